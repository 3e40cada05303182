//! Polynomials through a row's points.

use crate::LoadedContact;

/// Where the points lie between -1 and 1: the ends, and what makes the product of distances least with them.
const INNER: f64 = core::f64::consts::SQRT_2 - 1.0;

/// A point of the curve: friction and voltage.
pub(super) type Point = (f64, f64);

/// Coefficients, constant first, of the polynomial in the friction through `start`, `end` and, with more than two
/// coefficients, one or two points of the curve between them.
pub(super) fn polynomial<const C: usize>(contact: &LoadedContact<f64>, start: Point, end: Point) -> [f64; C] {
    through(&points::<C>(contact, start, end))
}

/// The same in the variable that runs from 0 at `start` to 1 at `end`.
pub(super) fn local_polynomial<const C: usize>(contact: &LoadedContact<f64>, start: Point, end: Point) -> [f64; C] {
    let width = end.0 - start.0;
    through(&points::<C>(contact, start, end).map(|(x, v)| ((x - start.0) / width, v)))
}

fn points<const C: usize>(contact: &LoadedContact<f64>, start: Point, end: Point) -> [Point; C] {
    let (middle, half) = (0.5 * (start.0 + end.0), 0.5 * (end.0 - start.0));
    let inner = |at: f64| {
        let x = middle + at * half;
        (x, contact.voltage_v_rms(x))
    };
    let mut index = 0;
    [(); C].map(|()| {
        index += 1;
        match index {
            1 => start,
            _ if index == C => end,
            2 if C == 3 => inner(0.0),
            2 => inner(-INNER),
            _ => inner(INNER),
        }
    })
}

/// Lagrange's form, multiplied out.
fn through<const C: usize>(points: &[Point; C]) -> [f64; C] {
    let mut sum = [0.0; C];
    for (index, &(x, v)) in points.iter().enumerate() {
        let mut basis = [0.0; C];
        if let Some(constant) = basis.first_mut() {
            *constant = v;
        }
        for (_, &(root, _)) in points.iter().enumerate().filter(|&(other, _)| other != index) {
            times_linear(&mut basis, root);
            for coefficient in &mut basis {
                *coefficient /= x - root;
            }
        }
        for (total, coefficient) in sum.iter_mut().zip(basis) {
            *total += coefficient;
        }
    }
    sum
}

/// Multiplies a polynomial by `x - root`.
fn times_linear(polynomial: &mut [f64], root: f64) {
    let mut below = 0.0;
    for coefficient in polynomial {
        (below, *coefficient) = (*coefficient, below - root * *coefficient);
    }
}
