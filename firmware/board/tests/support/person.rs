//! The simulated person of bring-up, who follows the board's instructions.
#![allow(clippy::panic, reason = "a test may fail")]

use frixel_board::bring_up::{Sync, TestOutput};

/// The parts between the processor's enable and the amplifier's, or a defect of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EnablePath {
    /// No defect.
    Right,
    /// Gate and monostable are bridged: the processor's enable passes.
    MonostableBridged,
    /// The monostable alone decides.
    ProcessorLeftOut,
    /// The monostable waits ten times as long as it may.
    MonostableSlow,
    /// The monostable never triggers.
    MonostableDead,
    /// The monostable takes no trigger before its pulse is over.
    MonostableNotRetriggered,
    /// The switch's second pole is bridged.
    PoleBridged,
    /// The second pole never closes.
    PoleOpen,
    /// The wires of the two poles touch each other.
    PolesBridged,
    /// The amplifier's enable is plugged in front of the second pole.
    PluggedBeforeThePole,
}

impl EnablePath {
    /// The mean voltage of `ENABLE_LOGIC`, V.
    fn logic_v(self, output: TestOutput) -> f32 {
        let TestOutput::Enable { kicked, sync } = output else { return 0.0 };
        // The part of the time that the monostable's 0.68 ms make.
        let alive = match (self, sync) {
            (Self::MonostableBridged, _) => 1.0,
            (Self::MonostableDead, _) | (_, Sync::Never) => 0.0,
            (_, Sync::Every2Ms) if self != Self::MonostableSlow => 0.34,
            _ => 1.0,
        };
        if kicked || self == Self::ProcessorLeftOut { 3.3 * alive } else { 0.0 }
    }

    /// Falling edges of `ENABLE_LOGIC` in a second.
    fn logic_edges(self, output: TestOutput) -> u32 {
        let falls = self == Self::MonostableNotRetriggered && self.logic_v(output) > 0.0;
        if falls { 1_400 } else { 0 }
    }

    /// The resistance from `ENABLE_LOGIC` to the amplifier's enable, kOhm.
    fn pole_kohm(self, switch_closed: bool) -> f32 {
        if self == Self::PluggedBeforeThePole || switch_closed { 0.0 } else { 10.0 }
    }

    /// The mean voltage behind the switch, V.
    fn enable_v(self, output: TestOutput, switch_closed: bool) -> f32 {
        if self == Self::PolesBridged && switch_closed {
            return 3.3;
        }
        let passes = self == Self::PoleBridged || (switch_closed && self != Self::PoleOpen);
        if passes { self.logic_v(output) } else { 0.0 }
    }
}

/// The state of the board that the instruments show.
pub(crate) struct Instruments {
    pub(crate) output: TestOutput,
    pub(crate) enable_path: EnablePath,
    pub(crate) switch_closed: bool,
    /// The reading of the oscilloscope, V.
    pub(crate) probe_v: f32,
}

/// Level of ready after the person has followed an instruction; `None` if the instruction does not affect it.
pub(crate) fn ready_after(said: &str) -> Option<bool> {
    let said = said.to_lowercase();
    let says = |what: &str| said.contains(what);
    if says("switch the amplifier's supply on") || says("switch it on") || says("wire to 3.3 v") {
        Some(true)
    } else if says("switch it off") || says("supply off") || says("wire off again") {
        Some(false)
    } else {
        None
    }
}

/// Whether the contact is closed after the person has followed an instruction; `None` if unaffected.
pub(crate) fn contact_after(said: &str) -> Option<bool> {
    match said.to_lowercase() {
        said if said.contains("hold the switch.") => Some(true),
        said if said.contains("release the switch.") => Some(false),
        _ => None,
    }
}

/// The answer of a person who reads the instruments.
pub(crate) fn answer(said: &str, instruments: &Instruments) -> String {
    let &Instruments { output, enable_path, switch_closed, probe_v } = instruments;
    if let Some((_, word)) = said.split_once("Then type: ") {
        return word.to_owned();
    }
    let Some((_, what)) = said.split_once("Type a number: ") else { panic!("nothing was asked: {said}") };
    match what {
        what if what.contains("series resistor") => "33.8".to_owned(),
        what if what.starts_with("released: ") => enable_path.pole_kohm(switch_closed).to_string(),
        // The leads have half an ohm.
        what if what.starts_with("held: ") => (1e3 * enable_path.pole_kohm(switch_closed) + 0.5).to_string(),
        what if what.contains("kOhm") => "9.9".to_owned(),
        what if what.contains("MOhm") => "999".to_owned(),
        what if what.contains("voltmeter") => match output {
            TestOutput::Dac(volts) => volts.to_string(),
            TestOutput::Zero | TestOutput::Enable { .. } => "0".to_owned(),
        },
        what if what.contains("positive supply") => "15.1".to_owned(),
        what if what.contains("negative supply") => "-14.9".to_owned(),
        what if what.contains("falling edges") => enable_path.logic_edges(output).to_string(),
        what if what.starts_with("ENABLE_LOGIC") => enable_path.logic_v(output).to_string(),
        what if what.starts_with("ENABLE,") => enable_path.enable_v(output, switch_closed).to_string(),
        what if what.contains("probe") => probe_v.to_string(),
        what if what.contains("at the capacitor") => "44.5".to_owned(),
        what if what.contains("at the monitor") => " 8.5 ".to_owned(),
        what => panic!("nobody knows this: {what}"),
    }
}
