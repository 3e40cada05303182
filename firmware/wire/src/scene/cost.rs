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

/// Instructions that a layer adds to a tick with the finger in its region, or near it.
pub const fn of_record(record: &Record) -> u32 {
    of_region(&record.region) + of_layer(&record.layer)
}

/// Instructions of a tick that looks at layers and finds none under the finger.
pub const fn of_empty_scene(header: &Header) -> u32 {
    match header.carrier {
        Carrier::Square => m::EMPTY,
        Carrier::Sine => m::EMPTY + m::SINE_CARRIER,
    }
}

/// Where a scene takes most, from its grid and the cost of each of its layers ([`of_record`]).
pub fn worst(header: &Header, grid: &Grid, costs: &[u32]) -> Worst {
    let empty = Worst { instructions: 0, cell: Cell { x_m: 0.0, y_m: 0.0, layers: [0; 2] } };
    grid.cells().fold(empty, |worst, cell| {
        let here = (0..).zip(costs).filter(|(number, _)| cell.has(*number)).map(|(_, cost)| cost);
        let instructions = of_empty_scene(header) + here.sum::<u32>();
        if instructions > worst.instructions { Worst { instructions, cell } } else { worst }
    })
}

/// [`worst`] of a whole scene.
pub fn worst_of_scene(header: &Header, records: &[Record], points: &[Point]) -> Worst {
    let mut grid = Grid::EMPTY;
    grid.reset(header.screen_width_m, header.screen_height_m);
    let mut costs = [0; RECORDS_MAX];
    for ((number, record), cost) in (0..).zip(records).zip(&mut costs) {
        grid.add(number, &record.region, points);
        *cost = of_record(record);
    }
    worst(header, &grid, &costs)
}

const fn of_region(region: &Region) -> u32 {
    match *region {
        Region::Ellipse { .. } => m::ELLIPSE,
        Region::Polygon { count, .. } if cfg!(feature = "polygon") => m::POLYGON + count as u32 * m::POLYGON_EDGE,
        // A polygon that is left out is never read.
        Region::Screen | Region::Rectangle { .. } | Region::Polygon { .. } => 0,
    }
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
