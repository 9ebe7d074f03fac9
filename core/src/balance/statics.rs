//! The structure under its static loads, raised slowly from rest with the history that friction
//! keeps.
//!
//! Between two load levels every law takes one step of its return map along the straight line from
//! displacement to displacement. A law whose contacts go on as they are from level to level is exact
//! in it; where one changes its state, or where sliding turns, the path bends, and two halves of the
//! step differ from the whole. Steps follow that difference.

use super::at_rest::{AtRest, RestStatus};
use crate::contact::ReturnMapJacobian;
use crate::model::Model;
use crate::solve::norm;
use crate::structure::{Quantity, Receptance, Request};
use crate::Error;
use faer::linalg::solvers::Solve as _;
use faer::{c64, Mat};

/// Difference between a step and its two halves, relative to the displacements.
const ACCURACY: f64 = 1e-10;
/// Shortest step, as a share of the load.
const SHORTEST: f64 = 1e-9;
/// Most steps: a loading that needs more does not end.
const MOST_STEPS: usize = 20_000;
/// Newton iterations per step.
const ITERATIONS: usize = 100;
/// Change of the displacements, relative to them, at which a step is solved.
const SOLVED: f64 = 1e-13;
/// Newton's step over the displacements beyond which a motion has hardly any stiffness, the least share of its
/// stiffness that a contact then keeps, and the longest step over the displacements.
const LOOSE: f64 = 1e3;
const KEPT: f64 = 1e-6;
const SHORT: f64 = 0.3;
/// Displacements over those of the stuck structure beyond which nothing holds it.
pub(super) const FREE: f64 = 1e9;
/// Steps that go so far, after which a body is taken as free: a single one may be a jump.
const ADRIFT: usize = 4;

/// A state on the loading path.
#[derive(Clone)]
pub(crate) struct Level {
    /// Share of the load.
    share: f64,
    /// Relative displacements at the contacts \[m\].
    pub(crate) u: Vec<f64>,
    /// What each law remembers.
    states: Vec<Vec<f64>>,
    /// Contact forces \[N\].
    pub(crate) force: Vec<f64>,
}

/// Raises the static loads of a model; displacements are recovered at the DOFs `observe`.
///
/// # Errors
/// A DOF that does not exist; a rigid-body motion that remains with all contacts stuck.
pub fn static_response(
    model: &Model,
    observe: &[usize],
    go_on: &dyn Fn(f64) -> bool,
) -> Result<AtRest, Error> {
    Error::check_dofs(observe, model.compliance().dofs())?;
    let mut loading = Loading::new(model)?;
    let status = loading.raise(go_on);
    let Loading { level, steps, .. } = loading;
    let displaced = |quantity, contact: &[c64], slip_load: &[c64]| {
        let mut out = vec![c64::new(0.0, 0.0); observe.len()];
        let request = Request { harmonic: 0, omega: 0.0, quantity, contact, slip_load, observe };
        model.compliance().displacement(&request, &mut out).map(|()| out)
    };
    let none = complex(&vec![0.0; level.u.len()]);
    let loaded = displaced(Quantity::Whole, &none, &none)?;
    let of_slip = complex(&slip_load(model, &level));
    let slipped = displaced(Quantity::OfSlip, &complex(&level.u), &of_slip)?;
    let displacement =
        loaded.iter().zip(&slipped).map(|(load, slip)| level.share * load.re + slip.re);
    Ok(AtRest {
        status,
        share: level.share,
        displacement: displacement.collect(),
        contact_displacement: level.u,
        contact_force: level.force,
        states: level.states,
        steps,
    })
}

/// The loading of a model, from rest or from where another one has ended.
pub(crate) struct Loading<'a> {
    pub(super) model: &'a Model,
    pub(super) receptance: Mat<f64>,
    /// Displacements of the stuck contacts at the beginning, …
    base: Vec<f64>,
    /// … and their change by the whole load.
    stuck: Vec<f64>,
    pub(crate) level: Level,
    /// Displacements that count beside those of a level that passes zero.
    least: f64,
    steps: usize,
}

impl<'a> Loading<'a> {
    pub(crate) fn new(model: &'a Model) -> Result<Self, Error> {
        let mut receptance = Receptance::default();
        model.compliance().receptance(0, 0.0, &mut receptance)?;
        let size = model.compliance().contacts();
        let states = model.laws().iter().map(|law| vec![0.0; law.state_size()]).collect();
        Ok(Self {
            model,
            receptance: Mat::from_fn(size, size, |i, j| receptance.contact[j * size + i].re),
            base: vec![0.0; size],
            stuck: receptance.stuck.iter().map(|u| u.re).collect(),
            level: Level { share: 0.0, u: vec![0.0; size], states, force: vec![0.0; size] },
            least: 0.0,
            steps: 0,
        })
    }

    /// What the equations lack at displacements that are reached from the level in one step, under the
    /// whole load.
    pub(super) fn missing(&self, u: &[f64]) -> Vec<f64> {
        let mut level = Level { share: 1.0, u: u.to_vec(), ..self.level.clone() };
        let mut residual = vec![0.0; u.len()];
        self.evaluate(&self.level, &mut level, &mut residual);
        residual
    }

    /// Adds another load, given by its displacements of the stuck contacts, from a level on.
    pub(crate) fn add(&mut self, level: &Level, base: Vec<f64>, stuck: Vec<f64>) {
        self.level = Level { share: 0.0, ..level.clone() };
        (self.base, self.stuck, self.steps) = (base, stuck, 0);
        self.least = norm(&self.base) + norm(&self.stuck);
    }

    /// Displacements of the stuck contacts under all that has been loaded.
    pub(crate) fn stuck(&self) -> Vec<f64> {
        self.base.iter().zip(&self.stuck).map(|(base, by)| base + by).collect()
    }

    /// Goes from no load to the whole one.
    pub(crate) fn raise(&mut self, go_on: &dyn Fn(f64) -> bool) -> RestStatus {
        // What presses without load, as an interference does, comes first.
        let Some(unloaded) = self.solve(&self.level, 0.0) else { return self.failure() };
        self.level = unloaded;
        let (mut step, mut adrift): (f64, usize) = (1.0, 0);
        while self.level.share < 1.0 {
            if !go_on(self.level.share) {
                return RestStatus::NotComputed;
            }
            if self.steps == MOST_STEPS {
                return self.failure();
            }
            step = step.min(1.0 - self.level.share);
            let to = if step >= 1.0 - self.level.share { 1.0 } else { self.level.share + step };
            match self.halves(to) {
                Some((level, error)) if error <= ACCURACY || step <= SHORTEST => {
                    // Rounding alone holds a body that contacts have let go.
                    adrift += usize::from(self.goes_far(&level));
                    if adrift == ADRIFT {
                        return RestStatus::Free;
                    }
                    self.level = level;
                    self.steps += 1;
                    step *= if error <= 0.1 * ACCURACY { 4.0 } else { 1.2 };
                }
                None if step <= SHORTEST => return self.failure(),
                _ => step *= 0.3,
            }
        }
        RestStatus::Converged
    }

    fn size(&self, u: &[f64]) -> f64 {
        norm(u).max(self.least)
    }

    /// Whether the load that a level adds moves a structure that floats as if nothing held it.
    fn goes_far(&self, level: &Level) -> bool {
        let moved: Vec<f64> = level.u.iter().zip(&self.level.u).map(|(a, b)| a - b).collect();
        // All frequencies of a large structure take long: they are asked for last.
        norm(&moved) > FREE * (level.share - self.level.share) * norm(&self.stuck) && self.floats()
    }

    /// Whether nothing but contacts holds the structure in one of its motions.
    fn floats(&self) -> bool {
        let free = self.model.compliance().free_frequencies();
        matches!(free, [slow, .., fast] if slow * slow * FREE <= fast * fast)
    }

    /// The level at a share of the load by two steps, and how far it is from that by one.
    fn halves(&self, to: f64) -> Option<(Level, f64)> {
        let whole = self.solve(&self.level, to)?;
        let middle = self.solve(&self.level, 0.5 * (self.level.share + to))?;
        let level = self.solve(&middle, to)?;
        let apart: Vec<f64> = whole.u.iter().zip(&level.u).map(|(a, b)| a - b).collect();
        let error = norm(&apart) / self.size(&level.u).max(f64::MIN_POSITIVE);
        let (one, two) = (slip_load(self.model, &whole), slip_load(self.model, &level));
        let apart: Vec<f64> = one.iter().zip(&two).map(|(a, b)| a - b).collect();
        let elastic: Vec<f64> =
            two.iter().zip(&level.force).map(|(q, f)| q.abs() + f.abs()).collect();
        let least = self.least * self.model.contact_stiffness().norm_max();
        let of_forces = norm(&apart) / norm(&elastic).max(least).max(f64::MIN_POSITIVE);
        Some((level, error.max(of_forces)))
    }

    /// The equilibrium at a share of the load, by one step from another: the next one, or, where contacts are
    /// next to rigid, one that springs hold.
    fn solve(&self, from: &Level, share: f64) -> Option<Level> {
        let near = self.newton(from, share, true);
        near.or_else(|| if self.floats() { None } else { self.newton(from, share, false) })
    }

    /// Newton's method from where all contacts stick on, damped. Rounding alone tells how far a motion
    /// without stiffness goes: for the next equilibrium its contacts keep some of theirs, so that it goes a
    /// short way. The residual may rise at that.
    fn newton(&self, from: &Level, share: f64, near: bool) -> Option<Level> {
        let size = from.u.len();
        let mut level = Level { share, ..from.clone() };
        let added = (share - from.share).max(0.0);
        level.u.iter_mut().zip(&self.stuck).for_each(|(u, stuck)| *u += added * stuck);
        let mut residual = vec![0.0; size];
        let mut slopes = self.evaluate(from, &mut level, &mut residual);
        let mut before = norm(&residual);
        for _ in 0..ITERATIONS {
            let mut step = self.direction(&slopes, &residual, 1.0);
            let (length, scale) = (norm(&step), norm(&level.u) + norm(&residual));
            if !length.is_finite() || length > FREE * (scale + norm(&self.stuck)) {
                return None;
            }
            let loose = near && length > LOOSE * scale;
            let mut kept = KEPT;
            while loose && kept < 1.0 && norm(&step) > SHORT * scale {
                step = self.direction(&slopes, &residual, 1.0 - kept);
                kept *= 10.0;
            }
            let mut damping = if loose { (SHORT * scale / norm(&step)).min(1.0) } else { 1.0 };
            let start = level.u.clone();
            loop {
                for (i, u) in level.u.iter_mut().enumerate() {
                    *u = start[i] + damping * step[i];
                }
                slopes = self.evaluate(from, &mut level, &mut residual);
                let after = norm(&residual);
                let solved = damping == 1.0 && length <= SOLVED * self.size(&level.u);
                if solved || size == 0 {
                    return Some(level);
                }
                let falls = after < before || after <= SOLVED * self.size(&level.u);
                if falls || loose || damping < 1e-3 {
                    before = after;
                    break;
                }
                damping *= 0.5;
            }
        }
        (before <= 1e3 * SOLVED * self.size(&level.u)).then_some(level)
    }

    /// `R(U) = U − s U^stuck − G Q(U)` of one step from a level, the states there, and the slopes of
    /// the slip loads `dQ/dU`.
    fn evaluate(&self, from: &Level, level: &mut Level, residual: &mut [f64]) -> Vec<Slope> {
        let stiffness = self.model.contact_stiffness();
        let mut slopes = Vec::new();
        let mut jacobian = ReturnMapJacobian::default();
        let laws = self.model.laws().iter().zip(self.model.points());
        for (index, (law, points)) in laws.enumerate() {
            let (before, after) = (&from.u[points.clone()], &level.u[points.clone()]);
            level.states[index].clone_from(&from.states[index]);
            let force = &mut level.force[points.clone()];
            law.return_map(before, after, &mut level.states[index], force, Some(&mut jacobian));
            let (count, states) = (points.len(), law.state_size());
            for i in 0..count {
                let by = |j: usize| -> f64 {
                    let through: f64 = (0..states)
                        .map(|z| {
                            jacobian.force_by_state[i * states + z]
                                * jacobian.by_after[z * count + j]
                        })
                        .sum();
                    let (row, column) = (points.start + i, points.start + j);
                    stiffness[(row, column)] - through - jacobian.force_by_after[i * count + j]
                };
                let by: Vec<f64> = (0..count).map(by).collect();
                // What is not a number has to come to light.
                if by.iter().any(|slope| *slope != 0.0) {
                    slopes.push(Slope { row: points.start + i, first: points.start, by });
                }
            }
        }
        residual.fill(0.0);
        self.add_response(slip_load(self.model, level).into_iter().enumerate(), residual);
        for (i, residual) in residual.iter_mut().enumerate() {
            *residual = level.u[i] - self.base[i] - level.share * self.stuck[i] - *residual;
        }
        slopes
    }

    /// `out += G q` of single slip loads.
    fn add_response(&self, slip_loads: impl Iterator<Item = (usize, f64)>, out: &mut [f64]) {
        for (j, q) in slip_loads.filter(|(_, q)| *q != 0.0) {
            let column = self.receptance.col(j).iter();
            out.iter_mut().zip(column).for_each(|(out, g)| *out += g * q);
        }
    }

    /// Newton's direction `dU = −R + G dQ`. The slip loads with a slope alone are unknown, of which
    /// `(1 − dQ/dU G) dQ = −dQ/dU R`. A share of the slopes below 1 leaves all contacts some stiffness.
    fn direction(&self, slopes: &[Slope], residual: &[f64], share: f64) -> Vec<f64> {
        let count = slopes.len();
        let matrix = Mat::from_fn(count, count, |i, j| {
            let column = self.receptance.col(slopes[j].row);
            f64::from(u8::from(i == j)) - share * slopes[i].times(|k| column[k])
        });
        let mut loads = Mat::from_fn(count, 1, |i, _| -share * slopes[i].times(|k| residual[k]));
        if count > 0 {
            matrix.partial_piv_lu().solve_in_place(&mut loads);
        }
        let mut step: Vec<f64> = residual.iter().map(|r| -r).collect();
        let loads = slopes.iter().enumerate().map(|(i, slope)| (slope.row, loads[(i, 0)]));
        self.add_response(loads, &mut step);
        step
    }

    /// Why no level follows: a body that has come free leaves the equations without a solution, and
    /// the softest direction of them without stiffness.
    fn failure(&self) -> RestStatus {
        let size = self.level.u.len();
        let (mut level, mut residual) = (self.level.clone(), vec![0.0; size]);
        level.u.iter_mut().zip(&self.stuck).for_each(|(u, stuck)| *u += SHORTEST * stuck);
        let mut matrix = Mat::<f64>::identity(size, size);
        for slope in self.evaluate(&self.level, &mut level, &mut residual) {
            let answer = self.receptance.col(slope.row);
            for (j, by) in slope.by.iter().enumerate() {
                matrix
                    .col_mut(slope.first + j)
                    .iter_mut()
                    .zip(answer.iter())
                    .for_each(|(entry, g)| *entry -= g * by);
            }
        }
        let singular = matrix.svd().is_ok_and(|svd| {
            let values = svd.S().column_vector();
            (0..size).any(|i| values[i] <= 1e-10 * values[0])
        });
        if singular || self.goes_away() {
            RestStatus::Free
        } else {
            RestStatus::Stalled
        }
    }
}

/// How a slip load answers the displacements of its contact.
struct Slope {
    row: usize,
    /// Position of the first of those displacements, …
    first: usize,
    /// … and the slope by each [N/m].
    by: Vec<f64>,
}

impl Slope {
    fn times(&self, displacement: impl Fn(usize) -> f64) -> f64 {
        self.by.iter().enumerate().map(|(j, by)| by * displacement(self.first + j)).sum()
    }
}

/// `q = D u − f` at a level.
pub(crate) fn slip_load(model: &Model, level: &Level) -> Vec<f64> {
    let stiffness = model.contact_stiffness();
    // A contact's stiffness couples its own points alone.
    let points = model.points().iter().flat_map(|own| own.clone().map(move |i| (i, own)));
    let stuck = points.map(|(i, own)| own.clone().map(|j| stiffness[(i, j)] * level.u[j]).sum());
    stuck.zip(&level.force).map(|(stuck, force): (f64, _)| stuck - force).collect()
}

fn complex(values: &[f64]) -> Vec<c64> {
    values.iter().map(|value| c64::new(*value, 0.0)).collect()
}
