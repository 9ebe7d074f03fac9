//! A whole curve of solutions: continued from a start to the end of a range of the parameter,
//! with its folds, and read off at given values.

use super::bordered::{Bordered, Condition};
use super::continuation::{at_parameter, Advance, Continuation, Steps};
use super::curve::Curve;

/// How a walk ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The parameter left its range.
    Range,
    /// The caller's condition was met.
    Condition,
    /// As many points as allowed.
    Points,
    /// No point ahead was found.
    Stalled,
    /// The walk came back to where it had been: it has lost its direction, or the curve is closed.
    Returned,
    /// The caller ended the analysis.
    Interrupted,
}

/// A curve as a sequence of points.
#[derive(Debug, Clone)]
pub struct Branch {
    /// Unknowns, point after point.
    pub points: Vec<Vec<f64>>,
    /// Positions of the points at which the parameter turns.
    pub folds: Vec<usize>,
    /// How it ended.
    pub end: End,
    /// Newton iterations in all.
    pub iterations: usize,
    /// Places stepped over.
    pub jumps: usize,
}

/// What bounds a walk.
pub struct Bounds<'a> {
    /// Range of the parameter.
    pub range: (f64, f64),
    /// Most points.
    pub most: usize,
    /// Ends the walk where it is met.
    pub ends: &'a dyn Fn(&[f64]) -> bool,
}

/// Newton iterations for single points of a curve.
const ITERATIONS: usize = 25;
/// Accuracy along the curve to which a fold is located, relative to its surroundings: the
/// parameter is accurate to the square of it.
const AT_FOLD: f64 = 1e-7;
/// Relative difference of the scalars of two folds that are the same.
const SAME_FOLD: f64 = 1e-7;
/// Golden section.
const GOLDEN: f64 = 0.381_966_011_250_105;

impl Branch {
    /// Continues a curve from `start` in the direction of `sign` in the parameter.
    pub fn continue_branch(
        curve: &mut dyn Curve,
        start: Vec<f64>,
        sign: f64,
        steps: Steps,
        bounds: &Bounds<'_>,
    ) -> Self {
        let start = resampled(curve, start);
        let mut branch = Self {
            points: vec![start.clone()],
            folds: Vec::new(),
            end: End::Stalled,
            iterations: 0,
            jumps: 0,
        };
        let mut walk = Continuation::new(curve, start, sign, steps);
        branch.end = loop {
            match walk.advance(curve) {
                Advance::Stalled => break End::Stalled,
                Advance::Interrupted => break End::Interrupted,
                Advance::Point => {}
            }
            let value = parameter(&walk.point);
            let (low, high) = bounds.range;
            if value < low || value > high {
                let edge = if value < low { low } else { high };
                branch.end_at(curve, &walk.point, edge);
                break End::Range;
            }
            branch.push(curve, walk.point.clone());
            curve.accept(&walk.point);
            if branch.returned(curve) {
                break End::Returned;
            }
            if (bounds.ends)(&walk.point) {
                break End::Condition;
            }
            if branch.points.len() >= bounds.most {
                break End::Points;
            }
            let suitable = curve.suitable_unknowns(&walk.point);
            if suitable != walk.point.len() {
                let [.., before, last] = &mut branch.points[..] else { break End::Stalled };
                let Some(known) = curve.resample(before, suitable) else { break End::Stalled };
                let Some(point) = curve.resample(last, suitable) else { break End::Stalled };
                walk.restart(curve, &known, &point);
                (*before, *last) = (known, point);
            }
            if let Some(by) = curve.better_begin(&walk.point) {
                let [.., before, last] = &mut branch.points[..] else { break End::Stalled };
                let Some((known, point)) = begun_later(curve, [before, last], by) else { continue };
                walk.restart(curve, &known, &point);
                (*before, *last) = (known, point);
            }
        };
        branch.iterations += walk.iterations;
        branch.jumps = walk.jumps;
        branch
    }

    /// Adds a point, and the fold before it if the parameter has turned.
    fn push(&mut self, curve: &mut dyn Curve, point: Vec<f64>) {
        if let [.., before, last] = &self.points[..] {
            let [a, b, c] = [before, last, &point].map(|z| parameter(z));
            if (b - a) * (c - b) < 0.0 && self.folds.last() != Some(&(self.points.len() - 1)) {
                if let Some(fold) = Self::turn(curve, before, last, &point) {
                    let nearer = distance(curve, &fold, before) < distance(curve, last, before);
                    let at = self.points.len() - usize::from(nearer);
                    self.points.insert(at, fold);
                    self.folds.push(at);
                } else {
                    self.folds.push(self.points.len() - 1);
                }
            }
        }
        self.points.push(point);
    }

    /// Whether the last fold has been met before. What was walked backwards is cut off.
    fn returned(&mut self, curve: &dyn Curve) -> bool {
        let Some((&last, earlier)) = self.folds.split_last() else { return false };
        // A point behind the fold has just been added; look once.
        if last + 2 != self.points.len() && last + 3 != self.points.len() {
            return false;
        }
        // The scalars tell: periodic motions may have been shifted in time since.
        let scalars = |at: usize| &self.points[at][curve.scalars(&self.points[at])..];
        let apart = |at: usize| {
            let ways = scalars(at).iter().zip(scalars(last)).map(|(a, b)| (a / b - 1.0).abs());
            ways.fold(0.0, f64::max)
        };
        let Some(first) = earlier.iter().position(|at| apart(*at) <= SAME_FOLD) else {
            return false;
        };
        let between = &earlier[first + 1..];
        // Folds as close as that to each other are a wiggle of the curve.
        if between.is_empty() || between.iter().any(|at| apart(*at) <= 100.0 * SAME_FOLD) {
            return false;
        }
        if let [turn] = *between {
            self.points.truncate(turn + 1);
            self.folds.truncate(first + 1);
        }
        true
    }

    /// The point between two others at which the parameter is largest or least: smooth or a corner.
    pub(crate) fn turn(
        curve: &mut dyn Curve,
        before: &[f64],
        middle: &[f64],
        after: &[f64],
    ) -> Option<Vec<f64>> {
        curve.accept(middle);
        let weights = curve.weights(middle);
        let sign = (parameter(middle) - parameter(before)).signum();
        let height = |z: &[f64]| sign * parameter(z);
        let chord: Vec<f64> = after.iter().zip(before).map(|(a, b)| a - b).collect();
        let squared = |a: &[f64], b: &[f64]| -> f64 {
            (0..a.len()).map(|i| weights[i].powi(2) * a[i] * b[i]).sum()
        };
        let length = squared(&chord, &chord).sqrt();
        let unit: Vec<f64> = chord.iter().map(|c| c / length).collect();
        let place = |z: &[f64]| -> f64 {
            let way: Vec<f64> = z.iter().zip(middle).map(|(a, b)| a - b).collect();
            squared(&way, &unit)
        };
        let mut known = vec![
            (place(before), before.to_vec()),
            (0.0, middle.to_vec()),
            (place(after), after.to_vec()),
        ];
        for _ in 0..80 {
            if curve.interrupted() {
                break;
            }
            let best = (1..known.len() - 1)
                .max_by(|&i, &j| height(&known[i].1).total_cmp(&height(&known[j].1)))?;
            let [left, here, right] = [&known[best - 1], &known[best], &known[best + 1]];
            let (low, high) = (left.0, right.0);
            if high - low <= AT_FOLD * length {
                break;
            }
            let vertex = vertex([left, here, right].map(|(s, z)| (*s, parameter(z))));
            let gap = 0.01 * (high - low);
            let golden = if high - here.0 > here.0 - low {
                here.0 + GOLDEN * (high - here.0)
            } else {
                here.0 - GOLDEN * (here.0 - low)
            };
            let mut at = vertex.filter(|s| *s > low && *s < high).unwrap_or(golden);
            // A vertex on the best point says that it is the fold: look at either side of it.
            if (at - here.0).abs() < 1e-3 * gap {
                let side = if high - here.0 > here.0 - low { 1.0 } else { -1.0 };
                at = here.0 + side * gap;
            }
            let share = (at - low) / (high - low);
            let start: Vec<f64> =
                left.1.iter().zip(&right.1).map(|(a, b)| a + share * (b - a)).collect();
            let target: Vec<f64> = middle.iter().zip(&unit).map(|(m, u)| m + at * u).collect();
            let mut z = start;
            let condition = Condition::Plane { normal: &unit, at: &target };
            let report = Bordered { weights: &weights, condition, max_iterations: ITERATIONS }
                .solve(curve, &mut z);
            if !report.converged {
                break;
            }
            let position = known.partition_point(|(s, _)| *s < at);
            known.insert(position, (at, z));
        }
        let (_, fold) = known.into_iter().max_by(|a, b| height(&a.1).total_cmp(&height(&b.1)))?;
        Some(fold)
    }

    /// Ends the branch exactly at the edge of the range, before a point beyond it.
    fn end_at(&mut self, curve: &mut dyn Curve, beyond: &[f64], edge: f64) {
        let Some(last) = self.points.last() else { return };
        if parameter(last) == edge {
            return;
        }
        if let Some((point, iterations)) = between(curve, last, beyond, edge) {
            self.iterations += iterations;
            self.points.push(point);
        }
    }

    /// Points with the parameter at `value`, each with the position of the point it follows.
    pub fn at(&self, curve: &mut dyn Curve, value: f64) -> Vec<(usize, Vec<f64>)> {
        let mut found = Vec::new();
        for (position, pair) in self.points.windows(2).enumerate() {
            let [a, b] = [0, 1].map(|i| parameter(&pair[i]) - value);
            if a == 0.0 {
                found.push((position, pair[0].clone()));
            } else if a * b < 0.0 {
                let Some((a, b)) = curve.matched(&pair[0], &pair[1]) else { continue };
                if let Some((point, _)) = between(curve, &a, &b, value) {
                    found.push((position, point));
                }
            }
        }
        if let Some(last) = self.points.last() {
            if parameter(last) == value {
                found.push((self.points.len() - 1, last.clone()));
            }
        }
        found
    }
}

/// A point in as many unknowns as the equations need there, begun where they are smooth.
fn resampled(curve: &mut dyn Curve, mut point: Vec<f64>) -> Vec<f64> {
    loop {
        let suitable = curve.suitable_unknowns(&point);
        match curve.resample(&point, suitable) {
            Some(more) if suitable > point.len() => point = more,
            _ => break,
        }
    }
    let later = curve.better_begin(&point).and_then(|by| curve.begin_later(&point, by));
    later.unwrap_or(point)
}

/// Two points with their motions begun later.
fn begun_later(
    curve: &mut dyn Curve,
    [before, last]: [&[f64]; 2],
    by: f64,
) -> Option<(Vec<f64>, Vec<f64>)> {
    Some((curve.begin_later(before, by)?, curve.begin_later(last, by)?))
}

/// The point with the parameter at `value` between two others.
pub(crate) fn between(
    curve: &mut dyn Curve,
    a: &[f64],
    b: &[f64],
    value: f64,
) -> Option<(Vec<f64>, usize)> {
    let [from, to] = [a, b].map(parameter);
    let share = (value - from) / (to - from);
    let mixed =
        |share: f64| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect() };
    let size = distance(curve, a, b).max(f64::MIN_POSITIVE);
    for start in [mixed(share), a.to_vec(), b.to_vec()] {
        curve.accept(&start);
        if let Some((z, iterations)) = at_parameter(curve, &start, value, ITERATIONS) {
            // Newton's method may lead to another branch at the same parameter.
            let near = mixed(share);
            if distance(curve, &z, &near) <= 2.0 * size {
                return Some((z, iterations));
            }
        }
    }
    None
}

fn parameter(z: &[f64]) -> f64 {
    z[z.len() - 1]
}

/// Distance of two points, each scalar by itself and the motion against the whole of it.
fn distance(curve: &dyn Curve, a: &[f64], b: &[f64]) -> f64 {
    let motion = curve.scalars(a);
    let size = |x: &[f64]| x[..motion].iter().map(|v| v * v).sum::<f64>().sqrt();
    let way: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    let scale = size(a).max(size(b)).max(f64::MIN_POSITIVE);
    let rest: f64 =
        (motion..a.len()).map(|i| (way[i] / a[i].abs().max(f64::MIN_POSITIVE)).powi(2)).sum();
    (rest + (size(&way) / scale).powi(2)).sqrt()
}

/// Abscissa of the vertex of a parabola through three points.
pub(crate) fn vertex([a, b, c]: [(f64, f64); 3]) -> Option<f64> {
    let (left, right) = (b.0 - a.0, b.0 - c.0);
    let p = left * left * (b.1 - c.1) - right * right * (b.1 - a.1);
    let q = left * (b.1 - c.1) - right * (b.1 - a.1);
    let at = b.0 - 0.5 * p / q;
    at.is_finite().then_some(at)
}
