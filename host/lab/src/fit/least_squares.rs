//! Least squares over the means of strokes, with the Levenberg-Marquardt algorithm of the crate of that name.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, VecStorage};

use frixel_model::Ripple;

use super::law::{Attraction, Coupling};

/// Step of the logarithm of a parameter, or of an exponent, for numerical derivatives.
const STEP: f64 = 1e-5;

/// The mean over part of a stroke at one voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Observation {
    /// Zero for natural friction.
    pub(super) voltage_v_rms: f64,
    pub(super) normal_load_n: f64,
    pub(super) measured: Measured,
    /// Square root of the number of rows.
    pub(super) weight: f64,
}

/// The quantity that an observation measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Measured {
    /// Total friction, in newtons.
    Friction(f64),
    /// Attraction in newtons, from a comparison with the friction just before and after: it does not depend on the
    /// friction coefficient.
    Attraction(f64),
}

/// The model to fit, with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Form {
    /// Friction coefficient and coupling, under a carrier.
    Contact(Ripple),
    /// Friction coefficient, attraction at 150 V and exponent of the voltage, with a fixed exponent of the load.
    Power { load_exponent: f64, reference_load_n: f64 },
    /// The same with a free exponent of the load.
    PowerOfLoad { reference_load_n: f64 },
}

/// A fitted law.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Solution {
    pub(super) friction_coefficient: f64,
    pub(super) attraction: Attraction,
}

impl Form {
    /// Parameters on which least squares is well scaled: logarithms, and exponents as they are.
    fn parameters(self, solution: &Solution) -> DVector<f64> {
        let first = libm::log(solution.friction_coefficient);
        match (self, solution.attraction) {
            (Self::Contact(_), Attraction::Contact(coupling, _)) => {
                DVector::from_vec(vec![first, libm::log(coupling.0)])
            }
            (Self::Power { .. }, Attraction::Power { reference_n, voltage_exponent, .. }) => {
                DVector::from_vec(vec![first, libm::log(reference_n), voltage_exponent])
            }
            (Self::PowerOfLoad { .. }, Attraction::Power { reference_n, voltage_exponent, load_exponent, .. }) => {
                DVector::from_vec(vec![first, libm::log(reference_n), voltage_exponent, load_exponent])
            }
            // A start of the wrong form gives parameters with which no step succeeds.
            _ => DVector::from_element(2, f64::NAN),
        }
    }

    fn solution(self, parameters: &DVector<f64>) -> Option<Solution> {
        let at = |index: usize| parameters.get(index).copied();
        let attraction = match self {
            Self::Contact(ripple) => Attraction::Contact(Coupling(libm::exp(at(1)?)), ripple),
            Self::Power { load_exponent, reference_load_n } => Attraction::Power {
                reference_n: libm::exp(at(1)?),
                voltage_exponent: at(2)?,
                load_exponent,
                reference_load_n,
            },
            Self::PowerOfLoad { reference_load_n } => Attraction::Power {
                reference_n: libm::exp(at(1)?),
                voltage_exponent: at(2)?,
                load_exponent: at(3)?,
                reference_load_n,
            },
        };
        Some(Solution { friction_coefficient: libm::exp(at(0)?), attraction })
    }
}

/// Finds the law of a form that is closest to the observations, from a start of the same form; `None` if the search
/// does not converge.
pub(super) fn solve(form: Form, observations: &[Observation], start: &Solution) -> Option<Solution> {
    let problem = Problem {
        form,
        observations,
        // A fixed factor gives attractions the unit and weight of friction. It must not move with the coefficient, or
        // the smallest coefficient would fit best.
        friction_per_attraction: start.friction_coefficient,
        parameters: form.parameters(start),
    };
    let (solved, report) = LevenbergMarquardt::new().with_tol(1e-10).minimize(problem);
    if !report.termination.was_successful() {
        return None;
    }
    let solution = form.solution(&solved.parameters)?;
    solved.parameters.iter().all(|parameter| parameter.is_finite()).then_some(solution)
}

/// Measured minus fitted friction of each observation, in newtons; `None` if the law is out of its range.
pub(super) fn residuals_n(
    solution: &Solution,
    friction_per_attraction: f64,
    observations: &[Observation],
) -> Option<Vec<f64>> {
    let points = observations.iter().map(|observation| (observation.voltage_v_rms, observation.normal_load_n));
    let attractions = solution.attraction.at(points)?;
    let residuals = observations.iter().zip(attractions).map(|(observation, attraction_n)| {
        let attraction_n = if observation.voltage_v_rms > 0.0 { attraction_n } else { 0.0 };
        match observation.measured {
            Measured::Friction(friction_n) => {
                friction_n - solution.friction_coefficient * (observation.normal_load_n + attraction_n)
            }
            Measured::Attraction(measured_n) => friction_per_attraction * (measured_n - attraction_n),
        }
    });
    Some(residuals.collect())
}

struct Problem<'o> {
    form: Form,
    observations: &'o [Observation],
    friction_per_attraction: f64,
    parameters: DVector<f64>,
}

impl Problem<'_> {
    fn weighted(&self, parameters: &DVector<f64>) -> Option<DVector<f64>> {
        let residuals = residuals_n(&self.form.solution(parameters)?, self.friction_per_attraction, self.observations)?;
        let weighted = residuals.iter().zip(self.observations).map(|(residual, one)| residual * one.weight);
        Some(DVector::from_iterator(residuals.len(), weighted))
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ParameterStorage = VecStorage<f64, Dyn, nalgebra::U1>;
    type ResidualStorage = VecStorage<f64, Dyn, nalgebra::U1>;
    type JacobianStorage = VecStorage<f64, Dyn, Dyn>;

    fn set_params(&mut self, parameters: &DVector<f64>) {
        self.parameters.copy_from(parameters);
    }

    fn params(&self) -> DVector<f64> {
        self.parameters.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        self.weighted(&self.parameters)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let columns: Option<Vec<_>> = (0..self.parameters.len())
            .map(|index| {
                let (mut above, mut below) = (self.parameters.clone(), self.parameters.clone());
                *above.get_mut(index)? += STEP;
                *below.get_mut(index)? -= STEP;
                Some((self.weighted(&above)? - self.weighted(&below)?) / (2.0 * STEP))
            })
            .collect();
        Some(DMatrix::from_columns(&columns?))
    }
}
