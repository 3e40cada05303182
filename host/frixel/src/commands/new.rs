//! `frixel new`: a first scene, with a comment for every line.

use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Component, MAIN_SEPARATOR, Path, PathBuf};

use super::error::{at, reading, writing};
use crate::input;
use anyhow::{Result, bail};
use clap::Args;
use frixel_files::{Inputs, OutputFile};
use frixel_scene::{Screen, check_picture, layer_kinds};

use super::terminal::print_line;

/// File extensions of pictures.
const PICTURE_EXTENSIONS: [&str; 3] = ["png", "jpg", "jpeg"];

#[derive(Debug, Args)]
pub(super) struct NewArgs {
    /// Name of the scene; `NAME.toml` is written, or `NAME` if it ends in `.toml`.
    name: PathBuf,
    /// A PNG or JPEG file that the scene plays as friction: dark is low, light is high.
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
}

pub(super) fn run(args: &NewArgs) -> Result<()> {
    let stem = args.name.file_stem().map(|stem| stem.to_string_lossy());
    if stem.is_none_or(|stem| stem.starts_with(['.', '~'])) {
        bail!("\"{}\" has no name for a scene: give one such as wood, or scenes/wood.toml", args.name.display());
    }
    let path = scene_path(&args.name);
    if args.name.extension().is_some_and(is_of_picture) {
        let (name, scene) = (args.name.display(), quoted(&args.name.with_extension("")));
        let picture = quoted(args.picture.as_ref().unwrap_or(&args.name));
        bail!("{name} is the name of a picture, and a scene needs another: frixel new {scene} --picture {picture}");
    }
    let text = match &args.picture {
        Some(picture) => {
            let pixels = pixels(picture)?;
            with_picture(&name_from(&path, picture)?, pixels)
        }
        None => with_stripes(),
    };
    if path.exists() || !OutputFile::new(&path, "the scene", &Inputs::new(&args.picture))?.write_new(text.as_bytes())? {
        bail!("{} already exists, and is not overwritten: give another name, or remove it", path.display());
    }
    let (name, path) = (path.display(), quoted(&path));
    print_line(format_args!(
        "{name} is new. What will be felt, and what it costs: frixel check {path}\nHow it looks: frixel preview \
         {path}\nUnder a simulated finger: frixel play {path}"
    ))
}

/// The path of the scene file with a name. A dot in the name does not begin an extension: `wood-0.5mm` is a name.
fn scene_path(name: &Path) -> PathBuf {
    if name.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        return name.to_owned();
    }
    let mut file = name.file_name().unwrap_or_default().to_owned();
    file.push(".toml");
    name.with_file_name(file)
}

/// Width and height of a picture that can be played.
fn pixels(picture: &Path) -> Result<(usize, usize)> {
    let bytes = input::read(picture, input::PICTURE_MAX_BYTES).map_err(reading(picture))?;
    check_picture(&bytes).map_err(at(format!("{} cannot be played as a picture", picture.display())))
}

fn is_of_picture(extension: &OsStr) -> bool {
    PICTURE_EXTENSIONS.iter().any(|known| extension.eq_ignore_ascii_case(known))
}

/// A path as one word of a shell command: in single quotes where it needs them.
fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    let is_plain = |letter: char| letter.is_alphanumeric() || letter == MAIN_SEPARATOR || "/:._-+,@".contains(letter);
    if text.chars().all(is_plain) { text } else { format!("'{}'", text.replace('\'', "'\\''")) }
}

/// The path of a picture relative to the scene's folder.
fn name_from(scene: &Path, picture: &Path) -> Result<String> {
    let from = real_folder(scene).map_err(writing(scene))?;
    let to = real_folder(picture).map_err(reading(picture))?;
    let name = relative(&from, &to).join(picture.file_name().unwrap_or_default());
    // Scene files use slashes on every operating system.
    Ok(name.display().to_string().replace(MAIN_SEPARATOR, "/"))
}

/// The canonical path of a file's folder.
fn real_folder(file: &Path) -> io::Result<PathBuf> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::canonicalize(folder)
}

/// The relative path between two canonical folders; the whole path if they are on different drives.
fn relative(from: &Path, to: &Path) -> PathBuf {
    let common = from.components().zip(to.components()).take_while(|(one, other)| one == other).count();
    if common == 0 {
        return to.to_owned();
    }
    let up = from.components().skip(common).map(|_| Component::ParentDir);
    up.chain(to.components().skip(common)).collect()
}

/// The beginning of every scene.
fn head() -> String {
    let Screen { width_mm, height_mm, .. } = Screen::example();
    format!(
        "# docs/design/scene-reference.md has every key. Lengths are in mm from the top left corner of the screen.\n\
         # Without [screen] and [finger] the scene is meant for the example screen, {width_mm} by {height_mm} mm, and the\n\
         # example finger. Fractions: 0 is that finger's natural friction, 1 the highest that can be reached.\n\
         version = 1\n"
    )
}

/// The rectangle in the middle of the example screen: left, top, width, height.
fn middle_mm() -> [f64; 4] {
    let Screen { width_mm, height_mm, .. } = Screen::example();
    [0.125 * width_mm, 0.125 * height_mm, 0.75 * width_mm, 0.75 * height_mm].map(f64::round)
}

fn with_stripes() -> String {
    let [x_mm, y_mm, width_mm, height_mm] = middle_mm();
    let kind = "grating";
    let others: Vec<&str> = layer_kinds().filter(|other| *other != kind).collect();
    format!(
        "{}\n\
         # Stripes in the middle of the screen: a finger that slides across them feels ribs.\n\
         [[layer]]\n\
         name = \"stripes\"\n\
         kind = \"{kind}\"  # or {}\n\
         region = {{ x_mm = {x_mm}, y_mm = {y_mm}, width_mm = {width_mm}, height_mm = {height_mm} }}\n\
         wavelength_mm = 4    # from one rib to the next\n\
         low_fraction = 0     # friction between the ribs\n\
         high_fraction = 0.9  # friction on the ribs\n",
        head(),
        others.join(", ")
    )
}

/// The largest rectangle with a picture's aspect ratio in the middle of the example screen: left, top, width, height.
fn fitted_mm((width, height): (usize, usize)) -> [f64; 4] {
    let [x_mm, y_mm, width_mm, height_mm] = middle_mm();
    let (width, height) = (width.max(1) as f64, height.max(1) as f64);
    let pixel_mm = (width_mm / width).min(height_mm / height);
    let hundredths = |mm: f64| (100.0 * mm).round() / 100.0;
    // A side of a region has at least a hundredth of a millimetre.
    let (wide_mm, high_mm) = (hundredths(width * pixel_mm).max(0.01), hundredths(height * pixel_mm).max(0.01));
    [hundredths(x_mm + 0.5 * (width_mm - wide_mm)), hundredths(y_mm + 0.5 * (height_mm - high_mm)), wide_mm, high_mm]
}

fn with_picture(picture: &str, pixels: (usize, usize)) -> String {
    let [x_mm, y_mm, width_mm, height_mm] = fitted_mm(pixels);
    // Quoted and escaped.
    let picture = toml_edit::Value::from(picture);
    format!(
        "{}\n\
         # The picture, as friction. The region has the picture's aspect ratio.\n\
         [[layer]]\n\
         name = \"picture\"\n\
         kind = \"bitmap\"\n\
         picture = {picture}\n\
         region = {{ x_mm = {x_mm}, y_mm = {y_mm}, width_mm = {width_mm}, height_mm = {height_mm} }}\n\
         levels = \"stretch\"    # the darkest and the lightest hundredth of the picture are black and white\n\
         black_fraction = 0    # friction where the picture is black\n\
         white_fraction = 0.9  # friction where it is white\n",
        head()
    )
}
