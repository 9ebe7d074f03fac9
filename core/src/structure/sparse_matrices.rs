//! Matrices that hold few numbers, such as those of a chain.

use faer::sparse::linalg::cholesky::factorize_symbolic_cholesky;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use faer::{MatRef, Side};

/// A real matrix by its numbers.
pub(super) type Sparse = SparseColMat<usize, f64>;

/// Share of the numbers of a matrix up to which it holds few.
const FEW: f64 = 1.0 / 32.0;

/// Where any of some matrices of one shape holds a number; nothing if these are many.
pub(super) fn pattern(matrices: &[MatRef<'_, f64>]) -> Option<Vec<(usize, usize)>> {
    let (rows, columns) = (matrices[0].nrows(), matrices[0].ncols());
    let most = (FEW * rows as f64 * columns as f64) as usize;
    let mut places = Vec::new();
    for j in 0..columns {
        let own = matrices.iter().map(|matrix| matrix.col(j)).collect::<Vec<_>>();
        let held = (0..rows).filter(|&i| i == j || own.iter().any(|column| column[i] != 0.0));
        places.extend(held.map(|i| (i, j)));
        if places.len() > most {
            return None;
        }
    }
    Some(places)
}

/// A matrix at the places of a pattern.
pub(super) fn at(places: &[(usize, usize)], matrix: MatRef<'_, f64>) -> Option<Sparse> {
    let entries: Vec<_> = places.iter().map(|&(i, j)| Triplet::new(i, j, matrix[(i, j)])).collect();
    Sparse::try_new_from_triplets(matrix.nrows(), matrix.ncols(), &entries).ok()
}

/// Numbers in the factor of a symmetric matrix.
pub(super) fn fill(matrix: &Sparse) -> Option<usize> {
    let (ordering, parameters) = (Default::default(), Default::default());
    let factor = factorize_symbolic_cholesky(matrix.symbolic(), Side::Lower, ordering, parameters);
    factor.ok().map(|factor| factor.len_val())
}

/// Whether a symmetric matrix is positive definite.
pub(super) fn is_positive(matrix: MatRef<'_, f64>) -> bool {
    let few = pattern(&[matrix]).and_then(|places| at(&places, matrix));
    let Some(few) = few else { return matrix.llt(Side::Lower).is_ok() };
    let symbolic = SymbolicLlt::try_new(few.symbolic(), Side::Lower);
    symbolic.is_ok_and(|own| Llt::try_new_with_symbolic(own, few.as_ref(), Side::Lower).is_ok())
}
