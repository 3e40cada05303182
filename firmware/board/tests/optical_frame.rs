//! The touch frame as a touch source of the main loop.

use std::cell::{Cell, RefCell};
use std::pin::pin;
use std::rc::Rc;
use std::task::Poll;

use embedded_hal_async::i2c::{ErrorKind, ErrorType, I2c, Operation};
use frixel_board::optical_frame::{BusError, FrameBus, I2cPort, OpticalFrame, Reports, TickTime, read};
use frixel_board::tick::TickShared;
use frixel_drivers::pin::{DirectPin, ReadLevel, SetLevel};
use frixel_drivers::polling::poll_once;
use frixel_drivers::zforce::{MESSAGE_MAX_LEN, ZForce};

use crate::support::firmware::BOARD;
use crate::support::hardware::run_tick;
use crate::support::played::Board;

const TICK_HZ: u32 = BOARD.tick_hz;

/// A bus on which no device answers.
struct Silent(Rc<Cell<u32>>);

impl ErrorType for Silent {
    type Error = ErrorKind;
}

impl I2c for Silent {
    async fn transaction(&mut self, _: u8, _: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        self.0.set(self.0.get() + 1);
        Err(ErrorKind::Other)
    }
}

struct Low;

impl ReadLevel for Low {
    fn is_high(&self) -> bool {
        false
    }
}

/// An unpowered frame is polled again every 0.1 s, in ticks, and the main loop never waits for it.
#[test]
fn a_silent_frame_is_polled_again_after_a_tenth_of_a_second() {
    let board = Board::new();
    let shared: &'static TickShared = board.shared;
    let (asked, errors) = (Rc::new(Cell::new(0)), Cell::new(0));
    let reports = Reports::new(None);
    let frame = ZForce::new(Silent(Rc::clone(&asked)), DirectPin(Low), TickTime { shared, tick_hz: TICK_HZ });
    let mut reading = pin!(read(frame, 400, &reports, |_| errors.set(errors.get() + 1)));
    let mut source = OpticalFrame::new(reading.as_mut(), &reports);
    let mut asked_at = Vec::new();
    while asked_at.len() < 4 {
        let before = asked.get();
        assert_eq!(source.next_touch(), None);
        if asked.get() > before {
            asked_at.push(shared.count());
        }
        run_tick();
        assert!(shared.count() < TICK_HZ, "{asked_at:?}");
    }
    assert!(asked_at.windows(2).all(|pair| (4_000..=4_002).contains(&(pair[1] - pair[0]))), "{asked_at:?}");
    assert_eq!(errors.get(), 3, "each is said after its pause");
}

/// Calls of a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PortCall {
    TakeClock,
    GiveClock,
    Stop,
    Begin(u8, usize),
    GiveUp,
}

/// A port with scripted answers.
struct Port {
    calls: RefCell<Vec<PortCall>>,
    /// Rising edges of SCL until SDA is high.
    held_for: Cell<u32>,
    /// Polls until it has stopped.
    stops_after: Cell<u32>,
    result: Cell<Poll<Result<(), BusError>>>,
}

type Handle = &'static Port;

/// A port that is free, stops at once, and transfers at once.
fn port() -> Handle {
    Box::leak(Box::new(Port {
        calls: RefCell::default(),
        held_for: Cell::new(0),
        stops_after: Cell::new(0),
        result: Cell::new(Poll::Ready(Ok(()))),
    }))
}

/// Counts a cell down.
fn count_down(count: &Cell<u32>) -> bool {
    let left = count.get();
    count.set(left.saturating_sub(1));
    left == 0
}

struct Clock(Handle);

impl SetLevel for Clock {
    fn set(&self, high: bool) {
        if high {
            count_down(&self.0.held_for);
        }
    }
}

struct Data(Handle);

impl ReadLevel for Data {
    fn is_high(&self) -> bool {
        self.0.held_for.get() == 0
    }
}

impl I2cPort for Handle {
    type Clock = DirectPin<Clock>;
    type Data = DirectPin<Data>;

    fn data(&self) -> DirectPin<Data> {
        DirectPin(Data(self))
    }

    fn take_clock(&mut self) -> DirectPin<Clock> {
        self.calls.borrow_mut().push(PortCall::TakeClock);
        DirectPin(Clock(self))
    }

    fn give_clock(&mut self) {
        self.calls.borrow_mut().push(PortCall::GiveClock);
    }

    fn stop(&mut self) {
        self.calls.borrow_mut().push(PortCall::Stop);
    }

    fn has_stopped(&mut self) -> bool {
        count_down(&self.stops_after)
    }

    fn begin(&mut self, address: u8, operation: &Operation<'_>) {
        let len = match operation {
            Operation::Read(bytes) => bytes.len(),
            Operation::Write(bytes) => bytes.len(),
        };
        self.calls.borrow_mut().push(PortCall::Begin(address, len));
    }

    fn poll(&mut self, operation: &mut Operation<'_>) -> Poll<Result<(), BusError>> {
        if let Operation::Read(bytes) = operation {
            bytes.fill(7);
        }
        self.result.get()
    }

    fn give_up(&mut self) {
        self.calls.borrow_mut().push(PortCall::GiveUp);
    }
}

/// Runs a transaction on a ticking board. Returns its result, the calls of the port, and its duration in ticks.
fn transaction(port: Handle, operations: &mut [Operation<'_>]) -> (Result<(), BusError>, Vec<PortCall>, u32) {
    let board = Board::new();
    let mut bus = FrameBus::new(port, TickTime { shared: board.shared, tick_hz: TICK_HZ });
    let mut future = pin!(bus.transaction(0x50, operations));
    for ticks in 0..TICK_HZ {
        if let Poll::Ready(result) = poll_once(future.as_mut()) {
            return (result, port.calls.take(), ticks);
        }
        run_tick();
    }
    panic!("it never ends")
}

#[test]
fn a_transfer_stops_the_peripheral_before_and_after() {
    let mut bytes = [0; 3];
    let calls = vec![PortCall::Stop, PortCall::Begin(0x50, 3), PortCall::Stop];
    assert_eq!(transaction(port(), &mut [Operation::Read(&mut bytes)]), (Ok(()), calls, 0));
    assert_eq!(bytes, [7; 3]);
}

#[test]
fn unneeded_transactions_are_refused_without_bus_activity() {
    let too_long = [0; MESSAGE_MAX_LEN + 1];
    let refused = (Err(BusError::Unsupported), vec![], 0);
    assert_eq!(transaction(port(), &mut []), refused);
    assert_eq!(transaction(port(), &mut [Operation::Write(&[])]), refused);
    assert_eq!(transaction(port(), &mut [Operation::Write(&too_long)]), refused);
    assert_eq!(transaction(port(), &mut [Operation::Write(&[1]), Operation::Write(&[2])]), refused);
}

/// A transfer that does not end is aborted after 6 ms. The bus is released.
#[test]
fn a_transfer_that_fails_or_does_not_end_is_abandoned_with_its_error() {
    let (acknowledge, arbitration) = (BusError::NoAcknowledge, BusError::ArbitrationLoss);
    for (polled, error, expected_ticks) in [
        (Poll::Ready(Err(acknowledge)), acknowledge, 0),
        (Poll::Ready(Err(arbitration)), arbitration, 0),
        (Poll::Pending, BusError::Timeout, TICK_HZ * 6 / 1000 + 1),
    ] {
        let port = port();
        port.result.set(polled);
        let calls = vec![PortCall::Stop, PortCall::Begin(0x50, 1), PortCall::GiveUp, PortCall::Stop];
        assert_eq!(transaction(port, &mut [Operation::Write(&[1])]), (Err(error), calls, expected_ticks));
    }
}

#[test]
fn a_bus_that_is_held_is_cleared_before_the_transfer() {
    let port = port();
    port.held_for.set(9);
    let (result, calls, _) = transaction(port, &mut [Operation::Write(&[1])]);
    assert_eq!(result, Ok(()));
    assert_eq!(
        calls,
        [PortCall::TakeClock, PortCall::GiveClock, PortCall::Stop, PortCall::Begin(0x50, 1), PortCall::Stop]
    );
    port.held_for.set(10);
    let (result, calls, _) = transaction(port, &mut [Operation::Write(&[1])]);
    assert_eq!(result, Err(BusError::BusHeld), "nine clocks do not free it");
    assert_eq!(calls, [PortCall::TakeClock, PortCall::GiveClock]);
}

/// A peripheral that still waits for the end of the last transfer ignores configuration.
#[test]
fn a_peripheral_that_does_not_stop_is_not_begun() {
    let port = port();
    port.stops_after.set(10);
    let (result, calls, ticks) = transaction(port, &mut [Operation::Write(&[1])]);
    assert_eq!((result, ticks), (Ok(()), 10));
    assert_eq!(calls, [PortCall::Stop, PortCall::Begin(0x50, 1), PortCall::Stop]);
    port.stops_after.set(u32::MAX);
    let (result, calls, ticks) = transaction(port, &mut [Operation::Write(&[1])]);
    assert_eq!((result, calls, ticks), (Err(BusError::BusHeld), vec![PortCall::Stop], TICK_HZ / 1000 + 1));
}
