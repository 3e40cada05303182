//! The script of the self-test on a simulated board with its wires: what it must find, and what it must not do.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::collections::VecDeque;

use frixel_board::bring_up::DriveError;
use frixel_board::self_test::{GREETING, LINE_TEST, Levels, LineTest, SKIP, ScriptLine, Stop, UNPLUGGED, Wire};
use frixel_hil_sim::looped_board::{Defect, LoopedRig, Port};
use frixel_wire::fault::Fault;

/// Ticks for which the host sends blocks: half a second.
const LINE_TICKS: u32 = 20_000;
/// Bytes that the line takes in a tick at 2 Mbaud.
const LINE_BYTES: usize = 5;

/// Longest time for which the enable may be high after ready has risen or the switch was closed, us: one read of the
/// inputs, and the enable's own fall.
const FORBIDDEN_ENABLE_MAX_US: u32 = 2;

/// A person, or a host, at the other end of the line.
struct Person {
    tests_line: bool,
    said: String,
    typed: VecDeque<u8>,
    /// The host's side of the line test, and its remaining ticks.
    line: Option<(LineTest, u32)>,
    /// The host's counts of received and missing blocks, and of damaged pieces.
    result: Option<[u32; 3]>,
}

impl Person {
    fn new(tests_line: bool) -> Self {
        Self { tests_line, said: String::new(), typed: VecDeque::new(), line: None, result: None }
    }

    fn hears(&mut self, bytes: &[u8]) {
        let begin = self.said.rfind('\n').map_or(0, |end| end + 1);
        self.said.push_str(std::str::from_utf8(bytes).unwrap());
        let Some((_, words)) = self.said[begin..].trim_end().split_once("Then type: ") else { return };
        let answer = match words {
            words if words.contains(SKIP) && self.tests_line => {
                self.line = Some((LineTest::new(), LINE_TICKS));
                LINE_TEST
            }
            words if words.contains(SKIP) => SKIP,
            // The script repeats a question after a mistyped answer.
            UNPLUGGED if !self.said.contains("unpluged") => {
                self.said.push_str("> unpluged\n");
                "unpluged"
            }
            GREETING | UNPLUGGED => words,
            words => panic!("nobody knows what to type: {words}"),
        };
        self.typed.extend(answer.bytes().chain([b'\r']));
    }

    fn measured(&self) -> Vec<(&str, u32, bool)> {
        let said = self.said.lines().filter_map(ScriptLine::parse);
        said.filter_map(|said| match said {
            ScriptLine::Measured(measurement) => Some((measurement.name, measurement.found, measurement.passes())),
            _ => None,
        })
        .collect()
    }

    fn failed(&self) -> Vec<&str> {
        self.measured().into_iter().filter(|(_, _, passes)| !passes).map(|(name, ..)| name).collect()
    }
}

impl Port for Person {
    fn read(&mut self, bytes: &mut [u8]) -> usize {
        let len = bytes.len().min(self.typed.len());
        for (to, from) in bytes.iter_mut().zip(self.typed.drain(..len)) {
            *to = from;
        }
        len
    }

    fn write(&mut self, bytes: &[u8]) -> usize {
        match &mut self.line {
            Some((line, _)) if self.typed.is_empty() || self.result.is_none() => line.take(bytes),
            _ => self.hears(bytes),
        }
        bytes.len()
    }

    fn pace(&mut self, ticks: u32) {
        let Some((line, left)) = &mut self.line else { return };
        if *left > ticks {
            *left -= ticks;
            let pending = line.pending();
            let len = pending.len().min(LINE_BYTES * ticks as usize);
            self.typed.extend(&pending[..len]);
            line.advance(len);
        }
    }

    fn wait(&mut self) -> bool {
        // The board waits for the line that ends the test.
        if let Some((line, _)) = self.line.take() {
            self.result = Some([line.received(), line.missing(), line.damaged()]);
            self.typed.extend(b"\r");
        }
        !self.typed.is_empty()
    }

    fn end(&mut self) {}
}

fn self_test(wrong: Defect, tests_line: bool) -> (Result<u32, Stop>, LoopedRig<Person>) {
    let mut rig = LoopedRig::new(Person::new(tests_line), wrong);
    (rig.run(), rig)
}

#[test]
fn a_board_in_order_passes_and_its_last_line_says_so() {
    let (result, rig) = self_test(Defect::Nothing, true);
    let person = rig.port();
    assert_eq!(result, Ok(0), "{}", person.said);
    let measured = person.measured().len() as u32;
    assert_eq!(
        ScriptLine::parse(person.said.trim_end().lines().last().unwrap()),
        Some(ScriptLine::End { measured, failed: 0 })
    );
    assert!(measured >= 20, "{}", person.said);
    let found = |name| person.measured().into_iter().find(|(known, ..)| *known == name).unwrap().1;
    // Half a second of blocks of 137 bytes, at 200,000 bytes a second.
    assert!((700..=740).contains(&found("line_blocks_received")), "{}", person.said);
    let [received, missing, damaged] = person.result.unwrap();
    assert!(received > 700 && missing == 0 && damaged <= 1, "{:?}", person.result);
    // The scene fills what a tick may take but for the smallest layer.
    assert!((1_900..=2_040).contains(&found("tick_estimated_core_cycles")), "{}", person.said);
}

#[test]
fn a_person_skips_the_line() {
    let (result, rig) = self_test(Defect::Nothing, false);
    assert_eq!(result, Ok(0));
    assert!(!rig.port().said.contains("line_blocks"), "{}", rig.port().said);
}

/// Defects that end the script: before the first pulse, unless they show only later.
#[test]
fn an_amplifier_that_is_there_a_closed_switch_and_a_missing_wire_end_it_at_once() {
    for (wrong, stop) in [
        (Defect::ReadyHigh, Stop::Ready),
        (Defect::ReadyRises, Stop::Ready),
        (Defect::ReadyWhileEnabled, Stop::Ready),
        (Defect::ReadyUnderTicks, Stop::Ready),
        (Defect::SwitchClosed, Stop::Switch),
        (Defect::SwitchPressed, Stop::Switch),
        (Defect::SwitchPressedInPulse, Stop::Switch),
        (Defect::SwitchPressedInCutPulse, Stop::Switch),
        (Defect::SwitchPressedUnderTicks, Stop::Switch),
        (Defect::MonitorDriven, Stop::MonitorDriven(Levels::HIGH)),
        (Defect::MonitorNotZero, Stop::MonitorNotZero(1_750)),
        (Defect::NoDataWire, Stop::Data(11)),
        (Defect::NoClockWire, Stop::Missing(Wire::Clock)),
        (Defect::NoSyncWire, Stop::Missing(Wire::Sync)),
        (Defect::NoEnableWire, Stop::Missing(Wire::Enable)),
        (Defect::NoMonitorWire, Stop::MonitorNotZero(0)),
        (Defect::AdcDead, Stop::MonitorNotZero(0)),
        (Defect::EnableStuckHigh, Stop::Resting(Wire::Enable, Levels::HIGH)),
        (Defect::EnableStaysHigh, Stop::EnableStaysHigh),
        (Defect::TickLate, Stop::Drive(DriveError::Fault(Fault::Deadline, 3_701))),
    ] {
        let (result, rig) = self_test(wrong, true);
        assert_eq!(result, Err(stop), "{wrong:?}");
        let said = &rig.port().said;
        assert!(said.trim_end().lines().last().unwrap().starts_with("STOP. "), "{said}");
        // A pulse where there must be none is caught by the simulated board, too.
        let comes_after_pulses = matches!(
            wrong,
            Defect::TickLate
                | Defect::EnableStaysHigh
                | Defect::SwitchPressedInCutPulse
                | Defect::ReadyUnderTicks
                | Defect::SwitchPressedUnderTicks
        );
        assert!(comes_after_pulses || !said.contains("enable_rises_us"), "{said}");
        assert!(rig.forbidden_enable_us() <= FORBIDDEN_ENABLE_MAX_US, "{wrong:?}: {} us", rig.forbidden_enable_us());
    }
}

/// A wrong measurement is reported with the others.
#[test]
fn each_wrong_measurement_fails_by_its_name() {
    for (wrong, names) in [
        (Defect::EnableDead, &["enable_rises_us", "enable_falls_us", "enable_is_cut_within_us"][..]),
        (Defect::OneShotLong, &["enable_falls_us"]),
        (Defect::NotRetriggered, &["enable_falls_between_kicks"]),
        (Defect::NotCut, &["enable_is_cut_within_us"]),
        (Defect::Clocks23, &["clocks_in_sync_at_least", "clocks_in_sync_at_most"]),
        (Defect::ClockAfterSync, &["clocks_in_sync_at_least", "clocks_in_sync_at_most", "clocks_after_sync_at_most"]),
        (Defect::LatchLate, &["latch_earliest_cycles", "latch_earliest_cycles_under_ticks"]),
        (Defect::LatchMoves, &["latch_spread_cycles", "latch_spread_cycles_under_ticks"]),
        (Defect::LatchMovesUnderTicks, &["latch_spread_cycles_under_ticks"]),
        (Defect::AdcFrozen, &["adc_at_300_mv", "adc_at_3000_mv"]),
        (Defect::TicksSlow, &["flash_wait_percent"]),
        (Defect::LineLoses, &["line_blocks_missing", "line_pieces_damaged"]),
    ] {
        let (result, rig) = self_test(wrong, true);
        assert_eq!(rig.port().failed(), names, "{wrong:?}: {}", rig.port().said);
        assert_eq!(result, Ok(names.len() as u32), "{wrong:?}");
    }
}

/// Every defect is in one of the tests above, or fails here.
#[test]
fn nothing_wrong_passes() {
    for (name, wrong) in Defect::ALL {
        assert_eq!(Defect::named(name), Some(*wrong));
        if *wrong != Defect::Nothing {
            let (result, _) = self_test(*wrong, true);
            assert_ne!(result, Ok(0), "{name}");
        }
    }
}
