//! `--jobs`: the number of plays that a command simulates in parallel.

use std::num::NonZero;

use anyhow::{Result, anyhow};
use clap::Args;
use frixel_lab::score::JOBS_MAX;
use rayon::ThreadPoolBuilder;

use super::argument::whole;

#[derive(Clone, Copy, Debug, Args)]
pub(super) struct JobsArgs {
    /// Number of plays to simulate in parallel; results do not depend on it. Default: one per processor.
    #[arg(long, value_name = "N", value_parser = whole(1..=JOBS_MAX))]
    jobs: Option<u64>,
}

impl JobsArgs {
    /// Runs `work` in a rayon pool of this many threads.
    pub(super) fn run<R: Send>(self, work: impl FnOnce() -> R + Send) -> Result<R> {
        let jobs = self.jobs.map(|jobs| jobs as usize);
        let threads = jobs.or_else(|| std::thread::available_parallelism().ok().map(NonZero::get)).unwrap_or(1);
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool =
            pool.map_err(|error| anyhow!("the threads of --jobs cannot start: {error}; give a smaller number"))?;
        Ok(pool.install(work))
    }
}
