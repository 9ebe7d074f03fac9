//! The harmonic balance at one frequency as a curve in the load: all loads times a factor, which is an
//! unknown. Motions that no curve over the frequency joins are often joined by it.

use crate::balance::condensed::Condensed;
use crate::solve::{between, norm, Advance, Continuation, Curve, Steps, System as _};

/// Steps relative to the motion and to the load.
const STEPS: Steps = Steps { first: 0.03, shortest: 1e-6, longest: 0.3, max_iterations: 10 };
/// Factors of the load between which motions are joined.
const FACTORS: [f64; 2] = [0.03, 30.0];
/// Most points of a curve.
const MOST: usize = 100;

/// The equations in the unknowns `(U, μ)`.
pub(super) struct LoadCurve<'b, 'a> {
    equations: &'b mut Condensed<'a>,
    /// Where they have been evaluated, and their residual there.
    at: [Vec<f64>; 2],
    /// Size of the last accepted motion.
    size: f64,
}

/// The motions at the load as it is that the curve through one of them comes by, in both directions, as far
/// as so many evaluations, and the work that is granted, lead.
pub(super) fn joined_by_load(
    equations: &mut Condensed<'_>,
    motion: &[f64],
    affordable: usize,
) -> Vec<Vec<f64>> {
    let mut found = Vec::new();
    let mut curve = LoadCurve { equations, at: Default::default(), size: 1.0 };
    for sign in [1.0, -1.0] {
        let mut here = motion.to_vec();
        here.push(1.0);
        let mut walk = Continuation::new(&mut curve, here, sign, STEPS);
        for _ in 0..MOST {
            let before = walk.point.clone();
            if walk.advance(&mut curve) != Advance::Point {
                break;
            }
            let (from, to) = (before[motion.len()], walk.point[motion.len()]);
            if (from - 1.0) * (to - 1.0) < 0.0 {
                let at = between(&mut curve, &before, &walk.point, 1.0);
                found.extend(at.map(|(mut z, _)| {
                    z.pop();
                    z
                }));
                curve.accept(&walk.point);
            }
            let dear =
                curve.equations.profile.evaluations > affordable || curve.equations.is_spent();
            if dear || !(FACTORS[0]..FACTORS[1]).contains(&to) {
                break;
            }
        }
    }
    curve.equations.load_scale = 1.0;
    found
}

impl LoadCurve<'_, '_> {
    /// Evaluates the equations at a point, unless it is the last one.
    fn evaluate(&mut self, z: &[f64]) {
        let Some((factor, u)) = z.split_last().filter(|_| self.at[0] != z) else { return };
        self.equations.load_scale = *factor;
        let mut residual = vec![0.0; u.len()];
        self.equations.residual(u, &mut residual);
        self.at = [z.to_vec(), residual];
    }
}

impl Curve for LoadCurve<'_, '_> {
    fn unknowns(&self) -> usize {
        self.equations.size() + 1
    }

    fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        self.evaluate(z);
        out.iter_mut().zip(&self.at[1]).for_each(|(out, r)| *out = r / self.size);
    }

    fn solve_bordered(
        &mut self,
        z: &[f64],
        border: &[f64],
        right: &[f64],
        _weights: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        self.evaluate(z);
        let mut right = right.to_vec();
        let (_, motion) = right.split_last_mut()?;
        motion.iter_mut().for_each(|r| *r *= self.size);
        let stuck = self.equations.stuck_response().to_vec();
        self.equations.solve_bordered((&stuck, 1.0), border, &right)
    }

    fn weights(&self, z: &[f64]) -> Vec<f64> {
        let mut weights = vec![norm(&z[..z.len() - 1]).max(f64::MIN_POSITIVE).recip(); z.len()];
        weights[z.len() - 1] = z[z.len() - 1].abs().max(FACTORS[0]).recip();
        weights
    }

    fn accept(&mut self, z: &[f64]) {
        self.size = norm(&z[..z.len() - 1]).max(f64::MIN_POSITIVE);
    }

    fn interrupted(&self) -> bool {
        self.equations.interrupted()
    }
}
