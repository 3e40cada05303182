//! The contact model over arrays.

use frixel_lab::model_csv::wider_than_finger;
use frixel_model::{Contact, ContactModel, Finger, InverseError, ParameterError, SoftContact, SoftFinger, StateError};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use super::error::{model_error, parameter_error};
use super::signals::mapped;

/// A finger on a coating, an object of `python/frixel/model.py`.
#[derive(FromPyObject)]
pub(crate) enum AnyContact {
    /// Of Winkler-Fuss springs.
    Springs {
        radius_m: f64,
        stiffness_pa_per_m: f64,
        friction_coefficient: f64,
        gap_m: f64,
        outer_radius_m: Option<f64>,
    },
    /// Of a soft material.
    Soft {
        radius_m: f64,
        modulus_pa: f64,
        stress_exponent: f64,
        shape_constant: f64,
        friction_coefficient: f64,
        gap_m: f64,
    },
}

/// A finger on a coating, with checked parameters.
enum Checked {
    Springs(Contact<f64>, Option<f64>),
    Soft(SoftContact<f64>),
}

impl AnyContact {
    fn radius_m(&self) -> f64 {
        let (Self::Springs { radius_m, .. } | Self::Soft { radius_m, .. }) = *self;
        radius_m
    }

    fn checked(&self) -> Result<Checked, ParameterError> {
        match *self {
            Self::Springs { radius_m, stiffness_pa_per_m, friction_coefficient, gap_m, outer_radius_m } => {
                let contact = Contact::new(&Finger { radius_m, stiffness_pa_per_m, friction_coefficient }, gap_m)?;
                outer_radius_m.map(|outer_radius_m| contact.within(outer_radius_m, 0.0).map(drop)).transpose()?;
                Ok(Checked::Springs(contact, outer_radius_m))
            }
            Self::Soft { radius_m, modulus_pa, stress_exponent, shape_constant, friction_coefficient, gap_m } => {
                let finger = SoftFinger { radius_m, modulus_pa, stress_exponent, shape_constant, friction_coefficient };
                finger.on_gap(gap_m).map(Checked::Soft)
            }
        }
    }
}

impl Checked {
    /// The contact under a load. Only a finger on springs without an outer radius accepts a negative load, which pulls.
    fn under_load(&self, normal_load_n: f64) -> Result<Box<dyn ContactModel<f64>>, ParameterError> {
        Ok(match self {
            Self::Springs(contact, Some(outer_radius_m)) => Box::new(contact.within(*outer_radius_m, normal_load_n)?),
            Self::Springs(contact, None) if normal_load_n < 0.0 => Box::new(contact.under_pull(-normal_load_n)?),
            Self::Springs(contact, None) => Box::new(contact.under_load(normal_load_n)?),
            Self::Soft(contact) => Box::new(contact.under_load(normal_load_n)?),
        })
    }
}

/// Arrays of equal length: contact radius, stiffness, friction and electric friction.
type States<'py> = [Bound<'py, PyArray1<f64>>; 4];

/// The contact at each voltage under its load; not a number where there is no contact. Also a warning if contacts would
/// be wider than the finger.
#[pyfunction]
pub(crate) fn eval_contact<'py>(
    py: Python<'py>,
    contact: AnyContact,
    voltage_v_rms: PyReadonlyArray1<'py, f64>,
    normal_load_n: PyReadonlyArray1<'py, f64>,
) -> PyResult<(States<'py>, Option<String>)> {
    let radius_m = contact.radius_m();
    let contact = contact.checked().map_err(|error| parameter_error(py, error))?;
    let state =
        |&(voltage_v_rms, normal_load_n): &(f64, f64)| match contact.under_load(normal_load_n)?.state(voltage_v_rms) {
            Ok(state) => {
                Ok([state.contact_radius_m, state.stiffness_pa_per_m, state.friction_n, state.electric_friction_n])
            }
            Err(StateError::Parameter(error)) => Err(error),
            Err(_) => Ok([f64::NAN; 4]),
        };
    let states = mapped(py, &pairs(&voltage_v_rms, &normal_load_n), state)?;
    let states = states.map_err(|error| parameter_error(py, error))?;
    let columns: [Vec<f64>; 4] = std::array::from_fn(|column| states.iter().map(|state| state[column]).collect());
    let doubt =
        wider_than_finger(columns[0].iter().filter(|contact_radius_m| **contact_radius_m > radius_m).count() as u64);
    Ok((columns.map(|column| column.into_pyarray(py)), doubt))
}

/// The rms voltage for each friction under its load; not a number where no voltage has this friction.
#[pyfunction]
pub(crate) fn invert_contact<'py>(
    py: Python<'py>,
    contact: AnyContact,
    friction_n: PyReadonlyArray1<'py, f64>,
    normal_load_n: PyReadonlyArray1<'py, f64>,
    is_electric: bool,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let contact = contact.checked().map_err(|error| parameter_error(py, error))?;
    let voltage = |&(friction_n, normal_load_n): &(f64, f64)| {
        let loaded = contact.under_load(normal_load_n)?;
        let voltage = if is_electric {
            loaded.voltage_for_electric_friction(friction_n)
        } else {
            loaded.voltage_for_friction(friction_n)
        };
        match voltage {
            Ok(voltage_v_rms) => Ok(voltage_v_rms),
            Err(InverseError::Parameter(error)) => Err(error),
            Err(_) => Ok(f64::NAN),
        }
    };
    let voltages = mapped(py, &pairs(&friction_n, &normal_load_n), voltage)?;
    Ok(voltages.map_err(|error| parameter_error(py, error))?.into_pyarray(py))
}

/// Values with the loads under which they are.
fn pairs(values: &PyReadonlyArray1<'_, f64>, normal_load_n: &PyReadonlyArray1<'_, f64>) -> Vec<(f64, f64)> {
    values.as_array().iter().copied().zip(normal_load_n.as_array().iter().copied()).collect()
}

/// Scales of voltage, friction and load of a finger on springs; `None` for a soft finger. Rejects parameters outside
/// of the model's range.
#[pyfunction]
pub(crate) fn contact_scales(contact: AnyContact) -> PyResult<Option<(f64, f64, f64)>> {
    Ok(match contact.checked().map_err(model_error)? {
        Checked::Springs(contact, _) => {
            Some((contact.voltage_scale_v_rms(), contact.friction_scale_n(), contact.load_scale_n()))
        }
        Checked::Soft(_) => None,
    })
}
