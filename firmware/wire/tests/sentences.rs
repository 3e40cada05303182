//! Human-readable sentences: each states what was found and what to do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use std::collections::BTreeSet;

use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::hello::{Hello, notice};
use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};
use frixel_wire::scene::SceneError;
use support::samples;

#[test]
fn faults_tell_their_number_and_a_cure() {
    let sentences: BTreeSet<String> = samples::faults().map(|fault| fault.to_string()).collect();
    assert_eq!(sentences.len(), samples::faults().count());
    for fault in samples::faults() {
        let sentence = fault.to_string();
        let text = sentence.strip_prefix(&format!("fault {}: ", fault.number())).expect(&sentence);
        let (_, cure) = text.split_once("; ").expect(&sentence);
        let known = !matches!(fault, Fault::Other(_));
        assert!(cure.contains("clear the fault") || (!known && cure.contains("update")), "{sentence}");
    }
}

#[test]
fn numbers_are_the_ones_of_the_wire() {
    assert!(State::try_from(4).unwrap_err().to_string().contains('4'));
    for state in samples::STATES {
        assert_eq!(State::try_from(state.number()), Ok(state));
    }
    assert!(Fault::try_from(0).is_err());
    for number in 1..=u8::MAX {
        assert_eq!(Fault::try_from(number).unwrap().number(), number);
    }
}

#[test]
fn states_begin_with_their_name() {
    for state in samples::STATES {
        assert!(state.to_string().starts_with(&format!("{state:?}").to_lowercase()), "{state}");
    }
}

/// Every flag has a sentence, any two are combined into one text, and unknown bits are reported.
#[test]
fn flags_say_all_that_is_set() {
    assert_eq!(Flags::default().to_string(), "nothing limits the output");
    let named: Vec<String> = (0..16).map(|bit| Flags(1 << bit).to_string()).collect();
    for (bit, sentence) in named.iter().enumerate() {
        assert_eq!(sentence.contains("does not know"), bit >= 8, "{sentence}");
        assert!(!sentence.contains(';'), "{sentence}");
    }
    for low in 0..8 {
        for high in low + 1..8 {
            assert_eq!(Flags(1 << low | 1 << high).to_string(), format!("{}; {}", named[low], named[high]));
        }
    }
    let names: BTreeSet<&str> = Flags(u16::MAX).names().collect();
    assert_eq!(names.len(), 8, "each flag has a name of its own");
    assert!(names.iter().all(|name| name.chars().all(|letter| letter.is_ascii_lowercase() || letter == '-')));
    assert!(Flags(1 << 3 | 1 << 9).names().eq(["no-finger"]));
    assert_eq!((Flags(1 << 3 | 1 << 9).unnamed(), Flags(0xff).unnamed()), (Flags(1 << 9), Flags(0)));
    assert_eq!(Flags(0x8201).to_string(), format!("{}; flags 0x8200, which this program does not know", named[0]));
}

/// The sentence of a refusal contains all its numbers and ends with the remedy.
#[test]
fn refusals_tell_numbers_and_a_cure() {
    let mut sentences = BTreeSet::new();
    for refusal in samples::refusals() {
        let sentence = refusal.to_string();
        assert!(sentence.contains(": "), "{sentence}");
        for number in numbers(refusal) {
            assert!(sentence.contains(&number), "{number} is not in: {sentence}");
        }
        sentences.insert(sentence);
    }
    assert_eq!(sentences.len(), samples::refusals().len());
}

fn numbers(refusal: Refusal) -> Vec<String> {
    let hex = |crc32: u32| format!("{crc32:#010x}");
    match refusal {
        Refusal::Faulted(fault) => vec![fault.to_string()],
        Refusal::UploadIncomplete { next_chunk } => vec![next_chunk.to_string()],
        Refusal::CrcMismatch { expected, found } => vec![hex(expected), hex(found)],
        Refusal::SceneTooLarge { len, max } => vec![len.to_string(), max.to_string()],
        Refusal::BitmapPoolFull { len, free } => vec![len.to_string(), free.to_string()],
        Refusal::BitmapMissing { crc32 } => vec![hex(crc32)],
        Refusal::TelemetryTooFast { period_min_ticks } => vec![period_min_ticks.to_string()],
        Refusal::Config(config) if config.field == ConfigField::TableRange => vec![config.found.to_string()],
        Refusal::Config(config) => {
            vec![config.field.to_string(), config.found.to_string(), config.min.to_string(), config.max.to_string()]
        }
        Refusal::Scene(error) => scene_numbers(error),
        Refusal::FeatureDisabled { layer: ConfigRefusal::WHOLE_SCENE } => vec!["carrier".into()],
        Refusal::FeatureDisabled { layer } => vec![format!("layer {layer}")],
        Refusal::TooCostly { cycles, cycles_max, x_m, y_m } => {
            let place = format!("{:.1} mm, {:.1} mm", 1e3 * x_m, 1e3 * y_m);
            vec![cycles.to_string(), cycles_max.to_string(), place]
        }
        Refusal::NoSuchLayer { layer, layers } => vec![format!("layer {layer}"), layers.to_string()],
        Refusal::UnknownCommand
        | Refusal::WrongState(_)
        | Refusal::NoScene
        | Refusal::Busy
        | Refusal::ArmSwitch
        | Refusal::TouchSource
        | Refusal::NoStreamLayer
        | Refusal::LayersFixed
        | Refusal::Autonomous => vec![],
    }
}

fn scene_numbers(error: SceneError) -> Vec<String> {
    match error {
        SceneError::Version { found } => vec![found.to_string()],
        SceneError::Length { found, expected } => vec![found.to_string(), expected.to_string()],
        SceneError::UnknownCarrier(shape) => vec![shape.to_string()],
        SceneError::UnknownKind { record, kind } => vec![format!("layer {record}"), kind.to_string()],
        SceneError::UnknownChoice { record, value, .. } => vec![format!("layer {record}"), value.to_string()],
        SceneError::TooManyRecords { found } => vec![found.to_string(), "64".into()],
        SceneError::UnknownFlags(flags) => vec![format!("{flags:#04x}")],
        SceneError::TooManyPoints { found } => vec![found.to_string(), "128".into()],
        SceneError::Points { record, first, count } => {
            vec![format!("layer {record}"), first.to_string(), count.to_string()]
        }
        SceneError::ButtonRegion { record } => vec![format!("layer {record}")],
        SceneError::NotZero { record: SceneError::HEADER, offset } => vec!["header".into(), offset.to_string()],
        SceneError::NotZero { record, offset } => vec![format!("layer {record}"), offset.to_string()],
    }
}

#[test]
fn config_refusals_name_the_place_and_the_unit() {
    let refusal = samples::config_refusal(ConfigField::VoltagePeak, ConfigRefusal::WHOLE_SCENE);
    assert_eq!(
        refusal.to_string(),
        "the largest peak voltage of the scene is 250.5 V, which the board cannot play: it takes 0.125 to 50.0 V"
    );
    let open = ConfigRefusal { min: f32::NEG_INFINITY, layer: 2, field: ConfigField::Gain, ..refusal };
    assert_eq!(
        open.to_string(),
        "the gain of layer 2 (the first is 0) is 250.5, which the board cannot play: it takes 50.0 or less"
    );
    let open = ConfigRefusal { max: f32::INFINITY, ..refusal };
    assert!(open.to_string().ends_with("it takes 0.125 V or more"));
}

/// Bits that this crate does not know are left out: only a newer host can say what they mean.
#[test]
fn notices_are_said_with_a_cure() {
    let said = |notices| Hello { notices, ..samples::hello() }.notice_sentences().collect::<Vec<_>>();
    assert!(said(0).is_empty() && said(0x80).is_empty());
    for (bit, sentence) in notice::SENTENCES {
        assert_eq!(said(bit), [sentence]);
        let (found, cure) = sentence.split_once(": ").expect(sentence);
        assert!(found.starts_with("the board"), "{sentence}");
        assert!(["play", "store", "flash"].iter().any(|verb| cure.contains(verb)), "{sentence}");
    }
    assert_eq!(said(u8::MAX).len(), notice::SENTENCES.len());
}
