use frixel_wire::scene::{Region, Wave};

use super::*;

const HERE: Region = Region::Rectangle { x_m: 0.01, y_m: 0.02, width_m: 0.03, height_m: 0.04 };

fn constant(blend: Blend, gain: f32, electric_friction_n: f32) -> Layer {
    Layer::new(&Record { region: HERE, blend, gain, layer: Kind::Constant { electric_friction_n } }, None).unwrap()
}

#[allow(clippy::needless_update, reason = "with more features there is more to it")]
fn at(x_m: f32, y_m: f32) -> Moment {
    Moment { x_m, y_m, ..Moment::default() }
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
        close(layer.blend_over(9.0, &at(x_m, y_m), &pool), expected);
    }
}

#[test]
fn add_adds_and_replace_replaces() {
    let pool = BitmapPool::new();
    close(constant(Blend::Add, 1.0, 0.25).blend_over(0.5, &at(0.02, 0.03), &pool), 0.75);
    close(constant(Blend::Replace, 1.0, 0.25).blend_over(0.5, &at(0.02, 0.03), &pool), 0.25);
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
        layer: Kind::Bitmap { crc32: 7, x_m: 0.0, y_m: 0.0, pitch_m: 1.0, black_n: 0.0, white_n: 255.0 },
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
        let found = layer.blend_over(0.0, &at(x_m, y_m), &pool);
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
                layer: Kind::Grating {
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
    close(grating(Wave::Sine).blend_over(0.0, &at(0.3, 0.0), &pool), 0.012);
    close(grating(Wave::Sine).blend_over(0.0, &at(0.3, 0.001), &pool), 0.002);
    close(grating(Wave::Sine).blend_over(0.0, &at(0.3, 0.0005), &pool), 0.007);
    close(grating(Wave::Square).blend_over(0.0, &at(0.3, 0.0002), &pool), 0.012);
    close(grating(Wave::Square).blend_over(0.0, &at(0.3, 0.0008), &pool), 0.002);
}

#[test]
fn a_gain_is_on_the_friction_of_its_layer_alone() {
    let pool = BitmapPool::new();
    let mut layer = constant(Blend::Add, 1.0, 0.25);
    layer.set_gain(-2.0);
    close(layer.blend_over(0.75, &at(0.02, 0.03), &pool), 0.25);
}
