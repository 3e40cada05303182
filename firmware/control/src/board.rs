//! Properties of a board that do not depend on the scene.

use frixel_wire::fault::Fault;
use frixel_wire::hello::{BoardKind, BoardLimits, Core, ResetCause};
use frixel_wire::scene::RECORDS_MAX;

use frixel_layers::{BITMAP_POOL_LEN, ticks};

use crate::{AmplifierSpec, Ceilings, ReadyWhileDisabled, SwitchingTime};

/// A board's identity, tick rate and limits. They do not change while the firmware runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Board {
    /// Kind of board.
    pub kind: BoardKind,
    /// Unique number of the board.
    pub id: [u8; 12],
    /// Ticks a second.
    pub tick_hz: u32,
    /// Limits that every scene must respect.
    pub limits: BoardLimits,
    /// Specification of the amplifier.
    pub amplifier: AmplifierSpec,
    /// Reset cause of the processor.
    pub reset_cause: ResetCause,
    /// The fault that caused the reset, and its detail number.
    pub reset_fault: Option<(Fault, u32)>,
    /// Description of that fault by the firmware, in UTF-8; empty without a fault.
    pub reset_text: &'static [u8],
    /// The host reports the finger's position. Otherwise the board has its own touch source.
    pub touch_from_host: bool,
    /// Notices of the hello that hold from the start ([`frixel_wire::hello::notice`]).
    pub notices: u8,
}

impl Board {
    /// The simulated board: the limits of the smallest real board, with an electrode that is not touched.
    ///
    /// The electrode is 2 cm^2 of bare 10 um polymer (relative permittivity 3), 0.53 nF, with edges of 20 us. The
    /// current limits suffice for a 150 V rms square carrier, with a margin; they do not imply safety for a person.
    pub const SIMULATOR: Self = Self {
        kind: BoardKind::Simulator,
        id: *b"frixel-sim\0\0",
        tick_hz: 40_000,
        limits: BoardLimits {
            bitmap_pool_bytes: BITMAP_POOL_LEN as u32,
            records_max: RECORDS_MAX as u8,
            receive_window_bytes: 4096,
            voltage_max_v_peak: 220.0,
            full_scale_v_peak: 250.0,
            edge_time_constant_s: 20e-6,
            electrode_capacitance_max_f: 0.53e-9,
            current_max_a_rms: 3e-3,
            current_max_a_peak: 15e-3,
            touch_report_period_s: 10e-3,
            tick_cycles_max: BoardLimits::SMALLEST_TICK_CYCLES_MAX,
            // It cannot be touched.
            series_resistance_ohm: f32::INFINITY,
            core: Core::CortexM4f,
        },
        // The edges' 20 us include the amplifier's own time constant. It switches at once.
        amplifier: AmplifierSpec {
            time_constant_s: 0.0,
            turn_on: SwitchingTime::from_s(0.0),
            turn_off: SwitchingTime::from_s(0.0),
            ready_while_disabled: ReadyWhileDisabled::High,
        },
        reset_cause: ResetCause::PowerOn,
        reset_fault: None,
        reset_text: b"",
        touch_from_host: false,
        notices: 0,
    };

    /// The NUCLEO-G474RE with the parts listed in `docs/board/hardware.md`, until bring-up has stored other limits.
    /// Another amplifier, series resistor or electrode needs other numbers.
    pub const NUCLEO_G474RE: Self = Self {
        kind: BoardKind::NucleoG474re,
        id: [0; 12],
        limits: BoardLimits {
            // Until the board has been measured.
            voltage_max_v_peak: 50.0,
            // 10 V of the DAC behind an amplifier of gain 20.
            full_scale_v_peak: 200.0,
            // The single lag with the same loss of mean square as 68 kOhm in series with the electrode below, 36 us,
            // behind an amplifier of 20 kHz, 8 us.
            edge_time_constant_s: 37.5e-6,
            // 2 cm^2 of bare 10 um polymer, relative permittivity 3.
            electrode_capacitance_max_f: 0.53e-9,
            // The limit for touch currents in normal use of IEC 61010-1, without frequency weighting.
            current_max_a_rms: 0.5e-3,
            // The current through the series resistor for an edge from 50 V to -50 V, 1.47 mA, plus a fifth.
            current_max_a_peak: 1.8e-3,
            // Two resistors of 34 kOhm, 1 %. They allow 28.6 V peak at a carrier of 125 Hz, 43.8 V at 1 kHz, and 50 V
            // from 2.2 kHz on (`frixel_model::TouchBound`).
            series_resistance_ohm: 68e3,
            ..Self::SIMULATOR.limits
        },
        // As required by `docs/board/hardware.md`.
        amplifier: AmplifierSpec {
            // A large-signal bandwidth of 20 kHz. The series resistor is behind the monitor.
            time_constant_s: 8e-6,
            // Assumed.
            turn_on: SwitchingTime::from_s(1e-3),
            turn_off: SwitchingTime::from_s(1e-3),
            ready_while_disabled: ReadyWhileDisabled::High,
        },
        touch_from_host: true,
        ..Self::SIMULATOR
    };

    /// The Raspberry Pi Pico 2 with the parts and the limits of the NUCLEO-G474RE. Its image allows
    /// [`Self::UNMEASURED_V_PEAK`] until limits are stored.
    pub const PICO_2: Self = Self {
        kind: BoardKind::Pico2,
        limits: BoardLimits {
            // 60 % of the 3,750 cycles between two ticks of the RP2350 at 150 MHz, estimated like a Cortex-M4F with
            // flash wait states; its Cortex-M33 runs the tick from RAM, without them.
            tick_cycles_max: 2_250,
            ..Self::NUCLEO_G474RE.limits
        },
        ..Self::NUCLEO_G474RE
    };

    /// The Raspberry Pi Pico with the same parts. It emulates floating-point arithmetic in software, so its tick rate
    /// is a fifth of the others', and it plays little more than one layer.
    pub const PICO: Self = Self {
        kind: BoardKind::Pico,
        tick_hz: 8_000,
        limits: BoardLimits {
            // Of the 25,000 cycles between two ticks of the RP2040 at 200 MHz. Work outside of the estimate takes up to
            // 7,750 more (on its emulator: an order, the ready line, monitor and switch, the status for the main loop),
            // so a seventh of the tick remains. The board must support a grating, estimated at about 13,410.
            tick_cycles_max: 13_450,
            core: Core::CortexM0Plus,
            ..Self::NUCLEO_G474RE.limits
        },
        ..Self::NUCLEO_G474RE
    };

    /// Largest voltage until limits are stored, V peak, for a Pico, a Pico 2, and a NUCLEO-G474RE built for another
    /// series resistance. DAC, amplifier, monitor, one-shot and resistance are not measured by a bring-up before a
    /// first play. This voltage is therefore harmless even if gain or reference is twice the nominal value, or the
    /// resistance half of it.
    pub const UNMEASURED_V_PEAK: f32 = 10.0;

    /// The largest voltage that its image allows until limits are stored, V peak, if that is less than its own: behind
    /// another resistance, and on a Pico or a Pico 2, for which there is no bring-up yet.
    pub fn until_measured_v_peak(&self) -> Option<f32> {
        let [ohm, built_in_ohm] =
            [self, &Self::NUCLEO_G474RE].map(|board| board.limits.series_resistance_ohm.to_bits());
        let is_unmeasured = match self.kind {
            BoardKind::Pico | BoardKind::Pico2 => true,
            BoardKind::NucleoG474re => ohm != built_in_ohm,
            _ => false,
        };
        is_unmeasured.then_some(Self::UNMEASURED_V_PEAK)
    }

    /// The real boards with their names, the default first.
    pub const NAMED: [(&'static str, Self); 3] =
        [("nucleo-g474re", Self::NUCLEO_G474RE), ("pico-2", Self::PICO_2), ("pico", Self::PICO)];

    /// This board with another resistance between amplifier and electrode, and with the full scale stored as its
    /// largest voltage. The edges and the touch bound are those of the resistance.
    #[must_use]
    pub const fn behind(self, series_resistance_ohm: f32) -> Self {
        let electrode_s = series_resistance_ohm * self.limits.electrode_capacitance_max_f;
        let amplifier_s = self.amplifier.time_constant_s;
        // Two successive lags as one (`frixel_model::Carrier`).
        let edge_time_constant_s = electrode_s + amplifier_s - electrode_s * amplifier_s / (electrode_s + amplifier_s);
        let voltage_max_v_peak = self.limits.full_scale_v_peak;
        let limits = BoardLimits { voltage_max_v_peak, edge_time_constant_s, series_resistance_ohm, ..self.limits };
        Self { limits, ..self }
    }

    /// The ceilings of this board's output.
    pub fn ceilings(&self) -> Ceilings {
        Ceilings::new(self)
    }

    /// Seconds between two ticks.
    pub fn tick_period_s(&self) -> f32 {
        1.0 / self.tick_hz as f32
    }

    /// The number of ticks nearest to a time.
    pub fn ticks(&self, time_s: f32) -> u32 {
        ticks(time_s, self.tick_hz)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_behind_its_own_resistance_has_its_own_edges() {
        let BoardLimits { series_resistance_ohm, edge_time_constant_s, .. } = Board::NUCLEO_G474RE.limits;
        let behind = Board::NUCLEO_G474RE.behind(series_resistance_ohm).limits;
        assert!((behind.edge_time_constant_s / edge_time_constant_s - 1.0).abs() < 0.01, "{behind:?}");
        assert_eq!(behind.voltage_max_v_peak.to_bits(), behind.full_scale_v_peak.to_bits());
        let twice = Board::NUCLEO_G474RE.behind(2.0 * series_resistance_ohm).limits;
        assert!(twice.edge_time_constant_s > 1.8 * edge_time_constant_s, "{twice:?}");
    }
}
