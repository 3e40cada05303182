//! The scene of bring-up: a square wave at a voltage.

use frixel_layers::{Blend, Constant, HEADER_LEN, Header, Layer, Leader, RECORD_LEN, Record, Region, Waveform};

/// Slow enough that a wrong gain shows before the whole voltage is there.
const SLEW_V_PER_S: f32 = 1000.0;
/// Frequency of the square wave: the lowest that a scene may have, so that most of a half period is settled.
pub(super) const CARRIER_HZ: f32 = 125.0;
/// Host timeout, s.
pub(super) const HOST_TIMEOUT_S: f32 = 0.25;
/// Electric friction of the scene, N. Its finger reaches less than 1 N at any voltage, so that the voltage is always at
/// the scene's limit.
const ELECTRIC_FRICTION_N: f32 = 100.0;

/// Offsets of a stored scene without bitmaps: the scene's length, then the scene.
const SCENE_OFFSET: usize = 8;
const STORED_LEN: usize = SCENE_OFFSET + HEADER_LEN + RECORD_LEN;

/// The scene, as the store would keep it: constant friction everywhere, far beyond what `peak_v` reaches.
pub(super) fn stored_scene(peak_v: f32) -> [u8; STORED_LEN] {
    let header = Header {
        screen_width_m: 0.1,
        screen_height_m: 0.1,
        finger_radius_m: 8e-3,
        stiffness_pa_per_m: 1.8e7,
        friction_coefficient: 0.5,
        normal_load_n: 0.5,
        effective_gap_m: 1e-5,
        voltage_max_v_rms: peak_v,
        voltage_max_v_peak: peak_v,
        slew_v_per_s: SLEW_V_PER_S,
        carrier_hz: CARRIER_HZ,
        host_timeout_s: HOST_TIMEOUT_S,
        waveform: Waveform::Square,
        autonomous: false,
        prediction: true,
        leader: Leader::First,
        layers_fixed: true,
        electric_friction_max_n: None,
        law: None,
    };
    let layer = Layer::Constant(Constant { electric_friction_n: ELECTRIC_FRICTION_N });
    let record = Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer };
    let mut bytes = [0; STORED_LEN];
    let len = ((HEADER_LEN + RECORD_LEN) as u64).to_le_bytes();
    let all = len.into_iter().chain(header.write(1, 0)).chain(record.write());
    for (to, from) in bytes.iter_mut().zip(all) {
        *to = from;
    }
    bytes
}

/// Fills `bytes` from an offset of the stored scene; `false` beyond its end.
pub(super) fn read_at(stored: &[u8], offset: u32, bytes: &mut [u8]) -> bool {
    let Some(rest) = stored.get(offset as usize..) else { return false };
    if rest.is_empty() {
        return false;
    }
    for (to, from) in bytes.iter_mut().zip(rest) {
        *to = *from;
    }
    true
}
