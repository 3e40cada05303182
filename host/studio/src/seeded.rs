//! One seeded stroke over a scene, as a hash: equal in a page and natively, or one of the crates computes differently
//! in WebAssembly.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

use frixel_hil_sim::{BoardMemory, RigConfig, RigTick, Status, WorldOptions};
use frixel_layers::Header;

use crate::host::{connect, load, stream_mut};
use crate::host_error::HostError;
use crate::pointer::PointerSample;
use crate::pointer_stream::PointerStream;
use crate::program::touch_source;
use crate::request::Request;

/// Duration of the finger's way over the screen, ms. It repeats.
const STROKE_MS: u32 = 400;
/// Time between two samples of the pointer, ms.
const SAMPLE_MS: u32 = 8;

/// Plays the scene of a request for its duration, in a realistic world with its seed, and returns the FNV-1a hash of
/// friction, electrode voltage and DAC code at every tick.
///
/// The finger moves from the left to the right of the screen and accelerates, and begins again.
pub fn seeded_hash(request: &Request) -> Result<u64, HostError> {
    let world = WorldOptions { touch: Some(touch_source(request)?), ..WorldOptions::default() };
    let config = RigConfig::default().with(&world);
    let mut memory = BoardMemory::new();
    let hash = Rc::new(RefCell::new(Hash::new()));
    let observed = Rc::clone(&hash);
    let line = PointerStream::new(&mut memory, &config, request.numbers.seed)?;
    let mut host = connect(line.observed(move |record| observed.borrow_mut().add(record)))?;
    load(&mut host, request)?;
    let Some(header) = host.playing().map(|playing| playing.program().header) else { return Err(HostError::NoBoard) };
    host.arm_and_play()?;
    let tick_hz = f64::from(host.device().hello().tick_hz);
    slide(stream_mut(&mut host), &header, request.numbers.duration_ms, tick_hz);
    host.wait(Duration::from_millis(request.numbers.duration_ms.into()))?;
    host.stop()?;
    let found = hash.borrow().0;
    Ok(found)
}

/// Samples of the pointer from now on.
fn slide(rig: &mut PointerStream, header: &Header, duration_ms: u32, tick_hz: f64) {
    let start_tick = rig.tick() as f64;
    for t_ms in (0..=duration_ms).step_by(SAMPLE_MS as usize) {
        let part = f64::from(t_ms % STROKE_MS) / f64::from(STROKE_MS);
        let (width_m, height_m) = (f64::from(header.screen_width_m), f64::from(header.screen_height_m));
        let place_m = [width_m * (0.05 + 0.9 * part * part), height_m * (0.4 + 0.2 * part)];
        // The start tick itself has passed.
        let tick = start_tick + 1.0 + f64::from(t_ms) * 1e-3 * tick_hz;
        // The finger lifts before it begins again.
        let is_down = t_ms % STROKE_MS + SAMPLE_MS < STROKE_MS;
        rig.pointer.add(PointerSample { tick, place_m, is_down, normal_load_n: None }, start_tick);
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

    fn add(&mut self, RigTick { status, felt, .. }: &RigTick<Status>) {
        self.add_word(felt.friction_n.to_bits());
        self.add_word(felt.electrode_v.to_bits());
        self.add_word(u64::from(status.telemetry.dac_code.cast_unsigned()));
    }

    fn add_word(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(Self::PRIME);
        }
    }
}
