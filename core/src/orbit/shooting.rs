//! Shooting: the start state that the flow brings back after a period, or to its mirror image
//! after half a period.

use super::closing::Closing;
use super::loop_memory::LoopMemory;
use super::price::matrix_price;
use super::rotation::Rotation;
use crate::contact::{PointState, Residual};
use crate::motion::{Flow, FlowEvent, LinearPhase, ModalSystem, Propagators, State, Transition};
use crate::solve::System;
use faer::Mat;

/// Steps of the flow that an orbit is granted: some thousand periods of a motion of a hundred modes, or
/// minutes of one of many more. What needs more has hardly any mass somewhere, or no orbit.
pub(super) const STEPS: usize = 1 << 22;

/// The closing condition of a periodic orbit at one frequency, in the coordinates of
/// [`Transition`].
pub(super) struct Shooting<'a> {
    pub(super) flow: Flow<'a>,
    pub(super) coordinates: Transition<'a>,
    limits: &'a [f64],
    /// Forces that the contacts remember beyond the number of strains.
    pub(super) idle: usize,
    pub(super) half_wave: bool,
    /// Whether segments are those of half a period.
    pub(super) symmetric: bool,
    /// Symmetry of a travelling wave, and what it does to the coordinates.
    pub(super) rotation: Option<(Rotation, Mat<f64>)>,
    pub(super) period: f64,
    span: f64,
    /// When the span begins \[s\].
    begin: f64,
    interrupted: Option<&'a dyn Fn() -> bool>,
    /// Of the last evaluation: phases, what held the forces at the start, points that have slipped.
    pub(super) phases: Vec<LinearPhase>,
    pub(super) held: Vec<PointState>,
    /// The forces at the start.
    pub(super) begun: Vec<f64>,
    pub(super) slipped: Vec<bool>,
    /// Steps of the flow that it took.
    steps: usize,
    /// What contacts without sliders remember.
    pub(super) memory: LoopMemory,
    /// State after the span.
    pub(super) end: Option<State>,
    /// Derivative of the image, and whether it is that of an evaluation before the last one.
    pub(super) derivative: Option<Mat<f64>>,
    closing: Option<Closing>,
    earlier: bool,
    /// Unknowns, image and points that have slipped of the last evaluation.
    pub(super) last: Option<(Vec<f64>, Vec<f64>, Vec<bool>)>,
    /// Transition matrices assembled so far, and exponentials of their stretches.
    pub(super) matrices: usize,
    /// Whether transition matrices are paid for with steps of the flow.
    charges: bool,
    pub(super) propagators: Propagators,
    /// Whether images beside the last one may serve, and how many have.
    pub(super) trusts: bool,
    pub(super) beside: usize,
}

impl<'a> Shooting<'a> {
    pub(super) fn new(
        system: &'a ModalSystem,
        omega: f64,
        half_wave: bool,
        interrupted: Option<&'a dyn Fn() -> bool>,
    ) -> Self {
        let coordinates = Transition::new(system, omega);
        Self::within(system, omega, half_wave, interrupted, coordinates)
    }

    /// As [`Shooting::new`], in given coordinates.
    pub(super) fn within(
        system: &'a ModalSystem,
        omega: f64,
        half_wave: bool,
        interrupted: Option<&'a dyn Fn() -> bool>,
        coordinates: Transition<'a>,
    ) -> Self {
        let period = std::f64::consts::TAU / omega;
        let flow = Flow::new(system, omega).granted(STEPS);
        let flow = match interrupted {
            Some(interrupted) => flow.watched(interrupted),
            None => flow,
        };
        Self {
            flow,
            coordinates,
            limits: system.limits(),
            idle: system.memories() - system.strains() - LoopMemory::places(system),
            half_wave,
            symmetric: half_wave,
            rotation: None,
            period,
            span: if half_wave { 0.5 * period } else { period },
            begin: 0.0,
            interrupted,
            phases: Vec::new(),
            held: Vec::new(),
            begun: Vec::new(),
            slipped: Vec::new(),
            steps: 0,
            memory: LoopMemory::new(system, half_wave),
            end: None,
            derivative: None,
            closing: None,
            earlier: false,
            last: None,
            matrices: 0,
            charges: false,
            propagators: Propagators::default(),
            trusts: true,
            beside: 0,
        }
    }

    /// Takes over what is known of stretches of other motions, and gives it back.
    pub(super) fn exchange(&mut self, known: &mut Propagators) {
        std::mem::swap(&mut self.propagators, known);
    }

    /// Has contacts without sliders keep what a residual traction says.
    pub(super) fn assume(&mut self, residual: Residual) {
        self.memory.assume(residual);
        self.last = None;
    }

    /// The unknowns of a state: its coordinates, and behind them what contacts without sliders remember.
    pub(super) fn unknowns(&self, state: &State) -> Vec<f64> {
        let mut y = self.coordinates.coordinates(state);
        y.extend(self.memory.numbers(state));
        y
    }

    /// The state of the unknowns.
    pub(super) fn state(&self, y: &[f64]) -> State {
        let (mut state, _) = self.coordinates.state(y);
        self.memory.recall(&mut state, self.coordinates.system(), &y[self.coordinates.size()..]);
        state
    }

    /// Whether the flow is confined to the part of a period after which sectors have changed their roles.
    pub(super) fn rotates(&self) -> bool {
        self.rotation.is_some()
    }

    /// Has the span begin a share of it later.
    pub(super) fn begin_later(&mut self, share: f64) {
        self.begin = share * self.span;
        self.last = None;
    }

    /// The unknowns of an orbit that is closed, with its span beginning at 0 again.
    pub(super) fn begun_at_zero(&mut self, y: &[f64]) -> Option<Vec<f64>> {
        let share = 1.0 - self.begin / self.span;
        let mut y = self.later(y, share, &mut |_, _| {})?;
        if self.half_wave {
            y.iter_mut().for_each(|y| *y = -*y);
        }
        self.begin = 0.0;
        self.last = None;
        // What is remembered is that of the period before.
        self.image(&y)
    }

    /// Grants the flow another number of steps; of fewer than usual, transition matrices take their share.
    pub(super) fn grant(&mut self, steps: usize) {
        self.flow.grant(steps);
        self.charges = steps < STEPS;
    }

    /// Confines the flow to the part of a period after which sectors have changed their roles.
    pub(super) fn rotate(&mut self, rotation: Rotation, system: &ModalSystem) {
        self.span = self.period / rotation.parts as f64;
        self.memory.rotate(&rotation);
        self.last = None;
        self.rotation = Some((rotation, rotation.matrix(&self.coordinates, system)));
    }

    /// Confines the flow to one of `count` equal segments of half a period, of which the image of the
    /// last one alone is mirrored; or of the whole period without half-wave symmetry.
    pub(super) fn narrow(&mut self, number: usize, count: usize) {
        let whole = if self.symmetric { 0.5 * self.period } else { self.period };
        self.span = whole / count as f64;
        self.half_wave = self.symmetric && number + 1 == count;
        self.memory.narrow(number, count);
        self.last = None;
    }

    /// Leaves what elements hold that never slip out of a derivative.
    pub(super) fn hold_origins(&self, matrix: &mut Mat<f64>) {
        self.memory.hold_origins(matrix);
    }

    /// Whether each point has slipped in the last evaluation.
    pub(super) fn slipped(&self) -> &[bool] {
        &self.slipped
    }

    /// Coordinates after the span, mirrored under half-wave symmetry.
    pub(super) fn image(&mut self, y: &[f64]) -> Option<Vec<f64>> {
        self.observed_image(y, None)
    }

    /// The same; what the flow passes is shown to an observer.
    pub(super) fn observed_image(
        &mut self,
        y: &[f64],
        mut observe: Option<&mut dyn FnMut(&FlowEvent<'_>)>,
    ) -> Option<Vec<f64>> {
        let known = self.last.as_ref().filter(|(last, ..)| observe.is_none() && last == y);
        if let Some((_, image, slipped)) = known {
            self.slipped.clone_from(slipped);
            if std::mem::take(&mut self.earlier) {
                (self.derivative, self.closing) = (None, None);
            }
            return Some(image.clone());
        }
        let (mut state, held) = self.coordinates.state(y);
        let (size, system) = (self.coordinates.size(), self.coordinates.system());
        self.memory.begin(&mut state, system, &y[size..]);
        self.held = held;
        self.begun.clone_from(&state.force);
        self.phases.clear();
        (self.derivative, self.closing) = (None, None);
        (self.earlier, self.last) = (false, None);
        let (phases, memory) = (&mut self.phases, &mut self.memory);
        state.time = self.begin;
        let before = self.flow.steps;
        let run = self.flow.run(&mut state, self.begin + self.span, &mut |passage| {
            LinearPhase::record(phases, system, &passage);
            memory.follow(&passage);
            if let Some(observe) = &mut observe {
                observe(&passage);
            }
        });
        self.steps = self.flow.steps - before;
        self.slipped = (0..self.limits.len())
            .map(|i| {
                self.held[i] != PointState::Stuck || self.phases.iter().any(|phase| phase.slips(i))
            })
            .collect();
        if let Some((rotation, _)) = &self.rotation {
            rotation.spread(&mut self.slipped);
        }
        run.ok()?;
        let remembered = self.memory.end(system, &state, y)?;
        let mut image = self.coordinates.coordinates(&state);
        self.end = Some(state);
        if let Some((_, matrix)) = &self.rotation {
            let turned = matrix * Mat::from_fn(size, 1, |i, _| image[i]);
            image.iter_mut().enumerate().for_each(|(i, y)| *y = turned[(i, 0)]);
        }
        image.extend(remembered);
        if self.rotation.is_none() && self.half_wave {
            image.iter_mut().for_each(|y| *y = -*y);
        }
        self.last = Some((y.to_vec(), image.clone(), self.slipped.clone()));
        Some(image)
    }

    /// Follows a state through the whole period; `false` where that fails.
    pub(super) fn follow_period(
        &mut self,
        state: &mut State,
        observe: &mut dyn FnMut(FlowEvent<'_>),
    ) -> bool {
        self.flow.run(state, self.period, observe).is_ok()
    }

    /// The unknowns a share of the span behind a start, as the flow leads there; `observe` hears of the
    /// share of the span at each passage.
    pub(super) fn later(
        &mut self,
        y: &[f64],
        share: f64,
        observe: &mut dyn FnMut(f64, &FlowEvent<'_>),
    ) -> Option<Vec<f64>> {
        let (mut state, span) = (self.state(y), self.span);
        state.time = self.begin;
        let until = self.begin + share * span;
        let run = self.flow.run(&mut state, until, &mut |passage| {
            let time = match &passage {
                FlowEvent::Segment(segment) => segment.start,
                FlowEvent::Event { event, .. } => event.time,
            };
            observe(time / span, &passage);
        });
        run.ok()?;
        Some(self.unknowns(&state))
    }

    /// Follows the motion itself over some spans: passive systems settle by themselves.
    pub(super) fn settle(&mut self, y: &mut Vec<f64>, spans: usize) -> bool {
        for _ in 0..spans {
            if self.interrupted() {
                return false;
            }
            match self.image(y) {
                Some(image) => *y = image,
                None => return false,
            }
        }
        true
    }

    /// Derivative of the image at the last evaluation.
    pub(super) fn derivative(&mut self) -> Mat<f64> {
        if let Some(derivative) = &self.derivative {
            return derivative.clone();
        }
        self.matrices += 1;
        if self.charges {
            let passes = self.price();
            self.flow.charge((passes * self.steps as f64) as usize);
        }
        let modes = self.coordinates.system().modes();
        self.propagators.serve(std::f64::consts::TAU / self.period, modes);
        let (coordinates, known) = (&self.coordinates, &mut self.propagators);
        let along = self.memory.along(coordinates, &self.phases, &self.held, &self.begun, known);
        let derivative = match &self.rotation {
            Some((_, matrix)) => {
                let (mut turned, size) = (along, matrix.nrows());
                let motion = matrix * turned.get(..size, ..);
                turned.get_mut(..size, ..).copy_from(&motion);
                turned
            }
            None if self.half_wave => faer::Scale(-1.0) * along,
            None => along,
        };
        self.derivative = Some(derivative.clone());
        derivative
    }
}

impl System for Shooting<'_> {
    fn size(&self) -> usize {
        self.coordinates.size() + LoopMemory::places(self.coordinates.system())
    }

    fn residual(&mut self, x: &[f64], out: &mut [f64]) {
        match self.image(x) {
            Some(image) => {
                for ((out, image), x) in out.iter_mut().zip(image).zip(x) {
                    *out = image - x;
                }
            }
            None => out.fill(f64::NAN),
        }
    }

    fn value(&mut self, x: &[f64], out: &mut [f64]) {
        if let Some(image) = self.image_beside(x) {
            out.iter_mut().zip(image.iter().zip(x)).for_each(|(out, (image, x))| *out = image - x);
            return;
        }
        let (derivative, slipped) = (self.derivative(), std::mem::take(&mut self.slipped));
        let closing = self.closing.take();
        self.residual(x, out);
        (self.derivative, self.slipped, self.earlier) = (Some(derivative), slipped, true);
        self.closing = closing;
    }

    fn price(&self) -> f64 {
        let stretches = self.phases.iter().filter(|phase| phase.is_linear()).count();
        let (size, system) = (self.coordinates.size(), self.coordinates.system());
        matrix_price(system, size, stretches, self.steps)
    }

    /// An orbit is passed along once more where it is read.
    fn is_seen_again(&self) -> bool {
        true
    }

    fn interrupted(&self) -> bool {
        self.interrupted.is_some_and(|ask| ask())
    }

    fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
        if self.closing.is_none() {
            let matrix = self.derivative();
            // The slip of a contact that never slips is free: it stays as it is.
            let conserved = match self.half_wave {
                true => Vec::new(),
                false => self.conserved(&matrix, &self.slipped),
            };
            self.closing = Closing::new(matrix, &conserved);
        }
        self.closing.as_ref().is_some_and(|closing| closing.step(rhs, step))
    }
}
