//! The pictures of scenes.

use tempfile::TempDir;

use crate::gallery::decoded;
use crate::processes::{bundled, succeed};

/// The caption is below the map, and says the speed as well.
#[test]
fn a_preview_is_a_png_of_the_asked_size_and_speed() {
    let folder = TempDir::new().unwrap();
    let map = |speed: &str| {
        let ribs = bundled("ribs.toml").display().to_string();
        let options = ["preview", &ribs, "-o", "map.png", "--map-width", "300", "--speed-mm-per-s", speed];
        succeed(folder.path(), &options);
        let (width, height, bytes) = decoded(&folder.path().join("map.png"));
        // The least width: 300 + 84 + 150 would leave too little room for the caption.
        assert_eq!(width, 600);
        bytes.chunks_exact(bytes.len() / height as usize).skip(60).take(200).flatten().copied().collect::<Vec<u8>>()
    };
    assert!(map("15") != map("100"), "the speed changes nothing");
}
