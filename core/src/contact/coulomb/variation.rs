//! The derivative of slip in two directions, taken through a panel.
//!
//! The derivative of φ in the coefficients of K and M follows from the panel's own matrix: gains on the
//! derivative at its start and on what changes φ' at the nodes serve all columns.

use super::collocation::{Collocation, Lanes, NODES};
use super::drive::Drive;
use super::panel::{product, Panel};
use crate::solve::multiply;
use faer::{Accum, Mat};
use pulp::{Arch, Simd, WithSimd};

/// Columns of a product that share its factors.
const TILE: usize = 4;
/// Panels whose products are summed at once: the sums are long, and are passed through once for all of them.
const TOGETHER: usize = 16;

/// Derivatives of the Fourier integrals of the traction over panels, summed over many panels at once.
pub(super) struct RateIntegrals {
    /// Basis at the nodes of the panels at hand, slot after slot.
    basis: Mat<f64>,
    /// Derivatives of the weighted traction there, both directions one after the other, column after column.
    traction: Mat<f64>,
    /// Integrals, slot after slot in columns of the derivative.
    sums: Mat<f64>,
    /// Nodes at hand.
    nodes: usize,
}

impl RateIntegrals {
    /// None yet, over so many panels, of so many slots in so many columns per direction.
    pub(super) fn new(panels: usize, slots: usize, width: usize) -> Self {
        let most = panels.min(TOGETHER) * NODES;
        Self {
            basis: Mat::zeros(most, slots),
            traction: Mat::zeros(most, 2 * width),
            sums: Mat::zeros(slots, 2 * width),
            nodes: 0,
        }
    }

    /// Adds a panel.
    pub(super) fn add(&mut self, panel: &Panel, weights: &Lanes, drive: &Drive<'_>) {
        let at = self.nodes;
        for (slot, basis) in panel.basis.iter().enumerate() {
            self.basis.col_as_slice_mut(slot)[at..at + NODES].copy_from_slice(basis);
        }
        panel.weigh_rates(weights, drive, &mut self.traction, at);
        self.nodes += NODES;
        if self.nodes == self.basis.nrows() {
            self.sum_up();
        }
    }

    fn sum_up(&mut self) {
        let basis = self.basis.get(..self.nodes, ..).transpose();
        let traction = self.traction.get(..self.nodes, ..);
        multiply(self.sums.as_mut(), Accum::Add, basis, traction, 1.0);
        self.nodes = 0;
    }

    /// Integrals of all panels.
    pub(super) fn into_sums(mut self) -> Mat<f64> {
        if self.nodes > 0 {
            self.sum_up();
        }
        self.sums
    }
}

impl Panel {
    /// Writes the derivatives of the traction at the nodes times weights, direction after direction,
    /// in columns of the derivative, in rows from `at` on.
    fn weigh_rates(&self, weights: &Lanes, drive: &Drive<'_>, out: &mut Mat<f64>, at: usize) {
        Arch::new().dispatch(Weighing { panel: self, weights, drive, out, at });
    }

    #[inline(always)]
    fn weighed(&self, weights: &Lanes, drive: &Drive<'_>, out: &mut Mat<f64>, at: usize) {
        let [cos, sin] = &self.direction;
        let (width, first) = (self.rate.len(), drive.pull.len());
        for (turned, direction, offset) in [(sin, cos, 0), (cos, sin, width)] {
            let sign = if offset == 0 { -1.0 } else { 1.0 };
            let (mut across, mut along) = ([0.0; NODES], [0.0; NODES]);
            for i in 0..NODES {
                across[i] = sign * weights[i] * self.limit()[i] * turned[i];
                along[i] = weights[i] * direction[i];
            }
            for (column, rate) in self.rate.iter().enumerate() {
                let row = &mut out.col_as_slice_mut(offset + column)[at..at + NODES];
                for i in 0..NODES {
                    row[i] = across[i] * rate[i];
                }
            }
            let constant = drive.pressing.is_none();
            for (column, basis) in self.basis.iter().enumerate().take(drive.limit_columns()) {
                let row = &mut out.col_as_slice_mut(offset + first + column)[at..at + NODES];
                let basis = if constant { &[1.0; NODES] } else { basis };
                for i in 0..NODES {
                    row[i] += along[i] * basis[i];
                }
            }
        }
    }

    /// Moves φ by a little along its last two columns.
    pub(super) fn correct(&mut self, by: [f64; 2]) {
        let [.., first, second] = &self.rate[..] else { return };
        for j in 0..NODES {
            let turned = first[j] * by[0] + second[j] * by[1];
            self.turned[j] += turned;
            let (own_sin, own_cos) = turned.sin_cos();
            let (cos, sin) = (self.direction[0][j], self.direction[1][j]);
            self.direction[0][j] = cos * own_cos - sin * own_sin;
            self.direction[1][j] = sin * own_cos + cos * own_sin;
        }
    }

    /// Takes the derivative of φ through the panel. Its columns are the coefficients of K and M, if
    /// `coefficients` are asked for, and others that the panel itself does not depend on.
    pub(super) fn carry(&mut self, drive: &Drive<'_>, coefficients: bool, rate: &mut [f64]) {
        Arch::new().dispatch(Carrying { panel: self, drive, coefficients, rate });
    }

    #[inline(always)]
    fn carried(&mut self, drive: &Drive<'_>, coefficients: bool, rate: &mut [f64]) {
        let factors = self.factors();
        let weights = self.weights();
        let mut by_end = self.restoring;
        for i in 0..NODES {
            by_end[i] *= weights[i];
        }
        // Gain on the start's derivative, at the nodes and at the end.
        let mut by_start = [1.0; NODES];
        factors.solve(&mut by_start);
        let last_by_start = 1.0 + product(&by_end, &by_start);
        self.rate.resize(rate.len(), [0.0; NODES]);
        if coefficients {
            self.sources(drive);
            // Gain on sources at the nodes.
            let mut gain = Collocation::get().integral;
            let mut last = weights;
            for (gain, last) in gain.iter_mut().zip(&mut last) {
                for entry in gain.iter_mut() {
                    *entry *= self.length;
                }
                factors.solve(gain);
                *last += product(&by_end, gain);
            }
            for (rates, starts) in self.rate.chunks_mut(TILE).zip(rate.chunks_mut(TILE)) {
                let mut source = [[0.0; NODES]; TILE];
                source[..rates.len()].copy_from_slice(rates);
                let mut sums = [[0.0; NODES]; TILE];
                for (j, gain) in gain.iter().enumerate() {
                    for (sum, source) in sums.iter_mut().zip(&source) {
                        for i in 0..NODES {
                            sum[i] = source[j].mul_add(gain[i], sum[i]);
                        }
                    }
                }
                rates.copy_from_slice(&sums[..rates.len()]);
                for ((rate, start), source) in rates.iter_mut().zip(starts).zip(&source) {
                    for i in 0..NODES {
                        rate[i] = start.mul_add(by_start[i], rate[i]);
                    }
                    *start = *start * last_by_start + product(&last, source);
                }
            }
            return;
        }
        for (rate, start) in self.rate.iter_mut().zip(rate) {
            *rate = by_start.map(|by| *start * by);
            *start *= last_by_start;
        }
    }

    /// Derivative of φ' in the coefficients of K and M, column after column.
    #[inline(always)]
    fn sources(&mut self, drive: &Drive<'_>) {
        let Self { rate, basis, direction, turning, nodes, .. } = self;
        let harmonics = drive.harmonics();
        let (slots, offset) = (harmonics.slots(), harmonics.offset());
        let (mut by_x, mut by_y, mut by_limit) = ([0.0; NODES], [0.0; NODES], [0.0; NODES]);
        for i in 0..NODES {
            by_x[i] = -direction[1][i] / nodes.limit[i];
            by_y[i] = direction[0][i] / nodes.limit[i];
            by_limit[i] = -turning[i] / nodes.limit[i];
        }
        rate.fill([0.0; NODES]);
        for (direction, by) in [by_x, by_y].iter().enumerate() {
            for (index, order) in harmonics.oscillating().iter().enumerate() {
                let (slot, order) = (offset + 2 * index, *order as f64);
                let (cos, sin) = (&basis[slot], &basis[slot + 1]);
                let columns = &mut rate[direction * slots + slot..][..2];
                for i in 0..NODES {
                    columns[0][i] = -order * by[i] * sin[i];
                    columns[1][i] = order * by[i] * cos[i];
                }
            }
        }
        if drive.pressing.is_none() {
            rate[2 * slots] = by_limit;
            return;
        }
        for (column, basis) in rate[2 * slots..].iter_mut().zip(basis) {
            for i in 0..NODES {
                column[i] = by_limit[i] * basis[i];
            }
        }
    }
}

/// A derivative to be taken through a panel.
struct Carrying<'a> {
    panel: &'a mut Panel,
    drive: &'a Drive<'a>,
    coefficients: bool,
    rate: &'a mut [f64],
}

impl WithSimd for Carrying<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.panel.carried(self.drive, self.coefficients, self.rate);
    }
}

/// Derivatives of a traction to be weighed.
struct Weighing<'a> {
    panel: &'a Panel,
    weights: &'a Lanes,
    drive: &'a Drive<'a>,
    out: &'a mut Mat<f64>,
    at: usize,
}

impl WithSimd for Weighing<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.panel.weighed(self.weights, self.drive, self.out, self.at);
    }
}
