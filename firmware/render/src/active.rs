//! The coefficients that the tick reads. What can be computed when a scene is committed is never computed in the tick.

use core::borrow::Borrow;

use frixel_model::{Carrier, Finger, InverseTable, InverseTableFilling, TableError, Waveform};
use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};
use frixel_wire::scene::cost::{self, LayerCosts, TICK_INSTRUCTIONS_MAX, Worst};
use frixel_wire::scene::{Carrier as Shape, Grid, Header, LayerSet, Point, RECORDS_MAX, Scene};
use heapless::Vec;

use crate::Board;
use crate::asked::Asked;
use crate::bitmap_pool::{BitmapPool, Directory};
use crate::carrier::CarrierTiming;
use crate::config;
use crate::layer::{self, Around, Clicks, Layer, LayerLoading, Moment, Tables};

/// Layers that a step of loading takes.
const LAYERS_PER_STEP: usize = 8;
/// Cells of the grid whose cost a step of loading finds.
const CELLS_PER_STEP: usize = 64;
/// Rows of the inverse table that a step of loading computes.
const ROWS_PER_STEP: usize = 8;

/// How far a scene is loaded: the next step.
#[derive(Clone, Debug)]
pub(crate) enum Loading {
    /// What holds for the whole scene.
    Drive,
    /// Layers from a number on.
    Layers {
        /// Number of the first.
        next: usize,
    },
    /// The cost of a tick, from a cell of the grid on.
    Cost {
        /// Number of the first.
        next_cell: usize,
        /// The worst cell before it.
        worst: Worst,
    },
    /// The layout of the inverse table.
    Table,
    /// Rows of the inverse table.
    Rows(InverseTableFilling),
}

impl Loading {
    /// The cost of a tick.
    const COST: Self = Self::Cost { next_cell: 0, worst: Worst::NOWHERE };
}

/// Coefficients of one scene. A board has two of them: one that plays and one that the next scene is built in.
///
/// In this order: what lies near the beginning is reached in one instruction.
#[repr(C)]
pub struct Active {
    pub(crate) carrier: CarrierTiming,
    pub(crate) slew_step_v: f32,
    /// Largest rms voltage within all limits.
    pub(crate) voltage_max_v_rms: f32,
    /// `None` for a scene that goes on without a host.
    pub(crate) host_timeout_ticks: Option<u32>,
    pub(crate) prediction: bool,
    table: Option<InverseTable>,
    /// The layers that are on.
    on: LayerSet,
    grid: Grid,
    layers: Vec<Layer, RECORDS_MAX>,
    tables: Tables,
}

impl Active {
    /// Coefficients of no scene.
    #[allow(clippy::new_without_default, reason = "it belongs in a static, not into a value made in passing")]
    pub const fn new() -> Self {
        Self {
            layers: Vec::new(),
            tables: Tables::new(),
            on: [0; 2],
            grid: Grid::EMPTY,
            table: None,
            carrier: CarrierTiming::SILENT,
            slew_step_v: 0.0,
            voltage_max_v_rms: 0.0,
            host_timeout_ticks: None,
            prediction: true,
        }
    }

    /// Bytes of these coefficients that a scene fills, for each of the two: its layers, points, waves and clicks. The rest
    /// is the same for every scene. No pointer is among them, so that they are as many on every target.
    pub fn bytes_filled(scene: &Scene) -> usize {
        scene.records().map(|record| layer::bytes_of(&record)).sum::<usize>()
            + scene.points().len() * size_of::<Point>()
    }

    /// How much of the inverse table the board computes for a scene, whose numbers a board takes. The table's room in RAM
    /// is the same for every scene; what is cut is the time that its rows take at a commit.
    pub fn table_rows(scene: &Scene, board: &Board) -> Result<TableRows, Refusal> {
        let header = scene.header();
        let mut grid = Grid::EMPTY;
        grid.reset(header.screen_width_m, header.screen_height_m);
        let mut tables = Tables::new();
        tables.set_points(scene.points());
        let mut asked = Asked::NOTHING;
        for (number, record) in (0..).zip(scene.records()) {
            grid.add(number, &record.region, tables.points());
            asked.add(number, &record, tables.points());
        }
        let (_, voltage_max_v_rms) = carrier(header, board).map_err(Refusal::Config)?;
        let rows = |asked_max_n| {
            let (_, filling) = begin_table(header, voltage_max_v_rms, asked_max_n).map_err(Refusal::Config)?;
            Ok::<_, Refusal>(filling.rows())
        };
        let (filled, whole) = (rows(asked_max_n(header, &asked, &grid))?, rows(f32::INFINITY)?);
        Ok(TableRows { filled, whole })
    }

    /// Forgets the scene.
    #[inline]
    pub(crate) fn unload(&mut self) {
        // One by one: the whole of it is thousands of bytes, and a tick may be waiting.
        self.layers.clear();
        self.tables.clear();
        self.on = [0; 2];
        self.table = None;
        self.carrier = CarrierTiming::SILENT;
        self.slew_step_v = 0.0;
        self.voltage_max_v_rms = 0.0;
        self.host_timeout_ticks = None;
        self.prediction = true;
    }

    /// The inverse table; `None` without a scene.
    #[inline]
    pub(crate) fn table(&self) -> Option<&InverseTable> {
        self.table.as_ref()
    }

    /// Some layer plays what the host streams.
    #[cfg(feature = "stream")]
    #[inline]
    pub(crate) fn has_stream(&self) -> bool {
        self.layers.iter().any(Layer::is_stream)
    }

    /// Electric friction of all layers that are on, in N.
    #[inline]
    pub(crate) fn electric_friction_n(&self, moment: &Moment, pool: &BitmapPool, clicks: &mut Clicks) -> f32 {
        let around = &mut Around { moment, pool, tables: &self.tables, clicks };
        let [x_m, y_m] = around.moment.place_m;
        let [on, others_on] = self.on;
        let [near, others_near] = self.grid.at(x_m, y_m);
        #[cfg(feature = "edge")]
        if !self.tables.clicks().is_empty() {
            around.clicks.begin();
        }
        let below_n = self.blend(0, on & near, 0.0, around);
        let others = others_on & others_near;
        if others == 0 { below_n } else { self.blend_others(others, below_n, around) }
    }

    /// Blends those of the 32 layers from number `first` on that are in `set`, over what is below them.
    #[inline]
    fn blend(&self, first: u32, mut set: u32, below_n: f32, around: &mut Around) -> f32 {
        let mut electric_friction_n = below_n;
        while set != 0 {
            let number = set.trailing_zeros();
            set &= set - 1;
            if let Some(layer) = self.layers.get((first + number) as usize) {
                electric_friction_n = layer.blend_over(electric_friction_n, around);
            }
        }
        electric_friction_n
    }

    #[inline(never)]
    fn blend_others(&self, set: u32, below_n: f32, around: &mut Around) -> f32 {
        self.blend(u32::BITS, set, below_n, around)
    }

    /// Puts a layer on or off and sets its gain while the scene plays. A layer that the scene does not have is none.
    #[inline]
    pub(crate) fn set_layer(&mut self, number: u8, on: bool, gain: f32) {
        if let Some(layer) = self.layers.get_mut(usize::from(number)) {
            layer.set_gain(gain);
            self.put(number, on);
        }
    }

    /// Does the next step of making these the coefficients of `scene`, each well below a millisecond of a board's time.
    /// Returns whether it was the last. When the scene is refused, these are the coefficients of no scene; before the last
    /// step they are of no use.
    pub(crate) fn load_step<D: Borrow<Directory>>(
        &mut self,
        loading: &mut Loading,
        scene: &Scene,
        board: &Board,
        directory: &D,
    ) -> Result<bool, Refusal> {
        let stepped = self.try_load_step(loading, scene, board, directory.borrow());
        if stepped.is_err() {
            self.unload();
        }
        stepped
    }

    fn try_load_step(
        &mut self,
        loading: &mut Loading,
        scene: &Scene,
        board: &Board,
        directory: &Directory,
    ) -> Result<bool, Refusal> {
        *loading = match loading {
            Loading::Drive => {
                self.load_drive(scene, board)?;
                Loading::Layers { next: 0 }
            }
            Loading::Layers { next } => {
                self.load_layers(*next, scene, board, directory)?;
                let next = *next + LAYERS_PER_STEP;
                if next < scene.record_count() { Loading::Layers { next } } else { Loading::COST }
            }
            Loading::Cost { next_cell, worst } => {
                let worst = self.worst(*next_cell, *worst, scene);
                let next_cell = *next_cell + CELLS_PER_STEP;
                if next_cell < Grid::CELLS {
                    Loading::Cost { next_cell, worst }
                } else {
                    check_cost(&worst)?;
                    Loading::Table
                }
            }
            Loading::Table => {
                let (table, filling) = begin_table(scene.header(), self.voltage_max_v_rms, self.asked_max_n(scene))
                    .map_err(Refusal::Config)?;
                self.table = Some(table);
                Loading::Rows(filling)
            }
            Loading::Rows(filling) => {
                let Some(table) = &mut self.table else { return Ok(true) };
                return filling
                    .fill(table, ROWS_PER_STEP)
                    .map_err(|error| Refusal::Config(no_table(&error, scene.header(), self.voltage_max_v_rms)));
            }
        };
        Ok(false)
    }

    /// Loads what holds for the whole scene, the inverse table left out.
    #[inline]
    fn load_drive(&mut self, scene: &Scene, board: &Board) -> Result<(), Refusal> {
        self.unload();
        let header = scene.header();
        if header.carrier == Shape::Sine && !cfg!(feature = "sine-carrier") {
            return Err(Refusal::LeftOut { layer: ConfigRefusal::WHOLE_SCENE });
        }
        config::check_header(header, board).map_err(Refusal::Config)?;
        (self.carrier, self.voltage_max_v_rms) = carrier(header, board).map_err(Refusal::Config)?;
        self.slew_step_v = header.slew_v_per_s * board.tick_period_s();
        self.host_timeout_ticks = (!header.autonomous).then(|| board.ticks(header.host_timeout_s));
        self.prediction = header.prediction;
        self.grid.reset(header.screen_width_m, header.screen_height_m);
        self.tables.set_points(scene.points());
        Ok(())
    }

    /// Loads the next layers.
    #[inline]
    fn load_layers(&mut self, next: usize, scene: &Scene, board: &Board, directory: &Directory) -> Result<(), Refusal> {
        for (number, record) in scene.records().enumerate().skip(next).take(LAYERS_PER_STEP) {
            let number = number as u8;
            config::check_record(&record, scene, number).map_err(Refusal::Config)?;
            let mut loading = LayerLoading { board, directory, tables: &mut self.tables };
            let layer = loading.layer(&record, number)?;
            // There is room for every record that a scene can have.
            let _ = self.layers.push(layer);
            self.put(number, true);
            self.grid.add(number, &record.region, self.tables.points());
        }
        Ok(())
    }

    /// The cell in which a tick takes longest, of those so far and the next.
    #[inline]
    fn worst(&self, next_cell: usize, so_far: Worst, scene: &Scene) -> Worst {
        let mut costs = LayerCosts::NONE;
        for (number, record) in (0..).zip(scene.records()) {
            costs.add(number, &record, self.tables.points());
        }
        let cells = self.grid.cells().skip(next_cell).take(CELLS_PER_STEP);
        cost::worst_of_cells(scene.header(), cells, &costs, so_far)
    }

    /// The largest electric friction that the scene can ask for, N.
    #[inline]
    fn asked_max_n(&self, scene: &Scene) -> f32 {
        let mut asked = Asked::NOTHING;
        for (number, record) in (0..).zip(scene.records()) {
            asked.add(number, &record, self.tables.points());
        }
        asked_max_n(scene.header(), &asked, &self.grid)
    }

    #[inline]
    fn put(&mut self, number: u8, on: bool) {
        let [first, others] = &mut self.on;
        let word = if u32::from(number) < u32::BITS { first } else { others };
        let bit = 1 << (u32::from(number) % u32::BITS);
        *word = if on { *word | bit } else { *word & !bit };
    }
}

/// Refuses a scene whose longest tick is too long.
#[inline]
fn check_cost(&Worst { instructions, cell }: &Worst) -> Result<(), Refusal> {
    let max = TICK_INSTRUCTIONS_MAX;
    if instructions > max {
        Err(Refusal::TooCostly { instructions, max, x_m: cell.x_m, y_m: cell.y_m })
    } else {
        Ok(())
    }
}

/// The carrier of a scene, and the largest rms voltage that it carries within all limits.
#[inline]
fn carrier(header: &Header, board: &Board) -> Result<(CarrierTiming, f32), ConfigRefusal> {
    let limits = &board.limits;
    let half_period_ticks = board.ticks(0.5 / header.carrier_hz);
    let carrier = Carrier {
        waveform: match header.carrier {
            Shape::Sine if cfg!(feature = "sine-carrier") => Waveform::Sine,
            _ => Waveform::Square,
        },
        half_period_s: half_period_ticks as f32 * board.tick_period_s(),
        edge_time_constant_s: limits.edge_time_constant_s,
    };
    let peak_per_rms = carrier.peak_per_rms();
    let voltage_max_v_rms = header.voltage_max_v_rms.min(header.voltage_max_v_peak / peak_per_rms);

    let drive_v_peak = voltage_max_v_rms * peak_per_rms;
    let current = carrier.electrode_current(limits.electrode_capacitance_max_f, drive_v_peak);
    for (field, found_a, max_a) in [
        (ConfigField::CurrentRms, current.a_rms, limits.current_max_a_rms),
        (ConfigField::CurrentPeak, current.a_peak, limits.current_max_a_peak),
    ] {
        config::within(field, found_a, 0.0, max_a, ConfigRefusal::WHOLE_SCENE)?;
    }

    let codes_per_v = f32::from(i16::MAX) / limits.full_scale_v_peak;
    let code_max = (header.voltage_max_v_peak * codes_per_v) as i32;
    let code_max = code_max.min(i32::from(i16::MAX));
    let timing = CarrierTiming::new(header.carrier, half_period_ticks, peak_per_rms * codes_per_v, code_max);
    Ok((timing, voltage_max_v_rms))
}

/// Rows of a scene's inverse table with a piece of the curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableRows {
    /// Those that the board computes.
    pub filled: usize,
    /// Those that it would compute if the scene asked for all that the drive can give.
    pub whole: usize,
}

/// The largest electric friction that a scene can ask for, N. A layer that may be changed while it plays may ask for
/// anything.
#[inline]
fn asked_max_n(header: &Header, asked: &Asked, grid: &Grid) -> f32 {
    if cfg!(feature = "table-cut") && header.layers_fixed { asked.electric_friction_max_n(grid) } else { f32::INFINITY }
}

/// Begins the inverse table of a scene's finger, coating and load, up to what is asked for.
#[inline]
fn begin_table(
    header: &Header,
    voltage_max_v_rms: f32,
    asked_max_n: f32,
) -> Result<(InverseTable, InverseTableFilling), ConfigRefusal> {
    let Header { effective_gap_m, normal_load_n, .. } = *header;
    InverseTable::begin(&finger(header), effective_gap_m, normal_load_n, voltage_max_v_rms, asked_max_n)
        .map_err(|error| no_table(&error, header, voltage_max_v_rms))
}

#[inline]
fn no_table(error: &TableError, header: &Header, voltage_max_v_rms: f32) -> ConfigRefusal {
    let (field, found) = match error {
        TableError::Contact => (ConfigField::EffectiveGap, header.effective_gap_m),
        _ => (ConfigField::TableRange, voltage_max_v_rms),
    };
    ConfigRefusal { field, found, min: 0.0, max: f32::INFINITY, layer: ConfigRefusal::WHOLE_SCENE }
}

/// A scene's finger.
#[inline]
fn finger(header: &Header) -> Finger<f32> {
    Finger {
        radius_m: header.finger_radius_m,
        stiffness_pa_per_m: header.stiffness_pa_per_m,
        friction_coefficient: header.friction_coefficient,
    }
}
