//! Tests which amplifiers the monitor check accepts as healthy, and how quickly it detects a broken one.
//! `frixel-session` (`safety`) tests that the board then stops.
//!
//! The plant here is a board and its amplifier in steps of 0.2 us: the enable changes 10 us into a tick, the DAC
//! latches the code at 24 us and slews at 5 V/us (AD5761R datasheet, "Slew rate", not read). The monitor's ADC takes
//! 2.5 us for a conversion, of which it samples for 2.2 us, and runs by itself: what a tick reads 0.9 us after its
//! beginning was sampled up to 0.6 us after it, and as early as 1.8 us before.

use frixel_model::{SINGLE_FAULT_CURRENT_MAX_A_PEAK, TOUCH_CURRENT_MAX_A_PEAK, TouchBound};
use frixel_wire::hello::BoardLimits;

use super::{MonitorCheck, lag_step};
use crate::Board;

const STEP_S: f32 = 0.2e-6;
const STEPS_PER_US: u32 = 5;
const TICK_STEPS: u32 = 25 * STEPS_PER_US;
const ENABLE_STEP: u32 = 10 * STEPS_PER_US;
const LATCH_STEP: u32 = 24 * STEPS_PER_US;
/// Steps from an edge of the enable until the amplifier switches.
const TURN_ON_STEPS: u32 = 900 * STEPS_PER_US;
const TURN_OFF_STEPS: u32 = 200 * STEPS_PER_US;
/// The latest and the earliest step of a tick in which the ADC samples the next reading.
const SAMPLE_STEPS: [u32; 2] = [3, TICK_STEPS - 9];

/// A board like the NUCLEO-G474RE's: an amplifier of 20 kHz that takes 1 ms to switch.
const BOARD: Board = Board {
    limits: BoardLimits { full_scale_v_peak: 200.0, ..Board::SIMULATOR.limits },
    amplifier: Board::NUCLEO_G474RE.amplifier,
    ..Board::SIMULATOR
};

/// Decay of a disabled amplifier's output.
#[derive(Clone, Copy, Debug)]
enum Decay {
    Linear {
        v_per_s: f32,
    },
    Exponential {
        time_constant_s: f32,
    },
    /// The output jumps to the electrode's voltage, which lags behind by the series resistor's 36 us.
    HighImpedance {
        time_constant_s: f32,
    },
}

/// The three kinds, each at 8 V within 0.75 ms of 200 V.
const DECAYS: [Decay; 3] = [
    Decay::Linear { v_per_s: 2.6e5 },
    Decay::Exponential { time_constant_s: 230e-6 },
    Decay::HighImpedance { time_constant_s: 230e-6 },
];

#[derive(Clone, Copy, Debug)]
struct Plant {
    gain: f32,
    /// Reading of the monitor at 0 V.
    offset_v: f32,
    sample_step: u32,
    sampled_v: f32,
    decay: Decay,
    code: i16,
    dac_v: f32,
    output_v: f32,
    electrode_v: f32,
    enable: bool,
    since_edge_steps: u32,
    /// Fraction of the distance to the DAC's voltage covered by the output in a step.
    lag: f32,
    is_on: bool,
}

impl Plant {
    fn new(decay: Decay) -> Self {
        Self {
            gain: 1.0,
            offset_v: 0.0,
            sample_step: SAMPLE_STEPS[0],
            sampled_v: 0.0,
            lag: 1.0 - (-STEP_S / BOARD.amplifier.time_constant_s).exp(),
            decay,
            code: 0,
            dac_v: 0.0,
            output_v: 0.0,
            electrode_v: 0.0,
            enable: false,
            since_edge_steps: u32::MAX / 2,
            is_on: false,
        }
    }

    fn step(&mut self) {
        let wanted_v = self.gain * f32::from(self.code) * 200.0 / 32_767.0;
        // 5 V/us behind a gain of 20.
        self.dac_v += (wanted_v - self.dac_v).clamp(-20.0, 20.0);
        self.since_edge_steps = self.since_edge_steps.saturating_add(1);
        if self.since_edge_steps >= if self.enable { TURN_ON_STEPS } else { TURN_OFF_STEPS } {
            self.is_on = self.enable;
        }
        if self.is_on && self.enable {
            self.output_v += self.lag * (self.dac_v - self.output_v);
        } else if !self.is_on {
            match self.decay {
                Decay::Linear { v_per_s } => {
                    let left_v = (self.output_v.abs() - v_per_s * STEP_S).max(0.0);
                    self.output_v = left_v.copysign(self.output_v);
                }
                Decay::Exponential { time_constant_s } => self.output_v *= 1.0 - STEP_S / time_constant_s,
                Decay::HighImpedance { time_constant_s } => {
                    self.electrode_v *= 1.0 - STEP_S / time_constant_s;
                    self.output_v = self.electrode_v;
                }
            }
        }
        self.electrode_v += STEP_S / 36e-6 * (self.output_v - self.electrode_v);
    }
}

/// A plant and the check of its monitor, tick by tick.
struct Bench {
    plant: Plant,
    check: MonitorCheck,
    code: i16,
    faults: u32,
    most_wrong: u32,
    ticks: u32,
}

impl Bench {
    fn new(plant: Plant) -> Self {
        Self { plant, check: MonitorCheck::new(&BOARD), code: 0, faults: 0, most_wrong: 0, ticks: 0 }
    }

    /// A tick that outputs `code`, or nothing.
    fn tick(&mut self, code: Option<i16>) {
        self.run(0, SAMPLE_STEPS[0]);
        self.faults += u32::from(is_fault(&mut self.check, self.code, self.plant.sampled_v));
        self.most_wrong = self.most_wrong.max(self.check.wrong_count);
        self.check.set_enabled(code.is_some(), self.code);
        self.code = code.unwrap_or(0);
        self.run(SAMPLE_STEPS[0], ENABLE_STEP);
        if self.plant.enable != code.is_some() {
            self.plant.enable = code.is_some();
            self.plant.since_edge_steps = 0;
        }
        // The enable and CLEAR are one output: the DAC is at zero at once.
        if code.is_none() {
            self.plant.code = 0;
        }
        self.run(ENABLE_STEP, LATCH_STEP);
        self.plant.code = self.code;
        self.run(LATCH_STEP, TICK_STEPS);
        self.ticks += 1;
    }

    /// The steps of a tick from one to before another.
    fn run(&mut self, from_step: u32, to_step: u32) {
        for step in from_step..to_step {
            self.plant.step();
            if step + 1 == self.plant.sample_step {
                self.plant.sampled_v = self.plant.output_v + self.plant.offset_v;
            }
        }
    }

    /// A square carrier for a number of ticks.
    fn square(&mut self, ticks: u32, voltage_v: f32, half_period_ticks: u32) {
        (0..ticks).for_each(|tick| self.tick(Some(square(voltage_v, half_period_ticks, tick))));
    }

    fn off(&mut self, ticks: u32) {
        (0..ticks).for_each(|_| self.tick(None));
    }
}

/// Whether a check faults in a tick in which the monitor reads `monitor_v`. The code is that of the tick before.
fn is_fault(check: &mut MonitorCheck, driven_code: i16, monitor_v: f32) -> bool {
    let (comparison, must_count) = check.advance(driven_code, monitor_v);
    if must_count { check.count(comparison) } else { check.sum(comparison) }
}

/// The code of a square carrier at a tick.
fn square(voltage_v: f32, half_period_ticks: u32, tick: u32) -> i16 {
    code_of(if (tick / half_period_ticks).is_multiple_of(2) { voltage_v } else { -voltage_v })
}

/// The code of a sine of the same length at a tick.
fn sine(voltage_v: f32, half_period_ticks: u32, tick: u32) -> i16 {
    let turns = f64::from(tick) / f64::from(2 * half_period_ticks);
    code_of(voltage_v * (core::f64::consts::TAU * turns).sin() as f32)
}

/// A code for a voltage.
fn code_of(voltage_v: f32) -> i16 {
    (voltage_v * 32_767.0 / 200.0) as i16
}

#[test]
fn a_lag_is_followed_as_an_exponential() {
    for i in 1..=1000 {
        let x = i as f32 * 1e-3;
        let exact = 1.0 - (-f64::from(x)).exp();
        assert!((f64::from(lag_step(x)) - exact).abs() < 1e-5, "{x}");
    }
    for i in 1..2000 {
        let x = i as f32 * 0.25;
        let exact = 1.0 - (-f64::from(x)).exp();
        assert!((f64::from(lag_step(x)) - exact).abs() < 1e-3, "{x}");
    }
    assert!((lag_step(f32::INFINITY) - 1.0).abs() < 1e-9, "an amplifier without lag");
}

#[test]
fn a_healthy_amplifier_has_no_wrong_tick_at_any_carrier_and_voltage() {
    for (gain, sample_step) in [0.95, 1.0, 1.05].into_iter().flat_map(|gain| SAMPLE_STEPS.map(|step| (gain, step))) {
        for voltage_v in [5.0, 10.7, 20.0, 50.0, 70.0, 100.0, 150.0, 200.0] {
            for half_period_ticks in [4, 5, 7, 10, 20, 160] {
                let mut bench = Bench::new(Plant { gain, sample_step, ..Plant::new(DECAYS[0]) });
                bench.square(640, voltage_v, half_period_ticks);
                (0..640).for_each(|tick| bench.tick(Some(sine(voltage_v, half_period_ticks, tick))));
                let wrong = (bench.faults, bench.most_wrong);
                assert_eq!(wrong, (0, 0), "gain {gain}, {voltage_v} V, {half_period_ticks} ticks, {sample_step}");
            }
        }
    }
}

/// Ticks after which a gain that changes while a carrier plays is a fault, if it changes at the tick `from_tick`.
fn ticks_to_gain_fault(plant: Plant, gain: f32, driven: &dyn Fn(u32) -> i16, from_tick: u32) -> Option<u32> {
    let mut bench = Bench::new(plant);
    for tick in 0..from_tick + 4_000 {
        if tick == from_tick {
            assert_eq!(bench.faults, 0, "healthy until here");
            bench.plant.gain = gain;
        }
        bench.tick(Some(driven(tick)));
        if bench.faults > 0 {
            return Some(tick + 1 - from_tick);
        }
    }
    None
}

/// The longest time for a gain that changes at any time, of square and sine at every length of a half period: 800 ticks
/// are 20 ms.
#[test]
fn a_gain_that_is_off_by_40_percent_is_found_within_20_ms_from_10_v_peak_on() {
    let mut most = 0;
    for half_period_ticks in [4, 5, 7, 20, 40, 80, 160] {
        for (is_sine, voltage_v) in [(false, 10.0), (true, 10.0), (false, 25.0), (true, 50.0)] {
            let carrier = if is_sine { sine } else { square };
            let driven = |tick| carrier(voltage_v, half_period_ticks, tick);
            for (gain, from_tick) in [0.6, 1.4].into_iter().flat_map(|gain| (0..8).map(move |i| (gain, 900 + 57 * i))) {
                let ticks = ticks_to_gain_fault(Plant::new(DECAYS[0]), gain, &driven, from_tick).unwrap_or(u32::MAX);
                assert!(ticks <= 800, "gain {gain}, {voltage_v} V, {half_period_ticks} ticks, {is_sine}: {ticks}");
                most = most.max(ticks);
            }
        }
    }
    println!("a gain off by 40 % from 10 V peak on: found after {:.1} ms at most", f64::from(most) / 40.0);
}

/// A gain that is too high by a quarter is tolerated. The current of that single fault is below its limit, and so is
/// the current of the few milliseconds in which the gain may be as high as a single tick tolerates.
#[test]
fn an_undetected_gain_error_stays_within_the_single_fault_limit() {
    let bound = TouchBound::behind(Board::NUCLEO_G474RE.limits.series_resistance_ohm);
    for half_period_ticks in [20, 80, 160] {
        let voltage_v = bound.voltage_max_v_peak(BOARD.tick_hz as f32 / (2 * half_period_ticks) as f32);
        // A quarter, and 4 % of the full scale of 200 V.
        let gain_max = 1.25 + 8.0 / f64::from(voltage_v);
        assert!(gain_max * TOUCH_CURRENT_MAX_A_PEAK < SINGLE_FAULT_CURRENT_MAX_A_PEAK, "{voltage_v} V");
        let driven = |tick| square(voltage_v, half_period_ticks, tick);
        for (gain, is_seen) in [(1.2, false), (1.3, true)] {
            let ticks = ticks_to_gain_fault(Plant::new(DECAYS[0]), gain, &driven, 900);
            assert_eq!(ticks.is_some(), is_seen, "gain {gain}, {voltage_v} V, {half_period_ticks} ticks: {ticks:?}");
        }
    }
}

/// Offset and a gain within tolerance, together, at every carrier: the offset cancels or is allowed for.
#[test]
fn an_offset_within_tolerance_is_no_gain_fault() {
    for (offset_v, gain) in [(7.5, 1.0), (-7.5, 1.0), (4.0, 1.1), (-4.0, 0.9)] {
        for voltage_v in [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0] {
            for half_period_ticks in [4, 5, 7, 20, 40, 80, 160] {
                let mut bench = Bench::new(Plant { gain, offset_v, ..Plant::new(DECAYS[0]) });
                bench.square(4_000, voltage_v, half_period_ticks);
                let context = format!("{offset_v} V, gain {gain}, {voltage_v} V, {half_period_ticks} ticks");
                assert_eq!(bench.faults, 0, "{context}");
                // Bursts with pauses, in which the carrier is not balanced.
                for pause_ticks in [3, 50, 200] {
                    bench.square(half_period_ticks / 2 + 60, voltage_v, half_period_ticks);
                    (0..pause_ticks).for_each(|_| bench.tick(Some(0)));
                }
                assert_eq!(bench.faults, 0, "{context}, in bursts");
            }
        }
    }
}

/// The monitor reads right until the half period ends, and in every other half period: 1.5 ms from 500 Hz on, and 0.5
/// ms after the half period on a slower carrier.
#[test]
fn a_dac_that_holds_its_last_code_is_found_within_1_5_ms_or_half_a_millisecond_after_the_half_period() {
    for voltage_v in [20.0, 50.0, 200.0] {
        for half_period_ticks in [4, 5, 7, 10, 20, 40, 80, 160] {
            let driven = |tick| square(voltage_v, half_period_ticks, tick);
            let ticks_to_fault = |from_tick: u32| {
                let mut check = MonitorCheck::new(&BOARD);
                check.set_enabled(true, 0);
                let held_v = f32::from(driven(from_tick)) * check.volts_per_code;
                let mut ticks = 0..from_tick + 1_000;
                let found = ticks.find(|&tick| {
                    // The amplifier has switched on before.
                    let monitor_v = if tick < from_tick { check.expected_v } else { held_v };
                    is_fault(&mut check, driven(tick), monitor_v)
                });
                found.map_or(u32::MAX, |tick| tick + 1 - from_tick)
            };
            let most = (100..100 + 2 * half_period_ticks).map(ticks_to_fault).max();
            let limit = (half_period_ticks + 20).max(60);
            assert!(most.is_some_and(|most| most <= limit), "{voltage_v} V, {half_period_ticks} ticks: {most:?}");
        }
    }
}

/// Lifts, stops and re-touches at every phase of the carrier, after and before the amplifier has switched.
#[test]
fn an_amplifier_that_switches_as_specified_never_faults() {
    for (decay, sample_step) in DECAYS.into_iter().flat_map(|decay| SAMPLE_STEPS.map(|step| (decay, step))) {
        for voltage_v in [5.0, 10.7, 20.0, 50.0, 100.0, 200.0] {
            for half_period_ticks in [4, 7, 20, 160] {
                let mut bench = Bench::new(Plant { sample_step, ..Plant::new(decay) });
                let (mut on_ticks, mut off_ticks) = (1, 1);
                while bench.ticks < 20_000 {
                    bench.square(on_ticks, voltage_v, half_period_ticks);
                    bench.off(off_ticks);
                    // All pairs of up to 89 and up to 97 ticks come, in another order.
                    (on_ticks, off_ticks) = (1 + (on_ticks + 31) % 89, 1 + (off_ticks + 40) % 97);
                }
                assert_eq!(bench.faults, 0, "{decay:?}, {voltage_v} V, {half_period_ticks} ticks, {sample_step}");
            }
        }
    }
}

/// The limit is 1 ms, plus the two ticks after which the monitor shows an edge of the enable.
#[test]
fn an_output_that_stays_or_is_slow_faults_when_the_turn_off_time_is_over() {
    for decay in [
        Decay::Linear { v_per_s: 0.0 },
        Decay::Linear { v_per_s: 1.2e4 },
        Decay::Exponential { time_constant_s: 1.5e-3 },
        // 10 MOhm and 0.53 nF.
        Decay::HighImpedance { time_constant_s: 5.3e-3 },
    ] {
        for voltage_v in [20.0, 50.0, 200.0] {
            let mut bench = Bench::new(Plant::new(decay));
            bench.square(3_000, voltage_v, 20);
            bench.off(42);
            assert_eq!(bench.faults, 0, "{decay:?}, {voltage_v} V");
            bench.off(1);
            assert_eq!(bench.faults, 1, "{decay:?}, {voltage_v} V");
        }
    }
}

/// Ticks until a check faults that reads `monitor_v` while `driven_v` is driven; `None` if there is none within 1,000.
fn ticks_to_fault(check: &mut MonitorCheck, driven_v: f32, monitor_v: f32) -> Option<u32> {
    (1..=1_000).find(|_| is_fault(check, code_of(driven_v), monitor_v))
}

#[test]
fn the_time_of_wrong_ticks_is_the_same_at_every_tick_rate() {
    for (tick_hz, wrong_ticks) in [(8_000, 3), (10_000, 4), (20_000, 8), (40_000, 16), (80_000, 32)] {
        let mut check = MonitorCheck::new(&Board { tick_hz, ..BOARD });
        assert_eq!(ticks_to_fault(&mut check, 0.0, 60.0), Some(wrong_ticks), "{tick_hz} Hz");
    }
}

/// An amplifier that turns on may lag, but not overshoot.
#[test]
fn a_voltage_above_the_drive_is_wrong_while_the_amplifier_turns_on() {
    let mut check = MonitorCheck::new(&BOARD);
    check.set_enabled(true, 0);
    assert_eq!(ticks_to_fault(&mut check, 20.0, 60.0), Some(16));
}

#[test]
fn the_voltage_of_an_earlier_turn_on_is_not_allowed_while_the_amplifier_turns_off() {
    let mut check = MonitorCheck::new(&BOARD);
    check.set_enabled(true, 0);
    for driven_v in [150.0, 20.0] {
        assert_eq!(ticks_to_fault(&mut check, driven_v, driven_v), None, "{driven_v} V");
    }
    check.set_enabled(false, code_of(20.0));
    assert_eq!(ticks_to_fault(&mut check, 0.0, 60.0), Some(1));
}

#[test]
fn an_output_that_rises_after_the_enable_has_fallen_is_a_fault_at_once() {
    let mut check = MonitorCheck::new(&BOARD);
    check.set_enabled(true, 0);
    assert_eq!(ticks_to_fault(&mut check, 150.0, 150.0), None);
    check.set_enabled(false, code_of(150.0));
    let mut readings_v = [20.0; 9].into_iter().chain([40.0]);
    let found = readings_v.by_ref().position(|monitor_v| is_fault(&mut check, 0, monitor_v));
    assert_eq!((found, readings_v.next()), (Some(9), None), "the higher one is the fault");
}
