//! The tick: touch in, voltage out.

use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::message::Telemetry;

use crate::carrier::Carrier;
use crate::envelope::Envelope;
use crate::estimator::{Estimate, Estimator};
use crate::layer::Moment;
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
    /// On the friction under the finger: below 1 while the finger is still or was so.
    gain: f32,
    asked_electric_friction_n: f32,
    target_v_rms: f32,
    out_of_reach: bool,
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
    /// Ticks until the last report is too old, zero without a finger.
    good_ticks: u32,
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
        good_ticks: 0,
        sampled_at_tick: None,
        last_x_m: 0.0,
        last_y_m: 0.0,
        estimate: Estimate::ZERO,
    };

    fn take(&mut self, touch: Touch, now_tick: u32, timing: &Timing) {
        match touch {
            Touch::Up => {
                self.lift();
                self.sampled_at_tick = None;
            }
            Touch::Down { x_m, y_m, age_ticks } => {
                let newer = self.sampled_at_tick.is_none_or(|tick| age_ticks < now_tick.wrapping_sub(tick));
                // A report that says nothing new does not keep the output alive: the source may be stuck.
                if newer && age_ticks <= SAMPLE_AGE_MAX_TICKS && x_m.is_finite() && y_m.is_finite() {
                    self.estimator.update(now_tick, age_ticks, x_m, y_m, timing.tick_period_s);
                    self.sampled_at_tick = Some(now_tick.wrapping_sub(age_ticks));
                    // The report is good at this tick, too.
                    self.good_ticks = timing.stale_after_ticks + 2;
                    self.last_x_m = x_m;
                    self.last_y_m = y_m;
                }
            }
        }
    }

    /// Forgets the finger. What is left of its estimator means nothing without samples.
    fn lift(&mut self) {
        self.good_ticks = 0;
        self.estimator.forget();
        self.stillness = Stillness::MOVING;
        self.estimate = Estimate::ZERO;
        self.last_x_m = 0.0;
        self.last_y_m = 0.0;
    }

    /// Estimates where the finger is now.
    #[inline]
    fn locate(&mut self, now_tick: u32, tick_period_s: f32) {
        self.estimate = self.estimator.at(now_tick, tick_period_s);
    }

    /// Where the finger is taken to be; without prediction, where it was last seen.
    #[inline]
    fn place(&self, prediction: bool) -> (f32, f32) {
        if prediction { (self.estimate.x_m, self.estimate.y_m) } else { self.last_place() }
    }

    #[cold]
    fn last_place(&self) -> (f32, f32) {
        (self.last_x_m, self.last_y_m)
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
            gain: 1.0,
            asked_electric_friction_n: 0.0,
            target_v_rms: 0.0,
            out_of_reach: false,
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
        let spare = match order {
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
            Order::SetLayer { layer, on, gain } => {
                self.active.set_layer(layer, on, gain);
                None
            }
            _ => None,
        };
        self.supervisor.set_host_timeout(self.host_timeout_ticks());
        spare
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
            self.finger.take(touch, self.tick, &self.timing);
        }
        let driven_v = f32::from(self.drive.dac_code) * self.timing.volts_per_code;
        let may_drive = self.supervisor.check(sense, driven_v, self.tick);
        let finger_there = self.look_after_finger();
        self.drive = if may_drive && finger_there { self.render(sense.touch.is_some()) } else { self.silence() };
        self.drive
    }

    /// What the board does now.
    pub fn status(&self) -> Status {
        let estimate = &self.finger.estimate;
        let (finger_x_m, finger_y_m) = self.finger.place(self.active.prediction);
        let flags = if self.supervisor.host_silent() { self.flags.with(Flags::HOST_SILENT) } else { self.flags };
        Status {
            telemetry: Telemetry {
                tick: self.tick,
                state: self.supervisor.state(),
                flags,
                finger_x_m,
                finger_y_m,
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

    /// Finds the finger, and returns whether there is one.
    #[inline]
    fn look_after_finger(&mut self) -> bool {
        if self.finger.good_ticks == 0 {
            self.flags = Flags::NO_FINGER;
            return false;
        }
        self.finger.good_ticks -= 1;
        if self.finger.good_ticks == 0 {
            self.flags = Flags::TOUCH_STALE;
            self.finger.lift();
            return false;
        }
        self.finger.locate(self.tick, self.timing.tick_period_s);
        let ramp = self.finger.stillness.update(&self.finger.estimate, &self.timing.stillness);
        self.gain = ramp.unwrap_or(1.0);
        self.flags = if ramp.is_some() { Flags::STILL } else { Flags::default() };
        true
    }

    /// Puts the friction under the finger on the carrier. A tick that has taken a report has done enough: it goes on
    /// with what the tick before asked for, and the longest tick is shorter by a quarter.
    #[inline]
    fn render(&mut self, reported: bool) -> Drive {
        if !reported {
            self.target_v_rms = self.voltage_under_finger_v_rms();
        }
        if self.out_of_reach {
            self.flags = self.flags.with(Flags::SATURATED);
            self.counters.saturated_ticks = self.counters.saturated_ticks.wrapping_add(1);
        }
        if self.envelope.follow(self.target_v_rms, self.active.slew_step_v) {
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

    /// The rms voltage that the scene wants under the finger.
    #[inline]
    fn voltage_under_finger_v_rms(&mut self) -> f32 {
        let Some(table) = self.active.table() else { return 0.0 };
        let (x_m, y_m) = self.finger.place(self.active.prediction);
        let electric_friction_n = self.gain * self.active.electric_friction_n(&Moment { x_m, y_m }, self.pool);
        self.asked_electric_friction_n = electric_friction_n;
        // Bit patterns of what is negative, and of not-a-number, are above those of every positive number.
        self.out_of_reach = electric_friction_n.to_bits() > table.electric_friction_max_n().to_bits()
            && is_not_minus_zero(electric_friction_n);
        table.voltage_v_rms(electric_friction_n)
    }

    /// Zero at once.
    fn silence(&mut self) -> Drive {
        self.asked_electric_friction_n = 0.0;
        self.target_v_rms = 0.0;
        self.out_of_reach = false;
        self.envelope.silence();
        self.carrier.rest(&self.active.carrier);
        Drive::default()
    }
}

#[cold]
fn is_not_minus_zero(electric_friction_n: f32) -> bool {
    electric_friction_n != 0.0
}
