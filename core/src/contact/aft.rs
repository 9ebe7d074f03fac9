//! The sampled evaluation of a law: alternating frequency and time (Cameron and Griffin 1989;
//! Guillen 1999, section 3.2).
//!
//! The displacements are sampled at equidistant instants, the law's return map takes its state from
//! instant to instant until it repeats, and a discrete Fourier transform leads back. The error is
//! of second order in the distance of the samples. It serves laws that have no closed form, and
//! comparisons with those that have one.

use super::law::{HarmonicForce, ReturnMapJacobian};
use super::march_rate::{is_elastic, FrictionWork, Rate};
use super::passage::SLOW;
use super::samples::Samples;
use super::slip_series::halve_means;
use super::{
    ContactLaw, Describing, Element, Motion, Parameter, Phase, PointSummary, Residual, SlipLoad,
};
use crate::Error;
use faer::Mat;
use std::f64::consts::TAU;
use std::ops::Deref;

/// Fewest samples: a coarser grid shows no hysteresis loop.
const FEWEST: usize = 8;
/// Most samples: as many as memory holds with ease.
const MOST: usize = 1 << 20;
/// Rounds after which a march is taken as it is. An elastoplastic contact forgets its start with
/// the first slip in either direction; several coupled points take some rounds more.
const MOST_ROUNDS: usize = 200;
/// Step of differences in a parameter, relative to it.
const DIFFERENCE: f64 = 1e-5;
/// Change of the state over a round, relative to the largest, that counts as none.
const PERIODIC: f64 = 1e-13;

/// A law that is evaluated through a fixed number of samples per period.
#[derive(Debug)]
pub struct Aft<L> {
    pub(super) law: L,
    pub(super) samples: usize,
}

/// One round of states that repeat.
struct Round {
    /// States and forces, instant after instant.
    state: Vec<f64>,
    force: Vec<f64>,
    /// Rounds marched until the states repeated, each with whether its start was the mean of the
    /// two before.
    averaged: Vec<bool>,
    /// Sum over the steps of the share in slip, per displacement.
    slipping: Vec<f64>,
    /// Friction work of every displacement over the span, if it was asked for.
    work: Vec<f64>,
    /// Whether anything has slipped from the start on.
    slipped: bool,
}

/// What goes from instant to instant.
struct Step {
    state: Vec<f64>,
    force: Vec<f64>,
    jacobian: ReturnMapJacobian,
    /// Displacements at the end, in the span or mirrored behind it.
    after: Vec<f64>,
}

impl Aft<Box<dyn ContactLaw>> {
    /// A law evaluated at `samples` instants per period.
    ///
    /// # Errors
    /// An odd or too small number of samples.
    pub fn new(law: Box<dyn ContactLaw>, samples: usize) -> Result<Self, Error> {
        if !(FEWEST..=MOST).contains(&samples) || samples % 2 == 1 {
            let remedy = format!("must be an even number from {FEWEST} to {MOST}");
            return Err(Error::value("samples", samples as f64, &remedy));
        }
        Ok(Self { law, samples })
    }
}

impl<L: Deref<Target: ContactLaw>> Aft<L> {
    /// The parts of a sum of laws: what one of them keeps while it never slips is its own.
    fn parts(&self) -> Vec<Aft<Box<dyn ContactLaw>>> {
        let sampled = |law| Aft { law, samples: self.samples };
        self.law.parts().into_iter().map(sampled).collect()
    }

    fn is_sum(&self) -> bool {
        !self.law.parts().is_empty()
    }

    /// Slip load of a contact that never slips, from the extreme samples: its value, and their
    /// instants with the derivatives in them.
    fn stuck(&self, samples: &Samples, residual: Residual) -> Option<(f64, [(usize, f64); 2])> {
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

    /// The first instant, reached without any slip as far as the law admits it.
    fn start(&self, samples: &Samples) -> Step {
        let (count, size) = (self.law.displacements(), self.law.state_size());
        let mut step = Step {
            state: vec![0.0; size],
            force: vec![0.0; count],
            jacobian: ReturnMapJacobian::default(),
            after: samples.at(0).to_vec(),
        };
        let Step { state, force, jacobian, after } = &mut step;
        self.law.return_map(&vec![0.0; count], after, state, force, Some(jacobian));
        step
    }

    /// Goes from instant n − 1 to instant n, which may be the first of the next span.
    fn advance(&self, samples: &Samples, n: usize, step: &mut Step) {
        let sign = if n == samples.count { samples.sign } else { 1.0 };
        let Step { state, force, jacobian, after } = step;
        let now = samples.at(n % samples.count);
        after.iter_mut().zip(now).for_each(|(after, now)| *after = sign * now);
        self.law.return_map(samples.at(n - 1), after, state, force, Some(jacobian));
    }

    /// Marches until the state repeats; with `account` of the friction work.
    fn march(&self, samples: &Samples, account: bool) -> Round {
        let (count, size) = (self.law.displacements(), self.law.state_size());
        let mut step = self.start(samples);
        let mut round = Round {
            state: vec![0.0; samples.count * size],
            force: vec![0.0; samples.count * count],
            averaged: vec![false],
            slipping: Vec::new(),
            work: Vec::new(),
            slipped: !step.jacobian.sticks(),
        };
        let friction =
            account.then(|| FrictionWork::new(self.law.stiffness(), self.law.elements().is_some()));
        let mut last_change = f64::INFINITY;
        loop {
            round.slipping = vec![0.0; count];
            round.work = vec![0.0; count];
            let before = step.state.clone();
            let mut largest = 0.0_f64;
            for n in 1..=samples.count {
                let old = (n - 1) * count;
                round.state[(n - 1) * size..n * size].copy_from_slice(&step.state);
                round.force[old..old + count].copy_from_slice(&step.force);
                self.advance(samples, n, &mut step);
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
            round.slipped |= round.slipping.iter().any(|&share| share > 0.0);
            let change = step.state.iter().zip(&before).map(|(a, b)| (a - b).abs());
            let change = change.fold(0.0, f64::max);
            if change <= PERIODIC * largest || round.averaged.len() == MOST_ROUNDS {
                return round;
            }
            let alternates = samples.sign < 0.0 && change > SLOW * last_change;
            if alternates {
                step.average(&before);
                let (u, Step { state, force, .. }) = (samples.at(0), &mut step);
                self.law.return_map(u, u, state, force, None);
            }
            round.averaged.push(alternates);
            last_change = change;
        }
    }

    /// Derivative of the march, start and history included.
    fn differentiate(&self, samples: &Samples, rounds: &[bool], slots: usize, out: &mut [f64]) {
        let stiffness = self.law.stiffness();
        let state_stiffness = self.law.state_stiffness();
        let mut step = self.start(samples);
        let basis = |n: usize| &samples.basis[(n % samples.count) * slots..][..slots];
        let mut rate = Rate::new(stiffness, state_stiffness.clone(), slots);
        rate.follow(&step.jacobian, None, basis(0));
        let weight = 2.0 / samples.count as f64;
        let mut sum = vec![0.0; slots];
        let mut before = (step.state.clone(), rate.clone());
        for (round, averaged) in rounds.iter().enumerate() {
            let last = round + 1 == rounds.len();
            if *averaged {
                step.average(&before.0);
                rate.average(&before.1);
            }
            before = (step.state.clone(), rate.clone());
            for n in 1..=samples.count {
                if last {
                    // Between two slips the slip load keeps its derivative: instants are summed.
                    sum.iter_mut().zip(basis(n - 1)).for_each(|(sum, b)| *sum += weight * b);
                    rate.add_direct(&step.jacobian, weight, basis(n - 1), out);
                }
                let force_by_state = step.jacobian.force_by_state.clone();
                self.advance(samples, n, &mut step);
                let wraps = n == samples.count;
                let changes = !is_elastic(&step.jacobian, &state_stiffness)
                    || force_by_state != step.jacobian.force_by_state;
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
}

impl Step {
    /// Begins a round from the mean of its state and that of the round before.
    fn average(&mut self, before: &[f64]) {
        self.state.iter_mut().zip(before).for_each(|(z, before)| *z = 0.5 * (*z + before));
    }
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}

impl<L: Deref<Target: ContactLaw>> HarmonicForce for Aft<L> {
    fn resolves(&self) -> usize {
        self.samples / 2 - 1
    }

    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let harmonics = motion.table.harmonics();
        let (slots, count) = (harmonics.slots(), self.law.displacements());
        out.reset(count * slots, tangent);
        let mut own = SlipLoad::default();
        for part in self.parts() {
            part.slip_load(motion, tangent, &mut own);
            out.value.iter_mut().zip(&own.value).for_each(|(sum, own)| *sum += own);
            out.tangent.iter_mut().zip(&own.tangent).for_each(|(sum, own)| *sum += own);
            out.active |= own.active;
        }
        if self.is_sum() {
            return;
        }
        let samples = Samples::of(motion, self.samples);
        let basis = |n: usize| &samples.basis[n * slots..(n + 1) * slots];
        if let Some((load, ends)) = self.stuck(&samples, motion.residual) {
            if harmonics.has_mean() {
                out.value[0] = load;
                out.active = ends.iter().any(|(_, slope)| *slope != 0.0);
                for (n, slope) in ends.into_iter().filter(|_| tangent) {
                    let row = out.tangent.iter_mut().zip(basis(n));
                    row.for_each(|(entry, b)| *entry += slope * b);
                }
            }
            return;
        }
        let round = self.march(&samples, false);
        if !round.slipped {
            return;
        }
        out.active = true;
        let stiffness = self.law.stiffness();
        let weight = 2.0 / samples.count as f64;
        for n in 0..samples.count {
            let u = samples.at(n);
            for (i, series) in out.value.chunks_exact_mut(slots).enumerate() {
                let stuck: f64 = (0..count).map(|j| stiffness[(i, j)] * u[j]).sum();
                let q = weight * (stuck - round.force[n * count + i]);
                series.iter_mut().zip(basis(n)).for_each(|(value, b)| *value += q * b);
            }
        }
        if tangent {
            self.differentiate(&samples, &round.averaged, slots, &mut out.tangent);
        }
        halve_means(harmonics, count, out);
    }

    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        out.fill(PointSummary::default());
        let total = self.law.stiffness();
        let mut own = out.to_vec();
        for part in self.parts() {
            part.summary(motion, &mut own);
            let stiffness = part.law.stiffness();
            for (i, (sum, own)) in out.iter_mut().zip(&own).enumerate() {
                sum.slip_fraction += stiffness[(i, i)] / total[(i, i)] * own.slip_fraction;
                sum.dissipation += own.dissipation;
            }
        }
        if self.is_sum() {
            return;
        }
        let samples = Samples::of(motion, self.samples);
        if self.stuck(&samples, motion.residual).is_some() {
            return;
        }
        let round = self.march(&samples, true);
        let spans = (self.samples / samples.count) as f64;
        // Without slip all work is elastic, and only rounding is left of it.
        let slips = round.slipping.iter().any(|share| *share > 0.0);
        for (i, summary) in out.iter_mut().enumerate().filter(|_| slips) {
            summary.slip_fraction = round.slipping[i] / samples.count as f64;
            summary.dissipation = spans * round.work[i];
        }
    }

    fn state_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        self.history(motion, samples).0
    }

    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        self.history(motion, samples).1
    }

    fn phases(&self, motion: Motion<'_>) -> Vec<Phase> {
        Phase::from_forces(&self.force_history(motion, Phase::INSTANTS), &self.law.limits())
    }

    /// By central differences: a march has no derivative in a parameter that would serve all laws.
    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        out.fill(0.0);
        let value = self.law.parameters()[index].value;
        let step = DIFFERENCE * value;
        if !(step > 0.0 && step.is_finite()) {
            return;
        }
        let slots = motion.table.harmonics().slots();
        let mut load = SlipLoad::default();
        for side in [0.5, -0.5] {
            let Ok(law) = self.law.with_parameter(index, value + side * step) else { continue };
            let law = Aft { law, samples: self.samples };
            law.slip_load(motion, false, &mut load);
            let stiffness = law.law.stiffness();
            let weight = side.signum() / step;
            for (i, series) in out.chunks_exact_mut(slots).enumerate() {
                for (slot, slope) in series.iter_mut().enumerate() {
                    let stuck: f64 = (0..self.law.displacements())
                        .map(|j| stiffness[(i, j)] * motion.displacement[j * slots + slot])
                        .sum();
                    *slope += weight * (stuck - load.value[i * slots + slot]);
                }
            }
        }
    }
}

impl<L: Deref<Target: ContactLaw>> Aft<L> {
    /// States and forces at equidistant instants. Between two instants of the march the law goes on
    /// from the earlier one.
    fn history(&self, motion: Motion<'_>, samples: usize) -> (Vec<f64>, Vec<f64>) {
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
        let stuck = self.stuck(&grid, motion.residual).filter(|_| size == 1);
        let round = self.march(&grid, false);
        let (mut states, mut forces) = (Vec::new(), Vec::new());
        for m in 0..samples {
            let theta = TAU * m as f64 / samples as f64;
            let u: Vec<f64> = motion
                .displacement
                .chunks_exact(slots)
                .map(|series| harmonics.jet(series, theta)[0])
                .collect();
            if let Some((load, _)) = stuck {
                let mean = if harmonics.has_mean() { load } else { 0.0 };
                let force = self.law.stiffness()[(0, 0)] * u[0] - mean;
                states.push(force);
                forces.push(force);
                continue;
            }
            let instant = (m * self.samples / samples) % self.samples;
            let n = instant % grid.count;
            let sign = if instant < grid.count { 1.0 } else { grid.sign };
            let mut state = round.state[n * size..(n + 1) * size].to_vec();
            let mut force = vec![0.0; count];
            self.law.return_map(grid.at(n), &scaled(&u, sign), &mut state, &mut force, None);
            states.extend(scaled(&state, sign));
            forces.extend(scaled(&force, sign));
        }
        (states, forces)
    }
}

impl ContactLaw for Aft<Box<dyn ContactLaw>> {
    fn name(&self) -> &'static str {
        self.law.name()
    }

    fn displacements(&self) -> usize {
        self.law.displacements()
    }

    fn state_size(&self) -> usize {
        self.law.state_size()
    }

    fn stiffness(&self) -> Mat<f64> {
        self.law.stiffness()
    }

    fn state_stiffness(&self) -> Mat<f64> {
        self.law.state_stiffness()
    }

    fn is_odd(&self) -> bool {
        self.law.is_odd()
    }

    fn is_monotone(&self) -> bool {
        self.law.is_monotone()
    }

    fn limits(&self) -> Vec<f64> {
        self.law.limits()
    }

    fn onsets(&self) -> Vec<f64> {
        self.law.onsets()
    }

    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: Option<&mut ReturnMapJacobian>,
    ) {
        self.law.return_map(before, after, state, force, jacobian);
    }

    fn stuck_load(&self, residual: Residual, low: f64, high: f64) -> Option<[f64; 3]> {
        self.law.stuck_load(residual, low, high)
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        let law = self.law.with_scaled_stiffness(share);
        Box::new(Self { law, samples: self.samples })
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        Box::new(Self { law: self.law.with_scaled_forces(factor), samples: self.samples })
    }

    fn parameters(&self) -> Vec<Parameter> {
        self.law.parameters()
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        let law = self.law.with_parameter(index, value)?;
        Ok(Box::new(Self { law, samples: self.samples }))
    }

    fn closed_form(&self) -> Option<&dyn HarmonicForce> {
        Some(self)
    }

    fn elements(&self) -> Option<Vec<Element>> {
        self.law.elements()
    }

    fn describing(&self, amplitude: f64) -> Option<Describing> {
        self.law.describing(amplitude)
    }
}
