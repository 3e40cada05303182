//! Error against run time, for every method to compute the voltage.

use frixel_chart::{Axis, Line, Look, Mark, PALETTE, Panel, RGBColor};

use super::ReportError;
use super::counts::Counts;
use super::finger::DrawnFinger;
use super::methods::{
    BISECTION, BISECTION_F32, BOARD, Bench, CLOSED_F32, CLOSED_F64, CUBIC, FORWARD, INTEGERS, Method, RANGE_V_RMS,
};
use super::page::{Section, cell, digits, row};

/// Stiffnesses in addition to that of the drawn finger: a soft and a hard finger, Pa/m.
const STIFFNESSES_PA_PER_M: [f64; 2] = [1e6, 1e13];
const LOADS_N: [f64; 3] = [0.0, 0.5, 2.0];
/// Range of the axis of errors.
const ERRORS: (f64, f64) = (1e-16, 1e1);

/// The methods with their look, the size that the table shows, and its name in the counts.
const METHODS: [(&str, Look, &str, Option<&str>); 8] = [
    (BOARD, Look::mark(PALETTE[2], Mark::Ring), "", Some("inverse_table")),
    (CUBIC, both(PALETTE[2], Mark::Diamond), "for 1e-5", None),
    (INTEGERS, both(PALETTE[0], Mark::Square), "for 1e-5", Some("inverse_table_fixed")),
    (CLOSED_F32, Look::mark(PALETTE[6], Mark::Ring), "", Some("inverse_closed_form")),
    (CLOSED_F64, Look::mark(PALETTE[6], Mark::Disc), "", None),
    (BISECTION, both(PALETTE[1], Mark::Disc), "53 steps", None),
    (BISECTION_F32, Look::mark(PALETTE[1], Mark::Ring), "24 steps", None),
    (FORWARD, both(PALETTE[4], Mark::Diamond), "1024 entries", None),
];

const fn both(colour: RGBColor, mark: Mark) -> Look {
    Look { colour, line: Line::Thin, mark }
}

/// All methods: the largest error over all fingers and loads, and the run time on the finger that is drawn.
fn measured(drawn: &DrawnFinger) -> Result<Vec<Method>, ReportError> {
    let own = drawn.finger.stiffness_pa_per_m;
    let mut worst: Vec<Method> = Vec::new();
    for stiffness_pa_per_m in [own].into_iter().chain(STIFFNESSES_PA_PER_M) {
        for load_n in [drawn.load_n].into_iter().chain(LOADS_N) {
            let double = drawn.contact::<f64>(stiffness_pa_per_m)?.under_load(load_n)?;
            let single = drawn.contact::<f32>(stiffness_pa_per_m)?.under_load(load_n as f32)?;
            let (radius_m, mu) = (drawn.finger.radius_m, drawn.finger.friction_coefficient);
            let parameters = [radius_m, stiffness_pa_per_m, mu, drawn.gap_m, load_n];
            let bench = Bench { double: &double, single: &single, parameters, is_timed: worst.is_empty() };
            let methods = bench.all();
            if worst.is_empty() {
                worst.clone_from(&methods);
            }
            for (one, other) in worst.iter_mut().zip(methods) {
                if other.error > one.error {
                    *one = Method { seconds: one.seconds, ..other };
                }
            }
        }
    }
    Ok(worst)
}

pub(super) fn section(drawn: &DrawnFinger, counts: &Counts) -> Result<Section, ReportError> {
    let methods = measured(drawn)?;
    let find = |name: &str, size: &str| methods.iter().find(|method| method.name == name && method.size == size);
    let unit_s = find(CLOSED_F64, "").map_or(f64::NAN, |method| method.seconds);
    let mut panel = Panel::new(
        "",
        Axis::log("MEASURED run time / closed form in f64", 0.05..200.0),
        Axis::log("largest relative error in electric friction", ERRORS.0..ERRORS.1),
    );
    let mut table = vec![row("method|largest error|MEASURED ns|Cortex-M4F: instructions, cycles (est.)")];
    for (name, look, size, counted) in METHODS {
        let points = methods.iter().filter(|method| method.name == name);
        let points = points.map(|method| (method.seconds / unit_s, method.error.clamp(ERRORS.0, ERRORS.1)));
        panel.add(name, look, points.collect());
        let Some(method) = find(name, size) else { continue };
        let cost = counted.and_then(|what| {
            let cycles = counts.get(&format!("m4f.{what}_cycles"))?;
            Some(format!("{}, {cycles}", counts.get(&format!("m4f.{what}"))?))
        });
        let title = if size.is_empty() { name.to_owned() } else { format!("{name}, {size}") };
        table.push(vec![title, digits(method.error), format!("{:.0}", 1e9 * method.seconds), cost.unwrap_or_default()]);
    }
    let mut rows = vec![row(
        "method|size|largest_relative_error|worst_at|measured_run_time_over_f64_closed_form|measured_nanoseconds",
    )];
    for Method { name, size, error, worst, seconds } in &methods {
        let times = [cell(seconds / unit_s), cell(1e9 * seconds)];
        rows.push([vec![(*name).to_owned(), size.clone(), cell(*error), worst.clone()], times.to_vec()].concat());
    }
    let notes = vec![
        format!(
            "Down and to the left is better. The error is the largest of |x(V) − x|/x over electric frictions x from \
             x({} V) to x({} V), where V is the voltage that a method gives for x, and x(V) is the model's friction at \
             that voltage in f64. It is the largest over loads of 0, 0.5 and 2 N and the finger's own, and over stiffnesses \
             of 10⁶, 10¹³ and the finger's own {:.1e} Pa/m. Points of one colour differ in size.",
            RANGE_V_RMS.0, RANGE_V_RMS.1, drawn.finger.stiffness_pa_per_m
        ),
        "Run times are MEASURED on this computer, in one run: each call waits for the result of the previous one. They \
         differ from run to run; all else on this page does not. Cycles are estimated from classes of instructions."
            .to_owned(),
        "Bisection is on Eqs. (43), (21), whose total friction cannot resolve the electric part in f32 under a load. The \
         forward table is at even steps of voltage; direct tables find a polynomial by the bits of the friction."
            .to_owned(),
    ];
    Ok(Section { name: "error-against-run-time", question: "Error against run time", panel, table, notes, rows })
}
