//! Exact periodic orbits: settings in, orbits out.

use crate::arrays::{check_samples, indices, padded, refused, table, vector, Array1};
use crate::problem::Problem;
use crate::response::{counters, timings};
use crate::settings::SteadySettings;
use crate::watch::{given_up, watched, whole};
use numpy::{Complex64, PyArray1, PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::mem::take;
use std::sync::Arc;
use stickslip_core::balance::{Kept, Point, PointStatus};
use stickslip_core::contact::PointState;
use stickslip_core::fourier::Measure;
use stickslip_core::motion::{transient, Event, Scheme, TransientSettings};
use stickslip_core::orbit::{
    orbit_peak, orbit_sweep, Orbit, OrbitSettings, PeriodicOrbits, Rotation,
};
use stickslip_core::timing::Profile;

/// Times, contact points and kinds of events.
pub type EventColumns<'py> =
    (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<u8>>);

/// Columns of events.
pub fn event_columns<'py>(py: Python<'py>, events: &[Event]) -> EventColumns<'py> {
    let kind = |event: &Event| match event.state {
        PointState::Stuck => 0,
        PointState::Forward => 1,
        PointState::Backward => 2,
    };
    (
        vector(py, events.iter().map(|event| event.time)),
        vector(py, events.iter().map(|event| event.point as i64)),
        vector(py, events.iter().map(kind)),
    )
}

/// Exact periodic orbits over frequency.
#[pyclass(frozen, module = "stickslip._core")]
pub struct Orbits {
    inner: stickslip_core::orbit::Orbits,
    observed: usize,
    contacts: usize,
    states: usize,
}

impl Orbits {
    fn points(&self) -> &[Arc<Orbit>] {
        &self.inner.points
    }

    fn amplitudes<'py>(
        &self,
        py: Python<'py>,
        columns: usize,
        of: impl Fn(&Point) -> &[Complex64],
    ) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        padded(py, columns, self.points().iter().map(|o| (o.response.harmonics, of(&o.response))))
    }

    fn rows<'py, T: numpy::Element + Clone>(
        &self,
        py: Python<'py>,
        columns: usize,
        of: impl Fn(&Orbit) -> Vec<T>,
    ) -> PyResult<Bound<'py, PyArray2<T>>> {
        table(py, self.points().len(), columns, self.points().iter().flat_map(|o| of(o)).collect())
    }
}

#[pymethods]
impl Orbits {
    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.points().iter().map(|o| o.response.omega))
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

    /// Orbits are not marched.
    #[getter]
    fn samples<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        vector(py, self.points().iter().map(|_| 0_i64))
    }

    #[getter]
    fn harmonics<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        vector(py, self.points().iter().map(|o| o.response.harmonics as i64))
    }

    #[getter]
    fn half_wave(&self) -> bool {
        self.inner.half_wave
    }

    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        vector(py, self.points().iter().map(|o| crate::response::status_code(o.response.status)))
    }

    #[getter]
    fn residual<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.points().iter().map(|o| o.response.residual))
    }

    #[getter]
    fn iterations<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        vector(py, self.points().iter().map(|o| o.response.iterations as i64))
    }

    #[getter]
    fn error_estimate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.observed, |o| o.response.error_estimate.clone())
    }

    #[getter]
    fn slip_fraction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let share = |o: &Orbit| o.response.contacts.iter().map(|c| c.slip_fraction).collect();
        self.rows(py, self.contacts, share)
    }

    #[getter]
    fn dissipation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let work = |o: &Orbit| o.response.contacts.iter().map(|c| c.dissipation).collect();
        self.rows(py, self.contacts, work)
    }

    /// Lowest and highest displacement `(n, observed, 2)`.
    #[getter]
    fn range<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        use numpy::PyArrayMethods as _;
        let values = self.points().iter().flat_map(|o| o.range.iter().flatten().copied());
        vector(py, values.collect::<Vec<_>>()).reshape([self.points().len(), self.observed, 2])
    }

    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.rows(py, self.states, |o| o.state.clone())
    }

    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
        self.rows(py, self.states, |o| o.multipliers.clone())
    }

    #[getter]
    fn neutral<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        vector(py, self.points().iter().map(|o| o.neutral as i64))
    }

    #[getter]
    fn work<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.points().iter().map(|o| o.work))
    }

    #[getter]
    fn viscous<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, self.points().iter().map(|o| o.viscous))
    }

    /// Offsets of the points in the columns, and the columns.
    #[getter]
    #[allow(clippy::type_complexity)]
    fn events<'py>(
        &self,
        py: Python<'py>,
    ) -> (
        Bound<'py, PyArray1<i64>>,
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<i64>>,
        Bound<'py, PyArray1<u8>>,
    ) {
        let mut offsets = vec![0_i64];
        let mut events = Vec::new();
        for orbit in self.points() {
            events.extend_from_slice(&orbit.events);
            offsets.push(events.len() as i64);
        }
        let (time, point, kind) = event_columns(py, &events);
        (vector(py, offsets), time, point, kind)
    }

    /// Number of points that were computed.
    #[getter]
    fn computed(&self) -> usize {
        let computed = |status: PointStatus| status != PointStatus::NotComputed;
        self.points().iter().filter(|p| computed(p.response.status)).count()
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
        let iterations = self.points().iter().map(|o| o.response.iterations).sum();
        counters(py, &self.inner.profile, iterations)
    }
}

/// Exact periodic orbits over a grid of frequencies.
#[pyfunction]
#[pyo3(signature = (problem, omega, observe, harmonics, settings, progress, rotation=None))]
#[allow(clippy::too_many_arguments)]
pub fn exact_response(
    py: Python<'_>,
    problem: &Problem,
    omega: Array1<'_, f64>,
    observe: Array1<'_, i64>,
    harmonics: usize,
    settings: SteadySettings,
    progress: Option<Py<PyAny>>,
    rotation: Option<(usize, usize, f64, f64, usize)>,
) -> PyResult<Orbits> {
    let settings = OrbitSettings { harmonics, ..settings.parse()? };
    let rotation = rotation.map(|(sectors, shift, wrap, sign, parts)| Rotation {
        sectors,
        shift,
        wrap,
        sign,
        parts,
    });
    let observe = indices(&observe)?;
    let grid = omega.as_array().to_vec();
    let observed = observe.len();
    let kept = Arc::new(Kept::default());
    let (model, own_kept) = (Arc::clone(&problem.model), Arc::clone(&kept));
    let (inner, raised) = watched(py, progress.as_ref(), move |look| {
        PeriodicOrbits::new(&model, settings, &observe)
            .and_then(|orbits| orbits.rotating(rotation))
            .and_then(|orbits| orbit_sweep(orbits.watched(look).keeping(&own_kept), &grid))
    })?;
    raised.raise_unless_interrupt(py)?;
    let model = &problem.model;
    let inner = match inner {
        Some(inner) => inner.map_err(refused)?,
        None => {
            let points = kept.lock().map(|mut points| take(&mut *points)).unwrap_or_default();
            let half_wave = model.is_symmetric() && settings.residual.is_symmetric();
            if points.is_empty() {
                return Err(given_up());
            }
            let profile = Profile::default();
            stickslip_core::orbit::Orbits { points, half_wave, interrupted: true, profile }
        }
    };
    Ok(Orbits { inner, observed, contacts: model.compliance().contacts(), states: model.states() })
}

/// Frequency and exact amplitude at the true maximum of one DOF; `bracket` holds the lowest, the
/// likely and the highest frequency.
#[pyfunction]
pub fn exact_peak(
    py: Python<'_>,
    problem: &Problem,
    bracket: [f64; 3],
    dof: usize,
    measure: &str,
    settings: SteadySettings,
) -> PyResult<(f64, f64)> {
    let settings = settings.parse()?;
    let measure: Measure = measure.parse().map_err(refused)?;
    let model = Arc::clone(&problem.model);
    whole(py, move |look| orbit_peak(&model, settings, dof, measure, bracket, look))?
        .map_err(refused)
}

type OrbitHistory<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
);

/// One period from a state: displacements, velocities, contact displacements and forces.
#[pyfunction]
pub fn orbit_history<'py>(
    py: Python<'py>,
    problem: &Problem,
    omega: f64,
    state: Array1<'_, f64>,
    observe: Array1<'_, i64>,
    samples: usize,
) -> PyResult<OrbitHistory<'py>> {
    let observe = indices(&observe)?;
    check_samples(samples, 2 * (observe.len() + problem.model.compliance().contacts()))?;
    let state = state.as_array().to_vec();
    let settings = TransientSettings {
        omega,
        scheme: Scheme::Exact,
        periods: 1,
        tolerance: None,
        samples,
        keep: None,
    };
    let model = &problem.model;
    let (own, dofs) = (Arc::clone(model), observe.clone());
    let history = whole(py, move |look| transient(&own, &settings, Some(&state), &dofs, look))?
        .map_err(refused)?;
    let points = model.compliance().contacts();
    // The end of the period is its beginning.
    let part = |values: &[f64], columns: usize| {
        table(py, samples, columns, values[..samples * columns].to_vec())
    };
    let trace = &history.trace;
    if trace.time.len() <= samples {
        return Err(pyo3::exceptions::PyValueError::new_err(
            "state: the motion from it is unbounded within a period",
        ));
    }
    Ok((
        part(&trace.displacement, observe.len())?,
        part(&trace.velocity, observe.len())?,
        part(&trace.contact_displacement, points)?,
        part(&trace.force, points)?,
    ))
}
