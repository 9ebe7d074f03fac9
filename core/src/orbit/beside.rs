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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{ContactLaw, Jenkins};
    use crate::model::{Contact, Model};
    use crate::motion::{ModalSystem, State};
    use crate::solve::System as _;
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, Mat};

    /// A chain of twelve masses, eight of them on Jenkins elements.
    fn system() -> ModalSystem {
        let size = 12;
        let stiffness = Mat::from_fn(size, size, |i, j| match i.abs_diff(j) {
            0 => 900.0 + 70.0 * i as f64,
            1 => -400.0,
            _ => 0.0,
        });
        let [mass, damping] =
            [1.0, 0.3].map(|factor| faer::Scale(factor) * Mat::<f64>::identity(size, size));
        let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref());
        let contact = |i: usize| {
            let law: Box<dyn ContactLaw> =
                Box::new(Jenkins::new(150.0, 1.0 + 0.7 * i as f64).unwrap());
            Contact { law, rows: Mat::from_fn(1, size, |_, j| f64::from(u8::from(i == j))) }
        };
        let amplitude = (0..size).map(|i| c64::new(12.0 + i as f64, 0.0)).collect();
        let loads = vec![HarmonicLoad { harmonic: 1, amplitude }];
        let contacts = (0..8).map(contact).collect();
        ModalSystem::new(&Model::new(structure.unwrap(), contacts, loads).unwrap()).unwrap()
    }

    /// Values beside a residual whose derivative is known take no step of the flow, and are those of a pass; until
    /// they are no more trusted.
    #[test]
    fn values_beside_a_residual_take_no_pass() {
        let system = system();
        for half_wave in [true, false] {
            let mut shooting = Shooting::new(&system, 1.3, half_wave, None);
            let mut y = shooting.unknowns(&State::rest(&system));
            assert!(shooting.settle(&mut y, 4));
            let [mut residual, mut step] = [(); 2].map(|()| vec![0.0; y.len()]);
            shooting.residual(&y, &mut residual);
            assert!(shooting.solve(&residual, &mut step));
            let near: Vec<f64> = y.iter().zip(&step).map(|(y, step)| y - 1e-2 * step).collect();
            let before = shooting.flow.steps;
            let [mut found, mut expected] = [(); 2].map(|()| vec![0.0; y.len()]);
            shooting.value(&near, &mut found);
            assert_eq!(shooting.flow.steps, before);
            assert!(shooting.distrust());
            shooting.value(&near, &mut expected);
            assert!(shooting.flow.steps > before);
            let error: Vec<f64> = found.iter().zip(&expected).map(|(a, b)| a - b).collect();
            assert!(norm(&error) < 1e-13 * norm(&y), "{half_wave} {:e}", norm(&error) / norm(&y));
            assert!(!shooting.distrust());
        }
    }
}
