//! The tick: touch in, voltage out.

use frixel_model::InverseTable;
use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::message::Telemetry;

use crate::carrier::Carrier;
use crate::envelope::Envelope;
use crate::finger::{Finger, FingerTiming, Presence};
use crate::layer::{Clicks, Moment};
use crate::order::Counters;
#[cfg(feature = "stream")]
use crate::stream::{Player, StreamBuffer, StreamNow};
use crate::supervisor::{self, Supervisor};
use crate::{Active, BitmapPool, Board, Drive, Order, Sense, Status};

/// Ticks until the next look at what has no deadline: far less than the tick counter takes to wrap.
const LOOK_AFTER_TICKS: u32 = 1 << 30;

/// After so many ticks that had something else to do, the next looks at the scene all the same: a touch source may
/// report faster than its reports are taken in.
const ATTENDED_MAX_TICKS: u32 = 8;

/// Turns touch into voltage, one tick at a time, and owns the output through its supervisor.
#[allow(clippy::struct_excessive_bools, reason = "each says one thing that the tick asks in one instruction")]
pub struct Ticker<'a> {
    finger: Finger,
    timing: Timing,
    pool: &'a BitmapPool,
    active: &'a mut Active,
    supervisor: Supervisor,
    clicks: Clicks,
    envelope: Envelope,
    carrier: Carrier,
    tick: u32,
    /// When something is next due: a host that is silent, or touch data that are too old.
    due_tick: u32,
    /// When the host will have been silent for too long, or when to look again if it need not be there.
    silent_tick: u32,
    /// There is a scene, a finger, and leave to drive.
    live: bool,
    drive: Drive,
    arm_switch: bool,
    /// An order may have changed what the scene asks for since it was last asked.
    asked_by_order: bool,
    /// What the scene was last asked for.
    moment: Moment,
    asked_electric_friction_n: f32,
    target_v_rms: f32,
    flags: Flags,
    counters: Counters,
    orders_applied: u32,
    /// `None` on a board that has no buffer for it.
    #[cfg(feature = "stream")]
    stream: Option<Player<'a>>,
    /// A stream plays, or fades.
    #[cfg(feature = "stream")]
    streaming: bool,
}

/// What belongs to the board and is computed once.
#[derive(Clone, Copy)]
struct Timing {
    finger: FingerTiming,
    host_timeout_default_ticks: u32,
    volts_per_code: f32,
}

impl<'a> Ticker<'a> {
    /// A ticker with its output at zero, that reads bitmaps from `pool` and starts with `active`, which need not hold
    /// a scene.
    pub fn new(board: &Board, pool: &'a BitmapPool, active: &'a mut Active) -> Self {
        let carrier = Carrier::new(&active.carrier);
        Self {
            timing: Timing {
                finger: FingerTiming::new(board),
                host_timeout_default_ticks: supervisor::host_timeout_default_ticks(board),
                volts_per_code: board.limits.full_scale_v_peak / f32::from(i16::MAX),
            },
            pool,
            active,
            supervisor: Supervisor::new(board),
            finger: Finger::UP,
            clicks: Clicks::NONE,
            envelope: Envelope::default(),
            carrier,
            tick: 0,
            due_tick: LOOK_AFTER_TICKS,
            silent_tick: LOOK_AFTER_TICKS,
            live: false,
            drive: Drive::default(),
            arm_switch: false,
            asked_by_order: false,
            moment: Moment::default(),
            asked_electric_friction_n: 0.0,
            target_v_rms: 0.0,
            flags: Flags::NO_FINGER,
            counters: Counters::default(),
            orders_applied: 0,
            #[cfg(feature = "stream")]
            stream: None,
            #[cfg(feature = "stream")]
            streaming: false,
        }
    }

    /// From now on, plays streams from `buffer`, into which the session takes their samples.
    #[cfg(feature = "stream")]
    pub fn attach_stream(&mut self, buffer: &'a StreamBuffer) {
        self.stream = Some(Player::new(buffer, self.timing.finger.tick_period_s()));
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
                self.clicks.forget();
                #[cfg(feature = "stream")]
                if !self.active.has_stream() {
                    self.stop_stream();
                }
                if self.active.prediction != spare.prediction {
                    self.finger.locate(self.tick, self.active.prediction, &self.timing.finger);
                }
                self.asked_by_order = true;
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
                self.asked_by_order = true;
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

    /// An order has changed what the scene asks for: a tick that would go on with what was asked for before asks anew.
    #[cold]
    #[inline(never)]
    fn ask_again(&mut self) {
        self.asked_by_order = false;
        if self.live {
            (self.target_v_rms, _) = self.voltage_v_rms();
        }
    }

    /// Latches a hard fault that the board has found: the output is zero from the next tick on. A fault that is latched
    /// already stays the one that is told, since it came first.
    pub fn raise(&mut self, fault: Fault, detail: u32) {
        if fault == Fault::Deadline {
            self.counters.missed_deadlines = self.counters.missed_deadlines.wrapping_add(1);
        }
        self.supervisor.raise(fault, detail);
        self.look();
    }

    /// One tick: to be called exactly [`Board::tick_hz`] times a second.
    ///
    /// Deadline: the drive has to be at the DAC before the next tick begins, 25 us or 4,250 cycles at 40 kHz on the
    /// G474. A board that misses it calls [`Ticker::raise`] with [`Fault::Deadline`]. The tick does not allocate, wait
    /// or panic; its longest path is a scene whose layers all lie under the finger.
    // A board that is built for size would make it small, and slow.
    #[inline(never)]
    pub fn tick(&mut self, sense: &Sense) -> Drive {
        self.tick = self.tick.wrapping_add(1);
        self.arm_switch = sense.arm_switch;
        let driven_v = f32::from(self.drive.dac_code) * self.timing.volts_per_code;
        if self.supervisor.check(sense, driven_v) {
            self.look();
        }
        #[cfg(feature = "stream")]
        if self.streaming {
            self.play_stream();
        }
        let due = self.due_tick.wrapping_sub(self.tick) as i32 <= 0;
        self.finger.advance();
        // A slow finger is where it was a tick ago.
        let settling = self.finger.is_settling();
        if due || sense.touch.is_some() || self.finger.is_digesting() || settling && self.tick & 1 == 0 {
            if self.asked_by_order {
                self.ask_again();
            }
            self.attend(sense, due);
        } else {
            self.flags = if settling { self.still() } else { Flags::default() };
            if self.live {
                self.meet_the_moment();
                let (voltage_v_rms, out_of_reach) = self.voltage_v_rms();
                self.target_v_rms = voltage_v_rms;
                if out_of_reach {
                    self.note_out_of_reach();
                }
            }
        }
        self.put_out()
    }

    /// Attends to what is due, or to a report of the touch source. That is enough for a tick: it goes on with what the
    /// tick before asked for.
    #[inline(never)]
    fn attend(&mut self, sense: &Sense, due: bool) {
        let timing = &self.timing.finger;
        self.flags = self.still();
        match sense.touch {
            Some(touch) => self.finger.take(touch, self.tick, self.active.prediction, timing),
            None if due => {}
            None if self.finger.is_digesting() => self.finger.digest(self.tick, self.active.prediction, timing),
            None => self.finger.settle(timing),
        }
        #[cfg(feature = "speed")]
        {
            self.moment.velocity_m_per_s = self.finger.velocity_m_per_s();
        }
        if due {
            self.look();
        } else if !self.live && self.may_be_live() {
            self.due_tick = self.tick.wrapping_add(1);
        } else {
            self.live &= self.may_be_live();
            self.find_next_due();
        }
        if self.live && self.tick.wrapping_sub(self.moment.tick) > ATTENDED_MAX_TICKS {
            self.meet_the_moment();
            self.ask_again();
        }
        let asked_n = self.asked_electric_friction_n;
        if self.live && self.active.table().is_some_and(|table| may_be_out_of_reach(asked_n, table)) {
            self.note_out_of_reach();
        }
    }

    /// The scene is to be asked for this tick, with the finger where it is now.
    #[inline]
    fn meet_the_moment(&mut self) {
        [self.moment.x_m, self.moment.y_m] = self.finger.place_m();
        self.moment.tick = self.tick;
    }

    /// The flag of a finger that is still, if it is.
    fn still(&self) -> Flags {
        if self.finger.gain() < 1.0 { Flags::STILL } else { Flags::default() }
    }

    /// There is a scene, a finger, and leave to drive.
    fn may_be_live(&self) -> bool {
        let there = matches!(self.finger.presence(), Presence::Down { .. });
        there && self.supervisor.state() == State::Active && self.active.table().is_some()
    }

    /// Looks at everything that has a deadline, and finds out whether to drive and when to look again.
    fn look(&mut self) {
        self.finger.expire(self.tick);
        self.supervisor.expire(self.tick);
        let in_ticks = self.supervisor.silent_at_tick().map_or(LOOK_AFTER_TICKS, |tick| tick.wrapping_sub(self.tick));
        self.silent_tick = self.tick.wrapping_add(in_ticks.min(LOOK_AFTER_TICKS));
        self.find_next_due();
        let may_be_live = self.may_be_live();
        if may_be_live && !self.live {
            self.moment.tick = self.tick;
        }
        self.live = may_be_live;
        #[cfg(feature = "stream")]
        if self.supervisor.state() != State::Active {
            self.stop_stream();
        }
    }

    /// The next deadline: the host's, or before it the finger's.
    fn find_next_due(&mut self) {
        self.due_tick = match self.finger.presence() {
            Presence::Down { until_tick } if (until_tick.wrapping_sub(self.silent_tick) as i32) < 0 => until_tick,
            _ => self.silent_tick,
        };
    }

    /// What the board does now.
    pub fn status(&self) -> Status {
        let [finger_x_m, finger_y_m] = self.finger.place_m();
        let mut flags = self.flags;
        if self.supervisor.host_silent() {
            flags = flags.with(Flags::HOST_SILENT);
        }
        #[cfg(feature = "stream")]
        if self.stream.as_ref().is_some_and(Player::is_dry) {
            flags = flags.with(Flags::STREAM_DRY);
        }
        Status {
            telemetry: Telemetry {
                tick: self.tick,
                state: self.supervisor.state(),
                flags,
                finger_x_m,
                finger_y_m,
                speed_m_per_s: self.finger.speed_m_per_s(),
                asked_electric_friction_n: self.asked_electric_friction_n,
                voltage_v_rms: self.envelope.voltage_v_rms(),
                dac_code: self.drive.dac_code,
            },
            fault: self.supervisor.fault(),
            orders_applied: self.orders_applied,
            arm_switch: self.arm_switch,
            counters: self.counters(),
        }
    }

    fn counters(&self) -> Counters {
        #[cfg(feature = "stream")]
        if let Some(stream) = &self.stream {
            let (stream_underruns, stream_gaps) = stream.counts();
            return Counters { stream_underruns, stream_gaps, ..self.counters };
        }
        self.counters
    }

    #[cfg(feature = "stream")]
    #[inline(never)]
    fn play_stream(&mut self) {
        if let Some(stream) = &mut self.stream {
            stream.advance();
            self.moment.stream = stream.now();
            self.streaming = !stream.is_over();
        }
    }

    #[cfg(feature = "stream")]
    fn stop_stream(&mut self) {
        if let Some(stream) = &mut self.stream {
            stream.stop();
            self.moment.stream = StreamNow::default();
            self.streaming = false;
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

    /// Brings the envelope to what is asked for, and the carrier to the DAC.
    #[inline]
    fn put_out(&mut self) -> Drive {
        if !self.live {
            return self.rest();
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
        self.drive = Drive { dac_code, amplifier_enable: true };
        self.drive
    }

    /// The rms voltage that the scene wants at this moment, and whether the friction may be out of reach.
    #[allow(clippy::inline_always, reason = "a call would cost every tick a tenth of what it takes")]
    #[inline(always)]
    fn voltage_v_rms(&mut self) -> (f32, bool) {
        let Some(table) = self.active.table() else { return (0.0, false) };
        #[cfg(feature = "edge")]
        if self.active.has_clicks() {
            self.clicks.begin();
        }
        let friction_n = self.active.electric_friction_n(&self.moment, self.pool, &mut self.clicks);
        let electric_friction_n = self.finger.gain() * friction_n;
        self.asked_electric_friction_n = electric_friction_n;
        (table.voltage_v_rms(electric_friction_n), may_be_out_of_reach(electric_friction_n, table))
    }

    /// Counts a tick whose friction is out of reach.
    #[cold]
    fn note_out_of_reach(&mut self) {
        // Minus zero is zero.
        if self.asked_electric_friction_n != 0.0 {
            self.flags = self.flags.with(Flags::SATURATED);
            self.counters.saturated_ticks = self.counters.saturated_ticks.wrapping_add(1);
        }
    }

    /// Zero at once.
    #[inline(never)]
    fn rest(&mut self) -> Drive {
        match self.finger.presence() {
            Presence::Up => self.flags = Flags::NO_FINGER,
            Presence::Stale => self.flags = Flags::NO_FINGER.with(Flags::TOUCH_STALE),
            Presence::Down { .. } => {}
        }
        self.asked_electric_friction_n = 0.0;
        self.target_v_rms = 0.0;
        #[cfg(feature = "edge")]
        self.clicks.lift();
        self.envelope.silence();
        self.carrier.rest(&self.active.carrier);
        self.drive = Drive::default();
        self.drive
    }
}

/// Above the largest friction, negative, or not a number: bit patterns of the last two are above those of every positive
/// number. Minus zero is among them, and within reach.
#[inline]
fn may_be_out_of_reach(electric_friction_n: f32, table: &InverseTable) -> bool {
    electric_friction_n.to_bits() > table.electric_friction_max_n().to_bits()
}
