//! A trigger of a layer: when it switches the layer next.

use std::time::Duration;

/// A record that is on for a time, and in a pattern if its layer has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Trigger {
    /// Number of the record, from zero.
    pub(crate) record: u8,
    /// Time at which it ends with the record off.
    pub(crate) ends_at: Duration,
    /// Time of its next switch.
    pub(crate) next_at: Duration,
    /// Index in the pattern of the duration that ends at the next switch.
    pub(crate) step: usize,
}

impl Trigger {
    /// Creates a trigger that begins at the time `now` with the record on.
    ///
    /// `pattern` has the durations on, off, on, and so on, and repeats after the last one. An empty pattern is on all
    /// the time.
    pub(crate) fn new(record: u8, now: Duration, ends_at: Duration, pattern: &[Duration]) -> Self {
        let next_at = pattern.first().map_or(ends_at, |first| now.saturating_add(*first).min(ends_at));
        Self { record, ends_at, next_at, step: 0 }
    }

    /// The trigger once it has switched at [`Self::next_at`], and whether its record is on from then on; `None` for the
    /// trigger if it has ended.
    pub(crate) fn switched(self, pattern: &[Duration]) -> (Option<Self>, bool) {
        if self.next_at >= self.ends_at || pattern.is_empty() {
            return (None, false);
        }
        let step = (self.step + 1) % pattern.len();
        let lasts = pattern.get(step).copied().unwrap_or_default();
        let next_at = self.next_at.saturating_add(lasts).min(self.ends_at);
        (Some(Self { next_at, step, ..self }), step.is_multiple_of(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times at which a trigger of a pattern switches, and whether the record is on from then on.
    fn switches(pattern_ms: &[u64], lasts_ms: u64) -> Vec<(u128, bool)> {
        let pattern: Vec<Duration> = pattern_ms.iter().map(|ms| Duration::from_millis(*ms)).collect();
        let begin = Duration::from_secs(1);
        let mut trigger = Some(Trigger::new(0, begin, begin + Duration::from_millis(lasts_ms), &pattern));
        let mut switches = Vec::new();
        while let Some(now) = trigger {
            let (next, is_on) = now.switched(&pattern);
            switches.push((now.next_at.saturating_sub(begin).as_millis(), is_on));
            trigger = next;
        }
        switches
    }

    #[test]
    fn a_pattern_is_on_and_off_and_ends_off() {
        assert_eq!(switches(&[], 100), [(100, false)]);
        assert_eq!(switches(&[100, 50, 200], 350), [(100, false), (150, true), (350, false)]);
        assert_eq!(switches(&[100, 50, 200], 120), [(100, false), (120, false)]);
        // It begins again with its first duration.
        assert_eq!(switches(&[10, 5], 35), [(10, false), (15, true), (25, false), (30, true), (35, false)]);
        assert_eq!(switches(&[10, 5, 20], 40), [(10, false), (15, true), (35, true), (40, false)]);
    }
}
