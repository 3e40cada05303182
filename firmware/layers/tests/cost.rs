//! The estimated cost of a scene.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use frixel_layers::cost::{FLASH_WAIT_PERCENT, of_empty_scene, of_record, worst_of_scene};
use frixel_layers::{Blend, Layer, Noise, Point, Record, Region, Stream};
use frixel_testkit::{HEADER, constant};
use frixel_wire::hello::Core;

const CONSTANT: Record = Record { blend: Blend::Add, ..constant(0.001) };

/// A stream costs cycles wherever the finger is, once for all layers that play it.
#[test]
fn a_stream_costs_at_every_place() {
    let stream = |x_m| Record {
        region: Region::Rectangle { x_m, y_m: 0.0, width_m: 1e-3, height_m: 1e-3 },
        layer: Layer::Stream(Stream { low_n: 0.0, high_n: 0.01 }),
        ..CONSTANT
    };
    let noise = Record {
        region: Region::Rectangle { x_m: 0.08, y_m: 0.05, width_m: 1e-3, height_m: 1e-3 },
        layer: Layer::Noise(Noise {
            seed: 1,
            wavelength_min_m: 1e-3,
            wavelength_max_m: 2e-3,
            low_n: 0.0,
            high_n: 0.01,
        }),
        ..CONSTANT
    };
    let of = |records: &[Record]| worst_of_scene(&HEADER, records, &[], Core::CortexM4f).core_cycles;
    let alone = of_empty_scene(&HEADER) + of_record(&noise, &[]);
    assert_eq!(of(&[noise]), alone.on(Core::CortexM4f));
    let with_stream = of(&[noise, stream(0.0)]);
    assert!(with_stream > of(&[noise]) && with_stream > of(&[stream(0.0)]), "{with_stream}");
    assert_eq!(of(&[noise, stream(0.0), stream(0.03)]), with_stream);
}

/// An edge level with the finger takes a closer test.
#[test]
fn a_polygon_costs_more_with_more_edges_at_one_height() {
    for core in [Core::CortexM4f, Core::CortexM0Plus] {
        polygons_cost_by_their_level_edges(core);
    }
}

fn polygons_cost_by_their_level_edges(core: Core) {
    let polygon = |vertices: &[(f32, f32)]| {
        let before = Point { x: 9.0, y: 9.0 };
        let points: Vec<Point> = std::iter::once(before).chain(vertices.iter().map(|&(x, y)| Point { x, y })).collect();
        let region = Region::Polygon { first: 1, count: vertices.len() as u8 };
        of_record(&Record { region, ..CONSTANT }, &points).on(core)
    };
    let convex = polygon(&[(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (2.0, 2.0), (0.0, 2.0), (-1.0, 1.0)]);
    let hill = polygon(&[(0.0, 0.0), (5.0, 0.0), (4.0, 2.0), (3.0, 1.0), (2.0, 2.0), (1.0, 1.0)]);
    let zigzag = polygon(&[(0.0, 0.0), (1.0, 2.0), (2.0, 0.0), (3.0, 2.0), (4.0, 0.0), (5.0, 2.0)]);
    let each = (hill - convex) / 2;
    assert!(each > 0);
    assert_eq!((hill - convex, zigzag - convex), (2 * each, 4 * each));
}

/// Neither core's costs follow from the other's by a factor.
#[test]
fn noise_costs_relatively_more_without_a_floating_point_unit() {
    let noise = Noise { seed: 1, wavelength_min_m: 1e-3, wavelength_max_m: 2e-3, low_n: 0.0, high_n: 0.01 };
    let noise = of_record(&Record { layer: Layer::Noise(noise), ..CONSTANT }, &[]);
    let constant = of_record(&CONSTANT, &[]);
    let ratio = |core| f64::from(noise.on(core)) / f64::from(constant.on(core));
    assert!(ratio(Core::CortexM0Plus) > 2.0 * ratio(Core::CortexM4f));
}

/// The cycles of a Cortex-M4F contain flash wait states, those of a Cortex-M0+ do not: it runs from RAM.
#[test]
fn cycles_include_the_wait_states_of_the_core() {
    let worst = |core| worst_of_scene(&HEADER, &[CONSTANT], &[], core);
    let (m4f, m0_plus) = (worst(Core::CortexM4f), worst(Core::CortexM0Plus));
    assert_eq!(m4f.cycles(Core::CortexM4f), (m4f.core_cycles * FLASH_WAIT_PERCENT).div_ceil(100));
    assert_eq!(m0_plus.cycles(Core::CortexM0Plus), m0_plus.core_cycles);
    assert!(m0_plus.core_cycles > 5 * m4f.core_cycles);
}
