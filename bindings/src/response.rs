//! Forced response: settings in, curves out, progress and Ctrl-C in between.

use crate::arrays::{
    either, indices, is_half_wave, padded, refused, series, table, vector, Array1, Array2,
};
use crate::problem::Problem;
pub use crate::settings::ResidualArgument;
use crate::settings::{parse_method, settings, March};
use crate::watch::{given_up, watched};
use numpy::{Complex64, PyArray1, PyArray2, PyArray3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::mem::take;
use std::sync::Arc;
use stickslip_core::balance::{
    self, sweep, sweep_range, ForcedBalance, Kept, Point, PointStatus, Progress, HIGHEST_ORDER,
};
use stickslip_core::contact::PointSummary;
use stickslip_core::fourier::{self, Harmonics, Measure, SampleTable};
use stickslip_core::orbit::Rescue;
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
    Ok(Solution { inner, observed, contacts: model.compliance().contacts() })
}

/// A curve of periodic responses.
#[pyclass(frozen, module = "stickslip._core")]
pub struct Solution {
    inner: stickslip_core::balance::Solution,
    observed: usize,
    contacts: usize,
}

impl Solution {
    fn points(&self) -> &[Arc<Point>] {
        &self.inner.points
    }

    fn amplitudes<'py>(
        &self,
        py: Python<'py>,
        columns: usize,
        of: impl Fn(&Point) -> &[Complex64],
    ) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        padded(py, columns, self.points().iter().map(|p| (p.harmonics, of(p))))
    }

    fn rows<'py>(
        &self,
        py: Python<'py>,
        columns: usize,
        add: impl Fn(&Point, &mut Vec<f64>),
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mut values = Vec::with_capacity(self.points().len() * columns);
        self.points().iter().for_each(|point| add(point, &mut values));
        table(py, self.points().len(), columns, values)
    }
}

#[pymethods]
impl Solution {
    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.points().iter().map(|p| p.omega))
    }

    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        self.amplitudes(py, self.observed, |p| &p.displacement)
    }

    #[getter]
    fn contact_displacement<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        self.amplitudes(py, self.contacts, |p| &p.contact_displacement)
    }

    #[getter]
    fn contact_force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        self.amplitudes(py, self.contacts, |p| &p.contact_force)
    }

    #[getter]
    fn harmonics<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        vector(py, self.points().iter().map(|p| p.harmonics as i64))
    }

    #[getter]
    fn samples<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        vector(py, self.points().iter().map(|p| p.samples.unwrap_or(0) as i64))
    }

    #[getter]
    fn half_wave(&self) -> bool {
        self.inner.half_wave
    }

    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        vector(py, self.points().iter().map(|p| status_code(p.status)))
    }

    #[getter]
    fn residual<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.points().iter().map(|p| p.residual))
    }

    #[getter]
    fn iterations<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        vector(py, self.points().iter().map(|p| p.iterations as i64))
    }

    #[getter]
    fn error_estimate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.observed, |p, out| out.extend_from_slice(&p.error_estimate))
    }

    #[getter]
    fn slip_fraction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let share = |c: &PointSummary| c.slip_fraction;
        self.rows(py, self.contacts, |p, out| out.extend(p.contacts.iter().map(share)))
    }

    #[getter]
    fn dissipation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let work = |c: &PointSummary| c.dissipation;
        self.rows(py, self.contacts, |p, out| out.extend(p.contacts.iter().map(work)))
    }

    /// Number of points that were computed.
    #[getter]
    fn computed(&self) -> usize {
        let computed = |status: PointStatus| status != PointStatus::NotComputed;
        self.points().iter().filter(|p| computed(p.status)).count()
    }

    #[getter]
    fn interrupted(&self) -> bool {
        self.inner.interrupted
    }

    #[getter]
    fn timings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        timings(py, &self.inner.profile)
    }

    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let iterations = self.points().iter().map(|p| p.iterations).sum();
        counters(py, &self.inner.profile, iterations)
    }
}

/// Number of a status, as Python knows it.
pub fn status_code(status: PointStatus) -> u8 {
    match status {
        PointStatus::Converged => 0,
        PointStatus::Stalled => 1,
        PointStatus::Singular => 2,
        PointStatus::NotComputed => 3,
        PointStatus::HarmonicsLimit => 4,
        // 5 is an orbit that did not close.
        PointStatus::SamplesLimit => 6,
        PointStatus::StepsLimit => 7,
    }
}

/// Seconds by stage.
pub fn timings<'py>(py: Python<'py>, profile: &Profile) -> PyResult<Bound<'py, PyDict>> {
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

/// Work by kind.
pub fn counters<'py>(
    py: Python<'py>,
    profile: &Profile,
    iterations: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let counters = PyDict::new(py);
    counters.set_item("iterations", iterations)?;
    counters.set_item("evaluations", profile.evaluations)?;
    counters.set_item("factorisations", profile.factorisations)?;
    counters.set_item("updates", profile.updates)?;
    counters.set_item("restarts", profile.restarts)?;
    counters.set_item("homotopies", profile.homotopies)?;
    Ok(counters)
}

/// Harmonic balance over a grid or a range of frequencies.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn forced_response(
    py: Python<'_>,
    problem: &Problem,
    omega: Frequencies<'_>,
    observe: Array1<'_, i64>,
    driving: Array1<'_, i64>,
    harmonics: Option<usize>,
    tolerance: f64,
    residual: ResidualArgument,
    method: &str,
    jacobian: &str,
    march: Option<March>,
    max_harmonics: usize,
    max_samples: usize,
    max_iterations: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Solution> {
    let method = parse_method(method, jacobian)?;
    let settings =
        settings(harmonics, tolerance, &residual, method, max_harmonics, max_iterations)?;
    let settings = March::applied(march, max_samples, settings)?;
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
        let rescue = Rescue::new(model, settings.residual, look);
        let fresh_start = |omega: f64, highest: usize| rescue.amplitudes(omega, highest);
        let balance = ForcedBalance::new(model, settings, &observe)?
            .watched(look)
            .rescued(&fresh_start)
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
