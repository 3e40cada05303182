use proptest::prelude::*;

use super::{CountRestarted, Credit};

const WINDOW: u16 = 4096;

/// A line that keeps the order of frames and may lose bytes, with the actual counts of both ends.
#[derive(Default)]
struct Line {
    written: u64,
    /// Lengths of the frames on the way, and whether they will arrive.
    under_way: Vec<(u64, bool)>,
    received: u32,
}

impl Line {
    fn write(&mut self, len: u64, arrives: bool) {
        self.written += len;
        self.under_way.push((len, arrives));
    }

    /// Takes the next frame off the line.
    fn deliver(&mut self) {
        if !self.under_way.is_empty() {
            let (len, arrives) = self.under_way.remove(0);
            self.received = self.received.wrapping_add(if arrives { len as u32 } else { 0 });
        }
    }

    fn bytes_under_way(&self) -> u64 {
        self.under_way.iter().map(|(len, _)| len).sum()
    }

    fn take(&mut self, step: &Step, credit: &mut Credit) {
        match step {
            Step::Write(len, arrives) => self.write(*len, *arrives),
            Step::Deliver => self.deliver(),
            Step::Report => assert_eq!(credit.received(self.received, self.written), Ok(())),
        }
    }
}

#[derive(Clone, Debug)]
enum Step {
    Write(u64, bool),
    Deliver,
    Report,
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let step = prop_oneof![
        (1_u64..192, any::<bool>()).prop_map(|(len, arrives)| Step::Write(len, arrives)),
        Just(Step::Deliver),
        Just(Step::Report),
    ];
    prop::collection::vec(step, 0..200)
}

proptest! {
    /// Credit never exceeds the room of the board, for any lost bytes and any count of the board.
    #[test]
    fn bytes_under_way_are_never_underestimated(steps in steps(), start in any::<u32>()) {
        let mut line = Line { written: u64::from(start), ..Line::default() };
        let mut credit = Credit::new(WINDOW, line.written);
        for step in &steps {
            line.take(step, &mut credit);
            prop_assert!(line.written - credit.settled() >= line.bytes_under_way());
        }
    }

    /// An answer that is the last on the line corrects the credit for all earlier losses.
    #[test]
    fn an_answer_settles_what_was_lost(steps in steps(), later in 1_u64..192) {
        let mut line = Line::default();
        let mut credit = Credit::new(WINDOW, 0);
        for step in &steps {
            line.take(step, &mut credit);
        }
        line.write(20, true);
        let request_end = line.written;
        let behind = later > 96;
        if behind {
            line.write(later, true);
        }
        while line.bytes_under_way() > if behind { later } else { 0 } {
            line.deliver();
        }
        prop_assert_eq!(credit.received(line.received, line.written), Ok(()));
        credit.answered(request_end, line.written);
        prop_assert_eq!(line.written - credit.settled(), line.bytes_under_way());
    }
}

#[test]
fn the_boards_count_may_wrap() {
    let mut credit = Credit::new(WINDOW, 0);
    let mut written = 0;
    for received in [0x7000_0000, 0xe000_0000, 0x5000_0000_u32] {
        written += 0x7000_0000;
        assert_eq!(credit.received(received, written), Ok(()));
        assert_eq!(credit.settled(), written);
    }
}

#[test]
fn a_count_that_goes_back_is_a_restart() {
    let mut credit = Credit::new(WINDOW, 0);
    assert_eq!(credit.received(1000, 1000), Ok(()));
    assert_eq!(credit.received(999, 2000), Err(CountRestarted));
}

#[test]
fn the_window_is_filled_to_the_last_byte_and_no_further() {
    let credit = Credit::new(WINDOW, 0);
    assert!(credit.allows(96, 0, 4000));
    assert!(!credit.allows(97, 0, 4000));
    assert!(credit.allows(90, 6, 4000));
    assert!(!credit.allows(90, 7, 4000));
}
