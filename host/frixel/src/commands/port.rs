//! The serial port that `--port` names, as every command opens it.

use anyhow::{Result, anyhow, bail};
use frixel_driver::{DEFAULT_BAUD, Device, PortError, SerialLink};
use frixel_felt::recorder::{Observation, Recorder};
use frixel_play::Observed;
use frixel_scene::Nearest;

use super::target::Target;
use super::terminal::note;

/// A board on a serial port, with the record of its telemetry.
pub(super) type PortLink = Observed<SerialLink, Recorder>;

/// Opens the serial port that `--port` names. `boards` are the names that the command also accepts.
pub(super) fn open(port: &str, boards: &[&str]) -> Result<SerialLink> {
    SerialLink::open(port, DEFAULT_BAUD).map_err(|source| match source {
        PortError::NotThere { .. } if !port.contains(['/', '\\']) => {
            anyhow!("{source}; {}", advice(port, boards))
        }
        source => source.into(),
    })
}

/// Connects to the board at a serial port, to play on it. Prints the board's notices, and refuses a board with an
/// electrode unless `arm` is set. `boards` are the names that the command also accepts.
pub(super) fn connect_to_play(port: &str, boards: &[&str], arm: bool) -> Result<Device<PortLink>> {
    let link = Observed::new(open(port, boards)?, Recorder::default(), |recorder, message| {
        recorder.record(&Observation::from_telemetry(message));
    });
    let device = Device::connect(link)?;
    for sentence in device.hello().notice_sentences() {
        note(format_args!("note: {sentence}"));
    }
    if device.may_arm(arm) {
        return Ok(device);
    }
    bail!(
        "{port} is a board with an electrode: add --arm, and hold the board's arm switch, to let it drive hundreds of \
         volts"
    )
}

/// Lists what `--port` accepts, and suggests the closest name.
fn advice(port: &str, boards: &[&str]) -> String {
    let words = if boards.is_empty() { String::new() } else { format!("`{}` or ", boards.join("`, `")) };
    let takes = format!("--port expects {words}the path of a board's serial port");
    match Nearest::new(port, Target::names()).suggestion {
        Some(board) if boards.contains(&board.as_str()) => format!("{takes}; did you mean `{board}`?"),
        Some(board) if board == "sim" => format!("{takes} here: start `frixel sim`, and give the port that it prints"),
        Some(board) => format!("{takes} here, and `{board}` is a board of `frixel play`"),
        None => takes,
    }
}
