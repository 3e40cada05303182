//! Compiles layers to records of the compiled scene.

pub(crate) mod place;

use frixel_layers::{Header, Layer as RecordLayer, Point, Record, Region as RecordRegion};
use frixel_wire::scene::POINTS_MAX;

use super::file::Scene;
use super::kinds::{Bitmap as BitmapWords, Lowered};
use super::layer::{Above, Amount, Layer, Rectangle, Region};
use super::log::Log;
use super::mistake::FitMistake;
use super::pool::{Placed, Pool, Unplaced};
use super::program::Bitmap;
use super::reach::Reach;
use super::warning::Warning;

/// Relative tolerance for total friction that equals natural friction, which is rounded to `f32`.
const NATURAL_ROUNDING: f64 = 1e-6;
pub(crate) const MM: f64 = 1e-3;
/// Number of times that a draft may double a picture's pitch to make it fit.
const COARSER_MAX: u32 = 5;

/// Compiles layers to records, and collects the points and bitmaps that they refer to.
pub(crate) struct Lowering<'a, 's> {
    scene: &'a Scene,
    header: &'a Header,
    reach: &'a Reach,
    pub(crate) tick_hz: u32,
    pool: Pool,
    points: Vec<Point>,
    pub(crate) noises: usize,
    pub(crate) clicks: usize,
    log: &'a mut Log<'s>,
}

impl<'a, 's> Lowering<'a, 's> {
    pub(super) fn new(
        scene: &'a Scene,
        header: &'a Header,
        reach: &'a Reach,
        tick_hz: u32,
        pool: Pool,
        log: &'a mut Log<'s>,
    ) -> Self {
        Self { scene, header, reach, tick_hz, pool, points: Vec::new(), noises: 0, clicks: 0, log }
    }

    /// The points and bitmaps that records refer to.
    pub(super) fn finish(self) -> (Vec<Point>, Vec<Bitmap>) {
        (self.points, self.pool.bitmaps)
    }

    /// Number of mistakes so far.
    pub(super) fn mistakes(&self) -> usize {
        self.log.mistakes()
    }

    /// Compiles a layer to a record; `None` if it has a mistake.
    pub(super) fn record(&mut self, layer: &Layer) -> Option<Record> {
        self.log.set_layer(Some(layer.number().table));
        let record = self.lower(layer);
        self.log.set_layer(None);
        record
    }

    fn lower(&mut self, layer: &Layer) -> Option<Record> {
        let Lowered { layer: record_layer, outline } = layer.kind.lower(layer, self)?;
        let region = match layer.region.clone().or(outline) {
            Some(region) => {
                place::check_on_screen(self.scene, layer, region.bounds(), self.log);
                self.region(layer, &region, &record_layer)?
            }
            None => RecordRegion::Screen,
        };
        Some(Record { region, blend: layer.blend, gain: layer.gain as f32, layer: record_layer })
    }

    /// Adds a warning, unless the layer is a copy that repeats it.
    pub(crate) fn warn(&mut self, layer: &Layer, warning: Option<Warning>) {
        if let Some(warning) = warning.filter(|_| !layer.is_copy) {
            self.log.warn_about(layer, warning);
        }
    }

    /// Adds the picture of a layer to the pool. `visible` is the visible part of the picture.
    pub(crate) fn place_bitmap(
        &mut self,
        layer: &Layer,
        bitmap: &BitmapWords,
        visible: Option<Rectangle>,
    ) -> Option<Placed> {
        let picture = layer.places.field("picture");
        match self.pool.place(layer, bitmap, visible, self.log) {
            Ok(placed) => Some(placed),
            Err(Unplaced::Reported) => None,
            Err(Unplaced::Unusable(mistake)) => {
                self.log.add(picture, mistake);
                None
            }
            Err(Unplaced::PoolTooSmall { needed_bytes, pool_bytes, mut pitch_mm }) => {
                let offset = if layer.places.has("pitch_mm") { layer.places.field("pitch_mm") } else { picture };
                self.log.add(offset, FitMistake::PoolTooSmall { needed_bytes, pool_bytes, pitch_mm });
                // A draft plays a coarser picture.
                let mut coarser = bitmap.clone();
                (0..COARSER_MAX).find_map(|_| {
                    coarser.pitch_mm = Some(pitch_mm);
                    pitch_mm *= 2.0;
                    self.pool.place(layer, &coarser, visible, self.log).ok()
                })
            }
        }
    }

    /// An amount of the compiled scene: electric friction in newtons, or a factor.
    pub(crate) fn amount(&self, layer: &Layer, amount: Amount) -> f32 {
        match amount {
            Amount::Newtons(friction_n) => electric_n(layer.above, friction_n, self.reach.natural_friction_n),
            Amount::Fraction(fraction) => (fraction * self.reach.electric_friction_max_n) as f32,
            Amount::Factor(factor) => factor as f32,
        }
    }

    fn region(&mut self, layer: &Layer, region: &Region, record_layer: &RecordLayer) -> Option<RecordRegion> {
        Some(match region {
            Region::Rectangle(rectangle) => {
                let button = matches!(record_layer, RecordLayer::Button(_));
                place::rectangle(*rectangle, self.header, button)
            }
            Region::Ellipse(rectangle) => place::ellipse(*rectangle, self.header),
            Region::Polygon(vertices) => {
                let point = |(x_mm, y_mm): &(f64, f64)| Point { x: (x_mm * MM) as f32, y: (y_mm * MM) as f32 };
                let (first, count) = self.points(layer, vertices.iter().map(point).collect())?;
                RecordRegion::Polygon { first, count }
            }
        })
    }

    /// Stores points, or reuses equal ones of another layer.
    pub(crate) fn points(&mut self, layer: &Layer, points: Vec<Point>) -> Option<(u8, u8)> {
        let count = points.len();
        let first = self.points.windows(count).position(|held| held == points).unwrap_or(self.points.len());
        if first == self.points.len() {
            self.points.extend(points);
        }
        self.limit(layer, "points of polygons and curves", self.points.len(), POINTS_MAX)?;
        Some((first as u8, count as u8))
    }

    pub(crate) fn limit(&mut self, layer: &Layer, what: &'static str, number: usize, max: usize) -> Option<()> {
        if number > max {
            self.log.add(layer.places.table(), FitMistake::TooMany { what, number, max });
            return None;
        }
        Some(())
    }
}

/// Friction above natural friction.
fn electric_n(above: Above, friction_n: f64, natural_friction_n: f64) -> f32 {
    let electric_n = match above {
        Above::Natural => friction_n,
        Above::Zero => friction_n - natural_friction_n,
    };
    let rounding = above == Above::Zero && electric_n.abs() <= NATURAL_ROUNDING * natural_friction_n;
    if rounding { 0.0 } else { electric_n as f32 }
}
