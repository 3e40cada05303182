//! PNG files, drawn at a higher resolution and then reduced.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use plotters::prelude::{BitMapBackend, IntoDrawingArea};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontTransform,
    rasterizer,
};

use super::style::{Scale, load_font};
use super::{Area, DrawError, Drawn};

/// Units per pixel in both directions, averaged to smooth the edges of lines and letters.
const UNITS: usize = 2;
const SCALE: Scale = Scale(UNITS as u32);
/// Number of grey levels: enough for the edges of letters, few enough for a palette.
const GREYS: u32 = 17;
/// Number of levels of each channel along edges of colours: a pixel has four units, of which 0 to 4 are covered.
const EDGE_LEVELS: u32 = 5;
/// Smallest difference between colours, in a channel, that have an edge. Others are steps of the same colour scale.
const EDGE_MIN: u8 = 64;
/// Vertical offset by which plotters draws letters too high, as a fraction of their size: their box ends at 1/1.24 of
/// it, with the baseline in the middle of the size.
const TOO_HIGH: f64 = 0.2;

/// Draws a picture of the given size in pixels, and encodes it.
pub(super) fn encoded(
    (width, height): (u32, u32),
    draw: impl FnOnce(&Area<Bitmap>, Scale) -> Drawn,
) -> Result<Vec<u8>, DrawError> {
    load_font()?;
    let (fine_width, fine_height) = (SCALE.px(width), SCALE.px(height));
    let mut fine = vec![255; 3 * fine_width as usize * fine_height as usize];
    {
        let backend = BitMapBackend::with_buffer(&mut fine, (fine_width, fine_height));
        draw(&Bitmap(backend).into_drawing_area(), SCALE)?;
    }
    let pixels = reduced(&fine, width as usize);
    encode(&pixels, (width, height)).map_err(|error| DrawError::new(&error))
}

/// Averages squares of units into pixels.
fn reduced(fine: &[u8], width: usize) -> Vec<[u8; 3]> {
    let mut pixels = Vec::with_capacity(fine.len() / (3 * UNITS * UNITS));
    // Most squares are like the one before.
    let mut last = None;
    let units = fine.as_chunks::<3>().0;
    for rows in units.chunks_exact(width * UNITS * UNITS) {
        let (upper, lower) = rows.split_at(width * UNITS);
        let squares = upper.as_chunks::<UNITS>().0.iter().zip(lower.as_chunks::<UNITS>().0);
        pixels.extend(squares.map(|square| match last {
            Some((before, pixel)) if before == square => pixel,
            _ => {
                let ([a, b], [c, d]) = square;
                let pixel = average([*a, *b, *c, *d]);
                last = Some((square, pixel));
                pixel
            }
        }));
    }
    pixels
}

/// The colour of a pixel: the average of its units along edges and in greys, rounded to few levels, and otherwise the
/// first of them. So the colour scale, edges and greys of a map are at most 256 colours, a palette.
fn average(units: [[u8; 3]; UNITS * UNITS]) -> [u8; 3] {
    const COUNT: u32 = (UNITS * UNITS) as u32;
    let [first, ..] = units;
    let channel = |channel: usize| units.map(|unit| unit[channel]);
    let channels = [channel(0), channel(1), channel(2)];
    let average = channels.map(|values| (values.into_iter().map(u32::from).sum::<u32>() + COUNT / 2) / COUNT);
    let has_edge = channels.iter().any(|values| {
        let (low, high) = values.iter().fold((u8::MAX, 0), |(low, high), value| (low.min(*value), high.max(*value)));
        high - low >= EDGE_MIN
    });
    let levels = match average {
        [red, green, blue] if red == green && green == blue => GREYS,
        _ if has_edge => EDGE_LEVELS,
        _ => return first,
    };
    average.map(|value| {
        let steps = levels - 1;
        let level = (value * steps + 127) / 255;
        ((level * 255 + steps / 2) / steps) as u8
    })
}

/// Encodes a PNG file, with a palette and one byte per pixel if there are few colours.
fn encode(pixels: &[[u8; 3]], (width, height): (u32, u32)) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let bytes = if let Some((palette, indices)) = indexed(pixels) {
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette.concat());
        encoder.set_filter(png::Filter::NoFilter);
        indices
    } else {
        encoder.set_color(png::ColorType::Rgb);
        pixels.concat()
    };
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&bytes)?;
    writer.finish()?;
    Ok(file)
}

/// The palette in order of first appearance, and the palette index of each pixel; `None` for more than 256 colours.
fn indexed(pixels: &[[u8; 3]]) -> Option<(Vec<[u8; 3]>, Vec<u8>)> {
    let mut palette: Vec<[u8; 3]> = Vec::new();
    let mut numbers: HashMap<u32, u8, BuildHasherDefault<ColourHasher>> = HashMap::default();
    let mut indices = Vec::with_capacity(pixels.len());
    let mut last = None;
    for pixel in pixels {
        let index = match last {
            Some((before, index)) if before == pixel => index,
            _ => {
                let [red, green, blue] = *pixel;
                *numbers.entry(u32::from_be_bytes([0, red, green, blue])).or_insert_with(|| {
                    palette.push(*pixel);
                    // At the 257th colour, the index is wrong, and the palette is discarded.
                    (palette.len() - 1) as u8
                })
            }
        };
        if palette.len() > 256 {
            return None;
        }
        last = Some((pixel, index));
        indices.push(index);
    }
    Some((palette, indices))
}

/// A fast multiplicative hasher of colours, which are many and not chosen by an attacker.
#[derive(Default)]
struct ColourHasher(u64);

impl Hasher for ColourHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.write_u32(u32::from(*byte));
        }
    }

    fn write_u32(&mut self, colour: u32) {
        // The odd number nearest to 2^64 over the golden ratio spreads small differences over all bits.
        self.0 = (self.0 ^ u64::from(colour)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}

/// The bitmap backend of plotters, corrected to draw letters at the same height as an SVG viewer, and rectangles with
/// their right and lower edges.
pub(super) struct Bitmap<'b>(BitMapBackend<'b>);

impl<'b> DrawingBackend for Bitmap<'b> {
    type ErrorType = <BitMapBackend<'b> as DrawingBackend>::ErrorType;

    fn get_size(&self) -> (u32, u32) {
        self.0.get_size()
    }

    fn ensure_prepared(&mut self) -> Result<(), DrawingErrorKind<Self::ErrorType>> {
        self.0.ensure_prepared()
    }

    fn present(&mut self) -> Result<(), DrawingErrorKind<Self::ErrorType>> {
        self.0.present()
    }

    fn draw_pixel(
        &mut self,
        place: BackendCoord,
        colour: BackendColor,
    ) -> Result<(), DrawingErrorKind<Self::ErrorType>> {
        self.0.draw_pixel(place, colour)
    }

    /// Draws a horizontal line at once, since backgrounds and rectangles consist of them.
    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Result<(), DrawingErrorKind<Self::ErrorType>> {
        if from.1 == to.1 && style.stroke_width() == 1 && style.color().alpha >= 1.0 {
            return self.0.draw_line((from.0.min(to.0), from.1), (from.0.max(to.0), to.1), style);
        }
        rasterizer::draw_line(self, from, to, style)
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        (x, y): BackendCoord,
    ) -> Result<(), DrawingErrorKind<Self::ErrorType>> {
        let shift = (TOO_HIGH * style.size()).round() as i32;
        let place = match style.transform() {
            FontTransform::None => (x, y + shift),
            FontTransform::Rotate90 => (x - shift, y),
            FontTransform::Rotate180 => (x, y - shift),
            FontTransform::Rotate270 => (x + shift, y),
        };
        self.0.draw_text(text, style, place)
    }

    fn blit_bitmap(
        &mut self,
        place: BackendCoord,
        size: (u32, u32),
        pixels: &[u8],
    ) -> Result<(), DrawingErrorKind<Self::ErrorType>> {
        self.0.blit_bitmap(place, size, pixels)
    }
}
