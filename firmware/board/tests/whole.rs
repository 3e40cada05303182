//! The script of bring-up through the firmware's session, ticker and supervisor, in virtual time: an amplifier whose
//! gain is 3 % high, with a person at the switch.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::fmt::Arguments;

use crate::support::firmware::{BOARD, BUILT_IN, Firmware};
use crate::support::person::{self, EnablePath, Instruments};
use frixel_board::bring_up::{Bench, Check, Drive, DriveError, Inputs, Line, Pressed, Reading, TestOutput, run};
use frixel_control::{Sense, Status};
use frixel_session::store::{CeilingPolicy, write_limits};
use frixel_wire::hello::BoardLimits;

/// Largest voltage that the board may store, V peak.
const MAY_STORE_V_PEAK: f32 = 50.0;
const GAIN: f32 = 1.03;
/// Ticks of a round of the main loop.
const ROUND_TICKS: u32 = 4;
/// Ticks for which a person holds on after the output is off: a second.
const LATE_TICKS: u32 = 40_000;
/// More ticks than bring-up takes: two minutes.
const TICKS_MAX: u32 = 120 * 40_000;

/// The person's next action at the switch, and its time.
#[derive(Clone, Copy)]
enum SwitchAction {
    Releases { at_tick: u32 },
    Presses { at_tick: u32 },
}

impl SwitchAction {
    fn holds(self, tick: u32) -> bool {
        match self {
            Self::Releases { at_tick } => tick < at_tick,
            Self::Presses { at_tick } => tick >= at_tick,
        }
    }
}

struct WholeBench {
    firmware: Firmware,
    /// The status of the round before.
    status: Status,
    said: String,
    inputs: Inputs,
    action: SwitchAction,
    ticks: u32,
    driven_v: f32,
    /// Ticks with an enabled amplifier.
    enabled_ticks: u32,
    stored: Option<BoardLimits>,
}

impl WholeBench {
    fn new() -> Self {
        let firmware = Firmware::new();
        Self {
            status: firmware.ticker.status(),
            firmware,
            said: String::new(),
            inputs: Inputs { amplifier_ready: false, switch_closed: false },
            action: SwitchAction::Releases { at_tick: 0 },
            ticks: 0,
            driven_v: 0.0,
            enabled_ticks: 0,
            stored: None,
        }
    }

    fn monitor_v(&self) -> f32 {
        GAIN * self.firmware.monitor.voltage_v()
    }

    /// A round of the main loop.
    fn turn(&mut self) {
        for _ in 0..ROUND_TICKS {
            self.ticks += 1;
            assert!(self.ticks < TICKS_MAX, "it waits for ever, after: {}", self.said);
            let sense = Sense {
                amplifier_fault: !self.inputs.amplifier_ready,
                monitor_v: self.monitor_v(),
                arm_switch: self.action.holds(self.ticks),
            };
            self.enabled_ticks += u32::from(self.firmware.tick(&sense).amplifier_enable);
        }
        self.status = self.firmware.ticker.status();
        self.firmware.poll(&self.status);
    }
}

impl Bench for WholeBench {
    fn say(&mut self, text: Arguments<'_>) {
        self.said = text.to_string();
        self.inputs.amplifier_ready = person::ready_after(&self.said).unwrap_or(self.inputs.amplifier_ready);
        self.inputs.switch_closed = person::contact_after(&self.said).unwrap_or(self.inputs.switch_closed);
        if self.said.contains("Release the switch, then hold it") {
            self.action = SwitchAction::Releases { at_tick: self.ticks + LATE_TICKS };
        }
    }

    fn read_line(&mut self, output: TestOutput) -> Line {
        let instruments = Instruments {
            output,
            enable_path: EnablePath::Right,
            switch_closed: self.inputs.switch_closed,
            // 68 kOhm in front of the 9.1 MOhm of discharge resistor and probe.
            probe_v: GAIN * self.driven_v / (1.0 + 68e3 / 9.1e6),
        };
        Line::try_from(person::answer(&self.said, &instruments).as_str()).unwrap()
    }

    fn check(&mut self, check: Check) -> bool {
        if check == Check::Ticks {
            // As on the board, the ticker is new then: it has not seen an amplifier that was off.
            assert!(self.inputs.amplifier_ready && self.ticks == 0);
            self.turn();
        }
        true
    }

    fn inputs(&mut self) -> Inputs {
        self.inputs
    }

    fn switch_is_held(&mut self) -> bool {
        self.turn();
        if let SwitchAction::Releases { at_tick } = self.action
            && self.ticks >= at_tick
        {
            self.action = SwitchAction::Presses { at_tick: self.ticks + LATE_TICKS };
        }
        self.status.arm_switch
    }

    fn drive(&mut self, _pressed: Pressed, peak_v: f32) -> Result<Reading, DriveError> {
        let mut drive = Drive::new(peak_v, &BOARD);
        loop {
            let status = self.status;
            self.turn();
            let (now_tick, monitor_v) = (self.status.telemetry.tick, self.monitor_v());
            if let Some(result) = drive.step(&status, now_tick, monitor_v, &mut self.firmware.session) {
                self.driven_v = peak_v;
                return result;
            }
        }
    }

    fn may_store(&mut self, limits: &BoardLimits) -> bool {
        limits.voltage_max_v_peak <= MAY_STORE_V_PEAK && write_limits(limits, CeilingPolicy::InForce).is_ok()
    }

    fn store(&mut self, limits: &BoardLimits) -> bool {
        self.stored = Some(*limits);
        true
    }
}

#[test]
fn a_board_is_brought_up_through_the_firmware() {
    let mut bench = WholeBench::new();
    let limits = run(&mut bench, &BUILT_IN).unwrap();
    assert_eq!(bench.stored, Some(limits));
    assert!((limits.full_scale_v_peak - 206.0).abs() < 0.1, "{limits:?}");
    // Four voltages of three seconds.
    assert!((470_000..490_000).contains(&bench.enabled_ticks), "{}", bench.enabled_ticks);
}
