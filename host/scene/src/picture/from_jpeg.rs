//! JPEG files, baseline and progressive.

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::orientation::Orientation;
use super::{COLOUR, PIXELS_MAX, Picture, PictureError, STEP, luma, refuse_too_large};

/// The first bytes of every JPEG file: start of image, and the start of a marker (ITU-T T.81, section B.2.1).
pub(super) const SIGNATURE: &[u8] = &[0xff, 0xd8, 0xff];

/// Decodes the bytes of a JPEG file.
pub(super) fn decode(jpeg: &[u8], pixels_max: usize) -> Result<Picture, PictureError> {
    let damaged = |error: zune_jpeg::errors::DecodeErrors| {
        let words = format!("{error:?}");
        PictureError::Damaged(words.split_whitespace().collect::<Vec<_>>().join(" "))
    };
    // Strict mode rejects a truncated picture, whose rest would be flat.
    let options = DecoderOptions::new_safe().set_max_width(PIXELS_MAX).set_max_height(PIXELS_MAX).set_strict_mode(true);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(jpeg), options);
    decoder.decode_headers().map_err(damaged)?;
    let size = decoder.info().ok_or_else(|| PictureError::Damaged("it has no size".to_owned()))?;
    let (width, height) = (usize::from(size.width), usize::from(size.height));
    refuse_too_large(width, height, pixels_max)?;
    let colour = match decoder.input_colorspace() {
        Some(ColorSpace::Luma) => ColorSpace::Luma,
        Some(ColorSpace::CMYK | ColorSpace::YCCK) => return Err(PictureError::Inks),
        _ => ColorSpace::RGB,
    };
    decoder.set_options(options.jpeg_set_out_colorspace(colour));
    let bytes = decoder.decode().map_err(damaged)?;
    let orientation = Orientation::of(decoder.exif().map(Vec::as_slice));
    let mut coloured = false;
    let grey: Vec<f32> = if colour == ColorSpace::Luma {
        bytes.into_iter().map(f32::from).collect()
    } else {
        let pixels = bytes.chunks_exact(3).map(|pixel| {
            let at = |channel: usize| u16::from_be_bytes([pixel.get(channel).copied().unwrap_or_default(); 2]);
            let [red, green, blue] = [at(0), at(1), at(2)];
            coloured |= red != green || green != blue;
            luma([red, green, blue]) / STEP
        });
        pixels.collect()
    };
    if grey.len() != width * height {
        return Err(PictureError::Damaged("pixels are missing".to_owned()));
    }
    let conversions = if coloured { vec![COLOUR.to_owned()] } else { Vec::new() };
    Ok(orientation.upright(Picture { width, height, grey, white_below: Vec::new(), conversions }))
}
