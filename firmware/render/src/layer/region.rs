//! Where a layer acts.

use frixel_wire::scene::Region as Record;

/// A region, ready to be tested. Left and top edge belong to it, right and bottom do not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Region {
    Screen,
    Rectangle { left_m: f32, top_m: f32, right_m: f32, bottom_m: f32 },
}

impl Region {
    pub(super) fn new(record: Record) -> Self {
        match record {
            Record::Screen => Self::Screen,
            Record::Rectangle { x_m, y_m, width_m, height_m } => {
                Self::Rectangle { left_m: x_m, top_m: y_m, right_m: x_m + width_m, bottom_m: y_m + height_m }
            }
        }
    }

    #[inline]
    pub(super) fn contains(&self, x_m: f32, y_m: f32) -> bool {
        match *self {
            Self::Screen => true,
            Self::Rectangle { left_m, top_m, right_m, bottom_m } => {
                x_m >= left_m && x_m < right_m && y_m >= top_m && y_m < bottom_m
            }
        }
    }
}
