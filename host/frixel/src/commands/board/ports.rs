//! `frixel board ports`: the serial ports of this machine.

use anyhow::Result;
use frixel_driver::ports;

use crate::commands::terminal::print_line;

pub(super) fn run() -> Result<()> {
    let found = ports()?;
    if found.is_empty() {
        print_line("no serial port found; plug a board in, or start `frixel sim` and use the port that it prints")?;
    }
    for port in found {
        print_line(port)?;
    }
    Ok(())
}
