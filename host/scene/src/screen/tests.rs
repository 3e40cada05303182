//! Tests of reading and refusing screens.

use super::*;

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
fn the_bundled_file_is_the_example() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/screens/example.toml");
    #[allow(clippy::disallowed_methods, reason = "the test reads a bundled file")]
    let text = std::fs::read_to_string(path).expect("it is there");
    assert_eq!(Screen::parse(&text, path), Ok(Screen::example()));
    assert_eq!(Screen::bundled("example"), Some(Screen::example()));
    assert_eq!(Screen::bundled("large"), None);
}
