//! The carrier under random envelopes, seen from the electrode: behind the lags of an amplifier and a series resistor.

use frixel_model::Carrier as Edges;
use frixel_testkit::Random;

use super::*;

const TICK_S: f64 = 25e-6;
const FULL_SCALE_V_PEAK: f32 = 250.0;
const VOLTAGE_MAX_V_RMS: f32 = 130.0;
/// Lowest checked voltage, V rms. Below it, half a step of the DAC is more than 0.1 % of the mean square.
const CHECKED_FROM_V_RMS: f32 = 8.0;
/// Ticks per carrier; a million in all.
const TICKS_PER_CARRIER: u32 = 40_000;

/// Time constants of amplifier and series resistor, in seconds.
#[derive(Clone, Copy, Debug)]
struct Lags {
    amplifier_s: f64,
    series_s: f64,
}

impl Lags {
    /// The simulated amplifier, whose time constant is that of the electrode. The other one is too short to matter.
    const SIMULATOR: Self = Self { amplifier_s: 1e-9, series_s: 20e-6 };
    /// `docs/board/hardware.md`: 20 kHz, and 68 kOhm before 0.53 nF.
    const G474: Self = Self { amplifier_s: 8e-6, series_s: 36e-6 };

    /// The board's limit of that name: the single lag with the same loss of mean square.
    fn edge_time_constant_s(self) -> f64 {
        let both_s = self.amplifier_s + self.series_s;
        both_s - self.amplifier_s * self.series_s / both_s
    }
}

/// The electrode, and the amplifier's output.
struct Electrode {
    lags: Lags,
    amplifier_v: f64,
    electrode_v: f64,
}

impl Electrode {
    /// Holds `target_v` for a tick, and returns the mean of the squared electrode voltage over it.
    ///
    /// The electrode follows `target + a e^(-t/amplifier) + b e^(-t/series)`.
    fn mean_square_v2(&mut self, target_v: f64) -> f64 {
        let Lags { amplifier_s, series_s } = self.lags;
        let mean = |time_constant_s: f64| time_constant_s / TICK_S * (1.0 - (-TICK_S / time_constant_s).exp());
        let a_v = (self.amplifier_v - target_v) * amplifier_s / (amplifier_s - series_s);
        let b_v = self.electrode_v - target_v - a_v;
        let (a_left, b_left) = ((-TICK_S / amplifier_s).exp(), (-TICK_S / series_s).exp());
        self.amplifier_v = target_v + (self.amplifier_v - target_v) * a_left;
        self.electrode_v = target_v + a_v * a_left + b_v * b_left;
        let both_s = amplifier_s * series_s / (amplifier_s + series_s);
        target_v * target_v
            + 2.0 * target_v * (a_v * mean(amplifier_s) + b_v * mean(series_s))
            + a_v * a_v * mean(amplifier_s / 2.0)
            + b_v * b_v * mean(series_s / 2.0)
            + 2.0 * a_v * b_v * mean(both_s)
    }
}

fn random_voltage_v_rms(random: &mut Random) -> f32 {
    let between = random.between(0.0, VOLTAGE_MAX_V_RMS);
    random.pick([VOLTAGE_MAX_V_RMS, 0.0, between, between])
}

/// An envelope in random segments.
///
/// It holds, jumps or ramps to another voltage, resonates with the carrier, which is the worst case for the integral,
/// or is absent, with zero output as without a finger.
struct Envelopes {
    random: Random,
    half_period_ticks: u32,
    left_ticks: u32,
    segment: Segment,
    voltage_v_rms: f32,
}

#[derive(Clone, Copy)]
enum Segment {
    Hold,
    Ramp { end_v_rms: f32, step_v: f32 },
    Resonant { voltages_v_rms: [f32; 2] },
    ZeroOutput,
}

impl Envelopes {
    /// The envelope at the next tick; `None` where the output is zero.
    fn next(&mut self) -> Option<f32> {
        if self.left_ticks == 0 {
            self.begin_piece();
        }
        self.left_ticks -= 1;
        match self.segment {
            Segment::Hold => {}
            Segment::Ramp { end_v_rms, step_v } => {
                self.voltage_v_rms += (end_v_rms - self.voltage_v_rms).clamp(-step_v, step_v);
            }
            Segment::Resonant { voltages_v_rms } => {
                let half_period = self.left_ticks / self.half_period_ticks;
                self.voltage_v_rms = voltages_v_rms[half_period as usize % 2];
            }
            Segment::ZeroOutput => {
                self.voltage_v_rms = 0.0;
                return None;
            }
        }
        Some(self.voltage_v_rms)
    }

    fn begin_piece(&mut self) {
        self.left_ticks = 1 + self.random.below(12 * self.half_period_ticks);
        self.segment = match self.random.below(8) {
            0 => Segment::ZeroOutput,
            1 => Segment::Resonant {
                voltages_v_rms: [random_voltage_v_rms(&mut self.random), random_voltage_v_rms(&mut self.random)],
            },
            2 | 3 => Segment::Ramp {
                end_v_rms: random_voltage_v_rms(&mut self.random),
                step_v: self.random.pick([0.1, 1.0, 10.0, 50.0]),
            },
            _ => {
                self.voltage_v_rms = random_voltage_v_rms(&mut self.random);
                Segment::Hold
            }
        };
    }
}

/// Checks [`TICKS_PER_CARRIER`] ticks of a carrier. Returns the number of ticks in which the mean square was checked.
fn check(waveform: Waveform, half_period_ticks: u32, lags: Lags, seed: u32) -> u32 {
    let edges = Edges {
        waveform,
        half_period_s: (f64::from(half_period_ticks) * TICK_S) as f32,
        half_period_ticks,
        edge_time_constant_s: lags.edge_time_constant_s() as f32,
    };
    let peak_per_rms = edges.peak_per_rms();
    let codes_per_v = f32::from(i16::MAX) / FULL_SCALE_V_PEAK;
    let code_max = DacCode::from_bits((VOLTAGE_MAX_V_RMS * peak_per_rms * codes_per_v).ceil() as i16);
    let timing = CarrierTiming::new(waveform, half_period_ticks, peak_per_rms * codes_per_v, code_max);
    let mut carrier = Carrier::new(&timing);
    let mut electrode = Electrode { lags, amplifier_v: 0.0, electrode_v: 0.0 };
    let mut envelopes = Envelopes {
        random: Random::new(u64::from(seed)),
        half_period_ticks,
        left_ticks: 0,
        segment: Segment::Hold,
        voltage_v_rms: 0.0,
    };

    let period_ticks = 2 * half_period_ticks as usize;
    let (mut codes, mut mean_squares_v2) = (Vec::new(), Vec::new());
    let (mut integral, mut envelope_v_rms, mut changed_tick, mut sign, mut edge_tick) = (0_i64, None, 0, 0, 0);
    let mut checked_ticks = 0;
    for tick in 0..TICKS_PER_CARRIER as usize {
        let next_v_rms = envelopes.next();
        if next_v_rms != envelope_v_rms {
            (envelope_v_rms, changed_tick) = (next_v_rms, tick);
        }
        let code = if let Some(envelope_v_rms) = envelope_v_rms {
            carrier.next(envelope_v_rms, &timing, tick as u32)
        } else {
            carrier.reset_to_zero(&timing);
            DacCode::ZERO
        };
        let code = i64::from(code.bits());
        codes.push(code);
        mean_squares_v2.push(electrode.mean_square_v2(code as f64 / f64::from(codes_per_v)));
        let here = || format!("{waveform:?} of {half_period_ticks} ticks, {lags:?}, seed {seed}, tick {tick}");

        integral += code;
        assert!(integral.abs() <= i64::from(timing.integral_max.to_bits()), "{integral}: {}", here());

        let is_edge = code.signum() == -sign && sign != 0;
        let half_ticks = tick - edge_tick;
        if is_edge {
            edge_tick = tick;
        }
        if code != 0 {
            sign = code.signum();
        }
        let Some(envelope_v_rms) = envelope_v_rms.filter(|_| tick >= changed_tick + 2 * period_ticks) else { continue };
        assert!(!is_edge || half_ticks == half_period_ticks as usize, "{half_ticks} ticks: {}", here());
        if tick < changed_tick + 3 * period_ticks {
            continue;
        }
        assert_eq!(codes[codes.len() - period_ticks..].iter().sum::<i64>(), 0, "{}", here());
        if envelope_v_rms >= CHECKED_FROM_V_RMS {
            let period = &mean_squares_v2[mean_squares_v2.len() - period_ticks..];
            let mean_square_v2 = period.iter().sum::<f64>() / period_ticks as f64;
            let error = mean_square_v2 / f64::from(envelope_v_rms).powi(2) - 1.0;
            assert!(error.abs() < 5e-3, "{error} at {envelope_v_rms} V rms: {}", here());
            checked_ticks += 1;
        }
    }
    checked_ticks
}

#[test]
fn the_carrier_of_a_constant_envelope_is_nominal_from_the_third_period_on() {
    let mut seed = 0;
    let mut checked_ticks = 0;
    let waveforms: &[Waveform] =
        if cfg!(feature = "sine-carrier") { &[Waveform::Square, Waveform::Sine] } else { &[Waveform::Square] };
    for waveform in waveforms {
        for (lags, half_periods_ticks) in [
            (Lags::SIMULATOR, &[4, 5, 7, 10, 15, 20, 21, 40][..]),
            // One lag stands for two from 6 of its time constants on.
            (Lags::G474, &[9, 10, 15, 20, 21]),
        ] {
            for half_period_ticks in half_periods_ticks {
                seed += 1;
                checked_ticks += check(*waveform, *half_period_ticks, lags, seed);
            }
        }
    }
    assert!(checked_ticks > seed * TICKS_PER_CARRIER / 20, "{checked_ticks} ticks had a constant envelope");
}
