//! Error metrics of the felt friction, collected sample by sample.
//!
//! - The **friction error** is felt friction minus reference friction. Both are means over one carrier period that ends
//!   at the sample, so that variation within a carrier period does not count as error. The error counts while the
//!   finger is down. After the finger comes down, the mean starts with the samples since then, so that no sample is
//!   skipped; when the finger goes up, the window is emptied. The time from the touch to the first report that reaches
//!   the board is counted separately, since the board cannot render friction before.
//! - The **inversion error** is the model's friction at the commanded voltage minus the board's target. It counts while
//!   the finger is down, the reference friction is in reach, and the envelope is not at its slew limit. Slew-limited
//!   ticks are counted separately.
//! - The **load mismatch** is the friction error caused by a normal load other than the scene's. The reference contains
//!   it too, so it is not part of the friction error.
//! - The **carrier ripple** is felt friction minus its mean over the carrier period centred on the sample, so that
//!   friction that changes at a constant rate has no ripple. It counts if that period lies entirely within a touch.
//!
//! Except for the reference friction, these numbers need a sample in every tick. A number is absent if a required
//! sample was not observed.

/// The known values of one tick. Frictions are totals, in newtons.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sample {
    /// Whether the finger is on the screen.
    pub finger_down: bool,
    /// Whether the board has received a report of a finger; absent if the board did not report.
    pub board_has_finger: Option<bool>,
    /// The reference friction at the finger's place.
    pub reference_n: Option<f64>,
    /// Whether the finger has just landed or turned, so that its skin does not yet pull against its motion.
    pub turning: bool,
    /// The board's target, the input of its inverse.
    pub commanded_n: Option<f64>,
    /// The friction that the finger felt.
    pub felt_n: Option<f64>,
    /// Friction of the full model at the commanded rms voltage, including DAC steps, with an ideal amplifier; absent if
    /// the reference friction is out of reach.
    pub inversion_n: Option<f64>,
    /// Whether the envelope was at its slew limit.
    pub slewing: bool,
    /// Friction error caused by a normal load other than the scene's.
    pub load_mismatch_n: Option<f64>,
    /// Whether the board clamped its target; absent if the board did not report.
    pub saturated: Option<bool>,
}

/// Collects errors, sample by sample.
#[derive(Clone, Debug, Default)]
pub(crate) struct Metrics {
    /// Errors of a carrier period.
    error: Ring,
    /// Felt friction of a carrier period and one sample more.
    felt: Ring,
    finger_down_samples: u64,
    /// Whether the board has received a report of the finger since it came down.
    is_reported: bool,
    unreported_samples: u64,
    /// Samples in which the board reported.
    reports: u64,
    saturated_samples: u64,
    slewing_samples: u64,
    friction_error: Spread,
    inversion_error: Spread,
    load_mismatch: Spread,
    carrier_ripple: Spread,
    reference_range_n: Option<(f64, f64)>,
}

/// The errors of a play. A number is absent if no sample counted, or if a required tick was not observed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MetricsSummary {
    /// Ticks of the play.
    pub ticks: u64,
    /// Observed ticks with the finger on the screen.
    pub finger_down_ticks: u64,
    /// Ticks of a touch before its first report reached the board. They have no friction error.
    pub unreported_ticks: u64,
    /// Ticks in which the board clamped its target.
    pub saturated_ticks: Option<u64>,
    /// Felt minus reference friction, as means over a carrier period.
    pub friction_error: Option<ErrorSize>,
    /// Ticks with the finger down in which the envelope was at its slew limit. They have no inversion error.
    pub slewing_ticks: Option<u64>,
    /// The model's friction at the commanded voltage, minus the board's target.
    pub inversion_error: Option<ErrorSize>,
    /// Friction error caused by a normal load other than the scene's.
    pub load_mismatch: Option<ErrorSize>,
    /// Rms of felt friction minus its mean over the centred carrier period, N.
    pub carrier_ripple_rms_n: Option<f64>,
    /// Smallest and largest total reference friction under the finger, N, except in the first micrometres after it
    /// lands or turns.
    pub reference_range_n: Option<(f64, f64)>,
}

/// The size of an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorSize {
    /// Root mean square, N.
    pub rms_n: f64,
    /// Largest magnitude, N.
    pub max_n: f64,
}

impl Metrics {
    /// Creates metrics without errors, for a carrier period of twice `half_period_ticks`.
    pub(crate) fn new(half_period_ticks: u32) -> Self {
        let half = half_period_ticks.max(1) as usize;
        Self { error: Ring::new(2 * half), felt: Ring::new(2 * half + 1), ..Self::default() }
    }

    /// Sets the carrier period to twice `half_period_ticks` from now on, and empties the windows.
    pub(crate) fn set_half_period(&mut self, half_period_ticks: u32) {
        let Self { error, felt, .. } = Self::new(half_period_ticks);
        (self.error, self.felt) = (error, felt);
    }

    /// Adds the next sample.
    pub(crate) fn add(&mut self, sample: &Sample) {
        if let Some(saturated) = sample.saturated {
            self.reports += 1;
            self.saturated_samples += u64::from(saturated);
        }
        if !sample.finger_down {
            self.error.clear();
            self.felt.clear();
            self.is_reported = false;
            return;
        }
        self.finger_down_samples += 1;
        self.is_reported |= sample.board_has_finger == Some(true);
        self.unreported_samples += u64::from(!self.is_reported);
        let errors = sample.felt_n.zip(sample.reference_n).filter(|_| self.is_reported);
        if let Some((felt_n, reference_n)) = errors {
            self.friction_error.add(self.error.mean_with(felt_n - reference_n));
        }
        self.slewing_samples += u64::from(sample.slewing);
        if let Some((inversion_n, commanded_n)) = sample.inversion_n.zip(sample.commanded_n).filter(|_| !sample.slewing)
        {
            self.inversion_error.add(inversion_n - commanded_n);
        }
        if let Some(load_mismatch_n) = sample.load_mismatch_n {
            self.load_mismatch.add(load_mismatch_n);
        }
        if let Some(ripple_n) = sample.felt_n.and_then(|felt_n| self.felt.ripple_with(felt_n)) {
            self.carrier_ripple.add(ripple_n);
        }
        if let Some(reference_n) = sample.reference_n.filter(|_| !sample.turning) {
            let (least_n, largest_n) = self.reference_range_n.unwrap_or((reference_n, reference_n));
            self.reference_range_n = Some((least_n.min(reference_n), largest_n.max(reference_n)));
        }
    }

    /// The errors so far, of a play of `ticks` ticks.
    pub(crate) fn summary(&self, ticks: u64) -> MetricsSummary {
        let every_tick_reported = self.reports == ticks;
        MetricsSummary {
            ticks,
            finger_down_ticks: self.finger_down_samples,
            unreported_ticks: self.unreported_samples,
            saturated_ticks: every_tick_reported.then_some(self.saturated_samples),
            friction_error: self.friction_error.size(),
            slewing_ticks: every_tick_reported.then_some(self.slewing_samples),
            inversion_error: self.inversion_error.size().filter(|_| every_tick_reported),
            load_mismatch: self.load_mismatch.size(),
            carrier_ripple_rms_n: self.carrier_ripple.size().map(|size| size.rms_n),
            reference_range_n: self.reference_range_n,
        }
    }
}

/// Root mean square and largest magnitude of a series.
#[derive(Clone, Copy, Debug, Default)]
struct Spread {
    count: u64,
    max: f64,
    /// Sum of squares, and the sum of its rounding errors (Knuth's two-sum).
    squares: f64,
    lost: f64,
}

impl Spread {
    fn add(&mut self, value: f64) {
        self.count += 1;
        // Not `max`, which also handles NaN.
        if value.abs() > self.max {
            self.max = value.abs();
        }
        let square = value * value;
        let sum = self.squares + square;
        let added = sum - self.squares;
        self.lost += (self.squares - (sum - added)) + (square - added);
        self.squares = sum;
    }

    fn size(&self) -> Option<ErrorSize> {
        let mean = (self.squares + self.lost) / self.count as f64;
        (self.count > 0).then(|| ErrorSize { rms_n: mean.sqrt(), max_n: self.max })
    }
}

/// The last values, up to a fixed number, and their sum. The sum is recomputed each time the ring wraps around, so that
/// rounding errors do not accumulate.
#[derive(Clone, Debug, Default)]
struct Ring {
    values: Vec<f64>,
    next: usize,
    filled: usize,
    sum: f64,
}

impl Ring {
    fn new(length: usize) -> Self {
        Self { values: vec![0.0; length], next: 0, filled: 0, sum: 0.0 }
    }

    fn clear(&mut self) {
        self.values.fill(0.0);
        (self.next, self.filled, self.sum) = (0, 0, 0.0);
    }

    fn push(&mut self, value: f64) {
        self.sum += value - self.values[self.next];
        self.values[self.next] = value;
        self.next += 1;
        self.filled = self.filled.max(self.next);
        if self.next == self.values.len() {
            self.next = 0;
            self.sum = self.values.iter().sum();
        }
    }

    /// Adds a value, and returns the mean of all values in the ring.
    fn mean_with(&mut self, value: f64) -> f64 {
        self.push(value);
        self.sum / self.filled as f64
    }

    /// Adds a value, and returns the difference of the middle value and the mean of the ring; `None` until the ring is
    /// full. The ring has one value more than a period, and its two end values count half, so that the mean is centred.
    fn ripple_with(&mut self, value: f64) -> Option<f64> {
        self.push(value);
        let period = self.values.len() - 1;
        if self.filled <= period {
            return None;
        }
        // The next place holds the oldest value.
        let middle = self.next + period - period / 2;
        let middle = if middle > period { middle - period - 1 } else { middle };
        let ends = 0.5 * (value + self.values[self.next]);
        Some(self.values[middle] - (self.sum - ends) / period as f64)
    }
}

#[cfg(test)]
mod tests;
