//! Pictures: PNG and JPEG files, read as grey.

mod from_jpeg;
mod from_png;
mod orientation;
#[cfg(test)]
mod tests;

use thiserror::Error;

use super::file_kind::{FileKind, WrongKind};

/// Largest number of pixels in a picture, and in all pictures of a scene: 64 million, whose grey values take at most
/// 256 MiB.
pub(super) const PIXELS_MAX: usize = SQUARE_MAX * SQUARE_MAX;
/// Side of a square picture of that size, in pixels.
const SQUARE_MAX: usize = 1 << 13;
/// Weights of red, green and blue in grey (luma of ITU-R BT.709).
const LUMA: [f32; 3] = [0.2126, 0.7152, 0.0722];
/// The largest sample of 16 bits.
const WHITE: u16 = u16::MAX;
/// An 8-bit step in 16-bit steps.
const STEP: f32 = 257.0;
/// The note about a picture converted to grey.
const COLOUR: &str = "colour turned to grey by luma";
/// Reciprocal of the fraction of samples that `levels = "stretch"` clips to black, and to white.
const STRETCHED_PART: usize = 100;

/// A picture as grey values from 0 (black) to 255 (white), row after row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) grey: Vec<f32>,
    /// Contribution of a white ground to each grey value; empty for an opaque picture. The grey values are those over
    /// black.
    pub(super) white_below: Vec<f32>,
    /// The conversions to grey, as text for a person.
    pub(super) conversions: Vec<String>,
}

/// The ground behind a transparent picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Ground {
    #[default]
    Black,
    White,
}

/// The reason why a picture cannot be used.
#[derive(Debug, Error)]
pub(super) enum PictureError {
    #[error("it is neither a PNG nor a JPEG file: save it as PNG")]
    UnknownFormat,
    #[error(transparent)]
    WrongKind(#[from] WrongKind),
    #[error("it is damaged ({0}): save it again")]
    Damaged(String),
    #[error("its colours are inks (CMYK): save it as RGB or grey")]
    Inks,
    #[error("it has {width} x {height} pixels, more than {SQUARE_MAX} x {SQUARE_MAX}: make it smaller")]
    TooLarge { width: usize, height: usize },
    #[error(
        "it has {width} x {height} pixels, and the pictures of a scene have at most {PIXELS_MAX} together: make them smaller"
    )]
    TooLargeTogether { width: usize, height: usize },
}

/// Checks the bytes of a picture before a scene names it. Returns its width and height in pixels, as played: a
/// photograph is upright.
///
/// # Errors
///
/// Fails if the picture cannot be played. The text, a sentence without a subject, states the reason and what to do.
pub fn check_picture(bytes: &[u8]) -> Result<(usize, usize), String> {
    Picture::decode(bytes, PIXELS_MAX).map(|picture| (picture.width, picture.height)).map_err(|error| error.to_string())
}

/// Whether bytes begin as a PNG or JPEG file does.
pub(crate) fn is_picture(bytes: &[u8]) -> bool {
    bytes.starts_with(from_png::SIGNATURE) || bytes.starts_with(from_jpeg::SIGNATURE)
}

impl Picture {
    /// Decodes the bytes of a PNG or JPEG file of at most `pixels_max` pixels.
    pub(super) fn decode(bytes: &[u8], pixels_max: usize) -> Result<Self, PictureError> {
        if bytes.starts_with(from_png::SIGNATURE) {
            from_png::decode(bytes, pixels_max)
        } else if bytes.starts_with(from_jpeg::SIGNATURE) {
            from_jpeg::decode(bytes, pixels_max)
        } else {
            FileKind::Picture.check(bytes)?;
            Err(PictureError::UnknownFormat)
        }
    }

    /// Lays the picture over black or white, and then inverts it if asked.
    pub(super) fn laid_over(mut self, ground: Ground, is_inverted: bool) -> Self {
        if !self.white_below.is_empty() {
            let word = match ground {
                Ground::Black => "black",
                Ground::White => "white",
            };
            self.conversions.push(format!("transparency laid over {word}"));
        }
        let white_below = std::mem::take(&mut self.white_below);
        if ground == Ground::White {
            for (grey, added) in self.grey.iter_mut().zip(white_below) {
                *grey += added;
            }
        }
        if is_inverted {
            for grey in &mut self.grey {
                *grey = f32::from(u8::MAX) - *grey;
            }
            self.conversions.push("black and white exchanged".to_owned());
        }
        self
    }

    /// Stretches the levels according to the picture's samples on a board: a hundredth of them is then black or darker,
    /// and a hundredth is white or lighter. A pixel averages a smaller area than a sample does, and may thus lie below
    /// black or above white. A picture whose samples have one grey stays as it is.
    pub(super) fn stretched(mut self, mut samples: Vec<u8>) -> Self {
        let Some(last) = samples.len().checked_sub(1) else { return self };
        let mut at = |place: usize| f32::from(*samples.select_nth_unstable(place).1);
        let (black, white) = (at(last / STRETCHED_PART), at(last - last / STRETCHED_PART));
        if white - black < 1.0 {
            self.conversions.push("of one grey, so that its levels cannot be stretched".to_owned());
            return self;
        }
        let scale = 255.0 / (white - black);
        for grey in &mut self.grey {
            *grey = (*grey - black) * scale;
        }
        self.conversions.push(format!("levels {black:.0} to {white:.0} stretched to 0 to 255"));
        self
    }
}

pub(super) fn refuse_too_large(width: usize, height: usize, pixels_max: usize) -> Result<(), PictureError> {
    match width.saturating_mul(height) {
        pixels if pixels > PIXELS_MAX => Err(PictureError::TooLarge { width, height }),
        pixels if pixels > pixels_max => Err(PictureError::TooLargeTogether { width, height }),
        _ => Ok(()),
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
