//! Pictures whose colours are known: patches of 16 pixels, and a ramp.

use super::*;

const COLOURS: &[u8] = include_bytes!("testdata/colours.jpg");

fn decoded(jpeg: &[u8]) -> Picture {
    Picture::decode(jpeg, PIXELS_MAX).expect("it is a JPEG file")
}

/// The grey in the middle of a patch.
fn patch(picture: &Picture, column: usize, row: usize) -> f32 {
    picture.grey[(16 * row + 8) * picture.width + 16 * column + 8]
}

#[test]
fn colours_of_a_jpeg_are_turned_to_grey_by_luma() {
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

/// A PNG file of two pixels, black and half transparent white, with its orientation before or behind the pixels.
fn png_with_orientation(number: u8, is_behind: bool) -> Vec<u8> {
    let exif = [&b"II\x2a\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0"[..], &[number], &[0; 7]].concat();
    let mut info = png::Info::with_size(2, 1);
    (info.color_type, info.bit_depth) = (png::ColorType::GrayscaleAlpha, png::BitDepth::Eight);
    let mut bytes = Vec::new();
    let mut writer = png::Encoder::with_info(&mut bytes, info).unwrap().write_header().unwrap();
    let chunk = png::chunk::ChunkType(*b"eXIf");
    if !is_behind {
        writer.write_chunk(chunk, &exif).unwrap();
    }
    writer.write_image_data(&[0, 255, 255, 128]).unwrap();
    if is_behind {
        writer.write_chunk(chunk, &exif).unwrap();
    }
    writer.finish().unwrap();
    bytes
}

#[test]
fn a_png_is_turned_upright_with_what_shows_through_it() {
    for is_behind in [false, true] {
        let decoded = |number| decoded(&png_with_orientation(number, is_behind));
        let plain = decoded(1);
        assert!(plain.white_below[1] > 100.0 && plain.conversions.is_empty());
        for (number, size, is_reversed) in [(2, (2, 1), true), (6, (1, 2), false), (8, (1, 2), true)] {
            let turned = decoded(number);
            let in_order = |values: &[f32]| if is_reversed { vec![values[1], values[0]] } else { values.to_vec() };
            assert_eq!((turned.width, turned.height), size, "orientation {number}");
            assert_eq!(turned.grey, in_order(&plain.grey), "orientation {number}");
            assert_eq!(turned.white_below, in_order(&plain.white_below), "orientation {number}");
            assert!(turned.conversions[0].contains("turned upright"));
        }
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
    let refused = |bytes: &[u8]| Picture::decode(bytes, PIXELS_MAX).expect_err("it is refused").to_string();
    assert_eq!(refused(include_bytes!("testdata/inks.jpg")), "its colours are inks (CMYK): save it as RGB or grey");
    assert_eq!(refused(b"GIF89a"), "it is neither a PNG nor a JPEG file: save it as PNG");
    assert!(refused(&COLOURS[..20]).contains("it is damaged"));
    // A file that ends early is refused, unless all of its pixels are there.
    let whole = Picture::decode(COLOURS, PIXELS_MAX).unwrap();
    for end in 0..COLOURS.len() {
        assert!(Picture::decode(&COLOURS[..end], PIXELS_MAX).map_or(true, |cut| cut == whole), "cut to {end} bytes");
    }
    for place in 0..COLOURS.len() {
        let mut damaged = COLOURS.to_vec();
        damaged[place] ^= 0x55;
        let _ = Picture::decode(&damaged, PIXELS_MAX);
    }
}

/// 1000 pixels: 9 black, 9 white, and grey levels 50 to 149 between.
#[test]
fn the_darkest_and_the_lightest_hundredth_become_black_and_white() {
    let mut grey = vec![0.0; 9];
    grey.extend((0..982).map(|pixel| 50.0 + (pixel % 100) as f32));
    grey.extend([255.0; 9]);
    let picture = Picture { width: 100, height: 10, grey, white_below: Vec::new(), conversions: Vec::new() };
    let stretched = picture.clone().stretched(picture.grey.iter().map(|grey| *grey as u8).collect());
    assert_eq!(stretched.conversions, ["levels 50 to 149 stretched to 0 to 255"]);
    for (before, after) in picture.grey.iter().zip(&stretched.grey) {
        let expected = (before - 50.0) / 99.0 * 255.0;
        assert!((after - expected).abs() < 1e-3, "{before}: {after} and not {expected}");
    }
    let flat = Picture { width: 2, height: 1, grey: vec![7.0, 7.0], white_below: Vec::new(), conversions: Vec::new() };
    let flat = flat.stretched(vec![7, 7]);
    assert_eq!((flat.grey, flat.conversions.len()), (vec![7.0, 7.0], 1));
}

/// A JPEG file with an EXIF block that notes this orientation, in this byte order.
fn with_orientation(jpeg: &[u8], number: u8, is_big_endian: bool) -> Vec<u8> {
    let tiff: Vec<u8> = if is_big_endian {
        [&b"MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0"[..], &[number], &[0; 6]].concat()
    } else {
        [&b"II\x2a\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0"[..], &[number], &[0; 7]].concat()
    };
    let length = (2 + 6 + tiff.len()) as u16;
    [&jpeg[..2], &[0xff, 0xe1], &length.to_be_bytes(), b"Exif\0\0", &tiff, &jpeg[2..]].concat()
}

/// The six patches of the file, as the eight orientations of the standard place them.
#[test]
fn a_photograph_is_turned_upright() {
    let plain = decoded(COLOURS);
    let cells = |picture: &Picture| -> Vec<Vec<f32>> {
        let (columns, rows) = (picture.width / 16, picture.height / 16);
        (0..rows).map(|row| (0..columns).map(|column| patch(picture, column, row)).collect()).collect()
    };
    let [top, bottom] = &cells(&plain)[..] else { panic!("two rows") };
    let [a, b, c, d, e, f] = [top[0], top[1], top[2], bottom[0], bottom[1], bottom[2]];
    for (number, expected) in [
        (1, vec![vec![a, b, c], vec![d, e, f]]),
        (2, vec![vec![c, b, a], vec![f, e, d]]),
        (3, vec![vec![f, e, d], vec![c, b, a]]),
        (4, vec![vec![d, e, f], vec![a, b, c]]),
        (5, vec![vec![a, d], vec![b, e], vec![c, f]]),
        (6, vec![vec![d, a], vec![e, b], vec![f, c]]),
        (7, vec![vec![f, c], vec![e, b], vec![d, a]]),
        (8, vec![vec![c, f], vec![b, e], vec![a, d]]),
    ] {
        for is_big_endian in [false, true] {
            let picture = decoded(&with_orientation(COLOURS, number, is_big_endian));
            assert_eq!(cells(&picture), expected, "orientation {number}");
            let is_said = picture.conversions.iter().any(|said| said.contains("turned upright"));
            assert_eq!(is_said, number != 1, "orientation {number}: {:?}", picture.conversions);
        }
    }
    // Unreadable data give no orientation.
    assert_eq!(decoded(&with_orientation(COLOURS, 9, true)), plain);
    let mut broken = with_orientation(COLOURS, 6, true);
    broken[14] = 0xff;
    assert_eq!(decoded(&broken), plain);
}
