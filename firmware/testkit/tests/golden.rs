//! The bytes of scenes, held in `golden/`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

#[allow(unreachable_pub, reason = "it is shared with the tests of `frixel-wire`")]
#[path = "../../wire/tests/support/hex.rs"]
mod hex;
use crate::support;

use std::fmt::Write;
use std::path::Path;

use frixel_layers::{Header, Point, Record, Scene};
use frixel_testkit::golden;
use hex::{from_hex, to_hex};

/// The bytes of all lines of this kind.
fn lines(text: &str, kind: &str) -> impl Iterator<Item = Vec<u8>> {
    text.lines().filter_map(move |line| line.strip_prefix(kind)?.strip_prefix(' ')).map(from_hex)
}

#[test]
fn scenes_are_golden() {
    let mut text = String::new();
    for header in support::headers() {
        writeln!(text, "# {header:?}, in front of 4 records and 3 points\nheader {}", to_hex(&header.write(4, 3)))
            .unwrap();
    }
    for record in support::records() {
        writeln!(text, "# {record:?}\nrecord {}", to_hex(&record.write())).unwrap();
    }
    for point in support::points() {
        writeln!(text, "# {point:?}\npoint {}", to_hex(&point.write())).unwrap();
    }
    writeln!(text, "# The scene of a finger with an empirical law\nscene {}", to_hex(&support::law_scene())).unwrap();
    golden::hold(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/scene.hex"), &text);

    for golden in lines(&text, "scene") {
        let scene = Scene::parse(&golden).unwrap();
        assert_eq!(scene.header().law.map(|law| law.points().len()), Some(2));
        assert_eq!(frixel_testkit::scene(scene.header(), &[]), golden);
    }
    for (golden, header) in lines(&text, "header").zip(support::headers()) {
        assert_eq!(Header::parse(golden.as_slice().try_into().unwrap()), Ok((header, 4, 3)));
    }
    for (golden, record) in lines(&text, "record").zip(support::records()) {
        assert_eq!(Record::parse(golden.as_slice().try_into().unwrap(), 0), Ok(record));
    }
    for (golden, point) in lines(&text, "point").zip(support::points()) {
        assert_eq!(Point::parse(golden.as_slice().try_into().unwrap()), point);
    }
}
