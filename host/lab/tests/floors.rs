//! How good fits of many simulated people are, against floors: `cargo xtask soak people`.

use frixel_hil_sim::Person;
use frixel_lab::fit::fit;
use rayon::prelude::*;

use super::filters::Filter;
use super::person::{self, Law, Protocol};
use super::simulated;
use super::tally::{Tally, is_doubted, settings};

/// Fits of people behind filters, each recording once through each filter.
fn fits(people: u64, seeds: u64, filters: &[Filter]) -> Vec<Tally> {
    let of = |index: u64| -> Vec<Tally> {
        let (person, seed) = (Person::drawn(index / seeds), index % seeds * 1000 + index / seeds);
        let rows = simulated::record(&person, &Protocol::default(), seed);
        let fit_of = |filter: &Filter| {
            let mut tally = Tally::default();
            tally.add(fit(filter.apply(&rows), &settings()), |load_n| simulated::truth(&person, load_n));
            tally
        };
        filters.iter().map(fit_of).collect()
    };
    let empty = || filters.iter().map(|_| Tally::default()).collect::<Vec<_>>();
    let join =
        |one: Vec<Tally>, other: Vec<Tally>| one.into_iter().zip(other).map(|(one, other)| one.and(other)).collect();
    (0..people * seeds).into_par_iter().map(of).reduce(empty, join)
}

/// People who obey the model, unfiltered and behind causal filters of 200 Hz.
#[test]
#[ignore = "minutes: cargo xtask soak people"]
fn people_who_obey_the_model() {
    let filters = [Filter::None, Filter::OnePole(200.0), Filter::Butterworth(200.0)];
    let tallies = fits(200, 3, &filters);
    filters.iter().zip(&tallies).for_each(|(filter, tally)| println!("{filter}: {tally}"));
    for (filter, tally) in filters.iter().zip(&tallies) {
        assert!(tally.refused() <= 0.02 && tally.doubt() <= 0.07, "{filter}: {tally}");
        assert!(tally.bias().abs() <= 0.005 && tally.half_width() <= 0.02, "{filter}: {tally}");
        assert!((0.93..=0.97).contains(&tally.electric()), "{filter}: {tally}");
    }
}

/// Causal and smoothing filters of 10 to 300 Hz.
#[test]
#[ignore = "minutes: cargo xtask soak people"]
fn filters_are_refused_or_right() {
    let filters = Filter::sweep();
    let tallies = fits(24, 1, &filters);
    filters.iter().zip(&tallies).for_each(|(filter, tally)| println!("{filter}: {tally}"));
    for (filter, tally) in filters.iter().zip(&tallies) {
        assert!(tally.fitted == 0 || tally.bias().abs() <= 0.01, "{filter}: {tally}");
    }
}

/// Square laws whose friction is half of natural friction at 150 V rms.
#[test]
#[ignore = "minutes: cargo xtask soak people"]
fn square_laws_of_50_percent_gain() {
    for load in [0.5, 1.0] {
        let found = |seed: u64| {
            let person =
                person::Person { law: Law::Power { voltage: 2.0, load }, ..person::Person::drawn(seed) }.with_gain(0.5);
            let fitted = fit(person.record(&Protocol::default()), &settings());
            (fitted.is_err(), fitted.is_ok_and(|fit| is_doubted(&fit)))
        };
        let found: Vec<(bool, bool)> = (0..200_u64).into_par_iter().map(found).collect();
        let refused = found.iter().filter(|(refused, _)| *refused).count();
        let doubted = found.iter().filter(|(_, doubted)| *doubted).count();
        println!("load to the power {load}: of 200, {refused} refused, {doubted} in doubt");
        assert!(refused + doubted >= 190, "load to the power {load}: {refused} refused, {doubted} in doubt");
    }
}
