//! The questions of the script, and the checks of their answers.

use core::fmt;

use super::{Bench, Inputs, LINE_MAX_LEN, Stop, TestOutput};

/// Shows an instruction until the person types `word`.
pub(super) fn confirm(bench: &mut impl Bench, what: fmt::Arguments<'_>, word: &str) {
    loop {
        bench.say(format_args!("{what} Then type: {word}"));
        if bench.read_line(TestOutput::Zero).trim().eq_ignore_ascii_case(word) {
            return;
        }
    }
}

pub(super) fn ask(bench: &mut impl Bench, what: &'static str, expected: (f32, f32)) -> Result<f32, Stop> {
    ask_while(bench, TestOutput::Zero, what, expected)
}

/// Asks for a number until the person types one, while the board outputs `output`. A number out of its range ends
/// bring-up; other text does not.
pub(super) fn ask_while(
    bench: &mut impl Bench,
    output: TestOutput,
    what: &'static str,
    range: (f32, f32),
) -> Result<f32, Stop> {
    loop {
        bench.say(format_args!("Type a number: {what}"));
        if let Some(number) = number(&bench.read_line(output)) {
            return expect(what, number, range).map(|()| number);
        }
    }
}

/// A finite number, with a decimal point or a decimal comma.
fn number(line: &str) -> Option<f32> {
    let mut bytes = [0; LINE_MAX_LEN];
    for (to, from) in bytes.iter_mut().zip(line.bytes()) {
        *to = if from == b',' { b'.' } else { from };
    }
    let text = str::from_utf8(bytes.get(..line.len())?).ok()?;
    text.trim().parse().ok().filter(|number: &f32| number.is_finite())
}

pub(super) fn expect(what: &'static str, found: f32, expected: (f32, f32)) -> Result<(), Stop> {
    if (expected.0..=expected.1).contains(&found) { Ok(()) } else { Err(Stop::Reading { what, found, expected }) }
}

pub(super) fn expect_inputs(bench: &mut impl Bench, expected: Inputs, after: &'static str) -> Result<(), Stop> {
    let found = bench.inputs();
    if found == expected { Ok(()) } else { Err(Stop::Inputs { after, expected, found }) }
}

/// Waits until the inputs change from `from` to `to`, which differ in one input. A change of the other input ends
/// bring-up; a bouncing contact does not.
pub(super) fn await_inputs(bench: &mut impl Bench, from: Inputs, to: Inputs, what: &'static str) -> Result<(), Stop> {
    bench.say(format_args!("{what}."));
    loop {
        let found = bench.inputs();
        if found == to {
            return Ok(());
        }
        if found != from {
            return Err(Stop::Inputs { after: what, expected: to, found });
        }
    }
}
