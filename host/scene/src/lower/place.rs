//! Converts places on the screen from millimetres and degrees to metres and turns.

use frixel_layers::{Header, Region as WireRegion};

use super::super::file::Scene;
use super::super::layer::{Layer, Rectangle};
use super::super::log::Log;
use super::super::mistake::FitMistake;
use super::MM;

/// Tolerance for a layer that extends past the screen by rounding, mm.
const OFF_SCREEN_MM: f64 = 1e-6;

/// Cycles per metre along x and y; exact for right angles.
pub(crate) fn wave_vector(wavelength_mm: f64, angle_deg: f64) -> (f32, f32) {
    let cycles_per_m = 1.0 / (wavelength_mm * MM);
    let (cos, sin) = direction(angle_deg);
    ((cycles_per_m * cos) as f32, (cycles_per_m * sin) as f32)
}

/// Cosine and sine of an angle; exact for right angles.
pub(crate) fn direction(angle_deg: f64) -> (f64, f64) {
    let exact = |part: f64| if part.abs() < 1e-12 { 0.0 } else { part };
    (exact(libm::cos(angle_deg.to_radians())), exact(libm::sin(angle_deg.to_radians())))
}

/// An angle in turns.
pub(crate) fn turns(angle_deg: f64) -> f32 {
    (angle_deg / 360.0) as f32
}

/// Refuses a layer that extends past the screen. A draft plays the part of it on the screen.
pub(crate) fn check_on_screen(scene: &Scene, layer: &Layer, rectangle: Rectangle, log: &mut Log) {
    let (screen_width_mm, screen_height_mm) = (scene.screen().width_mm, scene.screen().height_mm);
    let past = [
        ("left", -rectangle.x_mm),
        ("top", -rectangle.y_mm),
        ("right", rectangle.x_mm + rectangle.width_mm - screen_width_mm),
        ("bottom", rectangle.y_mm + rectangle.height_mm - screen_height_mm),
    ];
    let furthest = past.into_iter().max_by(|(_, one), (_, other)| one.total_cmp(other));
    if let Some((edge, beyond_mm)) = furthest.filter(|(_, beyond_mm)| *beyond_mm > OFF_SCREEN_MM) {
        let field = if layer.region.is_some() { "region" } else { "x_mm" };
        // Round up to a micrometre, so that moving by this distance suffices.
        let beyond_mm = (beyond_mm * 1e3 - 1e-6).ceil() / 1e3;
        let layer_title = layer.title.to_string();
        log.add(
            layer.places.field(field),
            FitMistake::OffScreen { layer: layer_title, edge, beyond_mm, screen_width_mm, screen_height_mm },
        );
    }
}

/// The region of a rectangle. A rectangle that covers the whole screen becomes the screen, which costs the board
/// nothing. A button keeps its sides.
pub(crate) fn rectangle(rectangle: Rectangle, header: &Header, button: bool) -> WireRegion {
    let [x_m, y_m, width_m, height_m] = stretches(rectangle, header);
    let everywhere = x_m <= 0.0 && y_m <= 0.0 && width_m >= header.screen_width_m && height_m >= header.screen_height_m;
    if everywhere && !button { WireRegion::Screen } else { WireRegion::Rectangle { x_m, y_m, width_m, height_m } }
}

pub(crate) fn ellipse(rectangle: Rectangle, header: &Header) -> WireRegion {
    let [x_m, y_m, width_m, height_m] = stretches(rectangle, header);
    WireRegion::Ellipse { x_m, y_m, width_m, height_m }
}

fn stretches(rectangle: Rectangle, header: &Header) -> [f32; 4] {
    let (x_m, width_m) = stretch(rectangle.x_mm, rectangle.width_mm, header.screen_width_m);
    let (y_m, height_m) = stretch(rectangle.y_mm, rectangle.height_mm, header.screen_height_m);
    [x_m, y_m, width_m, height_m]
}

/// Start and length of a side in metres. The length is shortened if rounding would extend it past the screen, but not
/// if the side is meant to extend past it, as in a draft.
fn stretch(start_mm: f64, length_mm: f64, screen_m: f32) -> (f32, f32) {
    let screen_mm = f64::from(screen_m) / MM;
    let rounding_mm = OFF_SCREEN_MM + f64::from(f32::EPSILON) * screen_mm;
    if start_mm < -rounding_mm || start_mm + length_mm > screen_mm + rounding_mm {
        return ((start_mm * MM) as f32, (length_mm * MM) as f32);
    }
    let start_m = ((start_mm * MM) as f32).max(0.0);
    let room_m = f64::from(screen_m) - f64::from(start_m);
    let rounded_m = room_m as f32;
    let room_m = if f64::from(rounded_m) > room_m { rounded_m.next_down() } else { rounded_m };
    (start_m, ((length_mm * MM) as f32).min(room_m))
}
