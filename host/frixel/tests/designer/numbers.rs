//! Felt friction in `docs/inside/numbers.md` is what the command beside them prints.
//!
//! A line `    $ frixel ...` is run, and the lines behind it, indented by six, are lines of its output.

use std::fs;

use frixel_testkit::golden;
use tempfile::TempDir;

use crate::processes::{repository, succeed};

/// The name at the beginning of a line of output.
fn name(line: &str) -> &str {
    line.trim_start().split("  ").next().unwrap_or_default()
}

#[test]
fn felt_friction_is_printed_by_the_commands_beside_it() {
    let path = repository().join("docs/inside/numbers.md");
    let text = fs::read_to_string(&path).unwrap();
    let scenes = repository().join("scenes").display().to_string();
    let (mut printed, mut commands, mut figures) = (String::new(), 0, 0);
    let mut found = String::new();
    for line in text.lines() {
        if let Some(command) = line.strip_prefix("    $ frixel ") {
            let folder = TempDir::new().unwrap();
            let arguments: Vec<String> =
                command.split_whitespace().map(|word| word.replacen("scenes/", &format!("{scenes}/"), 1)).collect();
            let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
            printed = succeed(folder.path(), &arguments);
            commands += 1;
        }
        let figure = line.strip_prefix("      ").filter(|_| !printed.is_empty());
        if let Some(figure) = figure {
            let line = printed.lines().find(|line| name(line) == name(figure));
            found += "      ";
            found += line.unwrap_or_else(|| panic!("{figure}: {printed}")).trim_start();
            figures += 1;
        } else {
            found += line;
            if !line.starts_with("    $ ") {
                printed.clear();
            }
        }
        found.push('\n');
    }
    assert!(commands >= 2 && figures >= 4, "{commands} commands, {figures} figures");
    golden::hold(&path, &found);
}
