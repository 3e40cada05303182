//! A command that is killed leaves its files whole or absent, and as one set.

use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::{Folder, line, reproducible};

const OLD: &[u8] = b"of an earlier run";
/// Kills of each command.
const KILLS: u32 = 5;

#[test]
fn kill_at_any_moment_leaves_one_whole_set() {
    let mut killed = 0;
    for output in reproducible() {
        let names: Vec<String> = output.written.iter().map(|name| name.replace("OUT", "out")).collect();
        let command_line = line(output, output.input, "out");
        let reference = Folder::new();
        let begun = Instant::now();
        assert_eq!(reference.run(&command_line).code, Some(0));
        let taken = begun.elapsed();
        let new: Vec<Vec<u8>> = names.iter().map(|name| reference.read(name).unwrap()).collect();
        for kill in 0..KILLS {
            let folder = Folder::new();
            // A file of `new` and a recording are never replaced.
            let has_old = !output.is_recording && output.argument != "new name";
            for name in names.iter().filter(|_| has_old) {
                folder.write(name, std::str::from_utf8(OLD).unwrap());
            }
            let mut command = folder.command(&command_line);
            let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
            drop(child.stdin.take());
            // Most of what is written is written at the end.
            sleep(taken.mul_f64(0.5 + 0.6 * f64::from(kill) / f64::from(KILLS)));
            let _ = child.kill();
            killed += u32::from(!child.wait().unwrap().success());
            let mut ages = [0; 2];
            for (name, new) in names.iter().zip(&new) {
                match folder.read(name) {
                    None => {}
                    Some(bytes) if bytes == OLD && has_old => ages[0] += 1,
                    Some(bytes) => {
                        assert!(bytes == *new, "{}: {name} is cut after {kill}", output.argument);
                        ages[1] += 1;
                    }
                }
            }
            assert!(ages.contains(&0), "{}: old beside new: {ages:?}", output.argument);
            // What is left over hinders nobody.
            if !output.is_recording && folder.read(&names[0]).is_none_or(|bytes| bytes == OLD) {
                let again = folder.run(&command_line);
                assert_eq!(again.code, Some(0), "{}: {}", output.argument, again.notes);
                assert!(folder.names().iter().all(|name| !name.contains("frixel-")), "{:?}", folder.names());
            }
        }
    }
    assert!(killed >= KILLS, "{killed} runs were killed");
}

/// A play that is killed does not put its rows beside the pictures of an earlier one.
#[test]
fn a_killed_play_leaves_no_new_rows_beside_old_pictures() {
    let folder = Folder::new();
    for name in ["out/felt.csv", "out/felt.svg", "out/summary.json", "out/scene.png"] {
        folder.write(name, "of an earlier run");
    }
    let mut child = folder.command("play scene.toml --seconds 60 --out out").stdout(Stdio::null()).spawn().unwrap();
    for _ in 0..12_000 {
        if folder.names().iter().any(|name| name.contains("felt.csv.frixel-tmp")) {
            break;
        }
        sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    for name in ["out/felt.csv", "out/felt.svg", "out/summary.json", "out/scene.png"] {
        assert_eq!(folder.text(name), "of an earlier run", "{name}");
    }
}
