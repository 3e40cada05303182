//! How often the stated intervals contain what they are about. `floors.rs` has the floors over 200 people; these are a
//! part of them.
//!
//! The quantity is what a drive of 150 V rms adds to the friction of a finger on its screen, in steady and full slip
//! under the median load of the recording, without noise: the simulator measures it on each person, apart from the
//! recording.

use frixel_hil_sim::Person;
use frixel_lab::fit::{FitError, fit};

use super::filters::Filter;
use super::person::{self, Law, Protocol};
use super::simulated;
use super::tally::{Tally, is_doubted, settings};

/// People in the test of every change.
const FEW: u64 = 24;
/// Recordings of the slow tests.
const MANY: u64 = 200;

/// People of the simulator, unfiltered and behind a causal filter of 200 Hz in turn.
#[test]
fn intervals_cover_and_are_not_too_wide() {
    let mut tally = Tally::default();
    for seed in 0..FEW {
        let person = Person::drawn(seed);
        let rows = simulated::record(&person, &Protocol::default(), seed);
        let filter = if seed % 2 == 0 { Filter::None } else { Filter::Butterworth(200.0) };
        tally.add(fit(filter.apply(&rows), &settings()), |load_n| simulated::truth(&person, load_n));
    }
    println!("{tally}");
    // Of 24 people, more than two are refused once in 80 sets if 2 % are, and more than four are told that the model is
    // in doubt once in 50 if 7 % are.
    assert!(tally.reasons.len() <= 2, "{tally:#?}");
    assert!(tally.doubt() * FEW as f64 <= 4.5, "{tally}");
    // Of 24 intervals of 95 %, five or more miss the truth once in 170 sets.
    let (electric, coefficient) = tally.missed();
    assert!(electric <= 4 && coefficient <= 4, "{tally:#?}");
    assert!(tally.half_width() <= 0.02 && tally.bias().abs() <= 0.005, "{tally}");
    // An interval that is always right because it is wide says nothing: half-widths are about twice the errors' rms.
    assert!((1.3..3.5).contains(&(tally.half_width() / tally.error_rms())), "{tally}");
}

/// Filters that look ahead, and causal ones that are too slow, are refused or do not matter.
#[test]
fn smoothed_recordings_are_refused_or_right() {
    for filter in [
        Filter::OnePole(60.0),
        Filter::Butterworth(120.0),
        Filter::Filtfilt(80.0),
        Filter::Filtfilt(20.0),
        Filter::Mean(3),
        Filter::Mean(11),
        Filter::Mean(21),
        Filter::Mean(51),
        Filter::SavitzkyGolay(7),
        Filter::SavitzkyGolay(11),
        Filter::SavitzkyGolay(21),
    ] {
        let mut tally = Tally::default();
        for seed in 0..4 {
            let person = person::Person::drawn(seed);
            let rows = person.record(&Protocol { strokes: 24, ..Protocol::default() });
            tally.add(fit(filter.apply(&rows), &settings()), |load_n| person.truth(load_n));
        }
        println!("{filter}: {tally} {:?}", tally.reasons.first());
        assert!(tally.fitted == 0 || tally.bias().abs() <= 0.01, "{filter}: {tally}");
        assert!(filter != Filter::Mean(3) || tally.fitted == 4, "{filter}: {:?}", tally.reasons);
    }
}

/// Centred means move friction before its switch, with times and without.
#[test]
fn friction_before_its_switch_is_called_so() {
    let rows = Filter::Mean(11).apply(&person::Person::example(1).record(&Protocol::default()));
    let untimed = rows.iter().map(|row| frixel_lab::fit::Row { time_s: None, ..row.clone() }).collect();
    for rows in [rows, untimed] {
        let error = fit(rows, &settings()).unwrap_err();
        assert!(matches!(error, FitError::NotSettled(_)), "{error}");
        let said = error.to_string();
        assert!(
            said.contains("before each switch") && said.contains("friction changes before the drive switches"),
            "{said}"
        );
    }
}

/// Without times, the lag of friction is left out as a part of each phase.
#[test]
fn recordings_without_times_are_right() {
    let mut tally = Tally::default();
    for seed in 0..8 {
        let person = person::Person::drawn(seed);
        // Steady sliding only: starts and turns cannot be left out.
        let rows = person.record(&Protocol { strokes: 24, ..Protocol::default() });
        let rows = rows.chunks(1600).flat_map(|stroke| &stroke[300..1300]);
        let rows = rows.map(|row| frixel_lab::fit::Row { time_s: None, speed_mm_s: None, stroke: None, ..row.clone() });
        tally.add(fit(Filter::OnePole(150.0).apply(&rows.collect::<Vec<_>>()), &settings()), |load_n| {
            person.truth(load_n)
        });
    }
    println!("{tally}");
    assert!(tally.reasons.is_empty() && tally.missed().0 <= 2, "{tally:#?}");
    assert!(tally.half_width() <= 0.15 && tally.bias().abs() <= 0.01, "{tally}");
}

/// A square law differs from the model by 0.3 in the exponent where the drive adds half of natural friction.
#[test]
fn square_laws_of_50_percent_gain_are_found() {
    let found = |seed: &u64| {
        let law = Law::Power { voltage: 2.0, load: 0.5 };
        let person = person::Person { law, ..person::Person::drawn(*seed) }.with_gain(0.5);
        fit(person.record(&Protocol::default()), &settings()).map_or(true, |fit| is_doubted(&fit))
    };
    // Rules that find 95 % miss two or more of 6 once in 30 sets.
    assert!((0..6).filter(found).count() >= 5);
}

/// Plants whose electric friction is a square of the voltage, with two exponents of the load.
const LAWS: [Law; 2] = [Law::Power { voltage: 2.0, load: 0.5 }, Law::Power { voltage: 2.0, load: 1.0 }];

/// How many plants that break the law are refused, or have an interval that contains the truth.
fn caught(law: Law, count: u64) -> usize {
    let mut tally = Tally::default();
    for seed in 0..count {
        let person = person::Person { law, ..person::Person::drawn(seed) };
        tally.add(fit(person.record(&Protocol::default()), &settings()), |load_n| person.truth(load_n));
    }
    println!("{law:?}: {tally}");
    let (missed, _) = tally.missed();
    count as usize - missed
}

/// 19 of these 20 are caught. If 95 % of all are, fewer than 18 of 20 are in one set of seeds in 13; rules that catch
/// 70 % pass once in 28.
#[test]
fn plants_that_break_the_law_are_refused_or_covered() {
    let caught: usize = LAWS.into_iter().map(|law| caught(law, 10)).sum();
    assert!(caught >= 18, "{caught} of 20");
}

/// 99 and 100 of 100 are caught. Rules that catch nine of ten plants reach 96 of 100 once in 42 sets of seeds; rules
/// that catch 99 % miss it once in 290.
#[test]
#[ignore = "minutes: cargo xtask soak people"]
fn nine_of_ten_plants_that_break_the_law_are_refused_or_covered() {
    for law in LAWS {
        let caught = caught(law, 100);
        assert!(caught >= 96, "{law:?}: {caught} of 100");
    }
}

/// Recordings of few strokes, and of few strokes at the highest voltage.
#[test]
#[ignore = "minutes: cargo xtask soak people"]
fn intervals_of_few_strokes_cover() {
    let few = |strokes: usize| Protocol { strokes, ..Protocol::default() };
    let mut uneven = vec![75.0; 32];
    uneven.extend([150.0; 4]);
    let uneven = Protocol { voltages_v_rms: uneven, ..Protocol::default() };
    for (what, protocol) in [("9", few(9)), ("12", few(12)), ("4 of 36 at 150 V", uneven)] {
        let mut tally = Tally::default();
        for seed in 0..MANY {
            let person = person::Person { drift: 0.0, ..person::Person::drawn(seed) };
            tally.add(fit(person.record(&protocol), &settings()), |load_n| person.truth(load_n));
        }
        println!("{what} strokes: {tally}");
        assert!(tally.electric() >= 0.89, "{what}: {tally}");
    }
}
