//! `frixel report`: the model's figures, its error and its cost, on one page.

use std::path::PathBuf;

use clap::Args;

use super::error::CommandError;

#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// Folder for the page and its numbers.
    #[arg(long, default_value = "frixel-report")]
    out: PathBuf,
}

pub(super) fn run(args: &ReportArgs) -> Result<(), CommandError> {
    for file in frixel::report::write(&args.out)? {
        println!("  {:<16} {}", "wrote", file.display());
    }
    Ok(())
}
