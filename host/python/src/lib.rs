//! The compiled part of the Python module `frixel`, called by the Python files beside it (`python/frixel`).
//!
//! Arguments and results are arrays, strings and plain objects; the public types and their documentation are in the
//! Python files. Computations release the GIL.
#![forbid(unsafe_code)]
#![allow(clippy::needless_pass_by_value, reason = "functions that Python calls take converted values")]

mod device;
mod error;
mod fit;
mod input;
mod model;
mod output;
mod profile;
mod recording;
mod scene;
mod score;
mod signals;
mod simulator;
mod sweep;

use pyo3::prelude::*;

/// Contact model, scenes and simulator, for the Python files beside it.
#[pymodule(gil_used = false)]
mod _frixel {
    #[pymodule_export]
    use super::device::Device;
    #[pymodule_export]
    use super::fit::fit_finger;
    #[pymodule_export]
    use super::input::read_file;
    #[pymodule_export]
    use super::model::{contact_scales, eval_contact, invert_contact};
    #[pymodule_export]
    use super::output::write_files;
    #[pymodule_export]
    use super::profile::{bundled_profiles, check_profile, profile_text};
    #[pymodule_export]
    use super::recording::{parquet, play_fields, read_parquet, replay};
    #[pymodule_export]
    use super::scene::Scene;
    #[pymodule_export]
    use super::score::score_scene;
    #[pymodule_export]
    use super::simulator::{check_stroke, simulate};
    #[pymodule_export]
    use super::sweep::{play_cell, study_files, sweep_cells};

    use frixel_driver::DURATION_MAX_S;
    use frixel_hil_sim::Board;
    use frixel_lab::calibration::{REACH, VOLTAGE_MAX_V_RMS};
    use frixel_lab::score::{JOBS_MAX, TrialPlan};
    use frixel_lab::simulate::STROKE_MAX_S;
    use frixel_model::Finger;
    use frixel_scene::FingerProfile;
    use frixel_wire::message::{GAIN_MAX, TELEMETRY_MAX_HZ};
    use pyo3::types::{IntoPyDict, PyModuleMethods};
    use pyo3::{Bound, PyResult};

    #[pymodule_init]
    fn init(module: &Bound<'_, pyo3::types::PyModule>) -> PyResult<()> {
        module.add("STROKES", TrialPlan::STROKES)?;
        module.add("SEEDS", TrialPlan::SEEDS)?;
        module.add("STROKE_S", TrialPlan::SECONDS)?;
        module.add("COUNT_MAX", TrialPlan::COUNT_MAX)?;
        module.add("JOBS_MAX", JOBS_MAX)?;
        module.add("MEDIAN_SPEEDS_MM_PER_S", TrialPlan::MEDIAN_SPEEDS_MM_PER_S.into_inner())?;
        module.add("STROKE_MAX_S", STROKE_MAX_S)?;
        module.add("TRIGGER_MAX_S", DURATION_MAX_S)?;
        module.add("GAIN_MAX", GAIN_MAX)?;
        module.add("TICK_HZ", Board::SIMULATOR.tick_hz)?;
        module.add("VOLTAGE_MAX_V_RMS", VOLTAGE_MAX_V_RMS)?;
        module.add("REACH", REACH)?;
        module.add("EXAMPLE_FINGER", example_finger().into_py_dict(module.py())?)?;
        module.add("TELEMETRY_MAX_HZ", TELEMETRY_MAX_HZ)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }

    /// Fields of the bundled finger `example`.
    fn example_finger() -> [(&'static str, f64); 5] {
        let example = FingerProfile::example();
        [
            ("friction_coefficient", example.friction_coefficient),
            ("normal_load_n", example.normal_load_n),
            ("radius_mm", example.radius_mm),
            ("stiffness_pa_per_m", Finger::<f64>::EXAMPLE.stiffness_pa_per_m),
            ("skin_gap_um", example.skin_gap_um),
        ]
    }
}
