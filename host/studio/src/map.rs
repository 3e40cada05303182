//! The friction map of a scene.

use frixel_felt::{FrictionMap, Preview, ReachSide, TO_THE_END};

use crate::host_error::HostError;
use crate::program::drafted;
use crate::request::{Numbers, Request};

/// The names of the numbers before the map: its size, and the least and the largest friction that can be reached.
pub(crate) const MAP_HEAD: [&str; 4] = ["widthPx", "heightPx", "lowN", "highN"];

/// The map of a request's scene, as bytes of `f32`: the numbers of [`MAP_HEAD`], then the target friction of every
/// pixel in N, row after row from the top left, then 0 for each pixel that is within reach, 1 for one above and -1 for
/// one below.
pub(crate) fn map(request: &Request) -> Result<Vec<u8>, HostError> {
    let (_, program) = drafted(request)?;
    let Numbers { width_px, height_px, speed_mm_per_s, .. } = request.numbers;
    let preview = Preview { speed_m_per_s: 1e-3 * speed_mm_per_s, map_max: (width_px.max(1), height_px.max(1)) };
    let map = FrictionMap::new(&program, &preview, TO_THE_END);
    let reach = &program.reach;
    let head: [f64; MAP_HEAD.len()] =
        [map.grid.width as f64, map.grid.height as f64, reach.friction_min_n(), reach.friction_max_n()];
    let friction_n =
        map.parts_of_reach.iter().map(|part| reach.natural_friction_n + part * reach.electric_friction_max_n);
    let sides = map.parts_of_reach.iter().map(|part| match ReachSide::of(*part) {
        ReachSide::Below => -1.0,
        ReachSide::Within => 0.0,
        ReachSide::Above => 1.0,
    });
    Ok(head.into_iter().chain(friction_n).chain(sides).flat_map(|value| (value as f32).to_le_bytes()).collect())
}
