//! A report of the touch source, used on the wire and by the tracker.

/// One report of the touch source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Touch {
    /// A finger is on the screen.
    Down {
        /// From the left edge of the screen, in m.
        x_m: f32,
        /// From the top edge of the screen, in m.
        y_m: f32,
        /// Ticks since the position was measured, as far as the source knows.
        age_ticks: u32,
    },
    /// No finger is on the screen.
    Up,
}
