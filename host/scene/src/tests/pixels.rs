//! Places and sizes in pixels of a design.

use super::*;
use crate::Screen;

const DESIGN: &str =
    "version = 2\nscreen = { width_mm = 60, height_mm = 120 }\ndesign = { width_px = 600, height_px = 1200 }\n";

fn scene(text: &str) -> Result<Scene, CompileError> {
    let scene = Scene::parse(text, "test.toml", &*PICTURES);
    schema::check_agrees(text, mistakes(&scene));
    scene
}

fn bytes(text: &str) -> Vec<u8> {
    let scene = scene(text).expect("it reads");
    compile::compile(&scene, &LIMITS, TICK_HZ).expect("it compiles").scene_bytes()
}

#[test]
fn pixels_are_parts_of_the_screen() {
    let mm = "[[layer]]\nkind = \"button\"\nregion = { x_mm = 5, y_mm = 20, width_mm = 20, height_mm = 10 }\n\
        repeat = { columns = 2, rows = 3, dx_mm = 30, dy_mm = 12 }\nrim_width_mm = 2\nrim_n = 0.02\nface_n = 0.0\n\
        [[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
        region = { shape = \"polygon\", points_mm = [[0, 60], [30, 60], [0, 90]] }\n\
        [[layer]]\nkind = \"edge\"\nx_mm = 30\ny_mm = 100\nangle_deg = 90\nwidth_mm = 4\nridge_n = 0.01\n\
        [[layer]]\nkind = \"rings\"\nx_mm = 30\ny_mm = 100\nwavelength_mm = 4\nlow_n = 0.0\nhigh_n = 0.01\n\
        region = { x_mm = 40, y_mm = 100, width_mm = 10, height_mm = 10 }\n\
        [[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 10\ny_mm = 60\nwidth_mm = 20\nheight_mm = 10\n";
    let px = "[[layer]]\nkind = \"button\"\nregion = { x_px = 50, y_px = 200, width_px = 200, height_px = 100 }\n\
        repeat = { columns = 2, rows = 3, dx_px = 300, dy_px = 120 }\nrim_width_mm = 2\nrim_n = 0.02\nface_n = 0.0\n\
        [[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
        region = { shape = \"polygon\", points_px = [[0, 600], [300, 600], [0, 900]] }\n\
        [[layer]]\nkind = \"edge\"\nx_px = 300\ny_px = 1000\nangle_deg = 90\nwidth_mm = 4\nridge_n = 0.01\n\
        [[layer]]\nkind = \"rings\"\nx_px = 300\ny_mm = 100\nwavelength_mm = 4\nlow_n = 0.0\nhigh_n = 0.01\n\
        region = { x_px = 400, y_mm = 100, width_px = 100, height_mm = 10 }\n\
        [[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_px = 100\ny_px = 600\nwidth_px = 200\nheight_px = 100\n";
    assert_eq!(bytes(&format!("{DESIGN}{px}")), bytes(&format!("{DESIGN}{mm}")));
}

#[test]
fn on_another_screen_pixels_move_and_millimetres_stay() {
    let layers = "[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nregion = { x_px = 60, y_mm = 12, width_px = 300, height_px = 240 }\n";
    let large = Screen { width_mm: 120.0, height_mm: 180.0, ..Screen::example() };
    let scene =
        scene(&format!("{DESIGN}{layers}")).expect("it reads").with_screen(large, "large").expect("it reads again");
    let program = compile::compile(&scene, &LIMITS, TICK_HZ).expect("it compiles");
    let written = "version = 2\nscreen = { width_mm = 120, height_mm = 180 }\n[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
        region = { x_mm = 12, y_mm = 12, width_mm = 60, height_mm = 36 }\n";
    assert_eq!(program.records[0].region, program_of(written).records[0].region);
    assert_eq!(
        program.notes.iter().filter(|note| note.starts_with("design")).collect::<Vec<_>>(),
        [
            "design: 600 x 1200 px are stretched to the screen's 120 mm x 180 mm: a pixel is 0.2000 mm wide and 0.1500 mm high"
        ]
    );
}

fn program_of(text: &str) -> Program {
    compile::compile(&scene(text).expect("it reads"), &LIMITS, TICK_HZ).expect("it compiles")
}

#[track_caller]
fn check_refused(text: &str, expected: &str) {
    let refused = scene(text).and_then(|scene| compile::compile(&scene, &LIMITS, TICK_HZ));
    assert_eq!(refused.expect_err("it is refused").to_string(), expected);
}

#[test]
fn pixels_that_mean_nothing() {
    let flat = |region: &str| format!("[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\nregion = {{ {region} }}\n");
    check_refused(
        &format!("version = 2\n{}", flat("x_px = 50, y_mm = 0, width_mm = 10, height_mm = 10")),
        "test.toml:5:19: `x_px` is in pixels, and the scene has no design size: add [design] with `width_px` and \
         `height_px`",
    );
    check_refused(
        &format!("{DESIGN}{}", flat("x_px = 50, x_mm = 5, y_mm = 0, width_mm = 10, height_mm = 10")),
        "test.toml:7:19: `x_mm` and `x_px` say the same in two units: leave one of them out",
    );
    check_refused(
        &format!("{DESIGN}{}", flat("x_px = 50, y_px = 0, width_px = 0.05, height_px = 10")),
        "test.toml:7:44: `width_px = 0.05` is out of range: expected 0.1 to 20000 px",
    );
    check_refused(
        &format!("{DESIGN}{}", flat("y_px = 0, width_px = 50, height_px = 10")),
        "test.toml:7:10: this region has no `x_mm` or `x_px`: add one of them",
    );
    check_refused(
        &format!("{DESIGN}{}", flat("shape = \"polygon\", points_px = [[0, 0], [10, 10]]")),
        "test.toml:7:43: `points_px` has 2 entries: expected 3 to 32",
    );
    check_refused(
        &format!("{DESIGN}{}", flat("x_px = 500, y_px = 0, width_px = 150, height_px = 10")),
        "test.toml:7:10: layer 1 (constant) reaches 5 mm past the right edge of the 60 mm x 120 mm screen: move it or \
         make it smaller",
    );
    check_refused("version = 2\ndesign = { width_px = 600 }\n", "test.toml:2:10: [design] has no `height_px`: add it");
    check_refused(
        "version = 2\ndesign = { width_px = 0, height_px = 10 }\n",
        "test.toml:2:23: `width_px = 0` is out of range: expected 1 to 100000 px",
    );
    check_refused(
        "version = 2\ndesign = { width = 600, height_px = 10 }\n",
        "test.toml:2:12: unknown field `width` in [design]; did you mean `width_px`?",
    );
}
