use frixel_session::Touch;

use super::{TouchConfig, TouchSource};
use crate::stroke::FingerState;

const TICK_HZ: u32 = 40_000;
/// The finger of these tests moves this far every tick, so that a noiseless report shows when it was sampled.
const STEP_M: f64 = 1e-6;
const SECONDS: u64 = 200;

fn finger(tick: u64) -> FingerState {
    FingerState { x_m: tick as f64 * STEP_M, y_m: 0.05, speed_m_per_s: STEP_M * f64::from(TICK_HZ) }
}

/// Returns every report of a source in `seconds` seconds, with the tick of its arrival.
fn reports(config: TouchConfig, seed: u64, seconds: u64) -> Vec<(u64, Touch)> {
    let mut source = TouchSource::new(&config, TICK_HZ, seed).unwrap();
    (0..seconds * u64::from(TICK_HZ))
        .filter_map(|tick| {
            source.tick(tick, Some(&finger(tick)));
            source.arrived().map(|touch| (tick, touch))
        })
        .collect()
}

fn place(touch: Touch) -> (f64, f64, u32) {
    match touch {
        Touch::Down { x_m, y_m, age_ticks } => (f64::from(x_m), f64::from(y_m), age_ticks),
        Touch::Up => panic!("the finger is down"),
    }
}

fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / values.len() as f64;
    (mean, variance.sqrt())
}

/// Returns the tick of the sample and the delay of every report of a source without noise.
fn samples_and_delays(config: TouchConfig, seconds: u64) -> Vec<(f64, f64)> {
    reports(TouchConfig { noise_rms_m: 0.0, ..config }, 5, seconds)
        .into_iter()
        .map(|(tick, touch)| {
            let sampled = place(touch).0 / STEP_M;
            (sampled, tick as f64 - sampled)
        })
        .collect()
}

#[test]
fn reports_come_at_the_rate_with_the_latency_and_the_jitter() {
    // Short enough for a place in `f32` to resolve the tick within a fifth.
    const SHORT_S: u64 = 40;
    let config = TouchConfig::default();
    let samples_and_delays = samples_and_delays(config, SHORT_S);
    let expected = SHORT_S as f64 * config.rate_hz;
    assert!((samples_and_delays.len() as f64 - expected).abs() <= 2.0, "{}", samples_and_delays.len());
    for pair in samples_and_delays.windows(2) {
        assert!((pair[1].0 - pair[0].0 - 400.0).abs() < 0.5, "samples are evenly spaced");
    }
    let delays: Vec<f64> = samples_and_delays.iter().map(|&(_, delay)| delay).collect();
    let (mean, deviation) = mean_and_deviation(&delays);
    // 4,000 reports: standard errors of 0.3 and 0.2 ticks. Cut at three deviations, 20 ticks of jitter are 19.73.
    assert!((mean - 400.0).abs() < 1.5, "latency {mean} ticks");
    assert!((deviation - 19.73).abs() < 1.0, "jitter {deviation} ticks");
    assert!(delays.iter().all(|delay| (delay - 400.0).abs() < 60.8), "jitter beyond three deviations");
}

#[test]
fn noise_is_that_of_the_configuration_in_each_axis_apart() {
    let config = TouchConfig { jitter_rms_s: 0.0, latency_s: 0.0, ..TouchConfig::default() };
    let errors: Vec<(f64, f64)> = reports(config, 5, SECONDS)
        .into_iter()
        .map(|(tick, touch)| {
            let (x_m, y_m, _) = place(touch);
            (x_m - finger(tick).x_m, y_m - 0.05)
        })
        .collect();
    assert_eq!(errors.len(), 20_000);
    let (x_errors_m, y_errors_m): (Vec<f64>, Vec<f64>) = errors.iter().copied().unzip();
    for errors_m in [&x_errors_m, &y_errors_m] {
        let (mean_m, deviation_m) = mean_and_deviation(errors_m);
        // Five standard errors.
        assert!(mean_m.abs() < 0.7e-6, "{mean_m}");
        assert!((deviation_m - 20e-6).abs() < 0.5e-6, "{deviation_m}");
    }
    let covariance = errors.iter().map(|(x_m, y_m)| x_m * y_m).sum::<f64>() / errors.len() as f64;
    assert!(covariance.abs() < 5.0 * 400e-12 / libm::sqrt(20_000.0), "{covariance}");
}

#[test]
fn reports_keep_their_order_and_never_precede_their_sample() {
    // Jitter of five periods with zero latency: half of the draws would come too early, and most out of order.
    let config = TouchConfig { latency_s: 0.0, jitter_rms_s: 50e-3, ..TouchConfig::default() };
    let samples_and_delays = samples_and_delays(config, 20);
    assert!(samples_and_delays.len() > 1900);
    for pair in samples_and_delays.windows(2) {
        assert!(pair[1].0 > pair[0].0, "out of order");
        assert!(pair[1].1 > -0.5, "before its sample");
    }
    let (_, deviation) = mean_and_deviation(&samples_and_delays.iter().map(|&(_, delay)| delay).collect::<Vec<_>>());
    assert!(deviation > 100.0, "no jitter to speak of: {deviation}");
}

#[test]
fn the_same_seed_gives_the_same_reports_and_another_has_its_own_noise_and_jitter() {
    let config = TouchConfig::default();
    assert_eq!(reports(config, 5, 5), reports(config, 5, 5));
    // The finger moves along x only, so y differs by noise alone; the spacing of reports differs by jitter alone.
    let noise = |seed| reports(config, seed, 5).iter().map(|&(_, touch)| place(touch).1).collect::<Vec<_>>();
    let spacing = |seed| reports(config, seed, 5).windows(2).map(|pair| pair[1].0 - pair[0].0).collect::<Vec<_>>();
    assert_ne!(noise(5)[..400], noise(6)[..400]);
    assert_ne!(spacing(5)[..400], spacing(6)[..400]);
}

#[test]
fn a_lift_is_reported_once_after_the_latency() {
    let config = TouchConfig { jitter_rms_s: 0.0, ..TouchConfig::default() };
    let mut source = TouchSource::new(&config, TICK_HZ, 5).unwrap();
    let (down, up) = (10_000, 20_000);
    let mut seen = Vec::new();
    for tick in 0..60_000 {
        let finger = (down..up).contains(&tick).then(|| finger(tick));
        source.tick(tick, finger.as_ref());
        seen.extend(source.arrived().map(|touch| (tick, touch)));
    }
    let first_tick = seen[0].0;
    assert!((down + 400..down + 800).contains(&first_tick), "first report at {first_tick}");
    let ups: Vec<u64> = seen.iter().filter(|(_, touch)| *touch == Touch::Up).map(|&(tick, _)| tick).collect();
    assert_eq!(ups.len(), 1);
    assert!((up + 400..up + 800).contains(&ups[0]), "lift at {}", ups[0]);
    assert_eq!(seen.last().unwrap().0, ups[0]);
    assert_eq!(seen.len(), 26);
}

/// Distances between the arrivals of a realistic source's reports, in report periods.
fn realistic_intervals(config: TouchConfig, seed: u64, seconds: u64) -> Vec<f64> {
    let reports = reports(config, seed, seconds);
    reports.windows(2).map(|pair| (pair[1].0 - pair[0].0) as f64 / 400.0).collect()
}

#[test]
fn a_realistic_source_has_the_double_intervals_and_the_gaps_of_the_recorded_strokes() {
    for seed in 1..=5 {
        let intervals = realistic_intervals(TouchConfig::REALISTIC, seed, SECONDS);
        let at_least_double = intervals.iter().filter(|interval| **interval >= 1.8).count() as f64;
        let share = at_least_double / intervals.len() as f64;
        assert!((0.04..=0.28).contains(&share), "{share}");
        // Both lost and bunched reports make double intervals; those of the bunched ones end with two reports.
        assert!((share - 0.15).abs() < 0.03, "{share}");
        let longest = intervals.iter().copied().fold(0.0, f64::max);
        assert!((5.0..=17.0).contains(&longest), "a gap of {longest} periods");
    }
}

#[test]
fn each_loss_can_be_switched_on_alone() {
    let lossy = |config| realistic_intervals(config, 5, SECONDS);
    let double = |intervals: &[f64]| {
        intervals.iter().filter(|interval| **interval >= 1.8).count() as f64 / intervals.len() as f64
    };
    let lost = lossy(TouchConfig { lost_share: 0.2, ..TouchConfig::IDEAL });
    assert!((double(&lost) - 0.2).abs() < 0.02, "{}", double(&lost));
    assert!(lost.iter().all(|interval| *interval > 0.5), "nothing is bunched");
    let bunched = lossy(TouchConfig { bunched_share: 0.1, ..TouchConfig::IDEAL });
    let together = bunched.iter().filter(|interval| **interval < 0.01).count() as f64 / bunched.len() as f64;
    assert!((together - 0.09).abs() < 0.02, "{together}");
    let paused = lossy(TouchConfig { pause_rate_hz: 0.5, pause_max_s: 0.14, ..TouchConfig::IDEAL });
    assert!(paused.iter().all(|interval| *interval < 15.5));
    let pauses = paused.iter().filter(|interval| **interval > 2.5).count();
    assert!((50..=120).contains(&pauses), "{pauses} of 100");
    assert!(lossy(TouchConfig::IDEAL).iter().all(|interval| (interval - 1.0).abs() < 0.4));
}

#[test]
fn places_come_in_steps() {
    let config = TouchConfig { step_m: 0.18e-3, ..TouchConfig::IDEAL };
    let mut errors_m = Vec::new();
    for (tick, touch) in reports(config, 5, 20) {
        let (x_m, ..) = place(touch);
        let steps = x_m / 0.18e-3;
        assert!((steps - steps.round()).abs() < 1e-2, "{steps}");
        errors_m.push(x_m - finger(tick - 400).x_m);
    }
    // Noise of 0.02 mm, jitter of 0.02 mm at this speed, and a step's 0.18 mm / sqrt(12).
    let (_, deviation_m) = mean_and_deviation(&errors_m);
    assert!((deviation_m - 59e-6).abs() < 4e-6, "{deviation_m}");
}

#[test]
fn a_lift_arrives_whatever_is_lost() {
    let config = TouchConfig { lost_share: 1.0, ..TouchConfig::IDEAL };
    let mut source = TouchSource::new(&config, TICK_HZ, 5).unwrap();
    let mut seen = Vec::new();
    for tick in 0..40_000 {
        source.tick(tick, (tick < 20_000).then(|| finger(tick)).as_ref());
        seen.extend(source.arrived());
    }
    assert_eq!(seen, [Touch::Up]);
}

/// A source that replaces another samples at the ticks at which it would have sampled from the start, and reports a
/// finger that was lifted meanwhile.
#[test]
fn a_source_that_begins_later_samples_at_its_own_ticks() {
    let config = TouchConfig { jitter_rms_s: 0.0, ..TouchConfig::IDEAL };
    let arrivals = |mut source: TouchSource, from_tick: u64, finger: Option<FingerState>| {
        (from_tick..from_tick + 4_000)
            .filter_map(|tick| {
                source.tick(tick, finger.as_ref());
                source.arrived().map(|touch| (tick, matches!(touch, Touch::Up)))
            })
            .collect::<Vec<_>>()
    };
    let begun = |tick| TouchSource::from_tick(&config, TICK_HZ, 5, tick).unwrap();
    let whole = arrivals(TouchSource::new(&config, TICK_HZ, 5).unwrap(), 0, Some(finger(0)));
    for from_tick in [0, 1, 399, 400, 1_234] {
        let found = arrivals(begun(from_tick), from_tick, Some(finger(0)));
        let expected: Vec<_> = whole.iter().copied().filter(|(tick, _)| *tick >= from_tick + 400).collect();
        assert_eq!(found[..expected.len()], expected, "from tick {from_tick}");
        let [(_, is_up)] = arrivals(begun(from_tick), from_tick, None)[..] else { panic!("one report of the lift") };
        assert!(is_up);
    }
}

#[test]
fn values_out_of_range_are_refused_by_name() {
    let default = TouchConfig::default();
    for (config, message) in [
        (TouchConfig { rate_hz: 0.0, ..default }, "touch rate_hz must be finite and above 0, found 0"),
        (TouchConfig { rate_hz: 50_000.0, ..default }, "touch rate_hz must be at most the tick rate, found 50000"),
        (TouchConfig { latency_s: -0.01, ..default }, "touch latency_s must be from 0 to 10, found -0.01"),
        (TouchConfig { noise_rms_m: f64::NAN, ..default }, "touch noise_rms_m must be from 0 to 10, found NaN"),
        (TouchConfig { lost_share: 1.1, ..default }, "touch lost_share must be from 0 to 1, found 1.1"),
        (TouchConfig { bunched_share: -0.1, ..default }, "touch bunched_share must be from 0 to 1, found -0.1"),
        (TouchConfig { pause_rate_hz: 11.0, ..default }, "touch pause_rate_hz must be from 0 to 10, found 11"),
        (TouchConfig { pause_max_s: 11.0, ..default }, "touch pause_max_s must be from 0 to 10, found 11"),
        (TouchConfig { step_m: -1.0, ..default }, "touch step_m must be from 0 to 10, found -1"),
        (TouchConfig { jitter_rms_s: 11.0, ..default }, "touch jitter_rms_s must be from 0 to 10, found 11"),
    ] {
        assert_eq!(TouchSource::new(&config, TICK_HZ, 1).unwrap_err().to_string(), message);
    }
}

#[test]
fn the_bundled_sources_differ_in_rate_latency_and_jitter_alone() {
    assert_eq!(TouchConfig::bundled("100"), Some(TouchConfig::REALISTIC));
    assert_eq!(TouchConfig::REALISTIC.without_losses(), TouchConfig::IDEAL);
    assert_eq!(TouchConfig::bundled("300"), None);
    for name in TouchConfig::bundled_names() {
        let TouchConfig { rate_hz, latency_s, jitter_rms_s, .. } = TouchConfig::bundled(name).unwrap();
        assert_eq!(name.parse(), Ok(rate_hz));
        assert_eq!(
            TouchConfig::bundled(name),
            Some(TouchConfig { rate_hz, latency_s, jitter_rms_s, ..TouchConfig::REALISTIC })
        );
    }
}
