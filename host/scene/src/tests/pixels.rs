//! Places and sizes in pixels of a design.

use super::*;
use crate::Screen;

const DESIGN: &str =
    "version = 1\nscreen = { width_mm = 60, height_mm = 120 }\ndesign = { width_px = 600, height_px = 1200 }\n";

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
    let scene = scene(&format!("{DESIGN}{layers}")).expect("it reads").with_screen(large, "large");
    let program = compile::compile(&scene, &LIMITS, TICK_HZ).expect("it compiles");
    let written = "version = 1\nscreen = { width_mm = 120, height_mm = 180 }\n[[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n\
        region = { x_mm = 12, y_mm = 12, width_mm = 60, height_mm = 36 }\n";
    assert_eq!(program.records[0].region, program_of(written).records[0].region);
    assert_eq!(
        program.notes().filter(|note| note.starts_with("design")).collect::<Vec<_>>(),
        [
            "design: 600 x 1200 px are stretched to the screen's 120 mm x 180 mm: a pixel is 0.2000 mm wide and 0.1500 mm high"
        ]
    );
}

fn program_of(text: &str) -> Program {
    compile::compile(&scene(text).expect("it reads"), &LIMITS, TICK_HZ).expect("it compiles")
}
