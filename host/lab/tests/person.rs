//! People and their recordings, drawn from a seed: a generator that owes nothing to the fit but the contact model, and
//! that can break the model's law.

use std::f64::consts::{PI, TAU};

use frixel_lab::fit::Row;
use frixel_model::{Contact, Finger};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// Sampling rate of the force sensor, in Hz.
const SAMPLE_HZ: f64 = 1000.0;
/// Octave-spaced parts of the 1/f noise: corner frequencies from 500 Hz down to 8 mHz.
const NOISE_OCTAVES: usize = 17;

/// How attraction depends on voltage and load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Law {
    /// Eqs. (43), (21).
    Contact,
    /// The same attraction at 150 V under the mean load, and these exponents of voltage and load.
    Power { voltage: f64, load: f64 },
}

/// A person who slides a finger over a screen.
#[derive(Clone, Debug)]
pub(super) struct Person {
    pub(super) friction_coefficient: f64,
    /// Effective gap of skin and coating together, in metres.
    pub(super) gap_m: f64,
    pub(super) load_n: f64,
    pub(super) law: Law,
    /// Exponent of the friction coefficient over the load.
    pub(super) coefficient_exponent: f64,
    /// Part by which the friction coefficient grows from the first to the last stroke.
    pub(super) drift: f64,
    /// Noise of friction over 10 to 1000 Hz, in newtons rms, per newton of natural friction.
    pub(super) noise_share: f64,
    /// Standard deviation of the load within strokes, as a part of the load.
    pub(super) load_share: f64,
    pub(super) seed: u64,
}

/// How a recording is made.
#[derive(Clone, Debug)]
pub(super) struct Protocol {
    pub(super) strokes: usize,
    pub(super) stroke_s: f64,
    pub(super) length_mm: f64,
    pub(super) voltages_v_rms: Vec<f64>,
}

impl Default for Protocol {
    /// 58 s of strokes that reach 82 mm/s.
    fn default() -> Self {
        Self { strokes: 36, stroke_s: 1.6, length_mm: 70.0, voltages_v_rms: vec![75.0, 106.0, 150.0] }
    }
}

pub(super) struct Random {
    generator: Pcg64,
}

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self { generator: Pcg64::seed_from_u64(seed) }
    }

    pub(super) fn uniform(&mut self) -> f64 {
        (self.generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Box and Muller's method.
    pub(super) fn gaussian(&mut self) -> f64 {
        let (u, v) = (1.0 - self.uniform(), self.uniform());
        (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
    }
}

impl Person {
    /// The example finger of the notes, with every effect.
    pub(super) fn example(seed: u64) -> Self {
        Self {
            friction_coefficient: 0.5,
            gap_m: 5e-6,
            load_n: 0.5,
            law: Law::Contact,
            coefficient_exponent: 0.0,
            drift: 0.0,
            noise_share: 4.5e-3 / 0.265,
            load_share: 22e-3 / 0.53,
            seed,
        }
    }

    /// A person of a population: gaps of 3.5 to 10 um, friction coefficients of 0.25 to 1, loads of 0.25 to 0.8 N.
    pub(super) fn drawn(seed: u64) -> Self {
        let mut random = Random::new(seed ^ 0x5eed);
        let gap_m = 3.5e-6 * (10.0_f64 / 3.5).powf(random.uniform());
        Self {
            friction_coefficient: 0.25 * 4.0_f64.powf(random.uniform()),
            gap_m,
            load_n: random.between(0.25, 0.8),
            coefficient_exponent: random.between(-0.3, 0.3),
            drift: random.between(-0.06, 0.06),
            ..Self::example(seed)
        }
    }

    /// The same person with a gap at which 150 V rms adds this share of natural friction.
    pub(super) fn with_gain(mut self, gain: f64) -> Self {
        let law = std::mem::replace(&mut self.law, Law::Contact);
        // The attraction falls with the gap: each step halves what is left of 1 to 20 um.
        let (mut thin_m, mut thick_m) = (1e-6, 20e-6);
        for _ in 0..50 {
            self.gap_m = 0.5 * (thin_m + thick_m);
            if self.attraction_n(150.0, self.load_n) > gain * self.load_n {
                thin_m = self.gap_m;
            } else {
                thick_m = self.gap_m;
            }
        }
        Self { law, ..self }
    }

    /// Attraction under a load, in newtons.
    pub(super) fn attraction_n(&self, voltage_v_rms: f64, load_n: f64) -> f64 {
        let finger = Finger { radius_m: 8e-3, stiffness_pa_per_m: 1.8e7, friction_coefficient: 1.0 };
        let contact = Contact::new(&finger, self.gap_m).unwrap();
        let at = |volts, load_n| contact.under_load(load_n).unwrap().electric_friction_n(volts);
        match self.law {
            Law::Contact => at(voltage_v_rms, load_n),
            Law::Power { voltage, load } => {
                let by_voltage = (voltage_v_rms / 150.0_f64).powf(voltage);
                at(150.0, self.load_n) * by_voltage * (load_n / self.load_n).powf(load)
            }
        }
    }

    /// The mean friction coefficient of the recording under a load, and what 150 V rms adds to friction, in newtons.
    pub(super) fn truth(&self, load_n: f64) -> (f64, f64) {
        let coefficient = self.coefficient(load_n) * (1.0 + 0.5 * self.drift);
        (coefficient, coefficient * self.attraction_n(150.0, load_n))
    }

    /// Friction coefficient under a load, before it drifts.
    pub(super) fn coefficient(&self, load_n: f64) -> f64 {
        self.friction_coefficient * (load_n / self.load_n).powf(self.coefficient_exponent)
    }

    /// Records the strokes of a protocol.
    pub(super) fn record(&self, protocol: &Protocol) -> Vec<Row> {
        let mut random = Random::new(self.seed);
        let mut noise = Noise::new(self.noise_share * self.friction_coefficient * self.load_n, &mut random);
        let (mut rows, mut time_s) = (Vec::new(), 0.0);
        for stroke in 0..protocol.strokes {
            let voltage_v_rms = protocol.voltages_v_rms[stroke % protocol.voltages_v_rms.len()];
            let mean_load_n = self.load_n * (1.0 + 0.03 * random.gaussian());
            let drift = 1.0 + self.drift * stroke as f64 / protocol.strokes as f64;
            let mut load = Wander::new(mean_load_n * self.load_share, &mut random);
            let (mut is_on, mut left_s, mut electric_n) = (false, 0.0, 0.0);
            for sample in 0..(protocol.stroke_s * SAMPLE_HZ) as u32 {
                let part = f64::from(sample) / (protocol.stroke_s * SAMPLE_HZ);
                let speed_mm_s = protocol.length_mm / protocol.stroke_s * 30.0 * (part * (1.0 - part)).powi(2);
                if left_s <= 0.0 {
                    is_on = !is_on;
                    left_s = random.between(0.02, 0.03);
                }
                left_s -= 1.0 / SAMPLE_HZ;
                let voltage = if is_on { voltage_v_rms } else { 0.0 };
                let load_n = mean_load_n + load.step(&mut random);
                let coefficient = drift * self.coefficient(load_n);
                let target_n = coefficient * self.attraction_n(voltage, load_n);
                electric_n += (target_n - electric_n) * (1.0 - (-speed_mm_s / SAMPLE_HZ / 11.5e-3).exp());
                let natural_n = coefficient * load_n + noise.step(&mut random);
                let sliding = (1.0 - (-speed_mm_s / 1.0).exp()).clamp(0.0, 1.0);
                rows.push(Row {
                    number: rows.len() as u64 + 2,
                    voltage_v_rms: voltage,
                    normal_force_n: load_n + 1e-3 * random.gaussian(),
                    friction_n: sliding * (natural_n + electric_n) + 1e-3 * random.gaussian(),
                    time_s: Some(time_s),
                    stroke: Some((stroke + 1).to_string()),
                    speed_mm_s: Some(speed_mm_s),
                    is_simulated: false,
                });
                time_s += 1.0 / SAMPLE_HZ;
            }
            time_s += 0.2;
        }
        rows
    }
}

/// Noise of power spectrum 1/f: a sum of first-order processes of equal power, an octave apart.
struct Noise {
    parts: Vec<(f64, f64)>,
    part_sd_n: f64,
}

impl Noise {
    /// Noise with this rms between 10 and 1000 Hz, which are 6.6 octaves.
    fn new(band_rms_n: f64, random: &mut Random) -> Self {
        let part_sd_n = band_rms_n / 100.0_f64.log2().sqrt();
        let corner_hz = |part: usize| 500.0 / 2.0_f64.powi(part as i32);
        let parts = (0..NOISE_OCTAVES).map(|part| {
            let kept = (-TAU * corner_hz(part) / SAMPLE_HZ).exp();
            (kept, part_sd_n * random.gaussian())
        });
        Self { parts: parts.collect(), part_sd_n }
    }

    fn step(&mut self, random: &mut Random) -> f64 {
        for (kept, value) in &mut self.parts {
            *value = *kept * *value + (1.0 - *kept * *kept).sqrt() * self.part_sd_n * random.gaussian();
        }
        self.parts.iter().map(|(_, value)| value).sum()
    }
}

/// A load that wanders below 2 Hz.
struct Wander {
    sd_n: f64,
    value_n: f64,
}

impl Wander {
    fn new(sd_n: f64, random: &mut Random) -> Self {
        Self { sd_n, value_n: sd_n * random.gaussian() }
    }

    fn step(&mut self, random: &mut Random) -> f64 {
        let kept = (-4.0 * PI / SAMPLE_HZ).exp();
        self.value_n = kept * self.value_n + (1.0 - kept * kept).sqrt() * self.sd_n * random.gaussian();
        self.value_n
    }
}
