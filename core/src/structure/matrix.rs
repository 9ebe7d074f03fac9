//! A real matrix that may hold few numbers.

use faer::sparse::{SparseColMat, Triplet};
use faer::Mat;
use std::ops::{Deref, Index};
use std::sync::OnceLock;

/// A real matrix by its numbers.
pub(super) type Sparse = SparseColMat<usize, f64>;

/// Size, rows times columns, from which on it is worth to look for few numbers.
const LARGE: usize = 1 << 10;
/// Share of the numbers of a matrix up to which it holds few.
const FEW: f64 = 1.0 / 32.0;

/// A real matrix: by its numbers where a large one holds few, as a full one where it holds many or somebody
/// asks for all of them.
#[derive(Debug, Clone)]
pub struct Matrix {
    shape: [usize; 2],
    few: Option<Sparse>,
    full: OnceLock<Mat<f64>>,
}

impl Matrix {
    /// From the numbers that are not zero, each at its row and column once.
    #[must_use]
    pub fn of_entries(rows: usize, columns: usize, entries: &[(usize, usize, f64)]) -> Self {
        if Self::is_few(rows, columns, entries.len()) {
            let triplets: Vec<_> = entries.iter().map(|&(i, j, x)| Triplet::new(i, j, x)).collect();
            if let Ok(few) = Sparse::try_new_from_triplets(rows, columns, &triplets) {
                return Self::of_few(few);
            }
        }
        let mut full = Mat::zeros(rows, columns);
        entries.iter().for_each(|&(i, j, x)| full[(i, j)] = x);
        full.into()
    }

    /// From a sparse matrix.
    pub(super) fn of_few(few: Sparse) -> Self {
        Self { shape: [few.nrows(), few.ncols()], few: Some(few), full: OnceLock::new() }
    }

    /// Whether so many numbers are few for a matrix of a size.
    #[must_use]
    pub fn is_few(rows: usize, columns: usize, count: usize) -> bool {
        rows * columns >= LARGE && count as f64 <= FEW * rows as f64 * columns as f64
    }

    /// Number of rows.
    #[must_use]
    pub fn nrows(&self) -> usize {
        self.shape[0]
    }

    /// Number of columns.
    #[must_use]
    pub fn ncols(&self) -> usize {
        self.shape[1]
    }

    /// All numbers.
    pub(crate) fn into_full(self) -> Mat<f64> {
        let few = self.few.as_ref();
        self.full.into_inner().or_else(|| few.map(Sparse::to_dense)).unwrap_or_else(Mat::new)
    }

    /// The numbers, if they are known to be few.
    pub(super) fn few(&self) -> Option<&Sparse> {
        self.few.as_ref()
    }

    /// Numbers that are not zero, with their rows and columns, column by column.
    pub(crate) fn entries(&self) -> Box<dyn Iterator<Item = (usize, usize, f64)> + '_> {
        if let Some(few) = &self.few {
            return Box::new(few.triplet_iter().map(|one| (one.row, one.col, *one.val)));
        }
        let own = self.col_iter().enumerate();
        Box::new(own.flat_map(|(j, column)| {
            let numbers = column.iter().enumerate();
            numbers.filter(|(_, x)| **x != 0.0).map(move |(i, x)| (i, j, *x))
        }))
    }
}

impl From<Mat<f64>> for Matrix {
    fn from(full: Mat<f64>) -> Self {
        let shape = [full.nrows(), full.ncols()];
        Self { shape, few: few(&full), full: full.into() }
    }
}

/// The numbers of a large matrix, if they are few.
fn few(full: &Mat<f64>) -> Option<Sparse> {
    let (rows, columns) = full.shape();
    let mut triplets = Vec::new();
    for (j, column) in full.col_iter().enumerate() {
        if !Matrix::is_few(rows, columns, triplets.len()) {
            return None;
        }
        let numbers = column.iter().enumerate().filter(|(_, x)| **x != 0.0);
        triplets.extend(numbers.map(|(i, x)| Triplet::new(i, j, *x)));
    }
    Sparse::try_new_from_triplets(rows, columns, &triplets).ok()
}

/// All numbers.
impl Deref for Matrix {
    type Target = Mat<f64>;

    fn deref(&self) -> &Mat<f64> {
        self.full.get_or_init(|| self.few.as_ref().map_or_else(Mat::new, Sparse::to_dense))
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = f64;

    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        match (&self.few, self.full.get()) {
            (Some(few), None) => few.as_ref().get(row, column).unwrap_or(&0.0),
            _ => &(**self)[(row, column)],
        }
    }
}

impl PartialEq for Matrix {
    fn eq(&self, other: &Self) -> bool {
        self.shape == other.shape
            && match (&self.few, &other.few) {
                (Some(_), Some(_)) => self.entries().eq(other.entries()),
                _ => **self == **other,
            }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_numbers_are_those_of_the_full_matrix() {
        let size = 200;
        let entries: Vec<_> = (0..size).map(|i| (i, (7 * i) % size, 1.0 + i as f64)).collect();
        let few = Matrix::of_entries(size, size, &entries);
        let mut full = Mat::zeros(size, size);
        entries.iter().for_each(|&(i, j, x)| full[(i, j)] = x);
        assert!(few.few().is_some() && few.full.get().is_none());
        assert!((0..size).all(|i| (0..size).all(|j| few[(i, j)] == full[(i, j)])));
        // To look at some numbers fills nothing.
        assert!(few.full.get().is_none());
        assert_eq!(*few, full);
        let given = Matrix::from(full.clone());
        assert!(given.few().is_some() && given == few);
        assert_eq!(given.into_full(), full);
        assert_eq!(few.clone().into_full(), full);
        // One number more than few, and what is small.
        let most = size * size / 32;
        let many: Vec<_> = (0..=most).map(|k| (k % size, k / size, 1.0)).collect();
        assert!(Matrix::of_entries(size, size, &many[..most]).few().is_some());
        assert!(Matrix::of_entries(size, size, &many).few().is_none());
        assert!(Matrix::from(Mat::<f64>::identity(20, 20)).few().is_none());
        assert_eq!(Matrix::of_entries(0, 3, &[]).shape(), (0, 3));
    }
}
