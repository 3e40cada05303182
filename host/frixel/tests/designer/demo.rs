//! `frixel` without a command, which is the demo, and `frixel demo`.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::processes::succeed;

#[test]
fn the_demo_plays_an_edited_scene_and_never_overwrites_it() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("frixel-out/brick.toml");
    let said = succeed(folder.path(), &[]);
    for name in ["felt.csv", "felt.svg", "scene.png"] {
        let file = Path::new("frixel-out").join(name);
        assert!(said.contains(&file.display().to_string()), "{name} is not named in {said}");
        assert!(fs::metadata(folder.path().join(file)).unwrap().len() > 10_000);
    }
    assert!(said.contains("brick.toml is new") && said.contains("on mortar its friction rises"), "{said}");
    assert!(said.contains("frixel play frixel-out/brick.toml"), "{said}");

    let bundled = fs::read_to_string(&path).unwrap();
    let edited = bundled.replace("white_n = 0.166", "white_n = 0.083");
    assert_ne!(edited, bundled);
    fs::write(&path, &edited).unwrap();
    let picture = folder.path().join("frixel-out/textures/brick.png");
    let mut mine = fs::read(&picture).unwrap();
    mine.extend(b"after the end");
    fs::write(&picture, &mine).unwrap();

    let said = succeed(folder.path(), &["demo"]);
    assert!(said.contains("brick.toml plays as it is") && !said.contains("on mortar"), "{said}");
    assert_eq!(fs::read_to_string(&path).unwrap(), edited);
    assert_eq!(fs::read(&picture).unwrap(), mine);
    // Mortar is at 0.76 from black to white: 39 mN instead of 102 mN above the natural friction of 250 mN.
    let summary = fs::read(folder.path().join("frixel-out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    let most_n = summary["reference_max_n"].as_f64().unwrap();
    assert!((0.288..0.290).contains(&most_n), "{summary}");
}
