//! Felt friction of the simulated finger, as the page draws and plays it.

use frixel_felt::recorder::{FeltRow, Observation, Recorder};
use frixel_hil_sim::{Felt, RigTick, Status};
use frixel_model::{ContactModel, FrictionLaw};

use crate::touched::TouchedPlaces;

/// Ticks of one sample for the page: a period of the usual carrier of 1 kHz, so that its ripple averages out.
pub(crate) const TICKS_PER_SAMPLE: u32 = 40;
/// Corner of the high-pass between felt friction and sound, Hz: below what loudspeakers and ears follow.
const SOUND_MIN_HZ: f64 = 10.0;

/// Records what happens tick by tick, for the page.
pub(crate) struct FeltSampler {
    recorder: Recorder,
    /// Values that the recorder's rows lack, for each row.
    touched: Vec<Touched>,
    tick_hz: f64,
    sound: Sound,
}

/// The places of the finger to the board, and its contact, at the end of a sample.
struct Touched {
    places: TouchedPlaces,
    contact_radius_m: f64,
}

/// The names of the columns, with their units. The page keeps each of them (`web/page/samples.js`), which a test
/// compares. The voltage is the rms. `predicted` and `reported` are where the finger is to the board, with prediction
/// and without.
pub(crate) const COLUMNS: [&str; 11] = [
    "xMm",
    "yMm",
    "speedMmPerS",
    "referenceN",
    "feltN",
    "voltageV",
    "predictedXMm",
    "predictedYMm",
    "reportedXMm",
    "reportedYMm",
    "contactRadiusMm",
];

/// Samples for the page.
pub(crate) struct FeltSamples {
    /// Tick of the first sample's first tick.
    pub(crate) first_tick: u64,
    /// As [`COLUMNS`] names them; places, speed and contact are not-a-number while the finger is up, and so is the
    /// contact of a finger with an empirical law, which does not give it.
    pub(crate) columns: [Vec<f32>; COLUMNS.len()],
    /// The change of the felt friction at every tick, N.
    pub(crate) sound_n: Vec<f32>,
}

impl FeltSampler {
    pub(crate) fn new(tick_hz: u32) -> Self {
        let mut recorder = Recorder::without_reference(tick_hz, TICKS_PER_SAMPLE).through_finger();
        recorder.start(0);
        Self { recorder, touched: Vec::new(), tick_hz: f64::from(tick_hz), sound: Sound::new(f64::from(tick_hz)) }
    }

    /// The recorder, which is notified of the scene that plays.
    pub(crate) fn recorder_mut(&mut self) -> &mut Recorder {
        &mut self.recorder
    }

    /// Adds a tick, in which the board had the finger at `places`, and its friction by `law`.
    pub(crate) fn add(&mut self, record: &RigTick<Status>, places: TouchedPlaces, law: &FrictionLaw) {
        self.recorder.record(&Observation::of_tick(record.tick as u32, &record.felt, &record.status.telemetry));
        if let Some(row) = self.recorder.rows().get(self.touched.len()) {
            let radius_m = |voltage_v_rms| contact_radius_m(law, voltage_v_rms);
            let contact_radius_m = row.x_mm.and(row.electrode_v_rms).map_or(f64::NAN, radius_m);
            self.touched.push(Touched { places, contact_radius_m });
        }
        self.sound.add(&record.felt);
    }

    /// Takes the samples since the last call.
    pub(crate) fn take(&mut self) -> FeltSamples {
        let rows = self.recorder.take_rows();
        let end_tick = |row: &FeltRow| (row.t_s * self.tick_hz).round() as u64;
        let touched = std::mem::take(&mut self.touched);
        let column = |value: fn(&FeltRow) -> f64| rows.iter().map(|row| value(row) as f32).collect();
        let touch = |value: fn(&Touched) -> f32| touched.iter().map(value).collect();
        FeltSamples {
            first_tick: rows.first().map_or(0, |row| end_tick(row) + 1 - u64::from(TICKS_PER_SAMPLE)),
            columns: [
                column(|row| row.x_mm.unwrap_or(f64::NAN)),
                column(|row| row.y_mm.unwrap_or(f64::NAN)),
                column(|row| row.speed_mm_s.unwrap_or(f64::NAN)),
                // On a bare screen, friction is natural.
                column(|row| row.reference_n.or(row.natural_n).unwrap_or(0.0)),
                column(|row| row.felt_n.unwrap_or(0.0)),
                column(|row| row.electrode_v_rms.unwrap_or(0.0)),
                touch(|touched| in_mm(touched.places.predicted_m)[0]),
                touch(|touched| in_mm(touched.places.predicted_m)[1]),
                touch(|touched| in_mm(touched.places.reported_m)[0]),
                touch(|touched| in_mm(touched.places.reported_m)[1]),
                touch(|touched| (1e3 * touched.contact_radius_m) as f32),
            ],
            sound_n: std::mem::take(&mut self.sound.samples_n),
        }
    }
}

/// Coordinates in mm, not-a-number without a place.
fn in_mm(place_m: Option<[f32; 2]>) -> [f32; 2] {
    place_m.map_or([f32::NAN; 2], |place_m| place_m.map(|along_m| 1e3 * along_m))
}

/// Radius of the contact at a voltage by the model, m; not-a-number for a friction that was measured.
fn contact_radius_m(law: &FrictionLaw, voltage_v_rms: f64) -> f64 {
    match law {
        FrictionLaw::Contact(carried) => {
            carried.contact().state(voltage_v_rms).map_or(f64::NAN, |state| state.contact_radius_m)
        }
        FrictionLaw::Empirical(_) => f64::NAN,
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

    use frixel_model::LoadedContact;

    fn finger() -> FrictionLaw {
        let finger: LoadedContact<f64> = frixel_hil_sim::example_finger().unwrap();
        finger.into()
    }

    /// Ticks of a world in which a finger rests from tick 100 on.
    fn records() -> Vec<RigTick<Status>> {
        let stroke = Stroke::still(Point { x_m: 0.0, y_m: 0.0 }, 1.0).unwrap();
        let mut world = World::new(WorldConfig::default(), stroke, 1).unwrap();
        (1..=1_000)
            .map(|tick| {
                if tick == 100 {
                    world.place_finger(FingerState { x_m: 0.02, y_m: 0.03, speed_m_per_s: 0.0 });
                }
                let felt = world.apply(frixel_control::Drive::default());
                RigTick {
                    tick,
                    status: frixel_control::Status { telemetry: Telemetry::default(), ..Default::default() },
                    drive: frixel_control::Drive::default(),
                    felt,
                }
            })
            .collect()
    }

    #[test]
    fn samples_follow_each_other_however_they_are_taken() {
        let mut recorder = FeltSampler::new(40_000);
        let (mut next_tick, mut sound) = (1, 0);
        for (count, record) in (1..).zip(&records()) {
            recorder.add(record, TouchedPlaces::default(), &finger());
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
        let mut recorder = FeltSampler::new(40_000);
        for record in &records() {
            recorder.add(record, TouchedPlaces::default(), &finger());
        }
        let samples = recorder.take();
        assert!(samples.sound_n.iter().all(|change_n| change_n.abs() < 1e-9), "a resting finger on a bare screen");
        assert!(samples.columns[0][1].is_nan() && (samples.columns[0][5] - 20.0).abs() < 1e-4);
    }
}
