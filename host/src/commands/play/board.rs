//! Playing to a board at a serial port.

use std::path::PathBuf;
use std::time::Duration;

use frixel::device::{DEFAULT_BAUD, Device, Event, SerialLink};
use frixel::metrics::MetricsSummary;
use frixel::output::{FeltRow, Report};
use frixel::player::start;
use frixel::scene::{Program, Scene, compile};
use frixel::wanted::Wanted;
use frixel_wire::fault::Flags;
use frixel_wire::message::Telemetry;

use super::super::interrupt::Interrupt;
use super::{Bars, CommandError, PlayArgs, tell_notes, write_felt_csv};

/// Most telemetry that a board sends, in messages a second.
const TELEMETRY_MAX_HZ: u32 = 1000;
/// Time between two looks at Ctrl-C and at the board's state.
const STEP: Duration = Duration::from_millis(50);

pub(super) fn play(args: &PlayArgs) -> Result<(Report, Vec<PathBuf>), CommandError> {
    let port = || args.port.clone();
    if args.stroke.is_some() {
        return Err(CommandError::StrokeOnBoard { port: port() });
    }
    if args.csv_hz > TELEMETRY_MAX_HZ {
        return Err(CommandError::CsvTooFast { port: port(), asked: args.csv_hz, max: TELEMETRY_MAX_HZ });
    }
    let scene = Scene::load(&args.scene)?;
    let interrupt = Interrupt::watch()?;
    let mut device = Device::connect(SerialLink::open(&args.port, DEFAULT_BAUD)?)?;
    let hello = *device.hello();
    if !(args.arm || hello.board.is_simulated()) {
        return Err(CommandError::NotArmed { port: port() });
    }
    let program = compile(&scene, &hello.limits, hello.tick_hz)?;
    tell_notes(&program);
    let mut bars = Bars::default();
    start(&mut device, &program, &mut |progress| bars.upload(progress))?;
    bars.finish();
    device.subscribe(hello.tick_hz.div_ceil(args.csv_hz))?;

    let mut diary = Diary::new(&program, hello.tick_hz);
    let mut passed_s = 0.0;
    while args.seconds.is_none_or(|seconds| passed_s < seconds) && !interrupt.is_asked() {
        device.wait(STEP, &mut |event| diary.take(&event))?;
        diary.stopped(&args.port)?;
        passed_s += STEP.as_secs_f64();
    }
    device.stop()?;
    device.disarm()?;
    let report = Report::new("board", &diary.metrics(), &program.reach, &device.counters(), None);
    Ok((report, vec![write_felt_csv(&args.out, &diary.rows)?]))
}

/// What a board tells while it plays.
struct Diary {
    wanted: Wanted,
    tick_period_s: f64,
    first_tick: Option<u32>,
    last_tick: u32,
    saturated: u64,
    rows: Vec<FeltRow>,
    end: Option<Event>,
}

impl Diary {
    fn new(program: &Program, tick_hz: u32) -> Self {
        Self {
            wanted: Wanted::new(program),
            tick_period_s: 1.0 / f64::from(tick_hz),
            first_tick: None,
            last_tick: 0,
            saturated: 0,
            rows: Vec::new(),
            end: None,
        }
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
        self.saturated += u64::from(telemetry.flags.contains(Flags::SATURATED));
        let (x_m, y_m) = (f64::from(telemetry.finger_x_m), f64::from(telemetry.finger_y_m));
        let finger_down = !telemetry.flags.contains(Flags::NO_FINGER);
        let natural_n = self.wanted.natural_friction_n();
        self.rows.push(FeltRow {
            t_s: f64::from(telemetry.tick.wrapping_sub(first_tick)) * self.tick_period_s,
            x_mm: finger_down.then_some(1e3 * x_m),
            y_mm: finger_down.then_some(1e3 * y_m),
            speed_mm_s: finger_down.then_some(1e3 * f64::from(telemetry.speed_m_per_s)),
            wanted_n: finger_down.then(|| natural_n + self.wanted.electric_friction_n(x_m, y_m)),
            asked_n: finger_down.then_some(natural_n + f64::from(telemetry.asked_electric_friction_n)),
            felt_n: None,
            voltage_v_rms: Some(f64::from(telemetry.voltage_v_rms)),
            dac_code: Some(telemetry.dac_code),
            flags: Some(telemetry.flags),
        });
    }

    /// The ticks that telemetry spans. What is felt, and how far that is off, no board can tell.
    fn metrics(&self) -> MetricsSummary {
        let wanted_n = self.rows.iter().filter_map(|row| row.wanted_n);
        let range_n =
            |range: Option<(f64, f64)>, n: f64| Some(range.map_or((n, n), |(min, max)| (min.min(n), max.max(n))));
        MetricsSummary {
            ticks: self.first_tick.map_or(0, |first| u64::from(self.last_tick.wrapping_sub(first))),
            saturated_ticks: self.saturated,
            wanted_range_n: wanted_n.fold(None, range_n),
            ..MetricsSummary::default()
        }
    }

    /// An error when the board has stopped without being told to.
    fn stopped(&self, port: &str) -> Result<(), CommandError> {
        match self.end {
            Some(Event::StateChanged { fault: Some(fault), .. }) => {
                Err(CommandError::Faulted { port: port.into(), fault })
            }
            Some(Event::StateChanged { flags, .. }) if flags.contains(Flags::HOST_SILENT) => {
                Err(CommandError::HostSilent { port: port.into() })
            }
            _ => Ok(()),
        }
    }
}
