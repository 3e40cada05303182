//! Every method of computing the voltage for an electric friction, with its error and its cost.

mod bisection;
mod direct;
mod forward_table;
mod timing;

use frixel_model::{LoadedContact, Real};

use super::error::ReportError;
use timing::seconds_per_call;

/// Range of voltages over which errors are evaluated, in volts rms.
pub(super) const RANGE_V_RMS: (f64, f64) = (1.0, 200.0);
/// Number of frictions at which an error is evaluated.
const ERROR_POINTS: usize = 20_000;
/// Number of frictions over which a run time is measured.
const TIMED_POINTS: usize = 1_024;
/// Step between consecutive frictions of a run-time measurement, so that the processor cannot predict the next one. It
/// has no common factor with their number.
const STRIDE: usize = 389;

/// A kind of method. Some kinds come in several sizes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    ClosedF64,
    ClosedF32,
    Bisection,
    BisectionF32,
    ForwardTable,
    Linear,
    Quadratic,
    Cubic,
    Device,
    FixedLinear,
    FixedQuadratic,
    FixedCubic,
}

/// One measured method.
#[derive(Clone, Debug)]
pub(super) struct Method {
    pub(super) kind: Kind,
    /// Number of steps, entries or rows that distinguishes methods of the same kind.
    pub(super) size: String,
    /// Name of the method in the counts of `cargo xtask bench`, if its instructions are counted.
    pub(super) counted: Option<&'static str>,
    /// Size of its table in bytes, if it has one.
    pub(super) bytes: Option<usize>,
    /// Largest relative error in electric friction over the range.
    pub(super) error: f64,
    /// The electric friction at which it is that large, in newtons.
    pub(super) worst_n: f64,
    /// Measured seconds per call in a chain of dependent calls.
    pub(super) seconds: f64,
}

/// A finger under a load, and the frictions to evaluate.
pub(super) struct Bench<'a> {
    pub(super) contact: &'a LoadedContact<f64>,
    pub(super) single: &'a LoadedContact<f32>,
    pub(super) parameters: Parameters,
}

/// Parameters of the direct and the tabulated textbook methods.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameters {
    pub(super) radius_m: f64,
    pub(super) stiffness_pa_per_m: f64,
    pub(super) friction_coefficient: f64,
    pub(super) gap_m: f64,
    pub(super) normal_load_n: f64,
}

impl Bench<'_> {
    /// Measures all methods.
    pub(super) fn all(&self) -> Result<Vec<Method>, ReportError> {
        let single = self.in_f32(Kind::ClosedF32, String::new(), None, |x| self.single.voltage_v_rms(x));
        let mut methods = vec![
            self.in_f64(Kind::ClosedF64, String::new(), |x| self.contact.voltage_v_rms(x)),
            Method { counted: Some("inverse_closed_form"), ..single },
        ];
        bisection::measure(self, &mut methods);
        forward_table::measure(self, &mut methods);
        direct::measure(self, &mut methods)?;
        Ok(methods)
    }

    /// Frictions between those at the least and at the largest voltage, evenly spaced in their logarithms.
    fn frictions(&self, count: usize) -> impl Iterator<Item = f64> {
        let (low, high) =
            (self.contact.electric_friction_n(RANGE_V_RMS.0), self.contact.electric_friction_n(RANGE_V_RMS.1));
        // Slightly inside the range, so that rounding to f32 does not leave it.
        let (low, high) = (low * (1.0 + 1e-6), high * (1.0 - 1e-6));
        (0..count).map(move |index| low * (high / low).powf(index as f64 / (count - 1) as f64))
    }

    fn in_f64(&self, kind: Kind, size: String, invert: impl Fn(f64) -> f64) -> Method {
        let error = |x: f64| (self.contact.electric_friction_n(invert(x)) / x - 1.0).abs();
        let (error, worst_n) = largest(self.frictions(ERROR_POINTS).map(|x| (error(x), x)));
        Method {
            kind,
            size,
            counted: None,
            bytes: None,
            error,
            worst_n,
            seconds: seconds_per_call(&self.timed(|x| x), invert),
        }
    }

    fn in_f32(&self, kind: Kind, size: String, bytes: Option<usize>, invert: impl Fn(f32) -> f32) -> Method {
        let error = |x: f64| {
            let x = x as f32;
            (self.contact.electric_friction_n(f64::from(invert(x))) / f64::from(x) - 1.0).abs()
        };
        let (error, worst_n) = largest(self.frictions(ERROR_POINTS).map(|x| (error(x), x)));
        Method {
            kind,
            size,
            counted: None,
            bytes,
            error,
            worst_n,
            seconds: seconds_per_call(&self.timed(|x| x as f32), invert),
        }
    }

    /// Measures a method whose friction and voltage are integer codes in the given units. The error is relative to the
    /// friction of the code.
    fn in_codes(
        &self,
        kind: Kind,
        size: String,
        bytes: usize,
        units: (f64, f64),
        invert: impl Fn(u32) -> u32,
    ) -> Method {
        let code = |x: f64| (x / units.0).round() as u32;
        let error = |x: f64| {
            let code = code(x);
            let voltage_v_rms = f64::from(invert(code)) * units.1;
            (self.contact.electric_friction_n(voltage_v_rms) / (f64::from(code) * units.0) - 1.0).abs()
        };
        let (error, worst_n) = largest(self.frictions(ERROR_POINTS).map(|x| (error(x), x)));
        Method {
            kind,
            size,
            counted: None,
            bytes: Some(bytes),
            error,
            worst_n,
            seconds: seconds_per_call(&self.timed(code), invert),
        }
    }

    fn timed<T>(&self, convert: impl Fn(f64) -> T) -> Vec<T> {
        let frictions: Vec<f64> = self.frictions(TIMED_POINTS).collect();
        (0..TIMED_POINTS).map(|index| convert(frictions[index * STRIDE % TIMED_POINTS])).collect()
    }
}

/// The largest error and its place; infinite if one is not a number, which no comparison finds.
fn largest(errors: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    errors.fold((0.0, f64::NAN), |worst, (error, place)| {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        if error > worst.0 { (error, place) } else { worst }
    })
}

impl Parameters {
    /// The parameters in either precision.
    fn as_reals<T: Real>(&self) -> [T; 5] {
        [self.radius_m, self.stiffness_pa_per_m, self.friction_coefficient, self.gap_m, self.normal_load_n]
            .map(T::from_f64)
    }
}

#[cfg(test)]
mod tests {
    use super::largest;

    #[test]
    fn an_error_that_is_no_number_is_the_largest() {
        let placed = |errors: [f64; 3]| largest(errors.into_iter().zip([0.1, 0.2, 0.3]));
        for errors in [[1.0, f64::NAN, 2.0], [f64::NAN, 1.0, 2.0], [1.0, 2.0, f64::NAN]] {
            assert!(placed(errors).0.is_infinite());
        }
        assert_eq!(placed([1.0, 3.0, 2.0]), (3.0, 0.2));
    }
}
