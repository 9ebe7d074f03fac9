//! Whether a body that contacts alone hold walks: no motion of it repeats.
//!
//! Contacts whose forces are bounded feel how a body moves, and not where it is. If that is not asked either, the
//! period map of a passive system brings no two motions further apart, measured by energy, and some motion repeats
//! but for a rigid-body displacement, its drift. Two of those keep their distance. Nothing takes energy out of their
//! difference then, so that they have one drift. Where it is not zero no motion repeats.
//!
//! The motion is sought by Newton's method on what has to repeat, from where the motion itself leads, with equal
//! steps of time. The drift counts if half the step leaves it as it is.

use super::modal_system::ModalSystem;
use super::runge_kutta::{operations_of_step, steps_of_march, RungeKutta};
use super::state::State;
use super::transition::Transition;
use crate::model::Model;
use crate::progress::Progress;
use crate::solve::norm;
use faer::{Mat, Side};

/// Periods that are followed first; each round doubles them.
const FIRST: usize = 8;
const ROUNDS: usize = 6;
/// Newton steps of a round, and the share of what is left open that each has to take.
const ITERATIONS: usize = 12;
const FALLS: f64 = 0.5;
/// Disturbance by which derivatives are found, relative to the motion: rounding and curvature leave as much.
const DISTURBED: f64 = 1e-6;
/// Singular values of the closing condition, relative to the largest, of what stays as it is: tractions of contacts
/// that never slip.
const NEUTRAL: f64 = 1e-8;
/// Periods of the drift along which a motion is taken between two rounds.
const FAR: f64 = 1e4;
/// What is left open, over the drift, of a motion that repeats but for that.
const REPEATS: f64 = 1e-4;
/// Change of a contact's forces, over that by its drift without slip, of one that slips by its drift.
const SLIPS: f64 = 1e-2;
/// Least drift in a period that is one, relative to the motion.
const LEAST: f64 = 1e-4;
/// Change of the drift by half the step.
const SAME: f64 = 0.1;
/// Damping that takes energy in, relative to the largest, by rounding.
const ROUNDING: f64 = 1e-9;

/// Operations of a decomposition, over the third power of its size.
const DECOMPOSED: f64 = 25.0;

/// Whether some body walks at a frequency [rad/s], and the operations that were taken; `false` if so many `operations`
/// do not show it.
pub(crate) fn walks(
    model: &Model,
    omega: f64,
    operations: f64,
    progress: &Progress<'_>,
) -> (bool, f64) {
    let prepared = DECOMPOSED * (model.structure().dofs() as f64).powi(3);
    if prepared > operations || model.is_travelling_wave() {
        return (false, 0.0);
    }
    if !forgets_places(model) || !takes_energy(model) {
        return (false, 0.0);
    }
    let Ok(system) = ModalSystem::marched(model) else { return (false, 0.0) };
    let rigid = system.rigid_modes();
    let unstable = |j: usize| system.omega_squared()[j] < 0.0 && !rigid.contains(&j);
    if rigid.is_empty() || (0..system.modes()).any(unstable) {
        return (false, 0.0);
    }
    let mut walk = Walk::new(&system, omega, rigid, operations - prepared, progress);
    let walks = walk.is_found() == Some(true);
    (walks, operations - walk.left)
}

/// Whether no force depends on how far its contact has gone.
fn forgets_places(model: &Model) -> bool {
    let laws = model.laws().iter();
    model.is_monotone() && laws.flat_map(|law| law.grows()).all(|grows| !grows)
}

/// Whether damping takes energy out of every motion, or leaves it as it is.
fn takes_energy(model: &Model) -> bool {
    let damping = model.structure().damping();
    let symmetric = faer::Scale(0.5) * (damping + damping.transpose());
    let Ok(values) = symmetric.self_adjoint_eigenvalues(Side::Lower) else { return false };
    let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    values.iter().all(|value| *value >= -ROUNDING * largest)
}

/// The search for a motion that repeats but for its drift.
struct Walk<'a> {
    system: &'a ModalSystem,
    coordinates: Transition<'a>,
    omega: f64,
    rigid: Vec<usize>,
    scheme: RungeKutta<'a>,
    /// Operations that are left.
    left: f64,
    progress: &'a Progress<'a>,
}

/// A period of a motion.
struct Passed {
    start: State,
    end: State,
    /// What it changes of all that has to repeat, and its drift.
    open: Vec<f64>,
    drift: Vec<f64>,
    /// Size of what has to repeat.
    size: f64,
    /// Whether every contact slips by its drift.
    slips: bool,
}

impl Passed {
    fn repeats(&self) -> bool {
        norm(&self.open) <= REPEATS * norm(&self.drift) && self.slips
    }

    fn drifts(&self) -> bool {
        norm(&self.drift) > LEAST * self.size
    }

    fn is_closed(&self) -> bool {
        norm(&self.open) <= LEAST * self.size && !self.drifts()
    }
}

impl<'a> Walk<'a> {
    fn new(
        system: &'a ModalSystem,
        omega: f64,
        rigid: Vec<usize>,
        operations: f64,
        progress: &'a Progress<'a>,
    ) -> Self {
        let rest = State::rest(system);
        let scheme = RungeKutta::new(system, omega, steps_of_march(system, omega), &rest);
        let coordinates = Transition::new(system, omega);
        Self { system, coordinates, omega, rigid, scheme, left: operations, progress }
    }

    /// Whether a body walks; nothing where that is not found out.
    fn is_found(&mut self) -> Option<bool> {
        let mut start = State::rest(self.system);
        for round in 0..ROUNDS {
            for _ in 0..FIRST << round {
                start = self.pass(start)?.end;
            }
            let passed = self.pass(start)?;
            let closed = self.close(passed)?;
            if closed.is_closed() {
                return Some(false);
            }
            if closed.repeats() && closed.drifts() {
                return self.lasts(closed);
            }
            let far = norm(&closed.drift) > norm(&closed.open);
            start = closed.end;
            if far {
                self.carry(&mut start, &closed.drift);
            }
        }
        None
    }

    /// Takes a motion along its drift, for soft contacts to come to their limits.
    fn carry(&mut self, state: &mut State, drift: &[f64]) {
        let mut by = vec![0.0; self.system.modes()];
        for (&j, drift) in self.rigid.iter().zip(drift) {
            by[j] = FAR * drift / self.coordinates.weight()[j];
        }
        self.scheme.carry(state, &by);
    }

    /// Whether half the step leaves a drift as it is.
    fn lasts(&mut self, passed: Passed) -> Option<bool> {
        let steps = 2 * self.scheme.steps();
        self.scheme = RungeKutta::new(self.system, self.omega, steps, &passed.start);
        let finer = self.pass(passed.end)?;
        let finer = self.close(finer)?;
        let apart: Vec<f64> = finer.drift.iter().zip(&passed.drift).map(|(a, b)| a - b).collect();
        let same = norm(&apart) <= SAME * norm(&finer.drift);
        Some(finer.repeats() && finer.drifts() && same)
    }

    /// Follows a motion over a period; nothing where there are no operations left, or nobody waits.
    fn pass(&mut self, start: State) -> Option<Passed> {
        self.left -= self.of_period();
        if self.left < 0.0 || !(self.progress)(0.0) {
            return None;
        }
        self.scheme.restart(&start);
        (0..self.scheme.steps()).for_each(|_| self.scheme.advance());
        if !self.scheme.end().is_bounded() {
            return None;
        }
        let mut end = start.clone();
        self.scheme.end().write(&mut end);
        let [before, after] = [&start, &end].map(|state| self.coordinates.coordinates(state));
        let parts = before.iter().zip(&after).map(|(a, b)| b - a).enumerate();
        let (drift, open): (Vec<_>, Vec<_>) = parts.partition(|(j, _)| self.rigid.contains(j));
        let [drift, open] = [drift, open].map(|own| own.into_iter().map(|(_, by)| by).collect());
        let size = norm(&self.repeating(&after));
        let slips = self.all_slip(&start, &end);
        Some(Passed { start, end, open, drift, size, slips })
    }

    /// Whether the forces of every contact are what they were, though its ends are further apart by its drift.
    fn all_slip(&self, start: &State, end: &State) -> bool {
        let mut shift = vec![0.0; self.system.modes()];
        self.rigid.iter().for_each(|&j| shift[j] = end.displacement[j] - start.displacement[j]);
        let apart = self.system.contact_displacement(&shift);
        let least = ROUNDING * norm(&apart);
        self.system.bodies().iter().all(|body| {
            let apart = &apart[body.points.clone()];
            let stiffness = body.law.stiffness();
            let stuck: Vec<f64> = (0..apart.len())
                .map(|i| apart.iter().enumerate().map(|(j, u)| stiffness[(i, j)] * u).sum())
                .collect();
            let forces = body.points.clone().map(|i| end.force[i] - start.force[i]);
            let change = norm(&forces.collect::<Vec<_>>());
            norm(apart) <= least || change <= SLIPS * norm(&stuck)
        })
    }

    fn of_period(&self) -> f64 {
        operations_of_step(self.system) * self.scheme.steps() as f64
    }

    /// The coordinates that have to repeat.
    fn repeating(&self, y: &[f64]) -> Vec<f64> {
        let parts = y.iter().enumerate().filter(|(j, _)| !self.rigid.contains(j));
        parts.map(|(_, y)| *y).collect()
    }

    /// Newton's method from a period on, as far as it leads.
    fn close(&mut self, mut passed: Passed) -> Option<Passed> {
        for _ in 0..ITERATIONS {
            if passed.is_closed() || passed.repeats() {
                break;
            }
            let Some(step) = self.step(&passed)? else { break };
            let start =
                self.moved(&passed.end, &self.coordinates.coordinates(&passed.start), &step);
            let next = self.pass(start)?;
            if norm(&next.open) > FALLS * norm(&passed.open) {
                break;
            }
            passed = next;
        }
        Some(passed)
    }

    /// The step of all that has to repeat which closes a period; nothing inside where there is none.
    fn step(&mut self, passed: &Passed) -> Option<Option<Vec<f64>>> {
        let y = self.coordinates.coordinates(&passed.start);
        let size = passed.open.len();
        self.left -= DECOMPOSED * (size as f64).powi(3);
        if self.left < size as f64 * self.of_period() {
            return None;
        }
        let by = DISTURBED * passed.size;
        let mut matrix = Mat::zeros(size, size);
        for column in 0..size {
            let step: Vec<f64> = (0..size).map(|i| if i == column { by } else { 0.0 }).collect();
            let beside = self.pass(self.moved(&passed.start, &y, &step))?;
            for (row, (beside, own)) in beside.open.iter().zip(&passed.open).enumerate() {
                matrix[(row, column)] = (own - beside) / by;
            }
        }
        let Ok(parts) = matrix.svd() else { return Some(None) };
        let (left, values, right) = (parts.U(), parts.S().column_vector(), parts.V());
        let mut step = vec![0.0; size];
        for k in (0..size).filter(|&k| values[k] > NEUTRAL * values[0]) {
            let share: f64 = (0..size).map(|i| left[(i, k)] * passed.open[i]).sum::<f64>();
            step.iter_mut()
                .enumerate()
                .for_each(|(i, to)| *to += share / values[k] * right[(i, k)]);
        }
        Some(Some(step))
    }

    /// A state that remembers what another one does, at coordinates `y` that a step has moved.
    fn moved(&self, remembers: &State, y: &[f64], step: &[f64]) -> State {
        let mut y = y.to_vec();
        let moving = y.iter_mut().enumerate().filter(|(j, _)| !self.rigid.contains(j));
        moving.zip(step).for_each(|((_, y), by)| *y += by);
        let mut state = remembers.clone();
        let (modes, weight) = (self.system.modes(), self.coordinates.weight());
        for j in (0..modes).filter(|j| !self.rigid.contains(j)) {
            state.displacement[j] = y[j] / weight[j];
        }
        state.velocity.copy_from_slice(&y[modes..2 * modes]);
        for body in self.system.bodies() {
            let strains = body.strains.clone().map(|a| y[2 * modes + a]);
            let forces = body.elastic.forces(&strains.collect::<Vec<_>>());
            state.force[body.points.clone()].copy_from_slice(&forces);
        }
        state
    }
}
