//! Fuzz targets: each function takes arbitrary bytes, and panics if it finds a bug.
#![forbid(unsafe_code)]
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::missing_panics_doc,
    reason = "a panic is how a target reports what it found"
)]

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use frixel_driver::{DeviceError, Upload, ignore_progress};
use frixel_felt::recorder::FeltRow;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke};
use frixel_lab::input::SceneFolder;
use frixel_lab::recording::{Metadata, Recording};
use frixel_lab::sweep::{Plan, Source, Sweep};
use frixel_layers::Scene as WireScene;
use frixel_layers::cost::worst_of_scene;
use frixel_play::{TO_THE_END, board_costs, connect};
use frixel_scene::{Scenario, Scene, compile};
use frixel_testkit::scene_with_points;
use sha2::{Digest, Sha256};

/// A function that takes arbitrary bytes, and the inputs that it starts from.
pub struct Target {
    /// The name on the command line.
    pub name: &'static str,
    /// Number of inputs in `cargo xtask ci fuzz`.
    pub inputs: u32,
    /// Generates the seed corpus: file names and contents.
    pub seeds: fn() -> Vec<(String, Vec<u8>)>,
    /// Tests one input.
    pub run: fn(&[u8]),
}

/// All targets. A target that reads text gets the bytes up to the first that is not UTF-8.
pub const TARGETS: [Target; 6] = [
    Target {
        name: "scene_text",
        inputs: 30_000,
        seeds: || contents(scene_files()),
        run: |bytes| scene_text(text(bytes)),
    },
    Target { name: "scene_bytes", inputs: 2_000_000, seeds: compiled_scenes, run: scene_bytes },
    Target { name: "scene_load", inputs: 30_000, seeds: compiled_scenes, run: |bytes| _ = scene_load(bytes) },
    Target {
        name: "parquet",
        inputs: 100_000,
        seeds: || vec![("recording".to_owned(), recording_file())],
        run: parquet,
    },
    Target {
        name: "scenario",
        inputs: 100_000,
        seeds: || contents(toml_files("../hil-sim/scenarios")),
        run: |bytes| scenario(text(bytes)),
    },
    Target {
        name: "plan",
        inputs: 150_000,
        seeds: || vec![("plan".to_owned(), PLAN.as_bytes().to_vec())],
        run: |bytes| plan(text(bytes)),
    },
];

fn text(bytes: &[u8]) -> &str {
    bytes.utf8_chunks().next().map_or("", |chunk| chunk.valid())
}

/// The TOML files in a folder, relative to this crate's.
fn toml_files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("a file").path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    assert!(!files.is_empty());
    files.sort();
    files
}

/// The scenes of the gallery, and one whose finger has an empirical law.
fn scene_files() -> Vec<PathBuf> {
    let mut files = toml_files("../scenes");
    files.push(Path::new(env!("CARGO_MANIFEST_DIR")).join("empirical.toml"));
    files
}

/// File names without extension, and contents.
fn contents(files: Vec<PathBuf>) -> Vec<(String, Vec<u8>)> {
    let named = files.into_iter().map(|file| (stem(&file), fs::read(file).expect("a file")));
    named.collect()
}

fn stem(file: &Path) -> String {
    file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The scenes of the repository without pictures, compiled, each with the name of its file.
pub fn compiled_scenes() -> Vec<(String, Vec<u8>)> {
    let board = RigConfig::default().board;
    let programs = scene_files().into_iter().map(|file| {
        let text = fs::read_to_string(&file).expect("a scene file");
        let scene = Scene::parse(&text, "fuzz.toml", &SceneFolder::of(&file)).expect("a scene");
        (file, compile(&scene, &board.limits, board.tick_hz).expect("a valid scene"))
    });
    let programs = programs.filter(|(_, program)| program.bitmaps.is_empty());
    programs.map(|(file, program)| (stem(&file), program.scene_bytes())).collect()
}

/// Compiles arbitrary text as a scene file. It is rejected, or becomes a program that a board accepts, with ticks in
/// time.
fn scene_text(text: &str) {
    let rig = RigConfig::default();
    // There are no pictures, because only the text is tested.
    let Ok(scene) = Scene::parse(text, "fuzz.toml", &BTreeMap::new()) else { return };
    let Ok(program) = compile(&scene, &rig.board.limits, rig.board.tick_hz) else { return };
    assert!(
        program.worst_tick(rig.board.limits.core).cycles(rig.board.limits.core) <= rig.board.limits.tick_cycles_max
    );
    if let Err(error) = board_costs(&program, &rig) {
        panic!("it compiles, but the board refuses it: {error}");
    }
}

/// A plan for the seed corpus.
const PLAN: &str = "scenes = [\"flat.toml\"]\npeople = 2\ntouch = [\"100\", \"500\"]\n[parameters]\n\
    \"layer.1.friction_fraction\" = { from = 0.1, to = 0.3, count = 3 }\n\"drive.voltage_max_v_rms\" = [100, 150]\n";
/// Largest number of people and of parameters for which the cells of a plan are generated.
const COMBINED_MAX: usize = 3;

/// The bytes of a recording's file, for the seed corpus.
fn recording_file() -> Vec<u8> {
    let row = |number: u32| FeltRow {
        t_s: f64::from(number),
        x_mm: (!number.is_multiple_of(3)).then_some(2.5),
        ..FeltRow::default()
    };
    let recording = Recording::of_rows(Metadata::default(), &(0..50).map(row).collect::<Vec<_>>());
    let mut bytes = Vec::new();
    recording.write_parquet(&mut bytes).expect("a recording");
    bytes
}

/// Reads arbitrary bytes as a recording's file, with a matching hash, so that the damage itself is parsed. They are
/// rejected, or the result can be written and read again.
fn parquet(bytes: &[u8]) {
    let Ok(recording) = Recording::read_parquet(sealed(bytes.to_vec()), TO_THE_END) else { return };
    let mut written = Vec::new();
    recording.write_parquet(&mut written).expect("what was read can be written");
    let again = Recording::read_parquet(written, TO_THE_END).expect("what was written can be read");
    assert_eq!(recording.first_difference(&again), None);
}

/// The bytes with the hash of a recording replaced by their own SHA-256.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let head = b"frixel.sha256\x18\x40";
    let Some(at) = bytes.windows(head.len()).rposition(|part| part == head).map(|at| at + head.len()) else {
        return bytes;
    };
    if let Some(digits) = bytes.get_mut(at..at + 64) {
        digits.fill(b'0');
        let digits: Vec<String> = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        bytes.splice(at..at + 64, digits.concat().into_bytes());
    }
    bytes
}

/// Reads arbitrary text as a scenario. It is rejected, or has a scene and at most 1,000 commands and faults.
fn scenario(text: &str) {
    let Ok(scenario) = Scenario::parse(text, "fuzz.toml") else { return };
    assert!(scenario.commands.len() + scenario.faults.len() <= 1_000);
    assert!(scenario.scenes().count() >= 1);
}

/// Reads arbitrary text as the plan of a sweep, and generates the cells of a plan with few combinations.
fn plan(text: &str) {
    let Ok(plan) = Plan::parse(text, "fuzz.toml") else { return };
    let lists = plan.parameters.len().max(plan.scenes.len()).max(plan.screens.len()).max(plan.touch.len());
    let values = plan.parameters.values().map(|values| values.values().len()).max().unwrap_or(0);
    if plan.people > COMBINED_MAX as u64 || lists > COMBINED_MAX || values > 2 * COMBINED_MAX {
        return;
    }
    let scene = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.1\n";
    let source = |name: &str| Ok::<_, Infallible>(Source::new(name, scene.to_owned(), BTreeMap::new()));
    let Ok(sweep) = Sweep::new(plan, source, |_, _| Ok(String::new()));
    for number in (0..sweep.index().cells()).chain(sweep.samples()) {
        assert!(sweep.cell(number).map_or(true, |cell| cell.key.len() == 32));
    }
}

/// Parses arbitrary bytes as a compiled scene. They are rejected, or every record can be read and written back.
fn scene_bytes(bytes: &[u8]) {
    let Ok(scene) = WireScene::parse(bytes) else { return };
    let records: Vec<_> = scene.records().collect();
    let points: Vec<_> = scene.points().collect();
    let written = scene_with_points(scene.header(), &records, &points);
    let again = WireScene::parse(&written).expect("what was read can be written");
    let records_again: Vec<_> = again.records().collect();
    let points_again: Vec<_> = again.points().collect();
    // Compare the text, because not-a-number is not equal to itself.
    let (header, header_again) = (scene.header(), again.header());
    assert_eq!(
        format!("{header:?} {records:?} {points:?}"),
        format!("{header_again:?} {records_again:?} {points_again:?}")
    );
}

/// Uploads arbitrary bytes as a compiled scene. The board rejects them, or estimates their longest tick to be within
/// its limit and plays them under a finger without a fault. Returns whether it plays them.
pub fn scene_load(bytes: &[u8]) -> bool {
    let rig_config = RigConfig::default();
    let mut memory = BoardMemory::new();
    let stroke = Stroke::sweep(0.12, 0.08, 1.0).expect("a stroke");
    let rig = Rig::new(&mut memory, &rig_config, stroke, 1).expect("a rig");
    let mut device = connect(Box::new(rig)).expect("a board");
    let upload = Upload { scene: bytes, bitmaps: Vec::new() };
    let taken = device.upload(&upload, &mut ignore_progress).and_then(|()| device.commit(upload.scene_crc32()));
    match taken {
        Ok(()) => {
            let scene = WireScene::parse(bytes).expect("the board has read it");
            let (records, points): (Vec<_>, Vec<_>) = (scene.records().collect(), scene.points().collect());
            let worst = worst_of_scene(scene.header(), &records, &points, rig_config.board.limits.core);
            assert!(worst.cycles(rig_config.board.limits.core) <= rig_config.board.limits.tick_cycles_max, "{worst:?}");
        }
        Err(DeviceError::Refused { .. }) => return false,
        Err(error) => panic!("{error}"),
    }
    let played = device
        .arm()
        .and_then(|()| device.play())
        .and_then(|()| device.wait(Duration::from_millis(60), &mut |_| {}))
        .and_then(|()| device.stop())
        .and_then(|()| device.disarm());
    if let Err(error) = played {
        panic!("{error}");
    }
    true
}
