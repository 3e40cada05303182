//! What ends the firmware leaves the output at zero, and the next hello says why.

use std::ops::ControlFlow;

use frixel_control::Drive;
use frixel_driver::Device;
use frixel_hil_sim::emulated::InjectedFault;
use frixel_wire::fault::Fault;
use frixel_wire::hello::{Hello, ResetCause};

use crate::bench::{Bench, program};
use crate::cable::Cable;
use crate::emulator;

/// Plays a scene, lets something happen, and returns the next hello.
fn suffer(fault: InjectedFault) -> Option<Hello> {
    let image = emulator::image()?;
    let bench = Bench::new(&image);
    let device = bench.play("constant.toml");
    bench.board.inject(fault).unwrap();
    bench.until("the output is off", |board| {
        board.starts().unwrap() == 2 && board.output().unwrap() == Drive::default()
    });
    assert_eq!(bench.board.output_at_start().unwrap(), Drive::default(), "off before the reset, not after it");
    drop(device);

    let mut device = Device::connect(Cable::plug(&bench.board)).unwrap();
    let hello = *device.hello();
    bench.pass(&mut device, 4_000);
    assert_eq!(bench.board.output().unwrap(), Drive::default(), "nothing starts by itself");
    frixel_play::start(&mut device, &program("constant.toml"), &mut |_| ControlFlow::Continue(())).unwrap();
    bench.until_driven(&mut device);
    Some(hello)
}

#[test]
fn a_panic_ends_the_drive_and_is_reported() {
    let Some(hello) = suffer(InjectedFault::Panic) else { return };
    assert_eq!((hello.reset_cause, hello.last_fault), (ResetCause::Software, Some(Fault::Panic)));
    assert_ne!(hello.fault_detail, 0, "the line");
}

#[test]
fn a_hard_fault_ends_the_drive_and_is_reported() {
    let Some(hello) = suffer(InjectedFault::HardFault) else { return };
    assert_eq!((hello.reset_cause, hello.last_fault), (ResetCause::Software, Some(Fault::HardFault)));
    assert!((0x48..0x8_0000).contains(&hello.fault_detail), "{:#x} is no place in the code", hello.fault_detail);
}

#[test]
fn a_stack_overflow_ends_the_drive_and_is_reported() {
    let Some(hello) = suffer(InjectedFault::StackOverflow) else { return };
    assert_eq!((hello.reset_cause, hello.last_fault), (ResetCause::Software, Some(Fault::StackOverflow)));
    assert!(hello.fault_detail < 0x2000_0000, "{:#x} is above the stack's bottom", hello.fault_detail);
}
