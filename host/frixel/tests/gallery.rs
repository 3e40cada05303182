//! Every scene of `scenes/` is felt on the simulator, as `docs/design/gallery.md` shows it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fmt::Write;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};

use frixel::output::draw_preview_png;
use frixel_felt::Preview;
use frixel_felt::judge::{Advice, LayerVerdict, Verdict};
use frixel_hil_sim::{RigConfig, WorldOptions};
use frixel_lab::input::SceneFolder;
use frixel_play::{TO_THE_END, judge};
use frixel_scene::{FingerProfile, Profile, Program, Scene, compile};
use frixel_testkit::golden;

use crate::processes::repository;

const PICTURE_BYTES_MAX: u64 = 40 * 1024;

struct Entry {
    name: String,
    text: String,
    scene: Scene,
    program: Program,
}

/// Names and texts of the scenes, sorted.
pub(crate) fn scenes() -> Vec<(String, String)> {
    let paths = fs::read_dir(repository().join("scenes")).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    paths.sort();
    let scene =
        |path: &PathBuf| (path.file_stem().unwrap().to_string_lossy().into_owned(), fs::read_to_string(path).unwrap());
    paths.iter().map(scene).collect()
}

fn gallery() -> Vec<Entry> {
    let rig = RigConfig::default();
    let entries = scenes().into_iter().map(|(name, text)| {
        let scene = Scene::parse(&text, &name, &SceneFolder(repository().join("scenes"))).unwrap();
        let program = compile(&scene, &rig.board.limits, rig.board.tick_hz).unwrap_or_else(|error| panic!("{error}"));
        Entry { name, text, scene, program }
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
pub(crate) fn decoded(path: &Path) -> (u32, u32, Vec<u8>) {
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
