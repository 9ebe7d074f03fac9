//! The state of a motion: modal displacements and velocities, contact forces.

use super::bodies::Body;
use super::microslip::Reversals;
use super::modal_system::{dot, ModalSystem};
use crate::contact::{Bound, PointState, REVERSALS};
use crate::error::brief;
use crate::Error;
use faer::Mat;

/// Force beyond its slip limit that printed digits may leave in a given state.
const ROUNDING: f64 = 1e-9;
/// Share of a contact's forces that no deformation gives which printed digits may leave, …
const PRINTED: f64 = 1e-6;
/// … and share of what their stiffness makes of the motion, where the forces are but the
/// rounding of that.
const CANCELLED: f64 = 1e-12;

/// Changes of state per point after which the states are taken as they are.
const FLIPS: usize = 8;

/// State at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time since the start of the period \[s\].
    pub time: f64,
    /// Modal displacements η.
    pub displacement: Vec<f64>,
    /// Modal velocities η' [1/s].
    pub velocity: Vec<f64>,
    /// Contact forces \[N\].
    pub force: Vec<f64>,
    /// What the laws remember whose forces are not their state.
    pub memory: Vec<f64>,
    /// Reversals of the contacts without sliders.
    pub reversals: Vec<Reversals>,
    /// What each contact point does.
    pub points: Vec<PointState>,
}

impl State {
    /// Rest with unloaded contacts.
    #[must_use]
    pub fn rest(system: &ModalSystem) -> Self {
        let (modes, points) = (system.modes(), system.points());
        let memory = system.bodies().last().map_or(0, |body| body.memory.end);
        let mut state = Self {
            time: 0.0,
            displacement: vec![0.0; modes],
            velocity: vec![0.0; modes],
            force: vec![0.0; points],
            memory: vec![0.0; memory],
            reversals: vec![Reversals::default(); system.microslips.len()],
            points: vec![PointState::Stuck; points],
        };
        if system.has_normals() || memory > 0 {
            state.settle_points(system);
        }
        state
    }

    /// A state from displacements and velocities of the DOFs and what the contacts remember, one
    /// after the other in `values`.
    ///
    /// # Errors
    /// A wrong number of values, values that are not finite, a contact force beyond its limit.
    pub fn from_dofs(system: &ModalSystem, values: &[f64]) -> Result<Self, Error> {
        let modes = system.modes();
        let expected = 2 * modes + system.memories();
        if values.len() != expected {
            return Err(Error::shape("state", format!("{expected} values"), values.len()));
        }
        if let Some(value) = values.iter().find(|v| !v.is_finite()) {
            return Err(Error::value("state", *value, "every value must be finite"));
        }
        let (motion, memory) = values.split_at(2 * modes);
        let mut state = Self::rest(system);
        state.displacement = system.to_modes(&motion[..modes]);
        state.velocity = system.to_modes(&motion[modes..]);
        let negligible = CANCELLED * state.largest_force(system);
        state.close(system);
        state.press(system);
        state.recall(system, memory);
        let mut origins = memory;
        for body in system.bodies() {
            let (own, rest) = origins.split_at(body.remembered.len() + body.told);
            origins = rest;
            if body.ways.is_some() && own[0] != 0.0 {
                let remedy = "Runge-Kutta steps know no origin but 0; take scheme = \"exact\"";
                return Err(Error::value(
                    "state: origin of a contact without sliders",
                    own[0],
                    remedy,
                ));
            }
        }
        for point in system.bodies().iter().flat_map(|body| body.remembered.iter().copied()) {
            let plane = system.plane_of(point).map(|plane| system.traction(plane, &state.force));
            let f = plane.unwrap_or(state.force[point]);
            let limit = system.limit(point, &state.force);
            if f.abs() > limit * (1.0 + ROUNDING) + negligible {
                return Err(Error::value(
                    format!("state: force of contact point {}", point + 1),
                    f,
                    &format!("must lie within its slip limit of {} N", brief(limit)),
                ));
            }
        }
        for body in system.bodies() {
            let own = &state.force[body.points.clone()];
            if body.remembered.len() < own.len() {
                continue;
            }
            let carried = body.elastic.carried(own);
            let size = own.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
            let most = (PRINTED * size).max(negligible);
            if let Some(i) = (0..own.len()).find(|&i| (own[i] - carried[i]).abs() > most) {
                return Err(Error::value(
                    format!("state: force of contact {}, point {i}", body.contact + 1),
                    own[i],
                    &format!(
                        "no deformation of the contact gives these forces; the nearest that one gives is {}",
                        brief(carried[i])
                    ),
                ));
            }
        }
        let given = state.memory.clone();
        state.settle_points(system);
        // Any ways lead a contact without sliders somewhere, whatever loops they close.
        let ways = |i: &usize| system.microslips().iter().any(|own| own.memory.contains(i));
        for i in (0..given.len()).filter(|i| !ways(i)) {
            let (given, kept) = (given[i], state.memory[i]);
            if (given - kept).abs() > ROUNDING * given.abs() + negligible {
                return Err(Error::value(
                    format!("state: number {i} that the contacts remember"),
                    given,
                    &format!("is none that its contact can have; the nearest is {}", brief(kept)),
                ));
            }
        }
        Ok(state)
    }

    /// Takes over what the contacts remember.
    pub(crate) fn recall(&mut self, system: &ModalSystem, mut values: &[f64]) {
        for body in system.bodies() {
            let (forces, rest) = values.split_at(body.remembered.len());
            let (memory, rest) = rest.split_at(body.told);
            body.remembered.iter().zip(forces).for_each(|(&i, f)| self.force[i] = *f);
            let own = &mut self.memory[body.memory.clone()];
            match body.ways {
                Some(k) => own.iter_mut().zip(&memory[1..]).for_each(|(z, way)| *z = k * way),
                None => own.copy_from_slice(memory),
            }
            values = rest;
        }
        self.reverse(system);
    }

    /// Takes the reversals that the memory tells over.
    fn reverse(&mut self, system: &ModalSystem) {
        for (own, reversals) in system.microslips.iter().zip(&mut self.reversals) {
            let [origin, ways @ ..] = &self.memory[own.memory.clone()] else { continue };
            let now = dot(system.contact_shape(own.point), &self.displacement);
            *reversals = Reversals::through(own, *origin, ways, now).0;
        }
    }

    /// Of each contact without sliders, the numbers of the memory that its reversals are made of.
    pub(crate) fn recall_ways(&mut self, system: &ModalSystem, values: &[f64]) -> Vec<Vec<usize>> {
        let mut kept = Vec::new();
        for ((own, reversals), values) in system
            .microslips
            .iter()
            .zip(&mut self.reversals)
            .zip(values.chunks_exact(1 + REVERSALS))
        {
            let now = dot(system.contact_shape(own.point), &self.displacement);
            let numbers;
            (*reversals, numbers) = Reversals::through(own, values[0], &values[1..], now);
            kept.push(numbers);
        }
        self.settle_microslips(system);
        kept
    }

    /// Gives the contacts without sliders their directions and forces.
    fn settle_microslips(&mut self, system: &ModalSystem) {
        for (own, reversals) in system.microslips.iter().zip(&self.reversals) {
            let [u, speed] = [&self.displacement, &self.velocity]
                .map(|values| dot(system.contact_shape(own.point), values));
            let sign = reversals.heading(u, speed);
            self.points[own.point] = PointState::slipping(sign);
            self.force[own.point] = reversals.force(own, sign, u);
            self.memory[own.memory.clone()].copy_from_slice(&reversals.numbers());
        }
    }

    /// Opens and closes contacts as the displacements say.
    fn close(&mut self, system: &ModalSystem) {
        self.points.fill(PointState::Stuck);
        for &point in &system.normals {
            if system.pressing(point, &self.displacement) <= 0.0 {
                self.points[point] = PointState::Open;
                system.pressed_by(point).for_each(|i| self.points[i] = PointState::Open);
            }
        }
    }

    /// Normal forces of the present displacements, and the slip limits of what slips.
    pub(super) fn press(&mut self, system: &ModalSystem) {
        for &point in &system.normals {
            let Bound::Unilateral { balanced, .. } = system.bounds[point] else { continue };
            let closed = self.points[point] != PointState::Open;
            let force = if closed { system.pressing(point, &self.displacement) } else { 0.0 };
            self.force[point] = force - balanced;
            for slipping in system.pressed_by(point) {
                let sign = self.points[slipping].sign();
                if sign != 0.0 {
                    self.force[slipping] = sign * system.limit(slipping, &self.force);
                }
            }
        }
        for plane in system.planes() {
            if self.points[plane.points[0]] == PointState::Sliding {
                system.lengthen(plane, &mut self.force);
            }
        }
    }

    /// Force that the contacts would have if all parts of their displacements, each at the amplitude
    /// that its energy gives it, pushed the same way: what the rounding of the forces counts against.
    fn largest_force(&self, system: &ModalSystem) -> f64 {
        let squares = system.omega_squared.iter().map(|square| square.max(0.0));
        let amplitudes: Vec<f64> = (self.displacement.iter().zip(&self.velocity).zip(squares))
            .map(|((x, v), square)| x.hypot(if square > 0.0 { v / square.sqrt() } else { 0.0 }))
            .collect();
        let stroke = |point: usize| -> f64 {
            let parts = system.contact_shape(point).iter().zip(&amplitudes);
            parts.map(|(shape, amplitude)| (shape * amplitude).abs()).sum()
        };
        let mut largest = 0.0_f64;
        for body in system.bodies() {
            let (stiffness, first) = (body.law.stiffness(), body.points.start);
            for i in 0..body.points.len() {
                let parts =
                    body.points.clone().map(|j| stiffness[(i, j - first)].abs() * stroke(j));
                largest = largest.max(parts.sum());
            }
        }
        largest
    }

    /// Displacements and velocities of the DOFs and what the contacts remember, one after the other.
    #[must_use]
    pub fn to_dofs(&self, system: &ModalSystem) -> Vec<f64> {
        let mut values = system.to_dofs(&self.displacement);
        values.extend(system.to_dofs(&self.velocity));
        let mut memory = self.memory.clone();
        for (own, reversals) in system.microslips.iter().zip(&self.reversals) {
            memory[own.memory.clone()].copy_from_slice(&reversals.numbers());
        }
        for body in system.bodies() {
            values.extend(body.remembered.iter().map(|&i| self.force[i]));
            let own = &memory[body.memory.clone()];
            match body.ways {
                Some(stiffness) => values.extend(Reversals::marched(own, stiffness).numbers()),
                None => values.extend(own),
            }
        }
        values
    }

    /// Keeps the forces within their limits, and has points at their limit slip if they move on.
    /// Of every point, what its force was held by: nothing where it sticks.
    pub(crate) fn settle_points(&mut self, system: &ModalSystem) -> Vec<PointState> {
        let speed = system.contact_displacement(&self.velocity);
        let at = system.contact_displacement(&self.displacement);
        let mut held = vec![PointState::Stuck; self.force.len()];
        self.close(system);
        for body in system.bodies() {
            let range = body.points.clone();
            let size = range.len();
            let force = &mut self.force[range.clone()];
            if matches!(system.bounds[range.start], Bound::Backbone(_)) {
                continue;
            }
            if body.remembered.is_empty() {
                let memory = &mut self.memory[body.memory.clone()];
                body.law.march(&at[range.clone()], &at[range.clone()], memory, force);
                continue;
            }
            let mut gain = vec![0.0; size * size];
            body.law.increment(&at[range.clone()], &at[range.clone()], force, Some(&mut gain));
            settle(system, body, &mut self.points, &self.force, &speed);
            for &point in &body.remembered {
                let i = point - range.start;
                if gain[i * size + i] != 1.0 {
                    held[point] = match self.points[point] {
                        PointState::Open => PointState::Open,
                        _ => PointState::slipping(self.force[point]),
                    };
                }
            }
        }
        self.settle_microslips(system);
        for own in &system.microslips {
            held[own.point] = self.points[own.point];
        }
        for plane in system.planes() {
            if plane.points.iter().any(|&i| held[i].slips()) {
                plane.points.iter().for_each(|&i| held[i] = PointState::Sliding);
            }
        }
        held
    }

    /// Displacements, velocities and forces.
    pub(crate) fn parts(&mut self) -> [&mut [f64]; 3] {
        [&mut self.displacement, &mut self.velocity, &mut self.force]
    }

    /// Becomes its mirror image.
    pub(crate) fn mirror(&mut self) {
        self.parts().into_iter().flatten().for_each(|v| *v = -*v);
        self.points.iter_mut().for_each(|point| *point = point.mirrored());
        self.reversals.iter_mut().for_each(Reversals::mirror);
    }

    /// Whether every number is finite and of a size whose square is.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.displacement.iter().chain(&self.velocity).all(|v| v.abs() < 1e100)
    }
}

/// Finds the states that follow from the velocities of a contact's points, one after the other:
/// at its limit a point slips if its force would grow beyond it, and sticks if it would slip
/// against it.
fn settle(
    system: &ModalSystem,
    body: &Body,
    points: &mut [PointState],
    force: &[f64],
    speed: &[f64],
) {
    let range = body.points.clone();
    let along = |matrix: &Mat<f64>, i: usize| -> f64 {
        speed[range.clone()].iter().enumerate().map(|(j, v)| matrix[(i - range.start, j)] * v).sum()
    };
    for plane in system.planes().iter().filter(|plane| range.contains(&plane.points[0])) {
        let limit = system.limit(plane.points[0], force);
        if limit > 0.0
            && system.traction(plane, force) >= limit
            && system.pull(plane, force, speed).1 > 0.0
        {
            plane.points.iter().for_each(|&i| points[i] = PointState::Sliding);
        }
    }
    let within = |i: usize| {
        let limit = system.limit(i, force);
        limit == 0.0 || force[i].abs() < limit || system.plane_of(i).is_some()
    };
    for _ in 0..FLIPS * (range.len() + 1) {
        if range.clone().all(within) {
            return;
        }
        let states = &points[range.clone()];
        let (tangent, slip_rate) = (body.law.tangent(states), body.law.slip_rate(states));
        let contradicts = |i: usize| match points[i] {
            _ if within(i) => false,
            PointState::Open => false,
            PointState::Stuck => {
                let growth = match system.bounds[i] {
                    Bound::Friction { friction, normal } => friction * along(&tangent, normal),
                    _ => 0.0,
                };
                along(&tangent, i) * force[i].signum() > growth
            }
            state => along(&slip_rate, i) * state.sign() < 0.0,
        };
        let Some(i) = range.clone().find(|&i| contradicts(i)) else { return };
        points[i] = match points[i] {
            PointState::Stuck => PointState::slipping(force[i]),
            _ => PointState::Stuck,
        };
    }
}
