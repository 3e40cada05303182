//! Rules for every command that writes results.

use std::fs::{self, OpenOptions};
use std::os::unix::fs::symlink;
use std::process::{Command, Stdio};
use std::thread;

use super::table::{OUTPUTS, Output, PLAY};
use super::{Folder, Ran};

/// Every output with a command line.
fn runs() -> impl Iterator<Item = (&'static Output, String)> {
    let line = |output: &Output| output.run.replace("IN", output.input).replace("OUT", "out");
    OUTPUTS.iter().filter(|output| !output.run.is_empty()).map(move |output| (output, line(output)))
}

#[test]
fn every_command_writes_what_the_table_says_and_leaves_nothing_else() {
    for (output, line) in runs() {
        let folder = Folder::new();
        let ran = folder.run(&line);
        assert_eq!(ran.code, Some(0), "{}: {}", output.argument, ran.notes);
        let names = folder.names();
        for name in output.written.iter().map(|name| name.replace("OUT", "out")) {
            assert!(names.contains(&name), "{line}: {name}");
        }
        assert!(names.iter().all(|name| !name.contains("frixel-") && !name.contains("partial")), "{line}: {names:?}");
    }
}

#[test]
fn no_command_replaces_its_input_a_recording_or_a_protected_file() {
    let of_a_person = "t_s,x_mm,y_mm,speed_mm_s,reference_n,felt_n,participant\n0.001,10,20,100,0.3,,P07\n";
    for (output, line) in runs() {
        let folder = Folder::new();
        for written in output.written.iter().map(|name| name.replace("OUT", "out")) {
            let refused = |says: &[&str]| {
                let before = folder.text(&written);
                let ran = folder.run(&line);
                let is_refused = says.iter().chain(&["already exists, and "]).any(|says| ran.refused(says));
                assert!(is_refused, "{line}, {written}: {}", ran.notes);
                assert_eq!(folder.text(&written), before, "{line}, {written}");
                fs::remove_file(folder.path(&written)).unwrap();
            };
            folder.write(&written, of_a_person);
            refused(&[
                "is a recording of a person, and results do not overwrite it: give",
                "holds a play on a real board",
            ]);
            if !output.input.is_empty() {
                symlink(folder.path(output.input), folder.path(&written)).unwrap();
                refused(&["is an input as well, and would be overwritten: give another "]);
            }
            folder.write(&written, "mine");
            let mut permissions = fs::metadata(folder.path(&written)).unwrap().permissions();
            permissions.set_readonly(true);
            fs::set_permissions(folder.path(&written), permissions).unwrap();
            refused(&["is write-protected: give another "]);
        }
    }
}

/// A play with the files of an earlier one, whose files may have so many blocks of 512 bytes. Without the signal, a
/// write fails as on a full disk.
fn play_with_blocks(folder: &Folder, blocks: u64) -> Ran {
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let line = "play scene.toml --seconds 0.3 --out out --record out/t.parquet";
    let mut command = Command::new("sh");
    command.args(["-c", &script, env!("CARGO_BIN_EXE_frixel")]).args(line.split(' ')).current_dir(folder.path(""));
    Ran::of(&command.output().unwrap())
}

#[test]
fn a_play_on_a_full_disk_leaves_the_earlier_one_as_it_was() {
    let folder = Folder::new();
    let names = PLAY.map(|name| name.replace("OUT", "out")).into_iter().chain(["out/t.parquet".to_owned()]);
    let names: Vec<String> = names.collect();
    assert_eq!(play_with_blocks(&folder, 1 << 20).code, Some(0));
    let sizes = names.iter().map(|name| fs::metadata(folder.path(name)).unwrap().len());
    let largest = sizes.max().unwrap();
    for name in &names {
        folder.write(name, "of an earlier play");
    }
    let before = folder.names();
    for blocks in [0, 1, 8, (largest - 1) / 512] {
        let ran = play_with_blocks(&folder, blocks);
        assert!(ran.refused("cannot be written") && ran.refused("check the free space"), "{blocks}: {}", ran.notes);
        assert!(names.iter().all(|name| folder.text(name) == "of an earlier play"), "{blocks}");
        assert_eq!(folder.names(), before, "{blocks}");
    }
}

/// A play that ended between two renamings: the note is of those that read one of its files.
#[test]
fn a_file_of_an_interrupted_play_is_noted() {
    let folder = Folder::new();
    assert_eq!(folder.run("play scene.toml --seconds 0.1 --out out --record out/t.parquet").code, Some(0));
    let of_another = folder.text("out/felt.csv").replacen("0.001000", "0.001001", 1);
    let line = "play scene.toml --seconds 0.1 --stroke out/felt.csv --out other";
    let whole = folder.run(line);
    folder.write("out/felt.csv", &of_another);
    let interrupted = folder.run(line);
    assert!(whole.code == Some(0) && !whole.notes.contains("interrupted"), "{}", whole.notes);
    assert!(interrupted.notes.contains("out/felt.csv: from an interrupted play"), "{}", interrupted.notes);
    assert!(!folder.run("replay out/t.parquet").notes.contains("interrupted"));
}

#[test]
fn streams_are_written_and_stay() {
    let folder = Folder::new();
    let line = "model eval --input points.csv --output ";
    assert_eq!(folder.run(&format!("{line}file")).code, Some(0));
    let expected = folder.text("file");
    let before = folder.names();
    for name in ["-", "/dev/stdout", "/dev/fd/1"] {
        assert_eq!(folder.run(&format!("{line}{name}")).said, expected, "{name}");
    }
    assert_eq!(folder.run(&format!("{line}/dev/null")).code, Some(0));
    assert!(folder.run(&format!("{line}/dev/full")).refused("/dev/full"));
    assert_eq!(folder.names(), before);
    folder.write("log", "earlier\n");
    let log = OpenOptions::new().append(true).open(folder.path("log")).unwrap();
    assert!(folder.command(&format!("{line}/dev/stdout")).stdout(log).status().unwrap().success());
    assert_eq!(folder.text("log"), format!("earlier\n{expected}"));
    let pipe = folder.path("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = thread::spawn(move || fs::read_to_string(pipe).unwrap());
    assert_eq!(folder.run(&format!("{line}pipe")).code, Some(0));
    assert_eq!(reader.join().unwrap(), expected);
    // A reader that goes away ends a stream of rows.
    let mut child = folder.command("model eval --input /dev/stdin").stdin(Stdio::piped()).spawn().unwrap();
    drop((child.stdout.take(), child.stdin.take()));
    assert!(!Ran::of(&child.wait_with_output().unwrap()).notes.contains("panicked"));
}
