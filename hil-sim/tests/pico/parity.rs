//! The codes of the DAC are those of the in-process rig, bit for bit.
//!
//! The two rigs hear their host at different ticks: a line of 2 Mbaud, a main loop and a queue lie between the host and
//! the Pico's tick. So the in-process rig is given each touch report at that of some ticks at which the codes then agree.
//! A wrong bit in the computation makes them disagree at all of these ticks.

use std::time::Duration;

use frixel_hil_sim::{RigConfig, Stroke, WorldConfig};
use frixel_session::Touch;
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::{Command, Request};
use frixel_wire::payload;

use super::bench::{BOARD, Bench, CONSTANT, program};
use crate::emulator;
use crate::script::Script;

/// Ticks by which the first report may come later after the command to play: more than a period of the carrier, whose
/// phase begins there.
const PHASES: u64 = 24;
/// Ticks before and after the tick at which a report is sent among which the in-process rig is given it.
const GIVEN_FROM: i64 = -4;
const GIVEN_TO: i64 = 16;
/// Ticks after a report in which the in-process rig may be ahead by that report: it takes it in the tick in which it is
/// given, the Pico once its main loop has computed the track.
const AHEAD_TICKS: usize = 5;
/// Ticks between two pings.
const PING_TICKS: usize = 500;

/// A report, with the tick at which it is sent.
type Sent = (i64, Touch);

/// What the Pico did: its codes from the first one on that is not zero, and the reports, at ticks from there on.
struct Played {
    codes: Vec<i16>,
    reports: Vec<Sent>,
}

/// Plays a scene on the Pico.
fn play(bench: &Bench, text: &str, time: Duration) -> Played {
    let mut host = bench.connect();
    bench.take_records();
    bench.start(&mut host, text);
    host.wait(time, &mut |_| ()).unwrap();
    let codes: Vec<i16> = bench.take_records().iter().map(|record| record.drive.dac_code.bits()).collect();
    let first = codes.iter().position(|code| *code != 0).unwrap();
    let reports = bench.take_reports().into_iter().map(|(tick, touch)| (tick as i64 - first as i64, touch)).collect();
    Played { codes: codes[first..].to_vec(), reports }
}

/// The codes of the in-process rig from the first one on that is not zero. It is given the first report so many ticks
/// after the command to play, and the others at ticks that count from that first code on.
fn in_process(text: &str, phase: u64, given: &[Sent], ticks: usize) -> Vec<i16> {
    // A fast line: what is given in a tick is heard in that tick.
    let config = RigConfig { board: BOARD, world: WorldConfig::of(&BOARD), baud: 1_000_000_000 };
    let mut script = Script::new(&config, Stroke::sweep(0.12, 0.08, 600.0).unwrap(), 1);
    script.play(&program(text).scene_bytes());
    script.rig.world_mut().lift_finger();
    script.run(phase);
    let ([(_, first), others @ ..], mut codes) = (given, Vec::new()) else { return Vec::new() };
    report(&mut script, *first);
    while codes.len() < ticks {
        for (_, touch) in others.iter().filter(|(at, _)| *at == codes.len() as i64) {
            report(&mut script, *touch);
        }
        if codes.len() % PING_TICKS == 1 {
            script.send(Command::Ping);
        }
        let code = script.step().status.telemetry.dac_code;
        if code != 0 || !codes.is_empty() {
            codes.push(code);
        }
        assert!(script.rig.tick() < 100_000, "it never drives");
    }
    codes
}

fn report(script: &mut Script, touch: Touch) {
    let Touch::Down { x_m, y_m, age_ticks } = touch else { return script.send(Command::Lift) };
    let mut buffer = [0; FRAME_MAX_LEN];
    let request = Request { sequence: 0, command: Command::Touch { x_m, y_m, age_ticks: age_ticks as u16 } };
    script.rig.send(payload::request_frame(&request, &mut buffer).unwrap());
}

/// Number of the first codes that are the same but for those just after a report.
fn agreement(found: &[i16], expected: &[i16], given: &[Sent]) -> usize {
    let is_ahead = |tick: usize| given.iter().any(|(at, _)| (0..=AHEAD_TICKS as i64).contains(&(tick as i64 - at)));
    let pairs = found.iter().zip(expected).enumerate();
    pairs.take_while(|(tick, (one, other))| one == other || is_ahead(*tick)).count()
}

/// Finds ticks at which the in-process rig is given the reports so that the first codes agree for as long as possible.
fn longest_agreement(text: &str, played: &Played) -> usize {
    let Played { codes, reports } = played;
    let first = &reports[..1];
    let phase = (0..PHASES).max_by_key(|phase| agreement(codes, &in_process(text, *phase, first, codes.len()), first));
    let (phase, mut given) = (phase.unwrap(), first.to_vec());
    for (sent_at, touch) in &reports[1..] {
        let with = |at: i64| [&given[..], &[(at, *touch)]].concat();
        let best = (sent_at + GIVEN_FROM..sent_at + GIVEN_TO)
            .max_by_key(|at| agreement(codes, &in_process(text, phase, &with(*at), codes.len()), &with(*at)));
        given = with(best.unwrap());
    }
    agreement(codes, &in_process(text, phase, &given, codes.len()), &given)
}

/// A friction that does not depend on the place, so that no report but the first one matters.
#[test]
fn a_constant_has_the_codes_of_the_in_process_rig() {
    let Some(image) = emulator::pico_image() else { return };
    let played = play(&Bench::new(&image), CONSTANT, Duration::from_millis(320));
    let ticks = played.codes.len();
    assert!(ticks > 2_400 && played.codes.iter().all(|code| *code != 0), "it drives all the time");
    let found = (0..PHASES).map(|phase| {
        let expected = in_process(CONSTANT, phase, &played.reports, ticks);
        played.codes.iter().zip(&expected).take_while(|(one, other)| one == other).count()
    });
    assert_eq!(found.max(), Some(ticks), "all codes are the same");
}

/// Stripes under a sliding finger: every code depends on the finger's track.
#[test]
fn stripes_have_the_codes_of_the_in_process_rig() {
    const STRIPES: &str = "version = 2\n[[layer]]\nkind = \"grating\"\nwave = \"sine\"\nwavelength_mm = 3\n\
                           low_fraction = 0.1\nhigh_fraction = 0.9\n";
    let Some(image) = emulator::pico_image() else { return };
    let played = play(&Bench::new(&image), STRIPES, Duration::from_millis(150));
    let ticks = played.codes.len();
    assert!(ticks > 1_100, "it drives all the time");
    let same = longest_agreement(STRIPES, &played);
    assert_eq!(same, ticks, "the first {same} codes are the same");
}
