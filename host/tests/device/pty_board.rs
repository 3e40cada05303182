//! A fake board behind a pseudo-terminal, in its own thread.

use std::io::{ErrorKind, Read, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serialport::{SerialPort, TTYPort};

use crate::fake_board::FakeBoard;

pub(crate) struct PtyBoard {
    pub(crate) path: String,
    pub(crate) board: Arc<Mutex<FakeBoard>>,
    unplugged: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl PtyBoard {
    pub(crate) fn start(board: FakeBoard) -> Self {
        let (master, slave) = TTYPort::pair().unwrap();
        let path = slave.name().unwrap();
        let board = Arc::new(Mutex::new(board));
        let unplugged = Arc::new(AtomicBool::new(false));
        let thread = std::thread::spawn({
            let (board, unplugged) = (Arc::clone(&board), Arc::clone(&unplugged));
            // The slave is held open, so that hosts may come and go.
            move || {
                serve(master, &board, &unplugged);
                drop(slave);
            }
        });
        Self { path, board, unplugged, thread: Some(thread) }
    }

    /// Pulls the cable: returns when the pseudo-terminal is gone.
    pub(crate) fn unplug(&mut self) {
        self.unplugged.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap();
        }
    }

    /// Waits until the board is as wanted; a test that waits in vain fails.
    pub(crate) fn until(&self, wanted: impl Fn(&FakeBoard) -> bool) {
        let started = Instant::now();
        while !wanted(&self.board.lock().unwrap()) {
            assert!(started.elapsed() < Duration::from_mins(1), "the board did not get there");
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

impl Drop for PtyBoard {
    fn drop(&mut self) {
        self.unplug();
    }
}

fn serve(mut master: TTYPort, board: &Mutex<FakeBoard>, unplugged: &AtomicBool) {
    master.set_timeout(Duration::from_millis(2)).unwrap();
    let started = Instant::now();
    let mut bytes = [0; 512];
    while !unplugged.load(Ordering::Relaxed) {
        let len = match master.read(&mut bytes) {
            Ok(len) => len,
            Err(error) if error.kind() == ErrorKind::TimedOut => 0,
            Err(error) => panic!("{error}"),
        };
        let mut board = board.lock().unwrap();
        let mut out = board.receive(&bytes[..len], started.elapsed());
        out.extend(board.poll(started.elapsed()));
        drop(board);
        master.write_all(&out).unwrap();
    }
}
