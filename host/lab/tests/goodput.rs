//! Uploads and streams over a bad line: nothing that arrives damaged is accepted, and a transfer that cannot get
//! through ends with a sentence. The test holds the table of `docs/inside/scenarios.md`, and
//! `FRIXEL_BLESS=1 cargo test -p frixel-lab --test main goodput` writes it.

use std::collections::{BTreeMap, HashSet};
use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;

use frixel_driver::{
    Bitmap, ByteStream, Device, LinkClosed, PollingLink, StreamSettings, StreamStatus, Upload, ignore_progress,
};
use frixel_hil_sim::{BoardMemory, LineNoise, NoiseConfig, Rig, RigConfig, Stroke};
use frixel_scene::{Program, Scene, compile};
use frixel_testkit::golden;
use frixel_wire::frame::Decoder;
use frixel_wire::scene::bitmap_crc32;
use rayon::prelude::*;

const SCENE: &str = "version = 1\n[[layer]]\nkind = \"stream\"\nlow_fraction = 0.0\nhigh_fraction = 0.5\n";
const SAMPLE_HZ: u32 = 8_000;
/// Length of a stream.
const STREAM_S: f64 = 3.0;
const PICTURE: [u16; 2] = [250, 200];
/// Longest time that an upload may take until it has ended, one way or the other.
const UPLOAD_MAX_S: f64 = 30.0;

/// One direction of a line, which compares what is accepted with what was sent.
struct Direction {
    noise: LineNoise,
    sent: Decoder,
    arrived: Decoder,
    payloads: HashSet<Vec<u8>>,
    accepted: u64,
    wrong: u64,
}

impl Direction {
    fn new(bit_error_rate: f64, seed: u64) -> Self {
        let mut noise = LineNoise::new(seed);
        noise.set(NoiseConfig { bit_error_rate, ..NoiseConfig::default() }).unwrap();
        let (sent, arrived) = (Decoder::new(), Decoder::new());
        Self { noise, sent, arrived, payloads: HashSet::new(), accepted: 0, wrong: 0 }
    }

    fn pass(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut input = bytes;
        while let Some(payload) = self.sent.next_frame(&mut input) {
            self.payloads.insert(payload.to_vec());
        }
        let mut arrived = Vec::new();
        self.noise.pass(bytes, &mut arrived);
        let mut input = arrived.as_slice();
        while let Some(payload) = self.arrived.next_frame(&mut input) {
            self.accepted += 1;
            self.wrong += u64::from(!self.payloads.contains(payload));
        }
        arrived
    }
}

struct BadLine<'a> {
    rig: Rig<'a>,
    to_board: Direction,
    to_host: Direction,
}

impl ByteStream for BadLine<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        let arrived = self.to_board.pass(bytes);
        self.rig.send(&arrived);
        Ok(())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.rig.tick() + (wait.as_secs_f64() * f64::from(self.rig.tick_hz())).ceil() as u64;
        while !self.rig.has_received() && self.rig.tick() < end {
            self.rig.step();
        }
        let mut received = Vec::new();
        self.rig.receive(&mut received);
        buffer.extend(self.to_host.pass(&received));
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_secs_f64(self.rig.tick() as f64 / f64::from(self.rig.tick_hz()))
    }

    fn name(&self) -> &'static str {
        "the line"
    }
}

fn program() -> Program {
    let board = RigConfig::default().board;
    let scene = Scene::parse(SCENE, "stream.toml", &BTreeMap::<String, Vec<u8>>::new()).unwrap();
    compile(&scene, &board.limits, board.tick_hz).unwrap()
}

/// What happened at one rate of errors.
struct Row {
    bit_error_rate: f64,
    /// Bytes a second, or why not and after how long.
    upload: Result<f64, (String, f64)>,
    /// Samples sent of those wanted, and interruptions.
    stream: Result<(u64, u32, u32), (String, f64)>,
    accepted: u64,
    wrong: u64,
}

/// Uploads a picture, then streams for [`STREAM_S`] seconds, each on a line of its own that becomes bad once the host has
/// connected.
fn measured(bit_error_rate: f64) -> Row {
    let (mut accepted, mut wrong) = (0, 0);
    let mut on_line = |work: &mut dyn FnMut(&mut Device<PollingLink<BadLine>>) -> Option<String>| {
        let mut memory = BoardMemory::new();
        let stroke = Stroke::sweep(0.12, 0.11, 3.0).unwrap().looped(0.2).unwrap();
        let rig = Rig::new(&mut memory, &RigConfig::default(), stroke, 1).unwrap();
        let line = BadLine { rig, to_board: Direction::new(0.0, 1), to_host: Direction::new(0.0, 2) };
        let mut device = Device::connect(PollingLink::new(line)).unwrap();
        let line = device.link_mut().stream_mut();
        line.to_board = Direction::new(bit_error_rate, 3);
        line.to_host = Direction::new(bit_error_rate, 4);
        let started = device.now();
        let failed = work(&mut device);
        let took_s = (device.now().saturating_sub(started)).as_secs_f64();
        let line = device.link_mut().stream_mut();
        accepted += line.to_board.accepted + line.to_host.accepted;
        wrong += line.to_board.wrong + line.to_host.wrong;
        (failed, took_s)
    };
    let program = program();
    let scene = program.scene_bytes();
    let samples: Vec<u8> = (0..50_000_u32).map(|number| (number.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let [width, height] = PICTURE;
    let picture = Bitmap { crc32: bitmap_crc32(width, height, &samples), width, height, samples: &samples };
    let upload = Upload { scene: &scene, bitmaps: vec![picture] };
    let (failed, took_s) = on_line(&mut |device| {
        let uploaded = device.upload(&upload, &mut ignore_progress).and_then(|()| device.commit(upload.scene_crc32()));
        let failed = uploaded.err().map(|error| error.to_string());
        if failed.is_none() {
            assert_eq!(device.link_mut().stream_mut().rig.scene(), Some(&program.header));
        }
        failed
    });
    let uploaded = failed.map_or(Ok(upload.total_bytes() as f64 / took_s), |sentence| Err((sentence, took_s)));

    let wanted = (STREAM_S * f64::from(SAMPLE_HZ)) as u64;
    let (mut sent, mut status) = (0, StreamStatus::default());
    let alone = Upload { scene: &scene, bitmaps: Vec::new() };
    let (failed, took_s) = on_line(&mut |device| {
        let mut play = || {
            device.upload(&alone, &mut ignore_progress)?;
            device.commit(alone.scene_crc32())?;
            device.arm()?;
            device.play()?;
            device.link_mut().stream_mut().rig.world_mut().start_stroke();
            device.start_stream(StreamSettings::new(SAMPLE_HZ))?;
            while sent < wanted {
                let piece: Vec<u16> = (sent..wanted.min(sent + 400)).map(|n| (n * 97) as u16).collect();
                sent += device.send_samples(&piece)? as u64;
                device.wait(Duration::from_millis(5), &mut |_| {})?;
            }
            Ok::<(), frixel_driver::DeviceError>(())
        };
        let failed = play().err().map(|error| error.to_string());
        status = device.stream_status().unwrap_or_default();
        failed
    });
    let streamed = (sent, status.underruns, status.gaps);
    Row {
        bit_error_rate,
        upload: uploaded,
        stream: failed.map_or(Ok(streamed), |sentence| Err((sentence, took_s))),
        accepted,
        wrong,
    }
}

fn check(rows: &[Row]) {
    for row in rows {
        let rate = row.bit_error_rate;
        assert_eq!(row.wrong, 0, "{rate}: of {} frames", row.accepted);
        assert!(row.accepted > 20, "{rate}: {} frames", row.accepted);
        if let Err((sentence, took_s)) = &row.upload {
            assert!(!sentence.is_empty() && *took_s < UPLOAD_MAX_S, "{rate}: {took_s} s, {sentence}");
        }
        if let Err((sentence, took_s)) = &row.stream {
            assert!(!sentence.is_empty() && *took_s < STREAM_S + UPLOAD_MAX_S, "{rate}: {took_s} s, {sentence}");
        }
        if rate <= 1e-4 {
            assert!(row.upload.is_ok() && row.stream.is_ok(), "{rate}: {:?}, {:?}", row.upload, row.stream);
        }
    }
}

fn table(rows: &[Row]) -> String {
    let mut table = format!(
        "| bit errors | upload of 50 kB | {STREAM_S} s of 8,000 samples a second | frames accepted | of them wrong |\n\
         |---|---|---|---|---|\n"
    );
    for row in rows {
        let upload = match &row.upload {
            Ok(bytes_per_s) => format!("{:.1} kB/s", bytes_per_s / 1e3),
            Err((sentence, took_s)) => format!("ends after {took_s:.1} s: {sentence}"),
        };
        let stream = match &row.stream {
            Ok((sent, underruns, gaps)) => format!("{sent} samples, {underruns} underruns, {gaps} gaps"),
            Err((sentence, took_s)) => format!("ends after {took_s:.1} s: {sentence}"),
        };
        let Row { bit_error_rate, accepted, wrong, .. } = row;
        writeln!(table, "| {bit_error_rate} | {upload} | {stream} | {accepted} | {wrong} |").unwrap();
    }
    table
}

#[test]
fn nothing_damaged_is_accepted_and_what_does_not_get_through_ends_with_a_sentence() {
    let rows: Vec<Row> = [0.0, 1e-6, 1e-5, 1e-4, 3e-4, 1e-3].into_par_iter().map(measured).collect();
    check(&rows);
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/inside/scenarios.md");
    golden::hold_part(&file, "<!-- goodput", &table(&rows));
}
