//! Whole ticks, by scene.

use cortex_m::singleton;
use frixel_control::{Active, Board, Drive, Sense, StreamBuffer, Ticker};
use frixel_layers::{BitmapPool, Header, Point, Record, Scene};
use frixel_session::{NextScene, Session, Touch};
use frixel_testkit::{HEADER, IdealMonitor, RandomScene, empirical_header, record, scene_with_points};
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::State;
use frixel_wire::message::Command;

use crate::count::{Case, Counter};
use crate::host::{Host, STREAM_FRAME, STREAM_TICKS_PER_SAMPLE};
use crate::layers::{GRATING, bitmap, largest_scene};

/// Number of ticks counted for each scene: a stroke across the screen.
const TICKS: u32 = 8_000;
/// Ticks between two reports of the touch source.
const REPORT_TICKS: u32 = 400;
/// Ticks between two pings.
pub(crate) const PING_TICKS: u32 = 2_000;
/// Ticks between two frames of the stream.
pub(crate) const STREAM_TICKS: u32 = STREAM_FRAME as u32 * STREAM_TICKS_PER_SAMPLE;
/// Number of random scenes whose commits are counted.
const COMMITTED_RANDOM_SCENES: u64 = 30;
/// Side of the square picture, in samples.
const PICTURE: u16 = 100;

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
    bench.commit_steps(counter, crc32);
}

/// A playing board.
pub(crate) struct Bench {
    pub(crate) host: Host<'static>,
    /// A bit for each kind of layer whose cost was counted, by the kind's number.
    pub(crate) kinds_counted: u32,
    monitor: IdealMonitor,
    /// Whether one monitor reading in four is wrong while the amplifier is enabled: the largest share that the correct
    /// ones compensate. The supervisor then checks every reading, as it does while the amplifier switches.
    pub(crate) disturbs_monitor: bool,
    is_enabled: bool,
}

impl Bench {
    /// A board that has just started. Can be called only once.
    pub(crate) fn new() -> Self {
        static POOL: BitmapPool = BitmapPool::new();
        static STREAM: StreamBuffer = StreamBuffer::new();
        let board = Board::SIMULATOR;
        let memory = (singleton!(: Active = Active::new()), singleton!(: NextScene = NextScene::new()));
        let (Some(playing), Some(next)) = memory else { panic!("this runs once") };
        let mut ticker = Ticker::new(&board, &POOL, playing);
        let mut session = Session::new(board, &POOL, next);
        ticker.attach_stream(&STREAM);
        session.attach_stream(&STREAM);
        Self {
            host: Host::new(session, ticker),
            kinds_counted: 0,
            monitor: IdealMonitor::new(
                board.limits.full_scale_v_peak,
                board.amplifier.time_constant_s / board.tick_period_s(),
            ),
            disturbs_monitor: false,
            is_enabled: false,
        }
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
        self.play_bytes(&scene_with_points(header, records, points));
    }

    /// Plays a compiled scene, which the board must accept.
    pub(crate) fn play_bytes(&mut self, scene: &[u8]) {
        self.host.command(Command::Disarm);
        // The arm switch is released in the first tick after that, and held in the second.
        self.tick(None);
        self.tick(None);
        self.host.play(scene);
        self.tick(None);
        self.assert_accepted(scene);
        assert!(self.host.ticker.status().telemetry.state == State::Active, "the scene does not play");
    }

    /// Counts the steps of the commits of random scenes, and of one with the most layers and points.
    fn commit_steps(&mut self, counter: &mut Counter, crc32: u32) {
        let mut case = counter.case("commit_step");
        self.commit(&largest_scene(), &mut case);
        for seed in 0..COMMITTED_RANDOM_SCENES {
            self.commit(&RandomScene::new(seed, crc32).bytes(), &mut case);
        }
        case.report();
        self.law_commit_steps(counter.case("commit_law_step"));
    }

    /// Counts the steps of the commits of scenes whose finger has an empirical law: up to the whole voltage, and up to
    /// a part of it.
    fn law_commit_steps(&mut self, mut case: Case) {
        for voltage_max_v_rms in [150.0, 97.0] {
            let header = Header { voltage_max_v_rms, ..empirical_header() };
            let scene = scene_with_points(&header, &[record(GRATING)], &[]);
            self.commit(&scene, &mut case);
        }
        case.report();
    }

    /// Counts the steps of a commit, which the board must accept.
    fn commit(&mut self, scene: &[u8], case: &mut Case) {
        self.host.upload(scene);
        self.host.commit(scene, |host| case.take(|host: &mut Host, ()| host.poll(), host, ()));
        self.assert_accepted(scene);
    }

    fn assert_accepted(&self, scene: &[u8]) {
        let header = Scene::open(scene).ok().map(|scene| *scene.header());
        assert!(header.is_some() && self.host.session.scene_header() == header.as_ref(), "the scene is refused");
    }

    /// Counts ticks without output.
    fn idle(&mut self, mut case: Case, first_touch: Option<Touch>) {
        for tick in 0..TICKS {
            let touch = if tick == 0 { first_touch } else { None };
            self.count(&mut case, touch);
        }
        case.report();
    }

    /// Counts ticks under a finger that touches down, slides, rests for a while and slides again.
    pub(crate) fn slide(&mut self, mut case: Case) {
        self.tick(Some(Touch::Up));
        // The amplifier has switched on before anything is counted.
        self.tick(Some(Touch::Down { x_m: 0.02, y_m: 0.03, age_ticks: 0 }));
        self.tick(None);
        self.tick(None);
        self.tick(None);
        self.tick(None);
        // Every case begins at the same distance from a report, so that all cases have the same events in the same
        // ticks.
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
            // At the end a report comes in every tick; this must not make any tick longer.
            let report_ticks = if tick < TICKS / 6 * 5 { REPORT_TICKS } else { 1 };
            let touch = tick.is_multiple_of(report_ticks).then(|| {
                let along_m = 1e-5 * tick.min(TICKS / 3).max(tick.saturating_sub(TICKS / 3)) as f32;
                Touch::Down { x_m: 0.02 + along_m, y_m: 0.03 + 0.3 * along_m, age_ticks: REPORT_TICKS }
            });
            driven += u32::from(self.count(&mut case, touch).dac_code != DacCode::ZERO);
        }
        // A square grating whose low part is bare glass drives for half of the time.
        assert!(driven > TICKS / 3, "the board does not drive");
        case.report();
    }

    pub(crate) fn tick(&mut self, touch: Option<Touch>) -> Drive {
        self.host.before_tick(touch);
        let sense = self.sense();
        let drive = tick(&mut self.host, &sense);
        self.monitor.follow(drive.dac_code);
        self.is_enabled = drive.amplifier_enable;
        drive
    }

    pub(crate) fn count(&mut self, case: &mut Case, touch: Option<Touch>) -> Drive {
        self.host.before_tick(touch);
        let sense = self.sense();
        let drive = case.take(tick, &mut self.host, &sense);
        self.monitor.follow(drive.dac_code);
        self.is_enabled = drive.amplifier_enable;
        drive
    }

    fn sense(&self) -> Sense {
        let arm_switch = !self.host.ticker.waits_for_release();
        let disturbs = self.disturbs_monitor && self.is_enabled;
        let is_wrong = disturbs && self.host.ticker.status().telemetry.tick.is_multiple_of(4);
        let monitor_v = self.monitor.voltage_v() + if is_wrong { 1e3 } else { 0.0 };
        Sense { amplifier_fault: false, monitor_v, arm_switch }
    }
}

/// Runs a tick and the order before it.
#[inline(never)]
fn tick(host: &mut Host<'static>, sense: &Sense) -> Drive {
    host.tick(sense)
}
