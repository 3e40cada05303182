//! The scenarios of `hil-sim/scenarios` on the emulated boards, through the command.

use std::path::Path;
use std::process::Command;

use crate::bench::turn;
use crate::emulator::{image, pico_image};
use crate::example::{page, run, text};

/// Runs scenarios on a rig, and returns what was not as expected.
fn unmet(rig: &str, scenarios: &[&str]) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../hil-sim/scenarios");
    let run = |name: &&str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_frixel"));
        command.args(["sim", "--expect", "--rig", rig, "--scenario"]).arg(folder.join(format!("{name}.toml")));
        let output = command.output().unwrap();
        (!output.status.success()).then(|| format!("{name}: {}", String::from_utf8_lossy(&output.stderr)))
    };
    scenarios.iter().filter_map(run).collect()
}

#[test]
fn scenarios_show_on_the_emulated_board_what_they_expect() {
    if image().is_none() {
        return;
    }
    let _turn = turn();
    let scenarios = ["cable-cut", "amplifier-over-current", "finger-lifted", "late-tick", "bytes-lost"];
    let unmet = unmet("qemu", &scenarios);
    assert!(unmet.is_empty(), "{}", unmet.join("\n"));
    // What this rig cannot cause is said, and nothing is claimed.
    let refused = self::unmet("qemu", &["dac-stuck"]).concat();
    assert!(refused.contains("dac-stuck.toml:10: the emulated board cannot cause this fault"), "{refused}");
}

#[test]
fn scenarios_show_on_the_picos_image_what_they_expect() {
    if pico_image().is_none() {
        return;
    }
    let _turn = turn();
    let unmet = unmet("pico", &["monitor-dead", "switch-let-go", "reset", "switch-welded", "cable-cut"]);
    assert!(unmet.is_empty(), "{}", unmet.join("\n"));
}

#[test]
fn the_pages_first_example_holds_on_the_emulated_board() {
    if image().is_none() {
        return;
    }
    let _turn = turn();
    let output = run(&text(), "qemu");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// A `play` of it ends when the image has computed the scene's table, which the page has the time of.
#[test]
fn the_pages_first_example_holds_on_the_picos_image() {
    if pico_image().is_none() {
        return;
    }
    let _turn = turn();
    let output = run(&text(), "pico");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let timeline = String::from_utf8(output.stdout).unwrap();
    let at_ms = |what: &str| {
        let line = timeline.lines().find_map(|line| line.strip_suffix(what)).unwrap();
        line.trim().strip_suffix(" ms").unwrap().parse::<f64>().unwrap()
    };
    let play_s = 1e-3 * (at_ms("  play: done") - at_ms("  play"));
    assert!(page().contains(&format!("which takes {play_s:.2} s: so long does each `play`")), "{play_s}");
}
