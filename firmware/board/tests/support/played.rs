//! A whole board: main loop and tick, and a host on the board that plays 10 V.

use std::rc::Rc;

use frixel_board::bring_up::Drive;
use frixel_board::main_loop::MainLoop;
use frixel_board::memory::BoardParts;
use frixel_board::tick::TickShared;
use frixel_session::Queues;
use frixel_wire::fault::State;
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::{Command, Request};
use frixel_wire::payload;

use super::firmware::{BOARD, firmware};
use super::hardware::{Event, Fake, Part, Wires, parts, run_tick, start, wires};

/// More ticks than it takes to play, two seconds.
const TICKS_MAX: u32 = 80_000;

/// A board whose tick belongs to this thread.
pub(crate) struct Board {
    pub(crate) main_loop: MainLoop<Fake>,
    pub(crate) wires: Rc<Wires>,
    pub(crate) shared: &'static TickShared,
    drive: Drive,
}

impl Board {
    /// A board that has just started, with its switch released.
    pub(crate) fn new() -> Self {
        let wires = wires();
        let shared: &TickShared = Box::leak(Box::new(TickShared::new::<Part>()));
        let (session, ticker) = firmware();
        let (session_ends, tick_ends) = Box::leak(Box::new(Queues::new())).split();
        let made = BoardParts { ticker, session: Box::leak(Box::new(session)), session_ends, tick_ends };
        let main_loop = parts(&wires, shared).start(
            made,
            shared,
            |tick| {
                wires.say(Event::TickStarted);
                start(tick);
            },
            || {
                wires.say(Event::WatchdogStarted);
                Part(Rc::clone(&wires))
            },
        );
        Self { main_loop, wires, shared, drive: Drive::new(10.0, &BOARD) }
    }

    /// A tick, and a turn of the main loop.
    pub(crate) fn step(&mut self) {
        run_tick();
        self.main_loop.turn(None);
    }

    /// As [`Self::step`], with the host on the board.
    pub(crate) fn step_with_host(&mut self) {
        self.step();
        let Self { main_loop, drive, shared, .. } = self;
        let result = drive.step(&main_loop.status, shared.count(), 0.0, main_loop.session);
        assert!(result.is_none_or(|result| result.is_err()), "it drives for three seconds");
    }

    /// Puts a command on the serial port, which the next turn takes.
    pub(crate) fn receive(&mut self, command: Command) {
        let mut frame = [0; FRAME_MAX_LEN];
        let request = Request { sequence: 1, command };
        self.wires.received.borrow_mut().extend(payload::request_frame(&request, &mut frame).unwrap());
    }

    /// The state after the last turn.
    pub(crate) fn state(&self) -> State {
        self.main_loop.status.telemetry.state
    }

    /// Runs a board whose switch is held until `done`.
    pub(crate) fn until(done: impl Fn(&Self) -> bool) -> Self {
        let mut board = Self::new();
        for _ in 0..BOARD.tick_hz / 100 {
            board.step();
        }
        board.wires.switch_closed.set(true);
        for _ in 0..BOARD.tick_hz / 10 {
            board.step();
        }
        board.wires.take();
        while !done(&board) {
            board.step_with_host();
            assert!(board.shared.count() < TICKS_MAX, "it waits in vain, {}", board.state());
        }
        board
    }

    /// A board that plays, with an output that is not zero.
    pub(crate) fn playing() -> Self {
        let is_driven = |event: &Event| matches!(event, Event::Sent(code) if code.bits() != 0);
        let board = Self::until(|board| board.wires.events.borrow().iter().any(is_driven));
        board.wires.take();
        board
    }
}
