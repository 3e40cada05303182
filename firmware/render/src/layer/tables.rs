//! What layers share and what does not fit into them. It belongs to a scene and stays as it was loaded.

use frixel_wire::scene::{POINTS_MAX, Point};
use heapless::Vec;

#[cfg(feature = "edge")]
use super::click::ClickNumber;
use super::click::{CLICKS_MAX, Click};
#[cfg(feature = "noise")]
use super::noise::{NOISES_MAX, Waves};

/// Room for points where there is something that uses them.
const POINTS_LEN: usize = if cfg!(any(feature = "polygon", feature = "speed")) { POINTS_MAX } else { 0 };

/// Points of polygons and curves, the waves of noises, and the clicks of edges and buttons.
pub(crate) struct Tables {
    points: Vec<Point, POINTS_LEN>,
    #[cfg(feature = "noise")]
    noises: Vec<Waves, NOISES_MAX>,
    clicks: Vec<Click, CLICKS_MAX>,
}

impl Tables {
    pub(crate) const fn new() -> Self {
        Self {
            points: Vec::new(),
            #[cfg(feature = "noise")]
            noises: Vec::new(),
            clicks: Vec::new(),
        }
    }

    pub(crate) fn clear(&mut self) {
        self.points.clear();
        #[cfg(feature = "noise")]
        self.noises.clear();
        self.clicks.clear();
    }

    /// Takes the points of a scene, as far as this firmware can use them.
    pub(crate) fn set_points(&mut self, points: impl Iterator<Item = Point>) {
        self.points.clear();
        self.points.extend(points.take(POINTS_LEN));
    }

    #[inline]
    pub(crate) fn points(&self) -> &[Point] {
        &self.points
    }

    #[cfg(feature = "noise")]
    #[inline]
    pub(super) fn noises(&self) -> &[Waves] {
        &self.noises
    }

    /// Keeps the waves of a noise and gives their number; the waves again when there is no room.
    #[cfg(feature = "noise")]
    pub(super) fn add_noise(&mut self, waves: Waves) -> Result<u8, Waves> {
        let number = self.noises.len() as u8;
        self.noises.push(waves).map(|()| number)
    }

    #[cfg(feature = "edge")]
    #[inline]
    pub(super) fn clicks(&self) -> &[Click] {
        &self.clicks
    }

    /// Keeps a click and gives its number; the click again when there is no room.
    #[cfg(feature = "edge")]
    pub(super) fn add_click(&mut self, click: Click) -> Result<ClickNumber, Click> {
        let number = self.clicks.len() as u8;
        self.clicks.push(click).map(|()| ClickNumber(number))
    }
}
