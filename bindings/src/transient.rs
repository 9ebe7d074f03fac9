//! Time integration: settings and a start state in, histories out.

use crate::columns::Columns;
use crate::problem::Problem;
use crate::settings::get;
use crate::watch::computed;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::motion::{self, Halt, Scheme, TransientSettings};

/// Follows a motion over periods of the excitation.
#[pyfunction]
pub fn transient<'py>(
    py: Python<'py>,
    problem: &Problem,
    settings: &Bound<'_, PyAny>,
    start: Option<Vec<f64>>,
    observe: Vec<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let exact = get::<String>(settings, "scheme")? == "exact";
    let scheme = if exact { Scheme::Exact } else { Scheme::RungeKutta(get(settings, "steps")?) };
    let settings = TransientSettings {
        omega: get(settings, "omega")?,
        scheme,
        periods: get(settings, "periods")?,
        tolerance: get(settings, "tolerance")?,
        samples: get(settings, "samples")?,
        keep: get(settings, "keep")?,
    };
    let observed = observe.len();
    let model = Arc::clone(&problem.model);
    let found = computed(py, progress, move |look| {
        motion::transient(&model, &settings, start.as_deref(), &observe, look)
    })?;
    if found.halt == Some(Halt::Contradiction) {
        return Err(PyValueError::new_err(
            "transient: the contacts do not settle on stick or slip at one instant; perturb the start state slightly, or use scheme = \"rk4\"",
        ));
    }
    let (model, trace) = (&problem.model, found.trace);
    let (instants, contacts) = (trace.time.len(), model.compliance().contacts());
    let mut columns = Columns::default();
    columns.shaped("displacement", [instants, observed], trace.displacement);
    columns.shaped("velocity", [instants, observed], trace.velocity);
    columns.shaped("contact_force", [instants, contacts], trace.force);
    columns.shaped("contact_displacement", [instants, contacts], trace.contact_displacement);
    columns.one("time", trace.time);
    columns.numbers("poincare", model.states(), found.poincare.iter().map(Vec::as_slice));
    // A period that was cut has no change, and its range means nothing.
    let periods = found.change.len();
    let range = found.range.into_iter().take(periods * observed).flatten().collect();
    columns.shaped("range", [periods, observed, 2], range);
    columns.one("change", found.change);
    columns.events(found.events.iter());
    columns.tell("settled", found.settled);
    columns.tell("unbounded", found.halt == Some(Halt::Unbounded));
    columns.tell("interrupted", found.interrupted);
    columns.tell_by_name("timings", [("total", found.total.as_secs_f64())]);
    columns.tell_by_name("counters", [("steps", found.steps), ("events", found.events_met)]);
    columns.end(py)
}
