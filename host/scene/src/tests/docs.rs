//! `docs/scene.md`: its examples compile, and it names every field.

use super::*;
use crate::Mistake;
use crate::kinds::KindName;

const DOCS: &str = include_str!("../../../../docs/scene.md");

fn kinds() -> impl Iterator<Item = &'static str> {
    KindName::ALL.iter().map(|(word, _)| *word)
}

/// The TOML examples.
fn examples() -> Vec<&'static str> {
    DOCS.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// The head without the tables that an example has.
fn head_for(head: &str, example: &str) -> String {
    let tables = head.split("\n\n").filter(|table| {
        let name = table.lines().next().unwrap_or_default().trim_matches(['[', ']']);
        !example.contains(&format!("[{name}]"))
    });
    tables.collect::<Vec<_>>().join("\n\n")
}

#[test]
fn every_example_compiles() {
    let examples = examples();
    let (head, rest) = examples.split_first().expect("there is a head");
    compile_text(head).expect("the head compiles");
    assert!(rest.len() >= 8, "{}", rest.len());
    for example in rest {
        let text = format!("{}\n{example}", head_for(head, example));
        if let Err(error) = compile_text(&text) {
            panic!("{error}\n{text}");
        }
    }
    for kind in kinds() {
        assert!(rest.iter().any(|example| example.contains(&format!("kind = \"{kind}\""))), "{kind}");
    }
}

#[test]
fn every_field_is_named() {
    let head = examples()[0];
    let layer = |kind: &str| format!("[[layer]]\nkind = \"{kind}\"");
    let tables = ["[screen]", "[coating]", "[finger]", "[drive]", "[carrier]", "[touch]"].map(str::to_owned);
    let layers = kinds().map(layer);
    let factors = kinds().map(|kind| format!("{}\nblend = \"multiply\"", layer(kind)));
    for table in tables.into_iter().chain(layers).chain(factors) {
        let text = format!("{}\n{table}\nzzz = 1", head_for(head, &table));
        let Err(CompileError { mistakes, .. }) = compile_text(&text) else { panic!("{table} takes anything") };
        let known = mistakes.iter().find_map(|located| match &located.mistake {
            Mistake::UnknownField { field, nearest, .. } if field == "zzz" => Some(&nearest.known),
            _ => None,
        });
        for field in known.expect("zzz is unknown") {
            assert!(DOCS.contains(&format!("`{field}`")), "{table} {field}");
        }
    }
}

#[test]
fn numbers_in_the_text_are_right() {
    let program = compile_text(examples()[0]).expect("the head compiles");
    let reach = program.reach;
    assert!(DOCS.contains(&format!("At 150 V rms it feels {:.2} mN more", 1e3 * reach.electric_friction_max_n)));
    assert!(DOCS.contains(&format!("{} N. At 150 V", reach.natural_friction_n)));
    assert_eq!(LIMITS.bitmap_pool_bytes, 65_536);
}
