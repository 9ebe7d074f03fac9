//! The derivative of the flow in its start state: the transition matrix, through events.
//!
//! Between events it is the exponential of the linear equations. At an event the vector field
//! jumps in the contact forces alone, by `S = I + Δz' ∇h / h'` where h passes zero (Leine and
//! Nijmeijer 2004, saltation matrix). At the onset of slip, `h = f ∓ μN`, the force of the point
//! loses its dependence on everything but its limit. At the return to stick nothing jumps. Where a
//! contact opens or closes, `h = N`: at opening nothing remains of the traction, and one that begins
//! at closing in stick, `t' = k_t u'`, begins earlier by dv/v', so that `dt = k_t u' dv/v'`.
//!
//! Where a contact slides in a plane the equations are not linear, and disturbances are power series like
//! the motion itself. At the onset the traction loses what is along it but the change of its limit.

use super::bodies::Body;
use super::contact_state::ContactState;
use super::linear_phase::{LinearPhase, Onset};
use super::loop_disturbance::LoopDisturbance;
use super::modal_system::ModalSystem;
use super::power_series::PowerSeries;
use super::propagator::{Propagators, Reach};
use super::state::State;
use crate::contact::PointState;
use faer::Mat;

/// Transition matrices in the coordinates `(w η, η', g)` with the strains g of the contacts
/// (`f = L g`, of a single spring `f/√k`), in whose norm passive systems contract: kinetic and
/// elastic energy.
pub(crate) struct Transition<'a> {
    pub(super) system: &'a ModalSystem,
    /// w per mode [rad/s].
    pub(super) weight: Vec<f64>,
}

impl<'a> Transition<'a> {
    /// Coordinates that suit a motion at `omega` [rad/s].
    pub(crate) fn new(system: &'a ModalSystem, omega: f64) -> Self {
        let weight = system.omega_squared().iter().map(|w| w.abs().sqrt().max(omega)).collect();
        Self { system, weight }
    }

    pub(crate) fn system(&self) -> &'a ModalSystem {
        self.system
    }

    /// Factors on the modal displacements [rad/s].
    pub(crate) fn weight(&self) -> &[f64] {
        &self.weight
    }

    /// Number of coordinates, 2N + strains.
    pub(crate) fn size(&self) -> usize {
        2 * self.weight.len() + self.system.strains()
    }

    /// Coordinates of a state.
    pub(crate) fn coordinates(&self, state: &State) -> Vec<f64> {
        let displacement = state.displacement.iter().zip(&self.weight).map(|(x, w)| w * x);
        let mut y: Vec<f64> = displacement.chain(state.velocity.iter().copied()).collect();
        for body in self.system.bodies() {
            y.extend(body.elastic.strains(&state.force[body.points.clone()]));
        }
        y
    }

    /// Rate of change of the coordinates of a state under static loads alone, in its regime.
    pub(crate) fn rate(&self, state: &State, regime: &ContactState) -> Vec<f64> {
        let system = self.system;
        let speed = system.contact_displacement(&state.velocity);
        let displacement = state.velocity.iter().zip(&self.weight).map(|(v, w)| w * v);
        let velocity = system.acceleration(&state.displacement, &state.velocity, &state.force);
        let mut y: Vec<f64> = displacement.chain(velocity).collect();
        let force = system.force_rates(regime, &state.force, &speed);
        for body in system.bodies() {
            y.extend(body.elastic.strains(&force[body.points.clone()]));
        }
        y
    }

    /// State of coordinates, and what the force of each point was held by: nothing where it sticks.
    pub(crate) fn state(&self, y: &[f64]) -> (State, Vec<PointState>) {
        let modes = self.weight.len();
        let mut state = State::rest(self.system);
        for j in 0..modes {
            state.displacement[j] = y[j] / self.weight[j];
            state.velocity[j] = y[modes + j];
        }
        for body in self.system.bodies() {
            let strains = &y[2 * modes + body.strains.start..2 * modes + body.strains.end];
            state.force[body.points.clone()].copy_from_slice(&body.elastic.forces(strains));
        }
        let held = state.settle_points(self.system);
        (state, held)
    }

    /// Linear forms that a motion conserves whose points `slipped` alone have slipped, each with a
    /// coordinate that it determines: strains w that no force at a slipping point feels keep
    /// `wᵀ (Lᵀ u − g)`, the slip of the other points. Of a single spring, its slip load over √k.
    pub(crate) fn conserved(&self, slipped: &[bool]) -> Vec<(usize, Vec<f64>)> {
        let modes = self.weight.len();
        let limits = self.system.limits();
        let mut forms = Vec::new();
        for body in self.system.bodies() {
            let held: Vec<bool> =
                body.points.clone().map(|i| slipped[i] || limits[i] == 0.0).collect();
            let mut basis = body.elastic.unmoved(&held);
            let first = 2 * modes + body.strains.start;
            for number in 0..basis.len() {
                let size = |a: usize| basis[number][a].abs();
                let pivot =
                    (0..body.elastic.rank()).fold(0, |p, a| if size(a) > size(p) { a } else { p });
                let strains = basis[number].clone();
                for other in &mut basis[number + 1..] {
                    let share = other[pivot] / strains[pivot];
                    other.iter_mut().zip(&strains).for_each(|(o, w)| *o -= share * w);
                }
                let mut row = vec![0.0; self.size()];
                for (i, f) in body.points.clone().zip(body.elastic.forces(&strains)) {
                    let shape = self.system.contact_shape(i).iter().zip(&self.weight);
                    row.iter_mut().zip(shape).for_each(|(row, (b, w))| *row += f * b / w);
                }
                for (a, w) in strains.iter().enumerate() {
                    row[first + a] = -w;
                }
                forms.push((first + pivot, row));
            }
        }
        forms
    }

    /// Derivative of the end state in the start state along the phases of a motion that begins with
    /// these forces; `known` holds the exponentials of motions next to it.
    pub(crate) fn along(
        &self,
        phases: &[LinearPhase],
        held: &[PointState],
        force: &[f64],
        loops: &mut LoopDisturbance,
        known: &mut Propagators,
    ) -> Mat<f64> {
        let mut own = self.start(phases, held, force);
        if loops.columns == 0 {
            // Of what contacts remember that slip nothing comes.
            let felt: Vec<usize> =
                (0..own.ncols()).filter(|&j| own.col(j).norm_max() > 0.0).collect();
            let mut total = Mat::from_fn(own.nrows(), felt.len(), |i, j| own[(i, felt[j])]);
            self.lead(phases, &mut total, loops, known);
            for (j, at) in felt.into_iter().enumerate() {
                own.col_mut(at).copy_from(total.col(j));
            }
            return own;
        }
        let mut total = Mat::zeros(own.nrows(), own.ncols() + loops.columns);
        total.get_mut(.., ..own.ncols()).copy_from(&own);
        self.lead(phases, &mut total, loops, known);
        total
    }

    /// Takes disturbances along phases.
    fn lead(
        &self,
        phases: &[LinearPhase],
        total: &mut Mat<f64>,
        loops: &mut LoopDisturbance,
        known: &mut Propagators,
    ) {
        // By how long the disturbances lag behind.
        let mut lag = 0.0;
        let changes = self.simple_changes(phases);
        let leads = self.leads(phases, &changes);
        for (number, phase) in phases.iter().enumerate() {
            let change = phases.get(number + 1).zip(changes[number].as_ref());
            if let Some((series, length)) = &phase.slide {
                self.slide(&phase.regime, series, *length, total, loops);
            } else if let Some(lead) = leads[number] {
                let reach = if change.is_some() { Reach::LAGGING } else { Reach::CAUGHT_UP };
                let duration = lag + phase.duration;
                lag = self.advance(&phase.regime, [duration, lead], reach, total, known);
            } else {
                lag += phase.duration;
            }
            if lag != 0.0 {
                if let Some((next, changed)) = change {
                    self.pass_late([phase, next], changed, lag, total, known);
                    continue;
                }
                self.catch_up(&phase.regime, lag, total);
                lag = 0.0;
            }
            if let Some(onset) = &phase.onset {
                self.jump(onset, total);
            }
            for (number, turn) in &phase.turns {
                let point = self.system.microslips()[*number].point;
                loops.turn(*number, *turn, || self.displacements(point, total));
            }
        }
    }

    /// Disturbances of the displacement of a point.
    fn displacements(&self, point: usize, total: &Mat<f64>) -> Vec<f64> {
        let shape = self.system.contact_shape(point);
        let own = |column: usize| -> f64 {
            let parts = shape.iter().zip(&self.weight).enumerate();
            parts.map(|(j, (b, w))| b / w * total[(j, column)]).sum()
        };
        (0..total.ncols()).map(own).collect()
    }

    /// Derivative at the start: points that slip, and forces that their limits hold, vary with their
    /// limits alone.
    pub(super) fn start(
        &self,
        phases: &[LinearPhase],
        by: &[PointState],
        force: &[f64],
    ) -> Mat<f64> {
        let (size, first) = (self.size(), 2 * self.weight.len());
        let mut total = Mat::<f64>::identity(size, size);
        for body in self.system.bodies() {
            let does = |i: usize| match phases.first().map(|phase| phase.regime.points[i]) {
                Some(PointState::Stuck) | None => by[i],
                Some(state) => state,
            };
            let held: Vec<bool> = body
                .points
                .clone()
                .map(|i| does(i) != PointState::Stuck || self.system.limits()[i] == 0.0)
                .collect();
            if !held.contains(&true) {
                continue;
            }
            if does(body.points.start) == PointState::Sliding {
                self.hold_in_plane(body, force, &mut total);
                continue;
            }
            let basis = body.elastic.unmoved(&held);
            for a in 0..body.elastic.rank() {
                for b in 0..body.elastic.rank() {
                    total[(first + body.strains.start + a, first + body.strains.start + b)] =
                        basis.iter().map(|w| w[a] * w[b]).sum();
                }
            }
            for i in body.points.clone() {
                let slope = self.system.limit_slope(i);
                for (a, strain) in body.strains.clone().enumerate() {
                    let per_limit =
                        does(i).sign() * body.elastic.inverse()[(a, i - body.points.start)];
                    for (j, slope) in slope.iter().enumerate() {
                        total[(first + strain, j)] += per_limit * slope / self.weight[j];
                    }
                }
            }
        }
        total
    }

    /// Holds the traction of an element that slips in a plane at its limit: across itself it may vary.
    fn hold_in_plane(&self, body: &Body, force: &[f64], total: &mut Mat<f64>) {
        let first = 2 * self.weight.len();
        let Some(plane) = self.system.plane_of(body.points.start) else { return };
        let still = vec![0.0; force.len()];
        let (along, _) = self.system.pull(plane, force, &still);
        let slope = self.system.limit_slope(plane.points[0]);
        for column in 0..total.ncols() {
            let strains: Vec<f64> =
                body.strains.clone().map(|a| total[(first + a, column)]).collect();
            let mut own = body.elastic.forces(&strains);
            let [x, y] = plane.points.map(|i| i - body.points.start);
            let across = along[0] * own[y] - along[1] * own[x];
            let displaced = slope.iter().zip(&self.weight).enumerate();
            let limit: f64 = displaced.map(|(j, (slope, w))| slope / w * total[(j, column)]).sum();
            own[x] = limit * along[0] - across * along[1];
            own[y] = limit * along[1] + across * along[0];
            for (a, strain) in body.strains.clone().zip(body.elastic.strains(&own)) {
                total[(first + a, column)] = strain;
            }
        }
    }

    /// Takes disturbances along a stretch in which contacts slide in a plane.
    fn slide(
        &self,
        regime: &ContactState,
        series: &PowerSeries,
        length: f64,
        total: &mut Mat<f64>,
        loops: &mut LoopDisturbance,
    ) {
        let (system, modes) = (self.system, self.weight.len());
        let mut disturbance = series.clone();
        let (mut x, mut v) = (vec![0.0; modes], vec![0.0; modes]);
        let mut force = vec![0.0; system.points()];
        for column in 0..total.ncols() {
            for j in 0..modes {
                x[j] = total[(j, column)] / self.weight[j];
                v[j] = total[(modes + j, column)];
            }
            for body in system.bodies() {
                let own = body.strains.clone().map(|a| total[(2 * modes + a, column)]);
                let own = body.elastic.forces(&own.collect::<Vec<_>>());
                force[body.points.clone()].copy_from_slice(&own);
            }
            let begun = loops.begun(column);
            disturbance.disturb(system, regime, series, [&x, &v, &force], &begun);
            disturbance.motion_at(length, &mut x, &mut v);
            for (point, force) in force.iter_mut().enumerate() {
                *force = disturbance.force_at(point, length);
            }
            for (own, held) in system.microslips().iter().zip(&mut loops.held) {
                held[column] = force[own.point];
            }
            for j in 0..modes {
                total[(j, column)] = x[j] * self.weight[j];
                total[(modes + j, column)] = v[j];
            }
            for body in system.bodies() {
                let own = body.elastic.strains(&force[body.points.clone()]);
                for (a, strain) in body.strains.clone().zip(own) {
                    total[(2 * modes + a, column)] = strain;
                }
            }
        }
    }

    /// `S = I + Δf' ∇h / h'` from the left, in strains.
    pub(super) fn jump(&self, onset: &Onset, total: &mut Mat<f64>) {
        let Some(jump) = self.jump_of(onset) else { return };
        for column in 0..total.ncols() {
            let total = total.col_as_slice_mut(column);
            let force: f64 = jump.form.iter().map(|(at, part)| part * total[*at]).sum();
            jump.gains.iter().for_each(|(at, gain)| total[*at] += gain * force);
            jump.vanishing.iter().for_each(|at| total[*at] = 0.0);
        }
    }

    /// What an event does to disturbances.
    pub(super) fn jump_of(&self, onset: &Onset) -> Option<Jump> {
        let first = 2 * self.weight.len();
        let bodies = self.system.bodies();
        let own = bodies.iter().find(|body| body.points.contains(&onset.point))?;
        let row = onset.point - own.points.start;
        let mut gains = Vec::new();
        for body in bodies {
            let jump = &onset.jump[body.points.clone()];
            if jump.iter().any(|jump| *jump != 0.0) {
                let strains = body.strains.clone().map(|strain| first + strain);
                gains.extend(strains.zip(body.elastic.strains(jump)));
            }
        }
        // The strains of what a normal force presses are those of single points.
        let mut vanishing = Vec::new();
        for point in &onset.released {
            let row = point - own.points.start;
            let held = (0..own.elastic.rank()).filter(|a| own.elastic.root()[(row, *a)] != 0.0);
            vanishing.extend(held.map(|a| first + own.strains.start + a));
        }
        // Else rounding would leave something of a force that a constant limit holds.
        let constant = onset.slope.iter().all(|slope| *slope == 0.0);
        let slope = if constant { &[] } else { onset.slope.as_slice() };
        if constant && own.elastic.rank() == 1 && onset.jump[onset.point] == -1.0 {
            vanishing.push(first + own.strains.start);
        }
        let roots = (0..own.elastic.rank()).map(|a| own.elastic.root()[(row, a)]);
        let strains = own.strains.clone().map(|strain| first + strain);
        let displaced = slope.iter().zip(&self.weight).map(|(slope, weight)| slope / weight);
        let form = strains.zip(roots).chain(displaced.enumerate()).collect();
        Some(Jump { gains, form, vanishing })
    }
}

/// What an event does to disturbances: `1 + gains formᵀ`, and coordinates of which nothing remains.
pub(super) struct Jump {
    pub(super) gains: Vec<(usize, f64)>,
    pub(super) form: Vec<(usize, f64)>,
    pub(super) vanishing: Vec<usize>,
}
