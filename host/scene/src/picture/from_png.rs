//! PNG files of any colour type.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, Limits, OutputInfo, Transformations};

use super::orientation::Orientation;
use super::{COLOUR, PIXELS_MAX, Picture, PictureError, STEP, WHITE, luma, refuse_too_large};

/// The first eight bytes of every PNG file (W3C PNG specification, section 5.2).
pub(super) const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Decodes the bytes of a PNG file.
pub(super) fn decode(png: &[u8], pixels_max: usize) -> Result<Picture, PictureError> {
    let damaged = |error: png::DecodingError| PictureError::Damaged(error.to_string());
    let mut reader = decoder(png).read_info().map_err(damaged)?;
    let (width, height) = reader.info().size();
    refuse_too_large(width as usize, height as usize, pixels_max)?;
    let size = reader.output_buffer_size().ok_or_else(|| PictureError::Damaged("it has no size".to_owned()))?;
    let mut bytes = vec![0; size];
    let frame = reader.next_frame(&mut bytes).map_err(damaged)?;
    // The orientation may follow the pixels. Damage there does not matter to them.
    let _ = reader.finish();
    let orientation = Orientation::of(reader.info().exif_metadata.as_deref());
    Ok(orientation.upright(grey(&bytes, &frame)))
}

/// A decoder that skips unused chunks: a colour profile or a text can unpack to a thousand times its size.
fn decoder(png: &[u8]) -> Decoder<Cursor<&[u8]>> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(png), Limits { bytes: 8 * PIXELS_MAX });
    // Expands palettes to colours, fewer bits than eight to eight, and a transparent colour to an alpha channel.
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_iccp_chunk(true);
    decoder.set_ignore_text_chunk(true);
    decoder
}

fn grey(bytes: &[u8], frame: &OutputInfo) -> Picture {
    let wide = frame.bit_depth == BitDepth::Sixteen;
    let channels = frame.color_type.samples();
    let mut coloured = false;
    let mut transparent = false;
    let mut grey = Vec::with_capacity(frame.width as usize * frame.height as usize);
    let mut white_below = Vec::new();
    for pixel in bytes.chunks_exact(if wide { 2 * channels } else { channels }) {
        let at = |channel: usize| sample(pixel, channel, wide);
        let (value, alpha) = match frame.color_type {
            ColorType::Grayscale | ColorType::Indexed => (f32::from(at(0)), WHITE),
            ColorType::GrayscaleAlpha => (f32::from(at(0)), at(1)),
            ColorType::Rgb => (luma([at(0), at(1), at(2)]), WHITE),
            ColorType::Rgba => (luma([at(0), at(1), at(2)]), at(3)),
        };
        coloured |= channels > 2 && (at(0) != at(1) || at(1) != at(2));
        let opacity = f32::from(alpha) / f32::from(WHITE);
        if alpha < WHITE && !transparent {
            transparent = true;
            white_below.resize(grey.len(), 0.0);
        }
        if transparent {
            white_below.push(f32::from(u8::MAX) * (1.0 - opacity));
        }
        grey.push(value / STEP * opacity);
    }
    let said = [(coloured, COLOUR), (wide, "16 bits a sample rounded to 8")];
    let conversions = said.iter().filter(|(done, _)| *done).map(|(_, text)| (*text).to_owned()).collect();
    Picture { width: frame.width as usize, height: frame.height as usize, grey, white_below, conversions }
}

/// A channel of a pixel, in 16 bits.
fn sample(pixel: &[u8], channel: usize, wide: bool) -> u16 {
    let byte = |index: usize| pixel.get(index).copied().unwrap_or_default();
    if wide {
        u16::from_be_bytes([byte(2 * channel), byte(2 * channel + 1)])
    } else {
        u16::from_be_bytes([byte(channel), byte(channel)])
    }
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use png::{Encoder, Info};

    use super::*;

    /// 2 MB of such a chunk took 534 MB.
    #[test]
    fn a_colour_profile_in_a_picture_is_not_unpacked() {
        let mut info = Info::with_size(2, 1);
        (info.color_type, info.bit_depth) = (ColorType::Grayscale, BitDepth::Eight);
        info.icc_profile = Some(Cow::Owned(vec![0; 1 << 20]));
        let mut png = Vec::new();
        let mut writer = Encoder::with_info(&mut png, info).unwrap().write_header().unwrap();
        writer.write_image_data(&[0, 255]).unwrap();
        writer.finish().unwrap();
        assert!(png.windows(4).any(|name| name == b"iCCP"));
        assert_eq!(decoder(&png).read_info().unwrap().info().icc_profile, None);
        assert!(decode(&png, PIXELS_MAX).is_ok());
    }
}
