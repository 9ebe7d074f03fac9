//! Slip of a Coulomb contact in two directions: the slip equation.
//!
//! The traction is `M e(φ)`, `e = (cos φ, sin φ)`. Projecting `K' = t' + λ e` on e and across,
//!
//! ```text
//! M φ' = K'·e⊥,     λ = K'·e − M',
//! ```
//!
//! and slip goes on while λ > 0.

use super::collocation::{Lanes, NODES};
use super::drive::Drive;
use crate::fourier::{cos_sin, doubled, rotate};
use std::cell::Cell;

/// The series that decide slip, and their values at angles.
pub(super) struct Plane<'a> {
    pub(super) drive: &'a Drive<'a>,
    /// Series of K', of M and of M', as far as it varies.
    pull_slope: [Vec<f64>; 2],
    limit: Vec<f64>,
    limit_slope: Vec<f64>,
    /// Longest panel.
    pub(super) longest: f64,
    /// Sizes of the limit, which errors are relative to, and of K.
    pub(super) scale: f64,
    pub(super) reach: f64,
    /// Panels solved for, of all laps.
    pub(super) solved: Cell<usize>,
}

/// K', M and M' at the nodes of a panel.
#[derive(Clone, Copy)]
pub(super) struct Nodes {
    pub(super) pull_slope: [Lanes; 2],
    pub(super) limit: Lanes,
    pub(super) limit_slope: Lanes,
}

impl<'a> Plane<'a> {
    pub(super) fn new(drive: &'a Drive<'a>) -> Self {
        let harmonics = drive.harmonics();
        let slope = |series: &[f64]| {
            let mut slope = vec![0.0; series.len()];
            for (index, order) in harmonics.oscillating().iter().enumerate() {
                let slot = harmonics.offset() + 2 * index;
                slope[slot] = *order as f64 * series[slot + 1];
                slope[slot + 1] = -(*order as f64) * series[slot];
            }
            slope
        };
        let limit = drive.limit();
        let varies = drive.pressing.is_some();
        let swing: f64 = limit.iter().map(|m| m.abs()).sum();
        Self {
            drive,
            pull_slope: [slope(drive.pull(0)), slope(drive.pull(1))],
            limit_slope: if varies { slope(&limit) } else { vec![0.0] },
            limit,
            // The quadrature has to resolve the highest harmonic.
            longest: (6.0 / harmonics.highest() as f64).min(1.0),
            scale: swing,
            reach: drive.pull.iter().map(|k| k.abs()).sum(),
            solved: Cell::new(0),
        }
    }

    /// What decides slip at angles so far from a `middle`, and the basis there, slot after slot.
    #[inline(always)]
    pub(super) fn nodes(&self, middle: f64, from: &Lanes, basis: &mut [Lanes]) -> Nodes {
        let harmonics = self.drive.harmonics();
        let (sin_middle, cos_middle) = middle.sin_cos();
        let [own_cos, own_sin] = cos_sin(from);
        let (mut cos, mut sin) = (own_cos, own_sin);
        for i in 0..cos.len() {
            cos[i] = cos_middle * own_cos[i] - sin_middle * own_sin[i];
            sin[i] = sin_middle * own_cos[i] + cos_middle * own_sin[i];
        }
        let step = if harmonics.half_wave() { doubled(&cos, &sin) } else { [cos, sin] };
        let varies = self.drive.pressing.is_some();
        let mut nodes = Nodes {
            pull_slope: [[0.0; NODES]; 2],
            limit: [self.limit[0]; NODES],
            limit_slope: [0.0; NODES],
        };
        let offset = harmonics.offset();
        basis[..offset].fill([1.0; NODES]);
        for (index, basis) in basis[offset..].chunks_exact_mut(2).enumerate() {
            let slot = offset + 2 * index;
            add(&mut nodes.pull_slope[0], [&cos, &sin], &self.pull_slope[0][slot..]);
            add(&mut nodes.pull_slope[1], [&cos, &sin], &self.pull_slope[1][slot..]);
            if varies {
                add(&mut nodes.limit, [&cos, &sin], &self.limit[slot..]);
                add(&mut nodes.limit_slope, [&cos, &sin], &self.limit_slope[slot..]);
            }
            (basis[0], basis[1]) = (cos, sin);
            rotate(&mut cos, &mut sin, &step);
        }
        nodes
    }

    /// λ at an angle with a direction of the traction.
    pub(super) fn slip_rate(&self, theta: f64, [cos, sin]: [f64; 2]) -> f64 {
        let (pull, pressing) = self.drive.at(theta);
        pull[0][1] * cos + pull[1][1] * sin - self.drive.friction * pressing[1]
    }
}

/// Adds a harmonic of a series.
#[inline(always)]
fn add(out: &mut Lanes, [cos, sin]: [&Lanes; 2], coefficients: &[f64]) {
    let (a, b) = (coefficients[0], coefficients[1]);
    for i in 0..NODES {
        out[i] = a.mul_add(cos[i], b.mul_add(sin[i], out[i]));
    }
}

/// The slopes of the basis, from the basis.
pub(super) fn differentiated(drive: &Drive<'_>, basis: &[f64], slope: &mut [f64]) {
    let harmonics = drive.harmonics();
    slope.fill(0.0);
    for (index, order) in harmonics.oscillating().iter().enumerate() {
        let slot = harmonics.offset() + 2 * index;
        slope[slot] = -(*order as f64) * basis[slot + 1];
        slope[slot + 1] = *order as f64 * basis[slot];
    }
}
