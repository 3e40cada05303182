//! The stages of a command, each with a heading and its run time.

use std::fs;
use std::time::{Duration, Instant};

use crate::outcome::Outcome;

/// Runs stages one after another and records the time and the outcome of each.
pub(crate) struct Stages {
    finished: Vec<Finished>,
}

/// A stage that has ended.
struct Finished {
    name: String,
    time: Duration,
    /// Time of all processors in the stage's programs, where the system tells it. It says more than the run time on a
    /// machine that does other things, too.
    processor_time: Option<Duration>,
    outcome: Outcome,
}

impl Stages {
    pub(crate) fn new() -> Self {
        Self { finished: Vec::new() }
    }

    /// Prints a heading and runs a stage.
    pub(crate) fn run(&mut self, name: &str, stage: impl FnOnce() -> Result<Outcome, String>) -> Result<(), String> {
        eprintln!("== {name}");
        let (begin, used_before) = (Instant::now(), processor_time());
        let outcome = stage()?;
        let time = begin.elapsed();
        let processor_time = processor_time().zip(used_before).map(|(now, before)| now.saturating_sub(before));
        eprintln!("== {name}: {}", seconds(time));
        self.finished.push(Finished { name: name.to_owned(), time, processor_time, outcome });
        Ok(())
    }

    /// A table with the run time of each stage, the time that processors spent on it, and the sums. It marks stages
    /// that skipped something.
    pub(crate) fn table(&self) -> String {
        let line = |time, processor_time: Option<Duration>, name: &str, mark| {
            let processor_time = processor_time.map(seconds).unwrap_or_default();
            format!("{:>9} {processor_time:>12}  {name}{mark}\n", seconds(time))
        };
        let lines = self.finished.iter().map(|stage| {
            let mark = if stage.outcome == Outcome::Skipped { " (SKIPPED in part)" } else { "" };
            line(stage.time, stage.processor_time, &stage.name, mark)
        });
        let time = self.finished.iter().map(|stage| stage.time).sum();
        let processor_time = self.finished.iter().map(|stage| stage.processor_time).sum();
        let heading = format!("{:>9} {:>12}\n", "time", "processors");
        [heading].into_iter().chain(lines).chain([line(time, processor_time, "all stages", "")]).collect()
    }
}

/// The processor time of all ended programs of this one, as Linux tells it.
fn processor_time() -> Option<Duration> {
    processor_time_in(&fs::read_to_string("/proc/self/stat").ok()?)
}

/// The fields `cutime` and `cstime` of `/proc/self/stat`, proc(5), in hundredths of a second.
fn processor_time_in(stat: &str) -> Option<Duration> {
    // The second field is a name in parentheses, which may have spaces; the next is the third.
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(16 - 3);
    let (user, system): (u64, u64) = (fields.next()?.parse().ok()?, fields.next()?.parse().ok()?);
    Some(Duration::from_millis(10 * (user + system)))
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
    fn the_time_of_processors_is_that_of_ended_programs() {
        let stat = "7 (a (b) c) S 1 2 3 4 5 6 7 8 9 10 11 12 250 50 15 16";
        assert_eq!(processor_time_in(stat), Some(Duration::from_secs(3)));
        assert_eq!(processor_time_in("7 (a) S 1"), None);
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
