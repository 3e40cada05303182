//! The tick: a finger's track and the board's inputs in, a DAC code out.
//!
//! # Conditions for zero output
//!
//! The output is zero in every tick in which one of these holds:
//!
//! - The state is not Active. [`Order::Stop`], [`Order::Disarm`] and the host timeout leave it: an armed or active
//!   board needs a host. A fault leaves it in the tick that detects it: the arm switch ([`Sense`]) at once, the
//!   amplifier's ready line at its second wrong sample within a millisecond, a fault of the board's own by
//!   [`Ticker::raise`]. The monitor voltage is a fault once wrong ticks exceed a third of the correct ones by 0.4 ms
//!   (at once after the enable has fallen), or once the gain over some milliseconds is off by more than a quarter.
//! - No finger has a valid track: after [`Order::Lift`], and when a track expires. A [`Track`] of another contact than
//!   the previous one counts as a lift: zero in the tick that takes it.
//! - There is no scene ([`Order::Unload`]). [`Order::Load`] of another scene lowers the envelope to the new voltage
//!   limit at once.
//!
//! # Limits of the output
//!
//! The coefficients of every scene are lowered to the board's [`Ceilings`] before the first tick that uses them, and no
//! code exceeds the coefficients. The ceilings thus hold for all orders of the session. Host timeouts are limited to
//! their ceiling, and tracks to the lifetime of the board's touch data.
//!
//! A stream that starts while the state is not Active is stopped at the next tick.

mod orders;
mod status;

use frixel_layers::{BitmapPool, Clicks, Inputs};
use frixel_model::InverseTable;
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::State;

use crate::carrier::Carrier;
use crate::envelope::Envelope;
use crate::finger::{Finger, fall_per_tick, stale_after_ticks};
use crate::order::Counters;
use crate::stream::Player;
#[cfg(feature = "stream")]
use crate::stream::StreamBuffer;
use crate::supervisor::{self, Supervisor};
use crate::{Active, Board, Ceilings, Drive, Sense, Track};

/// Turns the finger's track into voltage, one tick at a time.
pub struct Ticker<'a> {
    timing: Timing,
    ceilings: Ceilings,
    /// Whether the current scene's coefficients were above the ceilings.
    is_clamped: bool,
    tick: u32,
    /// Decides whether the output is enabled.
    supervisor: Supervisor,
    finger: Finger,
    /// Whether the finger was lifted since the last tick, even if another has touched the screen since.
    was_lifted: bool,
    /// Coefficients of the current scene.
    active: &'a mut Active,
    pool: &'a BitmapPool,
    clicks: Clicks,
    /// Inputs of the layers: position and velocity of the finger, tick, stream.
    inputs: Inputs,
    stream: Player<'a>,
    envelope: Envelope,
    carrier: Carrier,
    /// Target friction at the last tick. This and the next fields hold the results of the last tick.
    electric_friction_n: f32,
    target_v_rms: f32,
    dac_code: DacCode,
    arm_switch: bool,
    counters: Counters,
    orders_applied: u32,
}

/// Constants of the board, computed once.
#[derive(Clone, Copy)]
struct Timing {
    tick_period_s: f32,
    /// Longest time for which a track is followed, even if it ends later.
    track_ticks_max: u32,
    /// See [`Track::gain_before_end`].
    fall_per_tick: f32,
    host_timeout_default_ticks: u32,
}

impl<'a> Ticker<'a> {
    /// A ticker whose output is zero. It reads bitmaps from `pool` and starts with `active`, which need not hold a
    /// scene.
    pub fn new(board: &Board, pool: &'a BitmapPool, active: &'a mut Active) -> Self {
        let ceilings = board.ceilings();
        let is_clamped = active.limit_to(&ceilings);
        let carrier = Carrier::new(&active.carrier);
        let stale_after_ticks = stale_after_ticks(board);
        Self {
            timing: Timing {
                tick_period_s: board.tick_period_s(),
                track_ticks_max: stale_after_ticks + 1,
                fall_per_tick: fall_per_tick(stale_after_ticks),
                host_timeout_default_ticks: supervisor::host_timeout_default_ticks(board),
            },
            ceilings,
            is_clamped,
            tick: 0,
            supervisor: Supervisor::new(board),
            finger: Finger::Up,
            was_lifted: false,
            active,
            pool,
            clicks: Clicks::NONE,
            inputs: Inputs::default(),
            stream: Player::new(board.tick_period_s()),
            envelope: Envelope::default(),
            carrier,
            electric_friction_n: 0.0,
            target_v_rms: 0.0,
            dac_code: DacCode::ZERO,
            arm_switch: false,
            counters: Counters { clamped_loads: is_clamped.into(), ..Counters::default() },
            orders_applied: 0,
        }
    }

    /// Sets the tick count, for tests of its wrap-around.
    #[cfg(feature = "set-tick")]
    pub fn set_tick(&mut self, tick: u32) {
        self.tick = tick;
    }

    /// Plays streams from `buffer` from now on. The session writes their samples into it.
    #[cfg(feature = "stream")]
    pub fn attach_stream(&mut self, buffer: &'a StreamBuffer) {
        self.stream.attach(buffer);
    }

    /// Runs one tick. Call this exactly [`Board::tick_hz`] times a second, with at most one call of [`Ticker::apply`]
    /// before each.
    ///
    /// Deadline: the drive must reach the DAC at the latest when the board latches the frame. On the G474, the board
    /// must begin to send the frame 21.8 us into the tick's period of 25 us (4,250 cycles). A tick that misses the
    /// deadline leaves the previous voltage on the electrode: the board then sets the output to zero and calls
    /// [`Ticker::raise`] with [`Fault::Deadline`](frixel_wire::fault::Fault::Deadline). The tick does not allocate,
    /// wait or panic, and runs the same steps in the same order while the output is enabled; its duration depends on
    /// the layers under the finger.
    // Not inlined: a caller that is built for size would otherwise compile the tick for size, which is slow.
    #[inline(never)]
    pub fn tick(&mut self, sense: &Sense) -> Drive {
        self.tick = self.tick.wrapping_add(1);
        self.arm_switch = sense.arm_switch;

        // Return if anything stops the output: a fault (amplifier, monitor, arm switch, or raised by the board), a
        // state other than Active (Stop, Disarm, host timeout), no track (lift, expiry), no scene. Supervisor and
        // finger are updated first, so that they stop the output in this tick. A lift is cleared in every state, so
        // that it does not affect a later play.
        let driven_code = self.dac_code;
        self.supervisor.check(sense, driven_code);
        self.supervisor.expire(self.tick);
        self.finger.expire(self.tick);
        self.stream.advance(&mut self.inputs.stream);
        let was_lifted = core::mem::take(&mut self.was_lifted);
        let (State::Active, Some(track), false) = (self.supervisor.state(), self.finger.track(), was_lifted) else {
            return self.zero_output();
        };
        let Some(table) = self.active.table() else { return self.zero_output() };

        // Compute the output: the finger's position, the scene's friction there, its voltage, the envelope, the
        // carrier.
        let elapsed_s = self.elapsed_s(track);
        self.inputs.set_place(track.place_m(elapsed_s), self.tick);
        self.inputs.velocity_m_per_s = track.velocity_m_per_s(elapsed_s);
        let gain = track.ramp.gain_at(self.tick) * track.gain_before_end(self.tick, self.timing.fall_per_tick);
        let friction_n = gain * self.active.electric_friction_n(&self.inputs, self.pool, &mut self.clicks);
        // Zero for a NaN friction.
        let table_v_rms = table.voltage_v_rms(friction_n);
        let max_v_rms = self.active.voltage_max_v_rms;
        let target_v_rms = if table_v_rms < max_v_rms { table_v_rms } else { max_v_rms };
        if is_out_of_reach(friction_n, table) {
            self.counters.saturated_ticks = self.counters.saturated_ticks.wrapping_add(1);
        }
        if self.envelope.follow(target_v_rms, self.active.slew_step_v) {
            self.counters.slewed_ticks = self.counters.slewed_ticks.wrapping_add(1);
        }
        self.supervisor.set_amplifier_enabled(true, driven_code);
        let dac_code = self.carrier.next(self.envelope.voltage_v_rms(), &self.active.carrier, self.tick);

        self.electric_friction_n = friction_n;
        self.target_v_rms = target_v_rms;
        self.dac_code = dac_code;
        Drive { dac_code, amplifier_enable: true }
    }

    /// Seconds from the start of the track to this tick; 0 without prediction, so that the finger stays at its measured
    /// position.
    #[inline]
    fn elapsed_s(&self, track: &Track) -> f32 {
        if self.active.prediction_off { 0.0 } else { track.elapsed_s(self.tick, self.timing.tick_period_s) }
    }

    /// Sets the output to zero at once, without the slew limit.
    #[inline(never)]
    fn zero_output(&mut self) -> Drive {
        if self.supervisor.state() != State::Active {
            self.stream.stop(&mut self.inputs.stream);
        }
        self.supervisor.set_amplifier_enabled(false, self.dac_code);
        self.clicks.lift();
        self.envelope.reset_to_zero();
        self.carrier.reset_to_zero(&self.active.carrier);
        self.electric_friction_n = 0.0;
        self.target_v_rms = 0.0;
        self.dac_code = DacCode::ZERO;
        Drive { dac_code: DacCode::ZERO, amplifier_enable: false }
    }
}

/// Whether a friction is above the table's maximum, negative or NaN. As an unsigned integer, the bit pattern of a
/// negative number or NaN exceeds that of every positive number. Minus zero is within reach.
#[inline]
fn is_out_of_reach(electric_friction_n: f32, table: &InverseTable) -> bool {
    electric_friction_n.to_bits() > table.electric_friction_max_n().to_bits() && electric_friction_n != 0.0
}

#[cfg(test)]
mod tests;
