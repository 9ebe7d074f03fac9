//! The march of the sampled evaluation: from instant to instant until the state repeats, and its
//! derivative.

use super::rate::{follows, is_elastic, FrictionWork, Rate};
use super::restart::Restart;
use super::samples::Samples;
use crate::contact::periodic_march::SLOW;
use crate::contact::return_map::ReturnMapJacobian;
use crate::contact::{Aft, AssumedStart, ContactLaw, Element, Motion, Residual, Unslipped};
use faer::Mat;
use std::f64::consts::TAU;
use std::ops::Deref;

/// Rounds after which a march ends, repeated or not. An elastoplastic contact forgets its start with
/// the first slip in either direction; several coupled points take some rounds more.
const MOST_ROUNDS: usize = 200;
/// Change of the state over a round, relative to the largest, that counts as none, …
const PERIODIC: f64 = 1e-13;
/// … and that is small enough for the fixed point of the linearised round to be exact.
const SMALL: f64 = 1e-7;
/// Rounds after which slip is taken to recur, so that its fixed point is sought.
const PUSHES: usize = 3;

/// One round of states that repeat.
pub(super) struct Round {
    /// States and forces, instant after instant.
    pub(super) state: Vec<f64>,
    pub(super) force: Vec<f64>,
    /// Rounds marched until the states repeated, by how each has begun.
    pub(super) restarts: Vec<Restart>,
    /// Sum over the steps of the share in slip, per displacement.
    pub(super) slipping: Vec<f64>,
    /// Friction work of every displacement over the span, if it was asked for.
    pub(super) work: Vec<f64>,
    /// Whether the force has ever departed from the stuck spring's, by slip or otherwise.
    pub(super) slipped: bool,
}

/// What a march takes from instant to instant.
pub(super) struct Step {
    state: Vec<f64>,
    force: Vec<f64>,
    jacobian: ReturnMapJacobian,
    /// Displacements at the end, in the span or mirrored behind it.
    after: Vec<f64>,
    /// The derivative of all steps that are those of the spring, if there has been one.
    spring: Option<ReturnMapJacobian>,
    /// Whether that is the derivative at hand.
    springs: bool,
}

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
        let (before, state) = (&begun.displacement, begun.state.clone());
        let mut step = Step {
            state,
            force: vec![0.0; before.len()],
            jacobian: ReturnMapJacobian::default(),
            after: samples.at(0).to_vec(),
            spring: None,
            springs: false,
        };
        let Step { state, force, jacobian, after, .. } = &mut step;
        self.law.return_map(before, after, state, force, Some(jacobian));
        step
    }

    /// Goes from instant n − 1 to instant n, which may be the first of the next span; with the
    /// derivative of the step, if asked for.
    pub(super) fn advance(&self, samples: &Samples, n: usize, step: &mut Step, derived: bool) {
        let sign = if n == samples.count { samples.sign } else { 1.0 };
        let Step { state, force, jacobian, after, spring, springs } = step;
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

    /// Marches until the state repeats; with `account` of the friction work.
    pub(super) fn march(&self, samples: &Samples, begun: &AssumedStart, account: bool) -> Round {
        let (count, size) = (self.law.displacements(), self.law.state_size());
        let (stiffness, state_stiffness) = (self.law.stiffness(), self.law.state_stiffness());
        let departs = |step: &Step| {
            let stays = step.springs
                || (is_elastic(&step.jacobian, &state_stiffness)
                    && follows(&step.jacobian, &stiffness, &state_stiffness));
            !stays
        };
        let mut step = self.start(samples, begun);
        let mut round = Round {
            state: vec![0.0; samples.count * size],
            force: vec![0.0; samples.count * count],
            restarts: vec![Restart::GoesOn],
            slipping: Vec::new(),
            work: Vec::new(),
            // A residual force that depends on the motion varies as slip does.
            slipped: departs(&step) || begun.moves(&step.jacobian),
        };
        let couples = |element: &Element| element.law.planes().is_empty();
        let coupled = self.law.elements().is_some_and(|elements| elements.iter().all(couples));
        let friction = account.then(|| FrictionWork::new(self.law.stiffness(), coupled));
        let mut last_change = f64::INFINITY;
        let (mut pushes, mut jump): (usize, Option<(Vec<f64>, f64)>) = (0, None);
        loop {
            let mut lap = (pushes >= PUSHES).then(|| Lap::new(size));
            round.slipping = vec![0.0; count];
            round.work = vec![0.0; count];
            let before = step.state.clone();
            let mut largest = 0.0_f64;
            for n in 1..=samples.count {
                let old = (n - 1) * count;
                round.state[(n - 1) * size..n * size].copy_from_slice(&step.state);
                round.force[old..old + count].copy_from_slice(&step.force);
                // Once it has slipped, forces are enough unless more is asked for.
                let derived = account || !round.slipped || lap.is_some();
                self.advance(samples, n, &mut step, derived);
                if let Some(lap) = lap.as_mut().filter(|_| !step.springs) {
                    lap.advance(&step.jacobian.by_state);
                }
                round.slipped = round.slipped || departs(&step);
                largest = step.state.iter().fold(largest, |most, z| most.max(z.abs()));
                let shares = round.slipping.iter_mut().zip(&step.jacobian.slipping);
                shares.for_each(|(sum, share)| *sum += share);
                if let Some(friction) = &friction {
                    let du: Vec<f64> =
                        step.after.iter().zip(samples.at(n - 1)).map(|(a, b)| a - b).collect();
                    let before = &round.force[old..old + count];
                    let slipping = &step.jacobian.slipping;
                    friction.add(before, &step.force, &du, slipping, &mut round.work);
                }
            }
            step.state.iter_mut().for_each(|z| *z *= samples.sign);
            step.force.iter_mut().for_each(|f| *f *= samples.sign);
            let change = step.state.iter().zip(&before).map(|(a, b)| (a - b).abs());
            let change = change.fold(0.0, f64::max);
            let slips = lap.as_ref().is_none_or(|lap| !is_identity(&lap.by, size));
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
            let restart = match lap {
                Some(lap) => {
                    let mirrored = |i, j| samples.sign * lap.by[i * size + j];
                    let restart = Restart::at_fixed_point(&Mat::from_fn(size, size, mirrored));
                    jump = restart.is_some().then(|| (step.state.clone(), change));
                    restart.unwrap_or(Restart::GoesOn)
                }
                None if samples.sign < 0.0 && change > SLOW * last_change => Restart::Mean,
                None => Restart::GoesOn,
            };
            if !matches!(restart, Restart::GoesOn) {
                restart.apply(&mut step.state, &before);
                self.settle(samples, &mut step);
            }
            round.restarts.push(restart);
            (pushes, last_change) = (pushes + 1, change);
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
        let stiffness = self.law.stiffness();
        let state_stiffness = self.law.state_stiffness();
        let mut step = self.start(samples, begun);
        let basis = |n: usize| &samples.basis[(n % samples.count) * slots..][..slots];
        let mut rate = Rate::new(stiffness, state_stiffness.clone(), slots);
        rate.follow(&step.jacobian, None, basis(0));
        rate.begin(&step.jacobian, &begun.rate);
        let weight = 2.0 / samples.count as f64;
        let (mut sum, mut force_by_state) = (vec![0.0; slots], Vec::new());
        let mut before = (step.state.clone(), rate.clone());
        for (round, restart) in rounds.iter().enumerate() {
            let last = round + 1 == rounds.len();
            restart.apply(&mut step.state, &before.0);
            rate.restart(&before.1, restart);
            before = (step.state.clone(), rate.clone());
            for n in 1..=samples.count {
                if last {
                    // Between two slips the slip load keeps its derivative: instants are summed.
                    sum.iter_mut().zip(basis(n - 1)).for_each(|(sum, b)| *sum += weight * b);
                    if !step.springs {
                        rate.add_direct(&step.jacobian, weight, basis(n - 1), out);
                    }
                }
                force_by_state.clone_from(&step.jacobian.force_by_state);
                self.advance(samples, n, &mut step, true);
                let wraps = n == samples.count;
                let elastic = step.springs || is_elastic(&step.jacobian, &state_stiffness);
                let changes = !elastic || force_by_state != step.jacobian.force_by_state;
                if wraps || changes {
                    if last {
                        rate.add_to(&force_by_state, &mut sum, out);
                    }
                    let sign = if wraps { samples.sign } else { 1.0 };
                    if changes {
                        rate.follow(&step.jacobian, Some(basis(n - 1)), &scaled(basis(n), sign));
                    }
                    rate.scale(sign);
                    step.state.iter_mut().for_each(|z| *z *= sign);
                }
            }
        }
    }

    /// States and forces at equidistant instants. Between two instants of the march the law goes on
    /// from the earlier one.
    pub(super) fn history(&self, motion: Motion<'_>, samples: usize) -> (Vec<f64>, Vec<f64>) {
        if self.is_sum() {
            let parts: Vec<_> =
                self.parts().iter().map(|part| part.history(motion, samples)).collect();
            let mut states = Vec::with_capacity(samples * self.law.state_size());
            for n in 0..samples {
                for (own, _) in &parts {
                    let width = own.len() / samples;
                    states.extend(&own[n * width..(n + 1) * width]);
                }
            }
            let mut forces = vec![0.0; samples * self.law.displacements()];
            for (_, own) in &parts {
                forces.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
            }
            return (states, forces);
        }
        let harmonics = motion.table.harmonics();
        let (slots, count) = (harmonics.slots(), self.law.displacements());
        let size = self.law.state_size();
        let grid = Samples::of(motion, self.samples);
        let stuck = self.stuck(&grid, motion.residual);
        let round = self.march(&grid, &self.begin(motion), false);
        let (mut states, mut forces) = (Vec::new(), Vec::new());
        for m in 0..samples {
            let theta = TAU * m as f64 / samples as f64;
            let u: Vec<f64> = motion
                .displacement
                .chunks_exact(slots)
                .map(|series| harmonics.jet(series, theta)[0])
                .collect();
            let instant = (m * self.samples / samples) % self.samples;
            let n = instant % grid.count;
            let sign = if instant < grid.count { 1.0 } else { grid.sign };
            let mut state = round.state[n * size..(n + 1) * size].to_vec();
            let mut force = vec![0.0; count];
            self.law.return_map(grid.at(n), &scaled(&u, sign), &mut state, &mut force, None);
            if let Some((load, _)) = stuck {
                let mean = if harmonics.has_mean() { load } else { 0.0 };
                force[0] = sign * (self.law.stiffness()[(0, 0)] * u[0] - mean);
                if size == 1 {
                    state[0] = force[0];
                }
            }
            states.extend(scaled(&state, sign));
            forces.extend(scaled(&force, sign));
        }
        (states, forces)
    }
}

/// Derivative of a part of a round: numbers of state by those that it begins with, row by row.
struct Lap {
    size: usize,
    by: Vec<f64>,
    room: Vec<f64>,
}

impl Lap {
    fn new(size: usize) -> Self {
        let by: Vec<f64> = (0..size * size).map(|at| own(at, size)).collect();
        Self { size, room: by.clone(), by }
    }

    /// Goes on by a step with a derivative.
    fn advance(&mut self, step: &[f64]) {
        let size = self.size;
        if is_identity(step, size) {
            return;
        }
        for (at, entry) in self.room.iter_mut().enumerate() {
            let (row, column) = (at / size * size, at % size);
            *entry = (0..size).map(|k| step[row + k] * self.by[k * size + column]).sum();
        }
        std::mem::swap(&mut self.by, &mut self.room);
    }
}

fn own(at: usize, size: usize) -> f64 {
    f64::from(u8::from(at / size == at % size))
}

fn is_identity(matrix: &[f64], size: usize) -> bool {
    matrix.iter().enumerate().all(|(at, entry)| *entry == own(at, size))
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}
