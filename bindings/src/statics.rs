//! Structures under their static loads.

use crate::columns::Columns;
use crate::problem::Problem;
use crate::watch::computed;
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::balance;

/// Raises the static loads from rest.
#[pyfunction]
pub fn static_response<'py>(
    py: Python<'py>,
    problem: &Problem,
    observe: Vec<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let model = Arc::clone(&problem.model);
    let found =
        computed(py, progress, move |look| balance::static_response(&model, &observe, look))?;
    let mut columns = Columns::default();
    columns.one("displacement", found.displacement);
    columns.one("contact_displacement", found.contact_displacement);
    columns.one("contact_force", found.contact_force);
    columns.one("share", [found.share]);
    columns.one("status", [found.status as u8]);
    columns.tell("steps", found.steps);
    columns.end(py)
}
