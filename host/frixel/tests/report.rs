//! `frixel report`: its files, and that its numbers are what the model's bounds say.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use frixel_hil_sim::RigConfig;
use frixel_scene::{CompileError, Program, Scene, compile};

/// Counts of the shape that `cargo xtask bench` writes.
const BENCH: &str = r#"{ "m0plus.inverse_table": 803, "m33.inverse_table": 15, "m3.inverse_table": 415, "m3.inverse_table_fixed": 61, "m4f.inverse_closed_form": 185, "m4f.inverse_closed_form_cycles": 277,
    "m4f.inverse_table": 16, "m4f.inverse_table_cycles": 27, "m4f.tick_idle": 209,
    "m4f.tick_1_of_1": 331, "m4f.tick_1_of_1_mean": 301, "m4f.tick_1_of_8": 335, "m4f.tick_1_of_8_mean": 302,
    "m4f.tick_1_of_64": 329, "m4f.tick_1_of_64_mean": 303, "m4f.tick_8_of_8": 517, "m4f.tick_8_of_8_mean": 481,
    "m4f.tick_8_of_64": 524, "m4f.tick_8_of_64_mean": 482, "m4f.tick_8_of_64_cycles": 841 }"#;

/// What is the same in no two runs.
const MEASURED: &str = "error-against-run-time";

type Row = HashMap<String, String>;

fn frixel(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_frixel")).arg("report").args(args).output().unwrap()
}

/// A report that is made once for all tests, with counts.
fn report() -> &'static BTreeMap<String, String> {
    static REPORT: OnceLock<BTreeMap<String, String>> = OnceLock::new();
    REPORT.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let bench = folder.path().join("bench.json");
        fs::write(&bench, BENCH).unwrap();
        made(&folder.path().join("a/b"), &["--bench", &bench.display().to_string()])
    })
}

/// The files of a report, which the command names.
fn made(out: &Path, args: &[&str]) -> BTreeMap<String, String> {
    let run = frixel(&[&["--out", &out.display().to_string()], args].concat());
    assert!(run.status.success() && run.stderr.is_empty(), "{run:?}");
    let named = String::from_utf8(run.stdout).unwrap();
    let paths: Vec<PathBuf> =
        named.lines().map(|line| line.trim_start().strip_prefix("wrote").unwrap().trim().into()).collect();
    files(&paths, out)
}

fn files(paths: &[PathBuf], folder: &Path) -> BTreeMap<String, String> {
    let name = |path: &PathBuf| path.strip_prefix(folder).unwrap().display().to_string();
    let files: BTreeMap<_, _> = paths.iter().map(|path| (name(path), fs::read_to_string(path).unwrap())).collect();
    assert_eq!(files.len(), fs::read_dir(folder).unwrap().count(), "every file is named");
    files
}

fn rows(name: &str) -> Vec<Row> {
    let text = &report()[&format!("{name}.csv")];
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let row =
        |record: csv::StringRecord| header.iter().map(str::to_owned).zip(record.iter().map(str::to_owned)).collect();
    reader.records().map(|record| row(record.unwrap())).collect()
}

fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

fn largest(rows: &[Row], column: &str) -> f64 {
    rows.iter().map(|row| number(row, column)).fold(0.0, f64::max)
}

#[test]
fn the_page_shows_every_figure_and_needs_nothing_else() {
    let files = report();
    let page = &files["index.html"];
    let figures: Vec<&str> = files.keys().filter_map(|name| name.strip_suffix(".csv")).collect();
    assert_eq!(figures.len(), 10);
    assert_eq!(page.matches("<svg ").count(), 10);
    assert_eq!(page.matches("</svg>").count(), 10);
    for figure in figures {
        assert!(page.contains(&format!("<h2 id=\"{figure}\">")), "{figure}");
        assert!(page.contains(&format!("<a href=\"#{figure}\">")), "{figure}");
        assert!(page.contains(&format!("<a href=\"{figure}.csv\">")), "{figure}");
    }
    for outside in ["<script", "<link", "<img", "src=", "@import", "url(", "https://"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert_eq!(page.matches("http://").count(), page.matches("xmlns=\"http://www.w3.org/2000/svg\"").count());
    assert!(!page.contains("NaN") && !page.contains("inf"), "no number that is none");
    for axis in ["relative error", "bytes"] {
        assert!(page.contains(axis), "{axis}");
    }
    assert_eq!(page.matches("Worst points").count(), 4);
    // Both directions of the three maps, both precisions of the soft finger.
    assert_eq!(page.matches("\nworst: ").count(), 8, "they are marked in the pictures");
}

#[test]
fn two_runs_differ_in_what_is_measured_and_in_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let bench = folder.path().join("bench.json");
    fs::write(&bench, BENCH).unwrap();
    let out = folder.path().join("out");
    let (first, second) = (report(), made(&out, &["--bench", &bench.display().to_string()]));
    assert_eq!(first.keys().collect::<Vec<_>>(), second.keys().collect::<Vec<_>>());
    // Without the answer and the section of the measured figure.
    let constant = |page: &str| {
        let page: String = page.lines().filter(|line| !line.contains("MEASURED here")).collect();
        let start = page.find(&format!("<h2 id=\"{MEASURED}\">")).unwrap();
        let end = start + 1 + page[start + 1..].find("<h2 ").unwrap();
        page[..start].to_owned() + &page[end..]
    };
    assert_eq!(constant(&first["index.html"]), constant(&second["index.html"]));
    for (name, text) in first {
        if name != "index.html" && *name != format!("{MEASURED}.csv") {
            assert_eq!(text, &second[name], "{name}");
        }
    }
    let section = &first["index.html"][first["index.html"].find(&format!("<h2 id=\"{MEASURED}\">")).unwrap()..];
    assert!(
        section.contains("MEASURED") && section.contains("were measured on the computer"),
        "what is measured says so"
    );
}

#[test]
fn counts_are_asked_for_and_shown() {
    let counts = rows("error-against-instructions");
    let found: Vec<_> = counts.iter().map(|row| (row["core"].as_str(), row["instructions"].as_str())).collect();
    assert_eq!(found, [("m4f", "185"), ("m4f", "16"), ("m33", "15"), ("m0plus", "803"), ("m3", "415"), ("m3", "61")]);
    assert!(report()["index.html"].contains("16 (about 27 cycles)"));
    assert!(report()["index.html"].contains("takes on a board is in the figure before this one"));
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    // Without a count of an inversion or of a tick among layers, the page says that, and how to come by one.
    fs::write(path("other.json"), "{ \"m4f.tick_idle\": 209 }").unwrap();
    let other = path("other.json");
    let page = &made(&folder.path().join("page"), &["--bench", &other])["index.html"];
    for what in ["an inversion", "a tick"] {
        let start = page.find(&format!("What {what} takes on a board is not shown: ")).unwrap();
        let sentence = &page[start..start + page[start..].find("</p>").unwrap()];
        assert!(sentence.contains("has no count of one") && sentence.contains("cargo xtask bench"), "{sentence}");
    }
    assert_eq!(page.matches("<svg ").count(), 8);
    // Without a file, the counts of this version and their date.
    let page = &made(&folder.path().join("committed"), &[])["index.html"];
    assert_eq!(page.matches("<svg ").count(), 10);
    let date = page.split_once("counted by cargo xtask bench in an emulator, source of ").unwrap().1;
    assert!(date.starts_with("20") && date.as_bytes()[4] == b'-', "{}", &date[..12]);
    fs::write(path("bad.json"), "{ \"m4f.inverse_table\": \"sixteen\" }").unwrap();
    for (file, message) in
        [("none.json", "`cargo xtask bench` writes such a file"), ("bad.json", "expected a JSON object of numbers")]
    {
        let run = frixel(&["--out", &path("out"), "--bench", &path(file)]);
        assert!(!run.status.success());
        let stderr = String::from_utf8(run.stderr).unwrap();
        assert!(stderr.contains(file) && stderr.contains(message), "{stderr}");
    }
    // A folder that cannot be made.
    let run = frixel(&["--out", &path("bad.json/out")]);
    assert!(!run.status.success());
    assert!(String::from_utf8(run.stderr).unwrap().contains("check the folder"));
}

#[test]
fn a_tick_costs_what_was_counted_and_no_more_than_it_may() {
    let found: Vec<_> = rows("tick-cost-against-layers")
        .iter()
        .map(|row| ["layers_under_the_finger", "layers", "instructions", "mean_instructions"].map(|is| number(row, is)))
        .collect();
    let expected = [
        [1.0, 1.0, 331.0, 301.0],
        [1.0, 8.0, 335.0, 302.0],
        [1.0, 64.0, 329.0, 303.0],
        [8.0, 8.0, 517.0, 481.0],
        [8.0, 64.0, 524.0, 482.0],
    ];
    assert_eq!(found, expected);
    let section = section("tick-cost-against-layers");
    for said in [
        "with one under the finger they add 2 instructions on average",
        "with eight under the finger they add 1 instructions on average",
        "is refused when a tick at some place is estimated at more cycles than the board states",
    ] {
        assert!(section.contains(said), "{said}");
    }
    assert!(report()["index.html"].contains("What a tick takes on a board is in the figure before this one."));
    // The caption's claim: the board's own limit is what refuses.
    let constants = |count| {
        let layer = "[[layer]]\nkind = \"constant\"\nblend = \"max\"\nlive = true\nfriction_n = 0.001\n";
        compiled(&layer.repeat(count)).map(|_| ()).map_err(|error| error.to_string())
    };
    let refused = (8..=64).find_map(|count| constants(count).err().map(|message| (count, message)));
    let (count, message) = refused.unwrap();
    let limit = RigConfig::default().board.limits.tick_cycles_max;
    assert!(count > 8 && message.contains(&format!("the board has time for {limit}")), "{count}: {message}");
}

/// What the page has of a figure.
fn section(name: &str) -> &'static str {
    let page = &report()["index.html"];
    let start = page.find(&format!("<h2 id=\"{name}\">")).unwrap();
    &page[start..start + page[start..].find("</figure>").unwrap()]
}

/// Layers on a screen, compiled for the simulated board.
fn compiled(layers: &str) -> Result<Program, CompileError> {
    let head = "version = 1\n[screen]\nwidth_mm = 120\nheight_mm = 80\n[screen.coating]\nthickness_um = 10\npermittivity = 1\n\
                [finger]\nradius_mm = 8\nstiffness_pa_per_m = 1.8e7\nfriction_coefficient = 0.5\nnormal_load_n = 0.5\nskin_gap_um = 0\n";
    let board = RigConfig::default().board;
    compile(&Scene::parse(&format!("{head}{layers}"), "a scene", &BTreeMap::new())?, &board.limits, board.tick_hz)
}

/// The bytes and frames of an upload whose content is cut into chunks of 184 bytes: two bytes of number, four of CRC,
/// one of COBS and the zero byte go with each.
fn in_chunks(bytes: f64) -> (f64, f64) {
    let chunks = (bytes / 184.0).ceil();
    (bytes + 8.0 * chunks, chunks)
}

#[test]
fn bytes_on_the_wire_follow_what_is_in_the_scene() {
    let rows = rows("bytes-against-scene-content");
    let of = |content: &str| rows.iter().filter(move |row| row["content"] == content).collect::<Vec<_>>();
    let (gratings, triangles, pictures) = (of("gratings"), of("triangles"), of("a picture"));
    let many: Vec<_> = rows.iter().filter(|row| row["content"].starts_with("polygons of ")).collect();
    assert_eq!((gratings.len(), triangles.len(), pictures.len()), (64, 42, 9));
    let vertices = number(many[0], "amount");
    assert!(vertices > 3.0 && many.len() == (128.0 / vertices).floor() as usize, "{vertices}");
    let amounts = |rows: &[&Row]| rows.iter().map(|row| number(row, "amount")).collect::<Vec<_>>();
    assert_eq!(amounts(&gratings), (1..=64).map(f64::from).collect::<Vec<_>>());
    assert_eq!(amounts(&pictures), [50.0, 75.0, 100.0, 125.0, 150.0, 175.0, 200.0, 225.0, 250.0]);
    let frictions = of("a friction");
    assert_eq!(amounts(&frictions), (1..=100).map(f64::from).collect::<Vec<_>>());
    let table = |percent: usize| number(frictions[percent - 1], "table_bytes");
    // Four rows of 16 bytes for an octave.
    for percent in [2, 6, 25, 49] {
        assert!((table(2 * percent) - table(percent) - 64.0).abs() < 1.0, "{percent}");
    }
    assert!(frictions.is_sorted_by_key(|row| number(row, "table_bytes") as u32) && table(100) <= 2016.0);
    for row in &rows {
        let (amount, scene, pictures) =
            (number(row, "amount"), number(row, "scene_bytes"), number(row, "picture_bytes"));
        let (layers, points, samples) = match row["content"].as_str() {
            "gratings" => (amount, 0.0, 0.0),
            "triangles" => (amount / 3.0, amount, 0.0),
            "a picture" => (1.0, 0.0, amount * amount),
            "a friction" => (1.0, 0.0, 0.0),
            _ => (amount / vertices, amount, 0.0),
        };
        assert_eq!((scene, pictures), (56.0 + 56.0 * layers + 8.0 * points, samples), "{row:?}");
        // And a few requests, which are short.
        let (bytes, chunks) = in_chunks(scene);
        let (more_bytes, more_chunks) = in_chunks(pictures);
        let requests = number(row, "frames") - chunks - more_chunks;
        let request_bytes = number(row, "wire_bytes") - bytes - more_bytes;
        assert_eq!(requests as usize, if samples > 0.0 { 5 } else { 3 }, "{row:?}");
        assert!(request_bytes > 8.0 * requests && request_bytes < 24.0 * requests, "{request_bytes} of {row:?}");
    }
    // One vertex more would take a tick too long: the caption's claim.
    let polygon = |count: usize| {
        let angle = |corner| std::f64::consts::TAU * corner as f64 / count as f64;
        let points: Vec<_> = (0..count)
            .map(|corner| format!("[{:.3}, {:.3}]", 40.0 + 9.0 * angle(corner).cos(), 40.0 + 9.0 * angle(corner).sin()))
            .collect();
        compiled(&format!(
            "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\nregion = {{ shape = \"polygon\", points_mm = [{}] }}\n",
            points.join(", ")
        ))
    };
    assert!(polygon(vertices as usize).is_ok());
    assert!(
        vertices >= 32.0 || polygon(vertices as usize + 1).unwrap_err().to_string().contains("the board has time for")
    );
}

#[test]
fn maps_stay_below_the_goals_and_are_not_empty() {
    for (name, goal, least) in [("stability-f64", 4e-15, 1e-16), ("stability-f32", 1e-6, 6e-8)] {
        let rows = rows(name);
        assert_eq!(rows.len(), 24 * 3 * (14 * 3 + 1));
        for column in ["forward_relative_error", "inverse_relative_error"] {
            let worst = largest(&rows, column);
            assert!(worst <= goal && worst > least, "{name} {column}: {worst}");
        }
    }
    let rows = rows("stability-soft");
    for (precision, goal, least) in [("f64", 4e-14, 1e-16), ("f32", 1e-5, 6e-8)] {
        let rows: Vec<Row> = rows.iter().filter(|row| row["precision"] == precision).cloned().collect();
        assert_eq!(rows.len(), 66);
        for column in ["forward_relative_error", "inverse_relative_error"] {
            let worst = largest(&rows, column);
            assert!(worst <= goal && worst > least, "{precision} {column}: {worst}");
        }
    }
}

/// What a problem itself makes of the rounding of its numbers is not the model's error.
#[test]
fn errors_near_pull_off_stay_below_what_rounding_makes_of_them() {
    let rows = rows("stability-pulled");
    assert_eq!(rows.len(), 26 * 48);
    for row in &rows {
        // The bound of `PulledContact`.
        let bound = 4e-15 * (number(row, "condition") / 12.0).max(1.0);
        assert!(number(row, "forward_relative_error") <= bound, "{row:?}");
        assert!(number(row, "inverse_relative_error") <= 4e-15, "{row:?}");
    }
    assert!(largest(&rows, "forward_relative_error") > 1e-10 && largest(&rows, "condition") > 1e6);
}

/// The rows of the table on the first screen.
fn answers(page: &str) -> Vec<&str> {
    let table = page.split_once("<table>").unwrap().1.split_once("</table>").unwrap().0;
    assert!(page.find("<table>") < page.find("<nav>"), "it comes first");
    table.trim().lines().collect()
}

#[test]
fn three_questions_are_answered_on_the_first_screen() {
    let page = &report()["index.html"];
    let answers = answers(page);
    assert_eq!(answers.len(), 3);
    for (answer, question, figure, says) in [
        (answers[0], "Error against run time", MEASURED, ["MEASURED here", "16 instructions, estimated 27 cycles"]),
        (answers[1], "Stability on stiff", "stability-f64", ["n = 6.81e6", "of the load before pull-off"]),
        (answers[2], "What is left out", "scene", ["estimated 1529 of 2550 cycles", "250.0 to 380.0 mN at 150 V rms"]),
    ] {
        assert!(answer.contains(&format!("<th>{question}")), "{answer}");
        assert!(answer.contains(&format!("<a href=\"#{figure}\">")), "{answer}");
        for words in says {
            assert!(answer.contains(words), "{words}: {answer}");
        }
    }
}

#[test]
fn a_report_is_about_the_scene_and_the_finger_that_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("two.toml");
    let constant = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.25\n";
    fs::write(&scene, format!("version = 1\n{}", constant.repeat(2))).unwrap();
    let files = made(&folder.path().join("out"), &[&scene.display().to_string(), "--finger", "dry"]);
    let page = &files["index.html"];
    let answer = answers(page)[2];
    assert!(answer.contains("two.toml that are played: 1; layer 1 (constant) is optimised away"), "{answer}");
    assert!(page.matches("Drawn for finger &quot;dry&quot;, assumed: R = ").count() >= 4);
    assert!(!answer.contains("1008 of 1008 bytes"), "a quarter of the reach needs less of the table: {answer}");
    let run = frixel(&[&scene.display().to_string(), "--out", &scene.display().to_string()]);
    assert!(!run.status.success());
}

/// Errors of a method in the order of its sizes.
fn errors(method: &str, load: &str) -> Vec<f64> {
    let rows = rows(MEASURED);
    let of_method = rows.iter().filter(|row| row["method"] == method && row["normal_force_n"] == load);
    of_method.map(|row| number(row, "largest_relative_error")).collect()
}

#[test]
fn every_way_is_as_far_off_as_it_has_to_be() {
    for load in ["0", "0.5"] {
        for (method, goal) in
            [("closed form, f64", 4e-15), ("closed form, f32", 1e-6), ("the board's table, cubic, f32", 1e-5)]
        {
            assert!(errors(method, load).iter().all(|error| *error <= goal && *error > 0.0), "{method} {load}");
        }
        for order in ["linear", "quadratic", "cubic"] {
            for precision in ["f32", "integers"] {
                let errors = errors(&format!("direct table, {order}, {precision}"), load);
                for (error, target) in errors.iter().zip([1e-2, 1e-3, 1e-4, 1e-5, 4e-6]) {
                    assert!(*error <= target, "{order} {precision} {load}: {error} for {target}");
                }
                assert_eq!(errors.len(), 5);
            }
        }
        for method in ["bisection, f64", "forward table, binary search, f32"] {
            let errors = errors(method, load);
            assert!(errors.len() >= 4 && errors.windows(2).all(|pair| pair[1] < pair[0] / 3.0), "{method} {errors:?}");
        }
    }
    // Friction in total cannot resolve the electric part in f32.
    let bisection = |load| errors("bisection, f32", load)[2];
    assert!(bisection("0") < 1e-4 && bisection("0.5") > 1e-2);
    let rows = rows(MEASURED);
    assert!(rows.iter().all(|row| number(row, "measured_run_time_over_f64_closed_form") > 0.0));
}

/// The model's figures are then of the example finger, and what is left out is of the scene's own.
#[test]
fn a_scene_of_an_empirical_finger_has_a_report() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "version = 1\nfinger = { friction_coefficient = 0.4, normal_load_n = 0.5, origin = \"empirical\", date = \
                \"2026-11-23\", method = \"load cell\", screen = \"example\", exponent = 2, points = [[120, 0.09]], \
                intervals_n = [[0.08, 0.1]] }\n[[layer]]\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.05\n";
    fs::write(&scene, text).unwrap();
    let files = made(&folder.path().join("out"), &[&scene.display().to_string()]);
    let page = &files["index.html"];
    for words in
        ["is empirical and has no contact model: these are of the example finger", "Drawn for the example finger"]
    {
        assert!(page.contains(words), "{words}");
    }
    assert!(page.contains("120 V rms"), "the scene's own finger ends there");
}
