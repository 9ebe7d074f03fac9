//! Exact limit cycles by shooting: the state that half a period of unknown length turns into its
//! mirror image, or without half-wave symmetry a period into itself, with a scalar of the model as a
//! further unknown.
//!
//! The derivative in the state is the analytic transition matrix of the flow, that in the period
//! the velocity at its end, and that in the scalar a central difference of the flow: it only
//! steers Newton's method. The phase is held across the velocity of the last accepted point, which
//! never fails, and reported orbits begin at a maximum of the DOF that moves most.

use super::orbits::CycleOrbits;
use crate::balance::Point;
use crate::motion::{ContactState, State, Transition};
use crate::orbit::loop_memory::LoopMemory;
use crate::orbit::segments::{
    follow, halved, product_eigenvalues, segmentation, Member, Segment, Segmentation,
};
use crate::orbit::shooting::Shooting;
use crate::solve::{factorised_with, norm, Curve};
use faer::{c64, Mat};
use std::cell::RefCell;
use std::rc::Rc;

/// Relative step of the central difference in the scalar: motions that grow by orders of magnitude
/// over a period bend within 1e-5, and rounding stays far below what Newton's method notices.
const DIFFERENCE: f64 = 1e-7;

/// Points that slip in one of the segments.
fn slipped(segments: &[Segment]) -> Vec<bool> {
    let mut all = vec![false; segments.first().map_or(0, |one| one.slipped.len())];
    for one in segments {
        all.iter_mut().zip(&one.slipped).for_each(|(all, own)| *all |= own);
    }
    all
}

/// What is known of the flow over the span of the closing condition.
struct Evaluation {
    z: Vec<f64>,
    segments: Vec<Segment>,
    /// What contacts without sliders remember behind all segments.
    memory: LoopMemory,
    derivatives: bool,
    /// What contacts that never slip keep over a whole period: it stays as it is, in the place of
    /// equations of the last segment that hold by themselves.
    kept: Vec<(usize, Vec<f64>)>,
}

/// The closing condition in the unknowns `(states, ω, scalar)`: the states at the starts of equal
/// segments of half a period, as many as there are.
pub struct OrbitCurve<'a> {
    orbits: &'a CycleOrbits<'a>,
    /// Frequency that scales the coordinates of the state [rad/s].
    scale: f64,
    interrupted: &'a dyn Fn() -> bool,
    reference: Vec<f64>,
    /// Velocity at the reference over its size.
    drift: Vec<f64>,
    size: f64,
    at: Option<Evaluation>,
    /// The member at the last value of the scalar.
    member: RefCell<Option<(f64, Rc<Member<'a>>)>>,
    /// Half periods followed so far.
    pub flows: usize,
    /// Transition matrices so far.
    pub matrices: usize,
}

impl<'a> OrbitCurve<'a> {
    /// Equations of a family, starting at `start`; `scale` is a frequency of the motion.
    #[must_use]
    pub fn new(
        orbits: &'a CycleOrbits<'a>,
        scale: f64,
        start: &[f64],
        interrupted: &'a dyn Fn() -> bool,
    ) -> Self {
        let mut curve = Self {
            orbits,
            scale,
            interrupted,
            reference: Vec::new(),
            drift: Vec::new(),
            size: 1.0,
            at: None,
            member: RefCell::new(None),
            flows: 0,
            matrices: 0,
        };
        curve.accept(start);
        curve
    }

    /// Whether the closing condition is that of half a period, mirrored.
    pub(super) fn is_symmetric(&self) -> bool {
        self.orbits.family.is_symmetric()
    }

    /// Unknowns of one state, and how many of them say what contacts without sliders remember.
    pub(super) fn state_size(&self) -> [usize; 2] {
        [self.orbits.size(), LoopMemory::places(&self.orbits.system)]
    }

    fn member(&self, value: f64) -> Option<Rc<Member<'a>>> {
        let mut last = self.member.borrow_mut();
        if let Some((_, member)) = last.as_ref().filter(|(own, _)| *own == value) {
            return Some(Rc::clone(member));
        }
        let member = Rc::new(self.orbits.member(value).ok()?);
        *last = Some((value, Rc::clone(&member)));
        Some(member)
    }

    /// Unknowns from a harmonic balance.
    pub(super) fn unknowns_of(
        &self,
        point: &Point,
        value: f64,
        segments: usize,
    ) -> Option<Vec<f64>> {
        self.orbits.unknowns(point, value, self.scale, segments).ok()
    }

    /// Has `visit` look at the closing condition of a point.
    pub(super) fn with_shooting<T>(
        &self,
        z: &[f64],
        visit: impl FnOnce(&Member<'_>, &mut Shooting<'_>, &[f64]) -> Option<T>,
    ) -> Option<T> {
        let [y @ .., omega, value] = z else { return None };
        if !(*omega > 0.0 && omega.is_finite() && value.is_finite() && norm(y).is_finite()) {
            return None;
        }
        let member = self.member(*value)?;
        let coordinates = Transition::new(&member.system, self.scale);
        let half = self.is_symmetric();
        let mut shooting =
            Shooting::within(&member.system, *omega, half, Some(self.interrupted), coordinates);
        shooting.assume(self.orbits.family.residual());
        visit(&member, &mut shooting, y)
    }

    fn evaluate(&mut self, z: &[f64], derivatives: bool) -> bool {
        if self.at.as_ref().is_none_or(|at| at.z != z) {
            self.flows += 1;
            self.at = self.with_shooting(z, |member, shooting, y| {
                let segments = follow(member, shooting, y)?;
                let kept = if self.is_symmetric() {
                    Vec::new()
                } else {
                    shooting.coordinates.conserved(&slipped(&segments))
                };
                let (z, memory) = (z.to_vec(), shooting.memory.clone());
                Some(Evaluation { z, segments, memory, derivatives: false, kept })
            });
        }
        let Some(mut at) = self.at.take() else { return false };
        if derivatives && !at.derivatives {
            self.matrices += 1;
            let derived = self.with_shooting(z, |_, shooting, _| {
                shooting.memory.clone_from(&at.memory);
                shooting.derive(&mut at.segments);
                Some(())
            });
            at.derivatives = derived.is_some();
        }
        let known = at.derivatives || !derivatives;
        self.at = Some(at);
        known
    }

    /// Rate of the coordinates at a point.
    fn velocity(&self, z: &[f64]) -> Option<Vec<f64>> {
        self.with_shooting(z, |member, shooting, y| {
            let state = shooting.state(y.get(..self.orbits.size())?);
            let regime = ContactState::new(&member.system, &state.points);
            let mut rate = shooting.coordinates.rate(&state, &regime);
            rate.resize(self.orbits.size(), 0.0);
            Some(rate)
        })
    }

    /// Multipliers over half a period, mirrored, or over a whole one of no symmetry, without the one of the phase and the neutral ones,
    /// by falling modulus; and the number of the neutral ones.
    pub fn multipliers(&mut self, z: &[f64]) -> Option<(Vec<c64>, usize)> {
        if !self.evaluate(z, true) {
            return None;
        }
        let segments = &self.at.as_ref()?.segments;
        let (mut multipliers, neutral) = self.with_shooting(z, |_, shooting, _| {
            let slipped = slipped(segments);
            let mut neutral = 0;
            let reduced = segments.iter().map(|one| {
                let mut matrix = one.derivative.clone();
                shooting.hold_origins(&mut matrix);
                let (rest, count) = shooting.without_neutral(&matrix, &slipped);
                neutral = count;
                rest
            });
            let reduced: Vec<Mat<f64>> = reduced.collect();
            Some((product_eigenvalues(reduced)?, neutral))
        })?;
        let one = c64::new(1.0, 0.0);
        let phase = (0..multipliers.len()).min_by(|&i, &j| {
            (multipliers[i] - one).norm().total_cmp(&(multipliers[j] - one).norm())
        })?;
        multipliers.remove(phase);
        multipliers.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
        // Those of forces that no deformation gives, as of a forced orbit.
        let states = 2 * self.orbits.system.modes() + self.orbits.system.memories();
        multipliers.resize(states.saturating_sub(1 + neutral), c64::new(0.0, 0.0));
        Some((multipliers, neutral))
    }

    /// States at the starts of the segments, each at its time.
    pub(super) fn states(&self, z: &[f64]) -> Option<Vec<State>> {
        let [.., omega, _] = z else { return None };
        self.with_shooting(z, |_, shooting, y| {
            let starts = y.chunks_exact(self.orbits.size());
            let share = self.orbits.span() / omega / starts.len() as f64;
            let states = starts.enumerate().map(|(number, y)| {
                let state = shooting.state(y);
                State { time: number as f64 * share, ..state }
            });
            Some(states.collect())
        })
    }

    /// The Jacobian at a point, with nothing in its last row and in the column of the parameter.
    fn jacobian_at_parameter(&mut self, z: &[f64]) -> Option<Mat<f64>> {
        if !self.evaluate(z, true) {
            return None;
        }
        let mut out = Mat::zeros(z.len(), z.len());
        let (all, size) = (z.len() - 2, self.orbits.size());
        let at = self.at.as_ref()?;
        let count = at.segments.len();
        for (number, one) in at.segments.iter().enumerate() {
            let (first, next) = (number * size, (number + 1) % count * size);
            // A segment lasts π/(m ω), or 2π/(m ω); the end of the last one of half a period is mirrored.
            let mirrored = if self.is_symmetric() && number + 1 == count { 1.0 } else { -1.0 };
            let span = self.orbits.span();
            let shorter = mirrored * span / (count as f64 * z[all] * z[all]) / self.size;
            for i in 0..size {
                for j in 0..size {
                    out[(first + i, first + j)] = one.derivative[(i, j)] / self.size;
                }
                out[(first + i, all)] = one.rate[i] * shorter;
                out[(first + i, next + i)] -= self.size.recip();
            }
        }
        for (j, d) in self.drift.iter().enumerate() {
            out[(all, j)] = d / self.size;
        }
        for (target, form) in &at.kept {
            let row = all - size + target;
            (0..z.len()).for_each(|j| out[(row, j)] = 0.0);
            form.iter().enumerate().for_each(|(j, f)| out[(row, j)] = f / self.size);
        }
        Some(out)
    }

    /// Gives the Jacobian at a point the column of the parameter, by differences.
    fn add_rate(&mut self, z: &[f64], out: &mut Mat<f64>) -> Option<()> {
        let at = z.len() - 1;
        let step = DIFFERENCE * z[at].abs().max(f64::MIN_POSITIVE);
        let images = [step, -step].map(|step| {
            let mut shifted = z.to_vec();
            shifted[at] += step;
            let segments = self.with_shooting(&shifted, follow)?;
            Some(segments.into_iter().flat_map(|one| one.image).collect::<Vec<f64>>())
        });
        self.flows += 2;
        let [Some(ahead), Some(behind)] = images else { return None };
        for (row, (ahead, behind)) in ahead.iter().zip(behind).enumerate() {
            out[(row, at)] = (ahead - behind) / (2.0 * step) / self.size;
        }
        for (target, _) in self.at.iter().flat_map(|at| &at.kept) {
            out[(at - 1 - self.orbits.size() + target, at)] = 0.0;
        }
        Some(())
    }
}

impl Curve for OrbitCurve<'_> {
    fn unknowns(&self) -> usize {
        self.reference.len()
    }

    fn scalars(&self, z: &[f64]) -> usize {
        z.len() - 2
    }

    fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        if !self.evaluate(z, false) {
            out.fill(f64::NAN);
            return;
        }
        let all = z.len() - 2;
        let Some(at) = &self.at else { return };
        // What comes after each segment; after the last one, the first.
        let next = z[..all].iter().cycle().skip(self.orbits.size());
        let images = at.segments.iter().flat_map(|one| &one.image);
        for ((out, image), next) in out.iter_mut().zip(images).zip(next) {
            *out = (image - next) / self.size;
        }
        for (target, form) in &at.kept {
            let moved =
                form.iter().zip(z).zip(&self.reference).map(|((f, z), known)| f * (z - known));
            out[all - self.orbits.size() + target] = moved.sum::<f64>() / self.size;
        }
        let way = z.iter().zip(&self.reference).zip(&self.drift);
        out[all] = way.map(|((z, known), d)| d * (z - known)).sum::<f64>() / self.size;
    }

    fn solve_bordered(
        &mut self,
        z: &[f64],
        border: &[f64],
        right: &[f64],
        weights: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        let at = z.len() - 1;
        let held = border.iter().enumerate().all(|(j, entry)| j == at || *entry == 0.0);
        let mut matrix = self.jacobian_at_parameter(z)?;
        if !held || right[at] != 0.0 {
            self.add_rate(z, &mut matrix)?;
        }
        factorised_with(matrix, border, right, weights)
    }

    fn weights(&self, z: &[f64]) -> Vec<f64> {
        let size = z.len() - 2;
        let mut weights = vec![norm(&z[..size]).max(f64::MIN_POSITIVE).recip(); size];
        weights.extend(z[size..].iter().map(|v| v.abs().max(f64::MIN_POSITIVE).recip()));
        weights
    }

    fn accept(&mut self, z: &[f64]) {
        self.reference = z.to_vec();
        let size = z.len().saturating_sub(2);
        self.size = norm(&z[..size]).max(f64::MIN_POSITIVE);
        let drift = self.velocity(z).unwrap_or_else(|| vec![0.0; size]);
        let speed = norm(&drift).max(f64::MIN_POSITIVE);
        self.drift = drift.iter().map(|d| d / speed).collect();
    }

    fn suitable_unknowns(&mut self, z: &[f64]) -> usize {
        let states = z.len().saturating_sub(2);
        let known = self.evaluate(z, true).then_some(self.at.as_ref()).flatten();
        match known.map(|at| segmentation(&at.segments)) {
            Some(Segmentation::Double) => 2 * states + 2,
            Some(Segmentation::Halve) => states / 2 + 2,
            Some(Segmentation::Keep) | None => states + 2,
        }
    }

    fn resample(&mut self, z: &[f64], unknowns: usize) -> Option<Vec<f64>> {
        let (y, last) = z.split_at(z.len().checked_sub(2)?);
        let mut y = y.to_vec();
        while y.len() + 2 < unknowns {
            let starts: Vec<f64> = y.iter().chain(last).copied().collect();
            y = self.with_shooting(&starts, |_, shooting, y| halved(shooting, y))?;
        }
        while y.len() + 2 > unknowns {
            let size = self.orbits.size();
            y = y.chunks_exact(size).step_by(2).flatten().copied().collect();
        }
        y.extend(last);
        Some(y)
    }

    fn better_begin(&mut self, z: &[f64]) -> Option<f64> {
        self.best_begin(z)
    }

    fn begin_later(&mut self, z: &[f64], by: f64) -> Option<Vec<f64>> {
        self.begun(z, by)
    }

    fn matched(&mut self, a: &[f64], b: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let unknowns = a.len().max(b.len());
        let b = self.resample(b, unknowns)?;
        let a = self.resample(a, unknowns)?;
        Some((self.in_step(&a, &b)?, b))
    }

    fn interrupted(&self) -> bool {
        (self.interrupted)()
    }
}
