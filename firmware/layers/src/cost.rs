//! Estimates the cost of a scene in a tick, in processor cycles of a Cortex-M4F. Compiler and board use the same
//! numbers, so that the board accepts what the compiler accepts. The limit of a tick is
//! [`BoardLimits::tick_cycles_max`](frixel_wire::hello::BoardLimits::tick_cycles_max).
//!
//! `measured` holds the cost of every kind and region in **core cycles**: the cycles of each instruction by its class
//! (Cortex-M4 technical reference, Arm 100166, tables 3-1 and 7-1), with a memory without wait states. The file of
//! each kind adds up those that apply to it. [`FLASH_WAIT_PERCENT`] turns core cycles into cycles.

pub(crate) mod measured;

use frixel_wire::message::Refusal;
use frixel_wire::scene::RECORDS_MAX;

use crate::grid::{Cell, Grid};
use crate::header::{Carrier, Header};
use crate::point::Point;
use crate::record::Record;

/// Cycles for 100 core cycles when the tick runs from flash. **Assumed**; not measured on a board yet.
///
/// An STM32G474 at 170 MHz reads flash with 4 wait states, behind a cache of 1 KiB for instructions. Code that stays in
/// the cache does not wait; code that runs only once is prefetched, and waits for up to one cycle an instruction. A
/// tick has both: its loop over layers stays in the cache, the rest runs once.
pub const FLASH_WAIT_PERCENT: u32 = 125;

/// The place in a scene at which a tick takes the longest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Core cycles of the longest tick.
    pub core_cycles: u32,
    /// The cell of the grid that contains the place.
    pub cell: Cell,
}

impl Worst {
    /// No place: the initial value of a search.
    pub const NOWHERE: Self = Self { core_cycles: 0, cell: Cell { x_m: 0.0, y_m: 0.0, layers: [0; 2] } };

    /// Cycles of the longest tick, including flash wait states.
    pub const fn cycles(&self) -> u32 {
        cycles(self.core_cycles)
    }

    /// Refuses a scene whose longest tick is estimated at more than `cycles_max`.
    pub fn check(&self, cycles_max: u32) -> Result<(), Refusal> {
        let Cell { x_m, y_m, .. } = self.cell;
        let cycles = self.cycles();
        if cycles <= cycles_max { Ok(()) } else { Err(Refusal::TooCostly { cycles, cycles_max, x_m, y_m }) }
    }
}

/// Converts core cycles to cycles of code that runs from flash, rounded up.
pub const fn cycles(core_cycles: u32) -> u32 {
    core_cycles.saturating_mul(FLASH_WAIT_PERCENT).div_ceil(100)
}

/// Core cycles that the layers of a scene add to a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerCosts {
    layers: [u32; RECORDS_MAX],
    /// Core cycles that do not depend on where the finger is.
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
        // Counts once for all layers of the kind. Only one kind has it: a second one would need a sum over kinds.
        self.everywhere = self.everywhere.max(record.layer.cost_elsewhere());
    }
}

/// Core cycles that a layer adds to a tick with the finger in its region, or near it; `points` are the scene's.
pub fn of_record(record: &Record, points: &[Point]) -> u32 {
    record.region.cost(points) + record.layer.cost()
}

/// Core cycles of a tick with no layer near the finger.
pub const fn of_empty_scene(header: &Header) -> u32 {
    match header.carrier {
        Carrier::Square => measured::EMPTY,
        Carrier::Sine => measured::EMPTY + measured::SINE_CARRIER,
    }
}

/// Finds the place at which a tick takes the longest, from a scene's grid and the costs of its layers.
pub fn worst(header: &Header, grid: &Grid, costs: &LayerCosts) -> Worst {
    worst_of_cells(header, grid.cells(), costs, Worst::NOWHERE)
}

/// [`worst`] of some cells of the grid; `so_far` is the result for the cells before them.
pub fn worst_of_cells(header: &Header, cells: impl Iterator<Item = Cell>, costs: &LayerCosts, so_far: Worst) -> Worst {
    cells.fold(so_far, |worst, cell| {
        let here = (0..).zip(&costs.layers).filter(|(number, _)| cell.has(*number)).map(|(_, cost)| cost);
        let core_cycles = of_empty_scene(header) + costs.everywhere + here.sum::<u32>();
        if core_cycles > worst.core_cycles { Worst { core_cycles, cell } } else { worst }
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
