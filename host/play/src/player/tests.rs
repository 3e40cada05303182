use std::collections::BTreeMap;

use frixel_driver::{ByteStream, LinkClosed, PollingLink};
use frixel_felt::recorder::Observation;
use frixel_hil_sim::{BoardMemory, FingerState, Rig, RigConfig, Stroke};
use frixel_scene::{Scene, compile};

use super::*;

/// The line to a simulated board, with a record of every tick.
struct Line<'a> {
    rig: Rig<'a>,
    recorder: Recorder,
}

impl Line<'_> {
    fn step(&mut self) {
        let record = self.rig.step();
        self.recorder.record(&Observation::of_tick(&record));
    }
}

impl ByteStream for Line<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        self.rig.send(bytes);
        Ok(())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.now() + wait;
        while !self.rig.has_received() && self.now() < end {
            self.step();
        }
        self.rig.receive(buffer);
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_secs(self.rig.tick()) / self.rig.tick_hz()
    }

    fn name(&self) -> &'static str {
        "the simulator"
    }
}

impl Recorded for Line<'_> {
    fn recorder_mut(&mut self) -> &mut Recorder {
        &mut self.recorder
    }
}

type Playing<'a> = Player<PollingLink<Line<'a>>>;

fn program(layers: &str) -> Program {
    let scene = Scene::parse(&format!("version = 2\n{layers}"), "test.toml", &BTreeMap::new()).unwrap();
    let board = RigConfig::default().board;
    compile(&scene, &board.limits, board.tick_hz).unwrap()
}

fn ping(live: bool) -> Program {
    program(&format!("[[layer]]\nname = \"ping\"\nkind = \"constant\"\nfriction_fraction = 0.5\nlive = {live}\n"))
}

/// A board that plays a program.
fn playing(memory: &mut BoardMemory, program: Program) -> Playing<'_> {
    let rig = Rig::new(memory, &RigConfig::default(), Stroke::sweep(0.12, 0.08, 1.0).unwrap(), 1).unwrap();
    let board = RigConfig::default().board;
    let recorder = Recorder::new(&program, &board.limits, board.tick_hz, u64::MAX, 1).unwrap();
    let mut player = Player::new(Device::connect(PollingLink::new(Line { rig, recorder })).unwrap());
    player.device_mut().link_mut().stream_mut().rig.world_mut().place_finger(FingerState {
        x_m: 0.05,
        y_m: 0.05,
        speed_m_per_s: 0.1,
    });
    player.start(program, 0, &mut |_| ControlFlow::Continue(())).unwrap();
    player
}

/// Puts a program on the board behind the player's back, whose layers refuse every change.
fn refuse_changes(player: &mut Playing) {
    player.upload(&ping(false)).unwrap();
}

/// Friction of the reference above natural friction in the last tick, N.
fn wanted_n(player: &mut Playing) -> f64 {
    player.recorder_mut().rows().last().and_then(|row| row.wanted_n).unwrap() - 0.25
}

const MS: Duration = Duration::from_millis(1);

#[test]
fn a_change_that_the_board_refuses_is_not_kept() {
    let mut memory = BoardMemory::new();
    let mut player = playing(&mut memory, ping(true));
    player.wait(MS).unwrap();
    let before_n = wanted_n(&mut player);
    refuse_changes(&mut player);
    assert!(player.change_layer("ping", Some(false), None).unwrap_err().is_refusal());
    assert!(player.playing().unwrap().off().is_empty());
    player.wait(MS).unwrap();
    assert!(before_n > 0.02);
    assert_eq!(wanted_n(&mut player).to_bits(), before_n.to_bits(), "and the recorder goes back to the setting before");
}

#[test]
fn the_end_of_a_trigger_that_the_board_refuses_is_reported_once_with_its_layer() {
    let mut memory = BoardMemory::new();
    let mut player = playing(&mut memory, ping(true));
    player.change_layer("ping", Some(false), None).unwrap();
    player.trigger("ping", 0.05).unwrap();
    refuse_changes(&mut player);
    let refused = player.wait(100 * MS).unwrap_err().to_string();
    assert!(refused.starts_with("the end of the trigger of layer 1 \"ping\": "), "{refused}");
    player.wait(100 * MS).unwrap();
}

#[test]
fn a_trigger_ends_at_its_time_on_the_clock_of_the_link() {
    let mut memory = BoardMemory::new();
    let mut player = playing(&mut memory, ping(true));
    player.change_layer("ping", Some(false), None).unwrap();
    player.trigger("ping", 0.05).unwrap();
    let triggered = player.device().now();
    while player.playing().unwrap().off().is_empty() {
        player.step(MS).unwrap();
    }
    let lasted = player.device().now().saturating_sub(triggered);
    assert!(lasted.abs_diff(50 * MS) < 2 * MS, "{lasted:?}");
}

#[test]
fn the_recorder_is_told_what_plays() {
    let stream = "[[layer]]\nkind = \"stream\"\nlow_n = 0.002\nhigh_n = 0.018\nlive = true\n";
    let mut memory = BoardMemory::new();
    let mut player = playing(&mut memory, ping(true));
    player.wait(10 * MS).unwrap();
    assert!(wanted_n(&mut player) > 0.02, "a constant friction");
    assert_eq!(player.replace(program(stream)).unwrap(), Replaced::AtOnce);
    player.change_layer("1", None, Some(0.5)).unwrap();
    player.wait(10 * MS).unwrap();
    assert!(wanted_n(&mut player).abs() < 1e-6, "nothing streams yet");
    player.stream(Feed::of(vec![u16::MAX; 1_600], 4_000)).unwrap();
    player.wait(200 * MS).unwrap();
    assert!((wanted_n(&mut player) - 0.5 * 0.018).abs() < 1e-6, "half of the largest sample");
    player.wait(400 * MS).unwrap();
    assert!(player.is_stream_over());
    assert!(wanted_n(&mut player).abs() < 1e-6, "the stream has ended");
    player.stream(Feed::of(vec![u16::MAX; 4_000], 4_000)).unwrap();
    player.wait(200 * MS).unwrap();
    assert!(wanted_n(&mut player) > 0.008, "another stream");
    player.stop().unwrap();
    assert!(wanted_n(&mut player).abs() < 1e-6, "the output is off");
}

/// Disarmed by its host timeout, the board refuses to stop, and its output is zero all the same.
#[test]
fn a_board_that_has_left_the_play_by_itself_is_stopped_without_an_error() {
    let mut memory = BoardMemory::new();
    let mut player = playing(&mut memory, ping(true));
    let line = player.device_mut().link_mut().stream_mut();
    for _ in 0..20_000 {
        line.step();
    }
    assert_eq!(player.state().0, State::Active, "the player has not heard of it");
    player.stop().unwrap();
    assert_eq!(player.state().0, State::Disarmed);
}

#[test]
fn a_board_that_stopped_by_itself_says_why() {
    assert_eq!(StopReason::of(None, Flags::default()), None);
    assert_eq!(StopReason::of(None, Flags::HOST_SILENT), Some(StopReason::HostSilent));
    let fault = Some(Fault::Deadline);
    assert_eq!(StopReason::of(fault, Flags::HOST_SILENT), Some(StopReason::Fault(Fault::Deadline)));
}
