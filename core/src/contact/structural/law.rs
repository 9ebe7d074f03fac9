//! The structure-like damper as a contact law: its harmonics from the march through one period.

use super::slip_series;
use crate::contact::derivative::Derivative;
use crate::contact::law::{effort_of, HarmonicForce};
use crate::contact::periodic_march::{PeriodicMarch, Stretch};
use crate::contact::return_map::ReturnMapJacobian;
use crate::contact::slip_element::{Element, SlipElement as _};
use crate::contact::{
    ContactLaw, Held, Motion, Parameter, Phase, PointState, PointSummary, SlipLoad,
    StructuralDamper,
};
use crate::Error;
use faer::Mat;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Rounds of a march as a rule.
const USUAL_ROUNDS: usize = 2;

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

    fn grows(&self) -> Vec<bool> {
        vec![false; self.displacements()]
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
        let Some(jacobian) = jacobian else {
            self.increment(before, after, state, None);
            force.copy_from_slice(state);
            return;
        };
        jacobian.reset(points, points);
        self.increment(before, after, state, Some(&mut jacobian.by_state));
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

    /// The range of a point is that of its own limit, at the stiffness against the others.
    fn held(&self, motion: Motion<'_>) -> Vec<Option<Held>> {
        let march = PeriodicMarch::new(self, motion, Derivative::None);
        let slots = motion.table.harmonics().slots();
        let means = motion.displacement.chunks_exact(slots);
        let means = means.map(|series| motion.table.harmonics().mean(series));
        let point = |(i, mean): (usize, f64)| {
            let sticks = |stretch: &Stretch| stretch.states[i] == PointState::Stuck;
            let reach = self.limits[i] / self.stiffness[(i, i)];
            let held = reach > 0.0 && reach.is_finite() && march.stretches.iter().all(sticks);
            held.then_some(Held {
                position: 0.0,
                range: [mean - reach, mean + reach],
                pushed: march.slipped,
            })
        };
        means.enumerate().map(point).collect()
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
    fn effort(&self, slots: usize, load: &SlipLoad, tangent: bool) -> f64 {
        let rounds = load.rounds.max(USUAL_ROUNDS) as f64 / USUAL_ROUNDS as f64;
        rounds * effort_of([1.2e4, 900.0, 12.0], self.displacements() * slots, tangent)
    }

    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        out.reset(motion.displacement.len(), tangent);
        if motion.displacement.iter().any(|u| !u.is_finite()) {
            return;
        }
        let derivative = if tangent { Derivative::Coefficients } else { Derivative::None };
        let march = PeriodicMarch::new(self, motion, derivative);
        out.rounds = march.rounds;
        if !march.resolved {
            out.value.fill(f64::NAN);
            return;
        }
        out.active = march.slipped || self.limits.contains(&0.0);
        if out.active {
            slip_series::write(&march, &self.stiffness, motion, out);
            out.halve_means(motion.table.harmonics());
        }
    }

    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        out.fill(PointSummary::default());
        let harmonics = motion.table.harmonics();
        let span = harmonics.span();
        let march = PeriodicMarch::new(self, motion, Derivative::None);
        let displacement = |theta: f64| -> Vec<f64> {
            let series = motion.displacement.chunks_exact(harmonics.slots());
            series.map(|series| harmonics.jet(series, theta)[0]).collect()
        };
        for stretch in &march.stretches {
            let rate = &march.sets[stretch.set].reduced.slip_rate;
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
        let march = PeriodicMarch::new(self, motion, Derivative::None);
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
            let Some(stretch) = march.at(folded) else { continue };
            let tangent = &march.sets[stretch.set].reduced.tangent;
            history.extend((0..u.len()).map(|i| {
                let force = (0..u.len()).map(|j| tangent[(i, j)] * u[j]).sum::<f64>();
                sign * (force - stretch.offset[i]).clamp(-self.limits[i], self.limits[i])
            }));
        }
        history
    }

    fn phases(&self, motion: Motion<'_>) -> Vec<Phase> {
        let march = PeriodicMarch::new(self, motion, Derivative::None);
        let phase =
            |stretch: &Stretch| Phase { start: stretch.start, states: stretch.states.clone() };
        let mut phases: Vec<Phase> = march.stretches.iter().map(phase).collect();
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::contact::Residual;
    use crate::fourier::{Harmonics, SampleTable};
    use faer::mat;

    /// Forces that repeat after many rounds, as those of linked points that hardly slip, cost as many.
    #[test]
    fn rounds_are_paid_for() {
        let table = SampleTable::new(Harmonics::new(2, false));
        let law = StructuralDamper::new(mat![[11.0, -10.0], [-10.0, 11.0]].as_ref(), &[1.0, 1.0]);
        let law = law.unwrap();
        let of = |size: f64| {
            let (sine, cosine) = 0.5_f64.sin_cos();
            let unit = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, cosine, -sine, 0.3, 0.0];
            let displacement = unit.map(|u| size * u);
            let residual = Residual::Centred;
            let motion = Motion { table: &table, displacement: &displacement, residual };
            let mut load = SlipLoad::default();
            law.slip_load(motion, true, &mut load);
            (load.rounds, law.effort(5, &load, true))
        };
        let (usual, effort) = of(2.0);
        let hardly = (0..40).map(|n| of(0.12 + 0.005 * f64::from(n)));
        let (rounds, of_many) = hardly.max_by_key(|(rounds, _)| *rounds).unwrap();
        assert!(usual == USUAL_ROUNDS && rounds > 10 * usual, "{usual} {rounds}");
        assert_eq!(of_many / effort, rounds as f64 / usual as f64);
    }
}
