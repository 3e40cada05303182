//! What a scene costs the tick, in instructions on a Cortex-M4F. Compiler and board go by the same numbers, so that what
//! the one accepts the other takes.

mod measured;

use super::{Beat, Carrier, Cell, Grid, Header, Layer, Point, RECORDS_MAX, Record, Region, Wave};
use measured as m;

/// Most instructions that a tick may take. A scene that would take more at any place is refused.
pub const TICK_INSTRUCTIONS_MAX: u32 = 600;

/// The place of a scene at which a tick takes most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Instructions of the longest tick: no tick there takes more.
    pub instructions: u32,
    /// A cell of the grid that it is in.
    pub cell: Cell,
}

impl Worst {
    /// No place: where every search begins.
    pub const NOWHERE: Self = Self { instructions: 0, cell: Cell { x_m: 0.0, y_m: 0.0, layers: [0; 2] } };
}

/// Instructions that the layers of a scene add to a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerCosts {
    layers: [u32; RECORDS_MAX],
    /// Wherever the finger is.
    everywhere: u32,
}

impl LayerCosts {
    /// No layer.
    pub const NONE: Self = Self { layers: [0; RECORDS_MAX], everywhere: 0 };

    /// Adds layer number `number`; `points` are the scene's.
    pub fn add(&mut self, number: u8, record: &Record, points: &[Point]) {
        if let Some(cost) = self.layers.get_mut(usize::from(number)) {
            *cost = of_record(record, points);
        }
        if matches!(record.layer, Layer::Stream { .. }) {
            // There is one stream, however many layers play it.
            self.everywhere = m::STREAM_ELSEWHERE;
        }
    }
}

/// Instructions that a layer adds to a tick with the finger in its region, or near it; `points` are the scene's.
pub fn of_record(record: &Record, points: &[Point]) -> u32 {
    of_region(&record.region, points) + of_layer(&record.layer)
}

/// Instructions of a tick that looks at layers and finds none under the finger.
pub const fn of_empty_scene(header: &Header) -> u32 {
    match header.carrier {
        Carrier::Square => m::EMPTY,
        Carrier::Sine => m::EMPTY + m::SINE_CARRIER,
    }
}

/// Where a scene takes most, from its grid and the costs of its layers.
pub fn worst(header: &Header, grid: &Grid, costs: &LayerCosts) -> Worst {
    worst_of_cells(header, grid.cells(), costs, Worst::NOWHERE)
}

/// [`worst`] of some cells of the grid and of those before, whose worst is `so_far`.
pub fn worst_of_cells(header: &Header, cells: impl Iterator<Item = Cell>, costs: &LayerCosts, so_far: Worst) -> Worst {
    cells.fold(so_far, |worst, cell| {
        let here = (0..).zip(&costs.layers).filter(|(number, _)| cell.has(*number)).map(|(_, cost)| cost);
        let instructions = of_empty_scene(header) + costs.everywhere + here.sum::<u32>();
        if instructions > worst.instructions { Worst { instructions, cell } } else { worst }
    })
}

/// [`worst`] of a whole scene.
pub fn worst_of_scene(header: &Header, records: &[Record], points: &[Point]) -> Worst {
    let mut grid = Grid::EMPTY;
    grid.reset(header.screen_width_m, header.screen_height_m);
    let mut costs = LayerCosts::NONE;
    for (number, record) in (0..).zip(records) {
        grid.add(number, &record.region, points);
        costs.add(number, record, points);
    }
    worst(header, &grid, &costs)
}

fn of_region(region: &Region, points: &[Point]) -> u32 {
    match *region {
        Region::Ellipse { .. } => m::ELLIPSE,
        Region::Polygon { first, count } if cfg!(feature = "polygon") => {
            let vertices = points.get(usize::from(first)..).unwrap_or_default();
            let vertices = vertices.get(..usize::from(count)).unwrap_or_default();
            m::POLYGON + u32::from(count) * m::POLYGON_EDGE + edges_level_max(vertices) * m::POLYGON_EDGE_LEVEL
        }
        // A polygon that is left out is never read.
        Region::Screen | Region::Rectangle { .. } | Region::Polygon { .. } => 0,
    }
}

/// Most edges of a polygon that are level with one place: between two vertices, as many as at the upper of the two.
fn edges_level_max(vertices: &[Point]) -> u32 {
    let edges = || vertices.iter().zip(vertices.iter().cycle().skip(1));
    let level_at = |y: f32| edges().filter(|(from, to)| (from.y > y) != (to.y > y)).count();
    vertices.iter().map(|vertex| level_at(vertex.y)).max().unwrap_or(0) as u32
}

const fn of_layer(layer: &Layer) -> u32 {
    match *layer {
        Layer::Constant { .. } => m::CONSTANT,
        Layer::Grating { wave, .. } if cfg!(feature = "grating") => match wave {
            Wave::Sine => m::SINE,
            Wave::Square { .. } => m::SQUARE,
            Wave::Triangle => m::TRIANGLE,
            Wave::Saw => m::SAW,
        },
        Layer::Bitmap { tiled: false, .. } if cfg!(feature = "bitmap") => m::BITMAP,
        Layer::Bitmap { tiled: true, .. } if cfg!(feature = "bitmap") => m::BITMAP_TILED,
        Layer::Noise { .. } if cfg!(feature = "noise") => m::NOISE,
        Layer::Edge { .. } if cfg!(feature = "edge") => m::EDGE,
        Layer::Button { .. } if cfg!(feature = "edge") => m::BUTTON,
        Layer::Vibration { beat: Beat::Sine, .. } if cfg!(feature = "vibration") => m::VIBRATION_SINE,
        Layer::Vibration { beat: Beat::Square, .. } if cfg!(feature = "vibration") => m::VIBRATION_SQUARE,
        Layer::Speed { count, .. } if cfg!(feature = "speed") => m::SPEED + count as u32 * m::SPEED_POINT,
        Layer::Stream { .. } if cfg!(feature = "stream") => m::STREAM,
        // Left out: it is never read.
        _ => 0,
    }
}
