//! `frixel sweep`: every division into parts and every interruption ends with the same bytes.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::path::PathBuf;

use tempfile::TempDir;

use crate::processes::run;

const SCENE: &str = "version = 1\n[[layer]]\nname = \"plate\"\nkind = \"constant\"\nfriction_fraction = 0.5\n\
                     region = { x_mm = 20, y_mm = 10, width_mm = 80, height_mm = 60 }\n";
const PLAN: &str = "scenes = [\"plate.toml\"]\npeople = 3\nstrokes = 2\nseeds = 1\nseconds = 0.6\n\
                    [parameters]\n\"layer.1.friction_fraction\" = [0.02, 0.9]\n";
const RESULTS: [&str; 7] =
    ["layers.csv", "fingers.csv", "numbers.csv", "layers.parquet", "fingers.parquet", "numbers.parquet", "sweep.svg"];
const CELLS: &str = "cells/1-of-1.jsonl";

struct Folder(TempDir);

impl Folder {
    fn new(plan: &str) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path("plate.toml"), SCENE).unwrap();
        fs::write(folder.path("plan.toml"), plan).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Whether the command succeeds, its output, and its notes and error.
    fn run_to_end(&self, line: &str) -> (bool, String, String) {
        let output = run(self.0.path(), &line.split_whitespace().collect::<Vec<_>>());
        let text = |bytes| String::from_utf8(bytes).unwrap();
        (output.status.success(), text(output.stdout), text(output.stderr))
    }

    /// Output of the command, or its error.
    fn run(&self, line: &str) -> Result<String, String> {
        let (is_done, said, error) = self.run_to_end(line);
        if is_done { Ok(said) } else { Err(error) }
    }

    fn results(&self, out: &str) -> [Vec<u8>; 7] {
        RESULTS.map(|name| fs::read(self.path(out).join(name)).unwrap())
    }

    /// The lines of the only part.
    fn cells(&self, out: &str) -> Vec<String> {
        let text = fs::read_to_string(self.path(out).join(CELLS)).unwrap();
        text.lines().map(ToOwned::to_owned).collect()
    }

    fn write_cells(&self, out: &str, cells: &[String]) {
        fs::write(self.path(out).join(CELLS), cells.join("\n") + "\n").unwrap();
    }
}

#[test]
fn any_number_of_parts_makes_the_same_bytes() {
    let folder = Folder::new(PLAN);
    folder.run("sweep plan.toml -o whole").unwrap();
    let whole = folder.results("whole");
    for parts in [2, 7, 64] {
        // The last part first: no order matters.
        for part in (1..=parts).rev() {
            folder.run(&format!("sweep plan.toml -o parts{parts} --shard {part}/{parts} --jobs 1")).unwrap();
        }
        folder.run(&format!("sweep merge parts{parts}")).unwrap();
        assert!(folder.results(&format!("parts{parts}")) == whole, "{parts} parts");
    }
    let layers = String::from_utf8(whole[0].clone()).unwrap();
    let rows: Vec<&str> = layers.lines().collect();
    assert!(rows[1].starts_with("\"plate.toml\",,\"100\",0.02,\"layer 1 \"\"plate\"\"\",3,0,"), "{layers}");
    assert!(rows[2].starts_with("\"plate.toml\",,\"100\",0.9,\"layer 1 \"\"plate\"\"\",3,2,1,"), "{layers}");
}

/// Parts that run side by side, and one that is played twice, as a scheduler does after a worker was lost.
#[test]
fn parts_side_by_side_do_not_disturb_one_another() {
    let folder = Folder::new(PLAN);
    folder.run("sweep plan.toml -o whole").unwrap();
    std::thread::scope(|scope| {
        let parts = [1, 2, 3, 1, 2, 3];
        let folder = &folder;
        let run = move |part: u32| folder.run(&format!("sweep plan.toml -o parts --jobs 1 --shard {part}/3"));
        let runs: Vec<_> = parts.into_iter().map(|part| scope.spawn(move || run(part))).collect();
        for ran in runs {
            ran.join().unwrap().unwrap();
        }
    });
    folder.run("sweep merge parts").unwrap();
    assert!(folder.results("parts") == folder.results("whole"));
}

/// A killed sweep loses only the cells that were being played.
#[test]
fn what_is_there_is_not_played_again() {
    let folder = Folder::new(PLAN);
    folder.run("sweep plan.toml -o out").unwrap();
    let (results, cells) = (folder.results("out"), folder.cells("out"));
    assert_eq!(cells.len(), 6);
    // The line that was being written is there in part.
    let path = folder.path("out").join(CELLS);
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() - 2]).unwrap();
    let error = folder.run("sweep merge out").unwrap_err();
    assert!(error.contains("out: 5 of 6 cells are there: play the others with `frixel sweep"), "{error}");
    let said = folder.run("sweep plan.toml -o out").unwrap();
    assert!(said.contains("1 played, 5 already there, of 6"), "{said}");
    assert!(folder.results("out") == results && folder.cells("out") == cells);
    // Another value plays its own cells only, also in parts, and of the cells of other parts none.
    fs::write(folder.path("plan.toml"), PLAN.replace("[0.02, 0.9]", "[0.02, 0.5, 0.9]")).unwrap();
    let said = folder.run("sweep plan.toml -o out --shard 1/2").unwrap();
    assert!(said.contains("1 played, 4 already there, of 9"), "{said}");
    let said = folder.run("sweep plan.toml -o out").unwrap();
    assert!(said.contains("2 played, 7 already there, of 9"), "{said}");
}

/// A line that is there twice, or was changed, is not another result.
#[test]
fn the_result_of_another_cell_and_a_changed_one_do_not_count() {
    let folder = Folder::new(PLAN);
    folder.run("sweep plan.toml -o study").unwrap();
    let (results, cells) = (folder.results("study"), folder.cells("study"));
    for damaged in [cells[1].clone(), cells[0].replacen("plate", "plain", 1), "{".to_owned(), "\u{e9}".to_owned()] {
        folder.write_cells("study", &[&[damaged], &cells[1..]].concat());
        let error = folder.run("sweep merge study").unwrap_err();
        assert!(error.contains("study: 5 of 6 cells are there"), "{error}");
        let said = folder.run("sweep plan.toml -o study").unwrap();
        assert!(said.contains("1 played, 5 already there, of 6"), "{said}");
        assert!(folder.results("study") == results);
    }
    fs::write(folder.path("study/cells/plan.json"), "{}").unwrap();
    let error = folder.run("sweep merge study").unwrap_err();
    assert!(
        error.contains("is not a list of the cells of a sweep") && error.contains("play the sweep again"),
        "{error}"
    );
}

/// Each value of the lists is checked before the first play, and a combination when it is played: the others are played
/// as well.
#[test]
fn a_combination_that_is_refused_leaves_the_others() {
    let values = "\"layer.1.region.x_mm\" = [20, 100]\n\"layer.1.region.width_mm\" = [10, 80]\n";
    let folder = Folder::new(&PLAN.replace("\"layer.1.friction_fraction\" = [0.02, 0.9]\n", values));
    for (had, played) in [(0, 9), (9, 0)] {
        let (_, said, error) = folder.run_to_end("sweep plan.toml -o out");
        assert!(said.contains(&format!("{played} played, 3 refused, {had} already there, of 12")), "{said}");
        let names = "frixel: plate.toml with layer.1.region.width_mm = 80, layer.1.region.x_mm = 100: plate.toml:";
        assert!(error.starts_with(names) && error.contains("past the right edge"), "{error}");
    }
    fs::write(folder.path("plan.toml"), PLAN.replace("[0.02, 0.9]", "[0.02, 1.9]")).unwrap();
    let (_, said, error) = folder.run_to_end("sweep plan.toml -o other");
    assert!(said.is_empty() && error.contains("`friction_fraction = 1.9` is out of range"), "{said}{error}");
    assert!(!folder.path("other").exists());
}
