//! One client after the other on one board: what the first set going is not the second's.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::ops::ControlFlow;
use std::path::Path;

use frixel::scene_file;
use frixel_driver::{Device, PollingLink};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke};
use frixel_play::SimStream;
use frixel_scene::compile;
use frixel_wire::fault::State;

/// The state that a second client finds, when the first one has left its scene playing.
fn found() -> State {
    let config = RigConfig::default();
    let scene = scene_file::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/constant.toml")).unwrap();
    let program = compile(&scene, &config.board.limits, config.board.tick_hz).unwrap();
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &config, Stroke::sweep(0.12, 0.11, 1.0).unwrap(), 1).unwrap();
    let mut first = Device::connect(PollingLink::new(SimStream::new(rig, Recorder::default()))).unwrap();
    frixel_play::start(&mut first, &program, &mut |_| ControlFlow::Continue(())).unwrap();
    Device::connect(first.into_link()).unwrap().hello().state
}

#[test]
fn a_hello_disarms_what_another_client_played() {
    assert_eq!(found(), State::Disarmed);
}
