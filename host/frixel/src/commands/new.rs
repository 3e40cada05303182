//! `frixel new`: a first scene, with a comment for every line.

use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use frixel_scene::{Screen, check_picture};

use super::error::CommandError;
use super::terminal::print_line;

#[derive(Debug, Args)]
pub(super) struct NewArgs {
    /// Name of the scene; `NAME.toml` is written.
    name: PathBuf,
    /// A PNG or JPEG file that the scene plays as friction: dark is low, light is high.
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
}

pub(super) fn run(args: &NewArgs) -> Result<(), CommandError> {
    let stem = args.name.file_stem().map(|stem| stem.to_string_lossy());
    if stem.is_none_or(|stem| stem.starts_with(['.', '~'])) {
        return Err(CommandError::SceneName { name: args.name.clone() });
    }
    let path = args.name.with_extension("toml");
    let text = match &args.picture {
        Some(picture) => {
            let pixels = pixels(picture)?;
            with_picture(&name_from(&path, picture)?, pixels)
        }
        None => with_stripes(),
    };
    let created = File::create_new(&path).and_then(|mut file| file.write_all(text.as_bytes()));
    match created {
        Ok(()) => {}
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return Err(CommandError::SceneExists { path }),
        Err(error) => return Err(CommandError::writing(&path)(error)),
    }
    let path = path.display();
    print_line(format_args!(
        "{path} is new. What it costs and what will be felt: frixel scene check {path}\nHow it looks: frixel scene preview \
         {path} -o map.png\nUnder a simulated finger: frixel play {path}"
    ))
}

/// Width and height of a picture that can be played.
fn pixels(picture: &Path) -> Result<(usize, usize), CommandError> {
    let bytes = fs::read(picture).map_err(CommandError::reading(picture))?;
    check_picture(&bytes).map_err(|reason| CommandError::Picture { path: picture.to_owned(), reason })
}

/// The path of a picture from the folder of the scene.
fn name_from(scene: &Path, picture: &Path) -> Result<String, CommandError> {
    let absolute = std::path::absolute(picture).map_err(CommandError::reading(picture))?;
    let folder = scene.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = std::path::absolute(folder).map_err(CommandError::reading(folder))?;
    let name = absolute.strip_prefix(&folder).unwrap_or(&absolute);
    // TOML texts have slashes on every operating system, and no backslashes.
    Ok(name.display().to_string().replace('\\', "/"))
}

/// The beginning of every scene.
fn head() -> String {
    let Screen { width_mm, height_mm, .. } = Screen::example();
    format!(
        "# docs/scene.md has every field. Lengths are in mm from the top left corner of the screen.\n\
         # Without [screen] and [finger] the scene is meant for the example screen, {width_mm} by {height_mm} mm, and the\n\
         # example finger. Fractions are parts of what that finger can be given above its natural friction.\n\
         version = 2\n"
    )
}

/// The rectangle in the middle of the example screen: left, top, width, height.
fn middle_mm() -> [f64; 4] {
    let Screen { width_mm, height_mm, .. } = Screen::example();
    [0.125 * width_mm, 0.125 * height_mm, 0.75 * width_mm, 0.75 * height_mm].map(f64::round)
}

fn with_stripes() -> String {
    let [x_mm, y_mm, width_mm, height_mm] = middle_mm();
    format!(
        "{}\n\
         # Stripes in the middle of the screen: a finger that slides across them feels ribs.\n\
         [[layer]]\n\
         name = \"stripes\"\n\
         kind = \"grating\"  # or constant, bitmap, noise, edge, button, vibration, speed, stream, rings\n\
         region = {{ x_mm = {x_mm}, y_mm = {y_mm}, width_mm = {width_mm}, height_mm = {height_mm} }}\n\
         wavelength_mm = 4    # from one rib to the next\n\
         low_fraction = 0     # friction between the ribs\n\
         high_fraction = 0.9  # friction on the ribs\n",
        head()
    )
}

/// The largest rectangle with the ratio of a picture's sides in the middle of the example screen: left, top, width,
/// height.
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
    format!(
        "{}\n\
         # The picture, as friction: it fills the region, whose sides have the ratio of its own.\n\
         [[layer]]\n\
         name = \"picture\"\n\
         kind = \"bitmap\"\n\
         picture = \"{picture}\"\n\
         region = {{ x_mm = {x_mm}, y_mm = {y_mm}, width_mm = {width_mm}, height_mm = {height_mm} }}\n\
         levels = \"stretch\"    # the darkest and the lightest hundredth of the picture are black and white\n\
         black_fraction = 0    # friction where the picture is black\n\
         white_fraction = 0.9  # friction where it is white\n",
        head()
    )
}
