//! `frixel sweep`: every division into parts and every interruption ends with the same bytes.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use tempfile::TempDir;

const SCENE: &str = "version = 1\n[[layer]]\nname = \"plate\"\nkind = \"constant\"\nfriction_fraction = 0.5\n\
                     region = { x_mm = 20, y_mm = 10, width_mm = 80, height_mm = 60 }\n";
const PLAN: &str = "scenes = [\"plate.toml\"]\npeople = 3\nstrokes = 2\nseeds = 1\nseconds = 0.6\n\
                    [parameters]\n\"layer.1.friction_fraction\" = [0.02, 0.9]\n";
const RESULTS: [&str; 7] =
    ["layers.csv", "fingers.csv", "numbers.csv", "layers.parquet", "fingers.parquet", "numbers.parquet", "sweep.svg"];

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

    /// What the command says, or its error.
    fn run(&self, line: &str) -> Result<String, String> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_frixel"));
        let output = command.args(line.split_whitespace()).current_dir(self.0.path()).output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        if output.status.success() { Ok(text(output.stdout)) } else { Err(text(output.stderr)) }
    }

    fn results(&self, out: &str) -> [Vec<u8>; 7] {
        RESULTS.map(|name| fs::read(self.path(out).join(name)).unwrap())
    }

    fn cells(&self, out: &str) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.path(out).join("cells")).unwrap();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        paths
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
    assert_eq!(cells.len(), 6 + 1, "and the plan's");
    fs::remove_file(&cells[2]).unwrap();
    let error = folder.run("sweep merge out").unwrap_err();
    assert!(error.contains("out: 5 of 6 cells are there: play the others with `frixel sweep"), "{error}");
    let said = folder.run("sweep plan.toml -o out").unwrap();
    assert!(said.contains("1 played, 5 already there, of 6"), "{said}");
    assert!(folder.results("out") == results && folder.cells("out") == cells);
    // Another value plays its own cells only.
    fs::write(folder.path("plan.toml"), PLAN.replace("[0.02, 0.9]", "[0.02, 0.5, 0.9]")).unwrap();
    let said = folder.run("sweep plan.toml -o out").unwrap();
    assert!(said.contains("3 played, 6 already there, of 9"), "{said}");
}

/// A file that was copied over another one, or changed, is not a result.
#[test]
fn the_result_of_another_cell_and_a_changed_one_are_refused() {
    let folder = Folder::new(PLAN);
    folder.run("sweep plan.toml -o study").unwrap();
    let cells = folder.cells("study");
    let [one, other, ..] = &cells[..] else { panic!("{cells:?}") };
    let text = fs::read_to_string(one).unwrap();
    fs::copy(other, one).unwrap();
    let error = folder.run("sweep merge study").unwrap_err();
    assert!(error.contains("is not a result of a cell (it is that of the cell "), "{error}");
    fs::write(one, text.replacen("plate", "plain", 1)).unwrap();
    let error = folder.run("sweep merge study").unwrap_err();
    assert!(error.contains("its content has another hash than it says"), "{error}");
    fs::write(one, "{").unwrap();
    let error = folder.run("sweep merge study").unwrap_err();
    assert!(error.contains("is not a result of a cell") && error.contains("delete it"), "{error}");
    fs::write(one, text).unwrap();
    folder.run("sweep merge study").unwrap();
}
