//! What the simulated finger felt, as the page draws and plays it.

use frixel_felt::recorder::PlayListener;
use frixel_hil_sim::{Felt, ReferenceFriction, TickRecord};
use frixel_model::ParameterError;
use frixel_scene::reference::{Context, Reference, StrokeReference};
use frixel_scene::{LayerSetting, Program};
use frixel_wire::hello::BoardLimits;

/// Ticks of one sample for the page: a period of the usual carrier of 1 kHz, so that its ripple averages out.
pub(crate) const TICKS_PER_SAMPLE: u32 = 40;
/// Corner of the high-pass between felt friction and sound, Hz: below what loudspeakers and ears follow.
const SOUND_MIN_HZ: f64 = 10.0;

/// Collects what happens tick by tick, and gives it out in samples.
pub(crate) struct FeltRecorder {
    reference: Option<StrokeReference>,
    through_finger: ReferenceFriction,
    tick_hz: f64,
    sum: Sums,
    first_tick: u64,
    /// Samples since the last [`Self::take`], in the order of the columns.
    columns: [Vec<f32>; COLUMNS.len()],
    sound: Sound,
}

/// The names of the columns, with their units: the page has no other list of them. The voltage is the rms.
pub(crate) const COLUMNS: [&str; 6] = ["xMm", "yMm", "speedMmPerS", "referenceN", "feltN", "voltageV"];

#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    first_tick: u64,
    ticks: u32,
    reference_n: f64,
    felt_n: f64,
    square_v2: f64,
}

/// Samples for the page.
pub(crate) struct FeltSamples {
    /// Tick of the first sample's first tick.
    pub(crate) first_tick: u64,
    /// As [`COLUMNS`] names them; place and speed are not-a-number while the finger is up.
    pub(crate) columns: [Vec<f32>; COLUMNS.len()],
    /// The change of the felt friction at every tick, N.
    pub(crate) sound_n: Vec<f32>,
}

impl FeltRecorder {
    pub(crate) fn new(tick_hz: u32) -> Self {
        Self {
            reference: None,
            through_finger: ReferenceFriction::default(),
            tick_hz: f64::from(tick_hz),
            sum: Sums::default(),
            first_tick: 0,
            columns: Default::default(),
            sound: Sound::new(f64::from(tick_hz)),
        }
    }

    /// Adds a tick.
    pub(crate) fn add(&mut self, TickRecord { tick, felt, .. }: &TickRecord) {
        let reference_n = self.reference_n(*tick, felt);
        self.sound.add(felt);
        let sum = &mut self.sum;
        if sum.ticks == 0 {
            sum.first_tick = *tick;
        }
        sum.ticks += 1;
        sum.reference_n += reference_n;
        sum.felt_n += felt.friction_n;
        sum.square_v2 += felt.mean_square_v2;
        if sum.ticks == TICKS_PER_SAMPLE {
            if self.columns.iter().all(Vec::is_empty) {
                self.first_tick = sum.first_tick;
            }
            let per_tick = 1.0 / f64::from(TICKS_PER_SAMPLE);
            let (x_mm, y_mm, speed_mm_per_s) = felt.finger.map_or((f64::NAN, f64::NAN, f64::NAN), |finger| {
                (1e3 * finger.x_m, 1e3 * finger.y_m, 1e3 * finger.speed_m_per_s)
            });
            let voltage_v_rms = (sum.square_v2 * per_tick).sqrt();
            let sample = [x_mm, y_mm, speed_mm_per_s, sum.reference_n * per_tick, sum.felt_n * per_tick, voltage_v_rms];
            for (column, value) in self.columns.iter_mut().zip(sample) {
                column.push(value as f32);
            }
            self.sum = Sums::default();
        }
    }

    /// The friction that the finger would feel of a display without fault, N.
    fn reference_n(&mut self, tick: u64, felt: &Felt) -> f64 {
        let Some(reference) = &mut self.reference else { return felt.natural_friction_n };
        let Some(finger) = felt.finger else {
            reference.lift();
            return self.through_finger.follow(felt, 0.0);
        };
        let context = Context {
            t_s: tick as f64 / self.tick_hz,
            x_m: finger.x_m,
            y_m: finger.y_m,
            speed_m_per_s: finger.speed_m_per_s,
            ..Context::default()
        };
        self.through_finger.follow(felt, reference.electric_friction_n(&context))
    }

    /// Takes the samples since the last call.
    pub(crate) fn take(&mut self) -> FeltSamples {
        FeltSamples {
            first_tick: self.first_tick,
            columns: std::mem::take(&mut self.columns),
            sound_n: std::mem::take(&mut self.sound.samples_n),
        }
    }
}

impl PlayListener for FeltRecorder {
    fn scene_replaced(&mut self, program: &Program, _: &BoardLimits) -> Result<(), ParameterError> {
        self.reference = Some(Reference::new(program).along_stroke());
        Ok(())
    }

    fn layer_changed(&mut self, record: u8, LayerSetting { on, gain }: LayerSetting) {
        if let Some(reference) = &mut self.reference {
            reference.set_layer(record.into(), on, gain.into());
        }
    }
}

/// The change of the felt friction: a first-order high-pass, which starts anew with each touch.
struct Sound {
    smoothing: f64,
    mean_n: Option<f64>,
    samples_n: Vec<f32>,
}

impl Sound {
    fn new(tick_hz: f64) -> Self {
        Self { smoothing: std::f64::consts::TAU * SOUND_MIN_HZ / tick_hz, mean_n: None, samples_n: Vec::new() }
    }

    fn add(&mut self, felt: &Felt) {
        let sample_n = match (felt.finger, self.mean_n) {
            (None, _) => {
                self.mean_n = None;
                0.0
            }
            (Some(_), mean_n) => {
                let mean_n = mean_n.unwrap_or(felt.friction_n);
                let change_n = felt.friction_n - mean_n;
                self.mean_n = Some(mean_n + self.smoothing * change_n);
                change_n
            }
        };
        self.samples_n.push(sample_n as f32);
    }
}

#[cfg(test)]
mod tests {
    use frixel_hil_sim::{FingerState, Point, Stroke, World, WorldConfig};
    use frixel_wire::message::Telemetry;

    use super::*;

    /// Ticks of a world in which a finger rests from tick 100 on.
    fn records() -> Vec<TickRecord> {
        let stroke = Stroke::still(Point { x_m: 0.0, y_m: 0.0 }, 1.0).unwrap();
        let mut world = World::new(WorldConfig::default(), stroke, 1).unwrap();
        (1..=1_000)
            .map(|tick| {
                if tick == 100 {
                    world.place_finger(FingerState { x_m: 0.02, y_m: 0.03, speed_m_per_s: 0.0 });
                }
                let felt = world.apply(frixel_control::Drive::default());
                TickRecord {
                    tick,
                    status: frixel_control::Status { telemetry: Telemetry::default(), ..Default::default() },
                    felt,
                }
            })
            .collect()
    }

    #[test]
    fn samples_follow_each_other_however_they_are_taken() {
        let mut recorder = FeltRecorder::new(40_000);
        let (mut next_tick, mut sound) = (1, 0);
        for (count, record) in (1..).zip(&records()) {
            recorder.add(record);
            if count % 97 == 0 {
                let samples = recorder.take();
                let len = samples.columns[0].len() as u64;
                assert!(samples.columns.iter().all(|column| column.len() as u64 == len));
                assert!(len == 0 || samples.first_tick == next_tick, "{} after {next_tick}", samples.first_tick);
                next_tick += len * u64::from(TICKS_PER_SAMPLE);
                sound += samples.sound_n.len();
            }
        }
        assert_eq!((next_tick, sound), (961, 970));
    }

    #[test]
    fn a_touch_makes_no_sound_by_itself() {
        let mut recorder = FeltRecorder::new(40_000);
        for record in &records() {
            recorder.add(record);
        }
        let samples = recorder.take();
        assert!(samples.sound_n.iter().all(|change_n| change_n.abs() < 1e-9), "a resting finger on a bare screen");
        assert!(samples.columns[0][1].is_nan() && (samples.columns[0][5] - 20.0).abs() < 1e-4);
    }
}
