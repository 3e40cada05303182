//! Scenes of several files, and fields that layers share.

use super::*;
use crate::reference::Reference;
use crate::{FileUnavailable, Files, LayerTitle};

const BUTTONS: &str = "version = 1\n\n[defaults]\nrim_width_mm = 2\nrim_fraction = 0.8\nface_fraction = 0.4\n\n\
    [[layer]]\nname = \"back\"\nkind = \"button\"\nregion = { x_mm = 10, y_mm = 60, width_mm = 30, height_mm = 12 }\n";
const SHORT: &str = "version = 1\ninclude = [\"common.toml\"]\n";
const FLAT: &str = "[[layer]]\nname = \"flat\"\nkind = \"constant\"\nfriction_fraction = 0.1\n\
    region = { x_mm = 50, y_mm = 0, width_mm = 9, height_mm = 9 }\n";

fn scene(text: &str, files: &[(&str, &str)]) -> Result<Scene, CompileError> {
    let files = files.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec()));
    let mut files: BTreeMap<String, Vec<u8>> = files.collect();
    files.extend(PICTURES.clone());
    let scene = Scene::parse(text, "play/scene.toml", &files);
    schema::check_agrees(text, mistakes(&scene));
    scene
}

fn program(text: &str, files: &[(&str, &str)]) -> Program {
    compile::compile(&scene(text, files).expect("it reads"), &LIMITS, TICK_HZ).expect("it compiles")
}

#[test]
fn included_layers_lie_below_and_play_as_if_they_stood_here() {
    let apart = program(&format!("{SHORT}{FLAT}"), &[("common.toml", BUTTONS)]);
    let together = program(&format!("{BUTTONS}{FLAT}"), &[]);
    assert_eq!(apart.scene_bytes(), together.scene_bytes());
    let titles: Vec<&str> = apart.titles.iter().map(LayerTitle::as_str).collect();
    assert_eq!(titles, ["layer 1 \"back\"", "layer 2 \"flat\""]);
}

/// 30,000 layers of one name took half a minute.
#[test]
fn a_scene_of_too_many_layers_is_one_mistake() {
    let flat = "[[layer]]\nname = \"a\"\nkind = \"constant\"\nfriction_fraction = 0.1\n";
    let copies = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.1\n\
        region = { x_mm = 1, y_mm = 1, width_mm = 9, height_mm = 9 }\n\
        repeat = { columns = 64, rows = 64, dx_mm = 0.1, dy_mm = 0.1 }\n";
    for (layers, found) in [(flat.repeat(30_000), 30_000), (copies.repeat(2), 8_192)] {
        let error = Scene::parse(format!("version = 1\n{layers}"), "scene.toml", &BTreeMap::new());
        let mistakes = error.map_or_else(|error| error.diagnostics, |scene| scene.mistakes().to_vec());
        let [mistake] = &mistakes[..] else { panic!("{}", mistakes.len()) };
        let says = format!("there are {found} layers in this scene, and at most 4096 are read: no board supports ");
        assert!(mistake.message.to_string().starts_with(&says), "{mistake}");
    }
    let scene = Scene::parse(format!("version = 1\n{}", flat.repeat(4_096)), "scene.toml", &BTreeMap::new());
    assert!(scene.expect("it reads").mistakes().is_empty());
}

#[test]
fn names_of_100_000_characters_are_not_echoed_whole() {
    let long = "\u{e9}".repeat(100_000);
    let texts = [
        format!("[[layer]]\nkind = \"{long}\"\n"),
        format!("\"{long}\" = 1\n"),
        format!("[defaults]\n\"{long}\" = 1\n"),
        format!("{FLAT}\"{long}\" = 1\n"),
        format!("{FLAT}blend = \"{long}\"\n"),
        format!("include = [\"{long}.toml\"]\n"),
        format!("include = [\"{long}/\"]\n"),
        format!("finger = \"{long}\"\n"),
        format!("screen = \"{long}.toml\"\n"),
    ];
    for text in texts {
        let scene = scene(&format!("version = 1\n{text}"), &[]);
        let said: Vec<String> = mistakes(&scene).iter().map(|located| located.message.to_string()).collect();
        let lens: Vec<usize> = said.iter().map(String::len).collect();
        let shown: String = text.chars().filter(|character| *character != '\u{e9}').collect();
        assert!(said.iter().any(|sentence| sentence.contains('\u{2026}')), "{shown}: {lens:?}");
        assert!(lens.iter().all(|len| *len < 2_000), "{lens:?}");
    }
}

#[test]
fn a_layers_own_field_counts_before_the_default_in_any_unit() {
    let defaults = "version = 1\n[defaults]\nfriction_n = 0.26\nregion = { x_mm = 0, y_mm = 0, width_mm = 9, height_mm = 9 }\n\
        low_n = 0.0\nwave = \"square\"\n";
    let layers = "[[layer]]\nkind = \"constant\"\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.1\n\
        region = { x_mm = 20, y_mm = 0, width_mm = 9, height_mm = 9 }\n";
    let written = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
        region = { x_mm = 0, y_mm = 0, width_mm = 9, height_mm = 9 }\n[[layer]]\nkind = \"constant\"\n\
        friction_fraction = 0.1\nregion = { x_mm = 20, y_mm = 0, width_mm = 9, height_mm = 9 }\n";
    assert_eq!(program(&format!("{defaults}{layers}"), &[]).scene_bytes(), program(written, &[]).scene_bytes());
}

#[test]
fn the_nearest_default_counts_and_of_several_files_the_last_one() {
    let value = |text: &str, files: &[(&str, &str)]| {
        let program = program(&format!("{text}[[layer]]\nkind = \"constant\"\n"), files);
        Reference::new(&program).electric_friction_n(0.01, 0.01)
    };
    let defaults = |friction: &str| format!("version = 1\n[defaults]\nfriction_n = {friction}\n");
    let (one, two) = (defaults("0.26"), defaults("0.27"));
    let files = [("a.toml", one.as_str()), ("b.toml", two.as_str())];
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-6, "{found} and not {expected}");
    close(value("version = 1\ninclude = [\"a.toml\", \"b.toml\"]\n", &files), 0.02);
    close(value("version = 1\ninclude = [\"b.toml\", \"a.toml\"]\n", &files), 0.01);
    let own = "version = 1\ninclude = [\"a.toml\", \"b.toml\"]\n[defaults]\nfriction_n = 0.28\n";
    close(value(own, &files), 0.03);
}

/// A file that cannot be read.
struct Locked;

impl Files for Locked {
    fn bytes(&self, _name: &str) -> Result<Vec<u8>, FileUnavailable> {
        Err(FileUnavailable::Unreadable { reason: "locked".into() })
    }
}

#[test]
fn an_included_file_that_cannot_be_read_is_named_with_the_reason() {
    let refused = Scene::parse(SHORT, "scene.toml", &Locked).expect_err("it is refused");
    assert_eq!(
        refused.to_string(),
        "scene.toml:2:12: scene.toml includes common.toml, which cannot be used: it cannot be read (locked)"
    );
}

/// The schema knows the fields of `[defaults]` and of layers that they complete.
#[test]
fn an_editor_finds_misspelt_defaults() {
    let text = |defaults: &str, layer: &str| format!("version = 1\n[defaults]\n{defaults}\n[[layer]]\n{layer}\n");
    for (defaults, layer, right) in [
        ("kind = \"button\"\nrim_width_mm = 2", "rim_n = 0.01\nface_n = 0.0", true),
        ("kind = \"buton\"", "", false),
        ("rim_widht_mm = 2", "kind = \"button\"", false),
        ("gain = \"loud\"", "kind = \"button\"", false),
        ("name = \"key\"", "kind = \"button\"", false),
        ("gain = 1", "kind = \"button\"\nrim_widht_mm = 2", false),
    ] {
        assert_eq!(schema::takes_text(&text(defaults, layer)), right, "{defaults}\n{layer}");
    }
}
