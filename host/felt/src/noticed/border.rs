//! Borders that a finger crossed.

use std::ops::Range;

use frixel_scene::Program;
use frixel_scene::reference::{Context, Reference};

use super::likeness::Likeness;
use super::moment::{MOMENT_HZ, Moment};
use super::{BTreeMap, FINGERTIP_M, NoticedBorder, Sums, starts_on};
use crate::perception::{border_reference, border_sides, total_n, visible_layers};

/// Longest way on either side of a border, m.
const SIDE_MAX_M: f64 = 0.01;
/// Longest time on either side of a border, in moments: 200 ms.
const SIDE_MAX: usize = 400;
/// A shorter time on one side is a corner, in moments: 2 ms.
const SIDE_MIN: usize = 4;

/// The borders of a scene, with what a finger felt at them.
#[derive(Clone, Debug)]
pub(super) struct Crossings {
    program: Program,
    reference: Reference,
    borders: BTreeMap<[Option<usize>; 2], Crossed>,
}

/// Sums over the crossings of a border.
#[derive(Clone, Copy, Debug, Default)]
struct Crossed {
    count: f64,
    /// Friction on either side, electric, N.
    sides_n: [f64; 2],
    /// The layers that are only on that side, a bit each.
    layers: [u64; 2],
    sums: Sums,
    likeness: Likeness,
}

impl Crossings {
    pub(super) fn new(program: &Program) -> Self {
        Self {
            reference: border_reference(program, |layer| starts_on(program, layer)),
            borders: BTreeMap::new(),
            program: program.clone(),
        }
    }

    /// Adds the borders that are crossed in a run.
    pub(super) fn add(&mut self, run: &[Moment]) {
        let visible = |moment: &Moment| visible_layers(&self.reference, moment.context.x_m, moment.context.y_m);
        let visible: Vec<u64> = run.iter().map(visible).collect();
        let same: Vec<&[u64]> = visible.chunk_by(|one, other| one == other).collect();
        let mut border = 0;
        for pair in same.windows(2) {
            let [before, after] = pair else { continue };
            border += before.len();
            let first = side(run.iter().take(border).rev(), before.len());
            let second = side(run.iter().skip(border), after.len());
            if let (Some(first), Some(second)) = (first, second) {
                self.cross(run, border - first.end..border - first.start, border + second.start..border + second.end);
            }
        }
    }

    /// Adds a border with the moments before and after it.
    fn cross(&mut self, run: &[Moment], before: Range<usize>, after: Range<usize>) {
        let (Some(last), Some(first)) = (run.get(before.end - 1), run.get(after.start)) else { return };
        let side = |moment: &Moment| {
            let context = Context { t_s: 0.0, ..moment.context };
            let electric_n = total_n(&self.program, self.reference.electric_friction_at_n(&context))
                - self.program.reach.natural_friction_n;
            (visible_layers(&self.reference, context.x_m, context.y_m), electric_n)
        };
        let ((before_layers, before_n), (after_layers, after_n)) = (side(last), side(first));
        let (sides, is_turned) = border_sides(before_layers, after_layers);
        let turned = |pair: [f64; 2]| if is_turned { [pair[1], pair[0]] } else { pair };
        let only = [before_layers & !after_layers, after_layers & !before_layers];
        let crossed = self.borders.entry(sides).or_default();
        crossed.count += 1.0;
        for (sum_n, side_n) in crossed.sides_n.iter_mut().zip(turned([before_n, after_n])) {
            *sum_n += side_n;
        }
        for (layers, only) in crossed.layers.iter_mut().zip(if is_turned { [only[1], only[0]] } else { only }) {
            *layers |= only;
        }
        for moment in before.clone().chain(after.clone()).filter_map(|number| run.get(number)) {
            crossed.sums.add(moment);
        }
        let [low, high] = turned([0.0, 1.0]);
        let signal = before.map(|number| (number, low)).chain(after.map(|number| (number, high)));
        crossed.likeness.add(signal, run);
    }

    pub(super) fn noticed(&self) -> Vec<NoticedBorder> {
        let noticed = |(sides, crossed): (&[Option<usize>; 2], &Crossed)| {
            let friction_n = crossed.sides_n.map(|sum_n| sum_n / crossed.count);
            let step = crossed.sums.felt_step(friction_n, crossed.likeness.part_of_scene());
            NoticedBorder { sides: *sides, layers: crossed.layers, step }
        };
        self.borders.iter().map(noticed).collect()
    }
}

/// The moments of one side that count, from the border away; `None` for a corner. `same` moments have the same layers.
fn side<'m>(moments: impl Iterator<Item = &'m Moment>, same: usize) -> Option<Range<usize>> {
    let ways_m = moments.scan(0.0, |way_m, moment| {
        *way_m += moment.context.speed_m_per_s / MOMENT_HZ;
        Some(*way_m)
    });
    let ways_m = ways_m.take(same.min(SIDE_MAX)).take_while(|way_m| *way_m < SIDE_MAX_M);
    let (near, all) = ways_m.fold((0, 0), |(near, all), way_m| (near + usize::from(way_m < FINGERTIP_M), all + 1));
    (all >= SIDE_MIN).then(|| near.min(all - SIDE_MIN)..all)
}
