//! A client of the emulated board that sends more than its credit.

use std::fs::OpenOptions;
use std::io::Write;

use frixel_control::Drive;
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::{Command, Request};
use frixel_wire::payload;

use crate::bench::{Bench, HOST_TIMEOUT_TICKS};
use crate::emulator;

/// Bytes that a client pours without credit: 64 windows.
const FLOOD_LEN: usize = 1 << 18;

/// What is beyond the credit is no sign of life, so the board lets go of the client while it is still sending.
#[test]
fn a_client_that_pours_pings_and_reads_nothing_keeps_nothing_playing() {
    let Some(image) = emulator::image() else { return };
    let bench = Bench::new(&image);
    let device = bench.play("constant.toml");
    drop(device);

    let mut frame = [0; FRAME_MAX_LEN];
    let ping = payload::request_frame(&Request { sequence: 0, command: Command::Ping }, &mut frame).unwrap();
    let flood = ping.repeat(FLOOD_LEN / ping.len());
    let mut line = None;
    bench.until("the port is free", |board| {
        line = OpenOptions::new().write(true).open(board.serial_path()).ok();
        line.is_some()
    });
    let began = bench.board.tick().unwrap();
    line.unwrap().write_all(&flood).unwrap();
    let ended = bench.board.tick().unwrap();
    let records = bench.records();
    let last_driven = records.iter().rev().find(|record| record.drive != Drive::default()).unwrap();
    let ticks = last_driven.tick - began;
    let (flood_ticks, allowed) = (ended - began, HOST_TIMEOUT_TICKS + (ended - began) / 4);
    assert!(flood_ticks > 2 * HOST_TIMEOUT_TICKS, "the flood lasted for {flood_ticks} ticks only");
    assert!(ticks < allowed, "driven for {ticks} of the {flood_ticks} ticks that the flood lasted");
}
