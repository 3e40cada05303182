//! Coefficients that do not fit into a layer, or are shared by layers. They belong to a scene and are constant during a
//! play.

use frixel_wire::scene::POINTS_MAX;
use heapless::Vec;

use crate::clicks::{CLICKS_MAX, ClickCoefficients, ClickNumber};
#[cfg(feature = "noise")]
use crate::noise_waves::Waves;
use crate::point::Point;

/// Largest number of noise layers in a scene.
pub const NOISES_MAX: usize = if cfg!(feature = "noise") { 8 } else { 0 };
/// Capacity for points; 0 if no enabled feature uses them.
const POINTS_LEN: usize = if cfg!(any(feature = "polygon", feature = "speed")) { POINTS_MAX } else { 0 };

/// Points of polygons and curves, the waves of noises, and the clicks of edges and buttons.
pub(crate) struct Tables {
    points: Vec<Point, POINTS_LEN>,
    #[cfg(feature = "noise")]
    noises: Vec<Waves, NOISES_MAX>,
    clicks: Vec<ClickCoefficients, CLICKS_MAX>,
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

    /// Sets the points of a scene, if an enabled feature uses them.
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
    pub(crate) fn noises(&self) -> &[Waves] {
        &self.noises
    }

    /// Adds the waves of a noise and returns their number; returns the waves as an error if there is no room.
    #[cfg(feature = "noise")]
    pub(crate) fn add_noise(&mut self, waves: Waves) -> Result<u8, Waves> {
        let number = self.noises.len() as u8;
        self.noises.push(waves).map(|()| number)
    }

    #[cfg_attr(not(feature = "edge"), allow(dead_code, reason = "only edges and buttons click"))]
    #[inline]
    pub(crate) fn clicks(&self) -> &[ClickCoefficients] {
        &self.clicks
    }

    /// Adds a click and returns its number; returns the click as an error if there is no room.
    #[cfg_attr(not(feature = "edge"), allow(dead_code, reason = "only edges and buttons click"))]
    pub(crate) fn add_click(&mut self, click: ClickCoefficients) -> Result<ClickNumber, ClickCoefficients> {
        let number = self.clicks.len() as u8;
        self.clicks.push(click).map(|()| ClickNumber(number))
    }
}
