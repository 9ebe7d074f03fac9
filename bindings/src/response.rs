//! Forced response: settings in, curves out, progress and Ctrl-C in between.

use crate::arrays::{coefficients, is_half_wave, series, Array1, Array2};
use crate::columns::{stability_code, Columns};
use crate::found::Found;
use crate::problem::Problem;
use crate::settings::{balance as balance_settings, get, measure};
use crate::watch::{given_up, watched};
use numpy::{Complex64, PyArray1};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::mem::take;
use std::sync::Arc;
use stickslip_core::balance::{
    self, sweep, without_gap, CurveEnd, ForcedBalance, HarmonicChoice, Kept, Point, PointStatus,
    Progress, Settings, Unknowns, HIGHEST_ORDER,
};
use stickslip_core::design::bound;
use stickslip_core::fourier::{self, Harmonics, Measure, SampleTable};
use stickslip_core::orbit::{decide_stability, sweep_in_pieces, sweep_range_in_pieces, Balances};
use stickslip_core::solve::NewtonSettings;
use stickslip_core::timing::Profile;
use stickslip_core::{Error, Model};

/// Frequencies: a grid, or a range whose steps the core chooses.
pub enum Frequencies {
    Range((f64, f64)),
    Grid(Vec<f64>),
}

fn frequencies(given: &Bound<'_, PyAny>) -> PyResult<Frequencies> {
    if let Ok(range) = given.extract() {
        return Ok(Frequencies::Range(range));
    }
    let grid: PyResult<Array1<'_, f64>> = given.extract();
    grid.map(|grid| Frequencies::Grid(grid.as_array().to_vec())).map_err(|_| {
        let expected = "(from, to) or an array of float64 in 1 dimensions";
        PyTypeError::new_err(format!("expected {expected}, got {}", given.get_type()))
    })
}

/// Runs work that keeps what it has solved, as `kept`, before it ends.
pub fn keeping<K: Send + Sync + 'static, T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Kept<K>, &Progress<'_>) -> Result<T, Error> + Send + 'static,
    rest: impl FnOnce(Vec<Arc<K>>) -> Option<T>,
) -> PyResult<T> {
    let kept = Arc::new(Kept::default());
    let own = Arc::clone(&kept);
    if let Some(found) = watched(py, progress, move |look| work(&own, look))? {
        return Ok(found);
    }
    let points = kept.lock().map(|mut points| take(&mut *points)).unwrap_or_default();
    rest(points).ok_or_else(given_up)
}

/// Points of a sweep, which it may take a while to bring into order.
type Ordered = Box<dyn FnOnce() -> balance::Solution + Send>;

/// Runs a sweep, over the frequencies `order` if they were given; Ctrl-C keeps what was solved.
fn swept(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    observed: usize,
    model: &Arc<Model>,
    order: Vec<f64>,
    work: impl FnOnce(&Model, &Kept<Point>, &Progress<'_>) -> Result<balance::Solution, Error>
        + Send
        + 'static,
) -> PyResult<Found> {
    let own = Arc::clone(model);
    let (interrupted, computed, solution) = keeping(
        py,
        progress,
        move |kept, look| {
            let found = work(&own, kept, look)?;
            let computed = found.points.iter().filter(|point| is_computed(point)).count();
            Ok((found.interrupted, Some(computed), Box::new(|| found) as Ordered))
        },
        move |points: Vec<Arc<Point>>| {
            // A curve that was ended early has no gap: without its first point there is nothing.
            let begun = |first: &f64| points.iter().any(|point| point.omega == *first);
            let any = order.first().map_or(!points.is_empty(), begun);
            any.then(|| (true, None, Box::new(move || kept_points(points, &order)) as Ordered))
        },
    )?;
    let contacts = model.compliance().contacts();
    Found::new(interrupted, computed, move || {
        let found = solution();
        let points = found.points.iter().map(AsRef::as_ref);
        let mut columns = Columns::default();
        columns.responses(points.clone(), observed, contacts);
        columns.tell("end", end_name(found.end));
        columns.tell("cut", found.cut);
        let astray = points.clone().enumerate().filter(|(_, point)| point.astray);
        columns.tell("astray", astray.map(|(position, _)| position).collect::<Vec<_>>());
        curve(&mut columns, points, found.half_wave, found.interrupted, &found.profile);
        Ok(columns)
    })
}

/// The curve of points that were kept as they were solved.
fn kept_points(mut points: Vec<Arc<Point>>, order: &[f64]) -> balance::Solution {
    if !order.is_empty() {
        without_gap(&mut points, order, |point| point.omega);
    }
    // The first point may have no solution.
    let known = points.iter().find_map(|point| point.unknowns());
    let half_wave = known.is_some_and(|known| known.harmonics().half_wave());
    let (end, profile) = (CurveEnd::Interrupted, Profile::default());
    balance::Solution { points, half_wave, interrupted: true, end, cut: 0, profile }
}

fn is_computed(point: &Point) -> bool {
    point.status != PointStatus::NotComputed
}

/// How a curve ended, as Python knows it.
fn end_name(end: CurveEnd) -> &'static str {
    match end {
        CurveEnd::Range | CurveEnd::Interrupted | CurveEnd::Closed => "range",
        CurveEnd::Returned => "returned",
        CurveEnd::Stalled => "stalled",
        CurveEnd::Points => "points",
    }
}

/// What curves of some points have beside the columns of every motion.
pub fn curve<'a>(
    columns: &mut Columns,
    points: impl Iterator<Item = &'a Point> + Clone,
    half_wave: bool,
    interrupted: bool,
    profile: &Profile,
) {
    columns.one("fold", points.clone().map(|point| point.fold));
    columns.one("jump", points.clone().map(|point| point.jump));
    columns.one("further", points.clone().map(|point| point.further));
    columns.one("stability", points.clone().map(|point| stability_code(point.stable)));
    columns.tell("half_wave", half_wave);
    columns.tell("computed", points.clone().filter(|point| is_computed(point)).count());
    columns.tell("interrupted", interrupted);
    columns.effort(profile, ("iterations", points.map(|point| point.iterations).sum()));
}

/// Harmonic balance over a grid or a range of frequencies. `bounds` asks for those over the residual
/// tractions, and tells whether one vibration alone is known to exist. The first frequency of a grid begins
/// with the contact displacements `start`, `(points, H+1)`.
#[pyfunction]
#[pyo3(signature = (problem, omega, observe, driving, settings, progress, bounds=None, start=None))]
#[allow(clippy::too_many_arguments)]
pub fn forced_response<'py>(
    py: Python<'py>,
    problem: &Problem,
    #[pyo3(from_py_with = frequencies)] omega: Frequencies,
    observe: Vec<usize>,
    driving: Vec<usize>,
    settings: &Bound<'_, PyAny>,
    progress: Option<Py<PyAny>>,
    bounds: Option<bool>,
    start: Option<Array2<'py, Complex64>>,
) -> PyResult<Found> {
    let start = start.map(|start| motion_of(problem, &start)).transpose()?.flatten();
    let stability =
        settings.getattr_opt("stability")?.map_or(Ok(false), |given| given.extract())?;
    let settings = balance_settings(settings)?;
    let order = match &omega {
        Frequencies::Range(_) => Vec::new(),
        Frequencies::Grid(grid) => grid.clone(),
    };
    swept(py, progress, observe.len(), &problem.model, order, move |model, kept, look| {
        let balances = Balances::new(model, settings, (&observe, &driving), kept)?;
        let mut found = match omega {
            Frequencies::Range(range) => sweep_range_in_pieces(&balances, range, look),
            Frequencies::Grid(grid) => {
                sweep_in_pieces(model, &settings, &grid, look, |piece, look| {
                    balances.with(look, |balance| sweep(balance.begun_with(start.clone()), piece))
                })
            }
        }?;
        if stability && !model.is_monotone() {
            decide_stability(model, settings, &mut found, look)?;
        }
        if let Some(proved) = bounds {
            bound(model, settings, &observe, proved, &mut found, look)?;
        }
        Ok(found)
    })
}

/// Contact displacements `(points, H+1)` of a model as a start for another, if that has as many.
fn motion_of(problem: &Problem, start: &Array2<'_, Complex64>) -> PyResult<Option<Unknowns>> {
    let (harmonics, values) = coefficients(start, false)?;
    let fits = values.len() == problem.model.compliance().contacts() * harmonics.slots();
    Ok(fits.then(|| Unknowns::new(harmonics, values)))
}

/// Single-harmonic balance over a grid of frequencies.
#[pyfunction]
pub fn single_harmonic<'py>(
    py: Python<'py>,
    problem: &Problem,
    omega: Vec<f64>,
    observe: Vec<usize>,
    settings: &Bound<'_, PyAny>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Found> {
    let (estimate, max_iterations) = (get(settings, "estimate")?, get(settings, "max_iterations")?);
    let settings = Settings {
        harmonics: HarmonicChoice::Fixed(1),
        newton: NewtonSettings { max_iterations, ..NewtonSettings::default() },
        ..Settings::default()
    };
    swept(py, progress, observe.len(), &problem.model, Vec::new(), move |model, kept, look| {
        let balance = ForcedBalance::new(model, settings, &observe)?.watched(look).keeping(kept);
        balance::single_harmonic(balance, &omega, estimate)
    })
}

/// Amplitudes of series `X_0, X_1, …`, one per row, with the exact extrema of their polynomials.
#[pyfunction]
pub fn amplitude<'py>(
    py: Python<'py>,
    coefficients: Array2<'py, Complex64>,
    #[pyo3(from_py_with = measure)] measure: Measure,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
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
    Ok(PyArray1::from_iter(py, amplitudes))
}
