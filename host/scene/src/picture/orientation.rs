//! Orientation of a photograph: the EXIF tag `Orientation` (CIPA DC-008, section 4.6.5; TIFF 6.0, tag 274).

use exif::{In, Reader, Tag};

use super::Picture;

/// The note about a rotated picture.
const UPRIGHT: &str = "turned upright, as its camera noted (EXIF)";

/// Position of a file's pixels in the picture that the camera saw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Orientation {
    /// Rows of the picture are columns of the file.
    swapped: bool,
    /// The file's columns run from right to left.
    from_right: bool,
    /// The file's rows run from bottom to top.
    from_bottom: bool,
}

impl Orientation {
    /// Reads the orientation from an EXIF block that starts at its TIFF header. Defaults to upright if it is absent or
    /// unreadable.
    pub(super) fn of(exif: Option<&[u8]>) -> Self {
        let read = |exif: &[u8]| Reader::new().read_raw(exif.to_vec()).ok();
        let number =
            exif.and_then(read).and_then(|exif| exif.get_field(Tag::Orientation, In::PRIMARY)?.value.get_uint(0));
        let (swapped, from_right, from_bottom) = match number {
            Some(2) => (false, true, false),
            Some(3) => (false, true, true),
            Some(4) => (false, false, true),
            Some(5) => (true, false, false),
            Some(6) => (true, false, true),
            Some(7) => (true, true, true),
            Some(8) => (true, true, false),
            _ => (false, false, false),
        };
        Self { swapped, from_right, from_bottom }
    }

    /// The picture that the camera saw.
    pub(super) fn upright(self, picture: Picture) -> Picture {
        if self == Self::default() {
            return picture;
        }
        let (file_width, file_height) = (picture.width, picture.height);
        let (width, height) = if self.swapped { (file_height, file_width) } else { (file_width, file_height) };
        let pixel = |place: usize| {
            let (x, y) = (place % width, place / width);
            let (column, row) = if self.swapped { (y, x) } else { (x, y) };
            let column = if self.from_right { file_width - 1 - column } else { column };
            let row = if self.from_bottom { file_height - 1 - row } else { row };
            row * file_width + column
        };
        let upright = |values: &[f32]| -> Vec<f32> {
            // An opaque picture has no ground contribution.
            let count = if values.is_empty() { 0 } else { width * height };
            (0..count).map(|place| values.get(pixel(place)).copied().unwrap_or_default()).collect()
        };
        let (grey, white_below) = (upright(&picture.grey), upright(&picture.white_below));
        let conversions = picture.conversions.iter().cloned().chain([UPRIGHT.to_owned()]).collect();
        Picture { width, height, grey, white_below, conversions }
    }
}
