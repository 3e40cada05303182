//! Interruption of long work.

use std::ops::ControlFlow;

/// Function that long work calls many times a second, from several threads if it has them. When it breaks, the work
/// ends there.
pub type GoesOn<'a> = &'a (dyn Fn() -> ControlFlow<()> + Sync);

/// Lets all work go on to its end.
pub const TO_THE_END: GoesOn<'static> = &|| ControlFlow::Continue(());
