//! The simulated world: everything outside the board's pins.

mod faults;
mod options;

use core::ops::Range;

use frixel_control::{Board, Drive, Sense};
use frixel_model::FrictionLaw;
use frixel_session::Touch;

use crate::amplifier::{Amplifier, AmplifierConfig};
use crate::error::{OutOfRange, WorldError};
use crate::fingertip::{Fingertip, FingertipConfig, SlipStep, example_finger};
use crate::stroke::{FingerState, Stroke};
use crate::touch::{TouchConfig, TouchSource};
use faults::FaultSchedule;

pub use faults::WorldFault;
pub use options::{OwnFinger, WorldOptions};

/// Configuration of a [`World`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldConfig {
    /// Tick rate, Hz, above 0.
    pub tick_hz: u32,
    /// Voltage on the electrode that the board assumes for DAC code 32,767, in volts, peak. Above 0.
    pub full_scale_v_peak: f64,
    /// The amplifier between DAC and electrode.
    pub amplifier: AmplifierConfig,
    /// The finger, besides its contact model.
    pub fingertip: FingertipConfig,
    /// The touch source.
    pub touch: TouchConfig,
    /// Steady friction of the finger, whatever scene plays. `None`: that of the finger for which the scene is made.
    pub own_finger: Option<FrictionLaw>,
}

impl WorldConfig {
    /// The ideal plant: an amplifier whose only flaw is its edges, a finger in steady sliding under a constant load,
    /// and a touch source without losses. 40 kHz and 200 V at full scale.
    pub const IDEAL: Self = Self {
        tick_hz: 40_000,
        full_scale_v_peak: 200.0,
        amplifier: AmplifierConfig::IDEAL,
        fingertip: FingertipConfig::IDEAL,
        touch: TouchConfig::IDEAL,
        own_finger: None,
    };

    /// The ideal plant around a board, with the lags that the board expects.
    pub fn of(board: &Board) -> Self {
        Self {
            tick_hz: board.tick_hz,
            full_scale_v_peak: board.limits.full_scale_v_peak.into(),
            amplifier: AmplifierConfig::of(board),
            ..Self::IDEAL
        }
    }
}

impl Default for WorldConfig {
    /// [`Self::IDEAL`].
    fn default() -> Self {
        Self::IDEAL
    }
}

/// The result of a tick. All values but the mean square apply at the end of the tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Felt {
    /// The finger, if it is on the screen.
    pub finger: Option<FingerState>,
    /// Friction under the finger, in newtons: the natural and the electric part. Zero without a finger.
    pub friction_n: f64,
    /// Friction without the drive, in newtons: `mu F_N` of a finger in steady sliding, with its load and its noise.
    pub natural_friction_n: f64,
    /// Electric part of the friction, after the friction lag, in newtons.
    pub electric_friction_n: f64,
    /// Normal load of the finger, in newtons. Zero without a finger.
    pub normal_load_n: f64,
    /// Friction error caused by a normal load other than the scene's: this finger's friction in steady sliding, without
    /// noise, minus that under the load of the scene's profile, in newtons.
    pub load_mismatch_n: f64,
    /// Motion of the skin in this tick.
    pub slip: SlipStep,
    /// Voltage on the electrode.
    pub electrode_v: f64,
    /// Mean of the squared electrode voltage over the tick, in V^2.
    pub mean_square_v2: f64,
}

/// The reference under the same finger: the friction with an ideal display, with the same load, noise and skin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReferenceFriction {
    electric_n: [f64; 2],
}

impl ReferenceFriction {
    /// Advances by a tick in which the finger felt `felt`. `electric_friction_n` is the scene's at the finger's true
    /// place, in N. Returns the total friction of the reference.
    pub fn follow(&mut self, felt: &Felt, electric_friction_n: f64) -> f64 {
        if felt.finger.is_none() {
            *self = Self::default();
            return 0.0;
        }
        let steady_n = electric_friction_n * felt.slip.electric_gain;
        felt.natural_friction_n + felt.slip.advance(&mut self.electric_n, steady_n)
    }
}

/// Amplifier, electrode, finger and touch source, in virtual time.
///
/// In every tick, the board reads [`sense`](Self::sense), and its output is passed to [`apply`](Self::apply), which
/// holds it for one tick. Until a scene is played, the finger is the [example finger](crate::example_finger).
///
/// ```
/// use frixel_hil_sim::{Point, Stroke, World, WorldConfig};
/// use frixel_control::Drive;
///
/// let left = Point { x_m: 0.01, y_m: 0.03 };
/// let right = Point { x_m: 0.09, y_m: 0.03 };
/// let stroke = Stroke::constant_speed(left, right, 0.1)?;
/// let mut world = World::new(WorldConfig::default(), stroke, 1)?;
/// world.start_stroke();
/// let sense = world.sense();
/// assert!(!sense.amplifier_fault);
/// let felt = world.apply(Drive { amplifier_enable: true, ..Drive::default() });
/// assert_eq!(felt.friction_n, 0.25);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct World {
    /// The world without scheduled faults.
    config: WorldConfig,
    tick: u64,
    seed: u64,
    amplifier: Amplifier,
    faults: FaultSchedule,
    fingertip: Fingertip,
    touch_source: TouchSource,
    /// The report that arrived at the current tick.
    touch: Option<Touch>,
    stroke: Stroke,
    motion: Motion,
}

/// The source of the finger's motion.
#[derive(Clone, Copy, Debug)]
enum Motion {
    /// No source: the finger is off the screen.
    Lifted,
    /// The stroke, which started at this tick.
    Stroke { start_tick: u64 },
    /// The caller, who has placed the finger here. The normal load, in newtons, defaults to the profile's.
    Placed { finger: FingerState, normal_load_n: Option<f64> },
}

impl World {
    /// A world at rest at tick 0, with the finger lifted. All random numbers are drawn from `seed`.
    pub fn new(config: WorldConfig, stroke: Stroke, seed: u64) -> Result<Self, WorldError> {
        let WorldConfig { tick_hz, full_scale_v_peak, amplifier, fingertip, touch, own_finger } = config;
        if tick_hz == 0 {
            return Err(OutOfRange { name: "tick_hz", expected: "above 0", found: 0.0 }.into());
        }
        let mut touch_source = TouchSource::new(&touch, tick_hz, seed)?;
        touch_source.tick(0, None);
        let example: FrictionLaw = example_finger().map_err(WorldError::Finger)?.into();
        let mut fingertip = Fingertip::new(fingertip, example, tick_hz, seed)?;
        if let Some(law) = own_finger {
            fingertip.set_law(law);
        }
        Ok(Self {
            config,
            tick: 0,
            seed,
            amplifier: Amplifier::new(&amplifier, full_scale_v_peak, tick_hz)?,
            faults: FaultSchedule::default(),
            fingertip,
            touch_source,
            touch: None,
            stroke,
            motion: Motion::Lifted,
        })
    }

    /// Loads the finger of a scene's profile under its load, and half the period of the scene's carrier in ticks. A
    /// [finger of the world's own](OwnFinger) stays.
    pub fn set_finger(&mut self, law: impl Into<FrictionLaw>, half_period_ticks: u32) {
        let law = law.into();
        self.fingertip.set_scene_load(&law);
        if self.config.own_finger.is_none() {
            self.fingertip.set_law(law);
        }
        self.fingertip.set_half_period(half_period_ticks);
    }

    /// Replaces the touch source. Pending reports are lost, and the new source reports the finger at its first sample.
    ///
    /// # Errors
    ///
    /// [`OutOfRange`] names an invalid number of the configuration; the previous source stays.
    pub fn set_touch_source(&mut self, config: &TouchConfig) -> Result<(), OutOfRange> {
        self.touch_source = TouchSource::from_tick(config, self.config.tick_hz, self.seed, self.tick)?;
        self.touch = None;
        Ok(())
    }

    /// Steady friction of the finger on the screen.
    pub fn finger_law(&self) -> &FrictionLaw {
        self.fingertip.law()
    }

    /// Starts or restarts the stroke: its time zero is the current tick.
    pub fn start_stroke(&mut self) {
        self.motion = Motion::Stroke { start_tick: self.tick };
    }

    /// Places the finger, and ends a stroke. From the next tick on, [`Self::apply`] uses this place until the finger is
    /// placed elsewhere or lifted.
    ///
    /// To move the finger, call this in every tick with its speed: the world does not derive a speed from two places.
    pub fn place_finger(&mut self, finger: FingerState) {
        self.motion = Motion::Placed { finger, normal_load_n: None };
    }

    /// Like [`Self::place_finger`], with a normal load of `normal_load_n`, in newtons, above 0, in place of the
    /// profile's.
    pub fn place_pressing_finger(&mut self, finger: FingerState, normal_load_n: f64) {
        self.motion = Motion::Placed { finger, normal_load_n: Some(normal_load_n) };
    }

    /// Lifts the finger off the screen, and ends a stroke.
    pub fn lift_finger(&mut self) {
        self.motion = Motion::Lifted;
    }

    /// Schedules a fault for a range of ticks, from the current one on at the earliest.
    ///
    /// # Errors
    ///
    /// [`OutOfRange`] names an invalid number of the fault.
    pub fn schedule_fault(&mut self, ticks: Range<u64>, fault: WorldFault) -> Result<(), OutOfRange> {
        let ticks = ticks.start.max(self.tick)..ticks.end;
        self.faults.add(ticks, fault, self.config.amplifier)
    }

    /// Causes `fault` for `ticks` ticks, from the current one on.
    pub(crate) fn cause(&mut self, fault: WorldFault, ticks: u64) -> Result<(), OutOfRange> {
        let now = self.tick();
        self.schedule_fault(now..now.saturating_add(ticks), fault)
    }

    /// Ticks a second.
    pub fn tick_hz(&self) -> u32 {
        self.config.tick_hz
    }

    /// Number of ticks since the start.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// The finger at the current tick, if it is on the screen.
    pub fn finger(&self) -> Option<FingerState> {
        if self.faults.has(self.tick, WorldFault::FingerLifted) {
            return None;
        }
        match self.motion {
            Motion::Lifted => None,
            Motion::Stroke { start_tick } => self.stroke.at(self.stroke_s(start_tick)),
            Motion::Placed { finger, .. } => Some(finger),
        }
    }

    /// Time since the start of the stroke, s.
    fn stroke_s(&self, start_tick: u64) -> f64 {
        (self.tick - start_tick) as f64 / f64::from(self.config.tick_hz)
    }

    /// The load stated by the stroke or the caller, in N.
    fn stated_load_n(&self) -> Option<f64> {
        match self.motion {
            Motion::Stroke { start_tick } if self.stroke.has_loads() => {
                self.stroke.normal_load_n(self.stroke_s(start_tick))
            }
            Motion::Placed { normal_load_n, .. } => normal_load_n,
            Motion::Stroke { .. } | Motion::Lifted => None,
        }
    }

    /// Returns the board's input at the current tick. Repeated calls return the same value.
    pub fn sense(&self) -> Sense {
        Sense {
            amplifier_fault: self.faults.has(self.tick, WorldFault::AmplifierNotReady),
            monitor_v: self.amplifier.monitor_v() as f32,
            arm_switch: self.faults.arm_switch(self.tick),
        }
    }

    /// Monitor voltage at the end of the last tick, for a rig that advances the world when the board has latched the
    /// next code. In [`Self::sense`] it is one tick behind, since a board latches the code of a tick at the end of that
    /// tick.
    #[cfg(unix)]
    pub(crate) fn monitor_now_v(&self) -> f64 {
        self.amplifier.monitor_now_v()
    }

    /// Returns the touch report that arrived at the current tick.
    pub fn touch(&self) -> Option<Touch> {
        self.touch
    }

    /// Whether the arm switch is welded closed.
    pub(crate) fn is_switch_welded(&self) -> bool {
        self.faults.has(self.tick, WorldFault::SwitchWelded)
    }

    /// Holds the board's output for one tick, and advances to the next.
    pub fn apply(&mut self, drive: Drive) -> Felt {
        if let Some(config) = self.faults.new_amplifier(self.tick, self.config.amplifier) {
            let WorldConfig { full_scale_v_peak, tick_hz, .. } = self.config;
            // Its numbers were checked when the fault was scheduled.
            if let Ok(amplifier) = self.amplifier.reconfigured(&config, full_scale_v_peak, tick_hz) {
                self.amplifier = amplifier;
            }
        }
        let output = self.amplifier.tick(self.faults.drive(self.tick, drive));
        self.tick += 1;
        let finger = self.finger();
        let felt = match &finger {
            Some(finger) => self.fingertip.slide(&output, finger, self.stated_load_n()),
            None => self.fingertip.lift(&output),
        };
        self.touch_source.tick(self.tick, finger.as_ref());
        self.touch = self.faults.touch(self.tick, self.touch_source.arrived());
        felt
    }
}
