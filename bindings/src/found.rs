//! Results of which the columns are written while nobody waits for them.

use crate::columns::Columns;
use crate::watch::{look, LOOK};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use std::mem::replace;
use std::sync::mpsc::{sync_channel, Receiver, RecvTimeoutError};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What an analysis has found. Gigabytes of points take seconds to become columns: a thread that knows no
/// Python writes them, so that Ctrl-C is heard meanwhile, and whoever asks for them waits.
#[pyclass(frozen)]
pub struct Found {
    /// Whether the analysis was ended before it was through.
    #[pyo3(get)]
    interrupted: bool,
    /// How many points were computed, if that is known.
    #[pyo3(get)]
    computed: Option<usize>,
    columns: Mutex<Written>,
    solution: PyOnceLock<Py<PyAny>>,
}

enum Written {
    Soon(Receiver<PyResult<Columns>>),
    Now(PyResult<Columns>),
    Taken,
}

impl Found {
    /// Of an analysis whose columns `write` writes.
    pub fn new(
        interrupted: bool,
        computed: Option<usize>,
        write: impl FnOnce() -> PyResult<Columns> + Send + 'static,
    ) -> PyResult<Self> {
        // There is room for them: nobody may ever ask.
        let (sender, receiver) = sync_channel(1);
        std::thread::Builder::new().spawn(move || drop(sender.send(write())))?;
        let columns = Mutex::new(Written::Soon(receiver));
        Ok(Self { interrupted, computed, columns, solution: PyOnceLock::new() })
    }

    /// Of an analysis that has come to its end, or else comes to it by itself: see [`crate::watch::found`].
    /// `told` says whether it was ended early, and how many points there are.
    pub fn of<T: Send + 'static>(
        found: Result<T, impl FnOnce() -> PyResult<T> + Send + 'static>,
        told: impl FnOnce(&T) -> (bool, usize),
        write: impl FnOnce(T) -> Columns + Send + 'static,
    ) -> PyResult<Self> {
        match found {
            Ok(found) => {
                let (interrupted, computed) = told(&found);
                Self::new(interrupted, Some(computed), move || Ok(write(found)))
            }
            Err(end) => Self::new(true, None, move || Ok(write(end()?))),
        }
    }

    fn columns(&self) -> MutexGuard<'_, Written> {
        self.columns.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits a moment, and tells whether the columns are written.
    fn is_written(&self) -> PyResult<bool> {
        let mut columns = self.columns();
        if let Written::Soon(receiver) = &*columns {
            match receiver.recv_timeout(LOOK) {
                Ok(written) => *columns = Written::Now(written),
                Err(RecvTimeoutError::Timeout) => return Ok(false),
                Err(RecvTimeoutError::Disconnected) => return Err(lost()),
            }
        }
        Ok(true)
    }
}

#[pymethods]
impl Found {
    /// An object with the columns and all that was told. Ctrl-C, and what `progress` raises, end the wait for
    /// them, not their writing: they can be asked for again.
    fn solution<'py>(
        &self,
        py: Python<'py>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        while !py.detach(|| self.is_written())? {
            look(progress.as_ref(), 1.0)?;
        }
        let solution = self.solution.get_or_try_init(py, || {
            let written = replace(&mut *self.columns(), Written::Taken);
            match written {
                Written::Now(Ok(columns)) => Ok(columns.end(py)?.unbind()),
                Written::Now(Err(error)) => {
                    // Whoever asks again is told the same.
                    *self.columns() = Written::Now(Err(error.clone_ref(py)));
                    Err(error)
                }
                Written::Soon(_) | Written::Taken => Err(lost()),
            }
        });
        Ok(solution?.bind(py).clone())
    }
}

fn lost() -> PyErr {
    PyRuntimeError::new_err("the columns of a result were not written, a defect of stickslip")
}
