//! Error of the felt friction of a texture against the tick rate.
use std::collections::BTreeMap;
use std::error::Error;

use frixel::report::{Data, Figure};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel, Strip, StripCell};
use frixel_felt::recorder::FeltRow;
use frixel_hil_sim::{Point, RigConfig, Stroke, TouchConfig};
use frixel_lab::simulation::{Simulation, simulate};
use frixel_scene::{Scene, compile};

/// Tick rates in Hz, each with a whole number of ticks per window.
const TICKS_HZ: [u32; 9] = [1_000, 2_000, 4_000, 5_000, 8_000, 10_000, 16_000, 20_000, 40_000];
/// Least number of ticks in half a carrier period.
const HALF_PERIOD_MIN_TICKS: u32 = 4;
/// Highest frequency of the carrier, in Hz; low tick rates require a lower one.
const CARRIER_HZ: u32 = 1_000;
/// Windows per second over which felt and reference friction are averaged, at every tick rate. A window is a period of
/// the carrier at its highest frequency.
const WINDOW_HZ: u32 = 1_000;
const SPEED_M_PER_S: f64 = 0.1;
/// Seeds, each with different phases between carrier, touch source and stripes.
const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];
/// Time omitted at the beginning, in s, in which the envelope rises and the estimator converges on the finger.
const SETTLING_S: f64 = 0.1;

/// A touch source without latency and noise.
const IDEAL_TOUCH: TouchConfig =
    TouchConfig { rate_hz: 500.0, latency_s: 0.0, noise_rms_m: 0.0, jitter_rms_s: 0.0, ..TouchConfig::IDEAL };

/// A curve of the chart.
struct Case {
    name: &'static str,
    wavelength_mm: f64,
    touch: TouchConfig,
    look: Look,
}

fn cases() -> [Case; 4] {
    let curve = |colour, mark| Look { colour, line: Line::Solid, mark };
    [
        Case { name: "2 mm stripes", wavelength_mm: 2.0, touch: IDEAL_TOUCH, look: curve(PALETTE[0], Mark::Disc) },
        Case { name: "1 mm stripes", wavelength_mm: 1.0, touch: IDEAL_TOUCH, look: curve(PALETTE[2], Mark::Square) },
        Case {
            name: "0.5 mm stripes",
            wavelength_mm: 0.5,
            touch: IDEAL_TOUCH,
            look: curve(PALETTE[1], Mark::Triangle),
        },
        Case {
            name: "2 mm stripes, touch source of 100 Hz, 10 ms late",
            wavelength_mm: 2.0,
            touch: TouchConfig::default(),
            look: curve(PALETTE[3], Mark::Ring),
        },
    ]
}

/// The carrier frequency at a tick rate, limited by [`HALF_PERIOD_MIN_TICKS`] and [`CARRIER_HZ`].
fn carrier_hz(tick_hz: u32) -> u32 {
    (tick_hz / (2 * HALF_PERIOD_MIN_TICKS)).min(CARRIER_HZ)
}

fn scene(wavelength_mm: f64, carrier_hz: u32) -> String {
    format!(
        "version = 1\n\
         [screen]\nwidth_mm = 120\nheight_mm = 80\n\
         [screen.coating]\nthickness_um = 10\npermittivity = 1\n\
         [finger]\nradius_mm = 8\nstiffness_pa_per_m = 1.8e7\nfriction_coefficient = 0.5\nnormal_load_n = 0.5\nskin_gap_um = 0\n\
         [carrier]\nfrequency_hz = {carrier_hz}\n\
         [[layer]]\nkind = \"grating\"\nwavelength_mm = {wavelength_mm}\nlow_n = 0.0\nhigh_n = 0.02\n"
    )
}

/// Recorded rows, one per window or per tick, and the reachable range of electric friction.
struct Felt {
    rows: Vec<FeltRow>,
    natural_n: f64,
    range_n: f64,
}

fn felt(case: &Case, tick_hz: u32, rows_hz: u32, seed: u64) -> Result<Felt, Box<dyn Error>> {
    let mut rig = RigConfig::default();
    rig.board.tick_hz = tick_hz;
    rig.world.tick_hz = tick_hz;
    rig.world.touch = case.touch;
    let text = scene(case.wavelength_mm, carrier_hz(tick_hz));
    let scene = Scene::parse(&text, "the report's texture", &BTreeMap::new())?;
    let program = compile(&scene, &rig.board.limits, tick_hz)?;
    let stroke = Stroke::constant_speed(Point { x_m: 0.01, y_m: 0.04 }, Point { x_m: 0.11, y_m: 0.04 }, SPEED_M_PER_S)?;
    let simulation =
        Simulation { rig, seconds: stroke.duration_s(), stroke, seed, ticks_per_row: tick_hz.div_ceil(rows_hz) };
    let simulated = simulate(&program, &simulation, None)?;
    Ok(Felt {
        rows: simulated.recorder.rows().to_vec(),
        natural_n: program.reach.friction_min_n(),
        range_n: program.reach.electric_friction_max_n,
    })
}

/// Root mean square of felt minus reference friction over the windows of all seeds, relative to the reachable range.
fn rms_error(case: &Case, tick_hz: u32) -> Result<f64, Box<dyn Error>> {
    let (mut sum, mut count) = (0.0, 0.0);
    for seed in SEEDS {
        let felt = felt(case, tick_hz, WINDOW_HZ, seed)?;
        let settled = felt.rows.iter().filter(|row| row.t_s > SETTLING_S);
        for error_n in settled.filter_map(|row| Some(row.felt_n? - row.wanted_n?)) {
            sum += (error_n / felt.range_n).powi(2);
            count += 1.0;
        }
    }
    Ok((sum / count).sqrt())
}

/// Adds reference and felt friction over a few periods of the finest stripes.
fn trace(panel: &mut Panel, data: &mut Data<6>, case: &Case) -> Result<(), Box<dyn Error>> {
    for (index, (tick_hz, look)) in
        (0..).zip([(1_000, Look::line(PALETTE[1], Line::Solid)), (40_000, Look::line(PALETTE[0], Line::Solid))])
    {
        let felt = felt(case, tick_hz, tick_hz, SEEDS[0])?;
        let start_s = 0.3;
        let shown: Vec<_> = felt.rows.iter().filter(|row| (start_s..start_s + 0.02).contains(&row.t_s)).collect();
        let natural_n = felt.natural_n;
        let part = |value: fn(&FeltRow) -> Option<f64>| {
            shown
                .iter()
                .filter_map(|row| Some((1e3 * (row.t_s - start_s), 1e3 * (value(row)? - natural_n))))
                .collect::<Vec<_>>()
        };
        let mut put = |curve: &str, time_ms: f64, friction_mn: f64| {
            let (ticks, carrier) = (f64::from(tick_hz), f64::from(carrier_hz(tick_hz)));
            data.row([curve.into(), ticks.into(), carrier.into(), None.into(), time_ms.into(), friction_mn.into()]);
        };
        for (time_ms, reference_mn) in part(|row| row.wanted_n) {
            put("reference", time_ms, reference_mn);
        }
        let curve = part(|row| row.felt_n);
        for (time_ms, felt_mn) in &curve {
            put("felt", *time_ms, *felt_mn);
        }
        panel.add(&format!("felt at {} kHz", tick_hz / 1_000), look, curve);
        if index == 1 {
            panel.add("reference", Look::line(PALETTE[6], Line::Dashed), part(|row| row.wanted_n));
        }
    }
    Ok(())
}

/// The finger's way at the times that have a label.
fn way(time: &Axis) -> Strip {
    let cell =
        |time_ms: f64| StripCell { x: time_ms..time_ms, text: format!("{:.1}", SPEED_M_PER_S * time_ms), colour: None };
    Strip { label: "path, mm".to_owned(), cells: time.ticks().into_iter().map(cell).collect() }
}

fn caption() -> Vec<String> {
    let carriers: Vec<_> = TICKS_HZ.iter().filter(|tick_hz| carrier_hz(**tick_hz) < CARRIER_HZ).collect();
    let slower: Vec<_> =
        carriers.iter().map(|tick_hz| format!("{} Hz at {} kHz", carrier_hz(**tick_hz), **tick_hz / 1_000)).collect();
    vec![
        format!(
            "A sine grating of 20 mN under a finger that slides at 100 mm/s, played on the simulated board with its \
             ticks at another rate, and felt through amplifier and friction lag. Left: root mean square of felt less \
             reference friction, both as means over 1 ms, over five seeds. The carrier is 1 kHz where half its period has \
             the {HALF_PERIOD_MIN_TICKS} ticks that a board demands; with fewer ticks it is slower ({}). A square \
             carrier's force does not depend on its frequency but for its edges.",
            slower.join(", ")
        ),
        "At few ticks a second the error is what the finger slides in a tick or two, and halves with it. It ends at \
         what ticks cannot help: the friction lag (1.4 kHz at this speed) and the carrier's edges, or, with a touch \
         source of 100 Hz that is 10 ms late and noisy, what is not known of the finger's place. The other curves have \
         a touch source of 500 Hz without delay or noise. The reference is taken at the end of each tick."
            .to_owned(),
        "Right: the finest stripes tick by tick, with the touch source of 500 Hz. The spikes at 40 kHz are the edges of the \
         carrier, which a mean over its period takes out."
            .to_owned(),
    ]
}

pub(super) fn figure() -> Result<Figure, Box<dyn Error>> {
    let mut left = Panel::new(
        "Stripes under a finger of 100 mm/s, simulated",
        Axis::log("ticks a second, kHz", 0.9..50.0),
        Axis::log("rms friction error, % of the reachable range", 0.1..100.0),
    );
    let mut data = Data::new([
        "curve",
        "tick_hz",
        "carrier_hz",
        "rms_error_over_reachable_range",
        "time_ms",
        "electric_friction_mn",
    ]);
    for case in cases() {
        let mut points = Vec::new();
        for tick_hz in TICKS_HZ {
            let error = rms_error(&case, tick_hz)?;
            points.push((1e-3 * f64::from(tick_hz), 100.0 * error));
            let carrier_hz = f64::from(carrier_hz(tick_hz));
            let ticks = f64::from(tick_hz);
            data.row([case.name.into(), ticks.into(), carrier_hz.into(), error.into(), None.into(), None.into()]);
        }
        left.add(case.name, case.look, points);
    }
    let mut right = Panel::new(
        "0.5 mm stripes, tick by tick, simulated",
        Axis::linear("time, ms", 0.0..20.0),
        Axis::linear("electric friction, mN", -2.0..24.0),
    );
    let [_, _, finest, _] = cases();
    trace(&mut right, &mut data, &finest)?;
    right.add_strip(way(&right.x));
    Ok(Figure {
        name: "error-against-tick-rate",
        title: "Error against the rate of ticks, for a felt texture, simulated".to_owned(),
        caption: caption(),
        chart: Chart::new(vec![left, right], 2),
        csv: data.csv()?,
    })
}
