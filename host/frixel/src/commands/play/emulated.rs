//! Playing to the firmware on an emulated board, under a simulated finger.

use std::collections::VecDeque;
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

use frixel::output::{FeltRow, Report, Trace};
use frixel::player::start;
use frixel::rigs::{EmulatedLink, EmulatedRecorder};
use frixel::scene_file;
use frixel_driver::{Device, Event};
use frixel_hil_sim::emulated::{BOARD, Image, LinkBoard, LinkRecord};
use frixel_hil_sim::{Stroke, World, WorldConfig, contact_of};
use frixel_scene::{Program, compile};

use super::super::interrupt::Interrupt;
use super::board::check_end;
use super::simulator::{Rows, draw, scene_stroke};
use super::{Bars, CommandError, PlayArgs, Played, create_felt_csv, refuse_watch, tell_notes, ticks_per_row};

/// Most telemetry that the emulated serial port has room for, in messages a second.
const TELEMETRY_HZ: u32 = 100;
/// Time on the board's clock between two looks at Ctrl-C and at the board's state.
const STEP: Duration = Duration::from_millis(50);
/// Ticks that wait for the telemetry that belongs to them.
const HELD_TICKS: usize = 8_000;

pub(super) fn play(args: &PlayArgs) -> Result<Played, CommandError> {
    refuse_watch(args)?;
    if args.stream.is_some() {
        return Err(CommandError::StreamOnEmulated);
    }
    let ticks_per_row = ticks_per_row(args.csv_hz, BOARD.tick_hz)?;
    let program = compile(&scene_file::load(&args.scene)?, &BOARD.limits, BOARD.tick_hz)?;
    tell_notes(&program);
    let (stroke, seconds) = scene_stroke(args, &program, BOARD.tick_hz)?;
    let world = world(&program, stroke, args.seed)?;
    let image = Image::build()?;
    let interrupt = Interrupt::watch()?;
    let (sender, records) = mpsc::channel();
    let mut board = LinkBoard::start(&image, world, move |record| {
        // Nobody listens any more when the play has ended.
        let _ = sender.send(*record);
    })?;
    let mut device = Device::connect(EmulatedLink::open(&board)?)?;
    let (csv, csv_path) = create_felt_csv(&args.out)?;
    let mut bars = Bars::default();
    start(&mut device, &program, &mut |progress| bars.upload(progress))?;

    board.start_stroke();
    let ticks = (seconds * f64::from(BOARD.tick_hz)).round() as u64;
    let recorder = EmulatedRecorder::new(&program, BOARD.tick_hz, board.tick()?, ticks, ticks_per_row);
    let rows = Rows { csv, trace: Trace::new() };
    let mut diary = Diary { records, held: VecDeque::new(), recorder, rows, end: None };
    let begin = Instant::now();
    let ended = listen(&mut device, &mut diary, &interrupt, &mut |part| bars.play(part));
    let wall_s = begin.elapsed().as_secs_f64();
    bars.finish();
    let counters = device.counters();
    // The board's output goes to zero before anything else is done.
    drop(device);
    let mut failure = ended.and(board.check().map_err(CommandError::from)).err();

    let Diary { recorder, rows, .. } = diary;
    rows.csv.finish()?;
    let played_s = f64::from(recorder.ticks()) / f64::from(BOARD.tick_hz);
    if interrupt.is_asked() || (failure.is_some() && interrupt.was_asked()) {
        // Ctrl-C in a terminal ends the emulator, too.
        failure = None;
        eprintln!("interrupted: what follows is of the first {played_s:.3} s of {seconds:.3} s");
    }
    let report = Report::new("qemu", &recorder.metrics(), &program.reach, &counters, Some(played_s / wall_s));
    let mut files = vec![csv_path];
    files.extend(draw(args, &program, &rows.trace)?);
    Ok(Played { report, files, failure })
}

/// The world around the board, with the finger that the scene is meant for.
fn world(program: &Program, stroke: Stroke, seed: u64) -> Result<World, CommandError> {
    let config = WorldConfig {
        tick_hz: BOARD.tick_hz,
        full_scale_v_peak: f64::from(BOARD.limits.full_scale_v_peak),
        ..WorldConfig::default()
    };
    let mut world = World::new(config, stroke, seed)?;
    world.set_finger(contact_of(&program.header).map_err(CommandError::Finger)?);
    Ok(world)
}

/// Writes down what the finger feels for as long as the board plays.
fn listen(
    device: &mut Device<EmulatedLink>,
    diary: &mut Diary,
    interrupt: &Interrupt,
    on_part: &mut dyn FnMut(f64),
) -> Result<(), CommandError> {
    device.subscribe(BOARD.tick_hz / TELEMETRY_HZ)?;
    while !diary.recorder.is_done() && !interrupt.is_asked() {
        let waited = device.wait(STEP, &mut |event| diary.hear(event));
        let over = waited.is_err() || interrupt.is_asked();
        diary.take_records(if over { 0 } else { HELD_TICKS })?;
        check_end(diary.end.as_ref(), "qemu")?;
        waited?;
        on_part(diary.recorder.part());
    }
    device.stop()?;
    Ok(device.disarm()?)
}

/// What comes of a play.
struct Diary {
    records: Receiver<LinkRecord>,
    /// Records that wait for the telemetry of their ticks.
    held: VecDeque<LinkRecord>,
    recorder: EmulatedRecorder,
    rows: Rows,
    end: Option<Event>,
}

impl Diary {
    fn hear(&mut self, event: Event) {
        match event {
            Event::Telemetry(telemetry) => self.recorder.tell(&telemetry),
            Event::StateChanged { .. } => self.end = Some(event),
        }
    }

    /// Takes the records so far but for the last `held` of them.
    fn take_records(&mut self, held: usize) -> Result<(), CommandError> {
        self.held.extend(self.records.try_iter());
        let count = self.held.len().saturating_sub(held);
        let rows: Vec<FeltRow> = self.held.drain(..count).filter_map(|record| self.recorder.take(&record)).collect();
        Ok(self.rows.take(&rows)?)
    }
}
