//! What a scene is estimated to cost.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use frixel_layers::cost::{of_empty_scene, of_record, worst_of_scene};
use frixel_layers::{Blend, Layer, Noise, Point, Record, Region, Stream};
use frixel_testkit::{HEADER, constant};

const CONSTANT: Record = Record { blend: Blend::Add, ..constant(0.001) };

/// The stream goes on wherever the finger is, and once for all layers that play it.
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
    let of = |records: &[Record]| worst_of_scene(&HEADER, records, &[]).core_cycles;
    let empty = of_empty_scene(&HEADER);
    assert_eq!(of(&[noise]), empty + of_record(&noise, &[]));
    let with_stream = of(&[noise, stream(0.0)]);
    assert!(with_stream > of(&[noise]) && with_stream > of(&[stream(0.0)]), "{with_stream}");
    assert_eq!(of(&[noise, stream(0.0), stream(0.03)]), with_stream);
}

/// An edge that is level with the finger is looked at closely.
#[test]
fn a_polygon_costs_more_the_more_of_its_edges_are_level_with_one_place() {
    let polygon = |vertices: &[(f32, f32)]| {
        let before = Point { x: 9.0, y: 9.0 };
        let points: Vec<Point> = std::iter::once(before).chain(vertices.iter().map(|&(x, y)| Point { x, y })).collect();
        let region = Region::Polygon { first: 1, count: vertices.len() as u8 };
        of_record(&Record { region, ..CONSTANT }, &points)
    };
    let convex = polygon(&[(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (2.0, 2.0), (0.0, 2.0), (-1.0, 1.0)]);
    let hill = polygon(&[(0.0, 0.0), (5.0, 0.0), (4.0, 2.0), (3.0, 1.0), (2.0, 2.0), (1.0, 1.0)]);
    let zigzag = polygon(&[(0.0, 0.0), (1.0, 2.0), (2.0, 0.0), (3.0, 2.0), (4.0, 0.0), (5.0, 2.0)]);
    let each = (hill - convex) / 2;
    assert!(each > 0);
    assert_eq!((hill - convex, zigzag - convex), (2 * each, 4 * each));
}
