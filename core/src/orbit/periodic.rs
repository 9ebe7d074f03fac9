//! The exact periodic orbit at one frequency.

use super::closed::{left_error, Orbit};
use super::plan::Plan;
use super::price::{affordable_steps, work_of_steps};
use super::reading::{misses, Reading};
use super::rotation::Rotation;
use super::settings::OrbitSettings;
use super::shooting::{Shooting, STEPS};
use super::sliders::{choose, Assumption, Chosen};
use super::start::start_of;
use crate::balance::{Kept, Point, PointStatus, Progress, Unknowns};
use crate::contact::Residual;
use crate::model::Model;
use crate::motion::{ModalSystem, Propagators, Quadrature, State, FASTEST_EXACT};
use crate::solve::{newton, NewtonSettings, Outcome, System as _};
use crate::timing::Profile;
use crate::Error;
use faer::c64;
use std::sync::Arc;

/// Rounds of following the motion itself, and spans in the first: each round doubles them.
const ROUNDS: usize = 9;
const FIRST_SPANS: usize = 4;

/// Closing error, relative to the motion, of an orbit.
const CLOSED: f64 = 1e-10;
/// The same of one that another step of Newton's method closes.
const NEARLY: f64 = 1e-6;

/// Error of a multiplier.
const ROUNDING: f64 = 1e-8;

/// Exact orbits of a model, from frequency to frequency.
pub struct PeriodicOrbits<'a> {
    pub(super) plan: Plan<'a>,
    /// By how much sliders are displaced, see [`Assumption`].
    pub(super) sliders: Vec<f64>,
    pub(super) everywhere: Vec<usize>,
    /// The last balance that an orbit began with, and whether a neighbour was no better.
    pub(super) balanced: Option<Unknowns>,
    /// Whether it is the motion whose orbit is sought.
    pub(super) given: bool,
    pub(super) beyond: bool,
    pub(super) quadrature: Quadrature,
    /// What is known of the stretches of earlier orbits.
    pub(super) propagators: Propagators,
    pub(super) progress: &'a Progress<'a>,
    pub(super) kept: Option<&'a Kept<Orbit>>,
    pub(super) share: f64,
    /// Steps of the flow, transition matrices and time.
    pub(crate) profile: Profile,
}

impl<'a> Plan<'a> {
    /// Orbits that tell `progress` how far they are.
    pub(super) fn orbits(self, progress: &'a Progress<'a>) -> PeriodicOrbits<'a> {
        PeriodicOrbits {
            everywhere: (0..self.system.modes()).collect(),
            plan: self,
            sliders: Vec::new(),
            balanced: None,
            given: false,
            beyond: false,
            quadrature: Quadrature::default(),
            propagators: Propagators::default(),
            progress,
            kept: None,
            share: 0.0,
            profile: Profile::default(),
        }
    }
}

impl<'a> PeriodicOrbits<'a> {
    /// Prepares orbits; displacements are surveyed at the DOFs `observe`.
    ///
    /// # Errors
    /// Settings outside their range, a DOF that does not exist, a failing eigenvalue iteration.
    pub fn new(
        model: &'a Model,
        settings: OrbitSettings,
        observe: &'a [usize],
    ) -> Result<Self, Error> {
        Ok(Plan::new(model, settings, observe)?.orbits(&|_| true))
    }

    /// Grants orbits from here on fewer steps of the flow than usual.
    pub(super) fn grant(&mut self, steps: usize) {
        self.plan.granted = steps.min(STEPS);
    }

    /// Has the balance of the next orbit begin with a motion at its frequency.
    pub(super) fn begin_with(&mut self, motion: Unknowns) {
        (self.balanced, self.given) = (Some(motion), true);
    }

    pub(super) fn system(&self) -> &ModalSystem {
        &self.plan.system
    }

    /// Seeks orbits of a symmetry in space and time; their multipliers stay unknown, as what breaks
    /// the symmetry is not followed.
    ///
    /// # Errors
    /// The model has no such symmetry.
    pub fn rotating(mut self, rotation: Option<Rotation>) -> Result<Self, Error> {
        if let Some(rotation) = &rotation {
            rotation.check(&self.plan.system)?;
        }
        self.plan.rotation = rotation;
        Ok(self)
    }

    /// Has `progress` called during the analysis.
    #[must_use]
    pub fn watched(mut self, progress: &'a Progress<'a>) -> Self {
        self.progress = progress;
        self
    }

    /// Has a sweep put its orbits into `kept` as they are found, too.
    #[must_use]
    pub fn keeping(mut self, kept: &'a Kept<Orbit>) -> Self {
        self.kept = Some(kept);
        self
    }

    /// Reports the share of the work done; `false` if the analysis is to end.
    pub(super) fn report(&mut self, share: f64) -> bool {
        self.share = share;
        (self.progress)(share)
    }

    /// Changes how many harmonics are reported.
    pub(super) fn report_up_to(&mut self, highest: usize) {
        self.plan.settings.harmonics = highest;
    }

    /// Whether orbits are half-wave symmetric.
    #[must_use]
    pub fn half_wave(&self) -> bool {
        self.plan.half_wave
    }

    /// Passes along the orbit that closes at the unknowns `y` and reads it off.
    fn read(&mut self, shooting: &mut Shooting<'_>, omega: f64, y: &[f64]) -> Reading {
        let start = std::time::Instant::now();
        let empty = self.empty(omega, PointStatus::Converged);
        let (settings, quadrature) = (&self.plan.settings, &mut self.quadrature);
        let read = empty.read(shooting, y, settings, self.plan.observe, quadrature);
        self.profile.recovery += start.elapsed();
        Reading::of(shooting, y, read)
    }

    /// A point that has not been computed.
    pub(super) fn empty(&self, omega: f64, status: PointStatus) -> Orbit {
        let observed = self.plan.observe.len();
        let size = 2 * self.plan.system.modes() + self.plan.system.memories();
        Orbit {
            response: Point::empty(omega, status, observed, self.plan.system.displacements()),
            range: vec![[f64::NAN; 2]; observed],
            state: vec![f64::NAN; size],
            multipliers: vec![c64::new(f64::NAN, f64::NAN); size],
            neutral: 0,
            work: f64::NAN,
            viscous: f64::NAN,
            events: Vec::new(),
            start: None,
        }
    }

    /// The orbit at one frequency [rad/s], from the state of a neighbour or from harmonic balance.
    ///
    /// # Errors
    /// The eigenvalues of a transition matrix cannot be found; a DOF that has hardly any mass.
    pub fn solve(&mut self, omega: f64, neighbour: Option<&State>) -> Result<Orbit, Error> {
        self.plan.system.check_pace(self.plan.model, omega, FASTEST_EXACT)?;
        if self.plan.carried_away {
            return Ok(self.empty(omega, PointStatus::Free));
        }
        let (progress, share) = (self.progress, self.share);
        let interrupted = || !progress(share);
        let system = Arc::clone(&self.plan.system);
        let mut shooting = Shooting::new(&system, omega, self.plan.half_wave, Some(&interrupted));
        shooting.grant(self.plan.granted.min(affordable_steps(&system)));
        shooting.assume(self.plan.settings.residual);
        if let Some(rotation) = self.plan.rotation {
            shooting.rotate(rotation, &system);
        }
        shooting.exchange(&mut self.propagators);
        let found = self.solve_by(&mut shooting, omega, neighbour);
        self.profile.work += work_of_steps(&system, shooting.flow.taken());
        shooting.exchange(&mut self.propagators);
        found
    }

    /// The same by shooting that is prepared.
    fn solve_by(
        &mut self,
        shooting: &mut Shooting<'_>,
        omega: f64,
        neighbour: Option<&State>,
    ) -> Result<Orbit, Error> {
        let system = shooting.coordinates.system();
        let solved = self.shoot(shooting, omega, neighbour);
        let solved = solved.map(|(mut y, mut iterations, closed)| {
            let (residual, newton) = (self.plan.settings.residual, self.newton());
            let assumption = Assumption { residual, sliders: &self.sliders };
            let chosen = choose(shooting, assumption, &mut y, newton, &mut iterations);
            (y, iterations, closed, chosen)
        });
        let steps = shooting.flow.steps;
        self.profile.evaluations += steps;
        let Some((mut y, mut iterations, closed, chosen)) = solved else {
            return Ok(self.empty(omega, PointStatus::NotComputed));
        };
        if chosen == Chosen::Lost && shooting.interrupted() {
            return Ok(self.empty(omega, PointStatus::NotComputed));
        }
        if !closed || chosen == Chosen::Lost {
            // What is far from closing is not worth a reading.
            let (closing, _) = misses(shooting, &y);
            if closing.is_nan() && shooting.interrupted() {
                return Ok(self.empty(omega, PointStatus::NotComputed));
            }
            if closing.is_nan() || closing > NEARLY || chosen == Chosen::Lost {
                self.profile.evaluations += shooting.flow.steps - steps;
                return Ok(self.unclosed(omega, shooting, closing, iterations));
            }
        }
        let mut read = self.read(shooting, omega, &y);
        if read.closing.is_nan() && shooting.interrupted() {
            return Ok(self.empty(omega, PointStatus::NotComputed));
        }
        // The last step of Newton's method was not looked at, nor was what an image beside another left out.
        let beyond = read.error.is_nan() || read.error > self.newton().tolerance;
        let missed = chosen == Chosen::Inside && beyond;
        if missed && (shooting.distrust() || read.closing <= NEARLY) {
            let mut closer = y.clone();
            let report = newton(shooting, &mut closer, self.newton());
            iterations += report.iterations;
            if report.outcome == Outcome::Converged {
                y = closer;
            }
            read = self.read(shooting, omega, &y);
        }
        self.profile.evaluations += shooting.flow.steps - steps;
        let Reading { mut orbit, touches, closing, left, .. } = read;
        if closing.is_nan() || closing > CLOSED {
            return Ok(self.unclosed(omega, shooting, closing, iterations));
        }
        let Some(left) = left else {
            // Contacts have let go of a body that they alone hold: it may as well stand elsewhere.
            let floats = !system.rigid_modes().is_empty();
            let status = if floats { PointStatus::Free } else { PointStatus::Singular };
            return Ok(self.empty(omega, status));
        };
        let known =
            match self.plan.rotation {
                Some(_) => None,
                None => Some(shooting.multipliers().ok_or_else(|| {
                    Error::Eigenvalues("transition matrix of the orbit".to_owned())
                })?),
            };
        self.profile.factorisations += shooting.matrices;
        let keeps_tractions = known.as_ref().is_some_and(|(_, neutral)| *neutral > 0);
        if keeps_tractions && self.plan.is_let_go() {
            // Contacts hold the body somewhere, but not where its loads take it from rest.
            return Ok(self.empty(omega, PointStatus::Free));
        }
        orbit.response.residual = closing;
        orbit.response.iterations = iterations;
        orbit.response.error_estimate = left_error(shooting, self.plan.observe, &left);
        if let Some((multipliers, neutral)) = known {
            orbit.neutral = neutral;
            // Where a limit is touched they are those of disturbances away from it: what grows there
            // grows.
            let touches = touches || chosen == Chosen::Touching;
            let grows = multipliers.get(neutral).is_some_and(|one| one.norm() > 1.0 + ROUNDING);
            if grows || !touches {
                orbit.multipliers = multipliers;
            }
        }
        Ok(orbit)
    }

    /// What there is to say where no orbit has closed.
    fn unclosed(
        &self,
        omega: f64,
        shooting: &Shooting<'_>,
        closing: f64,
        iterations: usize,
    ) -> Orbit {
        let status = match shooting.flow.is_spent() {
            _ if self.plan.is_let_go() => PointStatus::Free,
            true => PointStatus::StepsLimit,
            false => PointStatus::Stalled,
        };
        let mut orbit = self.empty(omega, status);
        orbit.response.residual = closing;
        orbit.response.iterations = iterations;
        orbit
    }

    /// The orbit whose sliders are displaced by `sliders` \[m\] from rest, as far as Coulomb allows;
    /// from a harmonic balance of all DOFs, as [`Residual::FromRest`] sees it.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub(crate) fn solve_displaced(
        &mut self,
        start: &Point,
        sliders: Vec<f64>,
    ) -> Result<Orbit, Error> {
        let residual = std::mem::replace(&mut self.plan.settings.residual, Residual::FromRest);
        self.sliders = sliders;
        let model = self.plan.with_history.as_deref().unwrap_or(self.plan.model);
        let state = start_of(model, &self.plan.system, Residual::FromRest, start, false);
        let orbit = self.solve(start.omega, Some(&state));
        self.plan.settings.residual = residual;
        self.sliders = Vec::new();
        orbit
    }

    /// Whether an orbit depends on the sliders that it leaves where they are.
    pub(crate) fn depends_on_sliders(&self) -> bool {
        self.plan.system.has_normals() && !self.plan.half_wave
    }

    pub(super) fn newton(&self) -> NewtonSettings {
        NewtonSettings { tolerance: 1e-13, max_iterations: self.plan.settings.max_iterations }
    }

    /// Newton's method from the neighbour, from harmonic balance, and at last from where the
    /// motion itself leads; also whether it has converged. `None` if the caller has ended the analysis.
    fn shoot(
        &mut self,
        shooting: &mut Shooting<'_>,
        omega: f64,
        neighbour: Option<&State>,
    ) -> Option<(Vec<f64>, usize, bool)> {
        let settings = self.newton();
        let mut iterations = 0;
        let mut y = match neighbour {
            Some(state) => self.nearer_start(shooting, omega, state),
            None => shooting.unknowns(&self.harmonic_start(omega, 0.0)),
        };
        // Any other start has other sliders.
        let attempts = if self.sliders.is_empty() { 3 + ROUNDS } else { 1 };
        for attempt in 0..attempts {
            match attempt {
                0 => {}
                1 if neighbour.is_some() => {
                    y = shooting.unknowns(&self.harmonic_start(omega, 0.0));
                }
                1 => continue,
                2 if self.begins_later() => {
                    match self.shoot_later(shooting, omega, &mut iterations) {
                        Some(begun) => y = begun,
                        None if shooting.interrupted() => return None,
                        None => continue,
                    }
                }
                2 => continue,
                round => {
                    let round = round - 1;
                    self.profile.homotopies += usize::from(round == 2);
                    if !shooting.settle(&mut y, FIRST_SPANS << (round - 2)) {
                        if shooting.interrupted() {
                            return None;
                        }
                        y = shooting.unknowns(&State::rest(&self.plan.system));
                    }
                }
            }
            let mut trial = y.clone();
            // Matrices of its steps need not tell the multipliers.
            shooting.propagators.rough = true;
            let report = newton(shooting, &mut trial, settings);
            shooting.propagators.rough = false;
            iterations += report.iterations;
            match report.outcome {
                Outcome::Converged => return Some((trial, iterations, true)),
                Outcome::Interrupted => return None,
                Outcome::Stalled | Outcome::Singular if shooting.interrupted() => return None,
                Outcome::Stalled | Outcome::Singular if shooting.flow.is_spent() => break,
                Outcome::Stalled | Outcome::Singular => {}
            }
        }
        Some((y, iterations, false))
    }
}
