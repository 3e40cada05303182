//! The header that several tests share.
#![allow(unreachable_pub)]

use frixel_layers::{Header, Leader, Waveform};

pub fn header() -> Header {
    Header {
        screen_width_m: 0.1,
        screen_height_m: 0.0625,
        finger_radius_m: 0.008,
        stiffness_pa_per_m: 1e8,
        friction_coefficient: 0.5,
        normal_load_n: 0.5,
        effective_gap_m: 250e-9,
        voltage_max_v_rms: 150.0,
        voltage_max_v_peak: 160.0,
        slew_v_per_s: 100_000.0,
        carrier_hz: 1_000.0,
        host_timeout_s: 0.25,
        waveform: Waveform::Square,
        autonomous: false,
        prediction: true,
        leader: Leader::First,
        layers_fixed: false,
        electric_friction_max_n: None,
        law: None,
    }
}
