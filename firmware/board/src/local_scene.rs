//! Stored scenes for a [`LocalHost`](crate::local_host::LocalHost).

use frixel_layers::{HEADER_LEN, Header, Leader, RECORD_LEN, Record, Waveform};

use crate::local_host::HOST_TIMEOUT_S;

/// Slow enough that a wrong gain shows before the whole voltage is there.
const SLEW_V_PER_S: f32 = 1000.0;
/// Frequency of the square wave: the lowest that a scene may have, so that most of a half period is settled.
pub(crate) const CARRIER_HZ: f32 = 125.0;
/// Electric friction, N, that the finger of [`header`] reaches at no voltage, so that the voltage is always at the
/// scene's limit.
pub(crate) const OUT_OF_REACH_N: f32 = 100.0;

/// Bytes of a stored scene without bitmaps in front of the scene: its length.
const SCENE_OFFSET: usize = 8;

/// Bytes of a stored scene with so many layers.
pub(crate) const fn stored_len(layers: usize) -> usize {
    SCENE_OFFSET + HEADER_LEN + layers * RECORD_LEN
}

/// The header of a scene that drives up to `peak_v` with a square carrier.
pub(crate) fn header(peak_v: f32) -> Header {
    Header {
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
    }
}

/// A scene as the store would keep it; `LEN` is [`stored_len`] of the largest number of records.
pub(crate) fn stored<const LEN: usize>(header: &Header, records: &[Record]) -> heapless::Vec<u8, LEN> {
    let len = ((HEADER_LEN + RECORD_LEN * records.len()) as u64).to_le_bytes();
    let head = header.write(records.len() as u8, 0);
    len.into_iter().chain(head).chain(records.iter().flat_map(Record::write)).take(LEN).collect()
}
