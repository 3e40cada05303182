//! Stored form of the limits that were measured on a board during bring-up.

use frixel_wire::hello::BoardLimits;

/// Version of the layout.
const VERSION: u32 = 1;
/// Bytes of the stored limits: the version, then six numbers.
pub const LIMITS_LEN: usize = 28;
/// Largest voltage that is accepted, in V peak: no electrovibration screen takes more.
const VOLTAGE_MAX_V_PEAK: f32 = 500.0;
/// Upper bound of all stored numbers, in any unit.
const NUMBER_MAX: f32 = 1e9;

/// Writes the measured limits as bytes to store.
pub fn write_limits(limits: &BoardLimits) -> [u8; LIMITS_LEN] {
    let mut bytes = [0; LIMITS_LEN];
    let numbers = measured(limits).map(f32::to_bits);
    for (to, from) in bytes.as_chunks_mut().0.iter_mut().zip([VERSION].into_iter().chain(numbers)) {
        *to = from.to_le_bytes();
    }
    bytes
}

/// Returns `limits` with the stored numbers; `None` if their layout is unknown or a number is out of range.
pub fn read_limits(bytes: &[u8; LIMITS_LEN], limits: &BoardLimits) -> Option<BoardLimits> {
    let (words, _) = bytes.as_chunks::<4>();
    let [version, numbers @ ..] = words else { return None };
    let mut numbers = numbers.iter().map(|number| f32::from_le_bytes(*number));
    let plausible = numbers.clone().all(|number| number > 0.0 && number < NUMBER_MAX);
    let limits = BoardLimits {
        voltage_max_v_peak: numbers.next()?,
        full_scale_v_peak: numbers.next()?,
        edge_time_constant_s: numbers.next()?,
        electrode_capacitance_max_f: numbers.next()?,
        current_max_a_rms: numbers.next()?,
        current_max_a_peak: numbers.next()?,
        ..*limits
    };
    let plausible = plausible
        && limits.voltage_max_v_peak <= limits.full_scale_v_peak
        && limits.voltage_max_v_peak <= VOLTAGE_MAX_V_PEAK;
    (u32::from_le_bytes(*version) == VERSION && plausible).then_some(limits)
}

/// The numbers that are measured during bring-up, in the order in which they are stored.
fn measured(limits: &BoardLimits) -> [f32; 6] {
    [
        limits.voltage_max_v_peak,
        limits.full_scale_v_peak,
        limits.edge_time_constant_s,
        limits.electrode_capacitance_max_f,
        limits.current_max_a_rms,
        limits.current_max_a_peak,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use frixel_control::Board;

    const DEFAULTS: BoardLimits = Board::SIMULATOR.limits;

    #[test]
    fn limits_come_back_as_they_were() {
        let limits = BoardLimits {
            voltage_max_v_peak: 120.0,
            full_scale_v_peak: 201.5,
            edge_time_constant_s: 23e-6,
            electrode_capacitance_max_f: 0.4e-9,
            current_max_a_rms: 0.4e-3,
            current_max_a_peak: 2e-3,
            ..DEFAULTS
        };
        assert_eq!(read_limits(&write_limits(&limits), &DEFAULTS), Some(limits));
    }

    #[test]
    fn numbers_that_no_board_has_are_not_believed() {
        for limits in [
            BoardLimits { voltage_max_v_peak: 501.0, full_scale_v_peak: 600.0, ..DEFAULTS },
            BoardLimits { voltage_max_v_peak: DEFAULTS.full_scale_v_peak * 1.1, ..DEFAULTS },
            BoardLimits { voltage_max_v_peak: f32::NAN, ..DEFAULTS },
            BoardLimits { full_scale_v_peak: f32::INFINITY, ..DEFAULTS },
            BoardLimits { edge_time_constant_s: 0.0, ..DEFAULTS },
            BoardLimits { electrode_capacitance_max_f: -1e-9, ..DEFAULTS },
            BoardLimits { current_max_a_rms: f32::NAN, ..DEFAULTS },
        ] {
            assert_eq!(read_limits(&write_limits(&limits), &DEFAULTS), None, "{limits:?}");
        }
        let mut bytes = write_limits(&DEFAULTS);
        bytes[0] += 1;
        assert_eq!(read_limits(&bytes, &DEFAULTS), None);
    }
}
