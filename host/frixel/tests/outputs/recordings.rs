//! Recordings of people, which take a person's time.

use super::Folder;

const ROWS: &str = "t_s,x_mm,y_mm\n0.000000,1.0000,2.0000\n0.005000,1.5000,2.0000\n";

/// Another command's rows, the zeros that a crash of the machine leaves, and a header that was cut.
#[test]
fn a_record_is_not_finished_with_rows_that_no_record_writes() {
    let no_stroke = "me.csv.partial is no recorded stroke, which has t_s,x_mm,y_mm (";
    for (text, says) in [
        ("time_s,speed_mm_s,voltage_v_rms\n0,1,2\n".to_owned(), "the header has no column t_s"),
        (format!("{ROWS}\0\0\0\n0.020000,2.0000,2.0000\n"), "row 4: expected 3 cells as in the header, found 1"),
        (format!("{ROWS}0.015000,nan,2.0000\n"), "row 4, column x_mm: expected a number, found \"nan\""),
        ("t_s,x_mm,y_".to_owned(), "there is no me.csv.partial with rows of a recording that was cut off"),
    ] {
        let folder = Folder::new();
        folder.write("me.csv.partial", &text);
        let before = folder.names();
        let ran = folder.run("board record --finish -o me.csv");
        assert!(ran.refused(says) && (ran.refused(no_stroke) || !text.ends_with('\n')), "{text:?}: {}", ran.notes);
        assert_eq!((folder.names(), folder.text("me.csv.partial")), (before, text));
    }
}

/// What a board reported is joined with forces that come later; those of something else cost nothing.
#[test]
fn a_calibration_that_was_cut_off_keeps_its_rows_until_its_forces_fit() {
    let folder = Folder::new();
    let rows = "time_s,voltage_v_rms,speed_mm_s\n0.000,0.0,0.0\n0.001,0.0,0.0\n";
    folder.write("me.csv.partial", rows);
    folder.write("forces.csv", "time_s,normal_force_n,friction_n\n0,0.5,0.2\n1,0.5,0.2\n");
    for finish in ["", " --finish"] {
        let ran = folder.run(&format!("finger calibrate --strokes 9 -o me.csv --forces forces.csv{finish}"));
        assert!(ran.code == Some(1) && ran.notes.contains("me.csv.partial"), "{}", ran.notes);
        assert_eq!(folder.text("me.csv.partial"), rows);
    }
}

#[test]
fn a_play_replaces_what_a_finger_did_on_a_board_only_with_overwrite() {
    let folder = Folder::new();
    assert_eq!(folder.run("play scene.toml --seconds 0.1").code, Some(0));
    assert_eq!(folder.run("play scene.toml --seconds 0.1").code, Some(0), "a simulation is replaced");
    let summary = folder.text("frixel-out/summary.json");
    folder.write("frixel-out/summary.json", &summary.replace("\"simulated\":true", "\"simulated\":false"));
    let says = "frixel-out has what a finger did on a board, which no other play replaces: give another folder to --out, \
                or add --overwrite";
    assert!(folder.run("play scene.toml --seconds 0.2").refused(says));
    folder.write("mine.json", &folder.text("frixel-out/summary.json"));
    assert!(folder.run("model eval --input points.csv --output mine.json").refused("is a recording of a person"));
    assert_eq!(folder.run("play scene.toml --seconds 0.2 --overwrite").code, Some(0));
}
