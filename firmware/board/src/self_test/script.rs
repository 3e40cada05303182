//! The script. [`run`] is its table of contents.

use core::fmt;

use super::enable::measure_enable;
use super::load::{Load, counted_since};
use super::{Clocks, Inputs, Levels, LineTest, LoopedBoard, Measurement, ScriptLine, VERSION, Wire};
use crate::bring_up::DriveError;

/// The word typed first, which shows that the board receives.
pub const GREETING: &str = "frixel";
/// The word typed once the amplifier is unplugged.
pub const UNPLUGGED: &str = "unplugged";
/// The word typed to test the line, followed by seconds.
pub const LINE_TEST: &str = "line";
/// The word typed to skip the line test.
pub const SKIP: &str = "skip";

/// Bytes over SDI with each single bit set and cleared.
const PATTERNS: [u8; 12] = [0x00, 0xff, 0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x40, 0x80, 0x55, 0xaa];
/// Number of frames for measuring clocks and latch, a quarter of a second each.
const FRAMES: u32 = 10_000;
/// Clocks of a frame of the DAC.
const FRAME_CLOCKS: u32 = 24;
/// Tolerance of a captured edge in cycles: its synchroniser takes some.
const CAPTURE_CYCLES: u32 = 8;
/// Jitter of a latch in cycles: one of the synchroniser.
const JITTER_CYCLES: u32 = 2;
/// Placeholder for an edge that was not captured.
pub(super) const NEVER_US: u32 = 99_999;
/// Largest voltage at the amplifier that counts as zero, V: the offset allowed by bring-up.
const MONITOR_ZERO_V: f32 = 4.0;
/// Voltages of the ADC loop, mV, and their tolerance: 1 % on either side.
const LOOP_MV: [(u32, &str); 3] = [(300, "adc_at_300_mv"), (1_650, "adc_at_1650_mv"), (3_000, "adc_at_3000_mv")];
const LOOP_TOLERANCE_MV: u32 = 60;
/// Time for which ticks are counted, s.
const COUNTED_S: f32 = 3.0;
/// Silence after which the line test ends, before and after its first byte, s.
const FIRST_BYTE_S: f32 = 5.0;
const LAST_BYTE_S: f32 = 0.5;
/// Largest number of bytes taken from the port per round.
const CHUNK_LEN: usize = 256;

/// Why the self-test has ended early. The enable is low.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// The amplifier's ready is high.
    Ready,
    /// The arm switch is closed, and so is its second pole in the enable's wire.
    Switch,
    /// Something drives the monitor's pin.
    MonitorDriven(Levels),
    /// The monitor does not read zero while the loop outputs zero; mV.
    MonitorNotZero(u32),
    /// A wire is missing.
    Missing(Wire),
    /// The levels at rest of the pin at the end of a wire are wrong.
    Resting(Wire, Levels),
    /// The enable has not fallen after a pulse.
    EnableStaysHigh,
    /// SDO did not receive what SDI sent: the number of wrong bytes, which is all of them if the wire is missing.
    Data(u32),
    /// The scene was not played.
    Drive(DriveError),
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ready => f.write_str("ready is high: switch the amplifier's supply off, and unplug the amplifier"),
            Self::Switch => f.write_str(
                "the arm switch is closed: release it; if it was not pressed, its contact is welded, so unplug it",
            ),
            Self::MonitorDriven(levels) => {
                write!(f, "something drives the monitor's pin ({levels}): unplug the amplifier and its monitor")
            }
            Self::MonitorNotZero(mv) => write!(
                f,
                "the monitor's pin reads {mv} mV with zero volts on its wire: is the wire connected, and the amplifier \
                 unplugged?"
            ),
            Self::Missing(wire) => write!(f, "{wire} is not wired, or its wire is on a neighbouring pin"),
            Self::Resting(wire, levels) => {
                write!(f, "{wire} idles at the wrong level ({levels}): check which pin its wire is on")
            }
            Self::EnableStaysHigh => {
                f.write_str("the enable did not fall after a pulse: no amplifier may be connected to this board")
            }
            Self::Data(wrong) => write!(
                f,
                "{wrong} of {} bytes sent over SDI came back wrong on SDO: is the wire connected, and the DAC \
                 unplugged?",
                PATTERNS.len()
            ),
            Self::Drive(error) => write!(f, "the largest scene did not play: {error}"),
        }
    }
}

impl fmt::Display for Wire {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Clock => "SCLK",
            Self::Sync => "SYNC",
            Self::Enable => "enable",
            Self::Monitor => "the monitor",
        })
    }
}

impl fmt::Display for Levels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let level = |high| if high { "high" } else { "low" };
        write!(f, "{} with a pull-up, {} with a pull-down", level(self.pulled_up), level(self.pulled_down))
    }
}

/// Numbers of measurements so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    measured: u32,
    failed: u32,
}

impl Counts {
    pub(super) fn say(&mut self, board: &mut impl LoopedBoard, name: &str, found: u32, range: Option<(u32, u32)>) {
        let measurement = Measurement { name, found, range };
        self.measured += 1;
        self.failed += u32::from(!measurement.passes());
        board.say(format_args!("{}", ScriptLine::Measured(measurement)));
    }
}

/// Tests a board, and returns the number of measurements out of their range.
pub fn run(board: &mut impl LoopedBoard) -> Result<u32, Stop> {
    let result = steps(board);
    if let Err(stop) = &result {
        board.say(format_args!("{}{stop}.", ScriptLine::Stopped("")));
    }
    result
}

fn steps(board: &mut impl LoopedBoard) -> Result<u32, Stop> {
    let mut counts = Counts::default();
    greet(board);
    refuse_amplifier(board)?;
    unplug(board)?;
    find_wires(board)?;
    measure_frames(board, &mut counts)?;
    measure_enable(board, &mut counts)?;
    measure_adc(board, &mut counts);
    board.start_ticks();
    let mut load = Load::largest(board.board());
    measure_ticks(board, &mut load, &mut counts)?;
    measure_line(board, &mut load, &mut counts)?;
    load.rest(board)?;
    let Counts { measured, failed } = counts;
    board.say(format_args!("{}", ScriptLine::End { measured, failed }));
    Ok(failed)
}

/// Waits for the greeting, which shows that the serial port works in both directions.
fn greet(board: &mut impl LoopedBoard) {
    let kind = board.board().kind;
    board.say(format_args!(""));
    board.say(format_args!("Read docs/board/first-board.md first. No amplifier is plugged in, and its supply is off."));
    confirm(board, format_args!("This begins the self-test."), GREETING);
    // Not earlier: output at the start is lost if no host has opened the port yet.
    board.say(format_args!("{}{kind}", ScriptLine::Begin(VERSION, "")));
}

/// Shows an instruction until the person types `word`.
fn confirm(board: &mut impl LoopedBoard, what: fmt::Arguments<'_>, word: &str) {
    loop {
        board.say(format_args!("{what} Then type: {word}"));
        if board.read_line().trim().eq_ignore_ascii_case(word) {
            return;
        }
    }
}

/// Ends the script if ready is high or the arm switch is closed.
pub(super) fn refuse_inputs(board: &mut impl LoopedBoard) -> Result<(), Stop> {
    match board.inputs() {
        Inputs { amplifier_ready: true, .. } => Err(Stop::Ready),
        Inputs { switch_closed: true, .. } => Err(Stop::Switch),
        Inputs { amplifier_ready: false, switch_closed: false } => Ok(()),
    }
}

/// Ends the script if an amplifier is connected, before anything drives the monitor's wire.
fn refuse_amplifier(board: &mut impl LoopedBoard) -> Result<(), Stop> {
    refuse_inputs(board)?;
    match board.levels(Wire::Monitor) {
        Levels::FREE => Ok(()),
        driven => Err(Stop::MonitorDriven(driven)),
    }
}

/// Ends the script if an input is high, or if the monitor does not read zero while the loop outputs zero.
pub(super) fn refuse_inputs_or_voltage<B: LoopedBoard>(board: &mut B) -> Result<(), Stop> {
    refuse_inputs(board)?;
    let found_mv = board.loop_mv(B::MONITOR_ZERO_MV);
    let most_mv = (MONITOR_ZERO_V * B::MONITOR_MV_PER_V) as u32;
    if found_mv.abs_diff(B::MONITOR_ZERO_MV) <= most_mv { Ok(()) } else { Err(Stop::MonitorNotZero(found_mv)) }
}

fn unplug<B: LoopedBoard>(board: &mut B) -> Result<(), Stop> {
    confirm(
        board,
        format_args!(
            "1. Connect the wires that docs/board/first-board.md lists. The enable is pulsed: unplug the amplifier and \
             the DAC."
        ),
        UNPLUGGED,
    );
    refuse_amplifier(board)
}

/// Finds each wire by the resting level of its start. The enable stays low.
fn find_wires<B: LoopedBoard>(board: &mut B) -> Result<(), Stop> {
    for (wire, resting) in [(Wire::Clock, Levels::HIGH), (Wire::Sync, Levels::HIGH), (Wire::Enable, Levels::LOW)] {
        match board.levels(wire) {
            levels if levels == resting => {}
            Levels::FREE => return Err(Stop::Missing(wire)),
            levels => return Err(Stop::Resting(wire, levels)),
        }
    }
    let mut bytes = PATTERNS;
    let received = board.exchange(&mut bytes);
    let wrong = bytes.iter().zip(PATTERNS).filter(|(found, sent)| **found != *sent).count() as u32;
    if !received || wrong > 0 {
        return Err(Stop::Data(wrong));
    }
    refuse_inputs_or_voltage(board)?;
    board.say(format_args!("All wires are connected."));
    Ok(())
}

/// Counts the clocks of frames, and measures when they are latched.
fn measure_frames<B: LoopedBoard>(board: &mut B, counts: &mut Counts) -> Result<(), Stop> {
    let (mut before, mut after, mut unseen) = (0, 0, 0);
    let mut inside = (u32::MAX, 0);
    for _ in 0..FRAMES {
        refuse_inputs(board)?;
        match board.clocks() {
            Some(clocks) => {
                let Clocks { before: early, inside: clocks, after: late } = clocks;
                before = before.max(u32::from(early));
                after = after.max(u32::from(late));
                inside = (inside.0.min(clocks.into()), inside.1.max(clocks.into()));
            }
            None => unseen += 1,
        }
    }
    counts.say(board, "frames_without_sync", unseen, Some((0, 0)));
    counts.say(board, "clocks_before_sync_at_most", before, Some((0, 0)));
    counts.say(board, "clocks_in_sync_at_least", inside.0, Some((FRAME_CLOCKS, FRAME_CLOCKS)));
    counts.say(board, "clocks_in_sync_at_most", inside.1, Some((FRAME_CLOCKS, FRAME_CLOCKS)));
    counts.say(board, "clocks_after_sync_at_most", after, Some((0, 0)));
    measure_latch(board, ["latch_earliest_cycles", "latch_spread_cycles"], counts, refuse_inputs)
}

/// Measures when frames are latched; `meanwhile` is called between frames.
fn measure_latch<B: LoopedBoard>(
    board: &mut B,
    [earliest, spread]: [&str; 2],
    counts: &mut Counts,
    mut meanwhile: impl FnMut(&mut B) -> Result<(), Stop>,
) -> Result<(), Stop> {
    let mut latched = (u32::MAX, 0);
    for _ in 0..FRAMES {
        meanwhile(board)?;
        if let Some(cycles) = board.latch_cycles() {
            latched = (latched.0.min(cycles), latched.1.max(cycles));
        }
    }
    let expected = (B::LATCH_CYCLES - CAPTURE_CYCLES, B::LATCH_CYCLES + CAPTURE_CYCLES);
    counts.say(board, earliest, latched.0, Some(expected));
    counts.say(board, spread, latched.1.saturating_sub(latched.0), Some((0, JITTER_CYCLES)));
    Ok(())
}

fn measure_adc<B: LoopedBoard>(board: &mut B, counts: &mut Counts) {
    for (driven_mv, name) in LOOP_MV {
        let found_mv = board.loop_mv(driven_mv);
        counts.say(board, name, found_mv, Some((driven_mv - LOOP_TOLERANCE_MV, driven_mv + LOOP_TOLERANCE_MV)));
    }
    // The monitor of an amplifier at 0 V, read by the tick from now on.
    board.loop_mv(B::MONITOR_ZERO_MV);
}

/// Counts the cycles of ticks under the largest scene.
fn measure_ticks<B: LoopedBoard>(board: &mut B, load: &mut Load, counts: &mut Counts) -> Result<(), Stop> {
    let ticks = board.board().ticks(COUNTED_S);
    board.say(format_args!("2. The tick, under the largest scene that this board accepts."));
    while !load.round(board)? {}
    counting(board, load, ["alone", "ticks_late_alone", "tick_longest_cycles_alone"], counts, |board, load| {
        let from_tick = load.now_tick();
        while load.now_tick().wrapping_sub(from_tick) < ticks {
            load.round(board)?;
        }
        Ok(())
    })?;
    let longest = board.tick_times().worst_cycles;
    let wait_percent = longest.saturating_mul(100).div_ceil(load.core_cycles().max(1));
    counts.say(board, "tick_estimated_core_cycles", load.core_cycles(), None);
    counts.say(board, "flash_wait_percent", wait_percent, Some((50, frixel_layers::cost::FLASH_WAIT_PERCENT)));
    let names = ["latch_earliest_cycles_under_ticks", "latch_spread_cycles_under_ticks"];
    measure_latch(board, names, counts, |board| load.round(board).map(drop))
}

/// Prints the counts of ticks while `work` ran: their histogram, the late ones, and the longest so far.
fn counting<B: LoopedBoard>(
    board: &mut B,
    load: &mut Load,
    [histogram, late, longest]: [&str; 3],
    counts: &mut Counts,
    work: impl FnOnce(&mut B, &mut Load) -> Result<(), Stop>,
) -> Result<(), Stop> {
    let before = board.tick_times();
    let worked = work(board, load);
    let counted = counted_since(&before, &board.tick_times());
    board.say(format_args!("{}", ScriptLine::Histogram(histogram, counted.histogram)));
    counts.say(board, late, counted.missed_deadlines, Some((0, 0)));
    counts.say(board, longest, counted.worst_cycles, Some((1, counted.deadline_cycles)));
    worked
}

/// Receives and sends at the full rate of the line while the largest scene plays.
fn measure_line<B: LoopedBoard>(board: &mut B, load: &mut Load, counts: &mut Counts) -> Result<(), Stop> {
    load.rest(board)?;
    let wants_it = loop {
        board.say(format_args!(
            "3. The line, tested by `frixel board selftest --wires`; without it, skip. Then type: {LINE_TEST} or {SKIP}"
        ));
        match board.read_line().trim() {
            LINE_TEST => break true,
            SKIP => break false,
            _ => {}
        }
    };
    if !wants_it {
        return Ok(());
    }
    let mut test = LineTest::new();
    counting(board, load, ["line", "ticks_late_line", "tick_longest_cycles_line"], counts, |board, load| {
        exchange_blocks(board, load, &mut test)
    })?;
    counts.say(board, "line_blocks_received", test.received(), Some((1, u32::MAX)));
    counts.say(board, "line_blocks_missing", test.missing(), Some((0, 0)));
    counts.say(board, "line_pieces_damaged", test.damaged(), Some((0, 0)));
    Ok(())
}

/// Exchanges blocks until the host is silent, and then waits for a line, which signals that the host reads text again.
fn exchange_blocks<B: LoopedBoard>(board: &mut B, load: &mut Load, test: &mut LineTest) -> Result<(), Stop> {
    let (first_byte_ticks, last_byte_ticks) = (board.board().ticks(FIRST_BYTE_S), board.board().ticks(LAST_BYTE_S));
    load.round(board)?;
    let mut received_at_tick = load.now_tick();
    loop {
        load.round(board)?;
        let mut bytes = [0; CHUNK_LEN];
        let len = board.read(&mut bytes);
        test.take(bytes.get(..len).unwrap_or_default());
        if len > 0 {
            received_at_tick = load.now_tick();
        }
        let patience_ticks = if test.received() > 0 { last_byte_ticks } else { first_byte_ticks };
        if load.now_tick().wrapping_sub(received_at_tick) > patience_ticks {
            break;
        }
        let taken = board.write(test.pending());
        test.advance(taken);
    }
    load.rest(board)?;
    board.read_line();
    Ok(())
}
