//! Axes: what a value is called, and where it stands.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use crate::output::scale;

/// Most labels along an axis.
const LABELS: f64 = 7.0;
const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// An axis of a plot. Places on it are values, or their decimal logarithms.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::report) struct Axis {
    /// What it shows, with the unit.
    pub(in crate::report) label: String,
    logarithmic: bool,
    range: Range<f64>,
}

impl Axis {
    /// An even axis.
    pub(in crate::report) fn linear(label: &str, range: Range<f64>) -> Self {
        Self { label: label.to_owned(), logarithmic: false, range }
    }

    /// A logarithmic axis between values above zero.
    pub(in crate::report) fn log(label: &str, range: Range<f64>) -> Self {
        let range = range.start.log10()..range.end.log10();
        Self { label: label.to_owned(), logarithmic: true, range }
    }

    /// First and last place.
    pub(super) fn places(&self) -> Range<f64> {
        self.range.clone()
    }

    /// Where a value stands; nowhere when it has no logarithm.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        let place = if self.logarithmic { value.log10() } else { value };
        place.is_finite().then_some(place)
    }

    /// Places that are labelled.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let Range { start, end } = self.range;
        if !self.logarithmic {
            return scale::ticks(start, end, scale::step((end - start) / LABELS)).collect();
        }
        let decades = end - start;
        if decades > 2.5 {
            let step = (decades / LABELS).ceil().max(1.0);
            return scale::ticks(start, end, step).collect();
        }
        let within = |place: &f64| *place >= start - 1e-9 && *place <= end + 1e-9;
        let powers = start.floor() as i32..=end.ceil() as i32;
        powers
            .flat_map(|power| [1.0_f64, 2.0, 5.0].map(|digit| f64::from(power) + digit.log10()))
            .filter(within)
            .collect()
    }

    /// What a labelled place is called.
    pub(super) fn tick_label(&self, place: f64) -> String {
        if !self.logarithmic {
            return scale::label(place);
        }
        let value = 10_f64.powf(place);
        let power = place.round();
        let is_power = (place - power).abs() < 1e-9;
        if (1e-3..1e4).contains(&value) {
            let decimals = (2.0 - power).clamp(0.0, 6.0);
            let rounded = (value * 10_f64.powf(decimals)).round() / 10_f64.powf(decimals);
            scale::label(rounded)
        } else if is_power {
            format!("10{}", superscript(power as i32))
        } else {
            let power = place.floor();
            format!("{}·10{}", scale::label((10_f64.powf(place - power)).round()), superscript(power as i32))
        }
    }
}

/// To the drawing library, values are places.
impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, place: &f64, (first, last): (i32, i32)) -> i32 {
        let part = (place - self.range.start) / (self.range.end - self.range.start);
        first + (part * f64::from(last - first)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks()
    }

    fn range(&self) -> Range<f64> {
        self.places()
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(place: &f64) -> String {
        place.to_string()
    }

    fn format_ext(&self, place: &f64) -> String {
        self.tick_label(*place)
    }
}

fn superscript(power: i32) -> String {
    let sign = if power < 0 { "⁻" } else { "" };
    let digits = power.unsigned_abs().to_string();
    let raised = digits.bytes().filter_map(|digit| SUPERSCRIPTS.get(usize::from(digit - b'0')));
    sign.chars().chain(raised.copied()).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use proptest::prelude::*;

    use super::*;

    #[test]
    fn powers_are_written_as_such() {
        let axis = Axis::log("", 1e-17..1e12);
        for (place, expected) in [(-17.0, "10⁻¹⁷"), (-3.0, "0.001"), (0.0, "1"), (3.0, "1000"), (12.0, "10¹²")] {
            assert_eq!(axis.tick_label(place), expected);
        }
        assert_eq!(axis.tick_label(5e5_f64.log10()), "5·10⁵");
        assert_eq!(axis.tick_label(0.5_f64.log10()), "0.5");
    }

    proptest! {
        #[test]
        fn every_axis_has_a_few_labels_that_differ(start in -20.0..20.0_f64, decades in 0.7..40.0_f64) {
            let axis = Axis::log("", 10_f64.powf(start)..10_f64.powf(start + decades));
            let ticks = axis.ticks();
            prop_assert!((2..=9).contains(&ticks.len()), "{ticks:?}");
            let labels: HashSet<_> = ticks.iter().map(|tick| axis.tick_label(*tick)).collect();
            prop_assert_eq!(labels.len(), ticks.len());
            prop_assert!(ticks.iter().all(|tick| (start - 1e-6..=start + decades + 1e-6).contains(tick)));
        }

        #[test]
        fn every_even_axis_has_a_few_labels_that_differ(start in -1e3..1e3_f64, length in 0.01..1e4_f64) {
            let axis = Axis::linear("", start..start + length);
            let ticks = axis.ticks();
            prop_assert!((2..=8).contains(&ticks.len()), "{ticks:?}");
            let labels: HashSet<_> = ticks.iter().map(|tick| axis.tick_label(*tick)).collect();
            prop_assert_eq!(labels.len(), ticks.len());
        }
    }
}
