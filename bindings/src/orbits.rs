//! Exact periodic orbits: settings in, orbits out.

use crate::arrays::{check_samples, table};
use crate::columns::Columns;
use crate::problem::Problem;
use crate::response::{curve, keeping};
use crate::settings::{measure, orbit};
use crate::watch::whole;
use numpy::PyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::balance::{without_gap, Settings};
use stickslip_core::design::bound_orbits;
use stickslip_core::fourier::Measure;
use stickslip_core::motion::{transient, Scheme, TransientSettings};
use stickslip_core::orbit::{
    orbit_peak, orbit_sweep, OrbitSettings, Orbits, PeriodicOrbits, Rotation,
};
use stickslip_core::timing::Profile;

/// The symmetry of a travelling wave, `Rotation` of Python; none of another model.
fn rotation(given: &Bound<'_, PyAny>) -> PyResult<Option<Rotation>> {
    let given = given.extract::<Option<(usize, usize, f64, f64, usize)>>()?;
    let of = |(sectors, shift, wrap, sign, parts)| Rotation { sectors, shift, wrap, sign, parts };
    Ok(given.map(of))
}

/// Exact periodic orbits over a grid of frequencies. `bounds` asks for those over the residual tractions,
/// and tells whether one vibration alone is known to exist and how accurately extremes are sought.
#[pyfunction]
#[pyo3(signature = (
    problem, omega, observe, harmonics, settings, progress, rotation=None, bounds=None
))]
pub fn exact_response<'py>(
    py: Python<'py>,
    problem: &Problem,
    omega: Vec<f64>,
    observe: Vec<usize>,
    harmonics: usize,
    #[pyo3(from_py_with = orbit)] settings: OrbitSettings,
    progress: Option<Py<PyAny>>,
    #[pyo3(from_py_with = rotation)] rotation: Option<Rotation>,
    bounds: Option<(bool, f64)>,
) -> PyResult<Bound<'py, PyAny>> {
    let settings = OrbitSettings { harmonics, ..settings };
    let (model, own, observed) = (&problem.model, Arc::clone(&problem.model), observe.len());
    let order = omega.clone();
    let found = keeping(
        py,
        progress,
        move |kept, look| {
            let orbits = PeriodicOrbits::new(&own, settings, &observe)?.rotating(rotation)?;
            let mut found = orbit_sweep(orbits.watched(look).keeping(kept), &omega)?;
            if let Some((proved, tolerance)) = bounds {
                let search = Settings { tolerance, ..Settings::default() };
                bound_orbits(&own, search, &observe, proved, (settings, &mut found), look)?;
            }
            Ok(found)
        },
        |mut points| {
            without_gap(&mut points, &order, |orbit| orbit.response.omega);
            let half_wave = model.is_symmetric() && settings.residual.is_symmetric();
            let profile = Profile::default();
            (!points.is_empty()).then_some(Orbits { points, half_wave, interrupted: true, profile })
        },
    )?;
    let (contacts, states) = (model.compliance().contacts(), model.states());
    let orbits = || found.points.iter();
    let responses = orbits().map(|orbit| &orbit.response);
    let mut columns = Columns::default();
    columns.responses(responses.clone(), observed, contacts);
    columns.ranges(observed, orbits().map(|o| o.range.as_slice()));
    columns.numbers("state", states, orbits().map(|o| o.state.as_slice()));
    columns.multipliers(states, orbits().map(|o| (o.multipliers.as_slice(), o.neutral)));
    columns.one("work", orbits().map(|o| o.work));
    columns.one("viscous", orbits().map(|o| o.viscous));
    columns.one("event_count", orbits().map(|o| o.events.len() as i64));
    columns.events(orbits().flat_map(|o| &o.events));
    curve(&mut columns, responses, found.half_wave, found.interrupted, &found.profile);
    columns.end(py)
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
    #[pyo3(from_py_with = measure)] measure: Measure,
    #[pyo3(from_py_with = orbit)] settings: OrbitSettings,
    #[pyo3(from_py_with = rotation)] rotation: Option<Rotation>,
) -> PyResult<(f64, f64)> {
    let model = Arc::clone(&problem.model);
    whole(py, move |look| {
        let observe = [dof];
        PeriodicOrbits::new(&model, settings, &observe)
            .and_then(|orbits| orbits.rotating(rotation))
            .and_then(|orbits| orbit_peak(orbits.watched(look), measure, bracket))
    })
}

type Table<'py> = Bound<'py, PyArray2<f64>>;

/// One period from a state: displacements, velocities, contact displacements and forces.
#[pyfunction]
pub fn orbit_history<'py>(
    py: Python<'py>,
    problem: &Problem,
    omega: f64,
    state: Vec<f64>,
    observe: Vec<usize>,
    samples: usize,
) -> PyResult<[Table<'py>; 4]> {
    check_samples(samples, 2 * (observe.len() + problem.model.compliance().contacts()))?;
    let settings = TransientSettings {
        omega,
        scheme: Scheme::Exact,
        periods: 1,
        tolerance: None,
        samples,
        keep: None,
    };
    let (points, columns) = (problem.model.compliance().contacts(), observe.len());
    let model = Arc::clone(&problem.model);
    let history =
        whole(py, move |look| transient(&model, &settings, Some(&state), &observe, look))?;
    // The end of the period is its beginning.
    let part = |values: &[f64], columns: usize| {
        table(py, samples, columns, values[..samples * columns].to_vec())
    };
    let trace = &history.trace;
    if trace.time.len() <= samples {
        return Err(PyValueError::new_err(
            "state: the motion from it is unbounded within a period",
        ));
    }
    Ok([
        part(&trace.displacement, columns)?,
        part(&trace.velocity, columns)?,
        part(&trace.contact_displacement, points)?,
        part(&trace.force, points)?,
    ])
}
