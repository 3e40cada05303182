//! Warnings of layers that their author probably means otherwise, and mistakes that layers share.

use super::*;
use crate::Warning;

fn warnings(layers: &str) -> Vec<String> {
    let program = compile_text(&format!("version = 2\n{layers}")).expect("it compiles");
    program.warnings.iter().map(ToString::to_string).collect()
}

const TRACK: &str = "[[layer]]\nname = \"track\"\nkind = \"constant\"\nfriction_fraction = 0.2\n\
    region = { x_mm = 10, y_mm = 10, width_mm = 100, height_mm = 10 }\n";
const EDGE: &str =
    "[[layer]]\nname = \"detent\"\nkind = \"edge\"\nx_mm = 20\ny_mm = 10\nwidth_mm = 2\nridge_fraction = 0.3\n";

#[test]
fn an_edge_that_crosses_the_whole_screen_is_pointed_out_once() {
    let repeated = format!("{EDGE}repeat = {{ columns = 3, dx_mm = 8 }}\n");
    assert_eq!(
        warnings(&format!("{TRACK}{repeated}")),
        [
            "layer 2.1 \"detent 1\" has no `region`, so that its line crosses the whole screen: give it one to end the line \
             there"
        ]
    );
    let region = "region = { x_mm = 19, y_mm = 10, width_mm = 2, height_mm = 10 }\n";
    assert_eq!(warnings(&format!("{TRACK}{EDGE}{region}")), Vec::<String>::new());
    assert_eq!(warnings(EDGE), Vec::<String>::new(), "a scene of one line means it");
}

/// The fields of an edge are a place on the screen, not in the region.
#[test]
fn an_edge_whose_line_misses_its_region_is_pointed_out() {
    let region = "region = { x_mm = 30, y_mm = 10, width_mm = 20, height_mm = 20 }\n";
    let warned = warnings(&format!("{EDGE}{region}"));
    assert_eq!(
        warned,
        [
            "layer 1 \"detent\": its line lies 10 mm outside of its `region`, so that nobody crosses it: move `x_mm` and \
             `y_mm`, which are a place on the screen, or the region"
        ]
    );
    assert_eq!(warnings(&format!("{EDGE}{region}repeat = {{ columns = 2, dx_mm = 30 }}\n")).len(), 1);
    // Turned by 90 degrees the line runs along the region's top side, and turned by 45 through its corner.
    for harmless in ["angle_deg = 90\n", "angle_deg = -45\n", "angle_deg = 45\n"] {
        let expected = usize::from(harmless == "angle_deg = 45\n");
        assert_eq!(warnings(&format!("{EDGE}{region}{harmless}")).len(), expected, "{harmless}");
    }
}

#[test]
fn a_layer_that_hides_everything_below_it_is_pointed_out() {
    let plate = "[[layer]]\nname = \"plate\"\nkind = \"vibration\"\nfrequency_hz = 80\nlow_n = 0\nhigh_n = 0.01\n";
    assert_eq!(
        warnings(&format!("{TRACK}{plate}")),
        [
            "layer 2 \"plate\" has no `region`, so that it replaces layer 1 \"track\" on the whole screen: give it a `region`, \
             or a `blend` such as \"add\""
        ]
    );
    assert_eq!(
        warnings(&format!("{TRACK}{plate}live = true\n")),
        [
            "layer 2 \"plate\" has no `region`, so that it replaces layer 1 \"track\" on the whole screen while it is on: give \
             it a `region`, or a `blend` such as \"add\""
        ]
    );
    let ping = plate.replace("plate", "ping") + "live = true\n";
    assert_eq!(warnings(&format!("{TRACK}{plate}{ping}")).len(), 2, "one hides for good, one while it is on");
    assert_eq!(warnings(&format!("{TRACK}{ping}{plate}")).len(), 1, "what is hidden for good hides nothing");
    for harmless in ["blend = \"add\"\n", "region = { x_mm = 0, y_mm = 0, width_mm = 9, height_mm = 9 }\n"] {
        assert_eq!(warnings(&format!("{TRACK}{plate}{harmless}")), Vec::<String>::new(), "{harmless}");
    }
    assert_eq!(warnings(&format!("{plate}{TRACK}")), Vec::<String>::new(), "below the others it hides nothing");
    let picture = "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 20\n";
    assert_eq!(warnings(&format!("{TRACK}{picture}")), Vec::<String>::new(), "a picture has an outline");
}

#[test]
fn two_layers_of_one_name_are_pointed_out_with_the_one_that_counts() {
    let at = |x_mm: u32, name: &str| {
        format!(
            "[[layer]]\nname = \"{name}\"\nkind = \"constant\"\nfriction_fraction = 0.2\nlive = true\n\
             region = {{ x_mm = {x_mm}, y_mm = 0, width_mm = 9, height_mm = 9 }}\n"
        )
    };
    let twice = format!("{}{}{}", at(0, "a"), at(10, "b"), at(20, "a"));
    assert_eq!(
        warnings(&twice),
        [
            "layer 3 \"a\" has the name of layer 1, which is the one that `--control` changes by this name: give it another \
             name, or call it 3"
        ]
    );
    let program = compile_text(&format!("version = 2\n{twice}")).expect("it compiles");
    assert_eq!((program.layers.record("a"), program.layers.record("3")), (Ok(0), Ok(2)));
    let keys = |y_mm: u32| {
        at(0, "key").replace("y_mm = 0", &format!("y_mm = {y_mm}")) + "repeat = { columns = 3, dx_mm = 10 }\n"
    };
    let copies = compile_text(&format!("version = 2\n{}{}", keys(0), keys(20))).expect("it compiles").warnings;
    let [Warning::NameTwice { number, lower, .. }] = &copies[..] else { panic!("{copies:?}") };
    assert_eq!((number.as_str(), lower.as_str()), ("2.1", "1.1"));
}

/// The number of a layer in messages is the one that `--control` takes.
#[test]
fn a_layer_has_one_number() {
    let layer = |name: &str, more: &str| {
        format!("[[layer]]\n{name}kind = \"constant\"\nfriction_fraction = 0.2\nlive = true\n{more}")
    };
    let copies = "region = { x_mm = 0, y_mm = 0, width_mm = 9, height_mm = 9 }\nrepeat = { columns = 3, dx_mm = 10 }\n";
    let text = format!("{}{}{}", layer("", ""), layer("name = \"key\"\n", copies), layer("", copies));
    let program = compile_text(&format!("version = 2\n{text}{TRACK}live = true\n")).expect("it compiles");
    assert_eq!(program.titles.len(), 8);
    for (record, title) in (0..).zip(&program.titles) {
        let number = title.split(' ').nth(1).expect("a number");
        assert_eq!(program.layers.record(number), Ok(record), "{title}");
    }
    assert_eq!(
        program.titles[4..],
        ["layer 3.1 (constant)", "layer 3.2 (constant)", "layer 3.3 (constant)", "layer 4 \"track\""]
    );
}

/// Both layers have the mistake of the default, and both are absent.
#[test]
fn a_layer_with_a_mistake_that_it_shares_is_no_layer() {
    let text = "version = 2\n[defaults]\ngain = \"loud\"\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.2\n\
        [[layer]]\nkind = \"constant\"\nfriction_fraction = 0.3\n";
    let scene = Scene::parse(text, "test.toml", &BTreeMap::new()).expect("only its layers have mistakes");
    assert_eq!((scene.mistakes().len(), scene.layers.len()), (1, 0));
}

#[test]
fn defaults_are_checked_whether_a_layer_uses_them_or_not() {
    let refused = |defaults: &str| {
        let text = format!("version = 2\n[defaults]\n{defaults}\n{TRACK}");
        let refused = compile_text(&text).expect_err("it is refused");
        refused.mistakes.iter().map(|located| format!("{}: {}", located.line, located.mistake)).collect::<Vec<_>>()
    };
    for (defaults, mistake) in [
        ("face_fraction = 30", "3: `face_fraction = 30` is out of range: expected -1 to 1"),
        ("low_factor = \"a\"", "3: `low_factor` has to be a number, and this is a text"),
        ("wave = \"squre\"", "3: `wave = \"squre\"` is not known; did you mean `square`?"),
        ("kind = \"buton\"", "3: `kind = \"buton\"` is not known; did you mean `button`?"),
        ("burst = { period_ms = 10 }", "3: this burst has no `on_ms`: add it"),
        (
            "repeat = 3",
            "3: `repeat` has to be a table, and this is a number: write `repeat = { columns = 3, dx_mm = 10 }`, with \
            the distance from a copy to the next",
        ),
    ] {
        assert_eq!(refused(defaults), [mistake], "{defaults}");
    }
    let text = format!(
        "version = 2\n[defaults]\nregion = {{ x_mm = 0, y_mm = 0, width_mm = 9, height_mm = 9 }}\n\
         [[layer]]\nkind = \"constant\"\nfriction_fraction = 0\nregion = {{ x_mm = 1, y_mm = 0, width_mm = 9 }}\n{TRACK}"
    );
    assert_eq!(
        compile_text(&text).expect_err("it is refused").to_string(),
        "test.toml:7:10: this region, which replaces the default as a whole, has no `height_mm`: add it"
    );
    // A blend that one kind does not have is right for the others.
    let text = format!("version = 2\n[defaults]\nblend = \"add\"\nfactors = [0, 1]\nabove = \"natural\"\n{TRACK}");
    compile_text(&text).expect("it is right");
}

/// A layer off the design's range has its picture on a screen where it is valid.
#[test]
fn a_picture_of_a_layer_that_another_screen_makes_valid_is_played() {
    let text = "version = 2\n[design]\nwidth_px = 1000\nheight_px = 1000\n[[layer]]\nkind = \"bitmap\"\n\
        picture = \"textures/brick.png\"\nx_px = 0\ny_px = 0\nwidth_px = 0.05\nheight_mm = 10\n";
    let scene = Scene::parse(text, "test.toml", &*PICTURES).expect("only its layer has a mistake");
    assert_eq!(scene.mistakes().len(), 1, "{:?}", scene.mistakes());
    let screen = crate::Screen { width_mm: 1000.0, height_mm: 500.0, ..crate::Screen::example() };
    let scene = scene.with_screen(screen, "wide").expect("it is of version 2");
    assert_eq!(scene.mistakes().len(), 0, "{:?}", scene.mistakes());
    let program = compile(&scene, &LIMITS, TICK_HZ).expect("it compiles");
    assert_eq!((program.records.len(), program.bitmaps.len()), (1, 1));
}

/// Current above both limits lowers the voltage of a draft once, to the lower one of the two.
#[test]
fn a_draft_keeps_to_the_tighter_limit_of_the_current() {
    let text = "version = 2\n[carrier]\nfrequency_hz = 5000\n[drive]\nvoltage_max_v_rms = 150\n";
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
    let text = format!("version = 2\n{TRACK}live = true\n{EDGE}live = true\n");
    let program = compile_text(&text).expect("it compiles");
    let settings = |track: f32, is_edge_on: bool| {
        [LayerSetting { on: true, gain: track }, LayerSetting { on: is_edge_on, gain: 1.0 }]
    };
    assert_eq!(program.clamped_with(&settings(1.0, true)), None);
    assert_eq!(program.gains_in_reach(0, &settings(1.0, false)), Some((0.0, 5.0)));
    let (least, most) = program.gains_in_reach(0, &settings(6.0, true)).expect("there are some");
    assert!(
        least.abs() < 1e-6 && (3.4..=3.6).contains(&most),
        "0.2 of the reach, and an edge of 0.3: {least} to {most}"
    );
    let clamped = program.clamped_with(&settings(-1.0, false)).expect("it is clamped").to_string();
    assert!(clamped.starts_with("layer 1 \"track\" would ask for down to -0.02"), "{clamped}");
    let clamped = program.clamped_with(&settings(4.0, true)).expect("it is clamped").to_string();
    assert!(clamped.starts_with("layer 1 \"track\" and layer 2 \"detent\" would ask for up to 0.14"), "{clamped}");
}
