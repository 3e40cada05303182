//! Checks a scene's configuration and computes the tick's coefficients, in steps.

use frixel_control::{Active, Board, CarrierTiming};
use frixel_layers::cost::{LayerCosts, Worst};
use frixel_layers::{FingerLaw, Grid, Header, Point, Scene, active_bytes, within};
use frixel_model::{
    Carrier, EmpiricalLaw, EmpiricalTableFilling, Finger, InverseTable, InverseTableFilling, LawError, LawPoint,
    TableError, Waveform,
};
use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};

use super::bitmap_directory::Directory;

/// Grid cells whose cost is computed per step of loading.
const CELLS_PER_STEP: usize = 64;
/// Rows of the inverse table computed per step of loading.
const ROWS_PER_STEP: usize = 1;

/// The next step of loading a scene.
#[derive(Clone, Debug)]
pub(crate) enum Loading {
    /// Carrier, voltage limits and the other properties of the whole scene.
    Drive,
    /// The layer with a number.
    Layer {
        number: usize,
        /// Costs of the layers before it.
        costs: LayerCosts,
    },
    /// The cost of a tick in the remaining cells of the grid.
    Cost {
        /// Number of the next cell.
        next_cell: usize,
        /// The worst of the cells before it.
        worst: Worst,
        /// Costs of all layers.
        costs: LayerCosts,
    },
    /// The layout of the inverse table.
    Table,
    /// Rows of the inverse table.
    Rows(InverseTableFilling),
    /// Rows of the inverse table of an empirical law.
    LawRows(EmpiricalTableFilling),
}

impl Loading {
    /// Computes the next part of the coefficients of `scene` into `active`, and returns whether it was the last one. A
    /// step takes well under a millisecond, and 8 ms on an RP2040. Before the last step, the content of `active` must
    /// not be used; if the scene is refused, `active` holds no scene.
    pub(crate) fn step(
        &mut self,
        active: &mut Active,
        scene: &Scene,
        board: &Board,
        directory: &Directory,
    ) -> Result<bool, Refusal> {
        let stepped = self.try_step(active, scene, board, directory);
        if stepped.is_err() {
            active.unload();
        }
        stepped
    }

    fn try_step(
        &mut self,
        active: &mut Active,
        scene: &Scene,
        board: &Board,
        directory: &Directory,
    ) -> Result<bool, Refusal> {
        let header = scene.header();
        *self = match self {
            Self::Drive => {
                load_drive(active, scene, board)?;
                Self::Layer { number: 0, costs: LayerCosts::new(header, board.limits.core) }
            }
            Self::Layer { number, costs } => {
                if let Some(record) = scene.record(*number) {
                    active.layers.push(&record, board.tick_hz, &|crc32| directory.find(crc32))?;
                    costs.add(*number as u8, &record, active.layers.points(), board.limits.core);
                    Self::Layer { number: *number + 1, costs: *costs }
                } else {
                    Self::Cost { next_cell: 0, worst: Worst::NOWHERE, costs: *costs }
                }
            }
            Self::Cost { next_cell, worst, costs } => {
                let worst = costs.worst(active.layers.cells().skip(*next_cell).take(CELLS_PER_STEP), *worst);
                let next_cell = *next_cell + CELLS_PER_STEP;
                if next_cell < Grid::CELLS {
                    Self::Cost { next_cell, worst, costs: *costs }
                } else {
                    worst.check(board.limits.core, board.limits.tick_cycles_max)?;
                    Self::Table
                }
            }
            Self::Table => {
                let Active { table, voltage_max_v_rms, .. } = active;
                let begun = match header.law() {
                    Some(law) => begin_law_table(table, header, law, *voltage_max_v_rms).map(Self::LawRows),
                    None => begin_table(table, header, board, *voltage_max_v_rms).map(Self::Rows),
                };
                begun.map_err(Refusal::Config)?
            }
            Self::Rows(filling) => {
                return filling
                    .fill(&mut active.table, ROWS_PER_STEP)
                    .map_err(|error| Refusal::Config(no_table(&error, header, active.voltage_max_v_rms)));
            }
            Self::LawRows(filling) => {
                let Some(law) = header.law() else { return Ok(true) };
                return filling
                    .fill(&mut active.table, ROWS_PER_STEP)
                    .map_err(|error| Refusal::Config(no_law(&error, law)));
            }
        };
        Ok(false)
    }
}

/// Loads the properties of the whole scene, except the inverse table.
fn load_drive(active: &mut Active, scene: &Scene, board: &Board) -> Result<(), Refusal> {
    active.unload();
    let header = scene.header();
    if header.waveform == Waveform::Sine && !cfg!(feature = "sine-carrier") {
        return Err(Refusal::FeatureDisabled { layer: ConfigRefusal::WHOLE_SCENE });
    }
    header.check(&board.limits, board.tick_hz).map_err(Refusal::Config)?;
    (active.carrier, active.voltage_max_v_rms) = timing(header, board).map_err(Refusal::Config)?;
    active.slew_step_v = header.slew_v_per_s * board.tick_period_s();
    active.host_timeout_ticks = board.ticks(header.host_timeout_s);
    active.prediction_off = !header.prediction;
    active.layers.begin(header, scene.points());
    Ok(())
}

/// The waveform of a scene. Without the feature, this lets the compiler omit the sine; `load_drive` has refused such a
/// scene.
fn waveform(header: &Header) -> Waveform {
    match header.waveform {
        Waveform::Sine if cfg!(feature = "sine-carrier") => Waveform::Sine,
        _ => Waveform::Square,
    }
}

/// The timing of a scene's carrier, and its largest rms voltage within all limits.
fn timing(header: &Header, board: &Board) -> Result<(CarrierTiming, f32), ConfigRefusal> {
    let limits = &board.limits;
    let carrier = Carrier { waveform: waveform(header), ..header.carrier(limits, board.tick_hz) };
    let half_period_ticks = carrier.half_period_ticks;
    let peak_per_rms = carrier.peak_per_rms();
    let voltage_max_v_rms = header.voltage_max_v_rms.min(header.voltage_max_v_peak / peak_per_rms);

    let drive_v_peak = voltage_max_v_rms * peak_per_rms;
    let current = carrier.electrode_current(limits.electrode_capacitance_max_f, drive_v_peak);
    let ceilings = board.ceilings();
    // The carrier bounds its volt-seconds by the peak of the header, not by the scene's largest voltage.
    let bound_v_peak = ceilings.voltage_max_v_peak(half_period_ticks);
    for (field, found, max) in [
        (ConfigField::CurrentRms, current.a_rms, limits.current_max_a_rms),
        (ConfigField::CurrentPeak, current.a_peak, limits.current_max_a_peak),
        (ConfigField::VoltagePeak, header.voltage_max_v_peak, bound_v_peak),
    ] {
        within(field, found, 0.0, max, ConfigRefusal::WHOLE_SCENE)?;
    }

    let codes_per_v = f32::from(i16::MAX) / limits.full_scale_v_peak;
    let code_max = ceilings.code(header.voltage_max_v_peak);
    let timing = CarrierTiming::new(header.waveform, half_period_ticks, peak_per_rms * codes_per_v, code_max);
    Ok((timing, voltage_max_v_rms))
}

/// The largest rms voltage of a scene on a board, within the scene's rms limit and within its peak limit at the
/// carrier's peaks.
///
/// # Errors
///
/// A carrier whose current is too large is refused.
pub fn voltage_max_v_rms(header: &Header, board: &Board) -> Result<f32, Refusal> {
    timing(header, board).map(|(_, voltage_max_v_rms)| voltage_max_v_rms).map_err(Refusal::Config)
}

/// Number of rows of a scene's inverse table that hold a piece of the curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableRows {
    /// Rows computed by the board.
    pub filled: usize,
    /// Rows that the board would compute if the scene used the largest reachable friction.
    pub whole: usize,
}

/// Begins the inverse table of a scene's finger, coating, load and carrier, up to the scene's largest target friction.
fn begin_table(
    table: &mut InverseTable,
    header: &Header,
    board: &Board,
    voltage_max_v_rms: f32,
) -> Result<InverseTableFilling, ConfigRefusal> {
    let Header { effective_gap_m, normal_load_n, .. } = *header;
    let max_n = header.electric_friction_max_n.unwrap_or(f32::INFINITY);
    let carrier = Carrier { waveform: waveform(header), ..header.carrier(&board.limits, board.tick_hz) };
    table
        .begin(&finger(header), effective_gap_m, normal_load_n, &carrier.ripple(), voltage_max_v_rms, max_n)
        .map_err(|error| no_table(&error, header, voltage_max_v_rms))
}

/// Begins the inverse table of a scene's empirical law.
fn begin_law_table(
    table: &mut InverseTable,
    header: &Header,
    law: &FingerLaw,
    voltage_max_v_rms: f32,
) -> Result<EmpiricalTableFilling, ConfigRefusal> {
    let max_n = header.electric_friction_max_n.unwrap_or(f32::INFINITY);
    table.begin_law(law.exponent(), law.points(), voltage_max_v_rms, max_n).map_err(|error| no_law(&error, law))
}

/// The invalid number of a law, and its valid range.
fn no_law(error: &LawError, law: &FingerLaw) -> ConfigRefusal {
    let (field, found, [min, max]) = match *error {
        LawError::Exponent { found } | LawError::Slope { found, .. } => {
            (ConfigField::LawExponent, found, EmpiricalLaw::EXPONENTS)
        }
        LawError::Friction { found } => (ConfigField::LawFriction, found, EmpiricalLaw::FRICTIONS_N),
        LawError::Voltage { found, max } => (ConfigField::VoltageRms, found, [f32::MIN_POSITIVE, max]),
        LawError::Order { point } => no_point(law, point),
        LawError::PointCount { .. } => no_point(law, 0),
    };
    ConfigRefusal { field, found, min, max, layer: ConfigRefusal::WHOLE_SCENE }
}

/// The quantity that does not ascend at a point: its voltage, or otherwise its friction.
fn no_point(law: &FingerLaw, number: usize) -> (ConfigField, f32, [f32; 2]) {
    let point = |number: usize| {
        law.points()
            .get(number)
            .map_or((0.0, 0.0), |&LawPoint { voltage_v_rms, electric_friction_n }| (voltage_v_rms, electric_friction_n))
    };
    let (before_v, before_n) = number.checked_sub(1).map_or((0.0, 0.0), point);
    let (found_v, found_n) = point(number);
    let [voltages, frictions] = [before_v, before_n].map(|before| [before.next_up(), f32::MAX]);
    let [min, max] = voltages;
    if found_v >= min && found_v <= max {
        (ConfigField::LawFriction, found_n, frictions)
    } else {
        (ConfigField::LawPoint, found_v, voltages)
    }
}

fn no_table(error: &TableError, header: &Header, voltage_max_v_rms: f32) -> ConfigRefusal {
    let (field, found) = match error {
        TableError::Contact => (ConfigField::EffectiveGap, header.effective_gap_m),
        _ => (ConfigField::TableRange, voltage_max_v_rms),
    };
    ConfigRefusal { field, found, min: 0.0, max: f32::INFINITY, layer: ConfigRefusal::WHOLE_SCENE }
}

/// A scene's finger.
fn finger(header: &Header) -> Finger<f32> {
    Finger {
        radius_m: header.finger_radius_m,
        stiffness_pa_per_m: header.stiffness_pa_per_m,
        friction_coefficient: header.friction_coefficient,
    }
}

/// Bytes that a scene fills in each of the two [`Active`] buffers: its layers, points, waves and clicks. The rest is
/// the same for every scene. There is no pointer among them, so the number is the same on every target.
pub fn active_bytes_filled(scene: &Scene) -> usize {
    scene.records().map(|record| active_bytes(&record)).sum::<usize>() + scene.points().len() * size_of::<Point>()
}

/// Number of inverse-table rows that a board computes for a valid scene. The table takes the same RAM for every scene;
/// omitted rows save time at a commit.
pub fn table_rows(scene: &Scene, board: &Board) -> Result<TableRows, Refusal> {
    let header = scene.header();
    let voltage_max_v_rms = voltage_max_v_rms(header, board)?;
    let rows = |header: &Header| {
        let mut table = InverseTable::EMPTY;
        let begun = match header.law() {
            Some(law) => begin_law_table(&mut table, header, law, voltage_max_v_rms).map(|filling| filling.rows()),
            None => begin_table(&mut table, header, board, voltage_max_v_rms).map(|filling| filling.rows()),
        };
        begun.map_err(Refusal::Config)
    };
    let whole = Header { electric_friction_max_n: None, ..*header };
    Ok(TableRows { filled: rows(header)?, whole: rows(&whole)? })
}
