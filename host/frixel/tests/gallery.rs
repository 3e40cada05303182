//! Every scene of `scenes/` plays on the simulator, and `docs/design/gallery.md` shows it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fmt::Write;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};

use frixel::output::draw_preview_png;
use frixel::scene_file;
use frixel_felt::Preview;
use frixel_felt::judge::{Advice, LayerVerdict, Verdict};
use frixel_felt::recorder::FeltRow;
use frixel_hil_sim::{BoardMemory, FingerState, RigConfig, Stroke, WorldOptions};
use frixel_lab::simulate::default_stroke;
use frixel_layers::{Header, Scene as WireScene};
use frixel_play::{Simulation, TO_THE_END, judge, simulate};
use frixel_scene::reference::{Context, Reference, direction_of};
use frixel_scene::{FingerProfile, Profile, Program, Scene, TargetRange, compile};
use frixel_testkit::golden;
use frixel_wire::fault::Flags;

use crate::processes::repository;

const PICTURE_BYTES_MAX: u64 = 40 * 1024;
/// How much the felt friction has to vary along a stroke over a scene, as a part of what the drive can add.
const FELT_PART_MIN: f64 = 0.1;

struct Entry {
    name: String,
    text: String,
    scene: Scene,
    program: Program,
}

fn gallery() -> Vec<Entry> {
    let rig = RigConfig::default();
    let paths = fs::read_dir(repository().join("scenes")).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    scenes.sort();
    let entries = scenes.iter().map(|path| {
        let scene = scene_file::load(path).unwrap();
        Entry {
            name: path.file_stem().unwrap().to_string_lossy().into_owned(),
            text: fs::read_to_string(path).unwrap(),
            program: compile(&scene, &rig.board.limits, rig.board.tick_hz).unwrap_or_else(|error| panic!("{error}")),
            scene,
        }
    });
    entries.collect()
}

/// Lines of a comment as a paragraph.
fn paragraph<'t>(lines: impl Iterator<Item = &'t str>) -> String {
    lines.map(str::trim).collect::<Vec<_>>().join(" ")
}

impl Entry {
    /// The comment that the file begins with: what a finger meets.
    fn headline(&self) -> String {
        paragraph(self.text.lines().map_while(|line| line.strip_prefix('#')))
    }

    /// The comment that the file begins with, and the one that it ends with, as a paragraph.
    fn comment(&self) -> String {
        let mut last: Vec<&str> = self.text.lines().rev().map_while(|line| line.strip_prefix('#')).collect();
        last.reverse();
        format!("{} {}", self.headline(), paragraph(last.into_iter()))
    }

    /// Verdicts on the layers under a bundled finger.
    fn judged(&self, finger: &str) -> Vec<LayerVerdict> {
        let rig = RigConfig::default();
        let scene = self.scene.clone().with_finger(FingerProfile::bundled(finger).unwrap(), finger);
        let program = compile(&scene, &rig.board.limits, rig.board.tick_hz)
            .unwrap_or_else(|error| panic!("under the {finger} finger: {error}"));
        judge(&program, &rig, &WorldOptions::default(), Advice::Omitted, TO_THE_END).unwrap().layers
    }
}

/// Number of layers by verdict, such as `3 felt, 1 maybe`.
pub(crate) fn verdict_counts(layers: &[LayerVerdict]) -> String {
    let counts = [Verdict::Felt, Verdict::Maybe, Verdict::NotFelt, Verdict::Unknown].map(|verdict| {
        let count = layers.iter().filter(|layer| layer.verdict == verdict).count();
        (count > 0).then(|| format!("{count} {}", verdict.words()))
    });
    counts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// A layer is touched if the reference friction at some place of the stroke is another without it.
#[test]
fn the_default_stroke_touches_every_layer() {
    for Entry { name, program, .. } in &gallery() {
        let stroke = default_stroke(program, None).unwrap();
        let places: Vec<_> = (0..10_000).filter_map(|step| stroke.at(1e-3 * f64::from(step))).collect();
        let frictions_n = |program: &Program| -> Vec<f64> {
            let reference = Reference::new(program).with_vibrations_held();
            let friction_n = |[before, place]: &[FingerState; 2]| {
                let FingerState { x_m, y_m, speed_m_per_s } = *place;
                let direction = direction_of([x_m - before.x_m, y_m - before.y_m]);
                reference.electric_friction_at_n(&Context { x_m, y_m, speed_m_per_s, direction, ..Context::default() })
            };
            places.array_windows().map(friction_n).collect()
        };
        let whole_n = frictions_n(program);
        for (number, title) in program.titles.iter().enumerate() {
            let mut without = program.clone();
            without.records.remove(number);
            let without_n = frictions_n(&without);
            let largest_n = whole_n.iter().zip(&without_n).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
            assert!(largest_n > 1e-3, "{name}: {title} is not touched");
        }
    }
}

#[test]
fn every_scene_is_felt_without_a_fault_and_within_reach() {
    let gallery = gallery();
    assert!(gallery.len() >= 8, "{}", gallery.len());
    for Entry { name, text, program, .. } in &gallery {
        let rig = RigConfig::default();
        let (width_m, height_m) = (program.header.screen_width_m.into(), program.header.screen_height_m.into());
        let stroke = Stroke::sweep(width_m, height_m, 2.0).unwrap();
        let simulation =
            Simulation { rig, seconds: stroke.duration_s(), stroke, seed: 1, ticks_per_row: 40, through_finger: false };
        let simulated =
            simulate(program, &simulation, None, TO_THE_END).unwrap_or_else(|error| panic!("{name}: {error}"));
        let rows = simulated.recorder.rows();
        let felt =
            rows.iter().filter_map(|row| row.felt_n.filter(|_| row.speed_mm_s.is_some_and(|speed| speed > 20.0)));
        let (least_n, most_n) =
            felt.fold((f64::INFINITY, 0.0_f64), |(least, most), felt_n| (least.min(felt_n), most.max(felt_n)));
        let part = (most_n - least_n) / program.reach.electric_friction_max_n;
        assert!(part > FELT_PART_MIN, "{name}: felt from {least_n} to {most_n} N");
        let flags = rows.iter().filter_map(|row| row.flags);
        assert!(flags.clone().count() > 1_000, "{name}");
        if !text.contains("saturate = true") {
            let TargetRange { above, below, most_n, .. } = TargetRange::of(program);
            assert_eq!((above.screen_percent, below.screen_percent), (0.0, 0.0), "{name}");
            // One that asks for all of the reach may round to a last bit more.
            let all = most_n > (1.0 - 1e-6) * program.reach.friction_max_n();
            assert!(all || flags.clone().all(|flags| !flags.contains(Flags::SATURATED)), "{name} saturates");
        }
        // A fault would have ended the play, and the drive with it.
        let wants = |row: &&FeltRow| {
            let friction_n = row.reference_n.filter(|_| row.speed_mm_s.is_some_and(|speed| speed > 20.0));
            friction_n.is_some_and(|friction_n| friction_n > program.reach.natural_friction_n + 1e-3)
        };
        let drives = |row: &&FeltRow| row.voltage_v_rms.is_some_and(|voltage_v_rms| voltage_v_rms > 1.0);
        let last =
            rows.iter().rfind(wants).zip(rows.iter().rfind(drives)).map(|(wanted, driven)| wanted.t_s - driven.t_s);
        assert!(last.is_some_and(|late_s| late_s < 0.05), "{name}: the drive ends {last:?} s early");
    }
}

/// The compiler says the largest friction that the scene asks for, and the board ends its table there. What is felt is
/// the same to the last bit as with the whole table.
#[test]
fn no_scene_is_felt_otherwise_because_its_table_is_cut() {
    let mut cut = 0;
    for Entry { name, program, .. } in &gallery() {
        let rig = RigConfig::default();
        let bytes = program.scene_bytes();
        let table = BoardMemory::table_rows(&WireScene::parse(&bytes).unwrap(), &rig.board).unwrap();
        if table.filled == table.whole {
            continue;
        }
        cut += 1;
        let (width_m, height_m) = (program.header.screen_width_m.into(), program.header.screen_height_m.into());
        let stroke = Stroke::sweep(width_m, height_m, 1.0).unwrap();
        let simulation =
            Simulation { rig, seconds: stroke.duration_s(), stroke, seed: 1, ticks_per_row: 10, through_finger: false };
        let whole = Program { header: Header { electric_friction_max_n: None, ..program.header }, ..program.clone() };
        let [with_cut, without] = [program, &whole].map(|program| {
            let simulated =
                simulate(program, &simulation, None, TO_THE_END).unwrap_or_else(|error| panic!("{name}: {error}"));
            simulated.recorder.rows().to_vec()
        });
        assert!(program.header.electric_friction_max_n.is_some() && with_cut == without, "{name}");
        assert!(
            with_cut.iter().any(|row| row.voltage_v_rms.is_some_and(|voltage_v_rms| voltage_v_rms > 1.0)),
            "{name}"
        );
    }
    assert!(cut > 0);
}

/// The first comment of a scene is one plain sentence; the rest stands below the layers.
#[test]
fn every_scene_begins_with_one_plain_sentence_of_at_most_100_characters() {
    for entry in gallery() {
        let headline = entry.headline();
        assert!(headline.chars().count() <= 100, "{}: {headline}", entry.name);
        assert!(headline.ends_with('.') && !headline.contains(". "), "{}: one sentence: {headline}", entry.name);
        assert!(!headline.contains(['`', ';', '(']), "{}: plain words: {headline}", entry.name);
        assert!(headline.split(' ').count() >= 6, "{}: {headline}", entry.name);
    }
}

#[test]
fn every_scene_says_what_it_feels_like_and_what_is_assumed() {
    for entry in gallery() {
        let comment = entry.comment();
        let sentences = comment.matches(". ").count() + 1;
        assert!(comment.len() > 80 && sentences >= 2, "{}: {comment}", entry.name);
        assert!(comment.contains("Assumed"), "{} does not say what is assumed", entry.name);
        assert!(comment.contains(" person "), "{} does not say what a person would feel", entry.name);
        assert!(comment.to_lowercase().contains("sure: "), "{} does not say how sure that is", entry.name);
    }
}

/// Size and pixels of a picture.
fn decoded(path: &Path) -> (u32, u32, Vec<u8>) {
    let file = File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap();
    bytes.truncate(frame.buffer_size());
    (frame.width, frame.height, bytes)
}

/// A paragraph in lines of at most 120 characters.
fn lines(paragraph: &str) -> String {
    let mut width = 0;
    let words = paragraph.split(' ').map(|word| {
        let length = word.chars().count();
        let separator = match width {
            0 => "",
            width if width + 1 + length > 120 => "\n",
            _ => " ",
        };
        width = if separator == " " { width + 1 + length } else { length };
        [separator, word].concat()
    });
    words.collect()
}

fn page(gallery: &[Entry]) -> String {
    let mut page = "# Gallery\n\nScenes to start from: copy one, change it, look at it with `frixel preview`, play it \
                    with `frixel play`. After\n`cargo xtask studio`, [gallery/index.html](gallery/index.html) lets you \
                    slide over them in a browser. The pictures are\nmade by `FRIXEL_BLESS=1 cargo test -p frixel --test \
                    main gallery`, and the same test plays every scene on the\nsimulator.\n"
        .to_owned();
    page.push_str(
        "\n## What is felt\n\nThe verdicts of `frixel check` on the layers of each scene, under each bundled finger. \
         All four fingers are assumed;\n[scenes.md](scenes.md#fingers-and-screens) has their numbers.\n\n| scene |",
    );
    for finger in FingerProfile::bundled_names() {
        let _ = write!(page, " {finger} |");
    }
    page.push_str("\n|---|---|---|---|---|\n");
    for entry in gallery {
        let _ = write!(page, "| [{0}](#{0}) |", entry.name);
        for finger in FingerProfile::bundled_names() {
            let judged = entry.judged(finger);
            let is_felt = finger != "example" || judged.iter().any(|layer| layer.verdict == Verdict::Felt);
            assert!(is_felt, "nothing of {} is felt by the example finger", entry.name);
            let _ = write!(page, " {} |", verdict_counts(&judged));
        }
        page.push('\n');
    }
    for entry in gallery {
        let name = &entry.name;
        let _ = write!(
            page,
            "\n## {name}\n\n{}\n\n[scenes/{name}.toml](../../scenes/{name}.toml)\n\n\
             ![friction map of {name}.toml](gallery/{name}.png)\n",
            lines(&entry.comment())
        );
    }
    page
}

/// The document with the element, with a section for each scene.
fn with_sections(document: &str, gallery: &[Entry]) -> String {
    let [first, end] = ["    <section>\n", "</section>\n"];
    let (Some(begin), Some(last)) = (document.find(first), document.rfind(end)) else {
        panic!("docs/design/gallery/index.html has no section")
    };
    let mut sections = String::new();
    for entry in gallery {
        let Entry { name, .. } = entry;
        let _ = write!(
            sections,
            "{first}      <h2>{}</h2>\n      <p>{}</p>\n      <frixel-scene scene=\"{name}\"><img src=\"{name}.png\" \
             alt=\"Friction map of {name}.toml\" /></frixel-scene>\n    {end}",
            name.replace('_', " "),
            entry.headline()
        );
    }
    [&document[..begin], &sections, &document[last + end.len()..]].concat()
}

#[test]
fn the_gallery_in_the_docs_shows_these_scenes() {
    let gallery = gallery();
    let docs = repository().join("docs/design");
    let drawn_in = tempfile::tempdir().unwrap();
    let held_in = docs.join("gallery");
    golden::hold(&docs.join("gallery.md"), &page(&gallery));
    for Entry { name, program, .. } in &gallery {
        let file = format!("{name}.png");
        let (drawn, held) = (drawn_in.path().join(&file), held_in.join(&file));
        let preview = Preview { map_max: (400, 400), ..Preview::default() };
        fs::write(&drawn, draw_preview_png(&format!("{name}.toml"), program, &preview).unwrap()).unwrap();
        if golden::is_blessing() {
            fs::copy(&drawn, &held).unwrap();
        }
        assert!(decoded(&drawn) == decoded(&held), "{} differs. {}", held.display(), golden::how_to_bless());
        assert!(fs::metadata(&held).unwrap().len() <= PICTURE_BYTES_MAX, "{}", held.display());
    }
    let held = fs::read_dir(&held_in).unwrap().map(|entry| entry.unwrap().path());
    let pictures = held.filter(|path| path.extension().is_some_and(|ending| ending == "png")).count();
    assert_eq!(pictures, gallery.len(), "docs/design/gallery has pictures of no scene");
    let document = held_in.join("index.html");
    golden::hold(&document, &with_sections(&fs::read_to_string(&document).unwrap(), &gallery));
}
