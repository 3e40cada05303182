//! The compiled part of the Python module `frixel`: what the Python files beside it (`python/frixel`) call.
//!
//! Values cross as arrays, texts and plain objects; the types and documents for people are those of the Python
//! files. Python's lock is released wherever something is computed.
#![forbid(unsafe_code)]
#![allow(clippy::needless_pass_by_value, reason = "functions that Python calls take what was converted for them")]

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
    use super::profile::{bundled_profiles, check_profile};
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

    use frixel_lab::score::TrialPlan;
    use pyo3::types::PyModuleMethods;
    use pyo3::{Bound, PyResult};

    #[pymodule_init]
    fn init(module: &Bound<'_, pyo3::types::PyModule>) -> PyResult<()> {
        module.add("STROKES", TrialPlan::STROKES)?;
        module.add("SEEDS", TrialPlan::SEEDS)?;
        module.add("STROKE_S", TrialPlan::SECONDS)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
