//! A virtual board on a pseudo-terminal, and clients that send more than their credit or do not read.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs::{self, File, OpenOptions};
use std::io::{Read, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, sleep};
use std::time::Duration;

use frixel::output_file::Inputs;
use frixel::rigs::Server;
use frixel::scene_file;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke};
use frixel_scene::compile;
use frixel_wire::frame::{Decoder, FRAME_MAX_LEN, crc32};
use frixel_wire::message::{Answer, Command, FromBoard, Request};
use frixel_wire::payload::{self, CHUNK_LEN, Payload};

/// A client that knows no credit: it writes, and reads when it wants to.
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

    fn play(&mut self, scene: &[u8]) {
        self.command(Command::UploadScene { len: scene.len() as u32, crc32: crc32(scene) });
        for (number, chunk) in scene.chunks(CHUNK_LEN).enumerate() {
            let mut frame = [0; FRAME_MAX_LEN];
            self.line.write_all(payload::chunk_frame(number as u16, chunk, &mut frame).unwrap()).unwrap();
        }
        self.command(Command::UploadEnd);
        self.command(Command::Commit { crc32: crc32(scene) });
        self.command(Command::Arm);
        self.command(Command::Play);
    }
}

enum Message {
    Hello,
    Answer(Answer),
}

/// The bundled constant scene as a board takes it.
fn scene() -> Vec<u8> {
    let config = RigConfig::default();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/constant.toml");
    compile(&scene_file::load(&path).unwrap(), &config.board.limits, config.board.tick_hz).unwrap().scene_bytes()
}

/// Runs a virtual board while `talk` does, to which its port and its folder are given.
fn with_board(talk: impl FnOnce(&Path, &Path) + Send) {
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
            talk(Path::new(&port), folder.path());
            ended.store(true, Ordering::Release);
        });
        server.run(&mut rig, &|| ended.load(Ordering::Acquire) || client.is_finished()).unwrap();
    });
}

/// Virtual times of the events of this name.
fn times_of(name: &str, folder: &Path) -> Vec<f64> {
    let text = fs::read_to_string(folder.join("events.csv")).unwrap();
    let rows = text.lines().skip(1).filter(|row| row.split(',').nth(1) == Some(name));
    rows.map(|row| row.split(',').next().unwrap().parse().unwrap()).collect()
}

/// Four megabytes of pings, most of which were sent without credit, take twenty seconds on the line.
#[test]
fn a_client_that_ignores_credit_and_is_killed_keeps_nothing_playing() {
    with_board(|port, folder| {
        let mut client = Client::open(port);
        client.play(&scene());
        let mut frame = [0; FRAME_MAX_LEN];
        let ping = payload::request_frame(&Request { sequence: 0, command: Command::Ping }, &mut frame).unwrap();
        client.line.write_all(&ping.repeat((4 << 20) / ping.len())).unwrap();
        drop(client);
        while times_of("host-silent", folder).is_empty() {
            sleep(Duration::from_millis(20));
        }
        let (active_s, silent_s) = (times_of("active", folder)[0], times_of("host-silent", folder)[0]);
        // Writing them takes a second or two where a test has a processor for itself half of the time.
        assert!(silent_s - active_s < 6.0, "played for {} s", silent_s - active_s);
    });
}

/// A client may be busy for longer than its terminal takes telemetry for.
#[test]
fn a_client_that_does_not_read_for_a_while_finds_every_answer() {
    with_board(|port, _| {
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
