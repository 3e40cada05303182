//! Names and numbers of layers, shared mistakes of layers, and limits of drafts and gains.

use super::*;
use crate::{DiagnosticKind, LayerTitle};

const TRACK: &str = "[[layer]]\nname = \"track\"\nkind = \"constant\"\nfriction_fraction = 0.2\n\
    region = { x_mm = 10, y_mm = 10, width_mm = 100, height_mm = 10 }\n";
const EDGE: &str =
    "[[layer]]\nname = \"detent\"\nkind = \"edge\"\nx_mm = 20\ny_mm = 10\nwidth_mm = 2\nridge_fraction = 0.3\n";

/// The number of a layer in messages is the one that `--control` takes.
#[test]
fn a_layer_has_one_number() {
    let layer = |name: &str, more: &str| {
        format!("[[layer]]\n{name}kind = \"constant\"\nfriction_fraction = 0.2\nlive = true\n{more}")
    };
    let copies = "region = { x_mm = 0, y_mm = 0, width_mm = 9, height_mm = 9 }\nrepeat = { columns = 3, dx_mm = 10 }\n";
    let text = format!("{}{}{}", layer("", ""), layer("name = \"key\"\n", copies), layer("", copies));
    let program = compile_text(&format!("version = 1\n{text}{TRACK}live = true\n")).expect("it compiles");
    assert_eq!(program.titles.len(), 8);
    for (record, title) in (0..).zip(&program.titles) {
        assert_eq!(program.layers.records(&title.number().to_string()), Ok(vec![record]), "{title}");
    }
    assert_eq!((program.layers.records("key"), program.layers.records("2")), (Ok(vec![1, 2, 3]), Ok(vec![1, 2, 3])));
    // A name counts before a number.
    let named = compile_text(&format!("version = 1\n{}{TRACK}live = true\n", layer("name = \"2\"\n", ""))).unwrap();
    assert_eq!((named.layers.records("2"), named.layers.records("1")), (Ok(vec![0]), Ok(vec![0])));
    let titles: Vec<&str> = program.titles.iter().map(LayerTitle::as_str).collect();
    assert_eq!(
        titles[4..],
        ["layer 3.1 (constant)", "layer 3.2 (constant)", "layer 3.3 (constant)", "layer 4 \"track\""]
    );
}

/// Both layers have the mistake of the default, and both are absent.
#[test]
fn a_layer_with_a_mistake_that_it_shares_is_no_layer() {
    let text = "version = 1\n[defaults]\ngain = \"loud\"\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.2\n\
        [[layer]]\nkind = \"constant\"\nfriction_fraction = 0.3\n";
    let scene = Scene::parse(text, "test.toml", &BTreeMap::new()).expect("only its layers have mistakes");
    assert_eq!((scene.mistakes().len(), scene.layers.len()), (1, 0));
}

/// A layer off the design's range has its picture on a screen where it is valid.
#[test]
fn a_picture_of_a_layer_that_another_screen_makes_valid_is_played() {
    let text = "version = 1\n[design]\nwidth_px = 1000\nheight_px = 1000\n[[layer]]\nkind = \"bitmap\"\n\
        picture = \"textures/brick.png\"\nx_px = 0\ny_px = 0\nwidth_px = 0.05\nheight_mm = 10\n";
    let scene = Scene::parse(text, "test.toml", &*PICTURES).expect("only its layer has a mistake");
    assert_eq!(scene.mistakes().len(), 1, "{:?}", scene.mistakes());
    let screen = crate::Screen { width_mm: 1000.0, height_mm: 500.0, ..crate::Screen::example() };
    let scene = scene.with_screen(screen, "wide");
    assert_eq!(scene.mistakes().len(), 0, "{:?}", scene.mistakes());
    let program = compile(&scene, &LIMITS, TICK_HZ).expect("it compiles");
    assert_eq!((program.records.len(), program.bitmaps.len()), (1, 1));
}

/// Current above both limits lowers the voltage of a draft once, to the lower one of the two.
#[test]
fn a_draft_keeps_to_the_tighter_limit_of_the_current() {
    let text = "version = 1\n[carrier]\nfrequency_hz = 5000\n[drive]\nvoltage_max_v_rms = 150\n";
    let scene = Scene::parse(text, "test.toml", &BTreeMap::new()).expect("it reads");
    let lowered = |rms: f32, peak: f32| {
        let current_max_a_rms = LIMITS.current_max_a_rms * rms;
        let limits = BoardLimits { current_max_a_rms, current_max_a_peak: LIMITS.current_max_a_peak * peak, ..LIMITS };
        compile_draft(&scene, &limits, TICK_HZ).expect("a draft").reach.voltage_max_v_rms
    };
    let (by_rms, by_peak) = (lowered(0.5, 100.0), lowered(100.0, 0.05));
    let by_both = lowered(0.5, 0.05);
    assert!(by_rms < 149.0 && by_peak < 149.0, "{by_rms} {by_peak}");
    assert!((by_both - by_rms.min(by_peak)).abs() < 1e-3, "{by_both} is not the least of {by_rms} and {by_peak}");
}

/// Settings of a layer while it plays lead out of reach, or do not.
#[test]
fn gains_that_lead_out_of_reach_are_known_with_their_range() {
    use crate::LayerSetting;
    let text = format!("version = 1\n{TRACK}live = true\n{EDGE}live = true\n");
    let program = compile_text(&text).expect("it compiles");
    let settings = |track: f32, is_edge_on: bool| {
        [LayerSetting { on: true, gain: track }, LayerSetting { on: is_edge_on, gain: 1.0 }]
    };
    assert_eq!(program.clamped_with(&settings(1.0, true)), None);
    assert_eq!(program.gains_in_reach(&[0], &settings(1.0, false)), Some((0.0, 5.0)));
    let (least, most) = program.gains_in_reach(&[0], &settings(6.0, true)).expect("there are some");
    assert!(
        least.abs() < 1e-6 && (3.4..=3.6).contains(&most),
        "0.2 of the reach, and an edge of 0.3: {least} to {most}"
    );
    let clamped = program.clamped_with(&settings(-1.0, false)).expect("it is clamped").to_string();
    assert!(clamped.starts_with("layer 1 \"track\" would ask for down to -0.02"), "{clamped}");
    let clamped = program.clamped_with(&settings(4.0, true)).expect("it is clamped").to_string();
    assert!(clamped.starts_with("layer 1 \"track\" and layer 2 \"detent\" would ask for up to 0.14"), "{clamped}");
}

/// Diagnostics about several layers have no layer number.
#[test]
fn a_diagnostic_has_the_number_of_its_layer() {
    let layers_of = |text: &str| {
        let scene = Scene::parse(format!("version = 1\n{text}"), "test.toml", &*PICTURES).expect("it reads");
        let said =
            compile(&scene, &LIMITS, TICK_HZ).map_or_else(|error| error.diagnostics, |program| program.diagnostics);
        said.iter().map(|diagnostic| (diagnostic.kind, diagnostic.layer)).collect::<Vec<_>>()
    };
    let high = TRACK.replace("friction_fraction = 0.2", "friction_n = 0.9");
    let wrong = TRACK.replace("0.2", "\"a\"");
    let added = TRACK.replace("0.2", "0.9\nblend = \"add\"");
    assert_eq!(layers_of(&format!("{TRACK}{high}")), [(DiagnosticKind::Refusal, Some(2))]);
    assert_eq!(layers_of(&format!("{TRACK}{wrong}")), [(DiagnosticKind::Mistake, Some(2))]);
    assert_eq!(layers_of(&format!("{TRACK}{added}")), [(DiagnosticKind::Refusal, None)]);
    assert_eq!(layers_of(&format!("{TRACK}{EDGE}")), [(DiagnosticKind::Warning, Some(2))]);
}
