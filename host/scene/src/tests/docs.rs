//! Tests that the examples in `docs/design/scenes.md` compile, that `docs/design/scene-reference.md` is made from the
//! parser, and that the example in `docs/design/touch.md` is read.

use std::path::PathBuf;

use frixel_hil_sim::TouchConfig;
use frixel_testkit::{examples, golden};

use super::*;
use crate::grammar::{Absence, AmountFields, FieldSpec, Holds, KnownField, Range};
use crate::kinds::KindName;
use crate::schema::variant::{Tables, variants};
use crate::tables::LOW;
use crate::tables::layer::{ABOVE, BLEND, GAIN, KIND, LIVE, NAME, PATTERN_MS, REGION, REPEAT, START};
use crate::{FingerProfile, Profile};

const DOCS: &str = include_str!("../../../../docs/design/scenes.md");
const TOUCH_DOCS: &str = include_str!("../../../../docs/design/touch.md");

fn kinds() -> impl Iterator<Item = &'static str> {
    KindName::ALL.iter().map(|(word, _)| *word)
}

#[test]
fn every_example_compiles() {
    let examples = examples::blocks(DOCS);
    let (head, rest) = examples.split_first().expect("there is a head");
    compile_text(head).expect("the head compiles");
    assert!(rest.len() >= 8, "{}", rest.len());
    for example in rest {
        let text = examples::below_head(head, example);
        if let Err(error) = compile_text(&text) {
            panic!("{error}\n{text}");
        }
    }
    for kind in kinds() {
        assert!(rest.iter().any(|example| example.contains(&format!("kind = \"{kind}\""))), "{kind}");
    }
}

/// The fields of every layer.
const COMMON: [FieldSpec; 10] = [KIND, NAME, REGION, REPEAT, BLEND, GAIN, ABOVE, LIVE, START, PATTERN_MS];

/// All fields that the parser knows in a table, for any values of its other fields, in the order in which it reads
/// them.
fn known(before: &str, after: &str, key: &str) -> Vec<KnownField> {
    let mut all: Vec<KnownField> = Vec::new();
    for variant in variants(&Tables { before, after, key }) {
        let fields = variant.table.fields;
        for (number, known) in fields.iter().enumerate() {
            let place = |name: &str| all.iter().position(|other| other.field.name == name);
            if place(known.field.name).is_none() {
                let next = fields[number..].iter().find_map(|later| place(later.field.name));
                all.insert(next.unwrap_or(all.len()), known.clone());
            }
        }
    }
    all
}

/// The headings of the reference, each one also a heading of the guide, and the fields.
fn documented() -> Vec<(String, Vec<KnownField>)> {
    let mut all = Vec::new();
    for table in ["screen", "finger", "drive", "carrier", "touch", "design"] {
        all.push((format!("`[{table}]`"), known(&format!("version = 1\n{table} = {{"), "}", table)));
    }
    all.push(("`coating`".to_owned(), known("version = 1\nscreen = { coating = [{", "}] }", "coating")));
    let is_common = |known: &KnownField| COMMON.iter().any(|common| common.name == known.field.name);
    let layer = |kind: &str| known(&format!("layer = [{{ kind = \"{kind}\""), "}]", "layer");
    all.push(("Layers".to_owned(), layer("constant").into_iter().filter(is_common).collect()));
    all.push(("Regions".to_owned(), known("layer = [{ kind = \"constant\", region = {", "} }]", "region")));
    all.push(("Repeats".to_owned(), known("layer = [{ kind = \"constant\", repeat = {", "} }]", "repeat")));
    for kind in kinds() {
        let own = layer(kind).into_iter().filter(|known| !is_common(known)).collect();
        all.push((format!("`{kind}`"), own));
    }
    all.push(("Bursts".to_owned(), known("layer = [{ kind = \"vibration\", burst = {", "} }]", "burst")));
    all
}

/// A table in Markdown. The columns of units, ranges and defaults are omitted if they would be empty.
fn markdown(fields: &[KnownField]) -> String {
    let mut rows: Vec<[String; 5]> = vec![["key", "unit", "range", "default", "meaning"].map(str::to_owned)];
    let mut fields: Vec<FieldSpec> = fields.iter().map(|known| known.field).collect();
    while let Some(first) = fields.first().copied() {
        // The three units of an amount share one line.
        let (mut alike, others): (Vec<_>, Vec<_>) =
            fields.into_iter().partition(|field| field.meaning == first.meaning);
        fields = others;
        alike.sort_by_key(|field| ["_n", "_fraction", "_factor", "_mm"].map(|unit| !field.name.ends_with(unit)));
        let names: Vec<_> = alike.iter().map(|field| format!("`{}`", field.name)).collect();
        let mut units: Vec<&str> = alike.iter().map(unit).filter(|unit| !unit.is_empty()).collect();
        units.dedup();
        let default = alike.iter().map(default).find(|default| !default.is_empty()).unwrap_or_default();
        // A length in pixels has the range of the same length in millimetres.
        let lengths = ["_mm", "_px"].map(|unit| alike.iter().filter(|field| field.name.ends_with(unit)).count());
        let is_one = alike.len() == 1 || (alike.len() == 2 && lengths == [1, 1]);
        let range = if is_one { range(&alike[0]) } else { String::new() };
        rows.push([names.join(", "), units.join(", "), range, default, first.meaning.replace("](#", "](scenes.md#")]);
    }
    let shown: Vec<usize> = (0..5).filter(|column| rows.iter().skip(1).any(|row| !row[*column].is_empty())).collect();
    let line = |row: &[String; 5]| {
        let cells = shown
            .iter()
            .map(|column| if row[*column].is_empty() { " ".to_owned() } else { format!(" {} ", row[*column]) });
        format!("|{}|\n", cells.collect::<Vec<_>>().join("|"))
    };
    let mut lines: Vec<String> = rows.iter().map(line).collect();
    lines.insert(1, format!("|{}\n", "---|".repeat(shown.len())));
    lines.concat()
}

fn default(field: &FieldSpec) -> String {
    match field.absence {
        Absence::Mistake => String::new(),
        Absence::Number(number) => written(number),
        Absence::Flag(flag) => format!("`{flag}`"),
        Absence::Means(meaning) => meaning.to_owned(),
    }
}

/// The numbers that a field takes.
fn numbers(field: &FieldSpec) -> Option<Range> {
    match field.holds {
        Holds::Number(range)
        | Holds::Whole(range)
        | Holds::NumberOrAuto(range)
        | Holds::Numbers(range)
        | Holds::Interval(range)
        | Holds::Pairs(range) => Some(range),
        _ => None,
    }
}

/// The unit of a key, or of what its number is a share.
fn unit(field: &FieldSpec) -> &'static str {
    let pure = ["fraction", "factor"].into_iter().find(|pure| field.name.ends_with(&format!("_{pure}")));
    let unit = || numbers(field).and_then(|range| range.unit.split(',').next()).unwrap_or_default();
    pure.unwrap_or_else(unit).trim()
}

fn range(field: &FieldSpec) -> String {
    let Some(Range { min, max, unit }) = numbers(field) else { return String::new() };
    let whole = if matches!(field.holds, Holds::Whole(_)) { ", whole" } else { "" };
    // A unit may be followed by what else limits the number.
    let limit = unit.find(',').map_or("", |place| &unit[place..]);
    format!("{} to {}{whole}{limit}", written(min), written(max))
}

/// A number, with commas between thousands from 10,000 on, and as a power of ten from 1e6 on.
fn written(number: f64) -> String {
    if number.abs() >= 1e6 && number.fract() == 0.0 && number % 1e6 == 0.0 {
        return format!("{number:e}");
    }
    let text = number.to_string();
    if number.abs() < 1e4 || number.fract() != 0.0 {
        return text;
    }
    let (sign, digits) = text.split_at(usize::from(number < 0.0));
    let comma = |place: usize| if place > 0 && (digits.len() - place).is_multiple_of(3) { "," } else { "" };
    let grouped = digits.char_indices().map(|(place, digit)| format!("{}{digit}", comma(place)));
    format!("{sign}{}", grouped.collect::<String>())
}

/// The text above the tables of the reference.
fn reference_head() -> String {
    let AmountFields { newtons, fraction, factor } = LOW;
    let [newtons, fraction, factor] = [newtons, fraction, factor].map(|field| range(&field));
    format!(
        "\
# Scene files: every key

Written by `FRIXEL_BLESS=1 cargo test -p frixel-scene --lib docs` from the parser. [scenes.md](scenes.md), the guide,
has the same headings, with examples; `frixel schema` prints the same for editors.

Keys without a default must be given, or belong to one choice of several. The ending of a key is its unit. An amount of
friction has three keys, of which a layer uses one:

| ending | unit | range |
|---|---|---|
| `_n` | N, above natural friction or from zero: [`above`](scenes.md#what-can-be-reached) | {newtons} |
| `_fraction` | share of the most that the drive can add | {fraction} |
| `_factor` | factor, with `blend = \"multiply\"` | {factor} |

A length in px needs a [design size](scenes.md#design), and has the range of the length in mm. Angles run from x towards
y: 0 is along x, 90 along y.
"
    )
}

/// The reference of all keys.
fn reference() -> String {
    let mut page = reference_head();
    for (heading, fields) in documented() {
        let is_its = |line: &str| line.starts_with('#') && line.trim_start_matches(['#', ' ']) == heading;
        assert!(DOCS.lines().any(is_its), "the guide has no heading {heading}");
        page.extend(["\n## ", &heading, "\n\n", &markdown(&fields)]);
    }
    page
}

#[test]
fn the_reference_is_made_from_the_parser() {
    let path: PathBuf = scenes().join("../docs/design/scene-reference.md");
    golden::hold(&path, &reference());
}

#[test]
fn a_default_is_what_a_file_without_the_field_means() {
    let mut compared = 0;
    for (heading, fields) in documented() {
        let Some(kind) = heading.strip_prefix('`').and_then(|rest| rest.strip_suffix('`')) else { continue };
        let table = kind.trim_matches(['[', ']']);
        for known in fields {
            let FieldSpec { name, absence, .. } = known.field;
            let value = match absence {
                Absence::Number(number) => number.to_string(),
                Absence::Flag(flag) => flag.to_string(),
                Absence::Means(_) | Absence::Mistake => continue,
            };
            let Some(example) = example_of(table, kind.starts_with('[')) else { continue };
            let assigned = format!("{name} =");
            let lines = example.lines().filter(|line| !line.starts_with(&assigned));
            let without: String = lines.flat_map(|line| [line, "\n"]).collect();
            let with = format!("{without}{name} = {value}\n");
            let [without, with] = [without, with].map(|text| compile_text(&text).map(|program| program.scene_bytes()));
            // A field that belongs to another choice cannot be added.
            if let (Ok(without), Ok(with)) = (without, with) {
                assert_eq!(without, with, "{name} = {value} of {kind}");
                compared += 1;
            }
        }
    }
    assert!(compared >= 12, "{compared}");
}

/// The last example of a table or of a kind of layer, as a scene that ends with that table.
fn example_of(table: &str, top: bool) -> Option<String> {
    let examples = examples::blocks(DOCS);
    let is_of = |example: &&str| {
        if top { example.starts_with(&format!("[{table}]")) } else { example.contains(&format!("kind = \"{table}\"")) }
    };
    let layer = "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.1\n";
    let example = examples.iter().copied().skip(1).find(is_of)?;
    let own = if top {
        example.to_owned()
    } else {
        example.split("[[layer]]").find(|layer| layer.contains(&format!("kind = \"{table}\"")))?.to_owned()
    };
    let whole = if top { format!("{layer}\n{own}") } else { format!("[[layer]]{own}") };
    Some(examples::below_head(examples[0], &whole))
}

#[test]
fn numbers_in_the_text_are_right() {
    let program = compile_text(examples::blocks(DOCS)[0]).expect("the head compiles");
    let reach = program.reach;
    assert!(DOCS.contains(&format!("At 150 V rms it feels {:.2} mN more", 1e3 * reach.electric_friction_max_n)));
    assert!(DOCS.contains(&format!("{} N. At 150 V", reach.natural_friction_n)));
    assert_eq!(LIMITS.bitmap_pool_bytes, 65_536);
}

/// The table of bundled fingers is computed here: on the example screen, at the default limit of the drive.
#[test]
fn the_table_of_bundled_fingers_is_right() {
    for (number, name) in FingerProfile::bundled_names().into_iter().enumerate() {
        let Program { reach, header, .. } =
            compile_text(&format!("version = 1\nfinger = \"{name}\"")).expect("it compiles");
        let steps = libm::log(reach.friction_max_n() / reach.natural_friction_n) / libm::log(1.11);
        let row = format!(
            "| `{name}` | {} N | {:.0} mN | {:.0} mN | {steps:.1}{} |",
            header.normal_load_n,
            1e3 * reach.natural_friction_n,
            1e3 * reach.electric_friction_max_n,
            if number == 0 { " Weber steps" } else { "" }
        );
        assert!(DOCS.contains(&row), "{row}");
    }
}

/// The touch source of the documents reads, and has the losses of the bundled sources.
#[test]
fn the_touch_source_in_the_documents_is_read() {
    let text = TOUCH_DOCS.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("it is there");
    let source = TouchConfig::parse(text, "docs/design/touch.md").expect("it reads");
    let bits = |source: TouchConfig| [source.lost_share, source.bunched_share, source.pause_rate_hz].map(f64::to_bits);
    assert_eq!(source.rate_hz.to_bits(), 120.0_f64.to_bits());
    assert_eq!(bits(source), bits(TouchConfig::REALISTIC));
}
