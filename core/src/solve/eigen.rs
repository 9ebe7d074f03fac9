//! Eigenpairs of Hermitian matrices, whatever the unit of their entries.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd;
use faer::traits::ComplexField;
use faer::{Mat, MatRef, Par, Scale, Side};

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
    hermitian_eigen_of(matrix.to_owned())
}

/// The same of a matrix that is not needed any more: with many rows it is memory that one runs out of.
pub fn hermitian_eigen_of<T: ComplexField<Real = f64>>(
    mut matrix: Mat<T>,
) -> Option<(Vec<f64>, Mat<T>)> {
    let unit = unit_of(matrix.as_ref());
    matrix *= Scale(T::from_f64_impl(unit.recip()));
    let size = matrix.nrows();
    let (mut vectors, mut values) = (Mat::zeros(size, size), Diag::zeros(size));
    let need = evd::self_adjoint_evd_scratch::<T>(
        size,
        evd::ComputeEigenvectors::Yes,
        Par::Seq,
        Default::default(),
    );
    let mut room = MemBuffer::try_new(need).ok()?;
    let made = evd::self_adjoint_evd(
        matrix.as_ref(),
        values.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut room),
        Default::default(),
    );
    made.ok()?;
    let values = (0..size).map(|j| unit * T::real_part_impl(&values[j])).collect();
    Some((values, vectors))
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
