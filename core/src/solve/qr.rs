//! A QR decomposition that follows rank-one changes of its matrix in O(n²).

use faer::MatRef;

/// Orthogonal Q and upper triangular R of a square matrix.
#[derive(Debug, Clone)]
pub struct Qr {
    size: usize,
    /// Q, column after column: a rotation mixes two neighbouring columns.
    q: Vec<f64>,
    /// R, row after row: a rotation mixes two neighbouring rows.
    r: Vec<f64>,
}

/// A plane rotation `[c s; −s c]`.
#[derive(Debug, Clone, Copy)]
struct Rotation {
    cos: f64,
    sin: f64,
}

impl Rotation {
    /// The rotation that takes `(a, b)` to `(r, 0)`, and r.
    fn onto_first(a: f64, b: f64) -> (Self, f64) {
        let r = a.hypot(b);
        if r == 0.0 {
            return (Self { cos: 1.0, sin: 0.0 }, 0.0);
        }
        (Self { cos: a / r, sin: b / r }, r)
    }

    fn apply(self, a: &mut [f64], b: &mut [f64]) {
        for (a, b) in a.iter_mut().zip(b) {
            (*a, *b) = (self.cos * *a + self.sin * *b, self.cos * *b - self.sin * *a);
        }
    }
}

impl Qr {
    /// Decomposes a square matrix.
    #[must_use]
    pub fn new(matrix: MatRef<'_, f64>) -> Self {
        let size = matrix.nrows();
        if (0..size).all(|j| (j + 1..size).all(|i| matrix[(i, j)] == 0.0)) {
            // Triangular as it stands, as the identity of a linear system is.
            let entry = |index: usize| (index / size, index % size);
            let q = (0..size * size).map(entry).map(|(j, i)| f64::from(u8::from(i == j)));
            let r = (0..size * size).map(|index| matrix[entry(index)]);
            return Self { size, q: q.collect(), r: r.collect() };
        }
        let factors = matrix.qr();
        let (orthogonal, upper) = (factors.compute_Q(), factors.R());
        let (mut q, mut r) = (vec![0.0; size * size], vec![0.0; size * size]);
        for j in 0..size {
            for i in 0..size {
                q[j * size + i] = orthogonal[(i, j)];
                r[i * size + j] = if i <= j { upper[(i, j)] } else { 0.0 };
            }
        }
        Self { size, q, r }
    }

    /// Solves `Q R x = rhs`; `false` if R is singular or the solution not finite.
    pub fn solve(&self, rhs: &[f64], x: &mut [f64]) -> bool {
        let size = self.size;
        self.project(rhs, x);
        for i in (0..size).rev() {
            let row = &self.r[i * size..(i + 1) * size];
            let known: f64 = row[i + 1..].iter().zip(&x[i + 1..]).map(|(r, x)| r * x).sum();
            if row[i] == 0.0 {
                return false;
            }
            x[i] = (x[i] - known) / row[i];
        }
        x.iter().all(|x| x.is_finite())
    }

    /// Adds `u vᵀ` to the matrix: `Q (R + w vᵀ)` with `w = Qᵀ u` becomes triangular again by two
    /// sweeps of plane rotations, one that takes w to its first component, and one that clears the
    /// subdiagonal left by it (Golub and Van Loan, "Matrix Computations", 4th ed., 6.5.1).
    pub fn update(&mut self, u: &[f64], v: &[f64]) {
        let size = self.size;
        if size == 0 {
            return;
        }
        let mut w = vec![0.0; size];
        self.project(u, &mut w);
        for i in (0..size - 1).rev() {
            let (rotation, length) = Rotation::onto_first(w[i], w[i + 1]);
            (w[i], w[i + 1]) = (length, 0.0);
            self.rotate(i, i, rotation);
        }
        for (r, v) in self.r[..size].iter_mut().zip(v) {
            *r += w[0] * v;
        }
        for i in 0..size - 1 {
            let (rotation, _) =
                Rotation::onto_first(self.r[i * size + i], self.r[(i + 1) * size + i]);
            self.rotate(i, i, rotation);
            self.r[(i + 1) * size + i] = 0.0;
        }
    }

    /// `out = Qᵀ x`.
    fn project(&self, x: &[f64], out: &mut [f64]) {
        if self.size == 0 {
            return;
        }
        for (out, column) in out.iter_mut().zip(self.q.chunks_exact(self.size)) {
            *out = column.iter().zip(x).map(|(q, x)| q * x).sum();
        }
    }

    /// Rotates rows i and i + 1 of R from column `first` on, and the columns of Q against them.
    fn rotate(&mut self, i: usize, first: usize, rotation: Rotation) {
        let size = self.size;
        let (above, below) = self.r.split_at_mut((i + 1) * size);
        rotation.apply(&mut above[i * size + first..], &mut below[first..size]);
        let (left, right) = self.q.split_at_mut((i + 1) * size);
        rotation.apply(&mut left[i * size..], &mut right[..size]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;

    /// A matrix without structure, from a seeded sequence.
    fn scattered(size: usize, seed: f64) -> Mat<f64> {
        Mat::from_fn(size, size, |i, j| {
            let phase: f64 = seed + 12.9898 * i as f64 + 78.233 * j as f64;
            (4375.85 * phase.sin()).sin()
        })
    }

    #[test]
    fn updates_keep_the_factors_of_the_changed_matrix() {
        for size in [1, 2, 5, 17] {
            let mut matrix = scattered(size, 0.3);
            let mut factors = Qr::new(matrix.as_ref());
            for step in 0..20 {
                let vector = |phase: f64| -> Vec<f64> {
                    (0..size).map(|i| (phase + 3.7 * i as f64 + 1.3 * step as f64).cos()).collect()
                };
                let (u, v) = (vector(0.1), vector(2.0));
                factors.update(&u, &v);
                for i in 0..size {
                    for j in 0..size {
                        matrix[(i, j)] += u[i] * v[j];
                    }
                }
            }
            let q = Mat::from_fn(size, size, |i, j| factors.q[j * size + i]);
            let r = Mat::from_fn(size, size, |i, j| factors.r[i * size + j]);
            let scale = matrix.norm_max();
            assert!((&q * &r - &matrix).norm_max() < 1e-12 * scale);
            let identity = Mat::<f64>::identity(size, size);
            assert!((q.transpose() * &q - identity).norm_max() < 1e-13);
            assert!((0..size).all(|i| (0..i).all(|j| r[(i, j)] == 0.0)));
        }
    }

    #[test]
    fn solutions_satisfy_their_system_and_singular_ones_are_refused() {
        let matrix = scattered(6, 1.1);
        let factors = Qr::new(matrix.as_ref());
        let rhs: Vec<f64> = (0..6).map(|i| 1.0 - 0.4 * i as f64).collect();
        let mut x = vec![0.0; 6];
        assert!(factors.solve(&rhs, &mut x));
        for i in 0..6 {
            let got: f64 = (0..6).map(|j| matrix[(i, j)] * x[j]).sum();
            assert!((got - rhs[i]).abs() < 1e-12);
        }
        assert!(!Qr::new(Mat::zeros(3, 3).as_ref()).solve(&rhs[..3], &mut x[..3]));
    }
}
