//! No text and no table makes the compiler panic, and every mistake has a place.

use proptest::prelude::*;

use super::*;

proptest! {
    #[test]
    fn no_text_makes_the_parser_panic(text in ".*") {
        if let Err(error) = Scene::parse(&text, "test.toml", &*PICTURES) {
            prop_assert!(error.to_string().starts_with("test.toml:"));
        }
    }

    /// Valid TOML of known and unknown names, values of any type, and numbers of any size.
    #[test]
    fn no_table_makes_the_compiler_panic(
        lines in prop::collection::vec((0..LINES.len(), 0..VALUES.len(), any::<f64>()), 0..24),
    ) {
        let mut text = String::from(HEAD);
        for (line, value, number) in lines {
            let value = if VALUES[value] == "number" { format!("{number:?}") } else { VALUES[value].to_owned() };
            text.push_str(&LINES[line].replace("VALUE", &value));
            text.push('\n');
        }
        if let Err(error) = compile_text(&text) {
            prop_assert!(error.to_string().lines().all(|line| line.starts_with("test.toml:")), "{}", error);
        }
    }
}

const LINES: &[&str] = &[
    "[[layer]]",
    "[[layer]]\nkind = \"constant\"",
    "[[layer]]\nkind = \"grating\"",
    "[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"",
    "kind = VALUE",
    "friction_n = VALUE",
    "low_n = VALUE",
    "high_n = VALUE",
    "wavelength_mm = VALUE",
    "angle_deg = VALUE",
    "gain = VALUE",
    "blend = VALUE",
    "region = VALUE",
    "picture = VALUE",
    "x_mm = VALUE",
    "y_mm = VALUE",
    "width_mm = VALUE",
    "height_mm = VALUE",
    "pitch_mm = VALUE",
    "black_n = VALUE",
    "white_n = VALUE",
    "[drive]\nsaturate = VALUE",
    "[carrier]\nfrequency_hz = VALUE",
];
const VALUES: &[&str] = &[
    "number",
    "0",
    "1",
    "0.01",
    "2",
    "50",
    "true",
    "\"add\"",
    "\"bitmap\"",
    "[1, 2]",
    "{ x_mm = 1, y_mm = 2 }",
    "1979-05-27",
    "{ x_mm = 1, y_mm = 2, width_mm = 3, height_mm = 4 }",
    "nan",
    "-inf",
    "0xff",
    "1_000",
    "99999999999999999999",
];
