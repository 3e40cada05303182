//! Mean of the squared voltage over half a carrier period.

/// The mean of the last values; each value as it is, if the window is empty.
#[derive(Clone, Debug, Default)]
pub(super) struct MeanSquare {
    window_v2: Vec<f64>,
    next: usize,
    sum_v2: f64,
}

impl MeanSquare {
    /// Averages over this number of ticks. A new window begins with the mean of the old one.
    pub(super) fn set_window(&mut self, ticks: u32) {
        let (before, ticks) = (self.window_v2.len(), ticks as usize);
        if ticks != before {
            let mean_v2 = if before > 0 { self.sum_v2 / before as f64 } else { 0.0 };
            *self = Self { window_v2: vec![mean_v2; ticks], next: 0, sum_v2: mean_v2 * ticks as f64 };
        }
    }

    /// The mean with the squared voltage of a tick, in V^2.
    pub(super) fn tick(&mut self, square_v2: f64) -> f64 {
        let Some(oldest_v2) = self.window_v2.get_mut(self.next) else { return square_v2 };
        self.sum_v2 += square_v2 - *oldest_v2;
        *oldest_v2 = square_v2;
        self.next += 1;
        if self.next == self.window_v2.len() {
            self.next = 0;
            // Removes the rounding of the running sum.
            self.sum_v2 = self.window_v2.iter().sum();
        }
        self.sum_v2.max(0.0) / self.window_v2.len() as f64
    }

    /// Empties the window when the finger leaves.
    pub(super) fn lift(&mut self) {
        self.window_v2.fill(0.0);
        self.sum_v2 = 0.0;
    }
}
