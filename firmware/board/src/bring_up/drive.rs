//! A square wave of a voltage, driven through the firmware: a host on the board plays a scene to session and ticker.

use core::fmt;

use frixel_control::Status;
use frixel_session::{Session, Touch};
use frixel_wire::fault::{Fault, State};
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::{Command, Request};
use frixel_wire::payload;

use super::scene::{CARRIER_HZ, HOST_TIMEOUT_S, read_at, stored_scene};

/// Seconds that the output is driven: time to read a voltage from an oscilloscope that was set up before.
const DRIVEN_S: f32 = 3.0;
/// Seconds until the voltage is measured. The envelope has then reached the voltage, at 1,000 V/s, up to 400 V.
const SETTLING_S: f32 = 0.5;
/// Part of a half period, counted from the tick of its edge, in which the monitor is read: 1.2 to 3.2 ms of 4 ms. The
/// edges are tens of microseconds long, and the main loop sees them a few ticks late.
const READ_FROM: f32 = 0.3;
const READ_UNTIL: f32 = 0.8;
/// Seconds to arm, and to disarm.
const ANSWER_S: f32 = 0.5;
/// Seconds after the end until the monitor is read once more, and for which it is read. The output must be zero 1 ms
/// after the end.
const REST_S: f32 = 0.05;
/// Seconds between two pings: a fifth of the host timeout.
const PING_S: f32 = HOST_TIMEOUT_S / 5.0;
/// The finger moves along x, because the output is zero at standstill (below 2 mm/s).
const FINGER_SPEED_M_PER_S: f32 = 0.02;
const FINGER_Y_M: f32 = 0.05;

/// The driven voltage, and the voltage that the amplifier's monitor showed meanwhile, in V.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Driven peak, from the DAC code and the board's full scale.
    pub driven_v_peak: f32,
    /// The monitor in the positive half periods, mean.
    pub high_v: f32,
    /// The monitor in the negative half periods, mean.
    pub low_v: f32,
    /// The monitor after the end, mean.
    pub rest_v: f32,
}

/// Why the output was not driven to the end. It is zero, and the board is disarmed or faulted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DriveError {
    /// The session has refused the scene: it is beyond the board's limits.
    Refused,
    /// The board was not armed, or not disarmed, in time; it was in this state.
    State(State),
    /// The supervisor has latched a fault.
    Fault(Fault, u32),
    /// The monitor was not read in both half periods.
    NoReading,
}

impl fmt::Display for DriveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused => f.write_str("the firmware refuses this voltage: it is beyond the limits of this build"),
            Self::State(state) => write!(f, "the board did not do what it was told, and is {state}"),
            Self::Fault(fault, detail) => write!(f, "{fault} (detail {detail})"),
            Self::NoReading => f.write_str("the monitor was not read: the main loop is too slow"),
        }
    }
}

/// The host on the board, which plays one voltage for three seconds and disarms the board again. The board's main loop
/// calls [`Drive::step`] in every round, beside the session and with the tick running.
#[derive(Debug)]
pub struct Drive {
    peak_v: f32,
    timing: Timing,
    volts_per_code: f32,
    phase: Phase,
    /// Tick at which the phase has begun.
    since_tick: u32,
    pinged_at_tick: u32,
    touched_at_tick: u32,
    sequence: u16,
    half_period: HalfPeriod,
    high: Mean,
    low: Mean,
    rest: Mean,
    driven: Mean,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Loading,
    Arming,
    Starting,
    Driving,
    Disarming,
    Resting,
}

/// The half period of the carrier that the main loop has seen last.
#[derive(Clone, Copy, Debug, Default)]
struct HalfPeriod {
    positive: bool,
    since_tick: u32,
}

/// Ticks in the times above.
#[derive(Clone, Copy, Debug)]
struct Timing {
    tick_hz: f32,
    half_period_ticks: f32,
    touch_period_ticks: u32,
}

impl Timing {
    fn ticks(&self, time_s: f32) -> u32 {
        (time_s * self.tick_hz) as u32
    }
}

/// A running mean.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f32,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: f32) {
        self.sum += value;
        self.count += 1;
    }

    fn get(&self) -> Option<f32> {
        (self.count > 0).then(|| self.sum / self.count as f32)
    }
}

impl Drive {
    /// A host that will play a square wave of `peak_v` to a board that has been disarmed.
    pub fn new(peak_v: f32, board: &frixel_control::Board) -> Self {
        let tick_hz = board.tick_hz as f32;
        Self {
            peak_v,
            timing: Timing {
                tick_hz,
                half_period_ticks: 0.5 * tick_hz / CARRIER_HZ,
                touch_period_ticks: board.ticks(board.limits.touch_report_period_s),
            },
            volts_per_code: board.limits.full_scale_v_peak / f32::from(i16::MAX),
            phase: Phase::Loading,
            since_tick: 0,
            pinged_at_tick: 0,
            touched_at_tick: 0,
            sequence: 0,
            half_period: HalfPeriod::default(),
            high: Mean::default(),
            low: Mean::default(),
            rest: Mean::default(),
            driven: Mean::default(),
        }
    }

    /// One round: looks at the last status, the tick count and the monitor as they are now, and tells the session what
    /// a host would. The caller discards what the session sends, so that it goes on listening. Returns the result once
    /// the output is zero again.
    pub fn step(
        &mut self,
        status: &Status,
        now_tick: u32,
        monitor_v: f32,
        session: &mut Session<'_>,
    ) -> Option<Result<Reading, DriveError>> {
        let state = status.telemetry.state;
        if state == State::Faulted {
            let (fault, detail) = status.fault.unwrap_or((Fault::Other(0), 0));
            return Some(Err(DriveError::Fault(fault, detail)));
        }
        let ticks = now_tick.wrapping_sub(self.since_tick);
        let is_late = ticks > self.timing.ticks(ANSWER_S);
        match self.phase {
            Phase::Loading => {
                let scene = stored_scene(self.peak_v);
                let read = |offset: u32, bytes: &mut [u8]| read_at(&scene, offset, bytes);
                if !session.restore(read) {
                    return Some(Err(DriveError::Refused));
                }
                self.send(Command::Arm, session, status);
                self.enter(Phase::Arming, now_tick);
            }
            Phase::Arming if state == State::Armed => {
                self.send(Command::Play, session, status);
                self.enter(Phase::Starting, now_tick);
            }
            Phase::Starting if state == State::Active => {
                self.touch(now_tick, session);
                self.enter(Phase::Driving, now_tick);
            }
            Phase::Driving if state != State::Active => return Some(Err(DriveError::State(state))),
            Phase::Driving if ticks >= self.timing.ticks(DRIVEN_S) => {
                session.touch(Touch::Up, now_tick);
                self.send(Command::Disarm, session, status);
                self.enter(Phase::Disarming, now_tick);
            }
            Phase::Driving => {
                self.keep_alive(now_tick, session, status);
                if ticks >= self.timing.ticks(SETTLING_S) {
                    self.measure(status, now_tick, monitor_v);
                }
            }
            Phase::Disarming if state == State::Disarmed => self.enter(Phase::Resting, now_tick),
            Phase::Resting if ticks >= 2 * self.timing.ticks(REST_S) => return Some(self.reading()),
            Phase::Resting => {
                if ticks >= self.timing.ticks(REST_S) {
                    self.rest.add(monitor_v);
                }
            }
            Phase::Arming | Phase::Starting | Phase::Disarming if is_late => {
                self.send(Command::Disarm, session, status);
                return Some(Err(DriveError::State(state)));
            }
            Phase::Arming | Phase::Starting | Phase::Disarming => {}
        }
        None
    }

    fn enter(&mut self, phase: Phase, now_tick: u32) {
        self.phase = phase;
        self.since_tick = now_tick;
    }

    fn send(&mut self, command: Command, session: &mut Session<'_>, status: &Status) {
        self.sequence = self.sequence.wrapping_add(1);
        let mut frame = [0; FRAME_MAX_LEN];
        if let Ok(frame) = payload::request_frame(&Request { sequence: self.sequence, command }, &mut frame) {
            session.receive(frame, status);
        }
    }

    /// Pings, and moves the finger.
    fn keep_alive(&mut self, now_tick: u32, session: &mut Session<'_>, status: &Status) {
        if now_tick.wrapping_sub(self.pinged_at_tick) >= self.timing.ticks(PING_S) {
            self.pinged_at_tick = now_tick;
            self.send(Command::Ping, session, status);
        }
        if now_tick.wrapping_sub(self.touched_at_tick) >= self.timing.touch_period_ticks {
            self.touch(now_tick, session);
        }
    }

    fn touch(&mut self, now_tick: u32, session: &mut Session<'_>) {
        self.touched_at_tick = now_tick;
        let driven_s = match self.phase {
            Phase::Driving => now_tick.wrapping_sub(self.since_tick) as f32 / self.timing.tick_hz,
            _ => 0.0,
        };
        session.touch(Touch::Down { x_m: FINGER_SPEED_M_PER_S * driven_s, y_m: FINGER_Y_M, age_ticks: 0 }, now_tick);
    }

    /// Takes the monitor's voltage if the half period has settled.
    fn measure(&mut self, status: &Status, now_tick: u32, monitor_v: f32) {
        let code = status.telemetry.dac_code;
        let positive = code > 0;
        if positive != self.half_period.positive {
            self.half_period = HalfPeriod { positive, since_tick: status.telemetry.tick };
            return;
        }
        let elapsed = now_tick.wrapping_sub(self.half_period.since_tick) as f32 / self.timing.half_period_ticks;
        if (READ_FROM..READ_UNTIL).contains(&elapsed) {
            self.driven.add(f32::from(code).abs() * self.volts_per_code);
            if positive { self.high.add(monitor_v) } else { self.low.add(monitor_v) }
        }
    }

    fn reading(&self) -> Result<Reading, DriveError> {
        match (self.driven.get(), self.high.get(), self.low.get(), self.rest.get()) {
            (Some(driven_v_peak), Some(high_v), Some(low_v), Some(rest_v)) => {
                Ok(Reading { driven_v_peak, high_v, low_v, rest_v })
            }
            _ => Err(DriveError::NoReading),
        }
    }
}
