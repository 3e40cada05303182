//! Fits recover people, and scenarios show what they expect.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod columns;
mod coverage;
mod empirical;
mod examples;
#[allow(dead_code, reason = "the example fit_floors uses the rest")]
mod filters;
mod goodput;
mod model_csv;
mod person;
mod refusals;
mod scenarios;
mod simulated;
mod slow_sensors;
#[allow(dead_code, reason = "the example fit_floors uses the rest")]
mod tally;

use frixel_lab::fit::Settings;
use frixel_model::Ripple;

fn settings() -> Settings {
    Settings {
        voltage_v_rms: 150.0,
        normal_load_n: None,
        coating_gap_m: simulated::COATING_GAP_M,
        ripple: Ripple::NONE,
        without: Vec::new(),
        seed: 1,
    }
}
