//! Progress out of the core, Ctrl-C into it.

use pyo3::prelude::*;
use std::cell::{Cell, RefCell};
use std::time::{Duration, Instant};

/// Time between two looks at Python: often enough for Ctrl-C, rare enough to cost nothing.
const LOOK: Duration = Duration::from_millis(100);

/// Looks at Python from time to time while the core works: progress out, Ctrl-C in.
pub struct Watch<'a> {
    progress: Option<&'a Py<PyAny>>,
    last: Cell<Instant>,
    pub raised: RefCell<Option<PyErr>>,
}

impl<'a> Watch<'a> {
    pub fn new(progress: Option<&'a Py<PyAny>>) -> Self {
        Self { progress, last: Cell::new(Instant::now()), raised: RefCell::new(None) }
    }

    /// `false` once an exception is pending.
    pub fn look(&self, share: f64) -> bool {
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
