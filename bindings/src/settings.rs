//! What Python gives as settings, as the core has them. Python has checked every value.

use crate::arrays::refused;
use pyo3::conversion::FromPyObjectOwned;
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::balance::{Evaluation, HarmonicChoice, Method, SampleChoice, Settings};
use stickslip_core::contact::Residual;
use stickslip_core::fourier::Measure;
use stickslip_core::model::{MarchedLaws, Model, ParameterMode, Variation};
use stickslip_core::orbit::OrbitSettings;
use stickslip_core::solve::{FirstJacobian, NewtonSettings};

/// A value of the settings that Python gives.
pub fn get<'py, T: FromPyObjectOwned<'py>>(given: &Bound<'py, PyAny>, key: &str) -> PyResult<T> {
    given.getattr(key)?.extract().map_err(Into::into)
}

/// The assumed mean force of contacts that never slip: a name or a force in N.
pub fn residual(given: &Bound<'_, PyAny>) -> PyResult<Residual> {
    if let Ok(force) = given.extract() {
        return Ok(Residual::Value(force));
    }
    let from_rest = given.extract::<Option<String>>()?.is_some_and(|name| name == "from_rest");
    Ok(if from_rest { Residual::FromRest } else { Residual::Centred })
}

/// Of which amplitude.
pub fn measure(given: &Bound<'_, PyAny>) -> PyResult<Measure> {
    given.extract::<String>()?.parse().map_err(refused)
}

/// A number of harmonics, or none if they are chosen.
pub fn harmonics(fixed: Option<usize>) -> HarmonicChoice {
    fixed.map_or(HarmonicChoice::Auto, HarmonicChoice::Fixed)
}

/// Which harmonics are kept, and how far their equations are solved, with Newton's method and laws
/// in closed form: `HarmonicSettings` of Python.
pub fn harmonic(given: &Bound<'_, PyAny>) -> PyResult<Settings> {
    let max_iterations = get(given, "max_iterations")?;
    Ok(Settings {
        harmonics: harmonics(get(given, "fixed_harmonics")?),
        tolerance: get(given, "tolerance")?,
        residual: residual(&given.getattr("residual")?)?,
        max_harmonics: get(given, "max_harmonics")?,
        newton: NewtonSettings { max_iterations, ..NewtonSettings::default() },
        ..Settings::default()
    })
}

/// How the balance is solved and its laws are evaluated: `BalanceSettings` of Python.
pub fn balance(given: &Bound<'_, PyAny>) -> PyResult<Settings> {
    let first = match get::<String>(given, "jacobian")?.as_str() {
        "exact" => FirstJacobian::Exact,
        _ => FirstJacobian::Differences,
    };
    let newton = get::<String>(given, "method")? == "newton";
    let method = if newton { Method::Newton } else { Method::Broyden(first) };
    evaluation(given, Settings { method, ..harmonic(given)? })
}

/// The settings with laws that are marched, if Python gives a march.
pub fn evaluation(given: &Bound<'_, PyAny>, settings: Settings) -> PyResult<Settings> {
    let march = given.getattr("march")?;
    let evaluation = match march.extract::<usize>() {
        _ if march.is_none() => Evaluation::Direct,
        Ok(samples) => Evaluation::Marched(SampleChoice::Fixed(samples)),
        Err(_) => Evaluation::Marched(SampleChoice::Auto),
    };
    Ok(Settings { evaluation, max_samples: get(given, "max_samples")?, ..settings })
}

/// How long an orbit is iterated, and what it leaves open: `SteadySettings` of Python.
pub fn orbit(given: &Bound<'_, PyAny>) -> PyResult<OrbitSettings> {
    let residual = residual(&given.getattr("residual")?)?;
    let max_iterations = get(given, "max_iterations")?;
    Ok(OrbitSettings { residual, max_iterations, ..OrbitSettings::default() })
}

/// What is varied: `parameter` is "level" or one of the laws', of contacts or of points.
pub fn variation(given: &Bound<'_, PyAny>) -> PyResult<Variation> {
    let parameter: String = given.get_item("parameter")?.extract()?;
    if parameter == "level" {
        return Ok(Variation::Level);
    }
    let factor = given.get_item("factor")?.extract()?;
    let common = if factor { ParameterMode::Factor } else { ParameterMode::Value };
    Ok(Variation::Law { parameter, contacts: given.get_item("contacts")?.extract()?, common })
}

/// The model as it was solved: of its laws all, or those without a form of their own, were marched through
/// `samples` per period, if any.
pub fn evaluated(
    model: &Arc<Model>,
    samples: usize,
    all: bool,
) -> Result<Arc<Model>, stickslip_core::Error> {
    let laws = if all { MarchedLaws::All } else { MarchedLaws::Formless };
    match samples {
        0 => Ok(Arc::clone(model)),
        _ => model.marched(samples, laws).map(Arc::new),
    }
}
