//! The arm switch: to arm, a person presses it and holds it (`PROTOCOL.md` section 10, "States").
#![allow(clippy::large_stack_arrays, reason = "a test has room for a board's memory")]

use frixel_control::{Active, Board, Order, Sense, Ticker};
use frixel_layers::BitmapPool;
use frixel_wire::fault::{Fault, State};

const RELEASED: Sense = Sense { amplifier_fault: false, monitor_v: 0.0, arm_switch: false };
const HELD: Sense = Sense { arm_switch: true, ..RELEASED };

fn memory() -> (Box<BitmapPool>, Box<Active>) {
    (Box::new(BitmapPool::new()), Box::new(Active::new()))
}

/// A switch that is welded, or taped down, or held by habit, does not arm.
#[test]
fn a_switch_held_since_the_reset_does_not_arm() {
    let (pool, mut active) = memory();
    let mut ticker = Ticker::new(&Board::SIMULATOR, &pool, &mut active);
    for _ in 0..1000 {
        ticker.tick(&HELD);
    }
    assert!(!ticker.status().arm_switch);
    ticker.apply(Order::Arm);
    ticker.tick(&HELD);
    assert_eq!(ticker.state(), State::Disarmed);
    ticker.tick(&RELEASED);
    ticker.tick(&HELD);
    assert!(ticker.status().arm_switch);
    ticker.apply(Order::Arm);
    ticker.tick(&HELD);
    assert_eq!(ticker.state(), State::Armed);
}

/// Name of the case, and the action that disarms the board.
type Disarming = (&'static str, fn(&mut Ticker));

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
        let (pool, mut active) = memory();
        let mut ticker = Ticker::new(&Board::SIMULATOR, &pool, &mut active);
        ticker.tick(&RELEASED);
        ticker.tick(&HELD);
        ticker.apply(Order::HostHeard);
        ticker.apply(Order::Arm);
        ticker.tick(&HELD);
        assert_eq!(ticker.state(), State::Armed, "{how}");
        disarm(&mut ticker);
        ticker.tick(&HELD);
        assert_eq!(ticker.state(), State::Disarmed, "{how}");
        assert!(!ticker.status().arm_switch, "{how}");
        ticker.apply(Order::Arm);
        ticker.tick(&HELD);
        assert_eq!(ticker.state(), State::Disarmed, "{how}");
        ticker.tick(&RELEASED);
        ticker.tick(&HELD);
        ticker.apply(Order::HostHeard);
        ticker.apply(Order::Arm);
        ticker.tick(&HELD);
        assert_eq!(ticker.state(), State::Armed, "{how}");
    }
}
