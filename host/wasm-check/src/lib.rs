//! Plays bundled scenes on the in-process rig and hashes what the finger felt.
//!
//! The library is built for `wasm32-unknown-unknown` and run by node (`run.mjs`), and is also run natively by the
//! program of the same name. If the hashes differ, one of the three libraries computes differently in WebAssembly.
//! `cargo xtask portability` runs both. Compiling for WebAssembly is not enough: a call to a clock or a file system
//! compiles, and fails at run time.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::time::Duration;

use frixel_driver::{Bitmap, ByteStream, Device, LinkClosed, PollingLink, Upload};
use frixel_hil_sim::{BoardMemory, FingerState, Point, Rig, RigConfig, Stroke, TickRecord};
use frixel_scene::{Scene, compile};

/// Scenes that cover pictures, waves, clicks and noise.
const SCENES: [(&str, &str); 4] = [
    ("brick.toml", include_str!("../../../scenes/brick.toml")),
    ("grating.toml", include_str!("../../../scenes/grating.toml")),
    ("keyboard.toml", include_str!("../../../scenes/keyboard.toml")),
    ("sandpaper.toml", include_str!("../../../scenes/sandpaper.toml")),
];
const BRICK_PNG: &[u8] = include_bytes!("../../../scenes/textures/brick.png");

/// Duration of each scene in virtual time.
const PLAY_TIME: Duration = Duration::from_millis(200);
/// Duration of the finger's stroke of 100 mm, s.
const STROKE_S: f64 = 0.5;
const ACCELERATION_M_PER_S2: f64 = 0.8;
const TICK_HZ: f64 = 40_000.0;

/// Returns the hash for WebAssembly, exported as a plain number.
///
/// # Panics
///
/// Panics if a scene does not play. In WebAssembly a panic is a trap, which node reports.
#[allow(unsafe_code, reason = "an export needs a name that the linker keeps, and this crate has no other")]
#[unsafe(no_mangle)]
pub extern "C" fn frixel_scenes_hash() -> u64 {
    #[allow(clippy::expect_used, reason = "a failure leaves a module without imports as a trap")]
    scenes_hash().expect("every scene plays")
}

/// Plays every scene, and returns a hash of friction, electrode voltage and DAC code at every tick.
pub fn scenes_hash() -> Result<u64, String> {
    let mut hash = Hash::new();
    for (name, text) in SCENES {
        play(name, text, &mut hash).map_err(|error| format!("{name}: {error}"))?;
    }
    Ok(hash.0)
}

fn play(name: &str, text: &str, hash: &mut Hash) -> Result<(), String> {
    let config = RigConfig::default();
    let pictures = BTreeMap::from([("textures/brick.png".to_owned(), BRICK_PNG.to_vec())]);
    let scene = Scene::parse(text, name, &pictures).map_err(message)?;
    let program = compile(&scene, &config.board.limits, config.board.tick_hz).map_err(message)?;

    // The finger is positioned from outside, as by a web page; the rig's own stroke never starts.
    let stroke = Stroke::still(Point { x_m: 0.0, y_m: 0.0 }, 1.0).map_err(message)?;
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &config, stroke, 1).map_err(message)?;
    let mut device = Device::connect(PollingLink::new(RigLine { rig, hash })).map_err(message)?;

    let scene_bytes = program.scene_bytes_for(device.hello().protocol);
    let bitmaps = program.bitmaps.iter().map(|bitmap| Bitmap {
        crc32: bitmap.crc32,
        width: bitmap.width,
        height: bitmap.height,
        samples: &bitmap.samples,
    });
    let upload = Upload { scene: &scene_bytes, bitmaps: bitmaps.collect() };
    device.upload(&upload, &mut |_| {}).map_err(message)?;
    device.commit(upload.scene_crc32()).map_err(message)?;
    device.arm().map_err(message)?;
    device.play().map_err(message)?;
    device.wait(PLAY_TIME, &mut |_| {}).map_err(message)?;
    device.stop().map_err(message)
}

fn message(error: impl Display) -> String {
    error.to_string()
}

/// The line to the in-process rig, on the rig's clock.
struct RigLine<'a> {
    rig: Rig<'a>,
    hash: &'a mut Hash,
}

impl RigLine<'_> {
    fn step(&mut self) {
        // The finger repeatedly moves from the left to the right edge, accelerating.
        let t_s = (self.rig.tick() as f64 / TICK_HZ) % STROKE_S;
        let way_m = 0.5 * ACCELERATION_M_PER_S2 * t_s * t_s;
        let speed_m_per_s = ACCELERATION_M_PER_S2 * t_s;
        self.rig.world_mut().place_finger(FingerState { x_m: 0.01 + way_m, y_m: 0.03 + 0.3 * way_m, speed_m_per_s });
        let TickRecord { status, felt, .. } = self.rig.step();
        self.hash.add(felt.friction_n.to_bits());
        self.hash.add(felt.electrode_v.to_bits());
        self.hash.add(u64::from(status.telemetry.dac_code.cast_unsigned()));
    }
}

impl ByteStream for RigLine<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        self.rig.send(bytes);
        Ok(())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.now() + wait;
        while !self.rig.has_received() && self.now() < end {
            self.step();
        }
        self.rig.receive(buffer);
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_secs(self.rig.tick()) / self.rig.tick_hz()
    }

    fn name(&self) -> &'static str {
        "the in-process rig"
    }
}

/// FNV-1a with 64 bits (draft-eastlake-fnv), word by word.
struct Hash(u64);

impl Hash {
    const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01b3;

    fn new() -> Self {
        Self(Self::OFFSET_BASIS)
    }

    fn add(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(Self::PRIME);
        }
    }
}
