//! Faults of the board itself: power, reset, clocks, state machines, jumps that no instruction asked for.

use super::PicoRig;
use super::protocol::Request;
use crate::emulated::EmulatorError;

/// What a test does to the board.
impl PicoRig {
    /// Cuts the power of the processor, and switches it on again. `seed` is that of what its RAM holds then. The DAC
    /// keeps its own supply.
    pub fn power_cycle(&mut self, seed: u32) -> Result<(), EmulatorError> {
        self.process.request(Request::PowerCycle, &[seed]).map(drop)
    }

    /// Pulls the RUN pin low and lets it go.
    pub fn pull_run_pin(&mut self) -> Result<(), EmulatorError> {
        self.process.request(Request::RunPin, &[]).map(drop)
    }

    /// Stops the core for ever, as a loop without interrupts does.
    pub fn hang(&mut self) -> Result<(), EmulatorError> {
        self.process.request(Request::Hang, &[]).map(drop)
    }

    /// Lets the main loop hang, while interrupts go on.
    pub fn hang_main_loop(&mut self) -> Result<(), EmulatorError> {
        self.process.request(Request::HangMainLoop, &[]).map(drop)
    }

    /// Stops the crystal: core, tick and one-shot stand still, and every pin stays as it is.
    pub fn stop_crystal(&mut self) -> Result<(), EmulatorError> {
        self.process.request(Request::StopCrystal, &[]).map(drop)
    }

    /// Stops the state machine of the one-shot: it holds what it drives.
    pub fn stop_one_shot(&mut self) -> Result<(), EmulatorError> {
        self.process.request(Request::StopPio, &[1]).map(drop)
    }

    /// Lets the core go on at the first function whose name in the image contains `name`: a jump that no instruction
    /// asked for. `false` if there is no such function.
    pub fn jump_to(&mut self, name: &str) -> Result<bool, EmulatorError> {
        let Some(address) = self.address_of(name)? else { return Ok(false) };
        self.jump(address).map(|()| true)
    }

    /// The address of the first function whose name in the image contains `name`.
    pub(super) fn address_of(&mut self, name: &str) -> Result<Option<u32>, EmulatorError> {
        let bytes: Vec<u32> = name.bytes().map(u32::from).collect();
        Ok(self.process.request(Request::AddressOf, &bytes)?.first().copied().filter(|address| *address != 0))
    }

    /// Lets the core go on at an address.
    pub fn jump(&mut self, address: u32) -> Result<(), EmulatorError> {
        self.process.request(Request::Jump, &[address]).map(drop)
    }
}
