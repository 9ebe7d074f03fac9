//! A branch of limit cycles as points, with its two sides.

use crate::solve::{Branch, End};

/// A branch with what tells its sides apart.
pub(super) struct Sides {
    pub(super) branch: Branch,
    /// Position of the fold at which the sticking side ends.
    pub(super) limit: Option<usize>,
    pub(super) ends: [End; 2],
}

impl Default for Sides {
    fn default() -> Self {
        let branch = Branch {
            points: Vec::new(),
            folds: Vec::new(),
            end: End::Interrupted,
            iterations: 0,
            jumps: 0,
        };
        Self { branch, limit: None, ends: [End::Interrupted; 2] }
    }
}

/// The last unknown.
pub(super) fn value(z: &[f64]) -> f64 {
    z.last().copied().unwrap_or(f64::NAN)
}

/// Position of the fold farthest in a direction of the scalar.
pub(super) fn extreme(branch: &Branch, sign: f64) -> Option<usize> {
    let height = |at: &usize| sign * branch.points.get(*at).map_or(f64::NAN, |z| value(z));
    branch.folds.iter().copied().max_by(|a, b| height(a).total_cmp(&height(b)))
}

/// One branch of those to both sides: the one without a fold first and backwards.
pub(super) fn joined(up: Branch, down: Branch) -> Sides {
    let (first, second, sign) = if down.folds.is_empty() && !up.folds.is_empty() {
        (down, up, 1.0)
    } else {
        (up, down, -1.0)
    };
    let limit = extreme(&second, sign);
    let shift = first.points.len() - 1;
    let mut points: Vec<Vec<f64>> = first.points.into_iter().rev().collect();
    points.extend(second.points.into_iter().skip(1));
    let mut folds: Vec<usize> = first.folds.iter().map(|at| shift - at).collect();
    folds.extend(second.folds.iter().map(|at| shift + at));
    let ends = [first.end, second.end];
    let branch = Branch {
        points,
        folds,
        end: second.end,
        iterations: first.iterations + second.iterations,
        jumps: first.jumps + second.jumps,
    };
    Sides { branch, limit: limit.map(|at| shift + at), ends }
}
