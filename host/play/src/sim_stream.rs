//! The line to the in-process rig, on the rig's clock: waiting for a second of virtual time takes no wall time.

use std::time::Duration;

use frixel_driver::{ByteStream, LinkClosed};
use frixel_felt::recorder::{Observation, Recorder};
use frixel_hil_sim::{Rig, TickRecord};
use frixel_wire::fault::State;

use crate::recorded::Recorded;

/// Is called with every tick that is recorded.
type Observer<'a> = Box<dyn FnMut(&TickRecord) + 'a>;

/// The host's end of the serial line to a simulated board.
///
/// The stroke of the finger and the record start when the scene first plays.
pub struct SimStream<'a> {
    rig: Rig<'a>,
    recorder: Recorder,
    recording: bool,
    observer: Option<Observer<'a>>,
}

impl<'a> SimStream<'a> {
    /// Creates a line to `rig` that records its ticks into `recorder`.
    pub fn new(rig: Rig<'a>, recorder: Recorder) -> Self {
        Self { rig, recorder, recording: false, observer: None }
    }

    /// Calls `observer` with every tick that is recorded.
    #[must_use]
    pub fn observed(self, observer: impl FnMut(&TickRecord) + 'a) -> Self {
        Self { observer: Some(Box::new(observer)), ..self }
    }

    fn ticks(&self, time: Duration) -> u64 {
        (time.as_secs_f64() * f64::from(self.rig.tick_hz())).ceil() as u64
    }

    fn step(&mut self) {
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
}

impl Recorded for SimStream<'_> {
    type Recorder = Recorder;

    fn recorder_mut(&mut self) -> &mut Recorder {
        &mut self.recorder
    }
}

impl ByteStream for SimStream<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        self.rig.send(bytes);
        Ok(())
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

    fn name(&self) -> &'static str {
        "sim"
    }
}
