//! A motion beside one that is known, by the difference of both.
//!
//! Between events the difference follows the equations without loads, and exponentials that are known take it along.
//! An event comes a little earlier or later. From the instant of the one that is known the motion goes on in the
//! regime before it, or back, to its own event, and from there in the regime behind it to the same instant again:
//! what it is then is no motion that has been, but one that comes to the same. Events that only one of both motions
//! meets are not seen: whoever goes by what is found here looks at the motion itself in the end.

use super::linear_phase::{Crossing, LinearPhase};
use super::propagator::{Propagators, Reach};
use super::regime_rates::Rates;
use super::transition::Transition;
use crate::contact::PointState;
use crate::solve::{dot, norm};
use faer::Mat;

/// By how much an event may come earlier or later, in units of the fastest rate: further off the series of the
/// motion loses digits.
const FARTHEST: f64 = 4.0;
/// Step of Newton's method towards its instant, in the same units, that leaves nothing, and most steps.
const FOUND: f64 = 1e-7;
const STEPS: usize = 8;
/// How far the end of an exponential may be from that of its phase, in the same units: a difference has fewer digits
/// to lose to the lag than a derivative.
const CLOSE: f64 = 20.0;
/// Term of a difference, relative to the motion, that is none.
const ROUNDING: f64 = 1e-18;

impl Transition<'_> {
    /// Difference at the end of the phases of a motion at `omega` [rad/s] from that at their start; nothing where
    /// an event changes its place among the others, or something is not known.
    pub(crate) fn beside(
        &self,
        phases: &[LinearPhase],
        omega: f64,
        difference: &[f64],
        known: &mut Propagators,
    ) -> Option<Vec<f64>> {
        let roots = self.roots();
        let mut own = difference.to_vec();
        // By how long exponentials lag behind the difference, and by how much later the last event was.
        let (mut lag, mut last) = (0.0_f64, 0.0);
        let mut before = self.rates(&phases.first()?.regime, &roots);
        let leads = self.leads(phases, &self.simple_changes(phases));
        let mut nothing = 0.0;
        for (number, phase) in phases.iter().enumerate() {
            let goes_on = phases.get(number + 1).map(|next| {
                let end = phase.crossing.as_ref();
                let end = end.filter(|end| end.after.points == next.regime.points)?;
                Some((next, end, self.coordinates(&end.state)))
            });
            if let Some(own) = &goes_on {
                nothing = ROUNDING * norm(&own.as_ref()?.2);
            }
            match leads[number] {
                // A series leads there sooner than back to the last exponential, and from the next one.
                Some(lead) if phase.duration <= lag.abs() + lead.abs() => {
                    before.lag(phase.duration, &mut own, nothing);
                    lag = -lead;
                }
                Some(lead) => {
                    before.lag(-lag, &mut own, nothing);
                    let duration = lag + phase.duration;
                    lag = self.pass_as_known(&before, [duration, lead], &mut own, known)?;
                    before.lag(lag, &mut own, nothing);
                }
                None => {
                    before.lag(phase.duration, &mut own, nothing);
                    lag += phase.duration;
                }
            }
            let Some(goes_on) = goes_on else {
                // Behind the end nothing has happened yet.
                return (last <= phase.duration).then_some(own);
            };
            let (next, end, motion) = goes_on?;
            let after = self.rates(&next.regime, &roots);
            let late = self.cross([&before, &after], (phase, end), omega, &motion, &mut own)?;
            if phase.duration + late < last {
                return None;
            }
            last = late;
            before = after;
        }
        None
    }

    /// Takes a difference along a phase, or nearly so, by an exponential that is known; the duration that is left.
    fn pass_as_known(
        &self,
        rates: &Rates<'_>,
        [duration, lead]: [f64; 2],
        difference: &mut [f64],
        known: &mut Propagators,
    ) -> Option<f64> {
        let fastest = self.system().rate(0.0);
        if (duration + lead) * fastest <= Reach::CAUGHT_UP.short {
            return Some(duration);
        }
        let (system, weight) = (self.system(), self.weight());
        let strains: Vec<usize> = rates.springs.moves.iter().map(|(strain, ..)| *strain).collect();
        let own = known.known(&strains, &rates.springs, [duration, lead, CLOSE / fastest])?;
        let (motion, g) = difference.split_at_mut(2 * weight.len());
        if (0..g.len()).any(|i| g[i] != 0.0 && strains.binary_search(&i).is_err()) {
            return None;
        }
        // In the units of the exponential; what displacements do not make of strains is constant.
        let modes = weight.len();
        let mut states = Mat::from_fn(2 * modes, 1, |i, _| {
            motion[i] * if i < modes { own.scale[i] / weight[i] } else { 1.0 }
        });
        let strain = |states: &Mat<f64>, &(_, point, rate): &(usize, usize, f64)| -> f64 {
            let shape = system.contact_shape(point).iter().zip(&own.scale);
            let parts = shape.zip(states.col_as_slice(0));
            rate * parts.map(|((b, s), x)| b / s * x).sum::<f64>()
        };
        let constant: Vec<f64> =
            rates.springs.moves.iter().map(|one| g[one.0] - strain(&states, one)).collect();
        let inputs = Mat::from_fn(constant.len(), 1, |i, _| constant[i]);
        states = own.exponential.applied(states.as_ref(), inputs.as_ref());
        for (one, constant) in rates.springs.moves.iter().zip(&constant) {
            g[one.0] = constant + strain(&states, one);
        }
        for (i, (to, x)) in motion.iter_mut().zip(states.col_as_slice(0)).enumerate() {
            *to = x * if i < modes { weight[i] / own.scale[i] } else { 1.0 };
        }
        Some(duration - own.duration)
    }

    /// Takes the difference at an event to the regime behind it; by how much later the motion meets it.
    fn cross(
        &self,
        [before, after]: [&Rates<'_>; 2],
        (phase, end): (&LinearPhase, &Crossing),
        omega: f64,
        motion: &[f64],
        difference: &mut [f64],
    ) -> Option<f64> {
        let (system, modes, point) = (self.system(), self.weight().len(), end.event.point);
        let own = system.bodies().iter().find(|body| body.points.contains(&point))?;
        let strain = 2 * modes + own.strains.start;
        let begins = end.event.state != PointState::Stuck;
        // A strain grows on its side, a slip velocity falls.
        let way = if begins { end.event.state.sign() } else { -phase.regime.points[point].sign() };
        let (shape, fastest) = (system.contact_shape(point), system.rate(omega));
        let beside = |difference: &[f64]| -> Vec<f64> {
            motion.iter().zip(difference).map(|(y, d)| y + d).collect()
        };
        let (mut late, mut found) = (0.0, false);
        for _ in 0..STEPS {
            let (y, at) = (beside(difference), [omega, end.event.time + late]);
            let rate = before.rate(y.clone(), at);
            let [miss, slope] = if begins {
                [difference[strain], rate[strain]]
            } else {
                [&y, &rate].map(|all| dot(shape, &all[modes..2 * modes]))
            };
            let step = -miss / slope;
            let near = (late + step).abs() * fastest <= FARTHEST;
            if !near || slope * way <= 0.0 {
                return None;
            }
            before.go_on(y, Some(at), step, difference, 0.0);
            late += step;
            if step.abs() * fastest <= FOUND {
                found = true;
                break;
            }
        }
        if begins {
            difference[strain] = 0.0;
        }
        let at = [omega, end.event.time + late];
        after.go_on(beside(difference), Some(at), -late, difference, 0.0);
        found.then_some(late)
    }
}

impl Rates<'_> {
    /// Takes a difference on by a lag, or back, but for what counts for nothing.
    fn lag(&self, lag: f64, difference: &mut [f64], nothing: f64) {
        if lag != 0.0 {
            let steps = self.of.steps(lag);
            for _ in 0..steps {
                self.go_on(difference.to_vec(), None, lag / steps as f64, difference, nothing);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{ContactLaw, Jenkins};
    use crate::model::{Contact, Model};
    use crate::motion::{Flow, LoopDisturbance, ModalSystem, State};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::c64;
    use std::f64::consts::TAU;

    const OMEGA: f64 = 1.3;

    /// A chain of twelve masses on stiff springs, eight of them on Jenkins elements.
    fn model() -> Model {
        let size = 12;
        let stiffness = Mat::from_fn(size, size, |i, j| match i.abs_diff(j) {
            0 => 900.0 + 70.0 * i as f64,
            1 => -400.0,
            _ => 0.0,
        });
        let damping = faer::Scale(0.3) * Mat::<f64>::identity(size, size);
        let mass = Mat::<f64>::identity(size, size);
        let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref());
        let contact = |i: usize| {
            let law: Box<dyn ContactLaw> =
                Box::new(Jenkins::new(150.0, 1.0 + 0.7 * i as f64).unwrap());
            let rows = Mat::from_fn(1, size, |_, j| f64::from(u8::from(i == j)));
            Contact { law, rows }
        };
        let amplitude = (0..size).map(|i| c64::new(12.0 + i as f64, 3.0)).collect();
        let loads = vec![HarmonicLoad { harmonic: 1, amplitude }];
        Model::new(structure.unwrap(), (0..8).map(contact).collect(), loads).unwrap()
    }

    fn after_some_periods(system: &ModalSystem) -> State {
        let mut state = State::rest(system);
        Flow::new(system, OMEGA).run(&mut state, 3.0 * TAU / OMEGA, &mut |_| {}).unwrap();
        state
    }

    /// Phases of a period from a state, and the state behind it.
    fn passed(system: &ModalSystem, start: &State) -> (Vec<LinearPhase>, State) {
        let (mut phases, mut state) = (Vec::new(), start.clone());
        let until = state.time + TAU / OMEGA;
        Flow::new(system, OMEGA)
            .run(&mut state, until, &mut |passage| {
                LinearPhase::record(&mut phases, system, &passage);
            })
            .unwrap();
        (phases, state)
    }

    /// The difference is that of two passes, also where events come earlier and later, and takes no exponential
    /// that is not known.
    #[test]
    fn a_motion_beside_another_is_that_of_a_pass() {
        let model = model();
        let system = ModalSystem::new(&model).unwrap();
        let start = after_some_periods(&system);
        let own = Transition::new(&system, OMEGA);
        let (phases, end) = passed(&system, &start);
        assert!(phases.len() > 20, "{}", phases.len());
        let mut known = Propagators::default();
        known.serve(OMEGA, system.modes());
        let none = &mut LoopDisturbance::default();
        let matrix = own.along(&phases, &phases[0].regime.points, &start.force, none, &mut known);
        let before = known.count();
        let first = own.coordinates(&start);
        for size in [1e-3, 1e-5, 1e-8] {
            let mut moved = start.clone();
            moved.velocity.iter_mut().enumerate().for_each(|(j, v)| *v += size * (j as f64).cos());
            let (_, other) = passed(&system, &moved);
            let subtract = |a: &[f64], b: &[f64]| -> Vec<f64> {
                a.iter().zip(b).map(|(a, b)| a - b).collect()
            };
            let difference = subtract(&own.coordinates(&moved), &first);
            let expected = subtract(&own.coordinates(&other), &own.coordinates(&end));
            let found = own.beside(&phases, OMEGA, &difference, &mut known).unwrap();
            let error = norm(&subtract(&found, &expected)) / norm(&first);
            assert!(error < 1e-13, "{size} {error:e}");
            // What is linear alone is not enough.
            let linear = &matrix * Mat::from_fn(difference.len(), 1, |i, _| difference[i]);
            let missed = norm(&subtract(linear.col_as_slice(0), &expected)) / norm(&first);
            assert!(size < 1e-6 || missed > 1e3 * error, "{size} {missed:e} {error:e}");
        }
        assert_eq!(known.count(), before);
    }

    /// Far off, where events change their places, nothing is said.
    #[test]
    fn where_events_change_their_places_there_is_none() {
        let model = model();
        let system = ModalSystem::new(&model).unwrap();
        let start = after_some_periods(&system);
        let own = Transition::new(&system, OMEGA);
        let (phases, _) = passed(&system, &start);
        let mut known = Propagators::default();
        known.serve(OMEGA, system.modes());
        let none = &mut LoopDisturbance::default();
        own.along(&phases, &phases[0].regime.points, &start.force, none, &mut known);
        let modes = system.modes();
        let difference: Vec<f64> =
            (0..own.size()).map(|i| if i < 2 * modes { 3.0 } else { 0.0 }).collect();
        assert!(own.beside(&phases, OMEGA, &difference, &mut known).is_none());
        assert!(own
            .beside(&phases, OMEGA, &vec![0.0; own.size()], &mut Propagators::default())
            .is_none());
    }

    /// It does not matter which way contacts slip: a motion and its mirror image have the same exponentials.
    #[test]
    fn a_mirrored_motion_takes_the_exponentials_of_the_motion() {
        let model = model();
        let system = ModalSystem::new(&model).unwrap();
        let mut start = after_some_periods(&system);
        let own = Transition::new(&system, OMEGA);
        let mut known = Propagators::default();
        known.serve(OMEGA, system.modes());
        let mut matrices = Vec::new();
        let mut count = 0;
        for mirrored in [false, true] {
            if mirrored {
                start.mirror();
                start.time += 0.5 * TAU / OMEGA;
            }
            let (phases, _) = passed(&system, &start);
            assert!(phases.iter().any(|phase| phase.regime.points.contains(&PointState::Forward)));
            let none = &mut LoopDisturbance::default();
            let held = &phases[0].regime.points;
            matrices.push(own.along(&phases, held, &start.force, none, &mut known));
            count = if mirrored { count } else { known.count() };
        }
        assert!(count > 0);
        assert_eq!(known.count(), count);
        let error = (&matrices[0] - &matrices[1]).norm_max() / matrices[0].norm_max();
        assert!(error < 1e-11, "{error:e}");
    }
}
