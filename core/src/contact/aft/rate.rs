//! What a march through a contact law carries from instant to instant: its derivative, and the
//! friction work.

use super::restart::Restart;
use crate::contact::return_map::ReturnMapJacobian;
use crate::contact::Elastic;
use faer::Mat;

/// Share of the stiffness below which a derivative is the rounding of two that cancel.
const CANCELLED: f64 = 1e-14;

/// Derivative in all coefficients of `K_z u − z` at one instant: what slip has taken off the state
/// z. It stays as it is while the state follows its stiffness K_z.
#[derive(Clone)]
pub(super) struct Rate {
    slots: usize,
    stiffness: Mat<f64>,
    state_stiffness: Mat<f64>,
    value: Vec<f64>,
    /// Room for the next one.
    next: Vec<f64>,
}

impl Rate {
    /// No derivative yet, in `slots` coefficients per displacement.
    pub(super) fn new(stiffness: Mat<f64>, state_stiffness: Mat<f64>, slots: usize) -> Self {
        let value = vec![0.0; state_stiffness.nrows() * stiffness.nrows() * slots];
        Self { slots, stiffness, state_stiffness, next: value.clone(), value }
    }

    /// Its rows, number of state by number of state.
    pub(super) fn rows(&self) -> &[f64] {
        &self.value
    }

    /// Whether it stays as it is through a step.
    pub(super) fn stays(&self, jacobian: &ReturnMapJacobian) -> bool {
        is_elastic(jacobian, &self.state_stiffness)
    }

    /// Multiplies the derivative by a sign.
    pub(super) fn scale(&mut self, sign: f64) {
        self.value.iter_mut().for_each(|rate| *rate *= sign);
    }

    /// What a round begins with, from what the round before has begun with.
    pub(super) fn restart(&mut self, before: &Self, restart: &Restart) {
        restart.apply(&mut self.value, &before.value);
    }

    /// Takes the derivative through one return map, from an instant with one basis, or from rest, to
    /// an instant with another.
    pub(super) fn follow(
        &mut self,
        jacobian: &ReturnMapJacobian,
        before: Option<&[f64]>,
        after: &[f64],
    ) {
        let (states, count) = (self.state_stiffness.nrows(), self.stiffness.nrows());
        let size = count * self.slots;
        self.next.fill(0.0);
        for (i, row) in self.next.chunks_exact_mut(size).enumerate() {
            let through = &jacobian.by_state[i * states..(i + 1) * states];
            for (j, through) in through.iter().enumerate().filter(|(_, through)| **through != 0.0) {
                let old = &self.value[j * size..(j + 1) * size];
                row.iter_mut().zip(old).for_each(|(row, old)| *row += through * old);
            }
            for (l, block) in row.chunks_exact_mut(self.slots).enumerate() {
                let own = self.state_stiffness[(i, l)];
                let taken = own - jacobian.by_after[i * count + l];
                block.iter_mut().zip(after).for_each(|(block, b)| *block += taken * b);
                let Some(before) = before else { continue };
                let kept: f64 =
                    (0..states).map(|j| through[j] * self.state_stiffness[(j, l)]).sum();
                let by_before = kept + jacobian.by_before[i * count + l];
                if by_before.abs() > CANCELLED * own.abs() {
                    block.iter_mut().zip(before).for_each(|(block, b)| *block -= by_before * b);
                }
            }
        }
        std::mem::swap(&mut self.value, &mut self.next);
    }

    /// Adds what the displacements from which the first step leads vary by: rows in all coefficients,
    /// or nothing.
    pub(super) fn begin(&mut self, jacobian: &ReturnMapJacobian, before: &[f64]) {
        let count = self.stiffness.nrows();
        let size = count * self.slots;
        for (i, row) in self.value.chunks_exact_mut(size).enumerate() {
            for (l, before) in before.chunks_exact(size).enumerate() {
                let by_before = jacobian.by_before[i * count + l];
                row.iter_mut().zip(before).for_each(|(row, b)| *row -= by_before * b);
            }
        }
    }

    /// Adds the outer product with the summed basis to a tangent, and clears the sum.
    pub(super) fn add_to(&self, force_by_state: &[f64], sum: &mut [f64], out: &mut [f64]) {
        let (states, size) = (self.state_stiffness.nrows(), self.stiffness.nrows() * self.slots);
        if states == 0 {
            return sum.fill(0.0);
        }
        let mut force = vec![0.0; size];
        for (rows, by_state) in
            out.chunks_exact_mut(self.slots * size).zip(force_by_state.chunks_exact(states))
        {
            force.fill(0.0);
            for (rate, by) in
                self.value.chunks_exact(size).zip(by_state).filter(|(_, by)| **by != 0.0)
            {
                force.iter_mut().zip(rate).for_each(|(force, rate)| *force += by * rate);
            }
            for (row, s) in rows.chunks_exact_mut(size).zip(&*sum) {
                row.iter_mut().zip(&force).for_each(|(row, force)| *row += s * force);
            }
        }
        sum.fill(0.0);
    }

    /// Adds what an instant loses of the stuck contact's force without any slip of its state: the
    /// force follows the displacements by another stiffness than D.
    pub(super) fn add_direct(
        &self,
        jacobian: &ReturnMapJacobian,
        weight: f64,
        basis: &[f64],
        out: &mut [f64],
    ) {
        let (states, count) = (self.state_stiffness.nrows(), self.stiffness.nrows());
        let size = count * self.slots;
        for i in 0..count {
            for l in 0..count {
                let lost = lost(jacobian, i, l, &self.stiffness, &self.state_stiffness, states);
                if lost == 0.0 {
                    continue;
                }
                for (k, b) in basis.iter().enumerate() {
                    let first = (i * self.slots + k) * size + l * self.slots;
                    let row = &mut out[first..first + self.slots];
                    row.iter_mut().zip(basis).for_each(|(row, c)| *row += weight * lost * b * c);
                }
            }
        }
    }
}

/// Whether the force after a step follows the displacements by the stuck stiffness D.
pub(super) fn follows(
    jacobian: &ReturnMapJacobian,
    stiffness: &Mat<f64>,
    state_stiffness: &Mat<f64>,
) -> bool {
    let (states, count) = (state_stiffness.nrows(), stiffness.nrows());
    (0..count).all(|i| {
        (0..count).all(|l| lost(jacobian, i, l, stiffness, state_stiffness, states) == 0.0)
    })
}

/// What force i loses per displacement l against the stuck stiffness, though its state loses nothing.
fn lost(
    jacobian: &ReturnMapJacobian,
    i: usize,
    l: usize,
    stiffness: &Mat<f64>,
    state_stiffness: &Mat<f64>,
    states: usize,
) -> f64 {
    let by_state = &jacobian.force_by_state[i * states..(i + 1) * states];
    let through: f64 = (0..states).map(|j| by_state[j] * state_stiffness[(j, l)]).sum();
    let own = stiffness[(i, l)];
    let lost = own - through - jacobian.force_by_after[i * stiffness.nrows() + l];
    let cancelled = lost.abs() <= CANCELLED * own.abs();
    if cancelled {
        0.0
    } else {
        lost
    }
}

/// Whether a step takes the state along its stiffness, without any loss.
pub(super) fn is_elastic(jacobian: &ReturnMapJacobian, stiffness: &Mat<f64>) -> bool {
    let (states, count) = (stiffness.nrows(), stiffness.ncols());
    let own = |i: usize, j: usize| f64::from(u8::from(i == j));
    jacobian.sticks()
        && (0..states).all(|i| {
            (0..states).all(|j| jacobian.by_state[i * states + j] == own(i, j))
                && (0..count).all(|l| {
                    jacobian.by_after[i * count + l] == stiffness[(i, l)]
                        && jacobian.by_before[i * count + l] == -stiffness[(i, l)]
                })
        })
}

/// The friction work of a march. Over a period that of a single displacement is the work of its
/// force; coupled ones exchange elastic energy, so that their slip has to be known.
pub(super) struct FrictionWork {
    stiffness: Mat<f64>,
    elastic: Option<Elastic>,
}

impl FrictionWork {
    pub(super) fn new(stiffness: Mat<f64>, elastic: bool) -> Self {
        let couples = stiffness.nrows() > 1 && elastic;
        let elastic = couples.then(|| Elastic::new(stiffness.as_ref()).ok()).flatten();
        Self { stiffness, elastic }
    }

    /// Adds the work of a step.
    pub(super) fn add(
        &self,
        before: &[f64],
        force: &[f64],
        du: &[f64],
        slipping: &[f64],
        work: &mut [f64],
    ) {
        let count = force.len();
        let Some(elastic) = &self.elastic else {
            for i in 0..count {
                work[i] += 0.5 * (before[i] + force[i]) * du[i];
            }
            return;
        };
        let slips: Vec<bool> = slipping.iter().map(|share| *share > 0.0).collect();
        if !slips.contains(&true) {
            return;
        }
        let lost: Vec<f64> = (0..count)
            .map(|i| {
                let elastic: f64 = (0..count).map(|j| self.stiffness[(i, j)] * du[j]).sum();
                before[i] + elastic - force[i]
            })
            .collect();
        for (i, s) in elastic.slip(&slips, &lost).into_iter().enumerate() {
            work[i] += 0.5 * (before[i] + force[i]) * s;
        }
    }
}
