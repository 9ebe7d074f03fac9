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
    let unit = unit_of(matrix);
    let eigen = (Scale(T::from_f64_impl(unit.recip())) * matrix).self_adjoint_eigen(Side::Lower);
    let eigen = eigen.ok()?;
    let values = (0..matrix.nrows()).map(|j| unit * T::real_part_impl(&eigen.S()[j])).collect();
    Some((values, eigen.U().to_owned()))
}

/// Eigenvalues alone; see [`hermitian_eigen`].
pub fn hermitian_eigenvalues(matrix: MatRef<'_, f64>) -> Option<Vec<f64>> {
    let unit = unit_of(matrix);
    let values = (Scale(unit.recip()) * matrix).self_adjoint_eigenvalues(Side::Lower).ok()?;
    Some(values.into_iter().map(|value| unit * value).collect())
}

/// The power of two next to the largest entry.
fn unit_of<T: ComplexField<Real = f64>>(matrix: MatRef<'_, T>) -> f64 {
    let largest = matrix.norm_max();
    let exponent = if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0) } else { 0.0 };
    exponent.exp2()
}
