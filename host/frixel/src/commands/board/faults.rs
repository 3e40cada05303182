//! `frixel board faults`: the last fault of a board.

use anyhow::Result;
use clap::Args;
use frixel_driver::Device;
use frixel_scene::printable;
use frixel_wire::fault::State;

use crate::commands::interrupt::Interrupt;
use crate::commands::port;
use crate::commands::terminal::print_line;
use crate::commands::waiting;

#[derive(Debug, Args)]
pub(in crate::commands) struct FaultsArgs {
    /// Path of the board's serial port.
    #[arg(long)]
    port: String,
    /// Clear a latched fault whose cause is gone.
    #[arg(long)]
    clear: bool,
}

pub(super) fn run(args: &FaultsArgs) -> Result<()> {
    let device = Device::connect(port::open(&args.port, &[])?)?;
    let mut device = waiting::watch(device, &Interrupt::default());
    let hello = *device.hello();
    let line = |name: &str, value: String| print_line(format_args!("{name:16} {value}"));
    let last_fault = hello.last_fault.map_or("none since power-on".to_owned(), |fault| {
        format!("{fault} (number {}, detail {})", fault.number(), hello.fault_detail)
    });
    line("last fault", last_fault)?;
    line("last reset", hello.reset_cause.to_string())?;
    let text = device.fault_text()?;
    line(
        "firmware said",
        if text.is_empty() { "nothing before its last reset".to_owned() } else { printable(&text).into_owned() },
    )?;
    for sentence in hello.notice_sentences() {
        line("note", sentence.to_owned())?;
    }
    let is_latched = hello.state == State::Faulted;
    line("latched", if is_latched { "yes: the output is zero until it is cleared" } else { "no" }.to_owned())?;
    match (args.clear, is_latched) {
        (false, _) => Ok(()),
        (true, false) => line("cleared", "nothing was latched".to_owned()),
        (true, true) => {
            device.clear_fault()?;
            line("cleared", "yes: the board is disarmed".to_owned())
        }
    }
}
