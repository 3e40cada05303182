//! Playing to a board at a serial port.

use std::time::Duration;

use frixel::output::{FeltCsv, FeltRow, OutputError, Report};
use frixel::player::start;
use frixel::scene_file;
use frixel_driver::{DEFAULT_BAUD, Device, Event, SerialLink};
use frixel_scene::metrics::MetricsSummary;
use frixel_scene::wanted::Wanted;
use frixel_scene::{Program, Reach, compile};
use frixel_wire::fault::Flags;
use frixel_wire::hello::Hello;
use frixel_wire::message::Telemetry;

use super::super::interrupt::Interrupt;
use super::live::{Live, open_feed};
use super::{Bars, CommandError, PlayArgs, Played, check_seconds, create_felt_csv, tell_notes, ticks_per_row};

/// Most telemetry that a board sends, in messages a second.
const TELEMETRY_MAX_HZ: u32 = 1000;

pub(super) fn play(args: &PlayArgs) -> Result<Played, CommandError> {
    let port = || args.port.clone();
    if args.stroke.is_some() {
        return Err(CommandError::StrokeOnBoard { port: port() });
    }
    if args.csv_hz > TELEMETRY_MAX_HZ {
        return Err(CommandError::CsvTooFast { port: port(), asked: args.csv_hz, max: TELEMETRY_MAX_HZ });
    }
    if args.watch && args.stream.is_some() {
        return Err(CommandError::WatchWithStream);
    }
    let mut live = Live::new(args);
    let scene = scene_file::load(&args.scene)?;
    let interrupt = Interrupt::watch()?;
    let mut device = Device::connect(SerialLink::open(&args.port, DEFAULT_BAUD)?)?;
    let hello = *device.hello();
    if !(args.arm || hello.board.is_simulated()) {
        return Err(CommandError::NotArmed { port: port() });
    }
    args.seconds.map_or(Ok(()), |seconds| check_seconds(seconds, hello.tick_hz))?;
    ticks_per_row(args.csv_hz, hello.tick_hz)?;
    let program = compile(&scene, &hello.limits, hello.tick_hz)?;
    let feed = open_feed(args, hello.tick_hz, false)?;
    tell_notes(&program);
    let (csv, path) = create_felt_csv(&args.out)?;
    let mut bars = Bars::default();
    start(&mut device, &program, &mut |progress| bars.upload(progress))?;
    bars.finish();

    let mut diary = Diary::new(&program, &hello, csv);
    let ended =
        live.stream(feed, &mut device).and_then(|()| listen(&mut device, &mut diary, &mut live, args, &interrupt));
    let report = Report::new("board", &diary.metrics(), &diary.reach, &device.counters(), None)
        .with_stream(device.stream_status());
    // The board's output goes to zero before anything else is done.
    drop(device);
    let written = diary.csv.finish().map_err(CommandError::from);
    Ok(Played { report, files: vec![path], failure: ended.and(written).err() })
}

/// Writes down what the board tells for as long as it plays.
fn listen(
    device: &mut Device<SerialLink>,
    diary: &mut Diary,
    live: &mut Live,
    args: &PlayArgs,
    interrupt: &Interrupt,
) -> Result<(), CommandError> {
    device.subscribe(ticks_per_row(args.csv_hz, device.hello().tick_hz)?)?;
    let mut left = args.seconds.map_or(Duration::MAX, Duration::from_secs_f64);
    while !left.is_zero() && !interrupt.is_asked() {
        let step = live.step().min(left);
        let waited = device.wait(step, &mut |event| diary.take(&event));
        diary.check(&args.port)?;
        waited?;
        if let Some(program) = live.go_on(device)? {
            diary.replace(&program);
        }
        left = left.saturating_sub(step);
    }
    device.stop()?;
    Ok(device.disarm()?)
}

/// What a board tells while it plays.
struct Diary {
    wanted: Wanted,
    reach: Reach,
    tick_period_s: f64,
    first_tick: Option<u32>,
    last_tick: u32,
    wanted_range_n: Option<(f64, f64)>,
    csv: FeltCsv,
    /// Why no more rows are written.
    write_error: Option<OutputError>,
    end: Option<Event>,
}

impl Diary {
    fn new(program: &Program, hello: &Hello, csv: FeltCsv) -> Self {
        Self {
            wanted: Wanted::new(program),
            reach: program.reach,
            tick_period_s: 1.0 / f64::from(hello.tick_hz),
            first_tick: None,
            last_tick: 0,
            wanted_range_n: None,
            csv,
            write_error: None,
            end: None,
        }
    }

    /// Another program plays from now on.
    fn replace(&mut self, program: &Program) {
        self.wanted = Wanted::new(program);
        self.reach = program.reach;
    }

    fn take(&mut self, event: &Event) {
        match event {
            Event::Telemetry(telemetry) => self.take_telemetry(telemetry),
            Event::StateChanged { .. } => self.end = Some(*event),
        }
    }

    /// A row of what telemetry tells. Place and friction wanted there are as the board sees them; what is felt only a
    /// finger knows.
    fn take_telemetry(&mut self, telemetry: &Telemetry) {
        let first_tick = *self.first_tick.get_or_insert(telemetry.tick);
        self.last_tick = telemetry.tick;
        let (x_m, y_m) = (f64::from(telemetry.finger_x_m), f64::from(telemetry.finger_y_m));
        let finger_down = !telemetry.flags.contains(Flags::NO_FINGER);
        let natural_n = self.wanted.natural_friction_n();
        let wanted_n = finger_down.then(|| natural_n + self.wanted.electric_friction_n(x_m, y_m));
        if let Some(wanted_n) = wanted_n {
            let (least_n, largest_n) = self.wanted_range_n.unwrap_or((wanted_n, wanted_n));
            self.wanted_range_n = Some((least_n.min(wanted_n), largest_n.max(wanted_n)));
        }
        self.write(&FeltRow {
            t_s: f64::from(telemetry.tick.wrapping_sub(first_tick)) * self.tick_period_s,
            x_mm: finger_down.then_some(1e3 * x_m),
            y_mm: finger_down.then_some(1e3 * y_m),
            speed_mm_s: finger_down.then_some(1e3 * f64::from(telemetry.speed_m_per_s)),
            wanted_n,
            asked_n: finger_down.then_some(natural_n + f64::from(telemetry.asked_electric_friction_n)),
            felt_n: None,
            voltage_v_rms: Some(f64::from(telemetry.voltage_v_rms)),
            dac_code: Some(telemetry.dac_code),
            flags: Some(telemetry.flags),
        });
    }

    fn write(&mut self, row: &FeltRow) {
        if self.write_error.is_none() {
            self.write_error = self.csv.write(row).err();
        }
    }

    /// The ticks that telemetry spans. What is felt, how far that is off, and how many ticks were saturated, no board tells.
    fn metrics(&self) -> MetricsSummary {
        MetricsSummary {
            ticks: self.first_tick.map_or(0, |first| u64::from(self.last_tick.wrapping_sub(first))),
            wanted_range_n: self.wanted_range_n,
            ..MetricsSummary::default()
        }
    }

    /// Puts what was written so far into the file. An error when that does not go, or when the board has stopped without
    /// being told to.
    fn check(&mut self, port: &str) -> Result<(), CommandError> {
        self.write_error.take().map_or(Ok(()), Err)?;
        self.csv.flush()?;
        check_end(self.end.as_ref(), port)
    }
}

/// An error when a board has stopped without being told to.
pub(super) fn check_end(end: Option<&Event>, port: &str) -> Result<(), CommandError> {
    match end {
        Some(Event::StateChanged { fault: Some(fault), .. }) => {
            Err(CommandError::Faulted { port: port.into(), fault: *fault })
        }
        Some(Event::StateChanged { flags, .. }) if flags.contains(Flags::HOST_SILENT) => {
            Err(CommandError::HostSilent { port: port.into() })
        }
        _ => Ok(()),
    }
}
