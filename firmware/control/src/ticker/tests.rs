//! Tests the tick as the last line of defence: it stays within the board's ceilings for all coefficients and orders.

use frixel_layers::{Blend, Constant, Header, Layer, Record, Region, Waveform};
use frixel_model::{Finger as FingerModel, InverseTable, Ripple};
use frixel_testkit::HEADER;
use frixel_wire::fault::Flags;
use proptest::prelude::*;

use super::*;
use crate::{CarrierTiming, Order, StandstillRamp};

/// Few ticks a second, so that a host timeout of a second is short.
const BOARD: Board = Board { tick_hz: 5_000, ..Board::NUCLEO_G474RE };
const TRACK: Track = Track {
    contact: 1,
    from_tick: 0,
    until_tick: 0,
    place_m: [0.05; 2],
    path_velocity_m_per_s: [0.0; 2],
    path_half_acceleration_m_per_s2: [0.0; 2],
    velocity_m_per_s: [0.1, 0.0],
    half_acceleration_m_per_s2: [0.0; 2],
    ramp: StandstillRamp::MOVING,
};

/// Coefficients of a constant out of reach of any voltage, with a table up to 150 V rms.
fn active(carrier: CarrierTiming, slew_step_v: f32, voltage_max_v_rms: f32, host_timeout_ticks: u32) -> Active {
    let Header { finger_radius_m, stiffness_pa_per_m, friction_coefficient, .. } = HEADER;
    let finger = FingerModel { radius_m: finger_radius_m, stiffness_pa_per_m, friction_coefficient };
    let mut active = Active::new();
    let Header { effective_gap_m, normal_load_n, .. } = HEADER;
    active.table =
        InverseTable::of_finger(&finger, effective_gap_m, normal_load_n, &Ripple::NONE, 150.0, f32::INFINITY).unwrap();
    let layer = Layer::Constant(Constant { electric_friction_n: 1.0 });
    let record = Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer };
    active.layers.begin(&HEADER, core::iter::empty());
    active.layers.push(&record, BOARD.tick_hz, &|_| None).unwrap();
    active.carrier = carrier;
    active.slew_step_v = slew_step_v;
    active.voltage_max_v_rms = voltage_max_v_rms;
    active.host_timeout_ticks = host_timeout_ticks;
    active
}

/// Amplifier, monitor and person of a healthy board.
struct Rig<'a> {
    ticker: Ticker<'a>,
    monitor: frixel_testkit::IdealMonitor,
}

impl<'a> Rig<'a> {
    fn new(ticker: Ticker<'a>) -> Self {
        let time_constant_ticks = BOARD.amplifier.time_constant_s / BOARD.tick_period_s();
        let monitor = frixel_testkit::IdealMonitor::new(BOARD.limits.full_scale_v_peak, time_constant_ticks);
        Self { ticker, monitor }
    }

    fn tick(&mut self) -> Drive {
        let arm_switch = !self.ticker.waits_for_release();
        let drive = self.ticker.tick(&Sense { arm_switch, monitor_v: self.monitor.voltage_v(), ..Sense::default() });
        self.monitor.follow(drive.dac_code);
        drive
    }

    fn touch(&mut self) {
        let from_tick = self.ticker.tick;
        self.ticker.apply(Order::Track(Track { from_tick, until_tick: from_tick.wrapping_add(1 << 30), ..TRACK }));
    }

    fn play(&mut self) {
        self.tick();
        self.tick();
        self.ticker.apply(Order::Arm);
        self.ticker.apply(Order::Play);
        assert_eq!(self.ticker.state(), State::Active);
    }
}

/// The largest code of the board on any carrier: 50 V of 200 V.
const CODE_MAX: i16 = 8_191;

#[test]
fn coefficients_above_the_ceilings_are_lowered_flagged_and_counted() {
    let full = || active(CarrierTiming::new(Waveform::Square, 4, 1e9, DacCode::MAX), 1e9, 1e9, u32::MAX);
    let (pool, mut first, mut second) = (BitmapPool::new(), full(), full());
    let mut rig = Rig::new(Ticker::new(&BOARD, &pool, &mut first));
    assert_eq!(rig.ticker.status().counters.clamped_loads, 1, "by the first coefficients");
    rig.play();
    let mut next = Some(&mut second);
    for loads in 1..3 {
        rig.touch();
        // 625 Hz.
        let code_max = (BOARD.ceilings().voltage_max_v_peak(4) * 32_767.0 / 200.0) as i16;
        let codes: Vec<i16> = (0..40).map(|_| rig.tick().dac_code.bits()).collect();
        assert_eq!(codes.iter().map(|code| code.abs()).max(), Some(code_max));
        assert!(code_max < CODE_MAX, "the touch current is the limit");
        let status = rig.ticker.status();
        assert!(status.telemetry.flags.contains(Flags::CLAMPED));
        assert!(status.telemetry.voltage_v_rms <= 50.0);
        assert_eq!(status.counters.clamped_loads, loads);
        if let Some(next) = next.take() {
            rig.ticker.apply(Order::Load(next));
        }
    }
    rig.ticker.apply(Order::Unload);
    assert!(!rig.ticker.status().telemetry.flags.contains(Flags::CLAMPED));
}

#[test]
fn coefficients_at_the_ceilings_are_kept_and_not_flagged() {
    for half_period_ticks in 4..=20 {
        let ceilings = BOARD.ceilings();
        let voltage_v = ceilings.voltage_max_v_peak(half_period_ticks);
        let carrier = CarrierTiming::new(Waveform::Square, half_period_ticks, 100.0, ceilings.code(voltage_v));
        let mut at_ceilings = active(carrier, 1.0, voltage_v, BOARD.tick_hz);
        assert!(!at_ceilings.limit_to(&ceilings), "{half_period_ticks}");
        assert_eq!(at_ceilings.carrier, carrier);
    }
}

#[test]
fn each_coefficient_above_its_ceiling_is_lowered() {
    let ceilings = BOARD.ceilings();
    let timing = |code| CarrierTiming::new(Waveform::Square, 4, 100.0, ceilings.code(code));
    let voltage_v = ceilings.voltage_max_v_peak(4);
    let (carrier, above) = (timing(voltage_v), timing(1.01 * voltage_v));
    for (timing, slew_step_v, voltage_max_v_rms, host_timeout_ticks) in [
        (above, 1.0, voltage_v, BOARD.tick_hz),
        (carrier, f32::NAN, voltage_v, BOARD.tick_hz),
        (carrier, 1.0, 1.01 * voltage_v, BOARD.tick_hz),
        (carrier, 1.0, voltage_v, BOARD.tick_hz + 1),
    ] {
        let mut one_above = active(timing, slew_step_v, voltage_max_v_rms, host_timeout_ticks);
        assert!(one_above.limit_to(&ceilings));
        assert!(!one_above.limit_to(&ceilings), "it was lowered once");
        assert_eq!((one_above.carrier, one_above.host_timeout_ticks), (carrier, BOARD.tick_hz));
        assert!(one_above.voltage_max_v_rms <= voltage_v && one_above.slew_step_v <= 1.0);
    }
}

#[test]
fn unloading_a_scene_leaves_nothing_behind() {
    let carrier = CarrierTiming::new(Waveform::Square, 4, 100.0, DacCode::MAX);
    let mut unloaded = active(carrier, 1.0, 50.0, 100);
    unloaded.unload();
    assert!(unloaded.table().is_none() && unloaded.carrier == CarrierTiming::ZERO_OUTPUT);
    assert_eq!((unloaded.slew_step_v, unloaded.voltage_max_v_rms, unloaded.host_timeout_ticks), (0.0, 0.0, 0));
}

/// An arbitrary number, as in unchecked memory.
fn any_number() -> impl Strategy<Value = f32> {
    prop_oneof![any::<f32>(), -10.0_f32..1e4, Just(f32::NAN), Just(f32::INFINITY), Just(f32::MAX)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// For all coefficients, gains and scenes loaded during a play: no code is above the board's, no drive lasts longer
    /// than a second without a sign of life, and none longer than 40 ms without a touch report.
    #[test]
    fn nothing_drives_beyond_the_ceilings(
        waveform in prop_oneof![Just(Waveform::Square), Just(Waveform::Sine)],
        half_period_ticks in prop_oneof![0_u32..50, any::<u32>()],
        codes_per_v_rms in any_number(),
        code_max in any::<i16>(),
        slew_step_v in any_number(),
        voltage_max_v_rms in any_number(),
        host_timeout_ticks in prop_oneof![any::<u32>(), Just(u32::MAX), 0_u32..9_000],
        gain in any_number(),
        is_empty in any::<bool>(),
        is_unloaded in any::<bool>(),
        is_loaded in any::<bool>(),
        touches_for_ticks in 0_u32..9_000,
    ) {
        let carrier = CarrierTiming::new(waveform, half_period_ticks, codes_per_v_rms, DacCode::from_bits(code_max));
        let given = || active(carrier, slew_step_v, voltage_max_v_rms, host_timeout_ticks);
        let (pool, mut first, mut second) = (BitmapPool::new(), given(), given());
        if is_empty {
            first.table.clear();
        }
        let mut rig = Rig::new(Ticker::new(&BOARD, &pool, &mut first));
        rig.play();
        if is_unloaded {
            rig.ticker.apply(Order::Unload);
        }
        if is_loaded {
            rig.ticker.apply(Order::Load(&mut second));
        }
        rig.ticker.apply(Order::SetLayer { layer: 0, on: true, gain });
        let ceilings = BOARD.ceilings();
        let code_max = ceilings.code(ceilings.voltage_max_v_peak(ceilings.half_period_ticks(half_period_ticks))).bits();
        prop_assert!(code_max <= CODE_MAX);
        let mut touched_at = 0;
        for tick in 0..7_000_u32 {
            if tick < touches_for_ticks && tick.is_multiple_of(50) {
                rig.touch();
                touched_at = tick;
            }
            let drive = rig.tick();
            prop_assert!(drive.dac_code.bits().unsigned_abs() <= code_max.unsigned_abs(), "{drive:?}");
            let may_drive = tick <= BOARD.tick_hz + 1 && tick - touched_at <= BOARD.tick_hz / 25 + 1;
            prop_assert!(may_drive || drive == Drive::default(), "{tick}: {drive:?}");
        }
    }
}
