//! The layers of a scene's files, for a page that lists them beside the text.

use frixel_felt::check::feel;
use frixel_felt::judge::{Judgement, LayerVerdict, Texture, weber_steps_text};
use frixel_layers::{Point, Region, range};
use frixel_scene::{LayerSetting, LayerTable, Program, Scene};
use serde::Serialize;

/// A layer as it is written in a file. With `repeat`, it is several layers of the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct FileLayer {
    /// Number of the layer in messages, from 1.
    index: usize,
    /// Its name, or else its kind.
    name: String,
    /// Its kind.
    kind: &'static str,
    /// What a person will feel of it, or of its first copy, one sentence; empty for a layer that is not felt anywhere.
    felt: String,
    /// The same as numbers; `null` for a layer that is not felt anywhere.
    perceived: Option<Perceived>,
    /// The numbers of its layers in control lines.
    controls: Vec<String>,
    /// Whether they can be changed while they play.
    is_live: bool,
    /// Why they cannot, one sentence; empty if they can.
    why_not_live: String,
    /// Whether they are on when the scene begins to play.
    starts_on: bool,
    /// The gain in the file, and the least and the largest that a board takes.
    gain: f64,
    gain_min: f64,
    gain_max: f64,
    /// The least and the largest gain with which the drive can give what the layer asks for when it is on; `null` where
    /// it cannot be changed, or with no gain.
    gain_reach: Option<(f64, f64)>,
    /// The file that it stands in, if that is not the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    /// First and last line of its table, from 1.
    from: (usize, usize),
    /// Left, top, width and height of its region, or of the picture that it shows, mm; `null` for the whole screen.
    box_mm: Option<[f64; 4]>,
}

/// What is felt of a layer, or of its first copy.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
struct Perceived {
    /// Whether it is felt, as the command says it.
    verdict: &'static str,
    /// The friction before and after its step, N: that within it or that at its border, whichever is larger.
    from_n: f64,
    to_n: f64,
    /// Size of the step in Weber steps, as the command prints it.
    weber_steps: String,
    /// The vibration that is felt most surely when it is slid over; `null` for a layer without one.
    texture: Option<PerceivedTexture>,
}

/// A vibration under a sliding finger.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
struct PerceivedTexture {
    verdict: &'static str,
    speed_mm_per_s: f64,
    frequency_hz: f64,
    amplitude_n: f64,
    /// The smallest amplitude that is felt at this frequency, N; `null` where none is known.
    threshold_n: Option<f64>,
}

impl Perceived {
    fn of(layer: &LayerVerdict) -> Self {
        let step = layer.main_step();
        Self {
            verdict: layer.verdict.words(),
            from_n: step.from_n,
            to_n: step.to_n,
            weber_steps: weber_steps_text(step.weber_steps.abs()),
            texture: layer.texture.as_ref().map(PerceivedTexture::of),
        }
    }
}

impl PerceivedTexture {
    fn of(texture: &Texture) -> Self {
        let Texture { speed_mm_per_s, frequency_hz, amplitude_n, threshold_n, verdict, .. } = *texture;
        Self { verdict: verdict.words(), speed_mm_per_s, frequency_hz, amplitude_n, threshold_n }
    }
}

/// The layers of a scene, called `entry`, that was compiled to `program`.
pub(crate) fn layers(scene: &Scene, entry: &str, program: &Program, judgement: &Judgement) -> Vec<FileLayer> {
    let describe = |table: LayerTable| {
        let LayerTable { number, name, kind, gain, starts_on, layers, file, lines, bounds_mm } = table;
        let live: Result<Vec<Vec<u8>>, _> = layers.iter().map(|layer| program.layers.records(layer)).collect();
        let gain_reach = live.as_ref().ok().and_then(|records| gain_reach(program, &records.concat()));
        FileLayer {
            index: number,
            name: name.unwrap_or_else(|| kind.to_owned()),
            kind,
            felt: perceived(number, judgement).map_or_else(String::new, feel::sentence),
            perceived: perceived(number, judgement).map(Perceived::of),
            controls: layers,
            is_live: live.is_ok(),
            why_not_live: live.err().map_or(String::new(), |error| error.to_string()),
            starts_on,
            gain,
            gain_min: range::GAIN.min,
            gain_max: range::GAIN.max,
            gain_reach,
            file: (file != entry).then_some(file),
            from: lines,
            box_mm: bounds_mm.or_else(|| outline_mm(program, number)),
        }
    };
    scene.layer_tables().into_iter().map(describe).collect()
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

/// What is felt of the layer of the table with this number, or of its first copy.
fn perceived(table: usize, judgement: &Judgement) -> Option<&LayerVerdict> {
    judgement.layers.iter().find(|layer| layer.layer.number().table == table)
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
