//! Selects the finger to follow if there are several, since one electrode can render the effect for only one finger.

use frixel_layers::Leader;
use frixel_wire::touch::Touch;
use heapless::Vec;

/// Largest number of tracked fingers. Further fingers are ignored.
const FINGERS_MAX: usize = 10;

/// The fingers reported by the host, and the pending reports of the followed one.
pub(super) struct Fingers {
    /// Numbers of the fingers, in the order of their touch-down.
    down: Vec<u8, FINGERS_MAX>,
    /// The finger that is followed.
    followed: Option<u8>,
    /// Whether a lift of the followed finger is to be reported.
    gone: bool,
    /// The last position of the followed finger, if it has not been reported yet.
    place: Option<Touch>,
}

impl Fingers {
    pub(super) const fn new() -> Self {
        Self { down: Vec::new(), followed: None, gone: false, place: None }
    }

    /// Takes a finger's position.
    pub(super) fn touch(&mut self, finger: u8, place: Touch, rule: Leader) {
        if !self.down.contains(&finger) && self.down.push(finger).is_err() {
            return;
        }
        self.follow(rule);
        if self.followed == Some(finger) {
            self.place = Some(place);
        }
    }

    /// Records a lift. The lift of an unknown finger is also reported, since the tracker may still follow it.
    pub(super) fn lift(&mut self, finger: u8, rule: Leader) {
        self.down.retain(|other| *other != finger);
        if self.down.is_empty() {
            self.let_go();
        }
        self.follow(rule);
    }

    /// Forgets all fingers.
    pub(super) fn forget(&mut self) {
        if self.followed.is_some() {
            self.let_go();
        }
        self.down.clear();
    }

    /// The next report. A change of the followed finger is reported as a lift first, so that their distance is not
    /// taken for a movement.
    pub(super) fn next(&mut self) -> Option<Touch> {
        if core::mem::take(&mut self.gone) { Some(Touch::Up) } else { self.place.take() }
    }

    /// Selects the finger to follow by `rule`.
    fn follow(&mut self, rule: Leader) {
        let leader = match rule {
            Leader::First => self.down.first(),
            Leader::Latest => self.down.last(),
        };
        let leader = leader.copied();
        if leader != self.followed {
            if self.followed.is_some() {
                self.let_go();
            }
            self.followed = leader;
        }
    }

    fn let_go(&mut self) {
        self.gone = true;
        self.place = None;
        self.followed = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(finger: u8, step: u32) -> Touch {
        Touch::Down { x_m: 0.01 * f32::from(finger), y_m: 0.02, age_ticks: step }
    }

    fn reports(fingers: &mut Fingers) -> std::vec::Vec<Touch> {
        core::iter::from_fn(|| fingers.next()).collect()
    }

    #[test]
    fn the_first_leads_until_it_lifts() {
        let mut fingers = Fingers::new();
        for step in 0..3 {
            fingers.touch(7, place(7, step), Leader::First);
            fingers.touch(2, place(2, step), Leader::First);
            assert_eq!(reports(&mut fingers), [place(7, step)]);
        }
        fingers.lift(7, Leader::First);
        assert_eq!(reports(&mut fingers), [Touch::Up]);
        fingers.touch(2, place(2, 9), Leader::First);
        assert_eq!(reports(&mut fingers), [place(2, 9)]);
        fingers.lift(2, Leader::First);
        assert_eq!(reports(&mut fingers), [Touch::Up]);
    }

    #[test]
    fn the_latest_leads_until_it_lifts() {
        let mut fingers = Fingers::new();
        fingers.touch(1, place(1, 0), Leader::Latest);
        assert_eq!(reports(&mut fingers), [place(1, 0)]);
        fingers.touch(5, place(5, 0), Leader::Latest);
        assert_eq!(reports(&mut fingers), [Touch::Up, place(5, 0)], "no track connects the two fingers");
        fingers.touch(1, place(1, 1), Leader::Latest);
        assert_eq!(reports(&mut fingers), []);
        fingers.lift(5, Leader::Latest);
        fingers.touch(1, place(1, 2), Leader::Latest);
        assert_eq!(reports(&mut fingers), [Touch::Up, place(1, 2)]);
    }

    #[test]
    fn a_finger_that_does_not_lead_lifts_unnoticed() {
        let mut fingers = Fingers::new();
        fingers.touch(1, place(1, 0), Leader::First);
        fingers.touch(2, place(2, 0), Leader::First);
        fingers.lift(2, Leader::First);
        assert_eq!(reports(&mut fingers), [place(1, 0)]);
    }

    #[test]
    fn a_finger_that_comes_down_again_in_one_batch_begins_anew() {
        let mut fingers = Fingers::new();
        fingers.touch(0, place(0, 0), Leader::First);
        assert_eq!(reports(&mut fingers), [place(0, 0)]);
        fingers.lift(0, Leader::First);
        fingers.touch(0, place(9, 0), Leader::First);
        assert_eq!(reports(&mut fingers), [Touch::Up, place(9, 0)]);
    }

    #[test]
    fn a_change_of_rule_changes_the_leader() {
        let mut fingers = Fingers::new();
        fingers.touch(1, place(1, 0), Leader::First);
        fingers.touch(2, place(2, 0), Leader::First);
        reports(&mut fingers);
        fingers.touch(2, place(2, 1), Leader::Latest);
        assert_eq!(reports(&mut fingers), [Touch::Up, place(2, 1)]);
    }

    #[test]
    fn excess_fingers_are_ignored_and_a_new_host_starts_without_fingers() {
        let mut fingers = Fingers::new();
        for finger in 0..20 {
            fingers.touch(finger, place(finger, 0), Leader::Latest);
        }
        assert_eq!(reports(&mut fingers), [Touch::Up, place(9, 0)]);
        fingers.forget();
        assert_eq!(reports(&mut fingers), [Touch::Up]);
        fingers.touch(15, place(15, 0), Leader::First);
        assert_eq!(reports(&mut fingers), [place(15, 0)]);
    }
}
