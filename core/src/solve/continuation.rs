//! Continuation of a curve of solutions by arclength, around folds and past corners.
//!
//! The curve is given as a [`Curve`]: one equation less than unknowns, of which one is the
//! parameter. Where the equations are only piecewise smooth the curve has corners: its tangent
//! jumps, by more than a right angle too. What stays is the orientation: the sign of the determinant
//! of the equations bordered by the tangent is the same all along a curve, around folds and past
//! corners (Allgower and Georg 2003, chapters 2 and 12). So a point counts only if the curve passes
//! through it in the direction of the way there with this orientation.

use super::bordered::{Bordered, Condition};
use super::curve::Curve;
use super::norm;

/// Steps of a continuation, in the metric of [`Curve::weights`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Length of the first step.
    pub first: f64,
    /// Shortest step before the curve counts as stalled.
    pub shortest: f64,
    /// Longest step.
    pub longest: f64,
    /// Newton iterations per point.
    pub max_iterations: usize,
}

impl Default for Steps {
    fn default() -> Self {
        Self { first: 0.02, shortest: 1e-5, longest: 0.1, max_iterations: 12 }
    }
}

/// Iterations up to which the next step may be longer, …
const EASY: usize = 4;
/// … and by how much.
const GROWTH: f64 = 1.6;
/// Cosine between successive secants below which a step is too long: longer steps may land on another
/// part of a winding curve, …
const BEND: f64 = 0.95;
/// … unless it is so short, against the longest, that the bend must be a corner.
const CORNER: f64 = 2e-3;
/// Cosine above which a step that short goes straight on.
const STRAIGHT: f64 = 0.999;
/// Points in a row at steps below a hundredth of the longest after which the walk only crawls: the
/// equations are worse than their unknowns are known.
const CRAWL: usize = 150;
/// Lengths of the jumps over a place where short steps fail, against the longest step.
const JUMPS: [f64; 6] = [1e-3, 4e-3, 0.02, 0.1, 0.4, 1.0];

/// What a step along the curve gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Advance {
    /// A new point.
    Point,
    /// No point ahead, neither by short steps nor by jumps in any direction.
    Stalled,
    /// The caller ended the analysis.
    Interrupted,
}

/// A walk along a curve.
#[derive(Debug, Clone)]
pub struct Continuation {
    /// The last point.
    pub point: Vec<f64>,
    /// Newton iterations in all.
    pub iterations: usize,
    /// Jumps over places where short steps failed.
    pub jumps: usize,
    direction: Vec<f64>,
    /// Sign of the determinant of the equations bordered by the tangent in the direction of the
    /// walk: it is the same all along a curve, around folds and past corners. 0 where it is not known.
    pub(crate) orientation: f64,
    step: f64,
    steps: Steps,
    /// Short steps in a row.
    short: usize,
}

impl Continuation {
    /// A walk from a point of the curve, towards growing parameter, or falling.
    pub fn new(curve: &mut dyn Curve, start: Vec<f64>, sign: f64, steps: Steps) -> Self {
        curve.accept(&start);
        let weights = curve.weights(&start);
        let mut ahead = vec![0.0; start.len()];
        ahead[start.len() - 1] = sign;
        let (direction, orientation) =
            oriented(curve, &start, &weights, &ahead).unwrap_or((ahead, 1.0));
        Self {
            point: start,
            iterations: 0,
            jumps: 0,
            direction,
            orientation,
            step: steps.first,
            steps,
            short: 0,
        }
    }

    /// Goes on from the last two points, given in other unknowns.
    pub(crate) fn restart(&mut self, curve: &mut dyn Curve, before: &[f64], point: &[f64]) {
        self.point = before.to_vec();
        self.move_to(curve, point.to_vec());
        let weights = curve.weights(point);
        if let Some((_, orientation)) = oriented(curve, point, &weights, &self.direction.clone()) {
            self.orientation = orientation;
        }
    }

    /// Has the next step be no longer than this, for points that are wanted closer to each other: a walk that is
    /// short by that does not crawl.
    pub(crate) fn limit_step(&mut self, longest: f64) {
        if longest < self.step {
            (self.step, self.short) = (longest, 0);
        }
    }

    /// Takes one step.
    pub fn advance(&mut self, curve: &mut dyn Curve) -> Advance {
        let weights = curve.weights(&self.point);
        let unit = normalised(&self.direction, &weights);
        self.short = if self.step < 0.01 * self.steps.longest { self.short + 1 } else { 0 };
        if self.short > CRAWL {
            return Advance::Stalled;
        }
        while self.step >= self.steps.shortest {
            if curve.interrupted() {
                return Advance::Interrupted;
            }
            let found = self.correct(curve, &unit, &weights, self.step, false);
            if let Some((point, iterations)) = found {
                let (cosine, distance) = self.compare(&point, &unit, &weights);
                let corner = self.step <= CORNER * self.steps.longest;
                if distance < 3.0 * self.step && (cosine > BEND || (corner && cosine > 0.0)) {
                    let turn = self.turn(curve, &point, &weights);
                    if let Some((bend, tangent, orientation)) = turn {
                        let straight = cosine.min(bend);
                        let same = orientation * self.orientation >= 0.0;
                        // What changes the orientation and does not bend is a bifurcation.
                        let passes =
                            if corner { same || straight > STRAIGHT } else { same && bend > BEND };
                        if passes {
                            let easy = iterations <= EASY && straight > 0.5 * (1.0 + BEND);
                            self.move_to(curve, point);
                            self.orientation = orientation;
                            if bend > BEND {
                                self.direction = tangent;
                            }
                            let factor = if easy { GROWTH } else { 1.0 };
                            self.step = (factor * self.step).min(self.steps.longest);
                            return Advance::Point;
                        }
                    }
                }
            }
            self.step *= 0.5;
        }
        self.jump(curve, &unit, &weights)
    }

    /// Tangent at a new point, and its cosine with the way there: a point of another part of the
    /// curve that passes nearby has another tangent.
    fn turn(
        &self,
        curve: &mut dyn Curve,
        point: &[f64],
        weights: &[f64],
    ) -> Option<(f64, Vec<f64>, f64)> {
        let way: Vec<f64> = point.iter().zip(&self.point).map(|(a, b)| a - b).collect();
        let (tangent, orientation) = oriented(curve, point, weights, &way)?;
        let rest = vec![0.0; way.len()];
        let (a, b) = (difference(&way, &rest, weights), difference(&tangent, &rest, weights));
        let product: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
        Some((product / norm(&a).max(f64::MIN_POSITIVE), tangent, orientation))
    }

    /// Looks around where short steps fail: on spheres about the last point, along the secant and
    /// along the tangents here and a little ahead, where other equations may hold. The curve leaves
    /// a corner in one direction alone, with the orientation that it came with.
    fn jump(&mut self, curve: &mut dyn Curve, unit: &[f64], weights: &[f64]) -> Advance {
        for share in JUMPS {
            let radius = share * self.steps.longest;
            let mut best: Option<(f64, Vec<f64>)> = None;
            for direction in self.directions(curve, unit, weights, radius) {
                if curve.interrupted() {
                    return Advance::Interrupted;
                }
                let found = self.correct(curve, &direction, weights, radius, true);
                let Some((point, _)) = found else { continue };
                let (cosine, distance) = self.compare(&point, unit, weights);
                let turn = self.turn(curve, &point, weights);
                // Without orientations a way back cannot be told from a corner.
                let ahead = turn.as_ref().is_some_and(|(_, _, sign)| {
                    let same = sign * self.orientation;
                    same > 0.0 || (same == 0.0 && cosine > 0.0)
                });
                let lies_ahead = ahead && (distance - radius).abs() < 0.5 * radius;
                if lies_ahead && best.as_ref().is_none_or(|(known, _)| cosine > *known) {
                    best = Some((cosine, point));
                }
            }
            if let Some((_, point)) = best {
                self.move_to(curve, point);
                self.jumps += 1;
                self.step = (0.5 * radius).max(2.0 * self.steps.shortest);
                return Advance::Point;
            }
        }
        Advance::Stalled
    }

    fn directions(
        &self,
        curve: &mut dyn Curve,
        unit: &[f64],
        weights: &[f64],
        radius: f64,
    ) -> Vec<Vec<f64>> {
        let mut directions = vec![unit.to_vec()];
        for share in [0.0, 1.0, -1.0] {
            let at = moved(&self.point, unit, share * radius);
            if let Some(tangent) = tangent(curve, &at, weights, unit) {
                directions.push(tangent.iter().map(|t| -t).collect());
                directions.push(tangent);
            }
        }
        directions
    }

    /// The point of the curve at a distance along a direction: on a plane across it, or on the
    /// sphere.
    fn correct(
        &mut self,
        curve: &mut dyn Curve,
        unit: &[f64],
        weights: &[f64],
        step: f64,
        on_sphere: bool,
    ) -> Option<(Vec<f64>, usize)> {
        let mut z = moved(&self.point, unit, step);
        let condition = if on_sphere {
            Condition::Sphere { centre: &self.point, radius: step }
        } else {
            Condition::Plane { normal: unit, at: &z.clone() }
        };
        let report = Bordered { weights, condition, max_iterations: self.steps.max_iterations }
            .solve(curve, &mut z);
        self.iterations += report.iterations;
        report.converged.then_some((z, report.iterations))
    }

    /// Cosine of the way to a point with the direction so far, and its length.
    fn compare(&self, point: &[f64], unit: &[f64], weights: &[f64]) -> (f64, f64) {
        let way = difference(point, &self.point, weights);
        let along: Vec<f64> = unit.iter().zip(weights).map(|(u, w)| u * w).collect();
        let length = norm(&way);
        let product: f64 = way.iter().zip(&along).map(|(a, b)| a * b).sum();
        (product / length.max(f64::MIN_POSITIVE), length)
    }

    fn move_to(&mut self, curve: &mut dyn Curve, point: Vec<f64>) {
        self.direction = point.iter().zip(&self.point).map(|(a, b)| a - b).collect();
        curve.accept(&point);
        self.point = point;
    }
}

/// `z + step unit`.
fn moved(z: &[f64], unit: &[f64], step: f64) -> Vec<f64> {
    z.iter().zip(unit).map(|(z, u)| z + step * u).collect()
}

/// `a − b`, weighted.
fn difference(a: &[f64], b: &[f64], weights: &[f64]) -> Vec<f64> {
    a.iter().zip(b).zip(weights).map(|((a, b), w)| w * (a - b)).collect()
}

/// A direction of weighted length one.
fn normalised(direction: &[f64], weights: &[f64]) -> Vec<f64> {
    let length = norm(&difference(direction, &vec![0.0; direction.len()], weights));
    direction.iter().map(|d| d / length.max(f64::MIN_POSITIVE)).collect()
}

/// Tangent of the curve at a point, of length one and on the side of `ahead`.
#[must_use]
pub fn tangent(
    curve: &mut dyn Curve,
    z: &[f64],
    weights: &[f64],
    ahead: &[f64],
) -> Option<Vec<f64>> {
    oriented(curve, z, weights, ahead).map(|(tangent, _)| tangent)
}

/// The tangent with the orientation of the curve in its direction.
pub(crate) fn oriented(
    curve: &mut dyn Curve,
    z: &[f64],
    weights: &[f64],
    ahead: &[f64],
) -> Option<(Vec<f64>, f64)> {
    let unit = normalised(ahead, weights);
    let (tangent, orientation) = Bordered::tangent(curve, z, weights, &unit)?;
    Some((normalised(&tangent, weights), orientation))
}

/// The point of the curve with its parameter at `value`, from a start nearby.
#[must_use]
pub fn at_parameter(
    curve: &mut dyn Curve,
    start: &[f64],
    value: f64,
    max_iterations: usize,
) -> Option<(Vec<f64>, usize)> {
    let weights = curve.weights(start);
    let mut z = start.to_vec();
    let at = start.len() - 1;
    z[at] = value;
    let mut normal = vec![0.0; z.len()];
    normal[at] = weights[at].recip();
    let condition = Condition::Plane { normal: &normal, at: &z.clone() };
    let report = Bordered { weights: &weights, condition, max_iterations }.solve(curve, &mut z);
    report.converged.then_some((z, report.iterations))
}

/// The point of the curve on the plane across the way from `a` to `b`, at a share of it.
#[must_use]
pub fn across(curve: &mut dyn Curve, a: &[f64], b: &[f64], share: f64) -> Option<Vec<f64>> {
    let weights = curve.weights(a);
    let way: Vec<f64> = a.iter().zip(b).map(|(a, b)| b - a).collect();
    let normal = normalised(&way, &weights);
    let mut z = moved(a, &way, share);
    let condition = Condition::Plane { normal: &normal, at: &z.clone() };
    let report = Bordered { weights: &weights, condition, max_iterations: 25 }.solve(curve, &mut z);
    report.converged.then_some(z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::factorised_with;

    /// `x = 0`, where equations are defined up to this distance from the last point.
    struct Near {
        reach: f64,
        last: f64,
    }

    impl Curve for Near {
        fn unknowns(&self) -> usize {
            2
        }

        fn residual(&mut self, z: &[f64], out: &mut [f64]) {
            out[0] = if (z[1] - self.last).abs() > self.reach { f64::NAN } else { z[0] };
        }

        fn solve_bordered(
            &mut self,
            _: &[f64],
            border: &[f64],
            right: &[f64],
            weights: &[f64],
        ) -> Option<(Vec<f64>, f64)> {
            factorised_with(faer::mat![[1.0, 0.0], [0.0, 0.0]], border, right, weights)
        }

        fn weights(&self, _: &[f64]) -> Vec<f64> {
            vec![1.0; 2]
        }

        fn accept(&mut self, z: &[f64]) {
            self.last = z[1];
        }
    }

    /// A walk whose own steps fail one after the other ends; one whose steps are to be as short goes on.
    #[test]
    fn steps_that_are_wanted_short_are_no_crawl() {
        let (short, most) = (5e-3 * Steps::default().longest, 10 * CRAWL);
        let points = |reach: f64, limit: f64| {
            let mut curve = Near { reach, last: 0.0 };
            let mut walk = Continuation::new(&mut curve, vec![0.0; 2], 1.0, Steps::default());
            let found = (0..most).take_while(|_| {
                walk.limit_step(limit);
                walk.advance(&mut curve) == Advance::Point
            });
            found.count()
        };
        assert_eq!(points(f64::INFINITY, short), most);
        let crawled = points(short, f64::INFINITY);
        assert!((CRAWL..2 * CRAWL).contains(&crawled), "{crawled}");
    }
}
