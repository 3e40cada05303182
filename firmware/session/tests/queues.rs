//! The queues between a session in a main loop and a ticker in an interrupt.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use frixel_control::{Active, Board, Order, Sense, Ticker};
use frixel_layers::BitmapPool;
use frixel_session::{Queues, Session, Touch};
use frixel_wire::fault::State;

fn leaked<T>(value: T) -> &'static mut T {
    Box::leak(Box::new(value))
}

fn board() -> (Session<'static>, Ticker<'static>) {
    let pool: &BitmapPool = leaked(BitmapPool::new());
    let board = Board::SIMULATOR;
    let ticker = Ticker::new(&board, pool, leaked(Active::new()));
    (Session::new(board, pool, leaked(Active::new())), ticker)
}

#[test]
fn orders_cross_one_by_one_and_none_is_lost_when_the_queue_is_full() {
    let (mut session, mut ticker) = board();
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
    let (_, mut ticker) = board();
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
