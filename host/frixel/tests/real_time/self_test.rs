//! `frixel board selftest --wires` against a simulated board behind a pseudo-terminal, as a stranger uses it.

use std::fs;
use std::path::Path;
use std::process::Output;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use frixel_board::self_test::{GREETING, Stop};
use frixel_hil_sim::PseudoTerminal;
use frixel_hil_sim::looped_board::{Defect, LoopedRig, TerminalPort};
use serde_json::Value;

use crate::processes::{run_fed, said};

/// Runs the command beside a board, and returns what the board's script returned.
fn self_test(
    wrong: Defect,
    seconds: u32,
    typed: &str,
    report: &str,
) -> (Output, thread::JoinHandle<Result<u32, Stop>>) {
    let port = TerminalPort::open().unwrap();
    let path = port.path().to_owned();
    let board = thread::spawn(move || LoopedRig::new(port, wrong).run());
    (command(&path, seconds, typed, report), board)
}

fn command(port: &str, seconds: u32, typed: &str, report: &str) -> Output {
    let seconds = seconds.to_string();
    let arguments = ["board", "selftest", "--wires", "--port", port, "--seconds", &seconds, "-o", report];
    run_fed(Path::new("."), &arguments, typed.as_bytes())
}

fn read(report: &str) -> Value {
    serde_json::from_slice(&fs::read(report).unwrap()).unwrap()
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &said(output)
}

#[test]
fn a_board_in_order_passes_and_its_report_is_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().join("report.json").display().to_string();
    // Typed wrong first: the board asks again.
    let (output, board) = self_test(Defect::Nothing, 1, "done\nunplugged\n", &report);
    assert!(output.status.success(), "{}", text(&output));
    assert_eq!(board.join().unwrap(), Ok(0));
    let report = read(&report);
    assert_eq!(report["format"], "frixel self-test");
    assert_eq!((&report["version"], &report["board"]), (&1.into(), &"NUCLEO-G474RE".into()));
    assert_eq!((&report["passed"], &report["stopped"]), (&true.into(), &Value::Null));
    let measurements = report["measurements"].as_array().unwrap();
    let found = |name: &str| {
        let found = measurements.iter().find(|found| found["name"] == name);
        found.unwrap_or_else(|| panic!("no {name}: {report}"))["found"].as_u64().unwrap()
    };
    assert!(found("line_blocks_received") > 100 && found("host_blocks_received") > 100, "{report}");
    assert_eq!(found("clocks_in_sync_at_least"), 24);
    assert_eq!(report["ticks"]["alone"].as_array().unwrap().len(), 9, "{report}");
    // The page says what each of them means.
    let page = include_str!("../../../../docs/board/first-board.md");
    for found in measurements {
        let name = found["name"].as_str().unwrap();
        assert!(page.contains(&format!("`{name}`")), "docs/board/first-board.md does not have {name}");
    }
}

#[test]
fn what_is_wrong_ends_in_the_report_and_in_exit_code_1() {
    let folder = tempfile::tempdir().unwrap();
    for (wrong, typed, says) in [
        (Defect::ReadyHigh, "", "unplug the amplifier"),
        (Defect::NoSyncWire, "unplugged\n", "SYNC is not wired"),
        (Defect::LatchLate, "unplugged\n", "measurements out of range on"),
    ] {
        let report = folder.path().join(format!("{wrong:?}.json")).display().to_string();
        let (output, board) = self_test(wrong, 0, typed, &report);
        assert_eq!(output.status.code(), Some(1), "{}", text(&output));
        assert!(said(&output).contains(says), "{}", text(&output));
        assert_ne!(board.join().unwrap(), Ok(0));
        let report = read(&report);
        assert_eq!(report["passed"], false);
        assert_eq!(report["stopped"].is_null(), wrong == Defect::LatchLate, "{report}");
    }
}

#[test]
fn nobody_who_answers_and_a_board_with_another_program_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().join("report.json").display().to_string();
    // The board waits for an answer that never comes: its thread ends with this process.
    let (output, _board) = self_test(Defect::Nothing, 0, "", &report);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output).contains("standard input ended"), "{}", text(&output));

    let terminal = PseudoTerminal::open().unwrap();
    let output = command(terminal.path(), 0, "", &report);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output).contains("does not run the self-test"), "{}", text(&output));
    assert_eq!(read(&report)["passed"], false);
}

#[test]
fn a_board_that_never_stops_talking_ends_with_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().join("report.json").display().to_string();
    let asks = format!("Then type: {GREETING}\n");
    for (again, says) in [
        ("noise without an end", "does not run the self-test"),
        ("a line of another program\n", "does not run the self-test"),
        (asks.as_str(), "has sent 1000 lines"),
    ] {
        let mut terminal = PseudoTerminal::open().unwrap();
        let path = terminal.path().to_owned();
        let has_ended = AtomicBool::new(false);
        let output = thread::scope(|scope| {
            scope.spawn(|| {
                let mut bytes = again.as_bytes();
                while !has_ended.load(Ordering::Relaxed) {
                    // What the command types is read, so that it is not kept from typing.
                    terminal.read(&mut [0; 256]).unwrap();
                    let written = terminal.write(bytes).unwrap();
                    bytes = bytes.get(written..).unwrap();
                    if bytes.is_empty() {
                        bytes = again.as_bytes();
                        thread::sleep(Duration::from_micros(100));
                    }
                }
            });
            let output = command(&path, 0, "", &report);
            has_ended.store(true, Ordering::Relaxed);
            output
        });
        assert_eq!(output.status.code(), Some(1), "{}", text(&output));
        assert!(text(&output).contains(says), "{again}: {}", text(&output));
    }
}
