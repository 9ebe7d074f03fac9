//! What becomes of free motions: start states in, one row per start out.

use crate::arrays::{refused, Array2};
use crate::columns::Columns;
use crate::problem::Problem;
use crate::watch::{given_up, watched};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use stickslip_core::motion::{self, Classification, ClassificationSettings, Reason};
use stickslip_core::Model;

/// What becomes of some starts.
#[pyclass(frozen, get_all, module = "stickslip._core")]
pub struct Fates {
    columns: Py<PyDict>,
    interrupted: bool,
    /// Wall-clock time [s].
    seconds: f64,
}

/// One row per start; of those that were not decided the numbers are missing.
fn columns(
    py: Python<'_>,
    fates: &[Option<Classification>],
    model: &Model,
) -> PyResult<Py<PyDict>> {
    let dofs = model.compliance().dofs();
    let states = model.states();
    let fates = || fates.iter().map(Option::as_ref);
    let numbers =
        |of: fn(&Classification) -> f64| fates().map(move |fate| fate.map_or(f64::NAN, of));
    let rows =
        |of: fn(&Classification) -> &[f64]| fates().map(move |fate| fate.map_or(&[][..], of));
    let columns = Columns::new(py);
    let reason =
        |fate: Option<&Classification>| code(fate.map_or(Reason::Interrupted, |fate| fate.reason));
    columns.one("reason", fates().map(reason))?;
    let mode = |fate: Option<&Classification>| {
        fate.and_then(|fate| fate.mode).map_or(-1, |mode| mode as i64)
    };
    columns.one("mode", fates().map(mode))?;
    columns.one("share", numbers(|fate| fate.share))?;
    columns.one("omega", numbers(|fate| fate.omega))?;
    columns.one("time", numbers(|fate| fate.time))?;
    columns.one("events", fates().map(|fate| fate.map_or(0, |fate| fate.events as i64)))?;
    columns.numbers("amplitude", dofs, rows(|fate| &fate.amplitude))?;
    columns.numbers("final", states, rows(|fate| &fate.state))?;
    Ok(columns.end())
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
    let settings = ClassificationSettings { periods, tolerance };
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
    let columns = columns(py, &inner, model)?;
    Ok(Fates { columns, interrupted, seconds: began.elapsed().as_secs_f64() })
}

fn code(reason: Reason) -> u8 {
    match reason {
        Reason::Stuck => 0,
        Reason::Passive => 1,
        Reason::Closed => 2,
        Reason::Aperiodic => 3,
        Reason::Unbounded => 4,
        Reason::Overflow => 5,
        Reason::Settling => 6,
        Reason::Growing => 7,
        Reason::Falling => 8,
        Reason::Monotone => 9,
        Reason::Contradiction => 10,
        Reason::Interrupted => 11,
    }
}
