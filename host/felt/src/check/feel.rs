//! What a person will feel of a scene, as text.

use crate::perception::{
    AlikeLayers, BorderStep, BurstTimes, LayerPerception, NEAR_THRESHOLD, Perception, Step, Texture,
    VOLTAGE_DIFFERENCE_DB, Verdict, weber_steps_text,
};
use frixel_scene::LayerTitle;

/// The subject of a sentence: a layer, or the border of two.
struct Subject {
    text: String,
    /// The numbers of its layers' tables in the file; `None` for the bare screen. Copies of a layer have the same.
    tables: Vec<Option<usize>>,
}

/// Lines of a name and a text: one for all layers that feel the same, one for all borders with the same step, and one
/// for each note.
pub fn lines(perception: &Perception) -> Vec<(&'static str, String)> {
    let layers = perception.layers.iter().map(|layer| (Subject::layer(&layer.layer), sentence(layer)));
    let borders = perception.steps.iter().map(|border| (sides(border), step(&border.step)));
    let alike = perception.alike.iter().map(alike);
    let notes = perception.notes.iter().map(|note| ("note", note.clone()));
    let near = near_threshold(perception).into_iter().map(|subject| (subject, NEAR_THRESHOLD.to_owned()));
    let lines = |name, texts, more| grouped(texts, more).into_iter().map(move |text| (name, text));
    let felt = lines("feel", layers.collect(), " alike").chain(lines("step", borders.collect(), " alike"));
    felt.chain(lines("alike", alike.collect(), " such pairs"))
        .chain(lines("note", near.collect(), " alike"))
        .chain(notes)
        .collect()
}

impl Subject {
    fn layer(layer: &LayerTitle) -> Self {
        Self { text: layer.to_string(), tables: vec![Some(layer.number().table)] }
    }
}

/// Joins the subjects that have the same text. Of copies of a layer, only the first one is named, and `more` are
/// counted.
fn grouped(texts: Vec<(Subject, String)>, more: &str) -> Vec<String> {
    let mut groups: Vec<(Vec<(Subject, usize)>, String)> = Vec::new();
    for (subject, text) in texts {
        let group = groups.iter().position(|(_, other)| *other == text).unwrap_or(groups.len());
        if group == groups.len() {
            groups.push((Vec::new(), text));
        }
        let Some((subjects, _)) = groups.get_mut(group) else { continue };
        match subjects.iter_mut().find(|(other, _)| other.tables == subject.tables) {
            Some((_, copies)) => *copies += 1,
            None => subjects.push((subject, 0)),
        }
    }
    let subject = |(Subject { text, .. }, copies): &(Subject, usize)| match copies {
        0 => text.clone(),
        copies => format!("{text} and {copies}{more}"),
    };
    let subjects = |subjects: &[(Subject, usize)]| subjects.iter().map(subject).collect::<Vec<String>>().join(", ");
    groups.iter().map(|(group, text)| format!("{}: {text}", subjects(group))).collect()
}

/// What a person will feel of a layer, one sentence without its subject.
pub fn sentence(layer: &LayerPerception) -> String {
    let contrast = &layer.contrast;
    let place = match layer {
        LayerPerception { is_by_direction: true, .. } => "from one direction of the slide to the other",
        LayerPerception { is_narrow: true, .. } => "at a narrow place in it",
        _ => "within it",
    };
    let within = if contrast.contrast_n > 0.0 {
        format!("{} {place}", step(contrast))
    } else {
        format!("{:.1} mN throughout", 1e3 * contrast.from_n)
    };
    // A texture that is not felt at any speed is not worth a line.
    let has_texture = layer.textures.iter().any(|texture| texture.verdict != Verdict::NotFelt);
    let textures = layer.textures.iter().filter(|_| has_texture).map(texture);
    let burst = layer.burst.iter().map(|BurstTimes { on_ms, period_ms }| {
        format!("all this while a burst lasts, {on_ms:.0} ms of every {period_ms:.0} ms")
    });
    let cut_off = if layer.is_click_cut_off { ", cut off at the most that the drive can give" } else { "" };
    let click = layer.click.iter().map(|click| format!("click {}{cut_off}", step(click)));
    std::iter::once(within).chain(textures).chain(burst).chain(click).collect::<Vec<String>>().join("; ")
}

fn alike(alike: &AlikeLayers) -> (Subject, String) {
    let AlikeLayers { layers, difference_db, difference_weber_steps } = alike;
    let voltage = difference_db.map(|difference_db| {
        format!("{difference_db:.2} dB apart in voltage; {VOLTAGE_DIFFERENCE_DB} dB are needed to tell them apart")
    });
    let friction = difference_weber_steps
        .map(|steps| format!("{steps:.1} Weber steps apart in friction; 1 is needed to tell them apart by it"));
    let [one, other] = layers;
    let tables = layers.iter().map(|layer| Some(layer.number().table)).collect();
    (Subject { text: format!("{one} and {other}"), tables }, voltage.or(friction).unwrap_or_default())
}

/// The layers and borders that are near the threshold, and of which nothing else is felt.
fn near_threshold(perception: &Perception) -> Vec<Subject> {
    let verdicts = |layer: &LayerPerception| {
        let textures = layer.textures.iter().map(|texture| texture.verdict);
        let click = layer.click.iter().map(|click| click.verdict);
        textures.chain(click).chain([layer.contrast.verdict]).collect::<Vec<Verdict>>()
    };
    let is_felt = |layer: &LayerPerception| verdicts(layer).contains(&Verdict::Felt);
    let is_near = |layer: &&LayerPerception| !is_felt(layer) && verdicts(layer).contains(&Verdict::NearThreshold);
    let layers = perception.layers.iter().filter(is_near);
    let borders_felt = |border: &BorderStep| {
        let sides = [&border.from, &border.to].map(|side| side.as_ref().map(LayerTitle::number));
        perception.layers.iter().any(|layer| is_felt(layer) && sides.contains(&Some(layer.layer.number())))
    };
    let is_near = |border: &&BorderStep| border.step.verdict == Verdict::NearThreshold && !borders_felt(border);
    let borders = perception.steps.iter().filter(is_near).map(sides);
    let borders = borders.map(|subject| Subject { text: format!("the step {}", subject.text), ..subject });
    layers.map(|layer| Subject::layer(&layer.layer)).chain(borders).collect()
}

fn sides(border: &BorderStep) -> Subject {
    let sides = [border.from.as_ref(), border.to.as_ref()];
    let [from, to] = sides.map(|side| side.map_or("the bare screen", LayerTitle::as_str));
    let tables = sides.map(|side| side.map(|layer| layer.number().table)).to_vec();
    Subject { text: format!("from {from} to {to}"), tables }
}

fn step(step: &Step) -> String {
    let Step { from_n, to_n, weber_steps, verdict, .. } = step;
    let words = verdict.words();
    let steps = weber_steps_text(*weber_steps);
    format!("{:.1} to {:.1} mN, {steps} Weber steps ({words})", 1e3 * from_n, 1e3 * to_n)
}

fn texture(texture: &Texture) -> String {
    let Texture { speed_mm_per_s, frequency_hz, amplitude_n, threshold_n, verdict, .. } = texture;
    let threshold = threshold_n
        .map_or("no threshold known".to_owned(), |threshold_n| format!("threshold {:.2} mN", 1e3 * threshold_n));
    let words = verdict.words();
    format!("at {speed_mm_per_s:.0} mm/s {:.2} mN at {frequency_hz:.0} Hz, {threshold} ({words})", 1e3 * amplitude_n)
}
