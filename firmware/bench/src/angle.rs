//! Cost of the angle of a place, compared with `libm`.

use core::hint::black_box;

use frixel_layers::angle_turns;

use crate::count::Counter;

/// Half the side of the grid of places around the middle, in steps, and the length of a step, m.
const SIDE: i32 = 40;
const STEP_M: f32 = 1.3e-3;

/// Counts both implementations.
pub fn run(counter: &mut Counter) {
    let mut fast = counter.case("angle");
    let mut libm = counter.case("angle_libm");
    for row in -SIDE..=SIDE {
        for column in -SIDE..=SIDE {
            let place_m = black_box([STEP_M * column as f32, STEP_M * row as f32]);
            black_box(fast.take(in_turns, &mut (), place_m));
            black_box(libm.take(with_libm, &mut (), place_m));
        }
    }
    fast.report();
    libm.report();
}

#[inline(never)]
fn in_turns((): &mut (), [x_m, y_m]: [f32; 2]) -> f32 {
    angle_turns(x_m, y_m)
}

#[inline(never)]
fn with_libm((): &mut (), [x_m, y_m]: [f32; 2]) -> f32 {
    libm::atan2f(y_m, x_m)
}
