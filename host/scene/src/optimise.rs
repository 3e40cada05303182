//! Makes a program smaller without changing the felt friction: drops covered layers, replaces uniform layers by
//! constants, merges constants, and drops unused points and pictures.

use std::collections::BTreeSet;
use std::time::Duration;

use frixel_layers::{Blend, Constant, Header, Interval, Layer, Point, Record, Region, Speed};

use super::LayerSetting;
use super::layer::Layer as SceneLayer;
use super::log::Log;
use super::optimisation::Optimisation;
use super::program::Program;

/// A record with the layer that it was made from.
struct LayerWithRecord<'l> {
    layer: &'l SceneLayer,
    record: Record,
}

/// Makes a program smaller. `layers` are those of its records. Layers that the host may change during play stay.
pub(super) fn optimise(program: &mut Program, layers: &[&SceneLayer], log: &mut Log) {
    let records = std::mem::take(&mut program.records);
    let bitmaps: Vec<(u32, &SceneLayer)> = layers
        .iter()
        .zip(&records)
        .filter_map(|(layer, record)| Some((record.layer.bitmap_crc32()?, *layer)))
        .collect();
    let mut items: Vec<LayerWithRecord> =
        layers.iter().zip(records).map(|(layer, record)| LayerWithRecord { layer, record }).collect();
    flatten(&mut items, &program.points, log);
    drop_covered(&mut items, &program.header, log);
    drop_idle(&mut items, log);
    fold(&mut items, log);
    let setting = |item: &LayerWithRecord| LayerSetting { on: item.layer.starts_on, gain: item.record.gain };
    program.start = items.iter().map(setting).collect();
    let pattern =
        |item: &LayerWithRecord| item.layer.pattern_ms.iter().map(|ms| Duration::from_secs_f64(1e-3 * ms)).collect();
    program.patterns = items.iter().map(pattern).collect();
    (program.titles, program.records) = items.into_iter().map(|item| (item.layer.title.clone(), item.record)).unzip();
    compact_points(program);
    drop_bitmaps(program, &bitmaps, log);
}

/// Replaces layers whose target friction is the same everywhere and at all times by constants.
fn flatten(items: &mut [LayerWithRecord], points: &[Point], log: &mut Log) {
    for item in items.iter_mut().filter(|item| !item.layer.live) {
        let layer = &item.record.layer;
        if layer.is_streamed() || matches!(layer, Layer::Constant(_)) {
            continue;
        }
        let Interval { low, high } = layer.bounds(points);
        if low.to_bits() == high.to_bits() {
            item.record.layer = Layer::Constant(Constant { electric_friction_n: low });
            log.note_optimisation(item.layer, Optimisation::Flat { layer: item.layer.title.to_string() });
        }
    }
}

/// Drops layers that a layer above replaces entirely.
fn drop_covered(items: &mut Vec<LayerWithRecord>, header: &Header, log: &mut Log) {
    let mut number = 0;
    while let Some(item) = items.get(number) {
        let hides = |above: &&LayerWithRecord| {
            let always = !above.layer.live && !above.record.layer.is_streamed();
            always && above.record.blend == Blend::Replace && covers(above.record.region, item.record.region, header)
        };
        match items.iter().skip(number + 1).find(hides) {
            Some(by) if !item.layer.live => {
                let (layer, by) = (item.layer.title.to_string(), by.layer.title.to_string());
                log.note_optimisation(item.layer, Optimisation::Covered { layer, by });
                items.remove(number);
            }
            _ => number += 1,
        }
    }
}

/// Whether a region covers another one within the screen.
fn covers(region: Region, other: Region, header: &Header) -> bool {
    let screen = [0.0, 0.0, header.screen_width_m, header.screen_height_m];
    let sides = |region| match region {
        Region::Screen => Some(screen),
        Region::Rectangle { x_m, y_m, width_m, height_m } | Region::Ellipse { x_m, y_m, width_m, height_m } => {
            Some([x_m, y_m, x_m + width_m, y_m + height_m])
        }
        Region::Polygon { .. } => None,
    };
    if region == other || region == Region::Screen {
        return true;
    }
    // Of the other shapes, only a rectangle fills its bounding box.
    match (region, sides(region), sides(other)) {
        (Region::Rectangle { .. }, Some([left, top, right, bottom]), Some([x1, y1, x2, y2])) => {
            left <= x1 && top <= y1 && right >= x2 && bottom >= y2
        }
        _ => false,
    }
}

/// Drops constants without effect: adding zero, a factor of one, and zero on a bare screen.
fn drop_idle(items: &mut Vec<LayerWithRecord>, log: &mut Log) {
    let mut bare = true;
    items.retain(|item| {
        let own = match item.record.layer {
            Layer::Constant(Constant { electric_friction_n }) => Some(item.record.gain * electric_friction_n),
            _ => None,
        };
        let is = |value: f32| own.is_some_and(|own| own.to_bits() == value.to_bits());
        let idle = match item.record.blend {
            Blend::Add => is(0.0),
            Blend::Multiply => is(1.0) || bare,
            Blend::Replace | Blend::Max => bare && is(0.0),
        };
        let goes = idle && !item.layer.live;
        if goes {
            log.note_optimisation(item.layer, Optimisation::Idle { layer: item.layer.title.to_string() });
        } else {
            bare = false;
        }
        !goes
    });
}

/// Merges a constant into the constant directly below it if both have the same region. The result is bit-identical to
/// the board's.
fn fold(items: &mut Vec<LayerWithRecord>, log: &mut Log) {
    let mut number = 0;
    while let (Some(below), Some(above)) = (items.get(number), items.get(number + 1)) {
        let constant = |item: &LayerWithRecord| match item.record.layer {
            Layer::Constant(Constant { electric_friction_n }) if !item.layer.live => {
                Some(item.record.gain * electric_friction_n)
            }
            _ => None,
        };
        let together = below.record.region == above.record.region && below.record.blend == Blend::Replace;
        let folded = match (constant(below), constant(above), above.record.blend) {
            (Some(below), Some(above), Blend::Add) if together => Some(below + above),
            (Some(below), Some(above), Blend::Multiply) if together => Some(below * above),
            (Some(below), Some(above), Blend::Max) if together => Some(below.max(above)),
            _ => None,
        };
        let Some(electric_friction_n) = folded else {
            number += 1;
            continue;
        };
        let (layer, into) = (above.layer.title.to_string(), below.layer.title.to_string());
        log.note_optimisation(above.layer, Optimisation::Folded { layer, into });
        items.remove(number + 1);
        if let Some(below) = items.get_mut(number) {
            below.record.gain = 1.0;
            below.record.layer = Layer::Constant(Constant { electric_friction_n });
        }
    }
}

/// Keeps the points that records refer to, and renumbers them.
fn compact_points(program: &mut Program) {
    let all = std::mem::take(&mut program.points);
    let mut kept: Vec<Point> = Vec::new();
    let mut moved = |first: &mut u8, count: u8| {
        let own: Vec<Point> = all.iter().skip(usize::from(*first)).take(usize::from(count)).copied().collect();
        let place = kept.windows(own.len().max(1)).position(|held| held == own).unwrap_or(kept.len());
        if place == kept.len() {
            kept.extend(own);
        }
        // The index fits, since the number of points does not grow.
        *first = place as u8;
    };
    for record in &mut program.records {
        if let Region::Polygon { first, count } = &mut record.region {
            moved(first, *count);
        }
        if let Layer::Speed(Speed { first, count }) = &mut record.layer {
            moved(first, *count);
        }
    }
    program.points = kept;
}

/// Drops bitmaps that no record refers to. `bitmaps` has those of all layers.
fn drop_bitmaps(program: &mut Program, bitmaps: &[(u32, &SceneLayer)], log: &mut Log) {
    let named: BTreeSet<u32> = program.records.iter().filter_map(|record| record.layer.bitmap_crc32()).collect();
    program.bitmaps.retain(|bitmap| {
        let keeps = named.contains(&bitmap.crc32);
        if let Some((_, layer)) = bitmaps.iter().find(|(crc32, _)| !keeps && *crc32 == bitmap.crc32) {
            log.note_optimisation(layer, Optimisation::Bitmap { bytes: bitmap.samples.len() });
        }
        keeps
    });
}
