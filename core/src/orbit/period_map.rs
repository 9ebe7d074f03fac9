//! Floquet multipliers of a periodic motion that is given by its harmonics: the equations of structure
//! and contact laws, linearised along it, are integrated over a period.
//!
//! In the modes of the structure with its stuck contacts the linear part is advanced exactly, and what
//! the laws take off it acts in kicks at the ends of the steps (Strang 1968). Between the events of the
//! laws, at which steps end, the error has even powers of the step alone: maps of halved steps are
//! extrapolated (Romberg), and what the last halving has changed is the error.

use super::drift::Drift;
use super::linear_path::{inside, step, Displacements, Part, PartPath};
use crate::balance::Unknowns;
use crate::contact::{Residual, ReturnMapJacobian};
use crate::model::Model;
use crate::structure::modes;
use crate::Error;
use faer::{c64, Mat, MatRef};
use std::f64::consts::TAU;

/// Fewest steps per period, and most at the first level.
const STEPS: (usize, usize) = (32, 512);
/// Steps per period after which a map is given up.
const MOST_STEPS: usize = 1 << 15;
/// Columns of the extrapolation: further ones would raise rounding.
const COLUMNS: usize = 4;
/// Distance of the largest multiplier from 1 that decides, in errors.
const DECIDES: f64 = 20.0;
/// Error of the largest multiplier, relative to it, from which on the extrapolation is trusted.
const TRUSTED: f64 = 0.01;
/// Error of multipliers that is rounding.
const ROUNDING: f64 = 1e-10;

/// The linearised map over a period of motions of one model.
pub struct PeriodMap {
    omega_squared: Vec<f64>,
    /// Diagonal of the modal damping where it is diagonal, else zeros and the whole.
    damping: Vec<f64>,
    coupled: Option<Mat<f64>>,
    /// Relative displacements by modes, point after point.
    rows: Vec<Vec<f64>>,
    parts: Vec<Part>,
    states: usize,
    residual: Residual,
    /// Shapes of the modes, and the stiffness in them that no energy belongs to.
    shapes: Mat<f64>,
    circulatory: Option<Mat<f64>>,
}

/// Floquet multipliers with their error.
#[derive(Debug, Clone)]
pub struct Multipliers {
    /// By falling modulus; contacts that never slip do not count.
    pub values: Vec<c64>,
    /// What the last halving of the steps has changed of the largest modulus.
    pub error: f64,
    /// Whether a contact touches its limit: they are those of disturbances that lead away from it.
    pub touches: bool,
}

impl Multipliers {
    /// The largest modulus.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.values.first().map_or(0.0, |one| one.norm())
    }

    /// Whether the motion is stable; nothing if the largest multiplier is nearer to 1 than its error, or
    /// if nothing grows but contacts touch their limit: on its other side something may.
    #[must_use]
    pub fn stable(&self) -> Option<bool> {
        let away = self.largest() - 1.0;
        let known = away.abs() > self.error.max(ROUNDING) && (away > 0.0 || !self.touches);
        known.then_some(away < 0.0)
    }
}

impl PeriodMap {
    /// The map of a model.
    ///
    /// # Errors
    /// A travelling wave, which has no motion of its own; an eigenvalue iteration that fails.
    pub fn new(model: &Model) -> Result<Self, Error> {
        Self::damped(model, model.structure().damping())
    }

    /// The map of a model with another damping matrix.
    ///
    /// # Errors
    /// As [`PeriodMap::new`].
    pub(super) fn damped(model: &Model, damping: MatRef<'_, f64>) -> Result<Self, Error> {
        if model.is_travelling_wave() {
            return Err(Error::TravellingWave);
        }
        let (structure, ports) = (model.structure(), model.ports());
        let held = ports.rows.transpose() * &ports.stiffness * &ports.rows;
        let stiffness = structure.stiffness() + held;
        let modes = modes(structure.mass(), stiffness.as_ref())?;
        let damping = modes.damping(damping);
        let size = modes.omega_squared.len();
        let full = damping.matrix();
        let coupled =
            (!damping.is_diagonal()).then(|| Mat::from_fn(size, size, |i, j| full[(i, j)].re));
        let shapes = &ports.rows * &modes.shapes;
        let mut parts = Vec::new();
        let mut states = 0;
        for (law, points) in model.laws().iter().zip(model.points()) {
            let mut own = law.parts();
            if own.is_empty() {
                own.push(law.with_scaled_forces(1.0));
            }
            for law in own {
                let range = states..states + law.state_size();
                states = range.end;
                let stiffness = law.stiffness();
                parts.push(Part { law, first: points.start, states: range, stiffness });
            }
        }
        Ok(Self {
            damping: if coupled.is_some() { vec![0.0; size] } else { damping.diagonal() },
            omega_squared: modes.omega_squared,
            coupled,
            rows: (0..shapes.nrows())
                .map(|i| (0..size).map(|j| shapes[(i, j)]).collect())
                .collect(),
            parts,
            states,
            residual: Residual::Centred,
            shapes: modes.shapes,
            circulatory: None,
        })
    }

    /// The map of a structure whose stiffness has a further part F [N/m], also an unsymmetric one, as
    /// forces of a flow on a ring of blades; shape of the DOFs.
    #[must_use]
    pub fn with_circulatory(mut self, stiffness: MatRef<'_, f64>) -> Self {
        self.circulatory = Some(self.shapes.transpose() * stiffness * &self.shapes);
        self
    }

    /// The map of motions whose contacts keep another residual traction.
    #[must_use]
    pub fn assuming(mut self, residual: Residual) -> Self {
        self.residual = residual;
        self
    }

    /// Multipliers of a motion of frequency ω [rad/s], given by its contact displacements; the steps are
    /// halved until the largest is known to `tolerance`, or without one until it is known on which side
    /// of 1 it lies. Nothing where the contacts do not repeat what they do, or where the steps are too
    /// many. A contact that has slipped until it touches its limit is a spring: the map has another
    /// derivative beyond it.
    #[must_use]
    pub fn multipliers(
        &self,
        omega: f64,
        motion: &Unknowns,
        tolerance: Option<f64>,
    ) -> Option<Multipliers> {
        let u = Displacements {
            harmonics: motion.harmonics(),
            series: motion.values(),
            residual: self.residual,
        };
        let paths: Option<Vec<PartPath>> =
            self.parts.iter().map(|part| PartPath::new(part, &u)).collect();
        let paths = paths?;
        let touches = paths.iter().any(|path| path.touches);
        let mut ends: Vec<f64> = paths
            .iter()
            .filter(|path| !path.linear)
            .flat_map(|path| path.events.iter().copied())
            .collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|b, a| *b - *a < 1e-9);
        let first = ends.first().copied().unwrap_or(0.0);
        ends.retain(|end| *end < first + TAU - 1e-9);
        if ends.is_empty() {
            ends.push(first);
        }
        ends.push(first + TAU);
        let least = (2 * motion.harmonics().highest()).clamp(STEPS.0, STEPS.1);
        let counts: Vec<usize> = ends
            .windows(2)
            .map(|pair| ((pair[1] - pair[0]) / TAU * least as f64).ceil().max(1.0) as usize)
            .collect();
        let mut table: Vec<Mat<f64>> = Vec::new();
        let mut last: Option<f64> = None;
        for level in 0.. {
            let counts: Vec<usize> = counts.iter().map(|count| count << level).collect();
            if counts.iter().sum::<usize>() > MOST_STEPS {
                return None;
            }
            let (mut row, columns) = (Vec::new(), table.len().min(COLUMNS));
            row.push(self.map(omega, &u, &paths, &ends, &counts)?);
            for column in 0..columns {
                let weight = 4.0_f64.powi(column as i32 + 1);
                let better = faer::Scale(weight / (weight - 1.0)) * &row[column]
                    - faer::Scale(1.0 / (weight - 1.0)) * &table[column];
                row.push(better);
            }
            let mut values = row.last()?.eigenvalues().ok()?;
            values.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
            let largest = values.first().map_or(0.0, |one| one.norm());
            let error = last.map_or(f64::INFINITY, |last| (largest - last).abs());
            let enough = match tolerance {
                Some(tolerance) => error <= tolerance,
                None => (largest - 1.0).abs() > DECIDES * error && error < TRUSTED * largest,
            };
            if level >= 2 && (enough || error <= ROUNDING) {
                return Some(Multipliers { values, error, touches });
            }
            last = Some(largest);
            table = row;
        }
        None
    }

    /// The map with so many steps between neighbouring ends.
    fn map(
        &self,
        omega: f64,
        u: &Displacements<'_>,
        paths: &[PartPath],
        ends: &[f64],
        counts: &[usize],
    ) -> Option<Mat<f64>> {
        let mut run = Run::new(self, omega, u, paths, ends[0]);
        let last = ends.len() - 1;
        let mut before = inside(ends[last - 1], ends[last], ends[last]) - TAU;
        for (pair, &count) in ends.windows(2).zip(counts) {
            let [start, end] = [pair[0], pair[1]];
            let h = (end - start) / count as f64;
            let modes = [&self.omega_squared[..], &self.damping];
            let drift = Drift::new(modes, self.coupled.as_ref(), h / omega);
            let at = |n: usize| inside(start, end, start + h * n as f64);
            run.follow(before, at(0));
            for n in 0..count {
                run.kick(0.5 * h / omega);
                run.drift(&drift);
                run.follow(at(n), at(n + 1));
                run.kick(0.5 * h / omega);
            }
            before = at(count);
        }
        Some(run.matrix(omega))
    }
}

/// A fundamental matrix on its way through the period, row after row.
struct Run<'a> {
    map: &'a PeriodMap,
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

impl<'a> Run<'a> {
    fn new(
        map: &'a PeriodMap,
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
                let count = ((to - from) / TAU * STEPS.1 as f64).ceil().max(1.0) as usize;
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

    fn drift(&mut self, drift: &Drift) {
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
    fn follow(&mut self, from: f64, to: f64) {
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
    fn kick(&mut self, time: f64) {
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
    fn matrix(&self, omega: f64) -> Mat<f64> {
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
