//! `budgets.toml`: the upper limit of each figure.

use std::path::Path;

use crate::bench::Figures;
use crate::command::text;

/// Fails if a figure exceeds its limit in the file, or a limit has no figure.
pub(crate) fn check_file(path: &Path, figures: &Figures) -> Result<(), String> {
    let limits = toml::from_str(&text(path)?).map_err(|error| format!("{}: {error}", path.display()))?;
    check(&limits, figures)
}

/// The error lists all breaches.
fn check(limits: &Figures, figures: &Figures) -> Result<(), String> {
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
    use crate::command::{root, target_folder, write};
    use crate::numbers;

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

    #[test]
    fn an_image_over_a_lowered_budget_is_noticed() {
        let figures = numbers::committed_figures().unwrap();
        assert_eq!(check_file(&root().join("budgets.toml"), &figures), Ok(()));
        let budgets = text(&root().join("budgets.toml")).unwrap();
        let image = "pico.flash_full";
        let limit = budgets.lines().find(|line| line.starts_with(&format!("\"{image}\""))).unwrap();
        let lowered = target_folder().join("bench/lowered-budgets.toml");
        write(&lowered, budgets.replace(limit, &format!("\"{image}\" = {}", figures[image] - 1))).unwrap();
        let message = check_file(&lowered, &figures).unwrap_err();
        assert!(message.contains(&format!("{image} is {}", figures[image])), "{message}");
        assert_eq!(message.lines().count(), 2, "{message}");
    }
}
