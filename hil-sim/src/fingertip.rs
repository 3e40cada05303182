//! The fingertip: converts the voltage on the electrode to friction.
//!
//! The contact model gives the steady friction at a voltage. The skin follows it with a first-order lag whose cutoff
//! frequency grows with sliding speed.

use core::f64::consts::TAU;

use frixel_model::{Contact, Finger, LoadedContact, ParameterError};

/// Cutoff frequency of the friction lag over sliding speed, in Hz per m/s: 13.8 Hz per mm/s, arXiv 2505.11162.
///
/// Measured at 20 to 100 mm/s and 0.2 to 0.6 N. The simulator uses it as a straight line through zero at every speed,
/// so the friction of a still finger does not change.
const CUTOFF_HZ_PER_M_PER_S: f64 = 13.8e3;

/// Below this distance from its target, in newtons, the friction is set to the target. Otherwise the decay would reach
/// subnormal numbers, which are slow and never become zero.
const SETTLED_N: f64 = 1e-15;

/// The example finger: 0.25 N at no voltage and 28 mN more at 150 V rms, under a load of 0.5 N.
///
/// Radius 8 mm, stiffness 18 MPa/m, friction coefficient 0.5, effective gap 10 um: computed from Eqs. (43), (21) to
/// give friction of the size that is measured. The profile of a real finger is fitted to measurements.
pub fn example_finger() -> Result<LoadedContact<f64>, ParameterError> {
    let finger = Finger { radius_m: 8e-3, stiffness_pa_per_m: 1.8e7, friction_coefficient: 0.5 };
    Contact::new(&finger, 10e-6)?.under_load(0.5)
}

/// Friction that follows its target with a first-order lag.
#[derive(Clone, Debug)]
struct FrictionLag {
    /// `2 pi f_c T` over sliding speed.
    exponent_per_m_per_s: f64,
    /// Speed that `share` was computed for. It is stored because an exponential costs as much as the rest of the tick.
    speed_m_per_s: f64,
    /// Share of the distance to the target that is covered in a tick, `1 - e^(-2 pi f_c T)`.
    share: f64,
    electric_friction_n: f64,
}

impl FrictionLag {
    fn new(tick_hz: u32) -> Self {
        Self {
            exponent_per_m_per_s: TAU * CUTOFF_HZ_PER_M_PER_S / f64::from(tick_hz),
            speed_m_per_s: 0.0,
            share: 0.0,
            electric_friction_n: 0.0,
        }
    }

    /// Advances the lag by one tick, exactly, with constant target and speed.
    fn tick(&mut self, target_n: f64, speed_m_per_s: f64) -> f64 {
        if speed_m_per_s.to_bits() != self.speed_m_per_s.to_bits() {
            self.speed_m_per_s = speed_m_per_s;
            self.share = -libm::expm1(-self.exponent_per_m_per_s * speed_m_per_s);
        }
        let distance_n = target_n - self.electric_friction_n;
        self.electric_friction_n =
            if distance_n.abs() < SETTLED_N { target_n } else { self.electric_friction_n + self.share * distance_n };
        self.electric_friction_n
    }
}

/// Friction under the finger, in newtons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Friction {
    /// Total friction: `mu F_N` and the electric part.
    pub(crate) friction_n: f64,
    /// Friction that the voltage adds, after the lag.
    pub(crate) electric_friction_n: f64,
}

/// A finger's contact with the screen, and the friction on it.
#[derive(Clone, Debug)]
pub(crate) struct Fingertip {
    contact: LoadedContact<f64>,
    lag: FrictionLag,
}

impl Fingertip {
    pub(crate) fn new(contact: LoadedContact<f64>, tick_hz: u32) -> Self {
        Self { contact, lag: FrictionLag::new(tick_hz) }
    }

    /// Changes finger, profile or load; the friction follows with the lag.
    pub(crate) fn set_contact(&mut self, contact: LoadedContact<f64>) {
        self.contact = contact;
    }

    /// Returns the friction at the end of a tick, for the mean square voltage and the sliding speed during the tick.
    ///
    /// The electrostatic pressure follows the squared voltage, Eq. (8), so only its mean over the tick matters.
    pub(crate) fn slide(&mut self, mean_square_v2: f64, speed_m_per_s: f64) -> Friction {
        let target_n = self.contact.electric_friction_n(mean_square_v2.sqrt());
        let electric_friction_n = self.lag.tick(target_n, speed_m_per_s);
        Friction { friction_n: self.contact.natural_friction_n() + electric_friction_n, electric_friction_n }
    }

    /// Lifts the finger: there is no friction, and the next touch starts without electric friction.
    pub(crate) fn lift(&mut self) -> Friction {
        self.lag.electric_friction_n = 0.0;
        Friction { friction_n: 0.0, electric_friction_n: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_cmp, reason = "what has to be exact is tested as exact")]

    use core::f64::consts::{FRAC_1_SQRT_2, TAU};

    use super::{Fingertip, FrictionLag, example_finger};

    const TICK_HZ: u32 = 40_000;

    fn fingertip() -> Fingertip {
        Fingertip::new(example_finger().unwrap(), TICK_HZ)
    }

    #[test]
    fn the_example_finger_has_the_friction_that_the_notes_say() {
        let contact = example_finger().unwrap();
        assert_eq!(contact.natural_friction_n(), 0.25);
        let electric_friction_n = contact.electric_friction_n(150.0);
        assert!((electric_friction_n - 28e-3).abs() < 0.5e-3, "{electric_friction_n}");
    }

    /// Amplitude ratio of the lag for a sine of `frequency_hz` on top of a constant, from its samples.
    fn gain(frequency_hz: f64, speed_m_per_s: f64) -> f64 {
        const PERIODS: f64 = 40.0;
        let mut lag = FrictionLag::new(TICK_HZ);
        let ticks_per_period = f64::from(TICK_HZ) / frequency_hz;
        let settling = (10.0 * ticks_per_period) as u32;
        let (mut in_phase, mut quadrature) = (0.0, 0.0);
        let counted = (PERIODS * ticks_per_period) as u32;
        for tick in 0..settling + counted {
            let phase = TAU * f64::from(tick) / ticks_per_period;
            let felt = lag.tick(1.0 + libm::sin(phase), speed_m_per_s) - 1.0;
            if tick >= settling {
                in_phase += felt * libm::sin(phase);
                quadrature += felt * libm::cos(phase);
            }
        }
        2.0 * libm::hypot(in_phase, quadrature) / f64::from(counted)
    }

    #[test]
    fn friction_lag_has_its_half_power_point_where_it_was_measured() {
        for (speed_m_per_s, cutoff_hz) in [(0.02, 276.0), (0.05, 690.0), (0.1, 1380.0)] {
            let (mut low_hz, mut high_hz) = (10.0, 5000.0);
            while high_hz - low_hz > 1.0 {
                let middle_hz = 0.5 * (low_hz + high_hz);
                if gain(middle_hz, speed_m_per_s) > FRAC_1_SQRT_2 { low_hz = middle_hz } else { high_hz = middle_hz }
            }
            assert!((low_hz / cutoff_hz - 1.0).abs() < 0.01, "{low_hz} Hz at {speed_m_per_s} m/s");
        }
    }

    #[test]
    fn friction_takes_the_lag_s_share_of_a_step_whatever_the_tick() {
        // 1 - 1/e after one time constant 1/(2 pi 1380 Hz), in 4 and in 400 ticks.
        for ticks in [4, 400] {
            let tick_hz = (TAU * 1380.0 * f64::from(ticks)).round();
            let mut lag = FrictionLag::new(tick_hz as u32);
            let felt_n = (0..ticks).map(|_| lag.tick(1.0, 0.1)).last().unwrap();
            assert!((felt_n - 0.632_120_558_828_557_7).abs() < 1e-4, "{felt_n} in {ticks} ticks");
        }
    }

    #[test]
    fn a_still_finger_keeps_the_friction_it_has() {
        let mut fingertip = fingertip();
        let moving = (0..10).map(|_| fingertip.slide(10_000.0, 0.05)).last().unwrap();
        assert!(moving.electric_friction_n > 0.0);
        for _ in 0..1000 {
            assert_eq!(fingertip.slide(0.0, 0.0), moving);
        }
        assert!(fingertip.slide(0.0, 0.05).electric_friction_n < moving.electric_friction_n);
    }

    #[test]
    fn a_change_of_speed_takes_effect_at_once() {
        let mut fingertip = fingertip();
        let mut rise_n = |speed_m_per_s| {
            fingertip.lift();
            fingertip.slide(10_000.0, speed_m_per_s).electric_friction_n
        };
        let slow_n = rise_n(0.001);
        assert!(rise_n(0.1) > 50.0 * slow_n);
        assert_eq!(rise_n(0.001), slow_n);
    }

    #[test]
    fn a_lifted_finger_feels_nothing_and_starts_afresh() {
        let mut fingertip = fingertip();
        for _ in 0..1000 {
            fingertip.slide(10_000.0, 0.1);
        }
        let lifted = fingertip.lift();
        assert_eq!((lifted.friction_n, lifted.electric_friction_n), (0.0, 0.0));
        let touching = fingertip.slide(10_000.0, 0.0);
        assert_eq!((touching.friction_n, touching.electric_friction_n), (0.25, 0.0));
    }

    #[test]
    fn friction_without_voltage_decays_to_exactly_natural() {
        let mut fingertip = fingertip();
        for _ in 0..1000 {
            fingertip.slide(10_000.0, 0.1);
        }
        let last = (0..1000).map(|_| fingertip.slide(0.0, 0.1)).last().unwrap();
        assert_eq!((last.friction_n, last.electric_friction_n), (0.25, 0.0));
    }
}
