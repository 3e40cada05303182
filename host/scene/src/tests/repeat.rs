//! Copies of a layer, and stripes that move with their region.

use frixel_layers::{Layer, Region};

use super::{HEAD, compile_text};
use crate::LayerTitle;
use crate::reference::Reference;

const PADS: &str = "[[layer]]\nname = \"pad\"\nkind = \"constant\"\nfriction_n = 0.26\n\
    region = { x_mm = 10, y_mm = 20, width_mm = 8, height_mm = 6 }\n";

#[test]
fn copies_lie_in_columns_and_rows() {
    let program =
        compile_text(&format!("{HEAD}{PADS}repeat = {{ columns = 3, rows = 2, dx_mm = 12, dy_mm = 10 }}\n")).unwrap();
    let places_mm: Vec<(f64, f64)> = program
        .records
        .iter()
        .map(|record| match record.region {
            Region::Rectangle { x_m, y_m, .. } => ((1e3 * f64::from(x_m)).round(), (1e3 * f64::from(y_m)).round()),
            region => panic!("{region:?}"),
        })
        .collect();
    assert_eq!(places_mm, [(10.0, 20.0), (22.0, 20.0), (34.0, 20.0), (10.0, 30.0), (22.0, 30.0), (34.0, 30.0)]);
    assert_eq!(program.titles[0].as_str(), "layer 1.1 \"pad 1\"");
    assert_eq!(program.titles[5].as_str(), "layer 1.6 \"pad 6\"");
}

#[test]
fn places_of_a_kind_move_with_the_copy() {
    let rings = "[[layer]]\nkind = \"rings\"\nx_mm = 20\ny_mm = 30\nwavelength_mm = 3\nlow_n = 0.0\nhigh_n = 0.01\n\
        region = { x_mm = 10, y_mm = 20, width_mm = 20, height_mm = 20 }\nrepeat = { columns = 2, dx_mm = 40 }\n";
    let program = compile_text(&format!("{HEAD}{rings}")).unwrap();
    let reference = Reference::new(&program);
    for x_m in [0.011, 0.0173, 0.0204, 0.0291] {
        let (first_n, second_n) =
            (reference.electric_friction_n(x_m, 0.0283), reference.electric_friction_n(x_m + 0.04, 0.0283));
        assert!((first_n - second_n).abs() < 1e-8, "{first_n} {second_n}");
    }
    let titles: Vec<&str> = program.titles.iter().map(LayerTitle::as_str).collect();
    assert_eq!(titles, ["layer 1.1 (rings)", "layer 1.2 (rings)"]);
}

#[test]
fn stripes_can_begin_at_the_edge_of_their_region() {
    let stripes = |origin: &str| {
        let grating = "[[layer]]\nkind = \"grating\"\nwave = \"square\"\nwavelength_mm = 7\nlow_n = 0.0\nhigh_n = 0.01\n\
            region = { x_mm = 10, y_mm = 20, width_mm = 20, height_mm = 20 }\nrepeat = { columns = 3, dx_mm = 30 }\n";
        compile_text(&format!("{HEAD}{grating}origin = \"{origin}\"\n")).unwrap()
    };
    let differs = |origin: &str| {
        let reference = Reference::new(&stripes(origin));
        let at = |copy: f64, x_mm: f64| reference.electric_friction_n(1e-3 * (10.0 + 30.0 * copy + x_mm), 0.03);
        (0..20).any(|x| {
            (1..3).any(|copy| (at(f64::from(copy), f64::from(x) + 0.3) - at(0.0, f64::from(x) + 0.3)).abs() > 1e-6)
        })
    };
    assert!(differs("screen") && !differs("region"));
    // The high part of a square wave begins at the region's left edge.
    let program = stripes("region");
    let reference = Reference::new(&program);
    assert!(reference.electric_friction_n(0.0101, 0.03) > 9e-3 && reference.electric_friction_n(0.0136, 0.03) < 1e-6);
    assert!(program.records.iter().all(|record| matches!(record.layer, Layer::Grating(_))));
}
