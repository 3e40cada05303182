//! Plays that end in any way, at any instruction: the output is zero in time, and stays zero after the next start.

use std::time::Duration;

use frixel_hil_sim::emulated::{Image, PicoRig, WireEvent};
use frixel_testkit::Random;
use frixel_wire::fault::{Fault, State};
use frixel_wire::hello::{Hello, ResetCause};

use super::bench::{BOARD, Bench, CONSTANT, TICK};
use crate::emulator;

/// The one-shot ends within this time after the last kick, which was in the last tick.
const ONE_SHOT_MAX: Duration = Duration::from_millis(1);
/// From a panic to the pins.
const PANIC_MAX: Duration = Duration::from_micros(100);
/// The watchdog's time: half a second by the fastest ring oscillator, 12 MHz; the emulator's has 6.5.
const WATCHDOG_MAX: Duration = Duration::from_millis(930);
/// The watchdog's time, and a start.
const RESTART_MAX: Duration = Duration::from_millis(1_130);
/// Cycles of the core between two ticks: the RP2040 has 200 MHz here.
const TICK_CYCLES: u32 = 200_000_000 / BOARD.tick_hz;
/// Instructions between a frame and the next, at least: one takes 25 / 16 cycles at most, as an average over a tick.
const INSTRUCTIONS: u32 = TICK_CYCLES * 16 / 25;

/// The way in which a play ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ending {
    /// The firmware panics.
    Panic,
    /// The processor reads an instruction where there is no memory.
    HardFault,
    /// The core stops, including its interrupts.
    Hang,
    /// The main loop hangs.
    HangingMainLoop,
    /// A person presses the reset button.
    RunPin,
    /// The power is cut, and returns.
    PowerCut,
}

impl Ending {
    const ALL: [Self; 6] =
        [Self::Panic, Self::HardFault, Self::Hang, Self::HangingMainLoop, Self::RunPin, Self::PowerCut];

    /// Causes it now.
    fn happen(self, rig: &mut PicoRig, seed: u32) {
        match self {
            Self::Panic => assert!(rig.jump_to("unreachable_state").unwrap(), "the image has a function that panics"),
            Self::HardFault => rig.jump(0x3000_0000).unwrap(),
            Self::Hang => rig.hang().unwrap(),
            Self::HangingMainLoop => rig.hang_main_loop().unwrap(),
            Self::RunPin => rig.pull_run_pin().unwrap(),
            Self::PowerCut => rig.power_cycle(seed).unwrap(),
        }
    }

    /// Longest time until the output is zero.
    fn zero_within(self) -> Duration {
        match self {
            Self::Panic | Self::HardFault => PANIC_MAX,
            Self::Hang => ONE_SHOT_MAX,
            // The tick goes on, and has no report of the finger any more: it trusts the last one for 40 ms.
            Self::HangingMainLoop => Duration::from_millis(41),
            // As soon as the board runs again, for which the rig needs no time.
            Self::RunPin | Self::PowerCut => TICK,
        }
    }

    /// Reset cause and fault in the next hello.
    fn reported(self) -> (ResetCause, Option<Fault>) {
        match self {
            Self::Panic => (ResetCause::Software, Some(Fault::Panic)),
            Self::HardFault => (ResetCause::Software, Some(Fault::HardFault)),
            Self::Hang | Self::HangingMainLoop => (ResetCause::Watchdog, Some(Fault::Watchdog)),
            Self::RunPin => (ResetCause::Pin, None),
            Self::PowerCut => (ResetCause::PowerOn, None),
        }
    }
}

/// Plays, ends the play at a random instruction, and returns the hello of the next start.
fn end_play(bench: &Bench, ending: Ending, random: &mut Random) -> Hello {
    let host = bench.play(CONSTANT);
    for _ in 0..random.below(20) {
        bench.step();
    }
    let starts = bench.with(|rig| {
        let is_before_next_frame = rig.run_instructions(1 + random.below(INSTRUCTIONS)).unwrap();
        assert!(is_before_next_frame, "the next frame ended before {INSTRUCTIONS} instructions");
        assert_eq!(rig.zero_since(), None, "the board drives");
        rig.starts()
    });
    let begin = bench.now();
    bench.take_events();
    bench.with(|rig| ending.happen(rig, random.below(1 << 30)));
    drop(host);
    let zero_since = loop {
        bench.step();
        if let Some(since) = bench.with(|rig| rig.zero_since()) {
            break since;
        }
        assert!(bench.now().saturating_sub(begin) < RESTART_MAX, "{ending:?}: the output is not zero");
    };
    let late = zero_since.saturating_sub(begin);
    assert!(late <= ending.zero_within(), "{ending:?}: the output was zero after {late:?}");
    while bench.with(|rig| rig.starts()) == starts {
        bench.step();
        assert!(bench.now().saturating_sub(begin) < RESTART_MAX, "{ending:?}: the board has not started again");
    }
    if matches!(ending, Ending::Panic | Ending::HardFault) {
        zeroed_by_firmware(bench, ending);
    }
    bench.pass(Duration::from_millis(100));
    assert_eq!(bench.with(|rig| rig.zero_since()), Some(zero_since), "{ending:?}: nothing starts by itself");
    *bench.connect().hello()
}

/// Expects that the firmware disabled the amplifier and cleared the DAC before the start that releases all pins.
fn zeroed_by_firmware(bench: &Bench, ending: Ending) {
    let events = bench.take_events();
    assert!(events.is_sorted_by_key(|stamped| stamped.at), "{ending:?}: {events:?}");
    let before_start = events.split(|stamped| matches!(stamped.event, WireEvent::Start(_))).next().unwrap_or_default();
    for zeroing in [WireEvent::Enable(false), WireEvent::Clear(false)] {
        let is_there = before_start.iter().any(|stamped| stamped.event == zeroing);
        assert!(is_there, "{ending:?}: no {zeroing:?} before the start, in {before_start:?}");
    }
}

/// Ends plays at random instructions, each on a board that was just switched on.
fn end_plays(image: &Image, ending: Ending, times: u64) {
    for seed in 0..times {
        let hello = end_play(&Bench::new(image), ending, &mut Random::new(1_000 * ending as u64 + seed));
        let expected = (ending.reported().0, ending.reported().1, State::Disarmed);
        assert_eq!((hello.reset_cause, hello.last_fault, hello.state), expected, "{ending:?}, seed {seed}");
    }
    // Shows the progress of a soak that is stopped early.
    println!("{ending:?}: {times} plays ended as they must");
}

#[test]
fn whatever_ends_a_play_leaves_the_output_at_zero() {
    let Some(image) = emulator::pico_image() else { return };
    for ending in Ending::ALL {
        end_plays(&image, ending, 1);
    }
}

/// A test for each ending, so that they run side by side.
macro_rules! at_any_of_a_hundred_instructions {
    ($($name:ident: $ending:expr, $times:literal;)+) => {$(
        #[test]
        #[ignore = "takes minutes: `cargo xtask soak pico`"]
        fn $name() {
            let Some(image) = emulator::pico_image() else { return };
            end_plays(&image, $ending, $times);
        }
    )+};
}

at_any_of_a_hundred_instructions! {
    a_power_cut_at_any_instruction_leaves_the_output_at_zero: Ending::PowerCut, 100;
    a_reset_at_any_instruction_leaves_the_output_at_zero: Ending::RunPin, 100;
    a_panic_at_any_instruction_leaves_the_output_at_zero: Ending::Panic, 100;
    a_hard_fault_at_any_instruction_leaves_the_output_at_zero: Ending::HardFault, 100;
    a_hang_at_any_instruction_leaves_the_output_at_zero: Ending::Hang, 100;
    a_hanging_main_loop_at_any_instruction_leaves_the_output_at_zero: Ending::HangingMainLoop, 20;
}

/// The image clocks its watchdog from the ring oscillator, which continues without the crystal.
///
/// The rig assumes that the watchdog counts while the chip's clock stands still. No data sheet states this, so the test
/// does not verify it for a real board.
#[test]
fn the_watchdog_is_given_the_ring_oscillator() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::new(&image);
    drop(bench.play(CONSTANT));
    let (begin, starts) = bench.with(|rig| {
        rig.stop_crystal().unwrap();
        (rig.now(), rig.starts())
    });
    while bench.with(|rig| rig.starts()) == starts {
        bench.step();
        let late = bench.now().saturating_sub(begin);
        assert!(late < WATCHDOG_MAX, "the board was not reset for {late:?}");
    }
    bench.pass(Duration::from_millis(100));
    assert!(bench.with(|rig| rig.zero_since()).is_some(), "nothing starts by itself");
    let hello = *bench.connect().hello();
    let expected = (ResetCause::Watchdog, Some(Fault::Watchdog), State::Disarmed);
    assert_eq!((hello.reset_cause, hello.last_fault, hello.state), expected);
}
