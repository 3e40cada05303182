//! Where a layer has room on a screen.

/// Left, top, width and height, mm.
pub(super) type BoxMm = [f64; 4];

/// Sides of a layer that is added are multiples of this, mm.
const GRID_MM: f64 = 0.5;
/// Room between a layer that is added and others, mm.
const GAP_MM: f64 = 2.0;
/// Places that are tried for a layer along each side of the screen.
const PLACES: usize = 24;
/// Cost of a covered square millimetre, in distances from the middle to the border.
const COVERED: f64 = 1000.0;

/// A box of a size that covers as little as can be of what is there, as near to the middle as can be.
pub(super) fn roomiest(size_mm: [f64; 2], screen_mm: [f64; 2], taken_mm: &[BoxMm]) -> BoxMm {
    let [width, height] = size_mm.map(|mm| down(mm).max(GRID_MM));
    let room = [screen_mm[0] - width, screen_mm[1] - height];
    let parts = || (0..=PLACES).map(|step| step as f64 / PLACES as f64);
    let places = parts().flat_map(|y| parts().map(move |x| [x, y]));
    let boxes = places.map(|[x, y]| {
        let place = [down(room[0] * x), down(room[1] * y), width, height];
        let covered: f64 = taken_mm.iter().map(|other| overlap(wider(place), *other)).sum();
        (covered * COVERED + (x - 0.5).hypot(y - 0.5), place)
    });
    boxes.min_by(|(one, _), (other, _)| one.total_cmp(other)).map_or([0.0, 0.0, width, height], |(_, place)| place)
}

fn down(mm: f64) -> f64 {
    (mm / GRID_MM).floor() * GRID_MM
}

fn wider([x, y, width, height]: BoxMm) -> BoxMm {
    [x - GAP_MM, y - GAP_MM, width + 2.0 * GAP_MM, height + 2.0 * GAP_MM]
}

/// The area that two boxes share, mm².
fn overlap(one: BoxMm, other: BoxMm) -> f64 {
    let along = |at: usize| (one[at] + one[at + 2]).min(other[at] + other[at + 2]) - one[at].max(other[at]);
    along(0).max(0.0) * along(1).max(0.0)
}
