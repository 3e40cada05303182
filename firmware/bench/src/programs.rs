//! Random scenes that a board accepts, each played under a random finger: no tick may exceed the loader's estimate.
//!
//! The emulator's command line consists of `programs`, the pace of the touch source (`usual` or `fast`), the first
//! seed and the number of seeds. Every line of output is a seed, the instructions of the longest tick, the core cycles
//! that the loader estimates, and the number of that tick.

use core::str;

use cortex_m_semihosting::hprintln;
use frixel_layers::Layer;
use frixel_session::Touch;
use frixel_testkit::{Pace, RandomFinger, RandomScene};

use crate::count::{Case, Counter};
use crate::tick::{Bench, PING_TICKS, STREAM_TICKS};

/// Number of ticks counted for each scene.
const TICKS: u32 = 2_000;

/// The requested seeds.
pub struct Seeds {
    pace: Pace,
    first: u64,
    count: u64,
}

impl Seeds {
    /// Parses the emulator's command line; `None` when it requests something else.
    pub fn of_command_line(line: &[u8]) -> Option<Self> {
        let line = str::from_utf8(line).ok()?;
        let mut words = line.split_ascii_whitespace().skip_while(|word| *word != "programs").skip(1);
        let pace = match words.next()? {
            "usual" => Pace::Usual,
            "fast" => Pace::Fast,
            _ => return None,
        };
        let mut number = || words.next()?.parse().ok();
        Some(Self { pace, first: number()?, count: number()? })
    }
}

/// Plays the scenes of all seeds.
pub fn run(seeds: &Seeds, counter: &mut Counter) {
    let mut bench = Bench::new();
    let crc32 = bench.picture();
    for seed in seeds.first..seeds.first + seeds.count {
        // A debugger can trace a scene that is played alone.
        let case = if seeds.count == 1 { counter.case("") } else { Case::unfollowed() };
        bench.play_random(seed, seeds.pace, crc32, case);
    }
}

impl Bench {
    fn play_random(&mut self, seed: u64, pace: Pace, crc32: u32, mut case: Case) {
        let scene = RandomScene::new(seed, crc32);
        let estimated_core_cycles = scene.worst_tick().core_cycles;
        self.play_bytes(&scene.bytes());
        if scene.records.iter().any(|record| matches!(record.layer, Layer::Stream(_))) {
            self.start_stream();
        }
        let mut finger = RandomFinger::new(seed, &scene.header, pace);
        self.tick(Some(Touch::Up));
        for tick in 0..TICKS {
            if tick.is_multiple_of(PING_TICKS / 2) {
                self.host.ping();
            }
            if tick.is_multiple_of(STREAM_TICKS) {
                self.host.stream(tick / STREAM_TICKS);
            }
            let touch = finger.tick();
            self.count(&mut case, touch);
        }
        let (instructions, tick) = case.worst();
        hprintln!("{} {} {} {}", seed, instructions, estimated_core_cycles, tick);
    }
}
