//! The layers of a scene's files, for a page that lists them beside the text.

use frixel_felt::check::feel;
use frixel_felt::judge::{Judgement, LayerVerdict, Texture, weber_steps_text};
use frixel_layers::{Point, Region, range};
use frixel_scene::{LayerSetting, LayerTable, Program, Scene};
use serde_json::{Value, json};

/// The layers of a scene, called `entry`, that was compiled to `program`, as they are written in its files: with
/// `repeat`, one is several layers of the scene. `Layer` in `web/engine/types.d.ts` lists the fields of each.
pub(crate) fn layers(scene: &Scene, entry: &str, program: &Program, judgement: &Judgement) -> Vec<Value> {
    let describe = |table: LayerTable| {
        let LayerTable { number, name, kind, gain, starts_on, layers, file, lines, bounds_mm } = table;
        let live: Result<Vec<Vec<u8>>, _> = layers.iter().map(|layer| program.layers.records(layer)).collect();
        // Of its first copy.
        let felt = judgement.layers.iter().find(|layer| layer.layer.number().table == number);
        let mut layer = json!({
            "index": number,
            "name": name.unwrap_or_else(|| kind.to_owned()),
            "kind": kind,
            "felt": felt.map_or_else(String::new, feel::sentence),
            "perceived": felt.map(perceived),
            "controls": layers,
            "isLive": live.is_ok(),
            "startsOn": starts_on,
            "gain": gain,
            "gainMin": range::GAIN.min,
            "gainMax": range::GAIN.max,
            "gainReach": live.as_ref().ok().and_then(|records| gain_reach(program, &records.concat())),
            "whyNotLive": live.err().map_or(String::new(), |error| error.to_string()),
            "from": lines,
            "boxMm": bounds_mm.or_else(|| outline_mm(program, number)),
        });
        if file != entry {
            layer["file"] = file.into();
        }
        layer
    };
    scene.layer_tables().into_iter().map(describe).collect()
}

/// The judgement of a layer, as numbers: the verdict and sizes that the command prints.
fn perceived(layer: &LayerVerdict) -> Value {
    let step = layer.main_step();
    let texture = |Texture { speed_mm_per_s, frequency_hz, amplitude_n, threshold_n, verdict, .. }: &Texture| {
        json!({
            "verdict": verdict.words(),
            "speedMmPerS": speed_mm_per_s,
            "frequencyHz": frequency_hz,
            "amplitudeN": amplitude_n,
            "thresholdN": threshold_n,
        })
    };
    json!({
        "verdict": layer.verdict.words(),
        "fromN": step.from_n,
        "toN": step.to_n,
        "weberSteps": weber_steps_text(step.weber_steps.abs()),
        "texture": layer.texture.as_ref().map(texture),
    })
}

/// Left, top, width and height of the smallest rectangle around what the table with this number became, mm: the
/// compiler outlines a picture that has no region. `None` where a part of it is the whole screen.
fn outline_mm(program: &Program, table: usize) -> Option<[f64; 4]> {
    let own = program.records.iter().zip(&program.titles).filter(|(_, title)| title.number().table == table);
    let corners = own.map(|(record, _)| corners_m(&record.region, &program.points)).collect::<Option<Vec<_>>>()?;
    let corners = corners.into_iter().reduce(|[left, top, right, bottom], [other_left, other_top, x, y]| {
        [left.min(other_left), top.min(other_top), right.max(x), bottom.max(y)]
    });
    // They are hundredths of a millimetre, and so not the nearest f32 to them.
    let [left, top, right, bottom] = corners?.map(|side_m| (1e5 * f64::from(side_m)).round() / 100.0);
    Some([left, top, right - left, bottom - top])
}

/// Left, top, right and bottom of a region, m; `None` for the whole screen.
fn corners_m(region: &Region, points: &[Point]) -> Option<[f32; 4]> {
    match *region {
        Region::Screen => None,
        Region::Rectangle { x_m, y_m, width_m, height_m } | Region::Ellipse { x_m, y_m, width_m, height_m } => {
            Some([x_m, y_m, x_m + width_m, y_m + height_m])
        }
        Region::Polygon { first, count } => {
            let own = points.iter().skip(usize::from(first)).take(usize::from(count));
            own.map(|point| [point.x, point.y, point.x, point.y])
                .reduce(|[left, top, right, bottom], [x, y, ..]| [left.min(x), top.min(y), right.max(x), bottom.max(y)])
        }
    }
}

/// The gains in reach of some records together, once they are on and all others as the scene starts.
fn gain_reach(program: &Program, records: &[u8]) -> Option<(f64, f64)> {
    let is_meant = |record: usize| records.iter().any(|meant| usize::from(*meant) == record);
    let settings = program.start.iter().enumerate();
    let settings: Vec<LayerSetting> =
        settings.map(|(at, setting)| LayerSetting { on: setting.on || is_meant(at), ..*setting }).collect();
    // They are hundredths, and so not the nearest f32 to them.
    let hundredths = |gain: f32| (100.0 * f64::from(gain)).round() / 100.0;
    program.gains_in_reach(records, &settings).map(|(least, most)| (hundredths(least), hundredths(most)))
}
