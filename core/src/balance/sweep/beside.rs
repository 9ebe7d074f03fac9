//! Points of a branch beside a turn.
//!
//! Towards a fold the curve gets ever steeper, and the Newton step at the frequency of a point, which tells what
//! more harmonics would change there, grows without bound: it runs along the curve and not across it. To ask for
//! harmonics because of it makes a few points dearer than all others by orders of magnitude. So a point beside a
//! turn is judged as the fold is, by its distance to the curve of more harmonics on the plane across the way.

use super::branch::Walk;
use super::forced_curve::ForcedCurve;
use crate::balance::scale::OF_HARMONICS;
use crate::balance::settings::Resolution;
use crate::balance::solution::Point;
use crate::balance::tangent::distance;
use crate::Error;

/// Distance to a turn, as a share of the motion, up to which a point is beside it. Farther off the curve is so
/// flat, as a rule, that the step at its frequency is not much more than the distance.
const BESIDE: f64 = 0.1;

impl Walk<'_, '_> {
    /// Judges a point beside a turn across the way, if its error at its own frequency asks for more harmonics.
    pub(super) fn judge_beside(
        &mut self,
        curve: &mut ForcedCurve<'_>,
        point: &mut Point,
        resolution: Resolution,
    ) -> Result<(), Error> {
        if self.balance.control.is_fixed() || !point.is_solved() {
            return Ok(());
        }
        let error = self.error_of(point);
        if error <= self.balance.settings.tolerance {
            return Ok(());
        }
        let (last, here) = (self.last(), point.unknowns());
        let (Some(known), Some(here)) = (last.unknowns(), here) else { return Ok(()) };
        let (from, to) = (curve.point(known, last.omega), curve.point(here, point.omega));
        let before = self.points.iter().rev().nth(1);
        let before = before.and_then(|one| Some(curve.point(one.unknowns()?, one.omega)));
        let Some(before) = before else { return Ok(()) };
        let beside = to_turn([&before, &from, &to]) <= BESIDE;
        if !beside {
            return Ok(());
        }
        let way: Vec<f64> = to.iter().zip(&from).map(|(b, a)| b - a).collect();
        let mut judged = point.clone();
        let whole = self.judge_across(curve, &to, &mut judged, &[way], resolution)?;
        if whole && self.error_of(&judged) < error {
            *point = judged;
        }
        Ok(())
    }

    /// The error of a point as it counts against the tolerance.
    fn error_of(&self, point: &Point) -> f64 {
        let errors = point.error_estimate.iter().copied();
        self.balance.scale.relative(point, OF_HARMONICS, errors)
    }
}

/// Distance along a curve from the last of three points to where the frequency turns, ahead or behind, by how its
/// rate has changed from one way to the next; zero of a point with a turn just before it.
fn to_turn([a, b, c]: [&[f64]; 3]) -> f64 {
    let rate = |from: &[f64], to: &[f64], length: f64| {
        (to[to.len() - 1] / from[from.len() - 1] - 1.0) / length
    };
    let [earlier, later] = [distance(a, b), distance(b, c)];
    let [before, after] = [rate(a, b, earlier), rate(b, c, later)];
    let bend = (after - before) / (0.5 * (earlier + later));
    let here = after + 0.5 * later * bend;
    if before * after < 0.0 || here * after < 0.0 {
        return 0.0;
    }
    (here / bend).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion of one number on `ω = 2 − c u²`, whose size is 1.
    fn on_parabola(bend: f64, at: f64) -> [f64; 3] {
        [at.cos(), at.sin(), 2.0 - bend * at * at]
    }

    #[test]
    fn the_distance_to_a_turn_is_that_along_the_curve() {
        for bend in [0.01, 0.3, 1.0] {
            for (ahead, step) in [(0.05, 0.004), (0.05, -0.004), (0.1, 0.02), (0.1, -0.02)] {
                let points = [2.0, 1.0, 0.0].map(|n| on_parabola(bend, ahead + n * step));
                let way = distance(&on_parabola(bend, ahead), &on_parabola(bend, 0.0));
                let found = to_turn([&points[0], &points[1], &points[2]]);
                assert!((found / way - 1.0).abs() < 0.02, "{bend}, {ahead}, {step}: {found} {way}");
            }
        }
    }

    #[test]
    fn a_point_behind_a_turn_is_beside_it_and_one_on_a_straight_curve_is_not() {
        let [a, b, c] = [0.03, 0.015, -0.02].map(|at| on_parabola(1.0, at));
        assert_eq!(to_turn([&a, &b, &c]), 0.0);
        let [a, b, c] = [0.0, 0.02, 0.04].map(|at: f64| [at.cos(), at.sin(), 2.0 + at]);
        assert!(to_turn([&a, &b, &c]) > 1.0);
    }
}
