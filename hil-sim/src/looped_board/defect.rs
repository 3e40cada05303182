//! Defects of a board.

use frixel_board::self_test::{Inputs, Levels, Wire};

/// Declares [`Defect`] with its names, so that [`Defect::ALL`] is complete.
macro_rules! defects {
    ($($(#[doc = $doc:literal])+ $variant:ident = $name:literal,)+) => {
        /// A defect of a board or its wires.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Defect {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl Defect {
            /// All defects, with their names.
            pub const ALL: &[(&str, Self)] = &[$(($name, Self::$variant)),+];
        }
    };
}

defects! {
    /// No defect.
    Nothing = "nothing",
    /// The amplifier is plugged in, and its ready is high.
    ReadyHigh = "ready-high",
    /// The amplifier is switched on after the wires were found.
    ReadyRises = "ready-rises",
    /// The amplifier is plugged in, and its ready is high only while it is enabled.
    ReadyWhileEnabled = "ready-while-enabled",
    /// The amplifier is switched on after the tick was started.
    ReadyUnderTicks = "ready-under-ticks",
    /// The arm switch is held from the beginning, or welded.
    SwitchClosed = "switch-closed",
    /// The arm switch is pressed after the wires were found.
    SwitchPressed = "switch-pressed",
    /// The arm switch is pressed during a pulse of the enable, and released at its end.
    SwitchPressedInPulse = "switch-pressed-in-pulse",
    /// The arm switch is pressed during the pulse that the board cuts short.
    SwitchPressedInCutPulse = "switch-pressed-in-cut-pulse",
    /// The arm switch is pressed after the tick was started.
    SwitchPressedUnderTicks = "switch-pressed-under-ticks",
    /// The amplifier's monitor is plugged in.
    MonitorDriven = "monitor-driven",
    /// The monitor is offset from zero.
    MonitorNotZero = "monitor-not-zero",
    /// The wire from SDI to SDO is missing.
    NoDataWire = "no-data-wire",
    /// The wire of SCLK is missing.
    NoClockWire = "no-clock-wire",
    /// The wire of SYNC is missing.
    NoSyncWire = "no-sync-wire",
    /// The wire of the enable is missing.
    NoEnableWire = "no-enable-wire",
    /// The wire of the monitor is missing.
    NoMonitorWire = "no-monitor-wire",
    /// The enable's pin is high without a kick.
    EnableStuckHigh = "enable-stuck-high",
    /// A kick does not raise the enable.
    EnableDead = "enable-dead",
    /// The enable does not fall by itself.
    EnableStaysHigh = "enable-stays-high",
    /// The one-shot takes 1.2 ms.
    OneShotLong = "one-shot-long",
    /// The one-shot ends despite another kick.
    NotRetriggered = "not-retriggered",
    /// Disabling takes as long as the one-shot.
    NotCut = "not-cut",
    /// A frame has 23 clocks.
    Clocks23 = "clocks-23",
    /// The last clock comes after SYNC.
    ClockAfterSync = "clock-after-sync",
    /// SYNC does not move.
    NoLatch = "no-latch",
    /// SYNC rises too late.
    LatchLate = "latch-late",
    /// SYNC rises at varying times.
    LatchMoves = "latch-moves",
    /// The tick moves the rise of SYNC.
    LatchMovesUnderTicks = "latch-moves-under-ticks",
    /// The ADC reads zero.
    AdcDead = "adc-dead",
    /// The ADC reads the middle.
    AdcFrozen = "adc-frozen",
    /// Flash wait states cost more than assumed.
    TicksSlow = "ticks-slow",
    /// A tick misses its deadline.
    TickLate = "tick-late",
    /// The board loses received bytes.
    LineLoses = "line-loses",
}

/// Progress of the script.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Progress {
    /// The wire of the enable has not been sought yet.
    Begun,
    /// The wire was found, and the enable is low or was high only briefly.
    Wired,
    /// The enable has been high long enough for an amplifier to turn on.
    Enabled,
    /// The enable is high in the pulse after the first one.
    EnabledAgain,
    /// The tick runs.
    Ticks,
}

/// Inputs with nothing connected to them.
pub(super) const LOW: Inputs = Inputs { amplifier_ready: false, switch_closed: false };

impl Defect {
    /// The defect of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|(_, wrong)| *wrong)
    }

    /// The levels of ready and arm switch.
    pub(super) fn inputs(self, progress: Progress) -> Inputs {
        let ready = Inputs { amplifier_ready: true, ..LOW };
        let closed = Inputs { switch_closed: true, ..LOW };
        match (self, progress) {
            (Self::ReadyHigh, _)
            | (Self::ReadyRises, Progress::Wired | Progress::Enabled | Progress::EnabledAgain | Progress::Ticks)
            | (Self::ReadyWhileEnabled, Progress::Enabled)
            | (Self::ReadyUnderTicks, Progress::Ticks) => ready,
            (Self::SwitchClosed, _)
            | (Self::SwitchPressed, Progress::Wired | Progress::Enabled | Progress::EnabledAgain | Progress::Ticks)
            | (Self::SwitchPressedInPulse, Progress::Enabled)
            | (Self::SwitchPressedInCutPulse, Progress::EnabledAgain)
            | (Self::SwitchPressedUnderTicks, Progress::Ticks) => closed,
            _ => LOW,
        }
    }

    /// The levels at the end of a wire.
    pub(super) fn levels(self, wire: Wire) -> Levels {
        match (self, wire) {
            (Self::NoClockWire, Wire::Clock) | (Self::NoSyncWire, Wire::Sync) | (Self::NoEnableWire, Wire::Enable) => {
                Levels::FREE
            }
            (Self::MonitorDriven, Wire::Monitor)
            | (Self::EnableStuckHigh, Wire::Enable)
            | (_, Wire::Clock | Wire::Sync) => Levels::HIGH,
            (_, Wire::Enable) => Levels::LOW,
            (_, Wire::Monitor) => Levels::FREE,
        }
    }
}
