//! The queues between a session in a main loop and a ticker in an interrupt.

use crate::support::{TestBoard, leaked};

use frixel_control::{Order, Sense};
use frixel_session::{Queues, Touch};
use frixel_wire::fault::State;

#[test]
fn orders_cross_one_by_one_and_none_is_lost_when_the_queue_is_full() {
    let TestBoard { mut session, mut ticker, .. } = TestBoard::new();
    let (mut session_ends, mut tick_ends) = leaked(Queues::new()).split();
    let mut passed = 0;
    // More tracks than the queue has places, while no tick runs.
    for tick in 0..20 {
        session.touch(Touch::Down { x_m: 0.01 + 1e-4 * tick as f32, y_m: 0.02, age_ticks: 0 }, 400 * tick);
        session_ends.exchange(&mut session, |order| passed += u32::from(matches!(order, Order::Track(_))));
    }
    let before = passed;
    assert!(before > 0 && tick_ends.has_order());
    for _ in 0..10 {
        tick_ends.apply_order(&mut ticker);
        ticker.tick(&Sense::default());
    }
    assert!(!tick_ends.has_order(), "the tick takes an order each time");
    session_ends.exchange(&mut session, |order| passed += u32::from(matches!(order, Order::Track(_))));
    assert!(passed > before, "the track that waited for room crosses afterwards");
}

#[test]
fn a_status_is_that_of_the_first_tick_after_the_one_before_was_taken() {
    let mut ticker = TestBoard::new().ticker;
    let (mut session_ends, mut tick_ends) = leaked(Queues::new()).split();
    assert!(session_ends.next_status().is_none());
    for taken_after in [1, 5] {
        let first = ticker.status().telemetry.tick + 1;
        for _ in 0..taken_after {
            ticker.tick(&Sense::default());
            tick_ends.offer_status(&ticker);
        }
        let status = session_ends.next_status().unwrap();
        assert_eq!((status.telemetry.tick, status.telemetry.state), (first, State::Disarmed));
        assert!(session_ends.next_status().is_none());
    }
}
