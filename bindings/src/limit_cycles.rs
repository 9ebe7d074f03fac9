//! Limit cycles: negative damping and settings in, cycles along a branch out.

use crate::arrays::{either, matrix, refused, Array2, Array3};
use crate::columns::{counters, timings, Columns};
use crate::problem::Problem;
use crate::variation::Varied;
use crate::watch::{given_up, watched};
use numpy::Complex64;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use stickslip_core::balance::HarmonicChoice;
use stickslip_core::model::{NegativeDamping, Variation};
use stickslip_core::orbit::{self, ChangeKind, CycleSettings};
use stickslip_core::solve::End;
use stickslip_core::Model;

/// Limit cycles along a branch.
#[pyclass(frozen, get_all, module = "stickslip._core")]
pub struct LimitCycles {
    columns: Py<PyDict>,
    /// How either side ended, and at which value.
    ends: Vec<(&'static str, f64)>,
    /// r at which the stuck mode loses its damping, and its natural frequency.
    onset: (f64, f64),
    phase_dof: usize,
    jumps: usize,
    interrupted: bool,
    timings: Py<PyDict>,
    counters: Py<PyDict>,
}

impl LimitCycles {
    fn new(py: Python<'_>, found: &orbit::LimitCycles, model: &Model) -> PyResult<Self> {
        let end = |end| match end {
            End::Range => "range",
            End::Condition => "unbounded",
            End::Points => "points",
            End::Stalled => "stalled",
            End::Returned => "returned",
            End::Interrupted => "interrupted",
        };
        Ok(Self {
            columns: columns(py, found, model)?,
            ends: found.ends.iter().zip(found.end_values).map(|(e, v)| (end(*e), v)).collect(),
            onset: (found.onset, found.stuck_omega),
            phase_dof: found.phase_dof,
            jumps: found.jumps,
            interrupted: found.interrupted,
            timings: timings(py, &found.profile)?,
            counters: counters(py, &found.profile, 0)?,
        })
    }
}

fn columns(py: Python<'_>, found: &orbit::LimitCycles, model: &Model) -> PyResult<Py<PyDict>> {
    let (dofs, contacts) = (model.compliance().dofs(), model.compliance().contacts());
    let states = model.states();
    let cycles = || found.cycles.iter();
    let columns = Columns::new(py);
    columns.responses(cycles().map(|c| &c.response), dofs, contacts)?;
    columns.one("value", cycles().map(|c| c.value))?;
    columns.one("ratio", cycles().map(|c| c.ratio))?;
    columns.one("slipping", cycles().map(|c| c.slipping))?;
    columns.one("closed", cycles().map(|c| c.closed))?;
    columns.ranges(dofs, cycles().map(|c| c.range.as_slice()))?;
    columns.numbers("state", states, cycles().map(|c| c.state.as_slice()))?;
    let multipliers = cycles().map(|c| (c.multipliers.as_slice(), c.neutral));
    columns.multipliers(states.saturating_sub(1), multipliers)?;
    let turn = found.limit.map_or([f64::NAN; 2], |turn| [turn.value, turn.omega]);
    columns.one("turn", turn)?;
    columns.rows("folds", 2, f64::NAN, found.folds.iter().map(|turn| [turn.value, turn.omega]))?;
    let changes = || found.changes.iter();
    let kind = |change: &orbit::Change| match change.kind {
        ChangeKind::Fold => 0_i64,
        ChangeKind::ComplexPair => 1,
        ChangeKind::Symmetry => 2,
        ChangeKind::Grazing => 3,
    };
    columns.rows("change", 2, f64::NAN, changes().map(|c| [c.value, c.omega]))?;
    columns.one("change_after", changes().map(|c| c.after as i64))?;
    columns.one("change_kind", changes().map(kind))?;
    let unstable = changes().map(|c| [c.unstable.0 as i64, c.unstable.1 as i64]);
    columns.rows("change_unstable", 2, 0, unstable)?;
    Ok(columns.end())
}

/// Negative damping: one matrix, or complex ones by nodal diameter of a travelling wave.
pub enum Negative<'py> {
    Whole(Array2<'py, f64>),
    Wave(Array3<'py, Complex64>),
}

impl<'a, 'py: 'a> FromPyObject<'a, 'py> for Negative<'py> {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let expected = "an array of float64 in 2 dimensions, or of complex128 in 3";
        either(given, expected, Self::Whole, Self::Wave)
    }
}

impl Negative<'_> {
    fn damping(&self, proportional: bool) -> NegativeDamping {
        match self {
            Self::Whole(array) if proportional => NegativeDamping::Proportional(matrix(array)),
            Self::Whole(array) => NegativeDamping::Whole(matrix(array)),
            Self::Wave(array) => {
                let each = |one: numpy::ndarray::ArrayView2<'_, Complex64>| {
                    faer::Mat::from_fn(one.nrows(), one.ncols(), |i, j| one[[i, j]])
                };
                NegativeDamping::Wave(array.as_array().outer_iter().map(each).collect())
            }
        }
    }
}

/// Which cycles are sought and how: `CycleSettings` of Python.
#[derive(FromPyObject)]
pub struct Settings {
    mode: usize,
    ratio: f64,
    values: Option<Vec<f64>>,
    span: (f64, f64),
    method: String,
    fixed_harmonics: Option<usize>,
    max_harmonics: usize,
    tolerance: f64,
    stability: bool,
    max_points: usize,
}

/// Limit cycles of a mode along what is varied, the ratio if nothing is; `proportional` says that a
/// law made the negative damping, one that couples none of the modes without contacts.
#[pyfunction]
pub fn limit_cycles(
    py: Python<'_>,
    problem: &Problem,
    negative_damping: Negative<'_>,
    proportional: bool,
    variation: Option<Varied>,
    settings: Settings,
    progress: Option<Py<PyAny>>,
) -> PyResult<LimitCycles> {
    if settings.max_points < 2 {
        return Err(PyValueError::new_err("max_points: must be at least 2"));
    }
    let negative = negative_damping.damping(proportional);
    let variation = variation.map_or(Variation::Ratio, Variation::from);
    let ratio = settings.ratio;
    let harmonics = settings.fixed_harmonics;
    let settings = CycleSettings {
        mode: settings.mode,
        values: settings.values,
        range: settings.span,
        exact: settings.method == "exact",
        harmonics: harmonics.map_or(HarmonicChoice::Auto, HarmonicChoice::Fixed),
        max_harmonics: settings.max_harmonics,
        tolerance: settings.tolerance,
        reported: harmonics.unwrap_or(settings.max_harmonics),
        stability: settings.stability,
        most: settings.max_points,
    };
    let model = &problem.model;
    let own = Arc::clone(model);
    let (inner, raised) = watched(py, progress.as_ref(), move |look| {
        orbit::limit_cycles(&own, &negative, &variation, ratio, &settings, look)
    })?;
    raised.raise_unless_interrupt(py)?;
    LimitCycles::new(py, &inner.ok_or_else(given_up)?.map_err(refused)?, model)
}
