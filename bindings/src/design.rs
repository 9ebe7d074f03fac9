//! Damper design: peaks along a parameter, the least of them, and sensitivities.

use crate::arrays::{series, table, Array3};
use crate::columns::{uniqueness_code, Columns};
use crate::problem::Problem;
use crate::response::keeping;
use crate::settings::{evaluated, get, harmonic, measure, residual, variation};
use crate::watch;
use numpy::{Complex64, PyArray2, PyUntypedArrayMethods as _};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::balance::{Cause, Kept, Linearised, Progress, Unknowns};
use stickslip_core::contact::Residual;
use stickslip_core::design::{
    self, bounded_peak_curve, optimum, peak_curve, Cell, CellPeak, Curve, Optimum, Peak,
    PeakBounds, Target,
};
use stickslip_core::fourier::{Harmonics, Measure, SampleTable};
use stickslip_core::model::Variation;
use stickslip_core::Model;

/// Some of the peaks of a curve along a parameter.
fn written<'py>(py: Python<'py>, peaks: &[Peak], curve: &Curve) -> PyResult<Bound<'py, PyAny>> {
    let mut columns = Columns::default();
    let peaks = || peaks.iter();
    columns.one("value", peaks().map(|p| p.value));
    columns.one("omega", peaks().map(|p| p.omega));
    columns.one("amplitude", peaks().map(|p| p.amplitude));
    columns.one("sensitivity", peaks().map(|p| p.slope));
    columns.one("error_estimate", peaks().map(|p| p.error_estimate));
    columns.one("harmonics", peaks().map(|p| p.harmonics as i64));
    columns.one("at_edge", peaks().map(|p| p.at_edge));
    columns.one("status", peaks().map(|p| p.status as u8));
    let bound =
        |of: fn(&PeakBounds) -> f64| peaks().map(move |p| p.bounds.as_ref().map_or(f64::NAN, of));
    columns.one("lower", bound(|bounds| bounds.lower));
    columns.one("upper", bound(|bounds| bounds.upper));
    columns.one("unique", peaks().map(|p| uniqueness_code(p.bounds.map(|one| one.unique))));
    columns.one("guaranteed", peaks().map(|p| p.bounds.is_some_and(|bounds| bounds.proved)));
    columns.tell("interrupted", curve.interrupted);
    columns.effort(&curve.profile, ("points", curve.points));
    columns.end(py)
}

/// The peak that is followed: `DamperSettings` of Python.
fn target(settings: &Bound<'_, PyAny>, dof: usize) -> PyResult<Target> {
    let measure = measure(&settings.getattr("measure")?)?;
    Ok(Target { dof, measure, span: get(settings, "span")? })
}

/// What was found of a curve that could not be stopped; `None` is nothing.
fn rest(found: &[Arc<Peak>], values: &[f64]) -> Option<Curve> {
    let peaks: Vec<Peak> = found.iter().map(|peak| **peak).collect();
    (!peaks.is_empty()).then(|| Curve::cut_short(peaks, values))
}

/// The peak at every value of a parameter. `bounds` asks for those over the residual tractions, and
/// tells whether one vibration alone is known to exist.
#[pyfunction]
#[pyo3(signature = (problem, variation, dof, values, settings, progress, bounds=None))]
pub fn damper_curve<'py>(
    py: Python<'py>,
    problem: &Problem,
    #[pyo3(from_py_with = variation)] variation: Variation,
    dof: usize,
    values: Vec<f64>,
    settings: &Bound<'_, PyAny>,
    progress: Option<Py<PyAny>>,
    bounds: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    let (target, settings) = (target(settings, dof)?, harmonic(settings)?);
    let model = Arc::clone(&problem.model);
    let asked = values.clone();
    let follow = move |kept: &Kept<Peak>, look: &Progress<'_>| match bounds {
        None => peak_curve(&model, settings, &variation, &values, &target, look, Some(kept)),
        Some(proved) => {
            let asked = (&values[..], proved);
            bounded_peak_curve(&model, settings, &variation, asked, &target, look, Some(kept))
        }
    };
    let curve = keeping(py, progress, follow, |found| rest(&found, &asked))?;
    written(py, &curve.peaks, &curve)
}

/// The local minima of the peak over a parameter, the least first, and all peaks computed.
#[pyfunction]
pub fn optimal_damper<'py>(
    py: Python<'py>,
    problem: &Problem,
    #[pyo3(from_py_with = variation)] variation: Variation,
    dof: usize,
    bounds: (f64, f64),
    settings: &Bound<'_, PyAny>,
    progress: Option<Py<PyAny>>,
) -> PyResult<[Bound<'py, PyAny>; 2]> {
    let (target, settings) = (target(settings, dof)?, harmonic(settings)?);
    let model = Arc::clone(&problem.model);
    let found = keeping(
        py,
        progress,
        move |kept, look| optimum(&model, settings, &variation, bounds, &target, look, Some(kept)),
        |found| {
            let mut curve = rest(&found, &[])?;
            curve.peaks.sort_by(|a, b| a.value.total_cmp(&b.value));
            Some(Optimum { minima: Vec::new(), curve })
        },
    )?;
    Ok([written(py, &found.minima, &found.curve)?, written(py, &found.curve.peaks, &found.curve)?])
}

/// A problem of a map, with its settings and the DOF whose peak is sought.
type CellOf<'py> = (PyRef<'py, Problem>, Bound<'py, PyAny>, usize);

/// Amplitude, frequency, harmonics and status of the peaks of all problems of a map, as far as Ctrl-C lets it.
#[pyfunction]
pub fn peak_map(
    py: Python<'_>,
    cells: Vec<CellOf<'_>>,
    grid: Vec<f64>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Vec<(f64, f64, usize, u8)>> {
    let cell = |(problem, settings, dof): CellOf<'_>| {
        Ok((Arc::clone(&problem.model), harmonic(&settings)?, dof))
    };
    let cells: Vec<Cell> = cells.into_iter().map(cell).collect::<PyResult<_>>()?;
    let count = cells.len();
    let peaks = keeping(
        py,
        progress,
        move |kept, look| design::peak_map(&cells, &grid, threads, kept, look),
        |found: Vec<Arc<(usize, CellPeak)>>| {
            let mut peaks = vec![CellPeak::NOT_COMPUTED; count];
            found.iter().for_each(|cell| peaks[cell.0] = cell.1);
            Some(peaks)
        },
    )?;
    let told = |peak: &CellPeak| (peak.amplitude, peak.omega, peak.harmonics, peak.status as u8);
    Ok(peaks.iter().map(told).collect())
}

/// What amplitudes are differentiated by: "omega", "level", or a parameter of a contact or of one of
/// its points.
#[derive(FromPyObject)]
pub enum CauseArgument {
    Named(String),
    Law((usize, Option<usize>, String)),
}

impl CauseArgument {
    fn parse(&self, model: &Model) -> PyResult<Cause> {
        let unknown = |text: String| PyValueError::new_err(format!("sensitivity: no {text}"));
        match self {
            Self::Named(name) if name == "omega" => Ok(Cause::Frequency),
            Self::Named(name) if name == "level" => Ok(Cause::Load),
            Self::Named(name) => Err(unknown(name.clone())),
            Self::Law((contact, point, name)) => {
                let law = model.laws().get(*contact);
                let parameters = law.map(|law| law.parameters()).unwrap_or_default();
                let mut found = (0..parameters.len()).filter(|&at| {
                    let known = parameters[at];
                    known.name == name && (point.is_none() || known.point == *point)
                });
                let parameter = found.next().filter(|_| found.next().is_none());
                parameter
                    .map(|parameter| Cause::Law { contact: *contact, parameter })
                    .ok_or_else(|| unknown(format!("parameter {name} of contact {contact}")))
            }
        }
    }
}

/// Derivatives of the amplitude of a DOF at solved points, one column per cause.
#[pyfunction]
pub fn sensitivity<'py>(
    py: Python<'py>,
    problem: &Problem,
    omega: Vec<f64>,
    harmonics: Vec<usize>,
    contact_displacement: Array3<'py, Complex64>,
    half_wave: bool,
    #[pyo3(from_py_with = residual)] residual: Residual,
    dof: usize,
    #[pyo3(from_py_with = measure)] measure: Measure,
    causes: Vec<CauseArgument>,
    samples: Vec<usize>,
    all_marched: bool,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let model: &Model = &problem.model;
    let causes: Vec<Cause> =
        causes.iter().map(|cause| cause.parse(model)).collect::<PyResult<_>>()?;
    let shape = contact_displacement.shape();
    let (points, orders, contacts) = (shape[0], shape[1], shape[2]);
    let solved: Vec<Complex64> = contact_displacement.as_array().iter().copied().collect();
    let amplitude = move |n: usize, k: usize, i: usize| solved[(n * orders + k) * contacts + i];
    let (own, columns) = (Arc::clone(&problem.model), causes.len());
    let rows = watch::whole(py, move |look| {
        let mut rows = Vec::with_capacity(points * causes.len());
        let mut last: Option<SampleTable> = None;
        for (n, (&omega, &highest)) in omega.iter().zip(&harmonics).enumerate() {
            let highest = highest.clamp(1, orders.max(2) - 1);
            if !look(n as f64 / points as f64) {
                return Ok(Vec::new());
            }
            let sample_table = match last.take() {
                Some(table) if table.harmonics().highest() == highest => table,
                _ => SampleTable::new(Harmonics::new(highest, half_wave)),
            };
            let values = (0..contacts)
                .flat_map(|i| series(sample_table.harmonics(), |k| amplitude(n, k, i)))
                .collect();
            let solution = Unknowns::new(sample_table.harmonics().clone(), values);
            let marched = evaluated(&own, samples[n], all_marched)?;
            let slopes = Linearised::new(&marched, &sample_table, residual, omega, &solution)
                .and_then(|mut linearised| linearised.amplitude(dof, measure, &causes));
            rows.extend(slopes?.1);
            last = Some(sample_table);
        }
        Ok(rows)
    })?;
    table(py, points, columns, rows)
}
