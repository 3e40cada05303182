//! Supplies: what gives how much, which pins are left open, and what is decoupled.

use super::*;

#[test]
fn every_supply_gives_what_its_parts_take() {
    let carrier = read().unwrap();
    for Current { net: name, part, ma, .. } in &carrier.source {
        let nodes = &net(&carrier, name).nodes;
        let taken: f64 = carrier.load.iter().filter(|load| load.net == *name).map(|load| load.ma).sum();
        assert!(taken > 0.0 && taken <= 0.8 * ma, "{name}: {taken} of {ma} mA");
        // Resistors and capacitors are in the remarks of the parts that they serve.
        for node in nodes {
            let other = node.split_once('.').unwrap().0;
            let has_value = carrier.part.iter().any(|part| part.name == other && part.value.is_some());
            let is_load = carrier.load.iter().any(|load| load.net == *name && load.part == other);
            assert!(has_value || is_load || other == part, "{node} takes nothing from {name}");
        }
    }
    let sources: BTreeSet<&str> = carrier.source.iter().map(|source| source.net.as_str()).collect();
    assert!(carrier.load.iter().all(|load| sources.contains(load.net.as_str())));
    for supply in carrier.supply.iter().filter(|supply| !["COMMON", "NRST"].contains(&supply.net.as_str())) {
        assert!(sources.contains(supply.net.as_str()), "{}", supply.net);
    }
}

/// Two pins that are called alike may lie on either side of a power switch.
#[test]
fn a_supply_comes_from_one_pin_and_not_from_those_that_are_left_open() {
    let carrier = read().unwrap();
    for processor in processors(&carrier) {
        for Supply { net, positions } in processor.supplies.iter().filter(|supply| supply.net != "COMMON") {
            assert_eq!(positions.len(), 1, "{}: {net}", processor.sources);
        }
        // No position is in it twice.
        used(&processor);
    }
    for name in ["E5V", "5V_USB", "AVDD", "VDD"] {
        assert!(carrier.left_open.iter().any(|pin| pin.name == name), "{name}");
    }
}

/// Each supply pin of a chip on the carrier has a capacitor of 0.1 uF to the common. The DAC's reference has 10 nF, as
/// its data sheet asks for: 0.1 uF behind its 25 kOhm take ten times as long to start.
#[test]
fn chips_are_decoupled() {
    let carrier = read().unwrap();
    let (supply_f, reference_f) = (0.1e-6, 10e-9);
    for (pin, capacitor, farad) in [
        ("U2.VDD", "C3", supply_f),
        ("U2.VSS", "C5", supply_f),
        ("U2.DVCC", "C7", supply_f),
        ("U2.VREF", "C8", reference_f),
        ("U3.VCC", "C9", supply_f),
        ("U4.VCC", "C10", supply_f),
        ("A2.VCC", "C11", supply_f),
    ] {
        let has = |net: &Net, node: &str| net.nodes.iter().any(|other| other == node);
        assert!(has(net_of(&carrier, pin), &format!("{capacitor}.1")), "{pin} without {capacitor}");
        assert!(has(net(&carrier, "COMMON"), &format!("{capacitor}.2")), "{capacitor}");
        assert!((value(&carrier, capacitor) / farad - 1.0).abs() < 1e-9, "{capacitor}");
    }
}

/// The DAC bears 16.5 V at VDD and -16.5 V at VSS.
#[test]
fn the_dacs_supply_is_regulated_within_what_the_dac_bears() {
    let carrier = read().unwrap();
    let number = |name: &str, before: &str| -> f64 {
        let Part { ratings, .. } = part(&carrier, name);
        let (_, number) = ratings.split_once(before).unwrap_or_else(|| panic!("no {before} in {ratings}"));
        number.split(' ').next().unwrap().parse().unwrap()
    };
    assert!(part(&carrier, "PS2").part.contains("regulated"));
    assert!(part(&carrier, "PS2").ratings.contains("% from 0 to 30 mA"), "its voltage without a load");
    let largest_v = number("PS2", "+-") * (1.0 + 0.01 * number("PS2", "V within "));
    for bears in ["bears ", "at VDD and -"] {
        assert!(largest_v < number("U2", bears), "{largest_v} V");
    }
}

/// The optical frame is supplied with 5 V, and talks at 3.3 V.
#[test]
fn the_optical_frame_has_the_supply_of_its_guide() {
    let carrier = read().unwrap();
    assert!(net(&carrier, "5V").nodes.iter().any(|node| node == "F1.VBUS"));
    for pull_up in ["R14.2", "R15.2"] {
        assert!(net(&carrier, "3V3").nodes.iter().any(|node| node == pull_up));
    }
    let frame = part(&carrier, "F1");
    assert!(frame.ratings.contains("N_RST") && frame.ratings.contains("0.1 A"), "{}", frame.ratings);
}

/// A Pico's inputs bear 3.3 V.
#[test]
fn what_a_pico_reads_is_never_above_its_supply() {
    let carrier = read().unwrap();
    let ratings = |name: &str| &part(&carrier, name).ratings;
    assert!(ratings("A1").contains("READY never more than 3.3 V"));
    assert!(ratings("F1").contains("signals of 3.3 V"));
    assert!(net(&carrier, "3V3").nodes.iter().any(|node| node == "S1.1"), "the switch closes to 3.3 V");
    assert!(ratings("X1").contains("a hub that both plug into"), "probe and supply are two cables");
    assert!(ratings("X1").contains("that has no supply of its own"), "its adapter may be on earth");
}
