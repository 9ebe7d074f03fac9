//! Massless elastic bodies: the factor of a stiffness, and what it becomes while points slip.
//!
//! With `D = L Lᵀ` the strain `g = Lᵀ (u − s)` holds all that the forces `f = L g` can be: forces
//! that the body cannot carry (the resultant of one that floats) do not exist in it. Its square is
//! twice the elastic energy. While the points S slip, their rows of L hold g fast: it moves along
//! `P = I − L_Sᵀ (L_Sᵀ)⁺`, and the forces with the tangent `L P Lᵀ`, which is the condensed
//! stiffness `D_TT − D_TS D_SS⁻¹ D_ST` (Guillen 1999, eqs. 6.14-6.17) wherever D_SS has an inverse
//! and stays defined where it has none.

use crate::solve::hermitian_eigen;
use crate::Error;
use faer::linalg::solvers::Solve as _;
use faer::{Mat, MatRef};

/// Eigenvalues and directions below this share of the largest count as none.
const NEGLIGIBLE: f64 = 1e-12;

/// The factor L of a symmetric positive semidefinite stiffness, points × rank.
#[derive(Debug, Clone)]
pub struct Elastic {
    root: Mat<f64>,
    inverse: Mat<f64>,
}

/// What a body does while some of its points slip.
#[derive(Debug, Clone)]
pub(crate) struct ReducedStiffness {
    /// `∂f/∂u`, points × points [N/m].
    pub(crate) tangent: Mat<f64>,
    /// Slip per displacement, `s' = R u'`, rows of points that stick zero. Where the slip is not
    /// unique it is the least.
    pub(crate) slip_rate: Mat<f64>,
}

impl Elastic {
    /// Factors a stiffness [N/m].
    ///
    /// # Errors
    /// The eigenvalue iteration fails.
    pub fn new(stiffness: MatRef<'_, f64>) -> Result<Self, Error> {
        let size = stiffness.nrows();
        if size == 1 {
            let root = stiffness[(0, 0)].max(0.0).sqrt();
            let rank = usize::from(root > 0.0);
            return Ok(Self {
                root: Mat::from_fn(1, rank, |_, _| root),
                inverse: Mat::from_fn(rank, 1, |_, _| 1.0 / root),
            });
        }
        let (values, vectors) = hermitian_eigen(stiffness)
            .ok_or_else(|| Error::Eigenvalues("contact stiffness".to_owned()))?;
        let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let kept: Vec<usize> =
            (0..size).filter(|&j| values[j] > NEGLIGIBLE * largest && values[j] > 0.0).collect();
        let at = |i: usize, j: usize| vectors[(i, kept[j])];
        Ok(Self {
            root: Mat::from_fn(size, kept.len(), |i, j| at(i, j) * values[kept[j]].sqrt()),
            inverse: Mat::from_fn(kept.len(), size, |j, i| at(i, j) / values[kept[j]].sqrt()),
        })
    }

    /// The factor of the stiffness times a share.
    pub(crate) fn softened(&self, share: f64) -> Self {
        let root = share.max(0.0).sqrt();
        let factor = |matrix: &Mat<f64>, by: f64| faer::Scale(by) * matrix;
        Self { root: factor(&self.root, root), inverse: factor(&self.inverse, root.recip()) }
    }

    /// Number of independent strains.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.root.ncols()
    }

    /// L, points × rank.
    #[must_use]
    pub fn root(&self) -> &Mat<f64> {
        &self.root
    }

    /// The left inverse of L, rank × points: strains of the forces.
    #[must_use]
    pub fn inverse(&self) -> &Mat<f64> {
        &self.inverse
    }

    /// Strains of the forces: the left inverse of L times them.
    pub(crate) fn strains(&self, force: &[f64]) -> Vec<f64> {
        let row = |a: usize| force.iter().enumerate().map(move |(i, f)| self.inverse[(a, i)] * f);
        (0..self.rank()).map(|a| row(a).sum()).collect()
    }

    /// Forces of the strains.
    pub(crate) fn forces(&self, strains: &[f64]) -> Vec<f64> {
        let row = |i: usize| strains.iter().enumerate().map(move |(a, g)| self.root[(i, a)] * g);
        (0..self.root.nrows()).map(|i| row(i).sum()).collect()
    }

    /// The part of forces that a deformation can give.
    pub(crate) fn carried(&self, force: &[f64]) -> Vec<f64> {
        self.forces(&self.strains(force))
    }

    /// Orthonormal basis of the strains that move no row of the points marked in `held`.
    pub(crate) fn unmoved(&self, held: &[bool]) -> Vec<Vec<f64>> {
        let rows: Vec<usize> = (0..held.len()).filter(|&i| held[i]).collect();
        let mut basis = self.directions(&rows);
        let taken = basis.len();
        for a in 0..self.rank() {
            let mut unit = vec![0.0; self.rank()];
            unit[a] = 1.0;
            for _ in 0..2 {
                subtract_along(&basis, &mut unit);
            }
            let left = norm(&unit);
            if left > NEGLIGIBLE.sqrt() {
                unit.iter_mut().for_each(|x| *x /= left);
                basis.push(unit);
            }
        }
        basis.split_off(taken)
    }

    /// What the body does while the points marked in `slips` slip.
    pub(crate) fn reduced(&self, slips: &[bool]) -> ReducedStiffness {
        let (points, rank) = (self.root.nrows(), self.rank());
        let slipping: Vec<usize> = (0..points).filter(|&i| slips[i]).collect();
        let held = self.directions(&slipping);
        let projector = Mat::from_fn(rank, rank, |a, b| {
            let along: f64 = held.iter().map(|q| q[a] * q[b]).sum();
            f64::from(u8::from(a == b)) - along
        });
        let mut tangent = &self.root * &projector * self.root.transpose();
        let own = |i: usize| (0..rank).map(|a| self.root[(i, a)].powi(2)).sum::<f64>();
        let gone: Vec<bool> =
            (0..points).map(|i| slips[i] || tangent[(i, i)] <= NEGLIGIBLE * own(i)).collect();
        for i in 0..points {
            for j in 0..points {
                if gone[i] || gone[j] {
                    tangent[(i, j)] = 0.0;
                }
            }
        }
        let mut slip_rate = self.least_slip(&slipping, &held, &self.root.transpose().to_owned());
        drop_rounding(&mut tangent);
        drop_rounding(&mut slip_rate);
        ReducedStiffness { tangent, slip_rate }
    }

    /// Orthonormal basis of the strains that the rows of some points span.
    fn directions(&self, points: &[usize]) -> Vec<Vec<f64>> {
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for &i in points {
            let mut row: Vec<f64> = (0..self.rank()).map(|a| self.root[(i, a)]).collect();
            let size = norm(&row);
            // Twice is enough (Kahan): the first pass may leave rounding along the basis.
            for _ in 0..2 {
                subtract_along(&basis, &mut row);
            }
            let left = norm(&row);
            // Its square is the pivot of the stiffness.
            if left > NEGLIGIBLE.sqrt() * size {
                row.iter_mut().for_each(|r| *r /= left);
                basis.push(row);
            }
        }
        basis
    }

    /// Least slip of the points marked in `slips` that takes these forces off the body.
    pub(crate) fn slip(&self, slips: &[bool], lost: &[f64]) -> Vec<f64> {
        let slipping: Vec<usize> = (0..slips.len()).filter(|&i| slips[i]).collect();
        let strains = self.strains(lost);
        let column = Mat::from_fn(strains.len(), 1, |a, _| strains[a]);
        let slip = self.least_slip(&slipping, &self.directions(&slipping), &column);
        (0..slips.len()).map(|i| slip[(i, 0)]).collect()
    }

    /// Least solutions of `L_Sᵀ s = Q Qᵀ g` for columns g, with Q the basis `held` of the rows S.
    fn least_slip(&self, slipping: &[usize], held: &[Vec<f64>], strains: &Mat<f64>) -> Mat<f64> {
        let mut least = Mat::zeros(self.root.nrows(), strains.ncols());
        if held.is_empty() {
            return least;
        }
        let basis = Mat::from_fn(self.rank(), held.len(), |a, m| held[m][a]);
        let rows = Mat::from_fn(slipping.len(), self.rank(), |i, a| self.root[(slipping[i], a)]);
        let rows = rows * &basis;
        let gram = rows.transpose() * &rows;
        let slip = &rows * gram.partial_piv_lu().solve(basis.transpose() * strains);
        for (row, &i) in slipping.iter().enumerate() {
            for j in 0..strains.ncols() {
                least[(i, j)] = slip[(row, j)];
            }
        }
        least
    }
}

/// Sets what rounding has left in place of zeros to zero: of points that do not move with others the
/// rate is none, and must not have a sign.
fn drop_rounding(matrix: &mut Mat<f64>) {
    let least = NEGLIGIBLE * matrix.norm_max();
    for j in 0..matrix.ncols() {
        for i in 0..matrix.nrows() {
            if matrix[(i, j)].abs() <= least {
                matrix[(i, j)] = 0.0;
            }
        }
    }
}

/// Takes from x what lies along an orthonormal basis.
fn subtract_along(basis: &[Vec<f64>], x: &mut [f64]) {
    for q in basis {
        let along: f64 = q.iter().zip(&*x).map(|(q, x)| q * x).sum();
        x.iter_mut().zip(q).for_each(|(x, q)| *x -= along * q);
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::mat;

    #[test]
    fn slipping_points_are_condensed() {
        let d = mat![[5.0, -2.0, -1.0], [-2.0, 4.0, -1.0], [-1.0, -1.0, 2.0]];
        let elastic = Elastic::new(d.as_ref()).unwrap();
        let reduced = elastic.reduced(&[true, false, false]);
        for (i, j) in [(1, 1), (1, 2), (2, 2)] {
            let expected = d[(i, j)] - d[(i, 0)] * d[(0, j)] / d[(0, 0)];
            assert!((reduced.tangent[(i, j)] - expected).abs() < 1e-13);
        }
        for j in 0..3 {
            assert!((reduced.slip_rate[(0, j)] - d[(0, j)] / d[(0, 0)]).abs() < 1e-13);
        }
    }

    #[test]
    fn a_floating_body_that_slips_everywhere_slips_least() {
        let elastic = Elastic::new(mat![[3.0, -3.0], [-3.0, 3.0]].as_ref()).unwrap();
        assert_eq!(elastic.rank(), 1);
        let reduced = elastic.reduced(&[true, true]);
        assert_eq!(reduced.tangent, Mat::<f64>::zeros(2, 2));
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let expected = if i == j { 0.5 } else { -0.5 };
            assert!((reduced.slip_rate[(i, j)] - expected).abs() < 1e-14);
        }
        let one = elastic.reduced(&[false, true]);
        assert_eq!(one.tangent, Mat::<f64>::zeros(2, 2));
    }

    /// A floating body rests on the point that sticks. If another one is on the same ground it slips at
    /// a rate of exactly zero, to which rounding must not give a sign.
    #[test]
    fn points_do_not_slip_with_others_by_rounding() {
        let d = mat![
            [
                3_111_999.072_336_622,
                2_013_862.593_721_796_5,
                -2_259_566.291_669_272_4,
                -2_866_295.374_389_146
            ],
            [
                2_013_862.593_721_796_5,
                6_617_603.142_542_944,
                -3_395_872.949_069_31,
                -5_235_592.787_195_43
            ],
            [
                -2_259_566.291_669_272_4,
                -3_395_872.949_069_31,
                3_248_707.277_913_24,
                2_406_731.962_825_342_5
            ],
            [
                -2_866_295.374_389_146,
                -5_235_592.787_195_43,
                2_406_731.962_825_342_5,
                5_695_156.198_759_234
            ],
        ];
        let elastic = Elastic::new(d.as_ref()).unwrap();
        assert_eq!(elastic.rank(), 3);
        let rate = elastic.reduced(&[true, true, true, false]).slip_rate;
        for i in 0..3 {
            for j in 0..4 {
                let expected = f64::from(u8::from(i == j)) - f64::from(u8::from(j == 3));
                assert!((rate[(i, j)] - expected).abs() < 1e-12);
                assert_eq!(rate[(i, j)] == 0.0, expected == 0.0, "{i} {j}: {}", rate[(i, j)]);
            }
        }
    }
}
