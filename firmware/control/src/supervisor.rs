//! The one owner of the output: Disarmed, Armed, Active, Faulted (DESIGN section 5).

use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::{Fault, State};

use crate::deadline::is_past;
use crate::{Board, Order, Sense};

/// Host timeout before a scene has set one.
const HOST_TIMEOUT_DEFAULT_S: f32 = 0.25;
/// The monitor may be off by this part of full scale, and by [`MONITOR_GAIN_TOLERANCE`] of what is driven.
const MONITOR_FLOOR: f32 = 0.04;
const MONITOR_GAIN_TOLERANCE: f32 = 0.25;
/// Ticks of a wrong monitor voltage, less those of a right one, that are a fault.
const MONITOR_WRONG_TICKS: u32 = 20;

/// State of the supervisor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Supervisor {
    state: State,
    fault: Option<(Fault, u32)>,
    host_heard_at_tick: u32,
    /// `None` for a scene that goes on without a host.
    host_timeout_ticks: Option<u32>,
    host_silent: bool,
    /// The arm switch was open at some tick since the reset or the last disarming: to hold it now means to have pressed it.
    switch_was_released: bool,
    monitor: Monitor,
}

/// What the monitor should read, and how long it has not.
#[derive(Clone, Copy, Debug)]
struct Monitor {
    expected_v: f32,
    volts_per_code: f32,
    step: f32,
    /// [`MONITOR_GAIN_TOLERANCE`], beside the others: as a constant it would keep a register over the whole tick.
    gain_tolerance: f32,
    floor_v: f32,
    /// As `floor_v`; while wrong ticks are counted, less than nothing: every tick is to be looked at then.
    unnoticed_v: f32,
    wrong_ticks: u32,
}

impl Monitor {
    fn new(board: &Board) -> Self {
        let floor_v = MONITOR_FLOOR * board.limits.full_scale_v_peak;
        Self {
            expected_v: 0.0,
            volts_per_code: board.limits.full_scale_v_peak / f32::from(i16::MAX),
            step: lag_step(board.tick_period_s() / board.limits.edge_time_constant_s),
            gain_tolerance: MONITOR_GAIN_TOLERANCE,
            floor_v,
            unnoticed_v: floor_v,
            wrong_ticks: 0,
        }
    }

    /// Goes on by a tick at whose beginning a voltage was put out. Returns whether what the monitor read at its end is to
    /// be counted.
    #[inline]
    fn advance(&mut self, driven_v: f32, monitor_v: f32) -> bool {
        self.expected_v += self.step * (driven_v - self.expected_v);
        !self.is_within(self.unnoticed_v, driven_v, monitor_v)
    }

    /// Not so for a monitor that is not a number.
    #[inline]
    fn is_within(&self, floor_v: f32, driven_v: f32, monitor_v: f32) -> bool {
        (monitor_v - self.expected_v).abs() < floor_v + self.gain_tolerance * driven_v.abs()
    }

    /// Counts a tick, and returns whether there were too many wrong ones. No more than those are counted, so that a
    /// monitor that reads right again is soon believed, however long it was wrong.
    fn count(&mut self, driven_v: f32, monitor_v: f32) -> bool {
        self.wrong_ticks = if self.is_within(self.floor_v, driven_v, monitor_v) {
            self.wrong_ticks.saturating_sub(1)
        } else {
            (self.wrong_ticks + 1).min(MONITOR_WRONG_TICKS)
        };
        self.unnoticed_v = if self.wrong_ticks > 0 { f32::NEG_INFINITY } else { self.floor_v };
        self.wrong_ticks == MONITOR_WRONG_TICKS
    }
}

/// `1 - exp(-x)`, what a first-order lag follows in `x` of its time constants, within 1e-5 for `x` up to one and 1e-3 for any
/// above zero: 64 steps of the trapezoidal rule. `libm::expf` would cost an image more than it is worth.
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
            monitor: Monitor::new(board),
        }
    }

    pub(crate) fn state(&self) -> State {
        self.state
    }

    pub(crate) fn fault(&self) -> Option<(Fault, u32)> {
        self.fault
    }

    /// The output was put to zero because the host had gone silent, and nobody has armed since.
    pub(crate) fn host_silent(&self) -> bool {
        self.host_silent
    }

    /// Takes the orders that concern the state. Those that do not go with the state change nothing.
    pub(crate) fn apply(&mut self, order: &Order, now_tick: u32) {
        if order.is_sign_of_life() {
            self.host_heard_at_tick = now_tick;
        }
        match (order, self.state) {
            // A host that has not seen yet that the switch must be pressed again is ignored.
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

    /// Whoever wants to arm presses the switch anew.
    fn disarm(&mut self) {
        self.state = State::Disarmed;
        self.switch_was_released = false;
    }

    /// Whether the arm switch, held now, was pressed since the reset or the last disarming.
    pub(crate) fn switch_was_released(&self) -> bool {
        self.switch_was_released
    }

    /// Latches a hard fault, unless one is latched.
    pub(crate) fn raise(&mut self, fault: Fault, detail: u32) {
        if self.state != State::Faulted {
            self.state = State::Faulted;
            self.fault = Some((fault, detail));
        }
    }

    /// Sets the timeout that holds from now on; `None` for a scene that goes on without a host.
    pub(crate) fn set_host_timeout(&mut self, ticks: Option<u32>) {
        self.host_timeout_ticks = ticks;
    }

    /// Faults when the amplifier, its monitor or the arm switch say so. `dac_code` is what went to the amplifier in the tick
    /// before.
    #[inline]
    pub(crate) fn check(&mut self, sense: &Sense, dac_code: DacCode) {
        let driven_v = f32::from(dac_code.bits()) * self.monitor.volts_per_code;
        if self.monitor.advance(driven_v, sense.monitor_v) || sense.amplifier_fault || !sense.arm_switch {
            self.judge(sense, driven_v);
        }
    }

    /// Latches the fault that an input of [`Self::check`] means; of several the first here.
    #[cold]
    #[inline(never)]
    fn judge(&mut self, sense: &Sense, driven_v: f32) {
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

    /// The tick at which the host has been silent for too long; `None` when it need not be there.
    pub(crate) fn host_deadline_tick(&self) -> Option<u32> {
        let needed = matches!(self.state, State::Armed | State::Active);
        let timeout_ticks = self.host_timeout_ticks.filter(|_| needed)?;
        Some(self.host_heard_at_tick.wrapping_add(timeout_ticks).wrapping_add(1))
    }

    /// Disarms when the host has been silent for too long.
    pub(crate) fn expire(&mut self, now_tick: u32) {
        if let Some(tick) = self.host_deadline_tick()
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
