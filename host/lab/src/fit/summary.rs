//! A fit for programs and for people.

use std::fmt::Write;

use serde::Serialize;

use super::sensor::BANDWIDTH_TIMES_RISE;
use super::{
    DataSummary, Division, EmpiricalFit, Estimate, Exponent, Fit, HeldOut, MeasuredPoint, Preparation, Verdict,
    VoltageLaw,
};

/// Voltage of the keys that name it, in volts rms.
const NAMED_V_RMS: f64 = 150.0;

/// A fit by either law; the field names are the keys of `--json`, and an unknown value is `null` there. Intervals are
/// of 95 %.
#[derive(Default, Serialize)]
struct Summary<'f> {
    /// `empirical`; absent for the contact model.
    #[serde(skip_serializing_if = "Option::is_none")]
    law: Option<&'static str>,
    /// Friction over load with the drive off.
    friction_coefficient: f64,
    /// Its interval.
    friction_coefficient_interval: [f64; 2],
    /// Electric friction at 150 V rms under the stated load, N; `null` if friction is stated at another voltage.
    electric_friction_150_v_n: Option<f64>,
    /// Its interval.
    electric_friction_150_v_interval_n: Option<[f64; 2]>,
    /// Exponent of the voltage in a power law that is fitted to the same data.
    voltage_exponent: Option<f64>,
    /// Its interval.
    voltage_exponent_interval: Option<[f64; 2]>,
    /// The model's exponent for these data.
    voltage_exponent_of_model: Option<f64>,
    /// Verdict of the exponent of the voltage on the model: `kept`, `doubted` or `none`.
    voltage_verdict: Verdict,
    /// Exponent of the load; `null` if the loads are too similar.
    load_exponent: Option<f64>,
    /// Its interval.
    load_exponent_interval: Option<[f64; 2]>,
    /// The model's exponent for these data.
    load_exponent_of_model: Option<f64>,
    /// Verdict of the exponent of the load on the model: `kept`, `doubted` or `none`.
    load_verdict: Verdict,
    /// Voltage at which electric friction is stated, V rms.
    stated_voltage_v_rms: f64,
    /// Load at which electric friction is stated, N.
    normal_load_n: f64,
    /// Electric friction at the stated voltage, N.
    electric_friction_n: f64,
    /// Its interval.
    electric_friction_interval_n: [f64; 2],
    /// The one number about electrode, skin and gap that friction data give: `eps0/(2 g^2) sqrt(pi R/k)`, sqrt(N)/V^2.
    coupling_sqrt_n_per_v2: Option<f64>,
    /// Its interval.
    coupling_interval_sqrt_n_per_v2: Option<[f64; 2]>,
    /// Skin gap of a finger of conventional radius and stiffness on this screen, um.
    skin_gap_um: Option<f64>,
    /// Lowest and highest voltage of the data, V rms.
    voltage_range_v_rms: (f64, f64),
    /// Smallest and largest load of the strokes, N.
    normal_load_range_n: (f64, f64),
    /// Number of strokes.
    strokes: usize,
    /// Number of rows that were used.
    rows: usize,
    /// How rows were divided into strokes: `column`, `motion` or `blocks`; `means` if the rows are means.
    division: Option<Division>,
    /// Bandwidth with which friction follows a switch of the drive, Hz.
    ///
    /// It is that of force sensor and finger together; `null` if the data are inconclusive.
    bandwidth_hz: Option<f64>,
    /// Names of the odd strokes that were left out.
    strokes_left_out: Vec<&'f str>,
    /// Normal force and friction that the force sensor read without contact, which were subtracted, N; `null` where no
    /// rows are without contact.
    sensor_zero_n: Option<[f64; 2]>,
    /// Root mean square error of electric friction in held-out strokes, N; `null` for means.
    held_out_error_n: Option<f64>,
    /// The points of an empirical law: voltage, V rms, and electric friction, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    points: Option<Vec<[f64; 2]>>,
    /// The intervals of their electric friction, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    intervals_n: Option<Vec<[f64; 2]>>,
}

impl<'f> Summary<'f> {
    /// The results of a fit without the contact model. `stated` is a voltage and the electric friction at it.
    fn of(data: &'f DataSummary, strokes: usize, coefficient: Estimate, stated: (f64, Estimate)) -> Self {
        let (stated_voltage_v_rms, electric) = stated;
        let named = Some(electric).filter(|_| (stated_voltage_v_rms - NAMED_V_RMS).abs() < 1e-6);
        let Preparation { left_out, sensor_zero, .. } = &data.preparation;
        Self {
            friction_coefficient: coefficient.value,
            friction_coefficient_interval: interval(coefficient),
            electric_friction_150_v_n: named.map(|electric| electric.value),
            electric_friction_150_v_interval_n: named.map(interval),
            stated_voltage_v_rms,
            normal_load_n: data.normal_load_n,
            electric_friction_n: electric.value,
            electric_friction_interval_n: interval(electric),
            voltage_range_v_rms: data.voltage_range_v_rms,
            normal_load_range_n: data.load_range_n,
            strokes,
            rows: data.rows,
            division: Some(data.division),
            bandwidth_hz: data.bandwidth_hz,
            strokes_left_out: left_out.iter().map(|defective| &*defective.stroke).collect(),
            sensor_zero_n: sensor_zero.map(|zero| [zero.normal_force_n, zero.friction_n]),
            ..Self::default()
        }
    }
}

impl Fit {
    /// The fit as JSON, with the keys that docs/design/outputs.md lists.
    pub fn json(&self) -> serde_json::Value {
        let Exponent { measured, model, verdict } = self.voltage_exponent;
        let load = Some(self.load_exponent).filter(|exponent| exponent.verdict != Verdict::None);
        let stated = (self.stated_voltage_v_rms, self.electric_friction_n);
        serde_json::json!(Summary {
            voltage_exponent: Some(measured.value),
            voltage_exponent_interval: Some(interval(measured)),
            voltage_exponent_of_model: Some(model),
            voltage_verdict: verdict,
            load_exponent: load.map(|exponent| exponent.measured.value),
            load_exponent_interval: load.map(|exponent| interval(exponent.measured)),
            load_exponent_of_model: load.map(|exponent| exponent.model),
            load_verdict: self.load_exponent.verdict,
            coupling_sqrt_n_per_v2: Some(self.coupling_sqrt_n_per_v2.value),
            coupling_interval_sqrt_n_per_v2: Some(interval(self.coupling_sqrt_n_per_v2)),
            skin_gap_um: Some(1e6 * self.skin_gap_m),
            held_out_error_n: self.held_out.map(|held_out| held_out.contact_error_n),
            ..Summary::of(&self.data, self.strokes.len(), self.friction_coefficient, stated)
        })
    }
}

impl EmpiricalFit {
    /// The fit as JSON: the keys of a [`Fit`], some of them `null` without a model, and the keys of the law.
    pub fn json(&self) -> serde_json::Value {
        let exponent = match self.law {
            VoltageLaw::Power { exponent } => Some(exponent),
            VoltageLaw::Points { .. } => None,
        };
        let MeasuredPoint { voltage_v_rms, electric_friction_n } = self.highest;
        let points = self.points().map(|one| [one.voltage_v_rms, one.electric_friction_n.value]).collect();
        serde_json::json!(Summary {
            law: Some("empirical"),
            voltage_exponent: exponent.map(|exponent| exponent.value),
            voltage_exponent_interval: exponent.map(interval),
            held_out_error_n: self.held_out.map(|held_out| held_out.rms_n),
            points: Some(points),
            intervals_n: Some(self.points().map(|point| interval(point.electric_friction_n)).collect()),
            ..Summary::of(&self.data, self.strokes, self.friction_coefficient, (voltage_v_rms, electric_friction_n))
        })
    }
}

fn interval(estimate: Estimate) -> [f64; 2] {
    [estimate.low, estimate.high]
}

/// The fit as text, one line per item: results, verdicts on the model, and limits of the data.
pub fn words(fit: &Fit, screen: &str) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {name:<22} {value}");
    };
    let Estimate { value, low, high } = fit.friction_coefficient;
    let of = if fit.data.division == Division::Means { "of all means" } else { "the mean of this recording" };
    line("friction coefficient", format!("{value:.3} (95 % interval {low:.3} to {high:.3}), {of}"));
    let Estimate { value, low, high } = fit.electric_friction_n;
    let (voltage, load_n) = (fit.stated_voltage_v_rms, fit.data.normal_load_n);
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
        match fit.data.division {
            Division::Means => format!("{} means with their errors", fit.data.rows),
            _ => format!("{} strokes, {} rows of steady sliding", fit.strokes.len(), fit.data.rows),
        },
    );
    if let Some(bandwidth_hz) = fit.data.bandwidth_hz {
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
    let notes = notes(fit).into_iter().map(str::to_owned).chain(fit.data.preparation.notes(fit.data.division));
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
    // Digits that tell a doubted model from the data.
    let (outcome, digits) = match exponent.verdict {
        Verdict::None => return no_verdict.to_owned(),
        Verdict::Kept => ("is not contradicted", 2),
        Verdict::Doubted => ("is in doubt", 3),
    };
    let interval = format!("{low:.digits$} to {high:.digits$}");
    format!("{value:.digits$} (95 % interval {interval}); the model predicts {model:.digits$} and {outcome}")
}

/// The limits of the data, as sentences.
fn notes(fit: &Fit) -> Vec<&'static str> {
    let mut notes = vec![
        "friction data cannot tell radius, stiffness and gap apart: they show one coupling number, so radius and \
         stiffness are a convention, and the profile holds for the screen it was measured on",
        "the friction coefficient is that of this recording: skin gets moist within minutes, and friction with it",
    ];
    if fit.data.division == Division::Means {
        notes.push(
            "means cannot tell how strokes or people differ, nor what they have in common: intervals come from the stated \
             errors, as if the means were independent, and are those of the mean finger",
        );
        notes
            .push("means do not show whether fingers slid steadily, nor whether they changed while they were measured");
        if fit.data.load_range_n.0 >= fit.data.load_range_n.1 {
            notes.push("all loads are equal, so the means do not cover other loads");
        }
        return notes;
    }
    if fit.data.division == Division::Motion {
        notes.push("without a column stroke, strokes were divided by direction, speed and clock");
    }
    if fit.data.division == Division::Blocks {
        notes.push(
            "without a column stroke and without turns in the data, consecutive rows were taken as 24 blocks: the \
             intervals are right only if rows stand in the order in which they were measured",
        );
    }
    if !fit.data.has_time {
        notes.push("without a column time_s, starts and turns could not be left out, and the first quarter and the last tenth of each phase \
             of the drive stood in for the lag of friction");
    }
    if fit.data.bandwidth_hz.is_none() {
        notes.push(
            "too few switches, too much noise or too few rows a second to tell the bandwidth of the force sensor; electric \
             friction did not depend on how many rows beside a switch were left out",
        );
    }
    if !fit.data.has_speed {
        notes.push("without a column speed_mm_s, sliding at 20 to 100 mm/s was not checked");
    }
    notes
}
