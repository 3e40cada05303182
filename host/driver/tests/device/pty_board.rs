//! The simulated board behind a pseudo-terminal, in its own thread.

use std::io::{ErrorKind, Read, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use frixel_driver::{ByteStream, Link, LinkClosed, SerialLink, Written};
use serialport::{SerialPort, TTYPort};

use crate::virtual_link::VirtualLine;

/// Factor by which the clock of a [`Patient`] link is slowed down.
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
    pub(crate) line: Arc<Mutex<VirtualLine>>,
    unplugged: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl PtyBoard {
    pub(crate) fn start() -> Self {
        let (master, slave) = TTYPort::pair().unwrap();
        let path = slave.name().unwrap();
        let line = Arc::new(Mutex::new(VirtualLine::new()));
        let unplugged = Arc::new(AtomicBool::new(false));
        let thread = std::thread::spawn({
            let (line, unplugged) = (Arc::clone(&line), Arc::clone(&unplugged));
            // The slave is held open, so that hosts may come and go.
            move || {
                serve(master, &line, &unplugged);
                drop(slave);
            }
        });
        Self { path, line, unplugged, thread: Some(thread) }
    }

    /// Pulls the cable: returns when the pseudo-terminal is gone.
    pub(crate) fn unplug(&mut self) {
        self.unplugged.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap();
        }
    }

    /// Waits until `wanted` holds for the line; fails after two minutes.
    pub(crate) fn until(&self, wanted: impl Fn(&VirtualLine) -> bool) {
        let started = Instant::now();
        while !wanted(&self.line.lock().unwrap()) {
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

/// Advances the board's time as it receives bytes, and otherwise by one tick every 2 ms: far slower than real time, to
/// tolerate a host that gets no processor time.
fn serve(mut master: TTYPort, line: &Mutex<VirtualLine>, unplugged: &AtomicBool) {
    master.set_timeout(Duration::from_millis(2)).unwrap();
    let mut to_host = master.try_clone().unwrap();
    to_host.set_timeout(Duration::from_secs(5)).unwrap();
    let mut bytes = [0; 512];
    while !unplugged.load(Ordering::Relaxed) {
        let len = match master.read(&mut bytes) {
            Ok(len) => len,
            Err(error) if error.kind() == ErrorKind::TimedOut => 0,
            Err(error) => panic!("{error}"),
        };
        let mut line = line.lock().unwrap();
        line.write(&bytes[..len]).unwrap();
        line.step();
        while line.under_way() > 0 {
            line.step();
        }
        let mut out = Vec::new();
        line.read(&mut out, Duration::ZERO).unwrap();
        drop(line);
        match to_host.write_all(&out) {
            Ok(()) => {}
            // What nobody reads is lost, as on a real line.
            Err(error) if error.kind() == ErrorKind::TimedOut => {}
            Err(error) => panic!("{error}"),
        }
    }
}
