//! `--control`: a scene that changes while it plays.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Output, Stdio};

use tempfile::TempDir;

use super::{command, scene, succeed};

/// A scene of one layer, 10 mN above the natural friction of 250 mN everywhere.
fn write_scene(path: &Path, friction_n: &str) {
    let constant = fs::read_to_string(scene("constant.toml")).unwrap();
    let (head, _) = constant.split_once("[[layer]]").unwrap();
    let layer = "[[layer]]\nname = \"plate one\"\nkind = \"constant\"\nlive = true\nfriction_n = ";
    fs::write(path, format!("{head}{layer}{friction_n}\n")).unwrap();
}

/// Plays a scene for 1.2 s of virtual time with these lines on standard input.
fn control(folder: &Path, lines: &str) -> Output {
    let arguments = ["play", "scene.toml", "--control", "--from", "10,30", "--to", "110,30", "--seconds", "1.2"];
    let mut command = command(folder, &[&arguments[..], &["--speed", "80", "--ideal"]].concat());
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut process = command.spawn().unwrap();
    process.stdin.take().unwrap().write_all(lines.as_bytes()).unwrap();
    process.wait_with_output().unwrap()
}

/// Wanted and felt friction at a time, mN.
fn friction_mn(folder: &Path, t_ms: usize) -> (f64, f64) {
    let text = fs::read_to_string(folder.join("frixel-out/felt.csv")).unwrap();
    let cells: Vec<&str> = text.lines().nth(t_ms).unwrap().split(',').collect();
    (1e3 * cells[4].parse::<f64>().unwrap(), 1e3 * cells[6].parse::<f64>().unwrap())
}

#[test]
fn layers_are_switched_turned_down_and_triggered() {
    let folder = TempDir::new().unwrap();
    write_scene(&folder.path().join("scene.toml"), "0.26");
    let lines = "wait 0.2\nlayer \"plate one\" off\nwait 0.2\nlayer 1 on gain 0.5 # half\nwait 0.2\nlayer 1 off gain 1\n\
                 wait 0.1\ntrigger \"plate one\" 200\n";
    let output = control(folder.path(), lines);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for (t_ms, expected_mn) in [(190, 260.0), (390, 250.0), (590, 255.0), (690, 250.0), (890, 260.0), (1_000, 250.0)] {
        let (reference_mn, felt_mn) = friction_mn(folder.path(), t_ms);
        assert!((reference_mn - expected_mn).abs() < 0.1, "{t_ms} ms: {reference_mn} mN wanted");
        assert!((felt_mn - expected_mn).abs() < 0.5, "{t_ms} ms: {felt_mn} mN felt");
    }
    let svg = fs::read_to_string(folder.path().join("frixel-out/felt.svg")).unwrap();
    let names = ["plate one", "plate one off"].map(|name| svg.lines().filter(|line| *line == name).count());
    assert_eq!(names, [3, 2], "a tenth of a second has no room for a name");
}

/// A layer that starts off is off in the felt friction and in the drawing, and what lies below it is touched.
#[test]
fn a_layer_that_starts_off_waits_for_its_trigger_and_stays_as_it_was_switched() {
    let folder = TempDir::new().unwrap();
    let ground = "version = 1\n[[layer]]\nname = \"ground\"\nkind = \"constant\"\nfriction_n = 0.26\n";
    let ping = "[[layer]]\nname = \"ping\"\nkind = \"constant\"\nfriction_n = 0.35\nlive = true\nstart = \"off\"\n";
    fs::write(folder.path().join("scene.toml"), format!("{ground}{ping}")).unwrap();
    let lines = "wait 0.2\ntrigger ping 200\nwait 0.4\nreplace scene.toml\nwait 0.1\nlayer ping on gain 0.9\nwait 0.1\n\
                 replace scene.toml\nwait 0.1\nlayer ping gain 1 off\n";
    let output = control(folder.path(), lines);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let rows =
        [(20, 260.0), (190, 260.0), (390, 350.0), (590, 260.0), (690, 260.0), (790, 340.0), (890, 340.0), (990, 260.0)];
    for (t_ms, expected_mn) in rows {
        let (reference_mn, felt_mn) = friction_mn(folder.path(), t_ms);
        assert!((reference_mn - expected_mn).abs() < 0.1, "{t_ms} ms: {reference_mn} mN wanted");
        assert!((felt_mn - expected_mn).abs() < 1.5, "{t_ms} ms: {felt_mn} mN felt");
    }
    assert!(!String::from_utf8_lossy(&output.stdout).contains("never touched"));
    let svg = fs::read_to_string(folder.path().join("frixel-out/felt.svg")).unwrap();
    assert!(svg.lines().any(|line| line == "ping off") && svg.lines().any(|line| line == "ping"));
}

/// Whatever the time since the board's power-on, the first beat comes with the trigger, and the last one is whole.
#[test]
fn a_trigger_plays_its_burst_or_its_pattern_from_the_beginning() {
    let ping = "version = 1\n[[layer]]\nname = \"ping\"\nlive = true\nstart = \"off\"\n";
    let burst = "kind = \"vibration\"\nwave = \"square\"\nfrequency_hz = 0.01\nlow_fraction = 0\nhigh_fraction = 0.5\n\
                 burst = { period_ms = 330, on_ms = 80 }\n";
    let pattern = "kind = \"constant\"\nfriction_fraction = 0.5\npattern_ms = [60, 40, 120]\n";
    for (kind, edges_ms) in [(burst, vec![0, 80]), (pattern, vec![0, 60, 100, 220])] {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("scene.toml"), format!("{ping}{kind}")).unwrap();
        let output = control(folder.path(), "wait 0.2\ntrigger ping\nwait 0.5\ntrigger ping\n");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let is_on: Vec<bool> = (1..1_150).map(|t_ms| friction_mn(folder.path(), t_ms).1 > 280.0).collect();
        let edges = is_on.windows(2).zip(2_usize..).filter(|(pair, _)| pair[0] != pair[1]).map(|(_, t_ms)| t_ms);
        let edges: Vec<usize> = edges.collect();
        let expected: Vec<usize> =
            [200, 700].iter().flat_map(|at| edges_ms.iter().map(move |edge| at + edge)).collect();
        assert_eq!(edges.len(), expected.len(), "{edges:?}");
        let are_near = edges.iter().zip(&expected).all(|(found, expected)| found.abs_diff(*expected) <= 3);
        assert!(are_near, "{edges:?} are not {expected:?}");
    }
}

#[test]
fn a_scene_is_replaced_and_the_play_ended() {
    let folder = TempDir::new().unwrap();
    write_scene(&folder.path().join("scene.toml"), "0.26");
    write_scene(&folder.path().join("other scene.toml"), "0.27");
    let output =
        control(folder.path(), "wait 0.2\nreplace \"other scene.toml\"\nwait 0.4\nlayer 1 gain 0\nwait 0.2\nquit\n");
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && said.contains("other scene.toml plays\n"), "{said}");
    let summary = fs::read_to_string(folder.path().join("frixel-out/summary.json")).unwrap();
    let replaced_at_s = serde_json::from_str::<serde_json::Value>(&summary).unwrap()["replaced_at_s"].as_f64().unwrap();
    assert!((0.2..0.25).contains(&replaced_at_s), "{replaced_at_s} s");
    for (t_ms, expected_mn) in [(190, 260.0), (590, 270.0), (780, 250.0)] {
        let (reference_mn, _) = friction_mn(folder.path(), t_ms);
        assert!((reference_mn - expected_mn).abs() < 0.1, "{t_ms} ms: {reference_mn} mN wanted");
    }
    let rows = fs::read_to_string(folder.path().join("frixel-out/felt.csv")).unwrap().lines().count();
    assert!((800..900).contains(&rows), "it ended after 0.8 s: {rows}");
}

#[test]
fn completions_and_exit_codes_are_documented() {
    let folder = TempDir::new().unwrap();
    for shell in ["bash", "zsh", "fish"] {
        let (script, _) = succeed(folder.path(), &["completions", shell]);
        assert!(script.contains("frixel") && script.contains("with-log"), "{shell}");
    }
    let (help, _) = succeed(folder.path(), &["--help"]);
    assert!(help.contains("Exit codes: 0") && !help.contains('\u{1b}'), "{help}");
    let (version, _) = succeed(folder.path(), &["--version"]);
    assert!(version.starts_with("frixel "), "{version}");
}
