//! The coefficients that the tick reads. Everything that can be precomputed is computed when a scene is committed.

use frixel_layers::{ActiveLayers, BitmapPool, Clicks, Inputs};
use frixel_model::InverseTable;

use crate::Ceilings;
use crate::carrier::CarrierTiming;

/// Coefficients of one scene. A board has two of them: the ticker plays one, while the session computes the next scene
/// in the other.
///
/// The order of the fields matters: a field near the beginning can be loaded in one instruction.
#[repr(C)]
pub struct Active {
    /// The carrier, and the conversion from envelope to DAC codes.
    pub carrier: CarrierTiming,
    /// Largest change of the envelope in a tick, in V rms.
    pub slew_step_v: f32,
    /// Largest rms voltage within all limits, in V.
    pub voltage_max_v_rms: f32,
    /// Ticks without a frame from the host after which the board disarms.
    pub host_timeout_ticks: u32,
    /// Whether to use the last measured position of the finger. Otherwise it is extrapolated along its track.
    pub prediction_off: bool,
    /// Table from electric friction to voltage; empty without a scene.
    pub table: InverseTable,
    /// The layers.
    pub layers: ActiveLayers,
}

impl Active {
    /// Coefficients without a scene. All bits are zero, so that a static of them takes no flash.
    #[allow(clippy::new_without_default, reason = "it belongs in a static, not on the stack")]
    pub const fn new() -> Self {
        Self {
            layers: ActiveLayers::EMPTY,
            table: InverseTable::EMPTY,
            carrier: CarrierTiming::ZERO_OUTPUT,
            slew_step_v: 0.0,
            voltage_max_v_rms: 0.0,
            host_timeout_ticks: 0,
            prediction_off: false,
        }
    }

    /// Removes the scene.
    pub fn unload(&mut self) {
        self.layers.clear();
        self.table.clear();
        self.carrier = CarrierTiming::ZERO_OUTPUT;
        self.slew_step_v = 0.0;
        self.voltage_max_v_rms = 0.0;
        self.host_timeout_ticks = 0;
        self.prediction_off = false;
    }

    /// Lowers coefficients to a board's ceilings, and returns whether any was above. Ticks need not check the ceilings
    /// again, since no code exceeds the carrier's largest. Without a scene, the output is zero.
    pub(crate) fn limit_to(&mut self, ceilings: &Ceilings) -> bool {
        if self.table.is_empty() {
            return false;
        }
        let carrier = self.carrier.within(ceilings);
        let voltage_max_v_rms =
            from_zero_to(ceilings.voltage_max_v_peak(carrier.half_period_ticks), self.voltage_max_v_rms);
        let slew_step_v = from_zero_to(f32::INFINITY, self.slew_step_v);
        let host_timeout_ticks = self.host_timeout_ticks.min(ceilings.host_timeout_max_ticks);
        let is_lowered = carrier != self.carrier
            || host_timeout_ticks != self.host_timeout_ticks
            || differs(voltage_max_v_rms, self.voltage_max_v_rms)
            || differs(slew_step_v, self.slew_step_v);
        self.carrier = carrier;
        self.voltage_max_v_rms = voltage_max_v_rms;
        self.slew_step_v = slew_step_v;
        self.host_timeout_ticks = host_timeout_ticks;
        is_lowered
    }

    /// The inverse table; `None` without a scene.
    #[inline]
    pub(crate) fn table(&self) -> Option<&InverseTable> {
        if self.table.is_empty() { None } else { Some(&self.table) }
    }

    /// Whether a layer plays the host's stream.
    #[inline]
    pub(crate) fn has_stream(&self) -> bool {
        self.layers.has_stream()
    }

    /// Electric friction of all enabled layers, in N.
    #[inline]
    pub(crate) fn electric_friction_n(&self, inputs: &Inputs, pool: &BitmapPool, clicks: &mut Clicks) -> f32 {
        self.layers.electric_friction_n(inputs, pool, clicks)
    }

    /// Enables or disables a layer and sets its gain while the scene plays, from `tick` on. Unknown layer numbers are
    /// ignored.
    #[inline]
    pub(crate) fn set_layer(&mut self, number: u8, on: bool, gain: f32, tick: u32) {
        self.layers.set(number, on, gain, tick);
    }
}

/// The nearest number from zero to a maximum; zero for NaN.
fn from_zero_to(max: f32, number: f32) -> f32 {
    if number > max {
        max
    } else if number > 0.0 {
        number
    } else {
        0.0
    }
}

fn differs(one: f32, other: f32) -> bool {
    one.to_bits() != other.to_bits()
}
