//! Integrals of cosines and sines over a union of intervals.
//!
//! All products of two basis functions follow from `∫ cos mθ` and `∫ sin mθ`, m ≤ 2H: their matrix
//! is Toeplitz plus Hankel, at O(intervals·H + H²) instead of O(samples·H²).

use super::Harmonics;

/// `C_m = Σ ∫ cos mθ dθ` and `S_m = Σ ∫ sin mθ dθ` over intervals.
#[derive(Debug, Clone, Default)]
pub struct IntervalSums {
    cos: Vec<f64>,
    sin: Vec<f64>,
}

impl IntervalSums {
    /// Empties the sums and makes room for orders `0..=highest`.
    pub fn reset(&mut self, highest: usize) {
        self.cos.clear();
        self.cos.resize(highest + 1, 0.0);
        self.sin.clear();
        self.sin.resize(highest + 1, 0.0);
    }

    /// Adds the interval `[start, end]` of angles.
    pub fn add(&mut self, start: f64, end: f64) {
        self.cos[0] += end - start;
        self.add_bound(end, 1.0);
        self.add_bound(start, -1.0);
    }

    fn add_bound(&mut self, theta: f64, sign: f64) {
        let (sin_1, cos_1) = theta.sin_cos();
        let (mut cos, mut sin) = (cos_1, sin_1);
        let orders = self.cos.iter_mut().zip(&mut self.sin).enumerate().skip(1);
        for (order, (sum_cos, sum_sin)) in orders {
            let weight = sign / order as f64;
            *sum_cos += weight * sin;
            *sum_sin -= weight * cos;
            (cos, sin) = (cos * cos_1 - sin * sin_1, sin * cos_1 + cos * sin_1);
        }
    }

    /// Length of the union.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.cos[0]
    }

    /// `Σ ∫ basis dθ`, added with a factor to `out`.
    pub fn add_basis(&self, harmonics: &Harmonics, factor: f64, out: &mut [f64]) {
        if harmonics.has_mean() {
            out[0] += factor * self.cos[0];
        }
        for (index, &k) in harmonics.oscillating().iter().enumerate() {
            let slot = harmonics.offset() + 2 * index;
            out[slot] += factor * self.cos[k];
            out[slot + 1] += factor * self.sin[k];
        }
    }

    /// `Σ ∫ basis_row basis_column dθ` times a factor, handed to `store(row, column, value)`.
    /// Rows and columns may keep different harmonics.
    pub fn products(
        &self,
        rows: &Harmonics,
        columns: &Harmonics,
        factor: f64,
        mut store: impl FnMut(usize, usize, f64),
    ) {
        let half = 0.5 * factor;
        for (i, k) in rows.orders().enumerate() {
            let row = if rows.has_mean() && i > 0 {
                2 * i - 1
            } else {
                2 * i
            };
            for (j, l) in columns.orders().enumerate() {
                let column = if columns.has_mean() && j > 0 {
                    2 * j - 1
                } else {
                    2 * j
                };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_agree_with_quadrature() {
        let rows = Harmonics::new(3, false);
        let columns = Harmonics::new(5, true);
        let (start, end) = (0.4, 2.9);
        let mut sums = IntervalSums::default();
        sums.reset(8);
        sums.add(start, end);
        let mut matrix = vec![vec![0.0; columns.slots()]; rows.slots()];
        sums.products(&rows, &columns, 1.0, |i, j, v| matrix[i][j] = v);
        let samples = 4000;
        let h = (end - start) / samples as f64;
        let mut expected = vec![vec![0.0; columns.slots()]; rows.slots()];
        let (mut left, mut right) = (vec![0.0; rows.slots()], vec![0.0; columns.slots()]);
        for n in 0..samples {
            let theta = start + (n as f64 + 0.5) * h;
            rows.basis(theta, &mut left);
            columns.basis(theta, &mut right);
            for (i, a) in left.iter().enumerate() {
                for (j, b) in right.iter().enumerate() {
                    expected[i][j] += h * a * b;
                }
            }
        }
        for (got, want) in matrix.iter().flatten().zip(expected.iter().flatten()) {
            assert!((got - want).abs() < 1e-6, "{got} {want}");
        }
    }
}
