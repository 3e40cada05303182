//! The place of a layer on the screen, and the changes of its fields that move or resize it.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use crate::layer_text::TextError;

/// Decimals of a written length.
const DECIMALS: u32 = 2;
/// Numbers that differ by less are the same, pixels.
const CLOSE: f64 = 1e-6;
/// Pixels of at most this size need no fraction, mm.
const FINE_MM: f64 = 0.5;
/// Kinds that have a place besides their region.
const PLACED: [&str; 4] = ["rings", "spokes", "edge", "bitmap"];
/// The sides of a box; even ones are along x.
const SIDES: [&str; 4] = ["x", "y", "width", "height"];
const WHOLE_SCREEN: &str = "This layer covers the whole screen: drag a corner inwards to give it a place of its own.";
const TURNED: &str = "A turned picture has no side to drag: change its width in the text.";

/// A layer as its file has it.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Placed {
    /// Its fields, and the defaults of fields that it does not have.
    fields: Map<String, Value>,
    /// Whether the region is its own, not a default.
    has_own_region: bool,
    /// Number of the layer among those of its file, from 0.
    at: usize,
    kind: String,
    /// Left, top, width and height around all copies, mm; `None` for the whole screen.
    box_mm: Option<[f64; 4]>,
    screen: Screen,
    /// The change by hand.
    act: Option<Act>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Screen {
    width_mm: f64,
    height_mm: f64,
    /// Width and height of a pixel of the design, mm.
    pixel_mm: Option<[f64; 2]>,
}

/// A change of a layer by hand.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
enum Act {
    /// Moves it by so many mm.
    Move([f64; 2]),
    /// Gives its first copy this box.
    Resize(BoxMm),
}

/// A rectangle on the screen, mm.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct BoxMm {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

impl BoxMm {
    fn of([x, y, width, height]: [f64; 4]) -> Self {
        Self { x, y, width, height }
    }

    fn sides(self) -> [f64; 4] {
        [self.x, self.y, self.width, self.height]
    }
}

/// A length in a text.
struct Length {
    path: Vec<Value>,
    mm: f64,
    /// Size of its unit, mm.
    unit_mm: f64,
}

impl Length {
    /// The change that gives it another value.
    fn set(&self, mm: f64) -> Value {
        let value = mm / self.unit_mm;
        let before = self.mm / self.unit_mm;
        // A pixel has a fraction where it had one, or where the step is finer.
        let is_fine = self.unit_mm.to_bits() != 1_f64.to_bits() && self.unit_mm <= FINE_MM;
        let is_whole = is_fine && (before - before.round()).abs() < CLOSE && (value - before).abs() > 1.0 - CLOSE;
        json!({ "path": self.path, "value": value, "decimals": if is_whole { 0 } else { DECIMALS } })
    }
}

/// The place of a layer, as JSON. Without an act: `box`, that of the first copy; `copies`, the offset of each copy from
/// the first; `isWholeScreen`; `keepsRatio`, whether the height follows from the width; and `whyNotMoved` and
/// `whyNotResized`, sentences that are empty where it can be. With an act: the changes of the text.
pub(crate) fn place(request: &str) -> Result<Value, TextError> {
    let placed: Placed = serde_json::from_str(request).map_err(|_| TextError::Request)?;
    Ok(match placed.act {
        None => placed.answer(),
        Some(Act::Move(by)) => placed.moved(by).into(),
        Some(Act::Resize(to)) => placed.resized(to).into(),
    })
}

impl Placed {
    fn answer(&self) -> Value {
        let is_own = self.region().is_some() || !self.anchors().is_empty();
        let is_picture = self.kind == "bitmap" && self.region().is_none() && self.box_mm.is_some();
        let is_turned =
            self.fields.get("angle_deg").and_then(Value::as_f64).is_some_and(|angle_deg| angle_deg.abs() > 0.0);
        json!({
            "box": self.first_box(),
            "copies": self.copies(),
            "isWholeScreen": self.box_mm.is_none(),
            "keepsRatio": is_picture && self.length(3).is_none(),
            "whyNotMoved": if is_own { "" } else { WHOLE_SCREEN },
            "whyNotResized": if is_picture && is_turned { TURNED } else { "" },
        })
    }

    fn region(&self) -> Option<&Map<String, Value>> {
        self.fields.get("region")?.as_object()
    }

    /// The path of a key of the layer, or of its region.
    fn path(&self, is_of_region: bool, rest: &[Value]) -> Vec<Value> {
        let region = is_of_region.then(|| Value::from("region"));
        ["layer".into(), self.at.into()].into_iter().chain(region).chain(rest.iter().cloned()).collect()
    }

    /// The size of the unit of a field along an axis, mm.
    fn unit_mm(&self, field: &str, axis: usize) -> f64 {
        let pixel_mm = self.screen.pixel_mm.filter(|_| field.ends_with("_px"));
        pixel_mm.and_then(|pixel_mm| pixel_mm.get(axis).copied()).unwrap_or(1.0)
    }

    /// A side of the layer itself, or of its region, in either unit.
    fn side(&self, side: usize, is_of_region: bool) -> Option<Length> {
        let table = if is_of_region { self.region()? } else { &self.fields };
        let name = SIDES.get(side)?;
        let (field, value) = ["mm", "px"].iter().find_map(|unit| table.get_key_value(&format!("{name}_{unit}")))?;
        let unit_mm = self.unit_mm(field, side % 2);
        let path = self.path(is_of_region, &[field.as_str().into()]);
        Some(Length { path, mm: value.as_f64().unwrap_or_default() * unit_mm, unit_mm })
    }

    /// A side of the region, or of a layer without one.
    fn length(&self, side: usize) -> Option<Length> {
        self.side(side, self.region().is_some())
    }

    /// The place besides the region, each with its axis: a middle, a point of a line, or a picture's corner.
    fn anchors(&self) -> Vec<(usize, Length)> {
        let sides = (0..2).filter(|_| PLACED.contains(&self.kind.as_str()));
        sides.filter_map(|side| Some((side, self.side(side, false)?))).collect()
    }

    /// The coordinates of a polygon's vertices, each with its axis; `None` for another shape.
    fn vertices(&self) -> Option<Vec<(usize, Length)>> {
        let region = self.region().filter(|region| region.get("shape").is_some_and(|shape| shape == "polygon"))?;
        let (field, points) = ["points_px", "points_mm"].iter().find_map(|field| region.get_key_value(*field))?;
        let points = points.as_array()?.iter().enumerate();
        let coordinates = points.flat_map(|(at, point)| {
            let point = point.as_array().into_iter().flatten().enumerate();
            point.map(move |(axis, value)| (at, axis, value.as_f64().unwrap_or_default()))
        });
        let length = |(at, axis, value): (usize, usize, f64)| {
            let unit_mm = self.unit_mm(field, axis);
            let path = self.path(true, &[field.as_str().into(), at.into(), axis.into()]);
            (axis, Length { path, mm: value * unit_mm, unit_mm })
        };
        Some(coordinates.map(length).collect())
    }

    /// The offset of each copy from the first, mm.
    fn copies(&self) -> Vec<[f64; 2]> {
        let repeat = self.fields.get("repeat").and_then(Value::as_object);
        let offsets = |count: &str, axis: usize, steps: [&str; 2]| {
            let count = repeat.and_then(|repeat| repeat.get(count)?.as_f64()).unwrap_or(1.0) as u64;
            let step = repeat.and_then(|repeat| steps.iter().find_map(|step| repeat.get_key_value(*step)));
            let step_mm =
                step.map_or(0.0, |(field, value)| value.as_f64().unwrap_or_default() * self.unit_mm(field, axis));
            (0..count).map(move |at| at as f64 * step_mm)
        };
        let rows = offsets("rows", 1, ["dy_mm", "dy_px"]);
        rows.flat_map(|y| offsets("columns", 0, ["dx_mm", "dx_px"]).map(move |x| [x, y])).collect()
    }

    /// The least and the largest offset of copies along an axis, mm.
    fn spread(&self, axis: usize) -> [f64; 2] {
        let offsets = self.copies().into_iter().filter_map(|offset| offset.get(axis).copied());
        offsets.fold([0.0, 0.0], |[least, most]: [f64; 2], offset| [least.min(offset), most.max(offset)])
    }

    /// The box of the first copy: as the text has it, or the check where only that knows it.
    fn first_box(&self) -> BoxMm {
        let Some([x, y, width, height]) = self.box_mm else {
            return BoxMm { x: 0.0, y: 0.0, width: self.screen.width_mm, height: self.screen.height_mm };
        };
        if let Some(vertices) = self.vertices() {
            let ends = |axis: usize| {
                let places = vertices.iter().filter(|(own, _)| *own == axis).map(|(_, length)| length.mm);
                places.fold([f64::MAX, f64::MIN], |[least, most], mm| [least.min(mm), most.max(mm)])
            };
            let ([left, right], [top, bottom]) = (ends(0), ends(1));
            return BoxMm { x: left, y: top, width: right - left, height: bottom - top };
        }
        if self.region().is_some() {
            return BoxMm::of([0, 1, 2, 3].map(|side| self.length(side).map_or(0.0, |length| length.mm)));
        }
        let ([left, right], [top, bottom]) = (self.spread(0), self.spread(1));
        BoxMm { x: x - left, y: y - top, width: width - (right - left), height: height - (bottom - top) }
    }

    /// The changes that move it; all copies stay on the screen.
    fn moved(&self, by: [f64; 2]) -> Vec<Value> {
        let first = self.first_box();
        let limited = |axis: usize, by: f64, place: f64, side: f64, screen: f64| {
            if self.box_mm.is_none() {
                return by;
            }
            let [least, most] = self.spread(axis);
            by.min(screen - (place + most) - side).max(-(place + least))
        };
        let [dx, dy] = by;
        let by = [
            limited(0, dx, first.x, first.width, self.screen.width_mm),
            limited(1, dy, first.y, first.height, self.screen.height_mm),
        ];
        let set = |lengths: Vec<(usize, Length)>| {
            let lengths = lengths.into_iter().filter_map(|(axis, length)| Some((length, *by.get(axis)?)));
            lengths.filter(|(_, by)| by.abs() > 0.0).map(|(length, by)| length.set(length.mm + by)).collect()
        };
        let anchors: Vec<Value> = set(self.anchors());
        if self.region().is_none() {
            return anchors;
        }
        let corner = || (0..2).filter_map(|side| Some((side, self.length(side)?))).collect();
        let region = self.in_own_region(set(self.vertices().unwrap_or_else(corner)));
        region.into_iter().chain(anchors).collect()
    }

    /// The changes that give its first copy a box.
    fn resized(&self, to: BoxMm) -> Vec<Value> {
        if self.box_mm.is_none() && self.region().is_none() {
            let BoxMm { x, y, width, height } = to;
            return vec![self.new_region(&json!({ "x_mm": x, "y_mm": y, "width_mm": width, "height_mm": height }))];
        }
        let from = self.first_box();
        let changes = if let Some(vertices) = self.vertices() {
            let scaled = |(axis, length): &(usize, Length)| {
                let [place, side, to_place, to_side] = if *axis == 0 {
                    [from.x, from.width, to.x, to.width]
                } else {
                    [from.y, from.height, to.y, to.height]
                };
                length.set(to_place + (length.mm - place) * to_side / side)
            };
            vertices.iter().map(scaled).collect()
        } else {
            let sides = from.sides().into_iter().zip(to.sides()).enumerate();
            let changed = sides.filter(|(_, (from, to))| from.to_bits() != to.to_bits());
            changed.filter_map(|(side, (_, to))| Some(self.length(side)?.set(to))).collect()
        };
        if self.region().is_some() { self.in_own_region(changes) } else { changes }
    }

    /// Changes of a region that comes from the defaults, as a region of the layer's own.
    fn in_own_region(&self, changes: Vec<Value>) -> Vec<Value> {
        if self.has_own_region || changes.is_empty() {
            return changes;
        }
        let mut region = Value::from(self.region().cloned().unwrap_or_default());
        for change in changes {
            let path = change["path"].as_array().into_iter().flatten().skip(3);
            let keys = path.map(|key| key.as_str().map_or(key.to_string(), str::to_owned));
            let pointer: String = keys.flat_map(|key| ["/".to_owned(), key]).collect();
            if let Some(place) = region.pointer_mut(&pointer) {
                *place = change["value"].clone();
            }
        }
        vec![self.new_region(&region)]
    }

    fn new_region(&self, value: &Value) -> Value {
        json!({ "path": self.path(true, &[]), "value": value, "decimals": DECIMALS, "after": "kind" })
    }
}

#[cfg(test)]
mod tests;
