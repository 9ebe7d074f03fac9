//! Kinks of a curve: where contacts begin and cease to slip several times per period, or a resonance of higher
//! harmonics is near, a curve may turn within little of an interval, and twice. What interpolants of smooth curves
//! say has no bound then, and their error does not fall with the fourth power of the width.

use super::search::Search;
use crate::Error;

/// Gain in height, relative, that a curve with a kink must not promise.
const GAIN: f64 = 5e-4;

impl Search<'_, '_> {
    /// Looks into the interval of a kink in which the highest point may lie, as far as slopes lead there. Whether
    /// there was one.
    pub(super) fn look_at_kinks(&mut self) -> Result<bool, Error> {
        let Some(interval) = self.envelope.most_kinked(GAIN) else { return Ok(false) };
        match self.inside(interval, 0.5)? {
            Some(sample) => self.envelope.split(interval, sample),
            None => self.envelope.close(interval),
        }
        Ok(true)
    }
}
