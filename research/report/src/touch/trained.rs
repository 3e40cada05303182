//! A predictor that is trained on strokes: for each age of the newest report, the linear function of the places before
//! it that was best on other strokes.

use frixel_hil_sim::TouchReport;

use super::Recording;

/// Places that a prediction uses, one report period apart.
const PLACES: usize = 12;
/// Ages of the newest report that have a function of their own, and how many a report period has.
const AGES: usize = 24;
const AGES_PER_PERIOD: f64 = 4.0;
/// Samples from one that is trained on to the next.
const STRIDE: usize = 5;
/// Added to the diagonal of the normal equations, in m^2: less than the noise of the places.
const RIDGE_M2: f64 = 1e-10;

/// Differences of the places before the newest one from it, in m, along an axis.
type Differences = [f64; PLACES];

/// The sums of a least-squares fit of a linear function, and its solution.
#[derive(Clone)]
struct Fit {
    squares: [Differences; PLACES],
    products: Differences,
    weights: Differences,
}

/// What is known of a touch at a time.
struct Known {
    newest_m: [f64; 2],
    /// Along x and y. What is before the landing is 0.
    differences_m: [Differences; 2],
    /// Number of the fit, which depends on the number of known places and on the age of the newest one.
    fit: usize,
}

/// Linear functions for each number of known places and each age of the newest report.
pub(in super::super) struct Trained {
    period_s: f64,
    fits: Vec<Fit>,
}

impl Trained {
    /// The functions that are best on recordings of one class.
    pub(in super::super) fn on(recordings: &[Recording], rate_hz: f64) -> Self {
        let empty = Fit { squares: [[0.0; PLACES]; PLACES], products: [0.0; PLACES], weights: [0.0; PLACES] };
        let mut trained = Self { period_s: 1.0 / rate_hz, fits: vec![empty; PLACES * AGES] };
        for touch in recordings.iter().flat_map(|recording| &recording.touches) {
            for (index, true_m) in touch.places_m.iter().enumerate().step_by(STRIDE) {
                let Some(known) = trained.known(&touch.reports, touch.time_s(index)) else { continue };
                let Some(fit) = trained.fits.get_mut(known.fit) else { continue };
                for ((differences_m, true_m), newest_m) in known.differences_m.iter().zip(true_m).zip(known.newest_m) {
                    fit.add(differences_m, true_m - newest_m);
                }
            }
        }
        for fit in &mut trained.fits {
            fit.solve();
        }
        trained
    }

    /// The predicted place at a time, from the reports that have arrived by then; `None` before the first.
    pub(super) fn place_m(&self, reports: &[TouchReport], now_s: f64) -> Option<[f64; 2]> {
        let known = self.known(reports, now_s)?;
        let weights = &self.fits.get(known.fit)?.weights;
        let mut place_m = known.newest_m;
        for (m, differences_m) in place_m.iter_mut().zip(known.differences_m) {
            *m += weights.iter().zip(differences_m).map(|(weight, difference_m)| weight * difference_m).sum::<f64>();
        }
        Some(place_m)
    }

    fn known(&self, reports: &[TouchReport], now_s: f64) -> Option<Known> {
        // Reports arrive in the order of their samples.
        let arrived = reports.get(..reports.partition_point(|report| report.arrived_s <= now_s))?;
        let newest = arrived.last()?;
        let mut differences_m = [[0.0; PLACES]; 2];
        let [x_m, y_m] = &mut differences_m;
        let mut count = 0;
        for (x_m, y_m) in x_m.iter_mut().zip(y_m) {
            let at_s = newest.sampled_s - (count + 1) as f64 * self.period_s;
            let Some([x_before_m, y_before_m]) = between(arrived, at_s) else { break };
            let [x_newest_m, y_newest_m] = newest.place_m;
            (*x_m, *y_m) = (x_before_m - x_newest_m, y_before_m - y_newest_m);
            count += 1;
        }
        let age = (AGES_PER_PERIOD * (now_s - newest.sampled_s) / self.period_s) as usize;
        let fit = count.min(PLACES - 1) * AGES + age.min(AGES - 1);
        Some(Known { newest_m: newest.place_m, differences_m, fit })
    }
}

/// The place at a time, on the line between the reports before and after it; `None` before the first.
fn between(reports: &[TouchReport], at_s: f64) -> Option<[f64; 2]> {
    let after = reports.partition_point(|report| report.sampled_s < at_s);
    let (last, next) = (reports.get(after.checked_sub(1)?)?, reports.get(after)?);
    let share = (at_s - last.sampled_s) / (next.sampled_s - last.sampled_s);
    Some([0, 1].map(|axis| last.place_m[axis] + share * (next.place_m[axis] - last.place_m[axis])))
}

impl Fit {
    fn add(&mut self, differences_m: &Differences, target_m: f64) {
        for ((row, product), difference_m) in self.squares.iter_mut().zip(&mut self.products).zip(differences_m) {
            for (square, other_m) in row.iter_mut().zip(differences_m) {
                *square += difference_m * other_m;
            }
            *product += difference_m * target_m;
        }
    }

    /// Gauss elimination; the ridge makes every pivot positive.
    fn solve(&mut self) {
        let mut rows = self.squares;
        let mut weights = self.products;
        for (number, row) in rows.iter_mut().enumerate() {
            row[number] += RIDGE_M2;
        }
        for pivot in 0..PLACES {
            let pivot_row = rows[pivot];
            for row in pivot + 1..PLACES {
                let factor = rows[row][pivot] / pivot_row[pivot];
                for (entry, above) in rows[row].iter_mut().zip(pivot_row) {
                    *entry -= factor * above;
                }
                weights[row] -= factor * weights[pivot];
            }
        }
        for pivot in (0..PLACES).rev() {
            let rest: f64 = (pivot + 1..PLACES).map(|column| rows[pivot][column] * weights[column]).sum();
            weights[pivot] = (weights[pivot] - rest) / rows[pivot][pivot];
        }
        self.weights = weights;
    }
}
