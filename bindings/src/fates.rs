//! What becomes of free motions: start states in, one row per start out.

use crate::arrays::{refused, table, vector, Array2};
use crate::problem::Problem;
use crate::watch::{given_up, watched};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::motion::{self, Fate, FateSettings, Reason};

/// What becomes of some starts.
#[pyclass(frozen, module = "stickslip._core")]
pub struct Fates {
    inner: Vec<Option<Fate>>,
    dofs: usize,
    states: usize,
    #[pyo3(get)]
    interrupted: bool,
    /// Wall-clock time [s].
    #[pyo3(get)]
    seconds: f64,
}

impl Fates {
    fn column<'py, T: numpy::Element + Clone>(
        &self,
        py: Python<'py>,
        missing: T,
        of: impl Fn(&Fate) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        let values: Vec<T> =
            self.inner.iter().map(|fate| fate.as_ref().map_or(missing.clone(), &of)).collect();
        vector(py, values)
    }

    fn rows<'py>(
        &self,
        py: Python<'py>,
        columns: usize,
        of: impl Fn(&Fate) -> &[f64],
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mut values = Vec::with_capacity(self.inner.len() * columns);
        for fate in &self.inner {
            match fate {
                Some(fate) => values.extend_from_slice(of(fate)),
                None => values.resize(values.len() + columns, f64::NAN),
            }
        }
        table(py, self.inner.len(), columns, values)
    }
}

#[pymethods]
impl Fates {
    /// (n,) codes of the reasons, in the order of `Reason` in Python.
    #[getter]
    fn reason<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        self.column(py, code(Reason::Interrupted), |fate| code(fate.reason))
    }

    #[getter]
    fn mode<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.column(py, -1, |fate| {
            fate.mode.and_then(|mode| i64::try_from(mode).ok()).unwrap_or(-1)
        })
    }

    #[getter]
    fn share<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, f64::NAN, |fate| fate.share)
    }

    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, f64::NAN, |fate| fate.omega)
    }

    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, f64::NAN, |fate| fate.time)
    }

    #[getter]
    fn events<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.column(py, 0, |fate| i64::try_from(fate.events).unwrap_or(i64::MAX))
    }

    #[getter]
    fn amplitude<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.dofs, |fate| &fate.amplitude)
    }

    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.states, |fate| &fate.state)
    }
}

/// How it is found out what becomes of a motion.
#[derive(FromPyObject)]
pub struct ClassifySettings {
    periods: usize,
    tolerance: f64,
}

/// Follows free motions from start states, one per row, until it is decided what becomes of them.
#[pyfunction]
pub fn fates(
    py: Python<'_>,
    problem: &Problem,
    starts: Array2<'_, f64>,
    settings: ClassifySettings,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Fates> {
    let starts: Vec<Vec<f64>> =
        starts.as_array().outer_iter().map(|row| row.iter().copied().collect()).collect();
    let ClassifySettings { periods, tolerance } = settings;
    let settings = FateSettings { periods, tolerance };
    let model = &problem.model;
    let began = std::time::Instant::now();
    let own = Arc::clone(model);
    let (inner, raised) = watched(py, progress.as_ref(), move |look| {
        motion::fates(&own, settings, &starts, threads, look)
    })?;
    raised.raise_unless_interrupt(py)?;
    let inner = inner.ok_or_else(given_up)?.map_err(refused)?;
    let interrupted = inner
        .iter()
        .any(|fate| fate.as_ref().is_none_or(|fate| fate.reason == Reason::Interrupted));
    let dofs = model.compliance().dofs();
    let states = model.states();
    Ok(Fates { inner, dofs, states, interrupted, seconds: began.elapsed().as_secs_f64() })
}

fn code(reason: Reason) -> u8 {
    match reason {
        Reason::Held => 0,
        Reason::Passive => 1,
        Reason::Closed => 2,
        Reason::Wanders => 3,
        Reason::Outgrown => 4,
        Reason::Overflow => 5,
        Reason::Settling => 6,
        Reason::Growing => 7,
        Reason::Falling => 8,
        Reason::Monotone => 9,
        Reason::Contradiction => 10,
        Reason::Interrupted => 11,
    }
}
