//! Applies what messages about friction out of reach propose, and checks that it helps.

use super::*;

/// The mistakes of a scene, a sentence each; none if it compiles.
fn mistakes_of(text: &str) -> Vec<String> {
    compile_text(text).map_or_else(|error| error.to_string().lines().map(str::to_owned).collect(), |_| Vec::new())
}

/// The sentence of a scene with one mistake.
#[track_caller]
fn sentence(text: &str) -> String {
    let mistakes = mistakes_of(text);
    let [sentence] = &mistakes[..] else { panic!("{mistakes:?}\n{text}") };
    sentence.clone()
}

/// The limits that a sentence proposes to raise, each with its value in V.
fn proposed(sentence: &str) -> Vec<(String, f64)> {
    let Some((_, behind)) = sentence.split_once("raise ") else { return Vec::new() };
    let (limits, _) = behind.split_once(", or write").expect("the proposal ends");
    let limit = |limit: &str| {
        let (field, to) = limit.split_once(" to ").expect("a limit has a value");
        (field.trim_matches('`').to_owned(), to.parse().expect("a number"))
    };
    limits.split(" and ").map(limit).collect()
}

/// Lines of `[drive]` with these limits in place of those of the same names.
fn raised(drive: &[(&str, f64)], limits: &[(String, f64)]) -> String {
    let kept = drive.iter().filter(|(field, _)| limits.iter().all(|(raised, _)| raised != field));
    let lines = kept.map(|(field, to)| format!("{field} = {to}\n"));
    lines.chain(limits.iter().map(|(field, to)| format!("{field} = {to}\n"))).collect()
}

/// More volts are proposed only where they help, and just so many as help: within the limits of board, screen and
/// measurement, and not for fractions.
/// Head, limits of the drive, crest, and the limits that the message proposes to raise.
type Case<'c> = (&'c str, &'c [(&'c str, f64)], &'c str, &'c [&'c str]);

#[test]
fn more_volts_that_are_proposed_help() {
    let grating = "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = 0\nhigh_n = HIGH\n";
    let measured = "[finger]\nfriction_coefficient = 0.5\nnormal_load_n = 0.5\nradius_mm = 8\nstiffness_pa_per_m = 1.8e7\n\
        skin_gap_um = 4.74\norigin = \"measured\"\ndate = \"2026-11-20\"\nmethod = \"load cell\"\nscreen = \"lab\"\n\
        friction_coefficient_interval = [0.4, 0.6]\nelectric_friction_interval_n = [0.1, 0.2]\n\
        measured_voltage_max_v_rms = 150\nmeasured_normal_load_range_n = [0.4, 0.6]\n\
        [screen]\nname = \"lab\"\nwidth_mm = 120\nheight_mm = 80\n";
    let soft = "[finger]\nfriction_coefficient = 0.5\nnormal_load_n = 0.5\nradius_mm = 8\nmodel = \"soft\"\n\
        modulus_pa = 1e5\nstress_exponent = 0.9\nshape_constant = 4.5\nskin_gap_um = 4.74\n";
    let (rms, peak) = ("voltage_max_v_rms", "voltage_max_v_peak");
    let cases: [Case<'_>; 12] = [
        ("", &[], "0.16", &[rms]),
        ("", &[(rms, 120.0)], "0.12", &[rms]),
        // The board's peak allows some 210 V rms, which is too little.
        ("", &[], "0.9", &[]),
        ("", &[(rms, 300.0)], "0.9", &[]),
        // The scene's own peak limits the voltage.
        ("", &[(peak, 100.0)], "0.12", &[peak]),
        ("", &[(rms, 100.0), (peak, 120.0)], "0.12", &[rms, peak]),
        // A sine has more peak voltage for its rms voltage.
        ("[carrier]\nshape = \"sine\"\n", &[(rms, 100.0)], "0.12", &[rms]),
        ("[carrier]\nshape = \"sine\"\n", &[], "0.16", &[]),
        // The current into the electrode limits the voltage, to some 139 V rms at this frequency.
        ("[carrier]\nfrequency_hz = 5000\n", &[(rms, 100.0)], "0.1", &[rms]),
        ("[carrier]\nfrequency_hz = 5000\n", &[(rms, 100.0)], "0.12", &[]),
        // A board refuses a voltage that the finger was not measured at.
        (measured, &[], "0.16", &[]),
        (soft, &[(rms, 100.0)], "0.12", &[rms]),
    ];
    for (head, drive, high_n, expected) in cases {
        let scene = |limits: &[(String, f64)]| {
            format!("version = 1\n[drive]\n{}{head}{}", raised(drive, limits), grating.replace("HIGH", high_n))
        };
        let refused = sentence(&scene(&[]));
        let limits = proposed(&refused);
        assert_eq!(limits.iter().map(|(field, _)| field.as_str()).collect::<Vec<_>>(), expected, "{refused}");
        assert!(refused.contains(": lower it, "), "less friction is proposed first: {refused}");
        if limits.is_empty() {
            let more = [(rms.to_owned(), 215.0)];
            assert!(!mistakes_of(&scene(&more)).is_empty() || head == measured, "more volts would help: {refused}");
        } else {
            assert_eq!(mistakes_of(&scene(&limits)), Vec::<String>::new(), "{refused}");
            let less: Vec<_> = limits.iter().map(|(field, to)| (field.clone(), to - 3.0)).collect();
            assert!(!mistakes_of(&scene(&less)).is_empty(), "less would do: {refused}");
        }
    }
}

const BUTTON: &str = "version = 1\n[[layer]]\nname = \"OK\"\nkind = \"button\"\nrim_width_mm = 2\n\
    region = { x_mm = 10, y_mm = 10, width_mm = 20, height_mm = 20 }\n";

/// Fractions follow the voltage, so that more of it changes nothing; to lower one of the fields that are named helps.
#[test]
fn fractions_out_of_reach_are_answered_by_less() {
    for (fields, expected, lowered) in [
        (
            "rim_fraction = 0.8\nface_fraction = 0.4\nclick_fraction = 0.5\n",
            "7:16: layer 1 \"OK\", with its `rim_fraction = 0.8` and its `click_fraction = 0.5` together, asks for up to 0.169 N \
             above natural friction (1.3 of the reach), and",
            ("0.8", "0.5"),
        ),
        (
            "rim_fraction = 0.2\nface_fraction = 0.8\nclick_fraction = 0.5\n",
            "8:17: layer 1 \"OK\", with its `face_fraction = 0.8` and its `click_fraction = 0.5` together, asks for up to 0.169 N \
             above natural friction (1.3 of the reach), and",
            ("0.8", "0.5"),
        ),
        (
            "rim_fraction = 0.7\nface_fraction = 0.6\nclick_fraction = 0.5\n",
            "7:16: layer 1 \"OK\", each of its `rim_fraction = 0.7` and `face_fraction = 0.6` together with its \
             `click_fraction = 0.5`, asks for up to 0.156 N above natural friction (1.2 of the reach), and",
            ("0.5", "0.3"),
        ),
        // Rim and face in different units are compared in newtons.
        (
            "rim_n = 0.02\nface_fraction = 0.9\nclick_fraction = 0.3\n",
            "8:17: layer 1 \"OK\", with its `face_fraction = 0.9` and its `click_fraction = 0.3` together, asks for up to \
             0.156 N above natural friction, and",
            ("0.9", "0.7"),
        ),
        (
            "rim_fraction = 0.8\nface_fraction = 0.4\ngain = 2\n",
            "7:16: layer 1 \"OK\", with its gain of 2, asks for up to 0.208 N above natural friction (1.6 of the reach), \
             and",
            ("0.8", "0.5"),
        ),
    ] {
        let text = format!("{BUTTON}{fields}");
        let refused = sentence(&text).replace("test.toml:", "");
        assert!(refused.starts_with(expected), "{refused}");
        assert!(!refused.contains("raise"), "{refused}");
        let is_sum = refused.contains("together");
        assert_eq!(refused.contains(": lower one of them, or write"), is_sum, "{refused}");
        assert_eq!(mistakes_of(&text.replacen(lowered.0, lowered.1, 1)), Vec::<String>::new(), "{text}");
        let more_volts = text.replace("version = 1\n", "version = 1\n[drive]\nvoltage_max_v_rms = 200\n");
        assert!(!mistakes_of(&more_volts).is_empty(), "{text}");
    }
}

/// A picture without numbers asks for all that can be reached.
#[test]
fn the_field_of_a_picture_to_change_is_named_whatever_its_unit() {
    let picture = "version = 1\n[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 0\ny_mm = 0\n\
        width_mm = 50\nblack_n = 0.2\n";
    let refused = sentence(picture);
    assert!(refused.starts_with("test.toml:8:11: layer 1 (bitmap) asks for up to 0."), "{refused}");
    assert_eq!(mistakes_of(&picture.replace("0.2", "0.1")), Vec::<String>::new());
}
