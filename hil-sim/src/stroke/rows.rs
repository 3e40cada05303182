//! Motion through given rows of time and place.

use super::{FingerState, Point, StrokeRow};

/// The motion from one row to the next: straight, at constant speed.
#[derive(Clone, Copy, Debug)]
struct Piece {
    start_s: f64,
    end_s: f64,
    start: Point,
    start_load_n: f64,
    x_speed_m_per_s: f64,
    y_speed_m_per_s: f64,
    speed_m_per_s: f64,
    load_slope_n_per_s: f64,
}

/// Rows, prepared for look-ups by time.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    pieces: Vec<Piece>,
    end_s: f64,
    /// The number of pieces that start before each of as many equal time slots as there are pieces, so that a look-up
    /// searches only one slot.
    before_slot: Vec<usize>,
    slots_per_s: f64,
    has_loads: bool,
}

impl Rows {
    /// Creates a motion through `rows`, whose times ascend.
    ///
    /// `None` if a row cannot be reached at a finite speed. The finger touches the screen only between two consecutive
    /// rows that both have a place.
    pub(super) fn new(rows: &[StrokeRow]) -> Option<Self> {
        let mut pieces = Vec::with_capacity(rows.len());
        for (start, end) in rows.iter().zip(rows.iter().skip(1)) {
            let (start_s, end_s) = (start.t_s, end.t_s);
            let [start_load_n, end_load_n] = [start, end].map(|row| row.normal_load_n.unwrap_or(f64::NAN));
            let Some((start, end)) = start.place.zip(end.place) else { continue };
            let time_s = end_s - start_s;
            let x_speed_m_per_s = (end.x_m - start.x_m) / time_s;
            let y_speed_m_per_s = (end.y_m - start.y_m) / time_s;
            let speed_m_per_s = libm::hypot(x_speed_m_per_s, y_speed_m_per_s);
            if !speed_m_per_s.is_finite() {
                return None;
            }
            let load_slope_n_per_s = (end_load_n - start_load_n) / time_s;
            pieces.push(Piece {
                start_s,
                end_s,
                start,
                start_load_n,
                x_speed_m_per_s,
                y_speed_m_per_s,
                speed_m_per_s,
                load_slope_n_per_s,
            });
        }
        let end_s = rows.last().map_or(0.0, |row| row.t_s);
        let has_loads = rows.iter().any(|row| row.normal_load_n.is_some());
        let mut motion =
            Self { slots_per_s: pieces.len() as f64 / end_s, before_slot: Vec::new(), pieces, end_s, has_loads };
        motion.before_slot = motion.count_before_slots();
        Some(motion)
    }

    pub(super) fn end_s(&self) -> f64 {
        self.end_s
    }

    /// Returns the slot of a time. It is monotonic in time regardless of rounding; the search relies on that.
    fn slot(&self, t_s: f64) -> usize {
        ((t_s * self.slots_per_s) as usize).min(self.pieces.len())
    }

    fn count_before_slots(&self) -> Vec<usize> {
        let mut before_slot = vec![0; self.pieces.len() + 2];
        for piece in &self.pieces {
            if let Some(count) = before_slot.get_mut(self.slot(piece.start_s) + 1) {
                *count += 1;
            }
        }
        let mut total = 0;
        for count in &mut before_slot {
            total += *count;
            *count = total;
        }
        before_slot
    }

    /// Returns the piece of a time up to the end; `None` while the finger is off the screen.
    fn piece(&self, t_s: f64) -> Option<&Piece> {
        let slot = self.slot(t_s);
        let (first, last) = (*self.before_slot.get(slot)?, *self.before_slot.get(slot + 1)?);
        let started = first + self.pieces.get(first..last)?.partition_point(|piece| piece.start_s <= t_s);
        self.pieces.get(started.checked_sub(1)?).filter(|piece| t_s <= piece.end_s)
    }

    /// Whether the rows state the normal load.
    pub(super) fn has_loads(&self) -> bool {
        self.has_loads
    }

    /// Returns the normal load at a time up to the end, in N, if the rows state it.
    pub(super) fn normal_load_n(&self, t_s: f64) -> Option<f64> {
        let piece = if self.has_loads { self.piece(t_s)? } else { return None };
        let load_n = piece.start_load_n + (t_s - piece.start_s) * piece.load_slope_n_per_s;
        load_n.is_finite().then_some(load_n)
    }

    /// Returns the finger at a time up to the end; `None` while it is off the screen.
    pub(super) fn at(&self, t_s: f64) -> Option<FingerState> {
        let piece = self.piece(t_s)?;
        let time_s = t_s - piece.start_s;
        Some(FingerState {
            x_m: piece.start.x_m + time_s * piece.x_speed_m_per_s,
            y_m: piece.start.y_m + time_s * piece.y_speed_m_per_s,
            speed_m_per_s: piece.speed_m_per_s,
        })
    }
}
