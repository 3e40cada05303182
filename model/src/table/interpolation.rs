//! Polynomials through a row's points.

use crate::{LoadedContact, Real};

/// Where the points lie between -1 and 1: the ends, and what makes the product of distances least with them.
const INNER: f64 = core::f64::consts::SQRT_2 - 1.0;

/// A point of the curve: friction and voltage.
pub(super) type Point<T> = (T, T);

/// Coefficients, constant first, of the polynomial in the friction through `start`, `end` and, with more than two
/// coefficients, one or two points of the curve between them.
///
/// It is made in the friction over `unit`, a power of two near it, so that no product on the way leaves the range of `f32`.
pub(super) fn polynomial<T: Real, const C: usize>(
    contact: &LoadedContact<T>,
    start: Point<T>,
    end: Point<T>,
    unit: f32,
) -> [f32; C] {
    let scaled = points::<T, C>(contact, start, end).map(|(x, v)| (x / T::from(unit), v));
    let mut coefficients = through(&scaled).map(Real::to_f32);
    for power in 1..C {
        for coefficient in coefficients.iter_mut().skip(power) {
            *coefficient /= unit;
        }
    }
    coefficients
}

/// The same in the variable that runs from 0 at `start` to 1 at `end`.
pub(super) fn local_polynomial<const C: usize>(
    contact: &LoadedContact<f64>,
    start: Point<f64>,
    end: Point<f64>,
) -> [f64; C] {
    let width = end.0 - start.0;
    through(&points::<f64, C>(contact, start, end).map(|(x, v)| ((x - start.0) / width, v)))
}

fn points<T: Real, const C: usize>(contact: &LoadedContact<T>, start: Point<T>, end: Point<T>) -> [Point<T>; C] {
    let a_half = T::from(0.5);
    let (middle, half) = (a_half * (start.0 + end.0), a_half * (end.0 - start.0));
    let inner = |at: T| {
        let x = middle + at * half;
        (x, contact.voltage_v_rms(x))
    };
    let mut index = 0;
    [(); C].map(|()| {
        index += 1;
        match index {
            1 => start,
            _ if index == C => end,
            2 if C == 3 => inner(T::ZERO),
            2 => inner(-T::from_f64(INNER)),
            _ => inner(T::from_f64(INNER)),
        }
    })
}

/// Lagrange's form, multiplied out.
fn through<T: Real, const C: usize>(points: &[Point<T>; C]) -> [T; C] {
    let mut sum = [T::ZERO; C];
    for (index, &(x, v)) in points.iter().enumerate() {
        let mut basis = [T::ZERO; C];
        if let Some(constant) = basis.first_mut() {
            *constant = v;
        }
        for (_, &(root, _)) in points.iter().enumerate().filter(|&(other, _)| other != index) {
            times_linear(&mut basis, root);
            for coefficient in &mut basis {
                *coefficient = *coefficient / (x - root);
            }
        }
        for (total, coefficient) in sum.iter_mut().zip(basis) {
            *total = *total + coefficient;
        }
    }
    sum
}

/// Multiplies a polynomial by `x - root`.
fn times_linear<T: Real>(polynomial: &mut [T], root: T) {
    let mut below = T::ZERO;
    for coefficient in polynomial {
        (below, *coefficient) = (*coefficient, below - root * *coefficient);
    }
}
