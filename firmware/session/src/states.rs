//! The board's state: the commands that change it, the orders that carry it out, and what the host hears of it.

use frixel_wire::fault::{Flags, State};
use frixel_wire::message::{Accepted, Command, FromBoard, Refusal};

use crate::commands::Commands;
use crate::transmit_queue::TransmitQueue;
use frixel_control::Order;
use frixel_control::Status;

/// Orders that may wait for the ticker. A command is refused as busy when there is no room.
pub(crate) const ORDERS_MAX: usize = 8;
/// Of which these are kept for Stop and Disarm, so that what puts the output to zero is never refused for want of room.
const ORDERS_KEPT: usize = 2;

impl<'a> Commands<'a> {
    /// Tells the host of a change of state that it did not ask for.
    pub(crate) fn report_state(&mut self, status: &Status, queue: &mut TransmitQueue) {
        let before = self.state;
        self.follow_state(status);
        if self.state != before {
            let fault = status.fault.filter(|_| self.state == State::Faulted).map(|(fault, _)| fault);
            let flags = Flags(status.telemetry.flags.0 & Flags::HOST_SILENT.0);
            queue.send(&FromBoard::StateChanged { state: self.state, fault, flags });
        }
    }

    /// The ticker's state holds once it has applied every order.
    fn follow_state(&mut self, status: &Status) {
        if self.is_settled(status) {
            self.set_state(status.telemetry.state);
        }
    }

    /// A stream lasts no longer than the state in which it plays.
    fn set_state(&mut self, state: State) {
        self.state = state;
        #[cfg(feature = "stream")]
        if state != State::Active {
            self.forget_stream();
        }
    }

    pub(crate) fn is_settled(&self, status: &Status) -> bool {
        status.orders_applied == self.orders_sent
    }

    /// Commands that a latched fault stands in the way of.
    pub(crate) fn drive(&mut self, command: Command, status: &Status) -> Result<Accepted, Refusal> {
        if self.state == State::Faulted
            && let Some((fault, _)) = status.fault
        {
            return Err(Refusal::Faulted(fault));
        }
        match command {
            Command::Disarm if matches!(self.orders.back(), Some(Order::Disarm)) => Ok(Accepted::Done),
            Command::Arm if !status.arm_switch => Err(Refusal::ArmSwitch),
            Command::Arm => self.change_state(Order::Arm, &[State::Disarmed], State::Armed),
            Command::Play if self.committed_crc32 == 0 => Err(Refusal::NoScene),
            Command::Play => self.change_state(Order::Play, &[State::Armed], State::Active),
            Command::Stop => self.change_state(Order::Stop, &[State::Active], State::Armed),
            _ => self.change_state(Order::Disarm, &[State::Disarmed, State::Armed, State::Active], State::Disarmed),
        }
    }

    pub(crate) fn change_state(&mut self, order: Order<'a>, from: &[State], to: State) -> Result<Accepted, Refusal> {
        if !from.contains(&self.state) {
            return Err(Refusal::WrongState(self.state));
        }
        self.send_order(order)?;
        self.set_state(to);
        Ok(Accepted::Done)
    }

    /// Refuses when there is no room for another order, but for those that put the output to zero.
    pub(crate) fn room_for_order(&self) -> Result<(), Refusal> {
        if self.orders.len() + ORDERS_KEPT >= ORDERS_MAX { Err(Refusal::Busy) } else { Ok(()) }
    }

    #[inline(never)]
    pub(crate) fn send_order(&mut self, order: Order<'a>) -> Result<(), Refusal> {
        if !matches!(order, Order::Stop | Order::Disarm) {
            self.room_for_order()?;
        }
        self.orders.push_back(order).map_err(|_| Refusal::Busy)?;
        self.orders_sent = self.orders_sent.wrapping_add(1);
        Ok(())
    }

    /// Commands of the host come first: they are few, so that they hold up a lift by some ticks only. A sign of life waits
    /// for one order of the finger, so that a host that pings does not move the finger's tracks in time, and for no more,
    /// so that a touch source that reports at every tick does not silence the host.
    pub(crate) fn next_order(&mut self) -> Option<Order<'a>> {
        if let Some(order) = self.orders.pop_front() {
            self.host_heard &= !order.is_sign_of_life();
            return Some(order);
        }
        if !self.host_heard {
            return self.tracker.next_order();
        }
        let finger_first = if self.sign_of_life_waited { None } else { self.tracker.next_order() };
        self.sign_of_life_waited = finger_first.is_some();
        self.host_heard = finger_first.is_some();
        finger_first.or(Some(Order::HostHeard))
    }
}
