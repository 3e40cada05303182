//! One client after the other on one board, in virtual time: the second does not inherit the first one's play.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::time::Duration;

use frixel::scene_file;
use frixel_driver::{ByteStream, Device, DeviceError, LinkClosed, PollingLink, ignore_progress};
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke};
use frixel_play::RigStream;
use frixel_scene::{Program, compile};
use frixel_testkit::Random;

use crate::processes::bundled;

/// Host timeout of the scene here.
const HOST_TIMEOUT: Duration = Duration::from_millis(100);
/// Time within which a board acts on the host timeout (docs/board/safety.md).
const ACTS_WITHIN: Duration = Duration::from_millis(1);
/// Number of clients that are killed.
const KILLS: usize = 20;
/// Number of these that die during the upload of the picture, before the others.
const UPLOADS_KILLED: usize = 6;

/// The brick with this host timeout.
fn program(config: &RigConfig) -> Program {
    let mut program =
        compile(&scene_file::load(&bundled("brick.toml")).unwrap(), &config.board.limits, config.board.tick_hz)
            .unwrap();
    program.header.host_timeout_s = HOST_TIMEOUT.as_secs_f32();
    program
}

/// The board's serial line, which one client after the other opens.
#[derive(Clone)]
struct Line<'a>(Rc<RefCell<RigStream<'a>>>);

impl Line<'_> {
    /// Lets time pass without a client.
    fn pass(&self, time: Duration) {
        let mut line = self.0.borrow_mut();
        let end = line.now() + time;
        while line.now() < end {
            let left = end.saturating_sub(line.now());
            line.read(&mut Vec::new(), left).unwrap();
        }
    }
}

/// A client's end of the line. The client is killed after it has sent a number of bytes.
struct Mortal<'a> {
    line: Line<'a>,
    bytes_left: usize,
}

impl ByteStream for Mortal<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        let sent = &bytes[..bytes.len().min(self.bytes_left)];
        self.bytes_left -= sent.len();
        self.line.0.borrow_mut().write(sent)?;
        if sent.len() == bytes.len() { Ok(()) } else { Err(self.killed()) }
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        self.line.0.borrow_mut().read(buffer, wait)
    }

    fn now(&self) -> Duration {
        self.line.0.borrow().now()
    }

    fn name(&self) -> &'static str {
        "line"
    }
}

impl Mortal<'_> {
    fn killed(&self) -> LinkClosed {
        LinkClosed { port: self.name().to_owned(), reason: "the client is killed".to_owned() }
    }
}

/// Plays for some time.
fn play(line: &Line<'_>, program: &Program, bytes_max: usize, time: Duration) -> Result<(), DeviceError> {
    let mortal = Mortal { line: line.clone(), bytes_left: bytes_max };
    let mut client = Device::connect(PollingLink::new(mortal))?;
    frixel_play::start(&mut client, program, &mut ignore_progress)?;
    client.wait(time, &mut |_| ())
}

#[test]
fn a_client_killed_at_any_byte_leaves_the_output_at_zero_and_the_next_one_welcome() {
    let config = RigConfig::default();
    let program = program(&config);
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &config, Stroke::sweep(0.12, 0.11, 60.0).unwrap(), 1).unwrap();
    let driven_at_tick = Rc::new(Cell::new(0));
    let seen = Rc::clone(&driven_at_tick);
    let stream = RigStream::new(Box::new(rig)).observed(move |record| {
        if record.drive.amplifier_enable {
            seen.set(record.tick);
        }
    });
    let line = Line(Rc::new(RefCell::new(stream)));
    let driven_at = || Duration::from_secs(driven_at_tick.get()) / config.board.tick_hz;
    let a_while = Duration::from_millis(100);

    let mut random = Random::new(1);
    let mut killed_while_playing = 0;
    for kill in 0..KILLS {
        if kill == UPLOADS_KILLED {
            // Earlier clients do not interfere with an upload.
            play(&line, &program, usize::MAX, a_while).unwrap();
        }
        // Once the board holds the picture, some 300 bytes lead to playing, and pings follow.
        let count = if kill < UPLOADS_KILLED { random.below(66_000) } else { 300 + random.below(300) };
        let ended = play(&line, &program, count as usize, Duration::from_mins(1));
        assert!(matches!(ended, Err(DeviceError::Vanished { .. })), "after {count} bytes: {ended:?}");
        let killed_at = line.0.borrow().now();
        line.pass(2 * HOST_TIMEOUT);
        let late = driven_at().saturating_sub(killed_at);
        assert!(late <= HOST_TIMEOUT + ACTS_WITHIN, "after {count} bytes: driven for {late:?}");
        killed_while_playing += usize::from(!late.is_zero());
    }
    assert!(killed_while_playing >= 3, "only {killed_while_playing} clients died while the output was driven");
    play(&line, &program, usize::MAX, a_while).unwrap();
}
