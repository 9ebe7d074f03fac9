//! Progress out of the core, Ctrl-C into it.

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::cell::{Cell, RefCell};
use std::time::{Duration, Instant};

/// Time between two looks at Python: often enough for Ctrl-C, rare enough to cost nothing.
const LOOK: Duration = Duration::from_millis(100);

/// Looks at Python from time to time while the core works: progress out, Ctrl-C in.
pub struct Watch<'a> {
    progress: Option<&'a Py<PyAny>>,
    last: Cell<Instant>,
    raised: RefCell<Option<PyErr>>,
}

impl<'a> Watch<'a> {
    fn new(progress: Option<&'a Py<PyAny>>) -> Self {
        Self { progress, last: Cell::new(Instant::now()), raised: RefCell::new(None) }
    }

    /// Runs `work` without the interpreter, looking at it from time to time.
    pub fn during<T: Send>(
        py: Python<'_>,
        progress: Option<&'a Py<PyAny>>,
        work: impl FnOnce(&dyn Fn(f64) -> bool) -> T + Send,
    ) -> (T, Raised) {
        py.detach(|| {
            let watch = Watch::new(progress);
            let value = work(&|share| watch.look(share));
            (value, Raised(watch.raised.into_inner()))
        })
    }

    /// `false` once an exception is pending.
    fn look(&self, share: f64) -> bool {
        if self.raised.borrow().is_some() {
            return false;
        }
        if self.last.get().elapsed() < LOOK {
            return true;
        }
        self.last.set(Instant::now());
        Python::attach(|py| {
            let told = self.progress.map_or(Ok(()), |call| call.call1(py, (share,)).map(drop));
            match told.and_then(|()| py.check_signals()) {
                Ok(()) => true,
                Err(error) => {
                    self.raised.replace(Some(error));
                    false
                }
            }
        })
    }
}

/// What Python has raised meanwhile.
pub struct Raised(Option<PyErr>);

impl From<Option<PyErr>> for Raised {
    fn from(error: Option<PyErr>) -> Self {
        Self(error)
    }
}

impl Raised {
    /// Whether nothing was raised.
    pub fn is_empty(&self) -> bool {
        self.0.is_none()
    }

    /// Raises it.
    pub fn raise(self) -> PyResult<()> {
        self.0.map_or(Ok(()), Err)
    }

    /// Raises it unless it is Ctrl-C, which keeps what was solved; anything else that a progress
    /// callback raises is its own.
    pub fn raise_unless_interrupt(self, py: Python<'_>) -> PyResult<()> {
        match self.0 {
            Some(error) if !error.is_instance_of::<PyKeyboardInterrupt>(py) => Err(error),
            _ => Ok(()),
        }
    }
}
