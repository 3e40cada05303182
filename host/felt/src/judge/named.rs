//! Layers by their names.

use frixel_scene::{LayerTitle, Program, fold_copies};

/// Largest number of layers that a sentence names; the others are counted.
const NAMED_MAX: usize = 3;

/// A list of at most three names, and how many more there are.
pub fn listed_briefly(names: &[String]) -> String {
    let list = names.get(..NAMED_MAX).unwrap_or(names).join(", ");
    match names.len().saturating_sub(NAMED_MAX) {
        0 => list,
        more => format!("{list} and {more} more"),
    }
}

/// Which layers start off, and how to play one; `None` if all start on.
pub fn starts_off(program: &Program) -> Option<String> {
    let off = program.titles.iter().zip(&program.start).filter(|(_, setting)| !setting.on);
    let titles: Vec<&LayerTitle> = off.map(|(title, _)| title).collect();
    let number = titles.first()?.number();
    let (starts, it) =
        if titles.len() == 1 { ("starts", "it".to_owned()) } else { ("start", format!("layer {number}")) };
    let layers = listed_briefly(&fold_copies(&titles));
    Some(format!("{layers} {starts} off: `echo trigger {number} 10000 | frixel play SCENE --control` plays {it}"))
}
