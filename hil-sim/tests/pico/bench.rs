//! An emulated Pico under a finger that slides again and again, and a host on its serial line.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::time::Duration;

use frixel_control::Board;
use frixel_driver::{ByteStream, Device, LinkClosed, PollingLink, ignore_progress};
use frixel_hil_sim::emulated::{Image, PicoRig, Stamped};
use frixel_hil_sim::{Point, RigTick, Stroke, World, WorldConfig};
use frixel_scene::{Program, Scene, compile};
use frixel_wire::hello::BoardLimits;

pub(super) const BOARD: Board = Board::PICO;
pub(super) const TICK: Duration = Duration::from_micros(1_000_000 / BOARD.tick_hz as u64);
/// Time until the switch counts as held, with a margin.
const SWITCH_TIME: Duration = Duration::from_millis(50);

/// The friction of a scene that most tests play.
pub(super) const CONSTANT: &str = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.9\n";

/// Stripes just wide enough for a finger to distinguish, from zero to nearly the largest friction of the board.
pub(super) const GRATING: &str = "version = 1\n[[layer]]\nkind = \"grating\"\nwavelength_mm = 10\n\
     low_n = 0.0\nhigh_fraction = 0.9\n";

/// A host with nothing but a serial line.
pub(super) type Host = Device<PollingLink<Cable>>;

/// A scene, compiled for the board.
pub(super) fn program(text: &str) -> Program {
    program_for(text, &BOARD.limits)
}

/// A scene, compiled for the board with these limits.
pub(super) fn program_for(text: &str, limits: &BoardLimits) -> Program {
    let scene = Scene::parse(text, "scene.toml", &BTreeMap::<String, Vec<u8>>::new()).unwrap();
    compile(&scene, limits, BOARD.tick_hz).unwrap()
}

/// A finger that slides again and again.
fn world() -> World {
    let [left, right] = [(4e-3, 30e-3), (116e-3, 45e-3)].map(|(x_m, y_m)| Point { x_m, y_m });
    let stroke = Stroke::constant_speed(left, right, 0.1).unwrap().looped(0.02).unwrap();
    let mut world = World::new(WorldConfig::of(&BOARD), stroke, 1).unwrap();
    let Program { header, carrier, .. } = program(CONSTANT);
    world.set_finger(header.friction_law().unwrap(), carrier.half_period_ticks);
    world
}

/// The board, which tests and hosts share.
#[derive(Clone)]
pub(super) struct Bench {
    rig: Rc<RefCell<PicoRig>>,
    records: Rc<RefCell<Vec<RigTick>>>,
}

impl Bench {
    /// Switches the board on, and waits until its arm switch counts as held.
    pub(super) fn new(image: &Image) -> Self {
        let bench = Self::just_on(image);
        bench.pass(SWITCH_TIME);
        bench
    }

    /// Switches the board on.
    pub(super) fn just_on(image: &Image) -> Self {
        Self::of(PicoRig::start(image, world()).unwrap())
    }

    /// As [`Self::new`], in a world like this whose finger will make `stroke`, for an image that takes the finger's
    /// place from a touch frame.
    pub(super) fn in_world_with_frame(image: &Image, config: &WorldConfig, stroke: Stroke, seed: u64) -> Self {
        let mut world = World::new(*config, stroke, seed).unwrap();
        let Program { header, carrier, .. } = program(CONSTANT);
        world.set_finger(header.friction_law().unwrap(), carrier.half_period_ticks);
        let bench = Self::of(PicoRig::start(image, world).unwrap());
        bench.with(PicoRig::attach_frame);
        bench.pass(SWITCH_TIME);
        bench
    }

    /// Switches a board on whose image takes the finger's place from a touch frame.
    pub(super) fn just_on_with_frame(image: &Image) -> Self {
        let bench = Self::just_on(image);
        bench.with(PicoRig::attach_frame);
        bench
    }

    /// Switches a board on that has stored nothing yet.
    pub(super) fn factory_new(image: &Image) -> Self {
        Self::of(PicoRig::factory_new(image, world()).unwrap())
    }

    fn of(mut rig: PicoRig) -> Self {
        rig.record_events();
        Self { rig: Rc::new(RefCell::new(rig)), records: Rc::default() }
    }

    /// Runs `work` on the rig.
    pub(super) fn with<R>(&self, work: impl FnOnce(&mut PicoRig) -> R) -> R {
        work(&mut self.rig.borrow_mut())
    }

    pub(super) fn now(&self) -> Duration {
        self.rig.borrow().now()
    }

    /// Lets one tick pass, without a host.
    pub(super) fn step(&self) -> RigTick {
        let record = self.with(|rig| {
            let record = rig.step().unwrap();
            let touch_frames = rig.take_touch_frames();
            rig.send(&touch_frames);
            record
        });
        self.records.borrow_mut().push(record);
        record
    }

    /// Lets time pass, without a host.
    pub(super) fn pass(&self, time: Duration) {
        let end = self.now() + time;
        while self.now() < end {
            self.step();
        }
    }

    /// The ticks since the last call.
    pub(super) fn take_records(&self) -> Vec<RigTick> {
        self.records.take()
    }

    /// What happened on the wires since the last call.
    pub(super) fn take_events(&self) -> Vec<Stamped> {
        self.with(PicoRig::take_events)
    }

    /// Connects a host.
    pub(super) fn connect(&self) -> Host {
        Device::connect(PollingLink::new(Cable(self.clone()))).unwrap()
    }

    /// Connects a host, which plays a scene under the sliding finger, and waits until the board drives.
    pub(super) fn play(&self, text: &str) -> Host {
        let mut host = self.connect();
        self.start(&mut host, text);
        host
    }

    /// Plays a scene under the sliding finger, and waits until the board drives.
    pub(super) fn start(&self, host: &mut Host, text: &str) {
        self.start_program(host, &program(text));
    }

    /// Plays a program under the sliding finger, and waits until the board drives.
    pub(super) fn start_program(&self, host: &mut Host, program: &Program) {
        frixel_play::start(host, program, &mut ignore_progress).unwrap();
        self.with(|rig| rig.world_mut().start_stroke());
        host.wait(Duration::from_millis(60), &mut |_| ()).unwrap();
        assert_eq!(self.with(|rig| rig.zero_since()), None, "the board drives");
    }
}

/// A host's end of the serial line.
pub(super) struct Cable(Bench);

impl ByteStream for Cable {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        self.0.with(|rig| rig.send(bytes));
        Ok(())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.0.now() + wait;
        while self.0.now() < end && !self.0.with(|rig| rig.has_received()) {
            self.0.step();
        }
        self.0.with(|rig| rig.receive(buffer));
        Ok(())
    }

    fn now(&self) -> Duration {
        self.0.now()
    }

    fn name(&self) -> &'static str {
        "pico"
    }
}
