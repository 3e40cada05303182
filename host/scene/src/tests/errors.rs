//! Tests the message and the line of every mistake.

use proptest::prelude::*;

use super::*;

/// Line of the first layer's `[[layer]]`.
const FIRST: usize = 19;

fn message(text: &str) -> String {
    compile_text(text).expect_err("it is wrong").to_string()
}

/// Compiles the head and these layers, and compares the message with lines of `line:column: sentence`. Lines are
/// counted from the first line of the first layer, which is 1.
#[track_caller]
fn check_layers(layers: &str, expected: &[(usize, usize, &str)]) {
    let expected: Vec<String> = expected
        .iter()
        .map(|(line, column, sentence)| format!("test.toml:{}:{column}: {sentence}", FIRST + line - 1))
        .collect();
    assert_eq!(message(&format!("{HEAD}{layers}")), expected.join("\n"));
}

/// Replaces a piece of the head, and compares the message.
#[track_caller]
fn check_head(piece: &str, by: &str, expected: &str) {
    assert!(HEAD.contains(piece), "{piece}");
    assert_eq!(message(&HEAD.replace(piece, by)), expected);
}

#[test]
fn the_head_ends_where_the_tests_think() {
    assert_eq!(HEAD.lines().count() + 1, FIRST);
    compile_text(HEAD).expect("a scene without layers is bare glass");
}

#[test]
fn syntax() {
    check_head("[screen]", "[screen", "test.toml:3:8: this is not TOML: unclosed table, expected `]`");
    check_head(
        "120",
        "120 mm",
        "test.toml:4:12: this is not TOML: string values must be quoted, expected literal string",
    );
    for (written, hint) in [
        ("\u{201c}120\u{201d}", "; quotation marks are straight: \""),
        ("50%", "; write the part as a number: 0.5"),
        ("12.5 %", "; write the part as a number: 0.125"),
    ] {
        let refused = message(&HEAD.replacen("width_mm = 120", &format!("width_mm = {written}"), 1));
        assert!(refused.starts_with("test.toml:4:") && refused.ends_with(hint), "{refused}");
    }
    // The list has no field that would say again what another one says.
    check_layers(
        "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_fraction = 0\nhigh_n = 0.01\nenabled = true",
        &[(
            6,
            1,
            "unknown field `enabled` in layer 1 (grating); expected one of `name`, `region`, `repeat`, `blend`, `gain`, \
             `live`, `above`, `wave`, `angle_deg`, `phase_deg`, `origin`",
        )],
    );
    check_head("version = 1", "version = 1\nversion = 2", "test.toml:2:1: this is not TOML: duplicate key");
}

#[test]
fn unknown_and_missing_fields() {
    check_head(
        "radius_mm",
        "raduis_mm",
        "test.toml:12:1: unknown field `raduis_mm` in [finger]; did you mean `radius_mm`?",
    );
    check_head(
        "height_mm = 110",
        "colour = \"blue\"\nheight_mm = 110",
        "test.toml:5:1: unknown field `colour` in [screen]; nothing more is expected here",
    );
    check_head("height_mm = 110\n", "", "test.toml:3:1: [screen] has no `height_mm`: add it");
    check_head("version = 1\n", "", "test.toml:1:1: the scene has no `version`: write `version = 2` at the top");
    check_head(
        "[coating]\nthickness_um = 10\npermittivity = 1\n",
        "",
        "test.toml:1:1: the scene has no `coating`: add it, or write `version = 2`, which new scenes have",
    );
    check_head(
        "# layers follow",
        "[drive]\nlimit = 3",
        "test.toml:18:1: unknown field `limit` in [drive]; expected one of `voltage_max_v_rms`, `voltage_max_v_peak`, \
         `slew_v_per_us`, `host_timeout_ms`, `autonomous`, `saturate`",
    );
    check_layers(
        "[[layer]]\nfriction_n = 1",
        &[(
            1,
            1,
            "layer 1 has no `kind`: write one of `constant`, `grating`, `bitmap`, `noise`, `edge`, `button`, `vibration`, \
             `speed`, `stream`, `rings`",
        )],
    );
    check_layers(
        "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nx = 10\ny = 20\nwidth = 30\nheight = 5",
        &[(
            4,
            1,
            "`x`, `y`, `width` and `height` in layer 1 (constant) belong in `region`: write `region = { x_mm = 10, y_mm = 20, \
             width_mm = 30, height_mm = 5 }`",
        )],
    );
    // A kind with fields of its own for its place and size.
    check_layers(
        "[[layer]]\nkind = \"edge\"\nx = 10\ny_mm = 20\nwidth_mm = 3\nridge_n = 0.01",
        &[(3, 1, "unknown field `x` in layer 1 (edge); did you mean `x_mm`?")],
    );
    // Words of other trades.
    for (word, answer) in [
        ("slider", "did you mean `edge`, one for each detent, with `repeat`?"),
        ("picture", "did you mean `bitmap`?"),
        ("notification", "did you mean `vibration`, with `live = true`, so that a program can trigger it?"),
        ("key", "did you mean `button`?"),
    ] {
        let layer = format!("[[layer]]\nkind = \"{word}\"");
        check_layers(&layer, &[(2, 8, &format!("`kind = \"{word}\"` is not known; {answer}"))]);
    }
    for word in ["file", "image"] {
        let layer = format!("[[layer]]\nkind = \"bitmap\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 9\n{word} = \"a.png\"");
        check_layers(
            &layer,
            &[(6, 1, &format!("unknown field `{word}` in layer 1 (bitmap); did you mean `picture`?"))],
        );
    }
    check_layers(
        "[[layer]]\nkimd = \"constant\"\nfriction_n = 1",
        &[(2, 1, "unknown field `kimd` in layer 1; did you mean `kind`?")],
    );
    check_layers(
        "[[layer]]\nkind = \"grating\"\nname = \"a\"\nwavelenght_mm = 2\nlow_n = 0\nhigh_n = 0.01",
        &[(4, 1, "unknown field `wavelenght_mm` in layer 1 \"a\"; did you mean `wavelength_mm`?")],
    );
    check_layers(
        "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nregion = { x_mm = 0, y_mm = 0, width = 3, height_mm = 3 }",
        &[(4, 32, "unknown field `width` in this region; did you mean `width_mm`?")],
    );
}

#[test]
fn every_mistake_is_told_at_once() {
    check_layers(
        "[[layer]]\nkind = \"constat\"\n[[layer]]\nkind = \"grating\"\nwavelength_mm = 0\nlow_n = \"a\"",
        &[
            (2, 8, "`kind = \"constat\"` is not known; did you mean `constant`?"),
            (3, 1, "layer 2 (grating) has no `high_n` or `high_fraction`: add one of them"),
            (5, 17, "`wavelength_mm = 0` is out of range: expected 0.05 to 2000 mm"),
            (6, 9, "`low_n` has to be a number, and this is a text"),
        ],
    );
}

/// A misspelt kind is read as the nearest kind. For an unrecognisable one, the parser reads only the fields that every
/// kind has.
#[test]
fn an_unknown_kind_does_not_hide_what_else_is_wrong() {
    check_layers(
        "[[layer]]\nkind = \"gratin\"\nwavelenght_mm = 2\nlow_n = \"a\"\nhigh_n = 0.01\ngain = 500",
        &[
            (2, 8, "`kind = \"gratin\"` is not known; did you mean `grating`?"),
            (3, 1, "unknown field `wavelenght_mm` in layer 1 (grating); did you mean `wavelength_mm`?"),
            (4, 9, "`low_n` has to be a number, and this is a text"),
            (6, 8, "`gain = 500` is out of range: expected -100 to 100"),
        ],
    );
    check_layers(
        "[[layer]]\nkind = \"xyzzy\"\nwavelength_mm = 2\nlive = 3\nblend = \"ad\"\n\
         region = { x_mm = 0, y_mm = 0, width_mm = 3 }",
        &[
            (
                2,
                8,
                "`kind = \"xyzzy\"` is not known; expected one of `constant`, `grating`, `bitmap`, `noise`, `edge`, \
                 `button`, `vibration`, `speed`, `stream`, `rings`",
            ),
            (4, 8, "`live` has to be `true` or `false`, and this is a number"),
            (5, 9, "`blend = \"ad\"` is not known; did you mean `add`?"),
            (6, 10, "this region has no `height_mm`: add it"),
        ],
    );
}

#[test]
fn wrong_types() {
    check_head(
        "width_mm = 120",
        "width_mm = true",
        "test.toml:4:12: `width_mm` has to be a number, and this is `true` or `false`",
    );
    check_head(
        "[screen]",
        "[[screen]]",
        "test.toml:3:1: `screen` has to be a table, and this is a list: write `[screen]` on a line of its own, and its \
         fields below it",
    );
    let layer = "[layer]\nkind = \"constant\"\nfriction_n = 0.26";
    check_layers(
        layer,
        &[(
            1,
            1,
            "`layer` has to be a list of tables, and this is a table: write `[[layer]]`, in double brackets, before the \
             fields of each",
        )],
    );
    check_layers("layer = [3]", &[(1, 1, "unknown field `layer` in [finger]; nothing more is expected here")]);
    check_head(
        "# layers follow",
        "[touch]\nprediction = 1",
        "test.toml:18:14: `prediction` has to be `true` or `false`, and this is a number",
    );
    check_layers("[[layer]]\nkind = 3", &[(2, 8, "`kind` has to be a text in quotes, and this is a number")]);
}

#[test]
fn invalid_coatings() {
    let slab = "[coating]\nthickness_um = 10\npermittivity = 1\n";
    let first = |coating: &str| HEAD.replace(slab, "").replace("version = 1", &format!("version = 1\n{coating}"));
    assert_eq!(
        message(&first("coating = []")),
        "test.toml:1:1: the scene has no `coating`: add it, or write `version = 2`, which new scenes have"
    );
    assert_eq!(
        message(&first("coating = 3")),
        "test.toml:2:11: `coating` has to be a list of tables, and this is a number: write `[[coating]]`, in double \
         brackets, before the fields of each"
    );
    assert_eq!(
        message(&first("coating = [{ thickness_um = 3 }, 4]")),
        "test.toml:2:12: [[coating]] has no `permittivity`: add it\n\
         test.toml:2:34: `coating` has to be a list of tables, and this is a number: write `[[coating]]`, in double \
         brackets, before the fields of each"
    );
}

#[test]
fn numbers_out_of_range() {
    check_head(
        "radius_mm = 8",
        "radius_mm = -8",
        "test.toml:12:13: `radius_mm = -8` is out of range: expected 0.1 to 100 mm",
    );
    check_head(
        "friction_coefficient = 0.5",
        "friction_coefficient = nan",
        "test.toml:14:24: `friction_coefficient = NaN` is out of range: expected 0.001 to 10",
    );
    check_head(
        "normal_load_n = 0.5",
        "normal_load_n = inf",
        "test.toml:15:17: `normal_load_n = inf` is out of range: expected 0 to 50 N",
    );
    check_head(
        "# layers follow",
        "[drive]\nhost_timeout_ms = 5",
        "test.toml:18:19: `host_timeout_ms = 5` is out of range: expected 20 to 1000 ms",
    );
    check_head(
        "version = 1",
        "version = 3",
        "test.toml:1:11: this scene file has version 3, and this frixel reads versions 1 and 2: use a frixel that knows it",
    );
}

#[test]
fn drive_and_carrier_beyond_the_board() {
    check_head(
        "# layers follow",
        "[carrier]\nfrequency_hz = 6000",
        "test.toml:18:16: `frequency_hz = 6000` is too fast for 40000 ticks a second: expected at most 5000 Hz",
    );
    check_head(
        "# layers follow",
        "[drive]\nvoltage_max_v_peak = 221",
        "test.toml:18:22: `voltage_max_v_peak = 221` is above the board's limit of 220 V peak: lower it or leave it out",
    );
    check_head(
        "# layers follow",
        "[drive]\nvoltage_max_v_rms = 180\n[carrier]\nfrequency_hz = 5000",
        "test.toml:19:1: this carrier drives 3.69 mA rms into the board's worst-case electrode, and its limit is 3.00 mA: \
         lower `frequency_hz` under [carrier], or `voltage_max_v_rms` under [drive]",
    );
}

#[test]
fn fingers_and_coatings_that_cannot_be_played() {
    let slab = "[coating]\nthickness_um = 10\npermittivity = 1\n";
    let thick = "[[coating]]\nthickness_um = 1000\npermittivity = 1\n";
    check_head(
        slab,
        &thick.repeat(11),
        "test.toml:7:1: `thickness_um / permittivity, summed = 11000` is out of range: expected 0 to 10000 um",
    );
    let text = HEAD
        .replace(slab, &thick.repeat(9))
        .replace("1.8e7", "1e3")
        .replace("normal_load_n = 0.5", "normal_load_n = 0");
    assert_eq!(
        message(&format!("{text}[drive]\nvoltage_max_v_rms = 1")),
        "test.toml:7:1: this finger on this coating cannot be played (its friction between 1 V and the largest voltage does \
         not fit the board's table): check finger, coating and `voltage_max_v_rms`"
    );
}

#[test]
fn layers_off_the_screen() {
    let layer = |region: &str| format!("[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nregion = {{ {region} }}");
    let sentence = |beyond: &str, edge: &str| {
        format!(
            "layer 1 (constant) reaches {beyond} mm past the {edge} edge of the 120 mm x 110 mm screen: move it or make it \
             smaller"
        )
    };
    check_layers(&layer("x_mm = 100, y_mm = 0, width_mm = 30, height_mm = 5"), &[(4, 10, &sentence("10", "right"))]);
    check_layers(
        &layer("x_mm = -0.0005, y_mm = 0, width_mm = 30, height_mm = 5"),
        &[(4, 10, &sentence("0.001", "left"))],
    );
    check_layers(&layer("x_mm = 3, y_mm = -4, width_mm = 3, height_mm = 3"), &[(4, 10, &sentence("4", "top"))]);
    check_layers(&layer("x_mm = 0, y_mm = 200, width_mm = 3, height_mm = 3"), &[(4, 10, &sentence("93", "bottom"))]);
    compile_layers(&layer("x_mm = 0.1, y_mm = 0.1, width_mm = 119.9, height_mm = 109.9"));
    check_layers(
        "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 30\ny_mm = 0\nwidth_mm = 100\npitch_mm = 0.5\n\
         black_n = 0\nwhite_n = 0.01",
        &[(
            4,
            8,
            "layer 1 (bitmap) reaches 10 mm past the right edge of the 120 mm x 110 mm screen: move it or make it smaller",
        )],
    );
}

#[test]
fn friction_out_of_reach() {
    check_layers(
        "[[layer]]\nname = \"hot\"\nkind = \"constant\"\nfriction_n = 0.3",
        &[(
            4,
            14,
            "layer 1 \"hot\" asks for up to 0.3 N in total, and at 150 V rms this finger feels at most 0.2777 N in total: \
             lower it, raise `voltage_max_v_rms` to 198, or write `saturate = true` under [drive] to have it clamped",
        )],
    );
    check_layers(
        "[[layer]]\nkind = \"constant\"\nfriction_n = 0.2",
        &[(
            3,
            14,
            "layer 1 (constant) asks for down to 0.2 N in total, and a drive can only add to the finger's natural friction \
             of 0.25 N: raise it, or lower `normal_load_n`, or write `saturate = true` under [drive] to have it clamped",
        )],
    );
    check_layers(
        "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = -0.001\nhigh_n = 0.0278",
        &[
            (
                4,
                9,
                "layer 1 (grating) asks for down to -0.001 N above natural friction, and a drive can only add to the \
                 finger's natural friction of 0.25 N: raise it, or write `saturate = true` under [drive] to have it clamped",
            ),
            (
                5,
                10,
                "layer 1 (grating) asks for up to 0.0278 N above natural friction, and at 150 V rms this finger feels at \
                 most 0.02778 N above natural friction: lower it, raise `voltage_max_v_rms` to 151, or write `saturate = \
                 true` under [drive] to have it clamped",
            ),
        ],
    );
    check_layers(
        "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = 0\nhigh_n = 0.02\ngain = 2",
        &[(
            5,
            10,
            "layer 1 (grating), with its gain of 2, asks for up to 0.04 N above natural friction, and at 150 V rms this \
             finger feels at most 0.02778 N above natural friction: lower it, raise `voltage_max_v_rms` to 179, or write \
             `saturate = true` under [drive] to have it clamped",
        )],
    );
    let reachable = "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = 0\nhigh_n = 0.02778";
    compile_layers(reachable);
}

#[test]
fn the_field_to_change_is_pointed_at() {
    let line = |layers: &str| {
        let message = message(&format!("{HEAD}{layers}"));
        assert_eq!(message.lines().count(), 1, "{message}");
        message.split(':').nth(1).and_then(|line| line.parse::<usize>().ok()).expect("a line") + 1 - FIRST
    };
    let grating = |low_n: f64, high_n: f64, gain: f64| {
        format!("[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = {low_n}\nhigh_n = {high_n}\ngain = {gain}\n")
    };
    assert_eq!([line(&grating(0.0, 0.03, 1.0)), line(&grating(-0.01, 0.02, 1.0))], [5, 4]);
    // A negative gain swaps the two limits.
    assert_eq!([line(&grating(-0.02, 0.01, -1.0)), line(&grating(-0.03, 0.0, -1.0))], [5, 4]);
    let bitmap = |black_n: f64, white_n: f64| {
        format!(
            "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 50\n\
             black_n = {black_n}\nwhite_n = {white_n}"
        )
    };
    assert_eq!([line(&bitmap(0.0, 0.06)), line(&bitmap(-0.03, 0.03)), line(&bitmap(0.06, 0.0))], [8, 7, 7]);
}

#[test]
fn a_white_that_the_picture_does_not_have_is_not_asked_for() {
    let layer = |white_n: &str| {
        format!(
            "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 100\n\
             pitch_mm = 0.5\nblack_n = 0\nwhite_n = {white_n}"
        )
    };
    // The brightest mortar is 221 of 255 at this pitch.
    let program = compile_layers(&layer("0.032"));
    let brightest = program.bitmaps[0].samples.iter().max().expect("there are samples");
    let reach_n = program.reach.electric_friction_max_n;
    assert!(0.032 * f64::from(*brightest) / 255.0 < reach_n);
    assert!(0.036 * f64::from(*brightest) / 255.0 > reach_n);
    check_layers(
        &layer("0.036"),
        &[(
            9,
            11,
            &format!(
                "layer 1 (bitmap) asks for up to {} N above natural friction, and at 150 V rms this finger feels at most \
                 0.02778 N above natural friction: lower it, raise `voltage_max_v_rms` to 151, or write `saturate = true` \
                 under [drive] to have it clamped",
                (0.036 * f64::from(*brightest) / 255.0 * 1e5).ceil() / 1e5
            ),
        )],
    );
}

const STRIPES: &str =
    "[[layer]]\nname = \"stripes\"\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = 0\nhigh_n = 0.02\n";

#[test]
fn sums_out_of_reach() {
    let added = |above: &str| {
        format!(
            "{STRIPES}[[layer]]\nname = \"patch\"\nkind = \"constant\"\nblend = \"add\"\nfriction_n = {above}\n\
             region = {{ x_mm = 10, y_mm = 20, width_mm = 5, height_mm = 6 }}"
        )
    };
    check_layers(
        &added("0.01"),
        &[(
            7,
            1,
            "layer 1 \"stripes\" and layer 2 \"patch\" together (x 10 to 15 mm, y 20 to 26 mm) ask for up to 0.03 N above \
             natural friction, and at 150 V rms this finger feels at most 0.02778 N above natural friction: lower one of \
             them, raise `voltage_max_v_rms` to 156, or write `saturate = true` under [drive] to have it clamped",
        )],
    );
    compile_layers(&added("0.007"));
    check_layers(
        &added("-0.01"),
        &[(
            7,
            1,
            "layer 1 \"stripes\" and layer 2 \"patch\" together (x 10 to 15 mm, y 20 to 26 mm) ask for down to -0.01 N above \
             natural friction, and a drive can only add to the finger's natural friction of 0.25 N: raise one of \
             them, or the ground beneath them, or write `saturate = true` under [drive] to have it clamped",
        )],
    );
    check_layers(
        "[[layer]]\nkind = \"constant\"\nblend = \"add\"\nabove = \"zero\"\nfriction_n = 0.26",
        &[(
            4,
            9,
            "layer 1 (constant) is added to what lies below it, so its friction is a difference and cannot be given in total: \
             write `above = \"natural\"` or leave `above` out",
        )],
    );
}

#[test]
fn sums_are_refused_only_where_a_finger_finds_them() {
    // In phase, the crests add up; half a turn apart, the two cancel to a constant 0.02 N.
    let second =
        |phase: i32| format!("{STRIPES}{}blend = \"add\"\nphase_deg = {phase}\n", STRIPES.replace("stripes", "more"));
    let refused = message(&format!("{HEAD}{}", second(0)));
    assert!(refused.contains("layer 1 \"stripes\" and layer 2 \"more\" together"), "{refused}");
    assert!(refused.contains("ask for up to 0.0399"), "{refused}");
    let program = compile_layers(&second(180));
    assert_eq!(
        program.notes,
        [
            "layer 1 \"stripes\" and layer 2 \"more\" together (x 0 to 120 mm, y 0 to 110 mm) ask for up to 0.04 N above natural \
          friction, and at most 0.02778 N can be reached; no place was found where they do"
        ]
    );
}

#[test]
fn friction_hidden_by_a_layer_above_needs_no_reach() {
    let cover = "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nregion = { x_mm = 10, y_mm = 10, width_mm = 20, height_mm = 20 }";
    let hidden = "[[layer]]\nkind = \"constant\"\nfriction_n = 0.9\nregion = { x_mm = 12, y_mm = 11, width_mm = 3, height_mm = 19 }\n";
    compile_layers(&format!("{hidden}{cover}"));
    assert!(message(&format!("{HEAD}{cover}\n{hidden}")).contains("layer 2 (constant) asks for up to 0.9 N"));
}

#[test]
fn saturate_lets_everything_pass_and_says_so() {
    let text = HEAD.replace("# layers follow", "[drive]\nsaturate = true");
    let program =
        compile_text(&format!("{text}[[layer]]\nkind = \"constant\"\nfriction_n = 0.3")).expect("it is clamped");
    assert_eq!(
        program.notes,
        ["layer 1 (constant) asks for up to 0.3 N in total, and at most 0.2777 N can be reached; it is clamped there"]
    );
}

#[test]
fn too_many_layers() {
    let layers = "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n".repeat(65);
    check_layers(
        &layers,
        &[(193, 1, "the scene has 65 layers, and the board takes 64: leave some out or draw them into one picture")],
    );
}

#[test]
fn amounts_in_the_wrong_unit() {
    check_layers(
        "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nfriction_fraction = 0.5",
        &[(4, 21, "`friction_n` and `friction_fraction` say the same in two units: leave one of them out")],
    );
    check_layers(
        "[[layer]]\nkind = \"constant\"\nfriction_fraction = 1.5",
        &[(3, 21, "`friction_fraction = 1.5` is out of range: expected -1 to 1")],
    );
    check_layers(
        "[[layer]]\nkind = \"grating\"\nblend = \"multiply\"\nwavelength_mm = 2\nlow_n = 0\nhigh_factor = 1",
        &[(5, 1, "unknown field `low_n` in layer 1 (grating); did you mean `low_factor`?")],
    );
    check_layers(
        "[[layer]]\nkind = \"constant\"",
        &[(1, 1, "layer 1 (constant) has no `friction_n` or `friction_fraction`: add one of them")],
    );
    check_layers(
        "[[layer]]\nkind = \"speed\"\nblend = \"add\"\nspeeds_mm_per_s = [1, 2]\nfactors = [0, 1]",
        &[(3, 9, "`blend = \"add\"` is not known; expected one of `multiply`")],
    );
}

#[test]
fn regions_that_are_none() {
    let region = |region: &str| format!("[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nregion = {region}");
    check_layers(
        &region("{ shape = \"elipse\", x_mm = 0, y_mm = 0, width_mm = 3, height_mm = 3 }"),
        &[(4, 20, "`shape = \"elipse\"` is not known; did you mean `ellipse`?")],
    );
    check_layers(
        &region("{ shape = \"polygon\", points_mm = [[0, 0], [3, 3]] }"),
        &[(4, 43, "`points_mm` has 2 entries: expected 3 to 32")],
    );
    check_layers(
        &region("{ shape = \"polygon\", points_mm = [[0, 0], [3, 3], 4] }"),
        &[(4, 60, "`points_mm` has to be a list of pairs, [[x, y], [x, y]], and this is a number")],
    );
    check_layers(
        &region("{ shape = \"polygon\", points_mm = [[0, 0], [130, 3], [3, 4]] }"),
        &[(
            4,
            10,
            "layer 1 (constant) reaches 10 mm past the right edge of the 120 mm x 110 mm screen: move it or make it \
             smaller",
        )],
    );
    let button = "[[layer]]\nkind = \"button\"\nrim_width_mm = 1\nrim_n = 0.01\nface_n = 0";
    check_layers(button, &[(1, 1, "layer 1 (button) has no `region`: add it")]);
    check_layers(
        &format!("{button}\nregion = {{ shape = \"polygon\", points_mm = [[0, 0], [9, 0], [0, 9]] }}"),
        &[(6, 10, "a button is a rectangle or an ellipse, and this region is a polygon: change its `shape`")],
    );
}

#[test]
fn kinds_that_do_not_make_sense() {
    check_layers(
        "[[layer]]\nkind = \"noise\"\nseed = 1.5\nwavelength_min_mm = 4\nwavelength_max_mm = 2\nlow_n = 0\nhigh_n = 0.01",
        &[
            (3, 8, "`seed = 1.5` has to be a whole number: round it"),
            (4, 21, "`wavelength_min_mm = 4` is above `wavelength_max_mm = 2`: swap them"),
        ],
    );
    let speed = |curve: &str| format!("[[layer]]\nkind = \"speed\"\n{curve}");
    check_layers(
        &speed("speeds_mm_per_s = [10]\nfactors = [1]"),
        &[(3, 19, "`speeds_mm_per_s` has 1 entry: expected 2 to 16")],
    );
    check_layers(&speed("speeds_mm_per_s = [10, 20]\nfactors = [1]"), &[(4, 11, "`factors` has 1 entry: expected 2")]);
    check_layers(
        &speed("speeds_mm_per_s = [10, 5]\nfactors = [1, 2]"),
        &[(
            3,
            19,
            "the speeds of a curve have to rise, by 0.02 mm/s or more from each to the next, and 5 comes after 10: sort \
             them",
        )],
    );
    check_layers(
        "[[layer]]\nkind = \"vibration\"\nfrequency_hz = 80\nlow_n = 0\nhigh_n = 0.01\n\
         burst = { period_ms = 100, on_ms = 200, ramp_ms = 20 }",
        &[(6, 36, "`on_ms = 200` is longer than `period_ms`: expected at most 100 ms")],
    );
    check_layers(
        "[[layer]]\nkind = \"vibration\"\nfrequency_hz = 80\nlow_n = 0\nhigh_n = 0.01\n\
         burst = { period_ms = 100, on_ms = 80, ramp_ms = 50 }",
        &[(6, 50, "`ramp_ms = 50` is longer than half of `on_ms`: expected at most 40 ms")],
    );
}

#[test]
fn more_than_a_board_has_room_for() {
    let noise = "[[layer]]\nkind = \"noise\"\nblend = \"add\"\nwavelength_min_mm = 1\nwavelength_max_mm = 2\nlow_n = 0\nhigh_n = 0.001\n";
    compile_layers(&noise.repeat(8));
    check_layers(
        &noise.repeat(9),
        &[(57, 1, "this is number 9 of the scene's layers of noise, and a board takes 8: leave some out")],
    );
    let edge = "[[layer]]\nkind = \"edge\"\nx_mm = 60\ny_mm = 40\nwidth_mm = 2\nridge_n = 0.001\nclick_n = 0.0005\n";
    compile_layers(&edge.repeat(16));
    check_layers(
        &edge.repeat(17),
        &[(
            113,
            1,
            "this is number 17 of the scene's edges and buttons with a click, and a board takes 16: leave some out",
        )],
    );
    // Each polygon has its own corners.
    let polygon = |number: usize| {
        let side = (0..32).map(|corner| format!("[{}, {}]", corner, number + corner % 2)).collect::<Vec<_>>();
        format!(
            "[[layer]]\nkind = \"constant\"\nblend = \"add\"\nfriction_n = 0.001\n\
             region = {{ shape = \"polygon\", points_mm = [{}] }}\n",
            side.join(", ")
        )
    };
    let polygons = |count: usize| (0..count).map(polygon).collect::<String>();
    assert_eq!(compile_layers(&polygons(4)).points.len(), 128);
    check_layers(
        &polygons(5),
        &[(
            21,
            1,
            "this is number 160 of the scene's points of polygons and curves, and a board takes 128: leave some out",
        )],
    );
}

#[test]
fn a_layer_out_of_reach_is_refused_with_its_range() {
    check_layers(
        "[[layer]]\nkind = \"noise\"\nwavelength_min_mm = 1\nwavelength_max_mm = 2\nlow_n = 0\nhigh_n = 0.03",
        &[(
            6,
            10,
            "layer 1 (noise) asks for up to 0.03 N above natural friction, and at 150 V rms this finger feels at most 0.02778 N above natural friction: lower it, raise `voltage_max_v_rms` to 156, or write `saturate = true` under [drive] to have it clamped",
        )],
    );
    let twice = "[[layer]]\nkind = \"vibration\"\nfrequency_hz = 80\nlow_n = 0\nhigh_fraction = 0.7\n\
                 [[layer]]\nkind = \"speed\"\nspeeds_mm_per_s = [10, 100]\nfactors = [0.5, 2]";
    let message = message(&format!("{HEAD}{twice}"));
    assert!(message.contains("layer 1 (vibration) and layer 2 (speed) together"), "{message}");
    // A well in existing friction is not below zero; a well in bare glass is.
    let well = "[[layer]]\nkind = \"edge\"\nx_mm = 60\ny_mm = 40\nwidth_mm = 2\nridge_fraction = -0.5";
    compile_layers(&format!("[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.6\n{well}"));
    check_layers(
        well,
        &[(
            6,
            18,
            "layer 1 (edge) asks for down to -0.0139 N above natural friction, and a drive can only add to the finger's natural friction of 0.25 N: raise it, or the ground beneath it, by a layer with more friction, or write `saturate = true` under [drive] to have it clamped",
        )],
    );
}

/// The friction beside a polygon or an ellipse does not count as its target.
#[test]
fn outlines_count_as_they_are() {
    let corner = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.7\nregion = { shape = \"polygon\", points_mm = [[0, 0], [50, 0], [0, 50]] }\n";
    let other = "[[layer]]\nkind = \"constant\"\nblend = \"add\"\nfriction_fraction = 0.7\nregion = { shape = \"polygon\", points_mm = ";
    compile_layers(&format!("{corner}{other}[[50, 0], [50, 50], [0, 50]] }}"));
    let message = message(&format!("{HEAD}{corner}{other}[[40, 0], [50, 50], [0, 40]] }}"));
    assert!(message.contains("together"), "{message}");
}

#[test]
fn low_above_high() {
    check_layers(
        "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = 0.02\nhigh_n = 0.01",
        &[(4, 9, "`low_n = 0.02` is above `high_n = 0.01`: swap them")],
    );
}

#[test]
fn pictures() {
    let layer = |picture: &str, pitch_mm: &str| {
        format!(
            "[[layer]]\nkind = \"bitmap\"\npicture = \"{picture}\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 100\n\
             pitch_mm = {pitch_mm}\nblack_n = 0\nwhite_n = 0.01\n"
        )
    };
    check_layers(
        &layer("textures/brik.png", "0.5"),
        &[(
            3,
            11,
            "picture \"textures/brik.png\" was not found in the scene's set of files, which has \"brick.png\": paths \
             start from the folder of the file that names it",
        )],
    );
    check_layers(
        &layer("textures/README.md", "0.5"),
        &[(
            3,
            11,
            "picture \"textures/README.md\" cannot be used: it is neither a PNG nor a JPEG file: save it as PNG",
        )],
    );
    check_layers(
        &layer("textures/brick.png", "0.25"),
        &[(
            7,
            12,
            "the pictures up to this one need 160000 bytes, and the board has 65536: a pitch_mm of 0.4 would fit",
        )],
    );
    compile_layers(&layer("textures/brick.png", "0.4"));
    check_layers(
        &layer("textures/brick.png", "0.02"),
        &[(
            7,
            12,
            "the pictures up to this one need 25000000 bytes, and the board has 65536: a pitch_mm of 0.4 would fit",
        )],
    );
    let two = format!("{}{}", layer("textures/brick.png", "0.4"), layer("textures/brick.png", "0.5"));
    check_layers(
        &two,
        &[(
            16,
            12,
            "the pictures up to this one need 102500 bytes, and the board has 65536: a pitch_mm of 0.64 would fit",
        )],
    );
}

#[test]
fn damaged_pictures() {
    let whole = &PICTURES["textures/brick.png"];
    let pictures = BTreeMap::from([("cut.png".to_owned(), whole[..whole.len() / 2].to_vec())]);
    let layer = "[[layer]]\nkind = \"bitmap\"\npicture = \"cut.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 50\nblack_n = 0\nwhite_n = 0";
    let scene = Scene::parse(&format!("{HEAD}{layer}"), "test.toml", &pictures).expect("it reads");
    let error = compile(&scene, &LIMITS, TICK_HZ).expect_err("it is cut").to_string();
    assert!(error.starts_with("test.toml:21:11: picture \"cut.png\" cannot be used: it is damaged ("), "{error}");
}

#[test]
fn bytes_that_are_not_text() {
    let error =
        Scene::parse_bytes(b"version = 1\nname = \"\xff\"", "test.toml", &*PICTURES).expect_err("it is not text");
    assert_eq!(error.to_string(), "test.toml:2:9: this byte is not UTF-8 text: save the file as UTF-8");
}

proptest! {
    #[test]
    fn no_text_makes_the_parser_panic(text in ".*") {
        if let Err(error) = Scene::parse(&text, "test.toml", &*PICTURES) {
            prop_assert!(error.to_string().starts_with("test.toml:"));
        }
    }

    /// Valid TOML of known and unknown names, values of any type, and numbers of any size.
    #[test]
    fn no_table_makes_the_compiler_panic(
        lines in prop::collection::vec((0..LINES.len(), 0..VALUES.len(), any::<f64>()), 0..24),
    ) {
        let mut text = String::from(HEAD);
        for (line, value, number) in lines {
            let value = if VALUES[value] == "number" { format!("{number:?}") } else { VALUES[value].to_owned() };
            text.push_str(&LINES[line].replace("VALUE", &value));
            text.push('\n');
        }
        if let Err(error) = compile_text(&text) {
            prop_assert!(error.to_string().lines().all(|line| line.starts_with("test.toml:")), "{}", error);
        }
    }
}

const LINES: &[&str] = &[
    "[[layer]]",
    "[[layer]]\nkind = \"constant\"",
    "[[layer]]\nkind = \"grating\"",
    "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"",
    "kind = VALUE",
    "friction_n = VALUE",
    "low_n = VALUE",
    "high_n = VALUE",
    "wavelength_mm = VALUE",
    "angle_deg = VALUE",
    "gain = VALUE",
    "blend = VALUE",
    "region = VALUE",
    "picture = VALUE",
    "x_mm = VALUE",
    "y_mm = VALUE",
    "width_mm = VALUE",
    "height_mm = VALUE",
    "pitch_mm = VALUE",
    "black_n = VALUE",
    "white_n = VALUE",
    "[drive]\nsaturate = VALUE",
    "[carrier]\nfrequency_hz = VALUE",
];
const VALUES: &[&str] = &[
    "number",
    "0",
    "1",
    "0.01",
    "2",
    "50",
    "true",
    "\"add\"",
    "\"bitmap\"",
    "[1, 2]",
    "{ x_mm = 1, y_mm = 2 }",
    "1979-05-27",
    "{ x_mm = 1, y_mm = 2, width_mm = 3, height_mm = 4 }",
    "nan",
    "-inf",
    "0xff",
    "1_000",
    "99999999999999999999",
];

/// A word that is misspelt is one mistake: what its fields would be is a guess.
#[test]
fn an_unknown_kind_is_one_line() {
    check_layers(
        "[[layer]]\nkind = \"grateing\"\nlow_n = 0",
        &[(2, 8, "`kind = \"grateing\"` is not known; did you mean `grating`?")],
    );
}

/// Newtons written for millinewtons, and a button's rim with its click.
#[test]
fn messages_about_reach_suggest_the_fix() {
    check_layers(
        "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = 0\nhigh_n = 20",
        &[(
            5,
            10,
            "layer 1 (grating) asks for up to 20 N above natural friction, and at 150 V rms this finger feels at most \
             0.02778 N above natural friction: were mN meant? 1 mN is 0.001 N; lower it, or write `saturate = true` \
             under [drive] to have it clamped",
        )],
    );
    let error = message(&format!(
        "{HEAD}[[layer]]\nname = \"OK\"\nkind = \"button\"\nregion = {{ x_mm = 10, y_mm = 10, width_mm = 20, height_mm = 20 }}\n\
         rim_width_mm = 2\nrim_n = 0.02\nface_n = 0\nclick_n = 0.02\nclick_ms = 20\nabove = \"natural\""
    ));
    assert!(
        error.contains(
            "layer 1 \"OK\", with its `rim_n = 0.02` and its `click_n = 0.02` together, asks for up to 0.04 N"
        ),
        "{error}"
    );
}

/// What can be found at once is reported at once: mistakes of a layer's fields, of a picture, of its place, of room on
/// the board, and friction out of reach.
#[test]
fn mistakes_of_all_stages_come_together() {
    let layers = "\
        [[layer]]\nkind = \"grating\"\nwavelenght_mm = 2\nlow_n = 0\nhigh_n = 0.01\n\
        [[layer]]\nkind = \"bitmap\"\npicture = \"textures/brik.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 20\n\
        [[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
        region = { x_mm = 100, y_mm = 0, width_mm = 30, height_mm = 5 }\n\
        [[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 100\npitch_mm = 0.25\n\
        white_n = 0.01\n\
        [[layer]]\nkind = \"constant\"\nfriction_n = 0.9\n\
        region = { x_mm = 10, y_mm = 10, width_mm = 30, height_mm = 5 }\n";
    let text = message(&format!("{HEAD}{layers}"));
    let found: Vec<bool> =
        ["did you mean `wavelength_mm`", "was not found", "past the right edge", "a pitch_mm of", "up to 0.9 N"]
            .iter()
            .map(|part| text.contains(part))
            .collect();
    assert_eq!(found, [true; 5], "{text}");
}

/// Scenes that a board refuses play as drafts, clamped to what can be reached, with the board's sentences.
#[test]
fn drafts() {
    let draft = |layers: &str| {
        let scene = Scene::parse(&format!("{HEAD}{layers}"), "test.toml", &*PICTURES).expect("it reads");
        assert!(compile(&scene, &LIMITS, TICK_HZ).is_err(), "{layers}");
        let program = compile_draft(&scene, &LIMITS, TICK_HZ).expect("a draft plays it");
        assert!(program.is_draft());
        program
    };
    let refusal = |program: &Program| program.refusals[0].to_string();
    let reach = draft("[[layer]]\nkind = \"constant\"\nfriction_n = 0.9\n");
    assert!(
        refusal(&reach).starts_with("test.toml:21:14: layer 1 (constant) asks for up to 0.9 N"),
        "{}",
        refusal(&reach)
    );
    assert_eq!(reach.records.len(), 1);

    let bytes = draft(
        "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 100\n\
         pitch_mm = 0.1\nwhite_n = 0.01\n",
    );
    assert!(refusal(&bytes).contains("and the board has 65536"), "{}", refusal(&bytes));
    let samples: usize = bytes.bitmaps.iter().map(|bitmap| bitmap.samples.len()).sum();
    assert!((30_000..=65_536).contains(&samples), "{samples} bytes");

    let noise = "[[layer]]\nkind = \"noise\"\nblend = \"add\"\nwavelength_min_mm = 1\nwavelength_max_mm = 4\nlow_n = 0\n\
                 high_n = 0.001\n";
    let time = draft(&noise.repeat(5));
    assert!(refusal(&time).contains("and the board has time for 2550"), "{}", refusal(&time));
    assert_eq!((time.records.len(), time.notes.len()), (5, 0));

    let absent = draft(
        "[[layer]]\nname = \"wood\"\nkind = \"bitmap\"\npicture = \"wood.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 9\n",
    );
    assert_eq!(absent.notes, ["absent from this draft: layer 1 \"wood\""]);

    let off = draft(
        "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
         region = { shape = \"ellipse\", x_mm = 100, y_mm = -10, width_mm = 40, height_mm = 20 }\n\
         [[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nregion = { x_mm = -5, y_mm = 100, width_mm = 20, height_mm = 90 }\n",
    );
    assert_eq!(off.records.len(), 2);
    let header = off.header.write(2, off.points.len() as u8);
    let whole: Vec<u8> = header.into_iter().chain(off.scene_bytes().into_iter().skip(header.len())).collect();
    let parsed = frixel_layers::Scene::parse(&whole);
    assert!(parsed.is_ok(), "{parsed:?}");
}

/// A draft lowers its voltage to what the board's current and the finger's contact allow.
#[test]
fn drafts_keep_to_the_limits_of_the_drive() {
    let draft = |head: &str| {
        let scene = Scene::parse(head, "test.toml", &*PICTURES).expect("it reads");
        compile_draft(&scene, &LIMITS, TICK_HZ).expect("a draft plays it")
    };
    let current =
        draft(&HEAD.replace("# layers follow", "[drive]\nvoltage_max_v_rms = 180\n[carrier]\nfrequency_hz = 5000"));
    assert_eq!(current.refusals.len(), 1);
    assert!((135.0..145.0).contains(&current.reach.voltage_max_v_rms), "{:?}", current.reach);
    let fast = draft(&HEAD.replace("# layers follow", "[carrier]\nfrequency_hz = 6000"));
    assert_eq!((fast.refusals.len(), fast.half_period_ticks), (1, 4));
    let wide = draft(
        "version = 2\n[screen]\nwidth_mm = 100\nheight_mm = 80\n[finger]\nfriction_coefficient = 0.5\n\
                      normal_load_n = 0.5\nradius_mm = 8\nstiffness_pa_per_m = 1.8e7\nskin_gap_um = 0\n",
    );
    assert!(wide.refusals[0].to_string().contains("a skin gap is missing"), "{:?}", wide.refusals);
    assert!(wide.reach.voltage_max_v_rms < 100.0, "{:?}", wide.reach);
}

/// A scene that cannot be read is no draft.
#[test]
fn what_cannot_be_read_is_no_draft() {
    let text = format!("{HEAD}[[layer]]\nkind = \"constant\"\nfrction_n = 0.26\n");
    let scene = Scene::parse(&text, "test.toml", &*PICTURES).expect("its head reads");
    let refused = compile_draft(&scene, &LIMITS, TICK_HZ).expect_err("a layer has a misspelt field");
    assert_eq!(refused, compile(&scene, &LIMITS, TICK_HZ).expect_err("a board refuses it, too"));
}
