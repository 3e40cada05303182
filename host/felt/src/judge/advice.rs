//! Changes of an element that may make it perceptible, in the order in which they are tried.

use frixel_layers::{Blend, Edge, Grating, Layer, Record, Region, Rings};
use frixel_scene::{LayerSetting, Program};

use super::{Element, LayerVerdict, Reason};

/// Size factors, in the order in which they are tried.
const SIZES: [f64; 8] = [1.25, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0];
/// Factors of the friction.
const GAINS: [f64; 4] = [1.25, 1.6, 2.0, 3.0];
/// Largest fraction of the screen's sides that an enlarged element may fill.
const SCREEN_PART_MAX: f64 = 0.8;

/// A change of an element.
pub(super) struct Change {
    /// The changed fields, as in a scene file.
    pub(super) text: String,
    pub(super) element: Element,
}

/// Changes that may make an element perceptible, the smallest first.
pub(super) fn changes(element: &Element, found: &LayerVerdict) -> Vec<Change> {
    let is_small = |reason: &Reason| matches!(reason, Reason::TooSmall { .. });
    let is_slow = |reason: &Reason| matches!(reason, Reason::TooSlow { .. });
    let sizes = || SIZES.iter().filter_map(|factor| resized(element, *factor));
    let steeper = || SIZES.iter().filter_map(|factor| resized(element, 1.0 / factor));
    let stronger = || {
        let gains = GAINS.iter().filter_map(|factor| with_gain(element, *factor));
        gains.chain(strongest(element)).chain(widest(element))
    };
    let mut changes: Vec<Change> = if found.reasons.iter().any(is_small) {
        let both = strongest(element).into_iter().chain(widest(element)).flat_map(|strong| {
            SIZES.iter().filter_map(move |factor| {
                let large = resized(&strong.element, *factor)?;
                Some(Change { text: format!("{}, {}", large.text, strong.text), ..large })
            })
        });
        sizes().chain(stronger()).chain(both).collect()
    } else if found.reasons.iter().any(is_slow) {
        steeper().chain(stronger()).collect()
    } else {
        stronger().chain(sizes()).collect()
    };
    changes.extend(on_bare_glass(element));
    changes
}

/// The element without the layers that it adds to, as a constant of no electric friction makes it.
fn on_bare_glass(element: &Element) -> Option<Change> {
    (element.layer > 0 && element.joins_those_below()).then_some(())?;
    let mut program = element.program.clone();
    for (record, setting) in program.records.iter_mut().zip(&mut program.start).take(element.layer) {
        (record.gain, setting.gain) = (0.0, 0.0);
    }
    let Element { burst, is_triggered, .. } = *element;
    let element = Element { burst, is_triggered, ..Element::of(&program, element.layer)? };
    Some(Change { text: "a constant of `friction_fraction = 0` in its region below it".to_owned(), element })
}

/// The element with its record and setting changed; `None` if it becomes invisible.
fn changed(element: &Element, text: String, change: impl FnOnce(&mut Record, &mut LayerSetting)) -> Option<Change> {
    let mut program = element.program.clone();
    change(program.records.get_mut(element.layer)?, program.start.get_mut(element.layer)?);
    // The board would otherwise limit its table to the friction of the original scene.
    program.header.electric_friction_max_n = None;
    let Element { burst, is_triggered, .. } = *element;
    Some(Change { text, element: Element { burst, is_triggered, ..Element::of(&program, element.layer)? } })
}

/// The element scaled by `factor`: the wavelength of stripes, the width of a ridge, or the region.
fn resized(element: &Element, factor: f64) -> Option<Change> {
    let times = |value: f32| f64::from(value) * factor;
    // Round to tenths of a millimetre.
    let rounded_m = |size_m: f64| 1e-4 * (1e4 * size_m).round();
    let (field, size_m, layer) = match element.record()?.layer {
        Layer::Edge(edge) => {
            let width_m = rounded_m(times(edge.width_m));
            ("width_mm", width_m, Layer::Edge(Edge { width_m: width_m as f32, ..edge }))
        }
        Layer::Grating(grating) => {
            let cycles_per_m = f64::from(grating.cycles_per_m_x.hypot(grating.cycles_per_m_y));
            let wavelength_m = rounded_m(factor / cycles_per_m);
            let part = 1.0 / (wavelength_m * cycles_per_m);
            let scaled = |cycles_per_m: f32| (f64::from(cycles_per_m) * part) as f32;
            let (cycles_per_m_x, cycles_per_m_y) = (scaled(grating.cycles_per_m_x), scaled(grating.cycles_per_m_y));
            ("wavelength_mm", wavelength_m, Layer::Grating(Grating { cycles_per_m_x, cycles_per_m_y, ..grating }))
        }
        Layer::Rings(rings) => {
            let wavelength_m = rounded_m(factor / f64::from(rings.cycles_per_m));
            let cycles_per_m = (1.0 / wavelength_m) as f32;
            ("wavelength_mm", wavelength_m, Layer::Rings(Rings { cycles_per_m, ..rings }))
        }
        _ if factor > 1.0 => return enlarged(element, rounded_m, factor),
        _ => return None,
    };
    (size_m > 0.0).then_some(())?;
    changed(element, format!("{field} = {}", tenths_of_mm(size_m)), |record, _| record.layer = layer)
}

/// A length in millimetres, rounded to tenths.
fn tenths_of_mm(size_m: f64) -> String {
    format!("{:.1}", 1e3 * size_m).trim_end_matches(".0").to_owned()
}

/// The element with its region scaled by `factor` around the middle, within the screen.
fn enlarged(element: &Element, rounded_m: impl Fn(f64) -> f64, factor: f64) -> Option<Change> {
    let header = &element.program.header;
    let screen_m = [header.screen_width_m, header.screen_height_m].map(f64::from);
    let grown = |start_m: f32, size_m: f32, screen_m: f64| {
        let (start_m, size_m) = (f64::from(start_m), f64::from(size_m));
        let grown_m = rounded_m((factor * size_m).min(SCREEN_PART_MAX * screen_m)).max(size_m);
        let grown_start_m = (start_m + 0.5 * (size_m - grown_m)).clamp(0.0, (screen_m - grown_m).max(0.0));
        (grown_start_m as f32, grown_m as f32)
    };
    let region = &element.record()?.region;
    let (Region::Rectangle { x_m, y_m, width_m, height_m } | Region::Ellipse { x_m, y_m, width_m, height_m }) = *region
    else {
        return None;
    };
    let (x_m, new_width_m) = grown(x_m, width_m, screen_m[0]);
    let (y_m, new_height_m) = grown(y_m, height_m, screen_m[1]);
    let region = match region {
        Region::Ellipse { .. } => Region::Ellipse { x_m, y_m, width_m: new_width_m, height_m: new_height_m },
        _ => Region::Rectangle { x_m, y_m, width_m: new_width_m, height_m: new_height_m },
    };
    let sides = [("width_mm", width_m, new_width_m), ("height_mm", height_m, new_height_m)];
    let sides = sides.iter().filter(|(_, before_m, after_m)| after_m > before_m);
    let text: Vec<String> =
        sides.map(|(name, _, after_m)| format!("{name} = {}", tenths_of_mm(f64::from(*after_m)))).collect();
    (!text.is_empty()).then_some(())?;
    changed(element, format!("a region of {}", text.join(", ")), |record, _| record.region = region)
}

/// The largest gain within the drive's reach.
fn gain_max(element: &Element) -> Option<f64> {
    let Element { program, layer, .. } = element;
    let (_, most) = program.gains_in_reach(&[u8::try_from(*layer).ok()?], &program.start)?;
    Some(f64::from(most))
}

/// The element with its gain scaled by `factor`, within the drive's reach.
fn with_gain(element: &Element, factor: f64) -> Option<Change> {
    let gain = f64::from(element.program.start.get(element.layer)?.gain);
    let gain = (100.0 * factor * gain).round() / 100.0;
    (gain < gain_max(element)?).then(|| gained(element, gain))?
}

/// The element with the largest gain within the drive's reach.
fn strongest(element: &Element) -> Option<Change> {
    let gain = f64::from(element.program.start.get(element.layer)?.gain);
    let most = (100.0 * gain_max(element)?).floor() / 100.0;
    (most > gain).then(|| gained(element, most))?
}

fn gained(element: &Element, gain: f64) -> Option<Change> {
    changed(element, format!("gain = {gain}"), |record, setting| {
        (record.gain, setting.gain) = (gain as f32, gain as f32);
    })
}

/// The element spanning the drive's full range.
fn widest(element: &Element) -> Option<Change> {
    let record = element.record().filter(|record| record.blend != Blend::Multiply)?;
    let reach_n = element.program.reach.electric_friction_max_n;
    let (low, high, click_n) = match record.layer {
        Layer::Button(button) if button.face_n > button.rim_n => ("rim", "face", button.click.height_n),
        Layer::Button(button) => ("face", "rim", button.click.height_n),
        _ => ("low", "high", 0.0),
    };
    let fraction = ((0.99 - f64::from(click_n).max(0.0) / reach_n) * 100.0).floor() / 100.0;
    if fraction <= 0.0 {
        return None;
    }
    let gain = if element.program.start.get(element.layer)?.gain.total_cmp(&1.0).is_eq() { "" } else { ", gain = 1" };
    let mut layer = record.layer;
    let (low_n, high_n) = match &mut layer {
        Layer::Grating(grating) => (&mut grating.trough_n, &mut grating.crest_n),
        Layer::Rings(rings) => (&mut rings.trough_n, &mut rings.crest_n),
        Layer::Spokes(spokes) => (&mut spokes.trough_n, &mut spokes.crest_n),
        Layer::Noise(noise) => (&mut noise.low_n, &mut noise.high_n),
        Layer::Vibration(vibration) => (&mut vibration.low_n, &mut vibration.high_n),
        Layer::Button(button) if button.face_n > button.rim_n => (&mut button.rim_n, &mut button.face_n),
        Layer::Button(button) => (&mut button.face_n, &mut button.rim_n),
        _ => return None,
    };
    (*low_n, *high_n) = (0.0, (fraction * reach_n) as f32);
    let text = format!("{low}_fraction = 0, {high}_fraction = {fraction}{gain}");
    let change = changed(element, text, |record, setting| {
        (record.layer, record.gain, setting.gain) = (layer, 1.0, 1.0);
    })?;
    let Program { start, .. } = &change.element.program;
    change.element.program.clamped_with(start).is_none().then_some(change)
}
