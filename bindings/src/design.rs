//! Damper design: peaks along a parameter, the least of them, and sensitivities.

use crate::arrays::{refused, series, table, Array1, Array3};
use crate::columns::{status_code, timings, Columns};
use crate::problem::Problem;
use crate::response::ResidualArgument;
use crate::settings::{evaluated, HarmonicSettings, PeakSettings};
use crate::variation::Varied;
use crate::watch;
use numpy::{Complex64, PyArray2, PyUntypedArrayMethods as _};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict as _, PyDict};
use std::sync::Arc;
use stickslip_core::balance::{Cause, Linearised, Settings, Unknowns};
use stickslip_core::design::{optimum, peak_curve, Curve, Peak, Target};
use stickslip_core::fourier::{Harmonics, Measure, SampleTable};
use stickslip_core::model::Variation;
use stickslip_core::Model;

/// Peaks along a parameter.
#[pyclass(frozen, get_all, module = "stickslip._core")]
pub struct Peaks {
    columns: Py<PyDict>,
    interrupted: bool,
    timings: Py<PyDict>,
    counters: Py<PyDict>,
}

impl Peaks {
    /// Some of the peaks of a curve.
    fn new(py: Python<'_>, peaks: &[Peak], curve: &Curve) -> PyResult<Self> {
        let columns = Columns::new(py);
        let peaks = || peaks.iter();
        columns.one("value", peaks().map(|p| p.value))?;
        columns.one("omega", peaks().map(|p| p.omega))?;
        columns.one("amplitude", peaks().map(|p| p.amplitude))?;
        columns.one("sensitivity", peaks().map(|p| p.slope))?;
        columns.one("error_estimate", peaks().map(|p| p.error_estimate))?;
        columns.one("harmonics", peaks().map(|p| p.harmonics as i64))?;
        columns.one("at_edge", peaks().map(|p| p.at_edge))?;
        columns.one("status", peaks().map(|p| status_code(p.status)))?;
        let profile = &curve.profile;
        let counters = [
            ("points", curve.points),
            ("evaluations", profile.evaluations),
            ("factorisations", profile.factorisations),
            ("homotopies", profile.homotopies),
        ];
        Ok(Self {
            columns: columns.end(),
            interrupted: curve.interrupted,
            timings: timings(py, profile)?,
            counters: counters.into_py_dict(py)?.unbind(),
        })
    }
}

/// The peak that is followed, and how it is solved for: `DamperSettings` of Python.
pub struct DamperSettings {
    peak: PeakSettings,
    harmonic: HarmonicSettings,
}

impl<'a, 'py> FromPyObject<'a, 'py> for DamperSettings {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self { peak: given.extract()?, harmonic: given.extract()? })
    }
}

impl DamperSettings {
    fn parse(&self, dof: usize) -> PyResult<(Target, Settings)> {
        let measure: Measure = self.peak.measure.parse().map_err(refused)?;
        Ok((Target { dof, measure, span: self.peak.span }, self.harmonic.parse()?))
    }
}

/// Runs an analysis that Ctrl-C may end early.
fn watched<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&dyn Fn(f64) -> bool) -> Result<T, stickslip_core::Error> + Send + 'static,
) -> PyResult<T> {
    let (result, raised) = watch::watched(py, progress, work)?;
    raised.raise_unless_interrupt(py)?;
    result.ok_or_else(watch::given_up)?.map_err(refused)
}

/// The peak at every value of a parameter.
#[pyfunction]
pub fn damper_curve(
    py: Python<'_>,
    problem: &Problem,
    variation: Varied,
    dof: usize,
    values: Array1<'_, f64>,
    settings: DamperSettings,
    progress: Option<Py<PyAny>>,
) -> PyResult<Peaks> {
    let (variation, (target, settings)) = (Variation::from(variation), settings.parse(dof)?);
    let values = values.as_array().to_vec();
    let model = Arc::clone(&problem.model);
    let curve = watched(py, progress.as_ref(), move |look| {
        peak_curve(&model, settings, &variation, &values, &target, look)
    })?;
    Peaks::new(py, &curve.peaks, &curve)
}

/// The local minima of the peak over a parameter, the least first, and all peaks computed.
#[pyfunction]
pub fn optimal_damper(
    py: Python<'_>,
    problem: &Problem,
    variation: Varied,
    dof: usize,
    bounds: (f64, f64),
    settings: DamperSettings,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Peaks, Peaks)> {
    let (variation, (target, settings)) = (Variation::from(variation), settings.parse(dof)?);
    let model = Arc::clone(&problem.model);
    let found = watched(py, progress.as_ref(), move |look| {
        optimum(&model, settings, &variation, bounds, &target, look)
    })?;
    let curve = &found.curve;
    Ok((Peaks::new(py, &found.minima, curve)?, Peaks::new(py, &curve.peaks, curve)?))
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
#[allow(clippy::too_many_arguments)]
pub fn sensitivity<'py>(
    py: Python<'py>,
    problem: &Problem,
    omega: Array1<'py, f64>,
    harmonics: Array1<'py, i64>,
    contact_displacement: Array3<'py, Complex64>,
    half_wave: bool,
    residual: ResidualArgument,
    dof: usize,
    measure: &str,
    causes: Vec<CauseArgument>,
    samples: Array1<'py, i64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let model: &Model = &problem.model;
    let measure: Measure = measure.parse().map_err(refused)?;
    let residual = residual.parse()?;
    let causes: Vec<Cause> =
        causes.iter().map(|cause| cause.parse(model)).collect::<PyResult<_>>()?;
    let (omega, harmonics) = (omega.as_array().to_vec(), harmonics.as_array().to_vec());
    let samples = samples.as_array().to_vec();
    let shape = contact_displacement.shape();
    let (points, orders, contacts) = (shape[0], shape[1], shape[2]);
    if points != omega.len()
        || harmonics.len() != omega.len()
        || samples.len() != omega.len()
        || contacts != model.compliance().contacts()
        || dof >= model.compliance().dofs()
    {
        return Err(PyValueError::new_err("sensitivity: arrays of another model"));
    }
    let solved: Vec<Complex64> = contact_displacement.as_array().iter().copied().collect();
    let amplitude = move |n: usize, k: usize, i: usize| solved[(n * orders + k) * contacts + i];
    let (own, columns) = (Arc::clone(&problem.model), causes.len());
    let rows = watch::whole(py, move |look| {
        let mut rows = Vec::with_capacity(points * causes.len());
        let mut last: Option<SampleTable> = None;
        for (n, (&omega, &highest)) in omega.iter().zip(&harmonics).enumerate() {
            let highest = usize::try_from(highest).unwrap_or(0).clamp(1, orders.max(2) - 1);
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
            let march = usize::try_from(samples[n]).ok().filter(|&march| march > 0);
            let marched = evaluated(&own, march)?;
            let slopes = Linearised::new(&marched, &sample_table, residual, omega, &solution)
                .and_then(|mut linearised| linearised.amplitude(dof, measure, &causes));
            rows.extend(slopes?.1);
            last = Some(sample_table);
        }
        Ok(rows)
    })?
    .map_err(refused)?;
    table(py, points, columns, rows)
}
