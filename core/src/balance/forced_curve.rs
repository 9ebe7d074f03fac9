//! The harmonic balance of a forced response as a curve: `U = U^stuck(ω) + G(ω) Q(U)` with the
//! frequency as an unknown, so that it can be followed around folds.

use super::condensed::Condensed;
use super::evaluation::Evaluated;
use super::unknowns::Unknowns;
use crate::contact::Residual;
use crate::fourier::SampleTable;
use crate::solve::{norm, Curve, System as _};
use crate::timing::Profile;
use faer::Mat;

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
        }
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
            self.at = self.evaluated(z);
        }
        self.at.as_ref()
    }

    fn evaluated(&mut self, z: &[f64]) -> Option<Evaluation<'a>> {
        let (u, omega) = parts(z);
        if !(omega > 0.0 && omega.is_finite() && norm(u).is_finite()) {
            return None;
        }
        let mut equations = Condensed::new(self.model.clone(), self.table, self.residual, true);
        equations.densify();
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

    fn parameter(&self, z: &[f64]) -> usize {
        z.len() - 1
    }

    fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        let size = self.size;
        let Some(at) = self.evaluate(z) else { return out.fill(f64::NAN) };
        out.iter_mut().zip(&at.residual).for_each(|(out, r)| *out = r / size);
    }

    fn jacobian(&mut self, z: &[f64], out: &mut Mat<f64>) {
        if self.evaluate(z).is_none() {
            return out.fill(f64::NAN);
        }
        let Some(Evaluation { equations, .. }) = &mut self.at else { return };
        let matrix = equations.assemble_all();
        let by_omega = equations.frequency_rate();
        out.fill(0.0);
        for i in 0..by_omega.len() {
            for j in 0..by_omega.len() {
                out[(i, j)] = matrix[(i, j)] / self.size;
            }
            out[(i, by_omega.len())] = -by_omega[i] / self.size;
        }
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
        (self.interrupted)()
    }
}
