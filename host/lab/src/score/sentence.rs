//! A score as a sentence.

use frixel_felt::judge::{Verdict, listed_briefly};
use frixel_scene::{LayerTitle, fold_copies};

use super::{LayerScore, LevelScore, Score, Verdicts};

impl Score {
    /// The sentence of [`Score::verdict`].
    pub(super) fn sentence(&self) -> String {
        let levels = self.levels.iter().filter(|level| !level.simulated_fingers.is_felt_by_all());
        let alike = told_apart(&levels.collect::<Vec<_>>(), self.simulated_fingers);
        let untouched: Vec<&LayerTitle> = self.untouched_layers.iter().collect();
        let untouched = (!self.layers.is_empty() && !untouched.is_empty())
            .then(|| format!("no stroke reached {}", listed_briefly(&fold_copies(&untouched))));
        [Some(self.touched() + &self.noticed()), alike, untouched]
            .into_iter()
            .flatten()
            .collect::<Vec<String>>()
            .join("; ")
    }

    /// How many of the layers were touched, unless all or none were.
    fn touched(&self) -> String {
        let (touched, all) = (self.layers.len(), self.layers.len() + self.untouched_layers.len());
        match touched {
            touched if touched == 0 || touched == all => String::new(),
            1 => format!("1 of {all} layers was touched: "),
            touched => format!("{touched} of {all} layers were touched: "),
        }
    }

    fn noticed(&self) -> String {
        let (fingers, layers) = (self.simulated_fingers, &self.layers);
        if layers.is_empty() {
            return "no stroke stayed on a driven layer long enough to tell what is noticed".to_owned();
        }
        let (by_all, below): (Vec<&LayerScore>, Vec<&LayerScore>) =
            layers.iter().partition(|layer| layer.simulated_fingers.is_felt_by_all());
        // A finger notices nothing of a layer that it did not touch.
        let by = match fingers {
            1 => "the simulated finger".to_owned(),
            _ if by_all.iter().all(|layer| layer.simulated_fingers.touched == fingers) => {
                format!("{fingers} of {fingers} simulated fingers")
            }
            _ => {
                let them = if by_all.len() == 1 { "it" } else { "them" };
                format!("those of {fingers} simulated fingers that touched {them}")
            }
        };
        let (what, is) = match (layers.len(), by_all.len()) {
            (1, _) => ("layer", "is"),
            (_, 1) => ("layers", "is"),
            _ => ("layers", "are"),
        };
        let all = format!("{} of {} {what} {is} noticed by {by}", by_all.len(), layers.len());
        match (below.len(), fingers) {
            (0, _) => all,
            (_, fingers) if fingers > 1 && by_all.is_empty() => {
                let Some(only) = layers.first().filter(|_| layers.len() == 1) else {
                    let (by, layers) = (by_count(&below, fingers), layers.len());
                    return format!("none of {layers} layers is noticed by all {fingers} simulated fingers: {by}");
                };
                let Verdicts { touched, felt, .. } = only.simulated_fingers;
                let those = if touched < fingers { " that touched it" } else { "" };
                format!("{} is noticed by {felt} of {touched} simulated fingers{those}", only.layer)
            }
            (_, 1) => format!("{all}; {}", by_verdict(&below)),
            _ => format!("{all}; noticed by fewer: {}", by_count(&below, fingers)),
        }
    }
}

/// Layers in the order of the file, and copies of a layer by how surely they are noticed, the least first.
fn ordered<'s>(layers: impl IntoIterator<Item = &'s LayerScore>) -> Vec<&'s LayerScore> {
    let mut layers: Vec<&LayerScore> = layers.into_iter().collect();
    let table = |layer: &LayerScore| layer.layer.number().table;
    layers.sort_by(|one, other| table(one).cmp(&table(other)).then_with(|| one.cmp_felt(other)));
    layers
}

fn titles(layers: &[&LayerScore]) -> String {
    listed_briefly(&fold_copies(&layers.iter().map(|layer| &layer.layer).collect::<Vec<&LayerTitle>>()))
}

/// Layers by the verdict of the only finger.
fn by_verdict(layers: &[&LayerScore]) -> String {
    let of_verdict = |verdict: Verdict| {
        let layers = layers.iter().copied().filter(|layer| layer.simulated_fingers.of_one() == verdict);
        let layers = ordered(layers);
        (!layers.is_empty()).then(|| format!("{}: {}", verdict.words(), titles(&layers)))
    };
    let verdicts = [Verdict::NotFelt, Verdict::Maybe, Verdict::Unknown];
    verdicts.into_iter().filter_map(of_verdict).collect::<Vec<String>>().join("; ")
}

/// Layers with how many of several fingers notice them.
fn by_count(layers: &[&LayerScore], fingers: usize) -> String {
    let layers = ordered(layers.iter().copied());
    let copies = layers.chunk_by(|one, other| one.layer.number().table == other.layer.number().table);
    let parts = copies.map(|copies| {
        let least = copies.first().map(|least| count(&least.simulated_fingers, fingers)).unwrap_or_default();
        let is_same =
            copies.iter().zip(copies.iter().skip(1)).all(|(one, next)| one.simulated_fingers == next.simulated_fingers);
        format!("{} by {least}{}", titles(copies), if is_same { "" } else { " at least" })
    });
    listed_briefly(&parts.collect::<Vec<String>>())
}

/// Number of fingers that notice something, of the ones that touched it.
fn count(verdicts: &Verdicts, fingers: usize) -> String {
    let Verdicts { touched, felt, .. } = *verdicts;
    if touched < fingers { format!("{felt} of {touched}") } else { felt.to_string() }
}

fn told_apart(levels: &[&LevelScore], fingers: usize) -> Option<String> {
    let first = |titles: &[LayerTitle]| titles.first().map(ToString::to_string).unwrap_or_default();
    let pair = |level: &&LevelScore| {
        let pair = format!("{} from {}", first(&level.lower), first(&level.higher));
        if fingers == 1 { pair } else { format!("{pair} by {}", count(&level.simulated_fingers, fingers)) }
    };
    let surely = if fingers == 1 { "not surely " } else { "" };
    let pairs: Vec<String> = levels.iter().map(pair).collect();
    (!pairs.is_empty()).then(|| format!("{surely}told apart: {}", listed_briefly(&pairs)))
}

#[cfg(test)]
mod tests {
    use frixel_hil_sim::TouchConfig;
    use frixel_scene::LayerNumber;

    use super::*;

    fn title(table: usize, copy: Option<usize>, name: &str) -> LayerTitle {
        LayerTitle::new(LayerNumber { table, copy }, Some(name), "button")
    }

    fn verdicts(touched: usize, felt: usize, maybe: usize) -> Verdicts {
        Verdicts { touched, felt, maybe, not_felt: touched - felt - maybe, unknown: 0 }
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
        let all = "2 of 2 layers are noticed by 8 of 8 simulated fingers";
        assert_eq!(score(8, bars(8, [8, 8]), levels(8)).sentence(), all);
        assert_eq!(
            score(8, bars(8, [8, 8]), levels(2)).sentence(),
            format!("{all}; told apart: layer 3 \"bar 3\" from layer 4 \"bar 4\" by 2")
        );
        assert_eq!(
            score(8, bars(8, [8, 5]), Vec::new()).sentence(),
            "1 of 2 layers is noticed by 8 of 8 simulated fingers; noticed by fewer: layer 2 \"bar 2\" by 5"
        );
        assert_eq!(
            score(8, bars(7, [3, 0]), Vec::new()).sentence(),
            "none of 2 layers is noticed by all 8 simulated fingers: layer 1 \"bar 1\" by 3 of 7, \
             layer 2 \"bar 2\" by 0 of 7"
        );
    }

    #[test]
    fn one_finger_notices_or_not() {
        let sentence = |felt| score(1, bars(1, felt), Vec::new()).sentence();
        let by = "noticed by the simulated finger";
        assert_eq!(sentence([1, 1]), format!("2 of 2 layers are {by}"));
        assert_eq!(sentence([1, 0]), format!("1 of 2 layers is {by}; not felt: layer 2 \"bar 2\""));
        let seldom = score(8, bars(7, [7, 7]), Vec::new()).sentence();
        assert_eq!(seldom, "2 of 2 layers are noticed by those of 8 simulated fingers that touched them");
        let none = format!("0 of 2 layers are {by}; not felt: ");
        assert_eq!(sentence([0, 0]), format!("{none}layer 1 \"bar 1\", layer 2 \"bar 2\""));
    }

    #[test]
    fn layers_of_which_the_strokes_say_nothing_are_named_and_not_counted() {
        let mut nothing = score(2, Vec::new(), Vec::new());
        nothing.untouched_layers = vec![title(1, None, "far")];
        assert_eq!(nothing.sentence(), "no stroke stayed on a driven layer long enough to tell what is noticed");
        let mut touched = score(2, bars(2, [2, 2]), Vec::new());
        touched.untouched_layers = nothing.untouched_layers;
        assert_eq!(
            touched.sentence(),
            "2 of 3 layers were touched: 2 of 2 layers are noticed by 2 of 2 simulated fingers; no stroke reached \
             layer 1 \"far\""
        );
    }

    /// Copies are counted by their verdicts, and the least of each group is named, by its verdict and then by its size.
    #[test]
    fn copies_are_counted_by_their_verdicts() {
        let detent = |(copy, contrast_weber_steps): (usize, f64)| {
            let steps = Verdict::of_step(contrast_weber_steps);
            let detent = layer(title(5, Some(copy), &format!("detent {copy}")), [steps].into_iter().collect());
            LayerScore { contrast_weber_steps, ..detent }
        };
        let contrasts = [3.1, 2.4, 2.31, 1.7, 1.2, 0.9, 0.7, 1.4, 0.3];
        let detents = score(1, (1..).zip(contrasts).map(detent).collect(), Vec::new());
        assert_eq!(
            detents.sentence(),
            "3 of 9 layers are noticed by the simulated finger; not felt: layer 5.9 \"detent 9\" with 2 more copies; \
             maybe: layer 5.5 \"detent 5\" with 2 more copies"
        );
        let (least, copies) = detents.layer_rows().next().unwrap();
        assert_eq!((least.layer.as_str(), copies), ("layer 5.9 \"detent 9\"", 9));
    }

    /// Of many layers, the least sure ones have lines, in a summary that fits a terminal.
    #[test]
    fn a_summary_of_many_layers_is_short() {
        let key = |table: usize| layer(title(table, None, &format!("key {table}")), verdicts(40, table, 0));
        let summary = score(40, (1..=37).rev().map(key).collect(), Vec::new()).summary(false);
        let lines: Vec<&str> = summary.lines().filter(|line| line.contains("layer")).collect();
        assert!(lines[0].contains("\"key 1\"") && lines[9].contains("\"key 10\""), "{summary}");
        assert!(lines[10].contains("and 27 more layers") && lines[10].contains("score-layers.csv"), "{summary}");
        assert!(!summary.contains("\"key 11\" "), "{summary}");
    }

    /// Thirty keys that some notice are one part of the sentence, and of many layers a few are named.
    #[test]
    fn a_sentence_about_many_layers_is_short() {
        let key = |copy| layer(title(1, Some(copy), &format!("key {copy}")), verdicts(4, copy % 3, 0));
        assert_eq!(
            score(4, (1..=30).map(key).collect(), Vec::new()).sentence(),
            "none of 30 layers is noticed by all 4 simulated fingers: layer 1.3 \"key 3\" with 29 more copies \
             by 0 at least"
        );
        let bar = |table| layer(title(table, None, "bar"), verdicts(4, 1, 0));
        let sentence = score(4, (1..=37).map(bar).collect(), Vec::new()).sentence();
        assert!(sentence.ends_with("layer 3 \"bar\" by 1 and 34 more"), "{sentence}");
    }
}
