//! The host's side of a board's self-test: answers the script, tests the line, and writes the report.

use std::io::{self, Write as _};
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use frixel_board::self_test::{GREETING, LINE_TEST, LineTest, SKIP, UNPLUGGED};
use frixel_driver::{DEFAULT_BAUD, Link, SerialLink};

use super::report::Report;
use crate::commands::error::writing;
use crate::commands::port;
use crate::commands::terminal::print_line;
use crate::input;
use frixel_files::{Inputs, OutputFile};

/// Longest silence of a board that runs the self-test: it counts the clocks of 10,000 frames meanwhile.
const SILENCE_MAX: Duration = Duration::from_secs(20);
/// Longest time for the first line of the script.
const FIRST_LINE_MAX: Duration = Duration::from_secs(6);
/// Retry interval of the handshake, and of the line test's end.
const ASK_AGAIN_AFTER: Duration = Duration::from_secs(2);
/// Timeout of a read.
const READ_WAIT: Duration = Duration::from_millis(2);
/// Silence after the last block that ends the line test.
const LINE_SILENCE: Duration = Duration::from_secs(1);
/// Longest time after the last block until the line test ends, even without silence. A simulated board on a busy
/// machine takes several times as long as the test to read the blocks.
const LINE_END_MAX: Duration = Duration::from_secs(30);
/// Longest line of the script, in bytes; a longer one is noise, and is taken in pieces.
const SCRIPT_LINE_MAX_BYTES: usize = 1024;
/// Largest number of lines from a board: some ten times that of the script.
const SCRIPT_LINES_MAX: usize = 1000;
/// Bytes a second at 8 data bits, a start bit and a stop bit.
const LINE_BYTES_PER_S: f64 = DEFAULT_BAUD as f64 / 10.0;
/// Prefix of the word that the board waits for.
const PROMPT: &str = "Then type: ";

/// Runs the self-test of the board at a port.
pub(super) fn run(port: &str, line_seconds: u32, output: Option<&Path>) -> Result<()> {
    // A folder that is missing is found before the test, not after it.
    let output = output.map(|path| OutputFile::new(path, "-o", &Inputs::default())?.create()).transpose()?;
    let link = port::open(port, &[])?;
    let mut host = Host { link, received: Vec::new(), report: Report::new(), line_seconds, line_was_tested: false };
    if line_seconds > 0 {
        print_line(format_args!("The line will be tested for {line_seconds} s; `--seconds` changes that."))?;
    }
    let ended = host.run_script(port);
    let report = host.report;
    for line in report.of_line() {
        print_line(line)?;
    }
    if let Some(mut output) = output {
        let json = report.to_json().map_err(|error| writing(output.path())(error.into()))?;
        output.write_all(&json)?;
        let path = output.path().to_owned();
        output.commit()?;
        print_line(format_args!("wrote {}", path.display()))?;
    }
    ended?;
    match (report.stopped(), report.failed()) {
        (Some(reason), _) => bail!("the board at {port} stopped the self-test: {}", reason.trim_end_matches('.')),
        (None, 0) => print_line("Passed."),
        (None, failed) => {
            bail!("measurements out of range on {port}: {failed}; docs/board/first-board.md explains each")
        }
    }
}

struct Host {
    link: SerialLink,
    /// Bytes of a line that has not ended yet.
    received: Vec<u8>,
    report: Report,
    line_seconds: u32,
    /// Whether the board has sent nothing since the line test.
    line_was_tested: bool,
}

impl Host {
    /// Answers the board until its last line.
    fn run_script(&mut self, port: &str) -> Result<()> {
        let begun = Instant::now();
        let (mut is_first, mut received_at, mut lines) = (true, begun, 0);
        while !self.report.has_ended() {
            if is_first && (begun.elapsed() >= FIRST_LINE_MAX || lines == SCRIPT_LINES_MAX) {
                bail!(
                    "the board at {port} does not run the self-test: flash it with `cargo run --release --bin \
                     self-test` in firmware/board-nucleo-g474re, or press its reset button (docs/board/first-board.md)"
                );
            }
            if lines == SCRIPT_LINES_MAX {
                bail!(
                    "the board at {port} has sent {SCRIPT_LINES_MAX} lines and has not ended the self-test: check the \
                     line's rate and its cable, press the reset button, and begin again"
                );
            }
            // The board may have asked before the port was open, or may wait for the end of the line test.
            let is_nudged = is_first || self.line_was_tested;
            let Some(line) = self.line(if is_nudged { ASK_AGAIN_AFTER } else { SILENCE_MAX })? else {
                if is_nudged && received_at.elapsed() < SILENCE_MAX {
                    self.type_line("")?;
                    continue;
                }
                let seconds = SILENCE_MAX.as_secs();
                bail!("the board at {port} has sent nothing for {seconds} s: press its reset button, and begin again");
            };
            received_at = Instant::now();
            lines += 1;
            // Noise, or frames of another firmware, may come before the script.
            is_first &= !line.contains(PROMPT);
            self.line_was_tested = false;
            self.report.take(&line);
            print_line(&line)?;
            if let Some((_, word)) = line.split_once(PROMPT) {
                self.answer(word.trim())?;
                received_at = Instant::now();
            }
        }
        Ok(())
    }

    fn answer(&mut self, word: &str) -> Result<()> {
        match word {
            GREETING => self.type_line(GREETING),
            UNPLUGGED => {
                let typed = input::next_line(&mut io::stdin().lock()).with_context(|| {
                    format!("standard input ended before the answer: unplug the amplifier, then type {UNPLUGGED}")
                })?;
                self.type_line(typed.trim())
            }
            _ if self.line_seconds == 0 => self.type_line(SKIP),
            _ => self.test_line(),
        }
    }

    fn test_line(&mut self) -> Result<()> {
        self.type_line(LINE_TEST)?;
        let mut test = LineTest::new();
        let (begun, length) = (Instant::now(), Duration::from_secs(self.line_seconds.into()));
        let (mut sent, mut received_at) = (0.0, begun);
        loop {
            let elapsed = begun.elapsed();
            if elapsed < length {
                while sent < LINE_BYTES_PER_S * elapsed.as_secs_f64() {
                    let bytes = test.pending();
                    self.link.write(bytes)?;
                    sent += bytes.len() as f64;
                    let len = bytes.len();
                    test.advance(len);
                }
            } else if received_at.elapsed() > LINE_SILENCE || elapsed > length + LINE_END_MAX {
                break;
            }
            let mut bytes = Vec::new();
            self.link.read(&mut bytes, READ_WAIT)?;
            if !bytes.is_empty() {
                received_at = Instant::now();
                test.take(&bytes);
            }
        }
        self.report.take_line(&test);
        self.line_was_tested = true;
        self.type_line("")
    }

    fn type_line(&mut self, text: &str) -> Result<()> {
        self.link.write(format!("{text}\r").as_bytes())?;
        Ok(())
    }

    /// The board's next line that is not empty; `None` if no line ends within `timeout`.
    fn line(&mut self, timeout: Duration) -> Result<Option<String>> {
        let begun = Instant::now();
        loop {
            while let Some(len) = line_len(&self.received) {
                let line: Vec<u8> = self.received.drain(..len).collect();
                let line = String::from_utf8_lossy(&line).trim().to_owned();
                if !line.is_empty() {
                    return Ok(Some(line));
                }
            }
            if begun.elapsed() > timeout {
                return Ok(None);
            }
            self.link.read(&mut self.received, READ_WAIT)?;
        }
    }
}

/// Length in bytes of the first line with its line feed, or of a piece of a line that is too long; `None` if more may
/// follow.
fn line_len(received: &[u8]) -> Option<usize> {
    let end = received.iter().take(SCRIPT_LINE_MAX_BYTES).position(|byte| *byte == b'\n');
    end.map(|end| end + 1).or((received.len() >= SCRIPT_LINE_MAX_BYTES).then_some(SCRIPT_LINE_MAX_BYTES))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_without_end_is_taken_in_pieces() {
        assert_eq!(line_len(b"SELF-TEST"), None);
        assert_eq!(line_len(b"ok\nnext\n"), Some(3));
        assert_eq!(line_len(&[b'x'; 5_000]), Some(SCRIPT_LINE_MAX_BYTES));
    }
}
