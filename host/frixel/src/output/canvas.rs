//! Pixels, and the little that is drawn with them: areas, axis lines, smooth strokes, text.

use std::collections::HashMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use ab_glyph::{Font, FontRef, InvalidFont, PxScale, ScaleFont, point};

/// `DejaVu` Sans with few characters; its licence stands beside it.
static DEJAVU_SANS: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");
/// Height of the font's lines and of its capitals, in its em.
const LINE_HEIGHT: f32 = 1.164;
const CAPITAL_HEIGHT: f32 = 0.729;

/// Shades of grey at the edges of letters: enough to the eye.
const SHADES: f64 = 16.0;

/// Red, green and blue.
pub(super) type Colour = [u8; 3];
pub(super) const BLACK: Colour = [0, 0, 0];
pub(super) const WHITE: Colour = [255, 255, 255];

/// Where a text stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    /// It starts at the place.
    Start,
    /// Its middle is at the place.
    Middle,
    /// It ends at the place.
    End,
    /// It reads upwards, its middle at the place.
    Upright,
}

/// A picture of 8-bit colours, white at first.
pub(super) struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
    font: FontRef<'static>,
}

impl Canvas {
    pub(super) fn new(width: usize, height: usize) -> Result<Self, InvalidFont> {
        let font = FontRef::try_from_slice(DEJAVU_SANS)?;
        Ok(Self { width, height, pixels: vec![255; 3 * width * height], font })
    }

    /// Fills a rectangle from a corner.
    pub(super) fn fill(&mut self, (left, top): (usize, usize), (width, height): (usize, usize), colour: Colour) {
        for row in top..top + height {
            for column in left..left + width {
                self.blend(column as i64, row as i64, colour, 1.0);
            }
        }
    }

    /// Draws the outline just outside a rectangle.
    pub(super) fn frame(&mut self, (left, top): (usize, usize), (width, height): (usize, usize)) {
        for row in [top - 1, top + height] {
            self.fill((left - 1, row), (width + 2, 1), BLACK);
        }
        for column in [left - 1, left + width] {
            self.fill((column, top), (1, height), BLACK);
        }
    }

    /// Draws lines of some width through places, with smooth edges and round ends.
    pub(super) fn stroke(&mut self, lines: &[Vec<(f64, f64)>], width: f64, colour: Colour) {
        let reach = 0.5 * width + 1.0;
        let mut distances = vec![f32::INFINITY; self.width * self.height];
        for line in lines {
            let ends = line.iter().skip(1).chain(line.last());
            for (one, other) in line.iter().zip(ends) {
                let columns = pixels(one.0.min(other.0) - reach, one.0.max(other.0) + reach, self.width);
                for row in pixels(one.1.min(other.1) - reach, one.1.max(other.1) + reach, self.height) {
                    for column in columns.clone() {
                        let place = (column as f64 + 0.5, row as f64 + 0.5);
                        let nearest = &mut distances[row * self.width + column];
                        *nearest = nearest.min(distance(place, *one, *other) as f32);
                    }
                }
            }
        }
        for (index, distance) in distances.into_iter().enumerate() {
            let cover = 0.5 * width + 0.5 - f64::from(distance);
            if cover > 0.0 {
                self.blend((index % self.width) as i64, (index / self.width) as i64, colour, cover.min(1.0));
            }
        }
    }

    /// Draws a text of some size, its capitals level with the place.
    pub(super) fn text(&mut self, words: &str, size: f32, place: (i64, i64), anchor: Anchor) {
        let scale = PxScale::from(size * LINE_HEIGHT);
        let scaled = self.font.as_scaled(scale);
        let advances: Vec<f32> = words.chars().map(|letter| scaled.h_advance(scaled.glyph_id(letter))).collect();
        let length: f32 = advances.iter().sum();
        let mut along = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle | Anchor::Upright => -0.5 * length,
            Anchor::End => -length,
        };
        let baseline = 0.5 * CAPITAL_HEIGHT * size;
        let mut dots = Vec::new();
        for (letter, advance) in words.chars().zip(advances) {
            let glyph = self.font.glyph_id(letter).with_scale_and_position(scale, point(along, baseline));
            if let Some(outline) = self.font.outline_glyph(glyph) {
                let corner = outline.px_bounds().min;
                outline.draw(|column, row, cover| {
                    dots.push((corner.x as i64 + i64::from(column), corner.y as i64 + i64::from(row), cover));
                });
            }
            along += advance;
        }
        for (across, down, cover) in dots {
            let (x, y) = if anchor == Anchor::Upright { (down, -across) } else { (across, down) };
            self.blend(place.0 + x, place.1 + y, BLACK, (f64::from(cover.min(1.0)) * SHADES).round() / SHADES);
        }
    }

    /// How far a text of some size reaches, in pixels.
    pub(super) fn text_width(&self, words: &str, size: f32) -> f32 {
        let scaled = self.font.as_scaled(PxScale::from(size * LINE_HEIGHT));
        words.chars().map(|letter| scaled.h_advance(scaled.glyph_id(letter))).sum()
    }

    /// Writes the picture as a PNG file: a byte a pixel where there are few colours.
    pub(super) fn write_png(&self, path: &Path) -> Result<(), png::EncodingError> {
        let file = BufWriter::new(File::create(path)?);
        let mut encoder = png::Encoder::new(file, self.width as u32, self.height as u32);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        let indexed = self.indexed();
        let bytes = if let Some((palette, indices)) = &indexed {
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(palette.concat());
            encoder.set_filter(png::Filter::NoFilter);
            indices
        } else {
            encoder.set_color(png::ColorType::Rgb);
            &self.pixels
        };
        let mut writer = encoder.write_header()?;
        writer.write_image_data(bytes)?;
        writer.finish()
    }

    /// The colours in the order in which they appear, and the colour of each pixel; nothing where a byte is too short.
    fn indexed(&self) -> Option<(Vec<Colour>, Vec<u8>)> {
        let mut palette: Vec<Colour> = Vec::new();
        let mut numbers: HashMap<&[u8], u8> = HashMap::new();
        let mut indices = Vec::with_capacity(self.width * self.height);
        for pixel in self.pixels.chunks_exact(3) {
            let known = numbers.get(pixel).copied();
            let index = match (known, pixel) {
                (Some(index), _) => index,
                (None, [red, green, blue]) => {
                    let index = u8::try_from(palette.len()).ok()?;
                    palette.push([*red, *green, *blue]);
                    numbers.insert(pixel, index);
                    index
                }
                _ => return None,
            };
            indices.push(index);
        }
        Some((palette, indices))
    }

    /// Mixes a colour into a pixel; what is off the picture is left out.
    fn blend(&mut self, column: i64, row: i64, colour: Colour, part: f64) {
        let (Ok(column), Ok(row)) = (usize::try_from(column), usize::try_from(row)) else { return };
        if column >= self.width || row >= self.height {
            return;
        }
        let first = 3 * (row * self.width + column);
        for (channel, value) in self.pixels[first..first + 3].iter_mut().zip(colour) {
            let mixed = f64::from(*channel) + part * (f64::from(value) - f64::from(*channel));
            *channel = mixed.round() as u8;
        }
    }
}

/// The pixels from one place to another, as far as there are any.
fn pixels(start: f64, end: f64, count: usize) -> std::ops::Range<usize> {
    start.max(0.0) as usize..(end.max(0.0).ceil() as usize).min(count)
}

/// Distance of a place from a stretch between two others.
fn distance(place: (f64, f64), one: (f64, f64), other: (f64, f64)) -> f64 {
    let (along_x, along_y) = (other.0 - one.0, other.1 - one.1);
    let length_squared = along_x * along_x + along_y * along_y;
    let dot = (place.0 - one.0) * along_x + (place.1 - one.1) * along_y;
    let part = if length_squared > 0.0 { (dot / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (place.0 - one.0 - part * along_x).hypot(place.1 - one.1 - part * along_y)
}
