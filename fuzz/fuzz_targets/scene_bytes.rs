//! Parses arbitrary bytes as a compiled scene. They are rejected, or every record can be read and written back.
#![no_main]

use frixel_layers::Scene;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(scene) = Scene::parse(bytes) else { return };
    let records: Vec<_> = scene.records().collect();
    let points: Vec<_> = scene.points().collect();
    let mut written = scene.header().write(records.len() as u8, points.len() as u8).to_vec();
    written.extend(records.iter().flat_map(|record| record.write()));
    written.extend(points.iter().flat_map(|point| point.write()));
    let again = Scene::parse(&written).expect("what was read can be written");
    let records_again: Vec<_> = again.records().collect();
    let points_again: Vec<_> = again.points().collect();
    // Compare the text, because not-a-number is not equal to itself.
    assert_eq!(format!("{records:?} {points:?}"), format!("{records_again:?} {points_again:?}"));
});
