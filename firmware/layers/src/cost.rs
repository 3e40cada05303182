//! What a scene costs the tick, in instructions on a Cortex-M4F. Compiler and board use the same numbers, so that the
//! board takes what the compiler accepts.
//!
//! [`measured`] has the number of every kind and region; the file of each kind says which of them count for it.

pub(crate) mod measured;

use frixel_wire::scene::RECORDS_MAX;

use crate::grid::{Cell, Grid};
use crate::header::{Carrier, Header};
use crate::point::Point;
use crate::record::Record;

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
        // Once, however many layers of the kind there are.
        self.everywhere = self.everywhere.max(record.layer.cost_elsewhere());
    }
}

/// Instructions that a layer adds to a tick with the finger in its region, or near it; `points` are the scene's.
pub fn of_record(record: &Record, points: &[Point]) -> u32 {
    record.region.cost(points) + record.layer.cost()
}

/// Instructions of a tick with no layer near the finger.
pub const fn of_empty_scene(header: &Header) -> u32 {
    match header.carrier {
        Carrier::Square => measured::EMPTY,
        Carrier::Sine => measured::EMPTY + measured::SINE_CARRIER,
    }
}

/// Where a scene takes most, from its grid and the costs of its layers.
pub fn worst(header: &Header, grid: &Grid, costs: &LayerCosts) -> Worst {
    let empty = Worst { instructions: 0, cell: Cell { x_m: 0.0, y_m: 0.0, layers: [0; 2] } };
    grid.cells().fold(empty, |worst, cell| {
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
