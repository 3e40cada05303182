//! Pictures whose colours are known: patches of 16 pixels, and a ramp.

use super::*;

const COLOURS: &[u8] = include_bytes!("testdata/colours.jpg");

fn decoded(jpeg: &[u8]) -> Picture {
    Picture::decode(jpeg).expect("it is a JPEG file")
}

/// The grey in the middle of a patch.
fn patch(picture: &Picture, column: usize, row: usize) -> f32 {
    picture.grey[(16 * row + 8) * picture.width + 16 * column + 8]
}

#[test]
fn colours_of_a_jpeg_are_turned_to_grey_by_luminance() {
    for jpeg in [COLOURS, include_bytes!("testdata/progressive.jpg")] {
        let picture = decoded(jpeg);
        assert_eq!((picture.width, picture.height), (48, 32));
        let expected =
            [(0, 0, 0.2126 * 255.0), (1, 0, 0.7152 * 255.0), (2, 0, 0.0722 * 255.0), (0, 1, 255.0), (1, 1, 0.0)];
        for (column, row, grey) in expected.into_iter().chain([(2, 1, 90.0)]) {
            let found = patch(&picture, column, row);
            assert!((found - grey).abs() < 3.0, "{column}, {row}: {found} and not {grey}");
        }
        assert_eq!(picture.conversions, [COLOUR]);
    }
}

#[test]
fn grey_of_a_jpeg_stays() {
    let picture = decoded(include_bytes!("testdata/grey.jpg"));
    assert_eq!((picture.width, picture.height, picture.conversions.len()), (32, 16, 0));
    for (column, grey) in picture.grey.iter().take(32).enumerate() {
        assert!((grey - 8.0 * column as f32).abs() < 2.0, "{column}: {grey}");
    }
}

#[test]
fn what_is_no_picture_is_refused_and_never_panics() {
    let refused = |bytes: &[u8]| Picture::decode(bytes).expect_err("it is refused").to_string();
    assert_eq!(refused(include_bytes!("testdata/inks.jpg")), "its colours are inks (CMYK): save it as RGB or grey");
    assert_eq!(refused(b"GIF89a"), "it is neither a PNG nor a JPEG file: save it as PNG");
    assert!(refused(&COLOURS[..20]).contains("it is damaged"));
    // A file that ends early is refused, unless all of its pixels are there.
    let whole = Picture::decode(COLOURS).unwrap();
    for end in 0..COLOURS.len() {
        assert!(Picture::decode(&COLOURS[..end]).map_or(true, |cut| cut == whole), "cut to {end} bytes");
    }
    for place in 0..COLOURS.len() {
        let mut damaged = COLOURS.to_vec();
        damaged[place] ^= 0x55;
        let _ = Picture::decode(&damaged);
    }
}

/// 1000 pixels: 9 black, 9 white, and grey levels 50 to 149 between.
#[test]
fn the_darkest_and_the_lightest_hundredth_become_black_and_white() {
    let mut grey = vec![0.0; 9];
    grey.extend((0..982).map(|pixel| 50.0 + (pixel % 100) as f32));
    grey.extend([255.0; 9]);
    let picture = Picture { width: 100, height: 10, grey, conversions: Vec::new() };
    let stretched = picture.clone().stretched();
    assert_eq!(stretched.conversions, ["levels 50 to 149 stretched to 0 to 255"]);
    for (before, after) in picture.grey.iter().zip(&stretched.grey) {
        let expected = ((before - 50.0) / 99.0 * 255.0).clamp(0.0, 255.0);
        assert!((after - expected).abs() < 1e-3, "{before}: {after} and not {expected}");
    }
    let flat = Picture { width: 2, height: 1, grey: vec![7.0, 7.0], conversions: Vec::new() }.stretched();
    assert_eq!((flat.grey, flat.conversions.len()), (vec![7.0, 7.0], 1));
}
