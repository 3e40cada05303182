//! Motion through given rows of time and place.

use super::{FingerState, Point, StrokeRow};

/// The motion from one row to the next: straight, at constant speed.
#[derive(Clone, Copy, Debug)]
struct Segment {
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
    segments: Vec<Segment>,
    end_s: f64,
    /// The number of segments that start before each of as many equal time slots as there are segments: a look-up
    /// searches only one slot.
    before_slot: Vec<usize>,
    slots_per_s: f64,
    pub(super) has_loads: bool,
}

impl Rows {
    /// Creates a motion through `rows`, whose times ascend.
    ///
    /// `None` if a row cannot be reached at a finite speed. The finger touches the screen only between two consecutive
    /// rows that both have a place.
    pub(super) fn new(rows: &[StrokeRow]) -> Option<Self> {
        let mut segments = Vec::with_capacity(rows.len());
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
            segments.push(Segment {
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
            Self { slots_per_s: segments.len() as f64 / end_s, before_slot: Vec::new(), segments, end_s, has_loads };
        motion.before_slot = motion.count_before_slots();
        Some(motion)
    }

    pub(super) fn end_s(&self) -> f64 {
        self.end_s
    }

    /// Returns the slot of a time. It is monotonic in time regardless of rounding; the search relies on that.
    fn slot(&self, t_s: f64) -> usize {
        ((t_s * self.slots_per_s) as usize).min(self.segments.len())
    }

    fn count_before_slots(&self) -> Vec<usize> {
        let mut before_slot = vec![0; self.segments.len() + 2];
        for segment in &self.segments {
            if let Some(count) = before_slot.get_mut(self.slot(segment.start_s) + 1) {
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

    /// Returns the segment of a time up to the end; `None` while the finger is off the screen.
    fn segment(&self, t_s: f64) -> Option<&Segment> {
        let slot = self.slot(t_s);
        let (first, last) = (*self.before_slot.get(slot)?, *self.before_slot.get(slot + 1)?);
        let started = first + self.segments.get(first..last)?.partition_point(|segment| segment.start_s <= t_s);
        self.segments.get(started.checked_sub(1)?).filter(|segment| t_s <= segment.end_s)
    }

    /// Returns the normal load at a time up to the end, in N, if the rows state it.
    pub(super) fn normal_load_n(&self, t_s: f64) -> Option<f64> {
        let segment = if self.has_loads { self.segment(t_s)? } else { return None };
        let load_n = segment.start_load_n + (t_s - segment.start_s) * segment.load_slope_n_per_s;
        load_n.is_finite().then_some(load_n)
    }

    /// Returns the finger at a time up to the end; `None` while it is off the screen.
    pub(super) fn at(&self, t_s: f64) -> Option<FingerState> {
        let segment = self.segment(t_s)?;
        let time_s = t_s - segment.start_s;
        Some(FingerState {
            x_m: segment.start.x_m + time_s * segment.x_speed_m_per_s,
            y_m: segment.start.y_m + time_s * segment.y_speed_m_per_s,
            speed_m_per_s: segment.speed_m_per_s,
        })
    }
}
