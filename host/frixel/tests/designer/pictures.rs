//! The pictures of scenes.

use std::fs::File;
use std::io::BufReader;

use tempfile::TempDir;

use super::{scene, succeed};

/// The caption is below the map, and says the speed as well.
#[test]
fn a_preview_is_a_png_of_the_asked_size_and_speed() {
    let folder = TempDir::new().unwrap();
    let map = |speed: &str| {
        let ribs = scene("ribs.toml");
        let options = ["preview", &ribs, "-o", "map.png", "--map-width", "300", "--speed-mm-per-s", speed];
        succeed(folder.path(), &options);
        let file = BufReader::new(File::open(folder.path().join("map.png")).unwrap());
        let mut decoder = png::Decoder::new(file);
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut bytes).unwrap();
        // The least width: 300 + 84 + 150 would leave too little room for the caption.
        assert_eq!(frame.width, 600);
        bytes.chunks_exact(frame.line_size).skip(60).take(200).flatten().copied().collect::<Vec<u8>>()
    };
    assert!(map("15") != map("100"), "the speed changes nothing");
}
