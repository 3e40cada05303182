//! Progress bars on standard error, if that is a terminal.

use std::io::{IsTerminal, stderr};

use frixel_driver::Progress;
use indicatif::{ProgressBar, ProgressStyle};

/// Steps of a bar.
const STEPS: f64 = 1000.0;
const BAR: &str = "{prefix:8} {bar:40} {percent:>3} %  {msg}";
/// A play without an end has no bar.
const OPEN_END: &str = "{prefix:8} {msg}";

/// The progress bar of the upload, and then that of the play.
#[derive(Default)]
pub(super) struct Bars {
    name: &'static str,
    bar: Option<ProgressBar>,
}

impl Bars {
    pub(super) fn upload(&mut self, progress: Progress) {
        let part = progress.done_bytes as f64 / progress.total_bytes.max(1) as f64;
        self.show("upload", BAR, part, || format!("{} of {} bytes", progress.done_bytes, progress.total_bytes));
    }

    /// Shows how much of a play of `seconds`, which may be infinite, is over.
    pub(super) fn play(&mut self, played_s: f64, seconds: f64) {
        if seconds.is_finite() {
            let left_s = (seconds - played_s).max(0.0);
            self.show("play", BAR, played_s / seconds, || format!("{left_s:.0} s left"));
        } else {
            self.show("play", OPEN_END, 0.0, || format!("{played_s:.0} s so far; Ctrl-C ends it"));
        }
    }

    pub(super) fn finish(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }

    fn show(&mut self, name: &'static str, template: &str, part: f64, message: impl FnOnce() -> String) {
        if name != self.name {
            self.finish();
            self.name = name;
            self.bar = stderr().is_terminal().then(|| new_bar(name, template));
        }
        if let Some(bar) = &self.bar {
            bar.set_position((part * STEPS) as u64);
            bar.set_message(message());
        }
    }
}

fn new_bar(name: &'static str, template: &str) -> ProgressBar {
    let bar = ProgressBar::new(STEPS as u64).with_prefix(name);
    match ProgressStyle::with_template(template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
