//! A structure and its contact laws linearised along a motion, and the matrix of their disturbances on its
//! way through a period.

use super::drift::Drift;
use super::linear_path::{step, Displacements, Part, PartPath};
use crate::contact::ReturnMapJacobian;
use crate::solve::multiply;
use faer::{Accum, Mat, MatMut, MatRef};
use std::f64::consts::TAU;

/// Steps per period of the laws before the march begins: as many as the search for their path took.
pub(super) const SEARCH: usize = 512;
/// Multiplications from which a product of matrices is worth its set-up.
const LARGE: usize = 2000;

/// What disturbances of a motion feel.
pub(super) struct Linearised {
    pub(super) omega_squared: Vec<f64>,
    /// Relative displacements of the modes, point after point.
    pub(super) shapes: Mat<f64>,
    pub(super) parts: Vec<Part>,
    /// Numbers of all laws' states.
    pub(super) states: usize,
    /// The stiffness in the modes that no energy belongs to.
    pub(super) circulatory: Option<Mat<f64>>,
}

/// A fundamental matrix on its way through the period, row after row.
pub(super) struct FundamentalMatrix<'a> {
    map: &'a Linearised,
    u: &'a Displacements<'a>,
    paths: &'a [PartPath],
    size: usize,
    /// Disturbances of modal displacements and velocities, and of the states of the laws.
    rows: Vec<f64>,
    /// Shapes of the modes at the points of laws that are no mere springs, and the first such point of every part.
    shapes: Mat<f64>,
    places: Vec<usize>,
    /// Disturbances of their displacements, before the last step and now, …
    before: Vec<f64>,
    contacts: Vec<f64>,
    /// … and of what the laws take off their forces.
    loads: Vec<f64>,
    /// States of the laws, and their derivatives in the last step.
    states: Vec<Vec<f64>>,
    jacobians: Vec<ReturnMapJacobian>,
}

impl Linearised {
    /// States of the laws at an angle, from turn to turn: as many steps as the search took.
    pub(super) fn states_at(
        &self,
        start: f64,
        u: &Displacements<'_>,
        paths: &[PartPath],
    ) -> Vec<Vec<f64>> {
        let mut jacobian = ReturnMapJacobian::default();
        let of_part = |(part, path): (&Part, &PartPath)| {
            let mut state = path.start.clone();
            let mut stops: Vec<f64> =
                path.events.iter().copied().filter(|theta| *theta < start).collect();
            stops.push(start);
            let mut from = 0.0;
            for to in stops {
                let count = ((to - from) / TAU * SEARCH as f64).ceil().max(1.0) as usize;
                for n in 0..count {
                    let at = |n: usize| from + (to - from) * n as f64 / count as f64;
                    step(part, u, [at(n), at(n + 1)], &mut state, &mut jacobian);
                }
                from = to;
            }
            state
        };
        self.parts.iter().zip(paths).map(of_part).collect()
    }
}

impl<'a> FundamentalMatrix<'a> {
    pub(super) fn new(
        map: &'a Linearised,
        omega: f64,
        u: &'a Displacements<'a>,
        paths: &'a [PartPath],
        states: Vec<Vec<f64>>,
    ) -> Self {
        let modes = map.omega_squared.len();
        let size = 2 * modes + map.states;
        let (mut points, mut places) = (Vec::new(), Vec::new());
        for (part, path) in map.parts.iter().zip(paths) {
            places.push(points.len());
            let own = part.first..part.first + part.law.displacements();
            points.extend(own.filter(|_| !path.linear));
        }
        let mut run = Self {
            map,
            u,
            paths,
            size,
            rows: vec![0.0; size * size],
            shapes: Mat::from_fn(modes, points.len(), |mode, at| map.shapes[(points[at], mode)]),
            places,
            before: vec![0.0; size * points.len()],
            contacts: vec![0.0; size * points.len()],
            loads: vec![0.0; size * points.len()],
            states,
            jacobians: vec![ReturnMapJacobian::default(); map.parts.len()],
        };
        for (j, scale) in run.scales(omega).into_iter().enumerate() {
            run.rows[j * size + j] = scale;
        }
        run.gather();
        run
    }

    /// Units of the disturbances: they keep the matrix from being graded.
    fn scales(&self, omega: f64) -> Vec<f64> {
        let rates = self.map.omega_squared.iter().map(|w| w.abs().sqrt().max(omega));
        let stiff = |part: &Part| part.stiffness.norm_max();
        let states = self.map.parts.iter().flat_map(|part| {
            let unit = if stiff(part) > 0.0 { stiff(part) } else { 1.0 };
            part.states.clone().map(move |_| unit)
        });
        let ones = self.map.omega_squared.iter().map(|_| 1.0);
        ones.chain(rates).chain(states).collect()
    }

    /// Disturbances of the contact displacements.
    fn gather(&mut self) {
        let (size, modes) = (self.size, self.map.omega_squared.len());
        let displacements = &self.rows[..modes * size];
        product(&mut self.contacts, Accum::Replace, size, displacements, self.shapes.as_ref(), 1.0);
    }

    /// The free motion over a step.
    pub(super) fn drift(&mut self, drift: &Drift) {
        self.damp(drift);
        let (size, modes) = (self.size, drift.modes.len());
        let (displacements, rest) = self.rows.split_at_mut(modes * size);
        let pairs = displacements.chunks_exact_mut(size).zip(rest.chunks_exact_mut(size));
        for ((x, v), [a, b, c, d]) in pairs.zip(&drift.modes) {
            for (x, v) in x.iter_mut().zip(v) {
                (*x, *v) = (a * *x + b * *v, c * *x + d * *v);
            }
        }
        self.damp(drift);
        std::mem::swap(&mut self.before, &mut self.contacts);
        self.gather();
    }

    fn damp(&mut self, drift: &Drift) {
        let Some(coupled) = &drift.coupled else { return };
        let (size, modes) = (self.size, drift.modes.len());
        let velocities = &mut self.rows[modes * size..2 * modes * size];
        let before = velocities.to_vec();
        product(velocities, Accum::Replace, size, &before, coupled.transpose(), 1.0);
    }

    /// Takes the laws and their disturbances from one angle to the next one, to which the motion has led.
    pub(super) fn follow(&mut self, from: f64, to: f64) {
        let before = std::mem::take(&mut self.before);
        self.advance([from, to], &before);
        self.before = before;
    }

    /// Takes them past an event, at which nothing moves.
    pub(super) fn pass(&mut self, from: f64, to: f64) {
        let now = self.contacts.clone();
        self.advance([from, to], &now);
    }

    fn advance(&mut self, [from, to]: [f64; 2], before: &[f64]) {
        let (size, modes) = (self.size, self.map.omega_squared.len());
        let mut fresh = Vec::new();
        for (index, part) in self.map.parts.iter().enumerate() {
            if self.paths[index].linear {
                continue;
            }
            let jacobian = &mut self.jacobians[index];
            step(part, self.u, [from, to], &mut self.states[index], jacobian);
            let (states, count) = (part.states.len(), part.law.displacements());
            let first = (2 * modes + part.states.start) * size;
            let own = self.places[index] * size..;
            let old = &mut self.rows[first..first + states * size];
            fresh.clear();
            fresh.resize(states * size, 0.0);
            for (z, row) in fresh.chunks_exact_mut(size).enumerate() {
                for (y, old) in old.chunks_exact(size).enumerate() {
                    add(row, jacobian.by_state[z * states + y], old);
                }
                let before = before[own.clone()].chunks_exact(size);
                let after = self.contacts[own.clone()].chunks_exact(size);
                for (i, (before, after)) in before.zip(after).take(count).enumerate() {
                    add(row, jacobian.by_before[z * count + i], before);
                    add(row, jacobian.by_after[z * count + i], after);
                }
            }
            old.copy_from_slice(&fresh);
        }
    }

    /// What the laws take off the stuck contacts' forces acts for a time.
    pub(super) fn kick(&mut self, time: f64) {
        let (size, modes) = (self.size, self.map.omega_squared.len());
        self.loads.fill(0.0);
        for (index, part) in self.map.parts.iter().enumerate() {
            if self.paths[index].linear {
                continue;
            }
            let jacobian = &self.jacobians[index];
            let (states, count) = (part.states.len(), part.law.displacements());
            let (first, own) =
                ((2 * modes + part.states.start) * size, self.places[index] * size..);
            let loads = self.loads[own.clone()].chunks_exact_mut(size).take(count);
            for (i, load) in loads.enumerate() {
                let contacts = self.contacts[own.clone()].chunks_exact(size).take(count);
                for (j, contact) in contacts.enumerate() {
                    let kept = part.stiffness[(i, j)] - jacobian.force_by_after[i * count + j];
                    add(load, kept, contact);
                }
                for (z, state) in self.rows[first..].chunks_exact(size).take(states).enumerate() {
                    add(load, -jacobian.force_by_state[i * states + z], state);
                }
            }
        }
        let (displacements, rest) = self.rows.split_at_mut(modes * size);
        let velocities = &mut rest[..modes * size];
        if let Some(circulatory) = &self.map.circulatory {
            product(velocities, Accum::Add, size, displacements, circulatory.transpose(), -time);
        }
        product(velocities, Accum::Add, size, &self.loads, self.shapes.transpose(), time);
    }

    /// The matrix in units that do not grade it, without the states of contacts that never slip.
    pub(super) fn matrix(&self, omega: f64) -> Mat<f64> {
        let scales = self.scales(omega);
        let mut kept = vec![true; self.size];
        let modes = self.map.omega_squared.len();
        for (part, path) in self.map.parts.iter().zip(self.paths) {
            part.states.clone().for_each(|z| kept[2 * modes + z] = !path.linear);
        }
        let kept: Vec<usize> = (0..self.size).filter(|&i| kept[i]).collect();
        Mat::from_fn(kept.len(), kept.len(), |i, j| {
            self.rows[kept[i] * self.size + kept[j]] / scales[kept[i]]
        })
    }
}

/// A product of two matrices, times a factor, in place of `out` or on top of it: few numbers column by column.
/// Columns of `out` and `a` have `size` numbers.
fn product(out: &mut [f64], accum: Accum, size: usize, a: &[f64], b: MatRef<'_, f64>, factor: f64) {
    if a.len() * b.ncols() >= LARGE {
        let out = MatMut::from_column_major_slice_mut(out, size, b.ncols());
        let a = MatRef::from_column_major_slice(a, size, b.nrows());
        return multiply(out, accum, a, b, factor);
    }
    if matches!(accum, Accum::Replace) {
        out.fill(0.0);
    }
    for (j, column) in out.chunks_exact_mut(size).enumerate() {
        for (k, a) in a.chunks_exact(size).enumerate() {
            add(column, factor * b[(k, j)], a);
        }
    }
}

fn add(out: &mut [f64], factor: f64, row: &[f64]) {
    if factor != 0.0 {
        out.iter_mut().zip(row).for_each(|(out, row)| *out += factor * row);
    }
}
