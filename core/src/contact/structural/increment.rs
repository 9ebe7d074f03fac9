//! One increment of a massless elastic body with slipping contacts: the implicit box-constrained
//! complementarity problem `f = t − D Δs`, `|f_i| ≤ F_i`, `Δs_i` zero or along `f_i = ±F_i`.
//!
//! t are the trial forces without slip. In the energy norm f is the point of the box nearest to t
//! among the forces that the body can carry, so that the forces are unique; the slip need not be.
//! Solved by block principal pivoting: all points that contradict their state change it at once
//! while that makes them fewer, else the last one alone (Judice and Pires 1992).

use crate::contact::PointState;
use faer::Mat;

/// Violations below this share of the forces are rounding.
const ROUNDING: f64 = 1e-13;
/// Pivots below this share of their diagonal are those of a singular stiffness.
const SINGULAR: f64 = 1e-11;
/// Block changes without progress before single changes take over.
const CHANCES: usize = 8;
/// Changes after which the states are taken as they are; the method is finite and ends long before.
const MOST: usize = 1000;

/// The slip set of an increment, factored.
pub(super) struct Increment<'a> {
    stiffness: &'a Mat<f64>,
    limits: &'a [f64],
    states: Vec<PointState>,
    /// Points that slip, and those whose pivot is independent of the ones before.
    slipping: Vec<usize>,
    independent: Vec<bool>,
    /// Cholesky factor of D_SS, row by row; pivots of dependent points are raised.
    factor: Vec<f64>,
}

impl<'a> Increment<'a> {
    /// The problem of a body; limits of 0 are free of friction, infinite ones never slip.
    pub(super) fn new(stiffness: &'a Mat<f64>, limits: &'a [f64]) -> Self {
        let states = vec![PointState::Stuck; limits.len()];
        let (slipping, independent, factor) = (Vec::new(), Vec::new(), Vec::new());
        Self { stiffness, limits, states, slipping, independent, factor }
    }

    /// Takes the trial forces back into the box, from the points at their limit in `before` as
    /// the first guess of those that slip. Whether anything slips.
    pub(super) fn solve(&mut self, before: &[f64], trial: &mut [f64]) -> bool {
        let points = trial.len();
        let slips = |i: usize| trial[i].abs() > self.limits[i] || self.limits[i] == 0.0;
        if !(0..points).any(slips) || trial.iter().any(|t| t.is_nan()) {
            return false;
        }
        for i in 0..points {
            let beyond = trial[i].abs() > self.limits[i];
            let from = if beyond { trial[i] } else { before[i] };
            if beyond || before[i].abs() >= self.limits[i] {
                self.states[i] = PointState::slipping(from);
            }
        }
        let scale = trial.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
        let (mut force, mut slip) = (trial.to_vec(), Vec::new());
        let (mut fewest, mut chances) = (usize::MAX, CHANCES);
        for _ in 0..MOST {
            self.factorise();
            self.forces(trial, &mut force, &mut slip);
            let wrong = self.contradictions(&force, &slip, scale);
            let Some(&last) = wrong.last() else { break };
            if wrong.len() < fewest {
                (fewest, chances) = (wrong.len(), CHANCES);
            } else {
                chances = chances.saturating_sub(1);
            }
            let which = if chances > 0 { &wrong[..] } else { &[last] };
            for &i in which {
                self.states[i] = match self.states[i] {
                    PointState::Stuck => PointState::slipping(force[i]),
                    _ => PointState::Stuck,
                };
            }
        }
        for (i, (trial, f)) in trial.iter_mut().zip(&force).enumerate() {
            *trial = f.clamp(-self.limits[i], self.limits[i]);
        }
        true
    }

    /// Derivative of the forces in the trial forces, row by row.
    pub(super) fn gain(&self, gain: &mut [f64]) {
        let points = self.limits.len();
        gain.fill(0.0);
        for i in (0..points).filter(|i| !self.slipping.contains(i)) {
            gain[i * points + i] = 1.0;
            // D_TS D_SS⁻¹, one row at a time.
            let mut row: Vec<f64> = self.slipping.iter().map(|&j| self.stiffness[(i, j)]).collect();
            self.solve_factored(&mut row, true);
            for (&j, value) in self.slipping.iter().zip(row) {
                gain[i * points + j] = -value;
            }
        }
    }

    /// Points whose force or slip contradicts their state.
    fn contradictions(&self, force: &[f64], slip: &[f64], scale: f64) -> Vec<usize> {
        let mut wrong = Vec::new();
        for (i, limit) in self.limits.iter().enumerate() {
            let slipping = self.slipping.iter().position(|&j| j == i);
            let contradicts = match slipping {
                None => force[i].abs() > limit + ROUNDING * scale,
                Some(_) if *limit == 0.0 => false,
                Some(at) => {
                    self.states[i].sign() * slip[at] * self.stiffness[(i, i)] < -ROUNDING * scale
                }
            };
            if contradicts {
                wrong.push(i);
            }
        }
        wrong
    }

    /// Forces and slip in the present states.
    fn forces(&self, trial: &[f64], force: &mut [f64], slip: &mut Vec<f64>) {
        let at_limit = |i: usize| self.states[i].sign() * self.limits[i];
        slip.clear();
        slip.extend(self.slipping.iter().map(|&i| trial[i] - at_limit(i)));
        self.solve_factored(slip, false);
        for (i, force) in force.iter_mut().enumerate() {
            *force = if self.slipping.contains(&i) {
                at_limit(i)
            } else {
                let taken = self.slipping.iter().zip(&*slip);
                trial[i] - taken.map(|(&j, s)| self.stiffness[(i, j)] * s).sum::<f64>()
            };
        }
    }

    fn factorise(&mut self) {
        self.slipping.clear();
        self.slipping.extend(
            (0..self.limits.len())
                .filter(|&i| self.states[i] != PointState::Stuck || self.limits[i] == 0.0),
        );
        let size = self.slipping.len();
        self.factor.clear();
        self.factor.resize(size * size, 0.0);
        self.independent.clear();
        for i in 0..size {
            for j in 0..=i {
                let before: f64 =
                    (0..j).map(|k| self.factor[i * size + k] * self.factor[j * size + k]).sum();
                let own = self.stiffness[(self.slipping[i], self.slipping[j])];
                self.factor[i * size + j] = if i > j {
                    (own - before) / self.factor[j * size + j]
                } else {
                    let regular = own - before > SINGULAR * own;
                    self.independent.push(regular);
                    if regular {
                        (own - before).sqrt()
                    } else {
                        (SINGULAR * own).sqrt().max(f64::MIN_POSITIVE.sqrt())
                    }
                };
            }
        }
    }

    /// Solves with D_SS; without the dependent points if `regular`.
    fn solve_factored(&self, x: &mut [f64], regular: bool) {
        let size = self.slipping.len();
        let kept = |i: usize| !regular || self.independent[i];
        for i in 0..size {
            let before: f64 = (0..i).map(|k| self.factor[i * size + k] * x[k]).sum();
            x[i] = if kept(i) { (x[i] - before) / self.factor[i * size + i] } else { 0.0 };
        }
        for i in (0..size).rev() {
            let after: f64 = (i + 1..size).map(|k| self.factor[k * size + i] * x[k]).sum();
            x[i] = if kept(i) { (x[i] - after) / self.factor[i * size + i] } else { 0.0 };
        }
    }
}
