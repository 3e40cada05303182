use std::collections::BTreeMap;

use frixel_driver::{ByteStream, LinkClosed, PollingLink, ignore_progress};
use frixel_felt::recorder::PlayListener;
use frixel_hil_sim::{Board, BoardMemory, Rig, RigConfig, Stroke};
use frixel_scene::{LayerSetting, Scene, compile};
use frixel_wire::hello::{BoardKind, BoardLimits};

use super::*;

/// The line to a simulated board, and the player's notifications of its play.
struct Line {
    rig: Rig<'static>,
    told: Told,
    /// The largest electric friction that a tick has asked for, N.
    commanded_max_n: f32,
}

/// Notifications to a listener, one word each.
#[derive(Debug, Default, PartialEq)]
struct Told(Vec<String>);

impl PlayListener for Told {
    fn scene_replaced(&mut self, program: &Program, _: &BoardLimits) -> Result<(), ParameterError> {
        self.0.push(format!("scene of {}", program.records.len()));
        Ok(())
    }

    fn layer_changed(&mut self, record: u8, LayerSetting { on, gain }: LayerSetting) {
        self.0.push(format!("layer {record} {on} {gain}"));
    }

    fn stream_started(&mut self, sample_hz: u32) {
        self.0.push(format!("stream {sample_hz}"));
    }

    fn samples_sent(&mut self, samples: &[u16]) {
        self.0.push(format!("{} samples", samples.len()));
    }

    fn stream_ended(&mut self) {
        self.0.push("end".to_owned());
    }

    fn stopped(&mut self) {
        self.0.push("stop".to_owned());
    }
}

impl ByteStream for Line {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        self.rig.send(bytes);
        Ok(())
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let end = self.now() + wait;
        while !self.rig.has_received() && self.now() < end {
            let commanded_n = self.rig.step().status.telemetry.commanded_electric_friction_n;
            self.commanded_max_n = self.commanded_max_n.max(commanded_n);
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

impl Recorded for Line {
    type Recorder = Told;

    fn recorder_mut(&mut self) -> &mut Told {
        &mut self.told
    }
}

type Playing = Player<PollingLink<Line>>;

fn program(layers: &str) -> Program {
    let scene = Scene::parse(format!("version = 1\n{layers}"), "test.toml", &BTreeMap::new()).unwrap();
    let board = RigConfig::default().board;
    compile(&scene, &board.limits, board.tick_hz).unwrap()
}

fn ping(live: bool) -> Program {
    program(&format!("[[layer]]\nname = \"ping\"\nkind = \"constant\"\nfriction_fraction = 0.5\nlive = {live}\n"))
}

/// A board that plays a program.
fn playing(program: Program) -> Playing {
    let mut player = Player::new(Device::connect(PollingLink::new(line())).unwrap());
    player.start(program, 0, &mut ignore_progress).unwrap();
    player
}

/// A line to a board whose memory lives as long as the program.
fn line() -> Line {
    line_to(&RigConfig::default())
}

fn line_to(rig: &RigConfig) -> Line {
    let stroke = Stroke::sweep(0.12, 0.08, 60.0).unwrap();
    let memory = Box::leak(BoardMemory::new());
    let mut rig = Rig::new(memory, rig, stroke, 1).unwrap();
    rig.world_mut().start_stroke();
    Line { rig, told: Told::default(), commanded_max_n: 0.0 }
}

/// A layer of more friction that begins off, beside the whole screen's in the ways that a blend can join it.
fn off_at_start(blend: &str) -> Program {
    let amount = if blend == "multiply" { "factor = 2" } else { "fraction = 0.5" };
    program(&format!(
        "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.2\n\
         [[layer]]\nname = \"ping\"\nkind = \"constant\"\nblend = \"{blend}\"\nfriction_{amount}\nlive = true\n\
         start = \"off\"\n"
    ))
}

/// Puts a program on the board behind the player's back, whose layers refuse every change.
fn refuse_changes(player: &mut Playing) {
    player.upload(&LiveLayers::new(ping(false))).unwrap();
}

const MS: Duration = Duration::from_millis(1);

#[test]
fn only_a_simulator_plays_beyond_what_a_finger_was_measured_at() {
    let finger = |measured_v_rms: u8| {
        program(&format!(
            "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n[finger]\nfriction_coefficient = 0.5\n\
             normal_load_n = 0.5\nradius_mm = 8\nstiffness_pa_per_m = 1.8e7\nskin_gap_um = 4.74\n\
             origin = \"measured\"\ndate = \"2026-11-22\"\nmethod = \"load cell\"\nscreen = \"example\"\n\
             friction_coefficient_interval = [0.49, 0.51]\nelectric_friction_interval_n = [0.02, 0.03]\n\
             measured_voltage_max_v_rms = {measured_v_rms}\nmeasured_normal_load_range_n = [0.4, 0.6]\n"
        ))
    };
    let (within, beyond) = (finger(150), finger(75));
    playing(beyond.clone());
    let board = Board { kind: BoardKind::NucleoG474re, ..Board::SIMULATOR };
    let rig = RigConfig { board, ..RigConfig::default() };
    let mut player = Player::new(Device::connect(PollingLink::new(line_to(&rig))).unwrap());
    let sentence = "a real board plays only what was measured on this finger: the scene needs up to ";
    let refused = player.start(beyond.clone(), 0, &mut ignore_progress).unwrap_err().to_string();
    assert!(refused.starts_with(sentence), "{refused}");
    player.start(within, 0, &mut ignore_progress).unwrap();
    let refused = player.replace(beyond).unwrap_err();
    assert!(refused.is_refusal() && refused.to_string().starts_with(sentence), "{refused}");
    player.wait(100 * MS).unwrap();
    assert_eq!(player.state().0, State::Active, "what was there plays on");
}

#[test]
fn a_change_that_the_board_refuses_is_not_kept() {
    let mut player = playing(ping(true));
    refuse_changes(&mut player);
    assert!(player.change_layer("ping", Some(false), None).unwrap_err().is_refusal());
    assert!(player.playing().unwrap().off().is_empty());
    let told = ["layer 0 false 1", "layer 0 true 1"];
    assert_eq!(player.recorder_mut().0, told, "and the recorder goes back to the setting before");
}

#[test]
fn the_end_of_a_trigger_that_the_board_refuses_is_reported_once_with_its_layer() {
    let mut player = playing(ping(true));
    player.change_layer("ping", Some(false), None).unwrap();
    player.trigger("ping", Some(0.05)).unwrap();
    refuse_changes(&mut player);
    let refused = player.wait(100 * MS).unwrap_err().to_string();
    assert!(refused.starts_with("the end of the trigger of layer 1 \"ping\": "), "{refused}");
    player.wait(100 * MS).unwrap();
}

#[test]
fn the_recorder_is_told_what_plays() {
    let stream = "[[layer]]\nkind = \"stream\"\nlow_n = 0.002\nhigh_n = 0.018\nlive = true\n";
    let mut player = playing(ping(true));
    assert_eq!(player.replace(program(stream)).unwrap(), Replaced { faded_out: false, dropped_gains: None });
    player.change_layer("1", None, Some(0.5)).unwrap();
    player.stream(Feed::of(vec![0; 100], 4_000)).unwrap();
    player.wait(200 * MS).unwrap();
    assert!(player.is_stream_over());
    player.stop().unwrap();
    let told = ["scene of 1", "layer 0 true 0.5", "stream 4000", "100 samples", "end", "stop"];
    assert_eq!(player.recorder_mut().0, told);
}

/// The largest electric friction asked for since the last call, as a part of the reach.
fn commanded_max(player: &mut Playing) -> f64 {
    let reach_n = player.playing().unwrap().program().reach.electric_friction_max_n;
    let line = player.device_mut().link_mut().stream_mut();
    f64::from(std::mem::take(&mut line.commanded_max_n)) / reach_n
}

/// It is off before a tick can play it, at the first play and after every replacement, whatever its blend.
#[test]
fn a_layer_that_starts_off_is_never_played_until_it_is_switched_on() {
    for (blend, on) in [("replace", 0.5), ("add", 0.7), ("multiply", 0.4), ("max", 0.5)] {
        let mut player = playing(off_at_start(blend));
        player.wait(200 * MS).unwrap();
        let asked = commanded_max(&mut player);
        assert!((asked - 0.2).abs() < 1e-3, "{blend}: {asked}");
        player.replace(off_at_start(blend)).unwrap();
        player.wait(20 * MS).unwrap();
        let asked = commanded_max(&mut player);
        assert!((asked - 0.2).abs() < 1e-3, "{blend}: {asked}");
        player.trigger("ping", Some(0.05)).unwrap();
        player.wait(20 * MS).unwrap();
        let asked = commanded_max(&mut player);
        assert!((asked - on).abs() < 1e-3, "{blend}: {asked}");
        assert!(player.playing().unwrap().off().is_empty());
        player.wait(40 * MS).unwrap();
        assert_eq!(player.playing().unwrap().off(), [1]);
    }
}

#[test]
fn what_was_set_of_a_layer_is_kept_when_the_program_is_replaced() {
    let mut player = playing(off_at_start("add"));
    player.change_layer("ping", Some(true), Some(0.5)).unwrap();
    player.replace(off_at_start("add")).unwrap();
    commanded_max(&mut player);
    player.wait(20 * MS).unwrap();
    let asked = commanded_max(&mut player);
    assert!((asked - 0.45).abs() < 1e-3, "{asked}");
    assert_eq!(player.recorder_mut().0, ["layer 1 true 0.5", "scene of 2", "layer 1 true 0.5"]);
    // The page shows a scene as it is written.
    player.replace_anew(off_at_start("add")).unwrap();
    assert_eq!(player.playing().unwrap().off(), [1]);
}

#[test]
fn a_board_that_is_armed_by_hand_plays_nothing_of_a_layer_that_starts_off() {
    let mut player = Player::new(Device::connect(PollingLink::new(line())).unwrap());
    player.stop().unwrap();
    player.replace(off_at_start("replace")).unwrap();
    player.arm_and_play().unwrap();
    player.wait(200 * MS).unwrap();
    let asked = commanded_max(&mut player);
    assert!((asked - 0.2).abs() < 1e-3, "{asked}");
    assert_eq!(player.playing().unwrap().off(), [1]);
}

#[test]
fn a_trigger_of_a_stream_without_samples_is_refused() {
    let stream = "[[layer]]\nname = \"voice\"\nkind = \"stream\"\nlow_n = 0.002\nhigh_n = 0.018\nlive = true\n";
    let mut player = playing(program(stream));
    player.change_layer("voice", Some(false), None).unwrap();
    let refused = player.trigger("voice", Some(0.05)).unwrap_err();
    assert!(refused.is_refusal() && refused.to_string().contains("add `--stream FILE`"), "{refused}");
    player.stream(Feed::of(vec![0; 100], 4_000)).unwrap();
    player.trigger("voice", Some(0.05)).unwrap();
}

/// A board that was disarmed by its host timeout, or by a fault, refuses to stop; its output is zero all the same.
#[test]
fn a_board_that_has_left_the_play_by_itself_is_stopped_without_an_error() {
    for (has_fault, left_in) in [(false, State::Disarmed), (true, State::Faulted)] {
        let mut player = playing(ping(true));
        let rig = &mut player.device_mut().link_mut().stream_mut().rig;
        if has_fault {
            rig.raise(Fault::Deadline, 1);
        }
        for _ in 0..20_000 {
            rig.step();
        }
        assert_eq!(player.state().0, State::Active, "the player has not heard of it");
        player.stop().unwrap();
        assert_eq!(player.state().0, left_in);
        assert_eq!(player.state().1.is_some(), has_fault);
    }
}
