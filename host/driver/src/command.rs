//! Commands: their frames, their names in messages, and the states that they result in.

use frixel_wire::fault::State;
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::{Command, Request};
use frixel_wire::payload::{WriteError, request_frame};

/// The frame of a request.
pub(super) fn frame_of(sequence: u16, command: Command) -> Result<Vec<u8>, WriteError> {
    let mut buffer = [0; FRAME_MAX_LEN];
    request_frame(&Request { sequence, command }, &mut buffer).map(<[u8]>::to_vec)
}

/// The name of a command in error messages.
pub(super) fn name_of(command: &Command) -> &'static str {
    match command {
        Command::Ping => "ping",
        Command::UploadScene { .. } => "upload of the scene",
        Command::UploadBitmap { .. } => "upload of a bitmap",
        Command::UploadEnd => "end of an upload",
        Command::Commit { .. } => "commit",
        Command::Arm => "arm",
        Command::Disarm => "disarm",
        Command::Play => "play",
        Command::Stop => "stop",
        Command::ClearFault => "clear the fault",
        Command::Subscribe { .. } => "telemetry",
        Command::Touch { .. } => "touch",
        Command::Lift => "lift",
        Command::FaultText { .. } => "text of the fault",
        Command::SetLayer { .. } => "change of a layer",
        Command::StartStream { .. } => "start of a stream",
        Command::EndStream => "end of a stream",
        Command::TouchFinger { .. } => "touch of a finger",
        Command::LiftFinger { .. } => "lift of a finger",
        Command::TickTimes => "tick times",
    }
}

/// The state that a command results in, if its purpose is to change the state.
pub(super) fn state_after(command: &Command) -> Option<State> {
    match command {
        Command::Arm | Command::Stop => Some(State::Armed),
        Command::Disarm | Command::ClearFault => Some(State::Disarmed),
        Command::Play => Some(State::Active),
        Command::Ping
        | Command::UploadScene { .. }
        | Command::UploadBitmap { .. }
        | Command::UploadEnd
        | Command::Commit { .. }
        | Command::Subscribe { .. }
        | Command::Touch { .. }
        | Command::Lift
        | Command::FaultText { .. }
        | Command::SetLayer { .. }
        | Command::StartStream { .. }
        | Command::EndStream
        | Command::TouchFinger { .. }
        | Command::LiftFinger { .. }
        | Command::TickTimes => None,
    }
}
