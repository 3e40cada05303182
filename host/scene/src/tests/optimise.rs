//! Tests the optimisations, and that they do not change the friction.

use super::*;
use crate::reference::{Context, Reference};

/// Compiles these layers twice: optimised, and with all layers kept because the host may change them.
fn small_and_whole(layers: &str) -> (Program, Program) {
    (compile_layers(layers), compile_layers(&layers.replace("[[layer]]", "[[layer]]\nlive = true")))
}

/// Checks the optimisations, and that both programs have the same target friction, up to rounding of `f32` sums.
#[track_caller]
fn check(layers: &str, expected: &[&str], records: usize) {
    let (small, whole) = small_and_whole(layers);
    let found: Vec<String> = small.optimisations().collect();
    assert_eq!(found, expected);
    assert_eq!((small.records.len(), small.titles.len()), (records, records));
    assert_eq!(whole.records.len(), layers.matches("[[layer]]").count());
    assert!(small.scene_bytes().len() <= whole.scene_bytes().len());
    let (mut small, mut whole) = (Reference::new(&small).along_stroke(), Reference::new(&whole).along_stroke());
    for place in 0..8_000 {
        let context = Context {
            x_m: 0.12 * f64::from(place % 100) / 100.0,
            y_m: 0.11 * f64::from(place / 100) / 80.0,
            t_s: f64::from(place) * 25e-6,
            speed_m_per_s: 0.1,
            direction: [0.6, -0.8],
            stream: 0.5,
            stream_weight: 1.0,
            begun_s: 0.0,
        };
        let (found, expected) = (small.electric_friction_n(&context), whole.electric_friction_n(&context));
        assert!((found - expected).abs() < 1e-9, "{context:?}: {found} is not {expected}");
    }
}

const STRIPES: &str = "[[layer]]\nkind = \"grating\"\nwavelength_mm = 4\nlow_n = 0\nhigh_n = 0.01\n";

#[test]
fn a_covered_layer_is_dropped() {
    check(
        &format!("{STRIPES}[[layer]]\nkind = \"constant\"\nfriction_n = 0.26"),
        &["layer 1 (grating) is optimised away: layer 2 (constant) replaces it everywhere"],
        1,
    );
    let inside = "region = { shape = \"ellipse\", x_mm = 30, y_mm = 30, width_mm = 20, height_mm = 20 }\n";
    let around = "region = { x_mm = 30, y_mm = 30, width_mm = 20, height_mm = 20 }\n";
    check(
        &format!("{STRIPES}{inside}[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n{around}"),
        &["layer 1 (grating) is optimised away: layer 2 (constant) replaces it everywhere"],
        1,
    );
    check(&format!("{STRIPES}{around}[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n{inside}"), &[], 2);
    check(&format!("{STRIPES}[[layer]]\nkind = \"constant\"\nfriction_n = 0.002\nblend = \"add\""), &[], 2);
    // A stream may be absent.
    check(&format!("{STRIPES}[[layer]]\nkind = \"stream\"\nlow_n = 0\nhigh_n = 0.01"), &[], 2);
}

#[test]
fn a_layer_without_effect_is_dropped() {
    check(
        &format!(
            "[[layer]]\nkind = \"constant\"\nblend = \"multiply\"\nfriction_factor = 3\n{STRIPES}blend = \"add\"\n\
             [[layer]]\nkind = \"constant\"\nblend = \"multiply\"\nfriction_factor = 0.5\ngain = 2\n\
             [[layer]]\nname = \"nothing\"\nkind = \"grating\"\nblend = \"add\"\nwavelength_mm = 4\nlow_n = 0\nhigh_n = 0"
        ),
        &[
            "layer 4 \"nothing\" is played as a constant: its friction is the same everywhere",
            "layer 1 (constant) is optimised away: it changes nothing",
            "layer 3 (constant) is optimised away: it changes nothing",
            "layer 4 \"nothing\" is optimised away: it changes nothing",
        ],
        1,
    );
}

#[test]
fn constants_become_one() {
    check(
        "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
         [[layer]]\nkind = \"constant\"\nblend = \"add\"\nfriction_n = 0.002\ngain = 2\n\
         [[layer]]\nkind = \"constant\"\nblend = \"multiply\"\nfriction_factor = 0.5\n\
         [[layer]]\nkind = \"constant\"\nblend = \"max\"\nfriction_n = 0.009",
        &[
            "layer 2 (constant) is optimised away: it is merged into layer 1 (constant)",
            "layer 3 (constant) is optimised away: it is merged into layer 1 (constant)",
            "layer 4 (constant) is optimised away: it is merged into layer 1 (constant)",
        ],
        1,
    );
}

#[test]
fn points_and_pictures_that_nothing_names_go() {
    let polygon = "region = { shape = \"polygon\", points_mm = [[10, 10], [50, 10], [20, 60]] }\n";
    let picture = "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 10\ny_mm = 10\nwidth_mm = 40\npitch_mm = 2\n";
    let layers = format!(
        "{picture}[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n{polygon}\
         [[layer]]\nkind = \"constant\"\nfriction_n = 0.255\n\
         [[layer]]\nkind = \"speed\"\nspeeds_mm_per_s = [10, 200]\nfactors = [0.5, 1]"
    );
    check(
        &layers,
        &[
            "layer 1 (bitmap) is optimised away: layer 3 (constant) replaces it everywhere",
            "layer 2 (constant) is optimised away: layer 3 (constant) replaces it everywhere",
            "a picture of 400 bytes is optimised away: no remaining layer shows it",
        ],
        2,
    );
    let program = compile_layers(&layers);
    assert_eq!((program.points.len(), program.bitmaps.len()), (2, 0));
}

#[test]
fn pictures_are_cropped_to_what_can_be_found_and_shared() {
    let picture = |region: &str| {
        format!(
            "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 100\npitch_mm = 1\n\
             white_n = 0.02\n{region}"
        )
    };
    let part = "region = { x_mm = 20.5, y_mm = 30, width_mm = 40, height_mm = 10.2 }\n";
    // 41 columns, with centres from 20.5 mm to 60.5 mm, and 12 rows, enough to cover 30 mm to 40.2 mm.
    let program = compile_layers(&picture(part));
    assert_eq!((program.bitmaps[0].width, program.bitmaps[0].height), (41, 12));
    check(&picture(part), &["brick.png: 10000 samples are cropped to the 492 inside its region and the screen"], 1);
    check(
        &format!("{}{}", picture(""), picture("blend = \"add\"\ngain = 0.1\n")),
        &["brick.png is sent once for several layers: 10000 bytes less"],
        2,
    );
    // The cropped picture equals that part of the whole picture.
    let whole = compile_layers(&picture("region = { x_mm = 0, y_mm = 0, width_mm = 120, height_mm = 110 }\n"));
    let (part, whole) = (Reference::new(&program), Reference::new(&whole));
    for place in 0..2_000 {
        let (x_m, y_m) =
            (0.0206 + 0.0398 * f64::from(place % 50) / 50.0, 0.0301 + 0.0100 * f64::from(place / 50) / 40.0);
        let (found, expected) = (part.electric_friction_n(x_m, y_m), whole.electric_friction_n(x_m, y_m));
        assert!((found - expected).abs() < 3e-8, "({x_m}, {y_m}): {found} is not {expected}");
    }
}

/// A layer that is optimised away needs no feature of the firmware.
#[test]
fn a_program_needs_the_features_of_what_is_left() {
    use frixel_wire::hello::feature;
    let polygon = "region = { shape = \"polygon\", points_mm = [[10, 10], [50, 10], [20, 60]] }\n";
    let button = "[[layer]]\nkind = \"button\"\nrim_width_mm = 1\nrim_n = 0.01\nface_n = 0\n\
                  region = { x_mm = 1, y_mm = 1, width_mm = 9, height_mm = 9 }\n";
    let cover = "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n";
    for (layers, expected) in [
        (cover.to_owned(), &[][..]),
        (format!("{STRIPES}{polygon}"), &["grating", "polygon"]),
        (format!("{STRIPES}{polygon}{cover}{button}"), &["edge"]),
        (format!("{cover}[[layer]]\nkind = \"stream\"\nlow_n = 0\nhigh_n = 0.01"), &["stream"]),
    ] {
        let features = compile_layers(&layers).features();
        let named = frixel_layers::feature_names().filter(|(bit, _)| features & bit != 0);
        assert_eq!(named.map(|(_, name)| name).collect::<Vec<_>>(), expected, "{layers}");
    }
    let sine = HEAD.replace("# layers follow", "[carrier]\nshape = \"sine\"\n");
    assert_eq!(compile_text(&sine).expect("it compiles").features(), feature::SINE_CARRIER);
}
