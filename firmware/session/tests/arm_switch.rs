//! The arm switch: to arm, a person presses it and holds it (`PROTOCOL.md` section 10, "States").
#![allow(clippy::large_stack_arrays, reason = "a test has room for a board's memory")]

use frixel_control::{Active, Board, Order, Sense, Ticker};
use frixel_layers::BitmapPool;
use frixel_wire::fault::{Fault, State};

const RELEASED: Sense = Sense { amplifier_fault: false, monitor_v: 0.0, arm_switch: false };
const HELD: Sense = Sense { arm_switch: true, ..RELEASED };

/// Name of the case, and the action that disarms the board.
type Disarming = (&'static str, fn(&mut Ticker));

/// A person presses the switch, and the host arms.
fn press_and_arm(ticker: &mut Ticker) {
    ticker.tick(&RELEASED);
    ticker.tick(&HELD);
    ticker.apply(Order::HostHeard);
    ticker.apply(Order::Arm);
    ticker.tick(&HELD);
    assert_eq!(ticker.state(), State::Armed);
}

/// A switch that is welded, or taped down, or held by habit, does not arm.
#[test]
fn after_every_disarming_the_switch_must_be_pressed_again() {
    let disarm: [Disarming; 3] = [
        ("by the host", |ticker| {
            ticker.apply(Order::Disarm);
        }),
        ("by a silent host", |ticker| {
            for _ in 0..=10_001 {
                ticker.tick(&HELD);
            }
        }),
        ("by a fault that was cleared", |ticker| {
            ticker.raise(Fault::Deadline, 1);
            ticker.apply(Order::ClearFault);
        }),
    ];
    for (how, disarm) in disarm {
        let (pool, mut active) = (Box::new(BitmapPool::new()), Box::new(Active::new()));
        let mut ticker = Ticker::new(&Board::SIMULATOR, &pool, &mut active);
        press_and_arm(&mut ticker);
        disarm(&mut ticker);
        ticker.tick(&HELD);
        assert_eq!(ticker.state(), State::Disarmed, "{how}");
        assert!(!ticker.status().arm_switch, "{how}");
        ticker.apply(Order::Arm);
        ticker.tick(&HELD);
        assert_eq!(ticker.state(), State::Disarmed, "{how}");
        press_and_arm(&mut ticker);
    }
}
