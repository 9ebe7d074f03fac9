//! Settings of exact orbits.

use crate::balance::HIGHEST_ORDER;
use crate::contact::Residual;
use crate::Error;

/// Settings of exact orbits; none of them influences their accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitSettings {
    /// Highest harmonic that is reported; default 32.
    pub harmonics: usize,
    /// Force at mid-range of contacts that never slip; default [`Residual::Centred`].
    pub residual: Residual,
    /// Newton iterations of one shooting; default 100.
    pub max_iterations: usize,
}

impl Default for OrbitSettings {
    fn default() -> Self {
        Self { harmonics: 32, residual: Residual::Centred, max_iterations: 100 }
    }
}

impl OrbitSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_order("harmonics", self.harmonics, HIGHEST_ORDER)?;
        if self.max_iterations == 0 {
            return Err(Error::value("max_iterations", 0.0, "must be at least 1"));
        }
        self.residual.check()
    }
}
