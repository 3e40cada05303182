//! The link: hello, upload, play and stop over the emulated serial port, rubbish in between, a cable that is cut,
//! and a host that hangs.

use std::ops::ControlFlow;

use frixel_control::Drive;
use frixel_driver::Device;
use frixel_wire::fault::State;
use frixel_wire::hello::{BoardKind, ResetCause};

use crate::bench::{Bench, HOST_TIMEOUT_TICKS, program};
use crate::cable::Cable;
use crate::emulator;

/// Ticks of the millisecond within which a board acts on the host timeout (docs/safety.md). The last frame is heard
/// after 2 to 6: a turn of the main loop takes one or two, and a sign of life waits for one order of the finger.
const HEARD_WITHIN_TICKS: u32 = 40;

#[test]
fn a_picture_goes_up_plays_and_stops() {
    let Some(image) = emulator::image() else { return };
    let bench = Bench::new(&image);
    let program = program("brick.toml");
    let mut device = Device::connect(Cable::plug(&bench.board)).unwrap();
    let hello = *device.hello();
    assert_eq!(hello.board, BoardKind::Mps2An386);
    assert_eq!((hello.reset_cause, hello.last_fault, hello.state), (ResetCause::PowerOn, None, State::Disarmed));

    frixel_play::start(&mut device, &program, &mut |_| ControlFlow::Continue(())).unwrap();
    // Where the finger is when the picture has arrived depends on the machine; it comes over bright mortar soon.
    bench.until_felt(&mut device, 0.06);
    device.stop().unwrap();
    bench.pass(&mut device, 10);
    assert_eq!(bench.board.output().unwrap(), Drive::default());

    let driven: Vec<_> = bench.records().into_iter().filter(|record| record.drive.amplifier_enable).collect();
    let felt_n = driven.iter().map(|record| record.felt.electric_friction_n).fold(0.0, f64::max);
    assert!((0.06..0.115).contains(&felt_n), "the brick's mortar feels like 60 to 112 mN, not {felt_n} N");
}

#[test]
fn rubbish_between_frames_does_no_harm() {
    let Some(image) = emulator::image() else { return };
    let bench = Bench::new(&image);
    // Truncated, oversized, zeros only, and what looks like a frame but for its CRC.
    let rubbish = vec![vec![7, 1, 2, 0], [vec![0x55; 700], vec![0]].concat(), vec![0, 0, 0], vec![2, 9, 3, 8, 8, 0]];
    let mut device = Device::connect(Cable::plug(&bench.board).with_rubbish(rubbish)).unwrap();
    frixel_play::start(&mut device, &program("grating.toml"), &mut |_| ControlFlow::Continue(())).unwrap();
    bench.until_driven(&mut device);
    device.stop().unwrap();
    assert_eq!(device.counters().frames_rejected, 0, "the board's own frames arrive whole");
}

#[test]
fn a_cut_cable_puts_the_output_to_zero_within_the_host_timeout() {
    let Some(image) = emulator::image() else { return };
    let bench = Bench::new(&image);
    let device = bench.play("constant.toml");
    drop(device);
    bench.until("the board falls silent", |board| {
        board.tick().unwrap().wrapping_sub(board.received_at_tick().unwrap()) > HOST_TIMEOUT_TICKS + 1_000
    });
    let last_byte = bench.board.received_at_tick().unwrap();
    let records = bench.records();
    let last_driven = records.iter().rev().find(|record| record.drive != Drive::default()).unwrap();
    let ticks = last_driven.tick - last_byte;
    assert!(ticks <= HOST_TIMEOUT_TICKS + HEARD_WITHIN_TICKS, "driven for {ticks} ticks after the last byte");
    assert!(ticks >= HOST_TIMEOUT_TICKS, "driven for {ticks} ticks only");

    let hello = *Device::connect(Cable::plug(&bench.board)).unwrap().hello();
    assert_eq!((hello.state, hello.last_fault), (State::Disarmed, None));
}

/// It is connected, and makes no call any more: the emulated clock waits for it for 10 s, and then runs on.
#[test]
fn a_host_that_hangs_puts_the_output_to_zero_after_the_wait_for_it() {
    let Some(image) = emulator::image() else { return };
    let bench = Bench::new(&image);
    let device = bench.play("constant.toml");
    bench.until("the clock stands still", |board| {
        let ticks = board.ticks().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(50));
        board.ticks().unwrap() == ticks
    });
    bench.until("the host timeout acts", |board| !board.output().unwrap().amplifier_enable);
    assert!(device.counters().frames_sent > 0, "the host is still there");
}
