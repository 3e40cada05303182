//! The table against the firmware, the pages, and what the safety case says of the circuit.

mod high_voltage;
mod monitor;
mod protection;
mod supplies;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use super::*;

/// A bridge between two of these, or from one to a supply, would defeat a protection.
const GUARDED: [&str; 3] = ["ENABLE_MCU", "READY", "SWITCH_IN"];

/// A processor board: the sources that name its pins, and its pins and supplies in the table.
struct Processor<'a> {
    sources: &'static str,
    /// How the name of a pin begins.
    prefix: &'static str,
    pins: &'a [Pin],
    supplies: &'a [Supply],
    /// Of this board.
    left_open: Vec<&'a LeftOpen>,
}

fn processors(carrier: &Carrier) -> [Processor<'_>; 2] {
    let left_open = |of_nucleo: bool| {
        let pins = carrier.left_open.iter();
        pins.filter(|pin| pin.position.starts_with("CN") == of_nucleo).collect()
    };
    [
        Processor {
            sources: "firmware/board-nucleo-g474re/src",
            prefix: "P",
            pins: &carrier.pin,
            supplies: &carrier.supply,
            left_open: left_open(true),
        },
        Processor {
            sources: "firmware/board-pico/src",
            prefix: "GP",
            pins: &carrier.pico,
            supplies: &carrier.pico_supply,
            left_open: left_open(false),
        },
    ]
}

fn source(sources: &str, module: &str) -> String {
    let path = root().join(sources).join(format!("{module}.rs"));
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn net<'a>(carrier: &'a Carrier, name: &str) -> &'a Net {
    carrier.net.iter().find(|net| net.name == name).unwrap_or_else(|| panic!("no net {name}"))
}

fn value(carrier: &Carrier, name: &str) -> f64 {
    part(carrier, name).value.unwrap()
}

/// Resistors and capacitors, each with its two nets.
fn two_ended(carrier: &Carrier) -> Vec<(&Part, [&Net; 2])> {
    let parts = carrier.part.iter().filter(|part| part.value.is_some());
    parts.map(|part| (part, [1, 2].map(|end| net_of(carrier, &format!("{}.{end}", part.name))))).collect()
}

fn net_of<'a>(carrier: &'a Carrier, node: &str) -> &'a Net {
    let has_node = |net: &&Net| net.nodes.iter().any(|other| other == node);
    carrier.net.iter().find(has_node).unwrap_or_else(|| panic!("{node} is not connected"))
}

fn part<'a>(carrier: &'a Carrier, name: &str) -> &'a Part {
    carrier.part.iter().find(|part| part.name == name).unwrap_or_else(|| panic!("no part {name}"))
}

#[test]
fn the_page_is_that_of_the_table() {
    let held = fs::read_to_string(root().join(PAGE)).unwrap();
    assert!(held == page(&read().unwrap()), "run `cargo xtask hardware` to update {PAGE}");
}

#[test]
fn the_schematic_is_that_of_the_table_and_shows_every_part_once_and_every_node() {
    let carrier = read().unwrap();
    let held = fs::read_to_string(root().join(SCHEMATIC)).unwrap();
    assert!(held == schematic::draw(&carrier), "run `cargo xtask hardware` to update {SCHEMATIC}");
    let lines: Vec<&str> = held.lines().collect();
    let texts = |class: &str, text: &str| {
        let class = format!("class=\"{class}\"");
        lines.windows(2).filter(|pair| pair[0].contains(&class) && pair[1] == text).count()
    };
    for part in &carrier.part {
        assert_eq!(texts(schematic::PART, &part.name), 1, "{}", part.name);
    }
    for net in &carrier.net {
        assert_eq!(texts(schematic::NET, &net.name), net.nodes.len(), "{}", net.name);
    }
    // A remark has half of the drawing's width.
    for pair in lines.windows(2).filter(|pair| pair[0].contains("class=\"remark\"")) {
        assert!(pair[1].len() <= 50, "{}", pair[1]);
    }
}

/// The tables at the top of the modules, and the constants that the code uses.
#[test]
fn pins_are_those_of_the_firmware() {
    let carrier = read().unwrap();
    for Processor { sources, prefix, pins, .. } in processors(&carrier) {
        let mut in_code = BTreeSet::new();
        let row_start = format!("//! | {prefix}");
        for entry in fs::read_dir(root().join(sources)).unwrap() {
            let path = entry.unwrap().path();
            let Some(module) = path.file_stem().and_then(|stem| stem.to_str()).filter(|_| path.is_file()) else {
                continue;
            };
            for row in source(sources, module).lines().filter_map(|line| line.strip_prefix(&row_start)) {
                let cells: Vec<&str> = row.split('|').map(str::trim).collect();
                in_code.insert((format!("{prefix}{}", cells[0]), cells[1].to_owned(), module.to_owned()));
            }
        }
        let in_table: BTreeSet<_> =
            pins.iter().map(|pin| (pin.pin.clone(), pin.function.clone(), pin.module.clone())).collect();
        assert_eq!(in_table, in_code);
        for Pin { pin, module, constant, .. } in pins {
            let Some(constant) = constant else { continue };
            let text = source(sources, module);
            let (port, number) = (&pin[1..2], &pin[2..]);
            let has_ports = prefix == "P";
            // Pins of one bus are connected in a loop.
            assert!(!has_ports || text.contains(&format!("GPIO{port}")), "{pin}: no port in {module}");
            let kind = if has_ports { "u32" } else { "usize" };
            assert!(text.contains(&format!("const {constant}: {kind} = {number};")), "{pin}: {constant} in {module}");
        }
    }
}

/// Either processor board is wired to the same nets.
#[test]
fn both_processor_boards_have_the_same_nets() {
    let carrier = read().unwrap();
    let [nucleo, pico] = processors(&carrier).map(|Processor { pins, supplies, .. }| {
        let of_pins = pins.iter().filter_map(|pin| pin.net.as_deref());
        of_pins.chain(supplies.iter().map(|supply| supply.net.as_str())).collect::<BTreeSet<_>>()
    });
    assert_eq!(pico, nucleo);
}

/// The wires of the self-test: pins as its source has them, positions of the firmware's pins as the table has them.
#[test]
fn the_wires_of_the_self_test_are_those_of_its_page() {
    let carrier = read().unwrap();
    let page = fs::read_to_string(root().join("docs/board/first-board.md")).unwrap();
    let rows: Vec<Vec<&str>> = page
        .lines()
        .map(|line| line.split('|').map(str::trim).collect::<Vec<_>>())
        .filter(|cells| cells.len() == 8 && cells[3].starts_with("CN"))
        .collect();
    let captures = source("firmware/board-nucleo-g474re/src", "bin/self-test/captures");
    let wires = captures.lines().filter_map(|line| line.strip_prefix("//! | P"));
    let mut count = 0;
    for wire in wires {
        let cells: Vec<&str> = wire.split('|').map(str::trim).collect();
        let other = cells[2].split([' ', ',']).nth(1).unwrap();
        let ends = [format!("P{}", cells[0]), other.to_owned()];
        let is_wire = |row: &&Vec<&str>| ends.iter().all(|end| [row[2], row[4]].contains(&end.as_str()));
        let row = rows.iter().find(is_wire).unwrap_or_else(|| panic!("no wire of {ends:?}"));
        for (pin, position) in [(row[2], row[3]), (row[4], row[5])] {
            let known = carrier.pin.iter().find(|known| known.pin == pin);
            assert!(known.is_none_or(|known| known.position == position), "{pin} is not at {position}");
        }
        count += 1;
    }
    assert_eq!((count, rows.len()), (5, 5));
}

#[test]
fn every_node_is_a_part_and_in_one_net() {
    let carrier = read().unwrap();
    let parts: BTreeSet<&str> = carrier.part.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(parts.len(), carrier.part.len(), "a name is used twice");
    let mut nets = BTreeMap::new();
    for net in &carrier.net {
        assert!(net.nodes.len() > 1, "{} leads nowhere", net.name);
        for node in &net.nodes {
            let (part, _) = node.split_once('.').unwrap();
            assert!(parts.contains(part), "{node}: no such part");
            assert_eq!(nets.insert(node.as_str(), net.name.as_str()), None, "{node} is in two nets");
        }
    }
    for part in &parts {
        assert!(nets.keys().any(|node| node.split_once('.').unwrap().0 == *part), "{part} is not connected");
    }
    for Pin { pin, net, .. } in &carrier.pin {
        assert_eq!(nets.get(format!("{BOARD}.{pin}").as_str()), net.as_deref().as_ref(), "{pin}");
    }
    for part in &carrier.part {
        assert_eq!(part.value.is_some(), part.tolerance.is_some(), "{}: its tolerance", part.name);
    }
    for part in carrier.part.iter().filter(|part| part.value.is_some()) {
        let ends = [1, 2].map(|end| nets.get(format!("{}.{end}", part.name).as_str()));
        assert!(ends[0].is_some() && ends[1].is_some() && ends[0] != ends[1], "{}: {ends:?}", part.name);
    }
}

/// The nets of a processor board by connector and pin.
fn used<'a>(Processor { pins, supplies, left_open, .. }: &Processor<'a>) -> BTreeMap<(u32, u32), &'a str> {
    let mut used = BTreeMap::new();
    for pin in pins.iter().filter(|pin| !pin.position.is_empty()) {
        let name = pin.net.as_deref().unwrap_or("on the board");
        assert!(used.insert(place(&pin.position).unwrap(), name).is_none(), "{}", pin.position);
    }
    for supply in *supplies {
        for position in &supply.positions {
            assert!(used.insert(place(position).unwrap(), supply.net.as_str()).is_none(), "{position}");
        }
    }
    for LeftOpen { position, name, .. } in left_open {
        assert!(used.insert(place(position).unwrap(), name).is_none(), "{position} is {name}, to be left open");
    }
    used
}

/// Fails if a pin of a guarded net has a neighbour that may drive it high.
fn check_neighbours(used: &BTreeMap<(u32, u32), &str>, beside: fn(u32) -> Vec<u32>, harmless: &[(&str, &str)]) {
    for name in GUARDED {
        let (&(connector, number), _) = used.iter().find(|(_, net)| **net == name).unwrap();
        for beside in beside(number) {
            let Some(neighbour) = used.get(&(connector, beside)).copied().filter(|net| *net != "COMMON") else {
                continue;
            };
            assert!(harmless.contains(&(name, neighbour)), "{name} is beside {neighbour}");
        }
    }
}

#[test]
fn no_guarded_pin_has_a_neighbour_that_could_drive_it_high() {
    let carrier = read().unwrap();
    let [nucleo, pico] = processors(&carrier);
    // A double row, of which number 1 is beside 2 and 3.
    let in_double_row = |number: u32| {
        let across = if number % 2 == 1 { number + 1 } else { number - 1 };
        [Some(across), number.checked_sub(2), Some(number + 2)].into_iter().flatten().collect()
    };
    check_neighbours(&used(&nucleo), in_double_row, &[]);
    // Two rows, 17.8 mm apart. The enable and CLEAR are high together, as the one-shot makes them.
    let in_row = |number: u32| vec![number - 1, number + 1];
    check_neighbours(&used(&pico), in_row, &[("ENABLE_MCU", "CLEAR")]);
}

#[test]
#[allow(clippy::float_cmp, reason = "numbers of the table, as they are written")]
fn resistances_are_those_of_the_limits() {
    let carrier = read().unwrap();
    let series_ohm = value(&carrier, "R1") + value(&carrier, "R2");
    let board = fs::read_to_string(root().join("firmware/control/src/board.rs")).unwrap();
    let limits = board.split_once("pub const NUCLEO_G474RE").unwrap().1;
    let said = limits.split_once("series_resistance_ohm: ").unwrap().1.split_once(',').unwrap().0;
    assert_eq!(said.parse::<f64>().unwrap(), series_ohm);
    assert_eq!(value(&carrier, "R1"), value(&carrier, "R2"), "each alone must meet the limit of one fault");
    assert_eq!(value(&carrier, "R4") + value(&carrier, "R5"), 100e3);
    // What pulls an RP2350's input down that was high (erratum RP2350-E9).
    for name in ["R11", "R17"] {
        let pull_down = part(&carrier, name);
        assert!(pull_down.value.unwrap() <= 8.2e3 && pull_down.tolerance.unwrap() <= 0.01, "{name}");
    }
}
