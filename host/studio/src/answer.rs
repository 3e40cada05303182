//! Answers to the page, in the output buffer.

use std::fmt::Display;

use frixel_scene::{Diagnostic, DiagnosticKind, Program};
use frixel_wire::fault::Flags;
use frixel_wire::hello::Hello;
use frixel_wire::message::Telemetry;
use serde_json::{Value, json};

use crate::host_error::HostError;
use crate::program::ProgramError;

/// A sentence about a scene called `entry`, and its place in the text: `severity` (`error` or `warning`), `message`,
/// `file` if it is not the scene, and `line`, `column`, `endLine` and `endColumn`, which count from 1, columns in
/// characters. `help` is the nearest valid word for an unknown one, or `null`.
fn problem(diagnostic: &Diagnostic, entry: &str) -> Value {
    let Diagnostic { kind, file, line, column, text, .. } = diagnostic;
    let severity = match kind {
        DiagnosticKind::Mistake | DiagnosticKind::Refusal => "error",
        DiagnosticKind::Warning | DiagnosticKind::Note => "warning",
    };
    let marked = text.lines().next().unwrap_or_default().chars().count().max(1);
    let mut problem = json!({
        "severity": severity,
        "message": diagnostic.sentence(),
        "line": line,
        "column": column,
        "endLine": line,
        "endColumn": column + marked,
        "help": diagnostic.nearest(),
    });
    if file != entry {
        problem["file"] = file.as_str().into();
    }
    problem
}

/// A sentence without a place.
fn problem_of_request(message: impl Display) -> Value {
    json!({ "severity": "error", "message": message.to_string() })
}

/// The problems of an error, those of a scene called `entry` without its name.
pub(crate) fn problems(error: &ProgramError, entry: &str) -> Vec<Value> {
    match error {
        ProgramError::Request(error) => vec![problem_of_request(error)],
        ProgramError::Compile(error) => error.diagnostics.iter().map(|diagnostic| problem(diagnostic, entry)).collect(),
    }
}

/// The problems of a program called `entry`: why a board refuses it, if it is a draft, and warnings.
pub(crate) fn problems_of(program: &Program, entry: &str) -> Vec<Value> {
    let is_problem = |diagnostic: &&Diagnostic| diagnostic.kind != DiagnosticKind::Note;
    program.diagnostics.iter().filter(is_problem).map(|diagnostic| problem(diagnostic, entry)).collect()
}

/// An error as the page gets it: `error`, a sentence, `problems`, as [`crate::check`] returns them, and `isLinkLost`.
pub(crate) fn error(error: &HostError, entry: &str) -> Value {
    let problems = match error {
        HostError::Program(error) => problems(error, entry),
        error => vec![problem_of_request(error)],
    };
    json!({ "error": error.to_string(), "problems": problems, "isLinkLost": error.is_link_lost() })
}

/// A board that was connected to: `driving`, what Arm drives, and `tickHz`, its ticks a second.
pub(crate) fn board(hello: &Hello) -> Value {
    json!({ "driving": driven_board(hello), "tickHz": hello.tick_hz })
}

/// The label of Arm: what it drives, with the board's notices, which a person reads before the press.
fn driven_board(hello: &Hello) -> String {
    let board = hello.board;
    let sentence = if board.is_simulated() {
        format!("{board}, which has no electrode")
    } else {
        format!("{board} with an electrode, up to {} V peak", hello.limits.voltage_max_v_peak)
    };
    hello.notice_sentences().fold(sentence, |sentence, notice| sentence + "; note: " + notice)
}

/// A telemetry message. A board does not know the scene's friction without its own limits, so `referenceN` is the
/// friction that it commands: the reported electric part with `natural_n`.
pub(crate) fn telemetry(telemetry: &Telemetry, natural_n: f64) -> Value {
    json!({
        "tick": telemetry.tick,
        "xMm": 1e3 * f64::from(telemetry.finger_x_m),
        "yMm": 1e3 * f64::from(telemetry.finger_y_m),
        "speedMmPerS": 1e3 * f64::from(telemetry.speed_m_per_s),
        "isTouched": !telemetry.flags.contains(Flags::NO_FINGER),
        "referenceN": natural_n + f64::from(telemetry.commanded_electric_friction_n),
        "voltageV": telemetry.voltage_v_rms,
    })
}

#[cfg(test)]
mod tests {
    use frixel_wire::fault::State;
    use frixel_wire::hello::{BoardKind, BoardLimits, ResetCause, notice};

    use super::*;

    #[test]
    fn the_words_on_the_button_that_arms_a_board_hold_its_notices() {
        let mut hello = Hello {
            protocol: (1, 0),
            firmware: (0, 1, 0),
            board: BoardKind::NucleoG474re,
            id: [0; 12],
            tick_hz: 40_000,
            frame_max_len: 192,
            features: 0,
            scene_crc32: 0,
            reset_cause: ResetCause::PowerOn,
            last_fault: None,
            fault_detail: 0,
            state: State::Disarmed,
            limits: BoardLimits { voltage_max_v_peak: 300.0, ..BoardLimits::UNSTATED },
            notices: 0,
        };
        assert_eq!(driven_board(&hello), "NUCLEO-G474RE with an electrode, up to 300 V peak");
        hello.notices = notice::LIMITS_ABOVE_CEILINGS | notice::OPTION_BYTES;
        let said = driven_board(&hello);
        assert!(said.contains("300 V peak; note: ") && said.contains("above the ceilings"), "{said}");
        assert!(said.contains("option bytes"), "{said}");
    }
}
