//! A branch of limit cycles as points, with its two sides.

use super::settings::Turn;
use crate::solve::{Branch, Curve, End};

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

impl Sides {
    /// The sides of a branch that was followed upwards in the scalar, without what lies before `low` on
    /// the way to its limit. A branch that has come back has none: a farther turn may have been missed.
    pub(super) fn upwards(mut branch: Branch, low: f64) -> Self {
        let limit = extreme(&branch, 1.0);
        if limit.is_some_and(|at| value(&branch.points[at]) > low) {
            let outside = branch.points.iter().take_while(|z| value(z) < low).count();
            branch.points.drain(..outside);
            branch.folds.retain_mut(|fold| {
                *fold = fold.wrapping_sub(outside);
                *fold < branch.points.len()
            });
        }
        let limit = extreme(&branch, 1.0).filter(|_| branch.end != End::Returned);
        let ends = [End::Range, branch.end];
        Self { branch, limit, ends }
    }

    /// Where the branch is at a position.
    pub(super) fn turn(&self, at: usize) -> Option<Turn> {
        let z = self.branch.points.get(at)?;
        Some(Turn { value: value(z), omega: z[z.len() - 2] })
    }

    /// The scalar at both ends.
    pub(super) fn end_values(&self) -> [f64; 2] {
        let points = &self.branch.points;
        [points.first(), points.last()].map(|z| z.map_or(f64::NAN, |z| value(z)))
    }

    /// The points wanted, each with whether it lies on the slipping side; without `values` all of them.
    pub(super) fn select(
        &self,
        values: Option<&[f64]>,
        curve: &mut dyn Curve,
    ) -> Vec<(bool, Vec<f64>)> {
        let slipping = |position: usize| self.limit.is_some_and(|limit| position >= limit);
        let points = &self.branch.points;
        let Some(values) = values else {
            let beyond = |at: usize| self.limit.is_some_and(|limit| at > limit);
            return points.iter().enumerate().map(|(at, z)| (beyond(at), z.clone())).collect();
        };
        let mut found: Vec<(usize, Vec<f64>)> =
            values.iter().flat_map(|value| self.branch.at(curve, *value)).collect();
        let progress = |(position, z): &(usize, Vec<f64>)| -> f64 {
            let from = value(&points[*position]);
            let to = points.get(position + 1).map_or(from, |z| value(z));
            let share = (value(z) - from) / (to - from);
            *position as f64 + if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
        };
        found.sort_by(|a, b| progress(a).total_cmp(&progress(b)));
        found.into_iter().map(|(position, z)| (slipping(position), z)).collect()
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
