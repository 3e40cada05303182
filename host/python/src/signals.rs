//! Runs long work without the GIL, interruptible by Ctrl-C.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use frixel_play::{GoesOn, break_if};
use pyo3::prelude::*;

/// Interval between checks of Python's signals.
pub(crate) const SIGNALS_PERIOD: Duration = Duration::from_millis(50);

/// The exception of a pending signal, such as that of Ctrl-C.
pub(crate) fn raised_by_signal() -> Option<PyErr> {
    #[allow(clippy::redundant_closure_for_method_calls, reason = "the method is of one lifetime only")]
    let checked = Python::attach(|py| py.check_signals());
    checked.err()
}

/// Values between two checks of Python's signals, which take at most a tenth of a second.
const CHUNK: usize = 4096;

/// Maps values until one fails or a signal is pending. Unlike [`interruptible`], starts no thread, which would cost
/// more than a few values.
pub(crate) fn mapped<T: Sync, U: Send, E: Send>(
    py: Python<'_>,
    values: &[T],
    each: impl Fn(&T) -> Result<U, E> + Sync,
) -> PyResult<Result<Vec<U>, E>> {
    let mut mapped = Vec::with_capacity(values.len());
    for chunk in values.chunks(CHUNK) {
        py.check_signals()?;
        match py.detach(|| chunk.iter().map(&each).collect::<Result<Vec<U>, E>>()) {
            Ok(part) => mapped.extend(part),
            Err(error) => return Ok(Err(error)),
        }
    }
    Ok(Ok(mapped))
}

/// Runs `work` in another thread, while this thread checks Python's signals. On a signal, the [`GoesOn`] that `work`
/// gets breaks, and the result is the exception of the signal.
pub(crate) fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce(GoesOn<'_>) -> T + Send) -> PyResult<T> {
    let is_interrupted = AtomicBool::new(false);
    let goes_on = || break_if(is_interrupted.load(Ordering::Relaxed));
    py.detach(|| {
        thread::scope(|scope| {
            let (done, ended) = channel();
            let working = scope.spawn(move || {
                let result = work(&goes_on);
                drop(done);
                result
            });
            let mut signal = None;
            while signal.is_none() && ended.recv_timeout(SIGNALS_PERIOD) == Err::<(), _>(RecvTimeoutError::Timeout) {
                signal = raised_by_signal();
            }
            is_interrupted.store(signal.is_some(), Ordering::Relaxed);
            let result = working.join().unwrap_or_else(|panic| resume_unwind(panic));
            signal.map_or(Ok(result), Err)
        })
    })
}
