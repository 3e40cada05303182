//! `budgets.toml`: the upper limit of each figure.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::bench::Figures;

/// Limits by the figure's name.
pub(crate) type Limits = BTreeMap<String, u64>;

/// Reads the limits.
pub(crate) fn read(path: &Path) -> Result<Limits, String> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))
}

/// The limit of one figure; fails if there is none.
pub(crate) fn only(limits: &Limits, name: &str) -> Result<Limits, String> {
    let limit = limits.get(name).ok_or_else(|| format!("budgets.toml has no limit for {name}"))?;
    Ok(Limits::from([(name.to_owned(), *limit)]))
}

/// Fails if a figure exceeds its limit or a limit has no figure. The error lists them.
pub(crate) fn check(limits: &Limits, figures: &Figures) -> Result<(), String> {
    let breaches: Vec<String> = limits
        .iter()
        .filter_map(|(name, limit)| match figures.get(name) {
            Some(found) if found <= *limit => None,
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
        let limits = Limits::from([("a".to_owned(), 10), ("b".to_owned(), 10), ("c".to_owned(), 10)]);
        let figures = Figures::from([("a", 10), ("b", 11)]);
        let message = check(&limits, &figures).unwrap_err();
        assert!(message.contains("b is 11") && message.contains("c has a limit"), "{message}");
        assert!(!message.contains("a is"), "{message}");
        let figures = Figures::from([("a", 0), ("b", 10), ("c", 3), ("d", 99)]);
        assert_eq!(check(&limits, &figures), Ok(()));
    }
}
