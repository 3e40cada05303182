//! Axes: positions, ticks and tick labels of values.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

/// Default limit of the number of labels along an axis.
const LABELS: f64 = 7.0;
const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// A linear or logarithmic axis of a plot. It may run backwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity and its unit.
    pub label: String,
    logarithmic: bool,
    /// First and last value, or their decimal logarithms.
    range: Range<f64>,
    labels: f64,
}

impl Axis {
    /// Creates a linear axis.
    pub fn linear(label: &str, range: Range<f64>) -> Self {
        Self { label: label.to_owned(), logarithmic: false, range, labels: LABELS }
    }

    /// Creates a logarithmic axis; both ends must be above zero.
    pub fn log(label: &str, range: Range<f64>) -> Self {
        let range = range.start.log10()..range.end.log10();
        Self { label: label.to_owned(), logarithmic: true, range, labels: LABELS }
    }

    /// Limits the number of labels to `labels`.
    #[must_use]
    pub fn with_labels(self, labels: f64) -> Self {
        Self { labels, ..self }
    }

    /// Position of a value as a fraction of the axis, from 0 to 1; `None` if its logarithm is undefined.
    pub(super) fn part(&self, value: f64) -> Option<f64> {
        let place = if self.logarithmic { value.log10() } else { value };
        let Range { start, end } = self.range;
        place.is_finite().then_some((place - start) / (end - start))
    }

    /// Values with a label.
    pub fn ticks(&self) -> Vec<f64> {
        let (start, end) = (self.range.start.min(self.range.end), self.range.end.max(self.range.start));
        if !self.logarithmic {
            return multiples(start, end, step((end - start) / self.labels)).collect();
        }
        let decades = end - start;
        if decades > 2.5 {
            let step = (decades / self.labels).ceil().max(1.0);
            return multiples(start, end, step).map(|power| 10_f64.powf(power)).collect();
        }
        let within = |value: &f64| (start - 1e-9..=end + 1e-9).contains(&value.log10());
        let powers = start.floor() as i32..=end.ceil() as i32;
        powers.flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10_f64.powi(power))).filter(within).collect()
    }

    /// The label of a value.
    pub(super) fn tick_label(&self, value: f64) -> String {
        if !self.logarithmic {
            return label(value);
        }
        let place = value.log10();
        let power = place.round();
        if (1e-3..1e4).contains(&value) {
            let decimals = (2.0 - power).clamp(0.0, 6.0);
            label((value * 10_f64.powf(decimals)).round() / 10_f64.powf(decimals))
        } else if (place - power).abs() < 1e-9 {
            format!("10{}", superscript(power as i32))
        } else {
            let power = place.floor();
            format!("{}·10{}", label(10_f64.powf(place - power).round()), superscript(power as i32))
        }
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        let part = self.part(*value).unwrap_or(0.0);
        (f64::from(first) + part * f64::from(last - first)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks()
    }

    fn range(&self) -> Range<f64> {
        let value = |place: f64| if self.logarithmic { 10_f64.powf(place) } else { place };
        value(self.range.start)..value(self.range.end)
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(value: &f64) -> String {
        value.to_string()
    }

    fn format_ext(&self, value: &f64) -> String {
        self.tick_label(*value)
    }
}

/// The smallest of 1, 2, 5, 10, ... times a power of ten that is at least `least`.
fn step(least: f64) -> f64 {
    let power = 10_f64.powi(least.max(1e-300).log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    // The tolerance of a millionth covers the rounding of the power.
    steps.into_iter().find(|step| *step >= least * (1.0 - 1e-6)).unwrap_or(10.0 * power)
}

/// Multiples of `step` from `start` to `end`.
fn multiples(start: f64, end: f64, step: f64) -> impl Iterator<Item = f64> {
    let first = (start / step - 1e-6).ceil() as i64;
    let last = (end / step + 1e-6).floor() as i64;
    (first..=last).map(move |number| number as f64 * step)
}

/// Formats a number with at most six decimals, and zero without a sign.
fn label(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{}", if rounded.abs() > 0.0 { rounded } else { 0.0 })
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
        for (value, expected) in [(1e-17, "10⁻¹⁷"), (1e-3, "0.001"), (1.0, "1"), (1e3, "1000"), (1e12, "10¹²")] {
            assert_eq!(axis.tick_label(value), expected);
        }
        assert_eq!(axis.tick_label(5e5), "5·10⁵");
        assert_eq!(axis.tick_label(0.5), "0.5");
    }

    #[test]
    fn numbers_are_written_without_digits_that_are_rounding() {
        assert_eq!([label(-1e-9), label(250.0), label(0.1 + 0.2)], ["0", "250", "0.3"]);
        assert_eq!(multiples(250.0, 277.8, 5.0).collect::<Vec<_>>(), [250.0, 255.0, 260.0, 265.0, 270.0, 275.0]);
    }

    proptest! {
        #[test]
        fn steps_are_one_two_or_five(least in 1e-6..1e6f64) {
            let step = step(least);
            prop_assert!(step >= least * (1.0 - 1e-5) && step <= 2.5 * least * (1.0 + 1e-5));
            let digits = step / 10f64.powi(step.log10().floor() as i32);
            prop_assert!([1.0, 2.0, 5.0, 10.0].iter().any(|digit| (digits - digit).abs() < 1e-6), "{}", digits);
        }

        #[test]
        fn every_axis_has_a_few_labels_that_differ(start in -20.0..20.0_f64, decades in 0.7..40.0_f64) {
            let axis = Axis::log("", 10_f64.powf(start)..10_f64.powf(start + decades));
            let ticks = axis.ticks();
            prop_assert!((2..=9).contains(&ticks.len()), "{ticks:?}");
            let labels: HashSet<_> = ticks.iter().map(|tick| axis.tick_label(*tick)).collect();
            prop_assert_eq!(labels.len(), ticks.len());
            prop_assert!(ticks.iter().all(|tick| (start - 1e-6..=start + decades + 1e-6).contains(&tick.log10())));
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
