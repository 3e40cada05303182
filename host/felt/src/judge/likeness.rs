//! The fraction of a signal that is present in the felt friction.

/// Delays at which felt friction is compared with the scene, in moments: up to 40 ms late, which is imperceptible
/// (doi:10.1145/2611387), and 10 ms early, in steps of 2.5 ms.
const DELAYS: [isize; 21] = [-20, -15, -10, -5, 0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80];

/// Covariances of a signal with the felt friction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Likeness {
    variance: f64,
    /// With the felt friction, by delay.
    felt: [f64; DELAYS.len()],
    /// With the friction of the scene.
    scene: f64,
}

impl Likeness {
    /// Adds a signal, given as pairs of a moment's index and a value, with the frictions of the run, N. Its mean is
    /// removed, since a level is not a contrast.
    pub(super) fn add(&mut self, signal: impl Iterator<Item = (usize, f64)> + Clone, scene_n: &[f64], felt_n: &[f64]) {
        let (count, sum) = signal.clone().fold((0.0, 0.0), |(count, sum), (_, value)| (count + 1.0, sum + value));
        let mean = sum / f64::max(count, 1.0);
        let last = felt_n.len().saturating_sub(1);
        for (number, value) in signal {
            let deviation = value - mean;
            self.variance += deviation * deviation;
            self.scene += deviation * scene_n.get(number).copied().unwrap_or_default();
            for (sum, delay) in self.felt.iter_mut().zip(DELAYS) {
                *sum +=
                    deviation * felt_n.get(number.saturating_add_signed(delay).min(last)).copied().unwrap_or_default();
            }
        }
    }

    /// Slope of felt friction against the signal, at the delay with the largest slope; 0 for a constant signal. At most
    /// 1, since friction added by a display is not a contrast of the scene.
    pub(super) fn slope(&self) -> f64 {
        if self.variance > 0.0 { (self.felt.iter().copied().fold(0.0, f64::max) / self.variance).min(1.0) } else { 0.0 }
    }

    /// Fraction of the scene's friction that follows the signal; at most 1.
    pub(super) fn part_of_scene(&self) -> f64 {
        let felt = self.felt.iter().map(|felt| felt * self.scene.signum()).fold(0.0, f64::max);
        if self.scene.abs() > 0.0 { (felt / self.scene.abs()).min(1.0) } else { 0.0 }
    }
}
