//! How good fits of simulated people are: `cargo run -p frixel-lab --example fit_floors -- [PART [COUNT]]`.
//!
//! Parts are `people`, `filters` and `square`; without one, all of them run. COUNT is a number of people. Each line ends
//! with the floor that it holds, and the program fails if one is missed.
#![allow(clippy::unwrap_used, dead_code, reason = "modules of the tests, of which this uses a part")]

#[path = "../tests/filters.rs"]
mod filters;
#[path = "../tests/person.rs"]
mod person;
#[path = "../tests/simulated.rs"]
mod simulated;
#[path = "../tests/tally.rs"]
mod tally;

use std::process::ExitCode;

use filters::Filter;
use frixel_hil_sim::Person;
use frixel_lab::fit::{Settings, fit};
use frixel_model::Ripple;
use person::{Law, Protocol};
use rayon::prelude::*;
use tally::Tally;

/// Prints a part for a number of people; whether its floors hold.
type Part = fn(Option<u64>) -> bool;

/// Recordings of each person.
const SEEDS: u64 = 3;

fn settings() -> Settings {
    Settings {
        voltage_v_rms: 150.0,
        normal_load_n: None,
        coating_gap_m: simulated::COATING_GAP_M,
        ripple: Ripple::NONE,
        without: Vec::new(),
        seed: 1,
    }
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let part = arguments.next();
    let count = arguments.next().and_then(|count| count.parse().ok());
    let parts: [(&str, Part); 3] = [("people", people), ("filters", filters), ("square", square)];
    let asked = parts.iter().filter(|(name, _)| part.as_deref().is_none_or(|part| part == *name));
    // All parts run, whether one before it holds or not.
    let held: Vec<bool> = asked.map(|(_, run)| run(count)).collect();
    if !held.is_empty() && held.iter().all(|held| *held) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Fits of people behind filters, each recording once through each filter.
fn fits(people: u64, seeds: u64, filters: &[Filter], strokes: usize) -> Vec<Tally> {
    let protocol = Protocol { strokes, ..Protocol::default() };
    let of = |index: u64| -> Vec<Tally> {
        let (person, seed) = (Person::drawn(index / seeds), index % seeds * 1000 + index / seeds);
        let rows = simulated::record(&person, &protocol, seed);
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
fn people(count: Option<u64>) -> bool {
    let filters = [Filter::None, Filter::OnePole(200.0), Filter::Butterworth(200.0)];
    let tallies = fits(count.unwrap_or(200), SEEDS, &filters, 36);
    println!(
        "people who obey the model, {SEEDS} recordings each; floors: refused <= 2 %, doubt <= 7 %, bias <= 0.5 %,"
    );
    println!("cover 93 to 97 %, median half-width <= 2 %");
    let mut holds = true;
    for (filter, tally) in filters.iter().zip(&tallies) {
        let held = tally.refused() <= 0.02
            && tally.doubt() <= 0.07
            && tally.bias().abs() <= 0.005
            && (0.93..=0.97).contains(&tally.electric())
            && tally.half_width() <= 0.02;
        println!("  {:<28} {tally}{}", filter.to_string(), missed(held));
        holds &= held;
    }
    holds
}

/// Causal and smoothing filters of 10 to 300 Hz: refused, or right.
fn filters(count: Option<u64>) -> bool {
    let filters = Filter::sweep();
    let tallies = fits(count.unwrap_or(24), 1, &filters, 36);
    println!("filters of 10 to 300 Hz and smoothing over 3 to 75 ms; floor: all refused, or bias <= 1 %");
    let mut holds = true;
    for (filter, tally) in filters.iter().zip(&tallies) {
        let held = tally.fitted == 0 || tally.bias().abs() <= 0.01;
        println!("  {:<28} {tally}{}", filter.to_string(), missed(held));
        holds &= held;
    }
    holds
}

/// A square law whose friction is half of natural friction at 150 V rms.
fn square(count: Option<u64>) -> bool {
    let count = count.unwrap_or(200);
    println!("square laws of 50 % gain; floor: 95 % are refused or doubted");
    let mut holds = true;
    for load in [0.5, 1.0] {
        let found = |seed: u64| {
            let person =
                person::Person { law: Law::Power { voltage: 2.0, load }, ..person::Person::drawn(seed) }.with_gain(0.5);
            let fitted = fit(person.record(&Protocol::default()), &settings());
            (fitted.is_err(), fitted.is_ok_and(|fit| tally::is_doubted(&fit)))
        };
        let found: Vec<(bool, bool)> = (0..count).into_par_iter().map(found).collect();
        let refused = found.iter().filter(|(refused, _)| *refused).count();
        let doubted = found.iter().filter(|(_, doubted)| *doubted).count();
        let held = (refused + doubted) as f64 >= 0.95 * count as f64;
        println!("  load to the power {load}: of {count}, {refused} refused, {doubted} in doubt{}", missed(held));
        holds &= held;
    }
    holds
}

fn missed(held: bool) -> &'static str {
    if held { "" } else { "  MISSED" }
}
