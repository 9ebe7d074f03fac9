//! Images of unknowns beside those of a pass along the orbit, without another pass.

use super::shooting::Shooting;
use crate::solve::norm;
use std::f64::consts::TAU;

/// Distance of unknowns, relative to them, from which on other events are to be expected.
const FAR: f64 = 1e-2;

impl Shooting<'_> {
    /// The image of unknowns by that of the last ones and its phases, whose exponentials are known; nothing where
    /// that cannot be.
    pub(super) fn image_beside(&mut self, y: &[f64]) -> Option<Vec<f64>> {
        let follows = self.coordinates.system().is_followed_beside();
        if !self.trusts || !follows || self.rotation.is_some() {
            return None;
        }
        let (last, image, _) = self.last.as_ref()?;
        let step: Vec<f64> = y.iter().zip(last).map(|(y, last)| y - last).collect();
        if norm(&step) > FAR * norm(y) {
            return None;
        }
        let (state, held) = self.coordinates.state(y);
        let (before, _) = self.coordinates.state(last);
        let begins = self.phases.first()?.begins_as(&state.points);
        if !begins || held != self.held || state.points != before.points {
            return None;
        }
        let [own, known] = [&state, &before].map(|state| self.coordinates.coordinates(state));
        let difference: Vec<f64> = own.iter().zip(known).map(|(own, known)| own - known).collect();
        let (omega, phases) = (TAU / self.period, &self.phases);
        let end = self.coordinates.beside(phases, omega, &difference, &mut self.propagators)?;
        let sign = if self.half_wave { -1.0 } else { 1.0 };
        let image = image.iter().zip(end).map(|(image, difference)| image + sign * difference);
        let image = image.collect();
        self.beside += 1;
        Some(image)
    }

    /// Has every image be that of a pass from now on; whether others have served.
    pub(super) fn distrust(&mut self) -> bool {
        self.trusts = false;
        std::mem::take(&mut self.beside) > 0
    }
}
