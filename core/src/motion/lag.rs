//! Disturbances that lag behind their motion as it changes from one linear regime to the next.
//!
//! Behind a change from A to A⁺ with the jump J, disturbances X that lag by τ are those of `e^(A⁺ τ) X⁺` with
//!
//! ```text
//! X⁺ = e^(−A⁺ τ) J e^(A τ) X = X + ∫₀^τ e^(−A⁺ s) (A − A⁺) e^(A s) ds X + e^(−A⁺ τ) (J − 1) e^(A τ) X.
//! ```
//!
//! A change at one point is of rank one, and so are the integrand at every instant and the last term: a few
//! vectors say what a whole step would say of all columns. So short stretches take no step of their own, and
//! steps of another motion nearby serve where their ends are a little off.

use super::contact_state::ContactState;
use super::linear_phase::LinearPhase;
use super::propagator::Propagators;
use super::quadrature::nodes_of_waves;
use super::transition::Transition;
use crate::solve::multiply;
use faer::{Accum, Mat};

/// Modes up to which steps are as cheap.
const FEW: usize = 8;
/// Points of which one change may change the regime: more are not worth it.
const POINTS: usize = 2;
/// Most that disturbances lag or lead, in units of the fastest rate, the sum of it over the changes between two steps,
/// from which on another step costs less, and the most at the beginning, where they cannot lead.
const FARTHEST: f64 = 16.0;
const IN_ALL: f64 = 75.0;
const BEGINS: f64 = 8.0;

/// A point whose velocity moves strains at other rates.
pub(super) struct Change {
    point: usize,
    /// Their coordinates, and by how much less.
    strains: Vec<(usize, f64)>,
}

impl Transition<'_> {
    /// The change at the end of a phase, if disturbances may lag through it: where that is worth it, and simple.
    pub(super) fn simple_change(
        &self,
        phase: &LinearPhase,
        next: &LinearPhase,
    ) -> Option<Vec<Change>> {
        let releases = phase.onset.iter().any(|onset| !onset.released.is_empty());
        if self.weight.len() <= FEW || next.slide.is_some() || releases || !phase.turns.is_empty() {
            return None;
        }
        self.changes(&phase.regime, &next.regime)
    }

    /// Those at the ends of phases.
    pub(super) fn simple_changes(&self, phases: &[LinearPhase]) -> Vec<Option<Vec<Change>>> {
        let next = phases.iter().skip(1).map(Some).chain([None]);
        phases.iter().zip(next).map(|(phase, next)| self.simple_change(phase, next?)).collect()
    }

    /// By how much longer than each phase its step is \[s\]; nothing where disturbances lag without one. Behind a
    /// step they lead, and lag in the end: it leads to the median of the changes up to the next step, from where the
    /// sum of their lags is least.
    pub(super) fn leads(
        &self,
        phases: &[LinearPhase],
        changes: &[Option<Vec<Change>>],
    ) -> Vec<Option<f64>> {
        let rate = self.system.rate(0.0);
        let lags = |at: usize| changes.get(at).is_some_and(Option::is_some);
        let mut leads = vec![None; phases.len()];
        let (mut at, mut begun) = (0, 0.0);
        while lags(at) && (begun + phases[at].duration) * rate <= BEGINS {
            begun += phases[at].duration;
            at += 1;
        }
        while at < phases.len() {
            let (step, mut lead, mut places) = (at, 0.0, vec![0.0]);
            at += 1;
            while lags(step) && lags(at) {
                let last = places[places.len() - 1] + phases[at].duration;
                places.push(last);
                let median = places[(places.len() - 1) / 2];
                let off = places.iter().map(|place| (place - median).abs() * rate);
                let far = median.max(last - median) * rate > FARTHEST;
                if far || off.sum::<f64>() > IN_ALL {
                    break;
                }
                (lead, at) = (median, at + 1);
            }
            leads[step] = Some(lead);
        }
        leads
    }

    /// Takes disturbances that lag through the change at the end of a phase.
    pub(super) fn pass_late(
        &self,
        [phase, next]: [&LinearPhase; 2],
        changed: &[Change],
        lag: f64,
        total: &mut Mat<f64>,
        known: &mut Propagators,
    ) {
        let (before, after) = (&phase.regime, &next.regime);
        let roots = self.roots();
        let [old, new] = [before, after].map(|regime| self.rates(regime, &roots));
        let (size, modes) = (total.nrows(), self.weight.len());
        let error = known.error();
        let count = nodes_of_waves(0.5 * lag.abs() * self.system.rate(0.0), error);
        let rule = known.quadrature.rule(count);
        let times: Vec<f64> = rule.iter().map(|(share, _)| share * lag).collect();
        let jump = phase.onset.as_ref().and_then(|onset| self.jump_of(onset));
        let columns = changed.len() * count + usize::from(jump.is_some());
        let [mut gains, mut forms] = [(); 2].map(|()| Mat::<f64>::zeros(size, columns));
        // What a spring loses and what its event does are often the same but for a factor.
        let same = match (changed, jump.as_ref().map(|jump| jump.gains.as_slice())) {
            ([Change { strains, .. }], Some([(at, by)])) => match strains[..] {
                [(strain, rate)] if strain == *at => Some(by / rate),
                _ => None,
            },
            _ => None,
        };
        let mut back: Vec<f64> = times.iter().map(|s| -s).collect();
        back.extend(same.map(|_| -lag));
        for (number, Change { point, strains }) in changed.iter().enumerate() {
            let place = number * count;
            let (mut gain, mut form) = (vec![0.0; size], vec![0.0; size]);
            strains.iter().for_each(|(at, rate)| gain[*at] = *rate);
            form[modes..2 * modes].copy_from_slice(self.system.contact_shape(*point));
            new.write_series(gain, &back, false, (&mut gains, place), error);
            old.write_series(form, &times, true, (&mut forms, place), error);
            for (k, (_, weight)) in rule.iter().enumerate() {
                gains.col_as_slice_mut(place + k).iter_mut().for_each(|x| *x *= lag * weight);
            }
        }
        if let Some(jump) = &jump {
            let (mut gain, mut form) = (vec![0.0; size], vec![0.0; size]);
            jump.gains.iter().for_each(|(at, by)| gain[*at] += by);
            jump.form.iter().for_each(|(at, by)| form[*at] += by);
            match same {
                Some(factor) => {
                    let own = gains.col_as_slice_mut(columns - 1);
                    own.iter_mut().for_each(|x| *x *= factor);
                }
                None => new.write_series(gain, &[-lag], false, (&mut gains, columns - 1), error),
            }
            old.write_series(form, &[lag], true, (&mut forms, columns - 1), error);
        }
        let mut shares = Mat::<f64>::zeros(columns, total.ncols());
        let forms = forms.transpose();
        multiply(shares.as_mut(), Accum::Replace, forms, total.as_ref(), 1.0);
        multiply(total.as_mut(), Accum::Add, gains.as_ref(), shares.as_ref(), 1.0);
        for at in jump.iter().flat_map(|jump| &jump.vanishing) {
            (0..total.ncols()).for_each(|j| total[(*at, j)] = 0.0);
        }
    }

    /// What changes; nothing if that is much, or if points press otherwise.
    fn changes(&self, before: &ContactState, after: &ContactState) -> Option<Vec<Change>> {
        let first = 2 * self.weight.len();
        let tangents = [before, after].map(|regime| &regime.tangent);
        let normals = &self.system.normals;
        if normals.iter().any(|&i| tangents[0][(i, i)] != tangents[1][(i, i)]) {
            return None;
        }
        let mut changed = Vec::new();
        for body in self.system.bodies() {
            if before.points[body.points.clone()] == after.points[body.points.clone()] {
                continue;
            }
            for point in body.points.clone() {
                let column = |number: usize| -> Vec<f64> {
                    body.points.clone().map(|i| tangents[number][(i, point)]).collect()
                };
                let less: Vec<f64> = column(0).iter().zip(column(1)).map(|(a, b)| a - b).collect();
                if less.iter().any(|less| *less != 0.0) {
                    let strains = body.strains.clone().map(|strain| first + strain);
                    let strains = strains.zip(body.elastic.strains(&less)).collect();
                    changed.push(Change { point, strains });
                }
            }
        }
        (changed.len() <= POINTS).then_some(changed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Closure, ContactLaw, Coulomb, Jenkins};
    use crate::model::{Contact, Model};
    use crate::motion::{Flow, LoopDisturbance, ModalSystem, State};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::c64;
    use std::f64::consts::TAU;

    const OMEGA: f64 = 1.3;

    /// A chain of twelve masses on stiff springs, on elements of which some slip, and on a planar contact.
    fn model(coupled: bool) -> Model {
        let size = 12;
        let stiffness = Mat::from_fn(size, size, |i, j| match i.abs_diff(j) {
            0 => 900.0 + 70.0 * i as f64,
            1 => -400.0,
            _ => 0.0,
        });
        let damping = Mat::from_fn(size, size, |i, j| {
            let own = 0.3 * f64::from(u8::from(i == j));
            own + if coupled && i.abs_diff(j) < 2 { 0.02 * (i + 2 * j) as f64 } else { 0.0 }
        });
        let mass = Mat::<f64>::identity(size, size);
        let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref());
        let at = |places: &[usize]| {
            Mat::from_fn(places.len(), size, |i, j| f64::from(u8::from(places[i] == j)))
        };
        let mut contacts: Vec<Contact> = (0..8)
            .map(|i| {
                let law: Box<dyn ContactLaw> =
                    Box::new(Jenkins::new(150.0, 1.0 + 0.7 * i as f64).unwrap());
                Contact { law, rows: at(&[i]) }
            })
            .collect();
        let pad = Coulomb::new(1, 0.4, 120.0, Some(150.0), Closure::Preload(9.0)).unwrap();
        contacts.push(Contact { law: Box::new(pad), rows: at(&[9, 10]) });
        let amplitude = (0..size).map(|i| c64::new(12.0 + i as f64, 0.0)).collect();
        Model::new(structure.unwrap(), contacts, vec![HarmonicLoad { harmonic: 1, amplitude }])
            .unwrap()
    }

    /// The phases of a period from a state, and the forces at its start.
    fn phases(system: &ModalSystem, omega: f64, shift: f64) -> (Vec<LinearPhase>, Vec<f64>) {
        let mut state = State::rest(system);
        let mut flow = Flow::new(system, omega);
        flow.run(&mut state, 3.0 * TAU / omega, &mut |_| {}).unwrap();
        state.velocity.iter_mut().for_each(|v| *v += shift);
        let (force, mut phases) = (state.force.clone(), Vec::new());
        let until = state.time + TAU / omega;
        flow.run(&mut state, until, &mut |passage| {
            LinearPhase::record(&mut phases, system, &passage);
        })
        .unwrap();
        (phases, force)
    }

    /// The same as every stretch by itself, in small steps: of one motion, and of another one by the exponentials
    /// or another frequency by the exponentials of the first.
    #[test]
    fn disturbances_that_lag_come_to_the_same() {
        for coupled in [false, true] {
            let model = model(coupled);
            let system = ModalSystem::new(&model).unwrap();
            let mut known = Propagators::default();
            for (omega, shift) in [(OMEGA, 0.0), (OMEGA, 1e-3), (1.01 * OMEGA, 0.0)] {
                let own = Transition::new(&system, omega);
                known.serve(omega, system.modes());
                let before = known.count();
                let (phases, force) = phases(&system, omega, shift);
                assert!(phases.len() > 20, "{}", phases.len());
                let held: Vec<_> = phases[0].regime.points.clone();
                let mut by_steps = own.start(&phases, &held, &force);
                for phase in &phases {
                    let steps = (phase.duration * system.rate(0.0) / 0.3).ceil().max(1.0);
                    for _ in 0..steps as usize {
                        own.catch_up(&phase.regime, phase.duration / steps, &mut by_steps);
                    }
                    if let Some(onset) = &phase.onset {
                        own.jump(onset, &mut by_steps);
                    }
                }
                let none = &mut LoopDisturbance::default();
                let found = own.along(&phases, &held, &force, none, &mut known);
                let error = (&found - &by_steps).norm_max() / by_steps.norm_max();
                assert!(error < 1e-12, "{coupled} {shift} {error:e}");
                let zeros = |matrix: &Mat<f64>| {
                    (0..matrix.nrows()).filter(|i| matrix.row(*i).norm_max() == 0.0).count()
                };
                assert_eq!(zeros(&found), zeros(&by_steps));
                known.rough = true;
                let rough = own.along(&phases, &held, &force, none, &mut known);
                known.rough = false;
                let error = (&rough - &by_steps).norm_max() / by_steps.norm_max();
                assert!(error < 1e-8, "{coupled} {shift} {error:e}");
                let fresh = known.count() - before;
                assert!(fresh < if before == 0 { phases.len() } else { phases.len() / 4 });
            }
        }
    }

    /// Between two steps disturbances lead to the median of the changes: neither each lag nor their sum is large, and
    /// of the stretches that are longer than a series reaches many take no step.
    #[test]
    fn steps_lead_to_the_median_of_the_changes_up_to_the_next_one() {
        let model = model(false);
        let system = ModalSystem::new(&model).unwrap();
        let (own, rate) = (Transition::new(&system, OMEGA), system.rate(0.0));
        let (phases, _) = phases(&system, OMEGA, 0.0);
        let changes = own.simple_changes(&phases);
        let leads = own.leads(&phases, &changes);
        let (mut lag, mut sum, mut long) = (0.0_f64, 0.0, 0);
        for (phase, lead) in phases.iter().zip(&leads) {
            lag += phase.duration * rate;
            match lead {
                Some(lead) => (lag, sum) = (-lead * rate, lead * rate),
                None => sum += lag.abs(),
            }
            assert!(lag.abs() <= FARTHEST && sum <= IN_ALL, "{lag} {sum}");
            long += usize::from(lead.is_none() && phase.duration * rate > BEGINS);
        }
        let steps = leads.iter().flatten().count();
        assert!(leads.iter().flatten().any(|lead| *lead > 0.0));
        assert!(long > 3 && steps < phases.len() - long, "{long} {steps} {}", phases.len());
    }
}
