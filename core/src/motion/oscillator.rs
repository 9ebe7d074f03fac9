//! The exponential of equations of the second order, `η'' + C η' + K η = r` with constant r, by products of
//! matrices of half their size.
//!
//! A function f of `A = [[0, 1], [−K, −C]]` commutes with it, so that its blocks P, Q above and `R = −Q K`,
//! `S = P − Q C` below follow from the upper ones. What constant inputs do is the block V in the place of Q of
//! `(f − f(0)) / A`, which gives `P = f(0) − V K`. Where K is symmetric and C is diagonal, Q, S and V are symmetric
//! (reciprocity), and products of functions have, with `W = S + Q C / 2`,
//!
//! ```text
//! Q = W_f Q_g + (W_g Q_f)ᵀ,    V = P_f V_g + Q_f Q_g + g(0) V_f.
//! ```
//!
//! Displacements of a slow mode from those of a fast one are large in P, and S is their small difference: it is
//! taken from across the diagonal, where both are small. Else every product would multiply what rounding leaves
//! there by the ratio of the rates.

use super::damping::Damping;
use super::exponential::{exponential, sum_of, Driven, Function};
use crate::solve::{multiply, scaled_square, settle};
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, Mat, MatRef, Par};

/// Difference of entries across the diagonal, relative to those on it, that is rounding.
const SYMMETRIC: f64 = 1e-14;
/// Product of the sizes of V and K per mode up to which P, f(0) less the product of both, keeps its digits.
const MOST: f64 = 1e3;

/// The equations, in a unit of time that is the duration.
pub(super) struct Oscillator {
    stiffness: Mat<f64>,
    damping: Vec<f64>,
    /// Units of the displacements that make them as large as velocities, from the least on.
    scale: Vec<f64>,
    /// The modes in this order.
    order: Vec<usize>,
}

/// A function of their matrix.
struct Blocks<'a> {
    of: &'a Oscillator,
    at_zero: f64,
    p: Mat<f64>,
    q: Mat<f64>,
    v: Mat<f64>,
}

impl Oscillator {
    /// Of `K / s` over a duration; nothing where K is not symmetric, or C couples modes.
    pub(super) fn new(
        stiffness: &Mat<f64>,
        scale: &[f64],
        damping: &Damping,
        duration: f64,
    ) -> Option<Self> {
        let Damping::Diagonal(damping) = damping else { return None };
        let size = scale.len();
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|a, b| scale[*a].total_cmp(&scale[*b]));
        let mut own = Mat::zeros(size, size);
        for (j, &at) in order.iter().enumerate() {
            let column = stiffness.col_as_slice(at);
            let factor = duration * duration * scale[at];
            let to = own.col_as_slice_mut(j).iter_mut().zip(&order);
            to.for_each(|(to, from)| *to = factor * column[*from]);
        }
        let roots: Vec<f64> = (0..size).map(|j| own[(j, j)].abs().sqrt()).collect();
        for j in 0..size {
            for i in 0..j {
                let (k, across) = (own[(i, j)], own[(j, i)]);
                if (k - across).abs() > SYMMETRIC * roots[i] * roots[j] {
                    return None;
                }
                own[(j, i)] = k;
            }
        }
        let damping = order.iter().map(|&j| duration * damping[j]).collect();
        let scale = order.iter().map(|&j| duration * scale[j]).collect();
        Some(Self { stiffness: own, damping, scale, order })
    }

    /// A, without a scale.
    fn matrix(&self) -> Blocks<'_> {
        let size = self.scale.len();
        let [p, v] = [(); 2].map(|()| Mat::zeros(size, size));
        Blocks { of: self, at_zero: 0.0, p, q: Mat::identity(size, size), v }
    }

    /// The square of A.
    fn square(&self) -> Blocks<'_> {
        let size = self.scale.len();
        let mut q = Mat::zeros(size, size);
        self.damping.iter().enumerate().for_each(|(j, c)| q[(j, j)] = -c);
        let p = faer::Scale(-1.0) * &self.stiffness;
        Blocks { of: self, at_zero: 0.0, p, q, v: Mat::identity(size, size) }
    }

    /// The exponential in the coordinates `(s η, η')` behind the duration, with what the inputs add whose
    /// accelerations are `input`; nothing where it would lose digits.
    pub(super) fn exponential(&self, input: &Mat<f64>, duration: f64) -> Option<Driven> {
        let size = self.scale.len();
        let own = exponential(&self.matrix(), self.square(), Blocks::times_a);
        let parts = self.size_of(&own.v, 1) * self.size_of(&self.stiffness, -1);
        if parts > MOST * size as f64 {
            return None;
        }
        let lower = own.lower();
        let speed = own.speed(0.0);
        let mut rows = Mat::zeros(2 * size, 2 * size + input.ncols());
        for (j, (s, &at)) in self.scale.iter().zip(&self.order).enumerate() {
            let places = || self.scale.iter().zip(&self.order);
            let (up, down) = rows.col_as_slice_mut(at).split_at_mut(size);
            let parts = own.p.col_as_slice(j).iter().zip(lower.col_as_slice(j));
            for ((p, r), (own, &to)) in parts.zip(places()) {
                (up[to], down[to]) = (own / s * p, r / s);
            }
            let (up, down) = rows.col_as_slice_mut(size + at).split_at_mut(size);
            let parts = own.q.col_as_slice(j).iter().zip(speed.col_as_slice(j));
            for ((q, speed), (own, &to)) in parts.zip(places()) {
                (up[to], down[to]) = (own * q, *speed);
            }
        }
        let mut inputs = Mat::zeros(size, input.ncols());
        for j in 0..input.ncols() {
            let to = inputs.col_as_slice_mut(j).iter_mut().zip(&self.order);
            to.for_each(|(to, from)| *to = duration * input[(*from, j)]);
        }
        let (up, down) = (product(&own.v, &inputs), product(&own.q, &inputs));
        for j in 0..input.ncols() {
            let (above, below) = rows.col_as_slice_mut(2 * size + j).split_at_mut(size);
            let parts = up.col_as_slice(j).iter().zip(down.col_as_slice(j));
            for ((v, q), (own, &to)) in parts.zip(self.scale.iter().zip(&self.order)) {
                (above[to], below[to]) = (own * v, *q);
            }
        }
        Some(Driven { rows, kept: 1.0 })
    }

    /// Size of a matrix whose rows and columns are in a power of the units of displacements.
    fn size_of(&self, matrix: &Mat<f64>, power: i32) -> f64 {
        let scale: Vec<f64> = self.scale.iter().map(|s| s.powi(power)).collect();
        let squares = pulp::Arch::new().dispatch(Squares { own: matrix, scale: &scale });
        squares.iter().zip(&scale).map(|(square, s)| s * s * square).sum::<f64>().sqrt()
    }
}

impl Blocks<'_> {
    /// R.
    fn lower(&self) -> Mat<f64> {
        faer::Scale(-1.0) * product(&self.q, &self.of.stiffness)
    }

    /// `S + share Q C`.
    fn speed(&self, share: f64) -> Mat<f64> {
        let size = self.p.nrows();
        let mut out = Mat::zeros(size, size);
        for (j, c) in self.of.damping.iter().enumerate() {
            // The entries from slow to fast modes.
            let parts = self.p.col_as_slice(j)[j..].iter().zip(&self.q.col_as_slice(j)[j..]);
            let own = out.col_as_slice_mut(j)[j..].iter_mut();
            own.zip(parts).for_each(|(own, (p, q))| *own = p - c * q);
        }
        mirror(&mut out);
        for (j, c) in self.of.damping.iter().enumerate().filter(|_| share != 0.0) {
            let parts = out.col_as_slice_mut(j).iter_mut().zip(self.q.col_as_slice(j));
            parts.for_each(|(own, q)| *own += share * c * q);
        }
        out
    }

    /// The product with A: its upper rows are the lower ones.
    fn times_a(&self) -> Self {
        let (p, q, v) = (self.lower(), self.speed(0.0), self.q.clone());
        Self { of: self.of, at_zero: 0.0, p, q, v }
    }

    /// The product with another function, from the lower half of Q. Of V, which is symmetric too, the entries from
    /// slow to fast modes are taken.
    fn joined(&self, other: &Self, mut q: Mat<f64>) -> Self {
        let size = self.p.nrows();
        mirror(&mut q);
        let mut v = Mat::zeros(size, size);
        add_half(&mut v, &self.p, other.v.as_ref());
        add_half(&mut v, &self.q, other.q.as_ref());
        mirror(&mut v);
        if other.at_zero != 0.0 {
            v = sum_of([1.0, other.at_zero], [&v, &self.v]);
        }
        let at_zero = self.at_zero * other.at_zero;
        let mut p = Mat::zeros(size, size);
        (0..size).for_each(|j| p[(j, j)] = at_zero);
        let stiffness = self.of.stiffness.as_ref();
        multiply(p.as_mut(), Accum::Add, v.as_ref(), stiffness, -1.0);
        Self { of: self.of, at_zero, p, q, v }
    }
}

fn product(one: &Mat<f64>, other: &Mat<f64>) -> Mat<f64> {
    let mut out = Mat::zeros(one.nrows(), other.ncols());
    multiply(out.as_mut(), Accum::Replace, one.as_ref(), other.as_ref(), 1.0);
    out
}

/// Adds the lower half of a product.
fn add_half(half: &mut Mat<f64>, one: &Mat<f64>, other: MatRef<'_, f64>) {
    let [lower, whole] = [BlockStructure::TriangularLower, BlockStructure::Rectangular];
    let one = one.as_ref();
    triangular::matmul(half.as_mut(), lower, Accum::Add, one, whole, other, whole, 1.0, Par::Seq);
    settle();
}

/// Completes a symmetric matrix by its lower half.
fn mirror(own: &mut Mat<f64>) {
    for j in 0..own.ncols() {
        for i in 0..j {
            own[(i, j)] = own[(j, i)];
        }
    }
}

impl Function for Blocks<'_> {
    fn times(&self, other: &Self) -> Self {
        let mut q = Mat::zeros(self.q.nrows(), self.q.ncols());
        add_half(&mut q, &self.speed(0.5), other.q.as_ref());
        add_half(&mut q, &self.q, other.speed(0.5).transpose());
        self.joined(other, q)
    }

    fn squared(&self) -> Self {
        let mut q = product(&self.speed(0.5), &self.q);
        for j in 0..q.ncols() {
            for i in j..q.nrows() {
                q[(i, j)] += q[(j, i)];
            }
        }
        self.joined(self, q)
    }

    fn combined<const N: usize>(constant: f64, factors: [f64; N], functions: [&Self; N]) -> Self {
        let at_zero = factors.iter().zip(functions).map(|(factor, own)| factor * own.at_zero);
        let mut p = sum_of(factors, functions.map(|own| &own.p));
        (0..p.ncols()).for_each(|j| p[(j, j)] += constant);
        Self {
            of: functions[0].of,
            at_zero: constant + at_zero.sum::<f64>(),
            p,
            q: sum_of(factors, functions.map(|own| &own.q)),
            v: sum_of(factors, functions.map(|own| &own.v)),
        }
    }

    /// The lower blocks are as large as the upper ones, but for what springs couple.
    fn norm(&self) -> f64 {
        let scale = &self.of.scale;
        let upper = [&self.p, &self.q].map(|own| Squares { own, scale });
        let [p, q] = upper.map(|own| pulp::Arch::new().dispatch(own));
        let held = p.iter().zip(scale).map(|(p, s)| p / (s * s));
        (2.0 * (held.sum::<f64>() + q.iter().sum::<f64>())).sqrt()
    }
}

/// Squared sizes of the columns of a matrix whose rows are scaled. A closure would be no part of what vector
/// instructions are chosen for.
struct Squares<'a> {
    own: &'a Mat<f64>,
    scale: &'a [f64],
}

impl pulp::NullaryFnOnce for Squares<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn call(self) -> Vec<f64> {
        let columns = (0..self.own.ncols()).map(|j| self.own.col_as_slice(j));
        columns.map(|column| scaled_square(column, self.scale)).collect()
    }
}
