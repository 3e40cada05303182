//! What real boards take of the gallery, as `docs/board/pico.md` says it.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::fmt::Write as _;
use std::fs;

use frixel::scene_file::SceneFolder;
use frixel_hil_sim::{Board, RigConfig};
use frixel_scene::{Scene, compile, compile_draft};
use frixel_testkit::golden;
use frixel_wire::hello::BoardLimits;

use crate::processes::{repository, succeed};

/// Names of the gallery's scenes, sorted, and their text.
fn gallery() -> Vec<(String, String)> {
    let folder = fs::read_dir(repository().join("scenes")).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> = folder.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    paths.sort();
    paths
        .iter()
        .map(|path| (path.file_stem().unwrap().to_string_lossy().into_owned(), fs::read_to_string(path).unwrap()))
        .collect()
}

fn scene(text: &str) -> Scene {
    Scene::parse(text, "scene.toml", &SceneFolder(repository().join("scenes"))).unwrap()
}

/// Estimated cycles of a scene's longest tick on a board.
fn cycles(text: &str, board: &Board) -> u32 {
    let program = compile_draft(&scene(text), &board.limits, board.tick_hz).unwrap();
    program.worst_tick(board.limits.core).cycles(board.limits.core)
}

#[test]
fn the_page_says_which_scenes_the_picos_take() {
    let boards = [("Pico 2", Board::PICO_2), ("Pico", Board::PICO)];
    let heads = boards.map(|(name, board)| format!("{name}, of {}", board.limits.tick_cycles_max));
    let mut table = format!("| scene | {} |\n|---|---|---|\n", heads.join(" | "));
    for (name, text) in gallery() {
        let cells = boards.map(|(_, board)| {
            let cycles = cycles(&text, &board);
            if cycles <= board.limits.tick_cycles_max { cycles.to_string() } else { format!("{cycles}: refused") }
        });
        let _ = writeln!(table, "| {name} | {} |", cells.join(" | "));
    }
    golden::hold_part(&repository().join("docs/board/pico.md"), "<!-- scenes", &table);
}

/// The scene that the page of bring-up names drives the NUCLEO above the voltage from which its monitor is held against
/// the drive.
#[test]
fn the_first_scene_after_bring_up_is_taken_and_drives_what_the_monitor_sees() {
    let path = "hardware/first_voltage.toml";
    assert!(fs::read_to_string(repository().join("docs/board/hardware.md")).unwrap().contains(path));
    let said = succeed(&repository(), &["check", path, "--board", "nucleo-g474re"]);
    assert!(said.contains("NUCLEO-G474RE behind 68 kOhm takes it"), "{said}");
    // A scene that asks for all that the drive gives has one target.
    let targets = said.lines().find_map(|line| line.trim().strip_prefix("targets")).unwrap();
    let [least_n, largest_n] = [0, 2].map(|word| targets.split_whitespace().nth(word).unwrap());
    assert_eq!(least_n, largest_n, "{targets}");
    let board = Board::NUCLEO_G474RE;
    let text = fs::read_to_string(repository().join(path)).unwrap();
    let header = compile(&scene(&text), &board.limits, board.tick_hz).unwrap().header;
    assert!(header.voltage_max_v_peak > 2.0 * 10.7 && header.voltage_max_v_peak < 25.0, "{header:?}");
}

/// Limits with which nothing but the longest tick is refused.
fn but_for_the_tick(board: &Board) -> BoardLimits {
    let BoardLimits { tick_cycles_max, core, .. } = board.limits;
    BoardLimits { tick_cycles_max, core, ..RigConfig::default().board.limits }
}

/// What the compiler estimates is what the board estimates, for a scene of one layer that a Pico takes, and for one
/// that it does not.
#[test]
fn a_pico_takes_a_grating_and_refuses_noise_by_name_and_cycles() {
    let board = Board::PICO;
    let with = |layer: &str| format!("version = 1\n[[layer]]\n{layer}");
    let grating = with("kind = \"grating\"\nwavelength_mm = 2\nlow_n = 0\nhigh_n = 0.02\n");
    let noise = with("kind = \"noise\"\nwavelength_min_mm = 1\nwavelength_max_mm = 4\nlow_n = 0\nhigh_n = 0.02\n");
    let limits = but_for_the_tick(&board);
    compile(&scene(&grating), &limits, board.tick_hz).unwrap();
    let refusal = compile(&scene(&noise), &limits, board.tick_hz).unwrap_err().to_string();
    let found = cycles(&noise, &board);
    assert!(refusal.contains("noise") && refusal.contains(&format!("estimated at {found} cycles")), "{refusal}");
    assert!(refusal.contains("layer 1 (noise) takes too long") && refusal.contains("has time for 13450"), "{refusal}");
}

/// Nothing stores limits on a Pico: what its kind would take, it refuses.
#[test]
fn a_check_for_a_pico_says_what_it_allows_without_stored_limits() {
    for (board, says_so) in [("pico", true), ("pico-2", true), ("nucleo-g474re", false)] {
        let text = succeed(&repository(), &["check", "hardware/first_voltage.toml", "--board", board]);
        assert!(text.contains("V rms at"), "{text}");
        assert_eq!(text.contains("nothing stores limits on this board yet: it allows 10 V peak"), says_so, "{text}");
        assert_eq!(text.contains("refuses it as it is, and would take it once limits are stored"), says_so, "{text}");
        assert_eq!(text.contains("takes it\n"), !says_so, "{text}");
    }
}

#[test]
fn the_command_that_builds_the_smallest_image_is_that_of_the_board() {
    for (board, command) in [
        ("nucleo-g474re", "cd firmware/board-nucleo-g474re && cargo build --release --no-default-features --features "),
        ("pico-2", "cd firmware/board-pico && cargo build --release --no-default-features --features rp2350,"),
        (
            "pico",
            "cd firmware/board-pico && cargo build --release --target thumbv6m-none-eabi --no-default-features \
             --features rp2040,",
        ),
    ] {
        let arguments = ["check", "hardware/first_voltage.toml", "--image", "--board", board];
        let text = succeed(&repository(), &arguments);
        assert!(text.contains(command), "{text}");
    }
}
