//! What the session wants of the ticker, and the faults that the board finds.

use frixel_wire::fault::{Fault, State};

use super::{ORDERED_TICKS, Ticker};
use crate::{Active, Order};

impl<'a> Ticker<'a> {
    /// Takes an order of the session, between two ticks. Hands back the coefficients that a [`Order::Load`] replaced.
    #[inline]
    pub fn apply(&mut self, order: Order<'a>) -> Option<&'a mut Active> {
        if !matches!(order, Order::HostHeard) {
            self.orders_applied = self.orders_applied.wrapping_add(1);
        }
        self.supervisor.apply(&order, self.tick);
        let spare = match order {
            Order::Load(next) => {
                let spare = core::mem::replace(&mut self.active, next);
                self.carrier.retime(&self.active.carrier);
                self.envelope.limit(self.active.voltage_max_v_rms);
                self.target_v_rms = self.target_v_rms.min(self.active.voltage_max_v_rms);
                self.clicks.reset();
                #[cfg(feature = "stream")]
                if !self.active.has_stream() {
                    self.stop_stream();
                }
                if self.active.prediction != spare.prediction {
                    self.finger.locate(self.tick, self.active.prediction, &self.timing.finger);
                }
                self.ask_at_once();
                Some(spare)
            }
            Order::Unload => {
                self.active.unload();
                None
            }
            Order::SetLayer { layer, on, gain } => {
                self.active.set_layer(layer, on, gain);
                // Nobody slid into a layer that is put on under the finger.
                #[cfg(feature = "edge")]
                self.clicks.lift();
                self.ask_at_once();
                None
            }
            #[cfg(feature = "stream")]
            Order::StartStream(start) => {
                if let Some(stream) = &mut self.stream {
                    stream.start(start);
                    self.streaming = true;
                }
                None
            }
            #[cfg(feature = "stream")]
            Order::EndStream { last } => {
                if let Some(stream) = &mut self.stream {
                    stream.end(last);
                }
                None
            }
            _ => None,
        };
        self.supervisor.set_host_timeout(self.host_timeout_ticks());
        self.look();
        spare
    }

    /// What was asked for last is asked for no longer: the next tick asks anew, unless a deadline or a lift is in it.
    #[inline]
    fn ask_at_once(&mut self) {
        self.asked_tick = self.tick.wrapping_sub(ORDERED_TICKS);
    }

    /// The timeout that holds now. Only a playing scene may go on without a host.
    #[inline]
    fn host_timeout_ticks(&self) -> Option<u32> {
        if self.supervisor.state() == State::Active {
            self.active.host_timeout_ticks
        } else {
            Some(self.active.host_timeout_ticks.unwrap_or(self.timing.host_timeout_default_ticks))
        }
    }

    /// Latches a hard fault that the board has found: the output is zero from the next tick on. A fault that is latched
    /// already stays the one that is told, since it came first.
    #[inline]
    pub fn raise(&mut self, fault: Fault, detail: u32) {
        if fault == Fault::Deadline {
            self.counters.missed_deadlines = self.counters.missed_deadlines.wrapping_add(1);
        }
        self.supervisor.raise(fault, detail);
        self.look();
    }
}
