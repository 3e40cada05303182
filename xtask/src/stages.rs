//! The stages of a command, each with a heading and its run time.

use std::time::{Duration, Instant};

/// Runs stages one after another and records the time of each.
pub(crate) struct Stages {
    finished: Vec<(String, Duration)>,
}

impl Stages {
    pub(crate) fn new() -> Self {
        Self { finished: Vec::new() }
    }

    /// Prints a heading and runs a stage.
    pub(crate) fn run(&mut self, name: &str, stage: impl FnOnce() -> Result<(), String>) -> Result<(), String> {
        eprintln!("== {name}");
        let begin = Instant::now();
        stage()?;
        let time = begin.elapsed();
        eprintln!("== {name}: {}", seconds(time));
        self.finished.push((name.to_owned(), time));
        Ok(())
    }

    /// A table with the time of each stage and their sum.
    pub(crate) fn table(&self) -> String {
        let sum = self.finished.iter().map(|(_, time)| *time).sum();
        let lines = self.finished.iter().map(|(name, time)| format!("{:>9}  {name}\n", seconds(*time)));
        lines.chain([format!("{:>9}  all stages\n", seconds(sum))]).collect()
    }
}

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stage_that_fails_ends_the_run_and_has_no_time() {
        let mut stages = Stages::new();
        assert_eq!(stages.run("first", || Ok(())), Ok(()));
        assert_eq!(stages.run("second", || Err("broken".to_owned())), Err("broken".to_owned()));
        let table = stages.table();
        assert!(table.contains("first") && !table.contains("second") && table.contains("all stages"), "{table}");
    }
}
