//! Titles of layers in messages: `layer 3 "name"`, or `layer 3.1 "name 1"` for a copy that `repeat` has made.

/// Copies of one layer from which on a list names only the first.
const FOLDED_MIN: usize = 3;

/// The titles of layers as a sentence lists them, with copies folded.
pub(super) fn listed(titles: &[&str]) -> String {
    fold_copies(titles).join(" and ")
}

/// The titles of layers for a list. Of several copies of one layer that follow one another, only the first is named, and
/// the others are counted.
pub fn fold_copies(titles: &[&str]) -> Vec<String> {
    let groups = titles.chunk_by(|one, other| copied(one).is_some() && copied(one) == copied(other));
    let words = groups.flat_map(|group| match group {
        [first, rest @ ..] if group.len() >= FOLDED_MIN => vec![format!("{first} with {} more copies", rest.len())],
        titles => titles.iter().map(|title| (*title).to_owned()).collect(),
    });
    words.collect()
}

/// The number of the table in the file that a copy was made from; `None` for the title of a layer that is no copy.
fn copied(title: &str) -> Option<usize> {
    number(title).filter(|(_, is_copy)| *is_copy).map(|(table, _)| table)
}

/// The number of a layer's table in the file; copies of a layer have the same. `None` for a text that is no title.
///
/// ```
/// # use frixel_scene::table_number;
/// assert_eq!(table_number("layer 3 \"wood\""), Some(3));
/// assert_eq!(table_number("layer 3.1 \"wood 1\""), Some(3));
/// assert_eq!(table_number("the bare screen"), None);
/// ```
pub fn table_number(title: &str) -> Option<usize> {
    number(title).map(|(table, _)| table)
}

/// The number of a layer's table in the file, and whether the layer is a copy.
fn number(title: &str) -> Option<(usize, bool)> {
    let number = title.strip_prefix("layer ")?.split(' ').next()?;
    let (table, is_copy) = number.split_once('.').map_or((number, false), |(table, _)| (table, true));
    Some((table.parse().ok()?, is_copy))
}

#[cfg(test)]
mod tests {
    use super::listed;

    #[test]
    fn copies_are_folded() {
        let titles =
            ["layer 1 \"a.b\"", "layer 2.1 \"k 1\"", "layer 2.2 \"k 2\"", "layer 2.3 \"k 3\"", "layer 3 (noise)"];
        assert_eq!(listed(&titles), "layer 1 \"a.b\" and layer 2.1 \"k 1\" with 2 more copies and layer 3 (noise)");
        assert_eq!(listed(&titles[..3]), "layer 1 \"a.b\" and layer 2.1 \"k 1\" and layer 2.2 \"k 2\"");
        assert_eq!(listed(&["layer 1 \"2.1\"", "layer 2 \"2.1\"", "layer 3 \"2.1\""]).matches("copies").count(), 0);
    }
}
