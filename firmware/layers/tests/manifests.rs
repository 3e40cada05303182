//! The manifests have a Cargo feature for each kind of layer.

use std::fs;
use std::path::Path;

use frixel_layers::KIND_FEATURES;
use frixel_testkit::golden;

/// The manifests, and the crate whose features they forward: none in the crate of the layers itself.
const MANIFESTS: [(&str, Option<&str>); 3] = [
    ("firmware/layers/Cargo.toml", None),
    ("firmware/session/Cargo.toml", Some("frixel-layers")),
    ("firmware/board-nucleo-g474re/Cargo.toml", Some("frixel-session")),
];
/// The feature of polygon regions, before which the features of the kinds are listed.
const AFTER: &str = "polygon";

/// The manifest with the missing features of kinds added.
fn with_features(manifest: &str, forwarded: Option<&str>) -> String {
    let mut text = manifest.to_owned();
    for kind in KIND_FEATURES {
        let name = kind.name;
        let enables = forwarded.map(|forwarded| format!("\"{forwarded}/{name}\"")).unwrap_or_default();
        if !text.lines().any(|line| line.starts_with(&format!("{name} = ["))) {
            let next = format!("\n{AFTER} = [");
            let before = text.rfind(&next).map_or(text.len(), |at| start_of_comment(&text, at));
            text.insert_str(before, &format!("\n{name} = [{enables}]"));
        }
        let (defaults, rest) = text.split_once("default = [").unwrap_or_default();
        let (list, rest) = rest.split_once(']').unwrap_or_default();
        if !list.contains(&format!("\"{name}\"")) {
            let (separator, quoted) = (if list.contains('\n') { ",\n    " } else { ", " }, format!("\"{AFTER}\""));
            let list = list.replace(&quoted, &format!("\"{name}\"{separator}{quoted}"));
            text = format!("{defaults}default = [{list}]{rest}");
        }
    }
    text
}

/// Start of the comment above the line after this line break.
fn start_of_comment(text: &str, line_break: usize) -> usize {
    match text[..line_break].rfind('\n') {
        Some(before) if text[before..].starts_with("\n#") => start_of_comment(text, before),
        _ => line_break,
    }
}

#[test]
fn every_kind_is_a_feature_of_the_manifests() {
    for (manifest, forwarded) in MANIFESTS {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(manifest);
        let text = fs::read_to_string(&path).unwrap_or_default();
        golden::hold(&path, &with_features(&text, forwarded));
    }
}

#[test]
fn a_feature_is_added_to_the_list_and_to_the_defaults() {
    let features: String = KIND_FEATURES.iter().skip(1).flat_map(|kind| [kind.name, " = []\n"]).collect();
    let missing = format!("default = [\"{AFTER}\"]\n{features}# Polygons.\n{AFTER} = []\n");
    let found = with_features(&missing, None);
    let first = KIND_FEATURES[0].name;
    assert!(found.ends_with(&format!("\n{first} = []\n# Polygons.\n{AFTER} = []\n")), "{found}");
    assert!(found.starts_with(&format!("default = [\"{first}\", ")), "{found}");
    assert_eq!(with_features(&found, None), found);
}
