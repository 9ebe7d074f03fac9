//! The march of the sampled evaluation: from instant to instant until the state repeats, and its
//! derivative.

use super::lap_derivative::{is_identity, LapDerivative};
use super::rate::{follows, is_elastic, Rate};
use super::restart::Restart;
use super::round::{distance, Round, PERIODIC};
use super::samples::Samples;
use super::step::Step;
use crate::contact::periodic_march::SLOW;
use crate::contact::return_map::ReturnMapJacobian;
use crate::contact::{Aft, AssumedStart, ContactLaw, Motion, Residual, Unslipped};
use std::ops::Deref;

/// Rounds after which a march ends, repeated or not. An elastoplastic contact forgets its start with
/// the first slip in either direction; several coupled points take some rounds more.
const MOST_ROUNDS: usize = 200;
/// Change of the state over a round, relative to the largest, that is small enough for the fixed point of the
/// linearised round to be exact.
const SMALL: f64 = 1e-7;
/// Rounds after which slip is taken to recur, so that its fixed point is sought.
const PUSHES: usize = 3;

impl<L: Deref<Target: ContactLaw>> Aft<L> {
    /// The parts of a sum of laws: what one of them keeps while it never slips is its own.
    pub(super) fn parts(&self) -> Vec<Aft<Box<dyn ContactLaw>>> {
        let sampled = |law| Aft { law, samples: self.samples };
        self.law.parts().into_iter().map(sampled).collect()
    }

    pub(super) fn is_sum(&self) -> bool {
        !self.law.parts().is_empty()
    }

    /// Slip load of a contact that never slips, from the extreme samples: its value, and their
    /// instants with the derivatives in them.
    pub(super) fn stuck(
        &self,
        samples: &Samples,
        residual: Residual,
    ) -> Option<(f64, [(usize, f64); 2])> {
        if self.law.displacements() > 1 {
            return None;
        }
        let u = &samples.displacement;
        let pick = |better: fn(f64, f64) -> bool| {
            (0..u.len()).fold(0, |best, n| if better(u[n], u[best]) { n } else { best })
        };
        let (high, low) = (pick(|a, b| a > b), pick(|a, b| a < b));
        let (mut top, mut bottom) = (u[high], u[low]);
        if samples.sign < 0.0 {
            top = top.max(-bottom);
            bottom = -top;
        }
        let [load, by_low, by_high] = self.law.stuck_load(residual, bottom, top)?;
        Some((load, [(low, by_low), (high, by_high)]))
    }

    /// Where a motion begins: where its law assumes it, or without history.
    pub(super) fn begin(&self, motion: Motion<'_>) -> AssumedStart {
        self.law.assumed(motion).unwrap_or_else(|| {
            let (displacement, state) = self.law.beginning();
            AssumedStart { displacement, state, rate: Vec::new() }
        })
    }

    /// See [`ContactLaw::unslipped`]; mirrored, a constant part would change its sign.
    pub(super) fn unslipped(&self, samples: &Samples, begun: &AssumedStart) -> Option<Unslipped> {
        let lost = self.law.unslipped(begun, &samples.displacement)?;
        (samples.sign > 0.0 || lost.value.iter().all(|q| *q == 0.0)).then_some(lost)
    }

    /// The same as far as the amplitudes of a motion alone show it.
    pub(super) fn surely_unslipped(
        &self,
        motion: Motion<'_>,
        begun: &AssumedStart,
    ) -> Option<Unslipped> {
        let lost = self.law.surely_unslipped(begun, motion)?;
        let mirrored = motion.table.harmonics().half_wave();
        (!mirrored || lost.value.iter().all(|q| *q == 0.0)).then_some(lost)
    }

    /// The first instant, reached without any slip as far as the law admits it.
    pub(super) fn start(&self, samples: &Samples, begun: &AssumedStart) -> Step {
        let mut step = Step::first(samples, begun.state.clone());
        let Step { state, force, jacobian, after, .. } = &mut step;
        self.law.return_map(&begun.displacement, after, state, force, Some(jacobian));
        step
    }

    /// The first instant, reached by the last step of a round that repeats, from its states: a step to where it is
    /// has no derivative of its own.
    pub(super) fn wrapped(&self, samples: &Samples, states: &[f64]) -> Step {
        let size = self.law.state_size();
        let mut step = Step::first(samples, states[states.len() - size..].to_vec());
        self.advance(samples, samples.count, &mut step, true);
        step.state.copy_from_slice(&states[..size]);
        step
    }

    /// Goes from instant n − 1 to instant n, which may be the first of the next span; with the
    /// derivative of the step, if asked for.
    pub(super) fn advance(&self, samples: &Samples, n: usize, step: &mut Step, derived: bool) {
        let sign = if n == samples.count { samples.sign } else { 1.0 };
        let Step { state, force, jacobian, after, spring, springs, .. } = step;
        let (before, now) = (samples.at(n - 1), samples.at(n % samples.count));
        after.iter_mut().zip(now).for_each(|(after, now)| *after = sign * now);
        if !self.law.springs(before, after, state, force) {
            *springs &= !derived;
            return self.law.return_map(before, after, state, force, derived.then_some(jacobian));
        }
        if derived && !*springs {
            let spring = spring.get_or_insert_with(|| {
                // A step to where it is.
                let mut of_spring = ReturnMapJacobian::default();
                self.law.return_map(after, after, state, force, Some(&mut of_spring));
                of_spring
            });
            jacobian.clone_from(spring);
            *springs = true;
        }
    }

    /// The same with the derivative, and whether that of the slip load changes. Until it does, instants are summed:
    /// `told` are the sum of the basis and a tangent, to which goes what the instant before loses by itself.
    pub(super) fn advance_derived(
        &self,
        samples: &Samples,
        n: usize,
        step: &mut Step,
        rate: &Rate,
        told: Option<[&mut [f64]; 2]>,
    ) -> bool {
        if let Some([sum, out]) = told {
            let (basis, weight) = (samples.basis(n - 1), 2.0 / samples.count as f64);
            sum.iter_mut().zip(basis).for_each(|(sum, b)| *sum += weight * b);
            if !step.springs {
                rate.add_direct(&step.jacobian, weight, basis, out);
            }
        }
        step.force_by_state.clone_from(&step.jacobian.force_by_state);
        self.advance(samples, n, step, true);
        let elastic = step.springs || rate.stays(&step.jacobian);
        !elastic || step.force_by_state != step.jacobian.force_by_state
    }

    /// Marches until the state repeats.
    pub(super) fn march(&self, samples: &Samples, begun: &AssumedStart) -> Round {
        let size = self.law.state_size();
        let departs = self.departs();
        let mut step = self.start(samples, begun);
        let mut round = Round::new(samples, size);
        // A residual force that depends on the motion varies as slip does.
        round.slipped = departs(&step) || begun.moves(&step.jacobian);
        let mut last_change = f64::INFINITY;
        let (mut pushes, mut jump): (usize, Option<(Vec<f64>, f64)>) = (0, None);
        loop {
            let derived = pushes >= PUSHES;
            let before = step.state.clone();
            if self.lap(samples, &before, PERIODIC, &mut round) {
                step.state.clone_from(&round.end);
            } else {
                self.pass(samples, &mut step, derived, &mut round);
            }
            let largest = round.largest;
            let change = distance(&step.state, &before);
            let slips = !derived || round.moves;
            let small = |change: f64| change <= SMALL * largest;
            // A jump that was not small is confirmed by another one.
            let unsure = jump.take().filter(|(_, by)| !small(*by));
            let periodic = change <= PERIODIC * largest && unsure.is_none();
            if let Some((state, by)) = unsure.filter(|_| !slips) {
                // Beyond where slip ends: the march goes on from before the jump.
                (step.state, last_change, pushes) = (state, by, 0);
                round.restarts.pop();
                round.restarts.push(Restart::GoesOn);
                self.settle(samples, &mut step);
                continue;
            }
            if periodic || round.restarts.len() == MOST_ROUNDS {
                return round;
            }
            let restart = if derived {
                let restart = round.fixed_point();
                jump = restart.is_some().then(|| (step.state.clone(), change));
                restart.unwrap_or(Restart::GoesOn)
            } else if samples.sign < 0.0 && change > SLOW * last_change {
                Restart::Mean
            } else {
                Restart::GoesOn
            };
            if !matches!(restart, Restart::GoesOn) {
                restart.apply(&mut step.state, &before);
                self.settle(samples, &mut step);
            }
            round.restarts.push(restart);
            (pushes, last_change) = (pushes + 1, change);
        }
    }

    /// Whether the force departs from the stuck spring's in a step.
    fn departs(&self) -> impl Fn(&Step) -> bool {
        let (stiffness, state_stiffness) = (self.law.stiffness(), self.law.state_stiffness());
        move |step| {
            let stays = step.springs
                || (is_elastic(&step.jacobian, &state_stiffness)
                    && follows(&step.jacobian, &stiffness, &state_stiffness));
            !stays
        }
    }

    /// Takes a round step by step, with its derivative if it is asked for; without, only until it meets the round
    /// before: from there on it is the same.
    fn pass(&self, samples: &Samples, step: &mut Step, derived: bool, round: &mut Round) {
        let mut lap = derived.then(|| LapDerivative::new(self.law.state_size()));
        let (count, size) = (self.law.displacements(), self.law.state_size());
        let departs = self.departs();
        let before = (round.largest, round.departure);
        (round.largest, round.departure) = (0.0, None);
        for n in 1..=samples.count {
            let old = (n - 1) * count;
            let known = &mut round.state[(n - 1) * size..n * size];
            if lap.is_none() && size > 0 && *known == *step.state {
                round.largest = round.largest.max(before.0);
                round.departure = round.departure.max(before.1.filter(|last| *last >= n - 1));
                step.state.clone_from(&round.end);
                return self.settle(samples, step);
            }
            known.copy_from_slice(&step.state);
            round.force[old..old + count].copy_from_slice(&step.force);
            // Once it has slipped, forces are enough unless more is asked for.
            let derived = !round.slipped || lap.is_some();
            self.advance(samples, n, step, derived);
            if let Some(lap) = lap.as_mut().filter(|_| !step.springs) {
                lap.advance(&step.jacobian.by_state);
            }
            let departed = derived && departs(step);
            if departed || !derived {
                round.departure = Some(n - 1);
            }
            round.slipped |= departed;
            round.largest = step.state.iter().fold(round.largest, |most, z| most.max(z.abs()));
        }
        step.state.iter_mut().for_each(|z| *z *= samples.sign);
        step.force.iter_mut().for_each(|f| *f *= samples.sign);
        round.end.clone_from(&step.state);
        if let Some(lap) = lap {
            round.moves = !is_identity(&lap.by, size);
            round.by = scaled(&lap.by, samples.sign);
        }
    }

    /// Gives a state at the first instant its force.
    fn settle(&self, samples: &Samples, step: &mut Step) {
        let (u, Step { state, force, .. }) = (samples.at(0), step);
        self.law.return_map(u, u, state, force, None);
    }

    /// Derivative of the march, start and history included.
    pub(super) fn differentiate(
        &self,
        samples: &Samples,
        begun: &AssumedStart,
        rounds: &[Restart],
        slots: usize,
        out: &mut [f64],
    ) {
        let mut step = self.start(samples, begun);
        let mut rate = Rate::new(self.law.stiffness(), self.law.state_stiffness(), slots);
        rate.follow(&step.jacobian, None, samples.basis(0));
        rate.begin(&step.jacobian, &begun.rate);
        let mut sum = vec![0.0; slots];
        let mut before = (step.state.clone(), rate.clone());
        for (round, restart) in rounds.iter().enumerate() {
            let last = round + 1 == rounds.len();
            restart.apply(&mut step.state, &before.0);
            rate.restart(&before.1, restart);
            before = (step.state.clone(), rate.clone());
            for n in 1..=samples.count {
                let told = last.then_some([&mut sum[..], &mut *out]);
                let changes = self.advance_derived(samples, n, &mut step, &rate, told);
                let wraps = n == samples.count;
                if wraps || changes {
                    if last {
                        rate.add_to(&step.force_by_state, &mut sum, out);
                    }
                    let sign = if wraps { samples.sign } else { 1.0 };
                    if changes {
                        let [before, after] = [n - 1, n].map(|n| samples.basis(n));
                        rate.follow(&step.jacobian, Some(before), &scaled(after, sign));
                    }
                    rate.scale(sign);
                    step.state.iter_mut().for_each(|z| *z *= sign);
                }
            }
        }
    }
}

pub(super) fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}
