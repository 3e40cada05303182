//! A link to the in-process rig, with the rig's clock: waiting for a second of virtual time takes no wall time.

use std::time::Duration;

use frixel_driver::{KeepAlive, Link, LinkClosed, Written};
use frixel_felt::recorder::{Observation, Recorder};
use frixel_hil_sim::{Rig, TickRecord};
use frixel_play::Recorded;
use frixel_wire::fault::State;

/// Is called with every tick that is recorded.
type Observer<'a> = Box<dyn FnMut(&TickRecord) + 'a>;

/// The host's end of the serial line to a simulated board.
///
/// The stroke of the finger and the record start when the scene first plays.
pub struct SimLink<'a> {
    rig: Rig<'a>,
    recorder: Recorder,
    recording: bool,
    written: Written,
    written_at: Duration,
    pings: KeepAlive,
    /// Tick at which the next ping is due.
    ping_tick: Option<u64>,
    observer: Option<Observer<'a>>,
}

impl<'a> SimLink<'a> {
    /// Creates a link to `rig` that records its ticks into `recorder`.
    pub fn new(rig: Rig<'a>, recorder: Recorder) -> Self {
        Self {
            rig,
            recorder,
            recording: false,
            written: Written::default(),
            written_at: Duration::ZERO,
            pings: KeepAlive::default(),
            ping_tick: None,
            observer: None,
        }
    }

    /// Calls `observer` with every tick that is recorded.
    #[must_use]
    pub fn observed(self, observer: impl FnMut(&TickRecord) + 'a) -> Self {
        Self { observer: Some(Box::new(observer)), ..self }
    }

    /// The recorder with all ticks.
    pub fn into_recorder(self) -> Recorder {
        self.recorder
    }

    fn ticks(&self, time: Duration) -> u64 {
        (time.as_secs_f64() * f64::from(self.rig.tick_hz())).ceil() as u64
    }

    fn step(&mut self) {
        if self.ping_tick.is_some_and(|tick| tick <= self.rig.tick()) {
            let ping = self.pings.next_ping(self.now());
            self.send(&ping);
        }
        let record = self.rig.step();
        if self.recording {
            self.recorder.record(&Observation::of_tick(&record));
            if let Some(observer) = &mut self.observer {
                observer(&record);
            }
        } else if record.status.telemetry.state == State::Active {
            self.rig.world_mut().start_stroke();
            self.recorder.start(record.tick as u32);
            self.recording = true;
        }
    }

    fn send(&mut self, frame: &[u8]) {
        self.rig.send(frame);
        self.written.add(frame);
        self.written_at = self.now();
        self.plan_ping();
    }

    fn plan_ping(&mut self) {
        self.ping_tick = self.pings.due_at(self.written_at).map(|due| self.ticks(due));
    }
}

impl Recorded for SimLink<'_> {
    fn recorder_mut(&mut self) -> &mut Recorder {
        &mut self.recorder
    }
}

impl Link for SimLink<'_> {
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed> {
        self.send(frame);
        Ok(self.written.bytes)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.rig.tick() + self.ticks(wait);
        while !self.rig.has_received() && self.rig.tick() < end {
            self.step();
        }
        let len_before = buffer.len();
        self.rig.receive(buffer);
        let now = self.now();
        if self.pings.hear(buffer.get(len_before..).unwrap_or_default(), now) {
            self.plan_ping();
        }
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_secs_f64(self.rig.tick() as f64 / f64::from(self.rig.tick_hz()))
    }

    fn keep_alive(&mut self, period: Duration) {
        self.pings.set_period(period);
        self.plan_ping();
    }

    fn written(&self) -> Written {
        self.written
    }

    fn name(&self) -> &'static str {
        "sim"
    }
}
