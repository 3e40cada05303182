//! Legends: what the looks mean.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::plot::{draw_line, draw_mark};
use super::{Area, Drawn, FAMILY, Line, Look, Mark, Panel, Series, px};

/// Height of a line.
const LINE_HEIGHT: u32 = 20;
/// What an entry takes: about so much for each character, and for what stands before the name.
const CHARACTER_WIDTH: u32 = 7;
const BEFORE_NAME: u32 = 58;
/// Where a legend begins.
const LEFT: u32 = 30;

/// Names and looks, in order.
#[derive(Clone, Debug, Default)]
pub(super) struct Legend(Vec<(String, Look)>);

impl Legend {
    /// Of series that have a name.
    pub(super) fn of(series: &[Series]) -> Self {
        let named = series.iter().filter(|series| !series.name.is_empty());
        Self(named.map(|series| (series.name.clone(), series.look)).collect())
    }

    /// Of all panels, each name once.
    pub(super) fn of_all(panels: &[Panel]) -> Self {
        let mut all = Self::default();
        for (name, look) in panels.iter().flat_map(|panel| Self::of(&panel.series).0) {
            if !all.0.iter().any(|(known, _)| *known == name) {
                all.0.push((name, look));
            }
        }
        all
    }

    /// What it takes in a width.
    pub(super) fn height(&self, width: u32) -> u32 {
        self.lines(width) as u32 * LINE_HEIGHT
    }

    fn columns(&self, width: u32) -> usize {
        let longest = self.0.iter().map(|(name, _)| name.chars().count() as u32).max().unwrap_or(0);
        let columns = (width - LEFT) / (BEFORE_NAME + CHARACTER_WIDTH * longest);
        (columns as usize).clamp(1, self.0.len().max(1))
    }

    fn lines(&self, width: u32) -> usize {
        self.0.len().div_ceil(self.columns(width))
    }
}

/// Draws a legend into a width from a corner, column after column.
pub(super) fn draw(area: &Area, legend: &Legend, (x, y): (u32, u32), width: u32) -> Drawn {
    let (columns, lines) = (legend.columns(width), legend.lines(width));
    let entry_width = (width - LEFT) / columns as u32;
    let style = (FAMILY, px(15)).into_font().color(&BLACK).pos(Pos::new(HPos::Left, VPos::Center));
    for (index, (name, look)) in legend.0.iter().enumerate() {
        let (column, line) = ((index / lines) as u32, (index % lines) as u32);
        let left = px(x + LEFT + column * entry_width) as i32;
        let middle = px(y + line * LINE_HEIGHT + LINE_HEIGHT / 2) as i32;
        let end = left + px(30) as i32;
        if look.line != Line::None {
            draw_line(area, &[(left, middle), (end, middle)], look)?;
        }
        if look.mark != Mark::None {
            draw_mark(area, (left.midpoint(end), middle), look)?;
        }
        area.draw(&Text::new(name.clone(), (end + px(8) as i32, middle), style.clone()))?;
    }
    Ok(())
}
