//! Matrices that hold few numbers, such as those of a chain.

use super::matrix::{Matrix, Sparse};
use faer::sparse::linalg::cholesky::factorize_symbolic_cholesky;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::Triplet;
use faer::Side;

/// Where any of some square matrices of one size holds a number, and the diagonal, column by column; nothing if
/// these are many.
pub(super) fn pattern(matrices: &[&Matrix]) -> Option<Vec<(usize, usize)>> {
    let size = matrices[0].nrows();
    let mut places: Vec<(usize, usize)> = (0..size).map(|i| (i, i)).collect();
    for matrix in matrices {
        places.extend(matrix.few()?.triplet_iter().map(|one| (one.col, one.row)));
    }
    places.sort_unstable();
    places.dedup();
    let few = Matrix::is_few(size, size, places.len());
    few.then(|| places.into_iter().map(|(j, i)| (i, j)).collect())
}

/// A matrix at the places of a pattern.
pub(super) fn at(places: &[(usize, usize)], matrix: &Matrix) -> Option<Sparse> {
    let few = matrix.few()?.as_ref();
    let number = |i, j| few.get(i, j).copied().unwrap_or(0.0);
    let entries: Vec<_> = places.iter().map(|&(i, j)| Triplet::new(i, j, number(i, j))).collect();
    Sparse::try_new_from_triplets(matrix.nrows(), matrix.ncols(), &entries).ok()
}

/// Numbers in the factor of a symmetric matrix.
pub(super) fn fill(matrix: &Sparse) -> Option<usize> {
    let (ordering, parameters) = (Default::default(), Default::default());
    let factor = factorize_symbolic_cholesky(matrix.symbolic(), Side::Lower, ordering, parameters);
    factor.ok().map(|factor| factor.len_val())
}

/// Whether a symmetric matrix is positive definite.
pub(super) fn is_positive(matrix: &Matrix) -> bool {
    let few = pattern(&[matrix]).and_then(|places| at(&places, matrix));
    let Some(few) = few else { return matrix.llt(Side::Lower).is_ok() };
    let symbolic = SymbolicLlt::try_new(few.symbolic(), Side::Lower);
    symbolic.is_ok_and(|own| Llt::try_new_with_symbolic(own, few.as_ref(), Side::Lower).is_ok())
}
