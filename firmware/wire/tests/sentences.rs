//! Human-readable sentences: each states what was found and what to do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use std::collections::BTreeSet;
use std::fmt::{Debug, Display, Write};
use std::path::Path;

use frixel_testkit::golden;
use frixel_wire::fault::{Fault, Flags};
use frixel_wire::hello::{Hello, notice};
use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};
use support::samples;

/// Sentences for all samples. Each states what was found, with its numbers, and what to do; review it when it changes.
#[test]
fn sentences_match_the_golden_file() {
    let outside = samples::config_refusal(ConfigField::VoltagePeak, ConfigRefusal::WHOLE_SCENE);
    let no_least = ConfigRefusal { min: f32::NEG_INFINITY, layer: 2, field: ConfigField::Gain, ..outside };
    let no_largest = ConfigRefusal { max: f32::INFINITY, ..outside };
    let since_1_3 = samples::config_refusal(ConfigField::ElectricFrictionMax, ConfigRefusal::WHOLE_SCENE);
    let refusals = samples::refusals().into_iter().chain([no_least, no_largest, since_1_3].map(Refusal::Config));
    let mut text = String::new();
    let mut add = |sample: &dyn Debug, sentence: &dyn Display| writeln!(text, "# {sample:?}\n{sentence}").unwrap();
    for state in samples::STATES {
        add(&state, &state);
    }
    for fault in samples::faults().chain([Fault::Other(200)]) {
        add(&fault, &fault);
    }
    for refusal in refusals {
        add(&refusal, &refusal);
    }
    for (notice, sentence) in notice::SENTENCES {
        add(&notice, &sentence);
    }
    golden::hold(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/sentences.txt"), &text);
    let sentences: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(sentences.iter().collect::<BTreeSet<_>>().len(), sentences.len(), "no two are alike");
}

/// Every flag has a sentence, any two are combined into one text, and unknown bits are reported.
#[test]
fn every_set_flag_has_its_sentence() {
    assert_eq!(Flags::default().to_string(), "nothing limits the output");
    let named: Vec<String> = (0..16).map(|bit| Flags(1 << bit).to_string()).collect();
    for (bit, sentence) in named.iter().enumerate() {
        assert_eq!(sentence.contains("does not know"), bit >= 9, "{sentence}");
        assert!(!sentence.contains(';'), "{sentence}");
    }
    for low in 0..9 {
        for high in low + 1..9 {
            assert_eq!(Flags(1 << low | 1 << high).to_string(), format!("{}; {}", named[low], named[high]));
        }
    }
    let names: BTreeSet<&str> = Flags(u16::MAX).names().collect();
    assert_eq!(names.len(), 9, "each flag has a name of its own");
    assert!(names.iter().all(|name| name.chars().all(|letter| letter.is_ascii_lowercase() || letter == '-')));
    assert!(Flags(1 << 3 | 1 << 9).names().eq(["no-finger"]));
    assert_eq!((Flags(1 << 3 | 1 << 9).unnamed(), Flags(0x1ff).unnamed()), (Flags(1 << 9), Flags(0)));
    assert_eq!(Flags(0x8201).to_string(), format!("{}; flags 0x8200, which this program does not know", named[0]));
}

/// Unknown bits are omitted, since only a newer host can interpret them.
#[test]
fn every_known_notice_has_its_sentence() {
    let said = |notices| Hello { notices, ..samples::hello() }.notice_sentences().collect::<Vec<_>>();
    assert!(said(0).is_empty() && said(0x80).is_empty());
    for (bit, sentence) in notice::SENTENCES {
        assert_eq!(said(bit), [sentence]);
    }
    assert_eq!(said(u8::MAX).len(), notice::SENTENCES.len());
}
