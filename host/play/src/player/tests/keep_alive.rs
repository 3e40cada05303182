//! A link that also pings while the program makes no call, as a serial port does by its thread.

use frixel_driver::{KEEP_ALIVE_TIMEOUT, KeepAlive, Written};

use super::*;

/// The line to a simulated board, pinged in every tick that needs it, whatever the program does.
struct Threaded {
    line: Line,
    pings: KeepAlive,
    written: Written,
    received: Vec<u8>,
}

impl Threaded {
    fn new(line: Line) -> Self {
        let mut pings = KeepAlive::default();
        pings.leave_call(Duration::ZERO);
        Self { line, pings, written: Written::default(), received: Vec::new() }
    }

    fn tick(&mut self) {
        let now = self.line.now();
        if self.pings.due_at(now).is_some_and(|due| due <= now) {
            let ping = self.pings.next_ping(now);
            self.send(&ping);
        }
        self.line.rig.step();
        let before = self.received.len();
        self.line.rig.receive(&mut self.received);
        self.pings.hear(&self.received[before..], now);
    }

    fn send(&mut self, bytes: &[u8]) {
        self.line.rig.send(bytes);
        self.written.add(bytes);
    }

    /// The program makes no call for so long.
    fn hang(&mut self, duration: Duration) {
        let end = self.now() + duration;
        while self.now() < end {
            self.tick();
        }
    }
}

impl Link for Threaded {
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed> {
        self.send(frame);
        self.pings.wrote(self.line.now());
        self.pings.leave_call(self.line.now());
        Ok(self.written.bytes)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        self.pings.enter_call();
        let end = self.now() + wait;
        while self.received.is_empty() && self.now() < end {
            self.tick();
        }
        self.pings.leave_call(self.now());
        buffer.append(&mut self.received);
        Ok(())
    }

    fn now(&self) -> Duration {
        self.line.now()
    }

    fn keep_alive(&mut self, period: Duration) {
        self.pings.set_period(period);
    }

    fn written(&self) -> Written {
        self.written
    }

    fn name(&self) -> &str {
        self.line.name()
    }
}

impl Recorded for Threaded {
    type Recorder = Told;

    fn recorder_mut(&mut self) -> &mut Told {
        &mut self.line.told
    }
}

#[test]
fn a_program_that_calls_keeps_its_board_and_one_that_hangs_for_a_second_loses_it() {
    let mut player = start(Threaded::new(line()), ping(true));
    for _ in 0..5 {
        player.device_mut().link_mut().hang(KEEP_ALIVE_TIMEOUT.saturating_sub(10 * MS));
        player.step(MS).unwrap();
    }
    assert_eq!(player.state().0, State::Active);
    // 250 ms is the scene's host timeout.
    player.device_mut().link_mut().hang(KEEP_ALIVE_TIMEOUT + 300 * MS);
    let stopped = player.step(MS).unwrap_err();
    assert!(matches!(stopped, PlayError::Stopped(StopReason::HostSilent)), "{stopped}");
}
