//! `frixel report`: four questions on the first screen, and numbers that are what the model's bounds say.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use crate::processes::run;

/// Counts of the shape that `cargo xtask bench` writes.
const BENCH: &str = r#"{ "date": "2026-11-26", "m4f.inverse_table": 16, "m4f.inverse_table_cycles": 27,
    "g474.flash_full": 80000, "g474.flash_none": 30000, "g474.flash_grating_only": 42000,
    "g474.flash_bitmap_only": 41000, "g474.flash_telemetry_only": 31000 }"#;
const MEASURED: &str = "error-against-run-time";
const HEAD: &str = "version = 1\n";

type Row = HashMap<String, String>;
type Files = BTreeMap<String, String>;

/// A report of the bundled scene that is made once for all tests, with counts.
fn report() -> &'static Files {
    static REPORT: OnceLock<Files> = OnceLock::new();
    REPORT.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let bench = folder.path().join("bench.json");
        fs::write(&bench, BENCH).unwrap();
        made(&folder.path().join("a/b"), &["--bench", &bench.display().to_string()])
    })
}

/// The files of a report, each of which the command names.
fn made(out: &Path, args: &[&str]) -> Files {
    let run = run(Path::new("."), &[&["report", "--out", &out.display().to_string()], args].concat());
    assert!(run.status.success() && run.stderr.is_empty(), "{run:?}");
    let named = String::from_utf8(run.stdout).unwrap();
    let paths = named.lines().map(|line| Path::new(line.trim_start().strip_prefix("wrote").unwrap().trim()));
    let name = |path: &Path| path.strip_prefix(out).unwrap().display().to_string();
    let files: Files = paths.map(|path| (name(path), fs::read_to_string(path).unwrap())).collect();
    assert_eq!(files.len(), fs::read_dir(out).unwrap().count(), "every file is named");
    files
}

/// A report of a scene in a file, with a finger's profile if there is one.
fn of_scene(scene: &str, finger: Option<&str>) -> Files {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    fs::write(path("two.toml"), scene).unwrap();
    let mut args = vec![path("two.toml")];
    if let Some(finger) = finger {
        fs::write(path("finger.toml"), finger).unwrap();
        args.extend(["--finger".to_owned(), path("finger.toml")]);
    }
    made(&folder.path().join("out"), &args.iter().map(String::as_str).collect::<Vec<_>>())
}

fn rows(files: &Files, name: &str) -> Vec<Row> {
    let mut reader = csv::Reader::from_reader(files[&format!("{name}.csv")].as_bytes());
    let header = reader.headers().unwrap().clone();
    let row =
        |record: csv::StringRecord| header.iter().map(str::to_owned).zip(record.iter().map(str::to_owned)).collect();
    reader.records().map(|record| row(record.unwrap())).collect()
}

fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

fn largest<'r>(rows: impl IntoIterator<Item = &'r Row>, column: &str) -> f64 {
    rows.into_iter().map(|row| number(row, column)).fold(0.0, f64::max)
}

/// The cells of a table of the page, a row each.
fn table(files: &Files, section: &str) -> Vec<Vec<String>> {
    let (_, after) = files["index.html"].split_once(&format!("<section id=\"{section}\">")).unwrap();
    let (_, after) = after.split_once("<table>\n").unwrap();
    let (table, _) = after.split_once("</table>").unwrap();
    let cells = |row: &str| {
        let cells = row.split("<t").skip(2).map(|cell| cell[2..].split("</").next().unwrap().to_owned());
        cells.collect()
    };
    table.lines().map(cells).collect()
}

#[test]
fn four_questions_have_a_plot_and_a_table_on_the_first_screen() {
    let files = report();
    let page = &files["index.html"];
    let names = ["carrier.csv", "error-against-run-time.csv", "index.html", "scene.csv", "stability.csv"];
    assert_eq!(files.keys().collect::<Vec<_>>(), names);
    let (screen, below) = page.split_once("<footer>").unwrap();
    for tag in ["<section ", "<svg ", "<table>"] {
        assert_eq!((screen.matches(tag).count(), below.matches(tag).count()), (4, 0), "{tag}");
    }
    for outside in ["<script", "<link", "<img", "src=", "@import", "url(", "https://"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert_eq!(page.matches("http://").count(), page.matches("xmlns=\"http://www.w3.org/2000/svg\"").count());
    assert!(!page.contains("NaN") && !page.contains(">inf"), "no number that is none");
    // What q and n are stands where they are first used: on the axes.
    let first = |words: &str| screen.find(words).unwrap();
    assert!(first("q = σ₀/(g k) = (V/V*)²") < first("q = ") + 1 && first("n = F_N/(π k R g²)") < first("n = ") + 1);
    assert_eq!(table(files, MEASURED).len(), 9);
    assert_eq!(table(files, "stability").len(), 8);
    let cost = &table(files, MEASURED)[1];
    assert_eq!((cost[0].as_str(), cost[3].as_str()), ("the board's table, cubic, f32", "16, 27"));
}

#[test]
fn two_runs_differ_in_what_is_measured_and_in_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let second = made(&folder.path().join("out"), &[]);
    for name in ["stability.csv", "scene.csv", "carrier.csv"] {
        let constant = |files: &Files| files[name].lines().filter(|row| !row.contains("flash")).collect::<String>();
        assert_eq!(constant(report()), constant(&second), "{name}");
    }
    for (one, other) in rows(report(), MEASURED).iter().zip(rows(&second, MEASURED)) {
        let timed = |row: &Row| number(row, "measured_nanoseconds") > 0.0;
        assert!(timed(one) && timed(&other), "{one:?}");
        for column in ["method", "size", "largest_relative_error", "worst_at"] {
            assert_eq!(one[column], other[column]);
        }
    }
    // Without a file, the counts of this version and their date.
    assert!(second["index.html"].contains("in an emulator, source of 20"));
}

#[test]
fn mean_friction_under_each_carrier_is_within_half_a_percent() {
    let rows = rows(report(), "carrier");
    assert_eq!(rows.len(), 30);
    for row in &rows {
        assert!(number(row, "relative_error").abs() < 5e-3, "{row:?}");
    }
    let uncorrected = rows.iter().map(|row| number(row, "relative_error_without_correction"));
    assert!(uncorrected.fold(0.0, f64::max) > 0.1);
}

#[test]
fn errors_over_fingers_and_loads_stay_below_the_bounds_and_are_not_zero() {
    let rows = rows(report(), "stability");
    let of = |finger: &str| rows.iter().filter(|row| row["finger"] == finger).cloned().collect::<Vec<Row>>();
    let (springs, soft, pulled) = (of("springs"), of("soft"), of("pulled"));
    for (rows, f64_max, f32_max) in [(&springs, 4e-15, 1e-6), (&soft, 4e-14, 1e-5)] {
        for load in ["0", "0.5", "2"] {
            assert!(rows.iter().filter(|row| row["normal_force_n"] == load).count() >= 90, "{load}");
        }
        for error in ["friction_error", "voltage_error"] {
            let (double, single) = (largest(rows, &format!("{error}_f64")), largest(rows, &format!("{error}_f32")));
            assert!(double <= f64_max && double > 1e-16 && single <= f32_max && single > 6e-8, "{double} {single}");
        }
    }
    let mut cells: HashMap<(i32, Option<i32>), Vec<&str>> = HashMap::new();
    for row in springs.iter().filter(|row| (1e-12..1e12).contains(&number(row, "q"))) {
        let (q, n) = (number(row, "q").log10().floor() as i32, number(row, "n"));
        let n = (n > 0.0).then(|| (n.log10() / 2.0).floor() as i32);
        cells.entry((q, n)).or_default().push(&row["stiffness_pa_per_m"]);
    }
    // Of a decade of q and two of n, and without a load; each with a soft, a usual and a hard finger.
    assert_eq!(cells.iter().filter(|(_, fingers)| fingers.len() >= 4).count(), 24 * 8);
    // What a problem itself makes of the rounding of its numbers is not the model's error: the bound of
    // `PulledContact`.
    for row in &pulled {
        let bound = 4e-15 * (number(row, "condition") / 12.0).max(1.0);
        assert!(number(row, "friction_error_f64") <= bound && number(row, "voltage_error_f64") <= 4e-15, "{row:?}");
    }
    assert!(largest(&pulled, "friction_error_f64") > 1e-10 && largest(&pulled, "condition") > 1e6);
    // The table names those near pull-off apart.
    let table = table(report(), "stability");
    let shown = |row: &[String]| row[1].parse::<f64>().unwrap();
    assert!(table[6][0] == "negative load" && shown(&table[6]) <= 1e-13, "{table:?}");
    assert!(table[7][0] == "within 1 % of pull-off" && shown(&table[7]) > 1e-10, "{table:?}");
    let springs_most = largest(&springs, "friction_error_f64");
    assert_eq!(table[4][1], format!("{springs_most:.1e}"), "the table has the largest of all");
}

#[test]
fn every_way_is_as_far_off_as_it_has_to_be() {
    let rows = rows(report(), MEASURED);
    let errors = |method: &str| -> Vec<f64> {
        let of_method = rows.iter().filter(|row| row["method"] == method);
        of_method.map(|row| number(row, "largest_relative_error")).collect()
    };
    for (method, goal) in
        [("closed form, f64", 8e-15), ("closed form, f32", 1e-6), ("the board's table, cubic, f32", 1e-5)]
    {
        assert!(errors(method).iter().all(|error| *error <= goal && *error > 1e-16), "{method} {:?}", errors(method));
    }
    for method in ["direct table, cubic, f32", "direct table, cubic, integers"] {
        for (error, target) in errors(method).iter().zip([1e-2, 1e-3, 1e-4, 1e-5]) {
            assert!(*error <= target, "{method}: {error} for {target}");
        }
        assert_eq!(errors(method).len(), 4);
    }
    for method in ["bisection, f64", "forward table, binary search, f32"] {
        let errors = errors(method);
        assert!(errors.len() == 3 && errors.windows(2).all(|pair| pair[1] < pair[0]), "{method} {errors:?}");
    }
    // Friction in total cannot resolve the electric part in f32.
    assert!(errors("bisection, f32")[0] > 1e-2);
}

#[test]
fn what_a_scene_leaves_out_is_in_cycles_and_bytes() {
    let grating = |x_mm: u32| {
        format!(
            "[[layer]]\nkind = \"grating\"\nwavelength_mm = 4\nlow_fraction = 0\nhigh_fraction = 0.2\n\
             region = {{ x_mm = {x_mm}, y_mm = 0, width_mm = 10, height_mm = 10 }}\n"
        )
    };
    let flat = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.1\n";
    let two = of_scene(&format!("{HEAD}{flat}{flat}{}{}", grating(0), grating(80)), None);
    let needed = |files: &Files, what: &str| {
        let row = rows(files, "scene").into_iter().find(|row| row["what"].starts_with(what)).unwrap();
        (number(&row, "needed"), number(&row, "whole"))
    };
    let (tick, all) = needed(&two, "tick, if all layers");
    assert!(tick > 0.0 && all > tick + 100.0, "{tick} of {all} cycles: the gratings are not under the finger together");
    let (table_bytes, whole) = needed(&two, "inverse table");
    assert!(table_bytes < whole, "a fifth of the reach needs less of the table");
    assert!(two["index.html"].contains("two.toml that are played: 3; layer 1 (constant) is optimised away"));
    // The bundled scene has a picture; what each of its features adds is in the counts.
    assert_eq!(needed(report(), "image, flash"), (42_000.0, 80_000.0));
    assert!(report()["index.html"].contains("about 42000 bytes"));
}

#[test]
fn a_hard_a_soft_and_an_empirical_finger_are_reported() {
    let finger = |more: &str| {
        format!("friction_coefficient = 0.5\nnormal_load_n = 0.5\nradius_mm = 8\nskin_gap_um = 4.74\n{more}")
    };
    let scene = format!("{HEAD}[[layer]]\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.1\n");
    let soft = "model = \"soft\"\nmodulus_pa = 1e5\nstress_exponent = 0.9\nshape_constant = 4.5\n";
    let empirical = "friction_coefficient = 0.4\nnormal_load_n = 0.5\norigin = \"empirical\"\ndate = \"2026-11-23\"\n\
                     method = \"load cell\"\nscreen = \"example\"\nexponent = 2\npoints = [[120, 0.09]]\n\
                     intervals_n = [[0.08, 0.1]]\n";
    for (finger, words) in [
        (finger("stiffness_pa_per_m = 1e13\n"), ["k = 1.000e13 Pa/m", "a board refuses it"]),
        (finger("stiffness_pa_per_m = 1e3\n"), ["k = 1.000e3 Pa/m", "the contact would have a radius"]),
        (finger(soft), ["the scene's, assumed: R = 8 mm", "Layers of "]),
        (empirical.to_owned(), ["has no contact model: R = 8 mm", "120 V rms"]),
    ] {
        let page = &of_scene(&scene, Some(&finger))["index.html"];
        for words in words {
            assert!(page.contains(words), "{words}: {}", page.split_once("<footer>").unwrap().1);
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let scene_file = folder.path().join("scene.toml").display().to_string();
    fs::write(&scene_file, scene).unwrap();
    assert!(!run(folder.path(), &["report", &scene_file, "--out", &scene_file]).status.success());
}
