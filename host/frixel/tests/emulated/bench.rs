//! An emulated board under a finger that slides for ever.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::Duration;

use frixel::rigs::EmulatedRig;
use frixel::scene_file;
use frixel_driver::{Device, Link, ignore_progress};
use frixel_exchange::BOARD;
use frixel_hil_sim::emulated::{Image, LinkBoard};
use frixel_hil_sim::{Stroke, World, WorldConfig};
use frixel_play::{connect, start};
use frixel_scene::{Program, compile};

use crate::processes::bundled;

/// Wall time between two checks of what is waited for.
const NAP: Duration = Duration::from_millis(2);
/// Two minutes of naps, more on a busy machine: whatever is waited for longer has hung.
const NAPS_MAX: u32 = 60_000;
/// A count that is the same over so many naps stands still.
const STILL_NAPS: u32 = 25;
/// Longest time of the board from a play to its first output.
const DRIVEN_WITHIN: Duration = Duration::from_secs(1);

/// One emulator at a time: it takes more than a core.
static TURN: Mutex<()> = Mutex::new(());

pub(crate) fn turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

pub(crate) struct Bench {
    pub(crate) board: LinkBoard,
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
        let board = LinkBoard::start(image, world).unwrap();
        board.start_stroke();
        Self { board, _turn: turn }
    }

    /// Connects a host, once all that the one before has sent has arrived. Dropped, it stops and disarms the board.
    pub(crate) fn connect(&self) -> Device<impl Link> {
        self.until_still("no byte arrives", |board| board.received_bytes().unwrap());
        let rig = EmulatedRig::open(&self.board).unwrap();
        connect(Box::new(rig)).unwrap()
    }

    /// Plays one of the bundled scenes, and waits until the board drives.
    pub(crate) fn play(&self, scene: &str) -> Device<impl Link> {
        let mut device = self.connect();
        start(&mut device, &program(scene), &mut ignore_progress).unwrap();
        let end = device.now() + DRIVEN_WITHIN;
        while self.board.output().unwrap().dac_code.bits() == 0 {
            assert!(device.now() < end, "the board does not drive");
            device.wait(Duration::from_millis(1), &mut |_| ()).unwrap();
        }
        device
    }

    /// Waits for something in wall time, without a call to a host.
    pub(crate) fn until(&self, what: &str, mut done: impl FnMut(&LinkBoard) -> bool) {
        for _ in 0..NAPS_MAX {
            if done(&self.board) {
                return;
            }
            sleep(NAP);
        }
        panic!("hung: {what}");
    }

    /// Waits until a count of the board has been the same for [`STILL_NAPS`].
    pub(crate) fn until_still(&self, what: &str, count: impl Fn(&LinkBoard) -> u32) {
        let (mut last, mut naps) = (None, 0);
        self.until(what, |board| {
            let now = Some(count(board));
            naps = if now == last { naps + 1 } else { 0 };
            last = now;
            naps >= STILL_NAPS
        });
    }
}

/// Host timeout of the scenes here, the longest that there is: on a busy machine pings are late.
const HOST_TIMEOUT_S: f32 = 1.0;

/// One of the bundled scenes, for the emulated board.
fn program(name: &str) -> Program {
    let mut program = compile(&scene_file::load(&bundled(name)).unwrap(), &BOARD.limits, BOARD.tick_hz).unwrap();
    program.header.host_timeout_s = HOST_TIMEOUT_S;
    program
}
