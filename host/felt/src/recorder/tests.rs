use frixel_hil_sim::{Felt, SlipStep};
use frixel_wire::fault::State;
use frixel_wire::message::Telemetry;

use super::*;
use crate::tests::{LIMITS, TICK_HZ, program};

const CONSTANT: &str = "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n";
const EDGE: &str =
    "[[layer]]\nkind = \"edge\"\nx_mm = 50\ny_mm = 0\nwidth_mm = 1\nridge_n = 0.0\nclick_n = 0.01\nclick_ms = 60\n";
const STREAM: &str = "[[layer]]\nkind = \"stream\"\nlow_n = 0.0\nhigh_n = 0.02\n";

fn recorder(program: &Program, ticks_per_row: u32) -> Recorder {
    Recorder::new(program, &LIMITS, TICK_HZ, u64::MAX, ticks_per_row).unwrap()
}

fn telemetry(tick: u32) -> Telemetry {
    Telemetry {
        tick,
        state: State::Active,
        flags: Flags::default(),
        finger_x_m: 0.04,
        finger_y_m: 0.04,
        speed_m_per_s: 0.1,
        commanded_electric_friction_n: 0.01,
        voltage_v_rms: tick as f32,
        dac_code: tick as i16,
    }
}

/// What a simulated finger felt whose natural friction is 0.31 N, and that feels 0.9 of the scene's electric friction.
fn felt(friction_n: f64, electric_friction_n: f64) -> Felt {
    Felt {
        finger: Some(FingerState { x_m: 0.05, y_m: 0.05, speed_m_per_s: 0.1 }),
        friction_n,
        natural_friction_n: 0.31,
        electric_friction_n,
        normal_load_n: 0.62,
        load_mismatch_n: -0.02,
        slip: SlipStep { share: 1.0, direction: [1.0, 0.0], electric_gain: 0.9 },
        electrode_v: 0.0,
        mean_square_v2: 400.0,
    }
}

/// An observation of a simulated tick without a board's report.
fn simulated(tick: u32, friction_n: f64) -> Observation {
    Observation {
        tick,
        finger: Some(FingerState { x_m: 0.05, y_m: 0.05, speed_m_per_s: 0.1 }),
        felt: Some(felt(friction_n, friction_n - 0.25)),
        dac_code: Some(tick as i16),
        telemetry: None,
    }
}

fn in_mn(value: Option<f64>) -> Option<i64> {
    value.map(|value_n| (1e6 * value_n).round() as i64)
}

#[test]
fn a_row_has_means_over_its_ticks_and_what_the_board_reported_last() {
    let program = program(CONSTANT);
    let mut recorder = recorder(&program, 4);
    recorder.start(99);
    for tick in 90..120 {
        let telemetry = [102, 105, 111].contains(&tick).then(|| telemetry(tick));
        recorder.record(&Observation { telemetry, ..simulated(tick, f64::from(tick) / 1e3) });
    }
    let rows = recorder.take_rows();
    let means: Vec<_> = rows.iter().map(|row| in_mn(row.felt_n)).collect();
    assert_eq!(means, [101_500, 105_500, 109_500, 113_500, 117_500].map(Some));
    let reported: Vec<_> = rows.iter().map(|row| row.voltage_v_rms).collect();
    assert_eq!(reported, [Some(102.0), Some(105.0), Some(111.0), None, None]);
    assert!(rows.iter().all(|row| row.flags.is_some() == row.voltage_v_rms.is_some()));
    assert_eq!(rows.iter().map(|row| row.dac_code).collect::<Vec<_>>(), [103, 107, 111, 115, 119].map(Some));
    assert_eq!(in_mn(rows[0].reference_n), Some(260_000));
    assert_eq!(in_mn(rows[0].commanded_n), Some(260_000));
    let times: Vec<_> = rows.iter().map(|row| (row.t_s * f64::from(TICK_HZ)).round() as u32).collect();
    assert_eq!(times, [4, 8, 12, 16, 20]);
    let summary = recorder.summary();
    assert_eq!((summary.ticks, summary.finger_down_ticks), (20, 20));
    assert!(summary.friction_error.unwrap().rms_n > 0.1);
    assert_eq!((summary.saturated_ticks, summary.inversion_error), (None, None), "17 of 20 ticks were not reported");
}

/// The first message is time zero. The board's counter wraps around, and one message is lost.
#[test]
fn telemetry_alone_is_a_row_a_message() {
    let program = program(CONSTANT);
    let mut recorder = recorder(&program, 40);
    let first = u32::MAX - 60;
    for message in [0, 1, 3] {
        recorder.record(&Observation::from_telemetry(&telemetry(first.wrapping_add(40 * message))));
    }
    recorder.record(&Observation::from_telemetry(&telemetry(first)));
    let rows = recorder.rows();
    let times: Vec<_> = rows.iter().map(|row| (1e3 * row.t_s).round() as u32).collect();
    assert_eq!(times, [0, 1, 3]);
    assert!(rows.iter().all(|row| row.felt_n.is_none()), "nobody can say what was felt");
    assert_eq!(in_mn(rows[2].reference_n), Some(260_000));
    let summary = recorder.summary();
    assert_eq!((summary.ticks, summary.saturated_ticks, summary.friction_error), (120, None, None));
    assert!(summary.reference_range_n.is_some());
}

#[test]
fn a_record_ends_at_its_last_tick() {
    let program = program(CONSTANT);
    let mut recorder = Recorder::new(&program, &LIMITS, TICK_HZ, 6, 4).unwrap();
    recorder.start(0);
    (1..=100).for_each(|tick| recorder.record(&simulated(tick, 0.25)));
    assert_eq!((recorder.ticks(), recorder.ticks_left(), recorder.rows().len()), (6, 0, 1));
}

#[test]
fn without_a_reference_a_row_still_has_what_was_asked_for_and_felt() {
    let mut recorder = Recorder::without_reference(TICK_HZ, 1);
    recorder.start(0);
    recorder.record(&Observation { telemetry: Some(telemetry(1)), ..simulated(1, 0.27) });
    let row = recorder.rows()[0];
    assert_eq!(
        (in_mn(row.reference_n), in_mn(row.commanded_n), in_mn(row.felt_n)),
        (None, Some(260_000), Some(270_000))
    );
    assert_eq!(recorder.summary(), MetricsSummary { ticks: 1, ..MetricsSummary::default() });
}

/// A finger that crosses an edge at 100 mm/s, as a board reports it 1,000 times a second.
#[test]
fn the_reference_of_telemetry_clicks() {
    let program = program(EDGE);
    let mut recorder = recorder(&program, 40);
    let at = |message: u32| Telemetry { finger_x_m: 0.045 + 1e-4 * message as f32, ..telemetry(40 * message) };
    (0..150).for_each(|message| recorder.record(&Observation::from_telemetry(&at(message))));
    let reference_mn: Vec<f64> = recorder.rows().iter().map(|row| 1e3 * (row.reference_n.unwrap() - 0.25)).collect();
    let crossed = reference_mn.iter().position(|reference_mn| *reference_mn > 9.0).unwrap();
    assert!((48..=53).contains(&crossed), "it clicks at {crossed} ms");
    // The click decreases with the square of the time that remains of its 60 ms.
    for (ms, reference_mn) in reference_mn[crossed + 10..crossed + 60].iter().enumerate() {
        let expected_mn = 10.0 * (1.0 - (ms + 10) as f64 / 60.0).powi(2);
        assert!((reference_mn - expected_mn).abs() < 1e-3, "{ms}: {reference_mn} mN is not {expected_mn} mN");
    }
    assert!(reference_mn[crossed + 60..].iter().chain(&reference_mn[..crossed - 6]).all(|mn| mn.abs() < 1e-3));
}

/// Streams a ramp of 4,000 samples in a second.
fn stream_ramp(recorder: &mut Recorder) {
    let samples: Vec<u16> = (0..4_000).map(|index| 16 * index).collect();
    recorder.stream_started(4_000);
    for few in samples.chunks(50) {
        recorder.samples_sent(few);
    }
    recorder.stream_ended();
}

/// Electric friction of the ramp `ticks` ticks after it began, faded in, N.
fn ramp_n(ticks: f64) -> f64 {
    0.02 * 16.0 * (0.1 * ticks) / 65_535.0
}

/// A recorder of every tick and one of every 40th compute the same stream.
#[test]
fn the_reference_of_telemetry_streams() {
    let program = program(STREAM);
    for (period, tolerance_ticks) in [(1, 2.0), (40, 25.0)] {
        let mut recorder = recorder(&program, 40);
        let dry = |tick| if (400..4_010).contains(&tick) { Flags::STREAM_DRY } else { Flags::default() };
        for tick in (0..44_000).step_by(period) {
            if tick == 200 {
                stream_ramp(&mut recorder);
            }
            let telemetry = Telemetry { flags: dry(tick), ..telemetry(tick) };
            recorder.record(&Observation::from_telemetry(&telemetry));
        }
        let rows = recorder.rows();
        assert!(rows[..100].iter().all(|row| in_mn(row.reference_n) == Some(250_000)), "nothing streams yet");
        for row in &rows[115..1_090] {
            let ticks = row.t_s * f64::from(TICK_HZ) - 4_010.0;
            let (reference_n, mean_ticks) = (row.reference_n.unwrap() - 0.25, if period == 1 { 19.5 } else { 0.0 });
            let off_ticks = (reference_n - ramp_n(ticks - mean_ticks)) / ramp_n(1.0);
            assert!(off_ticks.abs() <= tolerance_ticks, "{} s, a tick in {period}: {off_ticks} ticks off", row.t_s);
        }
    }
}

/// The board waited for samples for less than the time between two messages, and so did not report it.
#[test]
fn a_stream_that_began_between_two_messages_is_in_the_reference() {
    let program = program(STREAM);
    let mut recorder = recorder(&program, 400);
    stream_ramp(&mut recorder);
    (0..100).for_each(|message| recorder.record(&Observation::from_telemetry(&telemetry(400 * message))));
    let rows = recorder.rows();
    let last_n = rows[90].reference_n.unwrap() - 0.25;
    let late_s = 0.9 - last_n / ramp_n(f64::from(TICK_HZ));
    assert!((0.0..0.08).contains(&late_s), "{late_s} s late");
}

#[test]
fn a_stream_that_a_board_refused_is_not_in_the_reference() {
    let program = program(STREAM);
    let mut recorder = recorder(&program, 400);
    recorder.stream_started(4_000);
    (0..100).for_each(|message| recorder.record(&Observation::from_telemetry(&telemetry(400 * message))));
    assert!(recorder.rows().iter().all(|row| in_mn(row.reference_n) == Some(250_000)));
}

/// Also by a recorder that had none before.
#[test]
fn another_program_is_compared_with_from_then_on() {
    let first = program(CONSTANT);
    for (mut recorder, before) in
        [(recorder(&first, 1), Some(260_000)), (Recorder::without_reference(TICK_HZ, 1), None)]
    {
        recorder.record(&simulated(1, 0.25));
        recorder.scene_replaced(&program(&CONSTANT.replace("0.26", "0.27")), &LIMITS).unwrap();
        recorder.record(&simulated(2, 0.25));
        let wanted: Vec<_> = recorder.rows().iter().map(|row| in_mn(row.reference_n)).collect();
        assert_eq!(wanted, [before, Some(270_000)]);
    }
}

#[test]
fn the_reference_goes_through_the_finger_that_felt() {
    let mut recorder = recorder(&program(CONSTANT), 1).through_finger();
    for tick in 1..=3 {
        let felt = Some(felt(0.32, 0.01));
        recorder.record(&Observation { felt, telemetry: Some(telemetry(tick)), ..simulated(tick, 0.32) });
    }
    for row in &recorder.rows()[..3] {
        assert_eq!(
            [in_mn(row.reference_n), in_mn(row.commanded_n), in_mn(row.felt_n)],
            [319_000, 320_000, 320_000].map(Some)
        );
        assert_eq!((in_mn(row.natural_n), row.electrode_v_rms, row.is_tracked), (Some(310_000), Some(20.0), true));
    }
    let lifted = Felt { finger: None, ..felt(0.0, 0.0) };
    recorder.record(&Observation::of_world(4, &lifted, 0));
    let row = recorder.rows().last().unwrap();
    assert_eq!((row.reference_n, row.is_tracked), (None, false), "a lifted finger feels nothing");
    let error = recorder.summary().friction_error.unwrap();
    assert!((error.rms_n - 1e-3).abs() < 1e-9, "{} N", error.rms_n);
    assert_eq!(recorder.summary().load_mismatch.map(|mismatch| in_mn(Some(mismatch.max_n))), Some(Some(20_000)));
}

#[test]
fn a_code_of_zero_is_no_friction_whatever_voltage_was_commanded() {
    let mut inversion = Inversion::new(&program(CONSTANT), &LIMITS).unwrap();
    assert_eq!(inversion.electric_friction_n(100.0, 0).to_bits(), 0);
    let expected_n = inversion.without_steps_n(100.0);
    let with_steps_n = inversion.electric_friction_n(100.0, -inversion.code_of(100.0));
    assert!((with_steps_n / expected_n - 1.0).abs() < 1e-3);
}

#[test]
fn a_play_is_judged_unless_something_changed_its_scene() {
    let program = program(CONSTANT);
    let judged = |change: &dyn Fn(&mut Recorder)| {
        let mut recorder = recorder(&program, 40).judged();
        recorder.start(0);
        (1..=100).for_each(|tick| recorder.record(&simulated(tick, 0.26)));
        change(&mut recorder);
        recorder.take_judged().map(|samples| samples.len())
    };
    assert_eq!(judged(&|_| {}), Some(10), "4,000 samples a second");
    let setting = LayerSetting { on: false, gain: 1.0 };
    assert_eq!(judged(&|recorder| recorder.layer_changed(0, setting)), None);
    assert_eq!(judged(&|recorder| recorder.triggered(0)), None);
    assert_eq!(judged(&|recorder| recorder.stream_started(1000)), None);
    assert_eq!(judged(&|recorder| recorder.scene_replaced(&program, &LIMITS).unwrap()), None);
    assert_eq!(recorder(&program, 40).take_judged(), None);
}
