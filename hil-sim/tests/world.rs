//! The world as a board sees it, tick by tick.
#![allow(clippy::unwrap_used, reason = "these are tests, which clippy does not see in the helpers")]

use frixel_control::{Drive, Sense};
use frixel_hil_sim::{
    AmplifierConfig, Felt, FingerState, FingertipConfig, Person, Point, ReferenceFriction, Stroke, StrokeRow,
    TouchConfig, World, WorldConfig, WorldFault, WorldOptions, example_finger,
};
use frixel_model::{Contact, Finger, FrictionLaw};
use frixel_wire::dac_code::DacCode;
use proptest::prelude::*;

const LEFT: Point = Point { x_m: 0.01, y_m: 0.03 };
const RIGHT: Point = Point { x_m: 0.09, y_m: 0.03 };
const DAC_FULL: f64 = 32_767.0;

/// A finger that slides for 0.8 s at the fastest speed that the friction lag was measured at.
fn sliding() -> Stroke {
    Stroke::constant_speed(LEFT, RIGHT, 0.1).unwrap()
}

fn world(config: &WorldConfig) -> World {
    World::new(*config, sliding(), 1).unwrap()
}

fn ideal_amplifier() -> WorldConfig {
    let amplifier = AmplifierConfig { electrode_time_constant_s: 0.0, ..AmplifierConfig::default() };
    WorldConfig { amplifier, ..WorldConfig::default() }
}

/// A square carrier of 1 kHz.
fn square(tick: u64, dac_code: i16) -> Drive {
    let positive = (tick / 20).is_multiple_of(2);
    Drive { dac_code: DacCode::from_bits(if positive { dac_code } else { -dac_code }), amplifier_enable: true }
}

/// A sine carrier of 1 kHz.
fn sine(tick: u64, dac_code: i16) -> Drive {
    let angle = core::f64::consts::PI * (tick % 40) as f64 / 20.0;
    let dac_code = DacCode::from_bits((f64::from(dac_code) * angle.sin()).round() as i16);
    Drive { dac_code, amplifier_enable: true }
}

/// A sine raises the mean friction of a finger that follows each tick. It does not raise that of a finger that follows
/// the mean square, as a measured law does.
#[test]
fn a_sine_is_felt_as_its_rms_voltage_by_a_finger_that_follows_the_mean_square() {
    let contact = example_finger().unwrap();
    let empirical = frixel_testkit::empirical_header().friction_law().unwrap();
    let mean_over_constant = |law: FrictionLaw, follows_mean_square| {
        let fingertip = FingertipConfig { follows_mean_square, ..FingertipConfig::default() };
        let mut world = world(&WorldConfig { fingertip, ..ideal_amplifier() });
        world.set_finger(law, 20);
        world.start_stroke();
        let felt = (0..4_000).map(|tick| world.apply(sine(tick, 28_000)));
        let mean_n = felt.skip(3_600).map(|felt| felt.electric_friction_n).sum::<f64>() / 400.0;
        mean_n / law.electric_friction_n(200.0 * 28_000.0 / DAC_FULL * core::f64::consts::FRAC_1_SQRT_2)
    };
    assert!(mean_over_constant(contact.into(), false) > 1.05);
    for ratio in [mean_over_constant(contact.into(), true), mean_over_constant(empirical, false)] {
        assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
    }
}

/// Whatever moves the finger, the world is the same: felt friction and touch reports, bit for bit. A finger is up before
/// its stroke, which may begin again.
#[test]
fn a_finger_that_is_placed_at_every_tick_is_the_finger_of_the_stroke() {
    let stroke = sliding();
    let mut by_stroke = world(&WorldConfig::default());
    let mut placed = by_stroke.clone();
    for tick in 0..100 {
        let felt = by_stroke.apply(square(tick, 32_767));
        assert_eq!((felt.finger, felt.friction_n), (None, 0.0));
        placed.apply(square(tick, 32_767));
    }
    by_stroke.start_stroke();
    // Beyond the end of the stroke, where the finger is lifted.
    for tick in 1..=40_000_u64 {
        match stroke.at(tick as f64 / 40_000.0) {
            Some(finger) => placed.place_finger(finger),
            None => placed.lift_finger(),
        }
        let drive = square(tick, 20_000);
        assert_eq!(placed.apply(drive), by_stroke.apply(drive), "tick {tick}");
        assert_eq!(placed.sense(), by_stroke.sense(), "tick {tick}");
    }
    assert_eq!(placed.finger(), None, "the stroke ended");
    by_stroke.start_stroke();
    assert_eq!(by_stroke.finger(), stroke.at(0.0));
}

#[test]
fn a_finger_stays_where_it_was_placed_until_it_is_lifted_or_a_stroke_starts() {
    let mut world = world(&WorldConfig::default());
    let finger = FingerState { x_m: 0.04, y_m: 0.05, speed_m_per_s: 0.0 };
    world.place_finger(finger);
    let drive = Drive { dac_code: DacCode::ZERO, amplifier_enable: true };
    for _ in 0..100 {
        assert_eq!(world.apply(drive).finger, Some(finger));
    }
    world.lift_finger();
    assert_eq!(world.apply(drive).finger, None);
    world.place_finger(finger);
    world.start_stroke();
    assert_ne!(world.apply(drive).finger, Some(finger));
}

#[test]
fn a_square_drive_without_lag_is_felt_as_the_model_says() {
    let finger = Finger { radius_m: 7e-3, stiffness_pa_per_m: 3e7, friction_coefficient: 0.8 };
    let another = Contact::new(&finger, 8e-6).unwrap().under_load(0.3).unwrap();
    let contacts = [example_finger().unwrap(), another];
    for (contact, dac_code) in contacts.iter().flat_map(|contact| [1, 3000, 16_384, 32_767].map(|code| (contact, code)))
    {
        let mut world = world(&ideal_amplifier());
        world.set_finger(*contact, 20);
        world.start_stroke();
        let felt = (0..4000).map(|tick| world.apply(square(tick, dac_code))).last().unwrap();
        let voltage_v_rms = 200.0 * f64::from(dac_code) / DAC_FULL;
        let expected_n = contact.electric_friction_n(voltage_v_rms);
        assert!((felt.electric_friction_n - expected_n).abs() < 1e-9, "{} {expected_n}", felt.electric_friction_n);
        assert!((felt.friction_n - contact.natural_friction_n() - expected_n).abs() < 1e-9);
        assert!((felt.mean_square_v2.sqrt() - voltage_v_rms).abs() < 1e-9);
    }
}

#[test]
fn the_monitor_shows_the_output_of_the_tick_before_the_last_and_the_switch_is_held() {
    let mut world = world(&WorldConfig::default());
    let mut before_v = 0.0;
    for tick in 0..100 {
        let drive = square(tick, 32_767);
        let felt = world.apply(drive);
        let sense = world.sense();
        assert!((f64::from(sense.monitor_v) - before_v).abs() < 1e-5, "tick {tick}: {sense:?}");
        assert!(sense.arm_switch);
        // The electrode follows the output behind its series resistor.
        before_v = 200.0 * f64::from(drive.dac_code.bits()) / DAC_FULL;
        assert!((felt.electrode_v - before_v).abs() > 1e-9, "tick {tick}");
    }
}

#[test]
fn the_amplifier_s_fault_line_follows_its_schedule() {
    let mut world = world(&WorldConfig::default());
    world.schedule_fault(10..12, WorldFault::AmplifierNotReady).unwrap();
    world.schedule_fault(20..21, WorldFault::AmplifierNotReady).unwrap();
    let faulty: Vec<u64> = (0..100)
        .filter(|_| {
            let fault = world.sense().amplifier_fault;
            world.apply(Drive::default());
            fault
        })
        .collect();
    assert_eq!(faulty, [10, 11, 20]);
}

proptest! {
    #[test]
    fn the_same_seed_gives_the_same_run_and_friction_is_never_below_natural(
        seed in any::<u64>(),
        codes in prop::collection::vec((any::<i16>(), any::<bool>()), 1..60),
    ) {
        let run = |seed| {
            let mut world = World::new(WorldConfig::default(), sliding(), seed).unwrap();
            world.start_stroke();
            // Each code is held for 40 ticks, so that touch reports come in between.
            codes.iter().flat_map(|code| [code; 40]).map(|&(dac_code, amplifier_enable)| {
                (world.sense(), world.apply(Drive { dac_code: DacCode::from_bits(dac_code), amplifier_enable }))
            }).collect::<Vec<(Sense, Felt)>>()
        };
        let first = run(seed);
        prop_assert_eq!(&first, &run(seed));
        // The largest code drives 200 V.
        let most_n = 0.25 + 1.001 * example_finger().unwrap().electric_friction_n(200.0);
        prop_assert!(first.iter().all(|(_, felt)| felt.friction_n >= 0.25 && felt.friction_n < most_n));
    }
}

/// A world with every effect, whose finger slides over a square drive.
fn realistic_run(seed: u64, ticks: u64) -> Vec<Felt> {
    let mut world = World::new(WorldConfig::IDEAL.with(&WorldOptions::default()), sliding(), seed).unwrap();
    world.start_stroke();
    (0..ticks).map(|tick| world.apply(square(tick, 20_000))).collect()
}

/// Fixed for ever: the same bits on every platform.
#[test]
fn the_last_friction_of_a_realistic_run_is_the_one_it_was() {
    let last = *realistic_run(1, 20_000).last().unwrap();
    let bits = [last.friction_n, last.natural_friction_n, last.mean_square_v2].map(f64::to_bits);
    assert_eq!(bits, [4_598_905_268_221_903_569, 4_597_954_213_826_141_275, 4_669_351_140_877_307_118]);
    assert_ne!(Some(&last), realistic_run(2, 20_000).last(), "another seed has another finger");
}

/// Takes one effect from a world as it is in another.
type SwitchOff = fn(&mut WorldConfig, &WorldConfig);

#[test]
fn every_effect_of_the_realistic_world_changes_what_is_felt_and_can_be_switched_off() {
    let realistic = WorldConfig::IDEAL.with(&WorldOptions::default());
    let ideal = WorldConfig::default();
    let run = |config: WorldConfig| {
        let mut world = World::new(config, sliding(), 1).unwrap();
        world.start_stroke();
        (0..30_000)
            .map(|tick| {
                let touch = world.touch();
                (touch, world.apply(square(tick, 20_000)).friction_n)
            })
            .collect::<Vec<_>>()
    };
    let all = run(realistic);
    let without: [(&str, SwitchOff); 9] = [
        ("offset", |config, ideal| config.amplifier.offset_v = ideal.amplifier.offset_v),
        ("current limit", |config, ideal| config.amplifier.slew_v_per_s = ideal.amplifier.slew_v_per_s),
        ("pre-sliding", |config, ideal| config.fingertip.pre_sliding = ideal.fingertip.pre_sliding),
        ("load", |config, ideal| config.fingertip.load_sd_n = ideal.fingertip.load_sd_n),
        ("noise", |config, ideal| config.fingertip.noise_rms_n = ideal.fingertip.noise_rms_n),
        ("leakage", |config, ideal| config.fingertip.leakage_hz = ideal.fingertip.leakage_hz),
        ("lost reports", |config, ideal| config.touch.lost_share = ideal.touch.lost_share),
        ("bunched reports", |config, ideal| config.touch.bunched_share = ideal.touch.bunched_share),
        ("pixel steps", |config, ideal| config.touch.step_m = ideal.touch.step_m),
    ];
    let mut off = realistic;
    for (name, switch_off) in without {
        let mut config = realistic;
        switch_off(&mut config, &ideal);
        assert!(run(config) != all, "{name}");
        switch_off(&mut off, &ideal);
    }
    off.touch = TouchConfig { pause_rate_hz: 0.0, pause_max_s: 0.0, ..off.touch };
    assert_eq!(off, ideal, "these are all effects");
    assert!(run(off) == run(ideal));
}

#[test]
fn the_reference_under_the_same_finger_is_what_a_perfect_display_would_be_felt_as() {
    // A world whose amplifier is ideal and whose finger is not: without leakage, the drive is what the model says, so a
    // reference that follows the model's electric friction is what is felt.
    let mut config = ideal_amplifier();
    config.amplifier.offset_v = 0.0;
    config.fingertip = FingertipConfig { leakage_hz: 0.0, ..FingertipConfig::REALISTIC };
    let mut world = World::new(config, sliding(), 1).unwrap();
    world.start_stroke();
    let steady_n = example_finger().unwrap().electric_friction_n(200.0 * 20_000.0 / DAC_FULL);
    let mut reference = ReferenceFriction::default();
    let mut natural_n = Vec::new();
    for tick in 0..31_000 {
        let felt = world.apply(square(tick, 20_000));
        let reference_n = reference.follow(&felt, steady_n);
        // The gain is that of the voltage at the last change of the load, a millisecond before at most.
        assert!((reference_n - felt.friction_n).abs() < 2e-6, "tick {tick}: {reference_n}, {felt:?}");
        natural_n.push(felt.natural_friction_n);
    }
    assert!(natural_n.iter().copied().fold(0.0, f64::max) > 0.26, "the load and the noise are felt");
    world.lift_finger();
    assert!(reference.follow(&world.apply(square(0, 20_000)), steady_n) <= 0.0);
}

#[test]
fn a_stroke_says_with_which_force_the_finger_presses() {
    let row = |t_s, x_m, load_n| StrokeRow { t_s, place: Some(Point { x_m, y_m: 0.03 }), normal_load_n: Some(load_n) };
    let stroke = Stroke::through_rows(&[row(0.0, 0.01, 0.5), row(0.5, 0.06, 0.9)]).unwrap();
    assert!((stroke.normal_load_n(0.25).unwrap() - 0.7).abs() < 1e-12);
    assert_eq!(sliding().normal_load_n(0.1), None);
    let mut world = World::new(WorldConfig::default(), stroke, 1).unwrap();
    world.start_stroke();
    for tick in 1..20_000_u32 {
        let felt = world.apply(Drive::default());
        let load_n = 0.5 + 0.8 * f64::from(tick) / 40_000.0;
        // The load is taken every millisecond, in which it rises by 0.8 mN.
        assert!((felt.friction_n - 0.5 * load_n).abs() < 0.5e-3, "tick {tick}: {}", felt.friction_n);
    }
}

#[test]
fn a_scenarios_own_finger_stays_and_the_scenes_does_not() {
    let person = Person::drawn(5);
    let contact = person.contact(1e-6 / 3.9).unwrap();
    let mut world = world(&WorldConfig { own_finger: Some(contact.into()), ..ideal_amplifier() });
    world.set_finger(example_finger().unwrap(), 20);
    world.start_stroke();
    let felt = (0..4000).map(|tick| world.apply(square(tick, 20_000))).last().unwrap();
    assert!((felt.natural_friction_n - contact.natural_friction_n()).abs() < 1e-12);
}

#[test]
fn a_world_that_makes_no_sense_is_refused_by_name() {
    let refused = |config| World::new(config, sliding(), 1).unwrap_err().to_string();
    assert_eq!(
        refused(WorldConfig { tick_hz: 0, ..WorldConfig::default() }),
        "simulated world: tick_hz must be above 0, found 0"
    );
    assert_eq!(
        refused(WorldConfig { full_scale_v_peak: f64::NAN, ..WorldConfig::default() }),
        "simulated world: full_scale_v_peak must be finite and above 0, found NaN"
    );
    let amplifier = AmplifierConfig { gain: -1.0, ..AmplifierConfig::default() };
    assert_eq!(
        refused(WorldConfig { amplifier, ..WorldConfig::default() }),
        "simulated world: amplifier gain must be finite and above 0, found -1"
    );
}
