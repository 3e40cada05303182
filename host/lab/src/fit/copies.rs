//! Rows that occur twice in a recording, as in a file that was appended to itself. They would narrow the intervals.

use super::table::Row;

/// Threshold for a copy: the succession of its rows is as improbable as eight rows that occur nowhere else.
const SUCCESSIONS: f64 = 7.0;

/// First and last row numbers of a run of rows that repeats an earlier run, regardless of time and stroke, and of that
/// earlier run. `None` without a repetition, or if chance explains it.
pub(super) fn find(rows: &[Row]) -> Option<[[u64; 2]; 2]> {
    // A sensor that is read faster than it measures repeats its rows.
    let runs: Vec<&[Row]> = rows.chunk_by(|one, next| measured(one) == measured(next)).collect();
    let singles = Windows::new(runs.len(), |at| runs.get(at).and_then(|run| run.first()).map(measured));
    let mut windows = Windows::new(runs.len().saturating_sub(1), |at| (singles.first(at), singles.first(at + 1)));
    let bits = information(&singles, &windows);
    let needed = SUCCESSIONS * (runs.len() as f64).log2();
    let mut length = 2;
    while windows.has_copies() {
        let is_improbable = |at: usize| Some(bits.get(at + length - 1)? - bits.get(at)? >= needed);
        if let Some((at, of)) = windows.copies().find(|(at, _)| is_improbable(*at).unwrap_or_default()) {
            // The runs at either end of a window may belong to it by chance, and be of other lengths.
            let row = |window: usize| runs.iter().take(window + length / 2).map(|run| run.len()).sum();
            return Some(copied(rows, row(at), row(of)));
        }
        let count = runs.len().saturating_sub(2 * length - 1);
        windows = Windows::new(count, |at| (windows.first(at), windows.first(at + length)));
        length *= 2;
    }
    None
}

fn measured(row: &Row) -> [u64; 3] {
    [row.voltage_v_rms, row.normal_force_n, row.friction_n].map(f64::to_bits)
}

/// Windows of consecutive runs, one at each run, and which of them are equal.
struct Windows {
    /// For each window, the first one that is equal.
    firsts: Vec<usize>,
    /// Number of windows that are equal to each, itself included.
    counts: Vec<usize>,
}

impl Windows {
    /// Windows with equal keys are equal.
    fn new<K: Ord>(count: usize, key: impl Fn(usize) -> K) -> Self {
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by_key(|at| key(*at));
        let (mut firsts, mut counts) = (vec![0; count], vec![0; count]);
        for equal in order.chunk_by(|one, next| key(*one) == key(*next)) {
            for at in equal {
                if let (Some(first), Some(number)) = (firsts.get_mut(*at), counts.get_mut(*at)) {
                    (*first, *number) = (equal.first().copied().unwrap_or_default(), equal.len());
                }
            }
        }
        Self { firsts, counts }
    }

    fn first(&self, at: usize) -> usize {
        self.firsts.get(at).copied().unwrap_or_default()
    }

    /// Number of equal windows beside this one and one copy of it.
    fn others(&self, at: usize) -> f64 {
        self.counts.get(at).map_or(0, |count| count.saturating_sub(2)) as f64
    }

    /// The windows that stand earlier as well, each with its first place.
    fn copies(&self) -> impl Iterator<Item = (usize, usize)> {
        self.firsts.iter().copied().enumerate().filter(|(at, first)| at != first)
    }

    fn has_copies(&self) -> bool {
        self.copies().next().is_some()
    }
}

/// Information in the successions of runs up to each run, in bits, as the rest of the recording shows their frequencies:
/// none where a run always follows another, as in a signal without noise.
fn information(singles: &Windows, pairs: &Windows) -> Vec<f64> {
    let count = singles.firsts.len();
    let mut bits = 0.0;
    let of_succession = |at: usize| {
        let probability = (singles.others(at + 1) + 0.5) / count as f64;
        -((pairs.others(at) + probability) / (singles.others(at) + 1.0)).log2()
    };
    let up_to = |run: usize| {
        bits += if run == 0 { 0.0 } else { of_succession(run - 1) };
        bits
    };
    (0..count).map(up_to).collect()
}

/// The numbers of the equal rows around `row` and around `of`: first and last of each.
fn copied(rows: &[Row], row: usize, of: usize) -> [[u64; 2]; 2] {
    let is_equal = |(one, other): &(&Row, &Row)| measured(one) == measured(other);
    let (before, behind) = (rows.split_at(row.min(rows.len())), rows.split_at(of.min(rows.len())));
    let earlier = before.0.iter().rev().zip(behind.0.iter().rev()).take_while(is_equal).count();
    let later = before.1.iter().zip(behind.1).take_while(is_equal).count();
    let numbers = |at: usize| {
        let copy = rows.get(at - earlier..at + later).unwrap_or_default();
        [copy.first(), copy.last()].map(|row| row.map_or(0, |row| row.number))
    };
    [numbers(row), numbers(of)]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Row, find};

    /// Added to the numbers of copied rows.
    const LATER: u64 = 1_000_000;

    /// Appends a copy of rows.
    fn append(rows: &mut Vec<Row>, from: usize, count: usize, later_s: f64) {
        let copy = rows[from..from + count].to_vec();
        rows.extend(copy.into_iter().map(|row| Row {
            number: row.number + LATER,
            time_s: row.time_s.map(|time_s| time_s + later_s),
            ..row
        }));
    }

    /// Rows of a sensor that measures once in some rows, in steps, with noise and under a load that wanders.
    fn rows(seed: u64, count: usize, held: usize, step_n: f64, noise_n: f64) -> Vec<Row> {
        let mut state = seed;
        // A part of SplitMix64, from -0.5 to 0.5.
        let mut random = || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            (mixed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let (mut load_n, mut measured_n) = (0.5, [0.0; 2]);
        let mut row = |index: usize| {
            let voltage_v_rms = if (index / 25).is_multiple_of(2) { 0.0 } else { 150.0 };
            load_n += 0.002 * random() - 1e-3 * (load_n - 0.5);
            if index.is_multiple_of(held) {
                let friction_n = 0.5 * load_n + 0.07 * voltage_v_rms / 150.0;
                measured_n =
                    [load_n, friction_n].map(|force_n| ((force_n + noise_n * random()) / step_n).round() * step_n);
            }
            let [normal_force_n, friction_n] = measured_n;
            let (number, time_s) = (index as u64 + 2, Some(1e-3 * index as f64));
            Row {
                number,
                voltage_v_rms,
                normal_force_n,
                friction_n,
                time_s,
                stroke: None,
                speed_mm_s: None,
                is_simulated: false,
            }
        };
        (0..count).map(&mut row).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Fifteen rows hold a window of eight, wherever they begin.
        #[test]
        fn rows_that_return_are_named(
            seed in 0_u64..1_000_000,
            from in 0_usize..400,
            count in 15_usize..100,
            later_s in 0.0_f64..9.0,
        ) {
            let mut rows = rows(seed, 500, 1, 1e-9, 0.004);
            prop_assert_eq!(find(&rows), None);
            append(&mut rows, from, count, later_s);
            let first = from as u64 + 2;
            let of = [first, first + count as u64 - 1];
            prop_assert_eq!(find(&rows), Some([of.map(|row| row + LATER), of]));
        }
    }

    /// The rows that end a recording may be those before the copied ones by chance, though held for other times.
    #[test]
    fn a_copy_behind_rows_that_are_equal_by_chance_is_named_whole() {
        let mut rows = rows(355_818, 20_000, 2, 0.02, 0.001);
        append(&mut rows, 7_580, 8_000, 60.0);
        let [[_, last], of] = find(&rows).unwrap();
        assert!(last == of[1] + LATER && of[1] - of[0] >= 7_999, "{of:?} {last}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// A sensor that is read faster than it measures, or that has coarse steps, repeats its rows, and a copy of them
        /// is found all the same.
        #[test]
        fn rows_of_a_poor_sensor_that_return_are_named(
            seed in 0_u64..1_000_000,
            held in 1_usize..12,
            step_n in prop::sample::select(vec![1e-9, 1e-4, 1e-3, 5e-3, 0.01, 0.02]),
            noise_n in 0.001_f64..0.01,
            from in 0_usize..12_000,
        ) {
            let mut rows = rows(seed, 20_000, held, step_n, noise_n);
            prop_assert_eq!(find(&rows), None);
            append(&mut rows, from, 8_000, 60.0);
            // Rows before those that were copied may be equal by chance.
            let [[_, last], of] = find(&rows).unwrap();
            prop_assert!(last == of[1] + LATER && of[1] - of[0] >= 7_999, "{of:?} {last}");
        }
    }
}
