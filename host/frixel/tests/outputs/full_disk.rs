//! A disk without space, and a folder that may not be written.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Stdio};

use super::{Folder, Ran, answered, line, reproducible};

/// Runs a command whose files may have so many blocks of 512 bytes.
fn run_with_blocks(folder: &Folder, line: &str, blocks: u64) -> Ran {
    let mut command = Command::new("sh");
    // Without the signal, a write fails as on a full disk.
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" {line}");
    command.args(["-c", &script, env!("CARGO_BIN_EXE_frixel")]).current_dir(folder.path(""));
    answered(command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()))
}

#[test]
fn no_cut_file_keeps_its_name_after_a_full_disk() {
    for output in reproducible() {
        let names: Vec<String> = output.written.iter().map(|name| name.replace("OUT", "out")).collect();
        let command_line = line(output, output.input, "out");
        let reference = Folder::new();
        assert_eq!(reference.run(&command_line).code, Some(0));
        let new: Vec<Vec<u8>> = names.iter().map(|name| reference.read(name).unwrap()).collect();
        let largest = new.iter().map(Vec::len).max().unwrap() as u64;
        let has_old = !output.is_recording && output.argument != "new name";
        // Nothing, a little, and nearly all of the largest file.
        let sizes = [0, 1, largest.saturating_sub(1) / 512];
        for blocks in sizes.into_iter().filter(|blocks| 512 * blocks < largest) {
            let folder = Folder::new();
            for name in names.iter().filter(|_| has_old) {
                folder.write(name, "old");
            }
            let ran = run_with_blocks(&folder, &command_line, blocks);
            let what = format!("{}, {blocks} blocks: {}", output.argument, ran.notes);
            assert_eq!(ran.code, Some(1), "{what}");
            let says = ["no cut file is left; check the free space", "cannot be written"];
            assert!(says.iter().all(|says| ran.notes.contains(says)), "{what}");
            let mut ages = [0; 2];
            for (name, new) in names.iter().zip(&new) {
                match folder.read(name) {
                    None => {}
                    Some(bytes) if bytes == b"old" && has_old => ages[0] += 1,
                    Some(bytes) => {
                        assert!(bytes == *new, "{what}: {name} is cut");
                        ages[1] += 1;
                    }
                }
            }
            assert!(ages.contains(&0), "{what}: old beside new: {ages:?}");
            assert!(folder.names().iter().all(|name| !name.contains("frixel-")), "{what}: {:?}", folder.names());
        }
    }
}

/// The demo fails where its scene cannot be written, and gives no advice about files that are not there.
#[test]
fn the_demo_on_a_full_disk_fails() {
    let folder = Folder::new();
    let ran = run_with_blocks(&folder, "demo", 1);
    assert!(ran.code == Some(1) && !ran.said.contains("change"), "{}", ran.said);
    assert!(!ran.said.contains("brick.toml is new"), "{}", ran.said);
    assert!(folder.read("frixel-out/brick.toml").is_none() && folder.read("frixel-out/textures/brick.png").is_none());
}

/// The log of a virtual board is read while it grows: it has whole rows when no more can be written.
#[test]
fn the_log_of_a_virtual_board_ends_with_a_whole_row_on_a_full_disk() {
    let folder = Folder::new();
    let ran = run_with_blocks(&folder, "sim --out out", 100);
    assert!(ran.code == Some(1) && ran.notes.contains("and has the rows until then"), "{}", ran.notes);
    for name in ["out/felt.csv", "out/forces.csv", "out/events.csv"] {
        let text = folder.text(name);
        let columns = text.lines().next().unwrap().split(',').count();
        let is_whole = |row: &str| row.split(',').count() == columns;
        assert!(text.ends_with('\n') && text.lines().all(is_whole), "{name}");
    }
}

#[test]
fn a_folder_that_may_not_be_written_is_named() {
    let folder = Folder::new();
    let locked = folder.path("locked");
    fs::create_dir(&locked).unwrap();
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).unwrap();
    // The administrator may write everywhere but where the kernel says what is there.
    let out = if fs::write(locked.join("probe"), "").is_ok() { "/sys/frixel-out".into() } else { locked.join("out") };
    for output in reproducible() {
        let ran = folder.run(&line(output, output.input, &out.display().to_string()));
        assert_eq!(ran.code, Some(1), "{}: {}", output.argument, ran.notes);
        assert!(ran.notes.contains("cannot be written ("), "{}: {}", output.argument, ran.notes);
    }
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o755)).unwrap();
}
