//! Settings of a forced response, each with its default.

use crate::contact::Residual;
use crate::model::{MarchedLaws, Model};
use crate::solve::{FirstJacobian, NewtonSettings};
use crate::Error;

/// How many harmonics a balance keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HarmonicChoice {
    /// Harmonics up to a fixed order.
    Fixed(usize),
    /// As many at each point as the tolerance demands.
    Auto,
}

impl HarmonicChoice {
    /// Highest order that may be kept, `most` of automatic harmonics, with the name of its setting.
    pub(crate) fn highest(self, most: usize) -> (&'static str, usize) {
        match self {
            Self::Fixed(highest) => ("harmonics", highest),
            Self::Auto => ("max_harmonics", most),
        }
    }
}

/// What solves the equations at each point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Method {
    /// Newton's method: the exact Jacobian in every iteration.
    #[default]
    Newton,
    /// Broyden's method: one Jacobian, updated by rank one.
    Broyden(FirstJacobian),
}

/// How the friction laws are evaluated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Evaluation {
    /// As the laws know best: by exact integrals, if they have them.
    #[default]
    Direct,
    /// The same, and laws that have none marched.
    Mixed(SampleChoice),
    /// All marched through equidistant samples (see [`crate::contact::Aft`]).
    Marched(SampleChoice),
}

impl Evaluation {
    /// How many samples per period are taken, if any.
    pub(super) fn samples(self) -> Option<SampleChoice> {
        match self {
            Self::Direct => None,
            Self::Mixed(samples) | Self::Marched(samples) => Some(samples),
        }
    }

    /// Which laws are marched where there are samples.
    #[must_use]
    pub fn marched(self) -> MarchedLaws {
        match self {
            Self::Direct | Self::Mixed(_) => MarchedLaws::Formless,
            Self::Marched(_) => MarchedLaws::All,
        }
    }
}

/// How many samples per period a march takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleChoice {
    /// A fixed number.
    Fixed(usize),
    /// As many at each point as the tolerance demands, a power of two.
    Auto,
}

/// What a balance resolves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resolution {
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// Samples per period of marched laws; none if they are evaluated as they are.
    pub samples: Option<usize>,
}

impl Resolution {
    /// Enough for both.
    #[must_use]
    pub fn or_finer(self, other: Self) -> Self {
        Self {
            harmonics: self.harmonics.max(other.harmonics),
            samples: self.samples.max(other.samples),
        }
    }
}

/// Samples that resolve harmonics up to `highest`, and as many beyond: a power of two.
pub(super) fn resolving(highest: usize) -> usize {
    (4 * (highest + 1)).next_power_of_two().max(FEWEST_SAMPLES)
}

/// Samples through which the harmonics up to `highest` that a solution discards are evaluated, unless they are given:
/// twice as many.
pub(super) fn resolving_discarded(highest: usize) -> usize {
    resolving(2 * highest + 1)
}

/// Settings of a forced response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Harmonics kept; default [`HarmonicChoice::Auto`].
    pub harmonics: HarmonicChoice,
    /// Relative error of the amplitudes, for automatic harmonics, samples and steps; default 1e-3.
    pub tolerance: f64,
    /// Force at mid-range of contacts that never slip; default [`Residual::Centred`].
    pub residual: Residual,
    /// Highest order that automatic harmonics may reach; default 255.
    pub max_harmonics: usize,
    /// Evaluation of the laws; default [`Evaluation::Direct`].
    pub evaluation: Evaluation,
    /// Most samples that an automatic march may take, a power of two; default 16384.
    pub max_samples: usize,
    /// Solver at each point; default [`Method::Newton`].
    pub method: Method,
    /// When the solver stops.
    pub newton: NewtonSettings,
}

/// Highest order that may be asked for: its tables grow with the square of it.
pub const HIGHEST_ORDER: usize = 1000;
/// Most samples that may be asked for: their sampling error is that of rounding.
const MOST_SAMPLES: usize = 1 << 20;
/// Finest tolerance: the solvers end at 1e-11 of the contact displacements.
const FINEST_TOLERANCE: f64 = 1e-8;

/// Fewest automatic samples: fewer do not show the hysteresis loop.
pub(super) const FEWEST_SAMPLES: usize = 32;

impl Default for Settings {
    fn default() -> Self {
        Self {
            harmonics: HarmonicChoice::Auto,
            tolerance: 1e-3,
            residual: Residual::Centred,
            max_harmonics: 255,
            evaluation: Evaluation::Direct,
            max_samples: 16384,
            method: Method::Newton,
            newton: NewtonSettings::default(),
        }
    }
}

impl Settings {
    /// Checks the settings against the loads of a model.
    ///
    /// # Errors
    /// A setting outside its range, or a load at a harmonic that would not be kept.
    pub fn check(&self, forced: &[usize]) -> Result<(), Error> {
        let highest_forced = forced.last().copied().unwrap_or(0).max(1);
        let (entry, kept) = self.harmonics.highest(self.max_harmonics);
        if kept < highest_forced {
            return Err(Error::value(
                entry,
                kept as f64,
                &format!("must be at least {highest_forced}, the highest forced harmonic"),
            ));
        }
        for (entry, order) in [(entry, kept), ("max_harmonics", self.max_harmonics)] {
            if order > HIGHEST_ORDER {
                let remedy = format!("must be at most {HIGHEST_ORDER}");
                return Err(Error::value(entry, order as f64, &remedy));
            }
        }
        if !(FINEST_TOLERANCE..1.0).contains(&self.tolerance) {
            let remedy = format!("must lie between {FINEST_TOLERANCE:e} and 1");
            return Err(Error::value("tolerance", self.tolerance, &remedy));
        }
        if self.newton.max_iterations == 0 {
            return Err(Error::value("max_iterations", 0.0, "must be at least 1"));
        }
        self.residual.check()
    }

    /// The same settings for a model: laws that have no form of their own are marched, through as many
    /// samples as the tolerance demands.
    #[must_use]
    pub(super) fn suited(self, model: &Model) -> Self {
        let formless = model.laws().iter().any(|law| law.closed_form().is_none());
        if formless && self.evaluation == Evaluation::Direct {
            return Self { evaluation: Evaluation::Mixed(SampleChoice::Auto), ..self };
        }
        self
    }

    /// The same settings with what is chosen automatically fixed.
    #[must_use]
    pub fn at(self, resolution: Resolution) -> Self {
        let fixed = resolution.samples.map(SampleChoice::Fixed);
        let evaluation = match (self.evaluation, fixed) {
            (Evaluation::Marched(_), Some(samples)) => Evaluation::Marched(samples),
            (_, Some(samples)) => Evaluation::Mixed(samples),
            (given, None) => given,
        };
        Self { harmonics: HarmonicChoice::Fixed(resolution.harmonics), evaluation, ..self }
    }

    /// Samples per period that were given.
    #[must_use]
    pub fn fixed_samples(&self) -> Option<usize> {
        match self.evaluation.samples() {
            Some(SampleChoice::Fixed(samples)) => Some(samples),
            Some(SampleChoice::Auto) | None => None,
        }
    }

    /// Whether something is chosen automatically.
    #[must_use]
    pub fn is_automatic(&self) -> bool {
        self.harmonics == HarmonicChoice::Auto
            || self.evaluation.samples() == Some(SampleChoice::Auto)
    }

    /// Checks the settings against the highest harmonic that laws evaluated as they are resolve:
    /// the error estimate looks as far beyond the kept harmonics as they reach.
    ///
    /// # Errors
    /// Too few samples for the harmonics that may be kept.
    pub fn check_resolution(&self, resolved: usize) -> Result<(), Error> {
        let (entry, kept) = self.harmonics.highest(self.max_harmonics);
        let resolved = match self.evaluation.samples() {
            None => resolved,
            Some(SampleChoice::Fixed(samples)) => (samples / 2).saturating_sub(1),
            Some(SampleChoice::Auto) => {
                let most = self.max_samples;
                let least = resolving(kept);
                if most < least || most > MOST_SAMPLES || !most.is_power_of_two() {
                    let remedy = format!(
                        "must be a power of two from {least} to {MOST_SAMPLES} for harmonics up to {kept}"
                    );
                    return Err(Error::value("max_samples", most as f64, &remedy));
                }
                return Ok(());
            }
        };
        let most = resolved.saturating_sub(1) / 2;
        if kept > most {
            let remedy = format!("needs at least {} samples; lower it to {most}", 4 * (kept + 1));
            return Err(Error::value(entry, kept as f64, &remedy));
        }
        Ok(())
    }
}
