//! A link to the in-process rig, with the rig's clock: waiting for a second of virtual time takes no wall time.

use std::time::Duration;

use frixel_driver::{Link, LinkClosed, Written};
use frixel_hil_sim::{Rig, TickRecord};
use frixel_scene::recorder::{Observation, Recorder};
use frixel_wire::fault::State;
use frixel_wire::message::Telemetry;

use super::RecordedLink;
use super::recorded::{ReferenceFinger, finger_and_felt};

/// A frame that is sent periodically without a call.
struct KeepAlive {
    frame: Vec<u8>,
    period_ticks: u64,
}

/// Is called with every tick that is recorded.
type Observer<'a> = Box<dyn FnMut(&TickRecord) + 'a>;

/// The host's end of the serial line to a simulated board.
///
/// The stroke of the finger and the record start when the scene first plays.
pub struct SimLink<'a> {
    rig: Rig<'a>,
    recorder: Recorder,
    reference_finger: ReferenceFinger,
    recording: bool,
    written: Written,
    written_at_tick: u64,
    keep_alive: Option<KeepAlive>,
    observer: Option<Observer<'a>>,
}

impl<'a> SimLink<'a> {
    /// Creates a link to `rig` that records its ticks into `recorder`.
    pub fn new(rig: Rig<'a>, recorder: Recorder) -> Self {
        Self {
            rig,
            recorder,
            reference_finger: ReferenceFinger::Scene,
            recording: false,
            written: Written::default(),
            written_at_tick: 0,
            keep_alive: None,
            observer: None,
        }
    }

    /// Calls `observer` with every tick that is recorded.
    #[must_use]
    pub fn observed(self, observer: impl FnMut(&TickRecord) + 'a) -> Self {
        Self { observer: Some(Box::new(observer)), ..self }
    }

    /// Compares with what the simulated finger would have felt of a display without fault, with its load, noise and
    /// skin; without this, with the friction of the scene's finger in steady sliding.
    #[must_use]
    pub fn referring_to_simulated_finger(self) -> Self {
        Self { reference_finger: ReferenceFinger::simulated(), ..self }
    }

    /// The recorder with all ticks.
    pub fn into_recorder(self) -> Recorder {
        self.recorder
    }

    fn ticks(&self, time: Duration) -> u64 {
        (time.as_secs_f64() * f64::from(self.rig.tick_hz())).ceil() as u64
    }

    fn step(&mut self) {
        let ping =
            self.keep_alive.take_if(|keep_alive| self.rig.tick() - self.written_at_tick >= keep_alive.period_ticks);
        if let Some(keep_alive) = ping {
            self.send(&keep_alive.frame);
            self.keep_alive = Some(keep_alive);
        }
        let record = self.rig.step();
        if self.recording {
            self.reference_finger.record(&mut self.recorder, &observation(&record), &record.felt);
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
        self.recorder.record_sent(frame);
        self.written.add(frame);
        self.written_at_tick = self.rig.tick();
    }
}

/// Everything about a tick: on the simulator, both board and finger are observable.
pub(super) fn observation(record: &TickRecord) -> Observation {
    let telemetry = record.status.telemetry;
    let (finger, felt) = finger_and_felt(&record.felt);
    Observation {
        tick: record.tick as u32,
        finger,
        felt,
        dac_code: Some(telemetry.dac_code),
        telemetry: Some(telemetry),
    }
}

impl RecordedLink for SimLink<'_> {
    fn recorder_mut(&mut self) -> &mut Recorder {
        &mut self.recorder
    }

    /// Does nothing: every tick has already been recorded, including the values that telemetry would report.
    fn record(&mut self, _telemetry: &[Telemetry]) {}
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
        self.rig.receive(buffer);
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_secs_f64(self.rig.tick() as f64 / f64::from(self.rig.tick_hz()))
    }

    fn keep_alive(&mut self, frame: Vec<u8>, period: Duration) {
        self.keep_alive = Some(KeepAlive { frame, period_ticks: self.ticks(period) });
    }

    fn written(&self) -> Written {
        self.written
    }

    fn name(&self) -> &'static str {
        "sim"
    }
}
