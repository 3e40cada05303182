//! Clipping of lines at the edges of a plot.

use std::ops::Range;

type Place = (f64, f64);

/// The parts of a line through `places` inside a rectangle. `None` breaks the line.
pub(super) fn clipped(places: &[Option<Place>], x: &Range<f64>, y: &Range<f64>) -> Vec<Vec<Place>> {
    let mut stretches: Vec<Vec<Place>> = Vec::new();
    let mut open = false;
    for pair in places.windows(2) {
        let &[Some(from), Some(to)] = pair else {
            open = false;
            continue;
        };
        let Some((start, end)) = inside(from, to, x, y) else {
            open = false;
            continue;
        };
        match stretches.last_mut() {
            Some(stretch) if open => stretch.push(end),
            _ => stretches.push(vec![start, end]),
        }
        open = end == to;
    }
    stretches
}

/// The part of a line segment inside a rectangle (Liang and Barsky, doi:10.1145/357332.357333).
fn inside(from: Place, to: Place, x: &Range<f64>, y: &Range<f64>) -> Option<(Place, Place)> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    let edges = [(-dx, from.0 - x.start), (dx, x.end - from.0), (-dy, from.1 - y.start), (dy, y.end - from.1)];
    for (speed, room) in edges {
        if speed < 0.0 {
            first = first.max(room / speed);
        } else if speed > 0.0 {
            last = last.min(room / speed);
        } else if room < 0.0 {
            return None;
        }
    }
    let along = |part: f64| if part >= 1.0 { to } else { (from.0 + part * dx, from.1 + part * dy) };
    (first <= last).then(|| (along(first), along(last)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_where_it_crosses_the_edges_and_where_it_is_broken() {
        let places = [(-1.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.9, 2.0), (0.9, -1.0)].map(Some);
        let found = clipped(&places, &(0.0..1.0), &(0.0..1.0));
        assert_eq!(found, [vec![(0.0, 0.5), (0.5, 0.5), (0.5, 1.0)], vec![(0.9, 1.0), (0.9, 0.0)]]);
        let holed = [Some((0.1, 0.1)), Some((0.2, 0.2)), None, Some((0.3, 0.3)), Some((0.4, 0.4))];
        assert_eq!(clipped(&holed, &(0.0..1.0), &(0.0..1.0)).len(), 2);
        assert_eq!(clipped(&[Some((2.0, 0.0)), Some((2.0, 1.0))], &(0.0..1.0), &(0.0..1.0)), Vec::<Vec<Place>>::new());
    }
}
