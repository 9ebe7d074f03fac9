//! Classical fourth-order Runge-Kutta, the reference of the field.

use super::modal_system::{dot, ModalSystem};
use super::state::State;

/// Integrates the modes with equal steps; contact forces follow from the laws' return maps from
/// the start of each step.
pub struct RungeKutta<'a> {
    system: &'a ModalSystem,
    steps: usize,
    step: f64,
    /// Modal load at the start and the middle of each step.
    loads: Vec<f64>,
    stages: [Vec<f64>; 4],
    trial: Vec<f64>,
    reference: Vec<f64>,
    reached: Vec<f64>,
    force: Vec<f64>,
    memory: Vec<f64>,
    /// Steps taken since the start.
    pub taken: usize,
}

impl<'a> RungeKutta<'a> {
    /// The scheme with `steps` steps per period at a frequency [rad/s].
    #[must_use]
    pub fn new(system: &'a ModalSystem, omega: f64, steps: usize) -> Self {
        let modes = system.modes();
        let mut loads = vec![0.0; 2 * steps * modes];
        for (i, load) in loads.chunks_exact_mut(modes).enumerate() {
            let phase = std::f64::consts::TAU * i as f64 / (2 * steps) as f64;
            system.add_load(phase, 1.0, load);
        }
        let points = system.points();
        Self {
            system,
            steps,
            step: std::f64::consts::TAU / omega / steps as f64,
            loads,
            stages: std::array::from_fn(|_| vec![0.0; 2 * modes]),
            trial: vec![0.0; 2 * modes],
            reference: vec![0.0; points],
            reached: vec![0.0; points],
            force: vec![0.0; points],
            memory: Vec::new(),
            taken: 0,
        }
    }

    /// Steps per period.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Length of a step \[s\].
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Gives a state the forces of laws that have them from the displacements.
    pub fn settle(&mut self, state: &mut State) {
        let modes = self.system.modes();
        for (point, u) in self.reference.iter_mut().enumerate() {
            *u = dot(self.system.contact_shape(point), &state.displacement);
        }
        self.trial[..modes].copy_from_slice(&state.displacement);
        self.forces(state);
        state.force.copy_from_slice(&self.force);
    }

    /// Takes the step of number `index` in the period.
    pub fn advance(&mut self, state: &mut State, index: usize) {
        let modes = self.system.modes();
        let h = self.step;
        for (point, u) in self.reference.iter_mut().enumerate() {
            *u = dot(self.system.contact_shape(point), &state.displacement);
        }
        for stage in 0..4 {
            let (share, half_steps) = [(0.0, 0), (0.5, 1), (0.5, 1), (1.0, 2)][stage];
            for j in 0..modes {
                let (mut x, mut v) = (state.displacement[j], state.velocity[j]);
                if stage > 0 {
                    x += share * h * self.stages[stage - 1][j];
                    v += share * h * self.stages[stage - 1][modes + j];
                }
                (self.trial[j], self.trial[modes + j]) = (x, v);
            }
            self.forces(state);
            self.rates(stage, (2 * index + half_steps) % (2 * self.steps));
        }
        for j in 0..modes {
            let sum = |i: usize| {
                let [a, b, c, d] = &self.stages;
                h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i])
            };
            state.displacement[j] += sum(j);
            state.velocity[j] += sum(modes + j);
        }
        self.trial[..modes].copy_from_slice(&state.displacement);
        self.forces(state);
        self.keep(state);
        self.taken += 1;
    }

    /// State at a `share` of the step from `before` to `after`: cubic motion, forces by the return
    /// map.
    #[must_use]
    pub fn between(&mut self, before: &State, after: &State, share: f64) -> State {
        let (h, s) = (self.step, share);
        let mut state = before.clone();
        for j in 0..self.system.modes() {
            let (x_0, v_0) = (before.displacement[j], h * before.velocity[j]);
            let (x_1, v_1) = (after.displacement[j], h * after.velocity[j]);
            let rise = x_1 - x_0;
            let (square, cube) = (3.0 * rise - 2.0 * v_0 - v_1, v_0 + v_1 - 2.0 * rise);
            state.displacement[j] = x_0 + s * (v_0 + s * (square + s * cube));
            state.velocity[j] = (v_0 + s * (2.0 * square + 3.0 * s * cube)) / h;
        }
        let modes = self.system.modes();
        self.trial[..modes].copy_from_slice(&state.displacement);
        for (point, u) in self.reference.iter_mut().enumerate() {
            *u = dot(self.system.contact_shape(point), &before.displacement);
        }
        self.forces(before);
        self.keep(&mut state);
        state
    }

    /// Takes the contact forces at the trial displacements over, with what the laws remember.
    fn keep(&self, state: &mut State) {
        state.force.copy_from_slice(&self.force);
        state.memory.copy_from_slice(&self.memory);
    }

    /// Contact forces at the trial displacements, from those at the start of the step.
    fn forces(&mut self, state: &State) {
        let modes = self.system.modes();
        self.force.copy_from_slice(&state.force);
        self.memory.clone_from(&state.memory);
        for (point, u) in self.reached.iter_mut().enumerate() {
            *u = dot(self.system.contact_shape(point), &self.trial[..modes]);
        }
        for body in self.system.bodies() {
            let points = body.points.clone();
            body.law.march(
                &self.reference[points.clone()],
                &self.reached[points.clone()],
                &mut self.memory[body.memory.clone()],
                &mut self.force[points],
            );
        }
    }

    /// Time derivatives at the trial state.
    fn rates(&mut self, stage: usize, half_step: usize) {
        let modes = self.system.modes();
        let (rate_x, rate_v) = self.stages[stage].split_at_mut(modes);
        rate_x.copy_from_slice(&self.trial[modes..]);
        rate_v.copy_from_slice(&self.loads[half_step * modes..(half_step + 1) * modes]);
        self.system.add_damping(&self.trial[modes..], -1.0, rate_v);
        for ((rate, w), x) in rate_v.iter_mut().zip(self.system.omega_squared()).zip(&self.trial) {
            *rate -= w * x;
        }
        for (point, f) in self.force.iter().enumerate() {
            for (rate, b) in rate_v.iter_mut().zip(self.system.contact_shape(point)) {
                *rate -= b * f;
            }
        }
    }
}
