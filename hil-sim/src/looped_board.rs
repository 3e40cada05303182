//! A simulated board with the self-test's wires and at most one defect, which [`frixel_board::self_test`] must find.
//! Its session, ticker and supervisor are the firmware's own.

mod defect;
mod one_shot;
#[cfg(unix)]
#[allow(clippy::disallowed_types, clippy::disallowed_methods, reason = "a terminal of another process, in real time")]
mod terminal_port;

use core::fmt::{Arguments, Write};

use frixel_board::self_test::{
    Clocks, Fall, Inputs, Levels, Line, LineReader, LoopedBoard, Round, Stop, Typed, UNPLUGGED, Wire,
};
use frixel_control::{Active, Board, Sense, Status, TickMeter, Ticker};
use frixel_layers::BitmapPool;
use frixel_session::{NextScene, Session};
use frixel_wire::fault::{Fault, State};
use frixel_wire::message::TickTimes;

pub use defect::Defect;
use defect::Progress;
use one_shot::OneShot;
#[cfg(unix)]
pub use terminal_port::TerminalPort;

/// Ticks of a round of the main loop.
const ROUND_TICKS: u32 = 4;
/// Cycles of a tick at rest, and under the largest scene.
const IDLE_CYCLES: u32 = 1_000;
const LOADED_CYCLES: u32 = 2_300;
/// The same on a board with slower flash than assumed, and the deadline of its ticks.
const SLOW_CYCLES: u32 = 2_900;
const DEADLINE_CYCLES: u32 = 3_700;

/// The other end of the board's serial line.
pub trait Port {
    /// Takes bytes for the board, and returns their number; 0 if there are none.
    fn read(&mut self, bytes: &mut [u8]) -> usize;

    /// Takes bytes from the board, and returns the number taken.
    fn write(&mut self, bytes: &[u8]) -> usize;

    /// Called when `ticks` have passed on the board; waits if there is a real-time clock.
    fn pace(&mut self, ticks: u32);

    /// Called when the board waits for a byte. Returns `false` at the end of the line's bytes.
    fn wait(&mut self) -> bool;

    /// Called when the board has sent everything and stays on; returns once there are no readers.
    fn end(&mut self);
}

/// The board, at power-on.
#[allow(clippy::struct_excessive_bools, reason = "what has happened, each apart from the others")]
pub struct LoopedRig<P> {
    port: P,
    reader: LineReader,
    wrong: Defect,
    session: Session<'static>,
    ticker: Ticker<'static>,
    status: Status,
    meter: TickMeter,
    /// Number of bytes received by the board, for a line that loses some.
    received: usize,
    latch_moved: bool,
    one_shot: OneShot,
    monitor_mv: u32,
    enable_was_found_low: bool,
    said_unplugged: bool,
    ticks_run: bool,
}

impl<P: Port> LoopedRig<P> {
    /// A board with one defect, or [`Defect::Nothing`].
    pub fn new(port: P, wrong: Defect) -> Self {
        let pool: &BitmapPool = Box::leak(Box::new(BitmapPool::new()));
        let (playing, next) = (Box::leak(Box::new(Active::new())), Box::leak(Box::new(NextScene::new())));
        let ticker = Ticker::new(&Board::NUCLEO_G474RE, pool, playing);
        Self {
            port,
            reader: LineReader::default(),
            wrong,
            session: Session::new(Board::NUCLEO_G474RE, pool, next),
            status: ticker.status(),
            ticker,
            meter: TickMeter::new(DEADLINE_CYCLES),
            received: 0,
            latch_moved: false,
            one_shot: OneShot::default(),
            monitor_mv: 0,
            enable_was_found_low: false,
            said_unplugged: false,
            ticks_run: false,
        }
    }

    /// Runs the self-test to its end.
    pub fn run(&mut self) -> Result<u32, Stop> {
        let result = frixel_board::self_test::run(self);
        // Timers that the script has left running continue.
        (0..10 * one_shot::ONE_SHOT_US * one_shot::CYCLES_PER_US).for_each(|_| _ = self.cycles());
        self.port.end();
        result
    }

    /// The other end of its line.
    pub fn port(&self) -> &P {
        &self.port
    }

    fn is(&self, wrong: Defect) -> bool {
        self.wrong == wrong
    }

    /// Microseconds for which the enable was high while ready was high or the arm switch closed.
    pub fn forbidden_enable_us(&self) -> u32 {
        self.one_shot.forbidden_enable_us()
    }

    fn progress(&self) -> Progress {
        if self.ticks_run {
            Progress::Ticks
        } else if self.one_shot.is_high_again() {
            Progress::EnabledAgain
        } else if self.one_shot.amplifier_has_turned_on() {
            Progress::Enabled
        } else if self.enable_was_found_low {
            Progress::Wired
        } else {
            Progress::Begun
        }
    }

    /// A kick may switch on an amplifier, so it is allowed only on a board without any sign of one.
    fn check_kick(&self) {
        assert!(self.said_unplugged, "a kick before the person has unplugged the amplifier");
        assert!(self.enable_was_found_low, "a kick before the wire was found with the enable low");
        assert_eq!(self.wrong.inputs(self.progress()), defect::LOW, "a kick");
        assert!(!self.ticks_run, "a kick under the tick");
    }

    fn write_all(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let len = self.port.write(bytes);
            bytes = &bytes[len..];
            if len == 0 && !self.port.wait() {
                return;
            }
        }
    }
}

impl<P: Port> LoopedBoard for LoopedRig<P> {
    const LATCH_CYCLES: u32 = 4_100;
    const ONE_SHOT_US: u32 = one_shot::ONE_SHOT_US;
    const CYCLES_PER_US: u32 = one_shot::CYCLES_PER_US;
    const MONITOR_ZERO_MV: u32 = 1_650;
    const MONITOR_MV_PER_V: f32 = 7.5;

    fn board(&self) -> &Board {
        &Board::NUCLEO_G474RE
    }

    fn say(&mut self, text: Arguments<'_>) {
        let mut line = String::new();
        // Writing to a string cannot fail.
        let _ = write!(line, "{text}\r\n");
        self.write_all(line.as_bytes());
    }

    fn read_line(&mut self) -> Line {
        let mut byte = [0];
        loop {
            if self.ticks_run {
                // The tick continues, with the switch released.
                self.round(false);
            }
            if self.port.read(&mut byte) == 0 {
                assert!(self.port.wait(), "nobody types");
                continue;
            }
            if let Typed::Ended(line) = self.reader.push(byte[0]) {
                self.said_unplugged |= line == UNPLUGGED;
                return line;
            }
        }
    }

    fn idle(&mut self) {}

    fn inputs(&mut self) -> Inputs {
        self.wrong.inputs(self.progress())
    }

    fn levels(&mut self, wire: Wire) -> Levels {
        self.enable_was_found_low |= wire == Wire::Enable && self.wrong.levels(wire) == Levels::LOW;
        self.wrong.levels(wire)
    }

    fn loop_mv(&mut self, driven_mv: u32) -> u32 {
        self.monitor_mv = match self.wrong {
            Defect::NoMonitorWire | Defect::AdcDead => 0,
            Defect::AdcFrozen => Self::MONITOR_ZERO_MV,
            Defect::MonitorNotZero => driven_mv + 100,
            _ => driven_mv + 7,
        };
        self.monitor_mv
    }

    fn exchange(&mut self, bytes: &mut [u8]) -> bool {
        if self.is(Defect::NoDataWire) {
            bytes.fill(0xff);
        }
        true
    }

    fn clocks(&mut self) -> Option<Clocks> {
        let whole = Clocks { before: 0, inside: 24, after: 0 };
        match self.wrong {
            Defect::Clocks23 => Some(Clocks { inside: 23, ..whole }),
            Defect::ClockAfterSync => Some(Clocks { inside: 23, after: 1, ..whole }),
            Defect::NoLatch => None,
            _ => Some(whole),
        }
    }

    fn latch_cycles(&mut self) -> Option<u32> {
        self.latch_moved = !self.latch_moved;
        match self.wrong {
            Defect::NoLatch => None,
            Defect::LatchLate => Some(Self::LATCH_CYCLES + 40),
            Defect::LatchMoves => Some(Self::LATCH_CYCLES + 6 * u32::from(self.latch_moved)),
            Defect::LatchMovesUnderTicks if self.ticks_run => {
                Some(Self::LATCH_CYCLES + 6 * u32::from(self.latch_moved))
            }
            _ => Some(Self::LATCH_CYCLES + 3),
        }
    }

    fn cycles(&mut self) -> u32 {
        let is_forbidden = self.inputs() != defect::LOW;
        self.one_shot.pass(is_forbidden)
    }

    fn forget_edges(&mut self) -> u32 {
        self.one_shot.forget_edges()
    }

    fn kick(&mut self) {
        self.check_kick();
        self.one_shot.kick(self.wrong);
    }

    fn disable(&mut self) {
        self.one_shot.disable(self.wrong);
    }

    fn enable_rose(&mut self) -> Option<u32> {
        self.one_shot.rose()
    }

    fn enable_fell(&mut self) -> Option<Fall> {
        self.one_shot.fell()
    }

    fn start_ticks(&mut self) {
        self.ticks_run = true;
    }

    fn round(&mut self, held: bool) -> Round<'_> {
        assert!(self.ticks_run, "the ticks have not been started");
        for _ in 0..ROUND_TICKS {
            self.session.hand_order_to(&mut self.ticker);
            let monitor_v = (self.monitor_mv as f32 - Self::MONITOR_ZERO_MV as f32) / Self::MONITOR_MV_PER_V;
            self.ticker.tick(&Sense { arm_switch: held, monitor_v, amplifier_fault: false });
            let is_loaded = self.ticker.state() == State::Active;
            let cycles = match self.wrong {
                _ if !is_loaded => IDLE_CYCLES,
                Defect::TicksSlow => SLOW_CYCLES,
                _ => LOADED_CYCLES,
            };
            self.meter.record(cycles);
            if is_loaded && self.is(Defect::TickLate) {
                self.ticker.raise(Fault::Deadline, DEADLINE_CYCLES + 1);
            }
        }
        self.port.pace(ROUND_TICKS);
        let before = core::mem::replace(&mut self.status, self.ticker.status());
        self.session.poll(&before);
        while self.session.transmit(&mut [0; 64]) > 0 {}
        Round { status: &self.status, now_tick: self.status.telemetry.tick, session: &mut self.session }
    }

    fn tick_times(&mut self) -> TickTimes {
        self.meter.times(self.ticker.status().counters.missed_deadlines)
    }

    fn read(&mut self, bytes: &mut [u8]) -> usize {
        let len = self.port.read(bytes);
        self.received += len;
        if self.is(Defect::LineLoses) && self.received > 5_000 && len > 1 {
            self.received = 0;
            // The last byte is lost.
            return len - 1;
        }
        len
    }

    fn write(&mut self, bytes: &[u8]) -> usize {
        self.port.write(bytes)
    }
}
