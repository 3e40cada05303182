//! The output of a recorder: one row per fixed number of ticks.

use std::fmt::{self, Display};

use frixel_wire::fault::Flags;

use super::Observation;

/// Below this voltage the output counts as off, V rms: on the example finger it adds some micronewtons.
pub const OFF_BELOW_V_RMS: f64 = 1.0;

/// A row of `felt.csv`. An unknown value is `None`, an empty cell. Frictions are totals, averaged over the row's ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeltRow {
    /// Time since the scene began to play, at the end of the row, s.
    pub t_s: f64,
    /// The finger's place from the left edge of the screen at the end of the row, mm.
    pub x_mm: Option<f64>,
    /// The finger's place from the top edge of the screen at the end of the row, mm.
    pub y_mm: Option<f64>,
    /// The finger's speed at the end of the row, mm/s.
    pub speed_mm_s: Option<f64>,
    /// The reference: friction of the scene at the finger's place, N.
    pub reference_n: Option<f64>,
    /// The board's target, the input of its inverse: friction, N.
    pub commanded_n: Option<f64>,
    /// Friction that the finger felt, N.
    pub felt_n: Option<f64>,
    /// Natural part of the felt friction, without the drive, of a simulated finger, N.
    pub natural_n: Option<f64>,
    /// Rms voltage on the electrode over the row, V; known only in a simulated world.
    pub electrode_v_rms: Option<f64>,
    /// Rms voltage of the envelope, V, as last reported in the row.
    pub voltage_v_rms: Option<f64>,
    /// The last code in the row sent to the DAC.
    pub dac_code: Option<i16>,
    /// All flags reported by the board in the row.
    pub flags: Option<Flags>,
    /// Whether the board has received a report of the touch by the end of the row.
    pub is_tracked: bool,
}

/// Displays flags as in a recording: names joined by `+`, or `none`. Flags without a name, which newer firmware may
/// set, are displayed as a hexadecimal number.
///
/// ```
/// use frixel_felt::recorder::FlagNames;
/// use frixel_wire::fault::Flags;
///
/// assert_eq!(FlagNames(Flags::SATURATED.with(Flags::STILL)).to_string(), "saturated+still");
/// assert_eq!(FlagNames(Flags::default()).to_string(), "none");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FlagNames(pub Flags);

impl Display for FlagNames {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut joint = "";
        for name in self.0.names() {
            write!(formatter, "{joint}{name}")?;
            joint = "+";
        }
        match self.0.unnamed().0 {
            0 if self.0.0 == 0 => formatter.write_str("none"),
            0 => Ok(()),
            unnamed => write!(formatter, "{joint}0x{unnamed:04x}"),
        }
    }
}

/// Total frictions at one tick, N.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Frictions {
    pub(super) reference_n: Option<f64>,
    pub(super) commanded_n: Option<f64>,
    pub(super) felt_n: Option<f64>,
}

impl Frictions {
    /// The frictions known without a program; natural friction is then the simulated finger's.
    pub(super) fn without_reference(observation: &Observation) -> Self {
        let natural_n = observation.felt.map(|felt| felt.friction_n - felt.electric_friction_n);
        let electric_n = observation.telemetry.map(|telemetry| f64::from(telemetry.commanded_electric_friction_n));
        Self {
            reference_n: None,
            commanded_n: natural_n.zip(electric_n).map(|(natural_n, electric_n)| natural_n + electric_n),
            felt_n: observation.felt.map(|felt| felt.friction_n),
        }
    }
}

/// Makes a row for every fixed number of ticks.
///
/// With one row per millisecond and a carrier of 1 kHz, felt friction is the mean over a carrier period, and thus
/// independent of the carrier's phase at the end of the row.
#[derive(Debug, Default)]
pub(super) struct RowMaker {
    tick_period_s: f64,
    ticks_per_row: u64,
    /// End of the current row, in ticks after time zero.
    row_end: u64,
    row: FeltRow,
    reference: Mean,
    commanded: Mean,
    felt: Mean,
    natural: Mean,
    electrode_v2: Mean,
    /// Whether the board has received a report of this touch.
    is_tracked: bool,
}

impl RowMaker {
    pub(super) fn new(tick_hz: u32, ticks_per_row: u32) -> Self {
        let (tick_period_s, ticks_per_row) = (1.0 / f64::from(tick_hz), u64::from(ticks_per_row.max(1)));
        Self { tick_period_s, ticks_per_row, ..Self::default() }
    }

    /// Adds an observation `ticks` ticks after time zero. Returns the row that it completes.
    ///
    /// A row whose last tick was not observed is omitted.
    pub(super) fn add(&mut self, observation: &Observation, ticks: u64, frictions: &Frictions) -> Option<FeltRow> {
        if ticks > self.row_end {
            self.begin(ticks.div_ceil(self.ticks_per_row) * self.ticks_per_row);
        }
        self.is_tracked =
            observation.finger.is_some() && (self.is_tracked || observation.board_has_finger() == Some(true));
        self.electrode_v2.add(observation.felt.map(|felt| felt.mean_square_v2));
        self.row.dac_code = observation.dac_code.or(self.row.dac_code);
        if let Some(telemetry) = &observation.telemetry {
            self.row.voltage_v_rms = Some(f64::from(telemetry.voltage_v_rms));
            self.row.flags = Some(self.row.flags.unwrap_or_default().with(telemetry.flags));
        }
        if observation.finger.is_some() {
            self.reference.add(frictions.reference_n);
            self.commanded.add(frictions.commanded_n);
            self.felt.add(frictions.felt_n);
            self.natural.add(observation.felt.map(|felt| felt.natural_friction_n));
        }
        (ticks == self.row_end).then(|| self.finish(observation, ticks))
    }

    fn begin(&mut self, row_end: u64) {
        self.row_end = row_end;
        self.row = FeltRow::default();
        for mean in
            [&mut self.reference, &mut self.commanded, &mut self.felt, &mut self.natural, &mut self.electrode_v2]
        {
            *mean = Mean::default();
        }
    }

    fn finish(&self, observation: &Observation, ticks: u64) -> FeltRow {
        FeltRow {
            t_s: ticks as f64 * self.tick_period_s,
            x_mm: observation.finger.map(|finger| 1e3 * finger.x_m),
            y_mm: observation.finger.map(|finger| 1e3 * finger.y_m),
            speed_mm_s: observation.finger.map(|finger| 1e3 * finger.speed_m_per_s),
            reference_n: self.reference.value(),
            commanded_n: self.commanded.value(),
            felt_n: self.felt.value(),
            natural_n: self.natural.value(),
            electrode_v_rms: self.electrode_v2.value().map(f64::sqrt),
            is_tracked: self.is_tracked,
            ..self.row
        }
    }
}

/// Mean of the known values.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: Option<f64>) {
        if let Some(value) = value {
            self.sum += value;
            self.count += 1;
        }
    }

    fn value(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / f64::from(self.count))
    }
}
