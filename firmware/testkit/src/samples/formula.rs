//! The friction of a scene file as a formula of the place, from the definitions in `docs/design/scenes.md`: mm, mN,
//! `f64`.

use core::f64::consts::TAU;

/// A scene, and its electric friction as a function of place.
pub struct Formula {
    /// Name of the formula.
    pub name: &'static str,
    /// The layers of the scene as TOML, on the example screen.
    pub toml: &'static str,
    /// Ends of the stroke on which the friction is compared, mm.
    pub stroke_mm: [(f64, f64); 2],
    /// Electric friction at a place in mm, mN.
    pub friction_mn: fn(f64, f64) -> f64,
    /// Whether the friction jumps, so that a rounded place may lie on the other side.
    pub jumps: bool,
    /// Tolerance of the felt friction, as a part of the reachable range: a fifth above the measured deviation.
    pub bound: f64,
}

/// From left to right, and a little down.
pub(super) const ACROSS: [(f64, f64); 2] = [(5.0, 30.0), (115.0, 45.0)];

/// Fraction of a turn, from 0 to 1.
pub fn turn(turns: f64) -> f64 {
    turns - turns.floor()
}

/// A sine between 0 and 1 of an angle in turns.
pub fn sine(turns: f64) -> f64 {
    0.5 + 0.5 * (TAU * turns).sin()
}

/// Coordinate of a place along a direction in degrees, from x towards y.
pub fn along_deg(x: f64, y: f64, degrees: f64) -> f64 {
    x * degrees.to_radians().cos() + y * degrees.to_radians().sin()
}

/// Noise between 0 and 1, as defined in `PROTOCOL.md`; wavelengths in mm.
pub fn noise(seed: u32, shortest: f64, longest: f64, x: f64, y: f64) -> f64 {
    let hash = |number: u32| {
        let mut v = seed.wrapping_add(number.wrapping_mul(0x9e37_79b9));
        v = (v ^ v >> 16).wrapping_mul(0x7feb_352d);
        v = (v ^ v >> 15).wrapping_mul(0x846c_a68b);
        f64::from((v ^ v >> 16) >> 8) / f64::from(1 << 24)
    };
    let sum: f64 = (0..8_u32)
        .map(|i| {
            let direction = 360.0 * (f64::from(i) + hash(3 * i + 1)) / 16.0;
            let number =
                1.0 / longest + (1.0 / shortest - 1.0 / longest) * (f64::from(5 * i % 8) + hash(3 * i + 2)) / 8.0;
            (TAU * (number * along_deg(x, y, direction) + hash(3 * i + 3))).cos()
        })
        .sum();
    0.5 + 0.5 * sum / 8.0
}
