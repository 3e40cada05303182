//! Estimates the cost of a scene in a tick, in processor cycles of a board's [`Core`]. Compiler and board use the same
//! numbers, so that the board accepts what the compiler accepts. The limit of a tick is
//! [`BoardLimits::tick_cycles_max`](frixel_wire::hello::BoardLimits::tick_cycles_max).
//!
//! The module `measured` holds the cost of every kind and region in **core cycles**, for memory without wait states.
//! For the Cortex-M4F, they are the cycles of each instruction by class (Cortex-M4 technical reference, Arm 100166,
//! tables 3-1 and 7-1); for the Cortex-M0+, the number of instructions times a bound on the cycles of each. Each kind's
//! file adds up the costs that apply to it. [`FLASH_WAIT_PERCENT`] converts core cycles to cycles on boards that run
//! from flash.

use core::ops::{Add, Mul};

use frixel_wire::hello::Core;
use frixel_wire::message::Refusal;
use frixel_wire::scene::RECORDS_MAX;

use crate::grid::{Cell, Grid, LayerSet, layer_numbers};
use crate::header::Header;
use crate::measured;
use crate::point::Point;
use crate::record::Record;
use frixel_model::Waveform;

// A core without compare-and-swap is a Cortex-M0 or M0+.
#[cfg(all(target_arch = "arm", not(target_has_atomic = "32"), not(feature = "every-core")))]
compile_error!(
    "this core has no costs without the feature `every-core` of `frixel-layers`; an image for the Pico is built with \
     --no-default-features --features rp2040,everything"
);

/// Core cycles on each core.
///
/// Without the feature `every-core`, which images for a Cortex-M4F omit, they apply to that core only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cost {
    cortex_m4f: u32,
    #[cfg(feature = "every-core")]
    cortex_m0_plus: u32,
}

impl Cost {
    pub(crate) const ZERO: Self = Self::new(0, 0);

    /// Core cycles on a Cortex-M4F, and on a Cortex-M0+.
    #[cfg_attr(
        not(feature = "every-core"),
        allow(unused_variables, reason = "costs of a core that the image is not built for")
    )]
    pub(crate) const fn new(cortex_m4f: u32, cortex_m0_plus: u32) -> Self {
        Self {
            cortex_m4f,
            #[cfg(feature = "every-core")]
            cortex_m0_plus,
        }
    }

    /// Core cycles on this core; [`u32::MAX`], more than any board accepts, for a core whose costs are omitted.
    pub const fn on(self, core: Core) -> u32 {
        match core {
            Core::CortexM4f => self.cortex_m4f,
            #[cfg(feature = "every-core")]
            Core::CortexM0Plus => self.cortex_m0_plus,
            #[cfg(not(feature = "every-core"))]
            Core::CortexM0Plus => u32::MAX,
        }
    }
}

impl Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            cortex_m4f: self.cortex_m4f + other.cortex_m4f,
            #[cfg(feature = "every-core")]
            cortex_m0_plus: self.cortex_m0_plus + other.cortex_m0_plus,
        }
    }
}

impl Mul<u32> for Cost {
    type Output = Self;

    fn mul(self, count: u32) -> Self {
        Self {
            cortex_m4f: self.cortex_m4f * count,
            #[cfg(feature = "every-core")]
            cortex_m0_plus: self.cortex_m0_plus * count,
        }
    }
}

/// Cycles per 100 core cycles if the tick runs from flash. **Assumed**; not measured on a board yet.
///
/// An STM32G474 at 170 MHz reads flash with 4 wait states, with an instruction cache of 1 KiB. Code in the cache does
/// not wait; code that runs only once is prefetched, and waits for up to one cycle per instruction. A tick has both:
/// its loop over layers stays in the cache, and the rest runs once.
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
    /// Initial value of a search, without a place.
    pub const NOWHERE: Self = Self { core_cycles: 0, cell: Cell { x_m: 0.0, y_m: 0.0, layers: [0; 2] } };

    /// Cycles of the longest tick on the core of the search, including flash wait states.
    pub const fn cycles(&self, core: Core) -> u32 {
        cycles(core, self.core_cycles)
    }

    /// Refuses a scene whose longest tick is estimated at more than `cycles_max` on the core of the search.
    pub fn check(&self, core: Core, cycles_max: u32) -> Result<(), Refusal> {
        let Cell { x_m, y_m, .. } = self.cell;
        let cycles = self.cycles(core);
        if cycles <= cycles_max { Ok(()) } else { Err(Refusal::TooCostly { cycles, cycles_max, x_m, y_m }) }
    }
}

/// Name and core cycles of each measured layer, or of the part in which it differs from another one.
pub const MEASURED_LAYERS: &[(&str, Cost)] = measured::LAYERS;

/// Converts core cycles to cycles, rounded up, for code that runs from flash on a Cortex-M4F, and from RAM on a
/// Cortex-M0+.
pub const fn cycles(core: Core, core_cycles: u32) -> u32 {
    match core {
        Core::CortexM0Plus => core_cycles,
        Core::CortexM4f => core_cycles.saturating_mul(FLASH_WAIT_PERCENT).div_ceil(100),
    }
}

/// The costs of a scene's layers, which determine the cost of a tick at any place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerCosts {
    /// Core cycles of a tick with no layer near the finger, excluding `elsewhere`.
    empty: u32,
    /// Core cycles added by layers at any position of the finger.
    elsewhere: u32,
    /// Core cycles added by each layer near the finger, each far below 65,536.
    layers: [u16; RECORDS_MAX],
}

impl LayerCosts {
    /// Costs of a scene with this header and without layers, on a board with this core.
    pub fn new(header: &Header, core: Core) -> Self {
        Self { empty: of_empty_scene(header).on(core), elsewhere: 0, layers: [0; RECORDS_MAX] }
    }

    /// Adds layer number `number`; `points` are the scene's, and `core` is that of [`Self::new`].
    pub fn add(&mut self, number: u8, record: &Record, points: &[Point], core: Core) {
        if let Some(cost) = self.layers.get_mut(usize::from(number)) {
            *cost = u16::try_from(of_record(record, points).on(core)).unwrap_or(u16::MAX);
        }
        // Counts once for all layers of the kind. Only one kind has it; a second one would need a sum over kinds.
        self.elsewhere = self.elsewhere.max(record.layer.cost_elsewhere().on(core));
    }

    /// Core cycles of a tick that evaluates these layers.
    pub fn of_tick(&self, layers: LayerSet) -> u32 {
        let near = layer_numbers(layers).filter_map(|number| self.layers.get(number));
        let layers = near.map(|cost| u32::from(*cost)).sum::<u32>();
        self.empty.saturating_add(self.elsewhere).saturating_add(layers)
    }

    /// Finds the cell in which a tick takes the longest; `so_far` is the result for the cells before these.
    pub fn worst(&self, cells: impl Iterator<Item = Cell>, so_far: Worst) -> Worst {
        cells.fold(so_far, |worst, cell| {
            let core_cycles = self.of_tick(cell.layers);
            if core_cycles > worst.core_cycles { Worst { core_cycles, cell } } else { worst }
        })
    }
}

/// Core cycles added to a tick by a layer with the finger in or near its region; `points` are the scene's.
pub fn of_record(record: &Record, points: &[Point]) -> Cost {
    record.region.cost(points) + record.layer.cost()
}

/// Core cycles of a tick with no layer near the finger.
pub fn of_empty_scene(header: &Header) -> Cost {
    match header.waveform {
        Waveform::Square => measured::EMPTY,
        Waveform::Sine => measured::EMPTY + measured::SINE_CARRIER,
    }
}

/// Finds the place in a scene at which a tick takes the longest on a core.
pub fn worst_of_scene(header: &Header, records: &[Record], points: &[Point], core: Core) -> Worst {
    let mut grid = Grid::EMPTY;
    grid.reset(header.screen_width_m, header.screen_height_m);
    let mut costs = LayerCosts::new(header, core);
    for (number, record) in (0..).zip(records) {
        grid.add(number, &record.region, points);
        costs.add(number, record, points, core);
    }
    costs.worst(grid.cells(), Worst::NOWHERE)
}
