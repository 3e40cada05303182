//! Templates of layers that a person adds, for the page's Add and New, and where a layer has room.

mod room;

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::{Value, json};

use crate::layer_text::{self, TextError};
use room::{BoxMm, roomiest};

/// Size of a layer that is added to others, as parts of the screen's width and height.
const PART: [f64; 2] = [0.25, 0.35];
/// Size of a picture, likewise: alone, and beside others.
const PICTURE_PARTS: [f64; 2] = [0.75, 0.5];
/// The longest length of a layer, as part of its box's shorter side.
const LENGTH_PART: f64 = 0.25;
/// The bundled picture, and its width over its height.
const PICTURE: (&str, f64) = ("textures/wood.jpg", 1.5);
/// The screen of New.
const SCREEN_MM: [f64; 2] = [120.0, 80.0];

/// A template of a layer.
struct Addition {
    /// The word on its button, which is also the layer's name.
    name: &'static str,
    /// Description of the layer, one sentence.
    words: &'static str,
    place: Place,
    /// The lines of the layer behind its name, for a box.
    lines: fn(&Layout) -> String,
}

/// Where a layer lies.
enum Place {
    /// On the whole screen.
    Screen,
    /// On the whole screen in New; in a scene that it is added to, in a box of [`PART`] of the screen.
    ScreenInNew,
    /// In a box: in New, its place in mm; in a scene that it is added to, its size as parts of the screen.
    Box { new_mm: BoxMm, part: [f64; 2] },
    /// A picture, placed by the ratio of its sides.
    Picture,
}

/// The box of a layer; `None` for the whole screen.
struct Layout(Option<BoxMm>);

impl Layout {
    /// The line of the region, if there is one.
    fn region(&self) -> String {
        self.0.map_or(String::new(), |of| region("", of))
    }

    /// Likewise of an ellipse.
    fn ellipse(&self) -> String {
        self.0.map_or(String::new(), |of| region("shape = \"ellipse\", ", of))
    }

    /// The lines of the middle.
    fn middle(&self) -> String {
        let [x, y, width, height] = self.0.unwrap_or([0.0, 0.0, SCREEN_MM[0], SCREEN_MM[1]]);
        format!("x_mm = {}\ny_mm = {}\n", number(x + 0.5 * width), number(y + 0.5 * height))
    }

    /// A length, mm, shorter in a box too small for the `longest` of the layer.
    fn length(&self, length_mm: f64, longest_mm: f64) -> f64 {
        let most_mm = self.0.map_or(f64::INFINITY, |[.., width, height]| LENGTH_PART * width.min(height));
        number(length_mm * (most_mm / longest_mm).min(1.0))
    }
}

fn region(shape: &str, mm: BoxMm) -> String {
    let [x, y, width, height] = mm.map(number);
    format!("region = {{ {shape}x_mm = {x}, y_mm = {y}, width_mm = {width}, height_mm = {height} }}\n")
}

/// A number as it is written: thousandths.
fn number(value: f64) -> f64 {
    (1000.0 * value).round() / 1000.0
}

/// The lines of a ridge with a click across the middle of a box; `repeat` is the line of its copies. It is not added to
/// what lies below: both together could be out of reach.
fn ridge(layout: &Layout, repeat: &str, width_mm: f64) -> String {
    format!(
        "kind = \"edge\"\nblend = \"max\"\n{}{repeat}{}width_mm = {width_mm}\nridge_fraction = 0.25\n\
         click_fraction = 0.75\nclick_ms = 15\n",
        layout.region(),
        layout.middle()
    )
}

/// All layers to begin with, in the order of their buttons.
static ADDITIONS: [Addition; 11] = [
    Addition {
        name: "stripes",
        words: "Broad stripes across the screen: a finger that slides over them meets one ridge after another.",
        place: Place::ScreenInNew,
        lines: |layout| {
            let wavelength = layout.length(10.0, 10.0);
            format!(
                "kind = \"grating\"\n{}wave = \"sine\"\nwavelength_mm = {wavelength}\n\
                 low_fraction = 0\nhigh_fraction = 0.8\n",
                layout.region()
            )
        },
    },
    Addition {
        name: "noise",
        words: "An uneven ground like coarse sand: no two places of it are alike.",
        place: Place::ScreenInNew,
        lines: |layout| {
            let [min, max] = [1.5, 3.0].map(|mm| layout.length(mm, 3.0));
            format!(
                "kind = \"noise\"\n{}wavelength_min_mm = {min}\nwavelength_max_mm = {max}\n\
                 low_fraction = 0\nhigh_fraction = 0.9\n",
                layout.region()
            )
        },
    },
    Addition {
        name: "picture",
        words: "The grain of a photo of wood, rough where it is bright; or a picture of yours.",
        place: Place::Picture,
        lines: |_| String::new(),
    },
    Addition {
        name: "plate",
        words: "A rough plate on smooth glass: a finger feels its border as a step.",
        place: Place::Box { new_mm: [35.0, 20.0, 50.0, 40.0], part: PART },
        lines: |layout| format!("kind = \"constant\"\n{}friction_fraction = 0.8\n", layout.region()),
    },
    Addition {
        name: "velvet",
        words: "Velvet: smooth for a finger that slides to the right, rough for one that slides back.",
        place: Place::Box { new_mm: [15.0, 10.0, 90.0, 60.0], part: PART },
        lines: |layout| {
            format!(
                "kind = \"direction\"\n{}angle_deg = 0\nalong_fraction = 0.1\nagainst_fraction = 0.9\n",
                layout.region()
            )
        },
    },
    Addition {
        name: "edge",
        words: "One ridge with a click, for a finger that crosses it.",
        place: Place::Box { new_mm: [45.0, 10.0, 30.0, 60.0], part: PART },
        lines: |layout| ridge(layout, "", layout.length(7.0, 7.0)),
    },
    Addition {
        name: "button",
        words: "One button: a rim that holds the finger back, and a rougher face inside of it.",
        place: Place::Box { new_mm: [35.0, 20.0, 50.0, 40.0], part: PART },
        lines: |layout| {
            let rim = layout.length(5.0, 5.0);
            format!(
                "kind = \"button\"\n{}rim_width_mm = {rim}\nrim_fraction = 0.9\nface_fraction = 0.35\n",
                layout.region()
            )
        },
    },
    Addition {
        name: "slider",
        words: "A slider with five detents: each is a ridge with a click that a finger can count.",
        place: Place::Box { new_mm: [15.0, 30.0, 90.0, 20.0], part: [0.5, 0.2] },
        lines: |layout| {
            // One copy for each detent.
            let [x, y, width, height] = layout.0.unwrap_or_default();
            let step = number(0.2 * width);
            let repeat = format!("repeat = {{ columns = 5, dx_mm = {step} }}\n");
            ridge(&Layout(Some([x, y, step, height])), &repeat, number(0.7 * step))
        },
    },
    Addition {
        name: "dial",
        words: "A dial of rings: a finger feels how far from its middle it is.",
        place: Place::Box { new_mm: [30.0, 10.0, 60.0, 60.0], part: PART },
        lines: |layout| {
            let wavelength = layout.length(10.0, 10.0);
            format!(
                "kind = \"rings\"\n{}{}wave = \"triangle\"\nwavelength_mm = {wavelength}\n\
                 low_fraction = 0\nhigh_fraction = 0.9\n",
                layout.ellipse(),
                layout.middle()
            )
        },
    },
    Addition {
        name: "jog wheel",
        words: "A wheel with twelve notches around its middle, for a finger that goes round.",
        place: Place::Box { new_mm: [30.0, 10.0, 60.0, 60.0], part: PART },
        lines: |layout| {
            format!(
                "kind = \"spokes\"\n{}{}number = 12\nwave = \"triangle\"\nlow_fraction = 0\nhigh_fraction = 0.9\n",
                layout.ellipse(),
                layout.middle()
            )
        },
    },
    Addition {
        name: "notification",
        words: "A buzz under a sliding finger, wherever it is, that stays off until Play once.",
        place: Place::Screen,
        lines: |_| {
            "kind = \"vibration\"\nlive = true\nstart = \"off\"\nwave = \"sine\"\nfrequency_hz = 90\n\
             low_fraction = 0\nhigh_fraction = 0.9\nburst = { period_ms = 1000, on_ms = 500, ramp_ms = 50 }\n"
                .to_owned()
        },
    },
];

/// Layers as a person begins to write one: the kinds that no button adds, and an edge without its click.
const WRITTEN: [&str; 3] = [
    "kind = \"edge\"\nridge_fraction = 0.8\n",
    "kind = \"speed\"\nspeeds_mm_per_s = [20, 150]\nfactors = [0.3, 1]\n",
    "kind = \"stream\"\nlow_fraction = 0\nhigh_fraction = 0.8\n",
];

impl Addition {
    /// The lines behind its name, and its box, where it is added to what lies on a screen, or alone in New.
    fn laid(&self, screen_mm: [f64; 2], taken_mm: Option<&[BoxMm]>) -> (String, Option<BoxMm>) {
        let added = |[across, down]: [f64; 2]| {
            let size_mm = [screen_mm[0] * across, screen_mm[1] * down];
            taken_mm.map(|taken_mm| roomiest(size_mm, screen_mm, taken_mm))
        };
        let box_mm = match self.place {
            Place::Screen => None,
            Place::ScreenInNew => added(PART),
            Place::Box { new_mm, part } => added(part).or(Some(new_mm)),
            Place::Picture => return picture(PICTURE, screen_mm, taken_mm.unwrap_or_default()),
        };
        ((self.lines)(&Layout(box_mm)), box_mm)
    }
}

/// The lines of a picture, and its box: by the ratio of its width to its height, and large where it is alone. It has no
/// pitch: the compiler takes the finest that a board has room for, whatever other pictures the scene has.
fn picture((file, aspect): (&str, f64), screen_mm: [f64; 2], taken_mm: &[BoxMm]) -> (String, Option<BoxMm>) {
    let part = PICTURE_PARTS[usize::from(!taken_mm.is_empty())];
    let width_mm = part * screen_mm[0].min(screen_mm[1] * aspect);
    let [x, y, width, _] = roomiest([width_mm, width_mm / aspect], screen_mm, taken_mm);
    let file = quoted(file);
    let lines = format!(
        "kind = \"bitmap\"\npicture = {file}\nlevels = \"stretch\"\nx_mm = {x}\ny_mm = {y}\nwidth_mm = {width}\n"
    );
    (lines, Some([x, y, width, width / aspect]))
}

/// A text as a string of TOML, which takes no DEL as it is.
fn quoted(text: &str) -> String {
    Value::from(text).to_string().replace('\u{7f}', "\\u007f")
}

/// Appends a layer to a text.
fn with_layer(text: &str, name: &str, lines: &str) -> Result<String, TextError> {
    layer_text::add(text, &format!("name = {}\n{lines}", quoted(name)))
}

/// The list for the page: of each layer to begin with `name`, `words`, `isPicture` for one in whose place a person may
/// choose a picture, and `scene`: the text of one that has it alone.
pub(crate) fn list() -> Result<Value, TextError> {
    let each = |addition: &Addition| {
        let Addition { name, words, .. } = addition;
        let (lines, _) = addition.laid(SCREEN_MM, None);
        let scene = with_layer(&format!("# {words}\nversion = 1\n"), name, &lines)?;
        let is_picture = matches!(addition.place, Place::Picture);
        Ok(json!({ "name": name, "words": words, "isPicture": is_picture, "scene": scene }))
    };
    ADDITIONS.iter().map(each).collect()
}

/// Initial values of a layer's fields, as TOML, by kind and field, for the page's completion. Fields that [`WRITTEN`]
/// lacks have the values of the first layer of that kind in [`ADDITIONS`].
pub(crate) fn first_values() -> Value {
    let listed = ADDITIONS.iter().map(|addition| addition.laid(SCREEN_MM, None).0);
    let mut kinds: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    for lines in WRITTEN.map(str::to_owned).into_iter().chain(listed) {
        let mut values: BTreeMap<&str, &str> = lines.lines().filter_map(|line| line.split_once(" = ")).collect();
        let kind = values.remove("kind").unwrap_or_default().trim_matches('"');
        let first = kinds.entry(kind.to_owned()).or_default();
        for (field, value) in values {
            first.entry(field.to_owned()).or_insert_with(|| value.to_owned());
        }
    }
    json!(kinds)
}

/// A layer that the page adds.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Added {
    /// The text that it is added to.
    text: String,
    /// The name that it has there.
    name: String,
    layer: Wanted,
    /// Width and height of the screen.
    screen_mm: [f64; 2],
    /// Boxes of the layers that are there.
    taken_mm: Vec<BoxMm>,
}

/// The layer to add.
#[derive(Deserialize)]
#[serde(untagged)]
enum Wanted {
    /// A picture: its file, and its width over its height.
    Picture(String, f64),
    /// One of the list, by its name.
    Listed(String),
}

/// Adds a layer where there is room, for a request as JSON: `text`, `name`, `layer` (a name of the list, or file and
/// aspect of a picture), `screenMm`, `takenMm`. The answer has the new `text` and the layer's `boxMm`, `null` for one
/// on the whole screen.
pub(crate) fn add(request: &str) -> Result<Value, TextError> {
    let Added { text, name, layer, screen_mm, taken_mm } =
        serde_json::from_str(request).map_err(|_| TextError::Request)?;
    let (lines, box_mm) = match &layer {
        Wanted::Picture(file, aspect) => picture((file, *aspect), screen_mm, &taken_mm),
        Wanted::Listed(listed) => {
            let addition = ADDITIONS.iter().find(|addition| addition.name == listed).ok_or(TextError::Request)?;
            addition.laid(screen_mm, Some(&taken_mm))
        }
    };
    Ok(json!({ "text": with_layer(&text, &name, &lines)?, "boxMm": box_mm }))
}

#[cfg(test)]
mod tests;
