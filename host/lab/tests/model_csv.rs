//! Rows of CSV through the contact model, and back.

use std::collections::{HashMap, HashSet};
use std::io::{self, Read, Write};

use frixel_lab::model_csv::{self, CsvError, Precision, Summary};
use frixel_model::{Contact, ContactModel, Finger, Real};
use proptest::prelude::*;

const HEADER: &str = "variant,radius_m,stiffness_pa_per_m,coating_m,permittivity,friction_coefficient,voltage_v,\
                      normal_force_n,outer_radius_m,modulus_pa,stress_exponent,shape_constant";
/// A row of every variant that has an answer.
const GOOD: [&str; 7] = [
    "wf-upper,8e-3,1.8e7,1e-5,1,0.5,150,,,,,",
    "wf-lower,8e-3,1.8e7,1e-5,1,0.5,150,0.5,,,,",
    "wf-loaded,8e-3,1.8e7,1e-5,1,0.5,150,-1e-3,,,,",
    "wf-finite,8e-3,1.8e7,1e-5,1,0.5,150,0.5,6e-3,,,",
    "soft-upper,8e-3,,1e-5,1,0.5,150,,,1e5,0.5,4.5",
    "soft-lower,8e-3,,1e-5,1,0.5,150,,,1e5,0.5,4.5",
    "soft-loaded,8e-3,,1e-5,1,0.5,150,0.5,,1e5,0.5,4.5",
];

/// Rows of a CSV text by column, of which no two have the same name.
fn rows(text: &str) -> Vec<HashMap<String, String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    assert_eq!(header.iter().collect::<HashSet<_>>().len(), header.len(), "{header:?}");
    let owned = |record: csv::StringRecord| {
        header.iter().zip(record.iter()).map(|(name, cell)| (name.to_owned(), cell.to_owned())).collect()
    };
    reader.records().map(|record| owned(record.unwrap())).collect()
}

/// The text that a table becomes, and what is said of it.
fn text(transform: Transform, precision: Precision, input: &str) -> (String, Summary) {
    let mut output = Vec::new();
    let summary = transform(precision, input.as_bytes(), &mut output).unwrap();
    (String::from_utf8(output).unwrap(), summary)
}

fn transformed(transform: Transform, precision: Precision, input: &str) -> (Vec<HashMap<String, String>>, Summary) {
    let (text, summary) = text(transform, precision, input);
    (rows(&text), summary)
}

type Transform = fn(Precision, &[u8], &mut Vec<u8>) -> Result<Summary, CsvError>;

fn eval(precision: Precision, input: &[u8], output: &mut Vec<u8>) -> Result<Summary, CsvError> {
    model_csv::eval(precision, input, output)
}

fn invert(precision: Precision, input: &[u8], output: &mut Vec<u8>) -> Result<Summary, CsvError> {
    model_csv::invert(precision, input, output)
}

fn statuses(transform: Transform, input: &str) -> Vec<String> {
    transformed(transform, Precision::F64, input).0.into_iter().map(|mut row| row.remove("status").unwrap()).collect()
}

fn eval_one(row: &str) -> HashMap<String, String> {
    transformed(eval, Precision::F64, &format!("{HEADER}\n{row}\n")).0.remove(0)
}

/// A good row with one cell changed.
fn changed(row: &str, column: &str, cell: &str) -> String {
    let place = HEADER.split(',').position(|name| name == column).unwrap();
    let cells: Vec<_> = row.split(',').enumerate().map(|(at, old)| if at == place { cell } else { old }).collect();
    cells.join(",")
}

fn relative_error(found: f64, right: f64) -> f64 {
    if found.total_cmp(&right).is_eq() { 0.0 } else { (found / right - 1.0).abs() }
}

#[test]
fn columns_come_in_any_order_and_pass_through_cell_for_cell() {
    let input = "\u{feff}note, voltage_v ,friction_coefficient,variant,permittivity,coating_m,stiffness_pa_per_m,radius_m\r\n\
                 \"a, \"\"b\"\"\", 150 ,0.50,wf-upper, 1,1e-5,18000000,+0.008\r\n";
    let (text, summary) = text(eval, Precision::F64, input);
    assert_eq!((summary.rows, summary.understood), (1, None));
    let mut lines = text.lines();
    assert_eq!(
        lines.next().unwrap(),
        "note, voltage_v ,friction_coefficient,variant,permittivity,coating_m,stiffness_pa_per_m,radius_m,sigma0_pa,\
         contact_radius_m,effective_stiffness_pa_per_m,friction_n,status"
    );
    let line = lines.next().unwrap();
    assert!(line.starts_with("\"a, \"\"b\"\"\", 150 ,0.50,wf-upper, 1,1e-5,18000000,+0.008,9.9609612961499"), "{line}");
    assert!(line.ends_with(",ok"));
    assert_eq!(lines.next(), None);
}

fn example<T: Real>() -> impl ContactModel<T> {
    let finger = Finger {
        radius_m: T::from_f64(8e-3),
        stiffness_pa_per_m: T::from_f64(1.8e7),
        friction_coefficient: T::from_f64(0.5),
    };
    Contact::new(&finger, T::from_f64(1e-5)).unwrap().under_load(T::ZERO).unwrap()
}

#[test]
fn digits_are_enough_to_read_the_same_number_again() {
    let input = format!("{HEADER}\n{}\n", GOOD[0]);
    for (precision, digits) in [(Precision::F64, 17), (Precision::F32, 9)] {
        let (rows, _) = transformed(eval, precision, &input);
        let mantissa = rows[0]["friction_n"].split('e').next().unwrap().to_owned();
        assert_eq!(mantissa.chars().filter(char::is_ascii_digit).count(), digits);
    }
    let (rows, _) = transformed(eval, Precision::F64, &input);
    let right = example::<f64>().state(150.0).unwrap().friction_n;
    assert_eq!(rows[0]["friction_n"].parse::<f64>().unwrap().to_bits(), right.to_bits());
    let (rows, _) = transformed(eval, Precision::F32, &input);
    let right = example::<f32>().state(150.0).unwrap().friction_n;
    assert_eq!(rows[0]["friction_n"].parse::<f32>().unwrap().to_bits(), right.to_bits());
}

#[test]
fn invert_returns_the_voltage_that_eval_was_given() {
    let (evaluated, _) = text(eval, Precision::F64, &format!("{HEADER}\n{}\n", GOOD.join("\n")));
    let (rows, _) = transformed(invert, Precision::F64, &evaluated);
    assert_eq!(rows.len(), GOOD.len());
    for row in rows {
        assert_eq!(row["status"], "ok", "{row:?}");
        // Friction in total loses what natural friction covers.
        assert!(relative_error(row["voltage_v"].parse().unwrap(), 150.0) < 1e-12, "{row:?}");
    }
}

/// Good rows with one cell spoiled, each with the column it is in.
fn spoiled() -> Vec<(String, &'static str)> {
    let mut cases = Vec::new();
    for good in GOOD {
        let is = |variants: &[&str]| variants.iter().any(|variant| good.starts_with(variant));
        for (column, cell) in HEADER.split(',').zip(good.split(',')) {
            if cell.is_empty() || column == "variant" {
                continue;
            }
            let load = column == "normal_force_n";
            let mut cells = vec!["glass", "1.5.0", "0x10", "1e", "--1", "\u{221e}", "nan", "inf", "-inf", "1e999"];
            if !(load && is(&["wf-lower", "wf-finite"])) {
                cells.push("");
            }
            if !(load && is(&["wf-lower", "wf-loaded"])) {
                cells.push("-1e-3");
            }
            if !load && column != "voltage_v" {
                cells.push("0");
            }
            cases.extend(cells.iter().map(|cell| (changed(good, column, cell), column)));
        }
    }
    cases
}

#[test]
fn every_bad_parameter_is_refused_by_name_in_its_own_row() {
    let cases = spoiled();
    assert!(cases.len() > 400);
    // Good rows stand between the bad ones.
    let pairs: Vec<_> = cases.iter().map(|(bad, _)| format!("{bad}\n{}\n", GOOD[0])).collect();
    let (rows, summary) = transformed(eval, Precision::F64, &format!("{HEADER}\n{}", pairs.concat()));
    let count = cases.len() as u64;
    assert_eq!((summary.rows, summary.invalid_rows), (2 * count, count));
    for ((bad, column), pair) in cases.iter().zip(rows.chunks(2)) {
        let status = &pair[0]["status"];
        assert!(status.starts_with("invalid: ") && status.contains(column), "{bad}: {status}");
        for answer in ["sigma0_pa", "contact_radius_m", "effective_stiffness_pa_per_m", "friction_n"] {
            assert_eq!(pair[0][answer], "", "{bad}");
        }
        assert_eq!(pair[1]["status"], "ok", "after {bad}");
    }
}

#[test]
fn reasons_say_what_was_expected_and_found_and_where() {
    let status = |row: &str| eval_one(row).remove("status").unwrap();
    for (row, expected) in [
        (
            changed(GOOD[0], "permittivity", "glass"),
            "invalid: row 2, column permittivity: expected a number, found \"glass\"",
        ),
        (
            changed(GOOD[0], "stiffness_pa_per_m", ""),
            "invalid: row 2, column stiffness_pa_per_m: expected a number, found an empty cell",
        ),
        (changed(GOOD[0], "radius_m", "-8e-3"), "invalid: radius_m must be finite and above zero, but is -8e-3"),
        (changed(GOOD[0], "permittivity", "0.5"), "invalid: permittivity must be finite and at least one, but is 5e-1"),
        (changed(GOOD[0], "voltage_v", "-1"), "invalid: voltage_v must be finite and not below zero, but is -1e0"),
        (
            changed(GOOD[4], "stress_exponent", "1.5"),
            "invalid: stress_exponent must be above zero and at most one, but is 1.5e0",
        ),
        (
            changed(GOOD[6], "normal_force_n", "-0.5"),
            "invalid: normal_force_n must be finite and not below zero, but is -5e-1",
        ),
        (
            changed(GOOD[0], "voltage_v", "1e300"),
            "invalid: voltage_v of 1e300 leads to numbers too large or too small for this precision",
        ),
        (changed(GOOD[0], "voltage_v", "1e150"), "invalid: the answer is too large or too small for this precision"),
        (
            changed(GOOD[2], "normal_force_n", "-inf"),
            "invalid: row 2, column normal_force_n: expected a number, found \"-inf\"",
        ),
        (
            changed(GOOD[2], "normal_force_n", "nan"),
            "invalid: row 2, column normal_force_n: expected a number, found \"nan\"",
        ),
        (
            changed(GOOD[2], "normal_force_n", "-1e308"),
            "invalid: normal_force_n of -1e308 leads to numbers too large or too small for this precision",
        ),
        (
            changed(GOOD[0], "variant", "wf"),
            "invalid: row 2, column variant: expected one of wf-upper, wf-lower, wf-loaded, wf-finite, soft-upper, \
             soft-lower, soft-loaded, found \"wf\"",
        ),
        ("wf-upper,8e-3".to_owned(), "invalid: row 2: expected 12 cells as in the header, found 2"),
        (format!("{},7", GOOD[0]), "invalid: row 2: expected 12 cells as in the header, found 13"),
    ] {
        assert_eq!(status(&row), expected, "{row}");
    }
    let f32_status = |row: &str| {
        let (mut rows, _) = transformed(eval, Precision::F32, &format!("{HEADER}\n\nwf\n\n{row}\n"));
        rows.remove(1).remove("status").unwrap()
    };
    assert_eq!(
        f32_status(&changed(GOOD[0], "voltage_v", "1e-50")),
        "invalid: row 5, column voltage_v: 1e-50 is out of the range of f32; use --precision f64"
    );
    // Friction and contact radius are in range, and the contact attraction is not.
    assert_eq!(
        f32_status("wf-upper,1e-10,1e14,1e-7,1,1e-20,1e18,,,,,"),
        "invalid: voltage_v of 9.999999843067494e17 leads to numbers too large or too small for this precision"
    );
}

#[test]
fn a_column_that_only_some_variants_need_is_missed_only_by_them() {
    let input = "variant,radius_m,stiffness_pa_per_m,coating_m,permittivity,friction_coefficient,voltage_v\n\
                 wf-upper,8e-3,1.8e7,1e-5,1,0.5,150\n\
                 wf-loaded,8e-3,1.8e7,1e-5,1,0.5,150\n\
                 wf-lower,8e-3,1.8e7,1e-5,1,0.5,150\n\
                 soft-upper,8e-3,1.8e7,1e-5,1,0.5,150\n";
    assert_eq!(
        statuses(eval, input),
        [
            "ok",
            "invalid: row 3, column normal_force_n: the header has no such column, and wf-loaded needs it",
            "ok",
            "invalid: row 5, column modulus_pa: the header has no such column, and soft-upper needs it",
        ]
    );
}

#[test]
fn no_voltage_and_no_load_are_zeros_and_a_pull_without_voltage_is_no_contact() {
    for good in [GOOD[0], GOOD[4], GOOD[5]] {
        let row = eval_one(&changed(good, "voltage_v", "0"));
        assert_eq!(row["status"], "ok");
        for answer in ["sigma0_pa", "contact_radius_m", "friction_n"] {
            assert_eq!(row[answer], "0", "{answer} of {good}");
        }
    }
    let row = eval_one(&changed(GOOD[2], "voltage_v", "0"));
    assert_eq!(
        (row["status"].as_str(), row["contact_radius_m"].as_str(), row["friction_n"].as_str()),
        ("no-contact", "0", "0")
    );
}

#[test]
fn a_contact_wider_than_the_finger_has_a_status_of_its_own() {
    let wide = changed(GOOD[0], "voltage_v", "1e5");
    let outside = changed(GOOD[3], "outer_radius_m", "1e-3");
    let (evaluated, summary) = text(eval, Precision::F64, &format!("{HEADER}\n{wide}\n{outside}\n{}\n", GOOD[0]));
    assert_eq!((summary.invalid_rows, summary.beyond_finger_rows), (0, 2));
    let found = rows(&evaluated);
    let statuses: Vec<&str> = found.iter().map(|row| row["status"].as_str()).collect();
    assert_eq!(statuses, ["wider-than-finger", "wider-than-finger", "ok"]);
    assert!(found[0]["contact_radius_m"].parse::<f64>().unwrap() > 8e-3);
    assert_eq!(found[1]["friction_n"], "");
    let again = evaluated.lines().filter(|line| !line.starts_with("wf-finite")).collect::<Vec<_>>().join("\n");
    let (found, summary) = transformed(invert, Precision::F64, &again);
    assert_eq!((found[0]["status"].as_str(), summary.beyond_finger_rows), ("wider-than-finger", 1));
    assert_eq!(summary.understood.as_deref(), Some("answers replace its voltage_v, status"));
}

#[test]
fn invert_takes_the_friction_that_is_filled_in() {
    let header = "variant,radius_m,stiffness_pa_per_m,coating_m,permittivity,friction_coefficient,normal_force_n,\
                  friction_n,electric_friction_n";
    let finger = "wf-loaded,8e-3,1.8e7,1e-5,1,0.5";
    let input = format!(
        "{header}\n\
         {finger},0.5,,0.02\n{finger},0.5,0.27,\n{finger},0.5,0.25,\n{finger},0.5,0.2499,\n{finger},0.5,,-1e-9\n\
         {finger},-1e-3,0,\n{finger},0.5,,\n{finger},0.5,0.27,0.02\n{finger},0.5,-0.1,\n{finger},0.5,,1e-30\n"
    );
    let (rows, _) = transformed(invert, Precision::F64, &input);
    let found: Vec<_> = rows.iter().map(|row| row["status"].as_str()).collect();
    assert_eq!(
        found,
        [
            "ok",
            "ok",
            "ok",
            "below-natural",
            "below-natural",
            "unstable",
            "invalid: row 8, column friction_n: neither friction_n nor electric_friction_n is filled in",
            "invalid: row 9: friction_n and electric_friction_n are both filled in; leave one empty",
            "below-natural",
            "ok",
        ]
    );
    let voltage = |row: usize| rows[row]["voltage_v"].parse::<f64>().unwrap();
    assert!(relative_error(voltage(0), voltage(1)) < 1e-13 && voltage(0) > 100.0);
    assert!(voltage(2).abs() < f64::MIN_POSITIVE);
    assert!(voltage(9) > 0.0 && voltage(9) < 1e-10, "the electric part does not drown in the total");
    assert!(rows[3..9].iter().all(|row| row["voltage_v"].is_empty()));
}

/// Rows without end.
struct Endless {
    text: Vec<u8>,
    sent: usize,
}

impl Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let header = HEADER.len() + 1;
        for byte in &mut *buffer {
            let at =
                if self.sent < header { self.sent } else { header + (self.sent - header) % (self.text.len() - header) };
            *byte = self.text[at];
            self.sent += 1;
        }
        Ok(buffer.len())
    }
}

/// Takes so many bytes and no more.
struct Narrow(usize);

impl Write for Narrow {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 = self.0.checked_sub(bytes.len()).ok_or(io::ErrorKind::BrokenPipe)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn rows_stream_through() {
    let mut input = Endless { text: format!("{HEADER}\n{}\n", GOOD[0]).into_bytes(), sent: 0 };
    let error = model_csv::eval(Precision::F64, &mut input, Narrow(1_000_000)).unwrap_err();
    assert!(matches!(error, CsvError::Write(ref source) if source.kind() == io::ErrorKind::BrokenPipe), "{error}");
    assert!(input.sent < 1_000_000, "{} bytes read for 1,000,000 written", input.sent);
}

/// Every answer is a number, and every row has its status. `columns` are the input columns that stay.
fn check_output(output: &[u8], columns: usize, answers: usize, summary: &Summary) {
    let mut reader = csv::ReaderBuilder::new().has_headers(true).flexible(true).from_reader(output);
    assert_eq!(reader.byte_headers().unwrap().len(), columns + answers + 1);
    let mut count = 0;
    let mut invalid = 0;
    for record in reader.byte_records() {
        let record = record.unwrap();
        count += 1;
        assert_eq!(record.len(), columns + answers + 1);
        let status = std::str::from_utf8(&record[record.len() - 1]).unwrap();
        invalid += u64::from(status.starts_with("invalid: "));
        for place in columns..columns + answers {
            let cell = std::str::from_utf8(&record[place]).unwrap();
            match status {
                "ok" | "no-contact" => assert!(cell.parse::<f64>().unwrap().is_finite(), "{cell}"),
                "wider-than-finger" => assert!(cell.is_empty() || cell.parse::<f64>().unwrap().is_finite(), "{cell}"),
                _ => assert_eq!(cell, "", "{status}"),
            }
        }
    }
    assert_eq!((count, invalid), (summary.rows, summary.invalid_rows));
}

fn cell() -> impl Strategy<Value = String> {
    prop_oneof![
        4 => any::<f64>().prop_map(|number| format!("{number:e}")),
        4 => (-9.0..9.0_f64).prop_map(|exponent| format!("{:e}", 10f64.powf(exponent))),
        1 => prop::sample::select(vec!["", "0", "-0", "1", "nan", "inf", "-inf", "1e-320", "1e999", " 2 ", "word", "0.5"])
            .prop_map(str::to_owned),
        1 => "\\PC{0,8}".prop_map(|text| text.replace(['"', ',', '\r', '\n'], "")),
    ]
}

proptest! {
    #[test]
    fn any_bytes_are_answered_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300), header in any::<bool>()) {
        let mut input = if header { format!("{HEADER},friction_n\n").into_bytes() } else { Vec::new() };
        input.extend(bytes);
        for precision in [Precision::F64, Precision::F32] {
            for (transform, answers) in [(eval as Transform, 4), (invert as Transform, 1)] {
                let mut output = Vec::new();
                if let Ok(summary) = transform(precision, &input, &mut output)
                    && header
                {
                    check_output(&output, 12, answers, &summary);
                }
            }
        }
    }

    #[test]
    fn any_cells_give_a_status_and_never_a_number_that_is_none(
        variant in prop::sample::select(GOOD.map(|row| row.split(',').next().unwrap()).to_vec()),
        cells in prop::collection::vec(cell(), 13),
    ) {
        let header = "radius_m,stiffness_pa_per_m,coating_m,permittivity,friction_coefficient,voltage_v,normal_force_n,\
                      outer_radius_m,modulus_pa,stress_exponent,shape_constant,friction_n,electric_friction_n";
        let input = format!("variant,{header}\n{variant},{}\n", cells.join(","));
        for precision in [Precision::F64, Precision::F32] {
            for (transform, answers) in [(eval as Transform, 4), (invert as Transform, 1)] {
                let mut output = Vec::new();
                let summary = transform(precision, input.as_bytes(), &mut output).unwrap();
                prop_assert_eq!(summary.rows, 1);
                check_output(&output, 13, answers, &summary);
            }
        }
    }
}
