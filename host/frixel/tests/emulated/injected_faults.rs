//! Faults that end the firmware leave the output at zero, and the next hello has the reason.

use std::time::Duration;

use frixel_control::Drive;
use frixel_hil_sim::emulated::InjectedFault;
use frixel_wire::fault::{Fault, State};
use frixel_wire::hello::{BoardKind, Hello, ResetCause};

use crate::bench::Bench;
use crate::emulator;

/// Plays a scene, injects a fault, and returns the next hello. The board has started `starts` times before.
fn hello_after(fault: InjectedFault, bench: &Bench, starts: u32) -> Hello {
    let device = bench.play("constant.toml");
    bench.board.inject(fault).unwrap();
    bench.until("the output is off", |board| {
        board.starts().unwrap() == starts + 1 && board.output().unwrap() == Drive::default()
    });
    assert_eq!(bench.board.output_at_start().unwrap(), Drive::default(), "off before the reset, not after it");
    drop(device);

    let mut device = bench.connect();
    let hello = *device.hello();
    device.wait(Duration::from_millis(100), &mut |_| ()).unwrap();
    assert_eq!(bench.board.output().unwrap(), Drive::default(), "nothing starts by itself");
    hello
}

/// The board plays again after each fault.
#[test]
fn what_ends_the_firmware_ends_the_drive_and_is_reported() {
    let Some(image) = emulator::image() else { return };
    let bench = Bench::new(&image);
    let hello = *bench.connect().hello();
    assert_eq!((hello.board, hello.reset_cause), (BoardKind::Mps2An386, ResetCause::PowerOn));
    assert_eq!((hello.state, hello.last_fault), (State::Disarmed, None));
    let expected = [
        (InjectedFault::Panic, Fault::Panic),
        (InjectedFault::HardFault, Fault::HardFault),
        (InjectedFault::StackOverflow, Fault::StackOverflow),
    ];
    for (starts, (injected, fault)) in (1..).zip(expected) {
        let hello = hello_after(injected, &bench, starts);
        assert_eq!((hello.reset_cause, hello.last_fault), (ResetCause::Software, Some(fault)), "{injected:?}");
        let detail = hello.fault_detail;
        match fault {
            Fault::Panic => assert_ne!(detail, 0, "the line"),
            Fault::HardFault => assert!((0x48..0x8_0000).contains(&detail), "{detail:#x} is no place in the code"),
            Fault::StackOverflow => assert!(detail < 0x2000_0000, "{detail:#x} is above the stack's bottom"),
            other => panic!("{other:?} is not expected"),
        }
    }
    drop(bench.play("constant.toml"));
}
