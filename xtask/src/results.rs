//! The result lines of test runners, which are held back and printed together at the end of a run.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};

/// What the runners of this run have reported.
static RESULTS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Runs a test runner, cargo's, node's or pytest: prints its output as it comes, without its results, which [`print()`]
/// prints. Fails if it fails.
pub(crate) fn run(name: &str, command: &mut Command) -> Result<(), String> {
    eprintln!("-- {name}");
    let explain = |error: std::io::Error| format!("{name} could not be run: {error}");
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(explain)?;
    let mut own = vec![format!("-- {name}")];
    if let Some(output) = child.stdout.take() {
        for line in BufReader::new(output).split(b'\n') {
            let line = String::from_utf8_lossy(&line.map_err(explain)?).into_owned();
            if is_result(&line) {
                own.push(line);
            } else {
                println!("{line}");
            }
        }
    }
    let status = child.wait().map_err(explain)?;
    RESULTS.lock().unwrap_or_else(PoisonError::into_inner).append(&mut own);
    if status.success() { Ok(()) } else { Err(format!("{name} failed ({status}): {command:?}")) }
}

/// Prints the results of all runners on standard output.
pub(crate) fn print() {
    for line in RESULTS.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
        println!("{line}");
    }
}

/// Whether a line counts tests: `test result: ok. 5 passed; …` of cargo, `# pass 5` or `ℹ pass 5` of node, `5 passed in
/// 2.10s` of pytest.
fn is_result(line: &str) -> bool {
    let of_node = |rest: &str| {
        let (word, number) = rest.split_once(' ').unwrap_or_default();
        let words = ["tests", "suites", "pass", "fail", "cancelled", "skipped", "todo", "duration_ms"];
        words.contains(&word) && number.parse::<f64>().is_ok()
    };
    let of_pytest =
        line.starts_with(|first: char| first.is_ascii_digit()) && line.contains(" passed") && line.contains(" in ");
    line.starts_with("test result: ")
        || of_pytest
        || line.strip_prefix("# ").or(line.strip_prefix("ℹ ")).is_some_and(of_node)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_told_from_other_lines() {
        for line in [
            "test result: ok. 3 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s",
            "# tests 12",
            "ℹ pass 12",
            "# duration_ms 812.31",
            "5 passed in 2.10s",
            "1 failed, 4 passed, 2 skipped in 61.02s (0:01:01)",
        ] {
            assert!(is_result(line), "{line}");
        }
        for line in ["test board::arms ... ok", "running 3 tests", "# Subtest: arms", "# pass the plate", "ok 1 - arms"]
        {
            assert!(!is_result(line), "{line}");
        }
    }
}
