//! Configuration of a finger's effects beyond the contact model: lag, varying load, friction noise, charge leakage.

use core::f64::consts::TAU;

use crate::error::{OutOfRange, within, zero_to_ten};

/// Distance over which friction follows its steady value, in m: the relaxation length of Dahl's law.
///
/// The cutoff of friction rises by 13.8 Hz per mm/s of sliding speed (arXiv 2505.11162; 10 people, 20 to 100 mm/s, 0.2
/// to 0.6 N). A first-order lag in distance has its cutoff at `v / (2 pi L)`, so `L` is `1 / (2 pi 13,800)` m: 11.5 um.
pub const RELAXATION_LENGTH_M: f64 = 1.0 / (TAU * 13.8e3);

/// Configuration of the simulated finger, besides the contact model. Each effect can be switched off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingertipConfig {
    /// Relaxation length of the friction, in m: 0 (friction has its steady value at once) to 10.
    pub relaxation_length_m: f64,
    /// Whether the contact starts at rest and reverses with the motion, by Dahl's law (doi:10.2514/3.61511): friction
    /// starts at 0 at touch-down, and changes its sign over the relaxation length when the motion reverses.
    ///
    /// Without it the contact always slips fully, and only the electric friction lags.
    pub pre_sliding: bool,
    /// Standard deviation of the normal load, in N: 0 to 10.
    ///
    /// One bare finger held at 0.53 N, at 40 mm/s: 22 mN (one trial of romangrigorii/data-driven-playback).
    pub load_sd_n: f64,
    /// Exponent `p` of the friction coefficient over the load, from -2 to 2: `mu(F_N) = mu (F_N / F_0)^p`, where `F_0`
    /// is the load of the profile.
    ///
    /// In bare fingers it is negative, zero or positive, at random (Okamoto laboratory, 2022), so the default is 0. On
    /// smooth glass the friction coefficient fell to a fifth as load rose (Dzidek 2017).
    pub load_exponent: f64,
    /// Noise of the friction, in N rms over 10 to 1,000 Hz at 40 mm/s: 0 to 10. Its power spectrum is 1/f.
    ///
    /// Friction of a finger on a flat surface has 1/f noise (Wiertlewski, Hudin, Hayward 2011);
    /// 4.5 mN for one bare finger at 0.53 N and 40 mm/s (one trial of romangrigorii/data-driven-playback).
    pub noise_rms_n: f64,
    /// Frequency below which charge leaks through the skin faster than the drive alternates, in Hz: 0 (no leakage) to
    /// 10,000. The voltage across the gap is the electrode voltage after a first-order high-pass.
    ///
    /// Leakage dominates below 250 Hz (arXiv 2409.18725). Others found a small effect of the frequency from 30 to 230
    /// Hz (4TU 08aa3d2d), or no corner (Meyer, Peshkin, Colgate 2013): [`Self::without_leakage`] corresponds to their
    /// results.
    pub leakage_hz: f64,
    /// Whether friction follows the mean squared voltage of half a carrier period, rather than that of each tick.
    ///
    /// Unmeasured. The board's table is made for friction that follows the tick: under a sine, a finger that follows
    /// the mean square feels about a tenth less at 130 mN.
    pub follows_mean_square: bool,
}

impl FingertipConfig {
    /// A finger in steady sliding under a constant load: only the contact model, and the measured lag of the electric
    /// friction.
    pub const IDEAL: Self = Self {
        relaxation_length_m: RELAXATION_LENGTH_M,
        pre_sliding: false,
        load_sd_n: 0.0,
        load_exponent: 0.0,
        noise_rms_n: 0.0,
        leakage_hz: 0.0,
        follows_mean_square: false,
    };

    /// A finger with every measured effect.
    pub const REALISTIC: Self = Self {
        relaxation_length_m: RELAXATION_LENGTH_M,
        pre_sliding: true,
        load_sd_n: 22e-3,
        load_exponent: 0.0,
        noise_rms_n: 4.5e-3,
        leakage_hz: 250.0,
        follows_mean_square: false,
    };

    /// This finger without charge leakage.
    #[must_use]
    pub fn without_leakage(self) -> Self {
        Self { leakage_hz: 0.0, ..self }
    }

    pub(super) fn validate(&self) -> Result<(), OutOfRange> {
        zero_to_ten("finger relaxation_length_m", self.relaxation_length_m)?;
        zero_to_ten("finger load_sd_n", self.load_sd_n)?;
        within("finger load_exponent", -2.0..=2.0, "from -2 to 2", self.load_exponent)?;
        zero_to_ten("finger noise_rms_n", self.noise_rms_n)?;
        within("finger leakage_hz", 0.0..=10e3, "from 0 to 10,000", self.leakage_hz)?;
        Ok(())
    }
}

impl Default for FingertipConfig {
    /// [`Self::IDEAL`].
    fn default() -> Self {
        Self::IDEAL
    }
}
