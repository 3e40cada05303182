//! What a score says, in a sentence.

use frixel_scene::{LayerTitle, fold_copies};

use super::{LayerScore, LevelScore, Score, Verdicts};

/// Most layers that a sentence names.
const NAMED_MAX: usize = 6;

impl Score {
    /// Which layers the simulated fingers notice, and which levels of friction they tell apart.
    ///
    /// It names the layers that some fingers do not surely notice, and those of which the strokes say nothing.
    pub fn sentence(&self) -> String {
        let levels = self.levels.iter().filter(|level| !level.simulated_fingers.is_felt_by_all());
        let alike = told_apart(&levels.collect::<Vec<_>>(), self.simulated_fingers);
        let untouched: Vec<&LayerTitle> = self.untouched_layers.iter().collect();
        let untouched = (!self.layers.is_empty() && !untouched.is_empty())
            .then(|| format!("no stroke says anything about {}", listed(fold_copies(&untouched))));
        [Some(self.noticed()), alike, untouched].into_iter().flatten().collect::<Vec<String>>().join("; ")
    }

    fn noticed(&self) -> String {
        let (fingers, layers) = (self.simulated_fingers, &self.layers);
        let below: Vec<&LayerScore> = layers.iter().filter(|layer| !layer.simulated_fingers.is_felt_by_all()).collect();
        let every = if self.untouched_layers.is_empty() { "every layer" } else { "every layer that was touched" };
        let every = match below.len() {
            0 => every.to_owned(),
            but => format!("{every} but {but}"),
        };
        let named = || named(&below, fingers);
        match (layers.len(), below.len(), fingers) {
            (0, ..) => "no stroke was on a layer, driven, for long enough to say what is noticed".to_owned(),
            (_, 0, 1) => format!("the simulated finger notices {every}"),
            (_, 0, _) => format!("{fingers} of {fingers} simulated fingers notice {every}"),
            (all, but, 1) if but < all => format!("the simulated finger notices {every}: {}", named()),
            (all, but, _) if but < all => format!("{fingers} of {fingers} simulated fingers notice {every}: {}", named()),
            (.., 1) => format!("there is no layer that the simulated finger surely notices: {}", named()),
            _ => format!("there is no layer that {fingers} of {fingers} simulated fingers notice: {}", named()),
        }
    }
}

/// Layers with how many fingers notice them. Copies of a layer are listed together.
fn named(layers: &[&LayerScore], fingers: usize) -> String {
    let copies = layers.chunk_by(|one, other| one.layer.number().table == other.layer.number().table);
    let parts = copies.filter_map(|copies| {
        let titles: Vec<&LayerTitle> = copies.iter().map(|layer| &layer.layer).collect();
        let least = LayerScore::least(copies.iter().copied())?;
        let same = copies.iter().all(|layer| layer.simulated_fingers == least.simulated_fingers);
        let text = words(&least.simulated_fingers, fingers);
        let more = if same { "" } else { " at least" };
        let titles = listed(fold_copies(&titles));
        Some(if fingers == 1 { format!("{text} {titles}") } else { format!("{titles} by {text}{more}") })
    });
    listed(parts.collect())
}

/// How many fingers notice something, of those that touched it.
fn words(verdicts: &Verdicts, fingers: usize) -> String {
    let Verdicts { touched, felt, felt_by_some, unknown, .. } = *verdicts;
    match fingers {
        1 if felt_by_some > 0 => "maybe".to_owned(),
        1 if unknown > 0 => "unknown for".to_owned(),
        1 => "not".to_owned(),
        fingers if touched < fingers => format!("{felt} of {touched}"),
        _ => felt.to_string(),
    }
}

fn told_apart(levels: &[&LevelScore], fingers: usize) -> Option<String> {
    let first = |titles: &[LayerTitle]| titles.first().map(ToString::to_string).unwrap_or_default();
    let pair = |level: &LevelScore| format!("{} and {}", first(&level.lower), first(&level.higher));
    if fingers == 1 {
        let pairs: Vec<String> = levels.iter().map(|level| pair(level)).collect();
        return (!pairs.is_empty()).then(|| format!("not surely told apart: {}", alternatives(pairs)));
    }
    let by = |level: &&LevelScore| format!("{} by {}", pair(level), words(&level.simulated_fingers, fingers));
    let pairs: Vec<String> = levels.iter().map(by).collect();
    (!pairs.is_empty()).then(|| format!("told apart: {}", alternatives(pairs)))
}

/// A list as a sentence has it.
fn listed(parts: Vec<String>) -> String {
    let mut parts = shortened(parts);
    let last = parts.pop().unwrap_or_default();
    if parts.is_empty() { last } else { format!("{} and {last}", parts.join(", ")) }
}

/// A list of pairs, each of which has an *and* of its own.
fn alternatives(parts: Vec<String>) -> String {
    shortened(parts).join(", ")
}

fn shortened(mut parts: Vec<String>) -> Vec<String> {
    if parts.len() > NAMED_MAX {
        let more = parts.len() - (NAMED_MAX - 1);
        parts.truncate(NAMED_MAX - 1);
        parts.push(format!("{more} more"));
    }
    parts
}
