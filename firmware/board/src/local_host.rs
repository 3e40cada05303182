//! A host on the board, which plays a scene on session and ticker, for programs without a host at their port.

use core::fmt;

use frixel_control::Status;
use frixel_session::{Session, Touch};
use frixel_wire::fault::{Fault, State};
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::hello::notice;
use frixel_wire::message::{Command, Refusal, Request};
use frixel_wire::payload;

/// Host timeout of this host's scenes, s.
pub(crate) const HOST_TIMEOUT_S: f32 = 0.25;
/// Time limit for arming and disarming, s.
const ANSWER_S: f32 = 0.5;
/// Ping period, s: a fifth of the host timeout.
const PING_S: f32 = HOST_TIMEOUT_S / 5.0;
/// Speed of the finger along x, m/s. It moves because the output is zero at standstill (below 2 mm/s).
const FINGER_SPEED_M_PER_S: f32 = 0.02;
const FINGER_Y_M: f32 = 0.05;

/// Why a scene was not played to the end. The output is zero, and the board is disarmed or faulted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DriveError {
    /// The session has refused the scene.
    Refused(Refusal),
    /// The board was not armed, or not disarmed, in time; this is its state.
    State(State),
    /// The supervisor has latched a fault.
    Fault(Fault, u32),
    /// The monitor was not read in both half periods.
    NoReading,
}

impl fmt::Display for DriveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(refusal) => refusal.fmt(f),
            Self::State(state) => write!(f, "the board was not armed or disarmed in time, and is {state}"),
            Self::Fault(fault, detail) => write!(f, "{fault} (detail {detail})"),
            Self::NoReading => f.write_str("the monitor was not read: the main loop is too slow"),
        }
    }
}

/// Plays one scene for a time under a moving finger, and disarms the board again. The board's main loop calls
/// [`LocalHost::step`] in every round, together with the session and with the tick running.
#[derive(Debug)]
pub(crate) struct LocalHost {
    tick_hz: f32,
    touch_period_ticks: u32,
    play_ticks: u32,
    /// Whether the board refuses to arm.
    has_wrong_option_bytes: bool,
    phase: Phase,
    /// First tick of the phase.
    since_tick: u32,
    pinged_at_tick: u32,
    touched_at_tick: u32,
    sequence: u16,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Loading,
    Arming,
    Starting,
    Playing,
    Disarming,
}

/// Progress of a play.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Progress {
    /// The board is being armed, or disarmed.
    Waiting,
    /// The scene has played for this number of ticks.
    Playing(u32),
    /// The board is disarmed again.
    Done,
}

impl LocalHost {
    /// A host that plays for `play_s` on a disarmed board.
    pub(crate) fn new(play_s: f32, board: &frixel_control::Board) -> Self {
        let tick_hz = board.tick_hz as f32;
        Self {
            tick_hz,
            touch_period_ticks: board.ticks(board.limits.touch_report_period_s),
            play_ticks: (play_s * tick_hz) as u32,
            has_wrong_option_bytes: board.notices & notice::OPTION_BYTES != 0,
            phase: Phase::Loading,
            since_tick: 0,
            pinged_at_tick: 0,
            touched_at_tick: 0,
            sequence: 0,
        }
    }

    /// Ends the play at the next step.
    #[cfg(feature = "self-test")]
    pub(crate) fn stop(&mut self) {
        self.play_ticks = 0;
    }

    /// One round: sends the session a host's messages. The caller discards the session's output, so that the session
    /// keeps listening.
    pub(crate) fn step(
        &mut self,
        scene: &[u8],
        status: &Status,
        now_tick: u32,
        session: &mut Session<'_>,
    ) -> Result<Progress, DriveError> {
        let state = status.telemetry.state;
        if state == State::Faulted {
            let (fault, detail) = status.fault.unwrap_or((Fault::Other(0), 0));
            return Err(DriveError::Fault(fault, detail));
        }
        let ticks = now_tick.wrapping_sub(self.since_tick);
        let is_late = ticks > (ANSWER_S * self.tick_hz) as u32;
        match self.phase {
            Phase::Loading if self.has_wrong_option_bytes => return Err(DriveError::Refused(Refusal::OptionBytes)),
            Phase::Loading => {
                session.commit_own(scene).map_err(DriveError::Refused)?;
                self.send(Command::Arm, session, status);
                self.enter(Phase::Arming, now_tick);
            }
            Phase::Arming if state == State::Armed => {
                self.send(Command::Play, session, status);
                self.enter(Phase::Starting, now_tick);
            }
            Phase::Starting if state == State::Active => {
                self.touch(now_tick, session);
                self.enter(Phase::Playing, now_tick);
            }
            Phase::Playing if state != State::Active => return Err(DriveError::State(state)),
            Phase::Playing if ticks >= self.play_ticks => {
                session.touch(Touch::Up, now_tick);
                self.send(Command::Disarm, session, status);
                self.enter(Phase::Disarming, now_tick);
            }
            Phase::Playing => {
                self.keep_alive(now_tick, session, status);
                return Ok(Progress::Playing(ticks));
            }
            Phase::Disarming if state == State::Disarmed => return Ok(Progress::Done),
            Phase::Arming | Phase::Starting | Phase::Disarming if is_late => {
                self.send(Command::Disarm, session, status);
                return Err(DriveError::State(state));
            }
            Phase::Arming | Phase::Starting | Phase::Disarming => {}
        }
        Ok(Progress::Waiting)
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
        if now_tick.wrapping_sub(self.pinged_at_tick) >= (PING_S * self.tick_hz) as u32 {
            self.pinged_at_tick = now_tick;
            self.send(Command::Ping, session, status);
        }
        if now_tick.wrapping_sub(self.touched_at_tick) >= self.touch_period_ticks {
            self.touch(now_tick, session);
        }
    }

    fn touch(&mut self, now_tick: u32, session: &mut Session<'_>) {
        self.touched_at_tick = now_tick;
        let played_s = match self.phase {
            Phase::Playing => now_tick.wrapping_sub(self.since_tick) as f32 / self.tick_hz,
            _ => 0.0,
        };
        session.touch(Touch::Down { x_m: FINGER_SPEED_M_PER_S * played_s, y_m: FINGER_Y_M, age_ticks: 0 }, now_tick);
    }
}
