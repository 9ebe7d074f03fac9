//! The equations of a nonlinear mode by the extended periodic motion concept (Krack 2015):
//! `(−k²ω²M + ikω(C − ξM) + K) X_k + F_k(X) = P_k`, of which only the static load P_0 acts, with
//! `X_1ᴴ M X_1 = a²`. The modal damping ratio is `ζ = ξ/(2ω)`.
//!
//! They are written in the modes of the stuck structure, of unit modal mass: there the structure is
//! nearly diagonal, contacts that stick leave it so, and nothing is singular at the frequency of the mode
//! itself, as the receptance is. Unknowns are the amplitudes over a, `Y = Φ⁻¹(X − X_rest)/a`, so that one
//! decade of amplitudes is like the next; and ω, ξ and ln a.

use crate::contact::{Motion, Residual, SlipLoad};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::{ModalBases, ModalBasis, Model};
use crate::solve::{gmres, norm, KrylovSettings};
use crate::timing::Profile;
use faer::MatRef;
use std::sync::Arc;
use std::time::Instant;

/// Rows are scaled by their own diagonal entry, but by no less than this share of the squared frequency:
/// that of the mode itself vanishes.
const FLOOR: f64 = 0.05;
/// Relative residual of linear equations: Newton's method squares the rest.
const LINEAR: f64 = 1e-6;
/// Most products with the tangent per Newton step.
const PRODUCTS: usize = 400;
/// Step after which Newton's method has one that squares it behind it.
const CLOSE: f64 = 1e-8;
/// Newton iterations.
const ITERATIONS: usize = 20;
/// Shortest damped step.
const SHORTEST: f64 = 1.0 / 32.0;
/// Step over the size of the unknowns beyond which the equations say nothing.
const FAR: f64 = 2.0;

/// One more condition, `normal · z = value`, that singles out a point of the curve.
pub(super) struct Plane {
    pub(super) normal: Vec<f64>,
    pub(super) value: f64,
}

/// The equations in one set of harmonics.
pub(super) struct ModeEquations<'a> {
    pub(super) model: &'a Model,
    pub(super) bases: ModalBases,
    pub(super) table: Arc<SampleTable>,
    /// Assumed residual force of every contact.
    pub(super) residuals: Vec<Residual>,
    /// Modal displacement at rest [m √kg].
    pub(super) rest: Vec<f64>,
    /// ω and ξ count in units of it [rad/s].
    pub(super) unit: f64,
    /// Fundamental of the last point, against which the phase is held.
    reference: Vec<f64>,
    /// Scales of the rows of modes.
    scales: Vec<f64>,
    /// Contact displacements and slip loads evaluated last.
    pub(super) contact: Vec<f64>,
    pub(super) loads: Vec<SlipLoad>,
    /// Work so far.
    pub(super) profile: Profile,
    /// Products with the tangent so far.
    pub(super) products: usize,
}

impl<'a> ModeEquations<'a> {
    pub(super) fn new(
        model: &'a Model,
        bases: ModalBases,
        table: Arc<SampleTable>,
        residuals: Vec<Residual>,
        rest: Vec<f64>,
        unit: f64,
    ) -> Self {
        Self {
            loads: vec![SlipLoad::default(); model.laws().len()],
            model,
            bases,
            table,
            residuals,
            rest,
            unit,
            reference: Vec::new(),
            scales: Vec::new(),
            contact: Vec::new(),
            profile: Profile::default(),
            products: 0,
        }
    }

    /// The same in the harmonics of another table.
    pub(super) fn with_table(&self, table: Arc<SampleTable>) -> Self {
        let (bases, rest) = (self.bases.clone(), self.rest.clone());
        Self::new(self.model, bases, table, self.residuals.clone(), rest, self.unit)
    }

    pub(super) fn harmonics(&self) -> &Harmonics {
        self.table.harmonics()
    }

    pub(super) fn basis(&self, order: usize) -> &ModalBasis {
        self.bases.at(order)
    }

    /// Number of modes.
    pub(super) fn modes(&self) -> usize {
        self.basis(1).modes()
    }

    /// Number of unknowns: amplitudes, ω, ξ, ln a.
    pub(super) fn unknowns(&self) -> usize {
        self.modes() * self.harmonics().slots() + 3
    }

    /// Where the amplitudes of an order stand among the unknowns: of all modes the cosines, then the
    /// sines.
    pub(super) fn range(&self, order: usize) -> std::ops::Range<usize> {
        let (modes, slot) = (self.modes(), self.harmonics().slot(order).unwrap_or(0));
        let width = if order == 0 { 1 } else { 2 };
        modes * slot..modes * (slot + width)
    }

    /// The amplitudes of an order, modes × (cosine, sine).
    pub(super) fn part<'b>(&self, values: &'b [f64], order: usize) -> MatRef<'b, f64> {
        let width = if order == 0 { 1 } else { 2 };
        MatRef::from_column_major_slice(&values[self.range(order)], self.modes(), width)
    }

    /// ω and ξ [rad/s] and a [m √kg] of a point.
    pub(super) fn scalars(&self, z: &[f64]) -> [f64; 3] {
        let [omega, excess, log] = [3, 2, 1].map(|back| z[z.len() - back]);
        [self.unit * omega, self.unit * excess, log.exp()]
    }

    /// Makes a point the one that phases and scales are relative to.
    pub(super) fn accept(&mut self, z: &[f64]) {
        let [omega, excess, _] = self.scalars(z);
        self.reference = z[self.range(1)].to_vec();
        let mut scales = vec![1.0; z.len() - 3];
        for order in self.harmonics().orders() {
            let (basis, range, modes) = (self.basis(order), self.range(order), self.modes());
            let frequency = order as f64 * omega;
            for (i, scale) in scales[range].iter_mut().enumerate() {
                let j = i % modes;
                let stiffness = basis.squared[j] - frequency.powi(2);
                let damping = frequency * (basis.damping[j] - excess);
                let floor = FLOOR * basis.squared[j].abs().max(frequency.powi(2));
                *scale = stiffness.signum() / stiffness.abs().max(damping.abs()).max(floor);
            }
        }
        self.scales = scales;
    }

    /// `Re Σ B Φ Y_k` at the contacts, point after point; `factor` multiplies the amplitudes, and the
    /// state at rest is added to them if `whole`.
    pub(super) fn at_contacts(&self, y: &[f64], factor: f64, whole: bool) -> Vec<f64> {
        let slots = self.harmonics().slots();
        let points = self.model.compliance().contacts();
        let mut out = vec![0.0; points * slots];
        for order in self.harmonics().orders() {
            let Some(slot) = self.harmonics().slot(order) else { continue };
            let mut part = faer::Scale(factor) * self.part(y, order);
            if order == 0 && whole {
                self.rest.iter().enumerate().for_each(|(j, rest)| part[(j, 0)] += rest);
            }
            let moved = self.basis(order).contacts.times(part.as_ref());
            for point in 0..points {
                for column in 0..moved.ncols() {
                    out[point * slots + slot + column] = moved[(point, column)];
                }
            }
        }
        out
    }

    /// Takes the modal forces of contact loads, laid out point after point, times `share` off the rows.
    fn subtract_forces(&self, load: &[f64], share: f64, rows: &mut [f64]) {
        let slots = self.harmonics().slots();
        let points = self.model.compliance().contacts();
        for order in self.harmonics().orders() {
            let Some(slot) = self.harmonics().slot(order) else { continue };
            let width = if order == 0 { 1 } else { 2 };
            let own = faer::Mat::from_fn(points, width, |i, j| load[i * slots + slot + j]);
            let force = self.basis(order).contacts.adjoint_times(own.as_ref());
            let modes = force.nrows();
            for (i, row) in rows[self.range(order)].iter_mut().enumerate() {
                *row -= share * force[(i % modes, i / modes)];
            }
        }
    }

    /// Adds what the linear structure makes of amplitudes at (ω, ξ), with the factors
    /// `[stiffness and mass, damping, excess]` of its parts; those of a derivative in ω or ξ differ.
    fn add_structure(&self, y: &[f64], parts: impl Fn(usize) -> [f64; 4], rows: &mut [f64]) {
        for order in self.harmonics().orders() {
            let (basis, own) = (self.basis(order), self.part(y, order));
            let [stiffness, inertia, damping, excess] = parts(order);
            let (modes, range) = (own.nrows(), self.range(order));
            let rows = &mut rows[range];
            let coupled = basis.coupling.as_ref().filter(|_| order > 0 && damping != 0.0);
            let coupled = coupled.map(|coupling| coupling.times(own));
            for j in 0..modes {
                let elastic = stiffness * basis.squared[j] - inertia;
                rows[j] += elastic * own[(j, 0)];
                if order == 0 {
                    continue;
                }
                let viscous = damping * basis.damping[j] - excess;
                rows[modes + j] += elastic * own[(j, 1)] - viscous * own[(j, 0)];
                rows[j] += viscous * own[(j, 1)];
                if let Some(coupled) = &coupled {
                    rows[j] += damping * coupled[(j, 1)];
                    rows[modes + j] -= damping * coupled[(j, 0)];
                }
            }
        }
    }

    /// Residual at a point, all but the last row: modes, amplitude and phase; not a number where it is
    /// not defined.
    pub(super) fn evaluate(&mut self, z: &[f64], tangent: bool) -> Vec<f64> {
        let [omega, excess, amplitude] = self.scalars(z);
        let size = z.len() - 3;
        let mut out = vec![f64::NAN; size + 2];
        if !(omega > 0.0 && amplitude > 0.0 && amplitude.is_finite() && norm(z).is_finite()) {
            return out;
        }
        self.contact = self.at_contacts(&z[..size], amplitude, true);
        let mut loads = std::mem::take(&mut self.loads);
        let start = Instant::now();
        for (index, (law, load)) in self.model.laws().iter().zip(&mut loads).enumerate() {
            law.slip_load(self.motion(index), tangent, load);
        }
        self.profile.law += start.elapsed();
        self.profile.evaluations += 1;
        self.loads = loads;
        out[..size].fill(0.0);
        self.add_structure(&z[..size], |order| dynamic(order, omega, excess), &mut out[..size]);
        self.subtract_forces(&self.slip_load(), amplitude.recip(), &mut out[..size]);
        if self.harmonics().has_mean() {
            let (basis, range) = (self.basis(0), self.range(0));
            for (j, row) in out[range].iter_mut().enumerate() {
                let balance = basis.squared[j] * self.rest[j] - basis.load[j];
                *row = if basis.free[j] { z[j] } else { *row + balance / amplitude };
            }
        }
        out[..size].iter_mut().zip(&self.scales).for_each(|(row, scale)| *row *= scale);
        let first = &z[self.range(1)];
        out[size] = 0.5 * (first.iter().map(|y| y * y).sum::<f64>() - 1.0);
        out[size + 1] = self.lag(first);
        out
    }

    /// Motion of the points of a contact, as evaluated last.
    pub(super) fn motion(&self, contact: usize) -> Motion<'_> {
        let (slots, points) = (self.harmonics().slots(), &self.model.points()[contact]);
        Motion {
            table: &self.table,
            displacement: &self.contact[points.start * slots..points.end * slots],
            residual: self.residuals[contact],
        }
    }

    /// Slip loads evaluated last, point after point.
    pub(super) fn slip_load(&self) -> Vec<f64> {
        self.loads.iter().flat_map(|load| &load.value).copied().collect()
    }

    /// Phase of a fundamental against the last point, times its size.
    fn lag(&self, first: &[f64]) -> f64 {
        let modes = first.len() / 2;
        let known = &self.reference;
        (0..modes).map(|j| known[modes + j] * first[j] - known[j] * first[modes + j]).sum()
    }

    /// Rates of the residual in ω, ξ and ln a, in their units, at the point evaluated last.
    fn scalar_rates(&mut self, z: &[f64]) -> [Vec<f64>; 3] {
        let [omega, excess, _] = self.scalars(z);
        let size = z.len() - 3;
        let unit = self.unit;
        let mut rates = [(); 3].map(|()| vec![0.0; size + 2]);
        let by_omega = |order: usize| {
            let k = order as f64 * unit;
            [0.0, 2.0 * k * order as f64 * omega, k, k * excess]
        };
        let by_excess = |order: usize| [0.0, 0.0, 0.0, order as f64 * omega * unit];
        self.add_structure(&z[..size], by_omega, &mut rates[0][..size]);
        self.add_structure(&z[..size], by_excess, &mut rates[1][..size]);
        for rate in &mut rates[..2] {
            rate[..size].iter_mut().zip(&self.scales).for_each(|(row, scale)| *row *= scale);
        }
        // All amplitudes grow alike, and the residual counts in units of a.
        self.add_modal_product(z, &z[..size], &mut rates[2]);
        rates
    }

    /// Adds the product of the rows of modes with a change of the amplitudes.
    fn add_modal_product(&self, z: &[f64], change: &[f64], out: &mut [f64]) {
        let [omega, excess, _] = self.scalars(z);
        let size = change.len();
        let slots = self.harmonics().slots();
        let mut rows = vec![0.0; size];
        self.add_structure(change, |order| dynamic(order, omega, excess), &mut rows);
        if self.loads.iter().any(|load| load.active) {
            let moved = self.at_contacts(change, 1.0, false);
            let mut load = vec![0.0; moved.len()];
            for (own, points) in self.loads.iter().zip(self.model.points()) {
                if own.active {
                    let range = points.start * slots..points.end * slots;
                    let tangent =
                        MatRef::from_row_major_slice(&own.tangent, range.len(), range.len());
                    let moved = faer::ColRef::from_slice(&moved[range.clone()]);
                    let product = tangent * moved;
                    load[range].iter_mut().enumerate().for_each(|(i, q)| *q = product[i]);
                }
            }
            self.subtract_forces(&load, 1.0, &mut rows);
        }
        if self.harmonics().has_mean() {
            let (basis, range) = (self.basis(0), self.range(0));
            for (j, row) in rows[range].iter_mut().enumerate() {
                *row = if basis.free[j] { change[j] } else { *row };
            }
        }
        for ((out, row), scale) in out.iter_mut().zip(&rows).zip(&self.scales) {
            *out += row * scale;
        }
    }

    /// Product of the tangent at the point evaluated last with a change of all unknowns.
    fn product(&self, z: &[f64], rates: &[Vec<f64>; 3], change: &[f64], out: &mut [f64]) {
        let size = z.len() - 3;
        out.fill(0.0);
        self.add_modal_product(z, &change[..size], out);
        for (rate, by) in rates.iter().zip(&change[size..]) {
            out.iter_mut().zip(rate).for_each(|(out, rate)| *out += by * rate);
        }
        let range = self.range(1);
        let along = z[range.clone()].iter().zip(&change[range.clone()]).map(|(a, b)| a * b);
        out[size] = along.sum();
        out[size + 1] = self.lag(&change[range]);
    }

    /// Newton's step at the point evaluated last with its tangent.
    pub(super) fn step(&mut self, z: &[f64], residual: &[f64], plane: &Plane) -> Option<Vec<f64>> {
        let start = Instant::now();
        let rates = self.scalar_rates(z);
        let size = z.len();
        let mut rhs: Vec<f64> = residual.iter().map(|r| -r).collect();
        let along: f64 = plane.normal.iter().zip(z).map(|(n, z)| n * z).sum();
        rhs.push(plane.value - along);
        let mut step = vec![0.0; size];
        let report = gmres(
            |change, out| {
                self.product(z, &rates, change, &mut out[..size - 1]);
                out[size - 1] = plane.normal.iter().zip(change).map(|(n, c)| n * c).sum();
                true
            },
            &rhs,
            &mut step,
            KrylovSettings { tolerance: LINEAR, max_products: PRODUCTS },
        );
        self.products += report.products;
        self.profile.linear_solve += start.elapsed();
        (report.residual < 0.1 && step.iter().all(|s| s.is_finite())).then_some(step)
    }

    /// Newton's method from `z` on a plane; the number of its iterations, if it converges. The equations
    /// are left evaluated at the solution.
    pub(super) fn solve(
        &mut self,
        z: &mut [f64],
        plane: &Plane,
        go_on: &dyn Fn() -> bool,
    ) -> Option<usize> {
        self.accept_scales(z);
        let mut residual = self.evaluate(z, true);
        for iteration in 1..=ITERATIONS {
            let before = norm(&residual);
            if !before.is_finite() || !go_on() {
                return None;
            }
            let step = self.step(z, &residual, plane)?;
            let length = norm(&step);
            // The mean counts in units of the amplitude too, but may be far larger.
            let mean = if self.harmonics().has_mean() { self.modes() } else { 0 };
            let mut share = (FAR / norm(&step[mean..])).min(1.0);
            let start = z.to_vec();
            loop {
                z.iter_mut()
                    .zip(start.iter().zip(&step))
                    .for_each(|(z, (s, d))| *z = s + share * d);
                residual = self.evaluate(z, true);
                let after = norm(&residual);
                // A step this short is rounding, and the residual with it.
                if after <= (1.0 - 0.1 * share) * before || (length <= CLOSE && after.is_finite()) {
                    break;
                }
                // Off the plane the residual is not all that there is to gain.
                let off: f64 = plane.normal.iter().zip(&start).map(|(n, z)| n * z).sum();
                if (off - plane.value).abs() > before && after.is_finite() {
                    break;
                }
                share *= 0.5;
                if share < SHORTEST {
                    return None;
                }
            }
            if share == 1.0 && length <= CLOSE {
                return Some(iteration);
            }
        }
        None
    }

    /// Scales rows for a point whose phase is still held against the last one.
    fn accept_scales(&mut self, z: &[f64]) {
        let reference = std::mem::take(&mut self.reference);
        self.accept(z);
        if !reference.is_empty() {
            self.reference = reference;
        }
    }

    /// Moves the state at rest to the mean of a point, whose mean becomes zero.
    pub(super) fn rebase(&mut self, z: &mut [f64]) {
        if self.harmonics().has_mean() {
            let [.., amplitude] = self.scalars(z);
            let range = self.range(0);
            for (rest, mean) in self.rest.iter_mut().zip(&mut z[range]) {
                *rest += amplitude * *mean;
                *mean = 0.0;
            }
        }
    }
}

/// Factors of stiffness, inertia, damping and excess at an order.
fn dynamic(order: usize, omega: f64, excess: f64) -> [f64; 4] {
    let frequency = order as f64 * omega;
    [1.0, frequency.powi(2), frequency, frequency * excess]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Closure, Coulomb, Jenkins};
    use crate::model::Contact;
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, mat};

    #[test]
    fn tangents_match_differences() {
        let structure = Structure::new(
            mat![[2.0, 0.1], [0.1, 1.0]].as_ref(),
            mat![[0.5, -0.1], [0.2, 0.4]].as_ref(),
            mat![[300.0, -100.0], [-100.0, 150.0]].as_ref(),
        )
        .unwrap();
        let pad = Coulomb::new(1, 0.4, 80.0, Some(120.0), Closure::Preload(0.5)).unwrap();
        let contacts = vec![
            Contact { law: Box::new(pad), rows: mat![[1.0, 0.0], [0.0, 1.0]] },
            Contact { law: Box::new(Jenkins::new(60.0, 0.2).unwrap()), rows: mat![[1.0, -1.0]] },
        ];
        let load = vec![c64::new(0.1, 0.0), c64::new(-0.2, 0.0)];
        let load = HarmonicLoad { harmonic: 0, amplitude: load };
        let model = Model::new(structure, contacts, vec![load]).unwrap();
        let table = Arc::new(SampleTable::new(Harmonics::new(3, false)));
        let bases = model.modal_bases(3).unwrap();
        let rest = vec![1e-3, -2e-3];
        let mut equations =
            ModeEquations::new(&model, bases, table, vec![Residual::Centred; 2], rest, 10.0);
        let size = equations.unknowns();
        let mut z: Vec<f64> = (0..size).map(|i| 0.3 * (1.0 + 1.7 * i as f64).sin()).collect();
        (z[size - 3], z[size - 2], z[size - 1]) = (1.1, 0.03, 0.01_f64.ln());
        let mut other = z.clone();
        other[3] += 0.2;
        equations.accept(&other);
        let residual = equations.evaluate(&z, true);
        assert!(equations.loads.iter().all(|load| load.active));
        let rates = equations.scalar_rates(&z);
        let columns: Vec<Vec<f64>> = (0..size)
            .map(|j| {
                let mut unit = vec![0.0; size];
                unit[j] = 1.0;
                let mut column = vec![0.0; size - 1];
                equations.product(&z, &rates, &unit, &mut column);
                column
            })
            .collect();
        for (j, column) in columns.iter().enumerate() {
            let h = 1e-6;
            let mut at = |by: f64| {
                let mut moved = z.clone();
                moved[j] += by;
                equations.evaluate(&moved, false)
            };
            let (ahead, behind) = (at(h), at(-h));
            for i in 0..size - 1 {
                let mut difference = (ahead[i] - behind[i]) / (2.0 * h);
                if j == size - 1 && i < size - 3 {
                    // The rate in ln a leaves out what vanishes with the residual.
                    difference += residual[i];
                }
                let scale = column[i].abs().max(1.0);
                assert!(
                    (difference - column[i]).abs() < 1e-6 * scale,
                    "{i} {j} {difference} {}",
                    column[i]
                );
            }
        }
    }
}
