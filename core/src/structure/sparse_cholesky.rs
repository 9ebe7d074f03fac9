//! Cholesky's factorisation of a large sparse matrix, for reductions of finite-element models.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::Perm;
use faer::sparse::linalg::cholesky::{
    factorize_symbolic_cholesky, LltRef, SymbolicCholesky, SymmetricOrdering,
};
use faer::sparse::{SparseColMat, SymbolicSparseColMat, SymbolicSparseColMatRef};
use faer::{Conj, Mat, Par, Side};
use feral_metis::{metis_order, CscPattern};

/// Numbers of a factor from which on a search for a better order pays.
const LARGE: usize = 10_000_000;

type Pattern<'a> = SymbolicSparseColMatRef<'a, usize>;

/// Why a matrix has no factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unfactored {
    /// It is not positive definite, or no matrix.
    NotDefinite,
    /// The factor does not fit into memory.
    TooLarge,
}

/// The factor L of `P A Pᵀ = L Lᵀ`, in an order that fills in little.
#[derive(Debug)]
pub struct SparseCholesky {
    pattern: SymbolicCholesky<usize>,
    factor: Vec<f64>,
}

impl SparseCholesky {
    /// Of a symmetric matrix, column by column: where each begins, its rows ascending, its numbers, of which those
    /// above the diagonal are not looked at.
    ///
    /// # Errors
    /// The matrix is not positive definite, or is none, or its factor does not fit into memory.
    pub fn new(
        begins: Vec<usize>,
        rows: Vec<usize>,
        numbers: Vec<f64>,
    ) -> Result<Self, Unfactored> {
        let matrix = lower_triangle(begins, rows, numbers).ok_or(Unfactored::NotDefinite)?;
        let pattern = least_fill(matrix.symbolic()).ok_or(Unfactored::TooLarge)?;
        let mut factor = Vec::new();
        factor.try_reserve_exact(pattern.len_val()).map_err(|_| Unfactored::TooLarge)?;
        factor.resize(pattern.len_val(), 0.0);
        let work = pattern.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut work = MemBuffer::try_new(work).map_err(|_| Unfactored::TooLarge)?;
        let found = pattern.factorize_numeric_llt(
            &mut factor,
            matrix.as_ref(),
            Side::Lower,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut work),
            Default::default(),
        );
        found.map_err(|_| Unfactored::NotDefinite)?;
        Ok(Self { pattern, factor })
    }

    /// Numbers that the factor has, some of them zero.
    #[must_use]
    pub fn numbers(&self) -> usize {
        self.factor.len()
    }

    /// Rows of the matrix.
    #[must_use]
    pub fn size(&self) -> usize {
        self.pattern.nrows()
    }

    /// The solutions `A⁻¹ b` of the columns of as many rows.
    #[must_use]
    pub fn solve(&self, mut right: Mat<f64>) -> Mat<f64> {
        let mut work =
            MemBuffer::new(self.pattern.solve_in_place_scratch::<f64>(right.ncols(), Par::Seq));
        LltRef::new(&self.pattern, &self.factor).solve_in_place_with_conj(
            Conj::No,
            right.as_mut(),
            Par::Seq,
            MemStack::new(&mut work),
        );
        right
    }
}

/// The lower triangle of a matrix, which is dropped: a factor needs the memory. Nothing if places are wrong.
fn lower_triangle(
    begins: Vec<usize>,
    rows: Vec<usize>,
    numbers: Vec<f64>,
) -> Option<SparseColMat<usize, f64>> {
    let size = begins.len().checked_sub(1)?;
    if begins[0] != 0 || begins[size] != rows.len() || rows.len() != numbers.len() {
        return None;
    }
    let (mut ends, mut lower, mut values) = (vec![0], Vec::new(), Vec::new());
    for (column, ends_of) in begins.windows(2).enumerate() {
        let own = rows.get(ends_of[0]..ends_of[1])?;
        if !own.windows(2).all(|pair| pair[0] < pair[1]) || own.last().is_some_and(|&i| i >= size) {
            return None;
        }
        let first = ends_of[0] + own.partition_point(|&row| row < column);
        lower.extend_from_slice(&rows[first..ends_of[1]]);
        values.extend_from_slice(&numbers[first..ends_of[1]]);
        ends.push(lower.len());
    }
    let pattern = SymbolicSparseColMat::new_checked(size, size, ends, None, lower);
    Some(SparseColMat::new(pattern, values))
}

/// The pattern of the factor in the better one of two orders: approximate minimum degree, and nested dissection where
/// the factor is large. Of blocks and plates of elements the second needs half the numbers of the first.
fn least_fill(lower: Pattern<'_>) -> Option<SymbolicCholesky<usize>> {
    let by_degree = filled(lower, SymmetricOrdering::Amd);
    if by_degree.as_ref().is_some_and(|pattern| pattern.len_val() < LARGE) {
        return by_degree;
    }
    let order = nested_dissection(lower);
    let dissected =
        order.as_ref().and_then(|order| filled(lower, SymmetricOrdering::Custom(order.as_ref())));
    by_degree.into_iter().chain(dissected).min_by_key(SymbolicCholesky::len_val)
}

fn filled(
    lower: Pattern<'_>,
    order: SymmetricOrdering<'_, usize>,
) -> Option<SymbolicCholesky<usize>> {
    factorize_symbolic_cholesky(lower, Side::Lower, order, Default::default()).ok()
}

/// An order by which separators come last (Karypis and Kumar, 1998), behind the rows that nothing joins, among which
/// the search would take the square of their number; nothing for more entries than its numbers count.
fn nested_dissection(lower: Pattern<'_>) -> Option<Perm<usize>> {
    let size = lower.ncols();
    let entries = || {
        let column = |j| lower.row_idx_of_col(j).map(move |i| (i, j));
        (0..size).flat_map(column).filter(|(i, j)| i != j)
    };
    let mut degrees = vec![0_i32; size];
    i32::try_from(2 * lower.compute_nnz()).ok()?;
    for (i, j) in entries() {
        degrees[i] += 1;
        degrees[j] += 1;
    }
    let (joined, mut order): (Vec<usize>, Vec<usize>) =
        (0..size).partition(|&row| degrees[row] > 0);
    let (mut numbers, mut begins) = (vec![0; size], vec![0_i32]);
    for (number, &row) in joined.iter().enumerate() {
        numbers[row] = number;
        begins.push(begins[number] + degrees[row]);
    }
    let place = |at: i32| usize::try_from(at).unwrap_or_default();
    let (mut ends, mut rows) = (begins.clone(), vec![0_i32; place(begins[joined.len()])]);
    // Columns of the upper triangle before those of the lower one, so that rows ascend.
    for (one, other) in entries().map(|(i, j)| (j, i)).chain(entries()) {
        let end = &mut ends[numbers[other]];
        rows[place(*end)] = i32::try_from(numbers[one]).ok()?;
        *end += 1;
    }
    let found = metis_order(&CscPattern::new(joined.len(), &begins, &rows)?).ok()?;
    order.extend(found.into_iter().map(|at| joined[place(at)]));
    let mut inverse = vec![0; size];
    for (at, &row) in order.iter().enumerate() {
        inverse[row] = at;
    }
    Some(Perm::new_checked(order.into(), inverse.into(), size))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain by its lower triangle.
    fn chain(size: usize, own: f64) -> Result<SparseCholesky, Unfactored> {
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

    /// A grid by its lower triangle: where columns begin, their rows, their numbers.
    fn grid(side: usize) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
        let (mut begins, mut rows, mut numbers) = (vec![0], Vec::new(), Vec::new());
        for j in 0..side.pow(3) {
            rows.push(j);
            numbers.push(6.0);
            for step in [1, side, side * side] {
                if j / step % side + 1 < side {
                    rows.push(j + step);
                    numbers.push(-1.0);
                }
            }
            begins.push(rows.len());
        }
        (begins, rows, numbers)
    }

    #[test]
    fn nested_dissection_fills_in_less_than_the_order_of_a_grid() {
        let size = 16_usize.pow(3);
        let (begins, rows, numbers) = grid(16);
        let matrix = lower_triangle(begins, rows, numbers).unwrap();
        let order = nested_dissection(matrix.symbolic()).unwrap();
        let numbers = |order| filled(matrix.symbolic(), order).unwrap().len_val();
        let dissected = numbers(SymmetricOrdering::Custom(order.as_ref()));
        let own = Perm::new_checked((0..size).collect(), (0..size).collect(), size);
        assert!(dissected < numbers(SymmetricOrdering::Custom(own.as_ref())));
        let least = least_fill(matrix.symbolic()).unwrap().len_val();
        assert_eq!(least, numbers(SymmetricOrdering::Amd));
    }

    #[test]
    fn large_factors_are_dissected_and_their_solutions_those_of_the_matrix() {
        let (begins, rows, numbers) = grid(36);
        let matrix = lower_triangle(begins.clone(), rows.clone(), numbers.clone()).unwrap();
        let factor = SparseCholesky::new(begins, rows, numbers).unwrap();
        let by_degree = filled(matrix.symbolic(), SymmetricOrdering::Amd).unwrap().len_val();
        assert!(LARGE < by_degree && factor.numbers() < by_degree);
        let right = |i: usize| (i as f64).sin();
        let found = factor.solve(Mat::from_fn(factor.size(), 1, |i, _| right(i)));
        let mut image = vec![0.0; factor.size()];
        for j in 0..factor.size() {
            for (i, &number) in matrix.row_idx_of_col(j).zip(matrix.val_of_col(j)) {
                image[i] += number * found[(j, 0)];
                image[j] += if i == j { 0.0 } else { number * found[(i, 0)] };
            }
        }
        let worst = image.iter().enumerate().map(|(i, x)| (x - right(i)).abs());
        assert!(worst.fold(0.0, f64::max) < 1e-12);
    }

    /// Rows of a diagonal, like those of fixed degrees of freedom, are no part of what is dissected.
    #[test]
    fn rows_that_nothing_joins_come_first() {
        let (size, alone) = (200, |j: usize| j % 4 == 3);
        let rows: Vec<Vec<usize>> = (0..size)
            .map(|j| if j + 4 < size && !alone(j) { vec![j, j + 4] } else { vec![j] })
            .collect();
        let mut begins = vec![0];
        rows.iter().for_each(|own| begins.push(begins[begins.len() - 1] + own.len()));
        let numbers = vec![1.0; begins[size]];
        let matrix = lower_triangle(begins, rows.concat(), numbers).unwrap();
        let order = nested_dissection(matrix.symbolic()).unwrap();
        let (forward, _) = order.arrays();
        assert!(forward[..size / 4].iter().all(|&row| alone(row)));
        assert!(!forward[size / 4..].iter().any(|&row| alone(row)));
    }

    #[test]
    fn what_has_no_factor_has_none() {
        assert_eq!(chain(50, 1.0).err(), Some(Unfactored::NotDefinite));
        assert!(SparseCholesky::new(vec![], vec![], vec![]).is_err());
        for (begins, rows) in [
            (vec![0, 1, 2], vec![0, 2]),
            (vec![0, 2, 2], vec![1, 0]),
            (vec![0, 3, 2], vec![0, 1]),
            (vec![0, 1, 1], vec![0, 1]),
        ] {
            assert!(SparseCholesky::new(begins, rows, vec![1.0, 1.0]).is_err());
        }
    }
}
