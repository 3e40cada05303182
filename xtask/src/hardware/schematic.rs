//! The schematic: a sheet for each function, with a box for each part. Nets are names at the ends of the pins.

use std::collections::BTreeMap;

use svg::Document;
use svg::node::element::{Group, Line, Rectangle, Text};

use super::{BOARD, Carrier, Part, Unit, value_text};

/// Lengths, in pixels.
const WIDTH: f64 = 1180.0;
const MARGIN: f64 = 20.0;
const COLUMN: f64 = 570.0;
const BOX_WIDTH: f64 = 250.0;
const ROW: f64 = 18.0;
const HEADER: f64 = 40.0;
const GAP: f64 = 26.0;
const PIN: f64 = 22.0;
const SYMBOL_WIDTH: f64 = 60.0;
const SYMBOL_HEIGHT: f64 = 16.0;
const SYMBOL_ROW: f64 = 56.0;
/// Distance of a text's baseline from the middle of its line.
const BASELINE: f64 = 4.0;

/// Classes of texts, by which a test counts them.
pub(super) const PART: &str = "part";
pub(super) const NET: &str = "net";
const PIN_NAME: &str = "pin";
const REMARK: &str = "remark";

const INK: &str = "#222";
/// Nets that carry a high voltage.
const DANGER: &str = "#c00";

/// The schematic as SVG.
pub(super) fn draw(carrier: &Carrier) -> String {
    let mut nets = BTreeMap::new();
    for net in &carrier.net {
        let color = if net.is_dangerous() { DANGER } else { INK };
        for node in &net.nodes {
            if let Some((part, pin)) = node.split_once('.') {
                let pico = carrier.pico.iter().find(|pico| part == BOARD && pico.net.as_ref() == Some(&net.name));
                let name = pico.map_or_else(|| pin.to_owned(), |pico| format!("{pin}, {}", pico.pin));
                nets.entry(part).or_insert_with(Vec::new).push(Pin { name, net: &net.name, color });
            }
        }
    }
    let mut sheets: Vec<&str> = Vec::new();
    for part in &carrier.part {
        if !sheets.contains(&part.sheet.as_str()) {
            sheets.push(&part.sheet);
        }
    }
    let mut drawing = Drawing { group: Group::new(), y: MARGIN };
    for sheet in sheets {
        let parts = carrier.part.iter().filter(|part| part.sheet == sheet);
        let parts: Vec<(&Part, &[Pin])> =
            parts.map(|part| (part, nets.get(part.name.as_str()).map_or(&[][..], Vec::as_slice))).collect();
        drawing.sheet(sheet, &parts);
    }
    let height = drawing.y;
    let background = Rectangle::new().set("width", "100%").set("height", "100%").set("fill", "#fff");
    let document = Document::new()
        .set("viewBox", (0, 0, WIDTH, height))
        .set("width", WIDTH)
        .set("height", height)
        .set("font-family", "sans-serif")
        .set("font-size", 12)
        .add(background)
        .add(drawing.group);
    document.to_string() + "\n"
}

/// A pin of a part, and the net that it is in.
struct Pin<'c> {
    name: String,
    net: &'c str,
    color: &'static str,
}

struct Drawing {
    group: Group,
    /// Where the next sheet begins.
    y: f64,
}

/// Which way a text or a pin points.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Left,
    Right,
}

impl Side {
    /// The direction away from the part.
    fn outwards(self) -> f64 {
        if self == Self::Left { -1.0 } else { 1.0 }
    }

    /// The anchor of a text that lies on this side of its point.
    fn anchor(self) -> &'static str {
        if self == Self::Left { "end" } else { "start" }
    }
}

impl Drawing {
    fn add(&mut self, node: impl Into<Box<dyn svg::Node>>) {
        self.group = std::mem::take(&mut self.group).add(node);
    }

    /// Draws a text of a class: the name of a part, of a pin or of a net, or a remark.
    fn text(&mut self, (x, y): (f64, f64), anchor: &str, color: &str, class: &str, text: &str) {
        let weight = if class == PART { "bold" } else { "normal" };
        let text = Text::new(text).set("x", x).set("y", y).set("text-anchor", anchor).set("font-weight", weight);
        self.add(text.set("fill", color).set("class", class));
    }

    fn line(&mut self, from: (f64, f64), to: (f64, f64), color: &str) {
        let line = Line::new().set("x1", from.0).set("y1", from.1).set("x2", to.0).set("y2", to.1);
        self.add(line.set("stroke", color).set("stroke-width", 1.5));
    }

    fn rectangle(&mut self, x: f64, y: f64, width: f64, height: f64) {
        let rectangle = Rectangle::new().set("x", x).set("y", y).set("width", width).set("height", height);
        self.add(rectangle.set("fill", "none").set("stroke", INK).set("stroke-width", 1.5));
    }

    /// Draws a sheet: boxes in two columns, then resistors and capacitors in two.
    fn sheet(&mut self, title: &str, parts: &[(&Part, &[Pin])]) {
        let title = Text::new(title).set("x", MARGIN).set("y", self.y + 16.0).set("font-size", 18);
        self.add(title.set("font-weight", "bold").set("fill", INK));
        self.line((MARGIN, self.y + 24.0), (WIDTH - MARGIN, self.y + 24.0), "#999");
        let mut columns = [self.y + 24.0 + GAP; 2];
        let (two_ended, boxes): (Vec<_>, Vec<_>) = parts.iter().partition(|(part, _)| part.value.is_some());
        for (part, pins) in boxes {
            let column = usize::from(columns[1] < columns[0]);
            columns[column] += self.part(MARGIN + COLUMN * column as f64, columns[column], part, pins) + GAP;
        }
        for (part, pins) in two_ended {
            let column = usize::from(columns[1] < columns[0]);
            // Its name stands above it.
            self.two_ended(MARGIN + COLUMN * column as f64, columns[column] + 0.5 * SYMBOL_HEIGHT, part, pins);
            columns[column] += SYMBOL_ROW;
        }
        self.y = columns[0].max(columns[1]) + GAP;
    }

    /// Draws a box with its pins, half of them on either side, and returns its height.
    fn part(&mut self, x: f64, y: f64, part: &Part, pins: &[Pin]) -> f64 {
        let left = x + 0.5 * (COLUMN - BOX_WIDTH) - MARGIN;
        let rows = pins.len().div_ceil(2);
        let height = HEADER + ROW * rows as f64 + 8.0;
        self.rectangle(left, y, BOX_WIDTH, height);
        let middle = left + 0.5 * BOX_WIDTH;
        self.text((middle, y + 15.0), "middle", INK, PART, &part.name);
        self.text((middle, y + 30.0), "middle", INK, REMARK, short(&part.what));
        for (index, pin) in pins.iter().enumerate() {
            let (side, row) = if index < rows { (Side::Left, index) } else { (Side::Right, index - rows) };
            let edge = if side == Side::Left { left } else { left + BOX_WIDTH };
            let at = y + HEADER + ROW * (row as f64 + 0.5);
            // The pin's name stands inside the box.
            let inside = if side == Side::Left { Side::Right } else { Side::Left };
            let name_at = (edge + 5.0 * inside.outwards(), at + BASELINE);
            self.text(name_at, inside.anchor(), "#666", PIN_NAME, &pin.name);
            self.end(edge, at, side, pin);
        }
        height
    }

    /// Draws a resistor or a capacitor, lying.
    fn two_ended(&mut self, x: f64, y: f64, part: &Part, pins: &[Pin]) {
        let middle = x + 0.5 * COLUMN - MARGIN;
        let (left, right) = (middle - 0.5 * SYMBOL_WIDTH, middle + 0.5 * SYMBOL_WIDTH);
        let top = y - 0.5 * SYMBOL_HEIGHT;
        if part.name.starts_with('C') {
            for (plate, lead) in [(middle - 3.0, left), (middle + 3.0, right)] {
                self.line((plate, top), (plate, top + SYMBOL_HEIGHT), INK);
                self.line((plate, y), (lead, y), INK);
            }
        } else {
            self.rectangle(left, top, SYMBOL_WIDTH, SYMBOL_HEIGHT);
        }
        self.text((middle, top - 4.0), "middle", INK, PART, &part.name);
        let value = part.value.map_or(String::new(), |value| value_text(Unit::of(&part.name), value));
        let remark = format!("{value}, {}", short(&part.what));
        self.text((middle, top + SYMBOL_HEIGHT + 13.0), "middle", INK, REMARK, &remark);
        for (edge, side, end) in [(left, Side::Left, "1"), (right, Side::Right, "2")] {
            if let Some(pin) = pins.iter().find(|pin| pin.name == end) {
                self.end(edge, y, side, pin);
            }
        }
    }

    /// Draws the line of a pin, and its net's name.
    fn end(&mut self, x: f64, y: f64, side: Side, pin: &Pin) {
        let end = x + PIN * side.outwards();
        self.line((x, y), (end, y), pin.color);
        self.text((end + 4.0 * side.outwards(), y + BASELINE), side.anchor(), pin.color, NET, pin.net);
    }
}

/// The description of a part, up to its first remark.
fn short(what: &str) -> &str {
    what.split([',', ':', '(']).next().unwrap_or_default().trim()
}
