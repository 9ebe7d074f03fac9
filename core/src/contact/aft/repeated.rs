//! The derivative of a march whose state repeats whatever it begins with.
//!
//! Through a round the derivative of the state is affine in the one that it begins with, `R₁ = A R₀ + B`, and
//! as the state repeats, so does it: `R₀ = (1 − A)⁻¹ B`. One round tells A and B, and the harmonics of the
//! derivative of the force, which are affine in R₀, too.

use super::lap_derivative::LapDerivative;
use super::rate::{is_elastic, Rate};
use super::round::CONTRACTS;
use super::samples::Samples;
use crate::contact::{Aft, ContactLaw};
use faer::linalg::matmul::matmul;
use faer::linalg::solvers::DenseSolveCore as _;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use std::ops::Deref;

/// Outer products that are summed at once: a tangent is passed through once for all of them.
const TOGETHER: usize = 32;

impl<L: Deref<Target: ContactLaw>> Aft<L> {
    /// Adds the derivative of a march to a tangent from a state at the first instant that repeats; `false`
    /// if what a march begins with is not soon forgotten.
    pub(super) fn differentiate_repeated(
        &self,
        samples: &Samples,
        state: &[f64],
        slots: usize,
        out: &mut [f64],
    ) -> bool {
        let state_stiffness = self.law.state_stiffness();
        let mut step = self.step_from(samples, state);
        let basis = |n: usize| &samples.basis[(n % samples.count) * slots..][..slots];
        let mut rate = Rate::new(self.law.stiffness(), state_stiffness.clone(), slots);
        let mut lap = LapDerivative::new(state.len());
        let mut products = Products::new(self.law.displacements(), state.len(), slots);
        let weight = 2.0 / samples.count as f64;
        let (mut sum, mut force_by_state) = (vec![0.0; slots], Vec::new());
        for n in 1..=samples.count {
            // Between two slips the slip load keeps its derivative: instants are summed.
            sum.iter_mut().zip(basis(n - 1)).for_each(|(sum, b)| *sum += weight * b);
            if !step.springs {
                rate.add_direct(&step.jacobian, weight, basis(n - 1), out);
            }
            force_by_state.clone_from(&step.jacobian.force_by_state);
            self.advance(samples, n, &mut step, true);
            let wraps = n == samples.count;
            let elastic = step.springs || is_elastic(&step.jacobian, &state_stiffness);
            let changes = !elastic || force_by_state != step.jacobian.force_by_state;
            if !wraps && !changes {
                continue;
            }
            products.add(&force_by_state, [rate.rows(), &lap.by], &sum, out);
            sum.fill(0.0);
            if changes {
                let sign = if wraps { samples.sign } else { 1.0 };
                let after: Vec<f64> = basis(n).iter().map(|b| sign * b).collect();
                rate.follow(&step.jacobian, Some(basis(n - 1)), &after);
                lap.advance(&step.jacobian.by_state);
            }
        }
        products.sum_up(out);
        if lap.by.iter().any(|by| by.abs() > CONTRACTS) {
            return false;
        }
        products.begin_with(&lap.by, rate.rows(), samples.sign, out);
        true
    }
}

/// Outer products of instants with the derivatives of forces there.
struct Products {
    slots: usize,
    states: usize,
    /// Summed basis of the products at hand, one after the other.
    sums: Vec<f64>,
    /// Derivatives of each force there.
    rows: Vec<Vec<f64>>,
    /// Sums of the basis times the derivative of each force in each number of the state that a round
    /// begins with.
    begin: Vec<f64>,
}

impl Products {
    fn new(displacements: usize, states: usize, slots: usize) -> Self {
        let begin = vec![0.0; displacements * states * slots];
        Self { slots, states, sums: Vec::new(), rows: vec![Vec::new(); displacements], begin }
    }

    /// Adds one, of the derivatives of the state in the coefficients of the motion and in the state that the
    /// round begins with.
    fn add(&mut self, force_by_state: &[f64], by: [&[f64]; 2], sum: &[f64], out: &mut [f64]) {
        let Self { slots, states, .. } = *self;
        let size = self.rows.len() * slots;
        self.sums.extend_from_slice(sum);
        for (i, (rows, by_state)) in
            self.rows.iter_mut().zip(force_by_state.chunks_exact(states)).enumerate()
        {
            let first = rows.len();
            rows.resize(first + size, 0.0);
            for (j, share) in by_state.iter().enumerate().filter(|(_, share)| **share != 0.0) {
                let own = rows[first..].iter_mut().zip(&by[0][j * size..(j + 1) * size]);
                own.for_each(|(row, rate)| *row += share * rate);
                for (k, through) in by[1][j * states..(j + 1) * states].iter().enumerate() {
                    let begin = &mut self.begin[(i * states + k) * slots..][..slots];
                    begin.iter_mut().zip(sum).for_each(|(begin, s)| *begin += share * through * s);
                }
            }
        }
        if self.sums.len() == TOGETHER * slots {
            self.sum_up(out);
        }
    }

    /// Adds the products at hand to a tangent.
    fn sum_up(&mut self, out: &mut [f64]) {
        let Self { slots, .. } = *self;
        let size = self.rows.len() * slots;
        let held = self.sums.len() / slots;
        for (own, rows) in out.chunks_exact_mut(slots * size).zip(&mut self.rows) {
            if rows.iter().any(|entry| *entry != 0.0) {
                let own = MatMut::from_column_major_slice_mut(own, size, slots);
                let rows = MatRef::from_column_major_slice(rows, size, held);
                let sums = MatRef::from_column_major_slice(&self.sums, slots, held);
                matmul(own, Accum::Add, rows, sums.transpose(), 1.0, Par::Seq);
            }
            rows.clear();
        }
        self.sums.clear();
    }

    /// Adds what follows from the derivative of the state that the round begins with.
    fn begin_with(&self, through: &[f64], ended: &[f64], sign: f64, out: &mut [f64]) {
        let Self { slots, states, .. } = *self;
        let size = self.rows.len() * slots;
        let own = |i: usize, j: usize| f64::from(u8::from(i == j)) - sign * through[i * states + j];
        let inverse = Mat::from_fn(states, states, own).partial_piv_lu().inverse();
        let mut begun = vec![0.0; size];
        for k in 0..states {
            begun.fill(0.0);
            for (j, ended) in ended.chunks_exact(size).enumerate() {
                let share = sign * inverse[(k, j)];
                begun.iter_mut().zip(ended).for_each(|(begun, ended)| *begun += share * ended);
            }
            for (i, rows) in out.chunks_exact_mut(slots * size).enumerate() {
                let sums = &self.begin[(i * states + k) * slots..][..slots];
                for (row, sum) in rows.chunks_exact_mut(size).zip(sums).filter(|(_, s)| **s != 0.0)
                {
                    row.iter_mut().zip(&begun).for_each(|(entry, by)| *entry += sum * by);
                }
            }
        }
    }
}
