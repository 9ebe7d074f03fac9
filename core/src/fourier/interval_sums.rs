//! Integrals of cosines and sines over a union of intervals.
//!
//! All products of two basis functions follow from `∫ cos mθ` and `∫ sin mθ`, m ≤ 2H: their matrix
//! is Toeplitz plus Hankel, at O(intervals·H + H²) instead of O(samples·H²).

use super::lanes::{rotate, sum, Lanes, NODES};
use super::Harmonics;
use pulp::{Simd, WithSimd};

/// `C_m = Σ ∫ cos mθ dθ` and `S_m = Σ ∫ sin mθ dθ` over intervals.
#[derive(Debug, Clone, Default)]
pub struct IntervalSums {
    /// Distance between the orders in use: products of odd harmonics have even orders alone.
    step: usize,
    cos: Vec<f64>,
    sin: Vec<f64>,
}

impl IntervalSums {
    /// Empty sums for the products of a set of harmonics.
    #[must_use]
    pub fn new(harmonics: &Harmonics) -> Self {
        let size = 2 * harmonics.highest() + 1;
        Self {
            step: if harmonics.half_wave() { 2 } else { 1 },
            cos: vec![0.0; size],
            sin: vec![0.0; size],
        }
    }

    /// Adds the interval `[start, end]` of angles.
    pub fn add(&mut self, start: f64, end: f64) {
        self.add_weighted(start, end, 1.0);
    }

    /// The same times a weight.
    pub fn add_weighted(&mut self, start: f64, end: f64, weight: f64) {
        self.add_length(weight * (end - start));
        self.add_end(end, weight);
        self.add_end(start, -weight);
    }

    /// Adds the length of an interval, times its weight.
    pub fn add_length(&mut self, length: f64) {
        self.cos[0] += length;
    }

    /// Adds the end of an interval, with its weight; the start with the negative one.
    pub fn add_end(&mut self, theta: f64, weight: f64) {
        let (sin_step, cos_step) = (self.step as f64 * theta).sin_cos();
        let (mut cos, mut sin) = (cos_step, sin_step);
        let mut order = self.step;
        while order < self.cos.len() {
            let share = weight / order as f64;
            self.cos[order] += share * sin;
            self.sin[order] -= share * cos;
            (cos, sin) = (cos * cos_step - sin * sin_step, sin * cos_step + cos * sin_step);
            order += self.step;
        }
    }

    /// Adds an instant, with its weight: a sum over samples in place of an integral.
    pub fn add_instant(&mut self, theta: f64, weight: f64) {
        let (sin_step, cos_step) = (self.step as f64 * theta).sin_cos();
        let (mut cos, mut sin) = (1.0, 0.0);
        for order in (0..self.cos.len()).step_by(self.step) {
            self.cos[order] += weight * cos;
            self.sin[order] += weight * sin;
            (cos, sin) = (cos * cos_step - sin * sin_step, sin * cos_step + cos * sin_step);
        }
    }

    /// Adds instants whose step of angle has these cosines and sines, each with its weight.
    pub(super) fn add_lanes(&mut self, step: &[Lanes; 2], weight: &Lanes) {
        pulp::Arch::new().dispatch(Lanewise { sums: self, step, weight });
    }

    /// `Σ ∫ basis_row basis_column dθ` times a factor, handed to `store(row, column, value)`.
    pub fn products(
        &self,
        harmonics: &Harmonics,
        factor: f64,
        mut store: impl FnMut(usize, usize, f64),
    ) {
        self.rows(harmonics, factor, |row, values| {
            values.iter().enumerate().for_each(|(column, value)| store(row, column, *value));
        });
    }

    /// The same, handed to `visit(row, values)` row by row.
    ///
    /// With `P_m = (C_m, S_m)`, `C_{−m} = C_m` and `S_{−m} = −S_m` the entries of the columns
    /// `cos lθ, sin lθ` are `P_{l+k} + P_{l−k}` in the row of `cos kθ`, and with `Q_m = (S_m, −C_m)`
    /// they are `Q_{l+k} − Q_{l−k}` in that of `sin kθ`, each halved.
    pub fn rows(&self, harmonics: &Harmonics, factor: f64, mut visit: impl FnMut(usize, &[f64])) {
        let Some(first) = harmonics.orders().next() else { return };
        let (count, step) = (harmonics.orders().count(), self.step);
        let negative = harmonics.highest() / step;
        let pair = |at: usize| {
            let order = at.abs_diff(negative) * step;
            let sign = if at < negative { -0.5 } else { 0.5 };
            (0.5 * factor * self.cos[order], sign * factor * self.sin[order])
        };
        let length = negative + (self.cos.len() - 1) / step + 1;
        let (mut p, mut q) = (vec![0.0; 2 * length], vec![0.0; 2 * length]);
        let pairs = p.chunks_exact_mut(2).zip(q.chunks_exact_mut(2));
        for (at, (p, q)) in pairs.enumerate() {
            let (cos, sin) = pair(at);
            (p[0], p[1], q[0], q[1]) = (cos, sin, sin, -cos);
        }
        let mut row = vec![0.0; 2 * count];
        let mut slot = 0;
        for order in harmonics.orders() {
            let sum = 2 * (negative + (order + first) / step);
            let difference = 2 * (negative + first / step - order / step);
            let sum = sum..sum + 2 * count;
            let difference = difference..difference + 2 * count;
            for (of, sign) in [(&p, 1.0), (&q, -1.0)].into_iter().take(1 + order.min(1)) {
                let parts = of[sum.clone()].iter().zip(&of[difference.clone()]);
                row.iter_mut().zip(parts).for_each(|(v, (s, d))| *v = s + sign * d);
                // The mean has no sine.
                let values = if first == 0 {
                    row[1] = row[0];
                    &row[1..]
                } else {
                    &row[..]
                };
                visit(slot, values);
                slot += 1;
            }
        }
    }
}

/// Instants that are added, lane by lane.
struct Lanewise<'a> {
    sums: &'a mut IntervalSums,
    step: &'a [Lanes; 2],
    weight: &'a Lanes,
}

impl WithSimd for Lanewise<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (mut cos, mut sin) = (*self.weight, [0.0; NODES]);
        for order in (0..self.sums.cos.len()).step_by(self.sums.step) {
            self.sums.cos[order] += sum(&cos);
            self.sums.sin[order] += sum(&sin);
            rotate(&mut cos, &mut sin, self.step);
        }
    }
}
