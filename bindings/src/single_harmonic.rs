//! The single-harmonic response: a grid in, curves out.

use crate::arrays::{indices, Array1};
use crate::problem::Problem;
use crate::response::{swept, Solution};
use pyo3::prelude::*;
use stickslip_core::balance::{self, ForcedBalance, HarmonicChoice, Settings};
use stickslip_core::solve::NewtonSettings;

/// How a single harmonic is balanced.
#[derive(FromPyObject)]
pub struct SingleSettings {
    estimate: bool,
    max_iterations: usize,
}

/// Single-harmonic balance over a grid of frequencies.
#[pyfunction]
pub fn single_harmonic(
    py: Python<'_>,
    problem: &Problem,
    omega: Array1<'_, f64>,
    observe: Array1<'_, i64>,
    settings: SingleSettings,
    progress: Option<Py<PyAny>>,
) -> PyResult<Solution> {
    let SingleSettings { estimate, max_iterations } = settings;
    let settings = Settings {
        harmonics: HarmonicChoice::Fixed(1),
        newton: NewtonSettings { max_iterations, ..NewtonSettings::default() },
        ..Settings::default()
    };
    let (grid, observe) = (omega.as_array().to_vec(), indices(&observe)?);
    swept(py, progress.as_ref(), observe.len(), &problem.model, move |model, kept, look| {
        let balance = ForcedBalance::new(model, settings, &observe)?.watched(look).keeping(kept);
        balance::single_harmonic(balance, &grid, estimate)
    })
}
