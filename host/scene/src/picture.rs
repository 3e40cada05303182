//! Pictures: PNG files of any colour type, read as grey.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, DecodingError, Limits, OutputInfo, Transformations};
use thiserror::Error;

/// Largest number of pixels of a picture: 64 million, so that its grey values take at most 256 MiB.
const PIXELS_MAX: u64 = 1 << 26;
/// The first eight bytes of every PNG file (W3C PNG specification, section 5.2).
const PNG_SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Weights of red, green and blue in grey (luma of ITU-R BT.709).
const LUMA: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// A picture as grey values from 0 (black) to 255 (white), row after row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) grey: Vec<f32>,
    /// The conversions to grey, as text for a person.
    pub(super) conversions: Vec<&'static str>,
}

/// The reason why a picture cannot be used.
#[derive(Debug, Error)]
pub(super) enum PictureError {
    #[error("it is not a PNG file: save it as PNG")]
    NotPng,
    #[error("it is damaged ({0}): save it again")]
    Damaged(DecodingError),
    #[error("it has {width} x {height} pixels, and at most {PIXELS_MAX} are read: make it smaller")]
    TooLarge { width: u32, height: u32 },
}

impl Picture {
    /// Decodes the bytes of a PNG file.
    pub(super) fn decode(png: &[u8]) -> Result<Self, PictureError> {
        if !png.starts_with(PNG_SIGNATURE) {
            return Err(PictureError::NotPng);
        }
        let limits = Limits { bytes: 8 * PIXELS_MAX as usize };
        let mut decoder = Decoder::new_with_limits(Cursor::new(png), limits);
        // Expands palettes to colours, fewer bits than eight to eight, and a transparent colour to an alpha channel.
        decoder.set_transformations(Transformations::EXPAND);
        let mut reader = decoder.read_info().map_err(PictureError::Damaged)?;
        let (width, height) = reader.info().size();
        let too_large = PictureError::TooLarge { width, height };
        if u64::from(width) * u64::from(height) > PIXELS_MAX {
            return Err(too_large);
        }
        let mut bytes = vec![0; reader.output_buffer_size().ok_or(too_large)?];
        let frame = reader.next_frame(&mut bytes).map_err(PictureError::Damaged)?;
        Ok(grey(&bytes, &frame))
    }
}

fn grey(bytes: &[u8], frame: &OutputInfo) -> Picture {
    let wide = frame.bit_depth == BitDepth::Sixteen;
    let channels = frame.color_type.samples();
    let mut coloured = false;
    let mut transparent = false;
    let mut grey = Vec::with_capacity(frame.width as usize * frame.height as usize);
    for pixel in bytes.chunks_exact(if wide { 2 * channels } else { channels }) {
        let at = |channel: usize| sample(pixel, channel, wide);
        let (value, alpha) = match frame.color_type {
            ColorType::Grayscale | ColorType::Indexed => (f32::from(at(0)), WHITE),
            ColorType::GrayscaleAlpha => (f32::from(at(0)), at(1)),
            ColorType::Rgb => (luma([at(0), at(1), at(2)]), WHITE),
            ColorType::Rgba => (luma([at(0), at(1), at(2)]), at(3)),
        };
        coloured |= channels > 2 && (at(0) != at(1) || at(1) != at(2));
        transparent |= alpha < WHITE;
        grey.push(value / STEP * (f32::from(alpha) / f32::from(WHITE)));
    }
    let said = [
        (coloured, "colour turned to grey"),
        (transparent, "transparency laid over black"),
        (wide, "16 bits a sample rounded to 8"),
    ];
    let conversions = said.iter().filter(|(done, _)| *done).map(|(_, text)| *text).collect();
    Picture { width: frame.width as usize, height: frame.height as usize, grey, conversions }
}

/// The largest sample of 16 bits.
const WHITE: u16 = u16::MAX;
/// A step of 8 bits in steps of 16.
const STEP: f32 = 257.0;

/// A channel of a pixel, in 16 bits.
fn sample(pixel: &[u8], channel: usize, wide: bool) -> u16 {
    let byte = |index: usize| pixel.get(index).copied().unwrap_or_default();
    if wide {
        u16::from_be_bytes([byte(2 * channel), byte(2 * channel + 1)])
    } else {
        u16::from_be_bytes([byte(channel), byte(channel)])
    }
}

/// The luma of a colour. Grey keeps its exact value.
fn luma(colour: [u16; 3]) -> f32 {
    let [red, green, blue] = colour;
    if red == green && green == blue {
        return f32::from(red);
    }
    LUMA[0] * f32::from(red) + LUMA[1] * f32::from(green) + LUMA[2] * f32::from(blue)
}
