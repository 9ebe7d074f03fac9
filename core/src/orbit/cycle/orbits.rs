//! Families of self-excited models in the time domain, and where their limit cycles start.

use crate::balance::Point;
use crate::model::FlutterModel;
use crate::motion::{ModalSystem, Transition, FASTEST_EXACT};
use crate::orbit::loop_memory::LoopMemory;
use crate::orbit::segments::Member;
use crate::orbit::shooting::Shooting;
use crate::orbit::start::{later, start_of};
use crate::structure::ModalDamping;
use crate::Error;
use std::f64::consts::{PI, TAU};

/// A family of self-excited models in the time domain.
pub struct CycleOrbits<'a> {
    pub(super) family: &'a FlutterModel<'a>,
    pub(super) system: ModalSystem,
    /// Modal damping and modal negative damping.
    damping: ModalDamping,
    negative: ModalDamping,
}

impl<'a> CycleOrbits<'a> {
    /// Prepares the family; nothing for a travelling wave, which has no motion of its own in time.
    ///
    /// # Errors
    /// The eigenvalue iteration fails.
    pub fn new(family: &'a FlutterModel<'a>) -> Result<Option<Self>, Error> {
        let Some(negative) = family.negative() else { return Ok(None) };
        let system = ModalSystem::new(family.model())?;
        let damping = system.project(family.model().structure().damping());
        let negative = system.project(negative.as_ref());
        Ok(Some(Self { family, system, damping, negative }))
    }

    /// Refuses a family whose motions the flow would follow in far too many steps per period.
    ///
    /// # Errors
    /// The DOF that has hardly any mass.
    pub(super) fn paced(self, omega: f64) -> Result<Self, Error> {
        self.system.check_pace(self.family.model(), omega, FASTEST_EXACT)?;
        Ok(self)
    }

    /// The member at a value of the scalar.
    pub(super) fn member(&self, value: f64) -> Result<Member<'a>, Error> {
        let given = self.family.model();
        let damping = self.damping.plus(self.family.ratio_at(value), &self.negative);
        let own = if self.family.changes().is_empty() {
            None
        } else {
            Some(given.with_laws(self.family.laws_at(value)?)?)
        };
        let held = !self.family.is_symmetric();
        let system = self.system.undriven(own.as_ref().unwrap_or(given), &damping, held)?;
        Ok(Member { own, given, system })
    }

    /// Number of unknowns that describe a state.
    pub(super) fn size(&self) -> usize {
        2 * self.system.modes() + self.system.strains() + LoopMemory::places(&self.system)
    }

    /// Angle that the closing condition spans.
    pub(super) fn span(&self) -> f64 {
        if self.family.is_symmetric() {
            PI
        } else {
            TAU
        }
    }

    /// Unknowns of [`OrbitCurve`] from a harmonic balance: the states at the starts of equal
    /// `segments` of that span, which begins an eighth of a period behind the start of that of
    /// the balance, away from the turning points.
    ///
    /// # Errors
    /// A value that a law refuses.
    pub fn unknowns(
        &self,
        point: &Point,
        value: f64,
        reference: f64,
        segments: usize,
    ) -> Result<Vec<f64>, Error> {
        let member = self.member(value)?;
        let coordinates = Transition::new(&member.system, reference);
        let half = self.family.is_symmetric();
        let shooting = Shooting::within(&member.system, point.omega, half, None, coordinates);
        let mut z = Vec::with_capacity(segments * self.size() + 2);
        for number in 0..segments {
            let angle = 0.25 * PI + self.span() * number as f64 / segments as f64;
            let residual = self.family.residual();
            let later = later(point, angle);
            let state = start_of(member.model(), &member.system, residual, &later, half);
            z.extend(shooting.unknowns(&state));
        }
        z.extend([point.omega, value]);
        Ok(z)
    }
}
