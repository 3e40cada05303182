//! Faults around a board: its amplifier, its DAC, its arm switch, its touch source, and the finger.

use core::ops::Range;

use frixel_control::Drive;
use frixel_session::Touch;
use frixel_wire::dac_code::DacCode;

use crate::amplifier::AmplifierConfig;
use crate::error::OutOfRange;

/// A fault around a board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WorldFault {
    /// The amplifier reports that it is not ready, as after an over-current, but keeps working. The board must disable
    /// it.
    AmplifierNotReady,
    /// A disabled amplifier holds its output voltage.
    AmplifierStuckOn,
    /// Gain of the amplifier's output, above 0. A sagging supply gives less than 1.
    AmplifierGain(f64),
    /// A disabled amplifier holds its output for this time, in seconds: 0 to 10.
    AmplifierSlowOff {
        /// In seconds: 0 to 10.
        delay_s: f64,
    },
    /// Gain of the monitor. Finite; 0 for a dead one.
    MonitorGain(f64),
    /// The DAC holds this code, regardless of the board.
    DacStuck(DacCode),
    /// The arm switch is released.
    SwitchOpen,
    /// The arm switch stays closed, as if welded.
    SwitchWelded,
    /// No touch report arrives.
    TouchSilent,
    /// Every touch report has the place of the first one, even after the finger has lifted.
    TouchStuck,
    /// Every second touch report is offset by this distance in x, in metres. Finite.
    TouchJumps {
        /// In metres.
        by_m: f64,
    },
    /// The finger is off the screen.
    FingerLifted,
}

impl WorldFault {
    /// Checks the numbers of a fault of the amplifier.
    #[cfg(unix)]
    pub(crate) fn check(self) -> Result<(), OutOfRange> {
        self.of_amplifier(AmplifierConfig::IDEAL).check()
    }

    /// The amplifier with this fault.
    fn of_amplifier(self, amplifier: AmplifierConfig) -> AmplifierConfig {
        match self {
            Self::AmplifierStuckOn => AmplifierConfig { is_stuck_on: true, ..amplifier },
            Self::AmplifierGain(gain) => AmplifierConfig { gain: amplifier.gain * gain, ..amplifier },
            Self::AmplifierSlowOff { delay_s } => AmplifierConfig { turn_off_delay_s: delay_s, ..amplifier },
            Self::MonitorGain(monitor_gain) => AmplifierConfig { monitor_gain, ..amplifier },
            _ => amplifier,
        }
    }
}

/// The scheduled faults of a world.
#[derive(Clone, Debug, Default)]
pub(super) struct FaultSchedule {
    faults: Vec<(Range<u64>, WorldFault)>,
    /// The place reported by a stuck touch source.
    stuck_at_m: Option<[f32; 2]>,
    /// Reports since a touch source began to jump.
    jumps: u32,
}

impl FaultSchedule {
    /// Adds a fault. `amplifier` is the amplifier that it may affect.
    pub(super) fn add(
        &mut self,
        ticks: Range<u64>,
        fault: WorldFault,
        amplifier: AmplifierConfig,
    ) -> Result<(), OutOfRange> {
        fault.of_amplifier(amplifier).check()?;
        self.faults.push((ticks, fault));
        Ok(())
    }

    /// The faults active at a tick.
    fn at(&self, tick: u64) -> impl Iterator<Item = WorldFault> {
        self.faults.iter().filter(move |(ticks, _)| ticks.contains(&tick)).map(|(_, fault)| *fault)
    }

    /// Whether a fault is active at a tick.
    pub(super) fn has(&self, tick: u64, fault: WorldFault) -> bool {
        self.at(tick).any(|there| there == fault)
    }

    /// The amplifier from this tick on, if it changes at it.
    pub(super) fn new_amplifier(&self, tick: u64, healthy: AmplifierConfig) -> Option<AmplifierConfig> {
        let changes = self.faults.iter().any(|(ticks, _)| ticks.start == tick || ticks.end == tick);
        changes.then(|| self.at(tick).fold(healthy, |amplifier, fault| fault.of_amplifier(amplifier)))
    }

    /// The part of a board's output that reaches the amplifier.
    pub(super) fn drive(&self, tick: u64, drive: Drive) -> Drive {
        let stuck_code = |fault| if let WorldFault::DacStuck(code) = fault { Some(code) } else { None };
        Drive { dac_code: self.at(tick).find_map(stuck_code).unwrap_or(drive.dac_code), ..drive }
    }

    /// State of the arm switch, which is closed without a fault.
    pub(super) fn arm_switch(&self, tick: u64) -> bool {
        !self.has(tick, WorldFault::SwitchOpen)
    }

    /// The touch report that reaches the board.
    pub(super) fn touch(&mut self, tick: u64, touch: Option<Touch>) -> Option<Touch> {
        if self.faults.is_empty() {
            return touch;
        }
        if self.has(tick, WorldFault::TouchSilent) {
            return None;
        }
        let mut touch = touch?;
        if self.has(tick, WorldFault::TouchStuck) {
            touch = self.stuck(touch);
        } else {
            self.stuck_at_m = None;
        }
        let jump_m = |fault| if let WorldFault::TouchJumps { by_m } = fault { Some(by_m) } else { None };
        let jump_m = self.at(tick).find_map(jump_m);
        if let (Some(by_m), Touch::Down { x_m, .. }) = (jump_m, &mut touch) {
            *x_m += if self.jumps % 2 == 1 { by_m as f32 } else { 0.0 };
            self.jumps = self.jumps.wrapping_add(1);
        }
        Some(touch)
    }

    fn stuck(&mut self, touch: Touch) -> Touch {
        let stuck_at_m = match touch {
            Touch::Down { x_m, y_m, .. } => Some(*self.stuck_at_m.get_or_insert([x_m, y_m])),
            Touch::Up => self.stuck_at_m,
        };
        let age_ticks = if let Touch::Down { age_ticks, .. } = touch { age_ticks } else { 0 };
        stuck_at_m.map_or(touch, |[x_m, y_m]| Touch::Down { x_m, y_m, age_ticks })
    }
}
