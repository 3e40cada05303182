//! What plays and experiments on a board have in common. Experiments take minutes of a person's time, so whatever can
//! be wrong is found before they begin.

use std::collections::BTreeMap;

use crate::rigs::PortLink;
use anyhow::{Result, anyhow, bail};
use frixel_driver::Device;
use frixel_files::OutputFile;
use frixel_scene::{Scene, compile};
use frixel_wire::hello::BoardLimits;

use super::argument::{above_zero_to, number};
use super::port;
use super::terminal::note;

/// Highest voltage of an experiment, in volts rms.
const VOLTAGE_MAX_V_RMS: f64 = 150.0;
/// A scene that drives as much as the board allows, up to that.
const HIGHEST: &str =
    "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 1\n[drive]\nvoltage_max_v_rms = 150\n";

/// Connects to the board at a serial port, says what a person should know of it, and rejects one whose electrode may
/// not be driven. The command takes these boards in place of a port.
pub(super) fn connect(port: &str, boards: &[&str], arm: bool) -> Result<Device<PortLink>> {
    let device = Device::connect(PortLink::new(port::open(port, boards)?))?;
    for sentence in device.hello().notice_sentences() {
        note(format_args!("note: {sentence}"));
    }
    if arm || device.hello().board.is_simulated() {
        return Ok(device);
    }
    bail!(
        "{port} is a board with an electrode: add --arm, and hold the board's arm switch, to let it drive hundreds of \
         volts"
    )
}

/// The highest voltage of an experiment, in volts rms: the given one, which must be within the board's limit, or else
/// what the board allows, up to 150.
pub(super) fn highest_voltage(given_v_rms: Option<f64>, limits: &BoardLimits, tick_hz: u32) -> Result<f64> {
    let scene = Scene::parse(HIGHEST, "the drive", &BTreeMap::new())?;
    let limit_v_rms = compile(&scene, limits, tick_hz)?.reach.voltage_max_v_rms;
    match given_v_rms {
        None => Ok(limit_v_rms.min(VOLTAGE_MAX_V_RMS)),
        Some(volts) if volts <= limit_v_rms => Ok(volts),
        Some(found) => bail!(
            "--voltage {found} is above what this board drives, {limit_v_rms:.0} V rms: give at most that, or leave \
             --voltage out"
        ),
    }
}

/// Parses the highest voltage of an experiment.
pub(super) fn voltage(text: &str) -> Result<f64, String> {
    number(text, above_zero_to(VOLTAGE_MAX_V_RMS), "a voltage above 0, at most 150 V rms")
}

/// Adds to an error that ended a recording where its rows are, if it has any, with advice on how to keep them.
pub(super) fn cut_off(recording: &OutputFile, advice: &str, error: anyhow::Error) -> anyhow::Error {
    if recording.is_cut_off() {
        return anyhow!("{error}; what was recorded until then is in {}: {advice}", recording.partial().display());
    }
    error
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use frixel_hil_sim::Board;
    use frixel_lab::calibration::Protocol;
    use frixel_scene::{Scene, compile};

    use super::highest_voltage;

    #[test]
    fn a_board_plays_an_experiment_at_its_highest_voltage() {
        for board in [Board::SIMULATOR, Board::NUCLEO_G474RE, Board::PICO_2] {
            let highest_v_rms = highest_voltage(None, &board.limits, board.tick_hz).unwrap();
            let scene = Protocol::new(highest_v_rms, 1).scene().unwrap();
            let scene = Scene::parse(&scene, "calibration", &BTreeMap::new()).unwrap();
            compile(&scene, &board.limits, board.tick_hz).unwrap();
        }
    }
}
