//! `frixel finger`: measures a finger and fits its profile.

mod calibrate;
mod fit;

use anyhow::Result;
use clap::Subcommand;

#[derive(Debug, Subcommand)]
pub(super) enum FingerCommand {
    /// Record a finger's friction while a board switches its drive on and off, for `frixel finger fit`.
    Calibrate(calibrate::CalibrateArgs),
    /// Fit a finger's profile to measured friction.
    Fit(fit::FitArgs),
}

pub(super) fn run(command: &FingerCommand) -> Result<()> {
    match command {
        FingerCommand::Calibrate(args) => calibrate::run(args),
        FingerCommand::Fit(args) => fit::run(args),
    }
}
