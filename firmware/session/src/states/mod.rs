//! The states Disarmed, Armed, Active and Faulted, as requested by the session and reported by the ticker.
//!
//! Takes the commands that arm, disarm, play and stop, and the ticker's status; returns refusals, changes of state to
//! report, and the next order for the ticker. Orders of other parts go through its [`Orders`]. It is independent of
//! scenes and fingers: whether there is a scene, and the finger's next order, are passed to it.

mod orders;

use frixel_control::{Order, Status};
use frixel_wire::fault::State;
use frixel_wire::message::{Accepted, Command, Refusal};

pub(crate) use orders::Orders;

/// The board's state and the orders to the ticker.
pub(crate) struct States<'a> {
    pub(crate) orders: Orders<'a>,
    /// State after the ticker has applied all orders.
    state: State,
    /// Whether a valid frame has arrived that no order has reported yet.
    has_sign_of_life: bool,
    /// Whether an [`Order::SignOfLife`] has already waited for one order of the finger.
    sign_of_life_waited: bool,
}

impl<'a> States<'a> {
    pub(crate) const fn new() -> Self {
        Self { orders: Orders::new(), state: State::Disarmed, has_sign_of_life: false, sign_of_life_waited: false }
    }

    pub(crate) fn state(&self) -> State {
        self.state
    }

    /// Records a sign of life of the host.
    pub(crate) fn note_sign_of_life(&mut self) {
        self.has_sign_of_life = true;
    }

    /// Whether the ticker has applied all orders.
    pub(crate) fn is_settled(&self, status: &Status) -> bool {
        status.orders_applied == self.orders.sent()
    }

    /// Adopts the ticker's state after it has applied all orders. Returns whether the state has changed.
    pub(crate) fn follow(&mut self, status: &Status) -> bool {
        let before = self.state;
        if self.is_settled(status) {
            self.state = status.telemetry.state;
        }
        self.state != before
    }

    /// Refuses a command that needs a playing scene, unless one plays.
    pub(crate) fn check_active(&self, status: &Status) -> Result<(), Refusal> {
        match (self.state, status.fault) {
            (State::Active, _) => Ok(()),
            (State::Faulted, Some((fault, _))) => Err(Refusal::Faulted(fault)),
            (state, _) => Err(Refusal::WrongState(state)),
        }
    }

    /// Handles the commands that are refused while a fault is latched. Play is also refused unless the board
    /// `has_scene`.
    pub(crate) fn drive(&mut self, command: Command, status: &Status, has_scene: bool) -> Result<Accepted, Refusal> {
        if self.state == State::Faulted
            && let Some((fault, _)) = status.fault
        {
            return Err(Refusal::Faulted(fault));
        }
        match command {
            Command::Disarm if self.orders.ends_with_disarm() => Ok(Accepted::Done),
            Command::Arm if !status.arm_switch => Err(Refusal::ArmSwitch),
            Command::Arm => self.change(Order::Arm, &[State::Disarmed], State::Armed),
            Command::Play if !has_scene => Err(Refusal::NoScene),
            Command::Play => self.change(Order::Play, &[State::Armed], State::Active),
            Command::Stop => self.change(Order::Stop, &[State::Active], State::Armed),
            _ => self.change(Order::Disarm, &[State::Disarmed, State::Armed, State::Active], State::Disarmed),
        }
    }

    /// Clears a latched fault.
    pub(crate) fn clear_fault(&mut self) -> Result<Accepted, Refusal> {
        self.change(Order::ClearFault, &[State::Faulted], State::Disarmed)
    }

    /// Disarms for a new client, since the previous one is gone.
    pub(crate) fn disarm_for_new_client(&mut self) {
        // Ignore a refusal: there was nothing to disarm. There is always room for this order.
        let _ = self.change(Order::Disarm, &[State::Armed, State::Active], State::Disarmed);
    }

    fn change(&mut self, order: Order<'a>, from: &[State], to: State) -> Result<Accepted, Refusal> {
        if !from.contains(&self.state) {
            return Err(Refusal::WrongState(self.state));
        }
        self.orders.send(order)?;
        self.state = to;
        Ok(Accepted::Done)
    }

    /// The next order. Waiting orders come first: they are few, and delay a lift by only a few ticks. An
    /// [`Order::SignOfLife`] waits for at most one order of the `finger`. It waits so that pings do not delay tracks,
    /// but no longer, so that a touch source that reports in every tick does not cause a host timeout.
    pub(crate) fn next_order(&mut self, finger: impl FnOnce() -> Option<Order<'a>>) -> Option<Order<'a>> {
        if let Some(order) = self.orders.next() {
            self.has_sign_of_life &= !order.is_sign_of_life();
            return Some(order);
        }
        let order = if self.has_sign_of_life && self.sign_of_life_waited { None } else { finger() };
        if !self.has_sign_of_life {
            return order;
        }
        self.sign_of_life_waited = order.is_some();
        self.has_sign_of_life = order.is_some();
        order.or(Some(Order::SignOfLife))
    }
}
