//! The state machine that decides whether the output is enabled: Disarmed, Armed, Active, Faulted
//! (`PROTOCOL.md` section 10, "States").

use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::{Fault, State};

use crate::monitor::{Comparison, MonitorCheck};
use crate::{Board, Order, Sense};

/// Host timeout until a scene sets one.
const HOST_TIMEOUT_DEFAULT_S: f32 = 0.25;

/// State of the supervisor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Supervisor {
    state: State,
    fault: Option<(Fault, u32)>,
    sign_of_life_at_tick: u32,
    host_timeout_ticks: u32,
    host_silent: bool,
    /// Whether the arm switch was open in some tick since the reset or the last disarming, so that a switch that is
    /// held now was pressed since.
    switch_was_released: bool,
    monitor: MonitorCheck,
}

impl Supervisor {
    pub(crate) fn new(board: &Board) -> Self {
        Self {
            state: State::Disarmed,
            fault: board.reset_fault,
            sign_of_life_at_tick: 0,
            host_timeout_ticks: host_timeout_default_ticks(board),
            host_silent: false,
            switch_was_released: false,
            monitor: MonitorCheck::new(board),
        }
    }

    pub(crate) fn state(&self) -> State {
        self.state
    }

    pub(crate) fn fault(&self) -> Option<(Fault, u32)> {
        self.fault
    }

    /// Whether the host timeout has disarmed the board, which has not been armed since.
    pub(crate) fn host_silent(&self) -> bool {
        self.host_silent
    }

    /// Applies orders that change the state. An order not allowed in the current state is ignored.
    pub(crate) fn apply(&mut self, order: &Order, now_tick: u32) {
        if order.is_sign_of_life() {
            self.sign_of_life_at_tick = now_tick;
        }
        match (order, self.state) {
            // Ignored until the switch was released: the host may have sent it before the board disarmed.
            (Order::Arm, State::Disarmed) if self.switch_was_released => {
                self.state = State::Armed;
                self.host_silent = false;
            }
            (Order::Play, State::Armed) => self.state = State::Active,
            (Order::Stop, State::Active) => self.state = State::Armed,
            (Order::Disarm, State::Armed | State::Active) | (Order::ClearFault, State::Faulted) => {
                self.disarm();
            }
            _ => {}
        }
    }

    /// Disarms. The switch must be released and pressed again before the next arming.
    fn disarm(&mut self) {
        self.state = State::Disarmed;
        self.switch_was_released = false;
    }

    /// Whether the arm switch, held now, was pressed since the reset or the last disarming.
    pub(crate) fn switch_was_released(&self) -> bool {
        self.switch_was_released
    }

    /// Latches a hard fault, unless one is already latched.
    pub(crate) fn raise(&mut self, fault: Fault, detail: u32) {
        if self.state != State::Faulted {
            self.state = State::Faulted;
            self.fault = Some((fault, detail));
        }
    }

    /// Sets the host timeout. Called after every order that is not about the finger.
    pub(crate) fn set_host_timeout(&mut self, ticks: u32) {
        self.host_timeout_ticks = ticks;
    }

    /// Latches a fault if the amplifier, its monitor or the arm switch requires it. `driven_code` is the code of the
    /// previous tick.
    #[inline]
    pub(crate) fn check(&mut self, sense: &Sense, driven_code: DacCode) {
        let (comparison, must_count) = self.monitor.advance(driven_code.bits(), sense.monitor_v);
        if must_count || sense.amplifier_fault || !sense.arm_switch {
            self.latch_first_fault(sense, comparison);
        } else if self.monitor.sum(comparison) {
            self.raise(Fault::Monitor, monitor_detail(sense));
        }
    }

    /// Latches the fault that the inputs of [`Self::check`] show; if there are several, the first one below.
    #[cold]
    #[inline(never)]
    fn latch_first_fault(&mut self, sense: &Sense, comparison: Comparison) {
        let is_ready_fault = self.monitor.is_ready_fault(!sense.amplifier_fault);
        let monitor_wrong = self.monitor.count(comparison);
        if !sense.arm_switch {
            self.switch_was_released = true;
        }
        if self.state == State::Faulted {
            return;
        }
        if monitor_wrong {
            self.raise(Fault::Monitor, monitor_detail(sense));
        } else if is_ready_fault {
            self.raise(Fault::Amplifier, 0);
        } else if self.state != State::Disarmed && !sense.arm_switch {
            self.raise(Fault::ArmSwitch, 0);
        }
    }

    /// Follows the amplifier's enable of this tick. `driven_code` is the code of the previous tick.
    #[inline]
    pub(crate) fn set_amplifier_enabled(&mut self, is_enabled: bool, driven_code: DacCode) {
        self.monitor.set_enabled(is_enabled, driven_code.bits());
    }

    /// Disarms an armed or active board whose host timeout has passed. Called at every tick.
    #[inline]
    pub(crate) fn expire(&mut self, now_tick: u32) {
        let is_host_silent = now_tick.wrapping_sub(self.sign_of_life_at_tick) > self.host_timeout_ticks;
        if is_host_silent && matches!(self.state, State::Armed | State::Active) {
            self.disarm();
            self.host_silent = true;
        }
    }
}

/// Detail of a monitor fault: the reading in whole volts.
fn monitor_detail(sense: &Sense) -> u32 {
    sense.monitor_v as i32 as u32
}

/// Host timeout in ticks before a scene has set one.
pub(crate) fn host_timeout_default_ticks(board: &Board) -> u32 {
    board.ticks(HOST_TIMEOUT_DEFAULT_S)
}

#[cfg(test)]
mod tests;
