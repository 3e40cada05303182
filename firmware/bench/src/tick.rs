//! Whole ticks, by scene.

use cortex_m::singleton;
use frixel_layers::BitmapPool;
use frixel_layers::{Carrier, HEADER_LEN, Header, Leader, POINT_LEN, Point, RECORD_LEN, Record, SCENE_MAX_LEN};
use frixel_render::{Active, Board, Drive, Sense, Session, StreamBuffer, Ticker, Touch};
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::State;
use frixel_wire::message::Command;

use crate::count::{Case, Counter};
use crate::host::{Host, STREAM_FRAME, STREAM_TICKS_PER_SAMPLE};
use crate::layers::{GRATING, bitmap, record};

/// Ticks counted of each scene: a stroke across the screen.
const TICKS: u32 = 8_000;
/// Ticks between two reports of the touch source.
const REPORT_TICKS: u32 = 400;
/// Ticks between two pings.
pub(crate) const PING_TICKS: u32 = 2_000;
/// Ticks between two frames of the stream.
pub(crate) const STREAM_TICKS: u32 = STREAM_FRAME as u32 * STREAM_TICKS_PER_SAMPLE;
/// Side of the square picture, in samples.
const PICTURE: u16 = 100;

pub(crate) const HEADER: Header = Header {
    screen_width_m: 0.12,
    screen_height_m: 0.11,
    finger_radius_m: 8e-3,
    stiffness_pa_per_m: 1.8e7,
    friction_coefficient: 0.5,
    normal_load_n: 0.5,
    effective_gap_m: 1e-5,
    voltage_max_v_rms: 150.0,
    voltage_max_v_peak: 200.0,
    slew_v_per_s: 5e6,
    carrier_hz: 1000.0,
    host_timeout_s: 0.25,
    carrier: Carrier::Square,
    autonomous: false,
    prediction: true,
    leader: Leader::First,
    layers_fixed: false,
    electric_friction_max_n: None,
};

/// Counts the ticks of every scene.
pub fn run(counter: &mut Counter) {
    let mut bench = Bench::new();
    bench.idle(counter.case("tick_disarmed"), None);
    bench.play(&HEADER, &[record(GRATING)]);
    bench.idle(counter.case("tick_idle"), Some(Touch::Up));
    bench.slide(counter.case("tick_grating"));
    let crc32 = bench.picture();
    bench.play(&HEADER, &[record(bitmap(crc32))]);
    bench.slide(counter.case("tick_bitmap"));
    bench.costs(counter, crc32);
    bench.numbers_of_layers(counter);
    bench.worst_scene(counter, crc32);
}

/// A playing board.
pub(crate) struct Bench {
    pub(crate) host: Host<'static>,
    monitor: Monitor,
}

/// An ideal amplifier with the board's edges.
struct Monitor {
    voltage_v: f32,
    volts_per_code: f32,
    step: f32,
}

impl Monitor {
    fn new(board: &Board) -> Self {
        let tick_period_s = 1.0 / board.tick_hz as f32;
        Self {
            voltage_v: 0.0,
            volts_per_code: board.limits.full_scale_v_peak / f32::from(i16::MAX),
            step: 1.0 - libm::expf(-tick_period_s / board.limits.edge_time_constant_s),
        }
    }

    fn follow(&mut self, drive: Drive) {
        self.voltage_v += self.step * (f32::from(drive.dac_code.bits()) * self.volts_per_code - self.voltage_v);
    }
}

impl Bench {
    /// A board that has just started. There is one.
    pub(crate) fn new() -> Self {
        static POOL: BitmapPool = BitmapPool::new();
        static STREAM: StreamBuffer = StreamBuffer::new();
        let board = Board::SIMULATOR;
        let (Some(first), Some(second)) = (singleton!(: Active = Active::new()), singleton!(: Active = Active::new()))
        else {
            panic!("this runs once");
        };
        let mut ticker = Ticker::new(&board, &POOL, first);
        let mut session = Session::new(board, &POOL, second);
        ticker.attach_stream(&STREAM);
        session.attach_stream(&STREAM);
        Self { host: Host::new(session, ticker), monitor: Monitor::new(&board) }
    }

    /// Sends the board a picture, and returns its name.
    pub(crate) fn picture(&mut self) -> u32 {
        let mut samples = [0; PICTURE as usize * PICTURE as usize];
        for (index, sample) in (0_u32..).zip(&mut samples) {
            *sample = (index.wrapping_mul(2_654_435_761) >> 24) as u8;
        }
        self.host.bitmap(PICTURE, PICTURE, &samples)
    }

    pub(crate) fn play(&mut self, header: &Header, records: &[Record]) {
        self.play_with_points(header, records, &[]);
    }

    pub(crate) fn play_with_points(&mut self, header: &Header, records: &[Record], points: &[Point]) {
        let mut scene = [0; SCENE_MAX_LEN];
        let (head, rest) = scene.split_at_mut(HEADER_LEN);
        head.copy_from_slice(&header.write(records.len() as u8, points.len() as u8));
        let (body, tail) = rest.split_at_mut(RECORD_LEN * records.len());
        for (place, record) in body.chunks_exact_mut(RECORD_LEN).zip(records) {
            place.copy_from_slice(&record.write());
        }
        for (place, point) in tail.chunks_exact_mut(POINT_LEN).zip(points) {
            place.copy_from_slice(&point.write());
        }
        self.play_bytes(&scene[..HEADER_LEN + RECORD_LEN * records.len() + POINT_LEN * points.len()]);
    }

    /// Plays a compiled scene, which the board has to take.
    pub(crate) fn play_bytes(&mut self, scene: &[u8]) {
        self.host.command(Command::Disarm);
        // The arm switch is released in the first tick after that, and held in the second.
        self.tick(None);
        self.tick(None);
        self.host.play(scene);
        self.tick(None);
        assert!(self.host.session.scene() == Some(scene), "the scene is refused");
        assert!(self.host.ticker.status().telemetry.state == State::Active, "the scene does not play");
    }

    /// Nothing to drive.
    fn idle(&mut self, mut case: Case, first_touch: Option<Touch>) {
        for tick in 0..TICKS {
            let touch = if tick == 0 { first_touch } else { None };
            self.count(&mut case, touch);
        }
        case.report();
    }

    /// A finger that comes down, slides, rests for a while and slides on.
    pub(crate) fn slide(&mut self, mut case: Case) {
        self.tick(Some(Touch::Up));
        // Every case begins at the same distance from a report, so that they meet the same things in the same ticks.
        while !self.host.ticker.status().telemetry.tick.is_multiple_of(REPORT_TICKS) {
            self.tick(None);
        }
        let mut driven = 0;
        for tick in 0..TICKS {
            if tick.is_multiple_of(PING_TICKS) {
                self.host.ping();
            }
            if tick.is_multiple_of(STREAM_TICKS) {
                self.host.stream(tick / STREAM_TICKS);
            }
            // In the end, as often as there are ticks: no tick may take longer for it.
            let report_ticks = if tick < TICKS / 6 * 5 { REPORT_TICKS } else { 1 };
            let touch = tick.is_multiple_of(report_ticks).then(|| {
                let along_m = 1e-5 * tick.min(TICKS / 3).max(tick.saturating_sub(TICKS / 3)) as f32;
                Touch::Down { x_m: 0.02 + along_m, y_m: 0.03 + 0.3 * along_m, age_ticks: REPORT_TICKS }
            });
            driven += u32::from(self.count(&mut case, touch).dac_code != DacCode::ZERO);
        }
        assert!(driven > TICKS / 2, "the board does not drive");
        case.report();
    }

    pub(crate) fn tick(&mut self, touch: Option<Touch>) -> Drive {
        self.host.before_tick(touch);
        let sense = self.sense();
        let drive = tick(&mut self.host, &sense);
        self.monitor.follow(drive);
        drive
    }

    pub(crate) fn count(&mut self, case: &mut Case, touch: Option<Touch>) -> Drive {
        self.host.before_tick(touch);
        let sense = self.sense();
        let drive = case.take(tick, &mut self.host, &sense);
        self.monitor.follow(drive);
        drive
    }

    fn sense(&self) -> Sense {
        let arm_switch = !self.host.ticker.waits_for_release();
        Sense { amplifier_fault: false, monitor_v: self.monitor.voltage_v, arm_switch }
    }
}

/// A tick with the order before it.
#[inline(never)]
fn tick(host: &mut Host<'static>, sense: &Sense) -> Drive {
    host.tick(sense)
}
