//! The codes of the DAC are those of session and ticker in this process, bit for bit, under a finger that slides over a
//! grating: tracks, layers, table, envelope and carrier.

use std::collections::BTreeSet;
use std::time::Duration;

use super::bench::{Bench, GRATING};
use super::twin::Twin;
use crate::emulator;

/// Smallest number of compared ticks, from the first nonzero code on.
const TICKS: usize = 2_400;

/// The codes from the first nonzero one on.
fn driven(codes: impl IntoIterator<Item = i16>) -> Vec<i16> {
    codes.into_iter().skip_while(|code| *code == 0).collect()
}

#[test]
fn a_grating_under_a_sliding_finger_has_the_codes_of_the_in_process_board() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::just_on(&image);
    bench.with(|rig| assert!(rig.watch_orders().unwrap(), "the image names the functions of the tick"));
    bench.pass(Duration::from_millis(50));
    let mut host = bench.connect();
    bench.start(&mut host, GRATING);
    host.wait(Duration::from_millis(320), &mut |_| ()).unwrap();
    let found = driven(bench.take_records().iter().map(|record| record.drive.dac_code.bits()));
    let expected = driven(Twin::codes(&bench.with(|rig| rig.take_watched().unwrap())));
    assert!(found.len() >= TICKS, "it drives for {} ticks", found.len());
    let distinct: BTreeSet<i16> = found.iter().copied().collect();
    assert!(
        distinct.len() > TICKS / 4 && distinct.first() < Some(&0),
        "the stripes alternate: {} codes",
        distinct.len()
    );
    // The code of the last tick is not latched yet.
    assert_eq!(found.len() + 1, expected.len(), "both drive as long");
    let same = expected.iter().zip(&found).take_while(|(one, other)| one == other).count();
    assert_eq!(same, found.len(), "the first {same} codes are the same");
}
