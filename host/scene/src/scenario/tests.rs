use std::path::Path;

use frixel_hil_sim::{NoiseConfig, RigFault, WorldFault};
use frixel_testkit::corpus;

use super::*;

const HEAD: &str = "scenario = 1\nscene = \"plate.toml\"\nseconds = 2\n";

fn parsed(tables: &str) -> Result<Scenario, String> {
    Scenario::parse(format!("{HEAD}{tables}"), "test.toml").map_err(|error| error.to_string())
}

#[test]
fn a_scenario_is_read_in_its_units() {
    let scenario = parsed(
        "seed = 7\nworld = \"realistic\"\nstroke = { from_mm = [10, 40], to_mm = [110, 40], speed_mm_per_s = 50 }\n\
         [[command]]\nat_ms = 0\ndo = \"play\"\n[[command]]\nat_ms = 10\ndo = \"trigger\"\nlayer = \"OK\"\nfor_ms = 50\n\
         [[fault]]\nname = \"noise\"\nat_ms = 300\nfor_ms = 20\ncause = \"bits-flipped\"\nshare = 1e-3\nline = \"to-board\"\n\
         [[fault]]\nat_ms = 400\ncause = \"reset\"\n[[fault]]\nat_ms = 500\ncause = \"amplifier-sags\"\ngain = 0.5\n\
         [[fault]]\nat_ms = 600\ncause = \"dac-stuck\"\nfraction = 0.4\n\
         [[expect]]\nafter = \"noise\"\nfrom_ms = 1\nto_ms = 9\noutput = \"driven\"\nfriction_fraction = [0.4, 0.6]\nstate = \"active\"\n",
    )
    .unwrap();
    assert_eq!((scenario.seed, scenario.is_realistic, scenario.resets()), (7, true, 1));
    assert_eq!(scenario.stroke.map(|stroke| stroke.speed_mm_per_s), Some(50.0));
    let trigger = Action::Trigger { layer: "OK".into(), duration_s: Some(0.05) };
    assert_eq!(scenario.commands[1].action, trigger);
    assert_eq!((scenario.commands[1].at_ms, scenario.faults[0].at_ms), (10.0, 300.0));
    let damage = LineDamage::Noise(NoiseConfig { bit_error_rate: 1e-3, ..NoiseConfig::default() });
    assert_eq!(scenario.faults[0].cause, Cause::Line { directions: [true, false], damage });
    assert_eq!(scenario.faults[2].cause, Cause::Rig(RigFault::World(WorldFault::AmplifierGain(0.5))));
    assert_eq!(scenario.faults[3].cause, Cause::DacStuck { fraction: 0.4 });
    let conditions: Vec<&Condition> = scenario.expectations.iter().map(|expectation| &expectation.condition).collect();
    assert_eq!(
        conditions,
        [&Condition::OutputDriven, &Condition::Friction([0.4, 0.6]), &Condition::State(State::Active)]
    );
    assert_eq!((scenario.expectations[0].from_ms, scenario.expectations[0].to_ms), (1.0, Some(9.0)));
}

#[test]
fn every_scenario_is_answered_as_its_page_says() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/corpus/scenarios/mistakes.md");
    corpus::hold(Path::new(page), |case| {
        let scenario = Scenario::parse(&case.files["scenario.toml"], "scenario.toml");
        scenario.map_or_else(|error| format!("{error}\n"), |_| String::new())
    });
}

/// 50,000 commands took half a minute.
#[test]
fn a_scenario_has_as_many_entries_as_are_read() {
    let command = |number: u32| format!("[[command]]\nname = \"c{number}\"\nat_ms = 1\ndo = \"stop\"\n");
    let commands = |count: u32| (0..count).map(command).collect::<Vec<_>>().concat();
    assert!(parsed(&commands(1_000)).is_ok());
    let error = parsed(&commands(50_000)).unwrap_err();
    assert!(error.contains("there are 50000 commands, faults and expectations, and at most 1000 are read"), "{error}");
}

/// A mistake in a command or a fault does not hide its name from an expectation.
#[test]
fn one_mistake_is_one_sentence() {
    let sag = "[[fault]]\nname = \"sag\"\nat_ms = 5\n";
    for tables in [
        format!("{sag}cause = \"amplifier-sags\"\n"),
        format!("{sag}cause = \"amplifier-sags\"\ngian = 0.3\n"),
        format!("{sag}cause = \"amplifier-sags\"\ngain = \"low\"\n"),
        format!("{sag}cause = \"amplifier-sag\"\n"),
        sag.to_owned(),
        "[[fault]]\nname = 3\nat_ms = 5\ncause = \"reset\"\n".to_owned(),
        "[[command]]\nname = \"sag\"\nat_ms = 5\ndo = \"trigger\"\n".to_owned(),
        "[fault]\nname = \"sag\"\nat_ms = 5\ncause = \"reset\"\n".to_owned(),
    ] {
        let error = parsed(&format!("{tables}[[expect]]\nafter = \"sag\"\noutput = \"off\"\n")).unwrap_err();
        assert_eq!(error.lines().count(), 1, "{error}");
    }
}

/// Every word of a scenario is in its documentation.
#[test]
#[allow(clippy::disallowed_methods, reason = "the test reads the documentation")]
fn the_documentation_has_every_word() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/inside/scenarios.md");
    let docs = std::fs::read_to_string(file).unwrap();
    let fields = [tables::file::ALL, tables::stroke::ALL, tables::when::ALL, tables::command::ALL, tables::fault::ALL];
    let fields = fields.concat().into_iter().chain(tables::expect::ALL.iter().copied()).map(|field| field.name);
    for word in fields.chain(read::ACTIONS.map(|(word, _)| word)).chain(read::CAUSES.map(|(word, _)| word)) {
        assert!(docs.contains(&format!("`{word}`")) || docs.contains(&format!("`[[{word}]]`")), "{word}");
    }
    for word in read::STATES.map(|(word, _)| word).into_iter().chain(read::FAULTS.map(|(word, _)| word)) {
        assert!(docs.contains(&format!("`\"{word}\"`")), "{word}");
    }
}
