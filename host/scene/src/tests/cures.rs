//! Applies the advice in messages about friction out of reach, and checks that it helps.

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

/// More volts are proposed only where they help, and only as many as necessary: within the limits of board, screen and
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
