//! What `frixel play` costs beside the world that it simulates:
//!
//! ```sh
//! cargo run --release -p frixel --example play_cost [SCENE [SECONDS]]
//! ```
//!
//! Four stages simulate the same scene, stroke and realistic world; each does what the one before does, and more. They
//! take turns, and of each the run with the least time of the processor counts, which other processes disturb least.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "it is a program")]

#[cfg(unix)]
fn main() -> std::process::ExitCode {
    stages::main()
}

#[cfg(not(unix))]
fn main() {
    eprintln!("the time of a processor is read on Unix only");
}

#[cfg(unix)]
mod stages {
    use std::env;
    use std::error::Error;
    use std::ffi::OsString;
    use std::hint::black_box;
    use std::path::Path;
    use std::process::{Command, ExitCode, Stdio};
    use std::time::Duration;

    use frixel_control::Drive;
    use frixel_driver::ignore_progress;
    use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke, World, WorldOptions};
    use frixel_lab::simulate::default_stroke;
    use frixel_play::{Player, Simulation, TO_THE_END, connect, simulate};
    use frixel_scene::{Program, compile};
    use frixel_wire::dac_code::DacCode;
    use rustix::time::{ClockId, clock_gettime};

    /// What is played unless the arguments say something else.
    const SCENE: &str = "scenes/brick.toml";
    const SECONDS: &str = "30";
    /// How many times each stage runs.
    const ROUNDS: usize = 5;
    /// A play that is nothing but its beginning and its end, s.
    const SHORT_S: &str = "0.001";
    const SEED: u64 = 1;
    /// Is in the environment of this program when it is to be the command.
    const IS_COMMAND: &str = "FRIXEL_PLAY_COST_IS_COMMAND";

    type Outcome<T> = Result<T, Box<dyn Error>>;

    /// What every stage simulates.
    struct Case {
        scene: String,
        program: Program,
        rig: RigConfig,
        stroke: Stroke,
        seconds: f64,
    }

    /// Least time of the processor, s, of each stage.
    struct Costs {
        /// [`World::sense`] and [`World::apply`] alone, under a square carrier.
        world_s: f64,
        /// And the firmware, its serial line and a host that keeps it playing.
        board_s: f64,
        /// And the recorder, with its reference and its metrics.
        recorded_s: f64,
        /// The command: and scene, summary, `felt.csv` and pictures.
        played_s: f64,
        /// The command, for a play of [`SHORT_S`].
        short_s: f64,
        /// `frixel check` of the scene: the judge of its elements.
        checked_s: f64,
    }

    pub(super) fn main() -> ExitCode {
        if env::var_os(IS_COMMAND).is_some() {
            let exit = frixel::main();
            eprintln!("{}", processor_s());
            return exit;
        }
        let arguments: Vec<OsString> = env::args_os().skip(1).collect();
        match measure(&arguments) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{error}");
                ExitCode::FAILURE
            }
        }
    }

    fn measure(arguments: &[OsString]) -> Outcome<()> {
        let argument = |place: usize, default: &str| -> String {
            arguments.get(place).map_or_else(|| default.to_owned(), |given| given.to_string_lossy().into_owned())
        };
        let (scene, seconds) = (argument(0, SCENE), argument(1, SECONDS));
        let seconds: f64 = seconds.parse().map_err(|_| format!("{seconds} is not a number of seconds"))?;
        let case = Case::new(scene, seconds)?;
        let mut costs = Costs::unknown();
        for _ in 0..ROUNDS {
            costs.add_round(&case)?;
        }
        costs.print(&case);
        Ok(())
    }

    impl Case {
        fn new(scene: String, seconds: f64) -> Outcome<Self> {
            let rig = RigConfig::default().with(&WorldOptions::default());
            let read = frixel::scene_file::load(Path::new(&scene))?;
            let program = compile(&read, &rig.board.limits, rig.board.tick_hz)?;
            let stroke = default_stroke(&program, Some(seconds))?;
            Ok(Self { scene, program, rig, stroke, seconds })
        }

        fn ticks(&self) -> u64 {
            (self.seconds * f64::from(self.rig.board.tick_hz)).round() as u64
        }

        fn world(&self) -> Outcome<()> {
            let mut world = World::new(self.rig.world, self.stroke.clone(), SEED)?;
            world.set_finger(self.program.header.friction_law()?, self.program.carrier.half_period_ticks);
            world.start_stroke();
            for tick in 0..self.ticks() {
                black_box(world.sense());
                let code = if (tick / 20).is_multiple_of(2) { 25_000 } else { -25_000 };
                let drive = Drive { dac_code: DacCode::from_bits(code), amplifier_enable: true };
                black_box(world.apply(black_box(drive)));
            }
            Ok(())
        }

        fn board(&self) -> Outcome<()> {
            let mut memory = BoardMemory::new();
            let rig = Rig::new(&mut memory, &self.rig, self.stroke.clone(), SEED)?;
            let mut player = Player::new(connect(Box::new(rig))?);
            player.start(self.program.clone(), 0, &mut ignore_progress)?;
            player.wait(Duration::from_secs_f64(self.seconds))?;
            player.stop()?;
            Ok(())
        }

        fn recorded(&self) -> Outcome<()> {
            let ticks_per_row = self.rig.board.tick_hz / 1000;
            let simulation = Simulation::of_stroke(self.rig, self.stroke.clone(), SEED);
            let simulation = Simulation { seconds: self.seconds, ticks_per_row, ..simulation };
            black_box(simulate(&self.program, &simulation, None, TO_THE_END)?);
            Ok(())
        }
    }

    impl Costs {
        fn unknown() -> Self {
            let unknown_s = f64::INFINITY;
            Self {
                world_s: unknown_s,
                board_s: unknown_s,
                recorded_s: unknown_s,
                played_s: unknown_s,
                short_s: unknown_s,
                checked_s: unknown_s,
            }
        }

        fn add_round(&mut self, case: &Case) -> Outcome<()> {
            let seconds = case.seconds.to_string();
            self.world_s = self.world_s.min(timed(|| case.world())?);
            self.board_s = self.board_s.min(timed(|| case.board())?);
            self.recorded_s = self.recorded_s.min(timed(|| case.recorded())?);
            self.played_s = self.played_s.min(play_s(&case.scene, &seconds)?);
            self.short_s = self.short_s.min(play_s(&case.scene, SHORT_S)?);
            self.checked_s = self.checked_s.min(command_s(&["check", &case.scene])?);
            Ok(())
        }

        fn print(&self, case: &Case) {
            let Self { world_s, board_s, recorded_s, played_s, short_s, checked_s } = *self;
            let ns = |time_s: f64| 1e9 * time_s / case.ticks() as f64;
            println!("{}, {} s: least processor time of {ROUNDS} runs, ns a tick", case.scene, case.seconds);
            println!("                       in all   more   over the world   over the board");
            let mut before_s = 0.0;
            for (name, time_s) in [
                ("world", world_s),
                ("board: and firmware", board_s),
                ("and recorder", recorded_s),
                ("frixel play", played_s),
            ] {
                println!(
                    "  {name:20} {:7.1} {:6.1} {:16.2} {:16.2}",
                    ns(time_s),
                    ns(time_s - before_s),
                    time_s / world_s,
                    time_s / board_s
                );
                before_s = time_s;
            }
            println!("  of frixel play, {:.0} ms are there however short the play is", 1e3 * short_s);
            println!("  frixel check takes {:.0} ms", 1e3 * checked_s);
        }
    }

    /// Time of the processor that a stage takes, s.
    fn timed(stage: impl FnOnce() -> Outcome<()>) -> Outcome<f64> {
        let begin_s = processor_s();
        stage()?;
        Ok(processor_s() - begin_s)
    }

    /// Time of the processor that this process has taken, s.
    fn processor_s() -> f64 {
        let time = clock_gettime(ClockId::ProcessCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }

    /// Time of the processor that the command takes for a play, s.
    fn play_s(scene: &str, seconds: &str) -> Outcome<f64> {
        let out = env::temp_dir().join(format!("frixel-play-cost-{}", std::process::id()));
        let folder = out.to_str().ok_or("the temporary folder's name is not UTF-8")?;
        let time_s = command_s(&["play", scene, "--seconds", seconds, "--out", folder])?;
        std::fs::remove_dir_all(&out)?;
        Ok(time_s)
    }

    /// Time of the processor that the command takes with these arguments, s. It runs in a process of its own, as people
    /// run it.
    fn command_s(arguments: &[&str]) -> Outcome<f64> {
        let mut command = Command::new(env::current_exe()?);
        let output = command.args(arguments).env(IS_COMMAND, "1").stdout(Stdio::null()).output()?;
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let last = said.lines().last().unwrap_or_default();
        last.parse().map_err(|_| said.clone().into())
    }
}
