//! Spans of consecutive rows of a play, for pictures.

use frixel_felt::recorder::{FeltRow, OFF_BELOW_V_RMS};
use frixel_wire::fault::Flags;

/// Part of a span's rows from which on the span counts as off. In a long play, the moments at which the finger turns
/// are a smaller part; in a play of up to ten minutes, a pause of a tenth of a second is a larger one.
const OFF_PART_MIN: f64 = 0.1;

/// The flags that switch the output off, the strongest reason first, and what they mean on a screen with a finger.
pub(super) const OFF_REASONS: [(Flags, &str); 5] = [
    (Flags::HOST_SILENT, "the host is silent"),
    (Flags::TOUCH_STALE, "the touch reports are too old"),
    (Flags::NO_FINGER, "no finger is reported to the board: touch reports are late or lost"),
    (Flags::STILL, "the finger stands still"),
    (Flags::STREAM_DRY, "the stream has no samples"),
];

/// A layer registered by [`Trace::layer`](super::trace::Trace::layer).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TracedLayer {
    /// Index of its title.
    pub(super) index: usize,
    pub(super) is_off: bool,
}

/// The extremes over consecutive rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) start_s: f64,
    pub(super) end_s: f64,
    pub(super) reference_n: Option<Extremes>,
    pub(super) commanded_n: Option<Extremes>,
    pub(super) felt_n: Option<Extremes>,
    pub(super) voltage_v_rms: Option<Extremes>,
    /// Length of the finger's path at the end of the span, mm.
    pub(super) path_mm: f64,
    /// The topmost layer under the finger at the end of the span.
    pub(super) layer: Option<TracedLayer>,
    pub(super) rows: u32,
    pub(super) off_rows: u32,
    /// The strongest reason for which the output is off in one of these rows, an index into [`OFF_REASONS`].
    pub(super) off_reason: Option<usize>,
}

/// Least and largest value of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extremes {
    pub(super) least: f64,
    pub(super) largest: f64,
}

impl Extremes {
    fn of(value: Option<f64>) -> Option<Self> {
        value.filter(|value| value.is_finite()).map(|value| Self { least: value, largest: value })
    }

    /// The extremes of both ranges together.
    pub(super) fn joined(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), largest: self.largest.max(other.largest) }
    }

    fn join(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        match (one, other) {
            (Some(one), Some(other)) => Some(one.joined(other)),
            _ => one.or(other),
        }
    }
}

impl Span {
    pub(super) fn of(row: &FeltRow, path_mm: f64, layer: Option<TracedLayer>) -> Self {
        let off_reason = off_reason(row);
        Self {
            path_mm,
            layer,
            rows: 1,
            off_rows: u32::from(off_reason.is_some()),
            off_reason,
            start_s: row.t_s,
            end_s: row.t_s,
            reference_n: Extremes::of(row.reference_n),
            commanded_n: Extremes::of(row.commanded_n),
            felt_n: Extremes::of(row.felt_n),
            voltage_v_rms: Extremes::of(row.voltage_v_rms),
        }
    }

    pub(super) fn join(&self, later: &Self) -> Self {
        Self {
            start_s: self.start_s,
            end_s: later.end_s,
            reference_n: Extremes::join(self.reference_n, later.reference_n),
            commanded_n: Extremes::join(self.commanded_n, later.commanded_n),
            felt_n: Extremes::join(self.felt_n, later.felt_n),
            path_mm: later.path_mm,
            layer: later.layer,
            rows: self.rows + later.rows,
            off_rows: self.off_rows + later.off_rows,
            off_reason: self.off_reason.into_iter().chain(later.off_reason).min(),
            voltage_v_rms: Extremes::join(self.voltage_v_rms, later.voltage_v_rms),
        }
    }

    /// The reason for which the output is off; `None` if it is on for nearly all of the span.
    pub(super) fn off(&self) -> Option<usize> {
        self.off_reason.filter(|_| f64::from(self.off_rows) >= OFF_PART_MIN * f64::from(self.rows))
    }
}

/// The reason for which the output is off in a row, an index into [`OFF_REASONS`]; `None` if it is on, if there is no
/// finger, and if the scene has no friction there.
fn off_reason(row: &FeltRow) -> Option<usize> {
    let is_off = row.x_mm.is_some() && row.voltage_v_rms.is_some_and(|voltage_v_rms| voltage_v_rms < OFF_BELOW_V_RMS);
    let flags = row.flags.filter(|_| is_off)?;
    OFF_REASONS.iter().position(|(flag, _)| flags.contains(*flag))
}
