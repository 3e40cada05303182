//! Progress bars on standard error, if that is a terminal.

use std::io::{IsTerminal, stderr};

use frixel_driver::Progress;
use indicatif::{ProgressBar, ProgressStyle};

/// The progress bar of the upload, and then that of the play.
#[derive(Default)]
pub(super) struct Bars {
    name: &'static str,
    bar: Option<ProgressBar>,
}

impl Bars {
    pub(super) fn upload(&mut self, progress: Progress) {
        self.show("upload", progress.done_bytes as f64 / progress.total_bytes.max(1) as f64);
    }

    pub(super) fn play(&mut self, part: f64) {
        self.show("play", part);
    }

    pub(super) fn finish(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }

    fn show(&mut self, name: &'static str, part: f64) {
        const STEPS: f64 = 1000.0;
        if name != self.name {
            self.finish();
            self.name = name;
            self.bar = stderr().is_terminal().then(|| new_bar(name, STEPS as u64));
        }
        if let Some(bar) = &self.bar {
            bar.set_position((part * STEPS) as u64);
        }
    }
}

fn new_bar(name: &'static str, steps: u64) -> ProgressBar {
    let bar = ProgressBar::new(steps).with_message(name);
    match ProgressStyle::with_template("{msg:8} {bar:40} {percent:>3} %") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
