//! The in-process rig as a [`BoardRig`].

use frixel_control::Board;
use frixel_wire::fault::Fault;

use crate::board_rig::{BoardRig, RigError, RigFault, RigTick};
use crate::{BoardMemory, Rig, RigConfig, Stroke, WorldError};

/// Cycles of a late tick, as the board reports them: above the 4,250 that a tick at 40 kHz has on the G474.
const LATE_TICK_CYCLES: u32 = 4_300;

/// A [`Rig`] whose board can be reset.
pub struct InProcessRig<'a> {
    rig: Rig<'a>,
    board: Board,
    /// Memory of the board for each reset: that of the start before is still borrowed.
    memories: core::slice::IterMut<'a, Box<BoardMemory>>,
}

impl<'a> InProcessRig<'a> {
    /// A board after power-on, in a world whose finger will make `stroke`. It takes one of `memories` for each start,
    /// so there must be one more than resets.
    pub fn new(
        memories: &'a mut [Box<BoardMemory>],
        config: &RigConfig,
        stroke: Stroke,
        seed: u64,
    ) -> Result<Self, InProcessError> {
        let mut memories = memories.iter_mut();
        let memory = memories.next().ok_or(InProcessError::NoMemory)?;
        let rig = Rig::new(memory, config, stroke, seed)?;
        Ok(Self { rig, board: config.board, memories })
    }

    /// The rig, to look inside the board.
    pub fn rig_mut(&mut self) -> &mut Rig<'a> {
        &mut self.rig
    }
}

/// Why an in-process rig cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InProcessError {
    /// There is no memory for the first start.
    #[error("an in-process rig needs memory for each start of its board, and was given none")]
    NoMemory,
    /// The world cannot be made.
    #[error(transparent)]
    World(#[from] WorldError),
}

impl BoardRig for InProcessRig<'_> {
    fn name(&self) -> &'static str {
        "sim"
    }

    fn board(&self) -> &Board {
        &self.board
    }

    fn tick(&self) -> u64 {
        self.rig.tick()
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
        while !self.rig.has_received() && self.rig.tick() < until_tick {
            let record = self.rig.step();
            watch(&RigTick { tick: record.tick, drive: record.drive, felt: record.felt });
        }
        self.rig.receive(received);
        Ok(())
    }

    fn cause(&mut self, fault: RigFault, ticks: u64) -> Result<(), RigError> {
        match fault {
            RigFault::World(fault) => {
                let world = self.rig.world_mut();
                let now = world.tick();
                world.schedule_fault(now..now.saturating_add(ticks), fault)?;
            }
            RigFault::Reset | RigFault::OptionBytes => {
                let reason = "its board has no memory left for another start";
                let memory = self.memories.next().ok_or(RigError::FaultUnavailable { rig: "sim", reason })?;
                if fault == RigFault::OptionBytes {
                    self.rig.change_option_bytes();
                }
                self.rig.reset(memory);
            }
            RigFault::LateTick => self.rig.raise(Fault::Deadline, LATE_TICK_CYCLES),
            RigFault::WrapSoon { ticks } => self.rig.set_board_tick(0_u32.wrapping_sub(ticks)),
        }
        Ok(())
    }

    fn start_stroke(&mut self) {
        self.rig.world_mut().start_stroke();
    }
}
