//! Lists of layers in messages.

/// Copies of one layer from which on a list names only the first.
const FOLDED_MIN: usize = 3;

/// The titles of layers as a sentence lists them. Of several copies of one layer that follow one another, only the
/// first is named.
pub(super) fn listed(titles: &[&str]) -> String {
    let groups = titles.chunk_by(|one, other| table(one).is_some() && table(one) == table(other));
    let words = groups.map(|group| match group {
        [first, rest @ ..] if group.len() >= FOLDED_MIN => format!("{first} with {} more copies", rest.len()),
        titles => titles.join(" and "),
    });
    words.collect::<Vec<String>>().join(" and ")
}

/// The number of the layer that a copy was made from; `None` for the title of a layer that is no copy.
fn table(title: &str) -> Option<&str> {
    let number = title.strip_prefix("layer ")?.split(' ').next()?;
    number.split_once('.').map(|(table, _)| table)
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
