//! What `docs/inside/scenarios.md` shows of its first example is what a reader sees.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

pub(crate) mod example;

use crate::processes::said;
use example::{page, run, text};

#[test]
fn the_first_example_shows_what_the_page_says() {
    let output = run(&text(), "sim");
    assert!(output.status.success(), "{}", said(&output));
    let timeline = String::from_utf8(output.stdout).unwrap();
    for line in [timeline.lines().next().unwrap(), timeline.lines().last().unwrap()] {
        assert!(page().contains(&format!("\n    {line}\n")), "{line}");
    }
}

#[test]
fn the_first_example_is_broken_as_the_page_says() {
    let broken = text().replace("from_ms = 251 ", "from_ms = 200 ");
    let output = run(&broken, "sim");
    assert_eq!(output.status.code(), Some(1));
    let sentence = said(&output).lines().next().unwrap().to_owned();
    assert!(page().contains(&format!("\n    {sentence}\n")), "{sentence}");
}
