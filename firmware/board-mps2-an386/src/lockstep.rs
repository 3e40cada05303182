//! Lockstep mode: the simulator sends ticks and reads the results. The same code runs without timer and serial port.

use core::sync::atomic::{Ordering, fence};

use frixel_control::{Status, Ticker};
use frixel_exchange::{TICK_BYTES_MAX, TickInput, TickOutput, layout};
use frixel_session::Session;

use crate::shared::{self, Cursor};

/// Runs one batch of ticks after the other.
pub fn run(session: &mut Session<'static>, mut ticker: Ticker<'static>) -> ! {
    let mut status = ticker.status();
    let mut batch = 0_u32;
    loop {
        batch = batch.wrapping_add(1);
        while shared::get(layout::BATCH_GIVEN) != batch {}
        fence(Ordering::Acquire);
        let (mut inputs, mut outputs) = (Cursor::at(layout::INPUTS), Cursor::at(layout::OUTPUTS));
        for _ in 0..shared::get(layout::BATCH_TICKS) {
            let input = TickInput::read(|| inputs.get());
            tick(session, &mut ticker, &mut status, &input).write(|word| outputs.set(word));
        }
        shared::publish(layout::BATCH_DONE, batch);
    }
}

/// Runs one tick, in the order of the in-process rig: bytes, touch, one order, tick, answers.
fn tick(
    session: &mut Session<'static>,
    ticker: &mut Ticker<'static>,
    status: &mut Status,
    input: &TickInput,
) -> TickOutput {
    if !input.received.is_empty() {
        session.receive(&input.received, status);
    }
    if let Some(touch) = input.touch {
        session.touch(touch, status.telemetry.tick.wrapping_add(1));
    }
    session.hand_order_to(ticker);
    let drive = ticker.tick(&input.sense);
    *status = ticker.status();
    session.poll(status);
    let mut bytes = [0; TICK_BYTES_MAX];
    let room = bytes.get_mut(..usize::from(input.room)).unwrap_or_default();
    let count = session.transmit(room);
    let sent = bytes.into_iter().take(count).collect();
    TickOutput { tick: status.telemetry.tick, drive, sent }
}
