//! Integrals of cosines and sines over a union of intervals.
//!
//! All products of two basis functions follow from `∫ cos mθ` and `∫ sin mθ`, m ≤ 2H: their matrix
//! is Toeplitz plus Hankel, at O(intervals·H + H²) instead of O(samples·H²).

use super::panel::{rotate, Lanes, NODES};
use super::Harmonics;

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
        self.add_length(end - start);
        self.add_end(end, 1.0);
        self.add_end(start, -1.0);
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
    pub(super) fn add_lanes(&mut self, cos_step: &Lanes, sin_step: &Lanes, weight: &Lanes) {
        let (mut cos, mut sin) = (*weight, [0.0; NODES]);
        for order in (0..self.cos.len()).step_by(self.step) {
            self.cos[order] += cos.iter().sum::<f64>();
            self.sin[order] += sin.iter().sum::<f64>();
            rotate(&mut cos, &mut sin, cos_step, sin_step);
        }
    }

    /// `Σ ∫ basis_row basis_column dθ` times a factor, handed to `store(row, column, value)`.
    pub fn products(
        &self,
        harmonics: &Harmonics,
        factor: f64,
        mut store: impl FnMut(usize, usize, f64),
    ) {
        let half = 0.5 * factor;
        let slots = |index: usize| {
            if harmonics.has_mean() {
                (2 * index).saturating_sub(1)
            } else {
                2 * index
            }
        };
        for (i, k) in harmonics.orders().enumerate() {
            let row = slots(i);
            for (j, l) in harmonics.orders().enumerate() {
                let column = slots(j);
                let (sum, difference) = (k + l, k.abs_diff(l));
                let (c_sum, c_diff) = (half * self.cos[sum], half * self.cos[difference]);
                let s_sum = half * self.sin[sum];
                let s_diff = if l >= k { half } else { -half } * self.sin[difference];
                store(row, column, c_diff + c_sum);
                if l > 0 {
                    store(row, column + 1, s_sum + s_diff);
                }
                if k > 0 {
                    store(row + 1, column, s_sum - s_diff);
                    if l > 0 {
                        store(row + 1, column + 1, c_diff - c_sum);
                    }
                }
            }
        }
    }
}
