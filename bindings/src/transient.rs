//! Time integration: settings and a start state in, histories out.

use crate::arrays::{indices, refused, Array1};
use crate::columns::Columns;
use crate::problem::Problem;
use crate::watch::{given_up, watched};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict as _, PyDict};
use std::sync::Arc;
use stickslip_core::motion::{self, Halt, Scheme, TransientSettings};
use stickslip_core::Model;

/// A motion from a start state.
#[pyclass(frozen, get_all, module = "stickslip._core")]
pub struct History {
    columns: Py<PyDict>,
    settled: bool,
    unbounded: bool,
    interrupted: bool,
    timings: Py<PyDict>,
    counters: Py<PyDict>,
}

impl History {
    fn new(
        py: Python<'_>,
        found: motion::History,
        observed: usize,
        model: &Model,
    ) -> PyResult<Self> {
        let contacts = model.compliance().contacts();
        let trace = found.trace;
        let instants = trace.time.len();
        let columns = Columns::new(py);
        columns.shaped("displacement", [instants, observed], trace.displacement)?;
        columns.shaped("velocity", [instants, observed], trace.velocity)?;
        columns.shaped("contact_force", [instants, contacts], trace.force)?;
        columns.shaped("contact_displacement", [instants, contacts], trace.contact_displacement)?;
        columns.one("time", trace.time)?;
        columns.numbers("poincare", model.states(), found.poincare.iter().map(Vec::as_slice))?;
        // A period that was cut has no change, and its range means nothing.
        let periods = found.change.len();
        let range = found.range.into_iter().take(periods * observed).flatten().collect();
        columns.shaped("range", [periods, observed, 2], range)?;
        columns.one("change", found.change)?;
        columns.events(found.events.iter())?;
        let counters = [("steps", found.steps), ("events", found.events_met)];
        Ok(Self {
            columns: columns.end(),
            settled: found.settled,
            unbounded: found.halt == Some(Halt::Unbounded),
            interrupted: found.interrupted,
            timings: [("total", found.total.as_secs_f64())].into_py_dict(py)?.unbind(),
            counters: counters.into_py_dict(py)?.unbind(),
        })
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
    History::new(py, inner, observed, model)
}
