//! Builds the configuration of a simulated world from its options.

use frixel_model::FrictionLaw;

use super::WorldConfig;
use crate::amplifier::AmplifierConfig;
use crate::fingertip::FingertipConfig;
use crate::touch::TouchConfig;

/// Options of a simulated world. The defaults give the realistic world, with every effect that was measured on real
/// amplifiers, fingers and touch sources.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorldOptions {
    /// Leaves out load changes, noise, pre-sliding, leakage, amplifier offsets, and the losses of the touch source.
    pub ideal: bool,
    /// Leaves out the leakage of charge through the skin.
    pub no_leakage: bool,
    /// Whether friction follows the mean squared voltage of the carrier: [`FingertipConfig::follows_mean_square`].
    pub mean_square: bool,
    /// Touch source. `None`: [`TouchConfig::REALISTIC`], or [`TouchConfig::IDEAL`] in an ideal world.
    pub touch: Option<TouchConfig>,
    /// Finger, whatever scene plays. `None`: the finger for which the scene is made.
    pub finger: Option<OwnFinger>,
}

/// A finger that replaces the scene's in the world. Board and scene keep the scene's finger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnFinger {
    /// Steady friction on the screen.
    pub law: FrictionLaw,
    /// Effects beside the contact model. An ideal world leaves them out.
    pub fingertip: FingertipConfig,
}

impl WorldConfig {
    /// This ideal world with the effects of `options`. The lags of amplifier and electrode stay.
    #[must_use]
    pub fn with(self, options: &WorldOptions) -> Self {
        let &WorldOptions { ideal, no_leakage, mean_square, touch, finger } = options;
        let own_finger = finger.map(|finger| finger.law);
        if ideal {
            let fingertip = FingertipConfig { follows_mean_square: mean_square, ..self.fingertip };
            return Self {
                own_finger,
                fingertip,
                touch: touch.map_or(self.touch, TouchConfig::without_losses),
                ..self
            };
        }
        let AmplifierConfig { output_time_constant_s, electrode_time_constant_s, .. } = self.amplifier;
        let fingertip = finger.map_or(FingertipConfig::REALISTIC, |finger| finger.fingertip);
        let fingertip = FingertipConfig { follows_mean_square: mean_square, ..fingertip };
        Self {
            own_finger,
            amplifier: AmplifierConfig {
                output_time_constant_s,
                electrode_time_constant_s,
                ..AmplifierConfig::REALISTIC
            },
            fingertip: if no_leakage { fingertip.without_leakage() } else { fingertip },
            touch: touch.unwrap_or(TouchConfig::REALISTIC),
            ..self
        }
    }
}
