//! Stored form of the limits measured on a board during bring-up, and their ceilings.
//!
//! Measured limits are typed in by a person, and the board cannot detect a wrong number. They are therefore bounded
//! twice, when stored and when read back: by [`VOLTAGE_CEILING_V_PEAK`], [`CURRENT_CEILING_A_RMS`] and
//! [`CURRENT_CEILING_A_PEAK`], and by the series resistance of the build. The ceilings apply to boards that people
//! touch: a simulated board stores no limits, and has its own. None of this is a certification.

use core::fmt;

use frixel_wire::hello::{BoardLimits, notice};

use super::{Flash, Slot, WORD_LEN};

/// Bytes of the stored limits: the version, then seven numbers.
pub const LIMITS_LEN: usize = 4 * WORD_LEN;

/// Largest voltage that may be stored, in V peak.
///
/// It is the rating of the parts in `docs/board/hardware.md`. The limit for a person who touches the electrode is
/// separate: it follows from the series resistance, and is not stored (`frixel_model::TouchBound`).
pub const VOLTAGE_CEILING_V_PEAK: f32 = 200.0;
/// Largest rms current that may be stored, in A: the limit of IEC 61010-1, 6.3.1 (original not read), for normal use.
///
/// The board compares currents without the weighting of IEC 60990, which only reduces them: for a sine of 1 kHz by a
/// factor of 1.7, the margin.
pub const CURRENT_CEILING_A_RMS: f32 = 0.5e-3;
/// Largest peak current that may be stored, in A: the limit of IEC 61010-1, 6.3.2 (original not read), for a
/// single-fault condition.
///
/// Also compared without the weighting of IEC 60990. With it, a current of 5 mA that decays within 36 us, as at the
/// carrier's edges with 68 kOhm, counts as 0.51 mA of the 0.7 mA of 6.3.1: a margin of 27 %.
pub const CURRENT_CEILING_A_PEAK: f32 = 5e-3;

/// Largest relative deviation of the stored limits' series resistance from the build's.
const SERIES_TOLERANCE: f32 = 0.01;
/// Smallest and largest edge time, relative to the time constant of the electrode with the series resistance. Bring-up
/// accepts 0.7 to 1.4 for the capacitor that it measures on, and an amplifier as slow as the resistor adds half as much
/// again.
const EDGES_MIN: f32 = 0.7;
const EDGES_MAX: f32 = 2.1;
/// Relative tolerance of a ceiling, because numbers typed in mA are rounded.
const ROUNDING: f32 = 1e-6;
/// Largest plausible voltage without ceilings, in V peak: no electrovibration screen withstands more.
const VOLTAGE_MAX_V_PEAK: f32 = 500.0;
/// Upper bound of all stored numbers, in any unit.
const NUMBER_MAX: f32 = 1e9;

/// Whether a firmware build bounds the stored limits by the ceilings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CeilingPolicy {
    /// Limits above a ceiling are refused. The default of every build.
    InForce,
    /// Limits above the ceilings are stored and used, with a notice in the hello ([`notice::LIMITS_ABOVE_CEILINGS`]).
    Lifted,
}

impl CeilingPolicy {
    /// Version of the layout, which differs so that a build refuses limits stored by a build of the other kind.
    const fn version(self) -> u32 {
        match self {
            Self::InForce => 1,
            Self::Lifted => 2,
        }
    }

    /// The notices of a board built with these ceilings.
    const fn notices(self) -> u8 {
        match self {
            Self::InForce => 0,
            Self::Lifted => notice::LIMITS_ABOVE_CEILINGS,
        }
    }
}

/// Why limits are not stored, or stored limits are not used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitsError {
    /// Another build with a different layout has stored them.
    Layout,
    /// A number is not positive or not finite, or the voltage is above the full scale or above 500 V.
    Implausible,
    /// The voltage is above [`VOLTAGE_CEILING_V_PEAK`].
    VoltagePeak {
        /// The voltage, in V peak.
        found: f32,
    },
    /// The rms current is above [`CURRENT_CEILING_A_RMS`].
    CurrentRms {
        /// The current, in A.
        found: f32,
    },
    /// The peak current is above [`CURRENT_CEILING_A_PEAK`].
    CurrentPeak {
        /// The current, in A.
        found: f32,
    },
    /// The current of an amplifier rail over the series resistance is above [`CURRENT_CEILING_A_PEAK`]. An amplifier
    /// stuck at the rail would drive that current through a person.
    CurrentAtRail {
        /// The current, in A.
        found: f32,
    },
    /// The limits were stored for another series resistance than this build's, on which the touch bound is based.
    SeriesResistance {
        /// The series resistance of the stored limits, in Ohm.
        found_ohm: f32,
        /// The series resistance of this build, in Ohm.
        built_in_ohm: f32,
    },
    /// The edges do not match the electrode and the series resistance: one of the three numbers is wrong.
    Edges {
        /// The time constant of the edges, in s.
        found_s: f32,
        /// The time constant of the electrode with the series resistance, in s.
        expected_s: f32,
    },
}

impl fmt::Display for LimitsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Layout => f.write_str("the stored limits are of another firmware build: store them again"),
            Self::Implausible => f.write_str(
                "the limits must be positive numbers, and the largest voltage at most the full scale and 500 V: \
                 measure again",
            ),
            Self::VoltagePeak { found } => {
                write!(
                    f,
                    "the largest voltage is {found} V peak, and its ceiling is {VOLTAGE_CEILING_V_PEAK} V: lower it"
                )
            }
            Self::CurrentRms { found } => write!(
                f,
                "the largest current is {} mA rms, and its ceiling is {} mA: lower it",
                1e3 * found,
                1e3 * CURRENT_CEILING_A_RMS
            ),
            Self::CurrentPeak { found } => write!(
                f,
                "the largest current is {} mA peak, and its ceiling is {} mA: lower it",
                1e3 * found,
                1e3 * CURRENT_CEILING_A_PEAK
            ),
            Self::CurrentAtRail { found } => write!(
                f,
                "an amplifier that is stuck at a rail drives {} mA through the series resistance, and its ceiling is \
                 {} mA: use a larger resistance",
                1e3 * found,
                1e3 * CURRENT_CEILING_A_PEAK
            ),
            Self::SeriesResistance { found_ohm, built_in_ohm } => write!(
                f,
                "the limits were stored for a series resistance of {} kOhm, and this build is for {} kOhm: build it \
                 for the resistance that is soldered",
                1e-3 * found_ohm,
                1e-3 * built_in_ohm
            ),
            Self::Edges { found_s, expected_s } => write!(
                f,
                "the edges are {} us, but the electrode behind the series resistance gives {} us: correct edges, \
                 electrode or resistance",
                1e6 * found_s,
                1e6 * expected_s
            ),
        }
    }
}

impl core::error::Error for LimitsError {}

/// Largest ratio of a rail of the amplifier to the full scale (`hardware/carrier.toml`, PS1).
pub const RAIL_MAX: f32 = 1.05;

/// Checks limits of a board that people touch against the ceilings. A board asserts this for its built-in limits.
pub const fn check_touched_board(limits: &BoardLimits) -> Result<(), LimitsError> {
    const fn exceeds(number: f32, ceiling: f32) -> bool {
        number > ceiling * (1.0 + ROUNDING)
    }
    let at_rail_a = RAIL_MAX * limits.full_scale_v_peak / limits.series_resistance_ohm;
    if exceeds(limits.voltage_max_v_peak, VOLTAGE_CEILING_V_PEAK) {
        Err(LimitsError::VoltagePeak { found: limits.voltage_max_v_peak })
    } else if exceeds(limits.current_max_a_rms, CURRENT_CEILING_A_RMS) {
        Err(LimitsError::CurrentRms { found: limits.current_max_a_rms })
    } else if exceeds(limits.current_max_a_peak, CURRENT_CEILING_A_PEAK) {
        Err(LimitsError::CurrentPeak { found: limits.current_max_a_peak })
    } else if exceeds(at_rail_a, CURRENT_CEILING_A_PEAK) {
        Err(LimitsError::CurrentAtRail { found: at_rail_a })
    } else {
        check_edges(limits)
    }
}

/// Checks that the edges match the electrode and the series resistance. No board that stores limits has an infinite
/// series resistance, which has no touch bound.
const fn check_edges(limits: &BoardLimits) -> Result<(), LimitsError> {
    let found_s = limits.edge_time_constant_s;
    let expected_s = limits.series_resistance_ohm * limits.electrode_capacitance_max_f;
    if found_s >= EDGES_MIN * expected_s && found_s <= EDGES_MAX * expected_s {
        Ok(())
    } else {
        Err(LimitsError::Edges { found_s, expected_s })
    }
}

/// Writes the measured limits as bytes to store. Refuses limits that [`read_limits`] would refuse.
pub fn write_limits(limits: &BoardLimits, ceilings: CeilingPolicy) -> Result<[u8; LIMITS_LEN], LimitsError> {
    check(limits, ceilings)?;
    let mut bytes = [0; LIMITS_LEN];
    let numbers = measured(limits).map(f32::to_bits);
    for (to, from) in bytes.as_chunks_mut().0.iter_mut().zip([ceilings.version()].into_iter().chain(numbers)) {
        *to = from.to_le_bytes();
    }
    Ok(bytes)
}

/// Returns `limits` with the stored numbers.
pub fn read_limits(
    bytes: &[u8; LIMITS_LEN],
    limits: &BoardLimits,
    ceilings: CeilingPolicy,
) -> Result<BoardLimits, LimitsError> {
    let (words, _) = bytes.as_chunks::<4>();
    let [version, numbers @ ..] = words else { return Err(LimitsError::Layout) };
    let &[voltage, full_scale, edge, electrode, current_rms, current_peak, series] = numbers else {
        return Err(LimitsError::Layout);
    };
    if u32::from_le_bytes(*version) != ceilings.version() {
        return Err(LimitsError::Layout);
    }
    let (found_ohm, built_in_ohm) = (f32::from_le_bytes(series), limits.series_resistance_ohm);
    let is_of_build = (found_ohm - built_in_ohm).abs() <= SERIES_TOLERANCE * built_in_ohm;
    if !is_of_build {
        return Err(LimitsError::SeriesResistance { found_ohm, built_in_ohm });
    }
    let limits = BoardLimits {
        voltage_max_v_peak: f32::from_le_bytes(voltage),
        full_scale_v_peak: f32::from_le_bytes(full_scale),
        edge_time_constant_s: f32::from_le_bytes(edge),
        electrode_capacitance_max_f: f32::from_le_bytes(electrode),
        current_max_a_rms: f32::from_le_bytes(current_rms),
        current_max_a_peak: f32::from_le_bytes(current_peak),
        ..*limits
    };
    check(&limits, ceilings).map(|()| limits)
}

/// The initial limits of a board, and its notices: the limits stored in `slot`, or the built-in ones. `flash` is `None`
/// on a board without a usable flash. Stored limits that are refused, damaged or have another build's layout are
/// ignored, with a notice.
pub fn load_limits<F: Flash>(
    flash: Option<&F>,
    slot: Slot,
    built_in: &BoardLimits,
    ceilings: CeilingPolicy,
) -> (BoardLimits, u8) {
    let stored = flash.and_then(|flash| slot.find(flash));
    match stored.map(|bytes| read_limits(&bytes, built_in, ceilings)) {
        None if flash.is_none_or(|flash| slot.is_erased(flash)) => (*built_in, ceilings.notices()),
        Some(Ok(limits)) => (limits, ceilings.notices()),
        None | Some(Err(_)) => (*built_in, ceilings.notices() | notice::STORED_LIMITS_REFUSED),
    }
}

fn check(limits: &BoardLimits, ceilings: CeilingPolicy) -> Result<(), LimitsError> {
    let is_plausible = measured(limits).iter().all(|number| *number > 0.0 && *number < NUMBER_MAX)
        && limits.voltage_max_v_peak <= limits.full_scale_v_peak
        && limits.voltage_max_v_peak <= VOLTAGE_MAX_V_PEAK;
    match ceilings {
        _ if !is_plausible => Err(LimitsError::Implausible),
        CeilingPolicy::InForce => check_touched_board(limits),
        CeilingPolicy::Lifted => check_edges(limits),
    }
}

/// The numbers measured or asked for by bring-up, in the order in which they are stored.
fn measured(limits: &BoardLimits) -> [f32; 7] {
    [
        limits.voltage_max_v_peak,
        limits.full_scale_v_peak,
        limits.edge_time_constant_s,
        limits.electrode_capacitance_max_f,
        limits.current_max_a_rms,
        limits.current_max_a_peak,
        limits.series_resistance_ohm,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use frixel_control::Board;

    const DEFAULTS: BoardLimits = Board::NUCLEO_G474RE.limits;
    const MEASURED: BoardLimits = BoardLimits {
        voltage_max_v_peak: 120.0,
        full_scale_v_peak: 201.5,
        edge_time_constant_s: 23e-6,
        electrode_capacitance_max_f: 0.4e-9,
        current_max_a_rms: 0.4e-3,
        current_max_a_peak: 2e-3,
        ..DEFAULTS
    };

    /// Limits of a build without ceilings, as if this build had stored them.
    fn forged(limits: &BoardLimits) -> [u8; LIMITS_LEN] {
        let words = [CeilingPolicy::InForce.version()].into_iter().chain(measured(limits).map(f32::to_bits));
        words.flat_map(u32::to_le_bytes).collect::<Vec<_>>().try_into().unwrap()
    }

    #[test]
    fn implausible_numbers_are_refused() {
        for limits in [
            BoardLimits { voltage_max_v_peak: 501.0, full_scale_v_peak: 600.0, ..MEASURED },
            BoardLimits { voltage_max_v_peak: MEASURED.full_scale_v_peak * 1.1, ..MEASURED },
            BoardLimits { voltage_max_v_peak: f32::NAN, ..MEASURED },
            BoardLimits { full_scale_v_peak: f32::INFINITY, ..MEASURED },
            BoardLimits { edge_time_constant_s: 0.0, ..MEASURED },
            BoardLimits { electrode_capacitance_max_f: -1e-9, ..MEASURED },
            BoardLimits { current_max_a_rms: f32::NAN, ..MEASURED },
        ] {
            for ceilings in [CeilingPolicy::InForce, CeilingPolicy::Lifted] {
                assert_eq!(write_limits(&limits, ceilings), Err(LimitsError::Implausible), "{limits:?}");
            }
            let read = read_limits(&forged(&limits), &DEFAULTS, CeilingPolicy::InForce);
            assert_eq!(read, Err(LimitsError::Implausible), "{limits:?}");
        }
    }

    #[test]
    fn limits_above_a_ceiling_are_neither_stored_nor_read_back() {
        let above = |ceiling: f32| ceiling * 1.001;
        let (volts, rms, peak) = (above(200.0), above(0.5e-3), above(5e-3));
        for (limits, error) in [
            (BoardLimits { voltage_max_v_peak: volts, ..MEASURED }, LimitsError::VoltagePeak { found: volts }),
            (BoardLimits { current_max_a_rms: rms, ..MEASURED }, LimitsError::CurrentRms { found: rms }),
            (BoardLimits { current_max_a_peak: peak, ..MEASURED }, LimitsError::CurrentPeak { found: peak }),
        ] {
            assert_eq!(write_limits(&limits, CeilingPolicy::InForce), Err(error));
            assert_eq!(read_limits(&forged(&limits), &DEFAULTS, CeilingPolicy::InForce), Err(error));
            assert!(error.to_string().contains("ceiling"), "{error}");
            let bytes = write_limits(&limits, CeilingPolicy::Lifted).unwrap();
            assert_eq!(read_limits(&bytes, &DEFAULTS, CeilingPolicy::Lifted), Ok(limits));
        }
        // As bring-up computes them from numbers in mA.
        let at_the_ceilings = BoardLimits {
            voltage_max_v_peak: 200.0,
            current_max_a_rms: 0.5 * 1e-3,
            current_max_a_peak: 5.0 * 1e-3,
            ..MEASURED
        };
        assert!(write_limits(&at_the_ceilings, CeilingPolicy::InForce).is_ok());
    }

    #[test]
    fn limits_of_a_board_with_another_series_resistance_are_refused() {
        let stored = write_limits(&DEFAULTS, CeilingPolicy::InForce).unwrap();
        for (series_ohm, is_taken) in
            [(67e3, false), (67.5e3, true), (68.5e3, true), (69e3, false), (75e3, false), (370e3, false)]
        {
            let built_in = Board::NUCLEO_G474RE.behind(series_ohm).limits;
            let read = read_limits(&stored, &built_in, CeilingPolicy::InForce);
            assert_eq!(read.is_ok(), is_taken, "{series_ohm}: {read:?}");
            let error = LimitsError::SeriesResistance { found_ohm: 68e3, built_in_ohm: series_ohm };
            assert!(is_taken || read == Err(error), "{series_ohm}: {read:?}");
        }
    }

    /// A capacitance in another unit would make every current a thousandth.
    #[test]
    fn edges_inconsistent_with_resistance_and_electrode_are_neither_stored_nor_read_back() {
        for (edges_us, electrode_nf, is_taken) in [
            (37.5, 0.53e-3, false),
            (37.5, 530.0, false),
            (20.0, 0.53, false),
            (25.0, 0.53, false),
            (25.5, 0.53, true),
            (75.5, 0.53, true),
            (76.0, 0.53, false),
        ] {
            let limits = BoardLimits {
                edge_time_constant_s: 1e-6 * edges_us,
                electrode_capacitance_max_f: 1e-9 * electrode_nf,
                ..DEFAULTS
            };
            let read = read_limits(&forged(&limits), &DEFAULTS, CeilingPolicy::InForce);
            for ceilings in [CeilingPolicy::InForce, CeilingPolicy::Lifted] {
                assert_eq!(write_limits(&limits, ceilings).is_ok(), is_taken, "{edges_us} us, {electrode_nf} nF");
            }
            assert!(is_taken && read.is_ok() || matches!(read, Err(LimitsError::Edges { .. })), "{read:?}");
        }
        let untouched = BoardLimits { series_resistance_ohm: f32::INFINITY, ..DEFAULTS };
        assert_eq!(write_limits(&untouched, CeilingPolicy::InForce), Err(LimitsError::Implausible));
        assert!(check_touched_board(&untouched).is_err());
    }

    #[test]
    fn a_resistance_too_low_for_an_amplifier_stuck_at_a_rail_is_refused() {
        for (series_ohm, is_taken) in [(41.9e3, false), (42.1e3, true), (374e3, true)] {
            let limits = Board::NUCLEO_G474RE.behind(series_ohm).limits;
            let found = check_touched_board(&limits);
            assert_eq!(found.is_ok(), is_taken, "{series_ohm}: {found:?}");
            assert!(is_taken || matches!(found, Err(LimitsError::CurrentAtRail { .. })), "{found:?}");
        }
    }
}
