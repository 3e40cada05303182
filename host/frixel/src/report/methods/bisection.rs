//! The straightforward method: bisect the voltage until the friction by Eqs. (36), (34), or with a load by Eqs. (43),
//! (21), matches.

use core::f64::consts::PI;

use frixel_model::{Real, VACUUM_PERMITTIVITY_F_PER_M};

use super::{Bench, Kind, Method, Parameters, RANGE_V_RMS};

const STEPS_F64: [usize; 5] = [8, 12, 20, 32, 53];
const STEPS_F32: [usize; 3] = [8, 12, 24];

/// Total friction at a voltage above zero, in the form of the paper's equations.
#[derive(Clone, Copy)]
struct Equation<T> {
    radius_m: T,
    stiffness_pa_per_m: T,
    friction_coefficient: T,
    gap_m: T,
    normal_load_n: T,
    half_permittivity: T,
    pi: T,
}

impl<T: Real> Equation<T> {
    fn new(parameters: &Parameters) -> Self {
        let [radius_m, stiffness_pa_per_m, friction_coefficient, gap_m, normal_load_n] = parameters.as_reals();
        let (half_permittivity, pi) = (T::from_f64(0.5 * VACUUM_PERMITTIVITY_F_PER_M), T::from_f64(PI));
        Self { radius_m, stiffness_pa_per_m, friction_coefficient, gap_m, normal_load_n, half_permittivity, pi }
    }

    fn friction_n(&self, voltage_v_rms: T) -> T {
        let Self { radius_m: radius, stiffness_pa_per_m: k, gap_m: gap, .. } = *self;
        let field = voltage_v_rms / gap;
        let sigma0 = self.half_permittivity * field * field;
        let around = T::TWO * gap * k * sigma0 / (T::ONE + sigma0 / (gap * k));
        let load = self.normal_load_n * k / (self.pi * radius);
        let area = T::TWO * radius / k * (sigma0 + (sigma0 * sigma0 + around + load).sqrt());
        self.friction_coefficient * self.pi * k * area * area / (T::from(4.0) * radius)
    }

    fn voltage_v_rms(&self, electric_friction_n: T, steps: usize) -> T {
        let wanted_n = self.friction_coefficient * self.normal_load_n + electric_friction_n;
        let (mut low, mut high) = (T::ZERO, T::from_f64(RANGE_V_RMS.1));
        for _ in 0..steps {
            let middle = (low + high) / T::TWO;
            if self.friction_n(middle) < wanted_n { low = middle } else { high = middle }
        }
        (low + high) / T::TWO
    }
}

pub(super) fn measure(bench: &Bench, methods: &mut Vec<Method>) {
    let double = Equation::<f64>::new(&bench.parameters);
    for steps in STEPS_F64 {
        let invert = |x| double.voltage_v_rms(x, steps);
        methods.push(bench.in_f64(Kind::Bisection, format!("{steps} steps"), invert));
    }
    let single = Equation::<f32>::new(&bench.parameters);
    for steps in STEPS_F32 {
        let invert = |x| single.voltage_v_rms(x, steps);
        methods.push(bench.in_f32(Kind::BisectionF32, format!("{steps} steps"), None, invert));
    }
}
