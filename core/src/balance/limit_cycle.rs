//! The harmonic balance of a limit cycle: `U = G(ω, r) Q(U)` with the frequency as an unknown.
//!
//! Nothing drives the motion, so that its phase is free; it is held relative to the last accepted
//! point, across the velocity of that point. Condensed to the contact displacements the equations
//! do not grow with the structure (Guillen 1999, section 5.3.1, takes this to be impossible).

use super::condensed::{gathered_load, scattered};
use super::unknowns::{gather, Unknowns};
use crate::contact::{ContactLaw, Motion, Residual, SlipLoad};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::FlutterModel;
use crate::solve::{norm, Curve};
use crate::structure::CompliancePartials;
use faer::{c64, Mat};

/// The equations of a limit cycle in the unknowns `(U, ω, scalar)`.
pub struct CycleBalance<'a> {
    pub(super) family: &'a FlutterModel<'a>,
    pub(super) table: &'a SampleTable,
    interrupted: &'a dyn Fn() -> bool,
    /// Of the last evaluation.
    pub(super) at: Option<Evaluation>,
    /// Last accepted point, and the size of its motion.
    reference: Vec<f64>,
    size: f64,
    /// Evaluations of the laws so far.
    pub evaluations: usize,
}

/// What the equations are made of at a point.
pub(super) struct Evaluation {
    z: Vec<f64>,
    pub(super) laws: Vec<Box<dyn ContactLaw>>,
    pub(super) stiffness: Mat<f64>,
    pub(super) ratio: f64,
    answers: Vec<CompliancePartials>,
    pub(super) loads: Vec<SlipLoad>,
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

    fn slots(&self) -> usize {
        self.table.harmonics().slots()
    }

    /// Contact displacements, ω and scalar.
    fn parts<'b>(&self, z: &'b [f64]) -> (&'b [f64], f64, f64) {
        let (u, rest) = z.split_at(z.len().saturating_sub(2));
        match rest {
            [omega, value] => (u, *omega, *value),
            _ => (u, f64::NAN, f64::NAN),
        }
    }

    /// Motion of the points of contact `index`.
    pub(super) fn motion<'b>(&'b self, index: usize, u: &'b [f64]) -> Motion<'b> {
        let (slots, points) = (self.slots(), &self.family.model().points()[index]);
        Motion {
            table: self.table,
            displacement: &u[points.start * slots..points.end * slots],
            residual: Residual::Centred,
        }
    }

    /// Slip loads of all points at the last evaluation.
    pub(super) fn slip_load(&self) -> Vec<f64> {
        let loads = self.at.iter().flat_map(|at| &at.loads);
        loads.flat_map(|load| load.value.iter().copied()).collect()
    }

    /// Evaluates laws and compliances at a point; `false` where they are not defined.
    pub(super) fn evaluate(&mut self, z: &[f64]) -> bool {
        if self.at.as_ref().is_some_and(|at| at.z == z) {
            return true;
        }
        self.at = None;
        let (u, omega, value) = self.parts(z);
        let sound = omega > 0.0 && omega.is_finite() && value.is_finite() && norm(u).is_finite();
        let Ok(laws) = self.family.laws_at(value) else { return false };
        if !sound {
            return false;
        }
        let points = self.family.model().points();
        let mut stiffness = self.family.model().contact_stiffness().clone();
        for (law, range) in laws.iter().zip(points) {
            stiffness.get_mut(range.clone(), range.clone()).copy_from(&law.stiffness());
        }
        let ratio = self.family.ratio_at(value);
        let compliance = self.family.destabilised();
        let answer = |order| compliance.answer(order, omega, ratio, stiffness.as_ref());
        let answers = self.table.harmonics().orders().map(answer).collect();
        let mut loads = vec![SlipLoad::default(); laws.len()];
        for (index, load) in loads.iter_mut().enumerate() {
            laws[index].slip_load(self.motion(index, u), true, load);
        }
        self.evaluations += 1;
        self.at = Some(Evaluation { z: z.to_vec(), laws, stiffness, ratio, answers, loads });
        true
    }

    /// `A q` over all harmonics, for one of the matrices of an answer.
    fn product(&self, matrix: impl Fn(&CompliancePartials) -> &Mat<c64>, load: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; load.len()];
        let Some(at) = &self.at else { return out };
        let harmonics = self.table.harmonics();
        let mut q = Vec::new();
        for (answer, order) in at.answers.iter().zip(harmonics.orders()) {
            gather(harmonics, order, load, &mut q);
            let u = matrix(answer) * gathered_load(&q);
            scattered(harmonics, order, &u, &mut out);
        }
        out
    }

    /// Derivative of the contact forces in the scalar at fixed displacements.
    fn force_rate(&self, u: &[f64]) -> Vec<f64> {
        let (slots, points) = (self.slots(), self.family.model().points());
        let mut rate = vec![0.0; u.len()];
        let Some(at) = &self.at else { return rate };
        for change in self.family.changes() {
            let own = &points[change.contact];
            let range = own.start * slots..own.end * slots;
            let mut slope = vec![0.0; range.len()];
            let motion = self.motion(change.contact, u);
            at.laws[change.contact].parameter_slope(motion, change.parameter, &mut slope);
            let share = change.rate();
            rate[range].iter_mut().zip(slope).for_each(|(rate, slope)| *rate += share * slope);
        }
        rate
    }

    /// Rows of `I − G ∂Q`.
    fn fill(&self, at: &Evaluation, out: &mut Mat<f64>) {
        let (harmonics, slots) = (self.table.harmonics(), self.slots());
        let contacts = self.family.destabilised().contacts();
        for (load, points) in at.loads.iter().zip(self.family.model().points()) {
            if !load.active {
                continue;
            }
            let width = points.len() * slots;
            for (answer, order) in at.answers.iter().zip(harmonics.orders()) {
                let Some(slot) = harmonics.slot(order) else { continue };
                for target in 0..contacts {
                    let row = target * slots + slot;
                    for (local, source) in points.clone().enumerate() {
                        let g = answer.contact[(target, source)];
                        let first = (local * slots + slot) * width;
                        let (cosines, sines) =
                            load.tangent[first..first + 2 * width].split_at(width);
                        for (j, (a, b)) in cosines.iter().zip(sines).enumerate() {
                            let column = points.start * slots + j;
                            out[(row, column)] -= (g.re * a + g.im * b) / self.size;
                            out[(row + 1, column)] -= (g.re * b - g.im * a) / self.size;
                        }
                    }
                }
            }
        }
    }

    /// Velocity of the last accepted point, laid out as the displacements, over its size.
    fn drift(&self) -> Vec<f64> {
        let (u, ..) = self.parts(&self.reference);
        drift(self.table.harmonics(), u).iter().map(|v| v / self.size).collect()
    }

    /// The contact displacements of a point in the layout of a balance.
    #[must_use]
    pub fn series(&self, z: &[f64]) -> Unknowns {
        Unknowns::new(self.table.harmonics().clone(), self.parts(z).0.to_vec())
    }
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

    fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        if !self.evaluate(z) {
            out.fill(f64::NAN);
            return;
        }
        let (u, ..) = self.parts(z);
        let response = self.product(|answer| &answer.contact, &self.slip_load());
        for ((out, u), g) in out.iter_mut().zip(u).zip(&response) {
            *out = (u - g) / self.size;
        }
        let (known, ..) = self.parts(&self.reference);
        let drift = self.drift();
        let across = drift.iter().zip(u.iter().zip(known)).map(|(d, (u, k))| d * (u - k));
        out[u.len()] = across.sum::<f64>() / self.size;
    }

    fn jacobian(&mut self, z: &[f64], out: &mut Mat<f64>) {
        out.fill(0.0);
        if !self.evaluate(z) {
            out.fill(f64::NAN);
            return;
        }
        let (u, ..) = self.parts(z);
        let size = u.len();
        for i in 0..size {
            out[(i, i)] = self.size.recip();
        }
        let Some(at) = &self.at else { return };
        self.fill(at, out);
        let load = self.slip_load();
        let by_omega = self.product(|answer| &answer.by_omega, &load);
        let by_value = if self.family.changes().is_empty() {
            self.product(|answer| &answer.by_ratio, &load)
        } else {
            // dG Q + G dQ with dG = −G dD G and dQ = dD U − dF: at a solution, −G dF.
            self.product(|answer| &answer.contact, &self.force_rate(u))
                .iter()
                .map(|rate| -rate)
                .collect()
        };
        for i in 0..size {
            out[(i, size)] = -by_omega[i] / self.size;
            out[(i, size + 1)] = -by_value[i] / self.size;
        }
        for (j, d) in self.drift().iter().enumerate() {
            out[(size, j)] = d / self.size;
        }
    }

    fn weights(&self, z: &[f64]) -> Vec<f64> {
        let (u, omega, value) = self.parts(z);
        let motion = norm(u).max(f64::MIN_POSITIVE).recip();
        let mut weights = vec![motion; u.len()];
        weights.extend([omega.recip(), value.abs().max(f64::MIN_POSITIVE).recip()]);
        weights
    }

    fn accept(&mut self, z: &[f64]) {
        self.reference = z.to_vec();
        self.size = norm(self.parts(z).0).max(f64::MIN_POSITIVE);
    }

    fn interrupted(&self) -> bool {
        (self.interrupted)()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Jenkins;
    use crate::model::{Contact, Model, NegativeDamping, ParameterMode, Variation};
    use crate::structure::Structure;
    use faer::mat;

    fn model(coupled: bool) -> (Model, Mat<f64>) {
        let mass = mat![[2.0, 0.1], [0.1, 1.0]];
        let stiffness = mat![[300.0, -100.0], [-100.0, 150.0]];
        let damping = Mat::<f64>::zeros(2, 2);
        let structure =
            Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
        let contact = |row: [f64; 2], stiffness, slip_force| Contact {
            law: Box::new(Jenkins::new(stiffness, slip_force).unwrap()),
            rows: Mat::from_fn(1, 2, |_, j| row[j]),
        };
        let contacts = vec![contact([1.0, 0.0], 80.0, 0.3), contact([1.0, -1.0], 200.0, 0.2)];
        let negative =
            if coupled { mat![[-0.5, 0.2], [-0.1, -0.3]] } else { faer::Scale(-0.2) * &mass };
        (Model::new(structure, contacts, Vec::new()).unwrap(), negative)
    }

    #[test]
    fn jacobians_match_differences_of_the_residual() {
        let law = |name: &str| Variation::Law {
            parameter: name.to_owned(),
            contacts: vec![(0, None), (1, None)],
            common: ParameterMode::Factor,
        };
        for (coupled, variation) in [
            (false, Variation::Ratio),
            (true, Variation::Ratio),
            (false, law("stiffness")),
            (true, law("slip_force")),
        ] {
            let (model, negative) = model(coupled);
            let by_law = variation != Variation::Ratio;
            let family =
                FlutterModel::new(&model, NegativeDamping::Whole(negative), variation, 0.7)
                    .unwrap();
            let table = SampleTable::new(Harmonics::new(5, true));
            let size = 2 * table.harmonics().slots();
            let mut z: Vec<f64> =
                (0..size).map(|i| 0.02 * (1.0 + i as f64).sin() / (1.0 + i as f64 / 3.0)).collect();
            z.extend([9.0, 1.1]);
            let mut curve = CycleBalance::new(&family, &table, &z, &|| false);
            let unknowns = curve.unknowns();
            let mut jacobian = Mat::zeros(unknowns, unknowns);
            curve.jacobian(&z, &mut jacobian);
            let (mut ahead, mut behind) = (vec![0.0; unknowns - 1], vec![0.0; unknowns - 1]);
            // The derivative in a parameter of the laws is that of a solution.
            let last = if by_law { unknowns - 1 } else { unknowns };
            for j in 0..last {
                let h = 1e-6 * z[j].abs().max(1e-3);
                let mut shifted = z.clone();
                shifted[j] += h;
                curve.residual(&shifted, &mut ahead);
                shifted[j] -= 2.0 * h;
                curve.residual(&shifted, &mut behind);
                for i in 0..unknowns - 1 {
                    let difference = (ahead[i] - behind[i]) / (2.0 * h);
                    let scale = 1.0 + difference.abs() + jacobian.col(j).norm_max();
                    assert!((difference - jacobian[(i, j)]).abs() < 1e-6 * scale, "{i} {j}");
                }
            }
        }
    }
}
