//! The combined results of many cells: the share of the simulated fingers that notice each layer.

use std::collections::BTreeMap;

use serde::Serialize;

use super::cell::{CellResult, LayerResult};
use super::parameter::Value;
use crate::score::Verdicts;
use crate::statistics::{median, share_interval};

/// Most lines of a summary: a terminal has some 40.
const LINES_MAX: usize = 36;

/// The share of some fingers that notice a layer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerShare {
    /// Number and name of the layer.
    pub layer: String,
    /// Number of the layer's table in the scene.
    pub table: usize,
    /// How many of the fingers that touched it notice it.
    pub simulated_fingers: Verdicts,
    /// Share of the fingers that touched it and notice it with certainty.
    pub felt_share: f64,
    /// 95 % interval of that share among people like these (Wilson 1927, doi:10.1080/01621459.1927.10502953).
    pub interval: [f64; 2],
    /// Median of the felt contrast within the layer, in Weber steps.
    pub contrast_weber_steps: f64,
}

/// Fingers that differ by the person only.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Name of the scene.
    pub scene: String,
    /// The values that the plan set.
    pub parameters: BTreeMap<String, Value>,
    /// Name of the screen; absent for the scene's own.
    pub screen: Option<String>,
    /// Name of the touch source.
    pub touch: String,
    /// Result of each finger, by the number of the person.
    pub fingers: Vec<CellResult>,
}

/// The results of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// The groups, ordered by the first cell of each.
    pub groups: Vec<Group>,
}

impl Study {
    /// Combines the results of cells, given in the order of their plan.
    pub fn new(results: impl IntoIterator<Item = CellResult>) -> Self {
        let mut groups: Vec<Group> = Vec::new();
        for result in results {
            // From the end, since most results are of the group of the one before.
            match groups.iter_mut().rfind(|group| group.is_of(&result)) {
                Some(group) => group.fingers.push(result),
                None => groups.push(Group {
                    scene: result.scene.clone(),
                    parameters: result.parameters.clone(),
                    screen: result.screen.clone(),
                    touch: result.touch.clone(),
                    fingers: vec![result],
                }),
            }
        }
        Self { groups }
    }

    /// Lines for a person, with their names: the share of the fingers that notice each layer, by the groups.
    pub fn summary(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for group in &self.groups {
            let fingers = match group.fingers.len() {
                1 => "1 simulated finger".to_owned(),
                count => format!("{count} simulated fingers"),
            };
            lines.push(format!("  {}, {fingers}", group.title()));
            for LayerShare { layer, simulated_fingers, interval: [low, high], .. } in group.layer_rows() {
                let Verdicts { touched, felt, maybe, .. } = simulated_fingers;
                let maybe = if maybe > 0 { format!(", maybe by {maybe}") } else { String::new() };
                let (low, high) = (100.0 * low, 100.0 * high);
                lines.push(format!("  {layer:<30} felt by {felt} of {touched} ({low:.0} to {high:.0} %){maybe}"));
            }
        }
        if lines.len() > LINES_MAX {
            let more = lines.len() - LINES_MAX;
            lines.truncate(LINES_MAX);
            lines.push(format!("  and {more} more lines: see layers.csv"));
        }
        lines
    }

    /// The paths of the fields that were set.
    pub fn paths(&self) -> Vec<&str> {
        let mut paths: Vec<&str> =
            self.groups.iter().flat_map(|group| group.parameters.keys().map(String::as_str)).collect();
        paths.sort_unstable();
        paths.dedup();
        paths
    }
}

impl Group {
    fn is_of(&self, result: &CellResult) -> bool {
        (&self.scene, &self.parameters, &self.screen, &self.touch)
            == (&result.scene, &result.parameters, &result.screen, &result.touch)
    }

    /// The layers that a finger touched, in the order of the scene.
    pub fn layers(&self) -> Vec<LayerShare> {
        shares(self.fingers.iter())
    }

    /// A row for each layer that a finger touched: of copies, the one that the smallest share of the fingers notices.
    pub fn layer_rows(&self) -> Vec<LayerShare> {
        least_of_copies(self.layers())
    }

    /// As [`Self::layer_rows`], of the fingers whose moisture is in a range, in standard deviations.
    pub fn layer_rows_of_moisture(&self, range: std::ops::Range<f64>) -> Vec<LayerShare> {
        least_of_copies(shares(self.fingers.iter().filter(|finger| range.contains(&finger.moisture))))
    }

    /// Label of the group: its scene, parameter values, screen and touch source.
    pub fn title(&self) -> String {
        self.title_without("")
    }

    /// Like [`Self::title`], without the field of this path.
    pub fn title_without(&self, path: &str) -> String {
        let values = self.parameters.iter().filter(|(other, _)| *other != path);
        let values = values.map(|(path, value)| format!("{path} = {value}"));
        let screen = self.screen.iter().map(|screen| format!("screen {screen}"));
        let touch = format!("touch {}", self.touch);
        let parts: Vec<String> =
            std::iter::once(self.scene.clone()).chain(values).chain(screen).chain([touch]).collect();
        parts.join(", ")
    }
}

fn shares<'f>(fingers: impl Iterator<Item = &'f CellResult>) -> Vec<LayerShare> {
    let fingers: Vec<&CellResult> = fingers.collect();
    let mut layers: Vec<&LayerResult> = Vec::new();
    for layer in fingers.iter().flat_map(|finger| &finger.layers) {
        if layers.iter().all(|other| other.layer != layer.layer) {
            layers.push(layer);
        }
    }
    let share = |of: &LayerResult| {
        let touched = || fingers.iter().filter_map(|finger| finger.layers.iter().find(|layer| layer.layer == of.layer));
        let simulated_fingers: Verdicts = touched().map(|layer| layer.verdict).collect();
        LayerShare {
            layer: of.layer.clone(),
            table: of.table,
            simulated_fingers,
            felt_share: simulated_fingers.felt as f64 / simulated_fingers.touched as f64,
            interval: share_interval(simulated_fingers.felt, simulated_fingers.touched),
            contrast_weber_steps: median(touched().map(|layer| layer.contrast_weber_steps)),
        }
    };
    layers.into_iter().map(share).collect()
}

fn least_of_copies(layers: Vec<LayerShare>) -> Vec<LayerShare> {
    let mut rows: Vec<LayerShare> = Vec::new();
    for layer in layers {
        match rows.iter_mut().find(|row| row.table == layer.table) {
            Some(row) if layer.felt_share < row.felt_share => *row = layer,
            Some(_) => {}
            None => rows.push(layer),
        }
    }
    rows
}
