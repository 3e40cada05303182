use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use frixel_wire::hello::BoardLimits;

use super::{CompileError, Program, Scene, compile};

mod docs;
mod errors;
mod json_schema;
mod layers;
mod optimise;
mod schema;

/// A board like the simulated one.
pub(super) const LIMITS: BoardLimits = BoardLimits {
    bitmap_pool_bytes: 64 * 1024,
    records_max: 64,
    receive_window_bytes: 4096,
    voltage_max_v_peak: 220.0,
    full_scale_v_peak: 250.0,
    edge_time_constant_s: 20e-6,
    electrode_capacitance_max_f: 0.53e-9,
    current_max_a_rms: 3e-3,
    current_max_a_peak: 15e-3,
    touch_report_period_s: 0.01,
    tick_cycles_max: 2_550,
};
pub(super) const TICK_HZ: u32 = 40_000;

/// Everything a scene needs but its layers; eighteen lines. The natural friction is 0.25 N, and the drive adds at
/// most 27.78 mN.
pub(super) const HEAD: &str = "\
version = 1

[screen]
width_mm = 120
height_mm = 110

[coating]
thickness_um = 10
permittivity = 1

[finger]
radius_mm = 8
stiffness_pa_per_m = 1.8e7
friction_coefficient = 0.5
normal_load_n = 0.5

# layers follow

";

/// The pictures of the bundled scenes, and a file that is none.
pub(super) static PICTURES: LazyLock<BTreeMap<String, Vec<u8>>> = LazyLock::new(|| {
    let files = fs::read_dir(scenes().join("textures")).expect("a folder").map(|entry| entry.expect("a file").path());
    let name = |path: &Path| format!("textures/{}", path.file_name().expect("a name").to_string_lossy());
    files.map(|path| (name(&path), fs::read(&path).expect("bytes"))).collect()
});

pub(super) fn scenes() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"))
}

/// Compiles a text, and sees that the schema for editors thinks of it as the parser does.
pub(super) fn compile_text(text: &str) -> Result<Program, CompileError> {
    let scene = Scene::parse(text, "test.toml", &*PICTURES);
    schema::check_agrees(text, scene.as_ref().err());
    // What a tick takes has tests of its own; others may pile up layers.
    compile::compile(&scene?, &BoardLimits { tick_cycles_max: u32::MAX, ..LIMITS }, TICK_HZ)
}

/// A scene of the repository.
fn bundled(name: &str) -> Scene {
    let text = fs::read_to_string(scenes().join(name)).expect(name);
    Scene::parse(&text, name, &*PICTURES).expect(name)
}

fn compile_layers(layers: &str) -> Program {
    compile_text(&format!("{HEAD}{layers}")).expect("it compiles")
}
