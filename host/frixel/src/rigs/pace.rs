//! The pace of virtual time that follows the wall clock, and the time that it drops.

/// Longest virtual time in one step, which is the largest delay of a client's bytes.
const BATCH_MAX_S: f64 = 5e-3;
/// Largest lag of virtual time behind the wall clock, for example on a busy machine. A larger lag drops time.
const LAG_MAX_S: f64 = 50e-3;

/// Time that a virtual board has dropped, in which board and finger stood still.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dropped {
    /// The dropped time, in seconds.
    pub seconds: f64,
    /// Number of times that time was dropped.
    pub times: u32,
}

/// Computes the virtual time that is due at a time of the wall clock.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pace(Dropped);

/// Virtual time that is due.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Batch {
    /// Virtual time to pass in this step, in seconds.
    pub(super) virtual_s: f64,
    /// Time that was dropped before it, in seconds; mostly zero.
    pub(super) dropped_s: f64,
}

impl Pace {
    /// The time that is due `elapsed_s` after the start on the wall clock, with `virtual_s` of virtual time passed.
    pub(super) fn next(&mut self, elapsed_s: f64, virtual_s: f64) -> Batch {
        let Self(dropped) = self;
        let behind_s = elapsed_s - dropped.seconds - virtual_s;
        if behind_s <= LAG_MAX_S {
            return Batch { virtual_s: behind_s.clamp(0.0, BATCH_MAX_S), dropped_s: 0.0 };
        }
        let dropped_s = behind_s - BATCH_MAX_S;
        dropped.seconds += dropped_s;
        dropped.times += 1;
        Batch { virtual_s: BATCH_MAX_S, dropped_s }
    }

    /// The time dropped so far.
    pub(super) fn dropped(&self) -> Dropped {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Passes virtual time as it is due, with a pause of the machine before some of the steps.
    fn run(pauses_s: &[f64]) -> (f64, f64, Pace) {
        let (mut pace, mut elapsed_s, mut virtual_s) = (Pace::default(), 0.0, 0.0);
        for pause_s in pauses_s {
            elapsed_s += 1e-3 + pause_s;
            virtual_s += pace.next(elapsed_s, virtual_s).virtual_s;
        }
        (elapsed_s, virtual_s, pace)
    }

    #[test]
    fn time_that_is_dropped_is_counted() {
        let mut pauses_s = [0.0; 500];
        pauses_s[100] = 0.2;
        pauses_s[300] = 0.5;
        let (elapsed_s, virtual_s, pace) = run(&pauses_s);
        let Dropped { seconds, times } = pace.dropped();
        assert_eq!(times, 2);
        assert!((seconds - 0.69).abs() < 0.01, "{seconds}");
        assert!((elapsed_s - seconds - virtual_s).abs() < 0.01, "{elapsed_s} {virtual_s}");
    }

    #[test]
    fn a_lag_of_less_than_50_ms_is_caught_up_on() {
        let mut pauses_s = [0.0; 200];
        pauses_s[100] = 0.045;
        let (elapsed_s, virtual_s, pace) = run(&pauses_s);
        assert_eq!(pace.dropped(), Dropped::default());
        assert!((elapsed_s - virtual_s).abs() < 2e-3, "{elapsed_s} {virtual_s}");
    }
}
