//! Floquet multipliers: how small disturbances of an orbit grow over a period.

use super::shooting::Shooting;
use crate::solve::norm;
use faer::linalg::solvers::Solve as _;
use faer::{c64, Mat};
use std::f64::consts::FRAC_PI_2;

/// Change of a linear form over a period, relative to it, that is none.
const KEPT: f64 = 1e-9;

impl Shooting<'_> {
    /// Floquet multipliers over the full period by falling modulus, the neutral ones first, and the
    /// number of these.
    pub(super) fn multipliers(&mut self) -> Option<(Vec<c64>, usize)> {
        let (mut multipliers, neutral) = self.span_multipliers()?;
        if self.half_wave {
            multipliers.iter_mut().for_each(|m| *m *= *m);
        }
        multipliers.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
        let ones = std::iter::repeat_n(c64::new(1.0, 0.0), neutral);
        // Forces that no deformation gives do not exist: what would be left of them is 0.
        let none = std::iter::repeat_n(c64::new(0.0, 0.0), self.idle);
        Some((ones.chain(multipliers).chain(none).collect(), neutral))
    }

    /// Multipliers over the span, mirrored under half-wave symmetry, without the neutral ones; and
    /// the number of these.
    fn span_multipliers(&mut self) -> Option<(Vec<c64>, usize)> {
        let mut matrix = self.derivative();
        self.hold_origins(&mut matrix);
        let (rest, neutral) = self.without_neutral(&matrix, &self.slipped);
        Some((rest.eigenvalues().ok()?, neutral))
    }

    /// Linear forms that the motion conserves while the points `slipped` alone slip, each with a
    /// coordinate that it determines: the slip of contacts that never do, and of one that but touches its
    /// limit in a plane, the part across.
    pub(super) fn conserved(&self, matrix: &Mat<f64>, slipped: &[bool]) -> Vec<(usize, Vec<f64>)> {
        let mut forms = self.coordinates.conserved(slipped);
        let system = self.coordinates.system();
        let side = if self.half_wave { -1.0 } else { 1.0 };
        for plane in system.planes().iter().filter(|plane| slipped[plane.points[0]]) {
            let others: Vec<bool> =
                (0..slipped.len()).map(|i| !plane.points.contains(&i)).collect();
            let [(target, one), (_, other)] = &self.coordinates.conserved(&others)[..] else {
                continue;
            };
            // What a period changes of a form.
            let change = |form: &[f64]| -> Vec<f64> {
                let after = |j: usize| -> f64 {
                    form.iter().enumerate().map(|(i, f)| f * matrix[(i, j)]).sum()
                };
                (0..form.len()).map(|j| side * after(j) - form[j]).collect()
            };
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let unit = |form: &[f64]| form.iter().map(|f| f / norm(form)).collect::<Vec<f64>>();
            let one = unit(one);
            let share = dot(&one, other);
            let other =
                unit(&other.iter().zip(&one).map(|(f, e)| f - share * e).collect::<Vec<_>>());
            let (a, b) = (change(&one), change(&other));
            // The combination that changes least.
            let angle = 0.5 * (2.0 * dot(&a, &b)).atan2(dot(&a, &a) - dot(&b, &b)) + FRAC_PI_2;
            let (sin, cos) = angle.sin_cos();
            let mixed = |a: &[f64], b: &[f64]| -> Vec<f64> {
                a.iter().zip(b).map(|(a, b)| cos * a + sin * b).collect()
            };
            if norm(&mixed(&a, &b)) <= KEPT {
                let form = mixed(&one, &other);
                let first = 2 * system.modes();
                let size = |i: usize| form[i].abs();
                let pivot =
                    (first..form.len())
                        .fold(*target, |most, i| if size(i) > size(most) { i } else { most });
                forms.push((pivot, form));
            }
        }
        forms.iter_mut().for_each(|(_, form)| form.resize(matrix.nrows(), 0.0));
        forms
    }

    /// A transition matrix without what is neutral while the points `slipped` alone slip, and the
    /// number of the multipliers that are 1 for it: a contact that never slips keeps its slip, and
    /// nothing answers to some rigid-body motions.
    pub(super) fn without_neutral(&self, matrix: &Mat<f64>, slipped: &[bool]) -> (Mat<f64>, usize) {
        let conserved = self.conserved(matrix, slipped);
        let rigid = self.coordinates.rigid(slipped);
        if conserved.is_empty() && rigid.is_empty() {
            return (matrix.clone(), 0);
        }
        let size = matrix.nrows();
        let mut change = Mat::<f64>::identity(size, size);
        for (target, row) in &conserved {
            for (j, value) in row.iter().enumerate() {
                change[(*target, j)] = *value;
            }
        }
        let changed = &change * matrix;
        let matrix = change.transpose().partial_piv_lu().solve(changed.transpose());
        let kept: Vec<usize> =
            (0..size).filter(|i| conserved.iter().all(|(target, _)| target != i)).collect();
        let rest = Mat::from_fn(kept.len(), kept.len(), |i, j| matrix[(kept[j], kept[i])]);
        if rigid.is_empty() {
            return (rest, conserved.len());
        }
        // Eigenvectors of the matrix and of its transpose, orthogonal to each other: what is left
        // across all of them has the other multipliers.
        let along = Mat::from_fn(kept.len(), rigid.len(), |i, j| {
            rigid[j].get(kept[i]).copied().unwrap_or(0.0)
        });
        let basis = along.qr().compute_Q();
        let across = basis.get(.., rigid.len()..);
        (across.transpose() * &rest * across, conserved.len() + rigid.len())
    }
}
