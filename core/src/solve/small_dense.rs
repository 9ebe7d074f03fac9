//! Small dense matrices, the blocks of banded systems: a general library spends more on getting
//! started and on aligned memory than these blocks take.

/// A small matrix, row by row.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Block {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Block {
    /// A matrix of zeros.
    #[must_use]
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, values: vec![0.0; rows * columns] }
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

    /// Entries row by row.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Whether every entry is zero.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.values.iter().all(|value| *value == 0.0)
    }

    /// `self −= a b`.
    pub fn subtract_product(&mut self, a: &Self, b: &Self) {
        subtract_product(&mut self.values, &a.values, &b.values, a.columns, b.columns);
    }

    /// `self += other`.
    pub fn add(&mut self, other: &Self) {
        self.values.iter_mut().zip(&other.values).for_each(|(a, b)| *a += b);
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
        if !range.is_empty() {
            let rows = part.values.chunks_exact_mut(range.len());
            for (to, from) in rows.zip(self.values.chunks_exact(self.columns)) {
                to.copy_from_slice(&from[range.clone()]);
            }
        }
        part
    }

    /// Adds a matrix to the columns from `first` on.
    pub fn add_columns(&mut self, first: usize, other: &Self) {
        if other.columns == 0 {
            return;
        }
        let rows = self.values.chunks_exact_mut(self.columns);
        for (to, from) in rows.zip(other.values.chunks_exact(other.columns)) {
            to[first..first + other.columns].iter_mut().zip(from).for_each(|(a, b)| *a += b);
        }
    }

    /// `out −= self x`.
    pub fn subtract_from(&self, x: &[f64], out: &mut [f64]) {
        subtract_product(out, &self.values, x, self.columns, 1);
    }
}

impl std::ops::Index<(usize, usize)> for Block {
    type Output = f64;

    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.values[i * self.columns + j]
    }
}

impl std::ops::IndexMut<(usize, usize)> for Block {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.values[i * self.columns + j]
    }
}

/// LU factors of a square block with row pivoting; those of a singular one are not finite.
#[derive(Debug, Clone, Default)]
pub struct BlockFactors {
    lu: Vec<f64>,
    pivots: Vec<usize>,
}

impl BlockFactors {
    /// Factors a square block.
    #[must_use]
    pub fn new(block: Block) -> Self {
        let (size, mut lu) = (block.rows, block.values);
        let mut pivots = vec![0; size];
        factorise(&mut lu, size, &mut pivots);
        Self { lu, pivots }
    }

    /// Solves in place for all columns of a block.
    pub fn solve(&self, right: &mut Block) {
        solve(&self.lu, self.pivots.len(), &self.pivots, &mut right.values, right.columns);
    }

    /// Solves in place for one right-hand side.
    pub fn solve_vector(&self, right: &mut [f64]) {
        solve(&self.lu, self.pivots.len(), &self.pivots, right, 1);
    }
}

/// `out −= a b`, with a: m × k and b: k × n.
fn subtract_product(out: &mut [f64], a: &[f64], b: &[f64], k: usize, n: usize) {
    if k == 0 || n == 0 {
        return;
    }
    for (out, a) in out.chunks_exact_mut(n).zip(a.chunks_exact(k)) {
        for (a, b) in a.iter().zip(b.chunks_exact(n)) {
            if *a != 0.0 {
                for (out, b) in out.iter_mut().zip(b) {
                    *out -= a * b;
                }
            }
        }
    }
}

/// LU factors of a square matrix with row pivoting, in place; `pivots[i]` is the row swapped with
/// row i. A singular matrix gives factors that are not finite.
fn factorise(a: &mut [f64], size: usize, pivots: &mut [usize]) {
    for i in 0..size {
        let pivot = (i..size)
            .max_by(|&p, &q| a[p * size + i].abs().total_cmp(&a[q * size + i].abs()))
            .unwrap_or(i);
        pivots[i] = pivot;
        if pivot != i {
            for j in 0..size {
                a.swap(i * size + j, pivot * size + j);
            }
        }
        let inverse = 1.0 / a[i * size + i];
        let (above, below) = a.split_at_mut((i + 1) * size);
        let row = &above[i * size..];
        for other in below.chunks_exact_mut(size) {
            let factor = other[i] * inverse;
            other[i] = factor;
            if factor != 0.0 {
                for (x, r) in other[i + 1..].iter_mut().zip(&row[i + 1..]) {
                    *x -= factor * r;
                }
            }
        }
    }
}

/// Solves with the factors for `columns` right-hand sides, size × columns, in place.
fn solve(lu: &[f64], size: usize, pivots: &[usize], right: &mut [f64], columns: usize) {
    // A sector without neighbours has nothing to solve for.
    if columns == 0 {
        return;
    }
    for (i, &pivot) in pivots.iter().enumerate() {
        if pivot != i {
            for j in 0..columns {
                right.swap(i * columns + j, pivot * columns + j);
            }
        }
    }
    for i in 1..size {
        let (above, below) = right.split_at_mut(i * columns);
        eliminate(&mut below[..columns], &lu[i * size..i * size + i], above, columns);
    }
    for i in (0..size).rev() {
        let (above, below) = right.split_at_mut((i + 1) * columns);
        let row = &mut above[i * columns..];
        eliminate(row, &lu[i * size + i + 1..(i + 1) * size], below, columns);
        let inverse = 1.0 / lu[i * size + i];
        row.iter_mut().for_each(|x| *x *= inverse);
    }
}

/// `row −= Σ factors_j rows_j`.
fn eliminate(row: &mut [f64], factors: &[f64], rows: &[f64], columns: usize) {
    for (factor, other) in factors.iter().zip(rows.chunks_exact(columns)) {
        for (x, y) in row.iter_mut().zip(other) {
            *x -= factor * y;
        }
    }
}
