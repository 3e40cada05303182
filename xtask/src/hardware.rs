//! `cargo xtask hardware`: writes `docs/board/wiring.md` and `docs/board/schematic.svg` from `hardware/carrier.toml`.

mod schematic;
#[cfg(test)]
mod tests;

use std::fmt::Write;

use serde::Deserialize;

use crate::command::{self, root};

const CARRIER: &str = "hardware/carrier.toml";
const PAGE: &str = "docs/board/wiring.md";
const SCHEMATIC: &str = "docs/board/schematic.svg";
/// The processor board among the parts.
const BOARD: &str = "U1";

/// Pins, parts and nets.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Carrier {
    /// Of the NUCLEO.
    pin: Vec<Pin>,
    supply: Vec<Supply>,
    /// Of a Pico or Pico 2 in its place.
    pico: Vec<Pin>,
    pico_supply: Vec<Supply>,
    left_open: Vec<LeftOpen>,
    part: Vec<Part>,
    net: Vec<Net>,
    measure: Vec<Measure>,
    source: Vec<Current>,
    load: Vec<Current>,
}

/// A pin of the processor that the firmware uses.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Pin {
    pin: String,
    /// Connector and number, such as `CN7-1`, or the number alone; empty for a pin that is on no connector.
    position: String,
    function: String,
    /// The module of the board's firmware that uses it, and the constant there that has its number.
    module: String,
    constant: Option<String>,
    /// Absent for a pin that is connected on the processor board only.
    net: Option<String>,
}

/// Ground or a supply on the connectors.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Supply {
    net: String,
    positions: Vec<String>,
}

/// A pin beside those of the same voltage, which a wire would tie to what it must not be tied to.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct LeftOpen {
    /// As [`Pin::position`].
    position: String,
    name: String,
    why: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Part {
    name: String,
    /// The sheet of the schematic that shows it.
    sheet: String,
    what: String,
    part: String,
    ratings: String,
    /// Ohm or farad.
    value: Option<f64>,
    /// Relative, of a part with a value.
    tolerance: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Net {
    name: String,
    why: String,
    /// `PART.PIN` of all that is connected.
    nodes: Vec<String>,
    /// The largest voltage to the common, of either sign, V; negative if it is always negative.
    peak_v: Option<f64>,
    /// It does not leave the closed box of the amplifier.
    #[serde(default)]
    boxed: bool,
}

/// A measurement by the builder, with everything connected, off and at 0 V.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Measure {
    /// Two nets.
    between: [String; 2],
    why: String,
    /// The parts that are measured, in series; empty if none of the table's parts is meant.
    parts: Vec<String>,
    unit: Unit,
    least: Option<f64>,
    most: Option<f64>,
    /// Relative error of the meter.
    error: f64,
}

#[derive(Clone, Copy, Debug, Deserialize)]
enum Unit {
    Ohm,
    Farad,
}

/// The current that a part supplies to a net or takes from it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Current {
    net: String,
    part: String,
    ma: f64,
    why: String,
}

/// Writes the page and the schematic.
pub(crate) fn write() -> Result<(), String> {
    let carrier = read()?;
    for (name, content) in [(PAGE, page(&carrier)), (SCHEMATIC, schematic::draw(&carrier))] {
        command::write(&root().join(name), content)?;
    }
    Ok(())
}

fn read() -> Result<Carrier, String> {
    toml::from_str(&command::text(&root().join(CARRIER))?).map_err(|error| format!("{CARRIER}: {error}"))
}

/// Connector and number of a position, by which positions are in order. The only connector of a board is number 0.
fn place(position: &str) -> Option<(u32, u32)> {
    let Some(position) = position.strip_prefix("CN") else { return Some((0, position.parse().ok()?)) };
    let (connector, number) = position.split_once('-')?;
    Some((connector.parse().ok()?, number.parse().ok()?))
}

/// A table of pins and supplies by position. `on_board` has the destination of a pin without a net.
fn pin_table(carrier: &Carrier, pins: &[Pin], supplies: &[Supply], on_board: &str) -> String {
    let mut text = String::from("| position | pin | net | to | function | module |\n|---|---|---|---|---|---|\n");
    let others = |name: &str| {
        let net = carrier.net.iter().find(|net| net.name == name);
        let is_outside = |node: &&String| !node.starts_with(&format!("{BOARD}."));
        let nodes = net.into_iter().flat_map(|net| &net.nodes).filter(is_outside).cloned();
        nodes.collect::<Vec<_>>().join(", ")
    };
    let mut pins: Vec<&Pin> = pins.iter().collect();
    pins.sort_by_key(|pin| place(&pin.position));
    for Pin { pin, position, function, module, constant, net } in pins {
        let net = net.as_deref().unwrap_or_default();
        let to = if net.is_empty() { on_board.to_owned() } else { others(net) };
        // Writing to a string cannot fail.
        let constant = constant.as_ref().map_or(String::new(), |constant| format!("::{constant}"));
        let _ = writeln!(text, "| {position} | {pin} | {net} | {to} | {function} | `{module}{constant}` |");
    }
    for Supply { net, positions } in supplies {
        let _ = writeln!(text, "| {} | | {net} | {} | | |", positions.join(", "), others(net));
    }
    text
}

fn page(carrier: &Carrier) -> String {
    let mut text = String::from(
        "# Wiring\n\nWritten by `cargo xtask hardware` from `hardware/carrier.toml`; a test holds it. Read\n\
         [safety.md](safety.md) and [hardware.md](hardware.md) first: they say why, and what to measure before\n\
         anything is switched on. Nobody has built this yet.\n\n\
         ![schematic](schematic.svg)\n\n\
         The schematic has a sheet for each function; a name at the end of a line is a net, and equal names are\n\
         connected. Pins of U1 are those of the NUCLEO, and of a Pico.\n\n\
         ## By connector and pin\n\nThe NUCLEO's connectors CN7 and CN10. Compare the positions with your board before \
         you solder. Every row goes to all other nodes of its net.\n\n",
    );
    text += &pin_table(carrier, &carrier.pin, &carrier.supply, "on the NUCLEO");
    text += "\n## With a Pico or Pico 2\n\n**Connect no amplifier to these boards yet**: \
             they have no bring-up ([pico.md](pico.md)). In place of the NUCLEO: the pins around the board, by their\n\
             number. The nodes of U1 among the nets below are the NUCLEO's.\n\n";
    text += &pin_table(carrier, &carrier.pico, &carrier.pico_supply, "serial port, or on the board");
    text += "\n## Left open\n\nPins of the processor boards that look like a supply of the carrier and must not be \
             wired to it.\n\n\
             | position | pin | |\n|---|---|---|\n";
    for LeftOpen { position, name, why } in &carrier.left_open {
        let _ = writeln!(text, "| {position} | {name} | {why} |");
    }
    text += &high_voltage(carrier);
    text += &measures(carrier);
    text += &supplies(carrier);
    text += "\n## Nets\n\n| net | nodes | |\n|---|---|---|\n";
    for Net { name, why, nodes, .. } in &carrier.net {
        let _ = writeln!(text, "| {name} | {} | {why} |", nodes.join(", "));
    }
    text += "\n## Bill of materials\n\nWhere a part is \"any\", the ratings decide.\n\n\
             | name | what | value | part | ratings |\n|---|---|---|---|---|\n";
    for Part { name, what, part, ratings, value, tolerance, .. } in &carrier.part {
        let mut value = value.map_or(String::new(), |value| value_text(Unit::of(name), value));
        if let Some(tolerance) = tolerance {
            let _ = write!(value, ", {} %", rounded(100.0 * tolerance, 3));
        }
        let _ = writeln!(text, "| {name} | {what} | {value} | {part} | {ratings} |");
    }
    text
}

/// Voltages to the common above which a net is dangerous, V peak (`docs/board/safety.md`).
const DANGEROUS_V: f64 = 42.4;

impl Net {
    fn is_dangerous(&self) -> bool {
        self.peak_v.is_some_and(|peak_v| peak_v.abs() > DANGEROUS_V)
    }
}

fn high_voltage(carrier: &Carrier) -> String {
    let mut text = String::from(
        "\n## High voltage\n\nWhat is *in the box* has no 68 kOhm in front of it: one box of insulating material,\n\
         closed, opened with a tool only, with 200 V written on it. Amplifier, supply of the rails and **both series\n\
         resistors** are in it, the resistors at the amplifier's output without a cable. Only the electrode's wire,\n\
         the input of the supply and the low voltages leave it. Wires of these nets are rated for 600 V. Between any\n\
         of them and any other net, and between the two rails, are 5 mm or more, through air and along surfaces;\n\
         between them and protective earth, the host's USB, the supply's input and the outside, 10 mm or more: for\n\
         420 V between the rails, 4.2 mm, and twice that where insulation is reinforced (IEC 60664-1, table F.4,\n\
         pollution degree 2, material group III, in a public copy: 4 mm for 400 V, 5 mm for 500 V). A rail may be 5 %\n\
         above its 200 V.\n\n\
         | net | V peak to the common | where |\n|---|---|---|\n",
    );
    for net in carrier.net.iter().filter(|net| net.is_dangerous()) {
        let place = if net.boxed { "**in the box**" } else { "leaves the box" };
        let _ = writeln!(text, "| {} | {} | {place} |", net.name, net.peak_v.unwrap_or_default().abs());
    }
    text
}

fn measures(carrier: &Carrier) -> String {
    let mut text = String::from(
        "\n## Measure before anything is switched on\n\nWith everything connected, USB pulled, all supplies off and\n\
         the rails at 0 V. The limits are those of the reading; the meter may be wrong by as much as the\n\
         last column says.\n\n\
         | from | to | parts | at least | at most | why | meter |\n|---|---|---|---|---|---|---|\n",
    );
    for Measure { between: [from, to], why, parts, unit, least, most, error } in &carrier.measure {
        let [least, most] = [least, most].map(|limit| limit.map_or(String::new(), |value| value_text(*unit, value)));
        let error = rounded(100.0 * error, 3);
        let _ = writeln!(text, "| {from} | {to} | {} | {least} | {most} | {why} | {error} % |", parts.join(", "));
    }
    text
}

fn supplies(carrier: &Carrier) -> String {
    let mut text =
        String::from("\n## Supplies\n\n| net | from | mA at most | to | mA | sum | |\n|---|---|---|---|---|---|---|\n");
    for Current { net, part, ma, why } in &carrier.source {
        let loads: Vec<&Current> = carrier.load.iter().filter(|load| load.net == *net).collect();
        let sum = rounded(loads.iter().map(|load| load.ma).sum(), 1);
        let _ = writeln!(text, "| {net} | {part} | {ma} | | | {sum} | {why} |");
        for Current { part, ma, why, .. } in loads {
            let _ = writeln!(text, "| | | | {part} | {ma} | | {why} |");
        }
    }
    text
}

impl Unit {
    /// That of a part's value, by the first letter of its name.
    fn of(name: &str) -> Self {
        if name.starts_with('C') { Self::Farad } else { Self::Ohm }
    }
}

fn value_text(unit: Unit, value: f64) -> String {
    let (unit, [small, large]) = match unit {
        Unit::Farad => ("F", [(1e-9, "n"), (1e-6, "u")]),
        Unit::Ohm => ("Ohm", [(1e3, "k"), (1e6, "M")]),
    };
    let (scale, prefix) = if value < 0.99 * large.0 && !(unit == "F" && value >= 0.05e-6) { small } else { large };
    format!("{} {prefix}{unit}", rounded(value / scale, 2))
}

/// A number with at most some digits behind the point.
fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
