//! Reports of the touch source to a board that ticks on its own timer.

use frixel_session::Touch;

use crate::words::{put_touch, take_touch, touch_kind};

/// Number of words of a [`StampedTouch`]. A lift leaves the last three unused.
pub const STAMPED_TOUCH_WORDS: usize = 5;

/// A report, and the tick to which its age refers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StampedTouch {
    /// Tick at which the report should have arrived.
    pub tick: u32,
    /// The report.
    pub touch: Touch,
}

impl StampedTouch {
    /// Encodes `self`: calls `put` for each word.
    pub fn write(&self, mut put: impl FnMut(u32)) {
        put(self.tick);
        put(touch_kind(Some(self.touch)));
        put_touch(Some(self.touch), &mut put);
    }

    /// Decodes a report: calls `take` for each word. `None` when the words are not a valid report.
    pub fn read(mut take: impl FnMut() -> u32) -> Option<Self> {
        let tick = take();
        let kind = take();
        take_touch(kind, &mut take).map(|touch| Self { tick, touch })
    }

    /// The report as it arrives at `now_tick`, with its delay added to its age.
    pub fn at(&self, now_tick: u32) -> Touch {
        match self.touch {
            Touch::Down { x_m, y_m, age_ticks } => {
                let late_ticks = (now_tick.wrapping_sub(self.tick) as i32).max(0) as u32;
                Touch::Down { x_m, y_m, age_ticks: age_ticks + late_ticks }
            }
            Touch::Up => Touch::Up,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_that_comes_late_is_older() {
        let report = StampedTouch { tick: 1000, touch: Touch::Down { x_m: 0.01, y_m: 0.02, age_ticks: 400 } };
        let mut words = Vec::new();
        report.write(|word| words.push(word));
        assert_eq!(words.len(), STAMPED_TOUCH_WORDS);
        let mut words = words.into_iter();
        let report = StampedTouch::read(|| words.next().unwrap()).unwrap();
        assert_eq!(report.at(1030), Touch::Down { x_m: 0.01, y_m: 0.02, age_ticks: 430 });
        assert_eq!(report.at(990), Touch::Down { x_m: 0.01, y_m: 0.02, age_ticks: 400 });
    }
}
