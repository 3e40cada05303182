//! The tick: touch in, voltage out.

mod orders;
mod status;

use frixel_model::InverseTable;
use frixel_wire::fault::State;

use crate::carrier::Carrier;
use crate::deadline::{earlier, is_past};
use crate::envelope::Envelope;
use crate::finger::{Finger, FingerTiming};
use crate::order::Counters;
#[cfg(feature = "stream")]
use crate::stream::{Player, StreamBuffer};
use crate::supervisor::{self, Supervisor};
use crate::{Active, Board, Drive, Sense, Touch};
#[cfg(feature = "stream")]
use frixel_layers::StreamSample;
use frixel_layers::{BitmapPool, Clicks, Inputs};

/// Ticks until the next look at what has no deadline: far less than the tick counter takes to wrap.
const LOOK_AFTER_TICKS: u32 = 1 << 30;

/// For so long nothing but an order leaves the scene unasked.
const ORDERED_TICKS: u32 = 4;

/// Turns touch into voltage, one tick at a time, and owns the output through its supervisor.
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
    /// When there is something else to do than to ask the scene: an errand of the finger's, or a deadline. Never later than
    /// now for what is not live, so that it never drives.
    due_tick: u32,
    /// When the host will have been silent for too long, or when to look again if it need not be there.
    silent_tick: u32,
    /// The same, or before it, when touch data are too old or a slow finger is still. It may be too early while a report
    /// is taken in: what is looked at then says so.
    deadline_tick: u32,
    /// When the scene was last asked; long ago after an order that may have changed what it wants.
    asked_tick: u32,
    /// There is a scene, a finger, and leave to drive.
    live: bool,
    arm_switch: bool,
    dac_code: i16,
    last: LastTicks,
    /// What layers depend on besides the place.
    inputs: Inputs,
    asked_electric_friction_n: f32,
    target_v_rms: f32,
    counters: Counters,
    orders_applied: u32,
    /// `None` on a board that has no buffer for it.
    #[cfg(feature = "stream")]
    stream: Option<Player<'a>>,
    /// A stream plays, or fades.
    #[cfg(feature = "stream")]
    streaming: bool,
}

/// When something was last counted. It means nothing while its count is none.
#[derive(Clone, Copy, Default)]
struct LastTicks {
    saturated_tick: u32,
    slewed_tick: u32,
}

/// What belongs to the board and is computed once.
#[derive(Clone, Copy)]
struct Timing {
    finger: FingerTiming,
    host_timeout_default_ticks: u32,
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
            },
            pool,
            active,
            supervisor: Supervisor::new(board),
            finger: Finger::UP,
            clicks: Clicks::NONE,
            envelope: Envelope::default(),
            carrier,
            tick: 0,
            due_tick: 0,
            silent_tick: LOOK_AFTER_TICKS,
            deadline_tick: LOOK_AFTER_TICKS,
            asked_tick: 0,
            live: false,
            arm_switch: false,
            dac_code: 0,
            last: LastTicks::default(),
            inputs: Inputs::default(),
            asked_electric_friction_n: 0.0,
            target_v_rms: 0.0,
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

    /// One tick: to be called exactly [`Board::tick_hz`] times a second.
    ///
    /// Deadline: the drive has to be at the DAC before the next tick begins, 25 us or 4,250 cycles at 40 kHz on the
    /// G474. A board that misses it calls [`Ticker::raise`] with [`Fault::Deadline`](frixel_wire::fault::Fault::Deadline).
    /// The tick does not allocate, wait or panic; its longest path is a scene whose layers all lie under the finger.
    // A board that is built for size would make it small, and slow.
    #[inline(never)]
    pub fn tick(&mut self, sense: &Sense) -> Drive {
        self.tick = self.tick.wrapping_add(1);
        self.arm_switch = sense.arm_switch;
        if self.supervisor.check(sense, self.dac_code) {
            // What is not live any more is due.
            self.look();
        }
        #[cfg(feature = "stream")]
        if self.streaming {
            self.play_stream();
        }
        self.finger.advance();
        let due = is_past(self.due_tick, self.tick);
        if (due || sense.touch.is_some()) && self.may_attend(sense.touch) {
            return self.attend(sense.touch);
        }
        self.ask();
        self.put_out()
    }

    /// A tick in which there is something else to do than to ask the scene: it takes a report of the touch source, or goes
    /// on with the last, or meets a deadline, or rests. If it drives, it drives what the scene asked for before.
    #[inline(never)]
    fn attend(&mut self, touch: Option<Touch>) -> Drive {
        let taken = touch.is_some_and(|touch| self.finger.take(touch, self.tick, &self.timing.finger));
        if taken {
            self.live &= self.finger.is_there();
        } else if self.finger.has_errand() && self.finger.go_on(self.tick, self.active.prediction, &self.timing.finger)
        {
            self.look_at_finger();
        }
        if is_past(self.deadline_tick, self.tick) {
            self.look();
        }
        self.plan();
        if !self.live {
            return self.rest();
        }
        if self.counters.saturated_ticks > 0 && self.last.saturated_tick == self.tick.wrapping_sub(1) {
            self.note_out_of_reach();
        }
        self.put_out()
    }

    /// Whether this tick may do something else than ask the scene: when the tick before asked it. A lift or a deadline never
    /// waits, and a report that can be taken may have the tick after an errand, but not one after an order: it is left out.
    #[inline]
    fn may_attend(&self, touch: Option<Touch>) -> bool {
        let asked_before_ticks = self.tick.wrapping_sub(self.asked_tick);
        asked_before_ticks == 1
            || !self.live
            || touch == Some(Touch::Up)
            || is_past(self.deadline_tick, self.tick)
            || asked_before_ticks < ORDERED_TICKS && touch.is_some() && self.finger.is_ready()
    }

    /// There is a scene, a finger, and leave to drive.
    fn may_be_live(&self) -> bool {
        self.finger.is_there() && self.supervisor.state() == State::Active && self.active.table().is_some()
    }

    /// Looks at everything that has a deadline or that an order may have changed.
    fn look(&mut self) {
        self.finger.expire(self.tick, &self.timing.finger);
        self.supervisor.expire(self.tick);
        let silent_in_ticks = match self.supervisor.silent_at_tick() {
            Some(tick) => tick.wrapping_sub(self.tick).min(LOOK_AFTER_TICKS),
            None => LOOK_AFTER_TICKS,
        };
        self.silent_tick = self.tick.wrapping_add(silent_in_ticks);
        #[cfg(feature = "stream")]
        if self.supervisor.state() != State::Active {
            self.stop_stream();
        }
        self.look_at_finger();
        self.plan();
    }

    /// Looks at what the finger may have changed.
    #[inline(never)]
    fn look_at_finger(&mut self) {
        self.deadline_tick = match self.finger.expires_at_tick() {
            Some(tick) => earlier(tick, self.silent_tick),
            None => self.silent_tick,
        };
        #[cfg(feature = "speed")]
        {
            self.inputs.velocity_m_per_s = self.finger.velocity_m_per_s();
        }
        let may_be_live = self.may_be_live();
        if may_be_live != self.live {
            // What was asked for in another life is asked for no longer.
            self.target_v_rms = 0.0;
            self.asked_electric_friction_n = 0.0;
            self.asked_tick = self.tick;
        }
        self.live = may_be_live;
    }

    /// Finds when there is something else to do than to ask the scene: at once, if there is an errand or nothing to ask.
    fn plan(&mut self) {
        let at_once = !self.live || self.finger.has_errand();
        self.due_tick = if at_once { self.tick } else { self.deadline_tick };
    }

    #[cfg(feature = "stream")]
    #[inline(never)]
    fn play_stream(&mut self) {
        if let Some(stream) = &mut self.stream {
            stream.advance();
            self.inputs.stream = stream.now();
            self.streaming = !stream.is_over();
        }
    }

    #[cfg(feature = "stream")]
    fn stop_stream(&mut self) {
        if let Some(stream) = &mut self.stream {
            stream.stop();
            self.inputs.stream = StreamSample::default();
            self.streaming = false;
        }
    }

    /// Asks the scene what it wants at this moment, where the finger is now, and finds the voltage for it.
    #[inline]
    fn ask(&mut self) {
        let Some(table) = self.active.table() else { return };
        let place_m = self.finger.place_m();
        self.inputs.set_place(place_m, self.tick);
        let friction_n = self.active.electric_friction_n(&self.inputs, self.pool, &mut self.clicks);
        self.asked_tick = self.tick;
        let electric_friction_n = self.finger.gain() * friction_n;
        self.asked_electric_friction_n = electric_friction_n;
        self.target_v_rms = table.voltage_v_rms(electric_friction_n);
        if may_be_out_of_reach(electric_friction_n, table) {
            self.note_out_of_reach();
        }
    }

    /// Counts a tick whose friction is out of reach.
    #[cold]
    fn note_out_of_reach(&mut self) {
        // Minus zero is zero.
        if self.asked_electric_friction_n != 0.0 {
            self.last.saturated_tick = self.tick;
            self.counters.saturated_ticks = self.counters.saturated_ticks.wrapping_add(1);
        }
    }

    /// Brings the envelope to what is asked for, and the carrier to the DAC.
    #[allow(clippy::inline_always, reason = "the call would cost every tick a tenth of what it takes")]
    #[inline(always)]
    fn put_out(&mut self) -> Drive {
        if self.envelope.follow(self.target_v_rms, self.active.slew_step_v) {
            self.last.slewed_tick = self.tick;
            self.counters.slewed_ticks = self.counters.slewed_ticks.wrapping_add(1);
        }
        let dac_code = self.carrier.next(self.envelope.voltage_v_rms(), &self.active.carrier, self.tick);
        self.dac_code = dac_code;
        Drive { dac_code, amplifier_enable: self.live }
    }

    /// Zero at once.
    #[inline(never)]
    fn rest(&mut self) -> Drive {
        self.asked_electric_friction_n = 0.0;
        self.target_v_rms = 0.0;
        self.clicks.lift();
        self.envelope.silence();
        self.carrier.rest(&self.active.carrier);
        self.dac_code = 0;
        Drive::default()
    }
}

/// Above the largest friction, negative, or not a number: bit patterns of the last two are above those of every positive
/// number. Minus zero is among them, and within reach.
#[inline]
fn may_be_out_of_reach(electric_friction_n: f32, table: &InverseTable) -> bool {
    electric_friction_n.to_bits() > table.electric_friction_max_n().to_bits()
}
