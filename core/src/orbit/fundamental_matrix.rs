//! A structure and its contact laws linearised along a motion, and the matrix of their disturbances on its
//! way through a period.

use super::drift::Drift;
use super::linear_path::{step, Displacements, Part, PartPath};
use crate::contact::ReturnMapJacobian;
use faer::Mat;
use std::f64::consts::TAU;

/// Steps per period of the laws before the march begins: as many as the search for their path took.
pub(super) const SEARCH: usize = 512;

/// What disturbances of a motion feel.
pub(super) struct Linearised {
    pub(super) omega_squared: Vec<f64>,
    /// Relative displacements by modes, point after point.
    pub(super) rows: Vec<Vec<f64>>,
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
    rows: Vec<Vec<f64>>,
    /// Those of the contact displacements.
    contacts: Vec<Vec<f64>>,
    /// States of the laws, and their derivatives in the last step.
    states: Vec<Vec<f64>>,
    jacobians: Vec<ReturnMapJacobian>,
}

impl<'a> FundamentalMatrix<'a> {
    pub(super) fn new(
        map: &'a Linearised,
        omega: f64,
        u: &'a Displacements<'a>,
        paths: &'a [PartPath],
        start: f64,
    ) -> Self {
        let modes = map.omega_squared.len();
        let size = 2 * modes + map.states;
        let unit = |i: usize| (0..size).map(|j| f64::from(u8::from(i == j))).collect();
        let mut run = Self {
            map,
            u,
            paths,
            size,
            rows: (0..size).map(unit).collect(),
            contacts: vec![vec![0.0; size]; map.rows.len()],
            states: paths.iter().map(|path| path.start.clone()).collect(),
            jacobians: vec![ReturnMapJacobian::default(); map.parts.len()],
        };
        for (j, scale) in run.scales(omega).into_iter().enumerate() {
            run.rows[j][j] = scale;
        }
        // The states at the start of the run, from turn to turn: as many steps as the search took.
        for ((part, path), state) in map.parts.iter().zip(paths).zip(&mut run.states) {
            let mut stops: Vec<f64> =
                path.events.iter().copied().filter(|theta| *theta < start).collect();
            stops.push(start);
            let mut from = 0.0;
            for to in stops {
                let count = ((to - from) / TAU * SEARCH as f64).ceil().max(1.0) as usize;
                for n in 0..count {
                    let at = |n: usize| from + (to - from) * n as f64 / count as f64;
                    step(part, u, at(n), at(n + 1), state);
                }
                from = to;
            }
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
        for (contact, shape) in self.contacts.iter_mut().zip(&self.map.rows) {
            contact.fill(0.0);
            for (row, b) in self.rows.iter().zip(shape) {
                add(contact, *b, row);
            }
        }
    }

    pub(super) fn drift(&mut self, drift: &Drift) {
        self.damp(drift);
        let modes = drift.modes.len();
        let (displacements, rest) = self.rows.split_at_mut(modes);
        for ((x, v), [a, b, c, d]) in displacements.iter_mut().zip(rest).zip(&drift.modes) {
            for (x, v) in x.iter_mut().zip(v) {
                (*x, *v) = (a * *x + b * *v, c * *x + d * *v);
            }
        }
        self.damp(drift);
    }

    fn damp(&mut self, drift: &Drift) {
        let Some(coupled) = &drift.coupled else { return };
        let modes = drift.modes.len();
        let before: Vec<Vec<f64>> = self.rows[modes..2 * modes].to_vec();
        for (i, row) in self.rows[modes..2 * modes].iter_mut().enumerate() {
            row.fill(0.0);
            before.iter().enumerate().for_each(|(j, v)| add(row, coupled[(i, j)], v));
        }
    }

    /// Takes the laws and their disturbances from one angle to another.
    pub(super) fn follow(&mut self, from: f64, to: f64) {
        let before = self.contacts.clone();
        self.gather();
        let modes = self.map.omega_squared.len();
        for (index, part) in self.map.parts.iter().enumerate() {
            if self.paths[index].linear {
                continue;
            }
            let jacobian = step(part, self.u, from, to, &mut self.states[index]);
            let (states, count) = (part.states.len(), part.law.displacements());
            let first = 2 * modes + part.states.start;
            let mut fresh = vec![vec![0.0; self.size]; states];
            for (z, row) in fresh.iter_mut().enumerate() {
                for (y, old) in self.rows[first..first + states].iter().enumerate() {
                    add(row, jacobian.by_state[z * states + y], old);
                }
                for i in 0..count {
                    add(row, jacobian.by_before[z * count + i], &before[part.first + i]);
                    add(row, jacobian.by_after[z * count + i], &self.contacts[part.first + i]);
                }
            }
            for (row, fresh) in self.rows[first..].iter_mut().zip(fresh) {
                *row = fresh;
            }
            self.jacobians[index] = jacobian;
        }
    }

    /// What the laws take off the stuck contacts' forces acts for a time.
    pub(super) fn kick(&mut self, time: f64) {
        let modes = self.map.omega_squared.len();
        if let Some(circulatory) = &self.map.circulatory {
            let (displacements, rest) = self.rows.split_at_mut(modes);
            for (i, velocity) in rest[..modes].iter_mut().enumerate() {
                for (j, displacement) in displacements.iter().enumerate() {
                    add(velocity, -time * circulatory[(i, j)], displacement);
                }
            }
        }
        for (index, part) in self.map.parts.iter().enumerate() {
            if self.paths[index].linear {
                continue;
            }
            let jacobian = &self.jacobians[index];
            let (states, count) = (part.states.len(), part.law.displacements());
            let first = 2 * modes + part.states.start;
            for i in 0..count {
                let mut load = vec![0.0; self.size];
                for j in 0..count {
                    let kept = part.stiffness[(i, j)] - jacobian.force_by_after[i * count + j];
                    add(&mut load, kept, &self.contacts[part.first + j]);
                }
                for z in 0..states {
                    let by_state = jacobian.force_by_state[i * states + z];
                    add(&mut load, -by_state, &self.rows[first + z]);
                }
                for (j, b) in self.map.rows[part.first + i].iter().enumerate() {
                    add(&mut self.rows[modes + j], time * b, &load);
                }
            }
        }
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
        Mat::from_fn(kept.len(), kept.len(), |i, j| self.rows[kept[i]][kept[j]] / scales[kept[i]])
    }
}

fn add(out: &mut [f64], factor: f64, row: &[f64]) {
    if factor != 0.0 {
        out.iter_mut().zip(row).for_each(|(out, row)| *out += factor * row);
    }
}
