//! The envelope: the rms voltage that the carrier carries, moving no faster than its slew limit.

/// The envelope's state.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Envelope {
    voltage_v_rms: f32,
}

impl Envelope {
    pub(crate) fn voltage_v_rms(&self) -> f32 {
        self.voltage_v_rms
    }

    /// Sets the voltage to zero at once, without the slew limit.
    pub(crate) fn reset_to_zero(&mut self) {
        self.voltage_v_rms = 0.0;
    }

    /// Lowers the voltage at once to the limit of a new scene.
    pub(crate) fn limit(&mut self, voltage_max_v_rms: f32) {
        self.voltage_v_rms = self.voltage_v_rms.min(voltage_max_v_rms);
    }

    /// Moves towards `target_v_rms` by at most `step_max_v`. Returns whether the target was further away than that.
    #[inline]
    pub(crate) fn follow(&mut self, target_v_rms: f32, step_max_v: f32) -> bool {
        let (lowest_v_rms, highest_v_rms) = (self.voltage_v_rms - step_max_v, self.voltage_v_rms + step_max_v);
        let (voltage_v_rms, too_far) = if target_v_rms > highest_v_rms {
            (highest_v_rms, true)
        } else if target_v_rms < lowest_v_rms {
            (lowest_v_rms, true)
        } else {
            (target_v_rms, false)
        };
        self.voltage_v_rms = voltage_v_rms;
        too_far
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_moves_by_the_step_at_most_and_arrives_exactly() {
        let mut envelope = Envelope::default();
        let slewed: Vec<bool> = (0..4).map(|_| envelope.follow(7.0, 2.0)).collect();
        assert_eq!(slewed, [true, true, true, false]);
        assert_eq!(envelope.voltage_v_rms().to_bits(), 7.0_f32.to_bits());
        assert!(envelope.follow(0.0, 2.0));
        assert_eq!(envelope.voltage_v_rms().to_bits(), 5.0_f32.to_bits());
        envelope.reset_to_zero();
        assert_eq!(envelope.voltage_v_rms().to_bits(), 0);
    }

    #[test]
    fn a_step_of_just_the_limit_is_not_too_far() {
        let mut envelope = Envelope::default();
        assert!(!envelope.follow(2.0, 2.0));
        assert!(!envelope.follow(0.0, 2.0));
        assert!(!envelope.follow(0.0, 0.0));
    }

    #[test]
    fn a_new_limit_lowers_it_at_once_and_never_raises_it() {
        let mut envelope = Envelope::default();
        envelope.follow(7.0, 10.0);
        envelope.limit(5.0);
        assert_eq!(envelope.voltage_v_rms().to_bits(), 5.0_f32.to_bits());
        envelope.limit(20.0);
        assert_eq!(envelope.voltage_v_rms().to_bits(), 5.0_f32.to_bits());
    }
}
