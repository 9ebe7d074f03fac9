//! The elastic Coulomb contact of one node: friction in one or two directions under a normal load
//! that may vary and vanish.
//!
//! With the relative displacements u (tangential) and v (normal, closing positive)
//!
//! | | |
//! |---|---|
//! | normal | `N = max(N₀ + k_n v, 0)` under a preload, `max(k_n (v − g), 0)` behind a gap |
//! | tangential | `t = k_t (u − w)`, `|t| ≤ μN`, and the slider w moves along t while `|t| = μN` |
//! | open | `t = 0`, the slider follows: `w = u` |
//!
//! (Yang, Chu and Menq 1998; Petrov and Ewins 2003.) A preload is in equilibrium without motion: the
//! structure feels N − N₀. Behind a gap it feels all of N.

use super::dual::Real;
use crate::contact::law::HarmonicForce;
use crate::contact::parameter::number;
use crate::contact::return_map::ReturnMapJacobian;
use crate::contact::slip_element::Element;
use crate::contact::{
    AssumedStart, ContactLaw, Describing, Held, Lap, Motion, Parameter, Parameters, Unslipped,
};
use crate::Error;
use faer::Mat;
use std::sync::Arc;

/// What presses the bodies together without motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Closure {
    /// A normal force N₀ \[N\], in equilibrium with what the structure has without motion.
    Preload(f64),
    /// A distance g \[m\], negative for an interference: the structure feels all of N.
    Gap(f64),
}

/// A Coulomb contact with elastic stiffness: μ, k_t, k_n and what presses it together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coulomb {
    /// Number of tangential directions, 1 or 2.
    pub(super) directions: usize,
    /// μ.
    pub(super) friction: f64,
    /// k_t [N/m].
    pub(super) tangential_stiffness: f64,
    /// k_n [N/m]; none where the normal load is constant and there is no normal displacement.
    pub(super) normal_stiffness: Option<f64>,
    /// What presses it together.
    pub(super) closure: Closure,
    /// Displacements and traction from which motions from rest begin.
    pub(super) beginning: ([f64; 3], [f64; 2]),
}

impl Coulomb {
    /// A contact with `directions` tangential displacements and, if it has a normal stiffness, a
    /// normal one behind them.
    ///
    /// # Errors
    /// Parameters that are negative or not finite; a gap without normal displacement.
    pub fn new(
        directions: usize,
        friction: f64,
        tangential_stiffness: f64,
        normal_stiffness: Option<f64>,
        closure: Closure,
    ) -> Result<Self, Error> {
        if !(1..=2).contains(&directions) {
            return Err(Error::shape("coulomb", "one or two tangential directions", directions));
        }
        let preload = match closure {
            Closure::Preload(force) => force,
            Closure::Gap(_) if normal_stiffness.is_none() => {
                return Err(Error::shape("coulomb: gap", "a normal displacement", "none"));
            }
            Closure::Gap(_) => 0.0,
        };
        for (entry, value) in [
            ("coulomb: friction", friction),
            ("coulomb: tangential_stiffness", tangential_stiffness),
            ("coulomb: normal_stiffness", normal_stiffness.unwrap_or(0.0)),
            ("coulomb: preload", preload),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(Error::value(entry, value, "must be finite and not negative"));
            }
        }
        if let Closure::Gap(gap) = closure {
            if !gap.is_finite() {
                return Err(Error::value("coulomb: gap", gap, "must be finite, in m"));
            }
        }
        Ok(Self {
            directions,
            friction,
            tangential_stiffness,
            normal_stiffness,
            closure,
            beginning: ([0.0; 3], [0.0; 2]),
        })
    }

    pub(crate) fn from_parameters(parameters: &Parameters) -> Result<Self, Error> {
        let one = |name: &str| number("coulomb", parameters, name);
        let given = |name: &str| parameters.contains_key(name);
        let closure = if given("gap") {
            Closure::Gap(one("gap")?)
        } else {
            Closure::Preload(one("preload")?)
        };
        let normal = if given("normal_stiffness") { Some(one("normal_stiffness")?) } else { None };
        let directions = one("directions")? as usize;
        Self::new(directions, one("friction")?, one("tangential_stiffness")?, normal, closure)
    }

    /// N₀: the normal force without displacement, negative behind an open gap \[N\].
    pub(super) fn normal_at_rest(&self) -> f64 {
        match self.closure {
            Closure::Preload(force) => force,
            Closure::Gap(gap) => -self.normal_stiffness.unwrap_or(0.0) * gap,
        }
    }

    /// Part of N that the structure does not feel \[N\].
    pub(super) fn balanced(&self) -> f64 {
        match self.closure {
            Closure::Preload(force) => force,
            Closure::Gap(_) => 0.0,
        }
    }

    /// Slider positions w from which friction has its history \[m\].
    pub(super) fn slider(&self) -> [f64; 2] {
        let (displacement, traction) = &self.beginning;
        std::array::from_fn(|i| match traction[i] {
            0.0 => displacement[i],
            t => displacement[i] - t / self.tangential_stiffness,
        })
    }

    /// `N₀ + k_n v` at the displacements of the contact: negative while it is open \[N\].
    pub(super) fn pressing(&self, displacement: &[f64]) -> f64 {
        let moved = self.normal_stiffness.map_or(0.0, |k| k * displacement[self.directions]);
        self.normal_at_rest() + moved
    }

    /// The traction as two numbers, in whatever number of directions.
    pub(super) fn pair<T: Real>(&self, of: impl Fn(usize) -> T) -> [T; 2] {
        [of(0), if self.directions == 2 { of(1) } else { T::from(0.0) }]
    }

    fn with(&self, change: impl FnOnce(&mut Self)) -> Result<Self, Error> {
        let mut changed = *self;
        change(&mut changed);
        let Self { directions, friction, tangential_stiffness, normal_stiffness, closure, .. } =
            changed;
        let law = Self::new(directions, friction, tangential_stiffness, normal_stiffness, closure)?;
        Ok(Self { beginning: self.beginning, ..law })
    }
}

pub(super) fn squared<T: Real>(vector: [T; 2]) -> T {
    vector[0] * vector[0] + vector[1] * vector[1]
}

impl ContactLaw for Coulomb {
    fn name(&self) -> &'static str {
        "coulomb"
    }

    fn displacements(&self) -> usize {
        self.directions + usize::from(self.normal_stiffness.is_some())
    }

    fn state_size(&self) -> usize {
        self.directions
    }

    fn stiffness(&self) -> Mat<f64> {
        let normal = self.normal_stiffness.unwrap_or(0.0);
        let size = self.displacements();
        Mat::from_fn(size, size, |i, j| match (i == j, i < self.directions) {
            (true, true) => self.tangential_stiffness,
            (true, false) => normal,
            (false, _) => 0.0,
        })
    }

    fn state_stiffness(&self) -> Mat<f64> {
        Mat::from_fn(self.directions, self.displacements(), |i, j| {
            if i == j {
                self.tangential_stiffness
            } else {
                0.0
            }
        })
    }

    fn is_odd(&self) -> bool {
        self.normal_stiffness.is_none_or(|k| k == 0.0)
    }

    fn is_monotone(&self) -> bool {
        self.is_odd()
    }

    /// Of a contact whose normal load varies, at the load without motion.
    fn limits(&self) -> Vec<f64> {
        let at_rest = self.normal_at_rest();
        // Behind a gap nothing is known before the motion is.
        let normal =
            if at_rest > 0.0 || self.normal_stiffness.is_none() { at_rest } else { f64::MAX };
        let tangential = match self.friction * self.tangential_stiffness {
            0.0 => 0.0,
            _ if normal == f64::MAX => f64::MAX,
            _ => self.friction * normal,
        };
        let normal = if self.is_odd() { f64::INFINITY } else { normal };
        (0..self.displacements())
            .map(|i| if i < self.directions { tangential } else { normal })
            .collect()
    }

    fn planes(&self) -> Vec<[usize; 2]> {
        if self.directions == 2 {
            vec![[0, 1]]
        } else {
            Vec::new()
        }
    }

    /// What presses it harder takes friction with it.
    fn grows(&self) -> Vec<bool> {
        (0..self.displacements()).map(|i| i == self.directions && !self.is_odd()).collect()
    }

    fn surely_slips(&self, motion: Motion<'_>) -> Option<bool> {
        self.surely_moves(motion)
    }

    fn surely_sticks(&self, motion: Motion<'_>) -> bool {
        self.surely_rests(motion)
    }

    fn unslipped(&self, begun: &AssumedStart, displacement: &[f64]) -> Option<Unslipped> {
        self.within_cone(begun, displacement)
    }

    fn surely_unslipped(&self, begun: &AssumedStart, motion: Motion<'_>) -> Option<Unslipped> {
        self.within_bounds(begun, motion)
    }

    fn springs(&self, before: &[f64], after: &[f64], state: &mut [f64], force: &mut [f64]) -> bool {
        self.spring_step([before, after], state, force)
    }

    fn lap(&self, lap: &mut Lap<'_>) -> bool {
        self.straight_lap(lap);
        true
    }

    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: Option<&mut ReturnMapJacobian>,
    ) {
        let directions = self.directions;
        let Some(jacobian) = jacobian else {
            let du = |i: usize| after[i] - before[i];
            let (from, to) = (self.pressing(before), self.pressing(after));
            if let Some(normal) = force.get_mut(directions) {
                *normal = to.max(0.0) - self.balanced();
            }
            let passage = self.step(self.pair(|i| state[i]), self.pair(du), from, to);
            state.copy_from_slice(&passage.traction[..directions]);
            force[..directions].copy_from_slice(state);
            return;
        };
        self.differentiated_step([before, after], state, force, jacobian);
    }

    fn beginning(&self) -> (Vec<f64>, Vec<f64>) {
        let (displacement, traction) = &self.beginning;
        (displacement[..self.displacements()].to_vec(), traction[..self.directions].to_vec())
    }

    fn held(&self, motion: Motion<'_>) -> Vec<Option<Held>> {
        self.held_sliders(motion)
    }

    fn assumed(&self, motion: Motion<'_>) -> Option<AssumedStart> {
        self.assumed_start(motion)
    }

    fn with_history(&self, displacement: &[f64], state: &[f64]) -> Option<Box<dyn ContactLaw>> {
        let mut beginning = ([0.0; 3], [0.0; 2]);
        beginning.0[..displacement.len()].copy_from_slice(displacement);
        beginning.1[..state.len()].copy_from_slice(state);
        Some(Box::new(Self { beginning, ..*self }))
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        Box::new(Self {
            tangential_stiffness: share * self.tangential_stiffness,
            normal_stiffness: self.normal_stiffness.map(|k| share * k),
            ..*self
        })
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        let closure = match self.closure {
            Closure::Preload(force) => Closure::Preload(factor * force),
            Closure::Gap(gap) => Closure::Gap(factor * gap),
        };
        let (displacement, traction) = self.beginning;
        let beginning = (displacement.map(|u| factor * u), traction.map(|t| factor * t));
        Box::new(Self { closure, beginning, ..*self })
    }

    fn elements(&self) -> Option<Vec<Element>> {
        let components = (0..self.displacements()).collect();
        Some(vec![Element { components, law: Arc::new(*self) }])
    }

    fn describing(&self, amplitude: f64) -> Option<Describing> {
        let limit = self.friction * self.normal_at_rest();
        let is_jenkins = self.directions == 1 && self.normal_stiffness.is_none();
        is_jenkins.then(|| Describing::of_jenkins(self.tangential_stiffness, limit, amplitude))
    }

    fn parameters(&self) -> Vec<Parameter> {
        let number = |name, value| Parameter { name, point: None, value, factor: false };
        let closure = match self.closure {
            Closure::Preload(force) => number("preload", force),
            Closure::Gap(gap) => number("gap", gap),
        };
        let mut parameters = vec![
            number("friction", self.friction),
            number("tangential_stiffness", self.tangential_stiffness),
            closure,
        ];
        parameters.extend(self.normal_stiffness.map(|k| number("normal_stiffness", k)));
        parameters
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        let changed = self.with(|law| match index {
            0 => law.friction = value,
            1 => law.tangential_stiffness = value,
            2 => {
                law.closure = match law.closure {
                    Closure::Preload(_) => Closure::Preload(value),
                    Closure::Gap(_) => Closure::Gap(value),
                }
            }
            _ => law.normal_stiffness = Some(value),
        })?;
        Ok(Box::new(changed))
    }

    fn closed_form(&self) -> Option<&dyn HarmonicForce> {
        Some(self)
    }
}
