//! Exact periodic orbits: settings in, orbits out.

use crate::arrays::{check_samples, indices, refused, table, Array1};
use crate::columns::Columns;
use crate::problem::Problem;
use crate::response::Solution;
use crate::settings::SteadySettings;
use crate::watch::{given_up, watched, whole};
use numpy::PyArray2;
use pyo3::prelude::*;
use std::mem::take;
use std::sync::Arc;
use stickslip_core::balance::Kept;
use stickslip_core::fourier::Measure;
use stickslip_core::motion::{transient, Scheme, TransientSettings};
use stickslip_core::orbit::{orbit_peak, orbit_sweep, OrbitSettings, PeriodicOrbits, Rotation};
use stickslip_core::timing::Profile;

/// Sectors, shift, wrap, sign and parts.
type RotationArgument = (usize, usize, f64, f64, usize);

fn rotation_of((sectors, shift, wrap, sign, parts): RotationArgument) -> Rotation {
    Rotation { sectors, shift, wrap, sign, parts }
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
    rotation: Option<RotationArgument>,
) -> PyResult<Solution> {
    let settings = OrbitSettings { harmonics, ..settings.parse()? };
    let rotation = rotation.map(rotation_of);
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
    let contacts = model.compliance().contacts();
    let states = model.states();
    let orbits = || inner.points.iter();
    let responses = orbits().map(|orbit| &orbit.response);
    let columns = Columns::new(py);
    columns.responses(responses.clone(), observed, contacts)?;
    columns.ranges(observed, orbits().map(|o| o.range.as_slice()))?;
    columns.numbers("state", states, orbits().map(|o| o.state.as_slice()))?;
    columns.multipliers(states, orbits().map(|o| (o.multipliers.as_slice(), o.neutral)))?;
    columns.one("work", orbits().map(|o| o.work))?;
    columns.one("viscous", orbits().map(|o| o.viscous))?;
    columns.one("event_count", orbits().map(|o| o.events.len() as i64))?;
    columns.events(orbits().flat_map(|o| &o.events))?;
    Solution::new(py, columns, responses, inner.half_wave, inner.interrupted, &inner.profile)
}

/// Frequency and exact amplitude at the true maximum of one DOF; `bracket` holds the lowest, the
/// likely and the highest frequency.
#[pyfunction]
#[pyo3(signature = (problem, bracket, dof, measure, settings, rotation=None))]
pub fn exact_peak(
    py: Python<'_>,
    problem: &Problem,
    bracket: [f64; 3],
    dof: usize,
    measure: &str,
    settings: SteadySettings,
    rotation: Option<RotationArgument>,
) -> PyResult<(f64, f64)> {
    let settings = settings.parse()?;
    let measure: Measure = measure.parse().map_err(refused)?;
    let model = Arc::clone(&problem.model);
    let rotation = rotation.map(rotation_of);
    whole(py, move |look| {
        let observe = [dof];
        PeriodicOrbits::new(&model, settings, &observe)
            .and_then(|orbits| orbits.rotating(rotation))
            .and_then(|orbits| orbit_peak(orbits.watched(look), measure, bracket))
    })?
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
