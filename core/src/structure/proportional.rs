//! Proportional damping: whether the modal damping matrix is diagonal, and in which modes.
//!
//! Modes are known to rounding only, and where frequencies lie close together they are known badly:
//! a change of the stiffness by its rounding turns two modes by that rounding over the distance of
//! their squared frequencies, by any angle where these are equal. So a damping matrix counts as
//! diagonal if it is so in modes that belong to the same stiffness but for its rounding. What is
//! neglected then changes a response by no more than
//!
//! - 1e-10 of it per pair of modes that the damping couples, or the rounding of the damping matrix,
//!   1e-15 N of the largest entry among those that the two modes meet;
//! - what moving a resonance by a millionth of its bandwidth changes, and what a change of the
//!   stiffness by 1e-15 N of the highest squared frequency changes.

use super::modes::{complex, HermitianModes, RealModes};
use faer::traits::ComplexField;
use faer::{c64, Mat, MatRef};

/// Modal damping between two modes, relative to their own, that still counts as none.
const COUPLING: f64 = 1e-10;
/// Rounding of a matrix per DOF.
const ROUNDING: f64 = 1e-15;
/// Shift of a resonance that still counts as none, relative to the bandwidth.
const SHIFT: f64 = 1e-6;
/// Angle between modes that still counts as none.
const ANGLE: f64 = 1e-10;
/// Sweeps of rotations over all pairs of modes; as in Jacobi's method a few suffice.
const SWEEPS: usize = 12;

/// A damping matrix in modal coordinates.
#[derive(Debug, Clone)]
pub(crate) struct ModalDamping {
    /// `Φᴴ C Φ`.
    matrix: Mat<c64>,
    /// Root of the damping that each mode meets, whatever of it cancels.
    met: Vec<f64>,
    omega_squared: Vec<f64>,
}

/// What a damping matrix does to two modes.
enum Pair {
    /// They are not coupled.
    Separate,
    /// They are combinations of two that are not coupled: cosine, and sine with its phase.
    Turned(f64, c64),
    /// They are coupled.
    Coupled,
}

impl ModalDamping {
    /// Of modes, from the damping matrix in modal coordinates and its entries over the DOFs.
    pub(crate) fn new(
        matrix: Mat<c64>,
        modes: &HermitianModes,
        entry: impl Fn(usize, usize) -> c64,
    ) -> Self {
        let dofs = modes.shapes.nrows();
        let largest = |k: usize| {
            (0..dofs).map(|l| entry(k, l).norm().max(entry(l, k).norm())).fold(0.0, f64::max)
        };
        let largest: Vec<f64> = (0..dofs).map(largest).collect();
        let met = (0..modes.shapes.ncols())
            .map(|j| (0..dofs).map(|k| modes.shapes[(k, j)].norm_sqr() * largest[k]).sum::<f64>())
            .map(f64::sqrt)
            .collect();
        Self { matrix, met, omega_squared: modes.omega_squared.clone() }
    }

    /// The sum with `factor` times another damping of the same modes.
    pub(crate) fn plus(&self, factor: f64, other: &Self) -> Self {
        let met = self.met.iter().zip(&other.met);
        Self {
            matrix: &self.matrix + faer::Scale(c64::new(factor, 0.0)) * &other.matrix,
            met: met.map(|(a, b)| a.hypot(factor.abs().sqrt() * b)).collect(),
            omega_squared: self.omega_squared.clone(),
        }
    }

    /// `Φᴴ C Φ`.
    pub(crate) fn matrix(&self) -> &Mat<c64> {
        &self.matrix
    }

    /// Damping of each mode [1/s].
    pub(crate) fn diagonal(&self) -> Vec<f64> {
        (0..self.matrix.nrows()).map(|j| self.matrix[(j, j)].re).collect()
    }

    /// Whether it couples none of the modes as they are.
    pub(crate) fn is_diagonal(&self) -> bool {
        let open = self.open();
        let separate = |i, j| matches!(self.pair(i, j, open, false), Pair::Separate);
        (0..self.met.len()).all(|j| (0..j).all(|i| separate(i, j)))
    }

    /// The modes in which this damping is diagonal, turned from the given ones only as far as
    /// rounding leaves them open, and the damping of each. `None` if it couples modes; what rounding
    /// couples does not count where a damping `law` says that nothing is coupled.
    pub(crate) fn separated(
        mut self,
        mut modes: HermitianModes,
        law: bool,
    ) -> Option<(HermitianModes, Vec<f64>)> {
        let open = self.open();
        for _ in 0..SWEEPS {
            let mut turned = false;
            for j in 0..self.met.len() {
                for i in 0..j {
                    match self.pair(i, j, open, law) {
                        Pair::Coupled if !law => return None,
                        Pair::Turned(cos, sin) => {
                            turned = true;
                            turn_columns(&mut modes.shapes, [i, j], cos, sin);
                            turn_columns(&mut self.matrix, [i, j], cos, sin);
                            turn_rows(&mut self.matrix, [i, j], cos, sin);
                            let larger = self.met[i].max(self.met[j]);
                            (self.met[i], self.met[j]) = (larger, larger);
                        }
                        _ => {}
                    }
                }
            }
            if !turned {
                return Some((modes, self.diagonal()));
            }
        }
        law.then(|| (modes, self.diagonal()))
    }

    /// Rounding of the stiffness, which leaves open how modes are coupled [1/s²].
    fn open(&self) -> f64 {
        let highest = self.omega_squared.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
        ROUNDING * self.met.len() as f64 * highest
    }

    fn pair(&self, i: usize, j: usize, open: f64, law: bool) -> Pair {
        let [own, other] = [i, j].map(|k| self.matrix[(k, k)].re);
        let [ahead, behind] = [self.matrix[(i, j)], self.matrix[(j, i)].conj()];
        let common = (own * other).abs().sqrt();
        let rounding = ROUNDING * self.met.len() as f64 * self.met[i] * self.met[j];
        let negligible = COUPLING * common + rounding;
        if ahead.norm().max(behind.norm()) <= negligible {
            return Pair::Separate;
        }
        // A Hermitian 2 × 2 block is diagonal in combinations of the two modes, …
        if (ahead - behind).norm() > negligible {
            return Pair::Coupled;
        }
        let coupling = ahead.norm();
        let angle = if own == other {
            std::f64::consts::FRAC_PI_4
        } else {
            0.5 * (2.0 * coupling / (own - other)).atan()
        };
        // … which the stiffness couples in turn.
        let [lower, upper] = [i, j].map(|k| self.omega_squared[k]);
        let stiffness = 0.5 * (2.0 * angle).sin().abs() * (upper - lower).abs();
        let bandwidth = lower.abs().min(upper.abs()).sqrt() * common;
        let limit = if law { open } else { open.min(SHIFT * bandwidth) };
        if stiffness > limit {
            Pair::Coupled
        } else if angle.abs() <= ANGLE {
            Pair::Separate
        } else {
            Pair::Turned(angle.cos(), ahead / coupling * angle.sin())
        }
    }
}

/// Whether a damping matrix is a multiple of the mass, so that no mode of any stiffness is coupled.
pub(super) fn follows_mass<T: ComplexField<Real = f64>>(
    damping: MatRef<'_, T>,
    mass: MatRef<'_, T>,
) -> bool {
    let factor = T::real_part_impl(&damping[(0, 0)]) / T::real_part_impl(&mass[(0, 0)]);
    let difference = damping - faer::Scale(T::from_f64_impl(factor)) * mass;
    difference.norm_max() <= ROUNDING * damping.norm_max()
}

/// Combines two columns a and b to `cos a + sin̄ b` and `cos b − sin a`.
fn turn_columns(matrix: &mut Mat<c64>, [i, j]: [usize; 2], cos: f64, sin: c64) {
    for k in 0..matrix.nrows() {
        let (a, b) = (matrix[(k, i)], matrix[(k, j)]);
        matrix[(k, i)] = a * cos + b * sin.conj();
        matrix[(k, j)] = b * cos - a * sin;
    }
}

/// Combines two rows a and b to `cos a + sin b` and `cos b − sin̄ a`.
fn turn_rows(matrix: &mut Mat<c64>, [i, j]: [usize; 2], cos: f64, sin: c64) {
    for k in 0..matrix.ncols() {
        let (a, b) = (matrix[(i, k)], matrix[(j, k)]);
        matrix[(i, k)] = a * cos + b * sin;
        matrix[(j, k)] = b * cos - a * sin.conj();
    }
}

impl RealModes {
    /// A damping matrix in these modes.
    pub(crate) fn damping(&self, matrix: MatRef<'_, f64>) -> ModalDamping {
        let modal = complex(self.project(matrix).as_ref());
        ModalDamping::new(modal, &self.to_hermitian(), |i, j| c64::new(matrix[(i, j)], 0.0))
    }

    /// These modes with a damping matrix that a law made: turned as far as rounding leaves them open,
    /// and not coupled, whatever rounding says.
    pub(crate) fn damped_by_law(mut self, matrix: MatRef<'_, f64>) -> (Self, ModalDamping) {
        let mut damping = self.damping(matrix);
        if let Some((modes, each)) = damping.clone().separated(self.to_hermitian(), true) {
            self.shapes = Mat::from_fn(each.len(), each.len(), |i, j| modes.shapes[(i, j)].re);
            let own = |i, j| if i == j { c64::new(each[i], 0.0) } else { c64::new(0.0, 0.0) };
            damping.matrix = Mat::from_fn(each.len(), each.len(), own);
        }
        (self, damping)
    }
}

impl HermitianModes {
    /// A damping matrix in these modes.
    pub(super) fn damping(&self, matrix: MatRef<'_, c64>) -> ModalDamping {
        ModalDamping::new(self.project(matrix), self, |i, j| matrix[(i, j)])
    }
}

#[cfg(test)]
mod tests {
    use super::super::modes::modes;
    use faer::{mat, Mat};

    #[test]
    fn a_law_couples_no_modes_whatever_rounding_left_in_its_matrix() {
        let (mass, stiffness) = (Mat::<f64>::identity(2, 2), mat![[1.0, 0.0], [0.0, 4.0]]);
        let damping = mat![[0.1, 1e-7], [1e-7, 0.2]];
        let own = || modes(mass.as_ref(), stiffness.as_ref()).unwrap();
        assert!(!own().damping(damping.as_ref()).is_diagonal());
        let (_, by_law) = own().damped_by_law(damping.as_ref());
        assert!(by_law.is_diagonal());
        assert_eq!(by_law.diagonal(), own().damping(damping.as_ref()).diagonal());
    }

    #[test]
    fn modes_of_one_frequency_are_those_of_the_damping() {
        let (mass, stiffness) =
            (Mat::<f64>::identity(2, 2), faer::Scale(4.0) * Mat::<f64>::identity(2, 2));
        let (sin, cos) = 0.6_f64.sin_cos();
        let turn = mat![[cos, -sin], [sin, cos]];
        let damping = &turn * mat![[0.1, 0.0], [0.0, 0.3]] * turn.transpose();
        let (modes, by_law) =
            modes(mass.as_ref(), stiffness.as_ref()).unwrap().damped_by_law(damping.as_ref());
        let modal = modes.shapes.transpose() * &damping * &modes.shapes;
        let mut each = by_law.diagonal();
        each.sort_by(f64::total_cmp);
        assert!((each[0] - 0.1).abs() < 1e-14 && (each[1] - 0.3).abs() < 1e-14);
        assert!(modal[(0, 1)].abs() < 1e-14);
    }
}
