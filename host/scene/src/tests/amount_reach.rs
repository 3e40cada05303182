//! What the drive can give of an amount is what the compiler takes.

use super::*;
use crate::{AmountReach, compile_draft_with_amounts};

/// Layers of all kinds that have amounts, with the stems of these.
const LAYERS: [(&str, &[&str]); 11] = [
    ("kind = \"constant\"", &["friction"]),
    ("kind = \"grating\"\nwavelength_mm = 5", &["low", "high"]),
    ("kind = \"rings\"\nwavelength_mm = 5\nx_mm = 60\ny_mm = 55", &["low", "high"]),
    ("kind = \"spokes\"\nnumber = 12\nx_mm = 60\ny_mm = 55", &["low", "high"]),
    ("kind = \"noise\"\nwavelength_min_mm = 2\nwavelength_max_mm = 5", &["low", "high"]),
    ("kind = \"vibration\"\nfrequency_hz = 60", &["low", "high"]),
    ("kind = \"stream\"", &["low", "high"]),
    ("kind = \"direction\"\nangle_deg = 0", &["along", "against"]),
    (
        "kind = \"bitmap\"\npicture = \"textures/wood.jpg\"\nlevels = \"stretch\"\npitch_mm = 1\n\
            x_mm = 1\ny_mm = 1\nwidth_mm = 90",
        &["black", "white"],
    ),
    (
        "kind = \"button\"\nrim_width_mm = 4\nregion = { x_mm = 1, y_mm = 1, width_mm = 20, height_mm = 20 }",
        &["face", "rim", "click"],
    ),
    ("kind = \"edge\"\nx_mm = 60\ny_mm = 55\nwidth_mm = 5", &["ridge", "click"]),
];
/// Ground below the layer, and the words that the layer has for it.
const GROUNDS: [(&str, &str); 6] = [
    ("", "blend = \"replace\"\nabove = \"natural\""),
    ("", "blend = \"replace\"\nabove = \"zero\""),
    ("", "blend = \"replace\"\ngain = -2"),
    ("", "blend = \"replace\"\nabove = \"zero\"\ngain = 0.5"),
    ("[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.4\n", "blend = \"add\""),
    (
        "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.4\n",
        "blend = \"add\"\nrepeat = { columns = 2, dx_mm = 25 }",
    ),
];

/// A layer of a kind on a ground.
struct Written {
    layer: &'static str,
    stems: &'static [&'static str],
    ground: &'static str,
    words: &'static str,
    unit: &'static str,
}

impl Written {
    fn all() -> impl Iterator<Item = Self> {
        let grounds = LAYERS.iter().flat_map(|(layer, stems)| GROUNDS.map(|ground| (*layer, *stems, ground)));
        // Only copies beside each other vary one by one.
        let apart = grounds.filter(|(layer, _, (_, words))| layer.contains("region") || !words.contains("repeat"));
        apart.flat_map(|(layer, stems, (ground, words))| {
            ["_n", "_fraction"].map(|unit| Self { layer, stems, ground, words, unit })
        })
    }

    /// The scene with this amount in a field, and bare glass in all others.
    fn text(&self, changed: &str, to: f64) -> String {
        let Self { layer, stems, ground, words, unit } = self;
        let amount = |stem: &&str| {
            let is_total = *unit == "_n" && *stem != "click" && words.contains("zero");
            let glass = if is_total { 0.25 } else { 0.0 };
            let value = match *stem {
                stem if changed == format!("{stem}{unit}") => to,
                // The least amount is not above the largest.
                "low" if changed.starts_with("high") => to.min(glass),
                "high" if changed.starts_with("low") => to.max(glass),
                _ => glass,
            };
            format!("{stem}{unit} = {value:?}\n")
        };
        format!("{HEAD}{ground}[[layer]]\n{layer}\n{words}\n{}", stems.iter().map(amount).collect::<String>())
    }
}

fn scene(text: &str) -> Scene {
    Scene::parse(text, "test.toml", &*PICTURES).unwrap()
}

#[test]
fn at_the_end_of_an_amount_a_scene_compiles_and_beyond_it_does_not() {
    let limits = BoardLimits { tick_cycles_max: u32::MAX, ..LIMITS };
    let mut ends = 0;
    for written in Written::all() {
        let scene_now = scene(&written.text("", 0.0));
        let (program, found) = compile_draft_with_amounts(&scene_now, &limits, TICK_HZ).unwrap();
        let table = scene_now.layer_tables().len();
        let own: Vec<&AmountReach> = found.iter().filter(|reach| reach.table == table).collect();
        assert_eq!(own.len(), written.stems.len(), "{found:?}");
        let step = if written.unit == "_n" { 0.01 * program.reach.electric_friction_max_n } else { 0.01 };
        for AmountReach { field, least, most, .. } in own {
            for (end, side) in [(least, -1.0), (most, 1.0)] {
                let [at, beyond] = [*end, end + side * step].map(|value| written.text(field, value));
                let refusal = compile(&scene(&at), &limits, TICK_HZ).err();
                assert!(refusal.is_none(), "{refusal:?}\n{at}");
                let scene = scene(&beyond);
                let is_refused = !scene.mistakes().is_empty() || compile(&scene, &limits, TICK_HZ).is_err();
                assert!(is_refused, "{beyond}");
                ends += 1;
            }
        }
    }
    assert!(ends > 400, "{ends}");
}

/// A layer without effect may have any amount: a slider ends no lower than the present one.
#[test]
fn an_amount_that_nothing_bounds_ends_at_or_above_itself() {
    for words in ["gain = 0", "gain = 1\n[[layer]]\nkind = \"constant\"\nfriction_n = 0"] {
        let text = format!("{HEAD}[[layer]]\nkind = \"constant\"\nfriction_n = 0.9\n{words}\n");
        let (_, found) = compile_draft_with_amounts(&scene(&text), &LIMITS, TICK_HZ).unwrap();
        assert!(found[0].least <= 0.9 && found[0].most >= 0.9 - 1e-6, "{words}: {:?}", found[0]);
    }
}
