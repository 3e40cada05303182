//! Refuses a scene whose tick takes too long at some place, as the board would.

use frixel_layers::Cell;
use frixel_layers::cost::{Worst, worst_of_scene};

use super::file::Scene;
use super::log::Log;
use super::mistake::Mistake;
use super::program::Program;

/// Refuses a program whose longest tick takes more than `max` instructions. The mistake stands at the topmost layer of the
/// place.
pub(super) fn check(scene: &Scene, program: &Program, max: u32, log: &mut Log) {
    let Worst { instructions, cell } = program.worst_tick();
    if instructions <= max {
        return;
    }
    let titles = program.titles_in(&cell);
    let topmost = scene.layers.iter().rfind(|layer| titles.last().is_some_and(|title| *title == layer.title));
    let (x_mm, y_mm) = middle_mm(&cell);
    let mistake = Mistake::TickTooLong { instructions, max, layers: titles.join(" and "), x_mm, y_mm };
    log.add(topmost.map_or(0, |layer| layer.places.table()), mistake);
}

impl Program {
    /// Where a tick takes most on a Cortex-M4F, and how many instructions.
    pub fn worst_tick(&self) -> Worst {
        worst_of_scene(&self.header, &self.records, &self.points)
    }

    /// How messages call the layers that may act in a cell, from bottom to top.
    pub fn titles_in(&self, cell: &Cell) -> Vec<&str> {
        (0..).zip(&self.titles).filter(|(number, _)| cell.has(*number)).map(|(_, title)| title.as_str()).collect()
    }
}

/// The middle of a cell, to a tenth of a millimetre: the grid is coarse.
pub fn middle_mm(cell: &Cell) -> (f64, f64) {
    let mm = |metres: f32| (1e4 * f64::from(metres)).round() / 10.0;
    (mm(cell.x_m), mm(cell.y_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{HEAD, PICTURES, compile_text};

    #[test]
    fn the_longest_tick_is_refused_with_its_place_and_number() {
        let layer = |x_mm: u32| {
            format!(
                "[[layer]]\nkind = \"grating\"\nwavelength_mm = 2\nlow_n = 0\nhigh_n = 0.001\nblend = \"add\"\n\
                 region = {{ x_mm = {x_mm}, y_mm = 0, width_mm = 20, height_mm = 20 }}\n"
            )
        };
        let text = format!("{HEAD}{}{}{}", layer(0), layer(90), layer(95));
        let program = compile_text(&text).expect("it compiles");
        let scene = Scene::parse(&text, "test.toml", &*PICTURES).expect("it reads");
        let Worst { instructions, cell } = program.worst_tick();
        assert_eq!(cell.layers, [0b110, 0]);
        for (max, refused) in [(instructions - 1, true), (instructions, false)] {
            let mut log = Log::new(&scene.source);
            check(&scene, &program, max, &mut log);
            let told = log.finish(Some(())).err().map(|error| error.to_string());
            let line = 2 * 7 + HEAD.lines().count() + 1;
            let expected = format!(
                "test.toml:{line}:1: a tick takes up to {instructions} instructions near x {} mm, y {} mm, for layer 2 (grating) and \
                 layer 3 (grating), and the board has time for {max}: move layers apart, or leave some out",
                (1e4 * f64::from(cell.x_m)).round() / 10.0,
                (1e4 * f64::from(cell.y_m)).round() / 10.0
            );
            assert_eq!(told, refused.then_some(expected));
        }
    }
}
