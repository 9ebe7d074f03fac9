//! Settings of a forced response, each with its default.

use crate::contact::Residual;
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

/// What solves the equations at each point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Method {
    /// Newton's method: the exact Jacobian in every iteration.
    #[default]
    Newton,
    /// Broyden's method: one Jacobian, updated by rank one.
    Broyden(FirstJacobian),
}

/// Settings of a forced response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Harmonics kept; default [`HarmonicChoice::Auto`].
    pub harmonics: HarmonicChoice,
    /// Relative error of the amplitudes, for automatic harmonics and steps; default 1e-3.
    pub tolerance: f64,
    /// Force at mid-range of contacts that never slip; default [`Residual::Centred`].
    pub residual: Residual,
    /// Highest order that automatic harmonics may reach; default 255.
    pub max_harmonics: usize,
    /// Solver at each point; default [`Method::Newton`].
    pub method: Method,
    /// When the solver stops.
    pub newton: NewtonSettings,
}

/// Highest order that may be asked for: its tables grow with the square, and a period with more
/// turning points is no vibration.
pub const HIGHEST_ORDER: usize = 1000;
/// Finest tolerance: the solvers end at 1e-11 of the contact displacements.
const FINEST_TOLERANCE: f64 = 1e-8;

impl Default for Settings {
    fn default() -> Self {
        Self {
            harmonics: HarmonicChoice::Auto,
            tolerance: 1e-3,
            residual: Residual::Centred,
            max_harmonics: 255,
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
        let (entry, kept) = match self.harmonics {
            HarmonicChoice::Fixed(highest) => ("harmonics", highest),
            HarmonicChoice::Auto => ("max_harmonics", self.max_harmonics),
        };
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
        if let Residual::Value(force) = self.residual {
            if !force.is_finite() {
                return Err(Error::value("residual", force, "must be a finite force in N"));
            }
        }
        Ok(())
    }

    /// Checks the settings against the highest harmonic that the evaluation of the laws resolves:
    /// the error estimate looks as far beyond the kept harmonics as they reach.
    ///
    /// # Errors
    /// Too few samples for the harmonics that may be kept.
    pub fn check_resolution(&self, resolved: usize) -> Result<(), Error> {
        let (entry, kept) = match self.harmonics {
            HarmonicChoice::Fixed(highest) => ("harmonics", highest),
            HarmonicChoice::Auto => ("max_harmonics", self.max_harmonics),
        };
        let most = resolved.saturating_sub(1) / 2;
        if kept > most {
            let remedy = format!("needs at least {} samples; lower it to {most}", 4 * (kept + 1));
            return Err(Error::value(entry, kept as f64, &remedy));
        }
        Ok(())
    }
}
