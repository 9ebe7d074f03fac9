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
    /// Velocities and accelerations.
    stages: [Vec<f64>; 4],
    /// Displacements at which forces are asked for.
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
            trial: vec![0.0; modes],
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
        self.refer_to(&state.displacement);
        self.trial.copy_from_slice(&state.displacement);
        self.forces(state);
        state.force.copy_from_slice(&self.force);
    }

    /// Takes the step of number `index` in the period.
    pub fn advance(&mut self, state: &mut State, index: usize) {
        let modes = self.system.modes();
        let h = self.step;
        self.refer_to(&state.displacement);
        self.trial.copy_from_slice(&state.displacement);
        self.force.copy_from_slice(&state.force);
        self.stages[0][..modes].copy_from_slice(&state.velocity);
        self.accelerations(0, 2 * index);
        for (stage, share, half_steps) in [(1, 0.5, 1), (2, 0.5, 1), (3, 1.0, 2)] {
            let (done, next) = self.stages.split_at_mut(stage);
            let (velocity, acceleration) = done[stage - 1].split_at(modes);
            go_on(&mut self.trial, &state.displacement, share * h, velocity);
            go_on(&mut next[0][..modes], &state.velocity, share * h, acceleration);
            self.forces(state);
            let at = 2 * index + half_steps;
            self.accelerations(stage, if at < 2 * self.steps { at } else { 0 });
        }
        let [a, b, c, d] = &self.stages;
        let rates = a.iter().zip(b).zip(c).zip(d).map(|(((a, b), c), d)| a + 2.0 * (b + c) + d);
        let moved = state.displacement.iter_mut().chain(&mut state.velocity);
        moved.zip(rates).for_each(|(to, rate)| *to += h / 6.0 * rate);
        self.trial.copy_from_slice(&state.displacement);
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
        self.trial.copy_from_slice(&state.displacement);
        self.refer_to(&before.displacement);
        self.forces(before);
        self.keep(&mut state);
        state
    }

    /// Keeps the displacements of the contacts from which forces change.
    fn refer_to(&mut self, displacement: &[f64]) {
        for (point, u) in self.reference.iter_mut().enumerate() {
            *u = dot(self.system.contact_shape(point), displacement);
        }
    }

    /// Takes the contact forces at the trial displacements over, with what the laws remember.
    fn keep(&self, state: &mut State) {
        state.force.copy_from_slice(&self.force);
        state.memory.copy_from_slice(&self.memory);
    }

    /// Contact forces at the trial displacements, from those at the start of the step.
    fn forces(&mut self, state: &State) {
        self.force.copy_from_slice(&state.force);
        self.memory.clone_from(&state.memory);
        for (point, u) in self.reached.iter_mut().enumerate() {
            *u = dot(self.system.contact_shape(point), &self.trial);
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

    /// Accelerations at the trial displacements and the velocities of a stage.
    fn accelerations(&mut self, stage: usize, half_step: usize) {
        let modes = self.system.modes();
        let (velocity, rates) = self.stages[stage].split_at_mut(modes);
        let load = &self.loads[half_step * modes..(half_step + 1) * modes];
        let elastic = self.system.omega_squared().iter().zip(&self.trial);
        for ((rate, load), (w, x)) in rates.iter_mut().zip(load).zip(elastic) {
            *rate = load - w * x;
        }
        self.system.add_damping(velocity, -1.0, rates);
        for (point, f) in self.force.iter().enumerate() {
            for (rate, b) in rates.iter_mut().zip(self.system.contact_shape(point)) {
                *rate -= b * f;
            }
        }
    }
}

/// Where a rate leads from some values over a length.
fn go_on(to: &mut [f64], from: &[f64], length: f64, rate: &[f64]) {
    for ((to, from), rate) in to.iter_mut().zip(from).zip(rate) {
        *to = from + length * rate;
    }
}
