//! The smallest circle around a periodic path in the plane, with the derivative of its centre.
//!
//! Two or three points of the path support it: where its distance from the centre is stationary.
//! Points are exchanged until none lies outside, and the centre is refined by Newton's method, in which
//! the points move along the path.

use super::drive::Drive;
use super::grid::Grid;
use super::slip::differentiated;
use super::vectors::{cross, dot, less, solve};

/// Excess over the squared radius, relative to it, that is none.
const OUTSIDE: f64 = 1e-13;
/// Distance of points that are the same.
const SAME: f64 = 1e-6;
/// Excess after which the supports are known.
const NEARLY: f64 = 1e-5;
/// Most exchanges and refinements: a handful is usual.
const STEPS: usize = 64;

/// A point of the path.
#[derive(Debug, Clone, Copy)]
struct Point {
    theta: f64,
    /// Position, slope and curvature.
    jet: [[f64; 2]; 3],
}

/// A circle by its supports.
#[derive(Debug, Clone)]
struct Circle {
    centre: [f64; 2],
    support: Vec<Point>,
}

impl Point {
    fn at(drive: &Drive<'_>, theta: f64) -> Self {
        let [x, y] = [0, 1].map(|i| drive.harmonics().jet(drive.pull(i), theta));
        Self { theta, jet: [0, 1, 2].map(|d| [x[d], y[d]]) }
    }

    fn from(&self, centre: [f64; 2]) -> [f64; 2] {
        less(self.jet[0], centre)
    }

    fn squared(&self, centre: [f64; 2]) -> f64 {
        dot(self.from(centre), self.from(centre))
    }

    /// Half the second derivative of the squared distance, if it is largest here.
    fn bend(&self, centre: [f64; 2]) -> Option<f64> {
        let speed = dot(self.jet[1], self.jet[1]);
        let bend = speed + dot(self.from(centre), self.jet[2]);
        (bend < -1e-9 * speed).then_some(bend)
    }

    /// The farthest point nearby.
    fn farthest(self, drive: &Drive<'_>, centre: [f64; 2], step: f64) -> Self {
        let (mut point, first) = (self, self.theta);
        for _ in 0..STEPS {
            let Some(bend) = point.bend(centre) else { break };
            let by = -dot(point.from(centre), point.jet[1]) / bend;
            let next = Self::at(drive, (point.theta + by).clamp(first - step, first + step));
            // Close to it the distance is flat: rounding would decide.
            if by.abs() > SAME && next.squared(centre) < point.squared(centre) {
                break;
            }
            point = next;
            if by.abs() < 1e-15 {
                break;
            }
        }
        point
    }
}

impl Circle {
    /// The smallest circle with these points on it.
    fn through(support: &[Point]) -> Self {
        let at = |i: usize| support[i].jet[0];
        let centre = match support {
            [_] => at(0),
            [_, _] => [0, 1].map(|i| 0.5 * (at(0)[i] + at(1)[i])),
            _ => {
                let (a, b) = (less(at(1), at(0)), less(at(2), at(0)));
                let to = solve([a, b], [0.5 * dot(a, a), 0.5 * dot(b, b)]).unwrap_or_default();
                [at(0)[0] + to[0], at(0)[1] + to[1]]
            }
        };
        Self { centre, support: support.to_vec() }
    }

    fn squared(&self) -> f64 {
        self.support[0].squared(self.centre)
    }

    /// The smallest circle around the supports and one more point, which lies on it.
    fn with(&self, point: Point) -> Self {
        let old = &self.support;
        let mut smallest: Option<Self> = None;
        for first in 0..old.len() {
            for second in first..old.len() {
                let mut support = vec![point, old[first]];
                support.extend((second > first).then(|| old[second]));
                let circle = Self::through(&support);
                let radius = circle.squared();
                let covers = |p: &Point| p.squared(circle.centre) <= radius * (1.0 + 1e-10);
                if old.iter().all(covers) && smallest.as_ref().is_none_or(|s| radius < s.squared())
                {
                    smallest = Some(circle);
                }
            }
        }
        smallest.unwrap_or_else(|| self.clone())
    }

    /// Coefficients of the two equations of the centre: as far from all supports, which are opposite if
    /// there are two of them.
    fn equations(&self) -> [[f64; 2]; 2] {
        let from = |i: usize| self.support[i].from(self.centre);
        let apart = |i: usize| less(from(0), from(i)).map(|x| 2.0 * x);
        if self.support.len() == 3 {
            return [apart(1), apart(2)];
        }
        let (a, b) = (from(0), from(1));
        let by = |i: usize, unit: [f64; 2]| {
            let point = &self.support[i];
            let moved = point.bend(self.centre).map_or(0.0, |bend| dot(point.jet[1], unit) / bend);
            less(point.jet[1].map(|x| x * moved), unit)
        };
        let along = |unit| cross(by(0, unit), b) + cross(a, by(1, unit));
        [apart(1), [along([1.0, 0.0]), along([0.0, 1.0])]]
    }

    fn residual(&self) -> [f64; 2] {
        let squared = |i: usize| self.support[i].squared(self.centre);
        let from = |i: usize| self.support[i].from(self.centre);
        if self.support.len() == 3 {
            return [squared(1) - squared(0), squared(2) - squared(0)];
        }
        [squared(1) - squared(0), cross(from(0), from(1))]
    }

    /// Newton's method on the centre.
    fn refine(&mut self, drive: &Drive<'_>, step: f64) {
        for _ in 0..STEPS {
            let centre = self.centre;
            self.support.iter_mut().for_each(|p| *p = p.farthest(drive, centre, step));
            // Two that were nearby are one now.
            for i in (1..self.support.len()).rev() {
                let same = |p: &Point| (p.theta - self.support[i].theta).abs() < SAME;
                if self.support[..i].iter().any(same) {
                    self.support.remove(i);
                }
            }
            if self.support.len() < 2 {
                self.centre = self.support[0].jet[0];
                return;
            }
            let by = solve(self.equations(), self.residual().map(|x| -x)).unwrap_or_default();
            self.centre = [centre[0] + by[0], centre[1] + by[1]];
            if dot(by, by) <= 1e-28 * self.squared() {
                return;
            }
        }
    }
}

/// Centre of the smallest circle around the path of K, and its derivative in the coefficients of K and
/// M, direction after direction.
pub(super) fn centre(drive: &Drive<'_>, grid: &Grid) -> ([f64; 2], Vec<f64>) {
    let [x, y, _] = &grid.value;
    let squared = |n: usize, c: [f64; 2]| (x[n] - c[0]).powi(2) + (y[n] - c[1]).powi(2);
    let count = grid.count();
    let mut circle = Circle::through(&[Point::at(drive, 0.0)]);
    let mut refined = false;
    for _ in 0..STEPS {
        let centre = circle.centre;
        let tops = (0..count).filter(|&n| {
            let own = squared(n, centre);
            own >= squared((n + count - 1) % count, centre)
                && own >= squared((n + 1) % count, centre)
        });
        let tops = tops.map(|n| Point::at(drive, n as f64 * grid.step));
        let tops = tops.map(|point| point.farthest(drive, centre, grid.step));
        let by_distance = |a: &Point, b: &Point| a.squared(centre).total_cmp(&b.squared(centre));
        let Some(top) = tops.max_by(by_distance) else { break };
        let excess = top.squared(centre) / circle.squared() - 1.0;
        if refined && excess <= OUTSIDE {
            break;
        } else if !refined && excess <= NEARLY {
            circle.refine(drive, grid.step);
            refined = true;
        } else {
            circle = circle.with(top);
            refined = false;
        }
    }
    (circle.centre, circle.rate(drive))
}

impl Circle {
    /// Derivative of the centre, from its equations.
    fn rate(&self, drive: &Drive<'_>) -> Vec<f64> {
        let slots = drive.harmonics().slots();
        let width = drive.columns();
        let mut out = vec![0.0; 2 * width];
        let bases: Vec<[Vec<f64>; 2]> = self
            .support
            .iter()
            .map(|point| {
                let mut pair = [vec![0.0; slots], vec![0.0; slots]];
                drive.harmonics().basis(point.theta, &mut pair[0]);
                let [basis, slope] = &mut pair;
                differentiated(drive, basis, slope);
                pair
            })
            .collect();
        let count = self.support.len();
        let rows = if count > 1 { self.equations() } else { [[1.0, 0.0], [0.0, 1.0]] };
        for (i, unit) in [[1.0, 0.0], [0.0, 1.0]].into_iter().enumerate() {
            for k in 0..slots {
                let from = |n: usize| self.support[n].from(self.centre);
                let by = |n: usize| 2.0 * dot(from(n), unit) * bases[n][0][k];
                let moved = |n: usize| {
                    let (point, [basis, slope]) = (&self.support[n], &bases[n]);
                    let by = dot(from(n), unit) * slope[k] + dot(point.jet[1], unit) * basis[k];
                    let along = point.bend(self.centre).map_or(0.0, |bend| -by / bend);
                    [0, 1].map(|j| unit[j] * basis[k] + point.jet[1][j] * along)
                };
                let right = match count {
                    1 => unit.map(|e| e * bases[0][0][k]),
                    2 => [by(0) - by(1), -cross(moved(0), from(1)) - cross(from(0), moved(1))],
                    _ => [by(0) - by(1), by(0) - by(2)],
                };
                let change = solve(rows, right).unwrap_or_default();
                out[i * slots + k] = change[0];
                out[width + i * slots + k] = change[1];
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Closure, Coulomb, Motion, Residual};
    use crate::fourier::{Harmonics, SampleTable};
    use crate::test_numbers::numbers;

    fn circle_of(pull: &[f64], highest: usize) -> ([f64; 2], Vec<f64>, f64) {
        let table = SampleTable::new(Harmonics::new(highest, false));
        let law = Coulomb::new(2, 1.0, 1.0, None, Closure::Preload(1.0)).unwrap();
        let motion = Motion { table: &table, displacement: pull, residual: Residual::Centred };
        let drive = Drive::new(&law, motion, false);
        let (found, rate) = centre(&drive, &Grid::new(&drive));
        let radius = (0..20_000).map(|n| Point::at(&drive, n as f64 * 3.15e-4).squared(found));
        (found, rate, radius.fold(0.0, f64::max).sqrt())
    }

    /// No centre nearby has a smaller circle, and the derivative is that of differences.
    #[test]
    fn the_circle_is_the_smallest() {
        let mut random = numbers();
        for case in 0..40 {
            let highest = 1 + case % 7;
            let slots = 2 * highest + 1;
            let pull: Vec<f64> =
                (0..2 * slots).map(|i| random() / (1.0 + (i % slots) as f64)).collect();
            let (found, rate, radius) = circle_of(&pull, highest);
            let table = SampleTable::new(Harmonics::new(highest, false));
            let law = Coulomb::new(2, 1.0, 1.0, None, Closure::Preload(1.0)).unwrap();
            let residual = Residual::Centred;
            let drive =
                Drive::new(&law, Motion { table: &table, displacement: &pull, residual }, false);
            for n in 0..16 {
                let (sin, cos) = (f64::from(n) * 0.4).sin_cos();
                let other = [found[0] + 1e-4 * cos, found[1] + 1e-4 * sin];
                let reach = (0..20_000).map(|n| Point::at(&drive, f64::from(n) * 3.15e-4));
                let reach = reach.map(|p| p.squared(other)).fold(0.0, f64::max).sqrt();
                assert!(reach > radius, "{case}: {reach} {radius}");
            }
            let width = 2 * slots + 1;
            for j in 0..2 * slots {
                let at = |by: f64| {
                    let mut pull = pull.clone();
                    pull[j] += by;
                    circle_of(&pull, highest).0
                };
                let (up, down) = (at(1e-5), at(-1e-5));
                for i in 0..2 {
                    let slope = (up[i] - down[i]) / 2e-5;
                    let own = rate[i * width + j];
                    assert!(
                        (own - slope).abs() < 1e-5 * (1.0 + slope.abs()),
                        "{case}: {own} {slope}"
                    );
                }
            }
        }
    }
}
