//! How well a scene is felt: what a simulated finger feels, compared with the scene at the finger's true place.
//!
//! The reference goes through the same finger, load and noise, so that only the display's errors remain: where the touch
//! source saw the finger, what the drive made of it, what leaked.

use std::cell::RefCell;
use std::time::Duration;

use frixel_driver::Device;
use frixel_hil_sim::{BoardMemory, Rig, TickRecord};
use frixel_scene::recorder::Recorder;
use frixel_scene::{Program, band_rms};

use crate::finger_reference::FingerReference;
use crate::player::{PlayError, Simulation, start};
use crate::rigs::SimLink;

/// Samples a second of the compared frictions: two in a period of the carrier of 1 kHz, each with one of its edges.
pub(crate) const SAMPLE_HZ: u32 = 2_000;
/// Up to this frequency, in Hz, a texture is felt as a force in a place; above it, as vibration without a phase.
const PLACE_BELOW_HZ: f64 = 40.0;
/// Up to this frequency, in Hz, spurious force counts: from 40 Hz on, skin is most sensitive.
const SPURIOUS_BELOW_HZ: f64 = 400.0;
/// Time in which a play settles and that does not count, in s.
const SETTLING_S: f64 = 0.3;

/// Difference between what a finger felt and the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeltError {
    /// Rms of the reference's electric friction below 40 Hz without its mean, N.
    pub reference_n: f64,
    /// Rms of felt less reference friction below 40 Hz, N.
    pub error_n: f64,
    /// Correlation of the two below 40 Hz, of their electric parts.
    pub correlation: f64,
    /// What the felt friction has beyond the reference between 40 and 400 Hz, N: the root of the difference of the two
    /// powers, 0 if it has less.
    pub spurious_n: f64,
}

impl FeltError {
    /// The error over the reference's own swing; infinite without one.
    pub fn ratio(&self) -> f64 {
        self.error_n / self.reference_n
    }

    /// Compares electric frictions, in N, in the same samples.
    pub(crate) fn of(reference_n: &[f64], felt_n: &[f64]) -> Self {
        let differences_n: Vec<f64> =
            reference_n.iter().zip(felt_n).map(|(reference, felt)| felt - reference).collect();
        let low = |samples: &[f64]| band_rms(samples, SAMPLE_HZ, 0.0..PLACE_BELOW_HZ);
        let high = |samples: &[f64]| band_rms(samples, SAMPLE_HZ, PLACE_BELOW_HZ..SPURIOUS_BELOW_HZ);
        let (reference, felt, error) = (low(reference_n), low(felt_n), low(&differences_n));
        let excess = high(felt_n).powi(2) - high(reference_n).powi(2);
        Self {
            reference_n: reference,
            error_n: error,
            correlation: (reference * reference + felt * felt - error * error) / (2.0 * reference * felt),
            spurious_n: excess.max(0.0).sqrt(),
        }
    }
}

/// Plays a program, and compares what is felt with the reference.
///
/// The rows of the simulation are not recorded. The program must have no stream.
pub fn felt_error(program: &Program, simulation: &Simulation) -> Result<FeltError, PlayError> {
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &simulation.rig, simulation.stroke.clone(), simulation.seed)?;
    let comparison = RefCell::new(Comparison::new(program, simulation.rig.board.tick_hz));
    {
        let link = SimLink::new(rig, Recorder::idle()).observed(|record| comparison.borrow_mut().add(record));
        let mut device = Device::connect(link)?;
        start(&mut device, program, &mut |_| {})?;
        device.wait(Duration::from_secs_f64(simulation.seconds), &mut |_| {})?;
        device.stop()?;
    }
    let Comparison { reference_n, felt_n, .. } = comparison.into_inner();
    Ok(FeltError::of(&reference_n, &felt_n))
}

/// Collects the frictions of a play.
struct Comparison {
    reference: FingerReference,
    tick_hz: f64,
    ticks_per_sample: u32,
    ticks: u32,
    /// Sums since the last sample.
    sums_n: [f64; 2],
    reference_n: Vec<f64>,
    felt_n: Vec<f64>,
}

impl Comparison {
    fn new(program: &Program, tick_hz: u32) -> Self {
        Self {
            reference: FingerReference::new(program, tick_hz),
            tick_hz: f64::from(tick_hz),
            ticks_per_sample: (tick_hz / SAMPLE_HZ).max(1),
            ticks: 0,
            sums_n: [0.0; 2],
            reference_n: Vec::new(),
            felt_n: Vec::new(),
        }
    }

    fn add(&mut self, record: &TickRecord) {
        let felt = &record.felt;
        let total_n = self.reference.follow(record);
        if felt.finger.is_none() {
            return;
        }
        let [reference_n, felt_n] = &mut self.sums_n;
        *reference_n += total_n - felt.natural_friction_n;
        *felt_n += felt.electric_friction_n;
        self.ticks += 1;
        if self.ticks.is_multiple_of(self.ticks_per_sample) {
            let per_tick = 1.0 / f64::from(self.ticks_per_sample);
            if f64::from(self.ticks) > SETTLING_S * self.tick_hz {
                self.reference_n.push(*reference_n * per_tick);
                self.felt_n.push(*felt_n * per_tick);
            }
            self.sums_n = [0.0; 2];
        }
    }
}
