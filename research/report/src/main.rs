//! Writes the figures of the contact model's paper, those behind decisions of the design: which tick rate and which
//! touch estimator, and what two readings of charge leakage predict for touch. `cargo run --release -p frixel-research
//! -- FOLDER` puts them on one page, with the numbers behind each picture beside it.
//!
//! What an inversion, a scene and extreme cases cost is in `frixel report`.
#![forbid(unsafe_code)]

mod bounds;
mod core_line;
mod example;
mod leakage;
mod loads;
mod soft;
#[cfg(test)]
mod tests;
mod tick_rate;
mod touch;
mod touch_estimators;

use std::error::Error;
use std::path::PathBuf;

use frixel::output_file::{Inputs, OutputFolder};
use frixel::report::{Figure, Page};

/// The folder that is written into if none is named.
const FOLDER: &str = "frixel-research";

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| FOLDER.into(), PathBuf::from);
    let _locked = OutputFolder::open(&folder)?;
    let page = Page {
        title: "The contact model's paper, and choices of the design",
        maker: "frixel-research",
        answers: &[],
        figures: &figures()?,
    };
    for file in page.write(&folder, &Inputs::default())? {
        println!("{}", file.display());
    }
    Ok(())
}

/// All figures in the order of the page.
fn figures() -> Result<[Figure; 8], Box<dyn Error>> {
    Ok([
        core_line::figure()?,
        loads::contact_radius()?,
        loads::friction()?,
        bounds::figure()?,
        soft::figure()?,
        tick_rate::figure()?,
        touch_estimators::figure()?,
        leakage::figure()?,
    ])
}

/// `count` evenly spaced values from `start` to `end`.
fn even(start: f64, end: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |index| start + (end - start) * index as f64 / (count - 1) as f64)
}

/// `count` values from `start` to `end`, evenly spaced in their logarithms.
fn geometric(start: f64, end: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    even(start.log10(), end.log10(), count).map(|power| 10_f64.powf(power))
}
