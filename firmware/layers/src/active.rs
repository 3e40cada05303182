//! The layers of a scene as the tick evaluates them.

use frixel_wire::message::Refusal;
use frixel_wire::scene::RECORDS_MAX;
use heapless::Vec;

use crate::bitmap_pool::{BitmapPool, StoredBitmap};
use crate::blend::Blend;
use crate::clicks::Clicks;
use crate::context::{Context, Inputs};
use crate::grid::{Cell, Grid, LayerSet};
use crate::header::Header;
use crate::kinds::Coefficients;
use crate::point::Point;
use crate::prepare::Preparation;
use crate::record::Record;
use crate::region::ActiveRegion;
use crate::tables::Tables;

/// The layers of one scene. Everything that is constant during a play is precomputed.
///
/// [`ActiveLayers::begin`] starts a scene, and [`ActiveLayers::push`] adds its layers one by one.
#[repr(C)]
pub struct ActiveLayers {
    /// The enabled layers.
    on: LayerSet,
    grid: Grid,
    layers: Vec<ActiveLayer, RECORDS_MAX>,
    tables: Tables,
}

impl ActiveLayers {
    /// No layers.
    pub const EMPTY: Self = Self { on: [0; 2], grid: Grid::EMPTY, layers: Vec::new(), tables: Tables::new() };

    /// Removes all layers.
    pub fn clear(&mut self) {
        // Clear each field instead of copying an empty value of thousands of bytes, since a tick may be waiting.
        self.layers.clear();
        self.tables.clear();
        self.on = [0; 2];
    }

    /// Removes all layers, and begins a scene with this header and these points.
    pub fn begin(&mut self, header: &Header, points: impl Iterator<Item = Point>) {
        self.clear();
        self.grid.reset(header.screen_width_m, header.screen_height_m);
        self.tables.set_points(points);
    }

    /// Checks the next record, computes its coefficients and enables the layer. `find_bitmap` finds a bitmap in the
    /// pool by its CRC-32.
    pub fn push(
        &mut self,
        record: &Record,
        tick_hz: u32,
        find_bitmap: &dyn Fn(u32) -> Option<StoredBitmap>,
    ) -> Result<(), Refusal> {
        let number = self.layers.len() as u8;
        record.check(self.tables.points(), number).map_err(Refusal::Config)?;
        let mut preparation = Preparation { tick_hz, find_bitmap, tables: &mut self.tables };
        let layer = ActiveLayer::new(record, number, &mut preparation)?;
        // There is room: a scene has at most `RECORDS_MAX` records.
        let _ = self.layers.push(layer);
        self.grid.add(number, &record.region, self.tables.points());
        self.put(number, true);
        Ok(())
    }

    /// The points of polygons and curves.
    pub fn points(&self) -> &[Point] {
        self.tables.points()
    }

    /// The cells of the screen, row by row, with the layers that may act in each.
    pub fn cells(&self) -> impl Iterator<Item = Cell> {
        self.grid.cells()
    }

    /// Whether a layer plays the host's stream.
    #[inline]
    pub fn has_stream(&self) -> bool {
        self.layers.iter().any(ActiveLayer::is_streamed)
    }

    /// Enables or disables a layer, and sets its gain, from `tick` on. Unknown layer numbers are ignored.
    pub fn set(&mut self, number: u8, on: bool, gain: f32, tick: u32) {
        let was_on = self.is_on(number);
        if let Some(layer) = self.layers.get_mut(usize::from(number)) {
            layer.gain = gain;
            if on && !was_on {
                layer.coefficients.begin(tick);
            }
            self.put(number, on);
        }
    }

    /// Electric friction of all enabled layers, in N.
    #[inline]
    pub fn electric_friction_n(&self, inputs: &Inputs, pool: &BitmapPool, clicks: &mut Clicks) -> f32 {
        let context = &mut Context { inputs, pool, tables: &self.tables, clicks };
        let [x_m, y_m] = inputs.place_m;
        let [on, others_on] = self.on;
        let [near, others_near] = self.grid.at(x_m, y_m);
        #[cfg(feature = "edge")]
        if !self.tables.clicks().is_empty() {
            context.clicks.begin();
        }
        let below_n = self.blend(0, on & near, 0.0, context);
        let others = others_on & others_near;
        if others == 0 { below_n } else { self.blend(u32::BITS, others, below_n, context) }
    }

    /// Blends the layers in `set` over the friction below. `set` has a bit for each of 32 layers, starting with number
    /// `first`.
    #[inline]
    fn blend(&self, first: u32, mut set: u32, below_n: f32, context: &mut Context) -> f32 {
        let mut electric_friction_n = below_n;
        while set != 0 {
            let number = set.trailing_zeros();
            set &= set - 1;
            if let Some(layer) = self.layers.get((first + number) as usize) {
                electric_friction_n = layer.blend_over(electric_friction_n, context);
            }
        }
        electric_friction_n
    }

    fn is_on(&self, number: u8) -> bool {
        let [first, others] = self.on;
        let word = if u32::from(number) < u32::BITS { first } else { others };
        word & (1 << (u32::from(number) % u32::BITS)) != 0
    }

    fn put(&mut self, number: u8, on: bool) {
        let [first, others] = &mut self.on;
        let word = if u32::from(number) < u32::BITS { first } else { others };
        let bit = 1 << (u32::from(number) % u32::BITS);
        *word = if on { *word | bit } else { *word & !bit };
    }
}

/// Bytes of memory for a record: its layer and its part of the tables, without its points.
pub fn active_bytes(record: &Record) -> usize {
    size_of::<ActiveLayer>() + record.layer.table_bytes()
}

/// A layer, ready to be evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ActiveLayer {
    region: ActiveRegion,
    join: Join,
    gain: f32,
    coefficients: Coefficients,
}

/// How a layer is combined with the layers below.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u8)]
enum Join {
    Blend(Blend),
    /// Faded with the weight of the host's stream.
    Fade(Blend),
}

impl ActiveLayer {
    /// Computes the layer of record `number`, which has been checked.
    pub(crate) fn new(record: &Record, number: u8, preparation: &mut Preparation) -> Result<Self, Refusal> {
        let region = ActiveRegion::new(&record.region).ok_or(Refusal::FeatureDisabled { layer: number })?;
        let coefficients = record.layer.prepare(number, preparation)?;
        let join = if record.layer.is_streamed() { Join::Fade(record.blend) } else { Join::Blend(record.blend) };
        Ok(Self { region, join, gain: record.gain, coefficients })
    }

    fn is_streamed(&self) -> bool {
        matches!(self.join, Join::Fade(_))
    }

    /// Combines this layer's electric friction with that of the layers below.
    #[inline]
    pub(crate) fn blend_over(&self, below_n: f32, context: &mut Context) -> f32 {
        if !self.region.contains(context) {
            return below_n;
        }
        let own_n = self.gain * self.coefficients.electric_friction_n(&self.region, context);
        match self.join {
            Join::Blend(blend) => blend.of(below_n, own_n),
            Join::Fade(blend) => below_n + context.inputs.stream.weight * (blend.of(below_n, own_n) - below_n),
        }
    }
}
