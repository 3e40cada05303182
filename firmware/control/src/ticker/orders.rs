//! Applies the session's orders and the faults raised by the board.

use frixel_wire::fault::Fault;

use super::Ticker;
use crate::finger::Finger;
use crate::{Active, Order};

impl<'a> Ticker<'a> {
    /// Applies an order of the session, before a tick. Returns the coefficients that an [`Order::Load`] replaced.
    #[inline(never)]
    pub fn apply(&mut self, order: Order<'a>) -> Option<&'a mut Active> {
        match order {
            Order::Track(track) => {
                self.was_lifted |= self.finger.follow(&track, self.tick, self.timing.track_ticks_max);
                None
            }
            Order::Lift => {
                self.finger = Finger::Up;
                self.was_lifted = true;
                None
            }
            order => self.apply_host_order(order),
        }
    }

    /// Applies an order that does not concern the finger.
    #[inline(never)]
    fn apply_host_order(&mut self, order: Order<'a>) -> Option<&'a mut Active> {
        if order.is_counted() {
            self.orders_applied = self.orders_applied.wrapping_add(1);
        }
        self.supervisor.apply(&order, self.tick);
        let mut spare = None;
        match order {
            Order::Load(next) => spare = Some(self.load(next)),
            Order::Unload => {
                self.active.unload();
                self.is_clamped = false;
            }
            Order::SetLayer { layer, on, gain } => {
                self.active.set_layer(layer, on, gain, self.tick.wrapping_add(1));
                // A layer enabled under the finger must not click, since the finger did not slide into it.
                self.clicks.lift();
            }
            #[cfg(feature = "stream")]
            Order::StartStream(start) => self.stream.start(start),
            #[cfg(feature = "stream")]
            Order::EndStream { end } => self.stream.end(end),
            // The supervisor has already applied them.
            Order::SignOfLife | Order::Arm | Order::Disarm | Order::Play | Order::Stop | Order::ClearFault => {}
            // `apply` has handled them.
            Order::Track(_) | Order::Lift => {}
        }
        self.supervisor.set_host_timeout(self.host_timeout_ticks());
        spare
    }

    /// Swaps the scene, within the board's ceilings, and returns the previous coefficients. The new scene's voltage
    /// limit applies at once.
    #[inline]
    fn load(&mut self, next: &'a mut Active) -> &'a mut Active {
        self.is_clamped = next.limit_to(&self.ceilings);
        if self.is_clamped {
            self.counters.clamped_loads = self.counters.clamped_loads.wrapping_add(1);
        }
        let spare = core::mem::replace(&mut self.active, next);
        self.carrier.retime(&self.active.carrier);
        self.envelope.limit(self.active.voltage_max_v_rms);
        self.clicks.reset();
        if !self.active.has_stream() {
            self.stream.stop(&mut self.inputs.stream);
        }
        spare
    }

    /// The host timeout of the scene, or the default without a scene.
    #[inline]
    fn host_timeout_ticks(&self) -> u32 {
        match self.active.table() {
            Some(_) => self.active.host_timeout_ticks,
            None => self.timing.host_timeout_default_ticks,
        }
    }

    /// Latches a hard fault detected by the board: the output is zero from the next tick on. A fault that is already
    /// latched remains the reported one.
    #[inline]
    pub fn raise(&mut self, fault: Fault, detail: u32) {
        if fault == Fault::Deadline {
            self.counters.missed_deadlines = self.counters.missed_deadlines.wrapping_add(1);
        }
        self.supervisor.raise(fault, detail);
    }
}
