//! The simulated board of the page: firmware and world in virtual time, with its host in the same instance.

use std::time::Duration;

use frixel_driver::DeviceError;
use frixel_hil_sim::{BoardMemory, RigConfig, TouchConfig, WorldOptions};
use frixel_play::{PlayError, SimulationError};
use frixel_wire::fault::{Fault, State};

use crate::felt::{FeltSamples, TICKS_PER_SAMPLE};
use crate::host::{self, Host, stream_mut};
use crate::host_error::HostError;
use crate::pointer::{Pointer, PointerSample};
use crate::pointer_stream::PointerStream;
use crate::program::{drafted, touch_source};
use crate::request::Request;

/// Line rate of the simulated port, bits a second: as fast as the rig's line takes bytes. A scene that is replaced is
/// uploaded in virtual time, ahead of the page's clock, so the upload has to be shorter than the pointer's delay.
const BAUD: u32 = 20_000_000;
/// The names of the numbers before the columns of a frame: ticks, how many samples of friction and of sound it has,
/// state, fault (0 for none), and 1 while the finger is down.
pub(crate) const FRAME_HEAD: [&str; 8] =
    ["tick", "firstTick", "ticksPerSample", "samples", "soundSamples", "state", "fault", "contact"];

/// The simulated board, its world, and its host.
pub(crate) struct Simulator {
    host: Host<PointerStream<'static>>,
    /// Whether the page wants the scene to play.
    is_wanted: bool,
    /// The world's touch source.
    touch: TouchConfig,
}

impl Simulator {
    /// A board after reset, in a realistic world whose random numbers are drawn from `seed`, and its host connected.
    ///
    /// The board's memory is never freed: like a real board, an instance of the module has one board.
    pub(crate) fn new(seed: u64) -> Result<Self, HostError> {
        let config = RigConfig { baud: BAUD, ..RigConfig::default() }.for_drafts().with(&WorldOptions::default());
        let touch = config.world.touch;
        let stream = PointerStream::new(Box::leak(BoardMemory::new()), &config, seed)?;
        Ok(Self { host: host::connect(stream)?, is_wanted: false, touch })
    }

    /// Ticks since power-on.
    pub(crate) fn tick(&mut self) -> u64 {
        stream_mut(&mut self.host).tick()
    }

    /// The board's state and latched fault.
    pub(crate) fn state(&mut self) -> (State, Option<Fault>) {
        stream_mut(&mut self.host).state()
    }

    /// The board's host, for control lines.
    pub(crate) fn host_mut(&mut self) -> &mut Host<PointerStream<'static>> {
        &mut self.host
    }

    /// Compiles a scene and plays it under the touch source of the request, as a draft if a board would refuse it. If
    /// either cannot be read, the previous scene continues.
    pub(crate) fn play(&mut self, request: &Request) -> Result<(), HostError> {
        let (_, mut program) = drafted(request)?;
        program.header.prediction &= !request.without_prediction;
        let touch = touch_source(request)?;
        if touch != self.touch {
            let world = stream_mut(&mut self.host).world_mut();
            world.set_touch_source(&touch).map_err(|error| SimulationError::World(error.into()))?;
            self.touch = touch;
        }
        host::replace(&mut self.host, program)?;
        self.resume()?;
        Ok(())
    }

    /// Plays the loaded scene from now on, whatever stopped it.
    pub(crate) fn resume(&mut self) -> Result<(), DeviceError> {
        self.is_wanted = true;
        self.host.arm_and_play()
    }

    /// Sets the output to zero and disarms the board.
    pub(crate) fn stop(&mut self) -> Result<(), DeviceError> {
        self.is_wanted = false;
        self.host.stop()
    }

    /// The finger, moved by the page.
    pub(crate) fn pointer_mut(&mut self) -> &mut Pointer {
        &mut stream_mut(&mut self.host).pointer
    }

    /// Adds a sample of the pointer.
    pub(crate) fn add_pointer_sample(&mut self, sample: PointerSample) {
        let stream = stream_mut(&mut self.host);
        let now_tick = stream.tick() as f64;
        stream.pointer.add(sample, now_tick);
    }

    /// Runs `ticks` of virtual time. The host runs only while `is_alive`. Without it, the board receives nothing, and
    /// its host timeout sets the output to zero. When the host runs again, a scene that is wanted continues.
    pub(crate) fn run(&mut self, ticks: u32, is_alive: bool) -> Result<(), PlayError> {
        if !is_alive {
            for _ in 0..ticks {
                stream_mut(&mut self.host).step();
            }
            return Ok(());
        }
        let end = self.tick() + u64::from(ticks);
        if self.is_wanted && self.host.state().0 == State::Disarmed {
            self.host.arm_and_play()?;
        }
        let left = end.saturating_sub(self.tick());
        let tick_hz = self.host.device().hello().tick_hz;
        self.host.wait(Duration::from_secs(left) / tick_hz)
    }

    /// Takes what was felt since the last call.
    pub(crate) fn take_felt(&mut self) -> FeltSamples {
        stream_mut(&mut self.host).felt.take()
    }

    /// Felt friction since the last call, and the board's state, as the bytes that `board.js` reads.
    pub(crate) fn take_frame(&mut self) -> Vec<u8> {
        let (state, fault) = self.state();
        let is_touched = stream_mut(&mut self.host).is_touched();
        let tick = self.tick();
        let FeltSamples { first_tick, columns, sound_n } = self.take_felt();
        let head: [f64; FRAME_HEAD.len()] = [
            tick as f64,
            first_tick as f64,
            f64::from(TICKS_PER_SAMPLE),
            columns[0].len() as f64,
            sound_n.len() as f64,
            f64::from(state.number()),
            fault.map_or(0.0, |fault| f64::from(fault.number())),
            f64::from(u8::from(is_touched)),
        ];
        let values = columns.iter().flatten().chain(&sound_n);
        head.iter()
            .flat_map(|number| number.to_le_bytes())
            .chain(values.flat_map(|value| value.to_le_bytes()))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use frixel_wire::fault::State;

    use super::*;

    const SCENE: &str = "version = 1\n[[layer]]\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = 0.11\n";

    fn request() -> Request {
        let files = [("a.toml".to_owned(), SCENE.as_bytes().to_vec())].into();
        Request { entry: "a.toml".to_owned(), files, ..Request::default() }
    }

    /// Whatever the page's life looked like, a scene that was played plays once the page has lived for 100 ms.
    #[test]
    fn a_scene_that_is_wanted_plays_whenever_the_page_lives() {
        let mut random = 1_u64;
        let mut draw = |below: u64| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 33) % below
        };
        for seed in 0..20 {
            let mut simulator = Simulator::new(seed).unwrap();
            for round in 0..20 {
                for _ in 0..draw(6) {
                    simulator.run(draw(6_000) as u32, draw(2) == 0).unwrap();
                }
                if round == 0 || draw(3) == 0 {
                    simulator.play(&request()).unwrap();
                }
                for _ in 0..draw(6) {
                    simulator.run(draw(6_000) as u32, draw(2) == 0).unwrap();
                }
                for _ in 0..12 {
                    simulator.run(320, true).unwrap();
                }
                assert_eq!(simulator.state().0, State::Active, "seed {seed}, round {round}");
            }
        }
    }

    #[test]
    fn the_touch_source_of_a_request_is_that_of_the_world() {
        let mut simulator = Simulator::new(1).unwrap();
        let own = "reports_per_s = 60\nlatency_ms = 12\n";
        // Of 100, 200 and 500 reports a second, one in eight is lost.
        for (touch, expected) in [(Some("200"), 165..188), (Some("500"), 415..465), (Some(own), 59..62), (None, 80..95)]
        {
            simulator.play(&Request { touch: touch.map(str::to_owned), ..request() }).unwrap();
            let sample = PointerSample { tick: 0.0, place_m: [0.03, 0.03], is_down: true, normal_load_n: None };
            simulator.add_pointer_sample(sample);
            let stream = stream_mut(&mut simulator.host);
            let reports = (0..40_000).filter(|_| {
                stream.step();
                stream.world_mut().touch().is_some()
            });
            let reports = reports.count();
            assert!(expected.contains(&reports), "{touch:?}: {reports} reports in a second");
        }
        let wrong = Request { touch: Some("reports_per_s = 0\n".to_owned()), ..request() };
        let error = simulator.play(&wrong).unwrap_err().to_string();
        assert!(error.contains("reports_per_s") && error.contains("touch source:1"), "{error}");
    }

    /// Slides at 100 mm/s, and returns how far on average the board had the finger from where it was, from where the
    /// firmware predicts it, and from the newest report, mm.
    fn distances_mm(without_prediction: bool) -> [f32; 3] {
        let mut simulator = Simulator::new(1).unwrap();
        simulator.play(&Request { without_prediction, ..request() }).unwrap();
        let begin_tick = simulator.tick();
        for sample in 0..100_u32 {
            let tick = begin_tick as f64 + 320.0 * f64::from(sample + 1);
            let place_m = [0.01 + 0.8e-3 * f64::from(sample), 0.03];
            simulator.add_pointer_sample(PointerSample { tick, place_m, is_down: true, normal_load_n: None });
        }
        let mut sums_mm = [0.0; 3];
        let mut count = 0.0;
        let stream = stream_mut(&mut simulator.host);
        for tick in 0..100 * 320 {
            let record = stream.step();
            let places = stream.touched();
            let (Some(predicted_m), Some(reported_m)) = (places.predicted_m, places.reported_m) else { continue };
            // The first reports say no speed.
            if tick < 8_000 {
                continue;
            }
            let board_m = record.status.telemetry.finger_x_m;
            let true_m = record.felt.finger.unwrap().x_m as f32;
            for (sum_mm, x_m) in sums_mm.iter_mut().zip([true_m, predicted_m[0], reported_m[0]]) {
                *sum_mm += 1e3 * (board_m - x_m).abs();
            }
            count += 1.0;
        }
        assert!(count > 20_000.0, "{count} ticks with a finger");
        sums_mm.map(|sum_mm| sum_mm / count)
    }

    /// The page shows the predicted finger where the firmware has it; without prediction, the firmware has it where it
    /// was reported, but for the noise that its filter takes away.
    #[test]
    fn the_board_has_the_finger_where_it_is_predicted_or_where_it_was_reported() {
        let [from_finger_mm, from_prediction_mm, from_report_mm] = distances_mm(false);
        assert!(from_prediction_mm < 1e-3, "{from_prediction_mm} mm");
        assert!(from_finger_mm < 0.3 && from_report_mm > 1.0, "{from_finger_mm} mm, {from_report_mm} mm");
        let [from_finger_mm, from_prediction_mm, from_report_mm] = distances_mm(true);
        assert!(from_report_mm < 0.3, "{from_report_mm} mm");
        // 10 ms late, and a report in 10 ms: 1 to 2 mm, and more after a report that is lost.
        assert!((1.0..3.0).contains(&from_finger_mm), "{from_finger_mm} mm");
        assert!(from_prediction_mm > 1.0, "{from_prediction_mm} mm");
    }

    /// The contact of the example finger at no voltage, by hand from the load: `F_N = pi k a^4 / 4 R`, and larger with
    /// it.
    #[test]
    fn the_contact_is_that_of_the_model() {
        let mut simulator = Simulator::new(1).unwrap();
        simulator.play(&request()).unwrap();
        let place_m = [0.03, 0.03];
        let sample = PointerSample { tick: 0.0, place_m, is_down: true, normal_load_n: Some(0.5) };
        simulator.add_pointer_sample(sample);
        // Before the board takes the finger to stand still.
        simulator.run(2_000, true).unwrap();
        let samples = simulator.take_felt();
        let [contact_mm, voltage_v] = [10, 5].map(|column| *samples.columns[column].last().unwrap());
        let still_mm = 1e3 * (4.0 * 8e-3 * 0.5 / (std::f32::consts::PI * 1.8e7)).powf(0.25);
        assert!(voltage_v > 50.0, "{voltage_v} V");
        assert!(contact_mm > 1.02 * still_mm && contact_mm < 1.2 * still_mm, "{contact_mm} mm, {still_mm} mm");
    }

    /// A draft plays here, clamped, even one whose ticks take longer than a board has time for.
    #[test]
    fn a_draft_plays() {
        let mut simulator = Simulator::new(1).unwrap();
        let layer = "[[layer]]\nkind = \"noise\"\nblend = \"add\"\n\
            wavelength_min_mm = 1\nwavelength_max_mm = 3\nlow_n = 0.0\nhigh_n = 9.0\n";
        let text = format!("version = 1\n{}", layer.repeat(12));
        let files = [("a.toml".to_owned(), text.into_bytes())].into();
        let request = Request { files, ..request() };
        let (_, program) = drafted(&request).unwrap();
        let reasons: Vec<String> = program.refusals().map(ToString::to_string).collect();
        assert!(reasons.iter().any(|reason| reason.contains("cycles")), "{reasons:#?}");
        assert!(reasons.iter().any(|reason| !reason.contains("cycles")), "{reasons:#?}");
        simulator.play(&request).unwrap();
        simulator.run(4_000, true).unwrap();
        assert_eq!(simulator.state().0, State::Active);
        // A board refuses it.
        assert!(matches!(host::load(&mut simulator.host, &request), Err(HostError::Program(_))));
    }
}
