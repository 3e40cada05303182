//! The state machine that decides whether the output is enabled: Disarmed, Armed, Active, Faulted
//! (`PROTOCOL.md` section 10, "States").

use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::{Fault, State};

use crate::tick_count::is_past;
use crate::{Board, Order, Sense};

/// Host timeout before a scene has set one.
const HOST_TIMEOUT_DEFAULT_S: f32 = 0.25;
/// Tolerance of the monitor voltage, as a fraction of full scale; [`MONITOR_GAIN_TOLERANCE`] of the driven voltage is
/// added to it.
const MONITOR_FLOOR: f32 = 0.04;
const MONITOR_GAIN_TOLERANCE: f32 = 0.25;
/// Count at which the monitor faults: a tick with a wrong voltage adds 1, one with a right voltage subtracts 1, down to
/// 0.
const MONITOR_WRONG_TICKS: u32 = 20;

/// State of the supervisor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Supervisor {
    state: State,
    fault: Option<(Fault, u32)>,
    host_heard_at_tick: u32,
    /// `None` for a scene that continues without a host.
    host_timeout_ticks: Option<u32>,
    host_silent: bool,
    /// The arm switch was open at some tick since the reset or the last disarming: if it is held now, it was pressed
    /// since.
    switch_was_released: bool,
    monitor: MonitorCheck,
}

/// The expected monitor voltage, and the count of ticks at which the monitor read something else.
#[derive(Clone, Copy, Debug)]
struct MonitorCheck {
    expected_v: f32,
    volts_per_code: f32,
    step: f32,
    /// [`MONITOR_GAIN_TOLERANCE`], stored here because the compiler would hold a constant in a register over the whole
    /// tick.
    gain_tolerance: f32,
    floor_v: f32,
    /// Equal to `floor_v`; minus infinity while `wrong_ticks` is above 0, so that every tick is then counted.
    uncounted_below_v: f32,
    wrong_ticks: u32,
}

impl MonitorCheck {
    fn new(board: &Board) -> Self {
        let floor_v = MONITOR_FLOOR * board.limits.full_scale_v_peak;
        Self {
            expected_v: 0.0,
            volts_per_code: board.limits.full_scale_v_peak / f32::from(i16::MAX),
            step: lag_step(board.tick_period_s() / board.limits.edge_time_constant_s),
            gain_tolerance: MONITOR_GAIN_TOLERANCE,
            floor_v,
            uncounted_below_v: floor_v,
            wrong_ticks: 0,
        }
    }

    /// Advances the expected voltage by a tick that began with `driven_v` at the output. Returns whether
    /// [`Self::count`] has to count the voltage that the monitor read at its end.
    #[inline]
    fn advance(&mut self, driven_v: f32, monitor_v: f32) -> bool {
        self.expected_v += self.step * (driven_v - self.expected_v);
        !self.is_within(self.uncounted_below_v, driven_v, monitor_v)
    }

    /// Whether the monitor voltage is within tolerance; `false` if it is not a number.
    #[inline]
    fn is_within(&self, floor_v: f32, driven_v: f32, monitor_v: f32) -> bool {
        (monitor_v - self.expected_v).abs() < floor_v + self.gain_tolerance * driven_v.abs()
    }

    /// Counts a tick, and returns whether there were too many wrong ones. The count is limited to
    /// [`MONITOR_WRONG_TICKS`], so that it soon falls again however long the monitor was wrong.
    fn count(&mut self, driven_v: f32, monitor_v: f32) -> bool {
        self.wrong_ticks = if self.is_within(self.floor_v, driven_v, monitor_v) {
            self.wrong_ticks.saturating_sub(1)
        } else {
            (self.wrong_ticks + 1).min(MONITOR_WRONG_TICKS)
        };
        self.uncounted_below_v = if self.wrong_ticks > 0 { f32::NEG_INFINITY } else { self.floor_v };
        self.wrong_ticks == MONITOR_WRONG_TICKS
    }
}

/// `1 - exp(-x)`, the step response of a first-order lag after `x` time constants, within 1e-5 for `x` up to one and
/// 1e-3 for any above zero: 64 steps of the trapezoidal rule. `libm::expf` would make the image larger.
fn lag_step(x: f32) -> f32 {
    let half_step = (x / 128.0).min(1.0);
    let mut left = (1.0 - half_step) / (1.0 + half_step);
    for _ in 0..6 {
        left *= left;
    }
    1.0 - left
}

impl Supervisor {
    pub(crate) fn new(board: &Board) -> Self {
        Self {
            state: State::Disarmed,
            fault: board.reset_fault,
            host_heard_at_tick: 0,
            host_timeout_ticks: Some(host_timeout_default_ticks(board)),
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

    /// The host timeout has disarmed the board, and the board has not been armed since.
    pub(crate) fn host_silent(&self) -> bool {
        self.host_silent
    }

    /// Applies the orders that change the state. An order that is not allowed in the current state is ignored.
    pub(crate) fn apply(&mut self, order: &Order, now_tick: u32) {
        if order.is_sign_of_life() {
            self.host_heard_at_tick = now_tick;
        }
        match (order, self.state) {
            // Ignored until the switch was released: the host may not know yet that it must be pressed again.
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

    /// Sets the host timeout; `None` for a scene that plays without a host.
    pub(crate) fn set_host_timeout(&mut self, ticks: Option<u32>) {
        self.host_timeout_ticks = ticks;
    }

    /// Latches a fault if the amplifier, its monitor or the arm switch requires it. `dac_code` is the output of the
    /// previous tick.
    #[inline]
    pub(crate) fn check(&mut self, sense: &Sense, dac_code: DacCode) {
        let driven_v = f32::from(dac_code.bits()) * self.monitor.volts_per_code;
        if self.monitor.advance(driven_v, sense.monitor_v) || sense.amplifier_fault || !sense.arm_switch {
            self.latch_first_fault(sense, driven_v);
        }
    }

    /// Latches the fault that the inputs of [`Self::check`] show; if there are several, the first one below.
    #[cold]
    #[inline(never)]
    fn latch_first_fault(&mut self, sense: &Sense, driven_v: f32) {
        let monitor_wrong = self.monitor.count(driven_v, sense.monitor_v);
        self.switch_was_released |= !sense.arm_switch;
        if self.state == State::Faulted {
            return;
        }
        if monitor_wrong {
            self.raise(Fault::Monitor, sense.monitor_v as i32 as u32);
        } else if sense.amplifier_fault {
            self.raise(Fault::Amplifier, 0);
        } else if self.state != State::Disarmed && !sense.arm_switch {
            self.raise(Fault::ArmSwitch, 0);
        }
    }

    /// The tick at which the host timeout passes; `None` if no host is required.
    pub(crate) fn host_expiry_tick(&self) -> Option<u32> {
        let needed = matches!(self.state, State::Armed | State::Active);
        let timeout_ticks = self.host_timeout_ticks.filter(|_| needed)?;
        Some(self.host_heard_at_tick.wrapping_add(timeout_ticks).wrapping_add(1))
    }

    /// Disarms if the host timeout has passed.
    pub(crate) fn expire(&mut self, now_tick: u32) {
        if let Some(tick) = self.host_expiry_tick()
            && is_past(tick, now_tick)
        {
            self.disarm();
            self.host_silent = true;
        }
    }
}

/// Host timeout in ticks before a scene has set one.
pub(crate) fn host_timeout_default_ticks(board: &Board) -> u32 {
    board.ticks(HOST_TIMEOUT_DEFAULT_S)
}

#[cfg(test)]
mod tests;
