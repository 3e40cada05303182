//! `frixel play --watch` on a virtual board, as processes of their own: a saved file plays, a file with mistakes does
//! not.

use std::fmt::Write;
use std::fs::{self, File};
use std::path::Path;
use std::process::Stdio;

use tempfile::TempDir;

use crate::processes::{HEAD, frixel};
use crate::{Running, VirtualBoard, rows_so_far, until};

/// A virtual board in an ideal world.
fn virtual_board(folder: &Path, arguments: &[&str]) -> VirtualBoard {
    VirtualBoard::start(folder, &[&["--ideal"], arguments].concat())
}

/// A client that plays `scene.toml` of a folder whenever it is saved; what it says is in `said`.
fn watching_client(folder: &Path, port: &str) -> Running {
    let mut command = frixel();
    command.args(["play", "scene.toml", "--watch", "--port", port, "--out", "client"]).current_dir(folder);
    command.stdout(Stdio::null()).stderr(File::create(folder.join("said")).unwrap());
    Running(command.spawn().unwrap())
}

/// Ten minutes to and fro without a lift, at 50 mm/s.
fn write_stroke(path: &Path) {
    let mut text = String::from("t_s,x_mm,y_mm\n");
    for turn in 0..300 {
        writeln!(text, "{},{},40", 2 * turn, if turn % 2 == 0 { 10 } else { 110 }).unwrap();
    }
    fs::write(path, text).unwrap();
}

/// The same total friction everywhere, and the longest host timeout that there is: on a busy machine pings are late.
fn scene(friction: &str) -> String {
    format!("{HEAD}[drive]\nhost_timeout_ms = 1000\n[[layer]]\nkind = \"constant\"\nfriction_n = {friction}\n")
}

/// The column `commanded_n`, a row a millisecond, without a row that is half written.
fn commanded_n(folder: &Path) -> Vec<f64> {
    let text = rows_so_far(folder);
    let Some((rows, _)) = text.rsplit_once('\n') else { return Vec::new() };
    rows.lines().skip(1).filter_map(|row| row.split(',').nth(5)?.parse().ok()).collect()
}

fn is(commanded_n: f64, expected_n: f64) -> bool {
    (commanded_n - expected_n).abs() < 1e-6
}

#[test]
fn a_saved_scene_plays_and_one_with_mistakes_does_not() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    write_stroke(&path("stroke.csv"));
    let mut board = virtual_board(folder.path(), &["--stroke", "stroke.csv"]);

    fs::write(path("scene.toml"), scene("0.26")).unwrap();
    let mut client = watching_client(folder.path(), &board.port);
    let said = || fs::read_to_string(path("said")).unwrap();
    let last_n = || commanded_n(&path("board")).last().copied().unwrap_or_default();
    until("the first scene plays", || is(last_n(), 0.26));

    // As an editor saves that keeps the old file until the new one is whole.
    fs::write(path("scene.toml~"), scene("0.27")).unwrap();
    fs::rename(path("scene.toml~"), path("scene.toml")).unwrap();
    until("the second scene plays", || is(last_n(), 0.27));

    fs::write(path("scene.toml"), scene("0.28x").replace("[finger]", "[fingr]")).unwrap();
    until("the mistakes are reported", || said().contains("is not played: the previous scene keeps playing"));
    let rows = commanded_n(&path("board")).len();
    until("the second scene plays on", || commanded_n(&path("board")).len() > rows + 300);

    fs::write(path("scene.toml"), scene("0.255")).unwrap();
    until("the mended scene plays", || is(last_n(), 0.255));
    assert!(client.interrupt(), "{}", said());
    assert!(board.process.interrupt());

    let said = said();
    assert!(said.contains("frixel: scene.toml plays; what is saved replaces it; Ctrl-C ends"), "{said}");
    assert!(said.contains("scene.toml:"), "where the mistakes are: {said}");
    assert_eq!(said.matches("plays as it was saved").count(), 2, "{said}");

    // Natural friction until the board knows the finger; then one scene after the other, and nothing else: a row is a
    // mean over a millisecond, so that one row at each change may be of two scenes.
    let asked = commanded_n(&path("board"));
    let begin = asked.iter().position(|commanded_n| *commanded_n > 0.2501).unwrap();
    let mut others = Vec::new();
    let mut left = [0.26, 0.27, 0.255].into_iter();
    let mut now_n = left.next().unwrap();
    let end = asked.iter().rposition(|commanded_n| is(*commanded_n, 0.255)).unwrap();
    for commanded_n in &asked[begin + 1..end] {
        if is(*commanded_n, now_n) {
            continue;
        }
        match left.clone().next() {
            Some(next_n) if is(*commanded_n, next_n) => now_n = left.next().unwrap(),
            _ => others.push(*commanded_n),
        }
    }
    assert_eq!(left.next(), None, "all three were played");
    assert!(others.len() <= 2, "beside the scenes: {others:?}");
    assert!(others.iter().all(|other_n| (0.255..0.27).contains(other_n)), "beside the scenes: {others:?}");
}

/// Grey from left to right, or from right to left.
fn write_picture(path: &Path, mirrored: bool) {
    let grey: Vec<u8> = (0..200 * 200_u32).map(|at| if mirrored { 199 - at % 200 } else { at % 200 } as u8).collect();
    let mut encoder = png::Encoder::new(File::create(path).unwrap(), 200, 200);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().unwrap().write_image_data(&grey).unwrap();
}

/// A scene with a picture.
fn picture_scene(name: &str) -> String {
    let layer = format!(
        "kind = \"bitmap\"\npicture = \"{name}\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 50\nblack_n = 0\nwhite_n = 0.02\n"
    );
    scene("0.26").replace("kind = \"constant\"\nfriction_n = 0.26\n", &layer)
}

/// Each picture fits on the board, and both together do not: the one that played goes first.
#[test]
fn a_picture_that_has_no_room_beside_the_one_that_plays_replaces_it_and_is_followed_itself() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    write_picture(&path("one.png"), false);
    write_picture(&path("other.png"), true);
    fs::write(path("scene.toml"), picture_scene("one.png")).unwrap();
    let mut board = virtual_board(folder.path(), &[]);
    let mut client = watching_client(folder.path(), &board.port);
    let said = || fs::read_to_string(path("said")).unwrap();
    until("the first scene plays", || !commanded_n(&path("client")).is_empty());
    fs::write(path("scene.toml"), picture_scene("other.png")).unwrap();
    until("the saved scene plays", || said().contains("the output faded out meanwhile"));

    // A picture that is edited is a change, too.
    write_picture(&path("other.png"), false);
    until("the edited picture plays", || said().matches("plays as it was saved").count() == 2);

    fs::remove_file(path("scene.toml")).unwrap();
    until("the file's end is said", || said().contains("scene.toml is gone"));
    let before = commanded_n(&path("client")).len();
    until("the scene plays on", || commanded_n(&path("client")).len() > before + 300);
    fs::write(path("scene.toml"), scene("0.26")).unwrap();
    until("the file is there again", || said().matches("plays as it was saved").count() == 3);
    assert!(client.interrupt(), "{}", said());
    assert!(board.process.interrupt());
    assert_eq!(said().matches("is gone").count(), 1, "{}", said());
}

/// On the simulator, a saved scene plays from the beginning, drafts included. After a mistake, the files of the play
/// before stay. A virtual board behind a port refuses the draft.
#[test]
fn a_saved_scene_plays_anew_on_the_simulator() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene("0.26")).unwrap();
    let mut command = frixel();
    command.args(["play", "scene.toml", "--watch", "--seconds", "0.2", "--out", "out"]).current_dir(folder.path());
    command.stdout(Stdio::null()).stderr(File::create(folder.path().join("said")).unwrap());
    let mut play = Running(command.spawn().unwrap());
    let said = || fs::read_to_string(folder.path().join("said")).unwrap();
    let summary = || fs::read_to_string(folder.path().join("out/summary.json")).unwrap_or_default();
    until("the first play", || {
        summary().contains("\"draft\":false") && said().contains("plays again when it is saved")
    });
    fs::write(&path, scene("0.9")).unwrap();
    until("a draft", || summary().contains("\"draft\":true"));
    fs::write(&path, "version = 1\n[[layer]]\nkind = \"constat\"\n").unwrap();
    until("a mistake", || said().contains("scene.toml is not played: the files in out stay"));
    assert!(said().contains("did you mean `constant`?") && summary().contains("\"draft\":true"), "{}", said());
    fs::write(&path, scene("0.26")).unwrap();
    until("the last play", || summary().contains("\"draft\":false"));
    assert!(play.interrupt());

    fs::write(&path, scene("0.9")).unwrap();
    let mut board = virtual_board(folder.path(), &[]);
    let arguments = ["play", "scene.toml", "--port", &board.port, "--seconds", "0.2"];
    let output = frixel().args(arguments).current_dir(folder.path()).output().unwrap();
    let refused = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{refused}");
    assert!(refused.contains("asks for up to 0.9 N") && !refused.contains("draft"), "{refused}");
    assert!(board.process.interrupt());
}
