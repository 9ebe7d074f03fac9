//! Damper design: peaks along a parameter, the least of them, and sensitivities.

use crate::arrays::{refused, series, table, vector, Array1, Array3};
use crate::problem::Problem;
use crate::response::{status_code, ResidualArgument};
use crate::settings::{evaluated, settings};
use crate::variation::Varied;
use crate::watch;
use numpy::{Complex64, PyArray1, PyArray2, PyUntypedArrayMethods as _};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use stickslip_core::balance::{Cause, Linearised, Method, Settings, Unknowns};
use stickslip_core::design::{optimum, peak_curve, Curve, Peak, Target};
use stickslip_core::fourier::{Harmonics, Measure, SampleTable};
use stickslip_core::model::Variation;
use stickslip_core::Model;

/// Peaks along a parameter.
#[pyclass(frozen, module = "stickslip._core")]
pub struct Peaks {
    peaks: Vec<Peak>,
    curve: Curve,
}

impl From<Curve> for Peaks {
    fn from(curve: Curve) -> Self {
        Self { peaks: curve.peaks.clone(), curve }
    }
}

#[pymethods]
impl Peaks {
    #[getter]
    fn value<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.peaks.iter().map(|p| p.value))
    }

    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.peaks.iter().map(|p| p.omega))
    }

    #[getter]
    fn amplitude<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.peaks.iter().map(|p| p.amplitude))
    }

    #[getter]
    fn sensitivity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.peaks.iter().map(|p| p.slope))
    }

    #[getter]
    fn error_estimate<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.peaks.iter().map(|p| p.error_estimate))
    }

    #[getter]
    fn harmonics<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        vector(py, self.peaks.iter().map(|p| p.harmonics as i64))
    }

    #[getter]
    fn at_edge<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        vector(py, self.peaks.iter().map(|p| p.at_edge))
    }

    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        vector(py, self.peaks.iter().map(|p| status_code(p.status)))
    }

    #[getter]
    fn interrupted(&self) -> bool {
        self.curve.interrupted
    }

    #[getter]
    fn timings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let profile = &self.curve.profile;
        let timings = PyDict::new(py);
        for (stage, time) in [
            ("compliance", profile.compliance),
            ("law", profile.law),
            ("linear_solve", profile.linear_solve),
            ("recovery", profile.recovery),
            ("estimate", profile.estimate),
            ("total", profile.total),
        ] {
            timings.set_item(stage, time.as_secs_f64())?;
        }
        Ok(timings)
    }

    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let profile = &self.curve.profile;
        let counters = PyDict::new(py);
        counters.set_item("points", self.curve.points)?;
        counters.set_item("evaluations", profile.evaluations)?;
        counters.set_item("factorisations", profile.factorisations)?;
        counters.set_item("homotopies", profile.homotopies)?;
        Ok(counters)
    }
}

/// What is varied, and which peak is followed.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Design {
    variation: Varied,
    dof: usize,
    measure: String,
    omega: (f64, f64),
    harmonics: Option<usize>,
    tolerance: f64,
    residual: ResidualArgument,
    max_harmonics: usize,
    max_iterations: usize,
}

impl Design {
    fn parse(self) -> PyResult<(Variation, Target, Settings)> {
        let variation = self.variation.into();
        let measure: Measure = self.measure.parse().map_err(refused)?;
        let target = Target { dof: self.dof, measure, span: self.omega };
        let settings = settings(
            self.harmonics,
            self.tolerance,
            &self.residual,
            Method::Newton,
            self.max_harmonics,
            self.max_iterations,
        )?;
        Ok((variation, target, settings))
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
    design: Design,
    values: Array1<'_, f64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Peaks> {
    let (variation, target, settings) = design.parse()?;
    let values = values.as_array().to_vec();
    let model = Arc::clone(&problem.model);
    let curve = watched(py, progress.as_ref(), move |look| {
        peak_curve(&model, settings, &variation, &values, &target, look)
    })?;
    Ok(curve.into())
}

/// The local minima of the peak over a parameter, the least first, and all peaks computed.
#[pyfunction]
pub fn optimal_damper(
    py: Python<'_>,
    problem: &Problem,
    design: Design,
    bounds: (f64, f64),
    progress: Option<Py<PyAny>>,
) -> PyResult<(Peaks, Peaks)> {
    let (variation, target, settings) = design.parse()?;
    let model = Arc::clone(&problem.model);
    let found = watched(py, progress.as_ref(), move |look| {
        optimum(&model, settings, &variation, bounds, &target, look)
    })?;
    let minima = Peaks { peaks: found.minima, curve: found.curve.clone() };
    Ok((minima, found.curve.into()))
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
