//! The stages of a command, each with a heading and its run time.

use std::time::{Duration, Instant};

use crate::outcome::Outcome;

/// Runs stages one after another and records the time and the outcome of each.
pub(crate) struct Stages {
    finished: Vec<(String, Duration, Outcome)>,
}

impl Stages {
    pub(crate) fn new() -> Self {
        Self { finished: Vec::new() }
    }

    /// Prints a heading and runs a stage.
    pub(crate) fn run(&mut self, name: &str, stage: impl FnOnce() -> Result<Outcome, String>) -> Result<(), String> {
        eprintln!("== {name}");
        let begin = Instant::now();
        let outcome = stage()?;
        let time = begin.elapsed();
        eprintln!("== {name}: {}", seconds(time));
        self.finished.push((name.to_owned(), time, outcome));
        Ok(())
    }

    /// A table with the time of each stage and their sum. It marks stages that skipped something.
    pub(crate) fn table(&self) -> String {
        let sum = self.finished.iter().map(|(_, time, _)| *time).sum();
        let lines = self.finished.iter().map(|(name, time, outcome)| {
            let mark = if *outcome == Outcome::Skipped { " (SKIPPED in part)" } else { "" };
            format!("{:>9}  {name}{mark}\n", seconds(*time))
        });
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
        assert_eq!(stages.run("first", || Ok(Outcome::Passed)), Ok(()));
        assert_eq!(stages.run("second", || Err("broken".to_owned())), Err("broken".to_owned()));
        let table = stages.table();
        assert!(table.contains("first") && !table.contains("second") && table.contains("all stages"), "{table}");
    }

    #[test]
    fn the_table_marks_what_was_skipped() {
        let mut stages = Stages::new();
        assert_eq!(stages.run("whole", || Ok(Outcome::Passed)), Ok(()));
        assert_eq!(stages.run("partial", || Ok(Outcome::Skipped)), Ok(()));
        let table = stages.table();
        assert!(table.contains("whole\n") && table.contains("partial (SKIPPED in part)\n"), "{table}");
    }
}
