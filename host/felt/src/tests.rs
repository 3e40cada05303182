//! Helpers shared by the tests of several modules.

use std::collections::BTreeMap;

use frixel_control::Board;
use frixel_scene::{Program, Scene, compile};
use frixel_wire::hello::BoardLimits;

pub(crate) const LIMITS: BoardLimits = Board::SIMULATOR.limits;
pub(crate) const TICK_HZ: u32 = 40_000;

/// All parts of a scene except its layers. The natural friction is 0.25 N, and the drive adds at most 27.78 mN.
const HEAD: &str = "\
version = 1
screen = { width_mm = 120, height_mm = 110, coating = { thickness_um = 10, permittivity = 1 } }
finger = { radius_mm = 8, stiffness_pa_per_m = 1.8e7, friction_coefficient = 0.5, normal_load_n = 0.5, skin_gap_um = 0 }
";

/// A scene with these layers.
pub(crate) fn program(layers: &str) -> Program {
    compiled(&format!("{HEAD}{layers}"))
}

/// A scene, without a limit on its ticks' cost.
pub(crate) fn compiled(text: &str) -> Program {
    let scene = Scene::parse(text, "test.toml", &BTreeMap::new()).expect("it is a scene");
    let limits = BoardLimits { tick_cycles_max: u32::MAX, ..LIMITS };
    compile(&scene, &limits, TICK_HZ).expect("it compiles")
}
