//! The memory of tick and session.

use core::mem::MaybeUninit;

#[cfg(feature = "stream")]
use frixel_control::StreamBuffer;
use frixel_control::{Active, Board, Ticker};
use frixel_layers::BitmapPool;
use frixel_session::{NextScene, Queues, Session, SessionEnds, TickEnds};

/// Memory for bitmaps, written by the session and read by the tick.
static POOL: BitmapPool = BitmapPool::new();

/// Samples of a stream, written by the session and read by the tick.
#[cfg(feature = "stream")]
static STREAM: StreamBuffer = StreamBuffer::new();

/// Tick and session, and the ends of the queues between them.
pub struct BoardParts {
    /// Computes the voltage, in the tick.
    pub ticker: Ticker<'static>,
    /// The session with the host, in the main loop.
    pub session: &'static mut Session<'static>,
    /// The session's ends of the queues.
    pub session_ends: SessionEnds,
    /// The tick's ends.
    pub tick_ends: TickEnds,
}

/// Memory that is too large for the stack: a `static mut` in a board's `main`, which holds the only reference. All its
/// bits are zero, so that it takes no flash; `singleton!` would make it on the stack.
pub struct Memory {
    playing: Active,
    next: NextScene,
    session: MaybeUninit<Session<'static>>,
    queues: Queues,
}

impl Memory {
    /// Empty memory.
    #[allow(clippy::new_without_default, reason = "it belongs in a static, not on the stack")]
    pub const fn new() -> Self {
        Self { playing: Active::new(), next: NextScene::new(), session: MaybeUninit::uninit(), queues: Queues::new() }
    }

    /// Creates the tick, the session and the queues between them, with the ends of each.
    #[inline(never)]
    pub fn make(&'static mut self, board: Board) -> BoardParts {
        #[cfg_attr(not(feature = "stream"), allow(unused_mut, reason = "a stream is attached to it"))]
        let mut ticker = Ticker::new(&board, &POOL, &mut self.playing);
        let session = session(&mut self.session, board, &mut self.next);
        #[cfg(feature = "stream")]
        {
            ticker.attach_stream(&STREAM);
            session.attach_stream(&STREAM);
        }
        let (session_ends, tick_ends) = self.queues.split();
        BoardParts { ticker, session, session_ends, tick_ends }
    }
}

/// Creates the session on the stack, in a function of its own, which uses that much stack at the start only.
#[inline(never)]
fn session(
    place: &'static mut MaybeUninit<Session<'static>>,
    board: Board,
    next: &'static mut NextScene,
) -> &'static mut Session<'static> {
    place.write(Session::new(board, &POOL, next))
}
