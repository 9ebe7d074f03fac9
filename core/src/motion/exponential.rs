//! The exponential of a matrix.

use faer::Mat;

/// Norm of a matrix to which the truncated exponential is applied.
const SMALL: f64 = 0.5;

/// Exponential of a matrix: Taylor polynomial of degree 15 in blocks of four, scaled and squared.
pub(super) fn exponential(a: &Mat<f64>) -> Mat<f64> {
    let size = a.nrows();
    let norm = a.norm_l2();
    let squarings = (norm / SMALL).log2().ceil().max(0.0);
    let scaled = faer::Scale(0.5_f64.powf(squarings)) * a;
    let second = &scaled * &scaled;
    let third = &second * &scaled;
    let fourth = &second * &second;
    let mut factorials = [1.0; 16];
    for k in 1..16 {
        factorials[k] = factorials[k - 1] / k as f64;
    }
    let block = |first: usize| {
        let mut sum = faer::Scale(factorials[first + 1]) * &scaled
            + faer::Scale(factorials[first + 2]) * &second
            + faer::Scale(factorials[first + 3]) * &third;
        for i in 0..size {
            sum[(i, i)] += factorials[first];
        }
        sum
    };
    let mut value = block(12);
    for first in [8, 4, 0] {
        value = &fourth * &value + block(first);
    }
    for _ in 0..squarings as usize {
        value = &value * &value;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_of_a_rotation_is_exact() {
        let angle = 7.3_f64;
        let a = Mat::from_fn(2, 2, |i, j| angle * (i as f64 - j as f64));
        let e = exponential(&a);
        assert!((e[(0, 0)] - angle.cos()).abs() < 1e-13);
        assert!((e[(1, 0)] - angle.sin()).abs() < 1e-13);
    }
}
