//! `frixel check`, `frixel preview` and `frixel schema` as a person uses them: numbers, pictures, and what they say to
//! wrong input.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::path::Path;
use std::process::Output;

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::processes::{HEAD, repository, run, succeed};

fn frixel(arguments: &[&str]) -> Output {
    run(&repository(), arguments)
}

/// What a command that fails with status 1 says on standard error.
fn refused(arguments: &[&str]) -> String {
    let output = frixel(arguments);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    assert!(output.stdout.is_empty(), "{arguments:?} said {}", String::from_utf8_lossy(&output.stdout));
    String::from_utf8(output.stderr).unwrap()
}

/// Files that a test writes.
struct Files(TempDir);

impl Files {
    fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).display().to_string()
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> String {
        fs::write(self.0.path().join(name), bytes).unwrap();
        self.path(name)
    }

    fn scene(&self, rest: &str) -> String {
        self.write("scene.toml", format!("{HEAD}\n{rest}"))
    }

    fn check(&self, rest: &str) -> Value {
        serde_json::from_str(&succeed(&repository(), &["check", &self.scene(rest), "--json", "--image"])).unwrap()
    }
}

/// A scene that asks for the whole reach is printed with no more than the reach.
#[test]
fn targets_in_reach_are_printed_in_reach() {
    let files = Files::new();
    for voltage_v_rms in [90, 100, 110, 120, 130, 140, 150] {
        let text = format!(
            "version = 1\n[drive]\nvoltage_max_v_rms = {voltage_v_rms}\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 1\n"
        );
        let summary = succeed(&repository(), &["check", &files.write("whole.toml", &text)]);
        let most = |name: &str| -> f64 {
            let line = summary.lines().find(|line| line.trim_start().starts_with(name)).unwrap();
            line.split(" N in total").next().unwrap().split(' ').next_back().unwrap().parse().unwrap()
        };
        assert!(most("targets") <= most("reachable"), "{summary}");
    }
}

#[test]
fn mistakes_are_json_where_that_is_asked_for() {
    let files = Files::new();
    let check = |scene: &str| {
        let output = frixel(&["check", scene, "--json"]);
        assert_eq!(output.status.code(), Some(1));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    let scene = files.scene(
        "[[layer]]\nkind = \"gratin\"\nwavelenght_mm = 2 # wide\nlow_n = 0\nhigh_n = 0.01\n\
         [[layer]]\nkind = \"constant\"\nregion = { x_mm = 0, y_mm = -3000, width_mm = 3, height_mm = 3 }\n",
    );
    let json = check(&scene);
    assert_eq!((json["file"].as_str(), json["unreadable"].is_null()), (Some(scene.as_str()), true));
    let mistakes: Vec<_> = json["mistakes"].as_array().unwrap().iter().collect();
    let found: Vec<_> = mistakes
        .iter()
        .map(|mistake| {
            let number = |key: &str| mistake[key].as_u64().unwrap();
            (number("line"), number("column"), mistake["text"].as_str().unwrap(), mistake["nearest"].as_str())
        })
        .collect();
    assert_eq!(
        found,
        [
            (18, 8, "\"gratin\"", Some("grating")),
            (19, 1, "wavelenght_mm", Some("wavelength_mm")),
            (22, 1, "[[layer]]", None),
            (24, 29, "-3000", None),
        ]
    );
    assert_eq!(
        mistakes[2]["message"],
        "layer 2 (constant) has no `friction_n` or `friction_fraction`: add one of them"
    );

    let missing = check(&files.path("none.toml"));
    assert!(missing["unreadable"].as_str().is_some_and(|reason| !reason.is_empty()), "{missing}");
    assert_eq!(missing["mistakes"], Value::Array(Vec::new()));
}

fn constant(rest: &str) -> String {
    format!("[[layer]]\nkind = \"constant\"\n{rest}\n")
}

#[test]
fn bytes_are_those_that_a_play_sends() {
    let files = Files::new();
    let check: Value =
        serde_json::from_str(&succeed(&repository(), &["check", "scenes/brick.toml", "--json"])).unwrap();
    let out = files.path("out");
    let played: Value = serde_json::from_str(&succeed(
        &repository(),
        &["play", "scenes/brick.toml", "--json", "--seconds", "0.01", "--out", &out],
    ))
    .unwrap();
    let (wire, ram) = (&check["wire"], &check["ram"]);
    let number = |value: &Value| value.as_u64().unwrap();
    assert_eq!(number(&wire["bitmap_bytes"]), 250 * 250);
    assert_eq!(ram["bitmap_pool_bytes"], wire["bitmap_bytes"]);
    assert_eq!(number(&wire["scene_bytes"]) + number(&wire["bitmap_bytes"]), number(&played["payload_bytes"]));
    assert_eq!(
        number(&wire["total_bytes"]),
        number(&wire["scene_bytes"]) + number(&wire["bitmap_bytes"]) + number(&wire["framing_bytes"])
    );
    // The play has a hello, the orders to arm, play and stop, and pings.
    let more = number(&played["wire_bytes"]) - number(&wire["total_bytes"]);
    assert!((20..200).contains(&more), "{more}");
    // The goal for a bulk upload.
    assert!(number(&wire["framing_bytes"]) * 20 <= number(&wire["total_bytes"]), "{wire}");
    assert!(check.get("board").is_none());
}

#[test]
fn ram_grows_by_what_a_layer_takes() {
    let files = Files::new();
    let active = |rest: &str| files.check(rest)["ram"]["active_bytes"].as_u64().unwrap();
    let one = constant("friction_n = 0.26\nlive = true");
    let layer = active(&one);
    assert!(layer > 0);
    assert_eq!(active(""), 0);
    assert_eq!(active(&one.repeat(5)), 5 * layer);
    let polygon = "region = { shape = \"polygon\", points_mm = [[0, 0], [30, 0], [0, 30]] }";
    assert_eq!(active(&constant(&format!("friction_n = 0.26\n{polygon}"))), layer + 3 * 8);
}

#[test]
fn the_table_ends_where_the_scene_does_unless_a_layer_may_change() {
    let files = Files::new();
    let table = |rest: &str| {
        let ram = files.check(&constant(rest))["ram"].clone();
        ["table_bytes", "table_whole_bytes", "table_room_bytes"].map(|key| ram[key].as_u64().unwrap())
    };
    let [most, whole, room] = table("friction_fraction = 1");
    assert!(most == whole && whole < room && room <= 2048, "{most} of {whole}, room for {room}");
    // Four rows of 16 bytes for an octave. The header rounds the largest friction up, by 1/128 at most.
    assert_eq!(table("friction_fraction = 0.495"), [whole - 64, whole, room]);
    assert_eq!(table("friction_fraction = 0.2475"), [whole - 128, whole, room]);
    assert_eq!(table("friction_fraction = 0.499\nlive = true"), [whole, whole, room]);

    let path = files.path("scene.toml");
    let said = succeed(&repository(), &["check", &path, "--cost"]);
    assert!(said.contains("nothing is cut"), "{said}");
    files.check(&constant("friction_fraction = 0.495"));
    let said = succeed(&repository(), &["check", &path, "--cost"]);
    assert!(said.contains(&format!("{} of {whole} bytes computed, 4 rows are cut", whole - 64)), "{said}");
}

#[test]
fn friction_out_of_reach_is_measured_and_its_layer_named() {
    let files = Files::new();
    let saturate = "[drive]\nsaturate = true\n";
    let region = "region = { x_mm = 30, y_mm = 0, width_mm = 30, height_mm = 80 }";
    let layers = [
        constant(&format!("name = \"too rough\"\n{region}\nfriction_n = 0.3")),
        constant(
            "name = \"too smooth\"\nregion = { x_mm = 60, y_mm = 40, width_mm = 60, height_mm = 40 }\nfriction_n = 0.2",
        ),
    ];
    let check = files.check(&format!("{saturate}{}", layers.concat()));
    let targets = &check["targets"];
    let near = |value: &Value, expected: f64| {
        let found = value.as_f64().unwrap();
        assert!((found - expected).abs() < 1e-6 * expected, "{found} is not {expected}");
    };
    near(&targets["least_n"], 0.2);
    near(&targets["most_n"], 0.3);
    near(&targets["above"]["screen_percent"], 25.0);
    near(&targets["below"]["screen_percent"], 25.0);
    assert_eq!(targets["above"]["layers"], serde_json::json!(["layer 1 \"too rough\""]));
    assert_eq!(targets["below"]["layers"], serde_json::json!(["layer 2 \"too smooth\""]));
    // The paper's Eqs. (43), (21) at 150 V.
    near(&check["reach"]["natural_n"], 0.25);
    near(&check["reach"]["total_max_n"], 0.277_781_2);

    let text = succeed(&repository(), &["check", &files.path("scene.toml")]);
    assert!(text.contains("25.0 % of the screen above, by layer 1 \"too rough\"; 25.0 %"), "{text}");
    let inside = files.check(&constant("friction_n = 0.26"));
    near(&inside["targets"]["most_n"], 0.26);
    assert_eq!(inside["targets"]["above"]["screen_percent"], 0.0);
}

#[test]
fn the_smallest_firmware_has_what_the_scene_asks_for() {
    let files = Files::new();
    let features = |rest: &str| files.check(rest)["board"]["features"].clone();
    assert_eq!(features(&constant("friction_n = 0.26")), serde_json::json!(["telemetry"]));
    let every = fs::read_dir(repository().join("scenes")).unwrap().filter_map(|entry| {
        let path = entry.unwrap().path();
        path.extension().is_some_and(|extension| extension == "toml").then(|| path.display().to_string())
    });
    let stream = "[carrier]\nshape = \"sine\"\n[[layer]]\nkind = \"stream\"\nlow_n = 0\nhigh_n = 0.01\n";
    let empirical = "version = 1\nfinger = { friction_coefficient = 0.4, normal_load_n = 0.5, origin = \"empirical\", date = \
        \"2026-11-23\", method = \"load cell\", screen = \"example\", exponent = 2, points = [[150, 0.09]], intervals_n = \
        [[0.08, 0.1]] }\n[[layer]]\nkind = \"constant\"\nfriction_n = 0.21\n";
    let drift = "version = 1\n[[layer]]\nkind = \"rings\"\nx_mm = 50\ny_mm = 20\nwavelength_mm = 10\ndrift_mm_per_s = 20\n\
        low_n = 0\nhigh_n = 0.02\nabove = \"natural\"\n";
    let mut found: Vec<String> = Vec::new();
    let written = [files.scene(stream), files.write("empirical.toml", empirical), files.write("drift.toml", drift)];
    for scene in every.chain(written) {
        let check: Value =
            serde_json::from_str(&succeed(&repository(), &["check", &scene, "--json", "--image"])).unwrap();
        let names: Vec<String> = serde_json::from_value(check["board"]["features"].clone()).unwrap();
        let command = check["board"]["command"].as_str().unwrap();
        assert!(command.contains("--no-default-features") && command.ends_with(&names.join(",")), "{command}");
        found.extend(names);
    }
    found.sort();
    found.dedup();
    // All that a scene can ask for, as both manifests have it.
    for (manifest, others) in [
        ("firmware/session/Cargo.toml", [].as_slice()),
        ("firmware/board-nucleo-g474re/Cargo.toml", &["panic-message", "log", "self-test"]),
    ] {
        let text = fs::read_to_string(repository().join(manifest)).unwrap();
        let list = text.split("default = [").nth(1).unwrap().split(']').next().unwrap();
        let mut known: Vec<&str> =
            list.split(',').map(|name| name.trim().trim_matches('"')).filter(|name| !name.is_empty()).collect();
        known.retain(|name| !others.contains(name));
        known.sort_unstable();
        assert_eq!(found, known, "{manifest}");
    }
}

#[test]
fn check_preview_and_play_say_the_same_of_wrong_input() {
    let files = Files::new();
    let wrong = files.scene("[[layer]]\nkind = \"gratting\"\n[[layer]]\nkind = \"constant\"\nfriction_nn = 1\n");
    let empty = files.write("empty.toml", "");
    let binary = files.write("binary.toml", [0x7f, b'E', b'L', b'F', 0xff, 0xfe, 0x00]);
    let (missing, folder) = (files.path("missing.toml"), files.path("."));
    for scene in [&wrong, &empty, &binary, &missing, &folder] {
        let message = refused(&["check", scene]);
        assert!(message.starts_with(&format!("frixel: {scene}:")), "{message}");
        let json = frixel(&["check", scene, "--json", "--image"]);
        assert_eq!((json.status.code(), String::from_utf8(json.stderr).unwrap()), (Some(1), message.clone()));
        assert_eq!(message, refused(&["preview", scene, "-o", &files.path("map.png")]));
        assert_eq!(message, refused(&["play", scene, "--out", &files.path("out")]));
    }
    assert!(!Path::new(&files.path("map.png")).exists());
}

#[test]
fn a_scene_is_checked_under_the_finger_of_an_option() {
    let files = Files::new();
    let short = files.write("short.toml", "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n");
    let natural_n = |options: &[&str]| {
        let json = succeed(&repository(), &[&["check", &short, "--json"], options].concat());
        let check: Value = serde_json::from_str(&json).unwrap();
        assert_eq!(check["finger"]["origin"], "assumed");
        (1e6 * check["reach"]["natural_n"].as_f64().unwrap()).round()
    };
    assert_eq!([natural_n(&[]), natural_n(&["--finger", "moist"])].map(|micro| micro as u64), [250_000, 400_000]);
    let anna = "friction_coefficient = 0.42\nnormal_load_n = 0.5\nradius_mm = 8\nstiffness_pa_per_m = 1.8e7\nskin_gap_um = 4\n";
    let anna = files.write("anna.toml", anna);
    assert_eq!(natural_n(&["--finger", &anna, "--screen", "example"]) as u64, 210_000);
    let summary = succeed(&repository(), &["check", &short, "--finger", &anna]);
    assert!(summary.contains(&format!("finger           finger \"{anna}\", assumed\n")), "{summary}");
    assert!(summary.contains(" V rms), assumed\n"), "{summary}");
}

/// Pixels of the rows that a map of 300 by 200 pixels lies in; the caption is below them.
fn map(path: &str) -> Vec<u8> {
    let mut decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(path).unwrap()));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap();
    bytes.chunks_exact(frame.line_size).skip(60).take(200).flatten().copied().collect()
}

#[test]
fn a_preview_is_a_png_of_the_asked_size() {
    let files = Files::new();
    let path = files.path("map.png");
    let message = succeed(&repository(), &["preview", "scenes/ribs.toml", "-o", &path, "--map-width", "300"]);
    assert!(message.contains(&path), "{message}");
    let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(&path).unwrap()));
    let reader = decoder.read_info().unwrap();
    // The least width: 300 + 84 + 150 would leave too little room for the caption.
    assert_eq!(reader.info().width, 600);
    let slow = files.path("slow.png");
    succeed(
        &repository(),
        &["preview", "scenes/ribs.toml", "-o", &slow, "--map-width", "300", "--speed-mm-per-s", "15"],
    );
    assert!(map(&slow) != map(&path), "the speed changes nothing");
}

#[test]
fn check_and_preview_say_what_a_person_feels() {
    let files = Files::new();
    let grating = "[[layer]]\nname = \"ridges\"\nkind = \"grating\"\nwavelength_mm = 1\nlow_n = 0.25\nhigh_n = 0.27\n";
    let scene = files.scene(&format!("{grating}above = \"zero\"\n"));
    let text = succeed(&repository(), &["check", &scene]);
    let feel = text.lines().find(|line| line.trim_start().starts_with("felt ")).unwrap();
    assert!(feel.contains("layer 1 \"ridges\": ") && feel.contains(" times the smallest that is felt ("), "{feel}");
    assert!(succeed(&repository(), &["preview", &scene, "-o", &files.path("map.png")]).contains(feel));
    // A touch source that keeps up with a millimetre: the one of 100 reports a second blurs a third of it.
    let arguments = ["check", &scene, "--json", "--touch", "500"];
    let json: Value = serde_json::from_str(&succeed(&repository(), &arguments)).unwrap();
    let layer = &json["judgement"]["layers"][0];
    let number = |value: &Value| value.as_f64().unwrap();
    let (texture, speed) = (&layer["texture"], number(&layer["speed_mm_per_s"]));
    assert_eq!((&layer["verdict"], &texture["verdict"]), (&json!("felt"), &json!("felt")));
    assert!((number(&texture["frequency_hz"]) / speed - 1.0).abs() < 0.05, "{texture}, a millimetre at {speed} mm/s");
    assert!((0.8..1.0).contains(&(number(&texture["amplitude_n"]) / 0.01)), "{texture}");
}
