//! Tests of reading and refusing screens.

use super::*;

#[test]
fn the_bundled_file_is_the_example() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/screens/example.toml");
    #[allow(clippy::disallowed_methods, reason = "the test reads a bundled file")]
    let text = std::fs::read_to_string(path).expect("it is there");
    assert_eq!(Screen::parse(&text, path), Ok(Screen::example()));
    assert_eq!(Screen::bundled("example"), Some(Screen::example()));
    assert_eq!(Screen::bundled("large"), None);
}
