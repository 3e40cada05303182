//! What can be wrong with a board.

use frixel_board::self_test::{Levels, Wire};

/// Declares [`Wrong`] with its names, so that none is left out of [`Wrong::ALL`].
macro_rules! wrongs {
    ($($(#[doc = $doc:literal])+ $variant:ident = $name:literal,)+) => {
        /// One thing that is wrong with a board or its wires.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Wrong {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl Wrong {
            /// All of them, with their names.
            pub const ALL: &[(&str, Self)] = &[$(($name, Self::$variant)),+];
        }
    };
}

wrongs! {
    /// The board and its wires are in order.
    Nothing = "nothing",
    /// The amplifier is plugged in, and its ready is high.
    ReadyHigh = "ready-high",
    /// The amplifier is switched on after the wires were found.
    ReadyRises = "ready-rises",
    /// The amplifier's monitor is plugged in.
    MonitorDriven = "monitor-driven",
    /// The monitor is beside zero.
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
    /// The one-shot ends although it is kicked again.
    NotRetriggered = "not-retriggered",
    /// Disabling the enable takes as long as the one-shot.
    NotCut = "not-cut",
    /// A frame has 23 clocks.
    Clocks23 = "clocks-23",
    /// The last clock comes after SYNC.
    ClockAfterSync = "clock-after-sync",
    /// SYNC does not move.
    NoLatch = "no-latch",
    /// SYNC rises too late.
    LatchLate = "latch-late",
    /// SYNC rises now early, now late.
    LatchMoves = "latch-moves",
    /// The tick moves the rise of SYNC.
    LatchMovesUnderTicks = "latch-moves-under-ticks",
    /// The ADC reads zero.
    AdcDead = "adc-dead",
    /// The ADC reads the middle.
    AdcFrozen = "adc-frozen",
    /// The flash is in one bank.
    OneBank = "one-bank",
    /// A reset in a store leaves nothing.
    StoreLost = "store-lost",
    /// Flash wait states cost more than is assumed.
    TicksSlow = "ticks-slow",
    /// A tick misses its deadline.
    TickLate = "tick-late",
    /// The board loses received bytes.
    LineLoses = "line-loses",
}

impl Wrong {
    /// What is wrong by its name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|(_, wrong)| *wrong)
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
