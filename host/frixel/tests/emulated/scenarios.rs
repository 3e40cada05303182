//! The scenarios of `hil-sim/scenarios` on the emulated boards, through the command.

use std::fs;

use crate::bench::turn;
use crate::emulator::{image, pico_image};
use crate::example::{page, run, text};
use crate::processes::{frixel, repository, said};

/// Scenarios that a rig cannot run, each with the input that it lacks.
const NOT_ON_QEMU: [(&str, &str); 1] = [("counters-wrap", "its emulator has no input for it")];
const NOT_ON_PICO: [(&str, &str); 3] = [
    ("counters-wrap", "an unmodified image has no input for it"),
    ("dac-holds-its-code", "too fast for 8000 ticks a second"),
    ("late-tick", "an unmodified image has no input for it"),
];

/// The ones that run on the emulated boards with every change. All of them take half an hour on the Pico, and need a
/// machine that does nothing else on `qemu`, which lags by more than its 20 ms on a busy one.
const FEW_ON_QEMU: [&str; 5] = ["cable-cut", "amplifier-over-current", "finger-lifted", "late-tick", "bytes-lost"];
const FEW_ON_PICO: [&str; 1] = ["cable-cut"];

/// Runs scenarios on a rig: those of `names`, and the ones that are `lacking`, which fail for the reason given.
fn check(rig: &str, lacking: &[(&str, &str)], names: impl Fn(&str) -> bool) {
    let _turn = turn();
    let mut files: Vec<_> =
        fs::read_dir(repository().join("hil-sim/scenarios")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| fs::read_to_string(file).unwrap().starts_with("scenario"));
    files.sort();
    let mut unmet = Vec::new();
    for file in files {
        let name = file.file_stem().unwrap().to_str().unwrap();
        let reason = lacking.iter().find(|(lacking, _)| *lacking == name);
        if reason.is_none() && !names(name) {
            continue;
        }
        let output = frixel().args(["sim", "--expect", "--rig", rig, "--scenario"]).arg(&file).output().unwrap();
        let said = said(&output);
        let is_right = match reason {
            Some((_, reason)) => !output.status.success() && said.contains(reason),
            None => output.status.success(),
        };
        if !is_right {
            unmet.push(format!("{name}: {}: {said}", output.status));
        }
    }
    assert!(unmet.is_empty(), "{}", unmet.join("\n"));
}

#[test]
fn scenarios_show_on_the_emulated_board_what_they_expect() {
    if image().is_some() {
        check("qemu", &NOT_ON_QEMU, |name| FEW_ON_QEMU.contains(&name));
    }
}

#[test]
#[ignore = "minutes of a machine that does nothing else"]
fn every_scenario_shows_on_the_emulated_board_what_it_expects() {
    if image().is_some() {
        check("qemu", &NOT_ON_QEMU, |_| true);
    }
}

#[test]
fn scenarios_show_on_the_picos_image_what_they_expect() {
    if pico_image().is_some() {
        check("pico", &NOT_ON_PICO, |name| FEW_ON_PICO.contains(&name));
    }
}

#[test]
#[ignore = "half an hour"]
fn every_scenario_shows_on_the_picos_image_what_it_expects() {
    if pico_image().is_some() {
        check("pico", &NOT_ON_PICO, |_| true);
    }
}

#[test]
fn the_pages_first_example_holds_on_the_emulated_board() {
    if image().is_none() {
        return;
    }
    let _turn = turn();
    let output = run(&text(), "qemu");
    assert!(output.status.success(), "{}", said(&output));
}

/// A `play` of it ends when the image has computed the scene's table. The page states how long that takes.
#[test]
fn the_pages_first_example_holds_on_the_picos_image() {
    if pico_image().is_none() {
        return;
    }
    let _turn = turn();
    let output = run(&text(), "pico");
    assert!(output.status.success(), "{}", said(&output));
    let timeline = String::from_utf8(output.stdout).unwrap();
    let at_ms = |what: &str| {
        let line = timeline.lines().find_map(|line| line.strip_suffix(what)).unwrap();
        line.trim().strip_suffix(" ms").unwrap().parse::<f64>().unwrap()
    };
    let play_s = 1e-3 * (at_ms("  play: done") - at_ms("  play"));
    assert!(page().contains(&format!("each `play` takes {play_s:.2} s")), "{play_s}");
}
