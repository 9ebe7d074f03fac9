//! The march of a massless elastic damper through one period, from transition to transition.
//!
//! While the set of slipping points stays what it is the forces are affine in the displacements,
//! `f = T u − κ`, and the slip follows from them: both are trigonometric series, whose limits and
//! standstills are located exactly. At a transition the states follow from the rates, one point
//! after the other (Murty's principal pivoting of the rate problem), and the derivative of κ in the
//! coefficients of u is carried through it.

use super::active_set::ActiveSet;
use super::derivative::Derivative;
use super::jets::Jet;
use super::structural::StructuralDamper;
use super::{Motion, PointState, SlipElement as _};
use crate::fourier::Harmonics;
use std::borrow::Cow;

/// Rounds after which a march is taken as it is: its forces repeat after a few.
const MOST_ROUNDS: usize = 200;
/// Change of the forces over a round, relative to the largest, that counts as none.
const PERIODIC: f64 = 1e-13;
/// Rounding errors of a force, relative to the elastic forces that it is a difference of.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Change over a round of half a period, relative to the one before, that shows a slip which
/// nothing undoes: mirrored it alternates, and the symmetric motion is the mean of both.
pub(super) const SLOW: f64 = 0.9;
/// Distance from its limit at which a point is at it, relative to the limit, …
pub(super) const AT_LIMIT: f64 = 1e-12;
/// … at most, where small limits are beside the rounding of elastic forces.
const NEAR_LIMIT: f64 = 1e-3;
/// Share of the way to the end of a cell by which a point is left alone behind a touch that changes
/// nothing, at first and at most; each further touch in the cell doubles it.
const APART: [f64; 2] = [1e-3, 0.5];

/// A stretch of the period in one state.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    pub(super) start: f64,
    pub(super) end: f64,
    /// Its slip set, by position.
    pub(super) set: usize,
    pub(super) states: Vec<PointState>,
    /// κ.
    pub(super) offset: Vec<f64>,
    /// Derivative of κ, row by row; empty unless it was asked for.
    pub(super) rate: Vec<f64>,
}

/// The last round of a march from zero slip to forces that repeat.
#[derive(Debug)]
pub(super) struct PeriodicMarch {
    pub(super) sets: Vec<ActiveSet>,
    pub(super) stretches: Vec<Stretch>,
    /// Whether anything has slipped since the start of the march.
    pub(super) slipped: bool,
    /// Whether every transition was resolved.
    pub(super) resolved: bool,
    /// Bound of the elastic forces without any slip.
    pub(super) elastic: f64,
    /// Rounds until the forces have repeated.
    pub(super) rounds: usize,
}

/// A march along one motion.
pub(super) struct March<'a> {
    pub(super) law: &'a StructuralDamper,
    pub(super) harmonics: &'a Harmonics,
    series: &'a [f64],
    /// Displacements at the ends of the cells of a grid.
    grid: Vec<Jet>,
    /// Largest elastic force without any slip.
    elastic: f64,
    /// Distance from its limit at which each point is at it.
    pub(super) at_limit: Vec<f64>,
    pub(super) sets: Vec<ActiveSet>,
    pub(super) here: Stretch,
    done: Vec<Stretch>,
    derivative: Derivative,
    slipped: bool,
    transitions: usize,
}

impl PeriodicMarch {
    /// Follows a motion until the forces repeat.
    pub(super) fn new(law: &StructuralDamper, motion: Motion<'_>, derivative: Derivative) -> Self {
        let mut march = March::new(law, motion, derivative);
        let sign = if motion.table.harmonics().half_wave() { -1.0 } else { 1.0 };
        let (mut last_change, mut rounds) = (f64::INFINITY, 0);
        let elastic = march.elastic;
        let resolved = loop {
            rounds += 1;
            let start = march.jet(0.0);
            let before = march.force_at(&start);
            let gradient = (derivative != Derivative::None).then(|| march.gradient(0.0));
            let resolved = march.round();
            let after = march.force_at(&march.jet(motion.table.harmonics().span()));
            let largest = after.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
            let change =
                before.iter().zip(&after).map(|(b, a)| (sign * a - b).abs()).fold(0.0, f64::max);
            let periodic = change <= PERIODIC * largest + ROUNDING * elastic;
            if !resolved || periodic || rounds == MOST_ROUNDS {
                break resolved;
            }
            march.wrap(sign);
            if sign < 0.0 && change > SLOW * last_change {
                march.average(&start, &before, gradient);
            }
            last_change = change;
        };
        let March { sets, mut done, here, slipped, .. } = march;
        done.push(here);
        Self { sets, stretches: done, slipped, resolved, elastic, rounds }
    }

    /// Stretch that holds an angle of the span.
    pub(super) fn at(&self, theta: f64) -> Option<&Stretch> {
        let next = self.stretches.partition_point(|stretch| stretch.end <= theta);
        self.stretches.get(next).or(self.stretches.last())
    }
}

impl<'a> March<'a> {
    fn new(law: &'a StructuralDamper, motion: Motion<'a>, derivative: Derivative) -> Self {
        let harmonics = motion.table.harmonics();
        let points = law.limits.len();
        let series = motion.displacement;
        let here = Stretch {
            start: 0.0,
            end: 0.0,
            set: 0,
            states: vec![PointState::Stuck; points],
            offset: vec![0.0; points],
            rate: Vec::new(),
        };
        let (sets, done) = (Vec::new(), Vec::new());
        let mut march = Self {
            law,
            harmonics,
            series,
            grid: Jet::grid(motion),
            elastic: 0.0,
            at_limit: Vec::new(),
            sets,
            here,
            done,
            derivative,
            slipped: false,
            transitions: 0,
        };
        // A force is the difference of elastic forces, which may be many times as large.
        let distance = |(elastic, limit): (f64, &f64)| {
            (ROUNDING * elastic).max(AT_LIMIT * limit).min(NEAR_LIMIT * limit)
        };
        let elastic = march.elastic_forces();
        march.elastic = elastic.iter().copied().fold(0.0, f64::max);
        march.at_limit = elastic.into_iter().zip(&law.limits).map(distance).collect();
        march.begin();
        march
    }

    /// Forces without slip at the start of the period, as far as the limits admit them.
    fn begin(&mut self) {
        let points = self.law.limits.len();
        self.here.set = self.find_set();
        let jet = self.jet(0.0);
        let (mut force, mut gain) = (vec![0.0; points], vec![0.0; points * points]);
        self.law.increment(&vec![0.0; points], jet.value(), &mut force, Some(&mut gain));
        self.slipped = (0..points).any(|i| gain[i * points + i] == 0.0);
        let gradient = self.derivative.start(self.law, &self.basis(0.0), &force, &gain);
        self.settle(&jet, force, gradient, None);
    }

    /// Passes once through the span; `false` if transitions pile up without end.
    fn round(&mut self) -> bool {
        self.transitions = 0;
        let grid = std::mem::take(&mut self.grid);
        let passed = self.pass(&grid);
        self.grid = grid;
        self.here.end = self.harmonics.span();
        passed
    }

    fn pass(&mut self, grid: &[Jet]) -> bool {
        let most = 8 * self.law.limits.len() * (grid.len() + 8);
        let mut from = Cow::Owned(self.jet(self.here.start));
        for to in grid {
            let [mut apart, most_apart] = APART;
            // The point that has just touched without a change, and the angle up to which it is left alone.
            let mut touched: Option<(usize, Jet)> = None;
            loop {
                let left_alone = touched.take();
                let (until, alone) =
                    left_alone.as_ref().map_or((to, None), |(i, end)| (end, Some(*i)));
                let Some((theta, point)) = self.next_transition(&from, until, alone) else {
                    let Some((_, end)) = left_alone else { break };
                    from = Cow::Owned(end);
                    continue;
                };
                from = Cow::Owned(self.jet(theta));
                if !self.arrive(&from, point) {
                    // The others may change their states right behind a touch that changes nothing.
                    let end = self.jet(theta + apart * (to.theta - theta));
                    apart = (2.0 * apart).min(most_apart);
                    touched = Some((point, end));
                }
                self.transitions += 1;
                if self.transitions > most {
                    return false;
                }
            }
            from = Cow::Borrowed(to);
        }
        true
    }

    /// Lets a point arrive at the end of its state; whether any state changes.
    fn arrive(&mut self, jet: &Jet, point: usize) -> bool {
        let before = (self.here.set, self.here.states.clone());
        let force = self.force_at(jet);
        let gradient = (self.derivative != Derivative::None).then(|| self.gradient(jet.theta));
        self.settle(jet, force, gradient, Some(point));
        (self.here.set, &self.here.states) != (before.0, &before.1)
    }

    /// Begins the next round where this one has ended.
    fn wrap(&mut self, sign: f64) {
        self.done.clear();
        (self.here.start, self.here.end) = (0.0, 0.0);
        if sign < 0.0 {
            self.here.offset.iter_mut().chain(&mut self.here.rate).for_each(|x| *x = -*x);
            self.here.states.iter_mut().for_each(|state| *state = state.mirrored());
        }
    }

    /// Bounds of the elastic forces on the points without any slip.
    fn elastic_forces(&self) -> Vec<f64> {
        let mut far = vec![0.0_f64; self.law.limits.len()];
        for jet in &self.grid {
            far.iter_mut().zip(jet.value()).for_each(|(far, u)| *far = far.max(u.abs()));
        }
        let row = |i: usize| -> f64 {
            far.iter().enumerate().map(|(j, u)| self.law.stiffness[(i, j)].abs() * u).sum()
        };
        (0..far.len()).map(row).collect()
    }

    /// Begins the round from the mean of its forces and those of the round before.
    fn average(&mut self, start: &Jet, before: &[f64], gradient: Option<Vec<f64>>) {
        let force: Vec<f64> =
            self.force_at(start).iter().zip(before).map(|(a, b)| 0.5 * (a + b)).collect();
        let gradient = gradient.map(|before| {
            self.gradient(0.0).iter().zip(&before).map(|(a, b)| 0.5 * (a + b)).collect()
        });
        self.settle(start, force, gradient, None);
    }

    fn jet(&self, theta: f64) -> Jet {
        Jet::at(self.harmonics, self.series, theta)
    }

    fn basis(&self, theta: f64) -> Vec<f64> {
        let mut basis = vec![0.0; self.harmonics.slots()];
        self.harmonics.basis(theta, &mut basis);
        basis
    }

    pub(super) fn tangent_row(&self, i: usize, of: &[f64]) -> f64 {
        self.sets[self.here.set].force_on(i, of)
    }

    fn force_at(&self, jet: &Jet) -> Vec<f64> {
        let offsets = self.here.offset.iter().enumerate();
        offsets.map(|(i, offset)| self.tangent_row(i, jet.value()) - offset).collect()
    }

    /// Derivative of the forces at an angle.
    fn gradient(&self, theta: f64) -> Vec<f64> {
        let mut gradient = vec![0.0; self.here.rate.len()];
        self.add_tangent(&self.basis(theta), &mut gradient);
        gradient.iter_mut().zip(&self.here.rate).for_each(|(g, rate)| *g -= rate);
        gradient
    }

    /// Adds `T ⊗ basis`, the derivative of `T u`, which the limits do not change.
    fn add_tangent(&self, basis: &[f64], out: &mut [f64]) {
        if self.derivative == Derivative::Limits {
            return;
        }
        let tangent = &self.sets[self.here.set].reduced.tangent;
        let size = tangent.nrows() * basis.len();
        for (i, row) in out.chunks_exact_mut(size).enumerate() {
            for (j, block) in row.chunks_exact_mut(basis.len()).enumerate() {
                let stiffness = tangent[(i, j)];
                block.iter_mut().zip(basis).for_each(|(out, b)| *out += stiffness * b);
            }
        }
    }

    /// Points that are free to move on in the present states.
    fn slips(&self) -> Vec<bool> {
        let states = self.here.states.iter().zip(&self.law.limits);
        states.map(|(state, limit)| *state != PointState::Stuck || *limit == 0.0).collect()
    }

    /// Position of the slip set of the present states.
    fn find_set(&mut self) -> usize {
        let slips = self.slips();
        if let Some(known) = self.sets.iter().position(|set| set.slips == slips) {
            return known;
        }
        let reduced = self.law.elastic.reduced(&slips);
        self.sets.push(ActiveSet::new(slips, reduced, self.series));
        self.sets.len() - 1
    }

    /// Finds the states that follow from the rates at an angle and goes on from there with the
    /// given forces and their derivative. `arrived` is at its limit, whatever rounding says.
    fn settle(
        &mut self,
        jet: &Jet,
        mut force: Vec<f64>,
        mut gradient: Option<Vec<f64>>,
        arrived: Option<usize>,
    ) {
        let points = force.len();
        let columns = gradient.as_ref().map_or(0, Vec::len) / points;
        let before = (self.here.set, self.here.states.clone());
        for (i, (force, limit)) in force.iter_mut().zip(&self.law.limits).enumerate() {
            let at_limit = arrived == Some(i) || force.abs() >= limit - self.at_limit[i];
            if *limit > 0.0 && at_limit {
                *force = limit.copysign(*force);
            } else {
                self.here.states[i] = PointState::Stuck;
            }
        }
        self.here.set = self.find_set();
        // Time that the onset of slip comes earlier, per column.
        let mut advance: Option<Vec<f64>> = None;
        for _ in 0..16 * (points + 1) {
            let Some(i) = (0..points).find(|&i| self.contradicts(jet, &force, i)) else { break };
            let old: Vec<f64> = (0..points).map(|r| self.tangent_row(r, jet.slope())).collect();
            let onset = self.here.states[i] == PointState::Stuck;
            let column: Vec<f64> = {
                let tangent = &self.sets[self.here.set].reduced.tangent;
                (0..points).map(|r| tangent[(r, i)]).collect()
            };
            self.here.states[i] =
                if onset { PointState::slipping(force[i]) } else { PointState::Stuck };
            self.here.set = self.find_set();
            self.slipped |= onset;
            let Some(gradient) = &mut gradient else { continue };
            if onset {
                let mut own = gradient[i * columns..(i + 1) * columns].to_vec();
                if self.derivative == Derivative::Limits {
                    own[i] -= force[i].signum();
                }
                for (r, row) in gradient.chunks_exact_mut(columns).enumerate() {
                    let share = if r == i {
                        1.0
                    } else if column[i] > 0.0 {
                        column[r] / column[i]
                    } else {
                        0.0
                    };
                    row.iter_mut().zip(&own).for_each(|(g, own)| *g -= share * own);
                }
                advance = (old[i] != 0.0).then(|| own.iter().map(|g| g / old[i]).collect());
            } else if let Some(advance) = &advance {
                // A point sticks because another has begun to slip: the rates jump once more.
                for (r, row) in gradient.chunks_exact_mut(columns).enumerate() {
                    let jump = self.tangent_row(r, jet.slope()) - old[r];
                    row.iter_mut().zip(advance).for_each(|(g, time)| *g += jump * time);
                }
            }
        }
        let (old_set, old_states) = before;
        if jet.theta > self.here.start
            && (self.here.set, &self.here.states) != (old_set, &old_states)
        {
            let next = (self.here.set, std::mem::replace(&mut self.here.states, old_states));
            self.here.set = old_set;
            self.here.end = jet.theta;
            self.done.push(self.here.clone());
            (self.here.set, self.here.states) = next;
            self.here.start = jet.theta;
        }
        self.here.offset =
            (0..points).map(|i| self.tangent_row(i, jet.value()) - force[i]).collect();
        if let Some(gradient) = gradient {
            let mut rate = vec![0.0; gradient.len()];
            self.add_tangent(&self.basis(jet.theta), &mut rate);
            rate.iter_mut().zip(&gradient).for_each(|(rate, g)| *rate -= g);
            self.here.rate = rate;
        }
    }
}
