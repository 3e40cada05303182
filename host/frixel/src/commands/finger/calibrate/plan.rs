//! A calibration, played on a board.

use std::io::Write;
use std::time::Duration;

use anyhow::{Result, bail};
use frixel_driver::{Device, ignore_progress};
use frixel_felt::recorder::{FeltRow, Recorder};
use frixel_lab::calibration::{BoardRow, Protocol, VOLTAGE_MAX_V_RMS, write_board};
use frixel_play::{Feed, Player};
use frixel_scene::{Program, Scene, compile};
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::{TELEMETRY_MAX_HZ, telemetry_period_ticks};
use indicatif::{ProgressBar, ProgressStyle};

use super::CalibrateArgs;
use crate::commands::argument::{above_zero_to, number};
use crate::commands::error::of_finger;
use crate::commands::interrupt::Interrupt;
use crate::commands::terminal::{note, say};
use crate::rigs::RecordedLink;
use crate::scene_file::ProfileNames;
use frixel_files::OutputFile;

/// Rows a second of the recording.
pub(super) const ROW_HZ: u32 = TELEMETRY_MAX_HZ;

/// Ticks between two rows, and between two telemetry messages of a board at a port.
pub(super) fn row_ticks(tick_hz: u32) -> u32 {
    telemetry_period_ticks(tick_hz, ROW_HZ)
}

/// A protocol that is ready to play on a board.
pub(super) struct Plan {
    pub(super) protocol: Protocol,
    program: Program,
    limits: BoardLimits,
    tick_hz: u32,
}

impl Plan {
    pub(super) fn new(args: &CalibrateArgs, limits: &BoardLimits, tick_hz: u32) -> Result<Self> {
        let voltage_max_v_rms = highest_voltage(args.voltage, limits, tick_hz)?;
        let protocol = Protocol { strokes: args.strokes.into(), ..Protocol::new(voltage_max_v_rms, args.seed) };
        let scene = protocol.scene().map_err(of_finger)?;
        let scene = Scene::parse(&scene, "calibration", &std::collections::BTreeMap::new())?;
        Ok(Self { program: compile(&scene, limits, tick_hz)?, protocol, limits: *limits, tick_hz })
    }

    /// Prints the plan.
    pub(super) fn say(&self, recording: &OutputFile) -> Result<()> {
        let words = self.protocol.words();
        words.lines().try_for_each(|line| say(recording, format_args!("  {:<16} {line}", "plan")))
    }

    /// Starts to play the protocol.
    pub(super) fn start<L: RecordedLink>(&self, device: Device<L>, telemetry_ticks: u32) -> Result<Player<L>> {
        let ticks = (self.protocol.duration_s() * f64::from(self.tick_hz)) as u64;
        let recorder = Recorder::new(&self.program, &self.limits, self.tick_hz, ticks, row_ticks(self.tick_hz));
        let mut player = Player::recording(device, recorder.map_err(of_finger)?);
        player.start(self.program.clone(), telemetry_ticks, &mut ignore_progress)?;
        let samples = self.protocol.samples().map_err(of_finger)?;
        player.stream(Feed::of(samples, self.protocol.sample_hz()))?;
        Ok(player)
    }

    /// Plays to the end, and returns the board's reports. Also writes them to `partial` as they arrive.
    pub(super) fn play<L: RecordedLink>(
        &self,
        player: &mut Player<L>,
        interrupt: &Interrupt,
        time_max: Duration,
        partial: &mut dyn Write,
    ) -> Result<Vec<BoardRow>> {
        let mut rows = Vec::new();
        write_board(&mut *partial, None)?;
        let bar = ProgressBar::new(self.protocol.strokes as u64);
        let style = ProgressStyle::with_template("  stroke {pos} of {len}: {msg}  {bar:30}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        let mut left = time_max;
        while !left.is_zero() && player.recorder_mut().ticks_left() > 0 {
            if interrupt.is_requested() {
                player.stop()?;
                bail!("the run was interrupted: start it again");
            }
            let stepped = player.step(left);
            let written = rows.len();
            rows.extend(board_rows(player));
            write_board(&mut *partial, rows.get(written..))?;
            left = left.saturating_sub(stepped?);
            let stroke = (player.recorder_mut().t_s() / (self.protocol.stroke_s + self.protocol.pause_s)) as u64;
            bar.set_position((stroke + 1).min(self.protocol.strokes as u64));
            bar.set_message(if stroke.is_multiple_of(2) { "to the right" } else { "to the left" });
        }
        player.stop()?;
        bar.finish_and_clear();
        let stream = player.device().stream_status();
        if let Some(status) = stream.filter(|status| status.underruns > 0) {
            note(format_args!(
                "the board ran out of samples {} times; its output was zero meanwhile",
                status.underruns
            ));
        }
        rows.extend(board_rows(player));
        Ok(rows)
    }
}

/// Parses the highest voltage of a calibration.
pub(super) fn voltage(text: &str) -> Result<f64, String> {
    number(text, above_zero_to(VOLTAGE_MAX_V_RMS), "a voltage above 0, at most 150 V rms")
}

/// The highest voltage of a calibration, in volts rms: the given one, which must be within the board's limit, or else
/// what the board allows, up to 150.
fn highest_voltage(given_v_rms: Option<f64>, limits: &BoardLimits, tick_hz: u32) -> Result<f64> {
    let limit_v_rms = ProfileNames::default().without_scene(limits, tick_hz)?.reach.voltage_max_v_rms;
    match given_v_rms {
        None => Ok(limit_v_rms.min(VOLTAGE_MAX_V_RMS)),
        Some(volts) if volts <= limit_v_rms => Ok(volts),
        Some(found) => bail!(
            "--voltage {found} is above what this board drives, {limit_v_rms:.0} V rms: give at most that, or leave \
             --voltage out"
        ),
    }
}

/// The board's reports since the last call.
fn board_rows<L: RecordedLink>(player: &mut Player<L>) -> impl Iterator<Item = BoardRow> {
    let row = |row: FeltRow| {
        let (time_s, speed_mm_s) = (row.t_s, row.speed_mm_s.unwrap_or(0.0));
        Some(BoardRow { time_s, voltage_v_rms: row.voltage_v_rms?, speed_mm_s })
    };
    player.recorder_mut().take_rows().into_iter().filter_map(row)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use frixel_hil_sim::Board;
    use frixel_lab::calibration::Protocol;
    use frixel_scene::{Scene, compile};

    use super::highest_voltage;

    #[test]
    fn a_board_plays_a_calibration_at_its_highest_voltage() {
        for board in [Board::SIMULATOR, Board::NUCLEO_G474RE, Board::PICO_2] {
            let highest_v_rms = highest_voltage(None, &board.limits, board.tick_hz).unwrap();
            let scene = Protocol::new(highest_v_rms, 1).scene().unwrap();
            let scene = Scene::parse(&scene, "calibration", &BTreeMap::new()).unwrap();
            compile(&scene, &board.limits, board.tick_hz).unwrap();
        }
    }
}
