//! Tests of screens: what is read and what is refused.

use super::*;

#[track_caller]
fn check(text: &str, expected: &str) {
    assert_eq!(Screen::parse(text, "screen.toml").expect_err("it is wrong").to_string(), expected);
}

const SIZE: &str = "width_mm = 200\nheight_mm = 150\n";

#[test]
fn slabs_in_series_add_their_gaps() {
    let text = format!(
        "{SIZE}coating = [{{ thickness_um = 1, permittivity = 4 }}, {{ thickness_um = 3, permittivity = 2 }}]\n\
         voltage_max_v_rms = 120\n"
    );
    let screen = Screen::parse(&text, "screen.toml").expect("it reads");
    assert_eq!(screen.coating_gap_um().to_bits(), 1.75_f64.to_bits());
    assert_eq!(screen.voltage_max_v_rms, Some(120.0));
    let one = Screen::parse(&format!("{SIZE}[coating]\nthickness_um = 1\npermittivity = 4\n"), "screen.toml");
    assert_eq!(one.expect("it reads").coating, [Slab { thickness_um: 1.0, permittivity: 4.0 }]);
}

#[test]
fn mistakes_are_told_with_their_place() {
    check("width_mm = 200\n", "screen.toml:1:1: this screen has no `height_mm`: add it");
    check(
        &format!("{SIZE}colour = \"black\"\n"),
        "screen.toml:3:1: unknown field `colour` in this screen; expected one of `name`, `coating`, `voltage_max_v_rms`, \
         `voltage_max_v_peak`, `slew_v_per_us`",
    );
    check(&format!("{SIZE}coating = []\n"), "screen.toml:1:1: this screen has no `coating`: add it");
    let slab = "[[coating]]\nthickness_um = 1000\npermittivity = 1\n";
    check(
        &format!("{SIZE}{}", slab.repeat(11)),
        "screen.toml:3:1: `thickness_um / permittivity, summed = 11000` is out of range: expected 0 to 10000 um",
    );
    check("width_mm = ", "screen.toml:1:12: this is not TOML: string values must be quoted, expected literal string");
}

#[test]
fn the_bundled_file_is_the_example() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/screens/example.toml");
    #[allow(clippy::disallowed_methods, reason = "the test reads a bundled file")]
    let text = std::fs::read_to_string(path).expect("it is there");
    assert_eq!(Screen::parse(&text, path), Ok(Screen::example()));
    assert_eq!(Screen::bundled("example"), Some(Screen::example()));
    assert_eq!(Screen::bundled("large"), None);
}
