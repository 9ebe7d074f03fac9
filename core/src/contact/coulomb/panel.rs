//! A panel of slip in two directions: the slip equation by collocation.
//!
//! The equation is stiff where M is small: φ is locked to the direction of motion. A panel takes φ as
//! the polynomial that satisfies the equation at the nodes of Gauss-Legendre quadrature (Hairer and
//! Wanner 1996, section IV.5), which serve the Fourier integrals as well.

use super::collocation::{Collocation, Lanes, NodeFactors, NODES};
use super::slip::{Nodes, Plane};
use crate::fourier::{cos_sin, sum, SERIES};
use pulp::{Arch, Simd, WithSimd};

/// Steps of Newton's method for a panel, which starts close and needs three.
const STEPS: usize = 12;
/// Error of φ that counts as none.
const ROUNDING: f64 = 1e-15;
/// Ratio of two steps of Newton's method below which its matrix is kept.
const SHRINKING: f64 = 1e-2;
/// Last coefficients of the polynomial of φ that count as none, relative to the largest limit. Values
/// at the end and integrals are good to the square of this.
pub(super) const RESOLVED: f64 = 2e-8;
/// The same where the end alone matters.
pub(super) const ROUGHLY: f64 = 1e-6;
/// The same for what a panel can add to an integral, whatever its order.
const NEGLIGIBLE: f64 = 1e-13;

/// A stretch of slip on which φ is one polynomial.
pub(super) struct Panel {
    start: f64,
    pub(super) length: f64,
    /// As long as a panel might have been here.
    pub(super) wanted: f64,
    /// How far φ has turned at the nodes, and cosine and sine of it.
    pub(super) turned: Lanes,
    pub(super) direction: [Lanes; 2],
    first_angle: f64,
    pub(super) last_angle: f64,
    /// λ at the nodes and at the end.
    slip_rate: Lanes,
    last_slip_rate: f64,
    /// φ' at the nodes, and its derivative in φ.
    pub(super) turning: Lanes,
    pub(super) restoring: Lanes,
    pub(super) nodes: Nodes,
    /// Basis at the nodes, slot after slot.
    pub(super) basis: Vec<Lanes>,
    /// Derivative of φ at the nodes, column after column; nothing if it was not asked for.
    pub(super) rate: Vec<Lanes>,
}

impl Panel {
    /// The panel from an angle on; `None` where Newton's method fails.
    pub(super) fn solve(plane: &Plane<'_>, start: f64, length: f64, angle: f64) -> Option<Self> {
        plane.solved.set(plane.solved.get() + 1);
        Arch::new().dispatch(Collocating { plane, start, length, angle })
    }

    #[inline(always)]
    fn collocated(plane: &Plane<'_>, start: f64, length: f64, angle: f64) -> Option<Self> {
        let table = Collocation::get();
        let mut basis = vec![[0.0; NODES]; plane.drive.harmonics().slots()];
        let from = table.node.map(|share| length * (share - 0.5));
        let nodes = plane.nodes(start + 0.5 * length, &from, &mut basis);
        let (sin, cos) = angle.sin_cos();
        let mut panel = Self {
            start,
            length,
            wanted: length,
            turned: guess(&nodes, [cos, sin], length),
            direction: [[cos; NODES], [sin; NODES]],
            first_angle: angle,
            last_angle: angle,
            slip_rate: [0.0; NODES],
            last_slip_rate: 0.0,
            turning: [0.0; NODES],
            restoring: [0.0; NODES],
            nodes,
            basis,
            rate: Vec::new(),
        };
        panel.evaluate([cos, sin]);
        let mut factors = panel.factors();
        let (mut last, mut shrunk) = (f64::INFINITY, 1.0_f64);
        for iteration in 0..STEPS {
            // One matrix serves the first two steps, and as long as they shrink fast.
            if iteration > 1 && (shrunk.is_nan() || shrunk >= SHRINKING) {
                factors = panel.factors();
            }
            let integral = table.integrals(&panel.turning);
            let mut step = panel.turned;
            for (step, integral) in step.iter_mut().zip(&integral) {
                *step -= length * integral;
            }
            factors.solve(&mut step);
            for (turned, step) in panel.turned.iter_mut().zip(&step) {
                *turned -= step;
            }
            let largest = step.iter().fold(0.0_f64, |most, step| most.max(step.abs()));
            if !sum(&step).is_finite() {
                return None;
            }
            panel.evaluate([cos, sin]);
            // What a step leaves is smaller than itself by as much as it was than the one before.
            shrunk = if last.is_finite() { largest / last } else { 1.0 };
            last = largest;
            if largest * shrunk.min(1.0) <= ROUNDING {
                panel.finish(plane);
                return Some(panel);
            }
        }
        None
    }

    /// What is known once φ is.
    #[inline(always)]
    fn finish(&mut self, plane: &Plane<'_>) {
        let [x, y] = &self.nodes.pull_slope;
        let [cos, sin] = &self.direction;
        for i in 0..NODES {
            self.slip_rate[i] = x[i] * cos[i] + y[i] * sin[i] - self.nodes.limit_slope[i];
        }
        self.last_angle = self.first_angle + product(&self.weights(), &self.turning);
        let (sin, cos) = self.last_angle.sin_cos();
        self.last_slip_rate = plane.slip_rate(self.end(), [cos, sin]);
    }

    #[inline(always)]
    fn evaluate(&mut self, [cos, sin]: [f64; 2]) {
        let largest = self.turned.iter().fold(0.0_f64, |most, by| most.max(by.abs()));
        let [own_cos, own_sin] = if largest <= SERIES {
            cos_sin(&self.turned)
        } else {
            [self.turned.map(f64::cos), self.turned.map(f64::sin)]
        };
        let [x, y] = &self.nodes.pull_slope;
        for i in 0..NODES {
            let along = [cos * own_cos[i] - sin * own_sin[i], sin * own_cos[i] + cos * own_sin[i]];
            self.turning[i] = (y[i] * along[0] - x[i] * along[1]) / self.nodes.limit[i];
            self.restoring[i] = -(x[i] * along[0] + y[i] * along[1]) / self.nodes.limit[i];
            (self.direction[0][i], self.direction[1][i]) = (along[0], along[1]);
        }
    }

    /// Factors of the matrix of the collocation, `1 − h A ∂φ'/∂φ`.
    #[inline(always)]
    pub(super) fn factors(&self) -> NodeFactors {
        let mut matrix = Collocation::get().integral;
        for (j, column) in matrix.iter_mut().enumerate() {
            let by = -self.length * self.restoring[j];
            for entry in column.iter_mut() {
                *entry *= by;
            }
            column[j] += 1.0;
        }
        NodeFactors::new(matrix)
    }

    pub(super) fn end(&self) -> f64 {
        self.start + self.length
    }

    /// M at the nodes.
    pub(super) fn limit(&self) -> &Lanes {
        &self.nodes.limit
    }

    /// How far the panel is from being resolved: 1 and below, it is.
    pub(super) fn error(&self, plane: &Plane<'_>, resolved: f64) -> f64 {
        let table = Collocation::get();
        let tail = table
            .tail
            .iter()
            .map(|row| row.iter().zip(&self.turning).map(|(p, g)| p * g).sum::<f64>().abs());
        let largest = self.limit().iter().fold(0.0_f64, |most, m| most.max(m.abs()));
        let error = tail.sum::<f64>() * self.length / NODES as f64 * largest / plane.scale;
        (error / resolved).min(error * self.length / NEGLIGIBLE * RESOLVED / resolved)
    }

    /// Share of the panel after which slip ends, if it does.
    pub(super) fn ends(&self) -> Option<f64> {
        let table = Collocation::get();
        let at = |j: usize| if j < NODES { table.node[j] } else { 1.0 };
        let value = |j: usize| if j < NODES { self.slip_rate[j] } else { self.last_slip_rate };
        let along = |share: f64| table.interpolate(&self.slip_rate, share);
        for j in 0..=NODES {
            if value(j) < 0.0 {
                let low = if j == 0 { 0.0 } else { at(j - 1) };
                return Some(crossing(&along, low, at(j)));
            }
            if j == 0 || j == NODES || value(j) > value(j - 1).min(value(j + 1)) {
                continue;
            }
            // Slip may end and begin again between two nodes.
            let [mut low, mut high] = [at(j - 1), at(j + 1)];
            if value(j) > 0.3 * value(j - 1).max(value(j + 1)) {
                continue;
            }
            for _ in 0..40 {
                let [a, b] = [low + 0.382 * (high - low), high - 0.382 * (high - low)];
                if along(a) < along(b) {
                    high = b;
                } else {
                    low = a;
                }
            }
            if along(low) < 0.0 {
                return Some(crossing(&along, at(j - 1), low));
            }
        }
        None
    }

    /// The direction of the traction at an angle inside.
    pub(super) fn direction(&self, theta: f64) -> [f64; 2] {
        let share = (theta - self.start) / self.length;
        let turned = Collocation::get().interpolate(&self.turned, share);
        let (sin, cos) = (self.first_angle + turned).sin_cos();
        [cos, sin]
    }

    /// Weights of the quadrature over the panel.
    #[inline(always)]
    pub(super) fn weights(&self) -> Lanes {
        Collocation::get().weight.map(|weight| self.length * weight)
    }

    /// `∫ λ`, the way of the slider.
    pub(super) fn way(&self) -> f64 {
        self.weights().iter().zip(&self.slip_rate).map(|(weight, rate)| weight * rate).sum()
    }

    /// `∫ M λ e_i²`, the work of the traction times the stiffness, of both directions.
    pub(super) fn work(&self) -> [f64; 2] {
        let mut work = [0.0; 2];
        for (j, weight) in self.weights().into_iter().enumerate() {
            let rate = weight * self.limit()[j] * self.slip_rate[j].max(0.0);
            work[0] += rate * self.direction[0][j].powi(2);
            work[1] += rate * self.direction[1][j].powi(2);
        }
        work
    }

    /// Adds the integrals of the traction times the basis, direction after direction.
    pub(super) fn add_traction(&self, weights: &Lanes, out: &mut [f64]) {
        let slots = self.basis.len();
        for (direction, out) in self.direction.iter().zip(out.chunks_exact_mut(slots)) {
            let mut traction = [0.0; NODES];
            for i in 0..NODES {
                traction[i] = weights[i] * self.limit()[i] * direction[i];
            }
            for (out, basis) in out.iter_mut().zip(&self.basis) {
                *out += product(&traction, basis);
            }
        }
    }
}

/// A panel to be found.
struct Collocating<'a> {
    plane: &'a Plane<'a>,
    start: f64,
    length: f64,
    angle: f64,
}

impl WithSimd for Collocating<'_> {
    type Output = Option<Panel>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Option<Panel> {
        Panel::collocated(self.plane, self.start, self.length, self.angle)
    }
}

/// Sum of products at the nodes.
#[inline(always)]
pub(super) fn product(a: &Lanes, b: &Lanes) -> f64 {
    let mut terms = *a;
    for i in 0..NODES {
        terms[i] *= b[i];
    }
    sum(&terms)
}

/// How far φ turns up to the nodes as if K'/M were constant between them: half the angle is then that of
/// a vector z which solves `z' = ½ (K'/M) z̄`. A guess is good enough: its functions are short series.
#[inline(always)]
fn guess(nodes: &Nodes, [cos, sin]: [f64; 2], length: f64) -> Lanes {
    let gap = &Collocation::get().gap;
    let [mut along, mut across] = [[0.0; NODES]; 2];
    for i in 0..NODES {
        let [x, y] = [0, 1].map(|n| nodes.pull_slope[n][i] / nodes.limit[i]);
        // Turned so that φ begins at zero.
        (along[i], across[i]) = (x * cos + y * sin, y * cos - x * sin);
    }
    // The change of z by its mirror image, from one node to the next.
    let mut by = [along, across];
    for i in 0..NODES {
        let before = i.saturating_sub(1);
        let mean = [0.5 * (along[before] + along[i]), 0.5 * (across[before] + across[i])];
        let step = 0.5 * length * gap[i];
        // The hyperbolic tangent by its continued fraction.
        let squared = (mean[0] * mean[0] + mean[1] * mean[1]) * step * step;
        let share = ((15.0 + squared) / (15.0 + 6.0 * squared)).min(1.0 / squared.sqrt());
        (by[0][i], by[1][i]) = (step * share * mean[0], step * share * mean[1]);
    }
    let [mut x, mut y] = [[1.0; NODES], [0.0; NODES]];
    let mut z = [1.0_f64, 0.0_f64];
    for i in 0..NODES {
        let [a, b] = [by[0][i], by[1][i]];
        z = [z[0] + a * z[0] + b * z[1], z[1] + b * z[0] - a * z[1]];
        (x[i], y[i]) = (z[0], z[1]);
    }
    let mut turned = [0.0; NODES];
    for i in 0..NODES {
        // A quarter of the angle of z by its tangent.
        let half = y[i] / ((x[i] * x[i] + y[i] * y[i]).sqrt() + x[i]);
        let quarter = half / (1.0 + (1.0 + half * half).sqrt());
        let squared = quarter * quarter;
        turned[i] = 8.0 * quarter * (1.0 - squared * (1.0 / 3.0 - squared * (0.2 - squared / 7.0)));
    }
    turned
}

/// Zero of a function that falls from `low` to `high`: regula falsi (Illinois).
fn crossing(of: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let (mut above, mut below) = (of(low), of(high));
    if above <= 0.0 {
        return low;
    }
    let mut side = 0;
    for _ in 0..60 {
        let middle = (low * below - high * above) / (below - above);
        if high - low <= 1e-12 || middle.is_nan() || middle <= low || middle >= high {
            break;
        }
        let value = of(middle);
        if value > 0.0 {
            (low, above) = (middle, value);
            below *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            (high, below) = (middle, value);
            above *= if side == -1 { 0.5 } else { 1.0 };
            side = -1;
        }
        if value.abs() <= 1e-14 * above.abs().max(below.abs()) {
            return middle;
        }
    }
    0.5 * (low + high)
}
