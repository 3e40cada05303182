//! Ways to compute the voltage for an electric friction, with their errors and run times.

use core::f64::consts::PI;

use frixel_model::{
    InverseTable, LoadedContact, Precision, Real, TableBuilder, U0F32, U1F31, VACUUM_PERMITTIVITY_F_PER_M,
};

use super::timing::{Sample, seconds_per_call};

/// Voltages over which errors are evaluated, in volts rms.
pub(super) const RANGE_V_RMS: (f64, f64) = (1.0, 200.0);
/// Number of frictions at which an error is evaluated.
const ERROR_POINTS: usize = 4_000;
/// Number of frictions over which a run time is measured, and the step between consecutive ones, coprime to that
/// number: the processor cannot predict the next.
const TIMED_POINTS: usize = 1_024;
const STRIDE: usize = 389;

const BISECTION_STEPS: [usize; 3] = [12, 24, 53];
const ENTRIES: [usize; 3] = [64, 1024, 4096];
/// Error bounds for which direct tables are built.
const TARGETS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];

pub(super) const BOARD: &str = "the board's table, cubic, f32";
pub(super) const CLOSED_F32: &str = "closed form, f32";
pub(super) const CLOSED_F64: &str = "closed form, f64";
pub(super) const BISECTION: &str = "bisection, f64";
pub(super) const BISECTION_F32: &str = "bisection, f32";
pub(super) const FORWARD: &str = "forward table, binary search, f32";
pub(super) const CUBIC: &str = "direct table, cubic, f32";
pub(super) const INTEGERS: &str = "direct table, cubic, integers";

/// A method to compute the voltage, in one size.
#[derive(Clone, Debug)]
pub(super) struct Method {
    pub(super) name: &'static str,
    /// Steps, entries, or the error bound of the table.
    pub(super) size: String,
    /// Largest relative error in electric friction; infinite where there is no answer.
    pub(super) error: f64,
    /// Place of the largest error.
    pub(super) worst: String,
    /// Measured seconds per call in a chain of dependent calls; not a number if they were not measured.
    pub(super) seconds: f64,
}

/// A finger under a load.
pub(super) struct Bench<'c> {
    pub(super) double: &'c LoadedContact<f64>,
    pub(super) single: &'c LoadedContact<f32>,
    /// Radius, stiffness, friction coefficient, gap and load in SI units, for the equations as they stand.
    pub(super) parameters: [f64; 5],
    /// Whether run times are measured.
    pub(super) is_timed: bool,
}

impl Bench<'_> {
    /// All methods, in the same order for every finger.
    pub(super) fn all(&self) -> Vec<Method> {
        let mut methods = vec![
            self.in_f64(CLOSED_F64, "", |x| self.double.voltage_v_rms(x)),
            self.in_f32(CLOSED_F32, "", |x| self.single.voltage_v_rms(x)),
        ];
        let double = Equation::<f64>::new(&self.parameters);
        for steps in BISECTION_STEPS {
            methods.push(self.in_f64(BISECTION, &format!("{steps} steps"), |x| double.voltage_v_rms(x, steps)));
        }
        let single = Equation::<f32>::new(&self.parameters);
        methods.push(self.in_f32(BISECTION_F32, "24 steps", |x| single.voltage_v_rms(x, 24)));
        methods.extend(ENTRIES.map(|entries| self.forward_table(entries)));
        for target in TARGETS {
            let size = format!("for {target:e}");
            methods.push(self.float_table(&size, target).unwrap_or_else(|| none(CUBIC, &size)));
            methods.push(self.integer_table(&size, target).unwrap_or_else(|| none(INTEGERS, &size)));
        }
        let board = InverseTable::build(self.double, RANGE_V_RMS.1).ok();
        let board = board.map(|table| self.in_f32(BOARD, "", |x| table.voltage_v_rms(x)));
        methods.push(board.unwrap_or_else(|| none(BOARD, "")));
        methods
    }

    /// The textbook's table: friction at even steps of voltage, binary search, and linear interpolation.
    fn forward_table(&self, entries: usize) -> Method {
        let step = RANGE_V_RMS.1 / (entries - 1) as f64;
        let frictions_n: Vec<f32> =
            (0..entries).map(|entry| self.double.electric_friction_n(step * entry as f64) as f32).collect();
        self.in_f32(FORWARD, &format!("{entries} entries"), |x| {
            let above = frictions_n.partition_point(|friction_n| *friction_n <= x);
            let below = above.saturating_sub(1).min(entries - 2);
            let (low, high) = (frictions_n[below], frictions_n[below + 1]);
            (below as f32 + (x - low) / (high - low)) * step as f32
        })
    }

    fn builder(&self, target: f64) -> Option<TableBuilder<'_>> {
        let friction_n = |voltage_v_rms| self.double.electric_friction_n(voltage_v_rms);
        TableBuilder::new(self.double, friction_n(RANGE_V_RMS.0), friction_n(RANGE_V_RMS.1), target).ok()
    }

    fn float_table(&self, size: &str, target: f64) -> Option<Method> {
        let builder = self.builder(target)?;
        let mut rows = vec![[0.0; 4]; builder.shape(Precision::F32, 4).ok()?.rows];
        let table = builder.build_f32(&mut rows).ok()?;
        Some(self.in_f32(CUBIC, size, |x| table.voltage_v_rms(x)))
    }

    /// A table whose friction and voltage are integer codes. The error is relative to the friction of the code.
    fn integer_table(&self, size: &str, target: f64) -> Option<Method> {
        let builder = self.builder(target)?;
        let mut rows = vec![[0; 4]; builder.shape(Precision::Fixed, 4).ok()?.rows];
        let table = builder.build_fixed(&mut rows).ok()?;
        let friction_n = table.friction_max_n() * U0F32::DELTA.to_num::<f64>();
        let voltage_v = table.voltage_max_v_rms() * U1F31::DELTA.to_num::<f64>();
        let codes = (
            |x: f64| (x / friction_n).round() as u32,
            |code: u32| f64::from(code) * friction_n,
            |code: u32| f64::from(code) * voltage_v,
        );
        Some(self.method(INTEGERS, size, codes, |code| table.voltage(U0F32::from_bits(code)).to_bits()))
    }

    fn in_f64(&self, name: &'static str, size: &str, invert: impl Fn(f64) -> f64) -> Method {
        self.method(name, size, (|x| x, |x| x, |volts| volts), invert)
    }

    fn in_f32(&self, name: &'static str, size: &str, invert: impl Fn(f32) -> f32) -> Method {
        self.method(name, size, (|x| x as f32, f64::from, f64::from), invert)
    }

    /// Measures a method in its own number type. The closures convert a friction to it, and it to friction and voltage.
    fn method<T: Sample>(
        &self,
        name: &'static str,
        size: &str,
        (taken, friction_n, volts): (impl Fn(f64) -> T, impl Fn(T) -> f64, impl Fn(T) -> f64),
        invert: impl Fn(T) -> T,
    ) -> Method {
        let mut method = Method { error: 0.0, ..none(name, size) };
        for x in self.frictions(ERROR_POINTS) {
            let x = taken(x);
            let error = (self.double.electric_friction_n(volts(invert(x))) / friction_n(x) - 1.0).abs();
            // Comparisons with NaN are false.
            let error = if error.is_nan() { f64::INFINITY } else { error };
            if error > method.error {
                let [_, k, .., load_n] = self.parameters;
                let worst = format!("{:.3} mN, {load_n} N, {k:.1e} Pa/m", 1e3 * friction_n(x));
                method = Method { error, worst, ..method };
            }
        }
        if self.is_timed {
            let frictions: Vec<f64> = self.frictions(TIMED_POINTS).collect();
            let inputs: Vec<T> =
                (0..TIMED_POINTS).map(|index| taken(frictions[index * STRIDE % TIMED_POINTS])).collect();
            method.seconds = seconds_per_call(&inputs, invert);
        }
        method
    }

    /// Frictions between those at the least and at the largest voltage, evenly spaced in their logarithms.
    fn frictions(&self, count: usize) -> impl Iterator<Item = f64> {
        let (low, high) =
            (self.double.electric_friction_n(RANGE_V_RMS.0), self.double.electric_friction_n(RANGE_V_RMS.1));
        // Slightly inside the range, so that rounding to f32 does not leave it.
        let (low, high) = (low * (1.0 + 1e-6), high * (1.0 - 1e-6));
        (0..count).map(move |index| low * (high / low).powf(index as f64 / (count - 1) as f64))
    }
}

/// A method that gives no answer.
fn none(name: &'static str, size: &str) -> Method {
    Method { name, size: size.to_owned(), error: f64::INFINITY, worst: String::new(), seconds: f64::NAN }
}

/// Total friction by the paper's Eqs. (43), (21), inverted by bisection over voltage.
#[derive(Clone, Copy)]
struct Equation<T> {
    parameters: [T; 5],
    half_permittivity: T,
    pi: T,
}

impl<T: Real> Equation<T> {
    fn new(parameters: &[f64; 5]) -> Self {
        let half_permittivity = T::from_f64(0.5 * VACUUM_PERMITTIVITY_F_PER_M);
        Self { parameters: parameters.map(T::from_f64), half_permittivity, pi: T::from_f64(PI) }
    }

    fn friction_n(&self, voltage_v_rms: T) -> T {
        let [radius, k, mu, gap, load_n] = self.parameters;
        let field = voltage_v_rms / gap;
        let sigma0 = self.half_permittivity * field * field;
        let around = T::TWO * gap * k * sigma0 / (T::ONE + sigma0 / (gap * k));
        let load = load_n * k / (self.pi * radius);
        let area = T::TWO * radius / k * (sigma0 + (sigma0 * sigma0 + around + load).sqrt());
        mu * self.pi * k * area * area / (T::from(4.0) * radius)
    }

    fn voltage_v_rms(&self, electric_friction_n: T, steps: usize) -> T {
        let [_, _, mu, _, load_n] = self.parameters;
        let reference_n = mu * load_n + electric_friction_n;
        let (mut low, mut high) = (T::ZERO, T::from_f64(RANGE_V_RMS.1));
        for _ in 0..steps {
            let middle = (low + high) / T::TWO;
            if self.friction_n(middle) < reference_n { low = middle } else { high = middle }
        }
        (low + high) / T::TWO
    }
}
