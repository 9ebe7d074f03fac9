//! Slip of a Coulomb contact in two directions: the slip equation, by collocation.
//!
//! The traction is `M e(φ)`, `e = (cos φ, sin φ)`. Projecting `K' = t' + λ e` on e and across,
//!
//! ```text
//! M φ' = K'·e⊥,     λ = K'·e − M',
//! ```
//!
//! and slip goes on while λ > 0. The equation is stiff where M is small: φ is locked to the direction
//! of motion. A panel takes φ as the polynomial that satisfies the equation at the nodes of
//! Gauss-Legendre quadrature (Hairer and Wanner 1996, section IV.5), which serve the Fourier
//! integrals as well. The derivative of φ in the coefficients follows from the panel's own matrix.

use super::collocation::{Collocation, NODES};
use super::coulomb_drive::Drive;
use crate::solve::{Block, BlockFactors};

/// Steps of Newton's method for a panel, which starts close and needs three.
const STEPS: usize = 12;
/// Error of φ that counts as none.
const ROUNDING: f64 = 1e-15;
/// Ratio of two steps of Newton's method below which its matrix is kept.
const SHRINKING: f64 = 1e-2;
/// Last coefficients of the polynomial of φ that count as none, relative to the largest limit. Values
/// at the end and integrals are good to the square of this.
pub(super) const RESOLVED: f64 = 2e-10;
/// The same where the end alone matters.
pub(super) const ROUGHLY: f64 = 1e-6;
/// The same for what a panel can add to an integral, whatever its order.
const NEGLIGIBLE: f64 = 1e-13;

/// The series that decide slip, and their values at one angle.
pub(super) struct Plane<'a> {
    pub(super) drive: &'a Drive<'a>,
    /// Series of K', of M and of M', as far as it varies.
    pull_slope: [Vec<f64>; 2],
    limit: Vec<f64>,
    limit_slope: Vec<f64>,
    /// Longest panel.
    pub(super) longest: f64,
    /// Sizes of the limit, which errors are relative to, and of K.
    pub(super) scale: f64,
    pub(super) reach: f64,
}

/// K', M and M' at an angle.
#[derive(Clone, Copy, Default)]
struct Node {
    pull_slope: [f64; 2],
    limit: f64,
    limit_slope: f64,
}

impl<'a> Plane<'a> {
    pub(super) fn new(drive: &'a Drive<'a>) -> Self {
        let harmonics = drive.harmonics();
        let slope = |series: &[f64]| {
            let mut slope = vec![0.0; series.len()];
            for (index, order) in harmonics.oscillating().iter().enumerate() {
                let slot = harmonics.offset() + 2 * index;
                slope[slot] = *order as f64 * series[slot + 1];
                slope[slot + 1] = -(*order as f64) * series[slot];
            }
            slope
        };
        let limit = drive.limit();
        let varies = drive.pressing.is_some();
        let swing: f64 = limit.iter().map(|m| m.abs()).sum();
        Self {
            drive,
            pull_slope: [slope(drive.pull(0)), slope(drive.pull(1))],
            limit_slope: if varies { slope(&limit) } else { vec![0.0] },
            limit,
            // The quadrature has to resolve the highest harmonic.
            longest: (4.0 / harmonics.highest() as f64).min(1.0),
            scale: swing,
            reach: drive.pull.iter().map(|k| k.abs()).sum(),
        }
    }

    fn node(&self, basis: &[f64]) -> Node {
        let dot = |series: &[f64]| series.iter().zip(basis).map(|(s, b)| s * b).sum::<f64>();
        let varies = self.drive.pressing.is_some();
        Node {
            pull_slope: [dot(&self.pull_slope[0]), dot(&self.pull_slope[1])],
            limit: if varies { dot(&self.limit) } else { self.limit[0] },
            limit_slope: if varies { dot(&self.limit_slope) } else { 0.0 },
        }
    }

    fn at(&self, theta: f64) -> Node {
        let mut basis = vec![0.0; self.drive.harmonics().slots()];
        self.drive.harmonics().basis(theta, &mut basis);
        self.node(&basis)
    }

    /// λ at an angle with a direction of the traction.
    pub(super) fn slip_rate(&self, theta: f64, angle: f64) -> f64 {
        let (sin, cos) = angle.sin_cos();
        self.at(theta).slip_rate(cos, sin)
    }
}

impl Node {
    fn slip_rate(&self, cos: f64, sin: f64) -> f64 {
        self.pull_slope[0] * cos + self.pull_slope[1] * sin - self.limit_slope
    }
}

/// A stretch of slip on which φ is one polynomial.
pub(super) struct Panel {
    start: f64,
    length: f64,
    /// As long as a panel might have been here.
    pub(super) wanted: f64,
    /// φ and M at the nodes, and at the end.
    pub(super) angle: [f64; NODES],
    pub(super) limit: [f64; NODES],
    pub(super) last_angle: f64,
    /// λ at the nodes and at the end.
    slip_rate: [f64; NODES],
    last_slip_rate: f64,
    /// φ' at the nodes, and its derivative in φ.
    turning: [f64; NODES],
    restoring: [f64; NODES],
    nodes: [Node; NODES],
    /// Basis at the nodes.
    pub(super) basis: Vec<f64>,
    /// Derivative of φ at the nodes, node after node; nothing if it was not asked for.
    pub(super) rate: Block,
}

impl Panel {
    /// The panel from an angle on; `None` where Newton's method fails.
    pub(super) fn solve(plane: &Plane<'_>, start: f64, length: f64, angle: f64) -> Option<Self> {
        let table = Collocation::get();
        let harmonics = plane.drive.harmonics();
        let slots = harmonics.slots();
        let mut basis = vec![0.0; NODES * slots];
        let mut nodes = [Node::default(); NODES];
        for ((basis, node), share) in basis.chunks_exact_mut(slots).zip(&mut nodes).zip(table.node)
        {
            harmonics.basis(start + share * length, basis);
            *node = plane.node(basis);
        }
        let mut panel = Self {
            start,
            length,
            wanted: length,
            angle: guess(&nodes, angle, length),
            limit: nodes.map(|node| node.limit),
            last_angle: angle,
            slip_rate: [0.0; NODES],
            last_slip_rate: 0.0,
            turning: [0.0; NODES],
            restoring: [0.0; NODES],
            nodes,
            basis,
            rate: Block::default(),
        };
        let mut factors = BlockFactors::default();
        let (mut last, mut shrunk) = (f64::INFINITY, 1.0_f64);
        for _ in 0..STEPS {
            panel.evaluate();
            // One matrix serves as long as the steps shrink fast.
            if shrunk.is_nan() || shrunk >= SHRINKING {
                factors = panel.factors();
            }
            let mut step: [f64; NODES] = std::array::from_fn(|i| {
                let turned = table.integral[i].iter().zip(&panel.turning).map(|(a, g)| a * g);
                panel.angle[i] - angle - length * turned.sum::<f64>()
            });
            factors.solve_vector(&mut step);
            panel.angle.iter_mut().zip(&step).for_each(|(angle, step)| *angle -= step);
            let largest = step.iter().fold(0.0_f64, |most, step| most.max(step.abs()));
            if !largest.is_finite() {
                return None;
            }
            // What a step leaves is smaller than itself by as much as it was than the one before.
            shrunk = if last.is_finite() { largest / last } else { 1.0 };
            last = largest;
            if largest * shrunk.min(1.0) <= ROUNDING {
                panel.evaluate();
                let turned = table.weight.iter().zip(&panel.turning).map(|(b, g)| b * g);
                panel.last_angle = angle + length * turned.sum::<f64>();
                panel.last_slip_rate = plane.slip_rate(start + length, panel.last_angle);
                return Some(panel);
            }
        }
        None
    }

    fn evaluate(&mut self) {
        for (j, node) in self.nodes.iter().enumerate() {
            let (sin, cos) = self.angle[j].sin_cos();
            let [x, y] = node.pull_slope;
            self.turning[j] = (y * cos - x * sin) / node.limit;
            self.restoring[j] = -(x * cos + y * sin) / node.limit;
            self.slip_rate[j] = node.slip_rate(cos, sin);
        }
    }

    /// Factors of the matrix of the collocation, `1 − h A ∂φ'/∂φ`.
    fn factors(&self) -> BlockFactors {
        let table = Collocation::get();
        let mut matrix = Block::identity(NODES);
        for (i, integral) in table.integral.iter().enumerate() {
            let row = matrix.row_mut(i).iter_mut().zip(integral.iter().zip(&self.restoring));
            row.for_each(|(entry, (a, by))| *entry -= self.length * a * by);
        }
        BlockFactors::new(matrix)
    }

    pub(super) fn end(&self) -> f64 {
        self.start + self.length
    }

    /// How far the panel is from being resolved: 1 and below, it is.
    pub(super) fn error(&self, plane: &Plane<'_>, resolved: f64) -> f64 {
        let table = Collocation::get();
        let tail = table
            .tail
            .iter()
            .map(|row| row.iter().zip(&self.turning).map(|(p, g)| p * g).sum::<f64>().abs());
        let largest = self.limit.iter().fold(0.0_f64, |most, m| most.max(m.abs()));
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
        let (sin, cos) = Collocation::get().interpolate(&self.angle, share).sin_cos();
        [cos, sin]
    }

    /// Weights of the quadrature over the panel.
    pub(super) fn weights(&self) -> [f64; NODES] {
        Collocation::get().weight.map(|weight| self.length * weight)
    }

    /// `∫ M λ e_i²`, the work of the traction times the stiffness, of both directions.
    pub(super) fn work(&self) -> [f64; 2] {
        let mut work = [0.0; 2];
        for (j, weight) in self.weights().into_iter().enumerate() {
            let (sin, cos) = self.angle[j].sin_cos();
            let rate = weight * self.limit[j] * self.slip_rate[j].max(0.0);
            work[0] += rate * cos * cos;
            work[1] += rate * sin * sin;
        }
        work
    }

    /// Takes the derivative of φ through the panel. Its columns are the coefficients of K and M, if
    /// `coefficients` are asked for, and others that the panel itself does not depend on.
    pub(super) fn carry(&mut self, drive: &Drive<'_>, coefficients: bool, rate: &mut [f64]) {
        let table = Collocation::get();
        let harmonics = drive.harmonics();
        let slots = harmonics.slots();
        let factors = self.factors();
        // Gain on the start's derivative and on sources at the nodes.
        let mut gain = Block::zeros(NODES, 1 + NODES);
        for (i, integral) in table.integral.iter().enumerate() {
            let row = gain.row_mut(i);
            row[0] = 1.0;
            row[1..=NODES].copy_from_slice(&integral.map(|a| self.length * a));
        }
        factors.solve(&mut gain);
        let mut source = Block::zeros(1 + NODES, rate.len());
        source.row_mut(0)[..rate.len()].copy_from_slice(rate);
        if coefficients {
            let mut slope = vec![0.0; slots];
            for (j, node) in self.nodes.iter().enumerate() {
                let (sin, cos) = self.angle[j].sin_cos();
                let basis = &self.basis[j * slots..(j + 1) * slots];
                differentiated(drive, basis, &mut slope);
                let row = source.row_mut(1 + j);
                for (i, slope) in slope.iter().enumerate() {
                    row[i] = -sin * slope / node.limit;
                    row[slots + i] = cos * slope / node.limit;
                }
                let by_limit = -self.turning[j] / node.limit;
                for (i, basis) in basis[..drive.limit_columns()].iter().enumerate() {
                    let basis = if drive.pressing.is_some() { *basis } else { 1.0 };
                    row[2 * slots + i] = by_limit * basis;
                }
            }
        }
        let mut at_nodes = Block::minus_product(&gain, &source);
        for j in 0..NODES {
            at_nodes.row_mut(j).iter_mut().for_each(|entry| *entry = -*entry);
        }
        for (j, weight) in self.weights().into_iter().enumerate() {
            let by = weight * self.restoring[j];
            let parts = at_nodes.row(j).iter().zip(source.row(1 + j));
            rate.iter_mut().zip(parts).for_each(|(r, (at, own))| *r += by * at + weight * own);
        }
        self.rate = at_nodes;
    }
}

/// The slopes of the basis, from the basis.
pub(super) fn differentiated(drive: &Drive<'_>, basis: &[f64], slope: &mut [f64]) {
    let harmonics = drive.harmonics();
    slope.fill(0.0);
    for (index, order) in harmonics.oscillating().iter().enumerate() {
        let slot = harmonics.offset() + 2 * index;
        slope[slot] = -(*order as f64) * basis[slot + 1];
        slope[slot + 1] = *order as f64 * basis[slot];
    }
}

/// φ at the nodes as if K'/M were constant between them: half the angle is then that of a vector z
/// which solves `z' = ½ (K'/M) z̄`.
fn guess(nodes: &[Node; NODES], angle: f64, length: f64) -> [f64; NODES] {
    let table = Collocation::get();
    let (mut y, mut x) = (0.5 * angle).sin_cos();
    let (mut angle, mut last) = (angle, 0.0);
    std::array::from_fn(|j| {
        let before = &nodes[j.saturating_sub(1)];
        let a = [0, 1].map(|i| {
            0.5 * (before.pull_slope[i] / before.limit + nodes[j].pull_slope[i] / nodes[j].limit)
        });
        let size = a[0].hypot(a[1]);
        let step = length * (table.node[j] - last);
        last = table.node[j];
        let by = if size > 0.0 { (0.5 * size * step).tanh() / size } else { 0.0 };
        let to = [x + by * (a[0] * x + a[1] * y), y + by * (a[1] * x - a[0] * y)];
        angle += 2.0 * (x * to[1] - y * to[0]).atan2(x * to[0] + y * to[1]);
        let norm = to[0].hypot(to[1]);
        (x, y) = (to[0] / norm, to[1] / norm);
        angle
    })
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
