//! Friction of each kind of layer by the definitions of `docs/design/scenes.md`, in mm, mN and seconds.

use std::f64::consts::TAU;

use frixel_scene::Bitmap;

/// A finger at a tick: mm, s, mm/s.
#[derive(Clone, Copy)]
pub struct At {
    pub x: f64,
    pub y: f64,
    pub t: f64,
    pub speed: f64,
}

/// What an evaluation may need beyond the moment.
pub struct Expected<'a> {
    /// The most that the drive adds, mN.
    pub range: f64,
    /// The scene's picture as it was resampled.
    pub picture: Option<&'a Bitmap>,
    before: Option<bool>,
    clicked_at: Option<f64>,
}

impl<'a> Expected<'a> {
    pub fn new(range: f64, picture: Option<&'a Bitmap>) -> Self {
        Self { range, picture, before: None, clicked_at: None }
    }

    /// A click of so many mN that takes so many seconds, from when this becomes another than it was.
    pub fn click_on_change(&mut self, now: bool, at: At, height: f64, takes: f64) -> f64 {
        if self.before.is_some_and(|before| before != now) {
            self.clicked_at = Some(at.t);
        }
        self.before = Some(now);
        self.click(at, height, takes)
    }

    /// The same from when this becomes true.
    pub fn click_on_entry(&mut self, now: bool, at: At, height: f64, takes: f64) -> f64 {
        if self.before == Some(false) && now {
            self.clicked_at = Some(at.t);
        }
        self.before = Some(now);
        if now { self.click(at, height, takes) } else { 0.0 }
    }

    fn click(&self, at: At, height: f64, takes: f64) -> f64 {
        self.clicked_at.map_or(0.0, |clicked| height * (1.0 - (at.t - clicked) / takes).max(0.0).powi(2))
    }

    /// Level of the picture from 0 to 1 at a place in samples from its corner: a tent about every sample's centre.
    /// `tiled` makes the tents of the first and last samples neighbours, else they go on beyond the border.
    pub fn level(&self, u: f64, v: f64, tiled: bool) -> f64 {
        let picture = self.picture.unwrap();
        let (width, height) = (usize::from(picture.width), usize::from(picture.height));
        let tents = |place: f64, count: usize| -> Vec<(usize, f64)> {
            let count_f = count as f64;
            let place = if tiled { place.rem_euclid(count_f) } else { place.clamp(0.5, count_f - 0.5) };
            let tent = |index: usize| {
                let mut away = (place - 0.5 - index as f64).abs();
                if tiled {
                    away = away.min(count_f - away);
                }
                (1.0 - away).max(0.0)
            };
            (0..count).map(|index| (index, tent(index))).filter(|(_, weight)| *weight > 0.0).collect()
        };
        let columns = tents(u, width);
        let mut level = 0.0;
        for (row, down) in tents(v, height) {
            for (column, right) in &columns {
                level += down * right * f64::from(picture.samples[row * width + column]) / 255.0;
            }
        }
        level
    }
}

/// A hill of height 1 and of this width about 0.
pub fn hill(away: f64, width: f64) -> f64 {
    if away.abs() < width / 2.0 { 0.5 + 0.5 * (TAU * away / width).cos() } else { 0.0 }
}
