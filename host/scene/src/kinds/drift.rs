//! The speed field of moving gratings and rings.

use frixel_layers::range::DRIFT_HZ;

use super::*;

const DRIFT: FieldSpec = number(
    "drift_mm_per_s",
    Range::new(-1000.0, 1000.0, " mm/s"),
    Number(0.0),
    "speed of the pattern: stripes move in the direction of `angle_deg`, rings outwards; negative: the other way. It \
     is felt while the finger slides",
);

/// Reads the speed of stripes or rings, mm/s; 0 if they do not move. Reports a drift that exceeds the board's limit on
/// waves per second.
pub(super) fn read(fields: &mut Fields, wavelength_mm: Option<f64>, log: &mut Log) -> f64 {
    let found_mm_per_s = fields.number_or_default(log, &DRIFT);
    let max_hz = DRIFT_HZ.max;
    if let Some(wavelength_mm) = wavelength_mm.filter(|length_mm| drift_hz(found_mm_per_s, *length_mm).abs() > max_hz) {
        let max_mm_per_s = max_hz * wavelength_mm;
        let mistake = FieldMistake::DriftsTooFast { found_mm_per_s, wavelength_mm, max_hz, max_mm_per_s };
        log.add(fields.places().field(DRIFT.name), mistake);
    }
    found_mm_per_s
}

/// Waves per second that pass a place, Hz.
pub(super) fn drift_hz(drift_mm_per_s: f64, wavelength_mm: f64) -> f64 {
    drift_mm_per_s / wavelength_mm
}
