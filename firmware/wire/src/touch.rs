//! A report of the touch source, used on the wire and by the tracker.

/// One report of the touch source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Touch {
    /// A finger is on the screen.
    Down {
        /// Distance from the left edge of the screen, m.
        x_m: f32,
        /// Distance from the top edge of the screen, m.
        y_m: f32,
        /// Ticks since the position was measured, as stated by the source.
        age_ticks: u32,
    },
    /// No finger is on the screen.
    Up,
}
