//! Mass, damping and stiffness.

use super::contact_shapes::SparseRows;
use super::massless::{substitute, trace, without_mass, StuckModes};
use super::matrix::{Matrix, Sparse};
use super::sparse_matrices::is_positive;
use crate::Error;
use faer::sparse::Triplet;
use faer::{Mat, MatRef};

/// Asymmetry, relative to the largest entry, that printed digits may leave in a matrix.
const ASYMMETRY: f64 = 1e-8;
/// Rows and columns of a tile.
const TILE: usize = 32;
/// Rounding of the stiffest mode, over the structure's own stiffness, that leaves three digits of this.
const HIDDEN: f64 = 1e-3;
/// Contacts from which on the numbers in their rows are counted.
const MANY: usize = 24;

/// The matrices of a linear structure; mass and stiffness symmetric, damping any.
#[derive(Debug, Clone)]
pub struct Structure {
    mass: Matrix,
    damping: Matrix,
    stiffness: Matrix,
    proportional: bool,
    /// DOFs without mass, which have a substitute in the matrix.
    massless: Vec<usize>,
}

impl Structure {
    /// A structure from its N × N matrices [kg, kg/s, N/m].
    ///
    /// # Errors
    /// Wrong shapes, entries that are not finite, mass or stiffness not symmetric, mass not
    /// positive definite.
    pub fn new(
        mass: MatRef<'_, f64>,
        damping: MatRef<'_, f64>,
        stiffness: MatRef<'_, f64>,
    ) -> Result<Self, Error> {
        Self::of(mass.to_owned(), damping.to_owned(), stiffness.to_owned())
    }

    /// The same of matrices that it may keep.
    ///
    /// # Errors
    /// As [`Structure::new`].
    pub fn of(
        mass: impl Into<Matrix>,
        damping: impl Into<Matrix>,
        stiffness: impl Into<Matrix>,
    ) -> Result<Self, Error> {
        let (mass, damping, stiffness) = (mass.into(), damping.into(), stiffness.into());
        let size = mass.nrows();
        for (entry, matrix) in [("mass", &mass), ("damping", &damping), ("stiffness", &stiffness)] {
            if (matrix.nrows(), matrix.ncols()) != (size, size) || size == 0 {
                return Err(Error::shape(
                    entry,
                    "square matrices of one size",
                    format!("{} x {}", matrix.nrows(), matrix.ncols()),
                ));
            }
            if let Some((i, j, x)) = matrix.entries().find(|(_, _, x)| !x.is_finite()) {
                let remedy = "every entry must be finite";
                return Err(Error::value(format!("{entry}[{i}, {j}]"), x, remedy));
            }
        }
        let massless = without_mass(&(0..size).map(|i| mass[(i, i)]).collect::<Vec<_>>());
        let mut mass = symmetric("mass", mass)?;
        let stiffness = symmetric("stiffness", stiffness)?;
        if !massless.is_empty() {
            let mut full = mass.into_full();
            trace(&mut full, &massless);
            mass = full.into();
        }
        if !is_positive(&mass) {
            return Err(Error::IndefiniteMass);
        }
        Ok(Self { mass, damping, stiffness, proportional: false, massless })
    }

    /// The same structure, `proportional` if a law made its damping, such as `C = a M + b K` or
    /// given ratios of its modes, so that it couples none of the modes without contacts. Of a matrix
    /// rounding decides whether it does.
    #[must_use]
    pub fn with_law(self, proportional: bool) -> Self {
        Self { proportional, ..self }
    }

    /// The same structure, held by the contacts of these rows, with substitutes for masses that are none:
    /// what moves in time needs some.
    #[must_use]
    pub(crate) fn held_by(mut self, rows: &Matrix, contact_stiffness: &Matrix) -> Self {
        if !self.massless.is_empty() {
            let restrained = self.restrained_stiffness(rows, contact_stiffness);
            let own: Vec<f64> = (0..self.dofs()).map(|i| restrained[(i, i)]).collect();
            let mut mass = self.mass.into_full();
            substitute(&mut mass, &self.massless, &own);
            self.mass = mass.into();
        }
        self
    }

    /// The same structure, where these DOFs have no mass but a substitute.
    #[must_use]
    pub(crate) fn with_massless(self, massless: Vec<usize>) -> Self {
        Self { massless, ..self }
    }

    /// DOFs without mass: the contacts alone decide how they move.
    #[must_use]
    pub fn massless(&self) -> &[usize] {
        &self.massless
    }

    /// Mass matrix without substitutes \[kg\].
    pub(super) fn true_mass(&self) -> Mat<f64> {
        let own = |i: usize| !self.massless.contains(&i);
        let mass = self.mass();
        Mat::from_fn(
            self.dofs(),
            self.dofs(),
            |i, j| {
                if own(i) && own(j) {
                    mass[(i, j)]
                } else {
                    0.0
                }
            },
        )
    }

    /// Modes with another stiffness, such as that of the stuck structure.
    ///
    /// # Errors
    /// The eigenvalue iteration fails, or the other stiffness is so large that its rounding hides the
    /// structure's own.
    pub(super) fn modes_at(&self, stiffness: Mat<f64>) -> Result<StuckModes<f64>, Error> {
        let stuck = StuckModes::new(self.mass(), stiffness, &self.massless)?;
        let with_mass = (0..self.dofs()).filter(|i| !self.massless.contains(i));
        let own = with_mass.map(|i| self.stiffness[(i, i)] / self.mass[(i, i)]).fold(0.0, f64::max);
        let squared = &stuck.modes.omega_squared;
        let fastest = squared.last().copied().unwrap_or(0.0);
        let rounding = f64::EPSILON * fastest;
        // Where contacts hold every mode, there is nothing beside them.
        let slow = squared.first().is_some_and(|slowest| *slowest <= own.max(rounding / HIDDEN));
        if own > 0.0 && slow && (rounding > HIDDEN * own || !fastest.is_finite()) {
            return Err(Error::value(
                "frequency of the stuck structure, squared",
                fastest,
                "contact stiffness has entries of absurd size: beside them that of the structure is \
                 rounded away; 1e12 times as stiff as the structure is as good as rigid",
            ));
        }
        Ok(stuck)
    }

    /// Whether a law made the damping, one that couples none of the modes without contacts.
    #[must_use]
    pub fn is_proportional(&self) -> bool {
        self.proportional
    }

    /// Number of DOFs N.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.mass.nrows()
    }

    /// Mass matrix \[kg\]; of DOFs without mass a substitute.
    #[must_use]
    pub fn mass(&self) -> MatRef<'_, f64> {
        self.mass.as_ref()
    }

    /// Damping matrix [kg/s].
    #[must_use]
    pub fn damping(&self) -> MatRef<'_, f64> {
        self.damping.as_ref()
    }

    /// Whether damping takes energy from every motion.
    pub(crate) fn is_damped(&self) -> bool {
        is_positive(&even(self.damping.clone()))
    }

    /// Whether it takes energy from none.
    pub(crate) fn is_undamped(&self) -> bool {
        self.damping.norm_max() == 0.0
    }

    /// Stiffness matrix [N/m], contacts not included.
    #[must_use]
    pub fn stiffness(&self) -> MatRef<'_, f64> {
        self.stiffness.as_ref()
    }

    /// Stiffness with contacts stuck: `K + Bᵀ D B`.
    #[must_use]
    pub fn restrained_stiffness(&self, rows: &Matrix, contact_stiffness: &Matrix) -> Mat<f64> {
        if rows.nrows() < MANY {
            return &*self.stiffness + rows.transpose() * &**contact_stiffness * &**rows;
        }
        let mut restrained = Mat::clone(&self.stiffness);
        for (i, j, k) in added(rows, contact_stiffness) {
            restrained[(i, j)] += k;
        }
        restrained
    }

    /// The same by its numbers, if these are few.
    pub(super) fn restrained_few(
        &self,
        rows: &Matrix,
        contact_stiffness: &Matrix,
    ) -> Option<Matrix> {
        let own = self.stiffness.few()?.triplet_iter();
        let mut numbers: Vec<_> = own.map(|one| Triplet::new(one.row, one.col, *one.val)).collect();
        let added = added(rows, contact_stiffness);
        numbers.extend(added.into_iter().map(|(i, j, k)| Triplet::new(i, j, k)));
        // Numbers of one place add up.
        let few = Sparse::try_new_from_triplets(self.dofs(), self.dofs(), &numbers).ok()?;
        Some(Matrix::of_few(few))
    }

    /// Mass, damping and stiffness by their numbers.
    pub(super) fn matrices(&self) -> [&Matrix; 3] {
        [&self.mass, &self.damping, &self.stiffness]
    }
}

/// What stuck contacts add to the stiffness, number by number: rows of many contacts hold few of them, and a
/// contact knows few others.
fn added(rows: &Matrix, contact_stiffness: &Matrix) -> Vec<(usize, usize, f64)> {
    let SparseRows { entries, .. } = SparseRows::of(rows);
    let mut numbers = Vec::new();
    for (i, j, d) in contact_stiffness.entries() {
        for &(l, right) in &entries[j] {
            numbers.extend(entries[i].iter().map(|&(k, left)| (k, l, left * d * right)));
        }
    }
    numbers
}

/// Averages out rounded digits.
fn symmetric(entry: &str, matrix: Matrix) -> Result<Matrix, Error> {
    let largest = matrix.entries().map(|(_, _, x)| x.abs()).fold(0.0, f64::max);
    let apart = |i: usize, j: usize| (matrix[(i, j)] - matrix[(j, i)]).abs();
    let is_wrong = |&(i, j): &(usize, usize)| apart(i, j) > ASYMMETRY * largest;
    // Of few numbers each may lack its counterpart.
    let wrong = match matrix.few() {
        Some(few) => few.triplet_iter().map(|one| (one.row, one.col)).find(is_wrong),
        None => tiles(matrix.nrows()).find(is_wrong),
    };
    if let Some((i, j)) = wrong {
        return Err(Error::value(
            format!("{entry}[{i}, {j}] - {entry}[{j}, {i}]"),
            apart(i, j),
            "the matrix must be symmetric",
        ));
    }
    Ok(even(matrix))
}

/// The symmetric part of a matrix.
fn even(matrix: Matrix) -> Matrix {
    if let Some(few) = matrix.few() {
        let halves = few.triplet_iter().flat_map(|one| {
            let half = 0.5 * one.val;
            [Triplet::new(one.row, one.col, half), Triplet::new(one.col, one.row, half)]
        });
        let (size, halves) = (matrix.nrows(), halves.collect::<Vec<_>>());
        if let Ok(few) = Sparse::try_new_from_triplets(size, size, &halves) {
            return Matrix::of_few(few);
        }
    }
    // A tile at a time: far columns lie apart in memory.
    let mut matrix = matrix.into_full();
    for (i, j) in tiles(matrix.nrows()) {
        let mean = 0.5 * (matrix[(i, j)] + matrix[(j, i)]);
        (matrix[(i, j)], matrix[(j, i)]) = (mean, mean);
    }
    matrix.into()
}

/// Places above the diagonal, tile by tile.
fn tiles(size: usize) -> impl Iterator<Item = (usize, usize)> {
    let starts = move || (0..size).step_by(TILE);
    let pairs =
        starts().flat_map(move |j| starts().take_while(move |i| *i <= j).map(move |i| (i, j)));
    pairs.flat_map(move |(first, column)| {
        let columns = column..size.min(column + TILE);
        columns.flat_map(move |j| (first..j.min(first + TILE)).map(move |i| (i, j)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::mat;

    #[test]
    fn damped_is_what_loses_energy_in_every_motion() {
        let damped = |c: Mat<f64>| {
            let one = Mat::<f64>::identity(2, 2);
            Structure::new(one.as_ref(), c.as_ref(), one.as_ref()).map(|made| made.is_damped())
        };
        // What turns with the rotor takes nothing.
        assert_eq!(damped(mat![[1.0, 5.0], [-5.0, 1.0]]), Ok(true));
        for c in [mat![[1.0, 3.0], [3.0, 1.0]], mat![[1.0, 0.0], [0.0, 0.0]], Mat::zeros(2, 2)] {
            assert_eq!(damped(c), Ok(false));
        }
    }

    #[test]
    fn a_structure_of_few_numbers_is_that_of_full_matrices() {
        let size = 120;
        let chain = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 2.0 + i as f64,
            // Printed digits: each side has its own.
            1 => -1.0 + 1e-12 * i as f64,
            _ => 0.0,
        };
        let stiffness = Mat::from_fn(size, size, chain);
        let turned = Mat::from_fn(size, size, |i, j| if i + 1 == j { 0.5 } else { 0.0 });
        let damping = Mat::<f64>::identity(size, size) + &turned - turned.transpose();
        let of = |matrix: &Mat<f64>| {
            let numbers: Vec<_> = Matrix::from(matrix.clone()).entries().collect();
            Matrix::of_entries(size, size, &numbers)
        };
        let one = Mat::<f64>::identity(size, size);
        let few = Structure::of(of(&one), of(&damping), of(&stiffness)).unwrap();
        let even = Mat::from_fn(size, size, |i, j| 0.5 * (chain(i, j) + chain(j, i)));
        assert!((few.stiffness() - &even).norm_max() <= f64::EPSILON);
        assert!(few.is_damped());
        let rows = Mat::from_fn(40, size, |i, j| match j {
            _ if j == 3 * i => 1.0,
            _ if j == 3 * i + 1 => -0.5,
            _ => 0.0,
        });
        let springs = Mat::from_fn(40, 40, |i, j| if i / 2 == j / 2 { 3.0 } else { 0.0 });
        let whole = &even + rows.transpose() * &springs * &rows;
        let (rows, springs) = (of(&rows), of(&springs));
        assert!((few.restrained_stiffness(&rows, &springs) - &whole).norm_max() < 1e-13);
        let restrained = few.restrained_few(&rows, &springs).unwrap();
        assert!((&*restrained - &whole).norm_max() < 1e-13);
        let skew = of(&turned);
        let wrong = Structure::of(of(&one), of(&damping), skew).map(|_| ());
        assert!(wrong.is_err_and(|error| error.to_string().contains("must be symmetric")));
    }
}
