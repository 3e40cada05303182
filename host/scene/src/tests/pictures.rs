//! The pitch that a scene leaves open, and the levels of pictures.

use std::sync::Arc;

use super::*;
use crate::{SharedFiles, pool};

const SHORT: &str = "version = 1\n";

/// A layer with a picture at the left border.
fn layer(picture: &str, y_mm: u32, width_mm: u32, rest: &str) -> String {
    format!(
        "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/{picture}\"\nx_mm = 0\ny_mm = {y_mm}\nwidth_mm = {width_mm}\n{rest}\n"
    )
}

fn program(layers: &str) -> Program {
    compile_text(&format!("{SHORT}{layers}")).expect("it compiles")
}

/// Names of one picture count once, and of two pictures the first is read.
#[test]
fn the_pictures_of_a_scene_have_so_many_pixels_together() {
    let layers = [layer("brick.png", 0, 40, ""), layer("leather.png", 0, 40, ""), layer("brick.png", 0, 40, "")];
    let scene = Scene::parse(format!("{SHORT}{}", layers.concat()), "scene.toml", &*PICTURES).expect("it reads");
    let pixels = 512 * 512 + 200 * 200;
    assert!(pool::decoded(&scene, pixels).values().all(Result::is_ok));
    let decoded = pool::decoded(&scene, pixels - 1);
    assert!(decoded["textures/brick.png"].is_ok());
    let error = decoded["textures/leather.png"].as_ref().expect_err("it is refused").to_string();
    let says = "it has 200 x 200 pixels, and the pictures of a scene have at most 67108864 together: make them smaller";
    assert!(error.ends_with(says), "{error}");
}

/// Scenes that share a file have one decoded picture, and each has its own limit of pixels.
#[test]
fn scenes_that_share_a_picture_decode_it_once() {
    let files = SharedFiles::from(PICTURES.clone());
    let text = format!("{SHORT}{}", layer("brick.png", 0, 40, ""));
    let scenes = [(); 2].map(|()| Scene::parse(&text, "scene.toml", &files).expect("it reads"));
    let decoded = |scene, pixels| pool::decoded(scene, pixels).remove("textures/brick.png").expect("it is named");
    let [one, other] = scenes.each_ref().map(|scene| decoded(scene, 512 * 512).expect("it is decoded"));
    assert!(Arc::ptr_eq(&one, &other));
    assert!(decoded(&scenes[0], 512 * 512 - 1).is_err());
    let own = Scene::parse(&text, "scene.toml", &*PICTURES).expect("it reads");
    assert!(one == decoded(&own, 512 * 512).expect("it is decoded"));
}

#[test]
fn stretched_levels_use_the_whole_range() {
    let range = |levels: &str| {
        let found = program(&layer("wood.jpg", 0, 60, levels));
        let samples = &found.bitmaps[0].samples;
        (samples.iter().min().copied().unwrap_or_default(), samples.iter().max().copied().unwrap_or_default())
    };
    let (black, white) = range("");
    assert!(black > 40 && white < 230, "{black} to {white}");
    assert_eq!(range("levels = \"full\""), (black, white));
    assert_eq!(range("levels = \"stretch\""), (0, 255));
    // The mean over many pixels varies less than they do.
    let (black, white) = range("pitch_mm = 2");
    assert!(black > 60 && white < 170, "{black} to {white}");
    assert_eq!(range("pitch_mm = 2\nlevels = \"stretch\""), (0, 255));
}

/// A black square in the middle of a transparent ground.
pub(super) fn icon() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 8, 8);
    encoder.set_color(png::ColorType::GrayscaleAlpha);
    let alpha = |pixel: u8| if (2..6).contains(&(pixel % 8)) && (16..48).contains(&pixel) { 255 } else { 0 };
    let data: Vec<u8> = (0..64).flat_map(|pixel| [0, alpha(pixel)]).collect();
    encoder.write_header().expect("a header").write_image_data(&data).expect("pixels");
    bytes
}

#[test]
fn a_black_icon_on_a_transparent_ground_is_felt_over_white() {
    let friction_n = |fields: &str, x_mm: f64| {
        let text = format!(
            "{SHORT}[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.3\n{}",
            layer("icon.png", 0, 8, fields)
        );
        let pictures = BTreeMap::from([("textures/icon.png".to_owned(), icon())]);
        let scene = Scene::parse(&text, "icon.toml", &pictures).expect("it is a scene");
        let program = compile(&scene, &LIMITS, TICK_HZ).expect("it compiles");
        let is_hidden = program.warnings().any(|warning| warning.contains("its shape cannot be felt"));
        let friction_n = crate::reference::Reference::new(&program).electric_friction_n(1e-3 * x_mm, 4.5e-3);
        ((10.0 * friction_n / program.reach.electric_friction_max_n).round() as i64, is_hidden)
    };
    // In the icon, beside it, and in the constant layer.
    for (fields, inside, beside, is_hidden) in [
        ("", 0, 0, true),
        ("invert = true", 10, 10, true),
        ("transparent = \"white\"", 0, 10, false),
        ("transparent = \"white\"\ninvert = true", 10, 0, false),
        // Black leaves the layers below unchanged.
        ("transparent = \"white\"\ninvert = true\nblend = \"max\"", 10, 3, false),
        ("transparent = \"white\"\ninvert = true\nblend = \"add\"\nwhite_fraction = 0.5", 8, 3, false),
    ] {
        for (x_mm, expected) in [(4.5, inside), (0.5, beside), (20.0, 3)] {
            assert_eq!(friction_n(fields, x_mm), (expected, is_hidden), "{fields} at {x_mm} mm");
        }
    }
}
