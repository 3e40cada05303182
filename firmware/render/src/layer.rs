//! Layers as the tick evaluates them.

#[cfg(feature = "grating")]
use frixel_wire::scene::Wave;
use frixel_wire::scene::{Blend, Layer as LayerRecord, Record, Region};

use crate::bitmap_pool::{Bitmap, BitmapPool};
#[cfg(feature = "grating")]
use crate::turns;

/// A layer, ready to be evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layer {
    /// `None` for a layer that acts everywhere.
    bounds: Option<Bounds>,
    blend: Blend,
    source: Source,
}

/// Where a layer acts: left and top belong to it, right and bottom do not.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounds {
    left_m: f32,
    top_m: f32,
    right_m: f32,
    bottom_m: f32,
}

/// What a layer evaluates to, its gain folded in.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    Constant {
        electric_friction_n: f32,
    },
    /// `middle + swing w(kx x + ky y + phase)`, with `w` a cosine, or 1 in the first half turn and -1 in the second.
    #[cfg(feature = "grating")]
    Grating {
        wave: Wave,
        cycles_per_m_x: f32,
        cycles_per_m_y: f32,
        phase_turns: f32,
        middle_n: f32,
        swing_n: f32,
    },
    #[cfg(feature = "bitmap")]
    Bitmap {
        offset: u32,
        width: u16,
        height: u16,
        samples_per_m: f32,
        /// Place of the first sample's centre, in m.
        x_m: f32,
        y_m: f32,
        black_n: f32,
        per_level_n: f32,
    },
}

impl Layer {
    /// The layer of a record whose numbers were checked, and whose bitmap, if it has one, lies at `bitmap`; `None` for
    /// a kind that this firmware was built without.
    #[cfg_attr(not(feature = "bitmap"), allow(unused_variables, reason = "the other kinds of layer have no bitmap"))]
    #[cfg_attr(
        all(feature = "grating", feature = "bitmap"),
        allow(clippy::unnecessary_wraps, reason = "no kind is left out")
    )]
    pub(crate) fn new(record: &Record, bitmap: Option<Bitmap>) -> Option<Self> {
        let gain = record.gain;
        let source = match record.layer {
            LayerRecord::Constant { electric_friction_n } => {
                Source::Constant { electric_friction_n: gain * electric_friction_n }
            }
            #[cfg(feature = "grating")]
            LayerRecord::Grating { wave, cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n, crest_n } => {
                // A sine is a cosine a quarter of a turn later.
                let later_turns = if wave == Wave::Sine { 0.25 } else { 0.0 };
                Source::Grating {
                    wave,
                    cycles_per_m_x,
                    cycles_per_m_y,
                    phase_turns: phase_turns - later_turns,
                    middle_n: 0.5 * gain * (crest_n + trough_n),
                    swing_n: 0.5 * gain * (crest_n - trough_n),
                }
            }
            #[cfg(feature = "bitmap")]
            LayerRecord::Bitmap { x_m, y_m, pitch_m, black_n, white_n, .. } => {
                let (offset, width, height) = bitmap.map_or((0, 0, 0), |b| (b.offset, b.width, b.height));
                Source::Bitmap {
                    offset,
                    width,
                    height,
                    samples_per_m: 1.0 / pitch_m,
                    x_m: x_m + 0.5 * pitch_m,
                    y_m: y_m + 0.5 * pitch_m,
                    black_n: gain * black_n,
                    per_level_n: gain * (white_n - black_n) / 255.0,
                }
            }
            #[cfg(not(all(feature = "grating", feature = "bitmap")))]
            _ => return None,
        };
        Some(Self { bounds: Bounds::new(record.region), blend: record.blend, source })
    }

    /// Joins this layer's electric friction at a place to that of the layers below.
    #[inline]
    pub(crate) fn blend_over(&self, below_n: f32, x_m: f32, y_m: f32, pool: &BitmapPool) -> f32 {
        if let Some(bounds) = &self.bounds
            && !bounds.contain(x_m, y_m)
        {
            return below_n;
        }
        let own_n = self.source.electric_friction_n(x_m, y_m, pool);
        match self.blend {
            Blend::Replace => own_n,
            Blend::Add => below_n + own_n,
        }
    }
}

impl Bounds {
    fn new(region: Region) -> Option<Self> {
        match region {
            Region::Screen => None,
            Region::Rectangle { x_m, y_m, width_m, height_m } => {
                Some(Self { left_m: x_m, top_m: y_m, right_m: x_m + width_m, bottom_m: y_m + height_m })
            }
        }
    }

    #[inline]
    fn contain(&self, x_m: f32, y_m: f32) -> bool {
        x_m >= self.left_m && x_m < self.right_m && y_m >= self.top_m && y_m < self.bottom_m
    }
}

impl Source {
    /// Electric friction at a place, in N.
    ///
    /// Not inlined: a loop over layers would begin with the constants of every kind, and go past away layers slowly.
    #[inline(never)]
    #[cfg_attr(
        not(all(feature = "grating", feature = "bitmap")),
        allow(unused_variables, reason = "the other kinds of layer do not look at them")
    )]
    fn electric_friction_n(&self, x_m: f32, y_m: f32, pool: &BitmapPool) -> f32 {
        match *self {
            Self::Constant { electric_friction_n } => electric_friction_n,
            #[cfg(feature = "grating")]
            Self::Grating { wave, cycles_per_m_x, cycles_per_m_y, phase_turns, middle_n, swing_n } => {
                let turns = x_m * cycles_per_m_x + y_m * cycles_per_m_y + phase_turns;
                let height = match wave {
                    Wave::Sine => turns::cosine(turns),
                    Wave::Square => 1.0_f32.copysign(turns::centred(turns)),
                };
                middle_n + swing_n * height
            }
            #[cfg(feature = "bitmap")]
            Self::Bitmap { offset, width, height, samples_per_m, x_m: left_m, y_m: top_m, black_n, per_level_n } => {
                let (column, next_column, right) = neighbours((x_m - left_m) * samples_per_m, width);
                let (row, next_row, down) = neighbours((y_m - top_m) * samples_per_m, height);
                let first = offset as usize + row * usize::from(width);
                let second = offset as usize + next_row * usize::from(width);
                let level = |row: usize, column: usize| f32::from(pool.sample(row + column));
                let upper = mix(level(first, column), level(first, next_column), right);
                let lower = mix(level(second, column), level(second, next_column), right);
                black_n + per_level_n * mix(upper, lower, down)
            }
        }
    }
}

/// The two samples on either side of a place, and how far it is from the first to the second. Held at the border.
#[cfg(feature = "bitmap")]
#[inline]
fn neighbours(place: f32, count: u16) -> (usize, usize, f32) {
    let last = u32::from(count.saturating_sub(1));
    let place = if place > 0.0 { place } else { 0.0 };
    // Beyond the last sample both are the last, whatever the distance.
    let index = (place as u32).min(last);
    (index as usize, (index + 1).min(last) as usize, place - index as f32)
}

#[cfg(feature = "bitmap")]
#[inline]
fn mix(from: f32, to: f32, part: f32) -> f32 {
    from + part * (to - from)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Region = Region::Rectangle { x_m: 0.01, y_m: 0.02, width_m: 0.03, height_m: 0.04 };

    fn constant(blend: Blend, gain: f32, electric_friction_n: f32) -> Layer {
        Layer::new(&Record { region: HERE, blend, gain, layer: LayerRecord::Constant { electric_friction_n } }, None)
            .unwrap()
    }

    fn close(found: f32, expected: f32) {
        assert!((found - expected).abs() <= 1e-6, "{found} is not {expected}");
    }

    #[test]
    fn a_region_takes_its_left_and_top_edge_and_leaves_right_and_bottom() {
        let pool = BitmapPool::new();
        let layer = constant(Blend::Replace, 2.0, 0.25);
        for (x_m, y_m, expected) in
            [(0.01, 0.02, 0.5), (0.039, 0.059, 0.5), (0.04, 0.03, 9.0), (0.02, 0.06, 9.0), (0.0099, 0.03, 9.0)]
        {
            close(layer.blend_over(9.0, x_m, y_m, &pool), expected);
        }
    }

    #[test]
    fn add_adds_and_replace_replaces() {
        let pool = BitmapPool::new();
        close(constant(Blend::Add, 1.0, 0.25).blend_over(0.5, 0.02, 0.03, &pool), 0.75);
        close(constant(Blend::Replace, 1.0, 0.25).blend_over(0.5, 0.02, 0.03, &pool), 0.25);
    }

    #[cfg(feature = "bitmap")]
    #[test]
    fn a_bitmap_is_bilinear_between_centres_and_held_at_its_border() {
        let pool = BitmapPool::new();
        pool.write(5, &[0, 100, 200, 50]);
        let record = Record {
            region: Region::Screen,
            blend: Blend::Replace,
            gain: 1.0,
            layer: LayerRecord::Bitmap { crc32: 7, x_m: 0.0, y_m: 0.0, pitch_m: 1.0, black_n: 0.0, white_n: 255.0 },
        };
        let layer = Layer::new(&record, Some(Bitmap { crc32: 7, offset: 5, width: 2, height: 2 })).unwrap();
        for (x_m, y_m, expected) in [
            (0.5, 0.5, 0.0),
            (1.5, 0.5, 100.0),
            (1.0, 0.5, 50.0),
            (0.5, 1.0, 100.0),
            (1.0, 1.0, 87.5),
            (-3.0, -3.0, 0.0),
            (9.0, 9.0, 50.0),
        ] {
            let found = layer.blend_over(0.0, x_m, y_m, &pool);
            assert!((found - expected).abs() < 1e-4, "({x_m}, {y_m}): {found} is not {expected}");
        }
    }

    #[cfg(feature = "grating")]
    #[test]
    fn a_grating_swings_between_trough_and_crest() {
        let pool = BitmapPool::new();
        let grating = |wave| {
            Layer::new(
                &Record {
                    region: Region::Screen,
                    blend: Blend::Replace,
                    gain: 1.0,
                    layer: LayerRecord::Grating {
                        wave,
                        cycles_per_m_x: 0.0,
                        cycles_per_m_y: 500.0,
                        phase_turns: 0.25,
                        trough_n: 0.002,
                        crest_n: 0.012,
                    },
                },
                None,
            )
            .unwrap()
        };
        close(grating(Wave::Sine).blend_over(0.0, 0.3, 0.0, &pool), 0.012);
        close(grating(Wave::Sine).blend_over(0.0, 0.3, 0.001, &pool), 0.002);
        close(grating(Wave::Sine).blend_over(0.0, 0.3, 0.0005, &pool), 0.007);
        close(grating(Wave::Square).blend_over(0.0, 0.3, 0.0002, &pool), 0.012);
        close(grating(Wave::Square).blend_over(0.0, 0.3, 0.0008, &pool), 0.002);
    }
}
