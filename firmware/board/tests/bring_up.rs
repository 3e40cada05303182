//! The bring-up script with a board and a person that behave correctly except for one defect.

use std::fmt::Arguments;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use crate::support::firmware::BUILT_IN;
use frixel_board::bring_up::{Bench, Check, DriveError, Inputs, Line, Pressed, Reading, Stop, Sync, TestOutput, run};
use frixel_control::Board;
use frixel_model::TouchBound;
use frixel_session::store::{CeilingPolicy, write_limits};
use frixel_wire::fault::{Fault, State};
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::Refusal;

const LIMITS: BoardLimits = BUILT_IN;
/// Largest voltage that the board may store, V peak.
const MAY_STORE_V_PEAK: f32 = 120.0;
/// All checks, in their order.
const CHECKS: [Check; 7] =
    [Check::Storage, Check::OneShot, Check::FaultsAreStored, Check::Dac, Check::Dac, Check::Dac, Check::Ticks];
/// More polls of an input than any test needs.
const POLLS_MAX: u32 = 10_000;

/// Events, in order.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Event {
    Checked(Check),
    /// The contact was seen closed, or open, before the tick ran.
    Contact(bool),
    /// The debounced switch was seen held, or not.
    Held(bool),
    /// A number was asked for.
    Asked,
    Driven(f32),
    Stored(BoardLimits),
}

/// The payload of the panic that ends a script that waits forever.
struct WaitsForever;

/// A defect of the inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Defect {
    /// Ready and switch are connected with each other.
    Bridged,
    /// The amplifier never gets ready.
    NeverReady,
    /// The person never releases the switch once the amplifier is on.
    Taped,
    /// The contact bounces.
    Bouncing,
}

/// A board and a person. Tests set their defects in the first half of the fields.
struct TestBench {
    limits: BoardLimits,
    /// Number of a question, and its first answer, which is wrong.
    wrong_answer: Option<(u32, &'static str)>,
    wrong_check: Option<Check>,
    /// Number of a drive, and its wrong result.
    wrong_drive: Option<(u32, Result<Reading, DriveError>)>,
    defect: Option<Defect>,

    polls: u32,
    asked: u32,
    drives: u32,
    said: String,
    questions: Vec<String>,
    answers: Vec<String>,
    inputs: Inputs,
    held: bool,
    /// Whether the last drive has used up the press.
    used_up: bool,
    events: Vec<Event>,
}

const IDLE: Inputs = Inputs { amplifier_ready: false, switch_closed: false };

impl TestBench {
    fn new() -> Self {
        Self {
            limits: LIMITS,
            wrong_answer: None,
            wrong_check: None,
            wrong_drive: None,
            defect: None,
            polls: 0,
            asked: 0,
            drives: 0,
            said: String::new(),
            questions: Vec::new(),
            answers: Vec::new(),
            inputs: IDLE,
            held: false,
            used_up: false,
            events: Vec::new(),
        }
    }

    /// Runs the script. Returns its end, or `None` if it waits forever.
    fn bring_up(&mut self) -> Option<Result<BoardLimits, Stop>> {
        let limits = self.limits;
        match catch_unwind(AssertUnwindSafe(|| run(self, &limits))) {
            Ok(result) => Some(result),
            Err(thrown) if thrown.is::<WaitsForever>() => None,
            Err(thrown) => resume_unwind(thrown),
        }
    }

    fn poll(&mut self) {
        self.polls += 1;
        if self.polls > POLLS_MAX {
            resume_unwind(Box::new(WaitsForever));
        }
    }

    /// Follows the board's last instruction, as the person.
    fn act(&mut self) {
        if let Some(ready) = ready_after(&self.said) {
            self.inputs.amplifier_ready = ready && self.defect != Some(Defect::NeverReady);
        }
        if let Some(closed) = contact_after(&self.said) {
            self.inputs.switch_closed = closed;
        }
        if self.said.contains("Release the switch, then hold it") {
            self.held = self.defect == Some(Defect::Taped);
        }
    }

    fn answer(&mut self, output: TestOutput) -> String {
        if let Some((_, word)) = self.said.split_once("Then type: ") {
            return word.to_owned();
        }
        self.events.push(Event::Asked);
        let (_, what) = self.said.split_once("Type a number: ").unwrap();
        // Four hundredths above what is driven, with the decimal comma of some countries.
        let probe_v = 1.04 * self.driven().last().copied().unwrap_or(f32::NAN);
        reading(what, output, self.inputs.switch_closed, probe_v).replace('.', ",")
    }

    /// Number of the first question with these words.
    fn number_of(&self, words: &str) -> u32 {
        self.questions.iter().position(|question| question.contains(words)).unwrap() as u32 + 1
    }

    fn driven(&self) -> Vec<f32> {
        let driven = |event: &Event| if let Event::Driven(volts) = event { Some(*volts) } else { None };
        self.events.iter().filter_map(driven).collect()
    }
}

impl Bench for TestBench {
    fn say(&mut self, text: Arguments<'_>) {
        self.said = text.to_string();
        self.act();
    }

    fn read_line(&mut self, output: TestOutput) -> Line {
        self.poll();
        let answer = self.answer(output);
        self.answers.push(answer.clone());
        self.asked += 1;
        self.questions.push(self.said.clone());
        let wrong = self.wrong_answer.filter(|(number, _)| *number == self.asked);
        Line::try_from(wrong.map_or(answer.as_str(), |(_, answer)| answer)).unwrap()
    }

    fn check(&mut self, check: Check) -> bool {
        self.events.push(Event::Checked(check));
        self.wrong_check != Some(check)
    }

    fn inputs(&mut self) -> Inputs {
        self.poll();
        self.events.push(Event::Contact(self.inputs.switch_closed));
        let bounce = self.defect == Some(Defect::Bouncing) && self.polls.is_multiple_of(2);
        let switch_closed = self.inputs.switch_closed ^ (bounce && self.said.contains("the switch."));
        let both = self.inputs.amplifier_ready || switch_closed;
        if self.defect == Some(Defect::Bridged) {
            Inputs { amplifier_ready: both, switch_closed: both }
        } else {
            Inputs { switch_closed, ..self.inputs }
        }
    }

    fn switch_is_held(&mut self) -> bool {
        self.poll();
        // The person holds on for some time after each drive, and presses again once the release was seen.
        let held = self.held && !self.used_up;
        self.used_up &= self.held;
        self.events.push(Event::Held(held));
        self.held = !held || self.defect == Some(Defect::Taped);
        held
    }

    fn drive(&mut self, _pressed: Pressed, peak_v: f32) -> Result<Reading, DriveError> {
        self.drives += 1;
        self.used_up = true;
        self.events.push(Event::Driven(peak_v));
        match self.wrong_drive.filter(|(number, _)| *number == self.drives) {
            Some((_, wrong)) => wrong,
            None => Ok(good(peak_v)),
        }
    }

    fn may_store(&mut self, limits: &BoardLimits) -> bool {
        limits.voltage_max_v_peak <= MAY_STORE_V_PEAK && write_limits(limits, CeilingPolicy::InForce).is_ok()
    }

    fn store(&mut self, limits: &BoardLimits) -> bool {
        self.events.push(Event::Stored(*limits));
        true
    }
}

/// The mean voltage of `ENABLE_LOGIC`, V. SYNC triggers the monostable for 0.68 ms.
fn logic_v(output: TestOutput) -> f32 {
    match output {
        TestOutput::Enable { kicked: true, sync: Sync::EveryPeriod } => 3.3,
        TestOutput::Enable { kicked: true, sync: Sync::Every2Ms } => 3.3 * 0.34,
        _ => 0.0,
    }
}

/// Level of ready after the person has followed an instruction; `None` if the instruction does not affect it.
fn ready_after(said: &str) -> Option<bool> {
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
fn contact_after(said: &str) -> Option<bool> {
    match said.to_lowercase() {
        said if said.contains("hold the switch.") => Some(true),
        said if said.contains("release the switch.") => Some(false),
        _ => None,
    }
}

/// The answer of a person to "Type a number". The oscilloscope shows `probe_v`.
fn reading(what: &str, output: TestOutput, switch_closed: bool, probe_v: f32) -> String {
    match what {
        what if what.contains("series resistor") => "33.8".to_owned(),
        what if what.starts_with("released: ") => "10".to_owned(),
        // The leads have half an ohm.
        what if what.starts_with("held: ") => "0.5".to_owned(),
        what if what.contains("kOhm") => "9.9".to_owned(),
        what if what.contains("MOhm") => "999".to_owned(),
        what if what.contains("voltmeter") => match output {
            TestOutput::Dac(volts) => volts.to_string(),
            TestOutput::Zero | TestOutput::Enable { .. } => "0".to_owned(),
        },
        what if what.contains("positive supply") => "15.1".to_owned(),
        what if what.contains("negative supply") => "-14.9".to_owned(),
        what if what.contains("falling edges") => "0".to_owned(),
        what if what.starts_with("ENABLE_LOGIC") => logic_v(output).to_string(),
        what if what.starts_with("ENABLE,") => if switch_closed { logic_v(output) } else { 0.0 }.to_string(),
        what if what.contains("probe") => probe_v.to_string(),
        what if what.contains("at the capacitor") => "44.5".to_owned(),
        what if what.contains("at the monitor") => " 8.5 ".to_owned(),
        what => panic!("no answer to: {what}"),
    }
}

/// A good board, after its bring-up.
fn brought_up() -> TestBench {
    let mut bench = TestBench::new();
    assert!(bench.bring_up().is_some_and(|end| end.is_ok()));
    bench
}

fn good(peak_v: f32) -> Reading {
    Reading { driven_v_peak: peak_v, high_v: 1.02 * peak_v + 1.0, low_v: -1.02 * peak_v + 1.0, rest_v: 1.0 }
}

#[test]
fn a_good_board_is_driven_up_to_its_limit_and_its_measured_limits_are_stored() {
    let mut bench = TestBench::new();
    let limits = bench.bring_up().unwrap().unwrap();
    assert_eq!(bench.driven(), [10.0, 25.0, 50.0, 25.0]);
    // 1.04 at the probe, which shows less than the amplifier puts out: 68 kOhm are in front of 10 MOhm and 100 MOhm.
    assert!((limits.full_scale_v_peak - 208.0 * (1.0 + 68e3 * (1.0 / 10e6 + 1.0 / 100e6))).abs() < 0.1);
    // An amplifier of 8.5 us in front of a resistor's 36 us.
    let edges_us = 8.5 + 36.0 - 8.5 * 36.0 / 44.5;
    assert!((1e6 * limits.edge_time_constant_s - edges_us).abs() < 1e-3, "{limits:?}");
    assert_eq!(
        limits,
        BoardLimits {
            full_scale_v_peak: limits.full_scale_v_peak,
            edge_time_constant_s: limits.edge_time_constant_s,
            ..LIMITS
        }
    );
    assert_eq!(bench.events.last(), Some(&Event::Stored(limits)));
}

#[test]
fn a_bouncing_contact_is_not_a_wrong_input() {
    let mut bench = TestBench { defect: Some(Defect::Bouncing), ..TestBench::new() };
    assert!(bench.bring_up().unwrap().is_ok());
}

#[test]
fn voltages_rise_by_25_v_at_most_up_to_the_built_in_limit() {
    for (max_v, expected) in [
        (5.0, vec![5.0, 5.0]),
        (10.0, vec![10.0, 10.0]),
        (30.0, vec![10.0, 25.0, 30.0, 25.0]),
        (110.0, vec![10.0, 25.0, 50.0, 75.0, 100.0, 110.0, 25.0]),
    ] {
        let limits = BoardLimits { voltage_max_v_peak: max_v, ..LIMITS };
        let mut bench = TestBench { limits, ..TestBench::new() };
        assert!(bench.bring_up().unwrap().is_ok());
        assert_eq!(bench.driven(), expected);
    }
}

#[test]
fn a_wrong_reading_stops_at_every_question() {
    let good = brought_up();
    let mut readings = 0;
    for (index, (question, answer)) in good.questions.iter().zip(&good.answers).enumerate() {
        if !question.contains("Type a number") {
            continue;
        }
        for wrong in ["-1000", "1e6", "0,01"] {
            let mut bench = TestBench { wrong_answer: Some((index as u32 + 1, wrong)), ..TestBench::new() };
            let end = bench.bring_up().unwrap();
            let is_nothing = answer == "0" || question.contains("held: the same, Ohm");
            if question.contains("MOhm") && wrong == "1e6" || is_nothing && wrong == "0,01" {
                assert!(end.is_ok(), "an isolator may have a million megohms, and 0 V are 0.01 V: {end:?}");
            } else {
                readings += 1;
                assert!(matches!(end, Err(Stop::Reading { .. })), "{question} {wrong}: {end:?}");
                assert_eq!(bench.events.last(), Some(&Event::Asked), "something follows a wrong reading");
            }
        }
    }
    assert!(readings >= 3 * 13, "{readings}");
}

#[test]
fn a_question_answered_without_a_number_is_asked_again() {
    let good = brought_up();
    for number in 1..=good.asked {
        for wrong in ["", "NaN", "inf", "ten", "1e400", "1 2", "\u{b5}"] {
            let mut bench = TestBench { wrong_answer: Some((number, wrong)), ..TestBench::new() };
            assert!(bench.bring_up().unwrap().is_ok(), "{number} {wrong}");
            assert_eq!(bench.asked, good.asked + 1);
        }
    }
}

#[test]
fn a_check_that_fails_stops() {
    for check in CHECKS {
        let mut bench = TestBench { wrong_check: Some(check), ..TestBench::new() };
        assert_eq!(bench.bring_up().unwrap(), Err(Stop::Check(check)));
        assert_eq!(bench.events.last(), Some(&Event::Checked(check)));
        assert!(bench.driven().is_empty());
    }
}

#[test]
fn limits_that_cannot_be_stored_stop_before_anything_else() {
    let limits = BoardLimits { voltage_max_v_peak: 121.0, ..LIMITS };
    let mut bench = TestBench { limits, ..TestBench::new() };
    assert_eq!(bench.bring_up().unwrap(), Err(Stop::Limits));
    assert_eq!(bench.events, []);
}

/// One of two resistors is shorted, the capacitor is 20 % large, and the amplifier is fast or slow. The edges reveal
/// the wrong resistance even without a reading of the ohmmeter.
#[test]
fn a_wrong_series_resistance_stops_at_the_ohmmeter_and_at_the_edges() {
    let good = brought_up();
    for (what, answer, stops) in [
        ("series resistor R1", "0.1", true),
        ("series resistor R1", "33.6", true),
        ("series resistor R1", "33.7", false),
        ("series resistor R2", "34.6", false),
        ("series resistor R2", "34.7", true),
        ("series resistor R2", "68", true),
        ("series resistor R2", "185", true),
        // Less 8.5 us at the monitor: 19.2 us of the resistor, 25.1, 25.3, 50.4 and 50.5.
        ("at the capacitor", "27.7", true),
        ("at the capacitor", "33.6", true),
        ("at the capacitor", "33.8", false),
        ("at the capacitor", "58.9", false),
        ("at the capacitor", "59", true),
        ("at the monitor", "19.5", true),
        ("at the monitor", "19", false),
    ] {
        let mut bench = TestBench { wrong_answer: Some((good.number_of(what), answer)), ..TestBench::new() };
        let end = bench.bring_up().unwrap();
        assert_eq!(matches!(end, Err(Stop::Reading { .. })), stops, "{what} {answer}: {end:?}");
        let first_voltage = bench.driven().first().copied();
        assert_eq!(first_voltage.is_none(), stops && what.starts_with("series"), "{what} {answer}");
    }
}

/// A start after a reset runs the script from its beginning.
#[test]
fn the_checks_without_voltage_and_the_switch_come_before_the_first_voltage() {
    let events = brought_up().events;
    let first_voltage = events.iter().position(|event| matches!(event, Event::Driven(_))).unwrap();
    let before = &events[..first_voltage];
    let checks: Vec<Event> = before.iter().filter(|event| matches!(event, Event::Checked(_))).copied().collect();
    assert_eq!(checks, CHECKS.map(Event::Checked));
    for contact in [Event::Contact(true), Event::Contact(false), Event::Held(true), Event::Held(false)] {
        assert!(before.contains(&contact), "{contact:?}");
    }
}

#[test]
fn every_voltage_follows_a_release_and_a_press() {
    let bench = brought_up();
    let mut since_last: Vec<bool> = Vec::new();
    for event in &bench.events {
        match event {
            Event::Held(held) => since_last.push(*held),
            Event::Driven(volts) => {
                let released = since_last.iter().position(|held| !held);
                assert!(released.is_some_and(|at| since_last[at..].contains(&true)), "{volts} V: {since_last:?}");
                since_last.clear();
            }
            _ => {}
        }
    }
}

/// The script waits for a switch that is not released and an amplifier that is not ready. Touching wires end it.
#[test]
fn odd_inputs_drive_nothing() {
    for (defect, ends) in [(Defect::Taped, false), (Defect::NeverReady, false), (Defect::Bridged, true)] {
        let mut bench = TestBench { defect: Some(defect), ..TestBench::new() };
        let end = bench.bring_up();
        assert_eq!(matches!(end, Some(Err(Stop::Inputs { .. }))), ends, "{defect:?}: {end:?}");
        assert_eq!(end.is_none(), !ends, "{defect:?}: {end:?}");
        assert!(bench.driven().is_empty(), "{defect:?}");
    }
}

/// A board with a bridged monostable or second pole works normally; only this step of the script finds the bridge.
#[test]
fn a_monostable_or_a_second_pole_that_does_not_disable_the_amplifier_stops() {
    let good = brought_up();
    for (question, reading) in [
        // Gate and monostable are bridged: the processor's enable passes.
        ("ENABLE_LOGIC with PB6 high and no SYNC, V", "3.3"),
        // The monostable alone decides.
        ("ENABLE_LOGIC with SYNC and PB6 low, V", "3.3"),
        // The monostable never triggers.
        ("ENABLE_LOGIC with both, V", "0"),
        // The monostable takes no trigger before its pulse is over.
        ("ENABLE_LOGIC with both: falling edges in a second, by an oscilloscope", "1400"),
        // The monostable's pulse is ten times too long.
        ("ENABLE_LOGIC, its mean with one SYNC every 2 ms, V", "3.3"),
        // The switch's second pole is bridged.
        ("ENABLE, switch released, ENABLE_LOGIC high, V", "3.3"),
        // The wires of the two poles touch each other.
        ("ENABLE, switch held, ENABLE_LOGIC low, V", "3.3"),
        // The second pole never closes.
        ("ENABLE, switch held, ENABLE_LOGIC high, V", "0"),
        // The amplifier's enable is plugged in front of the second pole.
        ("released: ENABLE_LOGIC to ENABLE at the amplifier's own terminal, kOhm", "0"),
    ] {
        let mut bench = TestBench { wrong_answer: Some((good.number_of(question), reading)), ..TestBench::new() };
        let end = bench.bring_up().unwrap();
        assert!(matches!(end, Err(Stop::Reading { what, .. }) if what == question), "{question}: {end:?}");
        assert!(bench.driven().is_empty());
    }
}

#[test]
fn a_fault_ends_the_script_and_no_voltage_follows() {
    for number in 1..=4 {
        for error in [
            DriveError::Fault(Fault::ArmSwitch, 0),
            DriveError::Fault(Fault::Monitor, 7),
            DriveError::State(State::Disarmed),
            DriveError::Refused(Refusal::OptionBytes),
            DriveError::NoReading,
        ] {
            let mut bench = TestBench { wrong_drive: Some((number, Err(error))), ..TestBench::new() };
            assert_eq!(bench.bring_up().unwrap(), Err(Stop::Drive(error)));
            assert_eq!(bench.driven().len(), number as usize);
            assert!(matches!(bench.events.last(), Some(Event::Driven(_))));
        }
    }
}

#[test]
fn a_higher_voltage_follows_only_a_correct_monitor() {
    for (number, peak_v) in [(1, 10.0), (2, 25.0), (3, 50.0), (4, 25.0)] {
        for wrong in [
            // Dead, one half dead, a wrong gain, an offset, charge that stays, a wrong voltage.
            Reading { high_v: 0.0, low_v: 0.0, ..good(peak_v) },
            Reading { low_v: 0.0, ..good(peak_v) },
            Reading { high_v: 1.25 * peak_v, low_v: -1.25 * peak_v, ..good(peak_v) },
            Reading { high_v: peak_v + 5.0, low_v: -peak_v + 5.0, ..good(peak_v) },
            Reading { rest_v: 5.0, ..good(peak_v) },
            Reading { driven_v_peak: 0.8 * peak_v, ..good(peak_v) },
            Reading { high_v: f32::NAN, ..good(peak_v) },
        ] {
            let mut bench = TestBench { wrong_drive: Some((number, Ok(wrong))), ..TestBench::new() };
            let end = bench.bring_up().unwrap();
            assert!(matches!(end, Err(Stop::Reading { .. })), "{wrong:?}: {end:?}");
            assert_eq!(bench.driven().len(), number as usize, "{wrong:?}");
        }
    }
}

/// Only the probe reveals an amplifier gain and a monitor scale that are wrong by the same factor.
#[test]
fn a_probe_that_contradicts_drive_or_monitor_stops() {
    let good = brought_up();
    let number = 1 + good.questions.iter().rposition(|question| question.contains("probe's")).unwrap() as u32;
    // 50 V are driven, and the monitor shows 51 V. 45 V would be within the amplifier's tolerance.
    for (probe, is_right) in [("45", false), ("47", true), ("50", true), ("55", true), ("57", false)] {
        let mut bench = TestBench { wrong_answer: Some((number, probe)), ..TestBench::new() };
        let end = bench.bring_up().unwrap();
        assert_eq!(end.is_ok(), is_right, "{probe}: {end:?}");
        assert_eq!(bench.driven().len(), if is_right { 4 } else { 3 });
    }
}

/// The touch bound has a margin for deviations of amplifier and resistor from the values assumed by the firmware. Probe
/// and monitor may be misread, but not both by more than 4 % too low.
#[test]
fn the_stored_full_scale_is_within_the_margin_of_the_touch_bound_for_any_readings() {
    const RESISTOR_MIN: f32 = 0.99 / 1.005;
    let good = brought_up();
    let number = 1 + good.questions.iter().rposition(|question| question.contains("probe's")).unwrap() as u32;
    let mut accepted = 0;
    for gain in [0.95, 1.0, 1.05] {
        for monitor_error in [-0.04, 0.0, 0.04] {
            let peak_v = 50.0 * gain * (1.0 + monitor_error);
            let reading = Reading { driven_v_peak: 50.0, high_v: peak_v, low_v: -peak_v, rest_v: 0.0 };
            for (probe, typed) in (40..=60).map(|volts| (volts, volts.to_string())) {
                let wrong_answer = Some((number, Box::leak(typed.into_boxed_str()) as &'static str));
                let mut bench = TestBench { wrong_answer, wrong_drive: Some((3, Ok(reading))), ..TestBench::new() };
                let Ok(limits) = bench.bring_up().unwrap() else { continue };
                accepted += 1;
                let current = gain * BUILT_IN.full_scale_v_peak / limits.full_scale_v_peak / RESISTOR_MIN;
                assert!(current < TouchBound::MARGIN, "gain {gain}, monitor {monitor_error}, probe {probe}: {current}");
            }
        }
    }
    assert!(accepted > 50, "{accepted}");
}

/// The clip of a mains-powered oscilloscope ties the common to earth, which hides a missing isolator.
#[test]
fn rails_and_isolation_are_measured_before_and_after_the_probes() {
    let bench = brought_up();
    let orders = [
        "measure each rail",
        "No oscilloscope is connected",
        "MOhm",
        "probe on the capacitor",
        "probe's",
        "measure each rail",
        "Take all probes off",
        "MOhm",
    ];
    let mut questions = bench.questions.iter();
    for order in orders {
        assert!(questions.any(|question| question.contains(order)), "{order}");
    }
    assert!(!questions.any(|question| question.contains("probe")));
    assert!(matches!(bench.events[..], [.., Event::Asked, Event::Stored(_)]));
}

/// The script checks the largest full scale that readings may give before it begins. Behind 44 kOhm an amplifier of
/// gain 20 may be stuck at its rail, and one of the largest gain that the script accepts may not.
#[test]
fn a_series_resistance_too_small_for_the_largest_gain_stops_before_anything_else() {
    for (series_ohm, is_taken) in [(44e3, false), (48e3, true)] {
        let behind = Board { limits: LIMITS, ..Board::NUCLEO_G474RE }.behind(series_ohm).limits;
        let limits = BoardLimits { voltage_max_v_peak: LIMITS.voltage_max_v_peak, ..behind };
        assert!(write_limits(&limits, CeilingPolicy::InForce).is_ok());
        let mut bench = TestBench { limits, ..TestBench::new() };
        let stops_at_once = bench.bring_up() == Some(Err(Stop::Limits)) && bench.events.is_empty();
        assert_eq!(stops_at_once, !is_taken, "{series_ohm}");
    }
}
