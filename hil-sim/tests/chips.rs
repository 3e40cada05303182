//! The drivers of `frixel-drivers` against models of their chips; the DAC's are in `dac.rs`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use std::collections::VecDeque;
use std::convert::Infallible;
use std::pin::pin;
use std::task::Poll;

use embedded_hal_async::i2c::{ErrorKind, I2c, NoAcknowledgeSource};
use embedded_io::{ErrorType, Read, ReadReady, Write, WriteReady};
use frixel_drivers::i2c_bus_clear::clear_bus;
use frixel_drivers::polling::poll_once;
use frixel_drivers::serial::BufferedSerial;
use frixel_drivers::zforce::{self, Touch, ZForce};
use frixel_hil_sim::chips::{HeldBus, PolledDelay, TouchEvent, Transfer, ZForceModule};

const NO_ACKNOWLEDGE: ErrorKind = ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address);

/// Polls until the future is ready, at most `polls` times.
fn poll_for<F: Future>(mut future: std::pin::Pin<&mut F>, polls: usize) -> Option<F::Output> {
    (0..polls).find_map(|_| match poll_once(future.as_mut()) {
        Poll::Ready(output) => Some(output),
        Poll::Pending => None,
    })
}

#[test]
fn the_touch_frame_is_set_up_and_reports_fingers() {
    let module = ZForceModule::new(3);
    let mut frame = ZForce::new(module.clone(), module.clone(), PolledDelay);
    {
        let mut touch = pin!(frame.next_touch());
        assert!(poll_for(touch.as_mut(), 1000).is_none(), "nobody touches it");
        assert_eq!(module.frequency_hz(), Some(200));
        module.touch(TouchEvent::Invalid, 1, 1);
        module.touch(TouchEvent::Down, 1234, 56);
        let Some(Ok(Touch::Down { x_m, y_m })) = poll_for(touch, 1000) else { panic!("no report") };
        assert!((x_m - 0.1234).abs() < 1e-6 && (y_m - 0.0056).abs() < 1e-6);
    }
    module.touch(TouchEvent::Move, 2000, 0);
    module.touch(TouchEvent::Up, 2000, 0);
    assert!(matches!(poll_for(pin!(frame.next_touch()), 1000), Some(Ok(Touch::Down { .. }))));
    assert_eq!(poll_for(pin!(frame.next_touch()), 1000), Some(Ok(Touch::Up)));
}

#[test]
fn a_touch_frame_that_restarts_is_set_up_again() {
    let module = ZForceModule::new(0);
    let mut frame = ZForce::new(module.clone(), module.clone(), PolledDelay);
    assert!(poll_for(pin!(frame.next_touch()), 100).is_none());
    module.restart();
    let mut touch = pin!(frame.next_touch());
    assert!(poll_for(touch.as_mut(), 100).is_none());
    module.touch(TouchEvent::Down, 10, 20);
    assert!(matches!(poll_for(touch, 100), Some(Ok(Touch::Down { .. }))));
}

#[test]
fn a_touch_frame_that_fails_is_left_alone_for_a_while_and_set_up_again() {
    let module = ZForceModule::new(0);
    module.connect(false);
    let mut frame = ZForce::new(module.clone(), module.clone(), PolledDelay);
    {
        let mut touch = pin!(frame.next_touch());
        assert!(poll_for(touch.as_mut(), 100).is_none(), "100 ms of pause");
        assert_eq!(poll_for(touch, 2), Some(Err(zforce::Error::I2c(NO_ACKNOWLEDGE))));
    }
    module.connect(true);
    assert!(poll_for(pin!(frame.next_touch()), 100).is_none());
    module.corrupt_length();
    module.touch(TouchEvent::Down, 10, 20);
    assert_eq!(poll_for(pin!(frame.next_touch()), 200), Some(Err(zforce::Error::Length([0xee, 0]))));
    module.forget_settings();
    let mut touch = pin!(frame.next_touch());
    assert!(poll_for(touch.as_mut(), 100).is_none());
    module.touch(TouchEvent::Up, 10, 20);
    assert_eq!(poll_for(touch, 100), Some(Ok(Touch::Up)));
}

/// A transfer aborted after any byte costs one pause, not one for every two remaining bytes. Messages that waited
/// meanwhile are outdated, and are not reported.
#[test]
fn a_report_that_was_read_in_part_is_skipped() {
    for len in 1..21 {
        let module = ZForceModule::new(0);
        let mut frame = ZForce::new(module.clone(), module.clone(), PolledDelay);
        assert!(poll_for(pin!(frame.next_touch()), 100).is_none());
        module.touch(TouchEvent::Down, 10, 20);
        module.touch(TouchEvent::Move, 20, 20);
        poll_for(pin!(module.clone().read(zforce::I2C_ADDRESS, &mut vec![0; len])), 1).unwrap().unwrap();
        let failed = poll_for(pin!(frame.next_touch()), 200);
        assert!(matches!(failed, Some(Err(zforce::Error::Length(_)))), "after {len} bytes: {failed:?}");
        let mut touch = pin!(frame.next_touch());
        assert!(poll_for(touch.as_mut(), 100).is_none(), "after {len} bytes");
        module.touch(TouchEvent::Up, 10, 20);
        assert_eq!(poll_for(touch, 100), Some(Ok(Touch::Up)), "after {len} bytes");
    }
}

/// After an outage of a second, reports from the outage are not used as the finger's place, however many wait.
#[test]
fn reports_of_a_long_outage_are_not_reported() {
    let module = ZForceModule::new(0);
    let mut frame = ZForce::new(module.clone(), module.clone(), PolledDelay);
    assert!(poll_for(pin!(frame.next_touch()), 100).is_none());
    module.connect(false);
    for x in 0..200 {
        module.touch(TouchEvent::Move, x, 20);
    }
    assert!(poll_for(pin!(frame.next_touch()), 200).is_some_and(|touch| touch.is_err()));
    module.connect(true);
    for _ in 0..3 {
        assert_eq!(poll_for(pin!(frame.next_touch()), 200), Some(Err(zforce::Error::Waiting)));
    }
    let mut touch = pin!(frame.next_touch());
    assert!(poll_for(touch.as_mut(), 100).is_none());
    module.touch(TouchEvent::Up, 10, 20);
    assert_eq!(poll_for(touch, 100), Some(Ok(Touch::Up)));
}

/// Clears a bus and returns whether that succeeded.
fn clear(bus: &HeldBus) -> bool {
    poll_for(pin!(clear_bus(&mut bus.clone(), &mut bus.clone(), &mut PolledDelay)), 1000).unwrap()
}

#[test]
fn nine_clocks_free_a_bus_that_a_reset_left_in_any_transfer() {
    let transfers = (0..=u8::MAX).map(Transfer::Sends).chain([Transfer::Receives, Transfer::Idle]);
    let mut held = 0;
    for (transfer, clock) in transfers.flat_map(|transfer| (0..9).map(move |clock| (transfer, clock))) {
        let bus = HeldBus::new(transfer, clock);
        held += usize::from(!HeldBus::new(transfer, clock).start());
        assert!(clear(&bus), "{transfer:?}, clock {clock}");
        assert!(bus.pulses() <= 9 && bus.start(), "{transfer:?}, clock {clock}");
    }
    assert!(held > 1000, "most of them could not begin a transfer before");
}

#[test]
fn a_bus_that_is_free_gets_no_clocks_and_one_that_is_shorted_is_reported() {
    let bus = HeldBus::new(Transfer::Idle, 0);
    assert!(clear(&bus) && bus.pulses() == 0);
    bus.short_sda();
    assert!(!clear(&bus) && bus.pulses() == 9);
}

/// A port that echoes received bytes, `room` bytes a tick.
#[derive(Default)]
struct Loopback {
    bytes: VecDeque<u8>,
    room: usize,
}

impl ErrorType for Loopback {
    type Error = Infallible;
}

impl ReadReady for Loopback {
    fn read_ready(&mut self) -> Result<bool, Infallible> {
        Ok(!self.bytes.is_empty())
    }
}

impl Read for Loopback {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        let len = bytes.len().min(self.bytes.len());
        for (to, from) in bytes.iter_mut().zip(self.bytes.drain(..len)) {
            *to = from;
        }
        Ok(len)
    }
}

impl WriteReady for Loopback {
    fn write_ready(&mut self) -> Result<bool, Infallible> {
        Ok(self.room > 0)
    }
}

impl Write for Loopback {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        let len = bytes.len().min(self.room);
        self.room -= len;
        self.bytes.extend(bytes.iter().take(len));
        Ok(len)
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

#[test]
fn a_slow_port_loses_and_repeats_nothing() {
    let mut link = BufferedSerial::new(Loopback::default());
    let sent: Vec<u8> = (0..3_000_u32).map(|number| (number % 251) as u8).collect();
    let (mut next, mut received) = (0, Vec::new());
    for tick in 0..3_000 {
        link.port_mut().room = [0, 1, 7, 64][tick % 4];
        let Ok(()) = link.transmit(|bytes| {
            let len = bytes.len().min(sent.len() - next).min(100);
            bytes[..len].copy_from_slice(&sent[next..next + len]);
            next += len;
            len
        });
        let Ok(()) = link.receive(|bytes| received.extend_from_slice(bytes));
    }
    assert_eq!(received, sent);
}
