//! Forced response: settings in, curves out, progress and Ctrl-C in between.

use crate::arrays::{either, indices, is_half_wave, refused, series, vector, Array1, Array2};
use crate::columns::{counters, timings, Columns};
use crate::problem::Problem;
use crate::settings::BalanceSettings;
pub use crate::settings::ResidualArgument;
use crate::watch::{given_up, watched};
use numpy::{Complex64, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::mem::take;
use std::sync::Arc;
use stickslip_core::balance::{
    self, sweep, sweep_range, ForcedBalance, Kept, Point, PointStatus, Progress, HIGHEST_ORDER,
};
use stickslip_core::fourier::{self, Harmonics, Measure, SampleTable};
use stickslip_core::orbit::OrbitInitialGuess;
use stickslip_core::timing::Profile;
use stickslip_core::Model;

/// Frequencies: a grid, or a range whose steps the core chooses.
pub enum Frequencies<'py> {
    Range((f64, f64)),
    Grid(Array1<'py, f64>),
}

impl<'a, 'py: 'a> FromPyObject<'a, 'py> for Frequencies<'py> {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let expected = "(from, to) or an array of float64 in 1 dimensions";
        either(given, expected, Self::Range, Self::Grid)
    }
}

/// Runs a sweep without the GIL. Ctrl-C keeps what was solved; anything else that a progress
/// callback raises is its own.
pub fn swept(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    observed: usize,
    model: &Arc<Model>,
    work: impl FnOnce(
            &Model,
            &Kept<Point>,
            &Progress<'_>,
        ) -> Result<balance::Solution, stickslip_core::Error>
        + Send
        + 'static,
) -> PyResult<Solution> {
    let kept = Arc::new(Kept::default());
    let (own_model, own_kept) = (Arc::clone(model), Arc::clone(&kept));
    let (inner, raised) = watched(py, progress, move |look| work(&own_model, &own_kept, look))?;
    raised.raise_unless_interrupt(py)?;
    let inner = match inner {
        Some(inner) => inner.map_err(refused)?,
        None => {
            let points = kept.lock().map(|mut points| take(&mut *points)).unwrap_or_default();
            let first = points.first().and_then(|point| point.unknowns()).ok_or_else(given_up)?;
            let half_wave = first.harmonics().half_wave();
            balance::Solution { points, half_wave, interrupted: true, profile: Profile::default() }
        }
    };
    let points = inner.points.iter().map(AsRef::as_ref);
    let columns = Columns::new(py);
    columns.responses(points.clone(), observed, model.compliance().contacts())?;
    Solution::new(py, columns, points, inner.half_wave, inner.interrupted, &inner.profile)
}

/// A curve of periodic motions.
#[pyclass(frozen, get_all, module = "stickslip._core")]
pub struct Solution {
    columns: Py<PyDict>,
    half_wave: bool,
    /// Number of points that were computed.
    computed: usize,
    interrupted: bool,
    timings: Py<PyDict>,
    counters: Py<PyDict>,
}

impl Solution {
    /// The curve of some points, whose columns are written.
    pub fn new<'a>(
        py: Python<'_>,
        columns: Columns<'_>,
        points: impl Iterator<Item = &'a Point> + Clone,
        half_wave: bool,
        interrupted: bool,
        profile: &Profile,
    ) -> PyResult<Self> {
        let computed = |point: &&Point| point.status != PointStatus::NotComputed;
        Ok(Self {
            columns: columns.end(),
            half_wave,
            computed: points.clone().filter(computed).count(),
            interrupted,
            timings: timings(py, profile)?,
            counters: counters(py, profile, points.map(|p| p.iterations).sum())?,
        })
    }
}

/// Harmonic balance over a grid or a range of frequencies.
#[pyfunction]
pub fn forced_response(
    py: Python<'_>,
    problem: &Problem,
    omega: Frequencies<'_>,
    observe: Array1<'_, i64>,
    driving: Array1<'_, i64>,
    settings: BalanceSettings,
    progress: Option<Py<PyAny>>,
) -> PyResult<Solution> {
    let settings = settings.parse()?;
    let (observe, driving) = (indices(&observe)?, indices(&driving)?);
    let grid = match &omega {
        Frequencies::Grid(grid) => grid.as_array().to_vec(),
        Frequencies::Range(_) => Vec::new(),
    };
    let range = match omega {
        Frequencies::Range(range) => Some(range),
        Frequencies::Grid(_) => None,
    };
    let model = Arc::clone(&problem.model);
    swept(py, progress.as_ref(), observe.len(), &model, move |model, kept, look| {
        let orbits = OrbitInitialGuess::new(model, settings.residual, &observe, look);
        let balance = ForcedBalance::new(model, settings, &observe)?
            .watched(look)
            .rescued(&orbits)
            .driven_by(&driving)
            .keeping(kept);
        match range {
            Some((from, to)) => sweep_range(balance, from, to),
            None => sweep(balance, &grid),
        }
    })
}

/// Amplitudes of series `X_0, X_1, …`, one per row, with the exact extrema of their polynomials.
#[pyfunction]
pub fn amplitude<'py>(
    py: Python<'py>,
    coefficients: Array2<'py, Complex64>,
    measure: &str,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let measure: Measure = measure.parse().map_err(refused)?;
    let view = coefficients.as_array();
    let (rows, orders) = (view.nrows(), view.ncols());
    if !(2..=HIGHEST_ORDER + 1).contains(&orders) {
        return Err(PyValueError::new_err(format!(
            "coefficients: expected X_0, X_1 and at most {HIGHEST_ORDER} harmonics, got {orders} orders"
        )));
    }
    let half_wave = (0..rows).all(|n| is_half_wave(orders, |k| view[[n, k]]));
    let table = SampleTable::new(Harmonics::new(orders - 1, half_wave));
    let amplitudes = (0..rows).map(|n| {
        let row = series(table.harmonics(), |k| view[[n, k]]);
        if row.iter().any(|value| value.is_nan()) {
            return f64::NAN;
        }
        fourier::amplitude(&table, &row, measure)
    });
    Ok(vector(py, amplitudes))
}
