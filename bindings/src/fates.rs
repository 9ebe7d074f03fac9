//! What becomes of free motions: start states in, one row per start out.

use crate::arrays::Array2;
use crate::columns::Columns;
use crate::problem::Problem;
use crate::settings::get;
use crate::watch::computed;
use pyo3::prelude::*;
use std::sync::Arc;
use std::time::Instant;
use stickslip_core::motion::{self, Classification, ClassificationSettings, Reason};

/// Follows free motions from start states, one per row, until it is decided what becomes of them.
#[pyfunction]
pub fn fates<'py>(
    py: Python<'py>,
    problem: &Problem,
    starts: Array2<'_, f64>,
    settings: &Bound<'_, PyAny>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let starts: Vec<Vec<f64>> = starts.as_array().outer_iter().map(|row| row.to_vec()).collect();
    let (periods, tolerance) = (get(settings, "periods")?, get(settings, "tolerance")?);
    let settings = ClassificationSettings { periods, tolerance };
    let (began, model) = (Instant::now(), Arc::clone(&problem.model));
    let found = computed(py, progress, move |look| {
        motion::fates(&model, settings, &starts, threads, look)
    })?;
    let (dofs, states) = (problem.model.compliance().dofs(), problem.model.states());
    // Of those that were not decided the numbers are missing.
    let fates = || found.iter().map(Option::as_ref);
    let numbers =
        |of: fn(&Classification) -> f64| fates().map(move |fate| fate.map_or(f64::NAN, of));
    let rows =
        |of: fn(&Classification) -> &[f64]| fates().map(move |fate| fate.map_or(&[][..], of));
    let reasons = || fates().map(|fate| fate.map_or(Reason::Interrupted, |fate| fate.reason));
    let modes = fates().map(|fate| fate.and_then(|fate| fate.mode).map_or(-1, |mode| mode as i64));
    let mut columns = Columns::default();
    columns.one("reason", reasons().map(|reason| reason as u8));
    columns.one("mode", modes);
    columns.one("share", numbers(|fate| fate.share));
    columns.one("omega", numbers(|fate| fate.omega));
    columns.one("time", numbers(|fate| fate.time));
    columns.one("events", fates().map(|fate| fate.map_or(0, |fate| fate.events as i64)));
    columns.numbers("amplitude", dofs, rows(|fate| &fate.amplitude));
    columns.numbers("final", states, rows(|fate| &fate.state));
    columns.tell("interrupted", reasons().any(|reason| reason == Reason::Interrupted));
    columns.tell("seconds", began.elapsed().as_secs_f64());
    columns.end(py)
}
