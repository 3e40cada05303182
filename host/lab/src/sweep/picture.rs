//! The picture of a sweep: the share of the simulated fingers that notice each layer.

use frixel_chart::{Axis, Chart, DrawError, Line, Look, Mark, PALETTE, Panel};
use frixel_scene::printable_lines;

use super::study::{Group, LayerShare, Study};

/// Most panels of a picture.
const PANELS_MAX: usize = 24;
/// Most layers of a panel.
const LAYERS_MAX: usize = PALETTE.len();
/// The thirds of a population by moisture, each with its middle, in standard deviations.
const THIRDS: [(f64, f64, f64); 3] =
    [(-1.09, f64::NEG_INFINITY, -0.43), (0.0, -0.43, 0.43), (1.09, 0.43, f64::INFINITY)];

/// Draws the share of the simulated fingers that notice each layer: over each field that has several numbers, and over
/// the moisture of their skin.
pub(super) fn svg(study: &Study) -> Result<String, DrawError> {
    let mut panels: Vec<Panel> =
        study.paths().into_iter().flat_map(|path| over_parameter(study, path)).chain(over_moisture(study)).collect();
    let left_out = panels.len().saturating_sub(PANELS_MAX);
    panels.truncate(PANELS_MAX);
    let mut chart = Chart::new(panels, 2);
    "Share of the simulated fingers that notice each layer".clone_into(&mut chart.title);
    chart.caption = vec![
        "Simulated fingers; people were not asked. Lines from mark to mark guide the eye; upright lines are 95 % \
              intervals."
            .to_owned(),
    ];
    if left_out > 0 {
        chart.caption.push(format!("{left_out} more panels are left out: layers.csv has all rows."));
    }
    // Names that a scene gives can have control characters.
    Ok(printable_lines(&chart.svg()?).into_owned())
}

/// A panel for each set of groups that differ by one field only, which has numbers.
fn over_parameter(study: &Study, path: &str) -> Vec<Panel> {
    let mut rest: Vec<&Group> = study.groups.iter().collect();
    let mut panels = Vec::new();
    while let Some(first) = rest.first().copied() {
        let (alike, other): (Vec<&Group>, Vec<&Group>) =
            rest.into_iter().partition(|group| group.title_without(path) == first.title_without(path));
        rest = other;
        let number = |group: &Group| group.parameters.get(path)?.number();
        let places: Option<Vec<f64>> = alike.iter().map(|group| number(group)).collect();
        let columns = |group: &&Group| group.layer_rows();
        if let Some(places) = places.filter(|places| places.len() > 1) {
            let columns: Vec<_> = places.into_iter().zip(alike.iter().map(columns)).collect();
            panels.push(panel(&first.title_without(path), path, &columns));
        }
    }
    panels
}

/// A panel for each group.
fn over_moisture(study: &Study) -> impl Iterator<Item = Panel> {
    study.groups.iter().map(|group| {
        let columns = THIRDS.map(|(middle, from, to)| (middle, group.layer_rows_of_moisture(from..to)));
        panel(&group.title(), "moisture of the skin, thirds of the people, in standard deviations (assumed)", &columns)
    })
}

fn panel(title: &str, over: &str, columns: &[(f64, Vec<LayerShare>)]) -> Panel {
    let places = || columns.iter().map(|(place, _)| *place);
    let (low, high) = (places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max));
    let room = 0.05 * (high - low);
    let x = Axis::linear(over, low - room..high + room);
    let mut panel = Panel::new(title, x, Axis::linear("share that notices it", 0.0..1.0));
    let mut layers: Vec<&str> = Vec::new();
    for layer in columns.iter().flat_map(|(_, layers)| layers) {
        if !layers.contains(&layer.layer.as_str()) {
            layers.push(&layer.layer);
        }
    }
    for (name, colour) in layers.iter().take(LAYERS_MAX).zip(PALETTE) {
        let shares = || {
            let of = |layers: &Vec<LayerShare>| layers.iter().find(|layer| layer.layer == *name).cloned();
            columns.iter().filter_map(move |(place, layers)| Some((*place, of(layers)?)))
        };
        for (place, share) in shares() {
            let [low, high] = share.interval;
            panel.add("", Look::line(colour, Line::Thin), vec![(place, low), (place, high)]);
        }
        let look = Look { colour, line: Line::Solid, mark: Mark::Disc };
        panel.add(name, look, shares().map(|(place, share)| (place, share.felt_share)).collect());
    }
    panel
}
