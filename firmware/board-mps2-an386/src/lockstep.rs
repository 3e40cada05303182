//! Ticks that the simulator gives, and that answer to it: the same code with no timer and no serial port.

use core::sync::atomic::{Ordering, fence};

use frixel_exchange::{Done, Given, TICK_BYTES_MAX, layout};
use frixel_render::{Session, Status, Ticker};

use crate::shared::{self, Cursor};

/// Does one batch of ticks after the other.
pub fn run(session: &mut Session<'static>, mut ticker: Ticker<'static>) -> ! {
    let mut status = ticker.status();
    let mut batch = 0_u32;
    loop {
        batch = batch.wrapping_add(1);
        while shared::get(layout::BATCH_GIVEN) != batch {}
        fence(Ordering::Acquire);
        let (mut given, mut done) = (Cursor::at(layout::GIVEN), Cursor::at(layout::DONE));
        for _ in 0..shared::get(layout::BATCH_TICKS) {
            let given = Given::read(|| given.get());
            tick(session, &mut ticker, &mut status, &given).write(|word| done.set(word));
        }
        shared::publish(layout::BATCH_DONE, batch);
    }
}

/// One tick, in the order of the in-process rig: bytes, orders, tick, answers.
fn tick(session: &mut Session<'static>, ticker: &mut Ticker<'static>, status: &mut Status, given: &Given) -> Done {
    if !given.received.is_empty() {
        session.receive(&given.received, status);
    }
    // That of a commit comes a tick after its bytes.
    while let Some(order) = session.next_order() {
        if let Some(spare) = ticker.apply(order) {
            session.take_back(spare);
        }
    }
    let drive = ticker.tick(&given.sense);
    *status = ticker.status();
    session.poll(status);
    let mut bytes = [0; TICK_BYTES_MAX];
    let room = bytes.get_mut(..usize::from(given.room)).unwrap_or_default();
    let count = session.transmit(room);
    let sent = bytes.into_iter().take(count).collect();
    Done { tick: status.telemetry.tick, drive, sent }
}
