//! Pulses of the enable. Ready and the arm switch are read throughout: some amplifiers are ready only while enabled, so
//! that a pulse may be the first sign of a connected one.

use super::script::{Counts, NEVER_US, Stop, refuse_inputs, refuse_inputs_or_voltage};
use super::{Fall, LoopedBoard};

/// Kicks of the pulse that tests retriggering of the one-shot.
const KICKS: u32 = 5;
/// Time between two kicks, us; also the longest wait for the enable to fall.
const KICK_US: u32 = 500;
const FALL_WAIT_US: u32 = 10_000;
/// Time for the enable to rise before it is disabled again, us.
const RISE_WAIT_US: u32 = 20;
/// Longest time from a kick until the enable is high, us.
const RISE_MAX_US: u32 = 10;
/// Longest time from the last kick, or from disabling, until the enable is low, us.
const FALL_MAX_US: u32 = 1_000;
const CUT_MAX_US: u32 = 2;

/// Edges of a pulse.
struct Pulse {
    /// Time from the first kick until the enable rose, us; `None` if it did not.
    rise_us: Option<u32>,
    /// Time from the last kick until it fell, us; `None` if it did not within [`FALL_WAIT_US`].
    fall_us: Option<u32>,
    /// Whether it fell more than once.
    fell_again: bool,
}

/// Pulses the enable. Ready, switch and monitor have shown no amplifier that it could switch on.
pub(super) fn measure_enable<B: LoopedBoard>(board: &mut B, counts: &mut Counts) -> Result<(), Stop> {
    refuse_inputs_or_voltage(board)?;
    let Pulse { rise_us, fall_us, fell_again } = pulse(board)?;
    counts.say(board, "enable_rises_us", rise_us.unwrap_or(NEVER_US), Some((0, RISE_MAX_US)));
    let least_us = B::ONE_SHOT_US - B::ONE_SHOT_US / 50;
    counts.say(board, "enable_falls_us", fall_us.unwrap_or(NEVER_US), Some((least_us, FALL_MAX_US)));
    counts.say(board, "enable_falls_between_kicks", u32::from(fell_again), Some((0, 0)));
    if rise_us.is_some() && fall_us.is_none() {
        return Err(Stop::EnableStaysHigh);
    }
    refuse_inputs_or_voltage(board)?;
    let cut_us = cut_pulse(board)?;
    counts.say(board, "enable_is_cut_within_us", cut_us.unwrap_or(NEVER_US), Some((0, CUT_MAX_US)));
    if rise_us.is_some() && cut_us.is_none() { Err(Stop::EnableStaysHigh) } else { Ok(()) }
}

/// Kicks the enable [`KICKS`] times, and lets it fall.
fn pulse<B: LoopedBoard>(board: &mut B) -> Result<Pulse, Stop> {
    let first = board.forget_edges();
    let mut last = first;
    let (mut rose, mut fell_again) = (None, false);
    for _ in 0..KICKS {
        last = board.cycles();
        board.kick();
        watch(board, last, KICK_US, |_| None::<()>)?;
        rose = rose.or(board.enable_rose());
        // It may fall only after the last kick, which takes longer than the time between two kicks.
        fell_again |= board.enable_fell().is_some();
    }
    let fell = watch(board, last, FALL_WAIT_US, B::enable_fell)?;
    board.disable();
    Ok(Pulse {
        rise_us: rose.map(|at| us_between::<B>(first, at)),
        fall_us: fell.map(|fall| us_between::<B>(last, fall.at)),
        fell_again: fell_again || fell.is_some_and(|fall| fall.had_fallen_before),
    })
}

/// Kicks the enable, disables it again, and returns the time from disabling until it fell, us.
fn cut_pulse<B: LoopedBoard>(board: &mut B) -> Result<Option<u32>, Stop> {
    let kicked = board.forget_edges();
    board.kick();
    watch(board, kicked, RISE_WAIT_US, |_| None::<()>)?;
    let cut = board.forget_edges();
    board.disable();
    let fell = watch(board, cut, FALL_WAIT_US, B::enable_fell)?;
    Ok(fell.map(|Fall { at, .. }| us_between::<B>(cut, at)))
}

/// Waits until `look` returns a result, up to a time since a start. Disables the enable and ends the script as soon as
/// ready is high or the arm switch is closed.
fn watch<B: LoopedBoard, T>(
    board: &mut B,
    since: u32,
    us: u32,
    mut look: impl FnMut(&mut B) -> Option<T>,
) -> Result<Option<T>, Stop> {
    loop {
        if let Err(stop) = refuse_inputs(board) {
            board.disable();
            return Err(stop);
        }
        let found = look(board);
        if found.is_some() || us_between::<B>(since, board.cycles()) >= us {
            return Ok(found);
        }
        board.idle();
    }
}

/// Microseconds from one cycle to another, rounded up.
fn us_between<B: LoopedBoard>(from: u32, to: u32) -> u32 {
    to.wrapping_sub(from).div_ceil(B::CYCLES_PER_US)
}
