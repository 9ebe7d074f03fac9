//! What Python gives as settings, as the core has them.

use crate::arrays::either;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::balance::{Evaluation, HarmonicChoice, Method, SampleChoice, Settings};
use stickslip_core::contact::Residual;
use stickslip_core::model::Model;
use stickslip_core::solve::{FirstJacobian, NewtonSettings};

/// The assumed mean force of contacts that never slip: a name or a force in N.
pub enum ResidualArgument {
    Force(f64),
    Name(String),
}

impl<'a, 'py> FromPyObject<'a, 'py> for ResidualArgument {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        either(given, "a force in N or a name", Self::Force, Self::Name)
    }
}

impl ResidualArgument {
    pub fn parse(&self) -> PyResult<Residual> {
        match self {
            Self::Force(force) => Ok(Residual::Value(*force)),
            Self::Name(name) if name == "centred" => Ok(Residual::Centred),
            Self::Name(name) if name == "from_rest" => Ok(Residual::FromRest),
            Self::Name(name) => Err(PyValueError::new_err(format!(
                "residual = \"{name}\": must be \"centred\", \"from_rest\" or a force in N"
            ))),
        }
    }
}

/// Settings from what Python gives.
pub fn settings(
    harmonics: Option<usize>,
    tolerance: f64,
    residual: &ResidualArgument,
    method: Method,
    max_harmonics: usize,
    max_iterations: usize,
) -> PyResult<Settings> {
    Ok(Settings {
        harmonics: harmonics.map_or(HarmonicChoice::Auto, HarmonicChoice::Fixed),
        tolerance,
        residual: residual.parse()?,
        max_harmonics,
        method,
        newton: NewtonSettings { max_iterations, ..NewtonSettings::default() },
        ..Settings::default()
    })
}

/// Samples per period of a march: a number or "auto".
pub enum March {
    Samples(usize),
    Name(String),
}

impl<'a, 'py> FromPyObject<'a, 'py> for March {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        either(given, "a number of samples or \"auto\"", Self::Samples, Self::Name)
    }
}

impl March {
    /// The settings with laws that are marched, if a march is given.
    pub fn applied(
        march: Option<Self>,
        max_samples: usize,
        settings: Settings,
    ) -> PyResult<Settings> {
        let evaluation = match march {
            None => Evaluation::Direct,
            Some(Self::Samples(samples)) => Evaluation::Marched(SampleChoice::Fixed(samples)),
            Some(Self::Name(name)) if name == "auto" => Evaluation::Marched(SampleChoice::Auto),
            Some(Self::Name(name)) => {
                return Err(PyValueError::new_err(format!(
                    "samples = \"{name}\": must be a number or \"auto\""
                )))
            }
        };
        Ok(Settings { evaluation, max_samples, ..settings })
    }
}

/// A solver by its name, with the first Jacobian of Broyden's method.
pub fn parse_method(method: &str, jacobian: &str) -> PyResult<Method> {
    match (method, jacobian) {
        ("newton", _) => Ok(Method::Newton),
        ("broyden", "exact") => Ok(Method::Broyden(FirstJacobian::Exact)),
        ("broyden", "differences") => Ok(Method::Broyden(FirstJacobian::Differences)),
        _ => Err(PyValueError::new_err(format!(
            "method = \"{method}\", jacobian = \"{jacobian}\": must be \"newton\" or \"broyden\", the latter with \"exact\" or \"differences\""
        ))),
    }
}

/// The model with its laws evaluated exactly, or marched through some samples per period.
pub fn evaluated(
    model: &Arc<Model>,
    march: Option<usize>,
) -> Result<Arc<Model>, stickslip_core::Error> {
    march.map_or_else(|| Ok(Arc::clone(model)), |samples| model.marched(samples).map(Arc::new))
}
