//! Classical fourth-order Runge-Kutta, the reference of the field.

use super::bodies::Body;
use super::modal_system::ModalSystem;
use super::state::State;
use crate::contact::{Slider, SlipElement as _};
use std::array::from_fn;
use std::f64::consts::TAU;
use std::mem::swap;

/// Modes that are computed side by side: loops over few numbers take longer to begin than to run.
const LANES: usize = 4;
/// A number of each of some modes; those that are missing have zeros.
pub(super) type Lanes = [f64; LANES];

/// Steps of Runge and Kutta in the time in which the fastest mode turns by one radian, and fewest steps per
/// period, of a motion that need not be precise.
const STEPS: f64 = 2.0;
const FEWEST: usize = 128;
/// Operations in the time of a return map.
const PER_MAP: f64 = 150.0;

/// Steps per period of such a motion that is excited at `omega` [rad/s].
pub(crate) fn steps_of_march(system: &ModalSystem, omega: f64) -> usize {
    ((STEPS * TAU * system.rate(omega) / omega).ceil() as usize).max(FEWEST)
}

/// Operations of one of them.
pub(crate) fn operations_of_step(system: &ModalSystem) -> f64 {
    let points = system.points();
    4.0 * ((2 * system.modes() * (points + 1)) as f64 + PER_MAP * points as f64)
}

/// Integrates the modes with equal steps; contact forces follow from the laws' return maps from
/// the start of each step.
pub(super) struct RungeKutta<'a> {
    system: &'a ModalSystem,
    equations: Equations<'a>,
    steps: usize,
    step: f64,
    /// Where the last step began, its inner stages, and where it ended.
    begin: Stage,
    stages: [Stage; 3],
    end: Stage,
    /// Steps taken since the start.
    pub(super) taken: usize,
}

/// The motion at a stage of a step.
#[derive(Debug, Clone)]
pub(super) struct Stage {
    modes: Vec<Modes>,
    /// Displacements of the contacts.
    pub(super) contacts: Vec<f64>,
    pub(super) force: Vec<f64>,
    memory: Vec<f64>,
}

/// Displacements, velocities and accelerations of some modes.
#[derive(Debug, Clone, Copy, Default)]
struct Modes {
    x: Lanes,
    v: Lanes,
    a: Lanes,
}

/// The equations of motion at the starts and the middles of all steps of a period.
struct Equations<'a> {
    /// Squared frequencies and damping of the modes.
    own: Vec<[Lanes; 2]>,
    /// The damping where modes damp each other, column after column.
    mutual: Vec<Vec<Lanes>>,
    /// Loads at the start and the middle of each step, and at the end of the last.
    loads: Vec<Lanes>,
    /// Displacement of every contact per mode.
    shapes: Vec<Lanes>,
    /// Contacts that are sliders, with their points: a call of each would take longer than what it does.
    sliders: Vec<(usize, Slider)>,
    others: Vec<&'a Body>,
}

impl<'a> RungeKutta<'a> {
    /// The scheme with `steps` steps per period at a frequency [rad/s], from a state at the start of a
    /// period; forces that follow from the displacements need not be known.
    pub(super) fn new(system: &'a ModalSystem, omega: f64, steps: usize, state: &State) -> Self {
        let equations = Equations::new(system, steps);
        let begin = Stage::of(system, state);
        let mut scheme = Self {
            system,
            equations,
            steps,
            step: TAU / omega / steps as f64,
            stages: from_fn(|_| begin.clone()),
            end: begin.clone(),
            begin,
            taken: 0,
        };
        scheme.restart(state);
        scheme
    }

    /// Goes on from a state at the start of a period.
    pub(super) fn restart(&mut self, state: &State) {
        self.begin = Stage::of(self.system, state);
        self.taken = 0;
        self.equations.follow(&self.begin, 0.0, &self.begin, &mut self.end, 0);
    }

    /// Displaces modes, as slowly as the contacts need.
    pub(super) fn carry(&mut self, state: &mut State, by: &[f64]) {
        self.restart(state);
        let mut carried = self.begin.clone();
        for (own, by) in carried.modes.iter_mut().zip(lanes(by)) {
            own.x = from_fn(|i| own.x[i] + by[i]);
        }
        self.equations.act(&self.begin, &mut carried);
        carried.write(state);
    }

    /// Steps per period.
    pub(super) fn steps(&self) -> usize {
        self.steps
    }

    /// Length of a step \[s\].
    pub(super) fn step(&self) -> f64 {
        self.step
    }

    /// Where the last step ended.
    pub(super) fn end(&self) -> &Stage {
        &self.end
    }

    /// Takes the next step.
    pub(super) fn advance(&mut self) {
        swap(&mut self.begin, &mut self.end);
        let (h, at) = (self.step, 2 * (self.taken % self.steps));
        let Self { equations, begin, stages: [a, b, c], end, .. } = self;
        equations.follow(begin, 0.5 * h, begin, a, at + 1);
        equations.follow(begin, 0.5 * h, a, b, at + 1);
        equations.follow(begin, h, b, c, at + 2);
        equations.conclude(begin, h / 6.0, [a, b, c], end, at + 2);
        self.taken += 1;
    }

    /// The motion at a `share` of the last step: cubic, with forces by the return map.
    pub(super) fn within(&mut self, share: f64) -> &Stage {
        let (h, s) = (self.step, share);
        // The stages of a step that has been taken are not needed any more.
        let [within, ..] = &mut self.stages;
        let ends = self.begin.modes.iter().zip(&self.end.modes);
        for (to, (from, end)) in within.modes.iter_mut().zip(ends) {
            for i in 0..LANES {
                let (x_0, v_0) = (from.x[i], h * from.v[i]);
                let (x_1, v_1) = (end.x[i], h * end.v[i]);
                let rise = x_1 - x_0;
                let (square, cube) = (3.0 * rise - 2.0 * v_0 - v_1, v_0 + v_1 - 2.0 * rise);
                to.x[i] = x_0 + s * (v_0 + s * (square + s * cube));
                to.v[i] = (v_0 + s * (2.0 * square + 3.0 * s * cube)) / h;
            }
        }
        self.equations.act(&self.begin, within);
        within
    }
}

impl Stage {
    fn of(system: &ModalSystem, state: &State) -> Self {
        let motion = lanes(&state.displacement).into_iter().zip(lanes(&state.velocity));
        Self {
            modes: motion.map(|(x, v)| Modes { x, v, a: [0.0; LANES] }).collect(),
            contacts: system.contact_displacement(&state.displacement),
            force: state.force.clone(),
            memory: state.memory.clone(),
        }
    }

    /// Displacement and velocity of a shape.
    pub(super) fn along(&self, shape: &[Lanes]) -> [f64; 2] {
        [dot(shape, &self.modes, |own| &own.x), dot(shape, &self.modes, |own| &own.v)]
    }

    /// Whether every number is finite and of a size whose square is.
    pub(super) fn is_bounded(&self) -> bool {
        let mut sizes = [0.0; LANES];
        for own in &self.modes {
            sizes = from_fn(|i| sizes[i] + (own.x[i].abs() + own.v[i].abs()));
        }
        sizes.iter().sum::<f64>() < 1e100
    }

    /// Gives a state this motion.
    pub(super) fn write(&self, state: &mut State) {
        let [x, v, force] = state.parts();
        x.iter_mut().zip(self.modes.iter().flat_map(|own| own.x)).for_each(|(to, x)| *to = x);
        v.iter_mut().zip(self.modes.iter().flat_map(|own| own.v)).for_each(|(to, v)| *to = v);
        force.copy_from_slice(&self.force);
        state.memory.copy_from_slice(&self.memory);
    }
}

impl<'a> Equations<'a> {
    fn new(system: &'a ModalSystem, steps: usize) -> Self {
        let modes = system.modes();
        let loads = (0..=2 * steps).flat_map(|i| {
            let mut load = vec![0.0; modes];
            system.add_load(TAU * (i % (2 * steps)) as f64 / (2 * steps) as f64, 1.0, &mut load);
            lanes(&load)
        });
        let diagonal = system.is_diagonally_damped();
        let column = |j: usize| (0..modes).map(move |i| system.damping.entry(i, j)).collect();
        let columns: Vec<Vec<f64>> = (0..modes).map(column).collect();
        let damping: Vec<f64> =
            (0..modes).map(|j| if diagonal { columns[j][j] } else { 0.0 }).collect();
        let own = lanes(system.omega_squared()).into_iter().zip(lanes(&damping));
        let slider = |body: &Body| body.slider().map(|slider| (body.points.start, slider));
        let bodies = system.bodies().iter();
        Self {
            own: own.map(|(w, c)| [w, c]).collect(),
            mutual: columns.iter().filter(|_| !diagonal).map(|one| lanes(one)).collect(),
            loads: loads.collect(),
            shapes: (0..system.points()).flat_map(|i| lanes(system.contact_shape(i))).collect(),
            sliders: bodies.clone().filter_map(slider).collect(),
            others: bodies.filter(|body| body.slider().is_none()).collect(),
        }
    }

    /// A stage where some rates lead from the start of the step over a length.
    fn follow(&self, begin: &Stage, length: f64, rates: &Stage, to: &mut Stage, half_step: usize) {
        let own = self.own.iter().zip(&self.loads[half_step * self.own.len()..]);
        let known = begin.modes.iter().zip(&rates.modes).zip(own);
        for (to, ((from, rate), (own, load))) in to.modes.iter_mut().zip(known) {
            to.x = from_fn(|i| from.x[i] + length * rate.v[i]);
            to.v = from_fn(|i| from.v[i] + length * rate.a[i]);
            to.accelerate(own, load);
        }
        self.act(begin, to);
    }

    /// The end of a step, where the rates of all stages lead, of which a sixth of the step is the weight.
    fn conclude(
        &self,
        begin: &Stage,
        sixth: f64,
        [a, b, c]: [&Stage; 3],
        to: &mut Stage,
        half_step: usize,
    ) {
        let own = self.own.iter().zip(&self.loads[half_step * self.own.len()..]);
        let known = begin.modes.iter().zip(&a.modes).zip(&b.modes).zip(&c.modes).zip(own);
        for (to, ((((from, a), b), c), (own, load))) in to.modes.iter_mut().zip(known) {
            to.x = from_fn(|i| from.x[i] + sixth * (from.v[i] + 2.0 * (a.v[i] + b.v[i]) + c.v[i]));
            to.v = from_fn(|i| from.v[i] + sixth * (from.a[i] + 2.0 * (a.a[i] + b.a[i]) + c.a[i]));
            to.accelerate(own, load);
        }
        self.act(begin, to);
    }

    /// Contact forces at the displacements of a stage, from those at the start of the step, and what they
    /// and other modes add to the accelerations.
    fn act(&self, begin: &Stage, at: &mut Stage) {
        let blocks = at.modes.len();
        for (j, column) in self.mutual.iter().enumerate() {
            let v = at.modes[j / LANES].v[j % LANES];
            subtract(&mut at.modes, column, v);
        }
        for (point, slider) in &self.sliders {
            let (point, shape) = (*point, self.shape(*point, blocks));
            let u = dot(shape, &at.modes, |own| &own.x);
            let mut force = [begin.force[point]];
            slider.increment(&[begin.contacts[point]], &[u], &mut force, None);
            (at.contacts[point], at.force[point]) = (u, force[0]);
            subtract(&mut at.modes, shape, force[0]);
        }
        for body in &self.others {
            let (points, kept) = (body.points.clone(), body.memory.clone());
            for point in points.clone() {
                at.contacts[point] = dot(self.shape(point, blocks), &at.modes, |own| &own.x);
            }
            let (force, memory) = (&mut at.force[points.clone()], &mut at.memory[kept.clone()]);
            force.copy_from_slice(&begin.force[points.clone()]);
            memory.copy_from_slice(&begin.memory[kept]);
            let [before, after] =
                [&begin.contacts, &at.contacts].map(|contacts| &contacts[points.clone()]);
            body.law.march(before, after, memory, force);
            for point in points {
                subtract(&mut at.modes, self.shape(point, blocks), at.force[point]);
            }
        }
    }

    fn shape(&self, point: usize, blocks: usize) -> &[Lanes] {
        &self.shapes[point * blocks..(point + 1) * blocks]
    }
}

impl Modes {
    /// Accelerations by own stiffness, own damping and loads.
    fn accelerate(&mut self, [w, c]: &[Lanes; 2], load: &Lanes) {
        self.a = from_fn(|i| load[i] - w[i] * self.x[i] - c[i] * self.v[i]);
    }
}

/// Numbers of modes, side by side.
pub(super) fn lanes(values: &[f64]) -> Vec<Lanes> {
    let block = |own: &[f64]| from_fn(|i| own.get(i).copied().unwrap_or(0.0));
    values.chunks(LANES).map(block).collect()
}

fn dot(shape: &[Lanes], modes: &[Modes], of: impl Fn(&Modes) -> &Lanes) -> f64 {
    let mut sums = [0.0; LANES];
    for (b, own) in shape.iter().zip(modes) {
        let x = of(own);
        sums = from_fn(|i| sums[i] + b[i] * x[i]);
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}

/// Takes some factor times a shape off the accelerations.
fn subtract(modes: &mut [Modes], shape: &[Lanes], factor: f64) {
    for (own, b) in modes.iter_mut().zip(shape) {
        own.a = from_fn(|i| own.a[i] - b[i] * factor);
    }
}
