//! A board of session and ticker, to which tests send frames.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::large_stack_arrays,
    dead_code,
    unused_imports,
    unreachable_pub,
    reason = "a test uses its part, and may fail"
)]

pub mod flash;

#[cfg(feature = "stream")]
use frixel_control::StreamBuffer;
use frixel_control::{Active, Board, Drive, Sense, Status, Ticker};
use frixel_layers::{Bitmap, BitmapPool, Layer};
use frixel_session::{NextScene, Session, Touch};
use frixel_testkit::IdealMonitor;
pub use frixel_testkit::{HEADER, constant, record, scene, scene_with_points};
use frixel_wire::frame::{Decoder, FRAME_MAX_LEN, crc32};
use frixel_wire::hello::Hello;
use frixel_wire::message::{Accepted, Answer, Command, FromBoard, Refusal, Request};
use frixel_wire::payload::{self, CHUNK_LEN, Payload};
use frixel_wire::scene::bitmap_crc32;

/// Most polls that a commit takes.
pub const COMMIT_POLLS_MAX: u32 = 200;

pub struct TestBoard {
    pub session: Session<'static>,
    pub ticker: Ticker<'static>,
    /// The board's default inputs: a held switch, and a correct monitor.
    pub sense: Sense,
    /// A report of the board's touch source, which the next tick consumes.
    pub touch: Option<Touch>,
    pub messages: Vec<FromBoard>,
    pub hello: Option<Hello>,
    /// The monitor reads zero, whatever is driven.
    pub amplifier_dead: bool,
    /// The host reads what the board sends.
    pub reads: bool,
    monitor: IdealMonitor,
    decoder: Decoder,
    sequence: u16,
}

impl TestBoard {
    pub fn new() -> Self {
        Self::of(Board::SIMULATOR)
    }

    /// A board whose host has said hello.
    pub fn connected() -> Self {
        let mut board = Self::new();
        board.hello();
        board
    }

    pub fn of(board: Board) -> Self {
        #[cfg_attr(not(feature = "stream"), allow(unused_mut, reason = "there is nothing to attach"))]
        let mut test_board = Self::without_stream(board);
        #[cfg(feature = "stream")]
        {
            let stream: &StreamBuffer = leaked(StreamBuffer::new());
            test_board.ticker.attach_stream(stream);
            test_board.session.attach_stream(stream);
        }
        test_board
    }

    /// A board that has no buffer for a stream.
    pub fn without_stream(board: Board) -> Self {
        let pool: &BitmapPool = leaked(BitmapPool::new());
        let mut test_board = Self {
            ticker: Ticker::new(&board, pool, leaked(Active::new())),
            session: Session::new(board, pool, leaked(NextScene::new())),
            sense: Sense { arm_switch: true, ..Sense::default() },
            touch: None,
            messages: Vec::new(),
            hello: None,
            amplifier_dead: false,
            reads: true,
            monitor: IdealMonitor::new(
                board.limits.full_scale_v_peak,
                board.amplifier.time_constant_s / board.tick_period_s(),
            ),
            decoder: Decoder::new(),
            sequence: 0,
        };
        // The arm switch is released at the first tick and held from the second on.
        test_board.ticks(2);
        test_board
    }

    pub fn status(&self) -> Status {
        self.ticker.status()
    }

    /// One tick with [`TestBoard::touch`] and [`TestBoard::sense`], in the order of the rigs: touch, one order, tick,
    /// answers.
    pub fn tick(&mut self) -> Drive {
        if let Some(touch) = self.touch.take() {
            self.session.touch(touch, self.status().telemetry.tick.wrapping_add(1));
        }
        self.session.hand_order_to(&mut self.ticker);
        let monitor_v = if self.amplifier_dead { 0.0 } else { self.monitor.voltage_v() };
        let arm_switch = self.sense.arm_switch && !self.ticker.waits_for_release();
        let sense = Sense { monitor_v: self.sense.monitor_v + monitor_v, arm_switch, ..self.sense };
        let drive = self.ticker.tick(&sense);
        self.monitor.follow(drive.dac_code);
        self.session.poll(&self.ticker.status());
        self.collect();
        drive
    }

    pub fn ticks(&mut self, count: u32) -> Drive {
        (0..count).map(|_| self.tick()).last().unwrap()
    }

    /// Ticks with a finger that slides at 100 mm/s along x and is reported every 10 ms, and a host that pings.
    pub fn slide(&mut self, ticks: u32) -> Vec<Drive> {
        let start = self.status().telemetry.tick;
        (0..ticks)
            .map(|i| {
                if i % 400 == 0 {
                    let x_m = 0.01 + 0.1 * 25e-6 * (start + i) as f32;
                    self.touch = Some(Touch::Down { x_m, y_m: 0.03, age_ticks: 0 });
                }
                if i % 2000 == 0 {
                    self.command(Command::Ping).unwrap();
                }
                self.tick()
            })
            .collect()
    }

    /// Bytes in, and a round of the main loop.
    pub fn send(&mut self, bytes: &[u8]) {
        self.session.receive(bytes, &self.ticker.status());
        self.deliver_orders();
        self.poll();
    }

    fn poll(&mut self) {
        self.session.poll(&self.ticker.status());
        self.deliver_orders();
        self.collect();
    }

    /// Hands all of the session's orders to the ticker, as if there had been as many ticks.
    pub fn deliver_orders(&mut self) {
        while self.session.hand_order_to(&mut self.ticker) {}
    }

    pub fn hello(&mut self) -> Hello {
        let mut frame = [0; FRAME_MAX_LEN];
        let frame = payload::hello_request_frame(&mut frame).unwrap().to_vec();
        self.send(&frame);
        self.hello.take().expect("a hello")
    }

    pub fn answer(&mut self, command: Command) -> Answer {
        self.sequence += 1;
        self.send(&request(self.sequence, command));
        // A commit is answered after some rounds of the main loop.
        for _ in 0..COMMIT_POLLS_MAX {
            if let Some(answer) = self.take_answer(self.sequence) {
                return answer;
            }
            self.poll();
        }
        panic!("no answer to {command:?}");
    }

    /// The answer to a request, if it has come.
    pub fn take_answer(&mut self, sequence: u16) -> Option<Answer> {
        let is_it = |message: &FromBoard| matches!(message, FromBoard::Answer(answer) if answer.sequence == sequence);
        let place = self.messages.iter().position(is_it)?;
        let FromBoard::Answer(answer) = self.messages.remove(place) else { unreachable!() };
        Some(answer)
    }

    /// Takes all answers that have come, with their sequence numbers.
    pub fn answers(&mut self) -> Vec<(u16, Result<Accepted, Refusal>)> {
        self.collect();
        let answer = |message| match message {
            FromBoard::Answer(Answer { sequence, outcome, .. }) => Some((sequence, outcome)),
            _ => None,
        };
        self.messages.drain(..).filter_map(answer).collect()
    }

    pub fn command(&mut self, command: Command) -> Result<Accepted, Refusal> {
        self.answer(command).outcome
    }

    pub fn chunk(&mut self, number: u16, bytes: &[u8]) {
        let mut frame = [0; FRAME_MAX_LEN];
        let frame = payload::chunk_frame(number, bytes, &mut frame).unwrap().to_vec();
        self.send(&frame);
    }

    pub fn chunks(&mut self, bytes: &[u8]) {
        for (number, chunk) in bytes.chunks(CHUNK_LEN).enumerate() {
            self.chunk(number as u16, chunk);
        }
    }

    pub fn upload_bitmap(&mut self, width: u16, height: u16, samples: &[u8]) -> Result<Accepted, Refusal> {
        let accepted =
            self.command(Command::UploadBitmap { width, height, crc32: bitmap_crc32(width, height, samples) })?;
        if accepted == Accepted::Done {
            self.chunks(samples);
            self.command(Command::UploadEnd)?;
        }
        Ok(accepted)
    }

    pub fn upload_scene(&mut self, scene: &[u8]) -> Result<Accepted, Refusal> {
        self.command(Command::UploadScene { len: scene.len() as u32, crc32: crc32(scene) })?;
        self.chunks(scene);
        self.command(Command::UploadEnd)
    }

    pub fn load(&mut self, scene: &[u8]) -> Result<Accepted, Refusal> {
        self.upload_scene(scene)?;
        self.command(Command::Commit { crc32: crc32(scene) })
    }

    /// Releases the arm switch and presses it again, as required after a disarming.
    pub fn press_switch(&mut self) {
        self.ticks(2);
    }

    /// From power-on to a playing scene.
    pub fn play(&mut self, scene: &[u8]) {
        self.hello();
        self.load(scene).unwrap();
        self.command(Command::Arm).unwrap();
        self.command(Command::Play).unwrap();
    }

    /// Takes the bytes that the board sends, while the host [reads](Self::reads).
    pub fn collect(&mut self) {
        if !self.reads {
            return;
        }
        let mut bytes = [0; 4096];
        let count = self.session.transmit(&mut bytes);
        for byte in &bytes[..count] {
            if let Some(frame) = self.decoder.push(*byte) {
                match Payload::parse_from_board(frame).unwrap() {
                    Payload::Hello(hello) => self.hello = Some(hello),
                    Payload::FromBoard(message) => self.messages.push(message),
                    other => panic!("not from a board: {other:?}"),
                }
            }
        }
    }
}

/// Memory that session and tick share for as long as the program runs, as on a board.
pub fn leaked<T>(value: T) -> &'static mut T {
    Box::leak(Box::new(value))
}

pub fn request(sequence: u16, command: Command) -> Vec<u8> {
    let mut frame = [0; FRAME_MAX_LEN];
    payload::request_frame(&Request { sequence, command }, &mut frame).unwrap().to_vec()
}

/// A picture with a pitch of 1 mm.
pub fn bitmap(crc32: u32) -> Layer {
    Layer::Bitmap(Bitmap {
        crc32,
        x_m: 0.0,
        y_m: 0.0,
        pitch_m: 1e-3,
        black_n: 0.0,
        white_n: 0.02,
        pitch_y_m: 1e-3,
        angle_turns: 0.0,
        tiled: false,
    })
}

/// A scene of a friction that is the same everywhere.
pub fn constant_scene(electric_friction_n: f32) -> Vec<u8> {
    scene(&HEADER, &[constant(electric_friction_n)])
}
