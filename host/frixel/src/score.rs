//! Plays a trial, and records what was felt and what the reference was.

use frixel_felt::fidelity::{FidelitySample, SAMPLE_HZ};
use frixel_felt::recorder::FingerState;
use frixel_hil_sim::{RigConfig, TickRecord};
use frixel_lab::score::Trial;
use frixel_scene::Program;
use frixel_wire::fault::Flags;

use crate::finger_reference::FingerReference;
use crate::player::{Simulation, SimulationError, simulate_observed};

/// Plays a trial on a simulated board, for [`Score::of`](frixel_lab::score::Score::of); returns a sample for every
/// quarter of a millisecond.
pub fn samples(program: &Program, rig: &RigConfig, trial: &Trial) -> Result<Vec<FidelitySample>, SimulationError> {
    let simulation = Simulation {
        rig: *rig,
        stroke: trial.stroke.clone(),
        seconds: trial.stroke.duration_s(),
        seed: trial.seed,
        ticks_per_row: u32::MAX,
    };
    let mut sampler = Sampler::new(program, rig.board.tick_hz);
    let rig = RigConfig { world: trial.world(rig.world), ..*rig };
    let simulation = Simulation { rig, ..simulation };
    let own_finger = trial.finger.map(|finger| finger.contact);
    simulate_observed(program, &simulation, own_finger, None, |record| sampler.add(record))?;
    Ok(sampler.samples)
}

/// Takes the mean of the ticks of a sample.
struct Sampler {
    ticks_per_sample: u32,
    reference: FingerReference,
    /// Whether the board has had a report of this touch.
    is_tracked: bool,
    ticks: u32,
    sum: FidelitySample,
    samples: Vec<FidelitySample>,
}

impl Sampler {
    fn new(program: &Program, tick_hz: u32) -> Self {
        Self {
            ticks_per_sample: (f64::from(tick_hz) / SAMPLE_HZ).round().max(1.0) as u32,
            reference: FingerReference::new(program, tick_hz),
            is_tracked: false,
            ticks: 0,
            sum: FidelitySample::default(),
            samples: Vec::new(),
        }
    }

    fn add(&mut self, record: &TickRecord) {
        let felt = &record.felt;
        let reference_n = self.reference.follow(record);
        let has_finger = !record.status.telemetry.flags.contains(Flags::NO_FINGER);
        self.is_tracked = felt.finger.is_some() && (self.is_tracked || has_finger);
        self.sum.reference_n += reference_n;
        self.sum.felt_n += felt.friction_n;
        self.sum.natural_n += felt.natural_friction_n;
        self.ticks += 1;
        if self.ticks == self.ticks_per_sample {
            let ticks = f64::from(self.ticks);
            let finger = felt.finger.filter(|_| self.is_tracked).map(|finger| FingerState {
                x_m: finger.x_m,
                y_m: finger.y_m,
                speed_m_per_s: finger.speed_m_per_s,
            });
            let FidelitySample { reference_n, felt_n, natural_n, .. } = self.sum;
            let [reference_n, felt_n, natural_n] = [reference_n, felt_n, natural_n].map(|sum_n| sum_n / ticks);
            self.samples.push(FidelitySample { finger, reference_n, felt_n, natural_n });
            (self.ticks, self.sum) = (0, FidelitySample::default());
        }
    }
}
