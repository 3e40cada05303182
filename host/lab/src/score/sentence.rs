//! What a score says, in a sentence.

use frixel_scene::{LayerTitle, fold_copies};

use super::{LayerScore, LevelScore, Score, Verdicts};

/// Most layers that a sentence names.
const NAMED_MAX: usize = 6;

impl Score {
    /// The sentence of [`Score::verdict`].
    pub(super) fn sentence(&self) -> String {
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
            (all, but, _) if but < all => {
                format!("{fingers} of {fingers} simulated fingers notice {every}: {}", named())
            }
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

#[cfg(test)]
mod tests {
    use frixel_hil_sim::TouchConfig;
    use frixel_scene::LayerNumber;

    use super::*;

    fn title(table: usize, copy: Option<usize>, name: &str) -> LayerTitle {
        LayerTitle::new(LayerNumber { table, copy }, Some(name), "button")
    }

    fn verdicts(touched: usize, felt: usize, felt_by_some: usize) -> Verdicts {
        Verdicts { touched, felt, felt_by_some, not_felt: touched - felt - felt_by_some, unknown: 0 }
    }

    fn layer(layer: LayerTitle, simulated_fingers: Verdicts) -> LayerScore {
        LayerScore { layer, simulated_fingers, contrast_weber_steps: 0.0, texture: None, border: None }
    }

    fn score(simulated_fingers: usize, layers: Vec<LayerScore>, levels: Vec<LevelScore>) -> Score {
        Score {
            simulated: String::new(),
            verdict: String::new(),
            touch_source: (&TouchConfig::IDEAL).into(),
            simulated_fingers,
            metrics: Vec::new(),
            layers,
            borders: Vec::new(),
            levels,
            untouched_layers: Vec::new(),
            plays: Vec::new(),
        }
    }

    fn bars(fingers: usize, felt: [usize; 2]) -> Vec<LayerScore> {
        let bar =
            |table: usize, felt: usize| layer(title(table, None, &format!("bar {table}")), verdicts(fingers, felt, 0));
        vec![bar(1, felt[0]), bar(2, felt[1])]
    }

    #[test]
    fn a_layer_that_some_do_not_notice_is_named() {
        let levels = |felt: usize| {
            let [lower, higher] = [3, 4].map(|table| vec![title(table, None, &format!("bar {table}"))]);
            vec![LevelScore { lower, higher, simulated_fingers: verdicts(8, felt, 0), weber_steps: 1.0 }]
        };
        let all = "8 of 8 simulated fingers notice every layer";
        assert_eq!(score(8, bars(8, [8, 8]), levels(8)).sentence(), all);
        assert_eq!(
            score(8, bars(8, [8, 8]), levels(2)).sentence(),
            format!("{all}; told apart: layer 3 \"bar 3\" and layer 4 \"bar 4\" by 2")
        );
        assert_eq!(score(8, bars(8, [8, 5]), Vec::new()).sentence(), format!("{all} but 1: layer 2 \"bar 2\" by 5"));
        assert_eq!(
            score(8, bars(7, [3, 0]), Vec::new()).sentence(),
            "there is no layer that 8 of 8 simulated fingers notice: layer 1 \"bar 1\" by 3 of 7 and \
             layer 2 \"bar 2\" by 0 of 7"
        );
    }

    #[test]
    fn one_finger_notices_or_not() {
        let sentence = |felt| score(1, bars(1, felt), Vec::new()).sentence();
        assert_eq!(sentence([1, 1]), "the simulated finger notices every layer");
        assert_eq!(sentence([1, 0]), "the simulated finger notices every layer but 1: not layer 2 \"bar 2\"");
        let none = "there is no layer that the simulated finger surely notices: ";
        assert_eq!(sentence([0, 0]), format!("{none}not layer 1 \"bar 1\" and not layer 2 \"bar 2\""));
    }

    #[test]
    fn layers_of_which_the_strokes_say_nothing_are_named_and_not_counted() {
        let mut nothing = score(2, Vec::new(), Vec::new());
        nothing.untouched_layers = vec![title(1, None, "far")];
        assert_eq!(nothing.sentence(), "no stroke was on a layer, driven, for long enough to say what is noticed");
        let mut touched = score(2, bars(2, [2, 2]), Vec::new());
        touched.untouched_layers = nothing.untouched_layers;
        assert_eq!(
            touched.sentence(),
            "2 of 2 simulated fingers notice every layer that was touched; no stroke says anything about layer 1 \"far\""
        );
    }

    /// Thirty keys that some notice are one part of the sentence, and of many layers a few are named.
    #[test]
    fn a_sentence_about_many_layers_is_short() {
        let key = |copy| layer(title(1, Some(copy), &format!("key {copy}")), verdicts(4, copy % 3, 0));
        assert_eq!(
            score(4, (1..=30).map(key).collect(), Vec::new()).sentence(),
            "there is no layer that 4 of 4 simulated fingers notice: layer 1.1 \"key 1\" with 29 more copies by 0 at least"
        );
        let bar = |table| layer(title(table, None, "bar"), verdicts(4, 1, 0));
        let sentence = score(4, (1..=37).map(bar).collect(), Vec::new()).sentence();
        assert!(sentence.ends_with("layer 5 \"bar\" by 1 and 32 more"), "{sentence}");
    }
}
