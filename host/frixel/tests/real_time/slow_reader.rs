//! A virtual board on a pseudo-terminal, and a client that does not read.

use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, sleep};
use std::time::Duration;

use frixel::rigs::Server;
use frixel_files::Inputs;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke};
use frixel_wire::frame::{Decoder, FRAME_MAX_LEN};
use frixel_wire::message::{Answer, Command, FromBoard, Request};
use frixel_wire::payload::{self, Payload};

/// A client that writes without asking for its credit, and reads when it wants to.
struct Client {
    line: File,
    decoder: Decoder,
    sequence: u16,
}

impl Client {
    fn open(path: &Path) -> Self {
        let line = OpenOptions::new().read(true).write(true).open(path).unwrap();
        let mut client = Self { line, decoder: Decoder::new(), sequence: 0 };
        let mut frame = [0; FRAME_MAX_LEN];
        client.line.write_all(payload::hello_request_frame(&mut frame).unwrap()).unwrap();
        while !client.read().iter().any(|payload| matches!(payload, Message::Hello)) {}
        client
    }

    /// Waits for bytes, and returns the messages that end in them.
    fn read(&mut self) -> Vec<Message> {
        let mut bytes = [0; 4096];
        let count = self.line.read(&mut bytes).unwrap();
        let mut messages = Vec::new();
        for byte in &bytes[..count] {
            match self.decoder.push(*byte).map(|frame| Payload::parse_from_board(frame).unwrap()) {
                Some(Payload::Hello(_)) => messages.push(Message::Hello),
                Some(Payload::FromBoard(FromBoard::Answer(answer))) => messages.push(Message::Answer(answer)),
                _ => {}
            }
        }
        messages
    }

    fn send(&mut self, command: Command) -> u16 {
        self.sequence += 1;
        let mut frame = [0; FRAME_MAX_LEN];
        let request = Request { sequence: self.sequence, command };
        self.line.write_all(payload::request_frame(&request, &mut frame).unwrap()).unwrap();
        self.sequence
    }

    fn command(&mut self, command: Command) {
        let sequence = self.send(command);
        loop {
            for message in self.read() {
                let Message::Answer(answer) = message else { continue };
                if answer.sequence == sequence {
                    answer.outcome.unwrap();
                    return;
                }
            }
        }
    }
}

enum Message {
    Hello,
    Answer(Answer),
}

/// Runs a virtual board while `talk` does, to which its port is given.
fn with_board(talk: impl FnOnce(&Path) + Send) {
    let folder = tempfile::tempdir().unwrap();
    let config = RigConfig::default();
    let mut memory = BoardMemory::new();
    let stroke = Stroke::sweep(0.12, 0.11, 60.0).unwrap();
    let mut rig = Rig::new(&mut memory, &config, stroke, 1).unwrap();
    let server = Server::open(folder.path(), &Inputs::default(), config.board.tick_hz, 40).unwrap();
    let port = server.path().to_owned();
    let ended = AtomicBool::new(false);
    thread::scope(|scope| {
        let client = scope.spawn(|| {
            talk(Path::new(&port));
            ended.store(true, Ordering::Release);
        });
        server
            .run(&mut rig, &|| {
                if ended.load(Ordering::Acquire) || client.is_finished() {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            })
            .unwrap();
    });
}

/// A client may be busy for longer than its terminal takes telemetry for.
#[test]
fn a_client_that_does_not_read_for_a_while_finds_every_answer() {
    with_board(|port| {
        let mut client = Client::open(port);
        client.command(Command::Subscribe { period_ticks: 40 });
        let first = client.sequence + 1;
        for _ in 0..60 {
            client.send(Command::Ping);
            sleep(Duration::from_millis(25));
        }
        // Whatever was lost before, this one is answered.
        let last = client.send(Command::Ping);
        let mut answered = Vec::new();
        while answered.last() != Some(&last) {
            let answers = client.read().into_iter().filter_map(|message| match message {
                Message::Answer(answer) => Some(answer.sequence),
                Message::Hello => None,
            });
            answered.extend(answers);
        }
        assert_eq!(answered, (first..=last).collect::<Vec<u16>>());
        assert_eq!(client.decoder.rejected(), 0, "no frame was cut in two");
    });
}
