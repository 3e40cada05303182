//! `frixel new`, and what a designer does next.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::processes::{bundled, succeed};

#[test]
fn a_new_scene_is_checked_and_played_as_it_is() {
    let folder = TempDir::new().unwrap();
    let picture = bundled("textures/brick.png");
    fs::copy(&picture, folder.path().join("mine.png")).unwrap();
    fs::copy(bundled("textures/wood.jpg"), folder.path().join("photo.jpg")).unwrap();
    for (name, arguments) in [
        ("near.toml", &["new", "near.toml", "--picture", "mine.png"][..]),
        ("photo.toml", &["new", "photo", "--picture", "photo.jpg"]),
        ("far.toml", &["new", "far", "--picture", picture.to_str().unwrap()]),
    ] {
        let said = succeed(folder.path(), arguments);
        assert!(said.contains(&format!("frixel play {name}")), "{said}");
        let said = succeed(folder.path(), &["check", name]);
        assert!(!said.contains("stretched by"), "{said}");
        let said = succeed(folder.path(), &["play", name, "--seconds", "0.5"]);
        assert!(said.contains("  in this play     "), "{said}");
    }
    fs::create_dir(folder.path().join("sub")).unwrap();
    succeed(folder.path(), &["new", "sub/w", "--picture", "mine.png"]);
    assert!(fs::read_to_string(folder.path().join("sub/w.toml")).unwrap().contains("picture = \"../mine.png\""));
    succeed(folder.path(), &["check", "sub/w.toml"]);
    for name in ["my \"best\".png", "it's mine.png", "both \"'\".png", "# \u{7f}.png"] {
        named_as_it_is(folder.path(), name);
    }
    #[cfg(unix)]
    named_as_it_is(folder.path(), "a\\b.png");
    let said = succeed(folder.path(), &["new", "my ribs"]);
    assert!(said.contains("frixel check 'my ribs.toml'\n"), "{said}");
    let text = fs::read_to_string(folder.path().join("near.toml")).unwrap();
    assert!(text.contains("levels = \"stretch\"") && !text.contains("pitch_mm"), "{text}");
    let said = succeed(folder.path(), &["check", "photo.toml"]);
    assert!(said.contains("colour turned to grey by luma") && said.contains("the finest pitch that fits"), "{said}");
    assert!(text.contains("picture = \"mine.png\"") && text.lines().count() < 20, "{text}");
}

/// A picture of any name is played by a new scene.
fn named_as_it_is(folder: &Path, picture: &str) {
    fs::copy(folder.join("mine.png"), folder.join(picture)).unwrap();
    succeed(folder, &["new", "named", "--picture", picture]);
    succeed(folder, &["check", "named.toml"]);
    fs::remove_file(folder.join("named.toml")).unwrap();
}
