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

/// Number of units per pixel in both directions, averaged to smooth the edges of lines and letters.
const SCALE: Scale = Scale(2);
/// Number of grey levels: enough for the edges of letters, few enough for a palette.
const GREYS: u32 = 17;
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
    let side = SCALE.px(1) as usize;
    let fine_row = 3 * width * side;
    let count = (side * side) as u32;
    let mut pixels = Vec::with_capacity(fine.len() / (3 * side * side));
    for rows in fine.chunks_exact(fine_row * side) {
        let mut sums = vec![[0_u32; 3]; width];
        for row in rows.chunks_exact(fine_row) {
            for (sums, units) in sums.iter_mut().zip(row.chunks_exact(3 * side)) {
                for unit in units.chunks_exact(3) {
                    for (sum, value) in sums.iter_mut().zip(unit) {
                        *sum += u32::from(*value);
                    }
                }
            }
        }
        pixels.extend(sums.iter().map(|sums| few_greys(sums.map(|sum| ((sum + count / 2) / count) as u8))));
    }
    pixels
}

/// Rounds a grey to one of the [`GREYS`] levels.
fn few_greys(pixel: [u8; 3]) -> [u8; 3] {
    let [red, green, blue] = pixel;
    if red != green || green != blue {
        return pixel;
    }
    let step = 255 / (GREYS - 1);
    [((u32::from(red) + step / 2) / step * step).min(255) as u8; 3]
}

/// Encodes a PNG file, with a palette and one byte per pixel if there are few colours.
fn encode(pixels: &[[u8; 3]], (width, height): (u32, u32)) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
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
