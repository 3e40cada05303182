//! Perception of a scene, as text.

use frixel_scene::LayerTitle;

use crate::judge::{
    AlikeLayers, BorderStep, BurstTimes, Judgement, LayerVerdict, MAYBE, Over, Reason, SizeLimit, Step,
    THRESHOLD_UNCERTAINTY, Texture, VOLTAGE_DIFFERENCE_DB, Verdict, listed_briefly, weber_steps_text,
};

/// Largest number of lines about elements; the others are summarised in one line. With the costs, the output fits 40
/// rows of 80 characters.
const ROWS_MAX: usize = 18;
/// Characters per row, and before a line's text.
const ROW_CHARS: usize = 80;
const NAME_CHARS: usize = 19;
/// Lines on layers that are alike; more are counted in one line.
const ALIKE_LINES_MAX: usize = 2;

/// A name and a text.
pub type Line = (&'static str, String);

/// Lines as text, each ending in a line feed.
pub fn text(lines: &[Line]) -> String {
    lines.iter().fold(String::new(), |text, (name, line)| text + &format!("  {name:<16} {line}\n"))
}

/// A verdict on a layer, or on its click.
struct Finding {
    layer: LayerTitle,
    /// The part of the layer: empty, or `click of `.
    part: &'static str,
    verdict: Verdict,
    text: String,
}

/// Lines of a name and a text. The first lines are grouped by verdict, the least certain first, with one line for all
/// elements with the same perception. Indistinguishable layers and notes follow.
pub fn lines(judgement: &Judgement) -> Vec<Line> {
    let mut elements: Vec<Finding> = judgement.layers.iter().flat_map(elements).collect();
    elements.sort_by_key(|element| element.verdict);
    let has_maybe = elements.iter().any(|element| element.verdict == Verdict::Maybe);
    let groups = grouped(elements);
    let mut lines: Vec<Line> = groups.iter().map(Group::line).collect();
    let rows = lines.iter().scan(0, |rows, (_, text)| {
        *rows += (NAME_CHARS + text.chars().count()).div_ceil(ROW_CHARS);
        Some(*rows)
    });
    let shown = rows.take_while(|rows| *rows <= ROWS_MAX).count();
    lines.truncate(shown);
    lines.extend(rest(groups.get(shown..).unwrap_or_default()).map(|text| ("more", text)));
    lines.extend(judgement.alike.iter().take(ALIKE_LINES_MAX).map(|alike| ("alike", alike_text(alike))));
    let more_pairs = judgement.alike.len().saturating_sub(ALIKE_LINES_MAX);
    lines.extend(
        (more_pairs > 0)
            .then(|| ("alike", format!("{more_pairs} more {}", if more_pairs == 1 { "pair" } else { "pairs" }))),
    );
    lines.extend(has_maybe.then(|| ("note", MAYBE.to_owned())));
    lines.extend(judgement.notes.iter().map(|note| ("note", note.clone())));
    lines
}

/// Perception of a layer: the verdict and its reasons.
pub fn sentence(layer: &LayerVerdict) -> String {
    let texts = elements(layer).map(|Finding { part, verdict, text, .. }| {
        if part.is_empty() {
            format!("{}: {text}", verdict.words())
        } else {
            format!("{part}it {}: {text}", verdict.words())
        }
    });
    texts.collect::<Vec<String>>().join("; ")
}

/// The verdict on the layer, and on its click if that is less certain.
fn elements(layer: &LayerVerdict) -> impl Iterator<Item = Finding> {
    let title = &layer.layer;
    let whole = Finding { layer: title.clone(), part: "", verdict: layer.verdict, text: reasons(layer) };
    let click = layer.click.filter(|click| click.verdict < layer.verdict);
    let click = click.map(|click| Finding {
        layer: title.clone(),
        part: "click of ",
        verdict: click.verdict,
        text: click_text(layer, &click),
    });
    std::iter::once(whole).chain(click)
}

fn click_text(layer: &LayerVerdict, click: &Step) -> String {
    let clamped = if layer.is_click_clamped { ", clamped to the most that the drive can give" } else { "" };
    format!("{}{clamped}", step_text(click, ""))
}

/// Elements with the same perception.
struct Group {
    verdict: Verdict,
    text: String,
    /// The first copy of each layer, and the number of other copies.
    members: Vec<(Finding, usize)>,
}

impl Group {
    fn line(&self) -> Line {
        let member = |(element, copies): &(Finding, usize)| {
            let Finding { layer, part, .. } = element;
            if *copies == 0 { format!("{part}{layer}") } else { format!("{part}{layer} and {copies} alike") }
        };
        let members: Vec<String> = self.members.iter().map(member).collect();
        (self.verdict.words(), format!("{}: {}", listed_briefly(&members), self.text))
    }

    fn count(&self) -> usize {
        self.members.iter().map(|(_, copies)| 1 + copies).sum()
    }
}

/// Groups elements with the same verdict and text, and copies of one layer, of which the first one is named.
fn grouped(elements: Vec<Finding>) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for element in elements {
        let is_copy = |(other, _): &(Finding, usize)| {
            other.part == element.part && other.layer.number().table == element.layer.number().table
        };
        let mut of_verdict = groups.iter_mut().filter(|group| group.verdict == element.verdict);
        let group = of_verdict.find(|group| group.text == element.text || group.members.iter().any(is_copy));
        let Some(group) = group else {
            let (verdict, text) = (element.verdict, element.text.clone());
            groups.push(Group { verdict, text, members: vec![(element, 0)] });
            continue;
        };
        match group.members.iter_mut().find(|member| is_copy(member)) {
            Some((_, copies)) => *copies += 1,
            None => group.members.push((element, 0)),
        }
    }
    groups
}

/// Number of elements without a line, by verdict.
fn rest(groups: &[Group]) -> Option<String> {
    let counts = [Verdict::NotFelt, Verdict::Unknown, Verdict::Maybe, Verdict::Felt].map(|verdict| {
        let count: usize = groups.iter().filter(|group| group.verdict == verdict).map(Group::count).sum();
        (count > 0).then(|| format!("{count} {}", verdict.words()))
    });
    let counts: Vec<String> = counts.into_iter().flatten().collect();
    (!counts.is_empty()).then(|| format!("{} (--json has them all)", counts.join(", ")))
}

/// Reasons for a layer's verdict: perceptible steps and texture, obstacles, and advice.
fn reasons(layer: &LayerVerdict) -> String {
    let LayerVerdict { verdict, over, contrast, speed_mm_per_s, reasons, advice, burst, .. } = layer;
    if *over == Over::Samples {
        let Step { from_n, to_n, .. } = contrast;
        return format!("the stream moves it between {} and {} mN", millinewtons(*from_n), millinewtons(*to_n));
    }
    let told = told(layer);
    let speed = speed_mm_per_s.filter(|_| !told.is_empty() && *verdict != Verdict::NotFelt);
    let speed = speed.map_or(String::new(), |speed| format!(" at {speed:.0} mm/s"));
    let burst = burst.iter().map(|BurstTimes { on_ms, period_ms }| {
        format!("in bursts of {} ms, one every {} ms", two_digits(*on_ms), two_digits(*period_ms))
    });
    let told = [format!("{}{speed}", told.join("; "))].into_iter().chain(burst);
    let told = told.chain(reasons.iter().filter_map(reason_text)).chain(advice.clone());
    told.collect::<Vec<String>>().join("; ")
}

/// The steps and the texture that are as certain as the layer's verdict.
fn told(layer: &LayerVerdict) -> Vec<String> {
    let LayerVerdict { verdict, over, contrast, is_narrow, texture, border, reasons, .. } = layer;
    if reasons.contains(&Reason::Flat) {
        return vec![format!("{} mN throughout, without a perceptible border", millinewtons(contrast.from_n))];
    }
    let place = match (over, is_narrow) {
        (Over::Speed, _) => " from 20 to 100 mm/s",
        (Over::Time, _) => " in time",
        (Over::Direction, _) => " from one direction of the slide to the other",
        (_, true) => " at a narrow place in it",
        _ => " within it",
    };
    let bare = || "the bare screen".to_owned();
    let from = |border: &BorderStep| format!(" from {}", border.from.as_ref().map_or_else(bare, ToString::to_string));
    let mut steps: Vec<(Step, String)> =
        border.iter().map(|border| (border.step, from(border))).chain([(*contrast, place.to_owned())]).collect();
    steps.sort_by(|(one, _), (other, _)| other.cmp_felt(one));
    // Bursts make a perception less certain than during the burst.
    let surest = layer.click.iter().map(|click| click.verdict).chain(texture.iter().map(|texture| texture.verdict));
    let surest = surest.chain(steps.iter().map(|(step, _)| step.verdict)).fold(Verdict::NotFelt, Verdict::max);
    let mut told: Vec<String> = steps
        .iter()
        .filter(|(step, _)| step.verdict == surest && !(texture.is_some() && step.contrast_n == 0.0))
        .map(|(step, place)| step_text(step, place))
        .collect();
    if *verdict == Verdict::NotFelt {
        // One of the steps suffices as a reason.
        told.truncate(1);
    }
    told.extend(texture.iter().filter(|texture| texture.verdict == surest).map(texture_text));
    told.extend(
        layer
            .click
            .iter()
            .filter(|click| click.verdict == surest)
            .map(|click| format!("click {}", click_text(layer, click))),
    );
    told
}

fn step_text(step: &Step, place: &str) -> String {
    let Step { from_n, to_n, weber_steps, verdict, .. } = step;
    let steps = weber_steps_text(weber_steps.abs());
    let down = if *weber_steps < 0.0 { " down" } else { "" };
    let as_a_step = if *verdict == Verdict::NotFelt { ": not felt as a step" } else { "" };
    format!("{} to {} mN{place}, {steps} Weber steps{down}{as_a_step}", millinewtons(*from_n), millinewtons(*to_n))
}

/// A texture, in comparison with its threshold.
pub fn texture_text(texture: &Texture) -> String {
    let Texture { frequency_hz, amplitude_n, threshold_n, natural_noise_n, verdict, .. } = texture;
    let threshold = match threshold_n {
        None => "with no known threshold".to_owned(),
        Some(_) if *verdict == Verdict::Unknown => {
            format!("less than the finger's own noise of about {} mN", two_digits(1e3 * natural_noise_n))
        }
        Some(threshold_n) => format!(
            "about {} times the smallest that is felt ({} mN, known within a factor of {THRESHOLD_UNCERTAINTY})",
            two_digits(amplitude_n / threshold_n),
            two_digits(1e3 * threshold_n)
        ),
    };
    let (amplitude, frequency) = (two_digits(1e3 * amplitude_n), two_digits(*frequency_hz));
    format!("{amplitude} mN at {frequency} Hz, {threshold}")
}

fn reason_text(reason: &Reason) -> Option<String> {
    let text = match reason {
        Reason::TooSmall { limit, weber_steps } => {
            let limit = match limit {
                SizeLimit::Fingertip => "a fingertip",
                SizeLimit::TouchSource => "the touch source",
            };
            format!("too narrow for {limit}, although the scene has {} Weber steps", weber_steps_text(*weber_steps))
        }
        Reason::TooSlow { way_mm, weber_steps } => {
            format!("too slow a slope: {} in total, over more than {way_mm:.0} mm", weber_steps_text(*weber_steps))
        }
        Reason::TooWeak => "too weak".to_owned(),
        Reason::TooShort { duration_ms, least_ms } => {
            format!("too short: {} ms; it needs {least_ms:.0} ms", two_digits(*duration_ms))
        }
        Reason::TooRare { pause_ms, touch_ms } => format!(
            "too rare: a pause of {} s may contain a whole touch of {} s",
            two_digits(1e-3 * pause_ms),
            two_digits(1e-3 * touch_ms)
        ),
        Reason::Buzz => "a buzz, not stripes in place".to_owned(),
        // The preceding steps and textures imply this.
        Reason::Flat | Reason::NotStudied => return None,
    };
    Some(text)
}

fn alike_text(alike: &AlikeLayers) -> String {
    let AlikeLayers { layers, copies, difference_db, difference_weber_steps } = alike;
    let voltage = difference_db.map(|difference_db| {
        format!("{difference_db:.1} dB apart in voltage; {VOLTAGE_DIFFERENCE_DB} dB are needed to tell them apart")
    });
    let friction = difference_weber_steps.map(|steps| {
        format!("{} Weber steps apart in friction; 1 is needed to tell them apart", weber_steps_text(steps))
    });
    let [one, other] = [0, 1].map(|side| match copies[side] {
        0 => layers[side].to_string(),
        copies => format!("{} and {copies} alike", layers[side]),
    });
    format!("{one} with {other}: {}", voltage.or(friction).unwrap_or_default())
}

/// A friction with three digits, mN.
fn millinewtons(friction_n: f64) -> String {
    format!("{:.0}", 1e3 * friction_n)
}

/// A number with two significant digits.
fn two_digits(value: f64) -> String {
    let digits = if value.abs() > 0.0 { (1.0 - value.abs().log10().floor()).clamp(0.0, 4.0) as usize } else { 0 };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
