//! The harmonic balance of a limit cycle: `U = G(ω, r) Q(U)` with the frequency as an unknown.
//!
//! Nothing drives the motion, so that its phase is free; it is held relative to the last accepted
//! point, across the velocity of that point. Condensed to the contact displacements the equations
//! do not grow with the structure (Guillen 1999, section 5.3.1, takes this to be impossible).

use crate::balance::condensed::Condensed;
use crate::balance::evaluation::Evaluated;
use crate::balance::unknowns::Unknowns;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::FlutterModel;
use crate::solve::{factorised_with, norm, Curve, System as _};
use faer::Mat;
use std::sync::Arc;

/// The equations of a limit cycle in the unknowns `(U, ω, scalar)`.
pub struct CycleBalance<'a> {
    pub(super) family: &'a FlutterModel<'a>,
    pub(super) table: &'a SampleTable,
    interrupted: &'a dyn Fn() -> bool,
    /// The equations at the last point, and their residual.
    pub(super) at: Option<Evaluation<'a>>,
    /// Last accepted point, and the size of its motion about the mean.
    reference: Vec<f64>,
    size: f64,
    /// Evaluations of the laws so far.
    pub evaluations: usize,
}

/// The forced balance of the model without loads, at the frequency and the scalar of a point.
pub(super) struct Evaluation<'a> {
    z: Vec<f64>,
    pub(super) equations: Condensed<'a>,
    pub(super) residual: Vec<f64>,
}

impl<'a> CycleBalance<'a> {
    /// Equations of a family in the harmonics of a table, and where they start: contact
    /// displacements, ω and the scalar.
    #[must_use]
    pub fn new(
        family: &'a FlutterModel<'a>,
        table: &'a SampleTable,
        start: &[f64],
        interrupted: &'a dyn Fn() -> bool,
    ) -> Self {
        let mut balance = Self {
            family,
            table,
            interrupted,
            at: None,
            reference: Vec::new(),
            size: 1.0,
            evaluations: 0,
        };
        balance.accept(start);
        balance
    }

    /// Contact displacements, ω and scalar.
    fn parts<'b>(&self, z: &'b [f64]) -> (&'b [f64], f64, f64) {
        let (u, rest) = z.split_at(z.len().saturating_sub(2));
        match rest {
            [omega, value] => (u, *omega, *value),
            _ => (u, f64::NAN, f64::NAN),
        }
    }

    /// Evaluates laws and compliances at a point; nothing where they are not defined.
    pub(super) fn evaluate(&mut self, z: &[f64]) -> Option<&Evaluation<'a>> {
        if self.at.as_ref().is_none_or(|at| at.z != z) {
            self.at = self.evaluated(z);
            self.evaluations += usize::from(self.at.is_some());
        }
        self.at.as_ref()
    }

    fn evaluated(&self, z: &[f64]) -> Option<Evaluation<'a>> {
        let (u, omega, value) = self.parts(z);
        let sound = omega > 0.0 && omega.is_finite() && value.is_finite() && norm(u).is_finite();
        let model = self.family.at(value).ok().filter(|_| sound)?;
        let model = Evaluated::Made(Arc::new(model));
        let mut equations = Condensed::new(model, self.table, self.family.residual(), true);
        equations.set_omega(omega).ok()?;
        let mut residual = vec![0.0; u.len()];
        equations.residual(u, &mut residual);
        Some(Evaluation { z: z.to_vec(), equations, residual })
    }

    /// The Jacobian at a point, with nothing in its last row.
    pub fn jacobian(&mut self, z: &[f64]) -> Option<Mat<f64>> {
        self.evaluate(z)?;
        let Evaluation { equations, .. } = self.at.as_ref()?;
        let (matrix, (u, ..)) = (equations.assemble_all(), self.parts(z));
        let (by_omega, by_value) = (equations.frequency_rate(), self.value_rate(equations, u));
        let size = u.len();
        let mut out = Mat::zeros(z.len(), z.len());
        for i in 0..size {
            for j in 0..size {
                out[(i, j)] = matrix[(i, j)] / self.size;
            }
            out[(i, size)] = -by_omega[i] / self.size;
            out[(i, size + 1)] = -by_value[i] / self.size;
        }
        for (j, d) in self.drift().iter().enumerate() {
            out[(size, j)] = d / self.size;
        }
        Some(out)
    }

    /// Rate of change of the equations with the scalar, sign reversed.
    fn value_rate(&self, equations: &Condensed<'_>, u: &[f64]) -> Vec<f64> {
        if self.family.changes().is_empty() {
            return equations.ratio_rate();
        }
        // dG Q + G dQ with dG = −G dD G and dQ = dD U − dF: at a solution, −G dF.
        let (mut force, mut rate) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        for change in self.family.changes() {
            let of = [change.contact, change.parameter];
            equations.add_force_rate(of, u, -change.rate(), &mut force);
        }
        equations.add_response(&force, &mut rate);
        rate
    }

    /// Velocity of the last accepted point, laid out as the displacements, over its size.
    fn drift(&self) -> Vec<f64> {
        let (u, ..) = self.parts(&self.reference);
        drift(self.table.harmonics(), u).iter().map(|v| v / self.size).collect()
    }

    /// Size of the motion of contact displacements about their mean.
    fn motion(&self, u: &[f64]) -> f64 {
        oscillation(self.table.harmonics(), u)
    }

    /// The contact displacements of a point in the layout of a balance.
    #[must_use]
    pub fn series(&self, z: &[f64]) -> Unknowns {
        Unknowns::new(self.table.harmonics().clone(), self.parts(z).0.to_vec())
    }
}

/// Norm of series without their means.
pub(crate) fn oscillation(harmonics: &Harmonics, series: &[f64]) -> f64 {
    let all = norm(series);
    if !harmonics.has_mean() {
        return all;
    }
    let own = series.chunks_exact(harmonics.slots()).flat_map(|own| &own[harmonics.offset()..]);
    own.map(|x| x * x).sum::<f64>().sqrt()
}

/// Derivative of a series in its angle.
fn drift(harmonics: &Harmonics, series: &[f64]) -> Vec<f64> {
    let slots = harmonics.slots();
    let mut out = vec![0.0; series.len()];
    for (point, own) in series.chunks_exact(slots).zip(out.chunks_exact_mut(slots)) {
        for order in harmonics.orders() {
            let Some(slot) = harmonics.slot(order) else { continue };
            if order > 0 {
                own[slot] = order as f64 * point[slot + 1];
                own[slot + 1] = -(order as f64) * point[slot];
            }
        }
    }
    out
}

impl Curve for CycleBalance<'_> {
    fn unknowns(&self) -> usize {
        self.reference.len()
    }

    fn scalars(&self, z: &[f64]) -> usize {
        z.len() - 2
    }

    fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        let size = self.size;
        let Some(at) = self.evaluate(z) else { return out.fill(f64::NAN) };
        out.iter_mut().zip(&at.residual).for_each(|(out, r)| *out = r / size);
        let ((u, ..), (known, ..)) = (self.parts(z), self.parts(&self.reference));
        let drift = self.drift();
        let across = drift.iter().zip(u.iter().zip(known)).map(|(d, (u, k))| d * (u - k));
        out[u.len()] = across.sum::<f64>() / size;
    }

    fn solve_bordered(
        &mut self,
        z: &[f64],
        border: &[f64],
        right: &[f64],
        weights: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        factorised_with(self.jacobian(z)?, border, right, weights)
    }

    fn weights(&self, z: &[f64]) -> Vec<f64> {
        let (u, omega, value) = self.parts(z);
        let motion = self.motion(u).max(f64::MIN_POSITIVE).recip();
        let mut weights = vec![motion; u.len()];
        weights.extend([omega.recip(), value.abs().max(f64::MIN_POSITIVE).recip()]);
        weights
    }

    fn accept(&mut self, z: &[f64]) {
        self.reference = z.to_vec();
        self.size = self.motion(self.parts(z).0).max(f64::MIN_POSITIVE);
    }

    fn interrupted(&self) -> bool {
        (self.interrupted)()
    }
}
