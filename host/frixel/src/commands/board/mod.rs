//! `frixel board`: the commands for a board at a serial port.

mod faults;
mod info;
mod ports;
mod record;
mod safety;
mod selftest;

use anyhow::Result;
use clap::Subcommand;

#[derive(Debug, Subcommand)]
pub(super) enum BoardCommand {
    /// List the serial ports.
    Ports,
    /// Identify the board at a port.
    Info(info::InfoArgs),
    /// Check link, clock and telemetry of a board, with its output at zero.
    Selftest(selftest::SelftestArgs),
    /// Print a board's last fault, or clear it.
    Faults(faults::FaultsArgs),
    /// Record the path of a finger on a board, as a stroke.
    Record(record::RecordArgs),
    /// Compute the current through a finger on an intact, a scratched and a bridged coating, and the voltages that keep
    /// it within its limit.
    Safety(safety::SafetyArgs),
}

pub(super) fn run(command: &BoardCommand) -> Result<()> {
    match command {
        BoardCommand::Ports => ports::run(),
        BoardCommand::Info(args) => info::run(args),
        BoardCommand::Selftest(args) => selftest::run(args),
        BoardCommand::Faults(args) => faults::run(args),
        BoardCommand::Record(args) => record::run(args),
        BoardCommand::Safety(args) => safety::run(args),
    }
}
