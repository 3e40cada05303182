//! A fake board behind a pseudo-terminal, in its own thread.

use std::io::{ErrorKind, Read, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use frixel_driver::{Link, LinkClosed, SerialLink, Written};
use serialport::{SerialPort, TTYPort};

use crate::fake_board::FakeBoard;

/// How much slower the clock of a [`Patient`] link runs.
const PATIENCE: u32 = 40;

/// A serial link with a slow clock, so that the driver's deadlines hold on a machine that is busy with other things:
/// the kernel may hand over a pseudo-terminal's bytes seconds late.
pub(crate) struct Patient(pub(crate) SerialLink);

impl Link for Patient {
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed> {
        self.0.write(frame)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        self.0.read(buffer, wait * PATIENCE)
    }

    fn now(&self) -> Duration {
        self.0.now() / PATIENCE
    }

    fn keep_alive(&mut self, period: Duration) {
        self.0.keep_alive(period);
    }

    fn set_shutdown_frames(&mut self, frames: Vec<u8>) {
        self.0.set_shutdown_frames(frames);
    }

    fn written(&self) -> Written {
        self.0.written()
    }

    fn name(&self) -> &str {
        self.0.name()
    }
}

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
            assert!(started.elapsed() < Duration::from_mins(2), "the board did not get there");
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
    let mut to_host = master.try_clone().unwrap();
    to_host.set_timeout(Duration::from_secs(5)).unwrap();
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
        match to_host.write_all(&out) {
            Ok(()) => {}
            // What nobody reads is lost, as on a real line.
            Err(error) if error.kind() == ErrorKind::TimedOut => {}
            Err(error) => panic!("{error}"),
        }
    }
}
