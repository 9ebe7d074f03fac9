//! The structure-like damper: a massless elastic body that touches its neighbours at several
//! points, each of which slips (Guillen 1999, chapter VI).
//!
//! `f = D (u − s)`, `|f_i| ≤ F_i`, and the slip s_i moves along `f_i = ±F_i` alone. The dissertation's
//! explicit update finds the slip of a step from the states of the step before; it is of first
//! order and overshoots the limits. Here a periodic motion is followed from transition to
//! transition, each located exactly (`passage`), and an increment solves the implicit problem
//! (`increment`).

use super::derivative::Derivative;
use super::elastic::{Elastic, ReducedStiffness};
use super::increment::Increment;
use super::law::{Element, HarmonicForce, ReturnMapJacobian, SlipElement};
use super::periodic_march::{PeriodicMarch, Stretch};
use super::registry::numbers;
use super::slip_series::{self, halve_means};
use super::{ContactLaw, Motion, Parameter, Parameters, Phase, PointState, PointSummary, SlipLoad};
use crate::Error;
use faer::{Mat, MatRef, Side};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Asymmetry, and negative eigenvalues, relative to the largest entry, that printed digits may
/// leave in a stiffness.
const PRINTED: f64 = 1e-6;
/// The same that rounding may leave.
const ROUNDING: f64 = 1e-12;

/// A massless elastic damper with several slipping contacts.
#[derive(Debug, Clone)]
pub struct StructuralDamper {
    pub(super) stiffness: Mat<f64>,
    pub(super) limits: Vec<f64>,
    pub(super) elastic: Elastic,
    /// The stiffness that it was built with, and the factor on it.
    pub(super) unit: Mat<f64>,
    pub(super) factor: f64,
}

impl StructuralDamper {
    /// A damper of stiffness D [N/m], points × points, and slip limits F [N]; infinite ones never
    /// slip, those of 0 are without friction.
    ///
    /// # Errors
    /// D not square, finite, symmetric and positive semidefinite; other than one limit per point,
    /// negative or NaN limits.
    pub fn new(stiffness: MatRef<'_, f64>, limits: &[f64]) -> Result<Self, Error> {
        let points = stiffness.nrows();
        if points == 0 || stiffness.ncols() != points {
            let got = format!("{points} x {}", stiffness.ncols());
            return Err(Error::shape("structural: stiffness", "a square matrix", got));
        }
        if limits.len() != points {
            let expected = format!("{points}, one per contact");
            return Err(Error::shape("structural: slip_forces", expected, limits.len()));
        }
        let limits = Self::checked(limits)?;
        let at = |i: usize, j: usize| stiffness[(i, j)];
        let pairs = || (0..points).flat_map(|i| (0..points).map(move |j| (i, j)));
        if let Some((i, j)) = pairs().find(|&(i, j)| !at(i, j).is_finite()) {
            let entry = format!("structural: stiffness[{i}, {j}]");
            return Err(Error::value(entry, at(i, j), "must be finite"));
        }
        let largest = pairs().fold(0.0_f64, |m, (i, j)| m.max(at(i, j).abs()));
        let skew = |(i, j): (usize, usize)| (at(i, j) - at(j, i)).abs() > PRINTED * largest;
        if let Some((i, j)) = pairs().find(|&pair| skew(pair)) {
            let remedy = format!("must equal stiffness[{j}, {i}] = {}", at(j, i));
            let entry = format!("structural: stiffness[{i}, {j}]");
            return Err(Error::value(entry, at(i, j), &remedy));
        }
        let symmetric = Mat::from_fn(points, points, |i, j| 0.5 * (at(i, j) + at(j, i)));
        let lowest = symmetric
            .self_adjoint_eigenvalues(Side::Lower)
            .map_err(|_| Error::Eigenvalues("structural: stiffness".to_owned()))?
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        if lowest < -PRINTED * largest {
            return Err(Error::value(
                "structural: lowest eigenvalue of stiffness",
                lowest,
                "must not be negative, for the damper would give energy away; check its signs and digits",
            ));
        }
        let elastic = Elastic::new(symmetric.as_ref())?;
        // What printed digits have left of negative eigenvalues is not in the elastic forces.
        let symmetric = if lowest < -ROUNDING * largest {
            elastic.root() * elastic.root().transpose()
        } else {
            symmetric
        };
        Ok(Self { unit: symmetric.clone(), stiffness: symmetric, limits, elastic, factor: 1.0 })
    }

    /// Slip limits as they may be.
    pub(super) fn checked(limits: &[f64]) -> Result<Vec<f64>, Error> {
        let bad = limits.iter().position(|limit| limit.is_nan() || *limit < 0.0);
        bad.map_or_else(
            || Ok(limits.to_vec()),
            |i| {
                Err(Error::value(
                    format!("structural: slip_forces[{i}]"),
                    limits[i],
                    "must not be negative; infinity means that the contact never slips",
                ))
            },
        )
    }

    pub(super) fn from_parameters(parameters: &Parameters) -> Result<Self, Error> {
        let limits = numbers("structural", parameters, "slip_forces")?;
        let entries = numbers("structural", parameters, "stiffness")?;
        let points = limits.len();
        if entries.len() != points * points {
            let expected = format!("{points} x {points} numbers, row by row");
            return Err(Error::shape("structural: stiffness", expected, entries.len()));
        }
        let stiffness = Mat::from_fn(points, points, |i, j| entries[i * points + j]);
        Self::new(stiffness.as_ref(), limits)
    }

    fn sliding(&self, states: &[PointState]) -> ReducedStiffness {
        let moves = states.iter().zip(&self.limits);
        let slips: Vec<bool> =
            moves.map(|(state, limit)| *state != PointState::Stuck || *limit == 0.0).collect();
        self.elastic.sliding(&slips)
    }
}

impl SlipElement for StructuralDamper {
    fn stiffness(&self) -> Mat<f64> {
        self.stiffness.clone()
    }

    fn limits(&self) -> Vec<f64> {
        self.limits.clone()
    }

    fn tangent(&self, points: &[PointState]) -> Mat<f64> {
        self.sliding(points).tangent
    }

    fn slip_rate(&self, points: &[PointState]) -> Mat<f64> {
        self.sliding(points).slip_rate
    }

    fn increment(&self, du: &[f64], force: &mut [f64], gain: Option<&mut [f64]>) {
        let before = force.to_vec();
        for (i, force) in force.iter_mut().enumerate() {
            *force += du.iter().enumerate().map(|(j, du)| self.stiffness[(i, j)] * du).sum::<f64>();
        }
        let mut increment = Increment::new(&self.stiffness, &self.limits);
        increment.solve(&before, force);
        if let Some(gain) = gain {
            increment.gain(gain);
        }
    }
}

impl ContactLaw for StructuralDamper {
    fn name(&self) -> &'static str {
        "structural"
    }

    fn displacements(&self) -> usize {
        self.limits.len()
    }

    fn state_size(&self) -> usize {
        self.limits.len()
    }

    fn stiffness(&self) -> Mat<f64> {
        self.stiffness.clone()
    }

    fn state_stiffness(&self) -> Mat<f64> {
        self.stiffness.clone()
    }

    fn is_odd(&self) -> bool {
        true
    }

    fn is_monotone(&self) -> bool {
        true
    }

    fn limits(&self) -> Vec<f64> {
        self.limits.clone()
    }

    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: Option<&mut ReturnMapJacobian>,
    ) {
        let points = state.len();
        let du: Vec<f64> = after.iter().zip(before).map(|(after, before)| after - before).collect();
        let Some(jacobian) = jacobian else {
            self.increment(&du, state, None);
            force.copy_from_slice(state);
            return;
        };
        jacobian.reset(points, points);
        self.increment(&du, state, Some(&mut jacobian.by_state));
        force.copy_from_slice(state);
        for i in 0..points {
            let gain = &jacobian.by_state[i * points..(i + 1) * points];
            for j in 0..points {
                let through: f64 = (0..points).map(|l| gain[l] * self.stiffness[(l, j)]).sum();
                jacobian.by_after[i * points + j] = through;
                jacobian.by_before[i * points + j] = -through;
            }
            jacobian.force_by_state[i * points + i] = 1.0;
            jacobian.slipping[i] = f64::from(u8::from(gain[i] != 1.0));
        }
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        Box::new(Self {
            stiffness: faer::Scale(share) * &self.stiffness,
            limits: self.limits.clone(),
            elastic: self.elastic.softened(share),
            unit: faer::Scale(share) * &self.unit,
            factor: self.factor,
        })
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        let limits = self.limits.iter().map(|limit| factor * limit).collect();
        Box::new(Self { limits, ..self.clone() })
    }

    fn parameters(&self) -> Vec<Parameter> {
        self.own_parameters()
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        Ok(Box::new(self.changed(index, value)?))
    }

    fn closed_form(&self) -> Option<&dyn HarmonicForce> {
        Some(self)
    }

    fn elements(&self) -> Option<Vec<Element>> {
        let components = (0..self.limits.len()).collect();
        Some(vec![Element { components, law: Arc::new(self.clone()) }])
    }
}

impl HarmonicForce for StructuralDamper {
    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        out.reset(motion.displacement.len(), tangent);
        if motion.displacement.iter().any(|u| !u.is_finite()) {
            return;
        }
        let passage = PeriodicMarch::new(
            self,
            motion,
            if tangent { Derivative::Coefficients } else { Derivative::None },
        );
        if !passage.resolved {
            out.value.fill(f64::NAN);
            return;
        }
        out.active = passage.slipped || self.limits.contains(&0.0);
        if out.active {
            slip_series::write(&passage, &self.stiffness, motion, out);
            halve_means(motion.table.harmonics(), self.limits.len(), out);
        }
    }

    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        out.fill(PointSummary::default());
        let harmonics = motion.table.harmonics();
        let span = harmonics.span();
        let passage = PeriodicMarch::new(self, motion, Derivative::None);
        let displacement = |theta: f64| -> Vec<f64> {
            let series = motion.displacement.chunks_exact(harmonics.slots());
            series.map(|series| harmonics.jet(series, theta)[0]).collect()
        };
        for stretch in &passage.stretches {
            let rate = &passage.sets[stretch.set].sliding.slip_rate;
            let (from, to) = (displacement(stretch.start), displacement(stretch.end));
            for (i, summary) in out.iter_mut().enumerate() {
                if stretch.states[i] == PointState::Stuck {
                    continue;
                }
                let travel: f64 = (0..from.len()).map(|j| rate[(i, j)] * (to[j] - from[j])).sum();
                summary.slip_fraction += (stretch.end - stretch.start) / span;
                summary.dissipation += self.limits[i] * stretch.states[i].sign() * travel;
            }
        }
        for (summary, limit) in out.iter_mut().zip(&self.limits) {
            summary.dissipation *= TAU / span;
            if *limit == 0.0 {
                summary.slip_fraction = 1.0;
            }
        }
    }

    fn state_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        self.force_history(motion, samples)
    }

    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let harmonics = motion.table.harmonics();
        let span = harmonics.span();
        let passage = PeriodicMarch::new(self, motion, Derivative::None);
        let mut history = Vec::with_capacity(samples * self.limits.len());
        for n in 0..samples {
            let theta = TAU * n as f64 / samples as f64;
            let mirror = harmonics.half_wave() && theta >= span;
            let (folded, sign) = if mirror { (theta - span, -1.0) } else { (theta, 1.0) };
            let u: Vec<f64> = motion
                .displacement
                .chunks_exact(harmonics.slots())
                .map(|series| harmonics.jet(series, folded)[0])
                .collect();
            let Some(stretch) = passage.at(folded) else { continue };
            let tangent = &passage.sets[stretch.set].sliding.tangent;
            history.extend((0..u.len()).map(|i| {
                let force = (0..u.len()).map(|j| tangent[(i, j)] * u[j]).sum::<f64>();
                sign * (force - stretch.offset[i]).clamp(-self.limits[i], self.limits[i])
            }));
        }
        history
    }

    fn phases(&self, motion: Motion<'_>) -> Vec<Phase> {
        let passage = PeriodicMarch::new(self, motion, Derivative::None);
        let phase =
            |stretch: &Stretch| Phase { start: stretch.start, states: stretch.states.clone() };
        let mut phases: Vec<Phase> = passage.stretches.iter().map(phase).collect();
        let span = motion.table.harmonics().span();
        if motion.table.harmonics().half_wave() {
            let mirrored: Vec<Phase> = phases
                .iter()
                .map(|phase| Phase {
                    start: phase.start + span,
                    states: phase.states.iter().map(|state| state.mirrored()).collect(),
                })
                .collect();
            phases.extend(mirrored);
        }
        phases.dedup_by(|next, last| next.states == last.states);
        phases
    }

    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        self.slope(motion, index, out);
    }
}
