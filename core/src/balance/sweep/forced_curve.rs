//! The harmonic balance of a forced response as a curve: `U = U^stuck(ω) + G(ω) Q(U)` with the
//! frequency as an unknown, so that it can be followed around folds.

use crate::balance::condensed::Condensed;
use crate::balance::evaluation::Evaluated;
use crate::balance::unknowns::Unknowns;
use crate::contact::Residual;
use crate::fourier::SampleTable;
use crate::solve::{norm, Curve, System as _};
use crate::timing::Profile;

/// The equations in the unknowns `(U, ω)` at one resolution.
pub(super) struct ForcedCurve<'a> {
    model: Evaluated<'a>,
    table: &'a SampleTable,
    residual: Residual,
    interrupted: &'a dyn Fn() -> bool,
    /// The equations at the last point.
    at: Option<Evaluation<'a>>,
    unknowns: usize,
    /// Size of the last accepted motion.
    size: f64,
    pub(super) profile: Profile,
    /// Evaluations after which it asks to end, …
    pub(super) affordable: usize,
    /// … and work.
    pub(super) granted: f64,
}

struct Evaluation<'a> {
    z: Vec<f64>,
    equations: Condensed<'a>,
    residual: Vec<f64>,
}

impl<'a> ForcedCurve<'a> {
    /// Equations of a model in the harmonics of a table.
    pub(super) fn new(
        model: Evaluated<'a>,
        table: &'a SampleTable,
        residual: Residual,
        interrupted: &'a dyn Fn() -> bool,
    ) -> Self {
        let unknowns = model.compliance().contacts() * table.harmonics().slots() + 1;
        Self {
            model,
            table,
            residual,
            interrupted,
            at: None,
            unknowns,
            size: 1.0,
            profile: Profile::default(),
            affordable: usize::MAX,
            granted: f64::INFINITY,
        }
    }

    /// Whether it has taken all evaluations, or all work, that it may.
    pub(super) fn is_spent(&self) -> bool {
        self.profile.evaluations >= self.affordable || self.profile.work >= self.granted
    }

    /// A point in the unknowns of this curve.
    pub(super) fn point(&self, unknowns: &Unknowns, omega: f64) -> Vec<f64> {
        let mut z = unknowns.recast(self.table.harmonics());
        z.push(omega);
        z
    }

    /// The contact displacements of a point.
    pub(super) fn series(&self, z: &[f64]) -> Unknowns {
        let (u, _) = parts(z);
        Unknowns::new(self.table.harmonics().clone(), u.to_vec())
    }

    /// The equations at a point, with the norm of their residual relative to the motion; nothing where
    /// they are not defined.
    pub(super) fn equations(&mut self, z: &[f64]) -> Option<(&mut Condensed<'a>, f64)> {
        self.evaluate(z)?;
        let at = self.at.as_mut()?;
        let size = norm(parts(z).0).max(f64::MIN_POSITIVE);
        Some((&mut at.equations, norm(&at.residual) / size))
    }

    fn evaluate(&mut self, z: &[f64]) -> Option<&Evaluation<'a>> {
        if self.at.as_ref().is_none_or(|at| at.z != z) {
            if let Some(last) = self.at.take() {
                self.profile.add(&last.equations.profile);
            }
            self.at = self.evaluated(z);
        }
        self.at.as_ref()
    }

    fn evaluated(&mut self, z: &[f64]) -> Option<Evaluation<'a>> {
        let (u, omega) = parts(z);
        if !(omega > 0.0 && omega.is_finite() && norm(u).is_finite()) {
            return None;
        }
        let mut equations = Condensed::of_curve(self.model.clone(), self.table, self.residual);
        equations.watch(self.interrupted);
        equations.set_omega(omega).ok()?;
        let mut residual = vec![0.0; u.len()];
        equations.residual(u, &mut residual);
        self.profile.add(&equations.profile);
        equations.profile = Profile::default();
        Some(Evaluation { z: z.to_vec(), equations, residual })
    }
}

/// Contact displacements and frequency.
fn parts(z: &[f64]) -> (&[f64], f64) {
    match z.split_last() {
        Some((omega, u)) => (u, *omega),
        None => (z, f64::NAN),
    }
}

impl Curve for ForcedCurve<'_> {
    fn unknowns(&self) -> usize {
        self.unknowns
    }

    fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        let size = self.size;
        let Some(at) = self.evaluate(z) else { return out.fill(f64::NAN) };
        out.iter_mut().zip(&at.residual).for_each(|(out, r)| *out = r / size);
    }

    fn solve_bordered(
        &mut self,
        z: &[f64],
        border: &[f64],
        right: &[f64],
        _weights: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        self.evaluate(z)?;
        let mut right = right.to_vec();
        let (_, motion) = right.split_last_mut()?;
        motion.iter_mut().for_each(|r| *r *= self.size);
        let equations = &mut self.at.as_mut()?.equations;
        let (rate, omega) = (equations.frequency_rate(), equations.omega);
        let solved = equations.solve_bordered((&rate, omega), border, &right);
        self.profile.add(&std::mem::take(&mut equations.profile));
        solved
    }

    fn weights(&self, z: &[f64]) -> Vec<f64> {
        let (u, omega) = parts(z);
        let mut weights = vec![norm(u).max(f64::MIN_POSITIVE).recip(); u.len()];
        weights.push(omega.recip());
        weights
    }

    fn accept(&mut self, z: &[f64]) {
        self.size = norm(parts(z).0).max(f64::MIN_POSITIVE);
    }

    fn interrupted(&self) -> bool {
        self.is_spent() || (self.interrupted)()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Closure, Coulomb};
    use crate::fourier::Harmonics;
    use crate::model::{Contact, Model};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, mat, Mat};

    /// Two masses on a planar contact each, one of which may open, and one that is stuck for good.
    fn model() -> Model {
        let mass = mat![[2.0, 0.1, 0.0], [0.1, 1.0, 0.2], [0.0, 0.2, 1.5]];
        let stiffness = mat![[300.0, -100.0, 0.0], [-100.0, 150.0, 20.0], [0.0, 20.0, 250.0]];
        let damping = mat![[0.5, -0.1, 0.0], [0.2, 0.4, 0.0], [0.0, 0.1, 0.6]];
        let structure =
            Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
        let contact = |preload: f64, rows: [[f64; 3]; 2]| Contact {
            law: Box::new(
                Coulomb::new(1, 0.4, 120.0, Some(150.0), Closure::Preload(preload)).unwrap(),
            ),
            rows: Mat::from_fn(2, 3, |i, j| rows[i][j]),
        };
        let contacts = vec![
            contact(0.4, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
            contact(9.0, [[1.0, -1.0, 0.0], [0.0, 0.5, 1.0]]),
            contact(1e5, [[0.0, 1.0, 0.0], [0.2, 0.0, 1.0]]),
        ];
        let amplitude = vec![c64::new(4.0, 0.8), c64::new(-1.2, 0.5), c64::new(2.0, -0.3)];
        let load = HarmonicLoad { harmonic: 1, amplitude };
        Model::new(structure, contacts, vec![load]).unwrap()
    }

    /// A solution is paid for as a factorisation of the points that yield.
    #[test]
    fn bordered_equations_are_paid_for() {
        let model = model();
        let table = SampleTable::new(Harmonics::new(5, false));
        let ask = || false;
        let mut curve = ForcedCurve::new(Evaluated::Given(&model), &table, Residual::Centred, &ask);
        let size = curve.unknowns();
        let mut z: Vec<f64> = (0..size).map(|i| 0.03 * (1.0 + i as f64).sin()).collect();
        z[size - 1] = 9.0;
        let weights = curve.weights(&z);
        curve.residual(&z, &mut vec![0.0; size - 1]);
        let before = curve.profile.work;
        curve.solve_bordered(&z, &weights, &vec![1.0; size], &weights).unwrap();
        let taken = curve.profile.work - before;
        let (equations, _) = curve.equations(&z).unwrap();
        let paid = equations.work_of_factors();
        assert!(paid > 0.0 && (taken / paid - 1.0).abs() < 1e-9, "{taken} {paid}");
    }

    /// The equations in the slip loads have the solution and the orientation of those in the
    /// displacements.
    #[test]
    fn bordered_equations_are_those_of_the_whole_jacobian() {
        let model = model();
        let table = SampleTable::new(Harmonics::new(5, false));
        let ask = || false;
        let mut orientations = Vec::new();
        for (case, omega) in [4.0, 9.0, 14.0, 25.0].into_iter().enumerate() {
            let mut curve =
                ForcedCurve::new(Evaluated::Given(&model), &table, Residual::Centred, &ask);
            let size = curve.unknowns();
            let mut z: Vec<f64> = (0..size)
                .map(|i| 0.03 * (1.0 + (case * 7 + i) as f64).sin() / (1.0 + (i % 11) as f64 / 3.0))
                .collect();
            z[size - 1] = omega;
            curve.accept(&z);
            let weights = curve.weights(&z);
            let border: Vec<f64> = (0..size).map(|i| weights[i] * (0.3 * i as f64).cos()).collect();
            let right: Vec<f64> = (0..size).map(|i| (0.7 * i as f64).sin()).collect();
            let (step, sign) = curve.solve_bordered(&z, &border, &right, &weights).unwrap();
            let motion = curve.size;
            let (equations, _) = curve.equations(&z).unwrap();
            let (by_motion, by_omega) = (equations.assemble_all(), equations.frequency_rate());
            let matrix = Mat::from_fn(size, size, |i, j| match (size - 1 - i, size - 1 - j) {
                (0, _) => border[j],
                (_, 0) => -by_omega[i] / motion,
                _ => by_motion[(i, j)] / motion,
            });
            for i in 0..size {
                let row: f64 = (0..size).map(|j| matrix[(i, j)] * step[j]).sum();
                let scale: f64 = (0..size).map(|j| (matrix[(i, j)] * step[j]).abs()).sum();
                assert!((row - right[i]).abs() < 1e-10 * (scale + 1.0), "{i}: {row} {}", right[i]);
            }
            assert_eq!(sign, matrix.determinant().signum());
            orientations.push(sign);
        }
        assert!(orientations.contains(&1.0) && orientations.contains(&-1.0), "{orientations:?}");
    }
}
