//! Floquet multipliers of a periodic motion that is given by its harmonics: the equations of structure
//! and contact laws, linearised along it, are integrated over a period.
//!
//! In the modes of the structure with its stuck contacts the linear part is advanced exactly, and what
//! the laws take off it acts in kicks at the ends of the steps (Strang 1968). Between the events of the
//! laws, at which steps end, the error has even powers of the step alone: maps of halved steps are
//! extrapolated (Romberg), and what the last halving has changed is the error.

use super::drift::Drift;
use super::fundamental_matrix::{FundamentalMatrix, Linearised, SEARCH};
use super::linear_path::{inside, Displacements, Part, PartPath};
use crate::balance::Unknowns;
use crate::contact::Residual;
use crate::model::Model;
use crate::structure::modes;
use crate::Error;
use faer::{c64, Mat, MatRef};
use std::f64::consts::TAU;

/// Fewest steps per period, and most at the first level.
const STEPS: (usize, usize) = (32, SEARCH);
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
    linearised: Linearised,
    /// Diagonal of the modal damping where it is diagonal, else zeros and the whole.
    damping: Vec<f64>,
    coupled: Option<Mat<f64>>,
    residual: Residual,
    /// Shapes of the modes.
    shapes: Mat<f64>,
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
        let held = ports.rows.transpose() * &*ports.stiffness * &*ports.rows;
        let stiffness = structure.stiffness() + held;
        let modes = modes(structure.mass(), stiffness.as_ref())?;
        let damping = modes.damping(damping);
        let size = modes.omega_squared.len();
        let full = damping.matrix();
        let coupled =
            (!damping.is_diagonal()).then(|| Mat::from_fn(size, size, |i, j| full[(i, j)].re));
        let shapes = &*ports.rows * &modes.shapes;
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
        let linearised = Linearised {
            omega_squared: modes.omega_squared,
            shapes,
            parts,
            states,
            circulatory: None,
        };
        Ok(Self {
            linearised,
            damping: if coupled.is_some() { vec![0.0; size] } else { damping.diagonal() },
            coupled,
            residual: Residual::Centred,
            shapes: modes.shapes,
        })
    }

    /// The map of a structure whose stiffness has a further part F [N/m], also an unsymmetric one, as
    /// forces of a flow on a ring of blades; shape of the DOFs.
    #[must_use]
    pub fn with_circulatory(mut self, stiffness: MatRef<'_, f64>) -> Self {
        self.linearised.circulatory = Some(self.shapes.transpose() * stiffness * &self.shapes);
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
            self.linearised.parts.iter().map(|part| PartPath::new(part, &u)).collect();
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
        let states = self.linearised.states_at(ends[0], &u, &paths);
        let mut table: Vec<Mat<f64>> = Vec::new();
        let mut last: Option<f64> = None;
        for level in 0.. {
            let counts: Vec<usize> = counts.iter().map(|count| count << level).collect();
            if counts.iter().sum::<usize>() > MOST_STEPS {
                return None;
            }
            let (mut row, columns) = (Vec::new(), table.len().min(COLUMNS));
            row.push(self.map(omega, &u, (&paths, &states), &ends, &counts)?);
            for column in 0..columns {
                let weight = 4.0_f64.powi(column as i32 + 1);
                let better = faer::Scale(weight / (weight - 1.0)) * &row[column]
                    - faer::Scale(1.0 / (weight - 1.0)) * &table[column];
                row.push(better);
            }
            if level == 0 {
                // Nothing is judged before the second halving, by what it has changed.
                table = row;
                continue;
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

    /// The map with so many steps between neighbouring ends, from the states of the laws at the first one.
    fn map(
        &self,
        omega: f64,
        u: &Displacements<'_>,
        (paths, states): (&[PartPath], &[Vec<f64>]),
        ends: &[f64],
        counts: &[usize],
    ) -> Option<Mat<f64>> {
        let mut run = FundamentalMatrix::new(&self.linearised, omega, u, paths, states.to_vec());
        let last = ends.len() - 1;
        let mut before = inside(ends[last - 1], ends[last], ends[last]) - TAU;
        for (pair, &count) in ends.windows(2).zip(counts) {
            let [start, end] = [pair[0], pair[1]];
            let h = (end - start) / count as f64;
            let modes = [&self.linearised.omega_squared[..], &self.damping];
            let drift = Drift::new(modes, self.coupled.as_ref(), h / omega);
            let at = |n: usize| inside(start, end, start + h * n as f64);
            run.pass(before, at(0));
            run.kick(0.5 * h / omega);
            for n in 0..count {
                // Between two steps the halves of the kicks are one.
                let share = if n + 1 == count { 0.5 } else { 1.0 };
                run.drift(&drift);
                run.follow(at(n), at(n + 1));
                run.kick(share * h / omega);
            }
            before = at(count);
        }
        Some(run.matrix(omega))
    }
}
