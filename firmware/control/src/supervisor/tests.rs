//! The safety requirements of the supervisor (`PROTOCOL.md` section 10, "States").

use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::{Fault, State};
use proptest::prelude::*;

use super::Supervisor;
use crate::{Board, Order, Sense};

const BOARD: Board = Board::SIMULATOR;
/// Tolerance of the simulated board's monitor, V: 4 % of 250 V.
const FLOOR_V: f32 = 10.0;
const FULL_SCALE_V: f32 = 250.0;
/// Wrong ticks that are a fault.
const WRONG_TICKS: u32 = 16;

/// A monitor voltage with otherwise normal inputs.
fn reading(monitor_v: f32) -> Sense {
    Sense { monitor_v, arm_switch: true, ..Sense::default() }
}

/// The person at the arm switch releases it and presses it again.
fn press_switch(supervisor: &mut Supervisor) {
    for arm_switch in [false, true] {
        supervisor.check(&Sense { arm_switch, ..reading(0.0) }, DacCode::ZERO);
    }
}

fn in_state(state: State) -> Supervisor {
    let mut supervisor = Supervisor::new(&BOARD);
    press_switch(&mut supervisor);
    match state {
        State::Disarmed => {}
        State::Armed => supervisor.apply(&Order::Arm, 0),
        State::Active => {
            supervisor.apply(&Order::Arm, 0);
            supervisor.apply(&Order::Play, 0);
        }
        State::Faulted => supervisor.raise(Fault::Deadline, 1),
    }
    assert_eq!(supervisor.state(), state);
    supervisor
}

/// An active supervisor that has driven `dac_code` for a long time.
fn driving(dac_code: i16) -> Supervisor {
    let mut supervisor = in_state(State::Active);
    supervisor.set_amplifier_enabled(true, DacCode::ZERO);
    for tick in 0..40 {
        // The first code is seen at the second tick.
        let monitor_v = if tick == 0 { 0.0 } else { driven_v(dac_code) };
        supervisor.check(&reading(monitor_v), DacCode::from_bits(dac_code));
    }
    assert_eq!(supervisor.state(), State::Active);
    supervisor
}

fn driven_v(dac_code: i16) -> f32 {
    f32::from(dac_code) * FULL_SCALE_V / 32_767.0
}

/// Number of ticks with this reading until the supervisor faults, at most `limit`.
fn ticks_to_fault(supervisor: &mut Supervisor, monitor_v: f32, dac_code: i16, limit: u32) -> Option<u32> {
    (1..=limit).find(|_| {
        supervisor.check(&reading(monitor_v), DacCode::from_bits(dac_code));
        supervisor.state() == State::Faulted
    })
}

/// A quarter of the driven voltage plus a twenty-fifth of full scale, on both sides of both signs.
#[test]
fn the_monitor_may_be_off_by_its_tolerance_and_no_more() {
    for dac_code in [0, 6_553, -6_553, 26_213, -26_213] {
        let tolerance_v = FLOOR_V + 0.25 * driven_v(dac_code).abs();
        for side in [-1.0, 1.0] {
            let inside_v = driven_v(dac_code) + side * (tolerance_v - 0.05);
            assert_eq!(
                ticks_to_fault(&mut driving(dac_code), inside_v, dac_code, 1000),
                None,
                "{dac_code}: {inside_v}"
            );
            let outside_v = driven_v(dac_code) + side * (tolerance_v + 0.05);
            let ticks = ticks_to_fault(&mut driving(dac_code), outside_v, dac_code, 1000);
            assert_eq!(ticks, Some(WRONG_TICKS), "{dac_code}: {outside_v}");
        }
    }
}

#[test]
fn a_monitor_at_its_tolerance_or_not_a_number_is_wrong() {
    for monitor_v in [0.04 * FULL_SCALE_V, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(ticks_to_fault(&mut driving(0), monitor_v, 0, 100), Some(WRONG_TICKS));
    }
}

#[test]
fn three_correct_ticks_compensate_a_wrong_one() {
    let mut supervisor = driving(0);
    assert_eq!(ticks_to_fault(&mut supervisor, 60.0, 0, WRONG_TICKS - 1), None);
    assert_eq!(ticks_to_fault(&mut supervisor, 0.0, 0, 15), None);
    assert_eq!(ticks_to_fault(&mut supervisor, 60.0, 0, 100), Some(6), "five were made up for");
}

#[test]
fn correct_ticks_do_not_count_in_advance() {
    let mut supervisor = driving(0);
    assert_eq!(ticks_to_fault(&mut supervisor, 60.0, 0, 3), None);
    assert_eq!(ticks_to_fault(&mut supervisor, 0.0, 0, 10_000), None);
    assert_eq!(ticks_to_fault(&mut supervisor, 60.0, 0, 100), Some(WRONG_TICKS));
}

#[test]
fn the_detail_of_a_monitor_fault_is_the_reading_in_volts() {
    for (monitor_v, detail) in [(60.9, 60), (-60.9, -60_i32 as u32)] {
        let mut supervisor = driving(0);
        ticks_to_fault(&mut supervisor, monitor_v, 0, 100);
        assert_eq!(supervisor.fault(), Some((Fault::Monitor, detail)));
    }
}

/// Holds for a fault of any duration.
#[test]
fn a_cleared_monitor_fault_does_not_return_while_readings_are_correct() {
    let mut supervisor = driving(0);
    for _ in 0..400_000 {
        supervisor.check(&reading(60.0), DacCode::ZERO);
    }
    assert_eq!(ticks_to_fault(&mut supervisor, 0.0, 0, 1), Some(1), "a fault latches");
    supervisor.apply(&Order::ClearFault, 0);
    assert_eq!(ticks_to_fault(&mut supervisor, 0.0, 0, 1000), None);
    assert_eq!(supervisor.state(), State::Disarmed);
}

#[test]
fn a_cleared_monitor_fault_returns_while_its_cause_lasts() {
    let mut supervisor = driving(0);
    for _ in 0..1000 {
        supervisor.check(&reading(60.0), DacCode::ZERO);
    }
    supervisor.apply(&Order::ClearFault, 0);
    let ticks = ticks_to_fault(&mut supervisor, 60.0, 0, 1000);
    assert!(ticks.is_some_and(|ticks| ticks <= WRONG_TICKS), "{ticks:?}");
}

#[test]
fn the_arm_switch_matters_only_while_it_has_to_be_held() {
    let let_go = Sense { arm_switch: false, ..Sense::default() };
    for (state, fault) in [
        (State::Disarmed, None),
        (State::Armed, Some((Fault::ArmSwitch, 0))),
        (State::Active, Some((Fault::ArmSwitch, 0))),
        (State::Faulted, Some((Fault::Deadline, 1))),
    ] {
        let mut supervisor = in_state(state);
        supervisor.check(&let_go, DacCode::ZERO);
        assert_eq!(supervisor.fault(), fault, "{state:?}");
    }
}

/// The first of `ticks` ticks with a fault, for a ready line that is low in the ticks `low_at`.
fn ready_low_at(supervisor: &mut Supervisor, ticks: u32, low_at: &[u32]) -> Option<u32> {
    (0..ticks).find(|tick| {
        supervisor.check(&Sense { amplifier_fault: low_at.contains(tick), ..reading(0.0) }, DacCode::ZERO);
        supervisor.state() == State::Faulted
    })
}

#[test]
fn a_ready_line_is_a_fault_at_its_second_low_sample_within_a_millisecond() {
    for (low_at, fault_at) in [
        (&[5][..], None),
        (&[5, 6], Some(6)),
        (&[5, 45], Some(45)),
        (&[5, 46], None),
        (&[5, 46, 87, 88], Some(88)),
        (&[5, 46, 86], Some(86)),
    ] {
        for state in [State::Disarmed, State::Armed, State::Active] {
            assert_eq!(ready_low_at(&mut in_state(state), 2_000, low_at), fault_at, "{low_at:?}");
        }
    }
}

#[test]
fn an_amplifier_fault_is_latched_in_every_state() {
    let faulty = Sense { amplifier_fault: true, ..reading(0.0) };
    for state in [State::Disarmed, State::Armed, State::Active] {
        let mut supervisor = in_state(state);
        supervisor.check(&faulty, DacCode::ZERO);
        assert_eq!((supervisor.state(), supervisor.fault()), (state, None));
        supervisor.check(&faulty, DacCode::ZERO);
        assert_eq!(supervisor.fault(), Some((Fault::Amplifier, 0)), "{state:?}");
        assert_eq!(supervisor.state(), State::Faulted);
    }
}

/// Every order in every state: an order that is not in this table changes nothing.
#[test]
fn orders_change_the_state_as_in_the_table() {
    let changes = [
        (Order::Arm, State::Disarmed, State::Armed),
        (Order::Play, State::Armed, State::Active),
        (Order::Stop, State::Active, State::Armed),
        (Order::Disarm, State::Armed, State::Disarmed),
        (Order::Disarm, State::Active, State::Disarmed),
        (Order::ClearFault, State::Faulted, State::Disarmed),
    ];
    let orders =
        [Order::SignOfLife, Order::Arm, Order::Play, Order::Stop, Order::Disarm, Order::ClearFault, Order::Unload];
    for order in &orders {
        for before in [State::Disarmed, State::Armed, State::Active, State::Faulted] {
            let mut supervisor = in_state(before);
            supervisor.apply(order, 0);
            let same = |other: &Order| core::mem::discriminant(other) == core::mem::discriminant(order);
            let change = changes.iter().find(|(changing, from, _)| same(changing) && *from == before);
            assert_eq!(supervisor.state(), change.map_or(before, |(_, _, to)| *to), "{before:?}");
        }
    }
}

/// Ticks after the last sign of life, at `heard_at_tick`, until the supervisor disarms.
fn ticks_to_silence(mut supervisor: Supervisor, heard_at_tick: u32, limit: u32) -> Option<u32> {
    supervisor.apply(&Order::SignOfLife, heard_at_tick);
    (1..=limit).find(|ticks| {
        supervisor.expire(heard_at_tick.wrapping_add(*ticks));
        assert_eq!(supervisor.host_silent(), supervisor.state() == State::Disarmed);
        supervisor.state() == State::Disarmed
    })
}

/// The default is a quarter of a second. The timeout also holds when the tick counter wraps.
#[test]
fn a_silent_host_disarms_after_its_timeout() {
    for heard_at_tick in [0, 7, u32::MAX - 10_000, u32::MAX - 5, u32::MAX] {
        for state in [State::Armed, State::Active] {
            assert_eq!(ticks_to_silence(in_state(state), heard_at_tick, 20_000), Some(10_001), "{heard_at_tick}");
            let mut supervisor = in_state(state);
            supervisor.set_host_timeout(800);
            assert_eq!(ticks_to_silence(supervisor, heard_at_tick, 20_000), Some(801), "{heard_at_tick}");
        }
    }
}

/// The age of the last sign of life is an unsigned difference: one of more than 2^31 ticks is old, not in the future.
#[test]
fn a_host_without_a_sign_of_life_for_half_a_day_is_silent() {
    for age_ticks in [801, 1 << 31, (1 << 31) + 1, u32::MAX] {
        for state in [State::Armed, State::Active] {
            let mut supervisor = in_state(state);
            supervisor.set_host_timeout(800);
            supervisor.apply(&Order::SignOfLife, 7);
            supervisor.expire(7_u32.wrapping_add(age_ticks));
            assert_eq!((supervisor.state(), supervisor.host_silent()), (State::Disarmed, true), "{age_ticks}");
        }
    }
}

#[test]
fn the_host_timeout_applies_only_when_armed_or_active() {
    let mut supervisor = in_state(State::Faulted);
    supervisor.expire(1_000_000);
    assert_eq!((supervisor.state(), supervisor.host_silent()), (State::Faulted, false));
    let mut supervisor = in_state(State::Disarmed);
    supervisor.expire(1_000_000);
    assert!(!supervisor.host_silent());
}

#[test]
fn a_host_that_arms_again_is_no_longer_silent() {
    let mut supervisor = in_state(State::Armed);
    supervisor.expire(10_001);
    assert!(supervisor.host_silent());
    supervisor.apply(&Order::SignOfLife, 10_002);
    assert!(supervisor.host_silent(), "it is heard, and has not armed");
    press_switch(&mut supervisor);
    supervisor.apply(&Order::Arm, 10_002);
    assert!(!supervisor.host_silent());
}

/// A switch that is held all the time, or stuck, arms nothing.
#[test]
fn arming_requires_a_switch_opened_since_the_reset_or_the_last_disarming() {
    let armed = |supervisor: &mut Supervisor, now_tick| {
        supervisor.check(&reading(0.0), DacCode::ZERO);
        supervisor.apply(&Order::Arm, now_tick);
        supervisor.state() == State::Armed
    };
    let mut supervisor = Supervisor::new(&BOARD);
    assert!(!armed(&mut supervisor, 1), "held since the reset");
    press_switch(&mut supervisor);
    assert!(armed(&mut supervisor, 2));
    supervisor.apply(&Order::Disarm, 3);
    assert!(!armed(&mut supervisor, 3), "held since it was disarmed");
    press_switch(&mut supervisor);
    assert!(armed(&mut supervisor, 4));
    supervisor.expire(4 + 10_001);
    assert!(!armed(&mut supervisor, 4 + 10_001), "held since the host fell silent");
    supervisor.raise(Fault::Deadline, 1);
    press_switch(&mut supervisor);
    supervisor.apply(&Order::ClearFault, 0);
    assert!(!armed(&mut supervisor, 0), "held since the fault was cleared");
}

proptest! {
    /// A fault is left only by clearing it, and only an order leads beyond Disarmed.
    #[test]
    fn only_orders_lead_to_a_driving_state(
        inputs in proptest::collection::vec((any::<bool>(), any::<bool>(), -300.0_f32..300.0, any::<i16>()), 1..200),
    ) {
        let mut supervisor = in_state(State::Disarmed);
        for (tick, (amplifier_fault, arm_switch, monitor_v, dac_code)) in inputs.into_iter().enumerate() {
            let before = supervisor.state();
            supervisor.check(&Sense { amplifier_fault, monitor_v, arm_switch }, DacCode::from_bits(dac_code));
            supervisor.expire(tick as u32);
            prop_assert!(matches!(supervisor.state(), State::Disarmed | State::Faulted));
            prop_assert!(before != State::Faulted || supervisor.state() == State::Faulted);
        }
    }
}
