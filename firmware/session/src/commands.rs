//! The command handler: dispatches the host's frames to the four parts of the session, and answers them.
//!
//! The parts are independent. The command handler passes values between them; orders of [`Scenes`] go through the
//! [`Orders`](crate::states::Orders) of [`States`].

use frixel_control::{Board, Order, Status, TickMeter};
use frixel_layers::BitmapPool;
use frixel_wire::fault::{Flags, State};
use frixel_wire::hello::notice;
use frixel_wire::message::{Accepted, Command, FAULT_TEXT_MAX_LEN, FAULT_TEXT_PIECE_LEN, Refusal, Request, TickTimes};
use frixel_wire::payload::{ParseError, Payload};

use crate::hello::hello;
use crate::link::Link;
use crate::motion::{Motion, ONLY_FINGER};
use crate::scene::{NextScene, PROGRESS_PERIOD_S, Removal, Scenes};
use crate::states::States;

/// The command handler.
pub(crate) struct Commands<'a> {
    pub(crate) board: Board,
    pub(crate) link: Link,
    pub(crate) scenes: Scenes<'a>,
    pub(crate) motion: Motion,
    pub(crate) states: States<'a>,
    /// Durations of the ticks; `None` on a board that does not measure them.
    pub(crate) tick_meter: Option<&'a TickMeter>,
}

impl<'a> Commands<'a> {
    pub(crate) fn new(board: Board, pool: &'a BitmapPool, next: &'a mut NextScene) -> Self {
        Self {
            board,
            link: Link::new(board.limits.receive_window_bytes),
            scenes: Scenes::new(pool, next),
            motion: Motion::new(&board),
            states: States::new(),
            tick_meter: None,
        }
    }

    /// Processes one frame's payload.
    pub(crate) fn take(&mut self, payload: Result<Payload, ParseError>, status: &Status) {
        self.report_state(status);
        match payload {
            Ok(Payload::HelloRequest { .. }) => self.handle_hello(status),
            Ok(Payload::Request(request)) => {
                self.states.note_sign_of_life();
                self.take_request(request, status);
            }
            Ok(Payload::Chunk { number, bytes }) => {
                self.states.note_sign_of_life();
                if let Some(next_chunk) = self.scenes.take_chunk(number, bytes) {
                    self.link.report_progress(next_chunk);
                }
            }
            Ok(Payload::Samples { first_index, samples }) => {
                self.states.note_sign_of_life();
                // Samples after a `StartStream` that waits for a commit belong to a stream that has not begun.
                if cfg!(feature = "stream") && !self.link.has_waiting_stream() {
                    self.scenes.stream.take(first_index, samples);
                }
                self.report_stream(status);
            }
            // A request with an unknown command is still answered under its sequence number.
            Err(ParseError::UnknownCommand { sequence }) => {
                self.states.note_sign_of_life();
                self.link.answer(sequence, Err(Refusal::UnknownCommand), self.states.state());
            }
            // Ignore frames that only a board sends, and invalid frames.
            Ok(Payload::Hello(_) | Payload::FromBoard(_)) | Err(_) => {}
        }
    }

    /// Begins a session with a new client: resets the credit, drops an unfinished upload or commit, and disarms the
    /// board, since the previous client is gone.
    fn handle_hello(&mut self, status: &Status) {
        self.states.disarm_for_new_client();
        self.end_stream_unless_active();
        self.link.restart();
        self.scenes.drop_unfinished();
        self.motion.forget_fingers(status);
        // Ignore a full order queue: the stream then runs dry instead.
        let _ = self.scenes.end_stream(&mut self.states.orders);
        self.link.send_hello(&hello(&self.board, status, self.states.state(), &self.scenes));
    }

    /// Executes a request, or keeps it until the current commit ends. Stop and Disarm never wait, and refuse waiting
    /// requests: an earlier Arm or Play must not take effect after them.
    fn take_request(&mut self, request: Request, status: &Status) {
        if matches!(request.command, Command::Stop | Command::Disarm) {
            self.link.refuse_waiting(self.states.state());
        }
        let must_keep_order = self.scenes.is_committing() || self.link.has_waiting();
        if !must_keep_order || may_overtake_a_commit(request.command) {
            self.carry_out(request, status);
        } else {
            self.link.wait(request, self.states.state());
        }
    }

    /// Executes a request and answers it, or begins a commit.
    fn carry_out(&mut self, Request { sequence, command }: Request, status: &Status) {
        if let Command::Commit { crc32 } = command {
            self.link.commit_begins(sequence);
            self.scenes.begin_commit(crc32);
        } else {
            let outcome = self.dispatch(command, status);
            self.end_stream_unless_active();
            self.link.answer(sequence, outcome, self.states.state());
        }
    }

    fn dispatch(&mut self, command: Command, status: &Status) -> Result<Accepted, Refusal> {
        let Self { board, link, scenes, motion, states, .. } = self;
        match command {
            Command::Ping => Ok(Accepted::Done),
            Command::UploadScene { len, crc32 } => scenes.begin_scene(len, crc32, board),
            Command::UploadBitmap { width, height, crc32 } if cfg!(feature = "bitmap") => {
                let removal = match states.state() {
                    State::Active => Removal::Plays,
                    _ if states.is_settled(status) => Removal::Allowed,
                    _ => Removal::Unsettled,
                };
                scenes.begin_bitmap(width, height, crc32, board, removal, &mut states.orders)
            }
            Command::UploadBitmap { width, height, .. } => {
                Err(Refusal::BitmapPoolFull { len: u32::from(width) * u32::from(height), free: 0 })
            }
            Command::UploadEnd => scenes.end_upload(),
            // Handled by `carry_out`.
            Command::Commit { .. } => Err(Refusal::Busy),
            Command::Subscribe { period_ticks } if cfg!(feature = "telemetry") => {
                link.subscribe(period_ticks, board.tick_hz)
            }
            Command::Touch { .. } | Command::Lift | Command::TouchFinger { .. } | Command::LiftFinger { .. }
                if !board.touch_from_host =>
            {
                Err(Refusal::TouchSource)
            }
            Command::Touch { x_m, y_m, age_ticks } => {
                motion.touch(ONLY_FINGER, (x_m, y_m), age_ticks, scenes.leader(), status)
            }
            Command::Lift => Ok(motion.lift(ONLY_FINGER, scenes.leader(), status)),
            Command::FaultText { offset } => Ok(fault_text(board.reset_text, offset)),
            Command::SetLayer { layer, on, gain } => {
                states.check_active(status)?;
                scenes.set_layer(layer, on, gain, &mut states.orders)
            }
            Command::StartStream { sample_hz, start_level } if cfg!(feature = "stream") => {
                states.check_active(status)?;
                scenes.start_stream(sample_hz, start_level, board, &mut states.orders)
            }
            Command::EndStream => scenes.end_stream(&mut states.orders),
            Command::TouchFinger { finger, x_m, y_m, age_ticks } => {
                motion.touch(finger, (x_m, y_m), age_ticks, scenes.leader(), status)
            }
            Command::LiftFinger { finger } => Ok(motion.lift(finger, scenes.leader(), status)),
            Command::TickTimes if cfg!(feature = "telemetry") => Ok(Accepted::TickTimes(self.tick_times(status))),
            // The features of these commands are disabled.
            Command::Subscribe { .. } | Command::StartStream { .. } | Command::TickTimes => {
                Err(Refusal::UnknownCommand)
            }
            Command::ClearFault => states.clear_fault(),
            Command::Arm if board.notices & notice::OPTION_BYTES != 0 => Err(Refusal::OptionBytes),
            Command::Arm | Command::Disarm | Command::Play | Command::Stop => {
                states.drive(command, status, scenes.crc32() != 0)
            }
        }
    }

    fn tick_times(&self, status: &Status) -> TickTimes {
        let missed_deadlines = status.counters.missed_deadlines;
        match self.tick_meter {
            Some(meter) => meter.times(missed_deadlines),
            None => TickTimes { missed_deadlines, ..TickTimes::default() },
        }
    }

    /// Does the work due at a tick: drops outdated data, reports unrequested changes of state, advances a commit or
    /// executes the first request that waited for it, and sends reports.
    pub(crate) fn poll(&mut self, status: &Status) {
        self.motion.expire(status.telemetry.tick);
        // First, so that a request that waited for the commit sees the board's current state.
        self.report_state(status);
        self.step_commit(status);
        self.report_stream(status);
        if cfg!(feature = "telemetry") {
            self.link.send_telemetry(&status.telemetry);
        }
    }

    fn step_commit(&mut self, status: &Status) {
        if self.scenes.is_committing() {
            let outcome = self.scenes.step_commit(&self.board, &mut self.states.orders);
            if let Some(outcome) = outcome {
                self.link.answer_commit(outcome, self.states.state());
            }
        } else if let Some(request) = self.link.next_waiting() {
            self.carry_out(request, status);
        }
    }

    /// Reports a change of state that the host did not request.
    fn report_state(&mut self, status: &Status) {
        if !self.states.follow(status) {
            return;
        }
        self.end_stream_unless_active();
        let state = self.states.state();
        let fault = status.fault.filter(|_| state == State::Faulted).map(|(fault, _)| fault);
        self.link.report_state(state, fault, Flags(status.telemetry.flags.0 & Flags::HOST_SILENT.0));
        // An Arm or a Play sent before the board disarmed itself must not take effect afterwards.
        if matches!(state, State::Disarmed | State::Faulted) {
            self.link.refuse_waiting(state);
        }
    }

    /// Stops taking samples of a stream unless the scene plays. Needs no order, since the ticker does the same on its
    /// own.
    fn end_stream_unless_active(&mut self) {
        if self.states.state() != State::Active {
            let _ = self.scenes.stream.end();
        }
    }

    /// Reports the progress of the stream if a report is due and the transmit queue has room; otherwise, the next call
    /// tries again.
    fn report_stream(&mut self, status: &Status) {
        let now_tick = status.telemetry.tick;
        let period_ticks = self.board.ticks(PROGRESS_PERIOD_S);
        if let Some(progress) = self.scenes.stream.progress_due(now_tick, period_ticks)
            && self.link.report_stream(progress, status)
        {
            self.scenes.stream.reported(now_tick);
        }
    }

    /// The next order for the ticker.
    pub(crate) fn next_order(&mut self) -> Option<Order<'a>> {
        let predicts = self.scenes.predicts();
        self.states.next_order(|| self.motion.next_order(predicts))
    }

    /// Commits one of the board's own scenes at once.
    pub(crate) fn commit_own(&mut self, scene: &[u8]) -> Result<(), Refusal> {
        self.scenes.commit_own(scene, &self.board, &mut self.states.orders)
    }
}

/// Whether a request may be executed during a commit, or while earlier requests wait for one. Its effects are
/// independent of theirs, except that Stop and Disarm refuse waiting requests (see [`Commands::take_request`]).
fn may_overtake_a_commit(command: Command) -> bool {
    matches!(
        command,
        Command::Ping
            | Command::Stop
            | Command::Disarm
            | Command::Subscribe { .. }
            | Command::Touch { .. }
            | Command::Lift
            | Command::FaultText { .. }
            | Command::TouchFinger { .. }
            | Command::LiftFinger { .. }
            | Command::TickTimes
    )
}

/// The piece of a fault's text at `offset`.
fn fault_text(text: &[u8], offset: u8) -> Accepted {
    let rest = text.get(..text.len().min(FAULT_TEXT_MAX_LEN)).and_then(|text| text.get(usize::from(offset)..));
    let mut bytes = [0; FAULT_TEXT_PIECE_LEN];
    let mut len = 0;
    for (to, from) in bytes.iter_mut().zip(rest.unwrap_or_default()) {
        *to = *from;
        len += 1;
    }
    Accepted::FaultText { len, bytes }
}
