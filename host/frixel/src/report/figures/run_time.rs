//! Error against run time and against size, for every inversion method.

use core::f64::consts::LOG10_2;

use frixel_model::ContactModel;

use super::boards::BoardCostFigure;
use super::{Figure, ReportError};
use crate::report::counts::Counts;
use crate::report::figure::{Data, Value};
use crate::report::finger::DrawnFinger;
use crate::report::methods::{Bench, Kind, Method, Parameters, RANGE_V_RMS};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel, RGBColor};

/// Kinds of methods in the order of the legends, with their names and styles.
const KINDS: [(Kind, &str, Look); 12] = [
    (Kind::ClosedF64, "closed form, f64", Look::mark(PALETTE[6], Mark::Disc)),
    (Kind::ClosedF32, "closed form, f32", Look::mark(PALETTE[6], Mark::Ring)),
    (Kind::Bisection, "bisection, f64", both(PALETTE[1], Mark::Disc)),
    (Kind::BisectionF32, "bisection, f32", both(PALETTE[1], Mark::Ring)),
    (Kind::ForwardTable, "forward table, binary search, f32", both(PALETTE[4], Mark::Diamond)),
    (Kind::Linear, "direct table, linear, f32", both(PALETTE[5], Mark::Triangle)),
    (Kind::Quadratic, "direct table, quadratic, f32", both(PALETTE[0], Mark::Square)),
    (Kind::Cubic, "direct table, cubic, f32", both(PALETTE[2], Mark::Diamond)),
    (Kind::Device, "the board's table, cubic, f32", Look::mark(PALETTE[2], Mark::Ring)),
    (Kind::FixedLinear, "direct table, linear, integers", dashed(PALETTE[5], Mark::Triangle)),
    (Kind::FixedQuadratic, "direct table, quadratic, integers", dashed(PALETTE[0], Mark::Square)),
    (Kind::FixedCubic, "direct table, cubic, integers", dashed(PALETTE[2], Mark::Diamond)),
];

/// Processors on which instructions are counted: prefix in the counts, and display name.
const CORES: [(&str, &str); 4] = [
    ("m4f", "STM32G474: Cortex-M4F"),
    ("m33", "RP2350: Cortex-M33, FPU"),
    ("m0plus", "RP2040: Cortex-M0+, no FPU"),
    ("m3", "Cortex-M3, no FPU"),
];

const ERROR: &str = "largest relative error in electric friction";

const fn both(colour: RGBColor, mark: Mark) -> Look {
    Look { colour, line: Line::Thin, mark }
}

const fn dashed(colour: RGBColor, mark: Mark) -> Look {
    Look { colour, line: Line::Dashed, mark }
}

/// All methods, measured for one finger under one load.
pub(super) struct Measured {
    load_n: f64,
    methods: Vec<Method>,
}

impl Measured {
    fn title(&self) -> String {
        if self.load_n > 0.0 { format!("Under {} N", self.load_n) } else { "No load".to_owned() }
    }

    /// Run time of the f64 closed form, which is the unit of all run times.
    fn unit_seconds(&self) -> f64 {
        self.of(Kind::ClosedF64).map(|method| method.seconds).next().unwrap_or(f64::NAN)
    }

    fn of(&self, kind: Kind) -> impl Iterator<Item = &Method> {
        self.methods.iter().filter(move |method| method.kind == kind)
    }

    /// A panel of the errors over one kind of cost.
    fn panel(&self, x: Axis, cost: impl Fn(&Method) -> Option<f64>) -> Panel {
        let mut panel = Panel::new(&self.title(), x, Axis::log(ERROR, 1e-16..1e1));
        for (kind, name, look) in KINDS {
            let points: Vec<_> =
                self.of(kind).filter_map(|method| Some((cost(method)?, method.error.max(1e-16)))).collect();
            if !points.is_empty() {
                panel.add(name, look, points);
            }
        }
        panel
    }
}

/// Measures all methods without a load and under the load of a finger.
pub(super) fn measure(drawn: &DrawnFinger) -> Result<[Measured; 2], ReportError> {
    let finger = drawn.finger;
    let measured = |load_n: f64| {
        let bench = Bench {
            contact: &drawn.contact::<f64>()?.under_load(load_n)?,
            single: &drawn.contact::<f32>()?.under_load(load_n as f32)?,
            parameters: Parameters {
                radius_m: finger.radius_m,
                stiffness_pa_per_m: finger.stiffness_pa_per_m,
                friction_coefficient: finger.friction_coefficient,
                gap_m: drawn.gap_m,
                normal_load_n: load_n,
            },
        };
        Ok::<_, ReportError>(Measured { load_n, methods: bench.all()? })
    };
    Ok([measured(0.0)?, measured(drawn.load_n)?])
}

/// What an inversion costs and how exact it is, for the methods that matter most, under the finger's load.
pub(super) fn sentences(measured: &[Measured; 2], counts: &Counts) -> Vec<String> {
    let [_, loaded] = measured;
    let kinds = [
        (Kind::Device, "board's table"),
        (Kind::ClosedF32, "closed form in f32"),
        (Kind::ClosedF64, "closed form in f64"),
    ];
    let mut sentences = Vec::new();
    for (kind, name) in kinds {
        let Some(method) = loaded.of(kind).next() else { continue };
        let cost = method.counted.and_then(|what| {
            let (instructions, cycles) = (counts.instructions("m4f", what)?, counts.cycles("m4f", what)?);
            Some(format!("; on a Cortex-M4F {instructions} instructions, estimated {cycles} cycles"))
        });
        sentences.push(format!(
            "The {name}: error at most {:.1e}, worst at {:.3} mN; MEASURED here {:.0} ns, {:.2} of the f64 closed form's{}.",
            method.error,
            1e3 * method.worst_n,
            1e9 * method.seconds,
            method.seconds / loaded.unit_seconds(),
            cost.unwrap_or_default()
        ));
    }
    sentences.push(format!("Instructions were {}.", counts.origin()));
    sentences
}

/// Error over run time on this computer.
pub(super) fn against_time(
    measured: &[Measured; 2],
    drawn: &DrawnFinger,
    boards: BoardCostFigure,
) -> Result<Figure, ReportError> {
    let time = || Axis::log("MEASURED run time / the f64 closed form's", 0.05..200.0);
    let panels = measured.each_ref().map(|one| one.panel(time(), |method| Some(method.seconds / one.unit_seconds())));
    let mut data = Data::new([
        "normal_force_n",
        "method",
        "size",
        "largest_relative_error",
        "measured_run_time_over_f64_closed_form",
        "measured_nanoseconds",
    ]);
    for one in measured {
        for method in &one.methods {
            data.row([
                one.load_n.into(),
                name(method.kind).into(),
                method.size.as_str().into(),
                method.error.into(),
                (method.seconds / one.unit_seconds()).into(),
                (1e9 * method.seconds).into(),
            ]);
        }
    }
    let (low, high) = RANGE_V_RMS;
    Ok(Figure {
        name: "error-against-run-time",
        title: "Error against run time, for every method of inversion".to_owned(),
        caption: vec![
            format!(
                "Down and to the left is better. The error is the largest of |x(V) − x|/x over all electric frictions \
                 x from x({low} V) to x({high} V), V being the voltage that a method gives for x, and x(V) what the \
                 model makes of it in f64, right to 4e-15. Each kind comes in several sizes, joined by a line: steps \
                 of the bisection, entries of the forward table, rows of the direct tables."
            ),
            format!(
                "Run times were measured on the computer that made this page, in one run, as a ratio to the f64 closed \
                 form ({}): each call waits for the answer of the last one. They differ from run to run and from \
                 processor to processor; all else on this page does not.",
                nanoseconds(measured)
            ),
            boards.sentence("an inversion"),
            "Bisection is the straightforward method: it halves the range of voltages on Eqs. (36), (34), with a load \
             on Eqs. (43), (21), which give friction in total. In f32 and under a load the total cannot resolve the \
             electric part. The textbook's forward table holds friction at even steps of voltage; below the first step \
             it knows nothing. Direct tables find their row from the bits of the friction and evaluate a polynomial. \
             Integers have codes of 32 bits for friction, and their error is that against the code."
                .to_owned(),
            drawn.caption.clone(),
        ],
        chart: Chart::new(panels.into(), 2).with_shared_legend(),
        csv: data.csv()?,
    })
}

/// Error over size in bytes.
pub(super) fn against_size(measured: &[Measured; 2], drawn: &DrawnFinger) -> Result<Figure, ReportError> {
    let size = || Axis::log("size of the table, bytes", 1e2..1e5);
    let panels = measured.each_ref().map(|one| {
        let mut panel = one.panel(size(), |method| method.bytes.map(|bytes| bytes as f64));
        panel.y = Axis::log(ERROR, 1e-7..1e1);
        panel
    });
    let mut data = Data::new(["normal_force_n", "method", "size", "bytes", "largest_relative_error"]);
    for one in measured {
        for method in one.methods.iter().filter(|method| method.bytes.is_some()) {
            let bytes = method.bytes.map_or(Value::Text(String::new()), Value::from);
            data.row([
                one.load_n.into(),
                name(method.kind).into(),
                method.size.as_str().into(),
                bytes,
                method.error.into(),
            ]);
        }
    }
    Ok(Figure {
        name: "error-against-size",
        title: "Error against size, for every kind of table".to_owned(),
        caption: vec![
            format!(
                "Largest relative error in electric friction over 1 V to 200 V, as above, against the bytes of the \
                 table. Without a load friction spans {:.0} octaves, under {} N {:.0}, and tables are shorter. A \
                 higher order is smaller at the same error, until rounding in f32 ends it near 10⁻⁶. The board's table \
                 has a fixed size, whatever the load.",
                range_octaves(drawn, measured[0].load_n),
                measured[1].load_n,
                range_octaves(drawn, measured[1].load_n),
            ),
            drawn.caption.clone(),
        ],
        chart: Chart::new(panels.into(), 2).with_shared_legend(),
        csv: data.csv()?,
    })
}

/// Error over instructions on boards; `None` if `counts` has no method.
pub(super) fn against_instructions(
    measured: &[Measured; 2],
    drawn: &DrawnFinger,
    counts: &Counts,
) -> Result<Option<Figure>, ReportError> {
    let mut data = Data::new(["core", "method", "instructions", "estimated_cycles", "largest_relative_error"]);
    let mut panels = Vec::new();
    for (core, core_name) in CORES {
        let mut panel = Panel::new(
            core_name,
            Axis::log("instructions of one inversion, at most", 5.0..1e5),
            counted_errors(measured),
        );
        for (kind, name, look) in KINDS {
            let counted =
                measured.iter().flat_map(|one| one.of(kind)).filter_map(|method| Some((method, method.counted?)));
            // With and without a load: the larger error counts, as the larger number of instructions does.
            let worst = counted.max_by(|one, other| one.0.error.total_cmp(&other.0.error));
            let Some((method, what)) = worst else { continue };
            let Some(instructions) = counts.instructions(core, what) else { continue };
            let (cycles, error) = (counts.cycles(core, what), method.error.max(1e-16));
            data.row([core.into(), name.into(), instructions.into(), cycles.into(), error.into()]);
            panel.add(name, Look { line: Line::None, ..look }, vec![(instructions, error)]);
            let estimate = cycles.map_or(String::new(), |cycles| format!(" (about {cycles} cycles)"));
            panel.notes.push((instructions, error, format!("{instructions}{estimate}")));
        }
        if !panel.series.is_empty() {
            panels.push(panel);
        }
    }
    if panels.is_empty() {
        return Ok(None);
    }
    let columns = panels.len().min(2) as u32;
    Ok(Some(Figure {
        name: "error-against-instructions",
        title: "Error against instructions on a board".to_owned(),
        caption: vec![
            format!(
                "Largest relative error in electric friction over 1 V to 200 V, without a load or under {} N, whichever \
                 is larger, against the largest number of instructions that one inversion took over all inputs. \
                 Instructions were {}; the cycles beside them are *estimated*: instructions are not cycles. A board of \
                 170 MHz has 4,250 cycles to a tick at 40 kHz, and 170 to a microsecond.",
                measured[1].load_n,
                counts.origin()
            ),
            drawn.caption.clone(),
        ],
        chart: Chart::new(panels, columns).with_shared_legend(),
        csv: data.csv()?,
    }))
}

/// An error axis for all methods whose instructions are counted, extended by a decade.
fn counted_errors(measured: &[Measured; 2]) -> Axis {
    let counted = measured.iter().flat_map(|one| &one.methods).filter(|method| method.counted.is_some());
    let powers = counted.map(|method| method.error.max(1e-16).log10());
    let (low, high) = powers.fold((0.0_f64, -16.0_f64), |(low, high), power| (low.min(power), high.max(power)));
    Axis::log(ERROR, 10_f64.powf(low.floor() - 1.0)..10_f64.powf(high.ceil() + 1.0))
}

fn name(kind: Kind) -> &'static str {
    KINDS.iter().find(|(one, ..)| *one == kind).map_or("", |(_, name, _)| *name)
}

fn nanoseconds(measured: &[Measured; 2]) -> String {
    let [unloaded, loaded] = measured.each_ref().map(|one| 1e9 * one.unit_seconds());
    format!("{unloaded:.0} ns without a load, {loaded:.0} ns under {} N", measured[1].load_n)
}

/// Octaves of electric friction between the least and the largest voltage.
fn range_octaves(drawn: &DrawnFinger, load_n: f64) -> f64 {
    let friction = |voltage: f64| {
        let contact = drawn.contact::<f64>().ok()?.under_load(load_n).ok()?;
        contact.state(voltage).ok().map(|state| state.electric_friction_n)
    };
    let octaves = |low: f64, high: f64| (high / low).log10() / LOG10_2;
    friction(RANGE_V_RMS.0).zip(friction(RANGE_V_RMS.1)).map_or(f64::NAN, |(low, high)| octaves(low, high))
}
