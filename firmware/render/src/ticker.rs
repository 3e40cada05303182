//! The tick: touch in, voltage out.

use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::message::Telemetry;

use crate::carrier::Carrier;
use crate::envelope::Envelope;
use crate::estimator::{Estimate, Estimator};
use crate::order::Counters;
use crate::stillness::{Stillness, StillnessTiming};
use crate::supervisor::{self, Supervisor};
use crate::{Active, BitmapPool, Board, Drive, Order, Sense, Status, Touch};

/// Touch data is too old to use after this many report periods without a report.
const STALE_AFTER_PERIODS: f32 = 3.0;
/// A sample older than this, 0.8 s at 40 kHz, says nothing of where the finger is now.
const SAMPLE_AGE_MAX_TICKS: u32 = 1 << 15;

/// Turns touch into voltage, one tick at a time, and owns the output through its supervisor.
pub struct Ticker<'a> {
    timing: Timing,
    pool: &'a BitmapPool,
    active: &'a mut Active,
    supervisor: Supervisor,
    finger: Finger,
    envelope: Envelope,
    carrier: Carrier,
    tick: u32,
    drive: Drive,
    arm_switch: bool,
    asked_electric_friction_n: f32,
    flags: Flags,
    counters: Counters,
    orders_applied: u32,
}

/// What belongs to the board and is computed once.
#[derive(Clone, Copy)]
struct Timing {
    tick_period_s: f32,
    stale_after_ticks: u32,
    host_timeout_default_ticks: u32,
    stillness: StillnessTiming,
    volts_per_code: f32,
}

/// What the ticker knows of the finger.
struct Finger {
    estimator: Estimator,
    stillness: Stillness,
    /// The last report said that a finger is there.
    down: bool,
    reported_at_tick: u32,
    /// When the newest sample was true; outlives stale data, so that a source that is stuck does not start anew.
    sampled_at_tick: Option<u32>,
    last_x_m: f32,
    last_y_m: f32,
    estimate: Estimate,
}

impl Finger {
    const UP: Self = Self {
        estimator: Estimator::NEW,
        stillness: Stillness::MOVING,
        down: false,
        reported_at_tick: 0,
        sampled_at_tick: None,
        last_x_m: 0.0,
        last_y_m: 0.0,
        estimate: Estimate::ZERO,
    };

    fn take(&mut self, touch: Touch, now_tick: u32, tick_period_s: f32) {
        match touch {
            Touch::Up => *self = Self::UP,
            Touch::Down { x_m, y_m, age_ticks } => {
                let newer = self.sampled_at_tick.is_none_or(|tick| age_ticks < now_tick.wrapping_sub(tick));
                // A report that says nothing new does not keep the output alive: the source may be stuck.
                if newer && age_ticks <= SAMPLE_AGE_MAX_TICKS && x_m.is_finite() && y_m.is_finite() {
                    self.estimator.update(now_tick, age_ticks, x_m, y_m, tick_period_s);
                    self.sampled_at_tick = Some(now_tick.wrapping_sub(age_ticks));
                    self.down = true;
                    self.reported_at_tick = now_tick;
                    self.last_x_m = x_m;
                    self.last_y_m = y_m;
                }
            }
        }
    }

    /// Where the finger is now; without prediction, where it was last seen.
    #[inline]
    fn locate(&mut self, now_tick: u32, tick_period_s: f32, prediction: bool) {
        if let Some(estimate) = self.estimator.at(now_tick, tick_period_s) {
            self.estimate =
                if prediction { estimate } else { Estimate { x_m: self.last_x_m, y_m: self.last_y_m, ..estimate } };
        }
    }
}

impl<'a> Ticker<'a> {
    /// A ticker with its output at zero, that reads bitmaps from `pool` and starts with `active`, which need not hold
    /// a scene.
    pub fn new(board: &Board, pool: &'a BitmapPool, active: &'a mut Active) -> Self {
        let carrier = Carrier::new(&active.carrier);
        Self {
            timing: Timing {
                tick_period_s: board.tick_period_s(),
                stale_after_ticks: board.ticks(STALE_AFTER_PERIODS * board.limits.touch_report_period_s),
                host_timeout_default_ticks: supervisor::host_timeout_default_ticks(board),
                stillness: StillnessTiming::new(board.tick_hz),
                volts_per_code: board.limits.full_scale_v_peak / f32::from(i16::MAX),
            },
            pool,
            active,
            supervisor: Supervisor::new(board),
            finger: Finger::UP,
            envelope: Envelope::default(),
            carrier,
            tick: 0,
            drive: Drive::default(),
            arm_switch: false,
            asked_electric_friction_n: 0.0,
            flags: Flags::NO_FINGER,
            counters: Counters::default(),
            orders_applied: 0,
        }
    }

    /// Takes an order of the session, between two ticks. Hands back the coefficients that a [`Order::Load`] replaced.
    pub fn apply(&mut self, order: Order<'a>) -> Option<&'a mut Active> {
        if !matches!(order, Order::HostHeard) {
            self.orders_applied = self.orders_applied.wrapping_add(1);
        }
        self.supervisor.apply(&order, self.tick);
        match order {
            Order::Load(next) => {
                let spare = core::mem::replace(&mut self.active, next);
                self.carrier.retime(&self.active.carrier);
                self.envelope.limit(self.active.voltage_max_v_rms);
                Some(spare)
            }
            Order::Unload => {
                self.active.unload();
                None
            }
            _ => None,
        }
    }

    /// Latches a hard fault that the board has found: the output is zero from the next tick on. A fault that is latched
    /// already stays the one that is told, since it came first.
    pub fn raise(&mut self, fault: Fault, detail: u32) {
        if fault == Fault::Deadline {
            self.counters.missed_deadlines = self.counters.missed_deadlines.wrapping_add(1);
        }
        self.supervisor.raise(fault, detail);
    }

    /// One tick: to be called exactly [`Board::tick_hz`] times a second.
    ///
    /// Deadline: the drive has to be at the DAC before the next tick begins, 25 us or 4,250 cycles at 40 kHz on the
    /// G474. A board that misses it calls [`Ticker::raise`] with [`Fault::Deadline`]. The tick does not allocate, wait
    /// or panic; its longest path is a scene whose layers all lie under the finger.
    pub fn tick(&mut self, sense: &Sense) -> Drive {
        self.tick = self.tick.wrapping_add(1);
        self.arm_switch = sense.arm_switch;
        if let Some(touch) = sense.touch {
            self.finger.take(touch, self.tick, self.timing.tick_period_s);
        }
        let driven_v = f32::from(self.drive.dac_code) * self.timing.volts_per_code;
        self.supervisor.check(sense, driven_v, self.tick, self.host_timeout_ticks());
        self.finger.locate(self.tick, self.timing.tick_period_s, self.active.prediction);
        self.flags = Flags::default();
        self.drive = match self.permitted_friction_n() {
            Some(electric_friction_n) => self.render(electric_friction_n),
            None => self.silence(),
        };
        self.drive
    }

    /// What the board does now.
    pub fn status(&self) -> Status {
        let estimate = &self.finger.estimate;
        let flags = if self.supervisor.host_silent() { self.flags.with(Flags::HOST_SILENT) } else { self.flags };
        Status {
            telemetry: Telemetry {
                tick: self.tick,
                state: self.supervisor.state(),
                flags,
                finger_x_m: estimate.x_m,
                finger_y_m: estimate.y_m,
                speed_m_per_s: libm::sqrtf(
                    estimate.velocity_x_m_per_s * estimate.velocity_x_m_per_s
                        + estimate.velocity_y_m_per_s * estimate.velocity_y_m_per_s,
                ),
                asked_electric_friction_n: self.asked_electric_friction_n,
                voltage_v_rms: self.envelope.voltage_v_rms(),
                dac_code: self.drive.dac_code,
            },
            fault: self.supervisor.fault(),
            orders_applied: self.orders_applied,
            arm_switch: self.arm_switch,
            counters: self.counters,
        }
    }

    /// The timeout that holds now. Only a playing scene may go on without a host.
    fn host_timeout_ticks(&self) -> Option<u32> {
        if self.supervisor.state() == State::Active {
            self.active.host_timeout_ticks
        } else {
            Some(self.active.host_timeout_ticks.unwrap_or(self.timing.host_timeout_default_ticks))
        }
    }

    /// The electric friction of the scene under the finger, where there may be any output.
    #[inline]
    fn permitted_friction_n(&mut self) -> Option<f32> {
        if !self.finger.down {
            self.flags = self.flags.with(Flags::NO_FINGER);
            return None;
        }
        if self.tick.wrapping_sub(self.finger.reported_at_tick) > self.timing.stale_after_ticks {
            self.flags = self.flags.with(Flags::TOUCH_STALE);
            self.finger = Finger { sampled_at_tick: self.finger.sampled_at_tick, ..Finger::UP };
            return None;
        }
        let gain = self.finger.stillness.update(&self.finger.estimate, &self.timing.stillness);
        if self.finger.stillness.is_ramped() {
            self.flags = self.flags.with(Flags::STILL);
        }
        if self.supervisor.state() != State::Active {
            return None;
        }
        let estimate = &self.finger.estimate;
        Some(gain * self.active.electric_friction_n(estimate.x_m, estimate.y_m, self.pool))
    }

    /// Puts an electric friction on the carrier.
    #[inline]
    fn render(&mut self, electric_friction_n: f32) -> Drive {
        let Some(table) = self.active.table() else {
            return self.silence();
        };
        self.asked_electric_friction_n = electric_friction_n;
        if !(electric_friction_n >= 0.0 && electric_friction_n <= table.electric_friction_max_n()) {
            self.flags = self.flags.with(Flags::SATURATED);
            self.counters.saturated_ticks = self.counters.saturated_ticks.wrapping_add(1);
        }
        if self.envelope.follow(table.voltage_v_rms(electric_friction_n), self.active.slew_step_v) {
            self.flags = self.flags.with(Flags::SLEWED);
            self.counters.slewed_ticks = self.counters.slewed_ticks.wrapping_add(1);
        }
        let (dac_code, early) = self.carrier.next(self.envelope.voltage_v_rms(), &self.active.carrier);
        if early {
            self.flags = self.flags.with(Flags::CARRIER_BALANCED);
            self.counters.balanced_edges = self.counters.balanced_edges.wrapping_add(1);
        }
        Drive { dac_code, amplifier_enable: true }
    }

    /// Zero at once.
    fn silence(&mut self) -> Drive {
        self.asked_electric_friction_n = 0.0;
        self.envelope.silence();
        self.carrier.rest(&self.active.carrier);
        Drive::default()
    }
}
