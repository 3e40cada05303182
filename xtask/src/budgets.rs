//! `budgets.toml`: the upper limit of each figure.

use std::path::Path;

use crate::bench::Figures;
use crate::command::text;

/// Reads the limits.
pub(crate) fn read(path: &Path) -> Result<Figures, String> {
    toml::from_str(&text(path)?).map_err(|error| format!("{}: {error}", path.display()))
}

/// Fails if a figure exceeds its limit or a limit has no figure. The error lists them.
pub(crate) fn check(limits: &Figures, figures: &Figures) -> Result<(), String> {
    let breaches: Vec<String> = limits
        .iter()
        .filter_map(|(name, limit)| match figures.get(name) {
            Some(found) if found <= limit => None,
            Some(found) => Some(format!("{name} is {found}, and its limit is {limit}")),
            None => Some(format!("{name} has a limit of {limit}, and was not measured")),
        })
        .collect();
    if breaches.is_empty() { Ok(()) } else { Err(format!("over budget (budgets.toml):\n  {}", breaches.join("\n  "))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_above_their_limit_or_not_measured_are_named() {
        let limits = Figures::from(["a", "b", "c"].map(|name| (name.to_owned(), 10)));
        let figures =
            |figures: &[(&str, u64)]| figures.iter().map(|(name, found)| ((*name).to_owned(), *found)).collect();
        let message = check(&limits, &figures(&[("a", 10), ("b", 11)])).unwrap_err();
        assert!(message.contains("b is 11") && message.contains("c has a limit"), "{message}");
        assert!(!message.contains("a is"), "{message}");
        assert_eq!(check(&limits, &figures(&[("a", 0), ("b", 10), ("c", 3), ("d", 99)])), Ok(()));
    }
}
