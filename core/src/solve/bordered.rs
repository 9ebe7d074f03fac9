//! Newton's method on a curve of solutions, held by one more condition.

use super::curve::Curve;
use super::line_search::LineSearch;
use super::norm;

/// Weighted step that may be the last: Newton's method squares it.
const CLOSE: f64 = 1e-8;
/// Residual, relative to the motion before, above which further steps follow as long as they lower it: half of what a
/// solution may have against its own, …
const BALANCED: f64 = 5e-9;
/// … at most so many: contacts much stiffer than the structure make forces of a short step that are many times its
/// length.
const FURTHER: usize = 4;
/// Decrease of the residual, relative to the share of a step taken, that counts as one.
const DECREASE: f64 = 0.1;
/// Shortest damped step.
const SHORTEST: f64 = 1.0 / 64.0;
/// Weighted step beyond which the equations say nothing about the point looked for.
const FAR: f64 = 2.0;

/// What singles out a point of the curve.
pub(super) enum Condition<'a> {
    /// It lies on the plane through `at` across `normal`, in the weighted metric.
    Plane { normal: &'a [f64], at: &'a [f64] },
    /// It lies at a distance from a point.
    Sphere { centre: &'a [f64], radius: f64 },
}

/// Equations and condition.
pub(super) struct Bordered<'a> {
    pub(super) weights: &'a [f64],
    pub(super) condition: Condition<'a>,
    pub(super) max_iterations: usize,
}

/// Outcome and effort.
pub(super) struct BorderedReport {
    pub(super) converged: bool,
    pub(super) iterations: usize,
}

impl Bordered<'_> {
    /// Solves from `z`, which holds the last iterate on return.
    pub(super) fn solve(&self, curve: &mut dyn Curve, z: &mut [f64]) -> BorderedReport {
        let size = z.len();
        let mut residual = vec![0.0; size];
        let mut trial = LineSearch::new(size);
        self.evaluate(curve, z, &mut residual);
        let (mut close, mut further) = (false, 0);
        for iteration in 1..=self.max_iterations {
            // What a step this short has found stands, whatever becomes of further ones.
            let failed = BorderedReport { converged: close, iterations: iteration };
            let before = norm(&residual);
            if !before.is_finite() || curve.interrupted() {
                return failed;
            }
            let Some((step, _)) = curve.solve_bordered(z, &self.border(z), &residual, self.weights)
            else {
                return failed;
            };
            let length = norm(&weighted(&step, self.weights));
            if !length.is_finite() {
                return failed;
            }
            let longest = (FAR / length).min(1.0);
            let evaluate = |z: &[f64], out: &mut [f64]| self.evaluate(curve, z, out);
            // The first step this short need not lower the residual.
            let last = !close && length <= CLOSE;
            let accepts = |share: f64, after: f64| {
                after <= (1.0 - DECREASE * share) * before || (after.is_finite() && last)
            };
            let shares = [longest, SHORTEST.min(longest)];
            if !trial.along(evaluate, [z, &step], shares, accepts) {
                return failed;
            }
            z.copy_from_slice(&trial.x);
            std::mem::swap(&mut residual, &mut trial.residual);
            close |= trial.length == 1.0 && length <= CLOSE;
            if close && (trial.size <= BALANCED || further == FURTHER) {
                return BorderedReport { converged: true, iterations: iteration };
            }
            further += usize::from(close);
        }
        BorderedReport { converged: close, iterations: self.max_iterations }
    }

    fn evaluate(&self, curve: &mut dyn Curve, z: &[f64], out: &mut [f64]) {
        let last = out.len() - 1;
        curve.residual(z, &mut out[..last]);
        let products = |from: &[f64], along: &dyn Fn(usize) -> f64| -> f64 {
            (0..z.len()).map(|i| self.weights[i].powi(2) * along(i) * (z[i] - from[i])).sum()
        };
        out[last] = match self.condition {
            Condition::Plane { normal, at } => products(at, &|i| normal[i]),
            Condition::Sphere { centre, radius } => {
                let squared = products(centre, &|i| z[i] - centre[i]);
                0.5 * (squared / radius - radius)
            }
        };
    }

    fn border(&self, z: &[f64]) -> Vec<f64> {
        let along = |i: usize| match self.condition {
            Condition::Plane { normal, .. } => normal[i],
            Condition::Sphere { centre, radius } => (z[i] - centre[i]) / radius,
        };
        (0..z.len()).map(|i| self.weights[i].powi(2) * along(i)).collect()
    }

    /// Solution of `J t = 0` with `unit · t = 1`, and the sign of the determinant of the equations
    /// bordered by t.
    pub(super) fn tangent(
        curve: &mut dyn Curve,
        z: &[f64],
        weights: &[f64],
        unit: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        let size = z.len();
        let mut right = vec![0.0; size];
        curve.residual(z, &mut right[..size - 1]);
        if !norm(&right).is_finite() {
            return None;
        }
        let condition = Condition::Plane { normal: unit, at: z };
        let border = Bordered { weights, condition, max_iterations: 0 }.border(z);
        right.fill(0.0);
        right[size - 1] = 1.0;
        curve.solve_bordered(z, &border, &right, weights)
    }
}

fn weighted(x: &[f64], weights: &[f64]) -> Vec<f64> {
    x.iter().zip(weights).map(|(x, w)| x * w).collect()
}
