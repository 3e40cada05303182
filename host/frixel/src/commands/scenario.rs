//! `frixel sim --scenario`: runs a scenario on a rig, and prints the expectations that were not met.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Result, bail};
use frixel_hil_sim::{BoardRig, RigConfig};
use frixel_lab::scenario::{self, Programs, ScenarioOutcome, run_in_process};
use frixel_lab::simulate::screen_m;
use frixel_scene::{Scenario, Scene};

use super::error::{at, reading};
use crate::input;
use crate::scene_file::load;

use super::stroke::note_off_screen;
use super::target::Target;
use super::terminal::{note, print_line};

/// Runs a scenario, prints what happened, and fails if something was not as expected and `expect` is set.
pub(super) fn run(file: &Path, expect: bool, rig: Target) -> Result<()> {
    let scenario = read(file)?;
    if expect && scenario.expectations.is_empty() {
        bail!(
            "{}: --expect checks a scenario's expectations, and this one has none: add an [[expect]] \
             (docs/inside/scenarios.md)",
            file.display()
        );
    }
    let scenes = scenes(&scenario, file)?;
    let config = rig.rig();
    let programs = programs(&scenario, &scenes, &config)?;
    let outcome = match rig {
        Target::Qemu | Target::Pico => {
            let program = scenario::first_program(&scenario, &programs)?;
            let simulation = scenario::simulation(&scenario, &programs, &config)?;
            let run = |mut rig: Box<dyn BoardRig + '_>| Ok(scenario::run(&scenario, &programs, &mut *rig)?);
            let (outcome, ended) = rig.on_rig(&simulation, program, run)?;
            ended.map(|()| outcome)?
        }
        Target::Sim | Target::Port => run_in_process(&scenario, &programs, &config)?,
    };
    print(&outcome)?;
    let (unmet, expectations) = (outcome.unmet.len(), outcome.expectations);
    if expect && unmet > 0 {
        let were = if unmet == 1 { "thing was" } else { "things were" };
        bail!("{}: {unmet} {were} not as expected: see above", file.display());
    }
    if unmet == 0 && expectations > 0 {
        print_line(format_args!("all {expectations} expectations were met"))?;
    }
    Ok(())
}

/// The programs of a scenario for a board. Prints a note if the stroke leaves the screen.
fn programs(scenario: &Scenario, scenes: &BTreeMap<String, Scene>, rig: &RigConfig) -> Result<Programs> {
    let programs = scenario::programs(scenario, scenes, &rig.board)?;
    if let (Some(_), Some(program)) = (&scenario.stroke, programs.get(&scenario.scene)) {
        let stroke = scenario::simulation(scenario, &programs, rig)?.stroke;
        let name = format!("{}: the stroke", scenario.file);
        note_off_screen(&name, &stroke, screen_m(program), scenario.seconds).map_err(at(&scenario.file))?;
    }
    Ok(programs)
}

fn print(outcome: &ScenarioOutcome) -> Result<()> {
    outcome.timeline.iter().try_for_each(print_line)?;
    outcome.unmet.iter().for_each(note);
    Ok(())
}

fn read(file: &Path) -> Result<Scenario> {
    let bytes = input::read_toml(file).map_err(reading(file))?;
    Ok(Scenario::parse(bytes, &file.display().to_string())?)
}

/// The scenes of a scenario, whose files are named relative to its folder.
fn scenes(scenario: &Scenario, file: &Path) -> Result<BTreeMap<String, Scene>> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let scenes = scenario.scenes().map(|name| Ok((name.to_owned(), load(&folder.join(name))?)));
    scenes.collect()
}
