//! Scenes for a [`LocalHost`](crate::local_host::LocalHost).

use frixel_layers::{HEADER_LEN, Header, Leader, RECORD_LEN, Record, Waveform};

use crate::local_host::HOST_TIMEOUT_S;

/// Slew limit, slow enough that a wrong gain shows before the full voltage is reached, V/s.
const SLEW_V_PER_S: f32 = 1000.0;
/// Frequency of the square wave, Hz: the lowest that a scene may have, so that most of a half period is settled.
pub(crate) const CARRIER_HZ: f32 = 125.0;
/// Electric friction, N, beyond the reach of [`header`]'s finger, so that the voltage is always at the scene's limit.
pub(crate) const OUT_OF_REACH_N: f32 = 100.0;

/// Bytes of a scene with `layers` layers.
pub(crate) const fn scene_len(layers: usize) -> usize {
    HEADER_LEN + layers * RECORD_LEN
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
        prediction: true,
        leader: Leader::First,
        layers_fixed: true,
        electric_friction_max_n: None,
        law: None,
    }
}

/// The bytes of a scene; `LEN` is [`scene_len`] of the largest number of records.
pub(crate) fn scene<const LEN: usize>(header: &Header, records: &[Record]) -> heapless::Vec<u8, LEN> {
    let head = header.write(records.len() as u8, 0);
    head.into_iter().chain(records.iter().flat_map(Record::write)).take(LEN).collect()
}
