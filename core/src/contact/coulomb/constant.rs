//! The Coulomb contact in one direction whose normal load does not vary: a Jenkins element of the
//! limit μN₀, seen from its slider position.

use crate::contact::law::HarmonicForce as _;
use crate::contact::{
    ContactLaw as _, Coulomb, Jenkins, Motion, Phase, PointSummary, Residual, SlipLoad,
};

/// A contact as a Jenkins element, and its motion.
pub(super) struct Constant<'a> {
    law: &'a Coulomb,
    element: Jenkins,
    motion: Motion<'a>,
    /// The tangential displacement from the slider position, where that is another one.
    seen: Option<Vec<f64>>,
}

impl<'a> Constant<'a> {
    /// The contact as an element, if it is one.
    pub(super) fn of(law: &'a Coulomb, motion: Motion<'a>) -> Option<Self> {
        if law.directions > 1 || !law.is_odd() {
            return None;
        }
        let limit = (law.friction * law.normal_at_rest()).max(0.0);
        let element = Jenkins::new(law.tangential_stiffness, limit).ok()?;
        let harmonics = motion.table.harmonics();
        let displacement = &motion.displacement[..harmonics.slots()];
        let from = motion.residual == Residual::FromRest && harmonics.has_mean();
        let seen = (from && law.slider()[0] != 0.0).then(|| {
            let mut seen = displacement.to_vec();
            seen[0] -= law.slider()[0];
            seen
        });
        Some(Self { law, element, motion: Motion { displacement, ..motion }, seen })
    }

    fn motion(&self) -> Motion<'_> {
        let displacement = self.seen.as_deref().unwrap_or(self.motion.displacement);
        Motion { displacement, ..self.motion }
    }

    pub(super) fn slip_load(&self, tangent: bool, out: &mut SlipLoad) {
        let (slots, size) = (self.motion.displacement.len(), out.value.len());
        if size == slots {
            self.element.slip_load(self.motion(), tangent, out);
        } else {
            let mut own = SlipLoad::default();
            self.element.slip_load(self.motion(), tangent, &mut own);
            out.value[..slots].copy_from_slice(&own.value);
            let rows = out.tangent.chunks_exact_mut(size).zip(own.tangent.chunks_exact(slots));
            rows.for_each(|(row, own)| row[..slots].copy_from_slice(own));
            out.active = own.active;
        }
        if self.seen.is_some() {
            out.value[0] += self.law.tangential_stiffness * self.law.slider()[0];
        }
    }

    pub(super) fn surely_slips(&self) -> Option<bool> {
        self.element.surely_slips(self.motion()).filter(|slips| *slips)
    }

    pub(super) fn summary(&self, out: &mut [PointSummary]) {
        self.element.summary(self.motion(), &mut out[..1]);
    }

    pub(super) fn traction_history(&self, samples: usize) -> Vec<f64> {
        self.element.force_history(self.motion(), samples)
    }

    pub(super) fn phases(&self, components: usize) -> Vec<Phase> {
        let mut phases = self.element.phases(self.motion());
        for phase in &mut phases {
            phase.states.resize(components, crate::contact::PointState::Stuck);
        }
        phases
    }

    /// Writes the derivative of the traction in a parameter.
    pub(super) fn parameter_slope(&self, index: usize, out: &mut [f64]) {
        let out = &mut out[..self.motion.displacement.len()];
        // The limit is μN₀.
        let (parameter, by) = match index {
            0 => (1, self.law.normal_at_rest()),
            1 => (0, 1.0),
            _ => (1, self.law.friction),
        };
        self.element.parameter_slope(self.motion(), parameter, out);
        out.iter_mut().for_each(|slope| *slope *= by);
    }
}
