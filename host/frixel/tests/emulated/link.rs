//! A host that hangs, on the emulated board. `scenarios.rs` has what else happens to the link.

use crate::bench::Bench;
use crate::emulator;

/// It is connected, and makes no call any more: the emulated clock waits for it for 10 s, and then runs on.
#[test]
fn a_host_that_hangs_puts_the_output_to_zero_after_the_wait_for_it() {
    let Some(image) = emulator::image() else { return };
    let bench = Bench::new(&image);
    let device = bench.play("constant.toml");
    bench.until_still("the clock stands still", |board| board.ticks().unwrap());
    bench.until("the host timeout acts", |board| !board.output().unwrap().amplifier_enable);
    assert!(device.counters().frames_sent > 0, "the host is still there");
}
