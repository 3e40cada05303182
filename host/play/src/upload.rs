//! Uploads of compiled programs to a board.

use std::ops::ControlFlow;

use frixel_driver::{Bitmap, Device, DeviceError, Link, Progress, Upload};
use frixel_scene::{LayerSetting, Program};

/// Disarms the board in any state, uploads the program, arms the board and plays. `progress` may cancel the upload.
pub fn start<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<(), DeviceError> {
    load(device, program, progress)?;
    device.arm()?;
    device.play()?;
    switch_off(device, &program.start)
}

/// Switches off the layers of the board that are off in these settings, one for each record of its program. They were
/// uploaded with a gain of 0.
pub(crate) fn switch_off<L: Link>(device: &mut Device<L>, settings: &[LayerSetting]) -> Result<(), DeviceError> {
    let off = (0..).zip(settings).filter(|(_, setting)| !setting.on);
    off.into_iter().try_for_each(|(record, setting)| device.set_layer(record, false, setting.gain))
}

/// Disarms the board in any state, then uploads the program without playing it. Returns the number of bytes that this
/// took on the line to the board.
pub fn load<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<u64, DeviceError> {
    let before = device.counters().wire_bytes;
    device.disarm()?;
    upload(device, program, &program.start, progress)?;
    Ok(device.counters().wire_bytes - before)
}

/// Uploads a program with these settings of its records, and commits it, in any state of the board. Layers that are off
/// have a gain of 0 until they are [switched off](switch_off) once the board plays.
pub(crate) fn upload<L: Link>(
    device: &mut Device<L>,
    program: &Program,
    settings: &[LayerSetting],
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<(), DeviceError> {
    let scene = program.scene_bytes_with(settings);
    let bitmaps = program.bitmaps.iter().map(|bitmap| Bitmap {
        crc32: bitmap.crc32,
        width: bitmap.width,
        height: bitmap.height,
        samples: &bitmap.samples,
    });
    let upload = Upload { scene: &scene, bitmaps: bitmaps.collect() };
    device.upload(&upload, progress)?;
    device.commit(upload.scene_crc32())
}
