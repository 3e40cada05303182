//! The line to the Pico's image in an emulator, on the emulator's clock: it advances only while the host waits.

use std::time::Duration;

use frixel_driver::{ByteStream, LinkClosed};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::emulated::{EmulatorError, PicoRig};
use frixel_play::Recorded;
use frixel_wire::message::Telemetry;

use super::held_ticks::HeldTicks;

const NAME: &str = "the emulated Pico";
/// Time for which ticks are held until their telemetry arrives.
const HELD: Duration = Duration::from_millis(200);

/// The serial port of an emulated Pico, with its clock.
///
/// The record has every tick of the world, counted since the board was switched on. Values that only the board knows
/// are in those rows for which a telemetry message arrived. The board counts its ticks from another one on, which the
/// first message shows to a millisecond.
pub struct PicoStream {
    rig: PicoRig,
    held: HeldTicks,
    /// The world's tick less the board's, once it is known.
    tick_offset: Option<u32>,
}

impl PicoStream {
    /// The line to the board of a rig.
    pub fn new(rig: PicoRig) -> Self {
        Self { rig, held: HeldTicks::default(), tick_offset: None }
    }

    fn step(&mut self) -> Result<(), LinkClosed> {
        let record = self.rig.step().map_err(|error| closed(&error))?;
        self.held.hold([record]);
        Ok(())
    }
}

impl Recorded for PicoStream {
    type Recorder = Recorder;

    fn recorder_mut(&mut self) -> &mut Recorder {
        &mut self.held.recorder
    }

    fn begin(&mut self) -> Result<(), LinkClosed> {
        self.rig.world_mut().start_stroke();
        self.held.recorder.start(self.rig.tick());
        Ok(())
    }

    fn record(&mut self, telemetry: &[Telemetry]) {
        if let Some(last) = telemetry.last() {
            let offset = *self.tick_offset.get_or_insert(self.rig.tick().wrapping_sub(last.tick));
            let shifted = |message: &Telemetry| Telemetry { tick: message.tick.wrapping_add(offset), ..*message };
            self.held.hear(telemetry.iter().map(shifted));
        }
        self.held.record((HELD.as_nanos() / self.rig.tick_period().as_nanos()) as usize);
    }

    fn record_rest(&mut self) {
        self.held.record(0);
    }
}

impl ByteStream for PicoStream {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        self.rig.send(bytes);
        Ok(())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.rig.now() + wait;
        while !self.rig.has_received() && self.rig.now() < end {
            self.step()?;
        }
        self.rig.receive(buffer);
        Ok(())
    }

    fn now(&self) -> Duration {
        self.rig.now()
    }

    fn name(&self) -> &'static str {
        NAME
    }
}

fn closed(error: &EmulatorError) -> LinkClosed {
    LinkClosed { port: NAME.to_owned(), reason: error.to_string() }
}
