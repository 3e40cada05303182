//! `cargo xtask numbers`: the tables of `docs/inside/numbers.md` that follow from what `cargo xtask bench` measured.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use serde_json::Value;

use crate::bench::{COMMITTED, Figures};
use crate::command::{self, root};

const PAGE: &str = "docs/inside/numbers.md";
/// Lines before and behind what is generated.
const BEGIN: &str = "<!-- `cargo xtask numbers` writes this part -->\n";
const END: &str = "<!-- end -->\n";

/// A table: its heading, the heading of its first column, further columns (heading, prefix of the figures' names,
/// suffix), and rows (text, the rest of the figures' names).
struct Table {
    heading: &'static str,
    first: &'static str,
    columns: &'static [(&'static str, &'static str, &'static str)],
    rows: &'static [(&'static str, &'static str)],
}

const TABLES: [Table; 4] = [
    Table {
        heading: "Inverting a friction",
        first: "way",
        columns: &[
            ("Cortex-M4F, instructions", "m4f.", ""),
            ("core cycles", "m4f.", "_cycles"),
            ("Cortex-M33, instructions", "m33.", ""),
            ("Cortex-M0+, instructions", "m0plus.", ""),
            ("Cortex-M3, instructions", "m3.", ""),
        ],
        rows: &[
            ("`InverseTable`, f32", "inverse_table"),
            ("`FixedTable` for 1e-5, in integers", "inverse_table_fixed"),
            ("closed form, f32, roots from `libm`", "inverse_closed_form"),
        ],
    },
    Table {
        heading: "A tick",
        first: "scene under the finger",
        columns: &[
            ("Cortex-M4F, instructions", "m4f.", ""),
            ("mean", "m4f.", "_mean"),
            ("core cycles", "m4f.", "_cycles"),
            ("Cortex-M33, instructions", "m33.", ""),
            ("Cortex-M0+, instructions", "m0plus.", ""),
        ],
        rows: &[
            ("no layer under it", "tick_idle"),
            ("disarmed", "tick_disarmed"),
            ("one grating", "tick_grating"),
            ("one picture", "tick_bitmap"),
            ("two constants", "tick_two_constants"),
            ("two constants, sine carrier", "tick_two_constants_sine_carrier"),
            ("a stream, finger elsewhere", "tick_stream_elsewhere"),
            ("8 of 8 layers", "tick_8_of_8"),
            ("8 of 64 layers", "tick_8_of_64"),
            ("as many layers as are accepted", "tick_worst_scene"),
        ],
    },
    Table {
        heading: "The longest step of a commit",
        first: "finger",
        columns: &[
            ("Cortex-M4F, instructions", "m4f.", ""),
            ("core cycles", "m4f.", "_cycles"),
            ("Cortex-M33, instructions", "m33.", ""),
            ("Cortex-M0+, instructions", "m0plus.", ""),
        ],
        rows: &[("contact model", "commit_step"), ("empirical law of 16 points", "commit_law_step")],
    },
    Table {
        heading: "Images, bytes",
        first: "what",
        columns: &[("NUCLEO-G474RE", "g474.", ""), ("Pico 2", "pico_2.", ""), ("Pico", "pico.", "")],
        rows: &[
            ("flash, everything", "flash_full"),
            ("flash, one grating", "flash_grating_only"),
            ("RAM without stacks, everything", "ram_full"),
            ("RAM without stacks, one grating", "ram_grating_only"),
            ("deepest stack without a panic, everything", "stack_full"),
            ("deepest stack without a panic, one grating", "stack_grating_only"),
            ("deepest stack of bring-up, formatting apart", "stack_bring_up"),
            ("deepest stack of the self-test, formatting apart", "stack_self_test"),
            ("code of the tick, everything", "tick_code_full"),
            ("code of the tick, one grating", "tick_code_grating_only"),
        ],
    },
];

/// Writes the generated part of the page anew.
pub(crate) fn write() -> Result<(), String> {
    command::write(&root().join(PAGE), replaced(&read(PAGE)?, &generated(&committed()?)?)?)
}

/// Reciprocal of the relative tolerance of a count, 0.2 %: code placement moves means of long steps by 0.03 %.
const TOLERANCE_RECIPROCAL: u64 = 500;

/// Fails if a count that was measured is not the committed one, on which the page's tables rest. The error lists them.
/// Bytes of images and stacks are left to their budgets.
pub(crate) fn check(measured: &Figures) -> Result<(), String> {
    differences(measured, &committed()?).map_err(|differences| {
        format!(
            "{COMMITTED} is not what was measured:\n  {}\nrun `FRIXEL_BLESS=1 cargo xtask bench`, and then \
             `cargo xtask numbers`",
            differences.join("\n  ")
        )
    })
}

fn differences(measured: &Figures, committed: &BTreeMap<String, Value>) -> Result<(), Vec<String>> {
    let difference = |name: &str| {
        let (measured, committed) = (measured.get(name).copied(), committed.get(name).and_then(Value::as_u64));
        let text = |figure: Option<u64>| figure.map_or("none".to_owned(), |figure| figure.to_string());
        let is_near =
            |(measured, committed): (u64, u64)| measured.abs_diff(committed) <= committed / TOLERANCE_RECIPROCAL;
        let holds = measured.zip(committed).is_some_and(is_near);
        (!holds).then(|| format!("{name}: measured {}, committed {}", text(measured), text(committed)))
    };
    let is_count =
        |name: &&str| ![".flash_", ".ram_", ".stack", ".tick_code_"].iter().any(|bytes| name.contains(bytes));
    let names: BTreeSet<&str> = measured.keys().chain(committed.keys()).map(String::as_str).collect();
    let found: Vec<String> =
        names.into_iter().filter(|name| *name != "date" && is_count(name)).filter_map(difference).collect();
    if found.is_empty() { Ok(()) } else { Err(found) }
}

fn committed() -> Result<BTreeMap<String, Value>, String> {
    serde_json::from_str(&read(COMMITTED)?).map_err(|error| format!("{COMMITTED}: {error}"))
}

/// The committed figures without their date.
#[cfg(test)]
pub(crate) fn committed_figures() -> Result<Figures, String> {
    Ok(committed()?.into_iter().filter_map(|(name, value)| Some((name, value.as_u64()?))).collect())
}

fn read(path: &str) -> Result<String, String> {
    command::text(&root().join(path))
}

/// The page with another generated part.
fn replaced(page: &str, generated: &str) -> Result<String, String> {
    let missing = |line: &str| format!("{PAGE} has no line `{}`", line.trim());
    let (before, rest) = page.split_once(BEGIN).ok_or_else(|| missing(BEGIN))?;
    let (_, after) = rest.split_once(END).ok_or_else(|| missing(END))?;
    Ok(format!("{before}{BEGIN}{generated}{END}{after}"))
}

/// The tables, of the committed figures.
fn generated(figures: &BTreeMap<String, Value>) -> Result<String, String> {
    let date = figures.get("date").and_then(Value::as_str).ok_or_else(|| format!("{COMMITTED} has no date"))?;
    // Writing to a string cannot fail.
    let mut text = String::new();
    let _ = writeln!(text, "Measured on {date}.");
    for Table { heading, first, columns, rows } in &TABLES {
        let headings: Vec<&str> = columns.iter().map(|(heading, ..)| *heading).collect();
        let _ = writeln!(text, "\n### {heading}\n\n| {first} | {} |", headings.join(" | "));
        let _ = writeln!(text, "|---|{}", "---:|".repeat(columns.len()));
        for (name, figure) in *rows {
            let cell = |(_, prefix, suffix): &(_, _, _)| {
                figures.get(&format!("{prefix}{figure}{suffix}")).and_then(Value::as_u64).map(grouped)
            };
            let cells: Vec<Option<String>> = columns.iter().map(cell).collect();
            if cells.iter().all(Option::is_none) {
                return Err(format!("{COMMITTED} has no figure `{figure}`: run `FRIXEL_BLESS=1 cargo xtask bench`"));
            }
            let cells: Vec<String> = cells.into_iter().map(Option::unwrap_or_default).collect();
            let _ = writeln!(text, "| {name} | {} |", cells.join(" | "));
        }
    }
    Ok(text)
}

/// A number with a comma before every third digit from the right.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_the_committed_figures() {
        let page = read(PAGE).unwrap();
        let held = replaced(&page, &generated(&committed().unwrap()).unwrap()).unwrap();
        assert!(held == page, "{PAGE} is not what was measured: run `cargo xtask numbers`");
    }

    #[test]
    fn a_figure_that_is_not_the_committed_one_is_named() {
        let committed = BTreeMap::from([("a".to_owned(), 1.into()), ("b".to_owned(), 2.into())]);
        let figures =
            |figures: &[(&str, u64)]| figures.iter().map(|(name, found)| ((*name).to_owned(), *found)).collect();
        let gone = differences(&figures(&[("a", 1)]), &committed);
        assert_eq!(gone, Err(vec!["b: measured none, committed 2".into()]));
        let long = BTreeMap::from([("step".to_owned(), 6_000.into())]);
        assert_eq!(differences(&figures(&[("step", 6_012)]), &long), Ok(()));
        assert!(differences(&figures(&[("step", 6_013)]), &long).is_err());
        let found = differences(&figures(&[("a", 1), ("b", 3), ("c", 4)]), &committed);
        assert_eq!(found, Err(vec!["b: measured 3, committed 2".into(), "c: measured 4, committed none".into()]));
    }

    #[test]
    fn the_readme_states_the_size_of_the_image() {
        let figures = committed().unwrap();
        let kib = |name: &str| figures[name].as_u64().unwrap().div_ceil(1024);
        let (full, grating) = (kib("g474.flash_full"), kib("g474.flash_grating_only"));
        let expected = format!("{full} KiB of flash with everything, {grating} KiB with one grating");
        assert!(read("README.md").unwrap().contains(&expected), "README.md does not state: {expected}");
    }
}
