//! Cholesky's factorisation of a large sparse matrix, for reductions of finite-element models.

use faer::linalg::solvers::Solve as _;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use faer::{Mat, Side};

/// The factor L of `A = L Lᵀ`, in an order that fills in little.
#[derive(Debug, Clone)]
pub struct SparseCholesky {
    factor: Llt<usize, f64>,
    size: usize,
}

impl SparseCholesky {
    /// Of a symmetric matrix by its lower triangle, column by column: where each begins, its rows ascending, its
    /// numbers. Nothing if the matrix is not positive definite, is none, or its factor does not fit into memory.
    #[must_use]
    pub fn new(begins: Vec<usize>, rows: Vec<usize>, numbers: Vec<f64>) -> Option<Self> {
        let size = begins.len().checked_sub(1)?;
        let whole = begins[0] == 0 && begins[size] == rows.len() && rows.len() == numbers.len();
        let ordered = |column: &[usize]| {
            let own = rows.get(column[0]..column[1]);
            own.is_some_and(|own| {
                own.windows(2).all(|pair| pair[0] < pair[1])
                    && own.last().is_none_or(|last| *last < size)
            })
        };
        if !whole || !begins.windows(2).all(ordered) {
            return None;
        }
        let pattern = SymbolicSparseColMat::new_checked(size, size, begins, None, rows);
        let matrix = SparseColMat::new(pattern, numbers);
        let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower).ok()?;
        let factor = Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower).ok()?;
        Some(Self { factor, size })
    }

    /// Rows of the matrix.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// The solutions `A⁻¹ b` of the columns of as many rows.
    #[must_use]
    pub fn solve(&self, mut right: Mat<f64>) -> Mat<f64> {
        self.factor.solve_in_place(right.as_mut());
        right
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain by its lower triangle.
    fn chain(size: usize, own: f64) -> Option<SparseCholesky> {
        let begins = (0..size).map(|j| 2 * j).chain([2 * size - 1]).collect();
        let rows = (0..size).flat_map(|j| [j, j + 1]).take(2 * size - 1).collect();
        let numbers = (0..size).flat_map(|_| [own, -1.0]).take(2 * size - 1).collect();
        SparseCholesky::new(begins, rows, numbers)
    }

    #[test]
    fn solutions_are_those_of_the_matrix() {
        let found = chain(300, 2.5).unwrap().solve(Mat::from_fn(300, 2, |i, j| (i + 7 * j) as f64));
        for j in 0..2 {
            for i in 0..300 {
                let beside = |k: usize| if k < 300 { found[(k, j)] } else { 0.0 };
                let image = 2.5 * found[(i, j)] - beside(i + 1) - beside(i.wrapping_sub(1));
                assert!((image - (i + 7 * j) as f64).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn what_has_no_factor_has_none() {
        assert!(chain(50, 1.0).is_none());
        assert!(SparseCholesky::new(vec![], vec![], vec![]).is_none());
        for (begins, rows) in [
            (vec![0, 1, 2], vec![0, 2]),
            (vec![0, 2, 2], vec![1, 0]),
            (vec![0, 3, 2], vec![0, 1]),
            (vec![0, 1, 1], vec![0, 1]),
        ] {
            assert!(SparseCholesky::new(begins, rows, vec![1.0, 1.0]).is_none());
        }
    }
}
