//! Uploads arbitrary bytes as a compiled scene. The board rejects them, or estimates their longest tick to be
//! within its limit and plays them under a finger without a fault.
#![no_main]

use std::time::Duration;

use frixel::rigs::SimLink;
use frixel_driver::{Device, DeviceError, Upload};
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke};
use frixel_layers::Scene as WireScene;
use frixel_layers::cost::worst_of_scene;
use frixel_scene::recorder::Recorder;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let rig_config = RigConfig::default();
    let mut memory = BoardMemory::new();
    let stroke = Stroke::sweep(0.12, 0.08, 1.0).expect("a stroke");
    let rig = Rig::new(&mut memory, &rig_config, stroke, 1).expect("a rig");
    let mut device = Device::connect(SimLink::new(rig, Recorder::idle())).expect("a board");
    let upload = Upload { scene: bytes, bitmaps: Vec::new() };
    let taken = device.upload(&upload, &mut |_| {}).and_then(|()| device.commit(upload.scene_crc32()));
    match taken {
        Ok(()) => {
            let scene = WireScene::parse(bytes).expect("the board has read it");
            let (records, points): (Vec<_>, Vec<_>) = (scene.records().collect(), scene.points().collect());
            let worst = worst_of_scene(scene.header(), &records, &points);
            assert!(worst.cycles() <= rig_config.board.limits.tick_cycles_max, "{worst:?}");
        }
        Err(DeviceError::Refused { .. }) => return,
        Err(error) => panic!("{error}"),
    }
    let played = device
        .arm()
        .and_then(|()| device.play())
        .and_then(|()| device.wait(Duration::from_millis(60), &mut |_| {}))
        .and_then(|()| device.stop())
        .and_then(|()| device.disarm());
    if let Err(error) = played {
        panic!("{error}");
    }
});
