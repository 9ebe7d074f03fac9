//! The equations of a nonlinear mode by the extended periodic motion concept (Krack 2015):
//! `(−k²ω²M + ikω(C − ξM) + K) X_k + F_k(X) = P_k`, of which only the static load P_0 acts, with
//! `X_1ᴴ M X_1 = a²`. The modal damping ratio is `ζ = ξ/(2ω)`.
//!
//! They are written in the modes of the stuck structure, of unit modal mass: there the structure is
//! nearly diagonal, contacts that stick leave it so, and nothing is singular at the frequency of the mode
//! itself, as the receptance is. Unknowns are the amplitudes over a, `Y = Φ⁻¹(X − X_rest)/a`, so that one
//! decade of amplitudes is like the next; and ω, ξ and ln a.

use super::feed::Feed;
use super::preconditioner::Preconditioner;
use crate::balance::Progress;
use crate::contact::{Motion, Residual, SlipLoad};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::{ModalBases, ModalBasis, Model};
use crate::solve::{multiply, norm};
use crate::timing::Profile;
use faer::{Accum, ColRef, MatMut, MatRef};
use std::cell::Cell;
use std::sync::Arc;
use std::time::Instant;

/// Rows are scaled by their own diagonal entry, but by no less than this share of the squared frequency:
/// that of the mode itself vanishes.
pub(super) const FLOOR: f64 = 0.05;

/// Relative residual of linear equations: Newton's method squares the rest.
const LINEAR: f64 = 1e-4;
/// Share of the stiffness of means that tangents keep.
const HELD: f64 = 1e-6;

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
    /// What keeps the motion up.
    pub(super) feed: Feed,
    /// Row of the condition on the phase, in the fundamental: against that of the last point, or of the
    /// force.
    pub(super) phase: Vec<f64>,
    /// Scales of the rows of modes.
    pub(super) scales: Vec<f64>,
    /// Point that was evaluated last.
    pub(super) at: Vec<f64>,
    /// What the linear equations of the last points were solved with.
    pub(super) preconditioner: Option<Preconditioner>,
    /// Ends the analysis if it says so, …
    pub(super) progress: &'a Progress<'a>,
    /// … and how far it has come.
    pub(super) share: Cell<f64>,
    /// Contact displacements and slip loads evaluated last.
    pub(super) contact: Vec<f64>,
    pub(super) loads: Vec<SlipLoad>,
    /// Work so far.
    pub(super) profile: Profile,
    /// Relative residual of linear equations that are solved by iteration.
    pub(super) linear: f64,
}

impl<'a> ModeEquations<'a> {
    pub(super) fn new(
        model: &'a Model,
        bases: ModalBases,
        table: Arc<SampleTable>,
        residuals: Vec<Residual>,
        rest: Vec<f64>,
        feed: Feed,
        progress: &'a Progress<'a>,
    ) -> Self {
        Self {
            loads: vec![SlipLoad::default(); model.laws().len()],
            model,
            bases,
            table,
            residuals,
            rest,
            unit: 1.0,
            feed,
            phase: Vec::new(),
            scales: Vec::new(),
            at: Vec::new(),
            preconditioner: None,
            progress,
            share: Cell::new(0.0),
            contact: Vec::new(),
            profile: Profile::default(),
            linear: LINEAR,
        }
    }

    /// The same in the harmonics of another table.
    pub(super) fn with_table(&self, table: Arc<SampleTable>) -> Self {
        Self {
            unit: self.unit,
            profile: Profile::default(),
            ..Self::new(
                self.model,
                self.bases.clone(),
                table,
                self.residuals.clone(),
                self.rest.clone(),
                self.feed.clone(),
                self.progress,
            )
        }
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

    /// Number of unknowns: amplitudes, ω, ξ or the force, ln a.
    pub(super) fn size(&self) -> usize {
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

    /// ω and ξ [rad/s] and a [m √kg] of a point; a force is no ξ.
    pub(super) fn scalars(&self, z: &[f64]) -> [f64; 3] {
        let [omega, feed, log] = [3, 2, 1].map(|back| z[z.len() - back]);
        let excess = if matches!(self.feed, Feed::Damping) { self.unit * feed } else { 0.0 };
        [self.unit * omega, excess, log.exp()]
    }

    /// Makes a point the one that phases and scales are relative to.
    pub(super) fn hold(&mut self, z: &[f64]) {
        let [omega, excess, _] = self.scalars(z);
        self.phase = self.feed.phase(&z[self.range(1)]);
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
        if let Some(shapes) = self.bases.common() {
            let amplitudes = MatRef::from_column_major_slice(
                &y[..shapes.ncols() * slots],
                shapes.ncols(),
                slots,
            );
            let moved = MatMut::from_row_major_slice_mut(&mut out, points, slots);
            multiply(moved, Accum::Replace, shapes, amplitudes, factor);
            if whole && self.harmonics().has_mean() {
                let rest = shapes * ColRef::from_slice(&self.rest);
                out.iter_mut().step_by(slots).zip(rest.iter()).for_each(|(u, rest)| *u += rest);
            }
            return out;
        }
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
    pub(super) fn subtract_forces(&self, load: &[f64], share: f64, rows: &mut [f64]) {
        let slots = self.harmonics().slots();
        let points = self.model.compliance().contacts();
        if let Some(shapes) = self.bases.common() {
            let load = MatRef::from_row_major_slice(load, points, slots);
            let size = shapes.ncols() * slots;
            let rows =
                MatMut::from_column_major_slice_mut(&mut rows[..size], shapes.ncols(), slots);
            return multiply(rows, Accum::Add, shapes.transpose(), load, -share);
        }
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
    pub(super) fn add_structure(
        &self,
        y: &[f64],
        parts: impl Fn(usize) -> [f64; 4],
        rows: &mut [f64],
    ) {
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

    /// Residual at a point: modes, amplitude and phase; not a number where it is not defined.
    pub(super) fn evaluate(&mut self, z: &[f64]) -> Vec<f64> {
        let [omega, excess, amplitude] = self.scalars(z);
        let size = z.len() - 3;
        let mut out = vec![f64::NAN; size + 2];
        if !(omega > 0.0 && amplitude > 0.0 && amplitude.is_finite() && norm(z).is_finite()) {
            return out;
        }
        self.at = z.to_vec();
        self.contact = self.at_contacts(&z[..size], amplitude, true);
        let mut loads = std::mem::take(&mut self.loads);
        let start = Instant::now();
        for (index, (law, load)) in self.model.laws().iter().zip(&mut loads).enumerate() {
            law.slip_load(self.motion(index), true, load);
        }
        self.profile.law += start.elapsed();
        self.profile.evaluations += 1;
        self.hold_means(&mut loads);
        self.loads = loads;
        out[..size].fill(0.0);
        self.add_structure(&z[..size], |order| dynamic(order, omega, excess), &mut out[..size]);
        self.subtract_forces(&self.slip_load(), amplitude.recip(), &mut out[..size]);
        if let Feed::Force(shape, _) = &self.feed {
            let range = self.range(1);
            Feed::add_force(shape, -z[size + 1] * self.unit.powi(2), &mut out[range]);
        }
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
        out[size + 1] = first.iter().zip(&self.phase).map(|(y, row)| y * row).sum();
        out
    }

    /// Leaves a little of their stiffness to means in the tangents: a body that nothing but sliding or
    /// open contacts hold has no mean position, and stays where it is. What is solved is not changed.
    fn hold_means(&self, loads: &mut [SlipLoad]) {
        if !self.harmonics().has_mean() {
            return;
        }
        let slots = self.harmonics().slots();
        for load in loads.iter_mut().filter(|load| load.active) {
            let size = load.value.len();
            for row in load.tangent.chunks_exact_mut(size).step_by(slots) {
                row.iter_mut().step_by(slots).for_each(|entry| *entry *= 1.0 - HELD);
            }
        }
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

    /// Whether the caller wants to end the analysis.
    pub(super) fn is_interrupted(&self) -> bool {
        !(self.progress)(self.share.get())
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
pub(super) fn dynamic(order: usize, omega: f64, excess: f64) -> [f64; 4] {
    let frequency = order as f64 * omega;
    [1.0, frequency.powi(2), frequency, frequency * excess]
}
