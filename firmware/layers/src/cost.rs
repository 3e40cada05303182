//! Estimates the cost of a scene in a tick, in processor cycles of a Cortex-M4F. Compiler and board use the same
//! numbers, so that the board accepts what the compiler accepts. The limit of a tick is
//! [`BoardLimits::tick_cycles_max`](frixel_wire::hello::BoardLimits::tick_cycles_max).
//!
//! The module `measured` holds the cost of every kind and region in **core cycles**: the cycles of each instruction by its class
//! (Cortex-M4 technical reference, Arm 100166, tables 3-1 and 7-1), with a memory without wait states. The file of
//! each kind adds up those that apply to it. [`FLASH_WAIT_PERCENT`] turns core cycles into cycles.

use frixel_wire::message::Refusal;
use frixel_wire::scene::RECORDS_MAX;

use crate::grid::{Cell, Grid, LayerSet, layer_numbers};
use crate::header::Header;
use crate::measured;
use crate::point::Point;
use crate::record::Record;
use frixel_model::Waveform;

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

/// Name and core cycles of each layer that was measured, or of the part of it that another does not have.
pub const MEASURED_LAYERS: &[(&str, u32)] = measured::LAYERS;

/// Converts core cycles to cycles of code that runs from flash, rounded up.
pub const fn cycles(core_cycles: u32) -> u32 {
    core_cycles.saturating_mul(FLASH_WAIT_PERCENT).div_ceil(100)
}

/// The costs of a scene's layers, from which the cost of a tick at any place follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerCosts {
    /// Core cycles of a tick with no layer near the finger, apart from `elsewhere`.
    empty: u32,
    /// Core cycles that layers add wherever the finger is.
    elsewhere: u32,
    /// Core cycles that each layer adds near the finger: far fewer than 65,536 each.
    layers: [u16; RECORDS_MAX],
}

impl LayerCosts {
    /// A scene with this header and without layers.
    pub const fn new(header: &Header) -> Self {
        Self { empty: of_empty_scene(header), elsewhere: 0, layers: [0; RECORDS_MAX] }
    }

    /// Adds layer number `number`; `points` are the scene's.
    pub fn add(&mut self, number: u8, record: &Record, points: &[Point]) {
        if let Some(cost) = self.layers.get_mut(usize::from(number)) {
            *cost = u16::try_from(of_record(record, points)).unwrap_or(u16::MAX);
        }
        // Counts once for all layers of the kind. Only one kind has it: a second one would need a sum over kinds.
        self.elsewhere = self.elsewhere.max(record.layer.cost_elsewhere());
    }

    /// Core cycles of a tick that evaluates these layers.
    pub fn of_tick(&self, layers: LayerSet) -> u32 {
        let near = layer_numbers(layers).filter_map(|number| self.layers.get(number));
        self.empty + self.elsewhere + near.map(|cost| u32::from(*cost)).sum::<u32>()
    }

    /// Finds the cell in which a tick takes the longest; `so_far` is the result for the cells before these.
    pub fn worst(&self, cells: impl Iterator<Item = Cell>, so_far: Worst) -> Worst {
        cells.fold(so_far, |worst, cell| {
            let core_cycles = self.of_tick(cell.layers);
            if core_cycles > worst.core_cycles { Worst { core_cycles, cell } } else { worst }
        })
    }
}

/// Core cycles that a layer adds to a tick with the finger in its region, or near it; `points` are the scene's.
pub fn of_record(record: &Record, points: &[Point]) -> u32 {
    record.region.cost(points) + record.layer.cost()
}

/// Core cycles of a tick with no layer near the finger.
pub const fn of_empty_scene(header: &Header) -> u32 {
    match header.waveform {
        Waveform::Square => measured::EMPTY,
        Waveform::Sine => measured::EMPTY + measured::SINE_CARRIER,
    }
}

/// Finds the place in a scene at which a tick takes the longest.
pub fn worst_of_scene(header: &Header, records: &[Record], points: &[Point]) -> Worst {
    let mut grid = Grid::EMPTY;
    grid.reset(header.screen_width_m, header.screen_height_m);
    let mut costs = LayerCosts::new(header);
    for (number, record) in (0..).zip(records) {
        grid.add(number, &record.region, points);
        costs.add(number, record, points);
    }
    costs.worst(grid.cells(), Worst::NOWHERE)
}
