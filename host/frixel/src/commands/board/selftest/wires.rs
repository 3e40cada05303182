//! The host's side of a board's self-test: answers the script, tests the line, and writes the report.

use std::io;
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
/// Handshake timeout; also the retry interval.
const FIRST_LINE_MAX: Duration = Duration::from_secs(6);
const ASK_AGAIN_AFTER: Duration = Duration::from_secs(2);
/// How long a read waits.
const READ_WAIT: Duration = Duration::from_millis(2);
/// Silence after the last block, by which the board's side of the test is over.
const LINE_SILENCE: Duration = Duration::from_secs(1);
/// Time after the last block, by which the test is over even if the board goes on. A simulated board on a busy machine
/// takes several times as long as the test to read what was sent.
const LINE_END_MAX: Duration = Duration::from_secs(30);
/// Longest line of the script, in bytes; a longer one is noise, and is taken in pieces.
const SCRIPT_LINE_MAX_BYTES: usize = 1024;
/// Most lines of a board: some ten times those of the script.
const SCRIPT_LINES_MAX: usize = 1000;
/// Bytes a second at 8 data bits, a start bit and a stop bit.
const LINE_BYTES_PER_S: f64 = DEFAULT_BAUD as f64 / 10.0;
/// Prefix of a word that the board waits for.
const ASKS: &str = "Then type: ";

/// Does the self-test of the board at a port.
pub(super) fn run(port: &str, line_seconds: u32, output: Option<&Path>) -> Result<()> {
    let output = output.map(|path| OutputFile::new(path, "-o", &Inputs::default())).transpose()?;
    let link = port::open(port, &[])?;
    let mut host = Host { link, heard: Vec::new(), report: Report::new(), line_seconds, line_was_tested: false };
    if line_seconds > 0 {
        print_line(format_args!("The line will be tested for {line_seconds} s; `--seconds` changes that."))?;
    }
    let talked = host.talk(port);
    let report = host.report;
    for line in report.of_line() {
        print_line(line)?;
    }
    if let Some(output) = output {
        output.write(&report.to_json().map_err(|error| writing(output.path())(error.into()))?)?;
    }
    talked?;
    match (report.stopped(), report.failed()) {
        (Some(reason), _) => bail!("the board at {port} has ended the self-test: {}", reason.trim_end_matches('.')),
        (None, 0) => print_line("Passed."),
        (None, failed) => bail!(
            "{failed} of the measurements of {port} are out of their range; docs/board/first-board.md says what each \
             means"
        ),
    }
}

struct Host {
    link: SerialLink,
    /// Bytes of a line that has not ended yet.
    heard: Vec<u8>,
    report: Report,
    line_seconds: u32,
    /// Whether the board has sent nothing since the test of the line.
    line_was_tested: bool,
}

impl Host {
    /// Answers the board until its last line.
    fn talk(&mut self, port: &str) -> Result<()> {
        let begun = Instant::now();
        let (mut is_first, mut heard_at, mut lines) = (true, begun, 0);
        while !self.report.has_ended() {
            if is_first && (begun.elapsed() >= FIRST_LINE_MAX || lines == SCRIPT_LINES_MAX) {
                bail!(
                    "the board at {port} does not run the self-test: flash it with `cargo run --release --bin \
                     self-test` in firmware/board-nucleo-g474re, or press its reset button (docs/board/first-board.md)"
                );
            }
            if lines == SCRIPT_LINES_MAX {
                bail!(
                    "the board at {port} has said {SCRIPT_LINES_MAX} lines and has not ended the self-test: check the \
                     line's rate and its cable, press the reset button, and begin again"
                );
            }
            // The board may have asked before anyone listened, or waits for the end of the line's test.
            let is_nudged = is_first || self.line_was_tested;
            let Some(line) = self.line(if is_nudged { ASK_AGAIN_AFTER } else { SILENCE_MAX })? else {
                if is_nudged && heard_at.elapsed() < SILENCE_MAX {
                    self.type_line("")?;
                    continue;
                }
                let seconds = SILENCE_MAX.as_secs();
                bail!("the board at {port} has said nothing for {seconds} s: press its reset button, and begin again");
            };
            heard_at = Instant::now();
            lines += 1;
            // Noise, or a firmware that speaks frames, is no line of the script.
            is_first &= !line.contains(ASKS);
            self.line_was_tested = false;
            self.report.take(&line);
            print_line(&line)?;
            if let Some((_, word)) = line.split_once(ASKS) {
                self.answer(word.trim())?;
                heard_at = Instant::now();
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
        let (mut sent, mut heard_at) = (0.0, begun);
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
            } else if heard_at.elapsed() > LINE_SILENCE || elapsed > length + LINE_END_MAX {
                break;
            }
            let mut bytes = Vec::new();
            self.link.read(&mut bytes, READ_WAIT)?;
            if !bytes.is_empty() {
                heard_at = Instant::now();
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

    /// The next line of the board that is not empty; `None` if no line ends within `patience`.
    fn line(&mut self, patience: Duration) -> Result<Option<String>> {
        let begun = Instant::now();
        loop {
            while let Some(len) = line_len(&self.heard) {
                let line: Vec<u8> = self.heard.drain(..len).collect();
                let line = String::from_utf8_lossy(&line).trim().to_owned();
                if !line.is_empty() {
                    return Ok(Some(line));
                }
            }
            if begun.elapsed() > patience {
                return Ok(None);
            }
            self.link.read(&mut self.heard, READ_WAIT)?;
        }
    }
}

/// Bytes of the first line with its end, or of a piece of one that is too long; `None` if more may follow.
fn line_len(heard: &[u8]) -> Option<usize> {
    let end = heard.iter().take(SCRIPT_LINE_MAX_BYTES).position(|byte| *byte == b'\n');
    end.map(|end| end + 1).or((heard.len() >= SCRIPT_LINE_MAX_BYTES).then_some(SCRIPT_LINE_MAX_BYTES))
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
