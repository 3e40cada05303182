//! `frixel safety`: the tables of touch currents, as a person prints them.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::process::{Command, Output};

fn frixel(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_frixel")).arg("safety").args(args).output().unwrap()
}

fn printed(args: &[&str]) -> String {
    let output = frixel(args);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The numbers of a line.
fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

/// Carrier, drive, then the steady and the worst current of four coatings, and the worst coating's capacitance.
fn rows(text: &str, is_bound: bool) -> Vec<Vec<f64>> {
    let is_row = |line: &&str| line.contains(" Hz ") && line.contains(" V ") && line.contains("bound") == is_bound;
    text.lines().take_while(|line| !line.starts_with("Faults")).filter(is_row).map(numbers).collect()
}

#[test]
fn at_the_bound_no_current_is_above_its_limit_and_above_it_one_is() {
    for args in [&[][..], &["--series-kohm", "34"], &["--series-kohm", "390"]] {
        let text = printed(args);
        let bounds = rows(&text, true);
        assert_eq!(bounds.len(), 6, "{text}");
        for row in bounds {
            let worst = row[2..10].iter().copied().fold(0.0, f64::max);
            assert!(worst <= 0.7 && worst > 0.5, "{row:?}");
        }
    }
    // What the board would give without the bound.
    let text = printed(&[]);
    let slow: Vec<Vec<f64>> = rows(&text, false).into_iter().filter(|row| row[0] <= 1_000.0).collect();
    assert!(slow.len() == 4 && slow.iter().all(|row| row[9] > 0.7), "{text}");
}

#[test]
fn a_thicker_coating_lets_less_through_and_a_bridged_one_does_not_change() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("thick.toml");
    std::fs::write(&path, "width_mm = 100\nheight_mm = 60\n[[coating]]\nthickness_um = 10\npermittivity = 3\n")
        .unwrap();
    let [thin, thick] = [printed(&[]), printed(&["--screen", path.to_str().unwrap()])];
    assert!(thick.contains("0.53 nF"), "{thick}");
    for (thin, thick) in rows(&thin, true).iter().zip(rows(&thick, true)) {
        assert!(thick[2] < 0.75 * thin[2] && thick[3] < 0.75 * thin[3], "{thin:?} {thick:?}");
        assert_eq!(thin[6..], thick[6..]);
    }
}

#[test]
fn the_resistance_for_a_voltage_keeps_it_within_the_bound() {
    let text = printed(&["--voltage-v-rms", "150"]);
    let lines: Vec<&str> = text.lines().filter(|line| line.contains("kOhm: ")).collect();
    assert_eq!(lines.len(), 3, "{text}");
    for line in lines {
        let numbers = numbers(&line.replace("kOhm:", ""));
        assert!(numbers[2] <= numbers[3] && numbers[2] > 150.0 && numbers[3] < 1.1 * numbers[2], "{line}");
    }
    // Fast carriers lose too much at the edges.
    assert!(text.lines().any(|line| line.contains("1000 Hz") && line.contains("none")), "{text}");
}

#[test]
fn wrong_input_is_refused_with_what_was_expected() {
    for (args, code, said) in [
        (&["--board", "uno"][..], 2, "nucleo-g474re"),
        (&["--series-kohm", "0"], 2, "a number above 0"),
        (&["--screen", "nosuch.toml"], 1, "nosuch.toml"),
    ] {
        let output = frixel(args);
        assert_eq!(output.status.code(), Some(code), "{args:?}");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(stderr.contains(said), "{stderr}");
    }
}
