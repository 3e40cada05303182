//! A square-wave voltage, driven through the firmware.

use frixel_control::Status;
use frixel_layers::{Blend, Constant, Layer, Record, Region};
use frixel_session::Session;

use crate::local_host::{DriveError, LocalHost, Progress};
use crate::local_scene::{CARRIER_HZ, OUT_OF_REACH_N, header, scene, scene_len};

/// Duration of the output, s: time to read a voltage from a prepared oscilloscope.
const DRIVEN_S: f32 = 3.0;
/// Settling time before the measurement, s. At 1,000 V/s, the envelope then reaches up to 400 V.
const SETTLING_S: f32 = 0.5;
/// Part of a half period, counted from the tick of its edge, in which the monitor is read: 1.2 to 3.2 ms of 4 ms. The
/// edges last tens of microseconds, and the main loop sees them a few ticks late.
const READ_FROM: f32 = 0.3;
const READ_UNTIL: f32 = 0.8;
/// Time from the end until the monitor is read again, and duration of that reading, s. The output must be zero 1 ms
/// after the end.
const REST_S: f32 = 0.05;

/// The driven voltage, and the monitor's voltage during and after the drive, in V.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Driven peak, from the DAC code and the board's full scale.
    pub driven_v_peak: f32,
    /// Mean of the monitor in the positive half periods.
    pub high_v: f32,
    /// Mean of the monitor in the negative half periods.
    pub low_v: f32,
    /// Mean of the monitor after the end.
    pub rest_v: f32,
}

/// Plays one voltage for three seconds, and reads the monitor during and after it. The board's main loop calls
/// [`Drive::step`] in every round, together with the session and with the tick running.
#[derive(Debug)]
pub struct Drive {
    scene: heapless::Vec<u8, { scene_len(1) }>,
    timing: Timing,
    volts_per_code: f32,
    host: LocalHost,
    /// Tick at which the board was disarmed again.
    ended_at_tick: Option<u32>,
    half_period: HalfPeriod,
    high: Mean,
    low: Mean,
    rest: Mean,
    driven: Mean,
}

/// The last half period of the carrier seen by the main loop.
#[derive(Clone, Copy, Debug, Default)]
struct HalfPeriod {
    positive: bool,
    since_tick: u32,
}

/// Ticks in the times above.
#[derive(Clone, Copy, Debug)]
struct Timing {
    tick_hz: f32,
    half_period_ticks: f32,
}

impl Timing {
    fn ticks(&self, time_s: f32) -> u32 {
        (time_s * self.tick_hz) as u32
    }
}

/// A running mean.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f32,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: f32) {
        self.sum += value;
        self.count += 1;
    }

    fn get(&self) -> Option<f32> {
        (self.count > 0).then(|| self.sum / self.count as f32)
    }
}

impl Drive {
    /// A host that plays a square wave of `peak_v` on a disarmed board.
    pub fn new(peak_v: f32, board: &frixel_control::Board) -> Self {
        let tick_hz = board.tick_hz as f32;
        let layer = Layer::Constant(Constant { electric_friction_n: OUT_OF_REACH_N });
        let record = Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer };
        Self {
            scene: scene(&header(peak_v), &[record]),
            timing: Timing { tick_hz, half_period_ticks: 0.5 * tick_hz / CARRIER_HZ },
            volts_per_code: board.limits.full_scale_v_peak / f32::from(i16::MAX),
            host: LocalHost::new(DRIVEN_S, board),
            ended_at_tick: None,
            half_period: HalfPeriod::default(),
            high: Mean::default(),
            low: Mean::default(),
            rest: Mean::default(),
            driven: Mean::default(),
        }
    }

    /// One round: processes the last status, the tick count and the current monitor voltage, and sends the session a
    /// host's messages. The caller discards the session's output, so that the session keeps listening. Returns the
    /// result once the output is zero again.
    pub fn step(
        &mut self,
        status: &Status,
        now_tick: u32,
        monitor_v: f32,
        session: &mut Session<'_>,
    ) -> Option<Result<Reading, DriveError>> {
        if let Some(ended_at_tick) = self.ended_at_tick {
            let ticks = now_tick.wrapping_sub(ended_at_tick);
            if ticks >= self.timing.ticks(REST_S) {
                self.rest.add(monitor_v);
            }
            return (ticks >= 2 * self.timing.ticks(REST_S)).then(|| self.reading());
        }
        match self.host.step(&self.scene, status, now_tick, session) {
            Err(error) => return Some(Err(error)),
            Ok(Progress::Playing(ticks)) if ticks >= self.timing.ticks(SETTLING_S) => {
                self.measure(status, now_tick, monitor_v);
            }
            Ok(Progress::Done) => self.ended_at_tick = Some(now_tick),
            Ok(Progress::Playing(_) | Progress::Waiting) => {}
        }
        None
    }

    /// Records the monitor's voltage if the half period has settled.
    fn measure(&mut self, status: &Status, now_tick: u32, monitor_v: f32) {
        let code = status.telemetry.dac_code;
        let positive = code > 0;
        if positive != self.half_period.positive {
            self.half_period = HalfPeriod { positive, since_tick: status.telemetry.tick };
            return;
        }
        let elapsed = now_tick.wrapping_sub(self.half_period.since_tick) as f32 / self.timing.half_period_ticks;
        if (READ_FROM..READ_UNTIL).contains(&elapsed) {
            self.driven.add(f32::from(code).abs() * self.volts_per_code);
            if positive { self.high.add(monitor_v) } else { self.low.add(monitor_v) }
        }
    }

    fn reading(&self) -> Result<Reading, DriveError> {
        match (self.driven.get(), self.high.get(), self.low.get(), self.rest.get()) {
            (Some(driven_v_peak), Some(high_v), Some(low_v), Some(rest_v)) => {
                Ok(Reading { driven_v_peak, high_v, low_v, rest_v })
            }
            _ => Err(DriveError::NoReading),
        }
    }
}
