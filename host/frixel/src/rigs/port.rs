//! A board on a serial port, observed through telemetry only.

use std::time::Duration;

use frixel_driver::{Link, LinkClosed, SerialLink, Written};
use frixel_felt::recorder::{Observation, Recorder};
use frixel_play::Recorded;
use frixel_wire::message::Telemetry;

/// A serial port, with the record of the telemetry received from it.
pub(crate) struct PortLink {
    serial: SerialLink,
    recorder: Recorder,
}

impl PortLink {
    /// Creates a link that records the telemetry of the board on `serial`.
    pub(crate) fn new(serial: SerialLink) -> Self {
        Self { serial, recorder: Recorder::default() }
    }
}

impl Recorded for PortLink {
    type Recorder = Recorder;

    fn recorder_mut(&mut self) -> &mut Recorder {
        &mut self.recorder
    }

    fn record(&mut self, telemetry: &[Telemetry]) {
        for message in telemetry {
            self.recorder.record(&Observation::from_telemetry(message));
        }
    }
}

impl Link for PortLink {
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed> {
        self.serial.write(frame)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        self.serial.read(buffer, wait)
    }

    fn now(&self) -> Duration {
        self.serial.now()
    }

    fn keep_alive(&mut self, period: Duration) {
        self.serial.keep_alive(period);
    }

    fn set_shutdown_frames(&mut self, frames: Vec<u8>) {
        self.serial.set_shutdown_frames(frames);
    }

    fn written(&self) -> Written {
        self.serial.written()
    }

    fn name(&self) -> &str {
        self.serial.name()
    }
}
