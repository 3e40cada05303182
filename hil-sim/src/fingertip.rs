//! The fingertip: converts the voltage on the electrode to friction.
//!
//! The contact model gives the steady friction at a voltage and a load. [`FingertipConfig`] adds effects beyond the
//! model, each with a switch: a varying load, a load-dependent friction coefficient, noise, the distance over which
//! friction follows, and charge leakage through the skin.

mod config;
mod leakage;
mod load;
mod mean_square;
mod noise;
mod sliding;

use frixel_model::{Contact, Finger, FrictionLaw, LoadedContact, ParameterError};

use crate::amplifier::Output;
use crate::error::OutOfRange;
use crate::stroke::FingerState;
use crate::world::Felt;
pub use config::{FingertipConfig, RELAXATION_LENGTH_M};
use leakage::Leakage;
use load::LoadWander;
use mean_square::MeanSquare;
use noise::FrictionNoise;
use sliding::Sliding;
pub use sliding::{SlipStep, one_minus_exp};

/// Smallest voltage at which electric friction under two loads is compared, V rms.
const COMPARED_V_RMS: f64 = 1.0;

/// The example finger on the example screen: 0.25 N at no voltage and 130 mN more at 150 V rms, under a load of 0.5 N.
///
/// Radius 8 mm, stiffness 18 MPa/m, friction coefficient 0.5, a coating of 1 um of silicon dioxide and a skin gap of
/// 4.74 um: the profile of `scenes/fingers/example.toml`, which gives the reasons. The profile is assumed.
pub fn example_finger() -> Result<LoadedContact<f64>, ParameterError> {
    let (coating_gap_um, skin_gap_um) = (1.0 / 3.9, 4.74);
    Contact::new(&Finger::<f64>::EXAMPLE, 1e-6 * (coating_gap_um + skin_gap_um))?.under_load(0.5)
}

/// Difference between the friction under the current load and under the load of the scene's finger.
#[derive(Clone, Copy, Debug, Default)]
struct LoadMismatch {
    /// Difference of natural friction in steady sliding, without noise, N.
    natural_n: f64,
    /// Fraction of the electric friction caused by the different load.
    electric_share: f64,
}

/// A finger's contact with the screen, and the friction on it.
#[derive(Clone, Debug)]
pub(crate) struct Fingertip {
    config: FingertipConfig,
    /// The finger under the load of the profile.
    profile: FrictionLaw,
    /// The load of the profile, N.
    profile_load_n: f64,
    /// The load of the finger that the scene is compiled for, in N.
    scene_load_n: f64,
    /// The finger under the load of this tick.
    law: FrictionLaw,
    /// The load of this tick, in N.
    load_n: f64,
    /// Friction coefficient at the load of this tick over that of the profile.
    coefficient_gain: f64,
    electric_gain: f64,
    load_mismatch: LoadMismatch,
    wander: LoadWander,
    noise: FrictionNoise,
    leakage: Leakage,
    mean_square: MeanSquare,
    sliding: Sliding,
    natural_n: [f64; 2],
    electric_n: [f64; 2],
    tick_period_s: f64,
}

impl Fingertip {
    pub(crate) fn new(config: FingertipConfig, law: FrictionLaw, tick_hz: u32, seed: u64) -> Result<Self, OutOfRange> {
        config.validate()?;
        Ok(Self {
            config,
            profile: law,
            profile_load_n: law.normal_load_n(),
            scene_load_n: law.normal_load_n(),
            law,
            load_n: law.normal_load_n(),
            coefficient_gain: 1.0,
            electric_gain: 1.0,
            load_mismatch: LoadMismatch::default(),
            wander: LoadWander::new(config.load_sd_n, tick_hz, seed),
            noise: FrictionNoise::new(config.noise_rms_n, seed),
            leakage: Leakage::new(config.leakage_hz, tick_hz),
            mean_square: MeanSquare::default(),
            sliding: Sliding::new(config.relaxation_length_m, config.pre_sliding, tick_hz),
            natural_n: [0.0; 2],
            electric_n: [0.0; 2],
            tick_period_s: 1.0 / f64::from(tick_hz),
        })
    }

    /// Steady friction.
    pub(crate) fn law(&self) -> &FrictionLaw {
        &self.law
    }

    /// Changes finger, profile or load; the friction follows with the lag.
    pub(crate) fn set_law(&mut self, law: FrictionLaw) {
        self.profile = law;
        self.profile_load_n = law.normal_load_n();
        self.law = law;
        self.load_n = self.profile_load_n;
        (self.coefficient_gain, self.electric_gain) = (1.0, 1.0);
    }

    /// Sets the load of the finger that the scene is compiled for.
    pub(crate) fn set_scene_load(&mut self, law: &FrictionLaw) {
        self.scene_load_n = law.normal_load_n();
    }

    /// Sets the carrier's half period. Friction follows the mean square over it if configured, or if the law is
    /// empirical, since measured friction is already a mean.
    pub(crate) fn set_half_period(&mut self, ticks: u32) {
        let is_mean = self.config.follows_mean_square || matches!(self.profile, FrictionLaw::Empirical(_));
        self.mean_square.set_window(if is_mean { ticks } else { 0 });
    }

    /// Slides to `finger` in a tick, over an electrode with the voltage of `output`. `measured_load_n`, if any,
    /// replaces the varying load.
    ///
    /// The electrostatic pressure follows the squared voltage, Eq. (8), so only its mean over the tick matters; or over
    /// half a carrier period, see [`FingertipConfig::follows_mean_square`].
    pub(crate) fn slide(&mut self, output: &Output, finger: &FingerState, measured_load_n: Option<f64>) -> Felt {
        let voltage_v_rms = self.mean_square.tick(self.leakage.tick(output)).sqrt();
        if self.wander.tick() {
            self.press(measured_load_n, voltage_v_rms);
        }
        let (share, direction) = self.sliding.to([finger.x_m, finger.y_m], finger.speed_m_per_s);
        let slip = SlipStep { share, direction, electric_gain: self.electric_gain };
        let steady_electric_n = self.coefficient_gain * self.law.electric_friction_n(voltage_v_rms);
        let electric_friction_n = slip.advance(&mut self.electric_n, steady_electric_n);
        let LoadMismatch { natural_n, electric_share } = self.load_mismatch;
        let natural_friction_n = self.natural_friction_n(&slip, finger.speed_m_per_s);
        Felt {
            finger: Some(*finger),
            friction_n: natural_friction_n + electric_friction_n,
            natural_friction_n,
            electric_friction_n,
            normal_load_n: self.load_n,
            load_mismatch_n: natural_n + electric_share * electric_friction_n,
            slip,
            electrode_v: output.end_v,
            mean_square_v2: output.mean_square_v2,
        }
    }

    /// Lifts the finger: there is no friction, and the next touch starts without any.
    pub(crate) fn lift(&mut self, output: &Output) -> Felt {
        self.leakage.lift();
        self.mean_square.lift();
        self.sliding.lift();
        (self.natural_n, self.electric_n) = ([0.0; 2], [0.0; 2]);
        Felt {
            finger: None,
            friction_n: 0.0,
            natural_friction_n: 0.0,
            electric_friction_n: 0.0,
            normal_load_n: 0.0,
            load_mismatch_n: 0.0,
            slip: SlipStep::REST,
            electrode_v: output.end_v,
            mean_square_v2: output.mean_square_v2,
        }
    }

    fn natural_friction_n(&mut self, slip: &SlipStep, speed_m_per_s: f64) -> f64 {
        let mut steady_n = self.coefficient_gain * self.law.natural_friction_n();
        if self.config.noise_rms_n > 0.0 {
            steady_n = (steady_n + self.noise.slide(speed_m_per_s * self.tick_period_s)).max(0.0);
        }
        if self.config.pre_sliding { slip.advance(&mut self.natural_n, steady_n) } else { steady_n }
    }

    /// Presses with the current load.
    fn press(&mut self, measured_load_n: Option<f64>, voltage_v_rms: f64) {
        let load_n = measured_load_n.unwrap_or_else(|| self.wander.load_n(self.profile_load_n));
        let compared_v_rms = voltage_v_rms.max(COMPARED_V_RMS);
        // Keep the previous load if the model refuses this one.
        let Ok(law) = self.profile.under_load(load_n) else { return };
        if law != self.law {
            self.law = law;
            self.load_n = load_n;
            self.coefficient_gain = self.coefficient_gain_at(load_n);
            let in_profile_n = self.profile.electric_friction_n(compared_v_rms);
            self.electric_gain = self.coefficient_gain * self.law.electric_friction_n(compared_v_rms) / in_profile_n;
        }
        self.load_mismatch = self.load_mismatch(compared_v_rms).unwrap_or_default();
    }

    /// Friction coefficient at a load over that at the load of the profile.
    fn coefficient_gain_at(&self, load_n: f64) -> f64 {
        let exponent = self.config.load_exponent;
        if exponent == 0.0 || self.profile_load_n <= 0.0 {
            1.0
        } else {
            libm::pow(load_n / self.profile_load_n, exponent)
        }
    }

    /// The effect of the current load on friction; `None` if it equals the load of the scene's finger.
    fn load_mismatch(&self, compared_v_rms: f64) -> Option<LoadMismatch> {
        if (self.load_n - self.scene_load_n).abs() <= f64::EPSILON * self.scene_load_n {
            return None;
        }
        let in_scene = self.profile.under_load(self.scene_load_n).ok()?;
        let scene_gain = self.coefficient_gain_at(self.scene_load_n);
        let natural_n = self.coefficient_gain * self.law.natural_friction_n();
        let electric_n = self.coefficient_gain * self.law.electric_friction_n(compared_v_rms);
        Some(LoadMismatch {
            natural_n: natural_n - scene_gain * in_scene.natural_friction_n(),
            electric_share: 1.0 - scene_gain * in_scene.electric_friction_n(compared_v_rms) / electric_n,
        })
    }
}

#[cfg(test)]
mod tests;
