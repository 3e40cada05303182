//! Empirical laws: electric friction as a monotone function of the voltage, for a finger that the contact model does
//! not describe.

use core::error::Error;
use core::fmt::{Display, Formatter, Result as FmtResult};

use crate::Real;
use crate::double_single::DoubleSingle;
use crate::table::{Curve, FRICTION_MAX_N, LAW_DENSITY, LAW_ROWS, Point, RowGrid, round_down};

/// A point of an empirical law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawPoint {
    /// Rms voltage, in volts.
    pub voltage_v_rms: f32,
    /// Electric friction at this voltage, in newtons.
    pub electric_friction_n: f32,
}

/// Electric friction `x` as a function of the rms voltage `V`, under one normal load.
///
/// 1. Power laws through the points: below the first one, `x ~ V^exponent`; between two, the power law through both.
///    A single point and an exponent are a power law.
/// 2. `x_top` is the friction at the largest voltage by step 1, rounded down to an `f32`. The *knots* of the law are
///    127 frictions, eight per octave: their `f32` bit patterns are that of `x_top` plus 1, and 1 to 126 times 2^20
///    less. At the knots, the law is that of step 1; between two knots, it is the power law through both.
///
/// A bend at a point is thus rounded off within an eighth of an octave of friction, and each row of the board's
/// [`InverseTable`](crate::InverseTable) lies within one power law, so that its error can be proven. Below the lowest
/// knot, less than 2^-15 of the friction at the largest voltage, a board outputs zero.
///
/// ```
/// use frixel_model::{EmpiricalLaw, LawPoint};
/// let point = LawPoint { voltage_v_rms: 150.0, electric_friction_n: 0.09 };
/// let law = EmpiricalLaw::new(2.0, &[point], 100.0)?;
/// assert!((law.electric_friction_n(50.0) / 0.01 - 1.0).abs() < 1e-6);
/// assert!((law.voltage_v_rms(0.01) / 50.0 - 1.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmpiricalLaw {
    exponent: f32,
    count: u8,
    points: [LawPoint; POINTS_MAX],
    grid: RowGrid,
}

/// Why numbers are not a valid empirical law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LawError {
    /// There is no point, or there are more than [`EmpiricalLaw::POINTS_MAX`].
    PointCount {
        /// The number of points.
        found: usize,
    },
    /// The exponent below the first point is outside [`EmpiricalLaw::EXPONENTS`].
    Exponent {
        /// The exponent.
        found: f32,
    },
    /// A point is not finite and above zero, or not above the previous one, in voltage or in friction.
    Order {
        /// Number of the point, from 0.
        point: usize,
    },
    /// From the previous point to this one, friction grows with a power of the voltage outside
    /// [`EmpiricalLaw::EXPONENTS`].
    Slope {
        /// Number of the point, from 0.
        point: usize,
        /// The power.
        found: f32,
    },
    /// The largest voltage is not above zero, or above that of the last point.
    Voltage {
        /// The largest voltage, V rms.
        found: f32,
        /// Voltage of the last point, V rms.
        max: f32,
    },
    /// The friction at the largest voltage is outside [`EmpiricalLaw::FRICTIONS_N`].
    Friction {
        /// The friction, N.
        found: f32,
    },
}

impl Display for LawError {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        let [least, most] = EXPONENTS;
        match *self {
            Self::PointCount { found } => write!(f, "a law has 1 to {POINTS_MAX} points, but this one has {found}"),
            Self::Exponent { found } => write!(f, "the exponent is {found}, but must be {least} to {most}"),
            Self::Order { point } => {
                write!(f, "point {} must exceed the previous one in both voltage and friction", point + 1)
            }
            Self::Slope { point, found } => write!(
                f,
                "up to point {} friction grows with the power {found:.3} of the voltage: expected {least} to {most}",
                point + 1
            ),
            Self::Voltage { found, max } => {
                write!(f, "the largest voltage is {found} V rms, but the law ends at {max} V rms")
            }
            Self::Friction { found } => {
                let [least, most] = FRICTIONS_N;
                write!(f, "the friction at the largest voltage is {found:e} N, but must be {least:e} to {most:e} N")
            }
        }
    }
}

impl Error for LawError {}

/// See [`EmpiricalLaw::POINTS_MAX`].
const POINTS_MAX: usize = 16;
/// See [`EmpiricalLaw::EXPONENTS`].
const EXPONENTS: [f32; 2] = [0.5, 12.0];
/// See [`EmpiricalLaw::FRICTIONS_N`].
const FRICTIONS_N: [f32; 2] = [1e-6, FRICTION_MAX_N];
/// Relative tolerance for powers outside [`EXPONENTS`]: the rounding error of `f32`.
const EXPONENT_ROUNDING: f32 = 1e-5;

impl EmpiricalLaw {
    /// Largest number of points in a law.
    pub const POINTS_MAX: usize = POINTS_MAX;
    /// Smallest and largest power of the voltage with which friction may grow. [`crate::InverseTable::RELATIVE_ERROR`]
    /// holds between them.
    pub const EXPONENTS: [f32; 2] = EXPONENTS;
    /// Smallest and largest friction at the largest voltage, N. Below, the coefficients of a table's rows overflow;
    /// above, they underflow.
    pub const FRICTIONS_N: [f32; 2] = FRICTIONS_N;

    /// Creates the law of these points, with `exponent` below the first, up to a largest voltage. This is at most the
    /// last point's: a law is never extrapolated.
    pub fn new(exponent: f32, points: &[LawPoint], voltage_max_v_rms: f32) -> Result<Self, LawError> {
        let count = points.len();
        let (Some(last), 1..=POINTS_MAX) = (points.last().copied(), count) else {
            return Err(LawError::PointCount { found: count });
        };
        let [least, most] = EXPONENTS;
        if !(least..=most).contains(&exponent) {
            return Err(LawError::Exponent { found: exponent });
        }
        let mut before: Option<LawPoint> = None;
        for (number, point) in points.iter().enumerate() {
            let LawPoint { voltage_v_rms, electric_friction_n } = before.unwrap_or(LawPoint::ZERO);
            let is_above = point.voltage_v_rms > voltage_v_rms && point.electric_friction_n > electric_friction_n;
            if !(is_above && point.voltage_v_rms.is_finite() && point.electric_friction_n.is_finite()) {
                return Err(LawError::Order { point: number });
            }
            if let Some(before) = before {
                let found = 1.0 / power::<f32>(before.at(), point.at());
                if !(found >= least * (1.0 - EXPONENT_ROUNDING) && found <= most * (1.0 + EXPONENT_ROUNDING)) {
                    return Err(LawError::Slope { point: number, found });
                }
            }
            before = Some(*point);
        }
        if !(voltage_max_v_rms > 0.0 && voltage_max_v_rms <= last.voltage_v_rms) {
            return Err(LawError::Voltage { found: voltage_max_v_rms, max: last.voltage_v_rms });
        }
        // Repeat the last point in the unused entries.
        let mut law = Self { exponent, count: count as u8, points: [last; POINTS_MAX], grid: RowGrid::EMPTY };
        for (to, from) in law.points.iter_mut().zip(points) {
            *to = *from;
        }
        let voltage = DoubleSingle::from(voltage_max_v_rms);
        let (point, power) = law.segment(|point| DoubleSingle::from(point.voltage_v_rms) >= voltage);
        let top_n = round_down(point.0 * (voltage / point.1).pow(DoubleSingle::ONE / power));
        let [least, most] = FRICTIONS_N;
        let unrepresentable = LawError::Friction { found: top_n };
        if !(least..=most).contains(&top_n) {
            return Err(unrepresentable);
        }
        law.grid = RowGrid::new(LAW_ROWS, LAW_DENSITY, top_n, voltage_max_v_rms).map_err(|_| unrepresentable)?;
        Ok(law)
    }

    /// Electric friction in newtons at an rms voltage of zero or more. The last power law continues above the last
    /// point, since the voltage on an electrode exceeds its rms value within a carrier period. The rms value itself
    /// stays at or below the last point's.
    pub fn electric_friction_n(&self, voltage_v_rms: f64) -> f64 {
        if !(voltage_v_rms > 0.0) {
            return 0.0;
        }
        let (point, power_below) = self.segment::<f64>(|point| f64::from(point.voltage_v_rms) >= voltage_v_rms);
        let by_points = point.0 * (voltage_v_rms / point.1).pow(1.0 / power_below);
        // Both laws agree at the knots and ascend, so a friction lies between the same knots in both.
        match self.knots(by_points) {
            Some((start, end)) => start.0 * (voltage_v_rms / start.1).pow(1.0 / power(start, end)),
            None => by_points,
        }
    }

    /// The rms voltage in volts for an electric friction in newtons; zero for a friction of zero or less and for NaN,
    /// and the last point's voltage for more than its friction.
    pub fn voltage_v_rms(&self, electric_friction_n: f64) -> f64 {
        if !(electric_friction_n > 0.0) {
            return 0.0;
        }
        let electric_friction_n = electric_friction_n.min(f64::from(self.last().electric_friction_n));
        match self.knots(electric_friction_n) {
            Some((start, end)) => power_law(start, end)(electric_friction_n),
            None => Curve::voltage_v_rms(self, electric_friction_n),
        }
    }

    /// The grid of this law's table.
    pub(crate) fn grid(&self) -> RowGrid {
        self.grid
    }

    fn last(&self) -> LawPoint {
        let [.., last] = self.points;
        last
    }

    /// The first point that satisfies `reaches`, or the last one, and the exponent of the power law `V ~ x^p` that ends
    /// there.
    fn segment<T: Real>(&self, reaches: impl Fn(&LawPoint) -> bool) -> (Point<T>, T) {
        let mut before: Option<&LawPoint> = None;
        for point in self.points.iter().take(usize::from(self.count)) {
            if reaches(point) || point == &self.last() {
                let power_below =
                    before.map_or(T::ONE / T::from(self.exponent), |before| power(before.at(), point.at()));
                return (point.at(), power_below);
            }
            before = Some(point);
        }
        (self.last().at(), T::ONE)
    }

    /// The knots around a friction; `None` below the lowest and above the highest knot.
    fn knots(&self, electric_friction_n: f64) -> Option<(Point<f64>, Point<f64>)> {
        let row = self.grid.row(electric_friction_n as f32);
        let knot = |row| {
            let friction_n = f64::from(self.grid.start_n(row));
            (friction_n, Curve::voltage_v_rms(self, friction_n))
        };
        (row < LAW_ROWS).then(|| (knot(row), knot(row + 1)))
    }
}

impl<T: Real> Curve<T> for EmpiricalLaw {
    /// The law through the points.
    fn voltage_v_rms(&self, electric_friction_n: T) -> T {
        let (point, power) = self.segment(|point| T::from(point.electric_friction_n) >= electric_friction_n);
        point.1 * (electric_friction_n / point.0).pow(power)
    }

    fn between(&self, start: Point<T>, end: Point<T>) -> impl Fn(T) -> T {
        power_law(start, end)
    }
}

impl LawPoint {
    const ZERO: Self = Self { voltage_v_rms: 0.0, electric_friction_n: 0.0 };

    fn at<T: Real>(&self) -> Point<T> {
        (T::from(self.electric_friction_n), T::from(self.voltage_v_rms))
    }
}

/// Exponent `p` of the power law `V ~ x^p` through two points.
fn power<T: Real>(start: Point<T>, end: Point<T>) -> T {
    ln_ratio(end.1, start.1) / ln_ratio(end.0, start.0)
}

// If inlined, it would put three divisions into one block. When building for size, the compiler would call them through
// a register, and the stack depth could not be computed from the image.
#[inline(never)]
fn ln_ratio<T: Real>(end: T, start: T) -> T {
    (end / start - T::ONE).ln_1p()
}

/// The voltage as a function of the friction, by the power law through two points.
fn power_law<T: Real>(start: Point<T>, end: Point<T>) -> impl Fn(T) -> T {
    let power = power(start, end);
    move |friction_n| start.1 * (friction_n / start.0).pow(power)
}
