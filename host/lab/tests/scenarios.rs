//! The scenarios that come with the simulator: what they expect is seen, and none of it would be seen on a broken rig.
#![allow(clippy::disallowed_methods, reason = "the tests read the scenarios' files")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use frixel_hil_sim::{Board, BoardMemory, BoardRig, Felt, NoiseConfig, Rig, RigConfig, RigError, RigFault, RigTick};
use frixel_lab::scenario::{ScenarioError, ScenarioOutcome, programs, run, run_in_process, simulation};
use frixel_scene::{Action, Cause, Condition, Expectation, LineDamage, Scenario, Scene};
use frixel_wire::dac_code::DacCode;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../hil-sim/scenarios")
}

/// Every scenario, with its scenes.
fn scenarios() -> Vec<(Scenario, BTreeMap<String, Scene>)> {
    let mut files: Vec<_> = fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let texts = files.iter().map(|file| {
        let name = file.file_name().unwrap().to_str().unwrap().to_owned();
        (name, fs::read_to_string(file).unwrap())
    });
    let scenarios: Vec<_> = texts
        .filter(|(_, text)| text.starts_with("scenario"))
        .map(|(name, text)| {
            let scenario = Scenario::parse(&text, &name).unwrap();
            let scenes = scenario.scenes().map(|scene| (scene.to_owned(), scene_of(scene))).collect();
            (scenario, scenes)
        })
        .collect();
    assert!(scenarios.len() >= 20, "{}", scenarios.len());
    scenarios
}

fn scene_of(name: &str) -> Scene {
    let text = fs::read_to_string(folder().join(name)).unwrap();
    Scene::parse(&text, name, &BTreeMap::<String, Vec<u8>>::new()).unwrap()
}

/// Runs a scenario on the simulator's board.
fn run_on_simulator(scenario: &Scenario, scenes: &BTreeMap<String, Scene>) -> Result<ScenarioOutcome, ScenarioError> {
    let config = RigConfig::default();
    run_in_process(scenario, &programs(scenario, scenes, &config.board)?, &config)
}

#[test]
fn every_scenario_shows_what_it_expects() {
    let mut unmet: Vec<String> = Vec::new();
    for (scenario, scenes) in scenarios() {
        assert!(!scenario.about.is_empty() && !scenario.expectations.is_empty(), "{}", scenario.file);
        let outcome = run_on_simulator(&scenario, &scenes).unwrap();
        unmet.extend(outcome.unmet.iter().map(ToString::to_string));
    }
    assert!(unmet.is_empty(), "{}", unmet.join("\n"));
}

#[test]
fn a_scenario_runs_the_same_every_time() {
    let named = |(scenario, _): &(Scenario, _)| scenario.file == "bits-flipped.toml";
    let (mut scenario, scenes) = scenarios().into_iter().find(named).unwrap();
    let noise = NoiseConfig { bit_error_rate: 2e-3, ..NoiseConfig::default() };
    scenario.faults[0].cause = Cause::Line { directions: [true, true], damage: LineDamage::Noise(noise) };
    let run = |seed| run_on_simulator(&Scenario { seed, ..scenario.clone() }, &scenes).unwrap();
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

#[test]
fn wrong_option_bytes_refuse_arming_with_the_command_that_sets_them() {
    let text = "scenario = 1\nscene = \"plate.toml\"\nseconds = 0.6\n\
         [[command]]\nat_ms = 0\ndo = \"play\"\n\
         [[fault]]\nat_ms = 200\ncause = \"option-bytes\"\n\
         [[command]]\nat_ms = 300\ndo = \"connect\"\n\
         [[command]]\nat_ms = 400\ndo = \"play\"\n\
         [[expect]]\nfrom_ms = 100\nto_ms = 190\noutput = \"driven\"\n\
         [[expect]]\nfrom_ms = 210\nto_ms = 300\nerror = \"restarted\"\n\
         [[expect]]\nfrom_ms = 210\noutput = \"off\"\n\
         [[expect]]\nfrom_ms = 400\nerror = \"STM32_Programmer_CLI -c port=SWD -ob BOR_LEV=4 IWDG_SW=0\"\n";
    let scenario = Scenario::parse(text, "option-bytes.toml").unwrap();
    let scenes = BTreeMap::from([("plate.toml".to_owned(), scene_of("plate.toml"))]);
    let outcome = run_on_simulator(&scenario, &scenes).unwrap();
    assert_eq!(outcome.unmet.iter().map(ToString::to_string).collect::<Vec<_>>(), Vec::<String>::new());
}

/// How a rig is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Break {
    /// The output is driven in every tick.
    Driven,
    /// The output is zero in every tick, and no friction is felt.
    Dead,
    /// Nothing arrives at the host.
    Mute,
    /// What the scenario causes does not happen, nor does the host do anything after its first command.
    Harmless,
    /// What is seen may be 5 ms late.
    Late,
}

/// 5 ms of the simulator's board.
const LATENESS_TICKS: u64 = 200;
const BREAKS: [Break; 4] = [Break::Driven, Break::Dead, Break::Mute, Break::Harmless];

struct Broken<'a> {
    rig: Rig<'a>,
    how: Break,
}

impl BoardRig for Broken<'_> {
    fn name(&self) -> &'static str {
        "broken"
    }

    fn board(&self) -> &Board {
        self.rig.board()
    }

    fn tick(&self) -> u64 {
        self.rig.tick()
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), RigError> {
        BoardRig::send(&mut self.rig, bytes)
    }

    fn run(
        &mut self,
        until_tick: u64,
        received: &mut Vec<u8>,
        watch: &mut dyn FnMut(&RigTick),
    ) -> Result<(), RigError> {
        let how = self.how;
        self.rig.run(until_tick, received, &mut |tick| {
            let mut tick = *tick;
            match how {
                Break::Driven => {
                    tick.drive.dac_code = DacCode::from_bits(20_000);
                    tick.drive.amplifier_enable = true;
                    tick.felt = Felt { electrode_v: 152.0, ..tick.felt };
                }
                Break::Dead => {
                    tick.drive.dac_code = DacCode::ZERO;
                    tick.felt = Felt { friction_n: 0.0, ..tick.felt };
                }
                Break::Mute | Break::Harmless | Break::Late => {}
            }
            watch(&tick);
        })?;
        if how == Break::Mute {
            received.clear();
        }
        Ok(())
    }

    fn cause(&mut self, fault: RigFault, ticks: u64) -> Result<(), RigError> {
        self.rig.cause(fault, ticks)
    }

    fn start_stroke(&mut self) {
        self.rig.start_stroke();
    }

    fn lateness_ticks(&self) -> u64 {
        if self.how == Break::Late { LATENESS_TICKS } else { 0 }
    }
}

fn run_broken(scenario: &Scenario, scenes: &BTreeMap<String, Scene>, how: Break) -> ScenarioOutcome {
    let mut scenario = scenario.clone();
    if how == Break::Harmless {
        // Names stay, so that times count from something.
        for fault in &mut scenario.faults {
            fault.cause = Cause::Line { directions: [false, false], damage: LineDamage::Cut };
        }
        for command in scenario.commands.iter_mut().filter(|command| command.action != Action::Play) {
            command.action = Action::Hang { ms: 0.0 };
        }
    }
    let config = RigConfig::default();
    let programs = programs(&scenario, scenes, &config.board).unwrap();
    let (mut memory, mut spare) = (BoardMemory::new(), vec![]);
    spare.resize_with(scenario.resets(), BoardMemory::new);
    let rig = simulation(&scenario, &programs, &config).unwrap().rig(&mut memory).unwrap();
    run(&scenario, &programs, &mut Broken { rig: rig.with_spare_memories(&mut spare), how }).unwrap()
}

/// An expectation that no broken rig leaves unmet would be met by anything.
#[test]
fn every_expectation_is_unmet_on_a_broken_rig() {
    for (scenario, scenes) in scenarios() {
        let outcomes = BREAKS.map(|how| run_broken(&scenario, &scenes, how));
        for (number, expectation) in scenario.expectations.iter().enumerate() {
            let is_unmet =
                outcomes.iter().any(|outcome| outcome.unmet.iter().any(|unmet| unmet.expectation == Some(number)));
            assert!(is_unmet, "{}:{}: {:?}", scenario.file, expectation.line, expectation.condition);
        }
    }
}

fn plays_and_stops() -> (Scenario, BTreeMap<String, Scene>) {
    scenarios().into_iter().find(|(scenario, _)| scenario.file == "plays-and-stops.toml").unwrap()
}

/// A rig that is late makes spans shorter, and in less than 10 ms no tick by itself is too late.
#[test]
fn a_driven_output_over_a_short_span_is_unmet_on_a_dead_board() {
    let (mut scenario, scenes) = plays_and_stops();
    let from_ms = 400.0;
    let condition = Condition::OutputDriven;
    scenario.expectations = vec![Expectation { line: 1, after: None, from_ms, to_ms: Some(from_ms + 4.0), condition }];
    assert_eq!(run_on_simulator(&scenario, &scenes).unwrap().unmet, []);
    let unmet = run_broken(&scenario, &scenes, Break::Dead).unmet;
    assert_eq!(unmet.len(), 1);
    assert!(unmet[0].sentence.ends_with("found DAC code 0 in each of its 160 ticks"), "{}", unmet[0]);
}

/// What is left of a span on a rig that is late is not what the file says.
#[test]
fn a_span_without_a_tick_says_why() {
    let (mut scenario, scenes) = plays_and_stops();
    scenario.seconds = 1.0;
    scenario.commands.retain(|command| command.at_ms < 1_000.0);
    for (from_ms, to_ms, how, said) in [
        (
            1_000.0,
            None,
            Break::Dead,
            "a driven output from 1000.000 ms on, and the scenario ends at 1000.000 ms: let it run for longer",
        ),
        (
            400.0,
            Some(400.0),
            Break::Dead,
            "a driven output from 400.000 to 400.000 ms, and there is no tick in it: expect it for longer",
        ),
        (
            400.0,
            Some(409.0),
            Break::Late,
            "a driven output from 400.000 to 409.000 ms, and this rig is up to 5 ms late, which shortens a span by as \
             much at both ends: expect it for more than 10 ms",
        ),
        (
            1_100.0,
            Some(1_200.0),
            Break::Late,
            "a driven output from 1100.000 ms on, and the scenario ends at 1000.000 ms: let it run for longer",
        ),
    ] {
        scenario.expectations =
            vec![Expectation { line: 1, after: None, from_ms, to_ms, condition: Condition::OutputDriven }];
        let unmet = run_broken(&scenario, &scenes, how).unmet;
        let sentences: Vec<&str> = unmet.iter().map(|unmet| unmet.sentence.as_str()).collect();
        assert_eq!(sentences, [format!("expected {said}")]);
    }
}
