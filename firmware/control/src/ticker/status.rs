//! The ticker's status report.

use frixel_wire::fault::{Flags, State};
use frixel_wire::message::Telemetry;

use super::{Ticker, is_out_of_reach};
use crate::finger::Finger;
use crate::order::Counters;
use crate::{Status, Track};

impl Ticker<'_> {
    /// The state of the supervisor.
    pub fn state(&self) -> State {
        self.supervisor.state()
    }

    /// Whether the arm switch must be released before the board can be armed. A board without a person at the switch,
    /// such as a simulated one, holds the switch whenever this is `false`, so that only the host decides.
    pub fn waits_for_release(&self) -> bool {
        self.supervisor.state() == State::Disarmed && !self.supervisor.switch_was_released()
    }

    /// The board's status after the last tick.
    pub fn status(&self) -> Status {
        let ([finger_x_m, finger_y_m], speed_m_per_s) = self.finger_motion();
        Status {
            telemetry: Telemetry {
                tick: self.tick,
                state: self.supervisor.state(),
                flags: self.flags(),
                finger_x_m,
                finger_y_m,
                speed_m_per_s,
                commanded_electric_friction_n: self.electric_friction_n,
                voltage_v_rms: self.envelope.voltage_v_rms(),
                dac_code: self.dac_code.bits(),
            },
            fault: self.supervisor.fault(),
            orders_applied: self.orders_applied,
            arm_switch: self.arm_switch && self.supervisor.switch_was_released(),
            counters: self.counters(),
        }
    }

    /// Position of the finger at the last tick, in m, and its speed, in m/s; zero without a finger.
    fn finger_motion(&self) -> ([f32; 2], f32) {
        let Some(track) = self.finger.track() else { return ([0.0; 2], 0.0) };
        let elapsed_s = self.elapsed_s(track);
        let [x, y] = track.velocity_m_per_s(elapsed_s);
        (track.place_m(elapsed_s), frixel_layers::square_root(x * x + y * y))
    }

    fn flags(&self) -> Flags {
        let saturated = self.active.table().is_some_and(|table| is_out_of_reach(self.electric_friction_n, table));
        let slewed = self.envelope.voltage_v_rms().to_bits() != self.target_v_rms.to_bits();
        let balanced = self.carrier.early_edges() > 0 && self.carrier.last_early_tick() == self.tick;
        let still = self.finger.track().is_some_and(|track| track.ramp.gain_at(self.tick) < 1.0);
        let falls = |track: &Track| track.gain_before_end(self.tick, self.timing.fall_per_tick) < 1.0;
        let stale = self.finger == Finger::Stale || self.finger.track().is_some_and(falls);
        [
            (Flags::NO_FINGER, self.finger.track().is_none()),
            (Flags::TOUCH_STALE, stale),
            (Flags::STILL, still),
            (Flags::SATURATED, saturated),
            (Flags::SLEWED, slewed),
            (Flags::CARRIER_BALANCED, balanced),
            (Flags::HOST_SILENT, self.supervisor.host_silent()),
            (Flags::STREAM_DRY, self.stream.is_dry()),
            (Flags::CLAMPED, self.is_clamped),
        ]
        .into_iter()
        .fold(Flags::default(), |flags, (flag, raised)| if raised { flags.with(flag) } else { flags })
    }

    fn counters(&self) -> Counters {
        let (stream_underruns, stream_gaps) = self.stream.counts();
        Counters { balanced_edges: self.carrier.early_edges(), stream_underruns, stream_gaps, ..self.counters }
    }
}
