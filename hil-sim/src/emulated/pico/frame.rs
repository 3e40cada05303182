//! The touch frame on the board's I2C bus.

use std::time::Duration;

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal_async::i2c::I2c;
use frixel_drivers::polling::poll_once;
use frixel_drivers::zforce::I2C_ADDRESS;
use frixel_session::Touch;

use super::PicoRig;
use super::protocol::{Ended, FRAME_READY, Ran, Request, SCL_HELD, SDA_HELD, Stamped, WireEvent};
use crate::chips::{HeldBus, TouchEvent, ZForceModule};
use crate::emulated::EmulatorError;

/// The byte read from SDA while no device drives it.
const RELEASED: u8 = 0xff;
/// Frame units per metre.
const UNITS_PER_M: f32 = 1e4;

/// A zForce module along the top edge of the screen, and faults of its bus.
#[derive(Debug)]
pub struct TouchFrame {
    module: ZForceModule,
    /// A device that holds SDA low, such as a module interrupted in a transfer; `None` if SDA is free.
    pub holds_sda: Option<HeldBus>,
    /// Whether the module holds SCL low.
    pub holds_scl: bool,
    /// Number of bytes after which the module restarts in the middle of a transfer; `None` for never.
    pub restarts_after: Option<u32>,
    /// Whether the module has nothing more to send in the current transfer.
    has_ended: bool,
    is_touched: bool,
    written: Vec<u8>,
}

impl TouchFrame {
    fn new() -> Self {
        Self {
            module: ZForceModule::new(0),
            holds_sda: None,
            holds_scl: false,
            restarts_after: None,
            has_ended: false,
            is_touched: false,
            written: Vec::new(),
        }
    }

    /// The module, to break it.
    pub fn module(&self) -> &ZForceModule {
        &self.module
    }

    /// Reports the finger's place.
    pub(super) fn report(&mut self, touch: Touch) {
        let units = |place_m: f32| (place_m * UNITS_PER_M).round() as u16;
        match touch {
            Touch::Down { x_m, y_m, .. } => {
                let event = if self.is_touched { TouchEvent::Move } else { TouchEvent::Down };
                self.module.touch(event, units(x_m), units(y_m));
                self.is_touched = true;
            }
            Touch::Up => {
                self.module.touch(TouchEvent::Up, 0, 0);
                self.is_touched = false;
            }
        }
    }

    /// Its inputs for a run: whether data is ready, and whether SDA and SCL are held low.
    pub(super) fn inputs(&self) -> u32 {
        let is_ready = self.module.waiting() > 0;
        let sda_is_held = self.holds_sda.as_ref().is_some_and(|bus| matches!(bus.clone().is_low(), Ok(true)));
        let inputs = [(is_ready, FRAME_READY), (sda_is_held, SDA_HELD), (self.holds_scl, SCL_HELD)];
        inputs.into_iter().map(|(is_set, input)| if is_set { input } else { 0 }).sum()
    }

    /// Returns the module's answer to an event on its bus: a byte, or 1 for an acknowledgement.
    fn answer(&mut self, event: WireEvent) -> Option<u8> {
        match event {
            WireEvent::I2cAddress { address, .. } => {
                // The START condition resets an interrupted transfer.
                let has_started = self.holds_sda.as_ref().is_none_or(HeldBus::start);
                Some(u8::from(has_started && self.module.acknowledges(address)))
            }
            WireEvent::I2cWrite(byte) => {
                self.written.push(byte);
                Some(1)
            }
            WireEvent::I2cRead => Some(self.next_byte()),
            WireEvent::I2cStop => {
                self.end_transfer();
                None
            }
            WireEvent::Scl(is_high) => {
                if let Some(bus) = &mut self.holds_sda {
                    let Ok(()) = if is_high { bus.set_high() } else { bus.set_low() };
                }
                None
            }
            _ => None,
        }
    }

    fn next_byte(&mut self) -> u8 {
        if self.restarts_after == Some(0) {
            self.restarts_after = None;
            self.module.restart();
            self.has_ended = true;
        }
        if self.has_ended {
            return RELEASED;
        }
        self.restarts_after = self.restarts_after.map(|bytes| bytes - 1);
        let waiting = self.module.waiting();
        let mut byte = [RELEASED];
        let _ = poll_once(std::pin::pin!(self.module.read(I2C_ADDRESS, &mut byte)));
        self.has_ended = self.module.waiting() < waiting;
        byte[0]
    }

    fn end_transfer(&mut self) {
        self.has_ended = false;
        let written = std::mem::take(&mut self.written);
        if !written.is_empty() {
            let _ = poll_once(std::pin::pin!(self.module.write(I2C_ADDRESS, &written)));
        }
    }
}

/// The board's bus, and the frame on it.
impl PicoRig {
    /// Connects a touch frame, which reports the world's finger from now on.
    pub fn attach_frame(&mut self) {
        self.frame = Some(TouchFrame::new());
    }

    /// The touch frame, to break it; `None` without one.
    pub fn frame_mut(&mut self) -> Option<&mut TouchFrame> {
        self.frame.as_mut()
    }

    /// Runs for a time, or until a frame of the DAC ends, with the touch frame's answers.
    pub(super) fn run(&mut self, time: Duration, instructions_max: u32) -> Result<Ran, EmulatorError> {
        let end = self.now + time;
        let (mut events, mut instructions) = (Vec::new(), 0);
        loop {
            let left = instructions_max.saturating_sub(instructions);
            let mut ran = self.run_to_question(end.saturating_sub(self.now), left)?;
            self.answer(&ran.events)?;
            events.append(&mut ran.events);
            instructions += ran.instructions;
            let all_done = instructions_max > 0 && instructions >= instructions_max;
            if ran.ended != Ended::FrameAsked || all_done {
                let ended = if ran.ended == Ended::FrameAsked { Ended::Instructions } else { ran.ended };
                return Ok(Ran { ended, instructions, events, ..ran });
            }
        }
    }

    /// Lets the touch frame answer an event on its bus.
    fn answer(&mut self, events: &[Stamped]) -> Result<(), EmulatorError> {
        for stamped in events {
            if let Some(answer) = self.frame.as_mut().and_then(|frame| frame.answer(stamped.event)) {
                self.process.request(Request::AnswerI2c, &[answer.into()])?;
            }
        }
        Ok(())
    }
}
