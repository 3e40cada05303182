//! Pictures on their way into the board's bitmap pool.

use std::fs;
use std::path::{Path, PathBuf};

use super::layer::{Bitmap as BitmapLayer, Layer, Rectangle};
use super::log::Log;
use super::mistake::{Mistake, Nearest};
use super::picture::Picture;
use super::program::Bitmap;
use super::resample::{Axis, resample};

/// Gathers the bitmaps of a scene, each one once, and sees that they fit.
pub(super) struct Pool {
    folder: PathBuf,
    size_bytes: u32,
    bitmaps: Vec<Bitmap>,
}

impl Pool {
    pub(super) fn new(folder: PathBuf, size_bytes: u32) -> Self {
        Self { folder, size_bytes, bitmaps: Vec::new() }
    }

    pub(super) fn into_bitmaps(self) -> Vec<Bitmap> {
        self.bitmaps
    }

    /// Reads and resamples a layer's picture. Gives the picture's rectangle and its bitmap's name.
    pub(super) fn place(
        &mut self,
        layer: &Layer,
        bitmap: &BitmapLayer,
        log: &mut Log,
        notes: &mut Vec<String>,
    ) -> Option<(Rectangle, u32)> {
        let picture = self.read(layer, bitmap, log)?;
        let height_mm = bitmap.height_mm.unwrap_or(bitmap.width_mm * picture.height as f64 / picture.width as f64);
        let across = Axis::covering(bitmap.width_mm, bitmap.pitch_mm, picture.width);
        let down = Axis::covering(height_mm, bitmap.pitch_mm, picture.height);
        // Before resampling, so that a pitch far too fine asks for no memory.
        let bytes = across.samples as u64 * down.samples as u64;
        if !self.fits(layer, bitmap, bytes, log) {
            return None;
        }
        let samples = resample(&picture.grey, picture.width, across, down);
        // The pool is smaller than 2^32 bytes, yet one side might be longer than the wire can say.
        let (Ok(width), Ok(height)) = (u16::try_from(across.samples), u16::try_from(down.samples)) else {
            self.too_small(layer, bitmap, bytes, log);
            return None;
        };
        let compiled = Bitmap::new(width, height, samples);
        let crc32 = compiled.crc32;
        if !self.bitmaps.contains(&compiled) {
            let held: u64 = self.bitmaps.iter().map(|bitmap| bitmap.samples.len() as u64).sum();
            if !self.fits(layer, bitmap, held + bytes, log) {
                return None;
            }
            self.bitmaps.push(compiled);
        }
        notes.extend(note(&picture, bitmap, across, down));
        let rectangle = Rectangle { x_mm: bitmap.x_mm, y_mm: bitmap.y_mm, width_mm: bitmap.width_mm, height_mm };
        Some((rectangle, crc32))
    }

    fn read(&self, layer: &Layer, bitmap: &BitmapLayer, log: &mut Log) -> Option<Picture> {
        let path = self.folder.join(&bitmap.picture);
        let offset = layer.places.field("picture");
        if !path.is_file() {
            let folder = path.parent().unwrap_or(&self.folder);
            let mistake = Mistake::PictureMissing {
                picture: bitmap.picture.clone(),
                folder: if folder.as_os_str().is_empty() { ".".to_owned() } else { folder.display().to_string() },
                nearest: nearest_file(folder, &path),
            };
            log.add(offset, mistake);
            return None;
        }
        match Picture::read(&path) {
            Ok(picture) => Some(picture),
            Err(error) => {
                let picture = bitmap.picture.clone();
                log.add(offset, Mistake::PictureUnusable { picture, reason: error.to_string() });
                None
            }
        }
    }

    fn fits(&self, layer: &Layer, bitmap: &BitmapLayer, needed_bytes: u64, log: &mut Log) -> bool {
        let fits = needed_bytes <= u64::from(self.size_bytes);
        if !fits {
            self.too_small(layer, bitmap, needed_bytes, log);
        }
        fits
    }

    fn too_small(&self, layer: &Layer, bitmap: &BitmapLayer, needed_bytes: u64, log: &mut Log) {
        // All pictures coarsened alike, a hundredth on top for the samples at the edges, up to the next 0.01 mm.
        let coarser = 1.01 * (needed_bytes as f64 / f64::from(self.size_bytes)).sqrt();
        let pitch_mm = (bitmap.pitch_mm * coarser * 100.0).ceil() / 100.0;
        let offset = layer.places.field(if layer.places.has("pitch_mm") { "pitch_mm" } else { "picture" });
        log.add(offset, Mistake::PoolTooSmall { needed_bytes, pool_bytes: self.size_bytes, pitch_mm });
    }
}

/// What was done to a picture, if anything.
fn note(picture: &Picture, bitmap: &BitmapLayer, across: Axis, down: Axis) -> Option<String> {
    let mut done: Vec<String> = picture.conversions.iter().map(ToString::to_string).collect();
    if (across.samples, down.samples) != (picture.width, picture.height) {
        done.push(format!(
            "{} x {} resampled to {} x {} at {} mm",
            picture.width, picture.height, across.samples, down.samples, bitmap.pitch_mm
        ));
    }
    let name = Path::new(&bitmap.picture).file_name().unwrap_or(bitmap.picture.as_ref()).to_string_lossy();
    (!done.is_empty()).then(|| format!("{name}: {}", done.join(", ")))
}

/// `, which has "..."` with the file in a folder whose name is nearest to a path's, or nothing.
fn nearest_file(folder: &Path, path: &Path) -> String {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let mut names: Vec<String> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    names.sort();
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    let nearest = Nearest::new(&wanted, names.iter().map(String::as_str));
    nearest.suggestion.map_or(String::new(), |name| format!(", which has \"{name}\""))
}
