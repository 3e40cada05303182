//! The pictures of a play.

use std::collections::HashMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use tempfile::TempDir;

use super::{frixel, scene, succeed};

/// Colours of the map that cover more than 200 pixels, without greys.
fn map_colours(path: &Path) -> usize {
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    let width = reader.info().width as usize;
    let mut counts: HashMap<[u8; 3], usize> = HashMap::new();
    // To the right of the map is the colour scale.
    for row in bytes.chunks_exact(3 * width) {
        for pixel in row.chunks_exact(3).take(width - 150) {
            *counts.entry([pixel[0], pixel[1], pixel[2]]).or_default() += 1;
        }
    }
    let coloured = |[red, green, blue]: &[u8; 3]| red != green || green != blue;
    counts.iter().filter(|(colour, count)| **count > 200 && coloured(colour)).count()
}

#[test]
fn time_stands_above_the_way_and_the_layers() {
    let folder = TempDir::new().unwrap();
    let stroke = ["--from", "20,40", "--to", "100,40", "--speed", "100"];
    succeed(folder.path(), &[&["play", scene("brick.toml").as_str()], &stroke[..]].concat());
    let svg = std::fs::read_to_string(folder.path().join("frixel-out/felt.svg")).unwrap();
    let has = |text: &str| svg.lines().any(|line| line == text);
    assert!(has("time, s") && has("path, mm") && has("layer"), "names of the strips");
    // 0.4 s at 100 mm/s, 0.8 s at the end, and the name of the only layer.
    assert!(has("40") && has("80") && svg.lines().any(|line| line.contains("brick") && !line.contains("toml")));
    assert!(svg.lines().any(|line| line.ends_with("brick.toml, simulated")));
}

#[test]
fn the_map_of_a_play_shows_what_only_a_sliding_finger_or_time_brings() {
    // Corduroy that comes with speed, and a heart that vibrates: the map has the ribs, and the shape of the heart.
    for (name, colours_min) in [("ribs.toml", 10), ("heartbeat.toml", 2), ("warning.toml", 2)] {
        let folder = TempDir::new().unwrap();
        succeed(folder.path(), &["play", &scene(name), "--seconds", "1"]);
        let colours = map_colours(&folder.path().join("frixel-out/scene.png"));
        // The stroke itself is red.
        assert!(colours > colours_min, "{name}: {colours} colours");
    }
}

/// A photograph is larger than any scene may be, and its first bytes tell what it is.
#[test]
fn a_picture_in_place_of_a_scene_leads_to_the_command_that_makes_one() {
    let folder = TempDir::new().unwrap();
    let mut photo = b"\xff\xd8\xff\xe0".to_vec();
    photo.resize(5 << 20, 0);
    std::fs::write(folder.path().join("photo.jpg"), photo).unwrap();
    for picture in [scene("textures/brick.png"), "photo.jpg".to_owned()] {
        let output = frixel(folder.path(), &["check", &picture]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(
            (output.status.code(), said),
            (
                Some(1),
                format!(
                    "frixel: {picture}: this is a picture, not a scene file; make a scene of it: frixel new NAME \
                     --picture {picture}\n"
                )
            )
        );
    }
}
