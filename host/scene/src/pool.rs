//! Compiles pictures to bitmaps for the board's pool.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use frixel_layers::Bitmap as Record;

use super::file::Scene;
use super::files::{FileUnavailable, SharedFile, file_name};
use super::kinds::{Bitmap as BitmapLayer, Kind, Levels, PITCH_MM};
use super::layer::{Layer, Rectangle, Region};
use super::log::Log;
use super::lower::{MM, place};
use super::mistake::FileMistake;
use super::optimisation::Optimisation;
use super::picture::{PIXELS_MAX, Picture};
use super::printable::printable;
use super::program::Bitmap;
use super::resample::{Axis, resample};

/// The file of each picture that a scene names, or the reason why it is not available.
pub(super) type PictureFiles = BTreeMap<String, Result<Arc<SharedFile>, FileUnavailable>>;

/// Collects the bitmaps of a scene without duplicates, and checks that they fit into the pool.
pub(super) struct Pool {
    pictures: Decoded,
    size_bytes: u32,
    /// The pitch of finer pictures with `pitch_mm = "auto"`.
    shared_pitch_mm: f64,
    screen_mm: (f64, f64),
    pub(super) bitmaps: Vec<Bitmap>,
}

/// The pictures of a scene, each decoded once, or the reason why a picture cannot be used.
pub(super) type Decoded = BTreeMap<String, Result<Arc<Picture>, FileMistake>>;

/// The reason why a picture has no place in the pool.
pub(super) enum Unplaced {
    /// A mistake that was logged when the scene was read.
    Reported,
    /// The picture cannot be used.
    Unusable(FileMistake),
    /// The pool has too little room for it.
    PoolTooSmall {
        /// Bytes needed by the pictures so far, including this one.
        needed_bytes: u64,
        pool_bytes: u32,
        /// A pitch at which they fit.
        pitch_mm: f64,
    },
}

/// A bitmap and its place on the screen.
pub(crate) struct Placed {
    /// The record, without friction.
    pub(crate) record: Record,
    /// The picture's outline; `None` for a tiled picture.
    pub(crate) outline: Option<Region>,
    /// Whether it is transparent and of one grey, so that another ground would reveal its shape.
    pub(crate) is_hidden: bool,
    /// Its height over its width, relative to that of its pixels.
    pub(crate) height_factor: f64,
    /// The height that preserves the proportions.
    pub(crate) height_kept_mm: f64,
}

impl Placed {
    fn new(
        bitmap: &BitmapLayer,
        picture: &Picture,
        whole: Rectangle,
        pitch_mm: f64,
        (across, down): (Axis, Axis),
        (crc32, is_hidden): (u32, bool),
    ) -> Self {
        // A picture is rotated about its centre.
        let (half_width_mm, half_height_mm) = (0.5 * whole.width_mm, 0.5 * whole.height_mm);
        let (middle_x_mm, middle_y_mm) = (whole.x_mm + half_width_mm, whole.y_mm + half_height_mm);
        let (cos, sin) = place::direction(bitmap.angle_deg);
        let turned =
            |x_mm: f64, y_mm: f64| (middle_x_mm + cos * x_mm - sin * y_mm, middle_y_mm + sin * x_mm + cos * y_mm);
        let pitches_mm = if bitmap.tiled {
            (whole.width_mm / across.samples as f64, whole.height_mm / down.samples as f64)
        } else {
            (pitch_mm, pitch_mm)
        };
        let corner_mm = if bitmap.angle_deg.abs() > 0.0 {
            turned(-half_width_mm, -half_height_mm)
        } else {
            let skipped_mm = |axis: Axis, pitch_mm: f64| axis.skipped as f64 * pitch_mm;
            (whole.x_mm + skipped_mm(across, pitches_mm.0), whole.y_mm + skipped_mm(down, pitches_mm.1))
        };
        let outline = match (bitmap.tiled, bitmap.angle_deg.abs() > 0.0) {
            (true, _) => None,
            (false, false) => Some(Region::Rectangle(whole)),
            (false, true) => Some(Region::Polygon(vec![
                turned(-half_width_mm, -half_height_mm),
                turned(half_width_mm, -half_height_mm),
                turned(half_width_mm, half_height_mm),
                turned(-half_width_mm, half_height_mm),
            ])),
        };
        let record = Record {
            crc32,
            x_m: (corner_mm.0 * MM) as f32,
            y_m: (corner_mm.1 * MM) as f32,
            pitch_m: (pitches_mm.0 * MM) as f32,
            black_n: 0.0,
            white_n: 0.0,
            pitch_y_m: (pitches_mm.1 * MM) as f32,
            angle_turns: place::turns(bitmap.angle_deg),
            tiled: bitmap.tiled,
        };
        let height_kept_mm = whole.width_mm * height_per_width(picture);
        let height_factor = whole.height_mm / height_kept_mm;
        Self { record, outline, is_hidden, height_factor, height_kept_mm }
    }
}

/// The picture's rectangle before rotation. Place and size default to those of the layer's region.
fn rectangle(bitmap: &BitmapLayer, region: Option<Rectangle>, height_per_width: f64) -> Option<Rectangle> {
    let width_mm = bitmap.width_mm.or(region.map(|region| region.width_mm))?;
    let height_mm = bitmap.height_mm.or(match (bitmap.width_mm, region) {
        (None, Some(region)) => Some(region.height_mm),
        _ => Some(width_mm * height_per_width),
    })?;
    Some(Rectangle {
        x_mm: bitmap.x_mm.or(region.map(|region| region.x_mm))?,
        y_mm: bitmap.y_mm.or(region.map(|region| region.y_mm))?,
        width_mm,
        height_mm,
    })
}

/// The samples along a row and down the rows. For a rotated or tiled picture, all samples; otherwise those within its
/// region and the screen.
fn axes(
    bitmap: &BitmapLayer,
    pitch_mm: f64,
    picture: &Picture,
    whole: Rectangle,
    region: Option<Rectangle>,
    (screen_width_mm, screen_height_mm): (f64, f64),
) -> (Axis, Axis) {
    if bitmap.tiled {
        let across = Axis::dividing(whole.width_mm, pitch_mm, picture.width);
        return (across, Axis::dividing(whole.height_mm, pitch_mm, picture.height));
    }
    let across = Axis::covering(whole.width_mm, pitch_mm, picture.width);
    let down = Axis::covering(whole.height_mm, pitch_mm, picture.height);
    if bitmap.angle_deg.abs() > 0.0 {
        return (across, down);
    }
    let seen = region.unwrap_or(whole);
    let crop = |axis: Axis, start_mm: f64, seen_mm: f64, length_mm: f64, screen_mm: f64| {
        let (from_mm, to_mm) = (seen_mm.max(0.0), (seen_mm + length_mm).min(screen_mm));
        axis.cropped((from_mm - start_mm) / pitch_mm, (to_mm - start_mm) / pitch_mm)
    };
    (
        crop(across, whole.x_mm, seen.x_mm, seen.width_mm, screen_width_mm),
        crop(down, whole.y_mm, seen.y_mm, seen.height_mm, screen_height_mm),
    )
}

/// The pitch of a picture: its own, or the finest allowed by its pixels, the range and the shared pitch.
fn pitch_mm(bitmap: &BitmapLayer, picture: &Picture, whole: Rectangle, shared_mm: f64) -> f64 {
    bitmap.pitch_mm.unwrap_or_else(|| {
        let pixel_mm = (whole.width_mm / picture.width as f64).min(whole.height_mm / picture.height as f64);
        pixel_mm.max(shared_mm).clamp(PITCH_MM.min, PITCH_MM.max)
    })
}

fn height_per_width(picture: &Picture) -> f64 {
    picture.height as f64 / picture.width as f64
}

/// The finest pitch, in hundredths of a millimetre, at which a scene's bitmaps fit into the pool if all layers with
/// `pitch_mm = "auto"` use it; the coarsest one if none fits.
fn shared_pitch_mm(scene: &Scene, screen_mm: (f64, f64), pictures: &Decoded, size_bytes: u32) -> f64 {
    let bitmaps = scene.layers.iter().filter_map(|layer| {
        let Kind::Bitmap(bitmap) = &layer.kind else { return None };
        let picture = pictures.get(&bitmap.picture)?.as_ref().ok()?;
        let region = layer.region.as_ref().map(Region::bounds);
        Some((bitmap, picture, region, rectangle(bitmap, region, height_per_width(picture))?))
    });
    let bitmaps: Vec<_> = bitmaps.collect();
    let fits = |hundredths: u32| {
        let mut grids = Vec::new();
        for (bitmap, picture, region, whole) in &bitmaps {
            let pitch_mm = pitch_mm(bitmap, picture, *whole, f64::from(hundredths) / 100.0);
            let content = (&bitmap.picture, bitmap.levels, bitmap.ground, bitmap.is_inverted);
            let grid = (content, axes(bitmap, pitch_mm, picture, *whole, *region, screen_mm));
            if !grids.contains(&grid) {
                grids.push(grid);
            }
        }
        let bytes: u64 = grids.iter().map(|(_, (across, down))| across.samples as u64 * down.samples as u64).sum();
        bytes <= u64::from(size_bytes)
    };
    let (finest, coarsest) = ((100.0 * PITCH_MM.min).round() as u32, (100.0 * PITCH_MM.max).round() as u32);
    if bitmaps.iter().all(|(bitmap, ..)| bitmap.pitch_mm.is_some()) || fits(finest) {
        return PITCH_MM.min;
    }
    // `low` does not fit, and `high` does or is the coarsest.
    let (mut low, mut high) = (finest, coarsest);
    while high - low > 1 {
        let middle = low.midpoint(high);
        if fits(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    f64::from(high) / 100.0
}

/// The opaque picture at the levels of its layer. Levels are those of the samples, so that the result does not depend
/// on the number of pixels.
fn levelled<'p>(bitmap: &BitmapLayer, picture: &'p Picture, across: Axis, down: Axis) -> Cow<'p, Picture> {
    let is_changed = bitmap.is_inverted || !picture.white_below.is_empty();
    let picture = if is_changed {
        Cow::Owned(picture.clone().laid_over(bitmap.ground, bitmap.is_inverted))
    } else {
        Cow::Borrowed(picture)
    };
    if bitmap.levels == Levels::Full {
        return picture;
    }
    let (across, down) = (across.whole_in_pixels(picture.width), down.whole_in_pixels(picture.height));
    let samples = resample(&picture.grey, picture.width, across, down);
    Cow::Owned(picture.into_owned().stretched(samples))
}

/// Decodes each picture of a scene once, up to a total number of pixels.
pub(super) fn decoded(scene: &Scene, pixels_max: usize) -> Decoded {
    let mut decoded = Decoded::new();
    let mut pixels_left = pixels_max;
    for layer in &scene.layers {
        if let Kind::Bitmap(bitmap) = &layer.kind {
            // `Scene::parse` has read every picture named by a layer.
            let unread = Err(FileUnavailable::Unreadable { reason: "the scene was read without it".to_owned() });
            let file = scene.pictures.get(&bitmap.picture).unwrap_or(&unread);
            decoded.entry(bitmap.picture.clone()).or_insert_with(|| {
                let picture = picture(&bitmap.picture, file, pixels_left);
                pixels_left -= picture.as_ref().map_or(0, |picture| picture.width * picture.height);
                picture
            });
        }
    }
    decoded
}

fn picture(
    name: &str,
    file: &Result<Arc<SharedFile>, FileUnavailable>,
    pixels_max: usize,
) -> Result<Arc<Picture>, FileMistake> {
    if name.is_empty() {
        return Err(FileMistake::NoFileName { field: "picture" });
    }
    let file = file.as_ref().map_err(|unavailable| FileMistake::unavailable("picture", name, unavailable))?;
    file.picture(pixels_max).map_err(|error| FileMistake::FileUnusable {
        what: "picture",
        file: name.to_owned(),
        reason: error.to_string(),
    })
}

impl Pool {
    /// Decodes the pictures of a scene, for a pool of `size_bytes`.
    pub(super) fn new(scene: &Scene, size_bytes: u32) -> Self {
        let pictures = decoded(scene, PIXELS_MAX);
        let screen_mm = (scene.screen().width_mm, scene.screen().height_mm);
        let shared_pitch_mm = shared_pitch_mm(scene, screen_mm, &pictures, size_bytes);
        Self { pictures, size_bytes, shared_pitch_mm, screen_mm, bitmaps: Vec::new() }
    }

    /// Resamples the picture of a layer. `region` bounds the layer's region, if it has one.
    pub(super) fn place(
        &mut self,
        layer: &Layer,
        bitmap: &BitmapLayer,
        region: Option<Rectangle>,
        log: &mut Log,
    ) -> Result<Placed, Unplaced> {
        let picture = self.pictures.get(&bitmap.picture).ok_or(Unplaced::Reported)?;
        let picture = picture.as_ref().map_err(|mistake| Unplaced::Unusable(mistake.clone()))?;
        let whole = rectangle(bitmap, region, height_per_width(picture)).ok_or(Unplaced::Reported)?;
        let pitch_mm = pitch_mm(bitmap, picture, whole, self.shared_pitch_mm);
        let (across, down) = axes(bitmap, pitch_mm, picture, whole, region, self.screen_mm);
        // Check before resampling, so that a far too fine pitch allocates no memory.
        let bytes = across.samples as u64 * down.samples as u64;
        self.check_room(pitch_mm, bytes)?;
        // One side may still exceed the protocol's 16 bits.
        let (Ok(width), Ok(height)) = (u16::try_from(across.samples), u16::try_from(down.samples)) else {
            return Err(self.too_small(pitch_mm, bytes));
        };
        let is_transparent = !picture.white_below.is_empty();
        let picture = levelled(bitmap, picture, across, down);
        let compiled = Bitmap::new(width, height, resample(&picture.grey, picture.width, across, down));
        let is_hidden = is_transparent && compiled.samples.windows(2).all(|pair| pair[0] == pair[1]);
        let name = (compiled.crc32, is_hidden);
        let (picture_name, kept) = (printable(file_name(&bitmap.picture)).into_owned(), across.samples * down.samples);
        if kept < across.whole * down.whole {
            let whole = across.whole * down.whole;
            log.note_optimisation(layer, Optimisation::Cropped { picture: picture_name.clone(), whole, kept });
        }
        if self.bitmaps.contains(&compiled) {
            log.note_optimisation(layer, Optimisation::Shared { picture: picture_name, bytes: kept });
        } else {
            let held: u64 = self.bitmaps.iter().map(|bitmap| bitmap.samples.len() as u64).sum();
            self.check_room(pitch_mm, held + bytes)?;
            self.bitmaps.push(compiled);
        }
        if let Some(note) = self.note(bitmap, &picture, pitch_mm, across, down) {
            log.note(layer.places.field("picture"), note);
        }
        Ok(Placed::new(bitmap, &picture, whole, pitch_mm, (across, down), name))
    }

    fn check_room(&self, pitch_mm: f64, needed_bytes: u64) -> Result<(), Unplaced> {
        if needed_bytes > u64::from(self.size_bytes) { Err(self.too_small(pitch_mm, needed_bytes)) } else { Ok(()) }
    }

    fn too_small(&self, pitch_mm: f64, needed_bytes: u64) -> Unplaced {
        // The pitch at which all pictures fit if they are coarsened alike: 1 % is added for samples at the edges, and
        // the result is rounded up to 0.01 mm.
        let coarser = 1.01 * (needed_bytes as f64 / f64::from(self.size_bytes)).sqrt();
        let pitch_mm = (pitch_mm * coarser * 100.0).ceil() / 100.0;
        Unplaced::PoolTooSmall { needed_bytes, pool_bytes: self.size_bytes, pitch_mm }
    }

    /// Describes the conversions of a picture, and an automatic pitch; `None` if there are none.
    fn note(&self, bitmap: &BitmapLayer, picture: &Picture, pitch_mm: f64, across: Axis, down: Axis) -> Option<String> {
        let mut done = picture.conversions.clone();
        let is_resampled = (across.whole, down.whole) != (picture.width, picture.height);
        if is_resampled {
            done.push(format!(
                "{} x {} resampled to {} x {} at {} mm",
                picture.width,
                picture.height,
                across.whole,
                down.whole,
                (1e4 * pitch_mm).round() / 1e4
            ));
        }
        if bitmap.pitch_mm.is_none() {
            let is_shared = pitch_mm.to_bits() == self.shared_pitch_mm.to_bits();
            done.push(match (is_resampled, is_shared) {
                (_, true) => format!("the finest pitch that fits into the board's {} bytes", self.size_bytes),
                (true, false) => "a pitch as fine as its pixels".to_owned(),
                (false, false) => format!("a sample for each pixel, {} mm", (1e4 * pitch_mm).round() / 1e4),
            });
        }
        (!done.is_empty()).then(|| format!("{}: {}", printable(file_name(&bitmap.picture)), done.join(", ")))
    }
}
