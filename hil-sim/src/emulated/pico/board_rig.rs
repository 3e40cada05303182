//! The emulated Pico as a [`BoardRig`], for scenarios.

use core::time::Duration;

use frixel_control::Board;

use super::PicoRig;
use crate::emulated::{EmulatorError, Image};
use crate::{BoardRig, RigError, RigFault, RigTick, World};

const NAME: &str = "the emulated Pico";
/// Time until the board has started and its arm switch is debounced.
const SWITCH_TIME: Duration = Duration::from_millis(60);
/// Largest delay between a request or an event and its observation: the supervisor of a real board waits for its
/// amplifier, and its touch reports take longer.
const LATENESS: Duration = Duration::from_millis(5);
const BOARD: Board = Board::PICO;

/// A [`PicoRig`] with a simulated person who holds the arm switch, and presses it again on request.
pub struct PicoBoardRig {
    rig: PicoRig,
    /// The tick until which the switch is released.
    switch_open_until: Option<u64>,
}

impl PicoBoardRig {
    /// Switches the board on, and waits until its arm switch is recognised as held.
    pub fn start(image: &Image, world: World) -> Result<Self, EmulatorError> {
        let mut rig = PicoRig::start(image, world)?;
        while rig.now() < SWITCH_TIME {
            rig.step()?;
        }
        Ok(Self { rig, switch_open_until: None })
    }

    fn step(&mut self) -> Result<RigTick, RigError> {
        self.switch_open_until = self.switch_open_until.filter(|until| *until > self.tick());
        // A welded switch stays closed regardless of the person.
        let is_open = self.switch_open_until.is_some() && !self.rig.world().is_switch_welded();
        self.rig.broken.arm_switch = is_open.then_some(false);
        self.rig.step().map_err(|error| ended(&error))
    }
}

impl BoardRig for PicoBoardRig {
    fn name(&self) -> &'static str {
        NAME
    }

    fn board(&self) -> &Board {
        const { &BOARD }
    }

    fn tick(&self) -> u64 {
        self.rig.world().tick()
    }

    fn now(&self) -> Duration {
        self.rig.now()
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), RigError> {
        self.rig.send(bytes);
        Ok(())
    }

    fn run(
        &mut self,
        until_tick: u64,
        received: &mut Vec<u8>,
        watch: &mut dyn FnMut(&RigTick),
    ) -> Result<(), RigError> {
        while !(self.rig.has_received() || self.rig.has_touch_frames()) && self.tick() < until_tick {
            watch(&self.step()?);
        }
        self.rig.receive(received);
        Ok(())
    }

    fn take_touch_frames(&mut self) -> Vec<u8> {
        self.rig.take_touch_frames()
    }

    fn cause(&mut self, fault: RigFault, ticks: u64) -> Result<(), RigError> {
        match fault {
            RigFault::World(fault) => Ok(self.rig.world_mut().cause(fault, ticks)?),
            RigFault::Reset => self.rig.pull_run_pin().map_err(|error| ended(&error)),
            RigFault::LateTick | RigFault::OptionBytes | RigFault::WrapSoon { .. } => {
                let reason = "an unmodified image has no input for it";
                Err(RigError::FaultUnavailable { rig: NAME, reason })
            }
        }
    }

    fn start_stroke(&mut self) {
        self.rig.world_mut().start_stroke();
    }

    fn press_switch(&mut self) -> u64 {
        let ticks = ticks(SWITCH_TIME);
        self.switch_open_until = Some(self.tick() + ticks);
        2 * ticks
    }

    fn lateness_ticks(&self) -> u64 {
        ticks(LATENESS)
    }
}

/// Ticks of the board in a time.
fn ticks(time: Duration) -> u64 {
    (time.as_secs_f64() * f64::from(BOARD.tick_hz)).round() as u64
}

fn ended(error: &EmulatorError) -> RigError {
    RigError::Ended { rig: NAME, reason: error.to_string() }
}
