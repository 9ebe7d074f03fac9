//! Small dense matrices, the blocks of banded systems: a general library spends more on getting
//! started and on aligned memory than these blocks take.

use super::kernels::{self, padded};
use std::ops::{Deref, DerefMut};

/// So many numbers need no memory of their own: those of a block of two rows, and of two beside each
/// other. Rings that are coupled through one DOF have hundreds of them.
const FEW: usize = 16;

/// The numbers of a block.
#[derive(Debug, Clone)]
enum Values {
    Few { count: usize, numbers: [f64; FEW] },
    Many(Vec<f64>),
}

impl Values {
    fn zeros(count: usize) -> Self {
        if count <= FEW {
            Self::Few { count, numbers: [0.0; FEW] }
        } else {
            Self::Many(vec![0.0; count])
        }
    }
}

impl Default for Values {
    fn default() -> Self {
        Self::zeros(0)
    }
}

impl Deref for Values {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        match self {
            Self::Few { count, numbers } => &numbers[..*count],
            Self::Many(numbers) => numbers,
        }
    }
}

impl DerefMut for Values {
    fn deref_mut(&mut self) -> &mut [f64] {
        match self {
            Self::Few { count, numbers } => &mut numbers[..*count],
            Self::Many(numbers) => numbers,
        }
    }
}

impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

/// A small matrix, row by row, each row padded with zeros to whole vectors.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Block {
    rows: usize,
    columns: usize,
    stride: usize,
    values: Values,
}

impl Block {
    /// A matrix of zeros.
    #[must_use]
    pub fn zeros(rows: usize, columns: usize) -> Self {
        let stride = padded(columns);
        Self { rows, columns, stride, values: Values::zeros(rows * stride) }
    }

    /// The identity.
    #[must_use]
    pub fn identity(size: usize) -> Self {
        let mut identity = Self::zeros(size, size);
        for i in 0..size {
            identity[(i, i)] = 1.0;
        }
        identity
    }

    /// Two matrices of as many rows side by side, padding included.
    #[must_use]
    pub(super) fn beside(left: &Self, right: &Self) -> Self {
        let stride = left.stride + right.stride;
        let mut both = Self::zeros(left.rows, stride);
        for i in 0..left.rows {
            let (first, second) = both.row_mut(i).split_at_mut(left.stride);
            first.copy_from_slice(left.row(i));
            second.copy_from_slice(right.row(i));
        }
        both
    }

    /// Numbers per row, padding included.
    #[must_use]
    pub(super) fn stride(&self) -> usize {
        self.stride
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// A row with its padding.
    #[must_use]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.stride..(i + 1) * self.stride]
    }

    /// A row with its padding, which has to stay zero.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.values[i * self.stride..(i + 1) * self.stride]
    }

    /// `self −= a b`.
    pub fn subtract_product(&mut self, a: &Self, b: &Self) {
        let sizes = [a.stride, a.columns, self.stride];
        kernels::subtract_product(&mut self.values, &a.values, &b.values, sizes);
    }

    /// `self += other`.
    pub fn add(&mut self, other: &Self) {
        self.values.iter_mut().zip(&*other.values).for_each(|(a, b)| *a += b);
    }

    /// Adds the columns of `other` from `first` on, a whole number of vectors.
    pub(super) fn add_part(&mut self, other: &Self, first: usize) {
        let rows = self.values.chunks_exact_mut(self.stride.max(1));
        for (to, from) in rows.zip(other.values.chunks_exact(other.stride.max(1))) {
            to.iter_mut().zip(&from[first..]).for_each(|(a, b)| *a += b);
        }
    }

    /// The negative of a product, `−a b`.
    #[must_use]
    pub fn minus_product(a: &Self, b: &Self) -> Self {
        let mut product = Self::zeros(a.rows, b.columns);
        product.subtract_product(a, b);
        product
    }

    /// A part of the columns.
    #[must_use]
    pub fn column_part(&self, range: std::ops::Range<usize>) -> Self {
        let mut part = Self::zeros(self.rows, range.len());
        for i in 0..self.rows {
            part.row_mut(i)[..range.len()].copy_from_slice(&self.row(i)[range.clone()]);
        }
        part
    }

    /// Adds a matrix to the columns from `first` on.
    pub fn add_columns(&mut self, first: usize, other: &Self) {
        for i in 0..other.rows {
            let to = &mut self.row_mut(i)[first..first + other.columns];
            to.iter_mut().zip(other.row(i)).for_each(|(a, b)| *a += b);
        }
    }

    /// `out −= self x`.
    pub fn subtract_from(&self, x: &[f64], out: &mut [f64]) {
        self.subtract_part_from(0, x, out);
    }

    /// `out −= part x` with the columns from `first` on, as many as x has entries.
    pub(super) fn subtract_part_from(&self, first: usize, x: &[f64], out: &mut [f64]) {
        for (row, out) in self.values.chunks_exact(self.stride.max(1)).zip(out) {
            *out -= dot(&row[first..first + x.len()], x);
        }
    }
}

impl std::ops::Index<(usize, usize)> for Block {
    type Output = f64;

    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.values[i * self.stride + j]
    }
}

impl std::ops::IndexMut<(usize, usize)> for Block {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.values[i * self.stride + j]
    }
}

/// LU factors of a square block with row pivoting; those of a singular one are not finite.
#[derive(Debug, Clone, Default)]
pub struct BlockFactors {
    lu: Block,
    pivots: Vec<usize>,
}

impl BlockFactors {
    /// Factors a square block.
    #[must_use]
    pub fn new(mut block: Block) -> Self {
        let mut pivots = vec![0; block.rows];
        kernels::factorise(&mut block.values, block.stride, &mut pivots);
        Self { lu: block, pivots }
    }

    /// Solves in place for all columns of a block.
    pub fn solve(&self, right: &mut Block) {
        // A sector without neighbours has nothing to solve for.
        if right.columns == 0 {
            return;
        }
        let stride = right.stride;
        for (i, &pivot) in self.pivots.iter().enumerate().filter(|(i, p)| i != *p) {
            let (above, below) = right.values.split_at_mut(pivot * stride);
            above[i * stride..(i + 1) * stride].swap_with_slice(&mut below[..stride]);
        }
        let sizes = [self.lu.stride, self.pivots.len(), stride];
        kernels::substitute(&self.lu.values, &mut right.values, sizes);
    }

    /// Solves in place for one right-hand side.
    pub fn solve_vector(&self, right: &mut [f64]) {
        for (i, &pivot) in self.pivots.iter().enumerate() {
            right.swap(i, pivot);
        }
        let size = self.pivots.len();
        for i in 1..size {
            right[i] -= dot(&self.lu.row(i)[..i], &right[..i]);
        }
        for i in (0..size).rev() {
            let row = self.lu.row(i);
            let known = dot(&row[i + 1..size], &right[i + 1..size]);
            right[i] = (right[i] - known) / row[i];
        }
    }
}

/// Scalar product in four sums, which need not wait for each other.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    if a.len() < 4 {
        return a.iter().zip(b).map(|(a, b)| a * b).sum();
    }
    let mut sums = [0.0; 4];
    let (a, b) = (a.chunks_exact(4), b.chunks_exact(4));
    let left: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + left
}
