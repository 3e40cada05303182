//! A simulated board's line, and hosts that send more than their credit or do not read.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use crate::script;

use frixel_hil_sim::{RigConfig, Stroke, TickRecord};
use frixel_wire::fault::State;
use frixel_wire::frame::{Decoder, FRAME_MAX_LEN};
use frixel_wire::message::{Command, FromBoard, Request};
use frixel_wire::payload::{self, Payload};
use script::{HEADER, Script, constant, scene};

/// Ticks of the host timeout of the scene here.
const HOST_TIMEOUT_TICKS: u64 = 10_000;

fn playing() -> Script {
    let stroke = Stroke::sweep(0.12, 0.08, 60.0).unwrap();
    let mut script = Script::new(&RigConfig::default(), stroke, 1);
    script.play(&scene(&HEADER, &[constant(0.02)]));
    script
}

fn ping(sequence: u16) -> Vec<u8> {
    let mut frame = [0; FRAME_MAX_LEN];
    payload::request_frame(&Request { sequence, command: Command::Ping }, &mut frame).unwrap().to_vec()
}

/// A mebibyte of pings takes five seconds on the line. All but a window of it was sent without credit.
#[test]
fn a_client_that_ignores_credit_and_is_killed_keeps_nothing_playing() {
    let mut script = playing();
    let window = u64::from(RigConfig::default().board.limits.receive_window_bytes);
    script.rig.send(&ping(0).repeat((1 << 20) / 9));
    let killed_at = script.step().tick;
    let mut records: Vec<TickRecord> = (0..80_000).map(|_| script.step()).collect();
    let disarmed = records.iter().find(|record| record.status.telemetry.state == State::Disarmed).unwrap();
    let ticks = disarmed.tick - killed_at;
    // A window and a margin of 512 bytes, 5 in each tick.
    assert!(ticks <= (window + 512) / 5 + HOST_TIMEOUT_TICKS + 2, "{ticks}");
    let disarmed_at = disarmed.tick;
    records.retain(|record| record.tick >= disarmed_at);
    assert!(records.iter().all(|record| record.status.telemetry.dac_code == 0));
}

/// Answers always have their place: telemetry is what is left out.
#[test]
fn a_host_that_did_not_read_for_three_seconds_finds_every_answer() {
    let mut script = playing();
    script.command(Command::Subscribe { period_ticks: 40 });
    let mut bytes = Vec::new();
    script.rig.receive(&mut bytes);
    script.rig.set_host_away(true);
    for tick in 0..120_000_u32 {
        // Every 50 ms, 60 pings in all.
        if tick % 2_000 == 0 {
            script.rig.send(&ping(100 + (tick / 2_000) as u16));
        }
        script.step();
    }
    assert_eq!(script.step().status.telemetry.state, State::Active, "its pings did arrive");
    script.rig.set_host_away(false);
    for _ in 0..2_000 {
        script.step();
        script.rig.receive(&mut bytes);
    }
    let mut decoder = Decoder::new();
    let (mut answered, mut telemetry_ticks) = (Vec::new(), Vec::new());
    for byte in bytes {
        match decoder.push(byte).map(|frame| Payload::parse_from_board(frame).unwrap()) {
            Some(Payload::FromBoard(FromBoard::Answer(answer))) if answer.sequence >= 100 => {
                answered.push(answer.sequence);
            }
            Some(Payload::FromBoard(FromBoard::Telemetry(telemetry))) => {
                telemetry_ticks.push(telemetry.tick);
            }
            _ => {}
        }
    }
    assert_eq!(decoder.rejected(), 0);
    assert_eq!(answered, (100..160).collect::<Vec<u16>>());
    let gaps = telemetry_ticks.windows(2).filter(|ticks| ticks[1] - ticks[0] > 100_000).count();
    assert_eq!(gaps, 1, "telemetry was left out meanwhile, and goes on: {telemetry_ticks:?}");
}
