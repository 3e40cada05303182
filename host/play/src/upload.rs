//! From a compiled program to the bytes that a board takes.

use std::ops::ControlFlow;

use frixel_driver::{Bitmap, Device, DeviceError, Link, Progress, Upload};
use frixel_scene::Program;

/// Disarms a board, whatever state an earlier client left it in, then uploads the program, arms the board and plays.
/// `progress` may break the upload off.
pub fn start<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<(), DeviceError> {
    load(device, program, progress)?;
    device.arm()?;
    device.play()
}

/// Disarms a board, whatever state an earlier client left it in, then uploads the program without playing it. Returns
/// the bytes that this took on the line to the board.
pub fn load<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<u64, DeviceError> {
    let before = device.counters().wire_bytes;
    device.disarm()?;
    upload(device, program, progress)?;
    Ok(device.counters().wire_bytes - before)
}

/// Uploads a program and commits it, in any state of the board.
pub(crate) fn upload<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<(), DeviceError> {
    let scene = program.scene_bytes_for(device.hello().protocol);
    let bitmaps = program.bitmaps.iter().map(|bitmap| Bitmap {
        crc32: bitmap.crc32,
        width: bitmap.width,
        height: bitmap.height,
        samples: &bitmap.samples,
    });
    let upload = Upload { scene: &scene, bitmaps: bitmaps.collect() };
    device.upload_while(&upload, progress)?;
    device.commit(upload.scene_crc32())
}
