//! The coefficients that the tick reads. What can be computed when a scene is committed is never computed in the tick.

use core::borrow::Borrow;

use frixel_model::{Carrier, Finger, InverseTable, TableError, Waveform};
use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};
use frixel_wire::scene::cost::{self, LayerCosts, TICK_INSTRUCTIONS_MAX, Worst};
use frixel_wire::scene::{Carrier as Shape, Grid, Header, LayerSet, Point, RECORDS_MAX, Scene};
use heapless::Vec;

use crate::Board;
use crate::asked::Asked;
use crate::bitmap_pool::{BitmapPool, Directory};
use crate::carrier::CarrierTiming;
use crate::config;
use crate::layer::{self, Around, Clicks, Layer, Loading, Moment, Sole, Tables};

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
    /// The one layer that is all there is, if so.
    sole: Option<Sole>,
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
            sole: None,
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
            let table = table(header, voltage_max_v_rms, asked_max_n).map_err(Refusal::Config)?;
            Ok::<_, Refusal>(table.rows_filled())
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
        self.sole = None;
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

    /// The one layer that is all there is, if so.
    #[inline]
    pub(crate) fn sole(&self) -> Option<&Sole> {
        self.sole.as_ref()
    }

    /// Electric friction of all layers that are on, in N.
    #[inline(never)]
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
        self.sole = self.find_sole();
    }

    /// Makes these the coefficients of `scene`. When it is refused, they are those of no scene.
    // One copy, which the board builds: see "Fast and small" in the crate's documentation.
    #[inline(never)]
    pub(crate) fn load<D: Borrow<Directory>>(
        &mut self,
        scene: &Scene,
        board: &Board,
        directory: &D,
    ) -> Result<(), Refusal> {
        self.unload();
        let header = scene.header();
        if header.carrier == Shape::Sine && !cfg!(feature = "sine-carrier") {
            return Err(Refusal::LeftOut { layer: ConfigRefusal::WHOLE_SCENE });
        }
        config::check_header(header, board).map_err(Refusal::Config)?;
        let (carrier, voltage_max_v_rms) = carrier(header, board).map_err(Refusal::Config)?;
        let asked_max_n = self.load_layers(scene, board, directory.borrow())?;
        self.carrier = carrier;
        self.voltage_max_v_rms = voltage_max_v_rms;
        self.slew_step_v = header.slew_v_per_s * board.tick_period_s();
        self.host_timeout_ticks = (!header.autonomous).then(|| board.ticks(header.host_timeout_s));
        self.prediction = header.prediction;
        self.table = Some(table(header, voltage_max_v_rms, asked_max_n).map_err(Refusal::Config)?);
        Ok(())
    }

    /// Loads the layers, and gives the largest electric friction that they can ask for, N.
    #[inline]
    fn load_layers(&mut self, scene: &Scene, board: &Board, directory: &Directory) -> Result<f32, Refusal> {
        self.grid.reset(scene.header().screen_width_m, scene.header().screen_height_m);
        self.tables.set_points(scene.points());
        let mut costs = LayerCosts::NONE;
        let mut asked = Asked::NOTHING;
        for (number, record) in scene.records().enumerate() {
            let number = number as u8;
            config::check_record(&record, scene, number).map_err(Refusal::Config)?;
            let mut loading = Loading { board, directory, tables: &mut self.tables };
            let layer = loading.layer(&record, number)?;
            // There is room for every record that a scene can have.
            let _ = self.layers.push(layer);
            costs.add(number, &record, self.tables.points());
            self.put(number, true);
            self.grid.add(number, &record.region, self.tables.points());
            asked.add(number, &record, self.tables.points());
        }
        self.sole = self.find_sole();
        let Worst { instructions, cell } = cost::worst(scene.header(), &self.grid, &costs);
        if instructions > TICK_INSTRUCTIONS_MAX {
            let max = TICK_INSTRUCTIONS_MAX;
            return Err(Refusal::TooCostly { instructions, max, x_m: cell.x_m, y_m: cell.y_m });
        }
        Ok(asked_max_n(scene.header(), &asked, &self.grid))
    }

    #[inline]
    fn put(&mut self, number: u8, on: bool) {
        let [first, others] = &mut self.on;
        let word = if u32::from(number) < u32::BITS { first } else { others };
        let bit = 1 << (u32::from(number) % u32::BITS);
        *word = if on { *word | bit } else { *word & !bit };
    }

    #[inline]
    fn find_sole(&self) -> Option<Sole> {
        self.layers.first().filter(|_| self.on == [1, 0]).and_then(Layer::sole)
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

/// The inverse table of a scene's finger, coating and load, up to what is asked for.
#[inline]
fn table(header: &Header, voltage_max_v_rms: f32, asked_max_n: f32) -> Result<InverseTable, ConfigRefusal> {
    let Header { effective_gap_m, normal_load_n, .. } = *header;
    InverseTable::of_finger(&finger(header), effective_gap_m, normal_load_n, voltage_max_v_rms, asked_max_n)
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
