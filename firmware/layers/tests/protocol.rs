//! The tables in `PROTOCOL.md` of kinds, features and ranges are those of the code.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use frixel_layers::{FingerLaw, Header, LawPoint, Range, feature_names, kind_names, range};
use frixel_testkit::HEADER;
use frixel_wire::hello::{BoardLimits, feature};

const PROTOCOL: &str = include_str!("../../wire/PROTOCOL.md");
const TICK_HZ: u32 = 40_000;
const LIMITS: BoardLimits = BoardLimits { voltage_max_v_peak: 220.0, ..BoardLimits::UNSTATED };

/// Rows of the table below a heading.
fn table(heading: &str) -> Vec<Vec<&'static str>> {
    let (_, table) = PROTOCOL.split_once(heading).unwrap();
    let lines =
        table.lines().skip_while(|line| !line.starts_with("|---")).skip(1).take_while(|line| line.starts_with('|'));
    lines.map(|line| line.trim_matches('|').split('|').map(str::trim).collect()).collect()
}

/// Rows of the table of ranges: number, least, largest, name of the field.
fn rows() -> Vec<[&'static str; 4]> {
    let cells = |row: Vec<&'static str>| match row[..] {
        [number, least, largest, field] => [number, least, largest, field],
        _ => panic!("{row:?}"),
    };
    table("### `Ranges`").into_iter().map(cells).collect()
}

#[test]
fn feature_bits_match_the_table() {
    let name = |bit: u32, name: &str| match bit {
        feature::HOST_TOUCH => "`HOST_TOUCH`".to_owned(),
        _ => format!("`{}`", name.to_uppercase().replace('-', "_")),
    };
    let code: Vec<(u32, String)> = feature_names().map(|(bit, named)| (bit, name(bit, named))).collect();
    let rows = table("### `Features`").into_iter();
    let page: Vec<(u32, String)> = rows.map(|row| (1 << row[0].parse::<u32>().unwrap(), row[1].to_owned())).collect();
    assert_eq!(page, code);
}

/// The row of kinds, and the table of their parameters.
#[test]
fn kind_numbers_match_the_tables() {
    let row = table("\nA record:\n").into_iter().find(|row| row[2].starts_with("kind: ")).unwrap();
    let listed = row[2].strip_prefix("kind: ").unwrap().split(", ");
    let numbered = |kind: &str| {
        let (number, name) = kind.split_once(' ').unwrap();
        (number.parse().unwrap(), name.split(" (").next().unwrap().to_owned())
    };
    let page: Vec<(u8, String)> = listed.map(numbered).collect();
    let code: Vec<(u8, String)> = kind_names().map(|(number, name)| (number, name.to_lowercase())).collect();
    assert_eq!(page, code);
    let rows = table("The parameters of each kind are `f32`").into_iter().map(|row| row[0].to_owned());
    assert_eq!(rows.collect::<Vec<_>>(), page.into_iter().map(|(_, name)| name).collect::<Vec<_>>());
}

fn limit(text: &str) -> f32 {
    match text {
        "limit 4" => LIMITS.voltage_max_v_peak,
        "an eighth of the ticks a second" => TICK_HZ as f32 / 8.0,
        "the largest `f32`" => f32::MAX,
        number => number.parse().unwrap(),
    }
}

#[track_caller]
fn check(number: &str, found: &(f32, f32, String)) {
    let row = rows().into_iter().find(|[name, ..]| *name == number).unwrap_or_else(|| panic!("no row {number}"));
    let [_, least, largest, field] = row;
    assert_eq!(&(limit(least), limit(largest), field.trim_matches('`').to_owned()), found, "{number}");
}

#[test]
fn numbers_of_the_header() {
    type Set = fn(&mut Header);
    let fields: [(&str, Set); 13] = [
        ("screen width", |header| header.screen_width_m = f32::NAN),
        ("screen height", |header| header.screen_height_m = f32::NAN),
        ("finger radius", |header| header.finger_radius_m = f32::NAN),
        ("Winkler-Fuss stiffness", |header| header.stiffness_pa_per_m = f32::NAN),
        ("friction coefficient", |header| header.friction_coefficient = f32::NAN),
        ("normal load", |header| header.normal_load_n = f32::NAN),
        ("effective gap", |header| header.effective_gap_m = f32::NAN),
        ("largest voltage, rms", |header| header.voltage_max_v_rms = f32::NAN),
        ("largest voltage, peak", |header| header.voltage_max_v_peak = f32::NAN),
        ("fastest change of the envelope", |header| header.slew_v_per_s = f32::NAN),
        ("carrier frequency", |header| header.carrier_hz = f32::NAN),
        ("host timeout", |header| header.host_timeout_s = f32::NAN),
        ("largest electric friction", |header| header.electric_friction_max_n = Some(f32::NAN)),
    ];
    for (name, set) in fields {
        let mut header = HEADER;
        set(&mut header);
        let refused = header.check(&LIMITS, TICK_HZ).unwrap_err();
        check(name, &(refused.min, refused.max, format!("{:?}", refused.field)));
    }
    let law = FingerLaw::new(f32::NAN, &[LawPoint { voltage_v_rms: 150.0, electric_friction_n: 0.1 }]);
    let refused = Header { law, ..HEADER }.check(&LIMITS, TICK_HZ).unwrap_err();
    check("exponent of a law", &(refused.min, refused.max, format!("{:?}", refused.field)));
}

#[test]
fn numbers_of_records_and_points() {
    let ranges: [(&str, Range); 19] = [
        ("gain, also of `SetLayer`", range::GAIN),
        ("friction or factor, also of a curve's point", range::FRICTION_N),
        ("region: left and top end", range::REGION_PLACE_M),
        ("region: width and height", range::REGION_SIZE_M),
        ("vertex of a polygon", range::VERTEX_M),
        ("cycles per metre", range::CYCLES_PER_M),
        ("phase", range::PHASE_TURNS),
        ("duty", range::DUTY),
        ("angle, direction", range::ANGLE_TURNS),
        ("bitmap: corner", range::BITMAP_PLACE_M),
        ("bitmap: distance of samples and rows", range::PITCH_M),
        ("noise: wavelength", range::WAVELENGTH_M),
        ("edge: place on the line; rings, spokes: middle", range::SHAPE_PLACE_M),
        ("edge: width; button: width of the rim", range::SHAPE_WIDTH_M),
        ("click: time", range::CLICK_S),
        ("burst: period", range::BURST_S),
        ("vibration: frequency", range::FREQUENCY_HZ),
        ("grating, rings: waves a second", range::DRIFT_HZ),
        ("curve: speed", range::SPEED_M_PER_S),
    ];
    for (name, range) in ranges {
        check(name, &(range.min as f32, range.max as f32, format!("{:?}", range.field)));
    }
    assert_eq!(rows().len(), 14 + ranges.len(), "every row is checked");
}
