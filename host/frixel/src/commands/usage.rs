//! What a person typed, or one sentence on what is wrong with it.

use std::process::ExitCode;

use clap::Parser;

use super::Cli;

/// Exit code of a command line that cannot be understood.
const USAGE: u8 = 2;

impl Cli {
    /// Reads the command line. When there is nothing to run, help or the error has been printed, and the exit code is told.
    pub(crate) fn read() -> Result<Self, ExitCode> {
        Self::try_parse().map_err(|error| {
            if error.use_stderr() && error.kind() != clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
                eprintln!("frixel: {}", sentence(&error.render().to_string()));
                return ExitCode::from(USAGE);
            }
            // Nobody is there to be told that nobody reads.
            let _ = error.print();
            if error.use_stderr() { ExitCode::from(USAGE) } else { ExitCode::SUCCESS }
        })
    }
}

/// Makes one sentence of what the parser says in paragraphs: what is wrong, a tip where there is one, and where help is.
fn sentence(said: &str) -> String {
    let mut paragraphs = said.split("\n\n");
    let wrong: Vec<&str> = paragraphs.next().unwrap_or_default().lines().map(str::trim).collect();
    let mut sentence = wrong.join(" ");
    if let Some(without) = sentence.strip_prefix("error: ") {
        sentence = without.to_owned();
    }
    let mut command = "frixel".to_owned();
    for line in paragraphs.flat_map(str::lines).map(str::trim) {
        if let Some(tip) = line.strip_prefix("tip: ") {
            sentence = format!("{sentence}; {tip}");
        } else if let Some(usage) = line.strip_prefix("Usage: ") {
            let words = usage.split(' ').take_while(|word| word.starts_with(|first: char| first.is_ascii_alphabetic()));
            command = words.collect::<Vec<_>>().join(" ");
        }
    }
    format!("{sentence}; `{command} --help` says what it takes")
}
