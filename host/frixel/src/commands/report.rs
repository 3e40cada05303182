//! `frixel report`: the model's error and its cost, on one page.

use std::path::PathBuf;

use clap::Args;

use super::error::CommandError;
use super::terminal::print_line;

#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// Folder for the page and its numbers.
    #[arg(long, default_value = "frixel-report")]
    out: PathBuf,
    /// Instruction counts of boards, as `cargo xtask bench` writes them to target/bench/bench.json.
    #[arg(long, value_name = "FILE.json")]
    bench: Option<PathBuf>,
}

pub(super) fn run(args: &ReportArgs) -> Result<(), CommandError> {
    for file in crate::report::write(&args.out, args.bench.as_deref())? {
        print_line(format_args!("  {:<16} {}", "wrote", file.display()))?;
    }
    Ok(())
}
