//! The real board that `--board` and `--series-kohm` describe.

use anyhow::Result;
use frixel_hil_sim::Board;
use frixel_session::store::check_touched_board;
use frixel_wire::hello::BoardKind;

use super::error::at;

/// The board, behind another series resistance if one is given.
pub(super) fn behind(board: Board, series_kohm: Option<f64>) -> Result<Board> {
    let Some(series_kohm) = series_kohm else { return Ok(board) };
    let board = board.behind(1e3 * series_kohm as f32);
    check_touched_board(&board.limits)
        .map_err(at(format!("no firmware accepts a series resistance of {series_kohm} kOhm")))?;
    Ok(board)
}

/// The largest voltage that the board allows until limits are stored, if that is less than its own.
pub(super) fn until_measured(board: &Board) -> Option<String> {
    let v_peak = board.until_measured_v_peak()?;
    let (when, page) = match board.kind {
        BoardKind::NucleoG474re => ("until bring-up has stored limits", "hardware.md"),
        _ => ("until limits are stored, which nothing does on this board yet,", "pico.md"),
    };
    Some(format!("{when} it allows {v_peak} V peak (docs/board/{page})"))
}
