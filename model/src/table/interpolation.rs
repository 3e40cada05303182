//! Polynomials through a row's points.

use core::mem::replace;

use crate::double_single::DoubleSingle;
use crate::{CarriedContact, LoadedContact, Real};

/// Position of the inner points between -1 and 1 that minimises the product of distances, to 1e-8.
const INNER: f32 = core::f32::consts::SQRT_2 - 1.0;

/// A point of the curve: friction and voltage.
pub(crate) type Point<T> = (T, T);

/// The source of a table: the rms voltage as a function of the electric friction.
pub(crate) trait Curve<T> {
    /// The voltage, in volts rms, for a friction above zero, in newtons.
    fn voltage_v_rms(&self, electric_friction_n: T) -> T;

    /// The voltage as a function of the friction within a row, whose ends are given.
    #[inline]
    fn between(&self, _start: Point<T>, _end: Point<T>) -> impl Fn(T) -> T {
        |electric_friction_n| self.voltage_v_rms(electric_friction_n)
    }
}

impl<T: Real> Curve<T> for LoadedContact<T> {
    #[inline]
    fn voltage_v_rms(&self, electric_friction_n: T) -> T {
        Self::voltage_v_rms(self, electric_friction_n)
    }
}

impl Curve<DoubleSingle> for CarriedContact<DoubleSingle> {
    #[inline]
    fn voltage_v_rms(&self, electric_friction_n: DoubleSingle) -> DoubleSingle {
        Self::voltage_v_rms(self, electric_friction_n)
    }
}

/// Coefficients, constant first, of the polynomial in the friction through `start`, `end` and, with more than two
/// coefficients, one or two points of the curve between them.
///
/// It is computed with the friction divided by `unit`, a nearby power of two, so that no intermediate product leaves
/// the range of `f32`.
pub(super) fn polynomial<T: Real, const C: usize>(
    curve: &impl Curve<T>,
    start: Point<T>,
    end: Point<T>,
    unit: f32,
) -> [f32; C] {
    let mut points: [_; C] = points(curve, start, end);
    for (x, _) in &mut points {
        *x = *x / T::from(unit);
    }
    let mut row = [0.0; C];
    for (power, (to, coefficient)) in row.iter_mut().zip(through(&points)).enumerate() {
        *to = (0..power).fold(coefficient.to_f32(), |scaled, _| scaled / unit);
    }
    row
}

/// The same polynomial in a variable that runs from 0 at `start` to 1 at `end`.
pub(super) fn local_polynomial<const C: usize>(
    contact: &LoadedContact<f64>,
    start: Point<f64>,
    end: Point<f64>,
) -> [f64; C] {
    let width = end.0 - start.0;
    through(&points(contact, start, end).map(|(x, v)| ((x - start.0) / width, v)))
}

fn points<T: Real, const C: usize>(curve: &impl Curve<T>, start: Point<T>, end: Point<T>) -> [Point<T>; C] {
    let (middle, half) = (T::from(0.5) * (start.0 + end.0), T::from(0.5) * (end.0 - start.0));
    let inner: &[f32] = match C {
        4 => &[-INNER, INNER],
        3 => &[0.0],
        _ => &[],
    };
    let voltage_v_rms = curve.between(start, end);
    let mut points = [start; C];
    for (point, at) in points.iter_mut().skip(1).zip(inner) {
        let x = middle + T::from(*at) * half;
        *point = (x, voltage_v_rms(x));
    }
    if let Some(last) = points.last_mut() {
        *last = end;
    }
    points
}

/// Expands Newton's form from its innermost bracket.
fn through<T: Real, const C: usize>(points: &[Point<T>; C]) -> [T; C] {
    let differences = divided_differences(points);
    let mut polynomial = [T::ZERO; C];
    for (&(root, _), difference) in points.iter().rev().zip(differences.iter().rev()) {
        // The polynomial so far times `x - root`, and the difference.
        let mut below = *difference;
        for coefficient in &mut polynomial {
            (below, *coefficient) = (*coefficient, below - root * *coefficient);
        }
    }
    polynomial
}

/// Divided differences of the first point, the first two, and so on to all of them.
fn divided_differences<T: Real, const C: usize>(points: &[Point<T>; C]) -> [T; C] {
    let mut differences = [T::ZERO; C];
    for (difference, (_, v)) in differences.iter_mut().zip(points) {
        *difference = *v;
    }
    for order in 1..C {
        let mut values = differences.iter_mut().skip(order - 1);
        let Some(mut before) = values.next().map(|first| *first) else { continue };
        for (difference, (last, first)) in values.zip(points.iter().skip(order).zip(points)) {
            before = replace(difference, (*difference - before) / (last.0 - first.0));
        }
    }
    differences
}
