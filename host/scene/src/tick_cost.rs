//! Refuses a scene whose longest tick exceeds the limit, by the same estimate as the board.

use std::cmp::Reverse;

use frixel_layers::cost::{self, LayerCosts, Worst, worst_of_scene};
use frixel_layers::{Cell, layer_numbers, layer_set};
use frixel_wire::hello::Core;

use super::file::Scene;
use super::log::Log;
use super::mistake::FitMistake;
use super::program::Program;
use super::reference::Shape;
use super::titles::{LayerTitle, listed};

/// Reports a mistake if the longest tick is estimated at more than `cycles_max` on a core, at the topmost layer of that
/// place.
///
/// The board adds up all layers in a cell of its grid. The message names the layers that overlap at one place of that
/// cell if they alone exceed the limit; otherwise it names all layers of the cell.
pub(super) fn check(scene: &Scene, program: &Program, core: Core, cycles_max: u32, log: &mut Log) {
    let worst = program.worst_tick(core);
    if worst.cycles(core) <= cycles_max {
        return;
    }
    let meeting = program.dearest_meeting(&worst.cell, core);
    let meet = meeting.as_ref().is_some_and(|meeting| meeting.cycles > cycles_max);
    let (layers, (x_mm, y_mm)) = match meeting {
        Some(Meeting { layers, place_m, .. }) if meet => (layers, rounded_mm(place_m)),
        _ => (layer_numbers(worst.cell.layers).collect(), middle_mm(&worst.cell)),
    };
    let titles: Vec<&LayerTitle> = layers.iter().filter_map(|number| program.titles.get(*number)).collect();
    let topmost = titles.last().and_then(|title| scene.layers.iter().find(|layer| layer.number() == title.number()));
    let cycles = worst.cycles(core);
    let alone = titles.len() == 1;
    let mistake = FitMistake::TickTooLong { cycles, cycles_max, layers: listed(&titles), alone, meet, x_mm, y_mm };
    log.add(topmost.map_or(0, |layer| layer.places.table()), mistake);
}

/// Layers that overlap at one place.
struct Meeting {
    place_m: (f64, f64),
    /// Numbers of the layers, from bottom to top.
    layers: Vec<usize>,
    /// Estimated cycles of a tick with these layers only.
    cycles: u32,
}

impl Program {
    /// The longest tick on a core, as estimated by the board.
    pub fn worst_tick(&self, core: Core) -> Worst {
        worst_of_scene(&self.header, &self.records, &self.points, core)
    }

    /// Titles in messages of the layers that may act in a cell, from bottom to top.
    pub fn titles_in(&self, cell: &Cell) -> Vec<&LayerTitle> {
        layer_numbers(cell.layers).filter_map(|number| self.titles.get(number)).collect()
    }

    /// Finds the place in a cell where the overlapping layers take most cycles.
    ///
    /// Tries every pair of a left and a top edge, moved inside by a micrometre: if rectangles overlap, one of these
    /// places lies within all of them. Also tries the centres of ellipses and polygons.
    fn dearest_meeting(&self, cell: &Cell, core: Core) -> Option<Meeting> {
        let mut costs = LayerCosts::new(&self.header, core);
        for (number, record) in (0..).zip(&self.records) {
            costs.add(number, record, &self.points, core);
        }
        let shapes: Vec<(usize, Shape)> = layer_numbers(cell.layers)
            .filter_map(|number| self.records.get(number).map(|record| (number, record)))
            .map(|(number, record)| (number, Shape::new(record.region, &self.points)))
            .collect();
        let boxes = shapes.iter().map(|(_, shape)| shape.bounds_m()).filter(|[left_m, ..]| left_m.is_finite());
        let (columns, rows): (Vec<_>, Vec<_>) =
            boxes.map(|[left, top, right, bottom]| ([left, right], [top, bottom])).unzip();
        let candidates = |sides_m: &[[f64; 2]], middle_m: f32| -> Vec<f64> {
            let edges = sides_m.iter().map(|[start_m, _]| start_m + INSIDE_M);
            let middles = sides_m.iter().map(|[start_m, end_m]| f64::midpoint(*start_m, *end_m));
            edges.chain(middles).chain([f64::from(middle_m)]).collect()
        };
        let (xs, ys) = (candidates(&columns, cell.x_m), candidates(&rows, cell.y_m));
        xs.iter()
            .flat_map(|x_m| ys.iter().map(|y_m| (*x_m, *y_m)))
            .map(|place_m| meeting_at(place_m, &shapes, &costs, core))
            // The first of the most expensive places: a corner if there is one.
            .min_by_key(|meeting| Reverse(meeting.cycles))
    }
}

fn meeting_at(place_m: (f64, f64), shapes: &[(usize, Shape)], costs: &LayerCosts, core: Core) -> Meeting {
    let here = shapes.iter().filter(|(_, shape)| shape.covers(place_m.0, place_m.1));
    let layers: Vec<usize> = here.map(|(number, _)| *number).collect();
    let cycles = cost::cycles(core, costs.of_tick(layer_set(layers.iter().copied())));
    Meeting { place_m, layers, cycles }
}

/// Distance inside a region's edges at which overlaps are tried, m: above rounding errors, and imperceptible.
const INSIDE_M: f64 = 1e-6;

/// The centre of a cell, rounded to a tenth of a millimetre, since the grid is coarse.
pub fn middle_mm(cell: &Cell) -> (f64, f64) {
    rounded_mm((f64::from(cell.x_m), f64::from(cell.y_m)))
}

fn rounded_mm((x_m, y_m): (f64, f64)) -> (f64, f64) {
    let mm = |metres: f64| (1e4 * metres).round() / 10.0;
    (mm(x_m), mm(y_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{HEAD, PICTURES, compile_text};

    fn layer(x_mm: u32) -> String {
        format!(
            "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = 0\nhigh_n = 0.001\nblend = \"add\"\n\
             region = {{ x_mm = {x_mm}, y_mm = 0, width_mm = 20, height_mm = 20 }}\n"
        )
    }

    /// The message for a board whose limit is `more_cycles` above the scene's cost, or below it if negative.
    fn message(text: &str, more_cycles: i32) -> Option<String> {
        let program = compile_text(text).expect("it compiles");
        let scene = Scene::parse(text, "test.toml", &*PICTURES).expect("it reads");
        let mut log = Log::new(&scene.source);
        check(
            &scene,
            &program,
            Core::CortexM4f,
            program.worst_tick(Core::CortexM4f).cycles(Core::CortexM4f).saturating_add_signed(more_cycles),
            &mut log,
        );
        log.finish(Some(())).err().map(|error| error.to_string())
    }

    #[test]
    fn layers_that_meet_are_named_with_their_place_and_number() {
        let text = format!("{HEAD}{}{}{}", layer(0), layer(90), layer(95));
        let program = compile_text(&text).expect("it compiles");
        assert_eq!(program.worst_tick(Core::CortexM4f).cell.layers, [0b110, 0]);
        let cycles = program.worst_tick(Core::CortexM4f).cycles(Core::CortexM4f);
        let line = 2 * 7 + HEAD.lines().count() + 1;
        let expected = format!(
            "test.toml:{line}:1: layer 2 (grating) and layer 3 (grating) overlap at x 95 mm, y 0 mm: a tick there is \
             estimated at {cycles} cycles, and the board has time for {}: move layers apart, or leave some out",
            cycles - 1
        );
        assert_eq!(message(&text, -1), Some(expected));
        assert_eq!(message(&text, 0), None);
    }

    /// The edges of the layers touch, so that the layers share a cell of the grid.
    #[test]
    fn layers_that_only_share_a_cell_are_not_said_to_meet() {
        let text = format!("{HEAD}{}{}", layer(0), layer(20));
        let message = message(&text, -1).expect("it is refused");
        assert!(message.contains("layer 1 (grating) and layer 2 (grating) lie too close together at x"), "{message}");
    }
}
