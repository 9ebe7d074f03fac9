//! What a friction law does along a given motion.

use crate::arrays::{check_samples, coefficients, refused, table, Array2};
use crate::problem::Problem;
use crate::settings::{evaluated, residual};
use crate::watch::whole;
use numpy::{Complex64, PyArray1, PyArray2};
use pyo3::prelude::*;
use stickslip_core::contact::{ContactLaw, Motion, Residual};
use stickslip_core::fourier::SampleTable;

/// Hands the law of a contact and its motion to `work`, for displacements `(points, H+1)`.
fn along<R: Send + 'static>(
    py: Python<'_>,
    problem: &Problem,
    contact: usize,
    displacement: &Array2<'_, Complex64>,
    residual: Residual,
    march: (usize, bool),
    work: impl FnOnce(&dyn ContactLaw, Motion<'_>) -> R + Send + 'static,
) -> PyResult<R> {
    let known = problem.assuming(residual).map_err(refused)?;
    let model = evaluated(known, march.0, march.1).map_err(refused)?;
    // A normal load that varies does not change its sign with the motion.
    let odd = model.laws()[contact].is_odd() && residual.is_symmetric();
    let (harmonics, displacement) = coefficients(displacement, odd)?;
    whole(py, move |_| {
        let sample_table = SampleTable::new(harmonics);
        let motion = Motion { table: &sample_table, displacement: &displacement, residual };
        Ok(work(model.laws()[contact].as_ref(), motion))
    })
}

/// Contact force over one period as the law gives it for displacements `(points, H+1)`.
#[pyfunction]
pub fn contact_force<'py>(
    py: Python<'py>,
    problem: &Problem,
    contact: usize,
    displacement: Array2<'py, Complex64>,
    #[pyo3(from_py_with = residual)] residual: Residual,
    march: (usize, bool),
    samples: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let points = displacement.as_array().nrows();
    check_samples(samples, points)?;
    let force = along(py, problem, contact, &displacement, residual, march, move |law, motion| {
        law.force_history(motion, samples)
    })?;
    table(py, samples, points, force)
}

/// Stretches of the period in which no point changes its state: their starts as angles, and the
/// direction of slip of every point, 0 in stick.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn contact_phases<'py>(
    py: Python<'py>,
    problem: &Problem,
    contact: usize,
    displacement: Array2<'py, Complex64>,
    #[pyo3(from_py_with = residual)] residual: Residual,
    march: (usize, bool),
) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>)> {
    let points = displacement.as_array().nrows();
    let phases = along(py, problem, contact, &displacement, residual, march, |law, motion| {
        law.phases(motion)
    })?;
    let states = phases.iter().flat_map(|phase| phase.states.iter().map(|state| state.sign()));
    let states = table(py, phases.len(), points, states.collect())?;
    Ok((PyArray1::from_iter(py, phases.iter().map(|phase| phase.start)), states))
}
