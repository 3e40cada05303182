//! DAC and amplifier: the output of a tick is one word of the shared memory. The simulator reads it as the drive of the
//! whole tick.

use core::sync::atomic::{AtomicU32, Ordering};

use frixel_board::hardware::{DacFrames, Late};
use frixel_control::Drive;
use frixel_drivers::amplifier::KickedEnable;
use frixel_exchange::{drive_of, word_of};
use frixel_wire::dac_code::DacCode;

use crate::shared;

/// The drive of the current tick, encoded. Only the tick writes it.
static DRIVE: AtomicU32 = AtomicU32::new(0);

fn set(drive: Drive) {
    DRIVE.store(word_of(drive), Ordering::Relaxed);
}

/// The drive of the last tick.
pub fn drive() -> Drive {
    drive_of(DRIVE.load(Ordering::Relaxed))
}

/// Passes the drive of a tick to the simulator. Called at the end of each tick.
pub fn publish(tick: u32) {
    shared::drive(tick, drive());
}

/// The tick's half of the DAC. It is never late: the simulator takes a code at any time.
pub struct Frames;

impl DacFrames for Frames {
    #[inline]
    fn send(&mut self, dac_code: DacCode) -> Result<(), Late> {
        set(Drive { dac_code, ..drive() });
        Ok(())
    }
}

/// The amplifier's enable. While it is low, the DAC is cleared, too.
///
/// There is no one-shot. A tick that does not run passes no drive to the simulator, whose time then stands still.
pub struct Enable;

impl KickedEnable for Enable {
    #[inline]
    fn kick(&mut self) {
        set(Drive { amplifier_enable: true, ..drive() });
    }

    #[inline]
    fn disable(&mut self) {
        set(Drive::default());
    }
}
