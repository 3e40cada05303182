//! `--jobs`: how many plays a command simulates side by side.

use std::num::NonZero;

use anyhow::{Result, anyhow};
use clap::Args;
use frixel_lab::score::TrialPlan;
use rayon::ThreadPoolBuilder;

use super::argument::whole;

#[derive(Clone, Copy, Debug, Args)]
pub(super) struct JobsArgs {
    /// Simulate so many plays side by side. Without it, as many as this machine has processors. Results are the same
    /// for any number.
    #[arg(long, value_name = "N", value_parser = whole(1..=TrialPlan::COUNT_MAX))]
    jobs: Option<u64>,
}

impl JobsArgs {
    /// Does work that simulates on the threads of its rayon pool.
    pub(super) fn run<R: Send>(self, work: impl FnOnce() -> R + Send) -> Result<R> {
        let jobs = self.jobs.map(|jobs| jobs as usize);
        let threads = jobs.or_else(|| std::thread::available_parallelism().ok().map(NonZero::get)).unwrap_or(1);
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool =
            pool.map_err(|error| anyhow!("the threads of --jobs cannot start: {error}; give a smaller number"))?;
        Ok(pool.install(work))
    }
}
