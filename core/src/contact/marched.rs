//! The marched evaluation of a law: alternating frequency and time (Cameron and Griffin 1989;
//! Guillen 1999, section 3.2).
//!
//! The displacements are sampled at equidistant instants, the law's return map takes the forces
//! from instant to instant until they repeat, and a discrete Fourier transform leads back. The
//! error is of second order in the distance of the samples. It serves laws that have no closed
//! form, and comparisons with those that have one.

use super::march_rate::{add_work, is_identity, sticks, Rate};
use super::passage::SLOW;
use super::samples::Samples;
use super::slip_series::halve_means;
use super::{
    Describing, FrictionLaw, Motion, Parameter, PointState, PointSummary, Residual, SlipLoad,
};
use crate::Error;
use faer::Mat;
use std::f64::consts::TAU;

/// Fewest samples: below it there is no loop to speak of.
const FEWEST: usize = 8;
/// Most samples: as many as memory holds with ease.
const MOST: usize = 1 << 20;
/// Rounds after which a march is taken as it is. An elastoplastic contact forgets its start with
/// the first slip in either direction; several coupled points take some rounds more.
const MOST_ROUNDS: usize = 200;
/// Step of differences in a parameter, relative to it.
const DIFFERENCE: f64 = 1e-5;
/// Change of the forces over a round, relative to the largest, that counts as none.
const PERIODIC: f64 = 1e-13;

/// A law that is evaluated by marching through a fixed number of samples per period.
#[derive(Debug)]
pub struct Marched {
    law: Box<dyn FrictionLaw>,
    samples: usize,
}

/// One round of forces that repeat.
struct Round {
    /// Instant after instant.
    force: Vec<f64>,
    /// Rounds marched until the forces repeated, each with whether its start was the mean of the
    /// two before.
    averaged: Vec<bool>,
    /// Steps in slip per point.
    slipping: Vec<usize>,
    /// Friction work of every point over the span, if it was asked for.
    work: Vec<f64>,
    /// Whether anything has slipped from the start on.
    slipped: bool,
}

impl Marched {
    /// A law evaluated at `samples` instants per period.
    ///
    /// # Errors
    /// An odd or too small number of samples.
    pub fn new(law: Box<dyn FrictionLaw>, samples: usize) -> Result<Self, Error> {
        if !(FEWEST..=MOST).contains(&samples) || samples % 2 == 1 {
            let remedy = format!("must be an even number from {FEWEST} to {MOST}");
            return Err(Error::value("samples", samples as f64, &remedy));
        }
        Ok(Self { law, samples })
    }

    /// Slip load of a contact that never slips, from the extreme samples: its value, and their
    /// instants with the derivatives in them.
    fn stuck(&self, samples: &Samples, residual: Residual) -> Option<(f64, [(usize, f64); 2])> {
        if self.points() > 1 {
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

    /// Takes the forces from instant n − 1 to instant n, which may be the first of the next span.
    /// `du` is the change of displacement on the way.
    fn step(
        &self,
        samples: &Samples,
        n: usize,
        du: &mut [f64],
        force: &mut [f64],
        gain: &mut [f64],
    ) {
        let wraps = n == samples.count;
        let (now, sign) = (samples.at(n % samples.count), if wraps { samples.sign } else { 1.0 });
        for ((du, now), last) in du.iter_mut().zip(now).zip(samples.at(n - 1)) {
            *du = sign * now - last;
        }
        self.law.advance(du, force, Some(gain));
    }

    /// Forces without any slip before the first instant, as far as the law admits them.
    fn start(&self, samples: &Samples, gain: &mut [f64]) -> Vec<f64> {
        let mut force = vec![0.0; self.points()];
        self.law.advance(&samples.displacement[..force.len()], &mut force, Some(gain));
        force
    }

    /// Marches until the forces repeat; with `account` of the friction work.
    fn march(&self, samples: &Samples, account: bool) -> Round {
        let points = self.points();
        let mut gain = vec![0.0; points * points];
        let mut force = self.start(samples, &mut gain);
        let mut round = Round {
            force: vec![0.0; samples.count * points],
            averaged: vec![false],
            slipping: Vec::new(),
            work: Vec::new(),
            slipped: !is_identity(&gain, points),
        };
        let (mut du, mut before) = (vec![0.0; points], vec![0.0; points]);
        let mut last_change = f64::INFINITY;
        loop {
            round.slipping = vec![0; points];
            round.work = vec![0.0; points];
            before.copy_from_slice(&force);
            let mut largest = 0.0_f64;
            for n in 1..=samples.count {
                let old = (n - 1) * points;
                round.force[old..old + points].copy_from_slice(&force);
                self.step(samples, n, &mut du, &mut force, &mut gain);
                for (i, (f, steps)) in force.iter().zip(&mut round.slipping).enumerate() {
                    largest = largest.max(f.abs());
                    *steps += usize::from(!sticks(&gain, points, i));
                }
                if account {
                    add_work(
                        self.law.as_ref(),
                        &round.force[old..old + points],
                        &force,
                        &du,
                        &gain,
                        &mut round.work,
                    );
                }
            }
            force.iter_mut().for_each(|f| *f *= samples.sign);
            round.slipped |= round.slipping.iter().any(|&steps| steps > 0);
            let change = force.iter().zip(&before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if change <= PERIODIC * largest || round.averaged.len() == MOST_ROUNDS {
                return round;
            }
            let alternates = samples.sign < 0.0 && change > SLOW * last_change;
            if alternates {
                force.iter_mut().zip(&before).for_each(|(f, before)| *f = 0.5 * (*f + before));
            }
            round.averaged.push(alternates);
            last_change = change;
        }
    }

    /// Derivative of the march, start and history included. With trial forces `D u − q` before and
    /// the gain P of the return map, `dq_n = P dq_{n−1} + (I − P) D du_n`.
    fn differentiate(&self, samples: &Samples, rounds: &[bool], slots: usize, out: &mut [f64]) {
        let points = self.points();
        let mut gain = vec![0.0; points * points];
        let mut force = self.start(samples, &mut gain);
        let mut rate = Rate::new(self.law.stiffness(), slots);
        rate.follow(&gain, &samples.basis[..slots]);
        let weight = 2.0 / samples.count as f64;
        let (mut sum, mut du) = (vec![0.0; slots], vec![0.0; points]);
        let mut before = (force.clone(), rate.clone());
        for (round, averaged) in rounds.iter().enumerate() {
            let last = round + 1 == rounds.len();
            if *averaged {
                force.iter_mut().zip(&before.0).for_each(|(f, before)| *f = 0.5 * (*f + before));
                rate.average(&before.1);
            }
            before = (force.clone(), rate.clone());
            for n in 1..=samples.count {
                if last {
                    // While everything sticks q keeps its derivative: instants are summed first.
                    let basis = &samples.basis[(n - 1) * slots..n * slots];
                    sum.iter_mut().zip(basis).for_each(|(sum, b)| *sum += weight * b);
                }
                self.step(samples, n, &mut du, &mut force, &mut gain);
                let wraps = n == samples.count;
                if wraps || !is_identity(&gain, points) {
                    if last {
                        rate.add_to(&mut sum, out);
                    }
                    let sign = if wraps { samples.sign } else { 1.0 };
                    rate.scale(sign);
                    force.iter_mut().for_each(|f| *f *= sign);
                    rate.follow(&gain, &samples.basis[(n % samples.count) * slots..][..slots]);
                }
            }
        }
    }
}

impl FrictionLaw for Marched {
    fn points(&self) -> usize {
        self.law.points()
    }

    fn is_odd(&self) -> bool {
        self.law.is_odd()
    }

    fn resolves(&self) -> usize {
        self.samples / 2 - 1
    }

    fn stiffness(&self) -> Mat<f64> {
        self.law.stiffness()
    }

    fn softened(&self, share: f64) -> Box<dyn FrictionLaw> {
        Box::new(Self { law: self.law.softened(share), samples: self.samples })
    }

    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let harmonics = motion.table.harmonics();
        let (slots, points) = (harmonics.slots(), self.points());
        out.reset(points * slots, tangent);
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
                let stuck: f64 = (0..points).map(|j| stiffness[(i, j)] * u[j]).sum();
                let q = weight * (stuck - round.force[n * points + i]);
                series.iter_mut().zip(basis(n)).for_each(|(value, b)| *value += q * b);
            }
        }
        if tangent {
            self.differentiate(&samples, &round.averaged, slots, &mut out.tangent);
        }
        halve_means(harmonics, points, out);
    }

    fn stuck_load(&self, residual: Residual, low: f64, high: f64) -> Option<[f64; 3]> {
        self.law.stuck_load(residual, low, high)
    }

    fn describing(&self, amplitude: f64) -> Option<Describing> {
        self.law.describing(amplitude)
    }

    fn advance(&self, du: &[f64], force: &mut [f64], gain: Option<&mut [f64]>) {
        self.law.advance(du, force, gain);
    }

    fn limits(&self) -> Vec<f64> {
        self.law.limits()
    }

    fn tangent(&self, points: &[PointState]) -> Mat<f64> {
        self.law.tangent(points)
    }

    fn slip_rate(&self, points: &[PointState]) -> Mat<f64> {
        self.law.slip_rate(points)
    }

    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        out.fill(PointSummary::default());
        let samples = Samples::of(motion, self.samples);
        if self.stuck(&samples, motion.residual).is_some() {
            return;
        }
        let round = self.march(&samples, true);
        let spans = (self.samples / samples.count) as f64;
        for (i, summary) in out.iter_mut().enumerate() {
            summary.slip_fraction = round.slipping[i] as f64 / samples.count as f64;
            if summary.slip_fraction > 0.0 {
                summary.dissipation = spans * round.work[i];
            }
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        self.law.parameters()
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn FrictionLaw>, Error> {
        let law = self.law.with_parameter(index, value)?;
        Ok(Box::new(Self { law, samples: self.samples }))
    }

    fn magnified(&self, factor: f64) -> Box<dyn FrictionLaw> {
        Box::new(Self { law: self.law.magnified(factor), samples: self.samples })
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
            let Ok(law) = self.with_parameter(index, value + side * step) else { continue };
            law.slip_load(motion, false, &mut load);
            let stiffness = law.stiffness();
            let weight = side.signum() / step;
            for (i, series) in out.chunks_exact_mut(slots).enumerate() {
                for (slot, slope) in series.iter_mut().enumerate() {
                    let stuck: f64 = (0..self.points())
                        .map(|j| stiffness[(i, j)] * motion.displacement[j * slots + slot])
                        .sum();
                    *slope += weight * (stuck - load.value[i * slots + slot]);
                }
            }
        }
    }

    /// Between two instants of the march the law goes on from the earlier one.
    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let harmonics = motion.table.harmonics();
        let (slots, points) = (harmonics.slots(), self.points());
        let grid = Samples::of(motion, self.samples);
        let stuck = self.stuck(&grid, motion.residual);
        let round = self.march(&grid, false);
        let mut history = Vec::with_capacity(samples * points);
        for m in 0..samples {
            let theta = TAU * m as f64 / samples as f64;
            let u: Vec<f64> = motion
                .displacement
                .chunks_exact(slots)
                .map(|series| harmonics.jet(series, theta)[0])
                .collect();
            if let Some((load, _)) = stuck {
                let mean = if harmonics.has_mean() { load } else { 0.0 };
                history.push(self.stiffness()[(0, 0)] * u[0] - mean);
                continue;
            }
            let instant = (m * self.samples / samples) % self.samples;
            let n = instant % grid.count;
            let sign = if instant < grid.count { 1.0 } else { grid.sign };
            let at = n * points..(n + 1) * points;
            let mut force: Vec<f64> = round.force[at.clone()].to_vec();
            let from = &grid.displacement[at];
            let du: Vec<f64> = u.iter().zip(from).map(|(u, from)| sign * u - from).collect();
            self.law.advance(&du, &mut force, None);
            history.extend(force.iter().map(|f| sign * f));
        }
        history
    }
}
