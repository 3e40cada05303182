//! Ripple of a carrier: the variation of the squared electrode voltage within a period.

use core::f32::consts::FRAC_PI_2;

use crate::carrier::tangent_deficit;
use crate::double_single::square_root;
use crate::{Carrier, Waveform};

/// Number of levels of a ripple.
const LEVELS: usize = 8;
/// Number of ticks after an edge of a square wave that have a level of their own.
const EDGE_TICKS: usize = 6;
/// Variance of excesses from which their skewness counts. Below, its rounding error is larger than its effect.
const SKEWED: f32 = 1e-5;
/// Cosines of pi/16, 3 pi/16, 5 pi/16 and 7 pi/16: with their negatives, the nodes of Chebyshev's quadrature, which
/// averages a function of a cosine over a period.
const PHASES: [f32; LEVELS / 2] = [0.980_785_3, 0.831_469_6, 0.555_570_2, 0.195_090_3];

/// Mean squares of the electrode voltage in the ticks of a carrier period, relative to that of the period.
///
/// The attraction follows the squared voltage, and friction is convex in it. Friction averaged over a period therefore
/// exceeds that of a constant voltage with the same rms: see [`LoadedContact::under_carrier`].
///
/// Eight levels represent all ticks. The mean friction is within 1e-6 of that of every tick for a square wave whose
/// lag is at most 1.5 ticks, within 5e-5 for a lag of 2.5 ticks, and within 0.41 % for one of at most 120 ticks. For a
/// sine it is within 3e-5 if its half period has at least 20 ticks, and within 0.3 % if it has fewer.
///
/// [`LoadedContact::under_carrier`]: crate::LoadedContact::under_carrier
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    levels: [Level; LEVELS],
}

/// Number of some ticks, and sums of the first three powers of their excesses.
#[derive(Default)]
struct Moments {
    count: f32,
    sum: f32,
    squares: f32,
    cubes: f32,
}

impl Moments {
    fn add(&mut self, excess: f32) {
        let square = excess * excess;
        self.count += 1.0;
        self.sum += excess;
        self.squares += square;
        self.cubes += square * excess;
    }

    /// Two levels with the mean, variance and skewness of the ticks, and twice their number as the weight: Gauss
    /// quadrature.
    fn levels(&self) -> [Level; 2] {
        let count = self.count.max(1.0);
        let mean = self.sum / count;
        let variance = (self.squares / count - mean * mean).max(0.0);
        let third = self.cubes / count - mean * (mean * mean + 3.0 * variance);
        let lean = if variance > SKEWED { 0.5 * third / variance } else { 0.0 };
        let spread = square_root(variance + lean * lean);
        [-spread, spread].map(|side| Level {
            excess: (mean + lean + side).max(-1.0),
            weight: if lean == 0.0 { self.count } else { self.count * (1.0 - lean / side) },
        })
    }
}

/// `1 - tanh(r)/r`.
fn deficit(r: f32) -> f32 {
    tangent_deficit(r, r * r)
}

/// Mean square in some ticks of a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Level {
    /// Mean square in these ticks over that of the period, minus 1.
    pub(crate) excess: f32,
    /// Weight of these ticks in a mean: their number, times any factor.
    pub(crate) weight: f32,
}

impl Ripple {
    /// No ripple: an ideal square wave, or a constant voltage.
    pub const NONE: Self = Self { levels: [Level { excess: 0.0, weight: 1.0 }; LEVELS] };

    /// Whether the squared voltage is constant.
    pub(crate) fn is_none(&self) -> bool {
        self.levels.iter().all(|level| level.excess == 0.0)
    }

    pub(crate) fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// The ripple of a square wave, whose half period is `half_period_ticks` long, or `2 lags` time constants.
    ///
    /// After an edge, the voltage follows `1 - s exp(-t/tau)` with `s = 1 + tanh(lags)`. With `r` half the time
    /// constants in a tick, `rho = tanh(r)/r` and `e = 1 + tanh(r)`, a tick decays by `d = exp(-2 r) = (2 - e)/e`, and
    /// tick `k` has the mean square `1 - 2 s (rho/e) d^k + s^2 (rho/e^2) d^2k`.
    #[inline(never)]
    fn square(half_period_ticks: u32, lags: f32) -> Self {
        let r = lags / half_period_ticks as f32;
        let rho = 1.0 - deficit(r);
        let e = 1.0 + r * rho;
        let decay = (2.0 - e) / e;
        let mean_square = deficit(lags);
        let loss = 1.0 - mean_square;
        let mut remaining = 1.0 + lags * loss;
        let mut levels = [Level { excess: 0.0, weight: 0.0 }; LEVELS];
        let mut rest = Moments::default();
        for tick in 0..half_period_ticks {
            let excess = ((loss - rho / e * remaining * (2.0 - remaining / e)) / mean_square).max(-1.0);
            remaining *= decay;
            match levels.get_mut(tick as usize) {
                Some(level) if (tick as usize) < EDGE_TICKS => *level = Level { excess, weight: 2.0 },
                _ => rest.add(excess),
            }
        }
        for (level, further) in levels.iter_mut().skip(EDGE_TICKS).zip(rest.levels()) {
            *level = further;
        }
        Self { levels }
    }

    /// A ripple `depth cos(phase)` at twice the frequency of a sine.
    fn cosine(depth: f32) -> Self {
        let mut levels = Self::NONE.levels;
        let (falling, rising) = levels.split_at_mut(LEVELS / 2);
        for ((below, above), cosine) in falling.iter_mut().zip(rising).zip(PHASES) {
            (below.excess, above.excess) = (-depth * cosine, depth * cosine);
        }
        Self { levels }
    }
}

impl Carrier {
    /// The ripple of this carrier behind its lag.
    ///
    /// ```
    /// use frixel_model::{Carrier, Contact, Finger, Ripple, Waveform};
    ///
    /// let carrier = Carrier::new(Waveform::Sine, 20, 40_000, 20e-6);
    /// let contact = Contact::new(&Finger::<f64>::EXAMPLE, 5e-6)?.under_load(0.5)?;
    /// let constant_n = contact.electric_friction_n(150.0);
    /// // A sine of 150 V rms is felt 11 % more strongly than a constant voltage.
    /// let mean_n = contact.under_carrier(carrier.ripple()).electric_friction_n(150.0);
    /// assert!((mean_n / constant_n - 1.11).abs() < 5e-3);
    /// assert_eq!(contact.under_carrier(Ripple::NONE).electric_friction_n(150.0), constant_n);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn ripple(&self) -> Ripple {
        let has_lag = self.edge_time_constant_s > 0.0;
        let lags = 0.5 * self.half_period_s / self.edge_time_constant_s;
        match self.waveform {
            Waveform::Square if has_lag => Ripple::square(self.half_period_ticks, lags),
            Waveform::Square => Ripple::NONE,
            Waveform::Sine if has_lag => Ripple::cosine(held_sine_depth(lags, self.half_period_ticks as f32)),
            Waveform::Sine => Ripple::cosine(1.0),
        }
    }
}

/// Depth of the ripple of a sine held for a tick at a time.
///
/// With `r` half the time constants in a tick, `h = tanh(r)`, `rho = h/r`, `t = tan(pi/(2 H))` for a half period of `H`
/// ticks and `S = h^2 + t^2`, the mean square is half of `(h^2 + t^2 (1 - rho))/S`. The amplitude around it is half the
/// magnitude of `1 - rho + rho h^2 (h^2 - t^2 - 2 i t h)/S^2`.
fn held_sine_depth(lags: f32, half_period_ticks: f32) -> f32 {
    let half_angle = FRAC_PI_2 / half_period_ticks;
    let t = half_angle * (1.0 - tangent_deficit(half_angle, -(half_angle * half_angle)));
    let r = lags / half_period_ticks;
    let kept = deficit(r);
    let rho = 1.0 - kept;
    let h = r * rho;
    let (h_squared, t_squared) = (h * h, t * t);
    let sum = h_squared + t_squared;
    let mean_square = (h_squared + t_squared * kept) / sum;
    let swing = rho * h_squared / (sum * sum);
    let (real, imaginary) = (kept + swing * (h_squared - t_squared), swing * 2.0 * t * h);
    (square_root(real * real + imaginary * imaginary) / mean_square).min(1.0)
}
