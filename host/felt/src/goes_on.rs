//! Interruption of long work.

use std::ops::ControlFlow;

/// Callback of long work, called many times a second, from each of its threads. A break ends the work.
pub type GoesOn<'a> = &'a (dyn Fn() -> ControlFlow<()> + Sync);

/// Breaks if the work is to end, for use in a [`GoesOn`].
pub fn break_if(is_interrupted: bool) -> ControlFlow<()> {
    if is_interrupted { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Never breaks: the work runs to its end.
pub const TO_THE_END: GoesOn<'static> = &|| ControlFlow::Continue(());
