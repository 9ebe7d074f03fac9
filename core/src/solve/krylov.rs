//! GMRES for linear systems whose matrix is known by its products alone (Saad and Schultz 1986).

use super::{dot, norm};

/// Directions after which the basis is begun anew.
const LONGEST_BASIS: usize = 80;

/// Image of a direction, relative to what it was before the others were taken off, that is rounding.
const NOTHING: f64 = 1e-14;

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KrylovSettings {
    /// Residual left, relative to the right-hand side.
    pub tolerance: f64,
    /// Products with the matrix.
    pub max_products: usize,
}

/// Outcome and effort.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KrylovReport {
    /// Residual left, relative to the right-hand side; not a number if the caller has ended it.
    pub residual: f64,
    /// Products with the matrix.
    pub products: usize,
}

/// Solves `A x = rhs` from the x that is given; `product(v, out)` writes A v, or says `false` to end.
pub fn gmres(
    mut product: impl FnMut(&[f64], &mut [f64]) -> bool,
    rhs: &[f64],
    x: &mut [f64],
    settings: KrylovSettings,
) -> KrylovReport {
    let goal = settings.tolerance * norm(rhs);
    let mut report = KrylovReport { residual: 0.0, products: 0 };
    let mut left = rhs.to_vec();
    if x.iter().any(|x| *x != 0.0) {
        let mut image = vec![0.0; x.len()];
        if !product(x, &mut image) {
            return KrylovReport { residual: f64::NAN, ..report };
        }
        report.products += 1;
        left.iter_mut().zip(&image).for_each(|(left, a)| *left -= a);
    }
    loop {
        let before = norm(&left);
        report.residual = before / norm(rhs).max(f64::MIN_POSITIVE);
        // What is not a number stays so.
        if before <= goal || report.products >= settings.max_products || !before.is_finite() {
            return report;
        }
        let room = (settings.max_products - report.products).min(LONGEST_BASIS);
        let Some(basis) = Basis::grown(&mut product, &left, goal, room) else {
            return KrylovReport { residual: f64::NAN, ..report };
        };
        report.products += basis.steps();
        basis.correct(x, &mut left);
        if norm(&left) >= before {
            report.residual = norm(&left) / norm(rhs);
            return report;
        }
    }
}

/// An orthonormal basis of the Krylov space, and the matrix in it, turned to triangular form.
struct Basis {
    vectors: Vec<Vec<f64>>,
    /// Columns of R.
    triangle: Vec<Vec<f64>>,
    /// Cosines and sines of the rotations.
    rotations: Vec<[f64; 2]>,
    /// The residual in the basis, rotated.
    right: Vec<f64>,
}

impl Basis {
    /// Grows a basis from a residual until what is left falls to `goal`; nothing if the caller ends it.
    fn grown(
        product: &mut impl FnMut(&[f64], &mut [f64]) -> bool,
        residual: &[f64],
        goal: f64,
        most: usize,
    ) -> Option<Self> {
        let size = norm(residual);
        let first = residual.iter().map(|r| r / size).collect();
        let mut basis = Self {
            vectors: vec![first],
            triangle: Vec::new(),
            rotations: Vec::new(),
            right: vec![size],
        };
        for _ in 0..most {
            let mut next = vec![0.0; residual.len()];
            if !product(&basis.vectors[basis.vectors.len() - 1], &mut next) {
                return None;
            }
            let grows = basis.include(next);
            let left = basis.right[basis.right.len() - 1].abs();
            if left <= goal || !grows {
                break;
            }
        }
        Some(basis)
    }

    fn steps(&self) -> usize {
        self.triangle.len()
    }

    /// Adds the image of the last direction; whether it leads out of the space.
    fn include(&mut self, mut image: Vec<f64>) -> bool {
        let before = norm(&image);
        let mut column = vec![0.0; self.vectors.len()];
        let (vectors, shares) = (&self.vectors, &mut column);
        pulp::Arch::new().dispatch(Orthogonalised { vectors, image: &mut image, shares });
        let rest = norm(&image);
        for (i, [cos, sin]) in self.rotations.iter().enumerate() {
            let (a, b) = (column[i], column[i + 1]);
            (column[i], column[i + 1]) = (cos * a + sin * b, cos * b - sin * a);
        }
        let last = column.len() - 1;
        let length = column[last].hypot(rest);
        // What the matrix takes to nothing leaves the residual as it is.
        let nothing = length <= NOTHING * before;
        let [cos, sin] = if nothing { [0.0, 1.0] } else { [column[last] / length, rest / length] };
        column[last] = if nothing { 0.0 } else { length };
        let right = self.right[last];
        self.right[last] = cos * right;
        self.right.push(-sin * right);
        self.rotations.push([cos, sin]);
        self.triangle.push(column);
        image.iter_mut().for_each(|w| *w /= rest);
        self.vectors.push(image);
        rest > NOTHING * before
    }

    /// Adds the least-squares solution to x, and leaves its residual.
    fn correct(mut self, x: &mut [f64], residual: &mut [f64]) {
        let steps = self.steps();
        let mut shares = self.right[..steps].to_vec();
        for i in (0..steps).rev() {
            // A direction that the matrix takes to nothing has no share.
            let pivot = self.triangle[i][i];
            shares[i] = if pivot == 0.0 { 0.0 } else { shares[i] / pivot };
            for j in 0..i {
                shares[j] -= self.triangle[i][j] * shares[i];
            }
        }
        for (share, vector) in shares.iter().zip(&self.vectors) {
            x.iter_mut().zip(vector).for_each(|(x, v)| *x += share * v);
        }
        // The residual in the basis, rotated back.
        let mut left = vec![0.0; steps + 1];
        left[steps] = self.right[steps];
        for i in (0..steps).rev() {
            let [cos, sin] = self.rotations[i];
            (left[i], left[i + 1]) =
                (cos * left[i] - sin * left[i + 1], sin * left[i] + cos * left[i + 1]);
        }
        let closed = self.vectors[steps].iter().any(|v| !v.is_finite());
        if closed {
            self.vectors.pop();
        }
        residual.fill(0.0);
        for (share, vector) in left.iter().zip(&self.vectors) {
            residual.iter_mut().zip(vector).for_each(|(r, v)| *r += share * v);
        }
    }
}

/// Takes off an image what it shares with vectors. A closure would be no part of what vector instructions are
/// chosen for.
struct Orthogonalised<'a> {
    vectors: &'a [Vec<f64>],
    image: &'a mut [f64],
    shares: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Orthogonalised<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        // Twice is enough (Kahan and Parlett).
        for _ in 0..2 {
            for (entry, vector) in self.shares.iter_mut().zip(self.vectors) {
                let share = dot(vector, self.image);
                self.image.iter_mut().zip(vector).for_each(|(w, v)| *w -= share * v);
                *entry += share;
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// An unsymmetric matrix, well conditioned.
    fn entry(i: usize, j: usize) -> f64 {
        f64::from(u8::from(i == j)) * (2.0 + (i as f64 * 0.3).sin())
            + 0.3 * ((i * 7 + 3 * j) as f64).sin() / (1.0 + (i as f64 - j as f64).abs())
    }

    fn times(v: &[f64], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = v.iter().enumerate().map(|(j, v)| entry(i, j) * v).sum();
        }
    }

    #[test]
    fn solves_to_the_tolerance_from_any_start() {
        let size = 60;
        let exact: Vec<f64> = (0..size).map(|i| (i as f64).cos()).collect();
        let mut rhs = vec![0.0; size];
        times(&exact, &mut rhs);
        for start in [0.0, 0.7] {
            for tolerance in [1e-3, 1e-12] {
                let mut x = vec![start; size];
                let settings = KrylovSettings { tolerance, max_products: 500 };
                let report = gmres(
                    |v, out| {
                        times(v, out);
                        true
                    },
                    &rhs,
                    &mut x,
                    settings,
                );
                let mut image = vec![0.0; size];
                times(&x, &mut image);
                let left: Vec<f64> = image.iter().zip(&rhs).map(|(a, b)| a - b).collect();
                assert!(norm(&left) <= 1.01 * tolerance * norm(&rhs), "{report:?}");
                assert!((norm(&left) / norm(&rhs) - report.residual).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_space_that_closes_gives_the_solution_and_a_singular_matrix_none() {
        // Two eigenvalues: two directions hold the solution.
        let product = |v: &[f64], out: &mut [f64]| {
            out.iter_mut()
                .zip(v)
                .enumerate()
                .for_each(|(i, (o, v))| *o = (1.0 + (i % 2) as f64) * v);
            true
        };
        let rhs: Vec<f64> = (1..=10).map(f64::from).collect();
        let settings = KrylovSettings { tolerance: 1e-14, max_products: 50 };
        let mut x = vec![0.0; 10];
        let report = gmres(product, &rhs, &mut x, settings);
        assert!(report.products <= 4, "{report:?}");
        for (i, x) in x.iter().enumerate() {
            assert!((x - rhs[i] / (1.0 + (i % 2) as f64)).abs() < 1e-12);
        }
        let singular = |v: &[f64], out: &mut [f64]| {
            out.copy_from_slice(v);
            out[3] = 0.0;
            true
        };
        let mut x = vec![0.0; 10];
        let report = gmres(singular, &rhs, &mut x, settings);
        assert!(report.residual > 0.1 && x.iter().all(|x| x.is_finite()), "{report:?}");
    }

    #[test]
    fn ends_when_the_caller_does() {
        let mut calls = 0;
        let product = |v: &[f64], out: &mut [f64]| {
            calls += 1;
            times(v, out);
            calls < 3
        };
        let settings = KrylovSettings { tolerance: 1e-12, max_products: 50 };
        let report = gmres(product, &[1.0; 20], &mut [0.0; 20], settings);
        assert!(report.residual.is_nan());
        assert_eq!(calls, 3);
    }
}
