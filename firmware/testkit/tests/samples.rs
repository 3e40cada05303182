//! Every kind of layer has a sample.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use frixel_layers::Layer;
use frixel_layers::cost::{MEASURED_LAYERS, of_record};
use frixel_testkit::RandomScene;
use frixel_testkit::record;
use frixel_testkit::samples::{POINTS, samples};

#[test]
fn every_kind_has_a_sample() {
    let mut numbers: Vec<u8> = samples().map(|sample| sample.records[0].record.layer.number()).collect();
    numbers.sort_unstable();
    assert_eq!(numbers, Layer::NUMBERS, "numbers of the kinds with a sample, and of all kinds");
    for sample in samples() {
        let number = sample.records[0].record.layer.number();
        assert!(sample.records.iter().all(|record| record.record.layer.number() == number));
        assert!(sample.costs.iter().all(|cost| cost.layer.number() == number));
    }
}

/// The estimated cost of a layer is the cost measured under the name of its case.
#[test]
fn samples_cost_what_was_measured() {
    let measured = |name: &str| {
        let (_, core_cycles) = MEASURED_LAYERS.iter().find(|(measured, _)| *measured == name).unwrap_or_else(|| {
            panic!("the cost of `{name}` is not known: `FRIXEL_BLESS=1 cargo xtask bench` measures it")
        });
        *core_cycles
    };
    for case in samples().flat_map(|sample| sample.costs) {
        let name = case.name.strip_prefix("tick_").and_then(|name| name.strip_suffix("_alone")).unwrap();
        let expected = match name.split_once("_over_") {
            Some((own, other)) => measured(own) + measured(other),
            None => measured(name),
        };
        assert_eq!(of_record(&record(case.layer), &POINTS), expected, "{name}");
    }
}

#[test]
fn every_kind_is_drawn() {
    for kind in Layer::NUMBERS {
        let has_kind = |seed| RandomScene::new(seed, 7).records.iter().any(|record| record.layer.number() == *kind);
        assert!((0..500).any(has_kind), "no random scene has a layer of kind {kind}");
    }
}
