//! What a person will feel of a scene, as text.

use crate::perception::{AlikeTextures, BorderStep, LayerPerception, Perception, Step, Texture, Verdict};

/// Lines of a name and a text: one for all layers that feel the same, one for all borders with the same step, and one
/// for each note.
pub fn lines(perception: &Perception) -> Vec<(&'static str, String)> {
    let layers = perception.layers.iter().map(|layer| (layer.layer.clone(), sentence(layer)));
    let borders = perception.steps.iter().map(|border| (sides(border), step(&border.step)));
    let lines = |name, texts| grouped(texts).into_iter().map(move |text| (name, text));
    let alike = perception.alike.iter().map(|alike| {
        let AlikeTextures { layers: [one, other], difference_db } = alike;
        (
            "alike",
            format!("{one} and {other}: {difference_db:.2} dB apart in voltage; 1.21 dB are needed to tell them apart"),
        )
    });
    let notes = perception.notes.iter().map(|note| ("note", note.clone()));
    lines("feel", layers.collect()).chain(lines("step", borders.collect())).chain(alike).chain(notes).collect()
}

/// Joins the subjects that have the same text.
fn grouped(texts: Vec<(String, String)>) -> Vec<String> {
    let mut groups: Vec<(Vec<String>, String)> = Vec::new();
    for (subject, text) in texts {
        match groups.iter_mut().find(|(_, other)| *other == text) {
            Some((subjects, _)) => subjects.push(subject),
            None => groups.push((vec![subject], text)),
        }
    }
    groups.into_iter().map(|(subjects, text)| format!("{}: {text}", subjects.join(", "))).collect()
}

/// What a person will feel of a layer, one sentence without its subject.
pub fn sentence(layer: &LayerPerception) -> String {
    let contrast = &layer.contrast;
    let within = if contrast.contrast_n > 0.0 {
        format!("{} within it", step(contrast))
    } else {
        format!("{:.1} mN throughout", 1e3 * contrast.from_n)
    };
    // A texture that is not felt at any speed is not worth a line.
    let has_texture = layer.textures.iter().any(|texture| texture.verdict != Verdict::NotFelt);
    let textures = layer.textures.iter().filter(|_| has_texture).map(texture);
    let click = layer.click.iter().map(|click| format!("click {}", step(click)));
    std::iter::once(within).chain(textures).chain(click).collect::<Vec<String>>().join("; ")
}

fn sides(border: &BorderStep) -> String {
    let side = |title: &Option<String>| title.clone().unwrap_or_else(|| "the bare screen".to_owned());
    format!("from {} to {}", side(&border.from), side(&border.to))
}

fn step(step: &Step) -> String {
    let Step { from_n, to_n, weber_steps, verdict, .. } = step;
    let words = verdict.words();
    format!("{:.1} to {:.1} mN, {weber_steps:.1} Weber steps ({words})", 1e3 * from_n, 1e3 * to_n)
}

fn texture(texture: &Texture) -> String {
    let Texture { speed_mm_per_s, frequency_hz, amplitude_n, threshold_n, verdict, .. } = texture;
    let threshold = threshold_n
        .map_or("no threshold known".to_owned(), |threshold_n| format!("threshold {:.2} mN", 1e3 * threshold_n));
    let words = verdict.words();
    format!("at {speed_mm_per_s:.0} mm/s {:.2} mN at {frequency_hz:.0} Hz, {threshold} ({words})", 1e3 * amplitude_n)
}
