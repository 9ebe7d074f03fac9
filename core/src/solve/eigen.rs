//! Eigenpairs of Hermitian matrices, whatever the unit of their entries.

use faer::traits::ComplexField;
use faer::{Mat, MatRef, Scale, Side};

/// Eigenvalues, ascending, and orthonormal eigenvectors of a Hermitian matrix, of which the lower
/// triangle is read; `None` if the iteration does not end.
///
/// Matrices of more than 128 rows are divided and conquered. There faer 0.24 ends the search for a
/// root of the secular equation where its value changes by less than 2e-16, an absolute number: the
/// error of the eigenvalues is 2e-16 a² for entries of size a. So the matrix is first scaled to
/// entries of size 1, as LAPACK does (`dstedc`), by a power of two, which rounds nothing.
pub fn hermitian_eigen<T: ComplexField<Real = f64>>(
    matrix: MatRef<'_, T>,
) -> Option<(Vec<f64>, Mat<T>)> {
    let largest = matrix.norm_max();
    let exponent = if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0) } else { 0.0 };
    let unit = exponent.exp2();
    let eigen = (Scale(T::from_f64_impl(unit.recip())) * matrix).self_adjoint_eigen(Side::Lower);
    let eigen = eigen.ok()?;
    let values = (0..matrix.nrows()).map(|j| unit * T::real_part_impl(&eigen.S()[j])).collect();
    Some((values, eigen.U().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::c64;
    use std::f64::consts::{PI, TAU};

    /// Largest error of the eigenvalues, of `Vᴴ V = I` and of `Vᴴ A V = Λ`, the first and the last
    /// relative to the largest eigenvalue.
    fn errors<T: ComplexField<Real = f64>>(matrix: &Mat<T>, mut exact: Vec<f64>) -> f64 {
        exact.sort_by(f64::total_cmp);
        let (values, vectors) = hermitian_eigen(matrix.as_ref()).unwrap();
        let largest = exact.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let diagonal = |values: &[f64]| {
            let entry = |i, j| if i == j { values[i] } else { 0.0 };
            Mat::from_fn(values.len(), values.len(), |i, j| T::from_f64_impl(entry(i, j)))
        };
        let ones = diagonal(&vec![1.0; values.len()]);
        let scaled = (vectors.adjoint() * (matrix * &vectors) - diagonal(&values)).norm_max();
        let of_values =
            values.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0_f64, f64::max);
        let of_vectors = (vectors.adjoint() * &vectors - ones).norm_max();
        of_vectors.max(scaled / largest).max(of_values / largest)
    }

    #[test]
    fn long_chains_in_any_unit() {
        for (size, stiffness) in [(129, 1e8), (300, 1e7), (300, 3.0), (400, 1e-12), (400, 1e150)] {
            let chain = Mat::from_fn(size, size, |i, j| match i.abs_diff(j) {
                0 => 2.0 * stiffness,
                1 => -stiffness,
                _ => 0.0,
            });
            let angle = |j: usize| PI * (j + 1) as f64 / (size + 1) as f64;
            let exact = (0..size).map(|j| 2.0 * stiffness * (1.0 - angle(j).cos())).collect();
            let error = errors(&chain, exact);
            assert!(error < 1e-13, "{size} masses, {stiffness} N/m: {error:.1e}");
        }
    }

    #[test]
    fn double_eigenvalues_of_rings_real_and_complex() {
        let (size, stiffness) = (240, 1e8);
        for turn in [0.0, 0.7] {
            let ahead = c64::new(0.0, turn).exp() * stiffness;
            let ring = Mat::from_fn(size, size, |i, j| match (j + size - i) % size {
                0 => c64::new(2.1 * stiffness, 0.0),
                1 => -ahead,
                other if other == size - 1 => -ahead.conj(),
                _ => c64::new(0.0, 0.0),
            });
            let angle = |j: usize| TAU * j as f64 / size as f64 + turn;
            let exact: Vec<f64> =
                (0..size).map(|j| stiffness * (2.1 - 2.0 * angle(j).cos())).collect();
            let error = errors(&ring, exact.clone());
            assert!(error < 1e-13, "{error:.1e}");
            if turn == 0.0 {
                let error = errors(&Mat::from_fn(size, size, |i, j| ring[(i, j)].re), exact);
                assert!(error < 1e-13, "{error:.1e}");
            }
        }
    }

    #[test]
    fn nothing_and_one_number() {
        let (values, vectors) = hermitian_eigen(Mat::<f64>::zeros(150, 150).as_ref()).unwrap();
        assert!(values.iter().all(|value| *value == 0.0));
        assert!(
            (vectors.transpose() * &vectors - Mat::<f64>::identity(150, 150)).norm_max() == 0.0
        );
        let one = Mat::from_fn(1, 1, |_, _| -5.0);
        assert_eq!(hermitian_eigen(one.as_ref()).unwrap().0, [-5.0]);
    }
}
