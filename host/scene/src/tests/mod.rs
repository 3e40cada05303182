use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use frixel_control::Board;
use frixel_wire::hello::BoardLimits;

use super::{CompileError, Diagnostic, Program, Scene, compile, compile_draft};

mod agreement;
mod bounds;
mod corpus;
mod cures;
mod docs;
mod drafts;
mod files;
mod hints;
mod json_schema;
mod layers;
mod optimise;
mod pictures;
mod pixels;
mod profiles;
mod random;
mod repeat;
mod schema;

pub(super) const LIMITS: BoardLimits = Board::SIMULATOR.limits;
pub(super) const TICK_HZ: u32 = 40_000;

/// All parts of a scene except its layers; eighteen lines. The natural friction is 0.25 N, and the drive adds at most
/// 27.78 mN.
pub(super) const HEAD: &str = "\
version = 1

[screen]
width_mm = 120
height_mm = 110

[screen.coating]
thickness_um = 10
permittivity = 1

[finger]
radius_mm = 8
stiffness_pa_per_m = 1.8e7
friction_coefficient = 0.5
normal_load_n = 0.5
skin_gap_um = 0
# layers follow

";

/// The pictures of the bundled scenes, and a file that is not a picture.
pub(super) static PICTURES: LazyLock<BTreeMap<String, Vec<u8>>> = LazyLock::new(|| {
    let files = fs::read_dir(scenes().join("textures")).expect("a folder").map(|entry| entry.expect("a file").path());
    let name = |path: &Path| format!("textures/{}", path.file_name().expect("a name").to_string_lossy());
    files.map(|path| (name(&path), fs::read(&path).expect("bytes"))).collect()
});

pub(super) fn scenes() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"))
}

/// Compiles a text, and checks that the schema for editors agrees with the parser about it.
pub(super) fn compile_text(text: &str) -> Result<Program, CompileError> {
    let scene = Scene::parse(text, "test.toml", &*PICTURES);
    schema::check_agrees(text, mistakes(&scene));
    // The cost of a tick has its own tests; other tests may stack many layers.
    let limits = BoardLimits { tick_cycles_max: u32::MAX, ..LIMITS };
    let scene = scene?;
    let compiled = compile(&scene, &limits, TICK_HZ);
    check_draft(&compiled, compile_draft(&scene, &limits, TICK_HZ));
    compiled
}

/// Panics unless a draft is what a board plays or, of a scene that a board refuses, has the board's reasons.
#[track_caller]
fn check_draft(compiled: &Result<Program, CompileError>, draft: Result<Program, CompileError>) {
    match (compiled, draft) {
        (Ok(program), draft) => assert_eq!(draft.as_ref(), Ok(program)),
        // As texts, because a number that was found may be not-a-number.
        (Err(CompileError { diagnostics, .. }), Ok(draft)) => {
            assert_eq!(format!("{:?}", draft.refusals().collect::<Vec<_>>()), format!("{diagnostics:?}"));
        }
        (Err(refused), Err(error)) => assert_eq!(error.to_string(), refused.to_string()),
    }
}

/// The mistakes that were found while a scene was read.
fn mistakes(scene: &Result<Scene, CompileError>) -> &[Diagnostic] {
    scene.as_ref().map_or_else(|error| error.diagnostics.as_slice(), Scene::mistakes)
}

fn compile_layers(layers: &str) -> Program {
    compile_text(&format!("{HEAD}{layers}")).expect("it compiles")
}
