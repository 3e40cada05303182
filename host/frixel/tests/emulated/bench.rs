//! An emulated board under a finger that slides for ever.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::Duration;

use frixel::scene_file;
use frixel_driver::{Device, Link};
use frixel_exchange::BOARD;
use frixel_hil_sim::emulated::{Image, LinkBoard, LinkRecord};
use frixel_hil_sim::{Stroke, World, WorldConfig};
use frixel_play::start;
use frixel_scene::{Program, compile};

use crate::cable::Cable;

/// Wall time between two checks of what is waited for.
const NAP: Duration = Duration::from_millis(2);
/// Two minutes of naps: whatever is waited for longer has hung.
const NAPS_MAX: u32 = 60_000;

/// A minute of the board's time, in which the finger comes over every part of a scene.
const FELT_WITHIN_TICKS: usize = 60 * BOARD.tick_hz as usize;

/// One emulator at a time: it takes more than a core.
static TURN: Mutex<()> = Mutex::new(());

pub(crate) fn turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

pub(crate) struct Bench {
    pub(crate) board: LinkBoard,
    records: Arc<Mutex<Vec<LinkRecord>>>,
    _turn: MutexGuard<'static, ()>,
}

impl Bench {
    pub(crate) fn new(image: &Image) -> Self {
        let turn = turn();
        let config = WorldConfig {
            tick_hz: BOARD.tick_hz,
            full_scale_v_peak: f64::from(BOARD.limits.full_scale_v_peak),
            ..WorldConfig::default()
        };
        let stroke = Stroke::sweep(0.12, 0.08, 600.0).unwrap();
        let world = World::new(config, stroke, 1).unwrap();
        let records = Arc::new(Mutex::new(Vec::new()));
        let seen = Arc::clone(&records);
        let board = LinkBoard::start(image, world, move |record| seen.lock().unwrap().push(*record)).unwrap();
        board.start_stroke();
        Self { board, records, _turn: turn }
    }

    /// Plays one of the bundled scenes, and waits until the board drives.
    pub(crate) fn play(&self, scene: &str) -> Device<Cable<'_>> {
        let mut device = Device::connect(Cable::plug(&self.board)).unwrap();
        start(&mut device, &program(scene), &mut |_| ControlFlow::Continue(())).unwrap();
        self.until_driven(&mut device);
        device
    }

    /// What happened so far, tick by tick.
    pub(crate) fn records(&self) -> Vec<LinkRecord> {
        self.records.lock().unwrap().clone()
    }

    /// Waits for something, in wall time.
    pub(crate) fn until(&self, what: &str, mut done: impl FnMut(&LinkBoard) -> bool) {
        for _ in 0..NAPS_MAX {
            if done(&self.board) {
                return;
            }
            sleep(NAP);
        }
        panic!("hung: {what}");
    }

    /// Waits until the board drives, for a host that is there all the time.
    pub(crate) fn until_driven<L: Link>(&self, device: &mut Device<L>) {
        self.until("the board drives", |board| {
            device.keep_alive().unwrap();
            board.output().unwrap().dac_code.bits() != 0
        });
    }

    /// Waits until the finger has felt so much electric friction, for a host that is there all the time.
    pub(crate) fn until_felt<L: Link>(&self, device: &mut Device<L>, electric_friction_n: f64) {
        let mut checked = 0;
        let end = self.records.lock().unwrap().len() + FELT_WITHIN_TICKS;
        self.until("the finger feels the scene", |board| {
            device.keep_alive().unwrap();
            let records = self.records.lock().unwrap();
            assert!(records.len() < end, "the finger does not feel the scene; the board puts out {:?}", board.output());
            let new = &records[checked..];
            checked = records.len();
            new.iter().any(|record| record.felt.electric_friction_n >= electric_friction_n)
        });
    }

    /// Lets some of the board's ticks pass, for a host that is there all the time.
    pub(crate) fn pass<L: Link>(&self, device: &mut Device<L>, ticks: u32) {
        let start = self.board.ticks().unwrap();
        self.until("ticks pass", |board| {
            device.keep_alive().unwrap();
            board.ticks().unwrap().wrapping_sub(start) >= ticks
        });
    }
}

/// Host timeout of the scenes here, the longest that there is: on a busy machine pings are late.
pub(crate) const HOST_TIMEOUT_TICKS: u32 = 40_000;

/// One of the bundled scenes, for the emulated board.
pub(crate) fn program(name: &str) -> Program {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    let mut program = compile(&scene_file::load(&path).unwrap(), &BOARD.limits, BOARD.tick_hz).unwrap();
    program.header.host_timeout_s = HOST_TIMEOUT_TICKS as f32 / BOARD.tick_hz as f32;
    program
}
