//! Legends: the names of series beside samples of their style.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::style::{LABEL, Scale, text_width};
use super::{Area, DrawError, Drawn, Line, Look, Mark, Series};

/// Height of a line, in pixels.
const LINE_HEIGHT: u32 = 20;
/// Width of the sample before a name, of the gap after it, and of the gap between columns, in pixels.
const SAMPLE: u32 = 30;
const GAP: u32 = 8;
const COLUMN_GAP: u32 = 24;
/// Distance of a legend from the left edge, in pixels.
const LEFT: u32 = 30;

/// Names and styles, in order.
#[derive(Clone, Debug)]
pub(super) struct Legend(Vec<(String, Look)>);

impl Legend {
    /// The legend of all series with a name.
    pub(super) fn of(series: &[Series]) -> Self {
        let named = series.iter().filter(|series| !series.name.is_empty());
        Self(named.map(|series| (series.name.clone(), series.look)).collect())
    }

    /// Height of the legend for a given width, both in pixels.
    pub(super) fn height(&self, width: u32) -> Result<u32, DrawError> {
        Ok(self.lines(width)? as u32 * LINE_HEIGHT)
    }

    fn columns(&self, width: u32) -> Result<usize, DrawError> {
        let mut longest = 0;
        for (name, _) in &self.0 {
            longest = longest.max(text_width(name, LABEL)?);
        }
        let columns = (width - LEFT) / (SAMPLE + GAP + COLUMN_GAP + longest);
        Ok((columns as usize).clamp(1, self.0.len().max(1)))
    }

    fn lines(&self, width: u32) -> Result<usize, DrawError> {
        Ok(self.0.len().div_ceil(self.columns(width)?))
    }

    /// Draws the legend below `top`, in pixels, column by column.
    pub(super) fn draw<DB: DrawingBackend>(&self, area: &Area<DB>, top: u32, width: u32, scale: Scale) -> Drawn {
        let (columns, lines) = (self.columns(width)?, self.lines(width)?);
        let column_width = (width - LEFT) / columns as u32;
        for (index, (name, look)) in self.0.iter().enumerate() {
            let (column, line) = ((index / lines) as u32, (index % lines) as u32);
            let left = LEFT + column * column_width;
            let middle = scale.px(top + line * LINE_HEIGHT + LINE_HEIGHT / 2) as i32;
            draw_sample(area, (scale.px(left) as i32, middle), look, scale)?;
            let place = (scale.px(left + SAMPLE + GAP) as i32, middle);
            area.draw(&Text::new(name.as_str(), place, scale.letters_at(LABEL, HPos::Left)))?;
        }
        Ok(())
    }
}

/// Draws a short sample of a style, to the right of the point.
fn draw_sample<DB: DrawingBackend>(area: &Area<DB>, (left, y): (i32, i32), look: &Look, scale: Scale) -> Drawn {
    let right = left + scale.px(SAMPLE) as i32;
    let half = scale.px(6) as i32;
    let line = match look.line {
        Line::Filled(_) => vec![(left, y - half), (right, y - half), (right, y + half), (left, y + half)],
        _ => vec![(left, y), (right, y)],
    };
    scale.draw_line(area, &line, look)?;
    if look.mark == Mark::None { Ok(()) } else { scale.draw_mark(area, (left.midpoint(right), y), look) }
}
