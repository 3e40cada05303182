//! Faults of the board itself: power, reset, clocks, state machines, and wild jumps.

use super::PicoRig;
use super::protocol::Request;
use crate::emulated::EmulatorError;

/// Fault injection for tests.
impl PicoRig {
    /// Cuts the power of the processor, and switches it on again. `seed` determines the RAM content afterwards. The DAC
    /// keeps its own supply.
    pub fn power_cycle(&mut self, seed: u32) -> Result<(), EmulatorError> {
        self.process.request(Request::PowerCycle, &[seed]).map(drop)
    }

    /// Pulls the RUN pin low and releases it.
    pub fn pull_run_pin(&mut self) -> Result<(), EmulatorError> {
        self.process.request(Request::RunPin, &[]).map(drop)
    }

    /// Stops the core for ever, like a loop without interrupts.
    pub fn hang(&mut self) -> Result<(), EmulatorError> {
        self.process.request(Request::Hang, &[]).map(drop)
    }

    /// Hangs the main loop, while interrupts continue.
    pub fn hang_main_loop(&mut self) -> Result<(), EmulatorError> {
        self.process.request(Request::HangMainLoop, &[]).map(drop)
    }

    /// Stops the crystal: core, tick and one-shot stop, and every pin keeps its level.
    pub fn stop_crystal(&mut self) -> Result<(), EmulatorError> {
        self.process.request(Request::StopCrystal, &[]).map(drop)
    }

    /// Stops the state machine of the one-shot, which keeps driving its current level.
    pub fn stop_one_shot(&mut self) -> Result<(), EmulatorError> {
        self.process.request(Request::StopPio, &[1]).map(drop)
    }

    /// Continues at the first function whose name in the image contains `name`, simulating a wild jump. Returns `false`
    /// if there is no such function.
    pub fn jump_to(&mut self, name: &str) -> Result<bool, EmulatorError> {
        let Some(address) = self.address_of(name)? else { return Ok(false) };
        self.jump(address).map(|()| true)
    }

    /// The address of the first function whose name in the image contains `name`.
    pub(super) fn address_of(&mut self, name: &str) -> Result<Option<u32>, EmulatorError> {
        let bytes: Vec<u32> = name.bytes().map(u32::from).collect();
        Ok(self.process.request(Request::AddressOf, &bytes)?.first().copied().filter(|address| *address != 0))
    }

    /// Continues at an address.
    pub fn jump(&mut self, address: u32) -> Result<(), EmulatorError> {
        self.process.request(Request::Jump, &[address]).map(drop)
    }
}
