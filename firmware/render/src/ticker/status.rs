//! What the ticker tells.

use frixel_wire::fault::Flags;
use frixel_wire::message::Telemetry;

use super::Ticker;
use crate::Status;
use crate::finger::Presence;
use crate::order::Counters;
#[cfg(feature = "stream")]
use crate::stream::Player;

impl Ticker<'_> {
    /// What the board does now.
    pub fn status(&self) -> Status {
        let [finger_x_m, finger_y_m] = self.finger.place_m();
        Status {
            telemetry: Telemetry {
                tick: self.tick,
                state: self.supervisor.state(),
                flags: self.flags(),
                finger_x_m,
                finger_y_m,
                speed_m_per_s: self.finger.speed_m_per_s(),
                asked_electric_friction_n: self.asked_electric_friction_n,
                voltage_v_rms: self.envelope.voltage_v_rms(),
                dac_code: self.dac_code,
            },
            fault: self.supervisor.fault(),
            orders_applied: self.orders_applied,
            arm_switch: self.arm_switch,
            counters: self.counters(),
        }
    }

    fn flags(&self) -> Flags {
        let Counters { saturated_ticks, slewed_ticks, .. } = self.counters;
        let now = |count, tick| count > 0 && tick == self.tick;
        #[cfg(feature = "stream")]
        let is_dry = self.stream.as_ref().is_some_and(Player::is_dry);
        #[cfg(not(feature = "stream"))]
        let is_dry = false;
        [
            (Flags::NO_FINGER, !self.finger.is_there()),
            (Flags::TOUCH_STALE, self.finger.presence() == Presence::Stale),
            (Flags::STILL, self.finger.gain() < 1.0),
            (Flags::SATURATED, now(saturated_ticks, self.last.saturated_tick)),
            (Flags::SLEWED, now(slewed_ticks, self.last.slewed_tick)),
            (Flags::CARRIER_BALANCED, now(self.carrier.early_edges(), self.carrier.last_early_tick())),
            (Flags::HOST_SILENT, self.supervisor.host_silent()),
            (Flags::STREAM_DRY, is_dry),
        ]
        .into_iter()
        .fold(Flags::default(), |flags, (flag, raised)| if raised { flags.with(flag) } else { flags })
    }

    fn counters(&self) -> Counters {
        let counters = Counters { balanced_edges: self.carrier.early_edges(), ..self.counters };
        #[cfg(feature = "stream")]
        if let Some(stream) = &self.stream {
            let (stream_underruns, stream_gaps) = stream.counts();
            return Counters { stream_underruns, stream_gaps, ..counters };
        }
        counters
    }
}
