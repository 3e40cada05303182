//! Tests that no direct current flows for any envelope.

use frixel_model::Carrier as Edges;
use proptest::prelude::*;

use super::*;

const WAVEFORMS: &[Waveform] =
    if cfg!(feature = "sine-carrier") { &[Waveform::Square, Waveform::Sine] } else { &[Waveform::Square] };

fn timing(waveform: Waveform, half_period_ticks: u32) -> CarrierTiming {
    CarrierTiming::new(waveform, half_period_ticks, 100.0, DacCode::from_bits(20_000))
}

proptest! {
    /// Amplitudes that follow the carrier are the worst case: half waves of one sign are large, and of the other small.
    /// After any of them, the carrier of a constant envelope is nominal from the third period on.
    #[test]
    fn the_integral_stays_within_a_half_period_at_full_voltage(
        waveform in proptest::sample::select(WAVEFORMS),
        half_period_ticks in 4_u32..80,
        seed_amplitudes in proptest::collection::vec(0.0_f32..200.0, 1..200),
        hold_ticks in 1_usize..200,
        resonant in any::<bool>(),
    ) {
        let timing = timing(waveform, half_period_ticks);
        let mut carrier = Carrier::new(&timing);
        let mut integral = 0_i64;
        let full = i64::from(timing.integral_max.to_bits());
        for i in 0..4000_usize {
            let half = i as u32 / half_period_ticks;
            let amplitude = if resonant { if half.is_multiple_of(2) { 200.0 } else { 3.0 } }
                else { seed_amplitudes[i / hold_ticks % seed_amplitudes.len()] };
            if i % 1013 == 0 { carrier.reset_to_zero(&timing); }
            integral += i64::from(carrier.next(amplitude, &timing, 0).bits());
            prop_assert!(integral.abs() <= full, "{integral} after {i} ticks, {full} allowed");
        }
        let codes = codes(&mut carrier, &timing, seed_amplitudes[0], 8 * half_period_ticks);
        let half_waves: Vec<&[i32]> = codes.chunks(half_period_ticks as usize).skip(4).collect();
        for pair in half_waves.windows(2) {
            let opposite: Vec<i32> = pair[0].iter().map(|code| -code).collect();
            prop_assert_eq!(&opposite, pair[1]);
        }
        // The codes are those of a new carrier.
        let sorted = |half_wave: &[i32]| {
            let mut magnitudes: Vec<i32> = half_wave.iter().map(|code| code.abs()).collect();
            magnitudes.sort_unstable();
            magnitudes
        };
        let fresh = fresh_codes(&timing, seed_amplitudes[0], half_period_ticks);
        prop_assert_eq!(sorted(half_waves[0]), sorted(&fresh));
    }
}

/// Runs a carrier, and returns its codes.
fn codes(carrier: &mut Carrier, timing: &CarrierTiming, envelope_v_rms: f32, ticks: u32) -> Vec<i32> {
    (0..ticks).map(|tick| i32::from(carrier.next(envelope_v_rms, timing, tick).bits())).collect()
}

/// The codes of a new carrier in a half period after the first, which may begin in the middle.
fn fresh_codes(timing: &CarrierTiming, envelope_v_rms: f32, half_period_ticks: u32) -> Vec<i32> {
    let codes = codes(&mut Carrier::new(timing), timing, envelope_v_rms, 5 * half_period_ticks);
    codes[4 * half_period_ticks as usize..].to_vec()
}

/// Includes conversions that no session computes, and envelopes that no table returns.
#[test]
fn no_envelope_or_conversion_exceeds_the_largest_code() {
    let numbers = [0.0, 1.0, -1.0, 1e3, -1e3, f32::MAX, f32::MIN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    for (envelope_v_rms, codes_per_v_rms) in numbers.into_iter().flat_map(|one| numbers.map(|other| (one, other))) {
        for (waveform, code_max) in [Waveform::Square, Waveform::Sine]
            .into_iter()
            .flat_map(|waveform| [-5, 0, 300].map(|code| (waveform, code)))
        {
            let timing = CarrierTiming::new(waveform, 20, codes_per_v_rms, DacCode::from_bits(code_max));
            let mut carrier = Carrier::new(&timing);
            for tick in 0..60 {
                let code = carrier.next(envelope_v_rms, &timing, tick).bits();
                assert!(code.abs() <= code_max.max(0), "{code}: {envelope_v_rms} V, {codes_per_v_rms} codes a volt");
            }
        }
    }
}

#[test]
fn the_integral_may_reach_one_half_wave_at_full_voltage() {
    for half_period_ticks in [4, 5, 20, 80] {
        let square = timing(Waveform::Square, half_period_ticks);
        assert_eq!(square.integral_max.to_bits(), 20_000 * half_period_ticks as i32);
        let sine = timing(Waveform::Sine, half_period_ticks);
        let half_wave: f64 = (0..1000).map(|i| ((f64::from(i) + 0.5) / 1000.0 * core::f64::consts::PI).sin()).sum();
        let expected = 20.0 * f64::from(half_period_ticks) * half_wave;
        assert!(
            (f64::from(sine.integral_max.to_bits()) - expected).abs() < 2.0,
            "{} is not {expected}",
            sine.integral_max
        );
    }
}

#[test]
fn a_carrier_starts_a_quarter_period_before_an_edge() {
    for (half_period_ticks, first_edge) in [(20, 10), (21, 11), (5, 3), (4, 2)] {
        let timing = timing(Waveform::Square, half_period_ticks);
        let codes = codes(&mut Carrier::new(&timing), &timing, 1.0, 2 * half_period_ticks);
        assert_eq!(codes.iter().position(|code| *code < 0), Some(first_edge), "{half_period_ticks}");
    }
}

/// After any drive, a restart reverses the remaining charge.
#[test]
fn a_restarted_carrier_moves_the_integral_towards_zero() {
    let timing = timing(Waveform::Square, 20);
    for (ticks, first_sign) in [(0, 1), (7, -1), (10, -1), (20, 1), (25, 1), (40, 1)] {
        let mut carrier = Carrier::new(&timing);
        let before: i32 = codes(&mut carrier, &timing, 50.0, ticks).iter().sum();
        assert_eq!(first_sign, if before > 0 { -1 } else { 1 }, "the integral is {before} after {ticks} ticks");
        carrier.reset_to_zero(&timing);
        let after = codes(&mut carrier, &timing, 50.0, 20);
        let first_edge = after.iter().position(|code| code.signum() != first_sign);
        assert_eq!(first_edge, Some(10), "{ticks}: a quarter period from the edge");
    }
}

#[test]
fn a_faster_carrier_takes_its_edge_no_later_than_its_own_half_period() {
    let slow = timing(Waveform::Square, 20);
    let fast = timing(Waveform::Square, 4);
    let mut carrier = Carrier::new(&slow);
    codes(&mut carrier, &slow, 1.0, 11); // one tick after an edge, 19 before the next
    carrier.retime(&fast);
    let after = codes(&mut carrier, &fast, 1.0, 12);
    assert_eq!(
        after.iter().map(|code| code.signum()).collect::<Vec<_>>(),
        [-1, -1, -1, -1, 1, 1, 1, 1, -1, -1, -1, -1]
    );
}

#[test]
fn a_slower_carrier_finishes_the_half_period_under_way() {
    let slow = timing(Waveform::Square, 20);
    let fast = timing(Waveform::Square, 4);
    let mut carrier = Carrier::new(&fast);
    codes(&mut carrier, &fast, 1.0, 3); // one tick after an edge, 3 before the next
    carrier.retime(&slow);
    let after = codes(&mut carrier, &slow, 1.0, 24);
    let positive = after.iter().filter(|code| **code > 0).count();
    assert_eq!((after.iter().position(|code| *code > 0), positive), (Some(3), 20));
}

/// Before its first scene, a board has no carrier.
#[test]
fn after_no_carrier_the_next_one_begins_at_its_crest() {
    for waveform in WAVEFORMS {
        let timing = timing(*waveform, 20);
        let mut carrier = Carrier::new(&CarrierTiming::ZERO_OUTPUT);
        carrier.reset_to_zero(&CarrierTiming::ZERO_OUTPUT);
        carrier.retime(&timing);
        let fresh = codes(&mut Carrier::new(&timing), &timing, 50.0, 80);
        assert_eq!(codes(&mut carrier, &timing, 50.0, 80), fresh, "{waveform:?}");
    }
}

/// Every positive half wave is large and every negative one small, so that the integral drifts to its limit. There the
/// half period ends early, which is counted, and a whole one begins.
#[test]
fn an_early_edge_is_counted_with_its_tick() {
    let timing = timing(Waveform::Square, 20);
    let mut carrier = Carrier::new(&timing);
    let (mut integral, mut early_edges, mut last_early_tick, mut left_ticks, mut sign) = (0, 0, 0, 10, 1);
    for tick in 0..4000 {
        let envelope_v_rms = if sign > 0 { 200.0 } else { 3.0 };
        let wanted = sign * (100.0 * envelope_v_rms) as i32;
        let code = i32::from(carrier.next(envelope_v_rms, &timing, tick).bits());
        if (integral + wanted).abs() > 20 * 20_000 {
            assert_eq!(code, -wanted, "tick {tick}: the integral is {integral}");
            (sign, left_ticks) = (-sign, 20);
            early_edges += 1;
            last_early_tick = tick;
        } else {
            assert_eq!(code, wanted, "tick {tick}: the integral is {integral}");
        }
        integral += code;
        left_ticks -= 1;
        if left_ticks == 0 {
            (sign, left_ticks) = (-sign, 20);
        }
        assert_eq!((carrier.early_edges(), carrier.last_early_tick()), (early_edges, last_early_tick));
    }
    assert!(early_edges > 10, "{early_edges}");
}

/// A half wave that begins early is whole: from zero, over its crest, to zero.
#[cfg(feature = "sine-carrier")]
#[test]
fn a_sine_begins_a_whole_half_wave_at_an_early_edge() {
    let timing = timing(Waveform::Sine, 20);
    let mut carrier = Carrier::new(&timing);
    // Steps up in the negative half waves and down in the positive ones, until the integral is at its limit.
    let mut tick = 0;
    while carrier.early_edges() == 0 {
        carrier.next(if carrier.sign > 0 { 3.0 } else { 200.0 }, &timing, tick);
        tick += 1;
    }
    let after = codes(&mut carrier, &timing, 200.0, 39);
    let half_wave = |i: i32| 20_000.0 * (f64::from(i) / 20.0 * core::f64::consts::PI).sin();
    for (i, code) in (1..).zip(after) {
        assert!((f64::from(code) - half_wave(i)).abs() <= 1.0, "{code} {i} ticks after the early edge");
    }
    assert_eq!(carrier.early_edges(), 1);
}

/// A new scene may allow a smaller integral than has accumulated: every code then moves the integral towards zero, with
/// a sixteenth of the envelope.
#[test]
fn an_integral_beyond_a_new_limit_only_falls_and_slowly() {
    for start_ticks in [10, 30] {
        let wide = timing(Waveform::Square, 20);
        let narrow = CarrierTiming::new(Waveform::Square, 4, 100.0, DacCode::from_bits(2_000));
        let mut carrier = Carrier::new(&wide);
        let mut integral: i32 = codes(&mut carrier, &wide, 200.0, start_ticks).iter().sum();
        assert!(integral.abs() > 10 * narrow.integral_max.to_bits(), "{integral}");
        carrier.retime(&narrow);
        let mut edges = 0;
        let mut last_sign = 0;
        for tick in 0..2_000 {
            let code = i32::from(carrier.next(20.0, &narrow, tick).bits());
            let beyond = integral.abs() - narrow.integral_max.to_bits();
            if beyond > 0 {
                assert!((integral + code).abs() < integral.abs(), "{integral} and {code}");
            }
            // A whole code is output only if it moves the integral within its limit.
            assert!(code.abs() == 2_000 || code.abs() == 125 && beyond > 0, "{integral} and {code}");
            assert!(code.abs() == 125 || beyond <= 2_000, "{integral} and {code}");
            integral += code;
            edges += u32::from(code.signum() != last_sign && last_sign != 0);
            last_sign = code.signum();
        }
        assert!(integral.abs() <= narrow.integral_max.to_bits(), "{integral}");
        assert!(edges > 10, "it alternates again");
    }
}

/// Rounding to the nearest code keeps small voltages.
#[test]
fn codes_are_rounded_to_the_nearest() {
    let timing = timing(Waveform::Square, 20);
    for (envelope_v_rms, expected) in [(0.004, 0), (0.006, 1), (0.014, 1), (0.016, 2), (123.456, 12_346)] {
        assert_eq!(codes(&mut Carrier::new(&timing), &timing, envelope_v_rms, 1), [expected]);
    }
}

/// One crest in a half period, in its middle, and no code at an edge.
#[cfg(feature = "sine-carrier")]
#[test]
fn a_sine_is_a_sine() {
    let timing = timing(Waveform::Sine, 20);
    let codes = codes(&mut Carrier::new(&timing), &timing, 100.0, 80);
    for (tick, code) in codes.iter().enumerate() {
        let turns = (tick as f64 - 10.0 + 20.0) / 40.0;
        let expected = 10_000.0 * (turns * core::f64::consts::TAU).sin();
        assert!((f64::from(*code) - expected).abs() <= 1.0, "tick {tick}: {code} is not {expected}");
    }
}

/// The electrode has the rms voltage of the envelope, behind the lag of the simulated amplifier and behind those of
/// `docs/board/hardware.md`: 20 kHz, and 68 kOhm before 0.53 nF. The single lag of a board's limits replaces both for
/// half periods of six time constants or more.
#[test]
fn an_electrode_behind_two_lags_has_the_voltage_of_the_envelope() {
    let simulator = (0.0, 20e-6, &[4, 5, 7, 10, 15, 20, 21, 40][..]);
    let board = (8e-6, 36e-6, &[9, 10, 15, 20, 21][..]);
    for (amplifier_s, series_s, half_periods_ticks) in [simulator, board] {
        for (waveform, half_period_ticks) in
            WAVEFORMS.iter().flat_map(|form| half_periods_ticks.iter().map(|half| (*form, *half)))
        {
            let error = mean_square_error(waveform, half_period_ticks, amplifier_s, series_s);
            assert!(error.abs() < 5e-3, "{waveform:?} of {half_period_ticks} ticks behind {series_s} s: {error}");
        }
    }
}

/// Relative error of the electrode's mean square at 100 V rms, from the fifth half period on.
fn mean_square_error(waveform: Waveform, half_period_ticks: u32, amplifier_s: f64, series_s: f64) -> f64 {
    const STEPS: u32 = 500;
    let step_s = 25e-6 / f64::from(STEPS);
    let both_s = amplifier_s + series_s;
    let edges = Edges {
        waveform,
        half_period_s: 25e-6 * half_period_ticks as f32,
        half_period_ticks,
        edge_time_constant_s: (both_s - amplifier_s * series_s / both_s) as f32,
    };
    let timing = CarrierTiming::new(waveform, half_period_ticks, 100.0 * edges.peak_per_rms(), DacCode::MAX);
    let (mut amplifier_v, mut electrode_v, mut sum_v2) = (0.0, 0.0, 0.0);
    for (tick, code) in (0..).zip(codes(&mut Carrier::new(&timing), &timing, 100.0, 6 * half_period_ticks)) {
        let target_v = 0.01 * f64::from(code);
        for _ in 0..STEPS {
            amplifier_v += (target_v - amplifier_v) * (step_s / amplifier_s).min(1.0);
            electrode_v += (amplifier_v - electrode_v) * step_s / series_s;
            sum_v2 += if tick < 4 * half_period_ticks { 0.0 } else { electrode_v * electrode_v };
        }
    }
    sum_v2 / f64::from(2 * half_period_ticks * STEPS) / 1e4 - 1.0
}
