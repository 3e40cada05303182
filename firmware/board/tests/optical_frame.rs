//! The touch frame as a touch source of the main loop.

use std::cell::Cell;
use std::convert::Infallible;
use std::pin::pin;
use std::rc::Rc;

use embedded_hal::digital::{ErrorType as PinErrorType, InputPin};
use embedded_hal_async::i2c::{ErrorKind, ErrorType, I2c, Operation};
use frixel_board::optical_frame::{OpticalFrame, Reports, TickDelay, read};
use frixel_board::tick::TickShared;
use frixel_drivers::zforce::ZForce;

use crate::support::firmware::BOARD;
use crate::support::hardware::run_tick;
use crate::support::played::Board;

const TICK_HZ: u32 = BOARD.tick_hz;

/// A bus on which nobody answers.
struct Silent(Rc<Cell<u32>>);

impl ErrorType for Silent {
    type Error = ErrorKind;
}

impl I2c for Silent {
    async fn transaction(&mut self, _: u8, _: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        self.0.set(self.0.get() + 1);
        Err(ErrorKind::Other)
    }
}

struct Low;

impl PinErrorType for Low {
    type Error = Infallible;
}

impl InputPin for Low {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(false)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(true)
    }
}

/// A frame without supply is asked again every 0.1 s, in ticks, and the main loop never waits for it.
#[test]
fn a_frame_that_does_not_answer_is_asked_again_after_a_tenth_of_a_second() {
    let board = Board::new();
    let shared: &'static TickShared = board.shared;
    let (asked, errors) = (Rc::new(Cell::new(0)), Cell::new(0));
    let reports = Reports::new(None);
    let frame = ZForce::new(Silent(Rc::clone(&asked)), Low, TickDelay::<TICK_HZ>(shared));
    let mut reading = pin!(read(frame, 400, &reports, |_| errors.set(errors.get() + 1)));
    let mut source = OpticalFrame::new(reading.as_mut(), &reports);
    let mut asked_at = Vec::new();
    while asked_at.len() < 4 {
        let before = asked.get();
        assert_eq!(source.next_touch(), None);
        if asked.get() > before {
            asked_at.push(shared.count());
        }
        run_tick();
        assert!(shared.count() < TICK_HZ, "{asked_at:?}");
    }
    assert!(asked_at.windows(2).all(|pair| (4_000..=4_002).contains(&(pair[1] - pair[0]))), "{asked_at:?}");
    assert_eq!(errors.get(), 3, "each is said after its pause");
}
