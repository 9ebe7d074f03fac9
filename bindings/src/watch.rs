//! Progress out of the core, Ctrl-C into it.
//!
//! The core works in a thread of its own, which knows no Python. The thread that called it waits,
//! tells how far the work is and asks for signals, whatever the core is doing: a factorisation of a
//! large matrix asks nobody. Work that does not end soon after it was told to is left to itself.

use crate::arrays::refused;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use std::any::Any;
use std::convert::Infallible;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{sync_channel, Receiver, RecvTimeoutError};
use std::sync::Arc;
use std::time::{Duration, Instant};
use stickslip_core::Error;

/// Time between two looks at Python: often enough for Ctrl-C, rare enough to cost nothing.
pub const LOOK: Duration = Duration::from_millis(50);
/// Time that work has to hand over what it has computed once it was told to end: with the look
/// before it and the result to build behind it, Ctrl-C is heeded within a second.
const PATIENCE: Duration = Duration::from_millis(500);
/// Stack of the working thread, as large as that of the first one usually is.
const STACK: usize = 8 << 20;

/// What the caller and the working thread tell each other.
#[derive(Default)]
struct Line {
    stop: AtomicBool,
    /// Bits of the share of the work done.
    share: AtomicU64,
}

/// What the working thread hands over.
pub enum Word<M, T> {
    Part(M),
    End(T),
}

/// What is left of work when nobody watches it any more.
pub enum Left<M, T> {
    /// What it gives.
    Ended(T),
    /// It was left to itself: where its words come from, and the share that was done.
    Alone(Receiver<Word<M, T>>, f64),
}

impl<M, T> Left<M, T> {
    pub fn ended(self) -> Option<T> {
        match self {
            Self::Ended(value) => Some(value),
            Self::Alone(..) => None,
        }
    }
}

/// Runs `work` without the interpreter, looking at Python from time to time. Ctrl-C ends it with
/// what it has by then; `None` if it was told to end and did not.
pub fn watched<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&dyn Fn(f64) -> bool) -> Result<T, Error> + Send + 'static,
) -> PyResult<Option<T>> {
    let (left, raised) = watched_parts(py, progress, nothing, |look, _| work(look))?;
    raise_unless_interrupt(py, raised)?;
    left.ended().transpose().map_err(refused)
}

/// [`watched`] work of which a part is worth waiting for, once it has begun: what it has found, or else what
/// hands that over when its present step has ended.
pub fn found<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&dyn Fn(f64) -> bool) -> Result<T, Error> + Send + 'static,
) -> PyResult<Result<T, impl FnOnce() -> PyResult<T> + Send + 'static>> {
    let (left, raised) = watched_parts(py, progress, nothing, |look, _| work(look))?;
    raise_unless_interrupt(py, raised)?;
    match left {
        Left::Ended(value) => value.map(Ok).map_err(refused),
        Left::Alone(words, share) if share > 0.0 => Ok(Err(move || match words.recv() {
            Ok(Word::End(value)) => value.map_err(refused),
            Ok(Word::Part(never)) => match never {},
            Err(_) => Err(given_up()),
        })),
        Left::Alone(..) => Err(given_up()),
    }
}

/// [`watched`] work that keeps nothing before its end.
pub fn computed<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&dyn Fn(f64) -> bool) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    watched(py, progress, work)?.ok_or_else(given_up)
}

/// Runs `work` without progress, of which a part is worth nothing: Ctrl-C is raised.
pub fn whole<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&dyn Fn(f64) -> bool) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    followed(py, None, work)
}

/// [`whole`] work with progress: what that raises is raised, too.
pub fn followed<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&dyn Fn(f64) -> bool) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    let (left, raised) = watched_parts(py, progress, nothing, |look, _| work(look))?;
    raised.map_or(Ok(()), Err)?;
    left.ended().ok_or_else(given_up)?.map_err(refused)
}

fn nothing(_: Python<'_>, never: Infallible) -> PyResult<()> {
    match never {}
}

/// Runs `work` that hands over parts of its result, each of which `deliver` takes, and returns what
/// Python has raised meanwhile beside what is left of it.
pub fn watched_parts<M: Send + 'static, T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    mut deliver: impl FnMut(Python<'_>, M) -> PyResult<()> + Send,
    work: impl FnOnce(&dyn Fn(f64) -> bool, &dyn Fn(M) -> bool) -> T + Send + 'static,
) -> PyResult<(Left<M, T>, Option<PyErr>)> {
    let line = Arc::new(Line::default());
    // Nothing is in flight: nobody need listen to work that was left to itself.
    let (sender, receiver) = sync_channel(0);
    let own = Arc::clone(&line);
    let worker = std::thread::Builder::new().stack_size(STACK).spawn(move || {
        let look = |share: f64| {
            own.share.store(share.to_bits(), Ordering::Relaxed);
            !own.stop.load(Ordering::Relaxed)
        };
        let value = work(&look, &|part| sender.send(Word::Part(part)).is_ok());
        let _ = sender.send(Word::End(value));
    })?;
    py.detach(move || {
        let share = || f64::from_bits(line.share.load(Ordering::Relaxed));
        let alone = |receiver| Left::Alone(receiver, share());
        let mut ended: Option<(Instant, PyErr)> = None;
        let mut last = Instant::now();
        let left = loop {
            let mut asked = Ok(());
            match receiver.recv_timeout(LOOK) {
                Ok(Word::End(value)) => break Left::Ended(value),
                Ok(Word::Part(part)) if ended.is_none() => {
                    asked = Python::attach(|py| deliver(py, part));
                }
                Ok(Word::Part(_)) | Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => match worker.join() {
                    Err(panic) => return Err(defect(panic.as_ref())),
                    Ok(()) => break alone(receiver),
                },
            }
            match &ended {
                None => {
                    if asked.is_ok() && last.elapsed() >= LOOK {
                        last = Instant::now();
                        asked = look(progress.as_ref(), share());
                    }
                    if let Err(error) = asked {
                        line.stop.store(true, Ordering::Relaxed);
                        ended = Some((Instant::now(), error));
                    }
                }
                Some((since, _)) if since.elapsed() > PATIENCE => break alone(receiver),
                Some(_) => {}
            }
        };
        Ok((left, ended.map(|(_, error)| error)))
    })
}

/// The error of work that panicked. That of pyo3 is no `Exception`: it would end a study and lose what came
/// before.
fn defect(panic: &(dyn Any + Send)) -> PyErr {
    let said = panic.downcast_ref::<String>().map(String::as_str);
    let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
    PyRuntimeError::new_err(format!("panic in the core of stickslip, a defect of it: {said}"))
}

/// The error of work that was left to itself without anything to keep.
pub fn given_up() -> PyErr {
    PyKeyboardInterrupt::new_err("nothing was computed yet that could be kept")
}

/// Tells how far the work is, and asks for signals.
pub fn look(progress: Option<&Py<PyAny>>, share: f64) -> PyResult<()> {
    Python::attach(|py| {
        if let Some(call) = progress {
            call.call1(py, (share,))?;
        }
        py.check_signals()
    })
}

/// Raises what Python has raised unless it is Ctrl-C, which keeps what was solved.
pub fn raise_unless_interrupt(py: Python<'_>, raised: Option<PyErr>) -> PyResult<()> {
    match raised {
        Some(error) if !error.is_instance_of::<PyKeyboardInterrupt>(py) => Err(error),
        _ => Ok(()),
    }
}
