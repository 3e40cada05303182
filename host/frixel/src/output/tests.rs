mod latency;

use std::fs;
use std::path::Path;

use frixel_wire::fault::Flags;
use frixel_wire::hello::BoardLimits;
use proptest::prelude::*;

use super::span::Extremes;
use super::*;
use crate::scene_file;
use frixel_chart::{RGBColor, colour};
use frixel_control::Board;
use frixel_driver::Counters;
use frixel_felt::metrics::{ErrorSize, MetricsSummary};
use frixel_felt::recorder::FeltRow;
use frixel_files::{Inputs, OutputFile};
use frixel_scene::reference::Reference;
use frixel_scene::{LayerNumber, LayerTitle, Program, compile};

const LIMITS: BoardLimits = Board::SIMULATOR.limits;

fn brick() -> Program {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/brick.toml"));
    compile(&scene_file::load(path).expect("it reads"), &LIMITS, 40_000).expect("it compiles")
}

/// Rows of a stroke along a slanted line, every millisecond; felt friction lags slightly.
fn stroke(program: &Program, seconds: f64) -> Vec<FeltRow> {
    let reference = Reference::new(program);
    let rows = (seconds * 1e3) as usize;
    let at = |row: usize| {
        let part = row as f64 / rows as f64;
        (5.0 + 110.0 * part, 30.0 + 40.0 * part + 8.0 * (12.0 * part).sin())
    };
    let friction_n = |(x_mm, y_mm): (f64, f64)| {
        reference.natural_friction_n() + reference.electric_friction_n(x_mm * 1e-3, y_mm * 1e-3)
    };
    let row = |row: usize| {
        let (x_mm, y_mm) = at(row);
        let felt_n = friction_n(at(row.saturating_sub(2)));
        FeltRow {
            t_s: row as f64 * 1e-3,
            x_mm: Some(x_mm),
            y_mm: Some(y_mm),
            speed_mm_s: Some(50.0),
            reference_n: Some(friction_n((x_mm, y_mm))),
            commanded_n: Some(felt_n),
            felt_n: Some(felt_n),
            voltage_v_rms: Some(150.0 * ((felt_n - 0.25) / 0.0278).max(0.0).sqrt()),
            dac_code: Some(1000),
            flags: Some(Flags::default()),
            ..FeltRow::default()
        }
    };
    (0..=rows).map(row).collect()
}

fn subject(name: &str) -> Subject {
    Subject { name: name.to_owned(), simulated: true, draft: false }
}

fn trace(rows: &[FeltRow]) -> Trace {
    let mut trace = Trace::new();
    for row in rows {
        trace.push(row, None);
    }
    trace
}

#[test]
fn csv_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("felt.csv");
    let output = OutputFile::new(&path, "--out", &Inputs::default()).expect("a place");
    let mut csv = FeltCsv::new(output.create().expect("a file")).expect("a header");
    let rows = [
        FeltRow {
            t_s: 0.001,
            x_mm: Some(12.345_678),
            y_mm: Some(-0.000_04),
            speed_mm_s: Some(100.0),
            reference_n: Some(0.25),
            commanded_n: Some(0.263_123_456_7),
            felt_n: Some(0.262),
            voltage_v_rms: Some(99.999_96),
            dac_code: Some(-12_345),
            flags: Some(Flags::default()),
            ..FeltRow::default()
        },
        FeltRow { t_s: 1.5, flags: Some(Flags::STILL.with(Flags::SATURATED)), ..FeltRow::default() },
        FeltRow { t_s: 2.0, felt_n: Some(f64::NAN), flags: Some(Flags(0x8008)), ..FeltRow::default() },
        FeltRow { t_s: 3.0, dac_code: Some(0), ..FeltRow::default() },
    ];
    for row in &rows {
        csv.write(row).expect("a row");
    }
    csv.into_writer().commit().expect("the end");
    assert_eq!(
        fs::read_to_string(&path).expect("the file"),
        "t_s,x_mm,y_mm,speed_mm_s,reference_n,commanded_n,felt_n,voltage_v_rms,dac_code,flags\n\
         0.001000,12.3457,0.0000,100.000,0.250000000,0.263123457,0.262000000,100.0000,-12345,none\n\
         1.500000,,,,,,,,,saturated+still\n\
         2.000000,,,,,,,,,no-finger+0x8000\n\
         3.000000,,,,,,,,0,\n"
    );
}

/// Noise that never repeats, from 0 to 1.
fn noise(row: usize) -> f64 {
    (row as f64 * 0.618_033_988_749_895).fract()
}

fn noisy(rows: usize) -> impl Iterator<Item = FeltRow> {
    (0..rows).map(|row| FeltRow {
        t_s: row as f64 * 25e-6,
        x_mm: Some(120.0 * noise(3 * row)),
        y_mm: Some(80.0 * noise(7 * row)),
        reference_n: Some(0.25 + 0.03 * noise(row)),
        felt_n: Some(0.25 + 0.03 * noise(row + 13)),
        voltage_v_rms: Some(150.0 * noise(row + 29)),
        ..FeltRow::default()
    })
}

#[test]
fn a_long_trace_stays_small_and_keeps_its_extremes() {
    let mut trace = Trace::new();
    for (number, mut row) in noisy(300_000).enumerate() {
        if number == 123_457 {
            row.felt_n = Some(0.9);
        }
        trace.push(&row, None);
    }
    assert!((800..1_600).contains(&trace.spans().len()), "{}", trace.spans().len());
    assert!(trace.strokes().map(|stroke| stroke.len()).sum::<usize>() < 8_000);
    let largest = trace.spans().iter().filter_map(|span| span.felt_n).map(|felt_n| felt_n.largest);
    assert!(largest.fold(0.0, f64::max) >= 0.9);
    let ends = (trace.spans()[0].start_s, trace.spans()[trace.spans().len() - 1].end_s);
    assert_eq!(ends, (0.0, 299_999.0 * 25e-6));

    let bytes = draw_felt_svg(&subject("noise"), &trace, &brick().reach).expect("a picture").len();
    assert!(bytes < 1_000_000, "{bytes} bytes");
}

proptest! {
    /// Every row lies within the one span that covers its time.
    #[test]
    fn spans_cover_their_rows(rows in 1..8_000_usize) {
        let rows: Vec<FeltRow> = noisy(rows).collect();
        let trace = trace(&rows);
        let mut spans = trace.spans().iter();
        let mut span = spans.next().expect("a span");
        for row in &rows {
            if row.t_s > span.end_s {
                span = spans.next().expect("a span for every row");
            }
            prop_assert!(span.start_s <= row.t_s && row.t_s <= span.end_s);
            let Some(Extremes { least, largest }) = span.felt_n else { panic!("felt") };
            prop_assert!(row.felt_n.is_some_and(|felt_n| least <= felt_n && felt_n <= largest));
        }
        prop_assert!(spans.next().is_none());
    }

    #[test]
    fn a_stroke_is_cut_where_the_finger_is_lifted(pieces in prop::collection::vec(1..50_usize, 1..6)) {
        let mut trace = Trace::new();
        for (number, piece) in pieces.iter().enumerate() {
            for step in 0..*piece {
                let place = (Some(step as f64), Some(number as f64));
                trace.push(&FeltRow { x_mm: place.0, y_mm: place.1, ..FeltRow::default() }, None);
            }
            trace.push(&FeltRow::default(), None);
            trace.push(&FeltRow::default(), None);
        }
        let strokes: Vec<Vec<(f64, f64)>> = trace.strokes().collect();
        prop_assert_eq!(strokes.iter().map(Vec::len).collect::<Vec<_>>(), pieces);
    }
}

#[test]
fn felt_svg_has_axes_units_and_legend() {
    let program = brick();
    let draw =
        |rows: &[FeltRow]| draw_felt_svg(&subject("a < b & c"), &trace(rows), &program.reach).expect("a picture");
    let mut rows = stroke(&program, 1.0);
    let svg = draw(&rows);
    for text in
        ["a &lt; b &amp; c, simulated", "friction, mN", "voltage, V rms", "time, s", "reference", "felt", "reachable"]
    {
        assert!(svg.lines().any(|line| line == text), "{text}");
    }
    assert!(svg.starts_with("<svg width=\"1000\" height="));
    assert!(!svg.contains("envelope"));
    assert_eq!(svg, draw(&rows));
    // A board that does not report felt friction.
    for row in &mut rows {
        row.felt_n = None;
    }
    let svg = draw(&rows);
    assert!(svg.lines().any(|line| line == "commanded") && !svg.lines().any(|line| line == "felt"));
    // No rows give an empty picture, not an error.
    draw(&[]);
    draw(&rows[..1]);
}

/// The colour at a part of the scale, as a pixel.
fn part_colour(part: f64) -> [u8; 3] {
    let RGBColor(red, green, blue) = colour(part);
    [red, green, blue]
}

fn read_png(bytes: &[u8]) -> (usize, Vec<u8>) {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    // A picture of few colours has a palette.
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().expect("a picture");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    let frame = reader.next_frame(&mut bytes).expect("samples");
    assert_eq!((frame.color_type, frame.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    (frame.width as usize, bytes)
}

#[test]
fn scene_png_shows_friction_and_stroke_where_they_are() {
    let program = brick();
    let rows = stroke(&program, 1.0);
    let drawn = draw_scene_png(&subject("brick"), &program, &trace(&rows)).expect("a picture");
    let (width, bytes) = read_png(&drawn);
    let again = draw_scene_png(&subject("brick"), &program, &trace(&rows)).expect("a picture");
    assert_eq!(drawn, again);
    // 110 mm are 800 pixels, from the map's corner at (84, 60).
    let pixel = |x_mm: f64, y_mm: f64| {
        let at = |mm: f64| (mm * 800.0 / 110.0) as usize;
        let first = 3 * ((60 + at(y_mm)) * width + 84 + at(x_mm));
        [bytes[first], bytes[first + 1], bytes[first + 2]]
    };
    assert_eq!(pixel(2.0, 2.0), part_colour(0.0));
    let reference = Reference::new(&program);
    for (x_mm, y_mm) in [(20.0, 20.0), (100.0, 100.0), (60.0, 90.0)] {
        let expected = part_colour(
            reference.electric_friction_n(x_mm * 1e-3, y_mm * 1e-3) / program.reach.electric_friction_max_n,
        );
        let near = pixel(x_mm, y_mm).iter().zip(expected).all(|(one, other)| one.abs_diff(other) < 24);
        assert!(near, "{:?} is not {expected:?}", pixel(x_mm, y_mm));
    }
    let (x_mm, y_mm) = rows[500].x_mm.zip(rows[500].y_mm).expect("a place");
    assert_eq!(pixel(x_mm, y_mm), [255, 59, 48]);
}

#[test]
fn screens_of_any_shape_are_drawn() {
    let mut program = brick();
    for (width_m, height_m) in [(2.0, 0.005), (0.005, 2.0), (0.005, 0.005), (2.0, 2.0)] {
        (program.header.screen_width_m, program.header.screen_height_m) = (width_m, height_m);
        let drawn = draw_scene_png(&subject("any shape"), &program, &Trace::new()).expect("a picture");
        let (width, bytes) = read_png(&drawn);
        assert!(width < 1_300 && bytes.len() / 3 / width < 1_000);
    }
}

#[test]
fn colours_end_where_the_scale_ends() {
    assert_eq!(part_colour(-3.0), part_colour(0.0));
    assert_eq!(part_colour(3.0), part_colour(1.0));
    assert_ne!(part_colour(0.0), part_colour(1.0));
    assert_eq!(part_colour(f64::NAN), [128, 128, 128]);
}

/// Rows of a friction that changes with time alone, as a vibration does, between two times.
fn vibration(frequency_hz: f64, between_s: std::ops::Range<f64>) -> Vec<FeltRow> {
    let row = |row: usize| {
        let t_s = row as f64 * 1e-3;
        let swing = if between_s.contains(&t_s) { (std::f64::consts::TAU * frequency_hz * t_s).sin() } else { 0.0 };
        let friction_n = Some(0.26 + 0.01 * swing);
        FeltRow { t_s, reference_n: friction_n, felt_n: friction_n, ..FeltRow::default() }
    };
    (0..3_000).map(row).collect()
}

#[test]
fn a_signal_too_fast_to_draw_is_drawn_as_its_envelope() {
    let drawn = |frequency_hz: f64| {
        let rows = vibration(frequency_hz, 1.0..2.0);
        draw_felt_svg(&subject(""), &trace(&rows), &brick().reach).expect("a picture")
    };
    let (slow, fast) = (drawn(20.0), drawn(150.0));
    let named = "felt, envelope, minimum to maximum";
    assert!(!slow.contains(named) && fast.contains(named));
    let explained = "Blocks are envelopes: the signal changes too fast to draw as a line there";
    assert!(!slow.contains(explained) && fast.contains(explained));
    // The reach is a polygon in both; in the fast one, two envelopes and two samples of them in the legend.
    let polygons = |svg: &str| svg.matches("<polygon").count();
    assert_eq!(polygons(&fast) - polygons(&slow), 4);
    assert!(fast.len() < slow.len());
}

#[test]
fn every_flag_of_the_rows_is_documented() {
    let page = include_str!("../../../../docs/design/outputs.md");
    for name in Flags(u16::MAX).names() {
        assert!(page.contains(&format!("\n| `{name}` | ")), "outputs.md says nothing about the flag {name}");
    }
}

#[test]
fn a_voltage_that_is_off_has_its_reason() {
    let program = brick();
    let rows = stroke(&program, 1.0);
    let drawn = |flags: Flags, voltage_v_rms: f64| {
        let mut rows = rows.clone();
        for row in &mut rows[200..400] {
            (row.voltage_v_rms, row.flags) = (Some(voltage_v_rms), Some(flags));
        }
        draw_felt_svg(&subject(""), &trace(&rows), &program.reach).expect("a picture")
    };
    let still = drawn(Flags::STILL, 0.0);
    assert!(still.lines().any(|line| line == "output off: the finger stands still"), "{still}");
    assert!(still.lines().any(|line| line == "output off"), "the strip");
    let mut rows_of_moment = rows.clone();
    for row in &mut rows_of_moment[200..201] {
        (row.voltage_v_rms, row.flags) = (Some(0.0), Some(Flags::TOUCH_STALE));
    }
    let moment = draw_felt_svg(&subject(""), &trace(&rows_of_moment), &program.reach).expect("a picture");
    assert!(moment.contains("output off: the touch") && !moment.contains("width=\"0\""), "a moment is drawn");
    let lost = drawn(Flags::STILL.with(Flags::TOUCH_STALE), 0.0);
    assert!(lost.contains("output off: the touch reports are too old") && !lost.contains("stands still"));
    // A scene without friction, and an output that is on.
    for svg in [drawn(Flags::SATURATED, 0.0), drawn(Flags::STILL, 20.0)] {
        assert!(!svg.contains("output off"));
    }
}

/// Ten minutes back and forth, one row per hundredth of a second: the finger stands still for one row a second, and the
/// host is silent for a tenth of a second.
#[test]
fn a_moment_at_each_turn_does_not_fill_the_strip_of_a_long_play() {
    let mut trace = Trace::new();
    for row in 0..60_000_usize {
        let flags = if (30_000..30_010).contains(&row) {
            Flags::HOST_SILENT
        } else if row.is_multiple_of(100) {
            Flags::STILL
        } else {
            Flags::default()
        };
        let voltage_v_rms = Some(if flags == Flags::default() { 100.0 } else { 0.0 });
        let t_s = 0.01 * row as f64;
        let row = FeltRow { t_s, x_mm: Some(1.0), voltage_v_rms, flags: Some(flags), ..FeltRow::default() };
        trace.push(&row, None);
    }
    let off: Vec<(f64, usize)> = trace.spans().iter().filter_map(|span| Some((span.start_s, span.off()?))).collect();
    let host_silent = 0;
    assert!(
        matches!(off[..], [(from_s, reason)] if reason == host_silent && (299.0..300.2).contains(&from_s)),
        "{off:?}"
    );
}

/// Rows that become one span: the strip has their strongest reason, whichever comes first.
#[test]
fn the_strongest_reason_of_a_span_is_shown() {
    let program = brick();
    for flags in [[Flags::STILL, Flags::HOST_SILENT], [Flags::HOST_SILENT, Flags::STILL]] {
        let row = |row: usize| FeltRow {
            t_s: 1e-3 * row as f64,
            x_mm: Some(1.0),
            voltage_v_rms: Some(0.0),
            flags: Some(flags[row % 2]),
            ..FeltRow::default()
        };
        let rows: Vec<FeltRow> = (0..4_000).map(row).collect();
        let svg = draw_felt_svg(&subject(""), &trace(&rows), &program.reach).expect("a picture");
        assert!(svg.contains("output off: the host is silent") && !svg.contains("stands still"), "{flags:?}");
    }
}

fn report(summary: &MetricsSummary) -> Report {
    let link = Counters { frames_sent: 400, frames_rejected: 1, payload_bytes: 63_000, wire_bytes: 65_000 };
    let mut reach = brick().reach;
    (reach.natural_friction_n, reach.electric_friction_max_n, reach.voltage_max_v_rms) = (0.25, 0.025, 150.0);
    Report::new("simulator", summary, &reach, &link, Some(123.4))
}

const NOTHING: MetricsSummary = MetricsSummary {
    ticks: 0,
    finger_down_ticks: 0,
    unreported_ticks: 0,
    saturated_ticks: None,
    slewing_ticks: None,
    friction_error: None,
    inversion_error: None,
    load_mismatch: None,
    carrier_ripple_rms_n: None,
    reference_range_n: None,
};

#[test]
fn report_as_json() {
    let known = MetricsSummary {
        ticks: 120_000,
        finger_down_ticks: 100_000,
        unreported_ticks: 480,
        saturated_ticks: Some(7),
        slewing_ticks: Some(9),
        friction_error: Some(ErrorSize { rms_n: 0.001, max_n: 0.005 }),
        inversion_error: Some(ErrorSize { rms_n: 1e-6, max_n: 0.00002 }),
        load_mismatch: Some(ErrorSize { rms_n: 0.012, max_n: 0.05 }),
        carrier_ripple_rms_n: Some(0.0005),
        reference_range_n: Some((0.25, 0.27)),
    };
    assert_eq!(
        report(&known).to_json(),
        "{\"rig\":\"simulator\",\"draft\":false,\"board_refuses\":[],\"simulated\":true,\"world\":null,\"touch_source\":null,\"finger_seed\":null,\"ticks\":120000,\"unreported_ticks\":480,\
         \"friction_error_rms_n\":0.001,\"friction_error_max_n\":0.005,\
         \"inversion_error_rms_n\":1e-6,\"inversion_error_max_n\":0.00002,\"slewing_ticks\":9,\
         \"load_mismatch_rms_n\":0.012,\"load_mismatch_max_n\":0.05,\"carrier_ripple_rms_n\":0.0005,\
         \"finger_origin\":\"assumed\",\"reachable_min_n\":0.25,\"reachable_max_n\":0.275,\"reference_min_n\":0.25,\"reference_max_n\":0.27,\
         \"saturated_ticks\":7,\"frames_sent\":400,\"frames_rejected\":1,\"payload_bytes\":63000,\"wire_bytes\":65000,\
         \"realtime_factor\":123.4,\"stream_samples\":null,\"stream_underruns\":null,\"stream_gaps\":null,\"in_this_play\":null,\"untouched_layers\":[],\"replaced_at_s\":null}"
    );
    assert_eq!(
        report(&known).summary(true),
        "  reachable        250.00 to 275.00 mN, assumed, at the load of the scene's finger\n\
         \x20 reference        250.00 to 270.00 mN, assumed, at the load of the finger that plays\n\
         \x20 inversion error  0.0010 mN rms, 0.0200 mN at most (0.004 % and 0.080 % of the range)\n\
         \x20 load mismatch    12.0000 mN rms, 50.0000 mN at most, for another load than the profile's; not in the friction \
         error\n\
         \x20 carrier ripple   0.5000 mN rms\n\
         \x20 ticks            120000, of which saturated 7, at the slew limit 9 (no inversion error), before the first touch report 480\n\
         \x20 link             400 frames sent, 1 rejected, 63000 payload bytes in 65000\n\
         \x20 speed            123 times real time\n\
         \x20 friction error   1.0000 mN rms, 5.0000 mN at most (4.000 % and 20.000 % of the range)\n"
    );
    assert_eq!(report(&known).summary(false), "  friction error   4.0 % of what the drive can add, rms\n");
}

#[test]
fn layers_that_were_never_touched_are_counted_from_the_last_replacement() {
    let title = |table, copy, name| LayerTitle::new(LayerNumber { table, copy }, Some(name), "button");
    let titles =
        [title(1, None, "base"), title(3, Some(1), "key 1"), title(3, Some(2), "key 2"), title(3, Some(3), "key 3")];
    let summary =
        |replaced_at_s| Report { untouched_layers: titles.to_vec(), replaced_at_s, ..report(&NOTHING) }.summary(false);
    let layers = "never touched    layer 1 \"base\", layer 3.1 \"key 1\" with 2 more copies";
    assert!(summary(None).contains(&format!("{layers}\n")), "{}", summary(None));
    assert!(summary(Some(1.5)).contains(&format!("{layers}; since 1.50 s, when the scene was replaced\n")));
}

#[test]
fn a_report_of_nothing_says_null_and_nothing() {
    let report = report(&NOTHING);
    assert!(report.to_json().contains("\"friction_error_rms_n\":null,\"friction_error_max_n\":null"));
    assert!(report.to_json().contains("\"saturated_ticks\":null"));
    assert!(!report.summary(true).contains("saturated"));
    assert!(!report.summary(true).contains("error") && !report.summary(true).contains("NaN"));
}
