//! What disables the amplifier and puts the DAC at zero: each of its parts is there, between the nets that it is for.

use super::*;

/// The amplifier's enable connects only to the switch's second pole and to a resistor to the common. Before the pole,
/// both one-shots must agree, and the second is fed by SYNC.
#[test]
fn the_enable_goes_through_both_one_shots_and_the_switch() {
    let carrier = read().unwrap();
    assert_eq!(net(&carrier, "ENABLE").nodes, ["S1.4", "A1.ENABLE", "R7.1"]);
    assert_eq!(net(&carrier, "ENABLE_LOGIC").nodes, ["U4.Y", "S1.3"]);
    assert_eq!(net(&carrier, "ALIVE").nodes, ["U3.Q", "U4.B", "R25.1"]);
    assert!(net(&carrier, "ENABLE_MCU").nodes.iter().any(|node| node == "U4.A"));
    assert!(net(&carrier, "SYNC").nodes.iter().any(|node| node == "U3.B"));
    // A wire that comes off an input of the gate reads as low: the resistor is on the gate's side of it.
    for input in ["U4.A", "U4.B"] {
        let net = net_of(&carrier, input);
        let pulls_down = |(part, nets): &(&Part, [&Net; 2])| {
            let names = nets.map(|net| net.name.as_str());
            part.what.contains("soldered at U4")
                && part.name.starts_with('R')
                && names.contains(&"COMMON")
                && names.contains(&net.name.as_str())
        };
        assert!(two_ended(&carrier).iter().any(pulls_down), "{input} floats without its wire");
    }
}

/// Each of these pins and parts is part of a protection, and everything works as before with one of them elsewhere.
#[test]
fn what_protects_is_between_the_nets_that_it_is_for() {
    let carrier = read().unwrap();
    for (pin, name) in [
        ("U3.A", "COMMON"),
        ("U3.CLR", "3V3"),
        ("U3.B", "SYNC"),
        ("U2.SYNC", "SYNC"),
        ("U2.LDAC", "COMMON"),
        ("U2.RESET", "NRST"),
        ("U2.CLEAR", "CLEAR"),
        ("S1.1", "3V3"),
        ("S1.2", "SWITCH"),
        ("U1.USB", "USB"),
        ("X1.DEVICE", "USB"),
        ("K2.1", "RETURN"),
    ] {
        assert_eq!(net_of(&carrier, pin).name, name, "{pin}");
    }
    let parts = two_ended(&carrier);
    for (name, ends) in [
        ("R3", ["ELECTRODE", "COMMON"]),
        ("R4", ["RETURN", "RETURN_MIDDLE"]),
        ("R5", ["RETURN_MIDDLE", "COMMON"]),
        ("R6", ["ENABLE_MCU", "COMMON"]),
        ("R7", ["ENABLE", "COMMON"]),
        ("R8", ["CLEAR", "COMMON"]),
        ("R9", ["SYNC", "3V3"]),
        ("R10", ["SWITCH", "SWITCH_IN"]),
        ("R11", ["SWITCH_IN", "COMMON"]),
        ("R12", ["MONO_RC", "3V3"]),
        ("R17", ["READY", "COMMON"]),
        ("R18", ["SIGNAL", "COMMON"]),
        ("R25", ["ALIVE", "COMMON"]),
        ("C1", ["SWITCH_IN", "COMMON"]),
        ("C2", ["MONO_RC", "MONO_C"]),
    ] {
        let (_, nets) = parts.iter().find(|(part, _)| part.name == name).unwrap();
        assert_eq!(nets.map(|net| net.name.as_str()), ends, "{name}");
    }
}

/// A good board passes every measurement with a meter that is as wrong as it may be, and no missing part passes. The
/// parts lie in a row from one of the nets to the other.
#[test]
fn what_is_to_be_measured_is_what_the_parts_give() {
    let carrier = read().unwrap();
    let two_ended = two_ended(&carrier);
    for Measure { between, why, parts, least, most, error, .. } in &carrier.measure {
        assert!(between.iter().all(|net| carrier.net.iter().any(|other| other.name == *net)), "{between:?}");
        assert!(!why.is_empty() && *error > 0.0);
        if parts.is_empty() {
            continue;
        }
        let (mut low, mut high) = (0.0, 0.0);
        let mut reached = between[0].as_str();
        for name in parts {
            let (part, nets) = two_ended.iter().find(|(part, _)| part.name == *name).unwrap();
            let ends = nets.map(|net| net.name.as_str());
            assert!(ends.contains(&reached), "{between:?}: {name} is between {ends:?}, not at {reached}");
            reached = if ends[0] == reached { ends[1] } else { ends[0] };
            let (value, tolerance) = (part.value.unwrap(), part.tolerance.unwrap());
            assert!(least.unwrap() > high, "{between:?} passes without {name}");
            low += value * (1.0 - tolerance);
            high += value * (1.0 + tolerance);
        }
        assert_eq!(reached, between[1], "{between:?}: where {parts:?} lead");
        assert!(low * (1.0 - error) >= least.unwrap(), "{between:?}: {low}");
        assert!(high * (1.0 + error) <= most.unwrap(), "{between:?}: {high}");
    }
}

/// The limits of both halves of the series resistance are those at which bring-up goes on.
#[test]
fn the_series_resistors_are_measured_as_bring_up_asks() {
    let carrier = read().unwrap();
    let script = source("firmware/board/src/bring_up", "amplifier");
    let ratios = script.split_once("SERIES_RATIO: (f32, f32) = (").unwrap().1.split_once(')').unwrap().0;
    let [least, most] = ratios.split(", ").collect::<Vec<_>>().try_into().unwrap();
    for name in ["R1", "R2"] {
        let measure = carrier.measure.iter().find(|measure| measure.parts == [name]).unwrap();
        for (limit, ratio) in [(measure.least, least), (measure.most, most)] {
            let asked = ratio.parse::<f64>().unwrap() * value(&carrier, name);
            assert!((limit.unwrap() / asked - 1.0).abs() < 1e-9, "{name}: {limit:?}, bring-up asks for {asked}");
        }
    }
}

/// The largest resistance that a reading allows holds CLEAR low against the DAC's own pull-up: 55 uA at most, and low
/// below 0.3 DVCC (AD5761R-EP).
#[test]
fn clear_is_low_against_the_pull_up_inside_the_dac() {
    let carrier = read().unwrap();
    let measure = carrier.measure.iter().find(|measure| measure.parts == ["R8"]).unwrap();
    let largest_ohm = measure.most.unwrap() * (1.0 + measure.error);
    assert!(55e-6 * largest_ohm < 0.7 && 0.7 < 0.3 * 3.0, "{largest_ohm}");
    assert!(net(&carrier, "CLEAR").why.contains("0.7 V at most"));
}

/// With the wire from the DAC off, the amplifier's input is at 0 V; with it on, the resistor is no load.
#[test]
fn the_amplifiers_input_is_held_at_zero_without_the_dac() {
    let carrier = read().unwrap();
    let ohm = value(&carrier, "R18");
    // What the input takes, by the amplifier's rating, behind a gain of 20: below a tenth of the least drive, 10 V.
    assert!(1e-6 * ohm * 20.0 < 1.0);
    // The DAC gives some milliamperes, behind 0.5 Ohm (AD5761R-EP).
    assert!(10.0 / ohm < 2e-3 && 0.5 / ohm < 1e-3);
}

#[test]
fn each_pole_of_the_switch_has_a_cable_of_its_own() {
    let carrier = read().unwrap();
    let switch = part(&carrier, "S1");
    assert!(switch.ratings.contains("each pole on a cable of its own"), "{}", switch.ratings);
}

/// The monostable lives longer than some ticks, and at most 1 ms, with every part at the end of its tolerance; and each
/// tick triggers it anew.
#[test]
fn the_monostable_outlives_ticks_and_not_a_millisecond() {
    let carrier = read().unwrap();
    let ends = [-1.0, 1.0].map(|end| {
        let of = |name| {
            let found = part(&carrier, name);
            found.value.unwrap() * (1.0 + end * found.tolerance.unwrap())
        };
        of("R12") * of("C2")
    });
    let Part { part, ratings, .. } = part(&carrier, "U3");
    assert!(part.contains("SN74LVC1G123") && !part.contains("74HC123"), "{part}");
    let behind = |said: &str| -> f64 {
        let (_, number) = ratings.split_once(said).unwrap_or_else(|| panic!("{ratings}"));
        number.split([' ', ',']).next().unwrap().parse().unwrap()
    };
    let [shortest_s, longest_s] = [behind("K = ") * ends[0], behind("K = 0.9 to ") * ends[1]];
    // A tick is 25 us, or 125 us on a Pico.
    assert!(shortest_s > 4.0 * 125e-6, "{shortest_s}");
    assert!(longest_s < 1e-3, "{longest_s}");
    // Bring-up takes a mean of 0.8 to 1.65 V, of 3.3 V, with an edge of SYNC every 2 ms.
    let taken_s = [0.8, 1.65].map(|mean_v| 2e-3 * mean_v / 3.3);
    assert!(taken_s[0] < shortest_s && longest_s < taken_s[1], "{taken_s:?}");
    let said = format!("bring-up measures a pulse of {:.3} to {:.1} ms", 1e3 * taken_s[0], 1e3 * taken_s[1]);
    assert!(ratings.contains(&said), "{ratings}");
}
