//! The tick of every board: its frames, its deadline, and faults found outside the tick.

use frixel_wire::fault::{Fault, State};
use frixel_wire::message::Command;

use crate::support::hardware::{DEADLINE_CYCLES, Event, PERIOD_CYCLES};
use crate::support::played::Board;

/// The events of the last tick, without those of the main loop.
fn of_tick(board: &Board) -> Vec<Event> {
    let is_of_tick = |event: &Event| matches!(event, Event::Sent(_) | Event::Kicked | Event::Disabled);
    board.wires.take().into_iter().filter(is_of_tick).collect()
}

fn is_zero(event: &Event) -> bool {
    matches!(event, Event::Sent(code) if code.bits() == 0)
}

/// The fault, its detail, and the number of missed deadlines, as reported to the main loop.
fn fault(board: &Board) -> (Option<(Fault, u32)>, u32) {
    let status = &board.main_loop.status;
    (status.fault, status.counters.missed_deadlines)
}

#[test]
fn a_playing_tick_sends_its_code_and_then_kicks_the_enable() {
    let mut board = Board::playing();
    board.step();
    assert!(matches!(of_tick(&board)[..], [Event::Sent(_), Event::Kicked]));
}

/// The monitor soon follows the code that the DAC has just output. A test on the Pico's rig checks that no order is
/// applied first either.
#[test]
fn a_tick_reads_the_monitor_before_it_counts() {
    let mut board = Board::playing();
    for _ in 0..10 {
        let before = board.shared.count();
        board.step();
        assert_eq!(board.shared.count(), before + 1);
        assert_eq!(board.wires.ticks_at_reading.get(), before, "the inputs come first");
    }
}

#[test]
fn a_board_that_was_not_armed_sends_zero_and_keeps_the_amplifier_off() {
    let mut board = Board::new();
    for tick in 1..=100 {
        board.step();
        assert_eq!(board.shared.count(), tick);
        assert!(matches!(&of_tick(&board)[..], [sent, Event::Disabled] if is_zero(sent)));
    }
}

#[test]
fn a_late_frame_disables_the_amplifier_and_is_one_fault() {
    for overruns in [false, true] {
        let mut board = Board::playing();
        board.wires.is_late.set(true);
        board.wires.cycles.set(DEADLINE_CYCLES + 1);
        board.wires.overruns.set(overruns);
        board.step();
        assert_eq!(of_tick(&board), [Event::Disabled], "nothing is sent, and nothing is kicked");
        board.wires.is_late.set(false);
        board.wires.cycles.set(1_000);
        board.wires.overruns.set(false);
        board.step();
        assert!(matches!(&of_tick(&board)[..], [sent, Event::Disabled] if is_zero(sent)));
        board.step();
        assert_eq!(board.state(), State::Faulted);
        assert_eq!(fault(&board), (Some((Fault::Deadline, DEADLINE_CYCLES + 1)), 1), "overruns {overruns}");
    }
}

/// The frame was sent in time, but the tick ends in the next period: the kicked enable is disabled again.
#[test]
fn a_tick_that_overruns_disables_the_amplifier_and_is_a_fault() {
    let mut board = Board::playing();
    board.wires.overruns.set(true);
    board.wires.cycles.set(17);
    board.step();
    assert!(matches!(of_tick(&board)[..], [Event::Sent(_), Event::Kicked, Event::Disabled]));
    board.wires.overruns.set(false);
    board.step();
    assert!(matches!(&of_tick(&board)[..], [sent, Event::Disabled] if is_zero(sent)));
    board.step();
    assert_eq!(fault(&board), (Some((Fault::Deadline, PERIOD_CYCLES + 17)), 1));
}

/// While the main loop has the DAC's bus, the tick sends nothing.
#[test]
fn a_frame_that_is_not_allowed_keeps_the_amplifier_off() {
    let mut board = Board::new();
    board.step();
    board.wires.take();
    let wires = board.wires.clone();
    board.shared.bus.while_frames_rest(crate::support::hardware::run_tick, || {
        wires.take();
        for _ in 0..5 {
            crate::support::hardware::run_tick();
        }
        assert_eq!(wires.take(), [Event::Disabled; 5]);
    });
    assert!(matches!(&of_tick(&board)[..], [sent, Event::Disabled] if is_zero(sent)), "frames go on");
}

#[test]
fn a_playing_tick_does_not_hand_over_the_bus() {
    let mut board = Board::playing();
    let mut polls = 0;
    let mut until_stopped = || {
        crate::support::hardware::run_tick();
        polls += 1;
        // A lift, or any other end of the output; here the amplifier's ready line falls.
        if polls == 10 {
            board.wires.ready.set(false);
        }
    };
    board.shared.bus.while_frames_rest(&mut until_stopped, || ());
    let sent_before: usize = of_tick(&board).iter().take_while(|event| **event != Event::Disabled).count();
    assert_eq!(sent_before, 22, "eleven codes, eleven kicks: a single low sample is no fault");
    board.step();
}

#[test]
fn a_fault_that_the_main_loop_finds_stops_the_next_tick() {
    let mut board = Board::playing();
    // The detail has 24 bits.
    board.shared.raise(Fault::Dac, 0xff12_3456);
    board.step();
    assert!(matches!(&of_tick(&board)[..], [sent, Event::Disabled] if is_zero(sent)));
    board.step();
    assert_eq!((board.state(), fault(&board)), (State::Faulted, (Some((Fault::Dac, 0x12_3456)), 0)));
    // It is raised only once: it does not return after the host clears it.
    board.receive(Command::ClearFault);
    for _ in 0..10 {
        board.step();
    }
    assert_eq!(board.state(), State::Disarmed);
}

#[test]
fn an_amplifier_that_is_not_ready_and_a_switch_that_opens_are_sensed() {
    let ready = |board: &Board| board.wires.ready.set(false);
    let switch = |board: &Board| board.wires.switch_closed.set(false);
    for (happens, expected) in [(&ready as &dyn Fn(&Board), Fault::Amplifier), (&switch, Fault::ArmSwitch)] {
        let mut board = Board::playing();
        happens(&board);
        // The switch counts as released after 0.8 ms, 32 ticks.
        for _ in 0..34 {
            board.step();
        }
        assert!(matches!(fault(&board).0, Some((found, _)) if found == expected), "{expected}: {:?}", fault(&board));
    }
}

#[test]
fn ticks_are_counted_with_the_time_until_their_drive_is_known() {
    let mut board = Board::new();
    for (cycles, overruns) in [(1_000, false), (3_000, false), (17, true)] {
        board.wires.cycles.set(cycles);
        board.wires.overruns.set(overruns);
        board.step();
    }
    let times = board.shared.meter.times(0);
    assert_eq!((times.deadline_cycles, times.worst_cycles), (DEADLINE_CYCLES, PERIOD_CYCLES + 17));
    assert_eq!(times.histogram.iter().sum::<u32>(), 3);
}
