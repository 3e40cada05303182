//! A fit for programs and for people.

use std::fmt::Write;

use serde::Serialize;

use super::sensor::BANDWIDTH_TIMES_RISE;
use super::{Division, Estimate, Exponent, Fit, HeldOut, Verdict};

/// Voltage of the keys that name it, in volts rms.
pub(super) const NAMED_V_RMS: f64 = 150.0;

/// A fit; the field names are the keys of `--json`, and an unknown value is `null` there. Intervals are of 95 %.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Friction over load with the drive off.
    pub friction_coefficient: f64,
    /// Its interval.
    pub friction_coefficient_interval: [f64; 2],
    /// Electric friction at 150 V rms under the stated load, N; `null` if friction is stated at another voltage.
    pub electric_friction_150_v_n: Option<f64>,
    /// Its interval.
    pub electric_friction_150_v_interval_n: Option<[f64; 2]>,
    /// Exponent of the voltage in a power law that is fitted to the same data.
    pub voltage_exponent: f64,
    /// Its interval.
    pub voltage_exponent_interval: [f64; 2],
    /// The model's exponent for these data.
    pub voltage_exponent_of_model: f64,
    /// `kept`, `doubted` or `none`: what the exponent of the voltage says about the model.
    pub voltage_verdict: &'static str,
    /// Exponent of the load; `null` if the loads are too similar.
    pub load_exponent: Option<f64>,
    /// Its interval.
    pub load_exponent_interval: Option<[f64; 2]>,
    /// The model's exponent for these data.
    pub load_exponent_of_model: Option<f64>,
    /// `kept`, `doubted` or `none`: what the exponent of the load says about the model.
    pub load_verdict: &'static str,
    /// Voltage at which electric friction is stated, V rms.
    pub stated_voltage_v_rms: f64,
    /// Load at which electric friction is stated, N.
    pub normal_load_n: f64,
    /// Electric friction at the stated voltage, N.
    pub electric_friction_n: f64,
    /// Its interval.
    pub electric_friction_interval_n: [f64; 2],
    /// The one number about electrode, skin and gap that friction data give: `eps0/(2 g^2) sqrt(pi R/k)`, sqrt(N)/V^2.
    pub coupling_sqrt_n_per_v2: f64,
    /// Its interval.
    pub coupling_interval_sqrt_n_per_v2: [f64; 2],
    /// Skin gap of a finger of conventional radius and stiffness on this screen, um.
    pub skin_gap_um: f64,
    /// Lowest and highest voltage of the data, V rms.
    pub voltage_range_v_rms: [f64; 2],
    /// Smallest and largest load of the strokes, N.
    pub normal_load_range_n: [f64; 2],
    /// Number of strokes.
    pub strokes: usize,
    /// Number of rows that were used.
    pub rows: usize,
    /// How rows were divided into strokes: `column`, `motion` or `blocks`; `means` if the rows are means.
    pub division: &'static str,
    /// Bandwidth with which friction follows a switch of the drive, Hz.
    ///
    /// It is that of force sensor and finger together; `null` if the data are inconclusive.
    pub bandwidth_hz: Option<f64>,
    /// Names of the odd strokes that were left out.
    pub strokes_left_out: Vec<String>,
    /// Normal force and friction that the force sensor read without contact, which were subtracted, N; `null` where no
    /// rows are without contact.
    pub sensor_zero_n: Option<[f64; 2]>,
    /// Root mean square error of electric friction in held-out strokes, N; `null` for means.
    pub held_out_error_n: Option<f64>,
}

impl From<&Fit> for Summary {
    fn from(fit: &Fit) -> Self {
        let is_named = (fit.stated_voltage_v_rms - NAMED_V_RMS).abs() < 1e-6;
        let electric = fit.electric_friction_n;
        let load = Some(fit.load_exponent).filter(|exponent| exponent.verdict != Verdict::None);
        Self {
            friction_coefficient: fit.friction_coefficient.value,
            friction_coefficient_interval: interval(&fit.friction_coefficient),
            electric_friction_150_v_n: is_named.then_some(electric.value),
            electric_friction_150_v_interval_n: is_named.then(|| interval(&electric)),
            voltage_exponent: fit.voltage_exponent.measured.value,
            voltage_exponent_interval: interval(&fit.voltage_exponent.measured),
            voltage_exponent_of_model: fit.voltage_exponent.model,
            voltage_verdict: verdict(&fit.voltage_exponent),
            load_exponent: load.map(|exponent| exponent.measured.value),
            load_exponent_interval: load.map(|exponent| interval(&exponent.measured)),
            load_exponent_of_model: load.map(|exponent| exponent.model),
            load_verdict: verdict(&fit.load_exponent),
            stated_voltage_v_rms: fit.stated_voltage_v_rms,
            normal_load_n: fit.normal_load_n,
            electric_friction_n: electric.value,
            electric_friction_interval_n: interval(&electric),
            coupling_sqrt_n_per_v2: fit.coupling_sqrt_n_per_v2.value,
            coupling_interval_sqrt_n_per_v2: interval(&fit.coupling_sqrt_n_per_v2),
            skin_gap_um: 1e6 * fit.skin_gap_m,
            voltage_range_v_rms: [fit.voltage_range_v_rms.0, fit.voltage_range_v_rms.1],
            normal_load_range_n: [fit.load_range_n.0, fit.load_range_n.1],
            strokes: fit.strokes.len(),
            rows: fit.rows,
            division: fit.division.key(),
            bandwidth_hz: fit.bandwidth_hz,
            strokes_left_out: fit.preparation.left_out_names().into_iter().map(str::to_owned).collect(),
            sensor_zero_n: fit.preparation.sensor_zero_n(),
            held_out_error_n: fit.held_out.map(|held_out| held_out.contact_error_n),
        }
    }
}

fn interval(estimate: &Estimate) -> [f64; 2] {
    [estimate.low, estimate.high]
}

impl Division {
    /// The word of `--json`.
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::Column => "column",
            Self::Motion => "motion",
            Self::Blocks => "blocks",
            Self::Means => "means",
        }
    }
}

fn verdict(exponent: &Exponent) -> &'static str {
    match exponent.verdict {
        Verdict::None => "none",
        Verdict::Kept => "kept",
        Verdict::Doubted => "doubted",
    }
}

/// The fit in words, a line each: the results, what they say about the model, and what the data cannot tell.
pub fn words(fit: &Fit, screen: &str) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {name:<22} {value}");
    };
    let Estimate { value, low, high } = fit.friction_coefficient;
    let of = if fit.division == Division::Means { "of all means" } else { "the mean of this recording" };
    line("friction coefficient", format!("{value:.3} (95 % interval {low:.3} to {high:.3}), {of}"));
    let Estimate { value, low, high } = fit.electric_friction_n;
    let (voltage, load_n) = (fit.stated_voltage_v_rms, fit.normal_load_n);
    let [value_mn, low_mn, high_mn] = [value, low, high].map(|newtons| 1e3 * newtons);
    line(
        "electric friction",
        format!(
            "{value_mn:.1} mN (95 % interval {low_mn:.1} to {high_mn:.1}) at {voltage:.0} V rms under {load_n:.2} N"
        ),
    );
    line("exponent of the voltage", exponent_words(&fit.voltage_exponent, NO_VERDICT_OF_VOLTAGE));
    line("exponent of the load", exponent_words(&fit.load_exponent, NO_VERDICT_OF_LOAD));
    line(
        "data",
        match fit.division {
            Division::Means => format!("{} means with their errors", fit.rows),
            _ => format!("{} strokes, {} rows of steady sliding", fit.strokes.len(), fit.rows),
        },
    );
    if let Some(bandwidth_hz) = fit.bandwidth_hz {
        let rise_ms = 1e3 * BANDWIDTH_TIMES_RISE / bandwidth_hz;
        line("force sensor", format!("follows a switch of the drive in {rise_ms:.1} ms, as with {bandwidth_hz:.0} Hz"));
    }
    if let Some(held_out) = &fit.held_out {
        line("strokes left out", HeldOut::words(held_out.contact_error_n, held_out.mean_n));
    }
    let skin_um = 1e6 * fit.skin_gap_m;
    line(
        "convention",
        format!("radius 8 mm, stiffness 18 MPa/m; with them the skin gap is {skin_um:.2} um on the screen {screen}"),
    );
    let notes = notes(fit).into_iter().map(str::to_owned).chain(fit.preparation.notes(fit.division));
    for note in notes {
        let _ = writeln!(text, "  note: {note}");
    }
    text
}

const NO_VERDICT_OF_VOLTAGE: &str = "no verdict on the model: below 100 V rms every model grows alike";
const NO_VERDICT_OF_LOAD: &str = "no verdict on the model: the loads were too alike";

fn exponent_words(exponent: &Exponent, no_verdict: &str) -> String {
    let Estimate { value, low, high } = exponent.measured;
    let model = exponent.model;
    let outcome = match exponent.verdict {
        Verdict::None => return no_verdict.to_owned(),
        Verdict::Kept => "is not contradicted",
        Verdict::Doubted => "is in doubt",
    };
    format!("{value:.2} (95 % interval {low:.2} to {high:.2}); the model says {model:.2} and {outcome}")
}

/// What the data cannot tell, in sentences.
fn notes(fit: &Fit) -> Vec<&'static str> {
    let mut notes = vec![
        "friction data cannot tell radius, stiffness and gap apart: they show one coupling number, so radius and \
         stiffness are a convention, and the profile holds for the screen it was measured on",
        "the friction coefficient is that of this recording: skin gets moist within minutes, and friction with it",
    ];
    if fit.division == Division::Means {
        notes.push(
            "means cannot tell how strokes or people differ, nor what they have in common: intervals come from the stated \
             errors, as if the means were independent, and are those of the mean finger",
        );
        notes.push("in means, nobody checked that fingers slid steadily, nor that they did not change while they were measured");
        if fit.load_range_n.0 >= fit.load_range_n.1 {
            notes.push("all loads are equal, so the means say nothing about other loads");
        }
        return notes;
    }
    if fit.division == Division::Motion {
        notes.push("without a column stroke, strokes were divided where the direction, the speed or the clock says so");
    }
    if fit.division == Division::Blocks {
        notes.push(
            "without a column stroke and without turns in the data, consecutive rows were taken as 24 blocks: the \
             intervals are right only if rows stand in the order in which they were measured",
        );
    }
    if !fit.has_time {
        notes.push("without a column time_s, starts and turns could not be left out, and the first quarter and the last tenth of each phase \
             of the drive stood in for the lag of friction");
    }
    if fit.bandwidth_hz.is_none() {
        notes.push(
            "too few switches, too much noise or too few rows a second to tell the bandwidth of the force sensor; electric \
             friction did not depend on how many rows beside a switch were left out",
        );
    }
    if !fit.has_speed {
        notes.push("without a column speed_mm_s, nobody checked that the finger slid at 20 to 100 mm/s");
    }
    notes
}
