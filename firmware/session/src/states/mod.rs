//! The board's state: the commands that change it, the orders to the ticker, and the reports to the host.

mod autonomous;

use frixel_wire::fault::{Flags, State};
use frixel_wire::message::{Accepted, Command, FromBoard, Refusal};

use crate::commands::Commands;
use crate::link::transmit_queue::TransmitQueue;
use frixel_control::Order;
use frixel_control::Status;

/// Orders that may wait for the ticker. A command is refused as busy when there is no room.
pub(crate) const ORDERS_MAX: usize = 8;
/// Number of them that are reserved for Stop and Disarm, so that these are never refused for lack of room.
const ORDERS_RESERVED: usize = 2;

impl<'a> Commands<'a> {
    /// Reports a change of state that the host did not request.
    pub(crate) fn report_state(&mut self, status: &Status, queue: &mut TransmitQueue) {
        let before = self.state;
        self.follow_state(status);
        if self.state != before {
            let fault = status.fault.filter(|_| self.state == State::Faulted).map(|(fault, _)| fault);
            let flags = Flags(status.telemetry.flags.0 & Flags::HOST_SILENT.0);
            queue.send(&FromBoard::StateChanged { state: self.state, fault, flags });
            // An Arm or a Play that was sent before the board disarmed itself must not take effect after it.
            if matches!(self.state, State::Disarmed | State::Faulted) {
                self.refuse_waiting(queue);
            }
        }
    }

    /// Adopts the ticker's state once the ticker has applied every order.
    fn follow_state(&mut self, status: &Status) {
        if self.is_settled(status) {
            self.set_state(status.telemetry.state);
        }
    }

    /// Sets the state. Leaving the Active state ends the stream.
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

    /// Handles the commands that are refused while a fault is latched.
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
            Command::Play => {
                if self.playing.is_autonomous() {
                    self.check_autonomous(true)?;
                }
                self.change_state(Order::Play, &[State::Armed], State::Active)
            }
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

    /// Refuses if there is no room for another order, not counting the room reserved for Stop and Disarm.
    pub(crate) fn room_for_order(&self) -> Result<(), Refusal> {
        if self.orders.len() + ORDERS_RESERVED >= ORDERS_MAX { Err(Refusal::Busy) } else { Ok(()) }
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

    /// The next order. Commands of the host come first: they are few, so they delay a lift by a few ticks only. An
    /// [`Order::HostHeard`] waits for at most one order of the finger: it waits so that pings do not delay tracks, and
    /// not longer, so that a touch source that reports at every tick does not cause a host timeout.
    pub(crate) fn next_order(&mut self) -> Option<Order<'a>> {
        if let Some(order) = self.orders.pop_front() {
            self.host_heard &= !order.is_sign_of_life();
            return Some(order);
        }
        let predicts = self.playing.header.is_none_or(|header| header.prediction);
        if !self.host_heard {
            return self.tracker.next_order(predicts);
        }
        let finger_first = if self.sign_of_life_waited { None } else { self.tracker.next_order(predicts) };
        self.sign_of_life_waited = finger_first.is_some();
        self.host_heard = finger_first.is_some();
        finger_first.or(Some(Order::HostHeard))
    }
}
