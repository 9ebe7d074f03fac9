//! Time integration: settings and a start state in, histories out.

use crate::arrays::{indices, refused, table, vector, Array1};
use crate::orbits::{event_columns, EventColumns};
use crate::problem::Problem;
use crate::watch::{given_up, watched};
use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use stickslip_core::motion::{self, Halt, Scheme, TransientSettings};

/// A motion from a start state.
#[pyclass(frozen, module = "stickslip._core")]
pub struct History {
    inner: motion::History,
    observed: usize,
    contacts: usize,
    states: usize,
}

impl History {
    fn rows<'py>(
        &self,
        py: Python<'py>,
        columns: usize,
        values: &[f64],
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        table(py, self.inner.trace.time.len(), columns, values.to_vec())
    }
}

#[pymethods]
impl History {
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.inner.trace.time.iter().copied())
    }

    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.observed, &self.inner.trace.displacement)
    }

    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.observed, &self.inner.trace.velocity)
    }

    #[getter]
    fn contact_displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.contacts, &self.inner.trace.contact_displacement)
    }

    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.contacts, &self.inner.trace.force)
    }

    #[getter]
    fn poincare<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let states = &self.inner.poincare;
        table(py, states.len(), self.states, states.concat())
    }

    #[getter]
    fn range<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        use numpy::PyArrayMethods as _;
        let ranges = &self.inner.range;
        let periods = ranges.len() / self.observed.max(1);
        vector(py, ranges.iter().flatten().copied().collect::<Vec<_>>()).reshape([
            periods,
            self.observed,
            2,
        ])
    }

    #[getter]
    fn change<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.inner.change.iter().copied())
    }

    #[getter]
    fn settled(&self) -> bool {
        self.inner.settled
    }

    #[getter]
    fn unbounded(&self) -> bool {
        self.inner.halt == Some(Halt::Unbounded)
    }

    #[getter]
    fn events<'py>(&self, py: Python<'py>) -> EventColumns<'py> {
        event_columns(py, &self.inner.events)
    }

    #[getter]
    fn interrupted(&self) -> bool {
        self.inner.interrupted
    }

    #[getter]
    fn timings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let timings = PyDict::new(py);
        timings.set_item("total", self.inner.total.as_secs_f64())?;
        Ok(timings)
    }

    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let counters = PyDict::new(py);
        counters.set_item("steps", self.inner.steps)?;
        counters.set_item("events", self.inner.events_met)?;
        Ok(counters)
    }
}

/// How a motion is followed: `TransientSettings` of Python.
#[derive(FromPyObject)]
pub struct Settings {
    omega: f64,
    scheme: String,
    periods: usize,
    tolerance: Option<f64>,
    steps: usize,
    samples: usize,
    keep: Option<usize>,
}

impl Settings {
    fn parse(self) -> PyResult<TransientSettings> {
        let Self { omega, scheme, periods, tolerance, steps, samples, keep } = self;
        let scheme = match scheme.as_str() {
            "exact" => Scheme::Exact,
            "rk4" => Scheme::RungeKutta(steps),
            other => {
                let message = format!("scheme = \"{other}\": must be \"exact\" or \"rk4\"");
                return Err(PyValueError::new_err(message));
            }
        };
        Ok(TransientSettings { omega, scheme, periods, tolerance, samples, keep })
    }
}

/// Follows a motion over periods of the excitation.
#[pyfunction]
pub fn transient(
    py: Python<'_>,
    problem: &Problem,
    settings: Settings,
    start: Option<Array1<'_, f64>>,
    observe: Array1<'_, i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<History> {
    let settings = settings.parse()?;
    let observe = indices(&observe)?;
    let start = start.map(|state| state.as_array().to_vec());
    let observed = observe.len();
    let own = Arc::clone(&problem.model);
    let (inner, raised) = watched(py, progress.as_ref(), move |look| {
        motion::transient(&own, &settings, start.as_deref(), &observe, look)
    })?;
    raised.raise_unless_interrupt(py)?;
    let inner = inner.ok_or_else(given_up)?.map_err(refused)?;
    let model = &problem.model;
    if inner.halt == Some(Halt::Contradiction) {
        return Err(PyValueError::new_err(
            "transient: the contacts do not settle on stick or slip at one instant; perturb the start state slightly, or use scheme = \"rk4\"",
        ));
    }
    Ok(History { inner, observed, contacts: model.compliance().contacts(), states: model.states() })
}
