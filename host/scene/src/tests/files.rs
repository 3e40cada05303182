//! Scenes of several files, and fields that layers share.

use super::*;
use crate::reference::Reference;
use crate::{FileMistake, FileUnavailable, Files, FingerProfile};

const BUTTONS: &str = "version = 2\n\n[defaults]\nrim_width_mm = 2\nrim_fraction = 0.8\nface_fraction = 0.4\n\n\
    [[layer]]\nname = \"back\"\nkind = \"button\"\nregion = { x_mm = 10, y_mm = 60, width_mm = 30, height_mm = 12 }\n";
const SHORT: &str = "version = 2\ninclude = [\"common.toml\"]\n";
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

#[track_caller]
fn check_refused(text: &str, files: &[(&str, &str)], expected: &[&str]) {
    let refused = scene(text, files).and_then(|scene| compile::compile(&scene, &LIMITS, TICK_HZ));
    assert_eq!(refused.expect_err("it is refused").to_string(), expected.join("\n"));
}

#[test]
fn included_layers_lie_below_and_play_as_if_they_stood_here() {
    let apart = program(&format!("{SHORT}{FLAT}"), &[("common.toml", BUTTONS)]);
    let together = program(&format!("{BUTTONS}{FLAT}"), &[]);
    assert_eq!(apart.scene_bytes(), together.scene_bytes());
    assert_eq!(apart.titles, ["layer 1 \"back\"", "layer 2 \"flat\""]);
}

#[test]
fn tables_come_from_any_one_of_the_files() {
    let common = "version = 2\nfinger = \"moist\"\n[drive]\nvoltage_max_v_rms = 100\n";
    let apart = program(&format!("{SHORT}{FLAT}"), &[("common.toml", common)]);
    assert!((apart.reach.natural_friction_n - 0.4).abs() < 1e-6, "{:?}", apart.reach);
    assert_eq!(apart.header.voltage_max_v_rms.to_bits(), 100.0_f32.to_bits());
    check_refused(
        &format!("{SHORT}finger = \"dry\"\n{FLAT}"),
        &[("common.toml", common)],
        &[
            "play/common.toml:2:1: `finger` stands in play/common.toml and in play/scene.toml: a scene has one, so leave \
           one of them out",
        ],
    );
}

#[test]
fn a_layers_own_field_counts_before_the_default_in_any_unit() {
    let defaults = "version = 2\n[defaults]\nfriction_n = 0.26\nregion = { x_mm = 0, y_mm = 0, width_mm = 9, height_mm = 9 }\n\
        low_n = 0.0\nwave = \"square\"\n";
    let layers = "[[layer]]\nkind = \"constant\"\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.1\n\
        region = { x_mm = 20, y_mm = 0, width_mm = 9, height_mm = 9 }\n";
    let written = "version = 2\n[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
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
    let defaults = |friction: &str| format!("version = 2\n[defaults]\nfriction_n = {friction}\n");
    let (one, two) = (defaults("0.26"), defaults("0.27"));
    let files = [("a.toml", one.as_str()), ("b.toml", two.as_str())];
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-6, "{found} and not {expected}");
    close(value("version = 2\ninclude = [\"a.toml\", \"b.toml\"]\n", &files), 0.02);
    close(value("version = 2\ninclude = [\"b.toml\", \"a.toml\"]\n", &files), 0.01);
    let own = "version = 2\ninclude = [\"a.toml\", \"b.toml\"]\n[defaults]\nfriction_n = 0.28\n";
    close(value(own, &files), 0.03);
}

#[test]
fn names_of_files_start_from_the_folder_of_the_file_they_stand_in() {
    let picture = "version = 2\n[[layer]]\nkind = \"bitmap\"\npicture = \"../textures/brick.png\"\nx_mm = 0\ny_mm = 0\n\
        width_mm = 20\n";
    let found = program("version = 2\ninclude = [\"parts/wall.toml\"]\n", &[("parts/wall.toml", picture)]);
    assert_eq!(found.bitmaps.len(), 1);
    let finger = format!("version = 2\nfinger = \"anna.toml\"\n{FLAT}");
    let anna = FingerProfile { friction_coefficient: 0.45, ..FingerProfile::example() }.to_toml();
    let files = [("parts/anna.toml", anna.as_str()), ("parts/all.toml", &finger)];
    let named = program("version = 2\ninclude = [\"./parts/all.toml\"]\n", &files);
    assert!((named.reach.natural_friction_n - 0.225).abs() < 1e-6, "{:?}", named.reach);
}

#[test]
fn includes_that_lead_nowhere_or_in_circles() {
    check_refused(
        "version = 2\ninclude = [\"comon.toml\"]\n",
        &[("common.toml", BUTTONS)],
        &["play/scene.toml:2:12: play/scene.toml includes play/comon.toml, which was not found: names start \
           from the folder of play/scene.toml; did you mean \"common.toml\"?"],
    );
    check_refused(
        "version = 2\ninclude = [\"none.toml\"]\n",
        &[("one.png", ""), ("nine.md", "")],
        &["play/scene.toml:2:12: play/scene.toml includes play/none.toml, which was not found: names start \
           from the folder of play/scene.toml"],
    );
    check_refused(
        "version = 2\ninclude = [\"common.toml\", \"common.toml\"]\n",
        &[("common.toml", BUTTONS)],
        &[
            "play/scene.toml:2:27: play/common.toml is included twice by play/scene.toml: a scene includes each file once, so \
           leave one of them out",
        ],
    );
    check_refused(
        SHORT,
        &[("common.toml", "version = 2\ninclude = [\"scene.toml\"]\n")],
        &[
            "play/common.toml:2:12: play/common.toml includes play/scene.toml, which includes play/common.toml itself: take \
           one of them out",
        ],
    );
    check_refused(
        "version = 2\ninclude = [\"a.toml\", \"common.toml\"]\n",
        &[("common.toml", BUTTONS), ("a.toml", SHORT)],
        &[
            "play/scene.toml:2:22: play/common.toml is included by play/scene.toml and by play/a.toml: a scene includes \
           each file once, so leave one of them out",
        ],
    );
    check_refused(
        "version = 2\ninclude = \"common.toml\"\n",
        &[],
        &["play/scene.toml:2:11: `include` has to be a list of texts in square brackets, and this is a text"],
    );
    check_refused(
        "version = 2\ninclude = [3]\n",
        &[],
        &["play/scene.toml:2:12: `include` has to be a text in quotes, and this is a number"],
    );
}

/// A file that cannot be read, and one that is not text.
struct Odd;

impl Files for Odd {
    fn bytes(&self, name: &str) -> Result<Vec<u8>, FileUnavailable> {
        if name == "latin.toml" { Ok(vec![0xff]) } else { Err(FileUnavailable::Unreadable { reason: "locked".into() }) }
    }
}

#[test]
fn an_included_file_that_cannot_be_used() {
    let refused = |name: &str| {
        let text = format!("version = 2\ninclude = [\"{name}\"]\n");
        Scene::parse(&text, "scene.toml", &Odd).expect_err("it is refused").to_string()
    };
    assert_eq!(
        refused("latin.toml"),
        "scene.toml:2:12: scene.toml includes latin.toml, which cannot be used: this byte is not UTF-8 text: save the \
         file as UTF-8"
    );
    assert_eq!(
        refused("common.toml"),
        "scene.toml:2:12: scene.toml includes common.toml, which cannot be used: it cannot be read (locked)"
    );
}

#[test]
fn a_mistake_is_reported_in_its_own_file() {
    let broken = BUTTONS.replace("height_mm", "hight_mm").replace("rim_width_mm = 2", "rim_width_mm = -2");
    check_refused(
        &format!("{SHORT}\n[[layer]]\nkind = \"constant\"\nfrictoin_n = 0.26\n"),
        &[("common.toml", &broken)],
        &[
            "play/scene.toml:6:1: unknown field `frictoin_n` in layer 2 (constant); did you mean `friction_n`?",
            "play/common.toml:4:16: `rim_width_mm = -2` is out of range: expected 0.01 to 2000 mm",
            "play/common.toml:11:49: unknown field `hight_mm` in this region; did you mean `height_mm`?",
        ],
    );
    check_refused(
        SHORT,
        &[("common.toml", "version = 2\n[defaults\n")],
        &["play/common.toml:2:10: this is not TOML: unclosed table, expected `]`"],
    );
    check_refused(
        SHORT,
        &[("common.toml", &BUTTONS.replace("0.8", "1.0").replace("[defaults]", "[defaults]\nclick_fraction = 0.5"))],
        &[
            "play/common.toml:6:16: layer 1 \"back\", with its `rim_fraction = 1.0` and its `click_fraction = 0.5` together, asks \
             for up to 0.195 N above natural friction (1.5 of the reach), and at 150 V rms this finger feels at most 0.1299 N \
             above natural friction: lower one of them, or write `saturate = true` under [drive] to have it clamped",
        ],
    );
    let scene = scene(SHORT, &[("common.toml", &broken)]).expect("its layers have mistakes, and nothing else");
    let error = compile::compile(&scene, &LIMITS, TICK_HZ).expect_err("it is refused");
    assert!(error.to_json().contains("\"file\":\"play/common.toml\",\"line\":4"), "{}", error.to_json());
}

#[test]
fn what_an_included_file_may_not_have() {
    check_refused(
        SHORT,
        &[("common.toml", FLAT)],
        &["play/common.toml:1:1: play/common.toml has no `version`: write `version = 2` at the top"],
    );
    check_refused(
        SHORT,
        &[("common.toml", "version = 1\n")],
        &["play/common.toml:1:11: play/scene.toml includes play/common.toml, which has version 1 and not 2: `frixel \
           scene migrate play/common.toml` prints it as version 2"],
    );
    check_refused(
        SHORT,
        &[("common.toml", "version = 2\nlayers = []\n")],
        &["play/common.toml:2:1: unknown field `layers` in play/common.toml; did you mean `layer`?"],
    );
    check_refused(
        &format!("{SHORT}{FLAT}"),
        &[("common.toml", &format!("version = 2\n{FLAT}"))],
        &[
            "play/scene.toml:4:8: a layer \"flat\" is in play/scene.toml and in play/common.toml: give one of them another \
           name",
        ],
    );
}

#[test]
fn defaults_that_no_layer_can_have() {
    check_refused(
        "version = 2\n[defaults]\nrim_widht_mm = 2\nname = \"key\"\n",
        &[],
        &[
            "play/scene.toml:3:1: unknown field `rim_widht_mm` in [defaults]; did you mean `rim_width_mm`?",
            "play/scene.toml:4:1: `name` in [defaults] would be the same for every layer: write it in each layer",
        ],
    );
    check_refused(
        "version = 2\ndefaults = 3\n",
        &[],
        &[
            "play/scene.toml:2:12: `defaults` has to be a table, and this is a number: write `[defaults]` on a line of its \
           own, and its fields below it",
        ],
    );
    // A mistake that layers share is said once.
    check_refused(
        "version = 2\n[defaults]\nkind = \"constant\"\ngain = \"loud\"\n[[layer]]\nfriction_n = 0.26\n[[layer]]\n\
         friction_n = 0.26\n",
        &[],
        &["play/scene.toml:4:8: `gain` has to be a number, and this is a text"],
    );
}

#[test]
fn scenes_of_version_one_have_one_file_and_no_defaults() {
    for (line, field) in
        [("include = [\"common.toml\"]", "include"), ("defaults = {}", "defaults"), ("design = {}", "design")]
    {
        let text = HEAD.replace("version = 1\n", &format!("version = 1\n{line}\n"));
        let mistakes = scene(&text, &[("common.toml", BUTTONS)]).expect_err("it is refused").mistakes;
        let [located] = &mistakes[..] else { panic!("{mistakes:?}") };
        assert_eq!(
            located.mistake,
            FileMistake::SinceVersionTwo {
                field: ["include", "defaults", "design"].into_iter().find(|name| *name == field).unwrap(),
                file: "play/scene.toml".to_owned()
            }
            .into()
        );
        let migrated = crate::migrate(&text, "scene.toml", &*PICTURES).expect_err("it is refused").to_string();
        assert!(migrated.contains(&format!("`{field}`")), "{migrated}");
    }
}

/// The schema knows the fields of `[defaults]` and of layers that they complete.
#[test]
fn an_editor_finds_misspelt_defaults() {
    let text = |defaults: &str, layer: &str| format!("version = 2\n[defaults]\n{defaults}\n[[layer]]\n{layer}\n");
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
