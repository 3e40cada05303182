//! The image of the Pico board on an emulated RP2040, wired to its chips and its world.

mod board_rig;
mod frame;
mod injection;
mod orders;
mod process;
mod protocol;

use std::collections::VecDeque;
use std::time::Duration;

use embedded_hal::delay::DelayNs;
use frixel_control::{Board, Drive};
use frixel_drivers::rp2::LIMITS_OFFSET;
use frixel_session::Touch;
use frixel_session::store::{CeilingPolicy, first_copy, write_limits};
use frixel_wire::dac_code::DacCode;
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::{Command, Request as HostRequest};
use frixel_wire::payload;

use super::{EmulatorError, Image};
use crate::chips::Ad5761rChip;
use crate::{BoardView, RigTick, World};
pub use board_rig::PicoBoardRig;
pub use frame::TouchFrame;
pub use orders::{AppliedOrder, Watched};
use process::Process;
use protocol::{ARM, Ended, READY, Ran, Request};
pub use protocol::{Stamped, StartCause, WireEvent};

/// Sequence number of the touch source's requests, for which no host awaits an answer.
const TOUCH_SEQUENCE: u16 = 0;
/// Time from power-on until the person presses and holds the arm switch.
const PRESSED_AT: Duration = Duration::from_millis(10);
/// Largest distance of a frame from a tick boundary that marks it, as a fraction of the period. Frames sent by the
/// driver between ticks are ignored.
const BOUNDARY_TOLERANCE: f64 = 0.2;
/// ADC codes per volt at the amplifier's output: 1.5 V at the pin for 200 V, of 3.3 V in 4,096 codes, around the middle
/// (`docs/board/hardware.md`).
const MONITOR_CODES_PER_V: f64 = 1.5 / 200.0 / 3.3 * 4096.0;
const MONITOR_ZERO_CODE: f64 = 2048.0;
/// DAC codes per volt: 10 V is full scale.
const DAC_CODES_PER_V: f64 = 32_768.0 / 10.0;

/// Inputs broken by a test.
#[derive(Clone, Copy, Debug, Default)]
pub struct BrokenInputs {
    /// Level of the amplifier's ready line, regardless of the amplifier.
    pub ready: Option<bool>,
    /// Level of the arm switch, regardless of the person.
    pub arm_switch: Option<bool>,
    /// Monitor voltage, regardless of the amplifier's output.
    pub monitor_v: Option<f64>,
}

/// A Pico with DAC, amplifier, screen, finger and touch source, and the host's end of its serial line.
///
/// Time is virtual and passes only in [`Self::step`], so it waits for a host on a busy machine. The world advances by
/// one tick with each frame that the board sends at its beat, and at the same rate without frames. The board receives
/// touch reports from its host, which [takes](Self::take_touch_frames) them from the touch source and sends them
/// between its own frames. An image with an optical frame receives them from [`Self::attach_frame`].
#[derive(Debug)]
pub struct PicoRig {
    process: Process,
    dac: Ad5761rChip,
    world: World,
    /// The touch frame; without one, the host sends the reports.
    frame: Option<TouchFrame>,
    /// Inputs that do not follow the world.
    pub broken: BrokenInputs,
    tick_period: Duration,
    now: Duration,
    /// Time at which the current tick ends.
    tick_ends_at: Duration,
    /// Time at which the last frame ended.
    frame_ended_at: Option<Duration>,
    amplifier_enable: bool,
    /// Time since which the amplifier has been disabled and the DAC's output zero.
    zero_since: Option<Duration>,
    to_board: VecDeque<u8>,
    /// Frames of the touch source for the host to send.
    touch_frames: Vec<u8>,
    at_host: Vec<u8>,
    events: Option<Vec<Stamped>>,
    /// The bytes sent to the board since its orders are watched.
    watched_bytes: Option<Vec<u8>>,
    starts: u32,
    instructions: u64,
}

impl PicoRig {
    /// Switches on a board with the stored limits of [`Board::PICO`], in a world whose finger is up and whose tick rate
    /// is the board's.
    pub fn start(image: &Image, world: World) -> Result<Self, EmulatorError> {
        let mut rig = Self::factory_new(image, world)?;
        let limits = write_limits(&Board::PICO.limits, CeilingPolicy::InForce)
            .map_err(|error| EmulatorError::ended(format!("`Board::PICO` has no valid limits: {error}")))?;
        // One byte per word.
        let words = [&[LIMITS_OFFSET][..], &first_copy(&limits).map(u32::from)].concat();
        rig.process.request(Request::WriteFlash, &words)?;
        Ok(rig)
    }

    /// Switches on a board without stored limits, which uses its built-in ones.
    pub fn factory_new(image: &Image, world: World) -> Result<Self, EmulatorError> {
        let tick_period = Duration::from_secs_f64(1.0 / f64::from(world.tick_hz()));
        Ok(Self {
            process: Process::start(image)?,
            dac: Ad5761rChip::new(),
            world,
            frame: None,
            broken: BrokenInputs::default(),
            tick_period,
            now: Duration::ZERO,
            tick_ends_at: tick_period,
            frame_ended_at: None,
            amplifier_enable: false,
            zero_since: Some(Duration::ZERO),
            to_board: VecDeque::new(),
            touch_frames: Vec::new(),
            at_host: Vec::new(),
            events: None,
            watched_bytes: None,
            starts: 0,
            instructions: 0,
        })
    }

    /// Virtual time since the board was first switched on.
    pub fn now(&self) -> Duration {
        self.now
    }

    /// The world.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world, to inject faults and to move the finger.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The DAC, to break it.
    pub fn dac(&self) -> &Ad5761rChip {
        &self.dac
    }

    /// Number of firmware starts.
    pub fn starts(&self) -> u32 {
        self.starts
    }

    /// Number of executed instructions since the board was first switched on.
    pub fn instructions(&self) -> u64 {
        self.instructions
    }

    /// The board's output now.
    pub fn output(&self) -> Drive {
        let code = (self.dac.output_v() * DAC_CODES_PER_V).round();
        Drive { dac_code: DacCode::from_bits(code as i16), amplifier_enable: self.amplifier_enable }
    }

    /// Time since which the amplifier has been disabled and the DAC's output zero; `None` otherwise.
    pub fn zero_since(&self) -> Option<Duration> {
        self.zero_since
    }

    /// Records events on the wires from now on.
    pub fn record_events(&mut self) {
        self.events = Some(Vec::new());
    }

    /// The events since the last call.
    pub fn take_events(&mut self) -> Vec<Stamped> {
        self.events.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Returns the touch source's frames since the last call. The host must [send](Self::send) them after every step.
    pub fn take_touch_frames(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.touch_frames)
    }

    /// Whether the touch source has frames to send.
    pub(crate) fn has_touch_frames(&self) -> bool {
        !self.touch_frames.is_empty()
    }

    /// Sends whole frames from the host, so that frames of the touch source fit between them.
    pub fn send(&mut self, bytes: &[u8]) {
        self.to_board.extend(bytes);
    }

    /// Appends the bytes that have arrived at the host to `bytes`.
    pub fn receive(&mut self, bytes: &mut Vec<u8>) {
        bytes.append(&mut self.at_host);
    }

    /// Whether any bytes have arrived at the host.
    pub fn has_received(&self) -> bool {
        !self.at_host.is_empty()
    }

    /// Advances one tick.
    pub fn step(&mut self) -> Result<RigTick, EmulatorError> {
        let tolerance = self.tick_period.mul_f64(BOUNDARY_TOLERANCE);
        loop {
            let frame_before = self.frame_ended_at;
            let ran = self.run((self.tick_ends_at + tolerance).saturating_sub(self.now), 0)?;
            let is_due = self.now + tolerance >= self.tick_ends_at;
            // The board's beat may start anywhere in the world's tick, which follows it from the second frame on.
            let is_beat =
                frame_before.is_some_and(|at| self.now.saturating_sub(at).abs_diff(self.tick_period) <= tolerance);
            let (boundary, earlier) = match (ran.ended, ran.events.split_last()) {
                (Ended::Frame, Some((frame, earlier))) if is_due || is_beat => (Some(*frame), earlier),
                _ => (None, &ran.events[..]),
            };
            self.follow(earlier);
            if let Some(frame) = boundary {
                self.tick_ends_at = self.now + self.tick_period;
                let record = self.advance_world();
                self.follow(&[frame]);
                return Ok(record);
            }
            if ran.ended == Ended::Time {
                self.tick_ends_at += self.tick_period;
                return Ok(self.advance_world());
            }
        }
    }

    /// Runs a number of instructions, or until the next frame ends. Returns whether all of them were executed.
    pub fn run_instructions(&mut self, count: u32) -> Result<bool, EmulatorError> {
        let ran = self.run(self.tick_period, count)?;
        self.follow(&ran.events);
        Ok(ran.ended == Ended::Instructions)
    }

    /// Runs for a time, or until a frame of the DAC ends or the touch frame is addressed.
    fn run_to_question(&mut self, time: Duration, instructions_max: u32) -> Result<Ran, EmulatorError> {
        let sense = self.world.sense();
        // The board has just latched its last code, and reads the monitor before this code has changed it.
        let monitor_v = self.broken.monitor_v.unwrap_or_else(|| self.world.monitor_now_v());
        let monitor_code = (MONITOR_ZERO_CODE + monitor_v * MONITOR_CODES_PER_V).round().clamp(0.0, 4095.0);
        let is_held = self.broken.arm_switch.unwrap_or(sense.arm_switch && self.now >= PRESSED_AT);
        let mut inputs = 0;
        if self.broken.ready.unwrap_or(!sense.amplifier_fault) {
            inputs |= READY;
        }
        if is_held {
            inputs |= ARM;
        }
        inputs |= self.frame.as_ref().map_or(0, TouchFrame::inputs);
        let head = [time.as_nanos() as u32, instructions_max, inputs, monitor_code as u32, self.dac.shifting_out()];
        if let Some(watched) = &mut self.watched_bytes {
            watched.extend(&self.to_board);
        }
        let words: Vec<u32> = head.into_iter().chain(self.to_board.drain(..).map(u32::from)).collect();
        let words = self.process.request(Request::Run, &words)?;
        let mut ran = Ran::read(&words).ok_or_else(|| no_answer("to run"))?;
        for stamped in &mut ran.events {
            stamped.at += self.now;
        }
        self.now += ran.elapsed;
        if ran.ended == Ended::Frame {
            self.frame_ended_at = Some(self.now);
        }
        self.instructions += u64::from(ran.instructions);
        self.at_host.append(&mut ran.received);
        Ok(ran)
    }

    /// Advances the world by one tick with the current output.
    fn advance_world(&mut self) -> RigTick {
        let drive = self.output();
        let felt = self.world.apply(drive);
        if let Some(touch) = self.world.touch() {
            self.report(touch);
        }
        RigTick { tick: self.world.tick(), drive, felt, status: BoardView::None }
    }

    /// Passes a touch report to the touch frame, or to the host.
    fn report(&mut self, touch: Touch) {
        if let Some(frame) = &mut self.frame {
            return frame.report(touch);
        }
        let command = match touch {
            Touch::Down { x_m, y_m, age_ticks } => Command::Touch { x_m, y_m, age_ticks: age_ticks as u16 },
            Touch::Up => Command::Lift,
        };
        let mut buffer = [0; FRAME_MAX_LEN];
        if let Ok(frame) = payload::request_frame(&HostRequest { sequence: TOUCH_SEQUENCE, command }, &mut buffer) {
            self.touch_frames.extend(frame);
        }
    }

    /// Applies events to the chips.
    fn follow(&mut self, events: &[Stamped]) {
        for stamped in events {
            let behind = stamped.at.saturating_sub(Duration::from_nanos(self.dac.now_ns()));
            self.dac.delay_ns(behind.as_nanos() as u32);
            self.act(stamped.event);
            let is_zero = !self.amplifier_enable && self.output().dac_code.bits() == 0;
            self.zero_since = is_zero.then(|| self.zero_since.unwrap_or(stamped.at));
            if let Some(events) = &mut self.events {
                events.push(*stamped);
            }
        }
    }

    fn act(&mut self, event: WireEvent) {
        match event {
            WireEvent::Frame { bits, clocks, .. } => {
                self.dac.set_sync(false);
                for place in (0..clocks.min(32)).rev() {
                    self.dac.clock(bits >> place & 1 != 0);
                }
                self.dac.set_sync(true);
            }
            WireEvent::Enable(high) => self.amplifier_enable = high,
            WireEvent::Clear(high) => self.dac.set_clear(high),
            WireEvent::Start(_) => {
                // Resistors pull enable and CLEAR down.
                self.amplifier_enable = false;
                self.dac.set_clear(false);
                self.starts += 1;
            }
            _ => {}
        }
    }
}

fn no_answer(what: &str) -> EmulatorError {
    EmulatorError::ended(format!("its answer to a request {what} is invalid"))
}
