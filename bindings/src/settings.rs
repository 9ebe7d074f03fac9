//! What Python gives as settings, as the core has them.

use crate::arrays::either;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::balance::{Evaluation, HarmonicChoice, Method, SampleChoice, Settings};
use stickslip_core::contact::Residual;
use stickslip_core::model::Model;
use stickslip_core::orbit::OrbitSettings;
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

/// Which harmonics are kept, and how far their equations are solved: `HarmonicSettings` of Python.
#[derive(FromPyObject)]
pub struct HarmonicSettings {
    fixed_harmonics: Option<usize>,
    tolerance: f64,
    residual: ResidualArgument,
    max_harmonics: usize,
    max_iterations: usize,
}

impl HarmonicSettings {
    /// The settings of the core, with Newton's method and laws in closed form.
    pub fn parse(&self) -> PyResult<Settings> {
        Ok(Settings {
            harmonics: self.fixed_harmonics.map_or(HarmonicChoice::Auto, HarmonicChoice::Fixed),
            tolerance: self.tolerance,
            residual: self.residual.parse()?,
            max_harmonics: self.max_harmonics,
            newton: NewtonSettings {
                max_iterations: self.max_iterations,
                ..NewtonSettings::default()
            },
            ..Settings::default()
        })
    }
}

/// How the balance is solved and its laws are evaluated: `BalanceSettings` of Python.
pub struct BalanceSettings {
    harmonic: HarmonicSettings,
    solver: Solver,
    evaluation: LawEvaluation,
}

#[derive(FromPyObject)]
struct Solver {
    method: String,
    jacobian: String,
}

impl<'a, 'py> FromPyObject<'a, 'py> for BalanceSettings {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        Ok(Self {
            harmonic: given.extract()?,
            solver: given.extract()?,
            evaluation: given.extract()?,
        })
    }
}

impl BalanceSettings {
    /// The settings of the core.
    pub fn parse(self) -> PyResult<Settings> {
        let method = parse_method(&self.solver.method, &self.solver.jacobian)?;
        self.evaluation.apply(Settings { method, ..self.harmonic.parse()? })
    }
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

/// Whether laws are marched, and through how many samples at most.
#[derive(FromPyObject)]
pub struct LawEvaluation {
    march: Option<March>,
    max_samples: usize,
}

impl LawEvaluation {
    /// The settings with laws that are marched, if a march is given.
    pub fn apply(self, settings: Settings) -> PyResult<Settings> {
        let evaluation = match self.march {
            None => Evaluation::Direct,
            Some(March::Samples(samples)) => Evaluation::Marched(SampleChoice::Fixed(samples)),
            Some(March::Name(name)) if name == "auto" => Evaluation::Marched(SampleChoice::Auto),
            Some(March::Name(name)) => {
                return Err(PyValueError::new_err(format!(
                    "samples = \"{name}\": must be a number or \"auto\""
                )))
            }
        };
        Ok(Settings { evaluation, max_samples: self.max_samples, ..settings })
    }
}

/// Of which amplitude the highest point is sought, and in which range of frequencies.
#[derive(FromPyObject)]
pub struct PeakSettings {
    pub measure: String,
    pub span: (f64, f64),
}

/// How long an orbit is iterated, and what it leaves open.
#[derive(FromPyObject)]
pub struct SteadySettings {
    residual: ResidualArgument,
    max_iterations: usize,
}

impl SteadySettings {
    /// The settings of shooting.
    pub fn parse(&self) -> PyResult<OrbitSettings> {
        let residual = self.residual.parse()?;
        let max_iterations = self.max_iterations;
        Ok(OrbitSettings { residual, max_iterations, ..OrbitSettings::default() })
    }
}

/// A solver by its name, with the first Jacobian of Broyden's method.
fn parse_method(method: &str, jacobian: &str) -> PyResult<Method> {
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
