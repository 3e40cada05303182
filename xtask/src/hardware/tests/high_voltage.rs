//! What is dangerous: where it is, what stands in front of it, and what it stores.

use std::collections::BTreeMap;

use super::*;

/// A supply may be this much above what it says (`PS1`).
const RAILS_TOLERANCE: f64 = 0.05;
const RAILS_V: f64 = 400.0;

/// The least resistance between the outputs of amplifier and supply and each net that they reach without passing the
/// common. A capacitor is none.
fn resistance_from_source(carrier: &Carrier) -> BTreeMap<&str, f64> {
    let sources = ["A1.OUT", "A1.VPLUS", "A1.VMINUS"];
    let is_source = |net: &&Net| net.nodes.iter().any(|node| sources.contains(&node.as_str()));
    let mut found: BTreeMap<&str, f64> =
        carrier.net.iter().filter(is_source).map(|net| (net.name.as_str(), 0.0)).collect();
    assert_eq!(found.len(), sources.len());
    // As many rounds as there are nets reach all of them.
    for _ in &carrier.net {
        for (part, [one, other]) in two_ended(carrier) {
            let ohm = if part.name.starts_with('R') { part.value.unwrap() } else { 0.0 };
            for (from, to) in [(one, other), (other, one)] {
                let Some(before) = found.get(from.name.as_str()).copied() else { continue };
                let least = found.get(to.name.as_str()).copied().unwrap_or(f64::INFINITY).min(before + ohm);
                if to.name != "COMMON" {
                    found.insert(&to.name, least);
                }
            }
        }
    }
    found
}

/// A person touches the electrode; everything with less than the whole series resistance in front of it is in the box.
#[test]
fn a_net_that_leaves_the_box_is_behind_both_series_resistors() {
    let carrier = read().unwrap();
    let series_ohm = value(&carrier, "R1") + value(&carrier, "R2");
    let reached = resistance_from_source(&carrier);
    assert!(reached.contains_key("ELECTRODE") && reached.contains_key("HV_MIDDLE"));
    for net in &carrier.net {
        let ohm = reached.get(net.name.as_str()).copied();
        assert_eq!(net.boxed, ohm.is_some_and(|ohm| ohm < series_ohm), "{}: {ohm:?}", net.name);
        assert_eq!(net.is_dangerous(), ohm.is_some(), "{}: its voltage", net.name);
        for node in net.nodes.iter().filter(|_| net.boxed) {
            let name = node.split_once('.').unwrap().0;
            assert!(["A1", "PS1", "R1", "R2", "R16", "R24"].contains(&name), "{node} is in the box");
        }
    }
}

#[test]
fn parts_bear_the_voltage_between_their_nets() {
    let carrier = read().unwrap();
    let mut rated = 0;
    // A bare electrode and a hand on the return contact join two nets. Either half of the return path bears all of it.
    let bare_v = net(&carrier, "ELECTRODE").peak_v;
    let peak_v = |net: &Net| if net.name.starts_with("RETURN") { bare_v } else { net.peak_v }.unwrap_or_default();
    for (part, nets) in two_ended(&carrier) {
        let [one, other] = nets.map(peak_v);
        // Between nets of one sign, one may be at zero.
        let across_v = if one * other < 0.0 { one.abs() + other.abs() } else { one.abs().max(other.abs()) };
        let says_v = part.ratings.split_once(" V").and_then(|(before, _)| before.rsplit(' ').next()?.parse().ok());
        if across_v > 5.0 {
            let says_v: f64 = says_v.unwrap_or_else(|| panic!("{} is rated for no voltage", part.name));
            assert!(says_v >= 1.2 * across_v, "{}: {across_v} V, rated for {says_v}", part.name);
            rated += 1;
        }
    }
    assert!(rated >= 11, "{rated}");
}

fn measure<'a>(carrier: &'a Carrier, from: &str, to: &str) -> &'a Measure {
    carrier.measure.iter().find(|measure| measure.between == [from, to]).unwrap()
}

/// With a meter that reads too little, and a supply that gives too much: at most 45 uC over both rails and from one,
/// and below 30 V within 10 s (`docs/board/safety.md`).
#[test]
fn the_stored_charge_is_within_its_limit_for_every_reading_that_is_allowed() {
    let carrier = read().unwrap();
    let most = |from, to| {
        let measure = measure(&carrier, from, to);
        assert!(matches!(measure.unit, Unit::Farad));
        measure.most.unwrap() * (1.0 + measure.error)
    };
    let rails_v = RAILS_V * (1.0 + RAILS_TOLERANCE);
    let rails_f = most("RAIL_PLUS", "RAIL_MINUS");
    assert!(rails_f * rails_v <= 45e-6, "{} uC", 1e6 * rails_f * rails_v);
    for rail in ["RAIL_PLUS", "RAIL_MINUS"] {
        let coulomb = most(rail, "COMMON") * 0.5 * rails_v;
        assert!(coulomb <= 45e-6, "{rail}: {} uC", 1e6 * coulomb);
    }
    // The slowest way in which capacitors between three nets discharge through one resistor from each rail to the
    // common; what a meter shows between two nets is no less than the capacitor between them.
    let slowest_f = most("RAIL_PLUS", "COMMON").max(most("RAIL_MINUS", "COMMON")) + 2.0 * rails_f;
    for (name, rail) in [("R16", "RAIL_PLUS"), ("R24", "RAIL_MINUS")] {
        for node in [format!("{name}.1"), format!("{name}.2")] {
            let is_there = |net: &&str| self::net(&carrier, net).nodes.contains(&node);
            assert!(["COMMON", rail].iter().any(is_there), "{node}");
        }
        let bleeder = part(&carrier, name);
        let bleeder_ohm = bleeder.value.unwrap() * (1.0 + bleeder.tolerance.unwrap());
        // Both rails together are the length of a vector, which is what decays.
        assert!(bleeder_ohm * slowest_f * (rails_v * 0.5_f64.sqrt() / 30.0).ln() < 10.0, "{name}");
    }
    // No capacitor of the table adds to what is measured.
    for (part, nets) in two_ended(&carrier) {
        assert!(!part.name.starts_with('C') || nets.iter().all(|net| !net.is_dangerous()), "{}", part.name);
    }
    let supply = part(&carrier, "PS1");
    for said in ["within 5 %", "0.1 uF between the rails", "0.2 uF from each"] {
        assert!(supply.ratings.contains(said), "{}", supply.ratings);
    }
}

/// IEC 60664-1, table F.4, pollution degree 2, material group III, in a public copy: 4 mm for 400 V, 5 mm for 500 V.
#[test]
fn insulation_and_distances_are_those_of_the_largest_voltage_between_the_rails() {
    let carrier = read().unwrap();
    let rails_v = RAILS_V * (1.0 + RAILS_TOLERANCE);
    for name in ["PS1", "X1"] {
        let said = format!("reinforced insulation for {rails_v} V");
        assert!(part(&carrier, name).part.contains(&said), "{name} without {said}");
    }
    let needed_mm = 4.0 + (rails_v - 400.0) / 100.0;
    let page = page(&carrier);
    let millimetres: Vec<f64> =
        page.split(" mm or more").filter_map(|before| before.rsplit(' ').next()?.parse().ok()).collect();
    let &[basic_mm, reinforced_mm] = &millimetres[..] else { panic!("{millimetres:?}") };
    assert!(basic_mm >= needed_mm && reinforced_mm >= 2.0 * needed_mm, "{needed_mm} mm: {millimetres:?}");
}

/// Metal behind the screen is capacitance that the edges do not count, and a way from the electrode to earth.
#[test]
fn nothing_conductive_is_behind_the_electrode() {
    let carrier = read().unwrap();
    let ratings = &part(&carrier, "K1").ratings;
    let said = "nothing conductive within 20 mm behind it, so no display and no metal table";
    assert!(ratings.contains(said), "{ratings}");
    // 10 cm by 10 cm with earth on all of its back, and 30 pF of wire.
    let behind_f = 8.854e-12 * 0.01 / 20e-3 + 30e-12;
    assert!(behind_f < 50e-12 && ratings.contains("50 pF or less to the common without a finger"), "{behind_f}");
    let safety = fs::read_to_string(root().join("docs/board/safety.md")).unwrap();
    assert!(safety.contains("within 20 mm behind") && safety.contains("**no more than 50 pF**"));
}

/// Switching the rails off does not rely on the firmware, and no wire ties the supply's input to the common.
#[test]
fn the_rails_have_a_switch_of_their_own_in_front_of_the_insulation() {
    let carrier = read().unwrap();
    let nodes = |name| net(&carrier, name).nodes.iter().map(String::as_str).collect::<Vec<_>>();
    assert_eq!(nodes("RAIL_SUPPLY"), ["J1.PLUS", "S2.1"]);
    assert_eq!(nodes("RAIL_SUPPLY_ON"), ["S2.2", "PS1.IN_PLUS"]);
    assert_eq!(nodes("RAIL_SUPPLY_RETURN"), ["J1.MINUS", "PS1.IN_MINUS"]);
}

/// R3 and the series resistance divide the voltage, and the limits do not count it.
#[test]
fn what_the_discharging_resistor_takes_is_said() {
    let carrier = read().unwrap();
    let hardware = fs::read_to_string(root().join("docs/board/hardware.md")).unwrap();
    let series_ohm = value(&carrier, "R1") + value(&carrier, "R2");
    // Built in, and for 150 V rms (`frixel board safety`).
    for series_ohm in [series_ohm, 374e3] {
        let taken = series_ohm / (series_ohm + value(&carrier, "R3"));
        let said = format!("{:.1} % at {} kOhm", 100.0 * taken, 1e-3 * series_ohm);
        assert!(hardware.contains(&said), "{said}");
    }
}
