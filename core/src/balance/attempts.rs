//! Attempts at one point of a forced response: the chosen method, and what follows where it fails.

use super::condensed::{Condensed, Path};
use super::forced::ForcedBalance;
use super::limit_load::is_carried_away;
use super::neighbour::Rough;
use super::open_mean::is_held_by_contacts;
use super::settings::{resolving, Method, Resolution};
use super::solution::{Point, PointStatus};
use super::unknowns::Unknowns;
use crate::solve::{
    broyden, homotopy, newton, norm, NewtonSettings, Outcome, Parametrised as _, Report,
    System as _,
};
use crate::Error;

/// Contact displacements over those of the stuck structure at which an undamped resonance counts as
/// one that friction does not bound.
const UNBOUNDED: f64 = 1e12;

/// The same at which a body may have gone away: equations that hold but for rounding do not say.
const AWAY: f64 = 1e6;

/// Residual, relative to the contact displacements, over the tolerance of the last step beyond which a motion is no
/// solution: 1e-8. Friction leaves 1e-11; rounding at stops 1e9 times as stiff as the structure leaves some 1e-9.
const UNBALANCED: f64 = 1e3;

/// Samples per period by which a motion is tried that exact integrals do not lead to.
const BLURRED: usize = 512;

/// Newton steps after which an exact orbit may be the better start: neighbours lead on in five.
const BRIEF: usize = 15;

impl ForcedBalance<'_> {
    /// Solves at one frequency with some harmonics and samples.
    ///
    /// # Errors
    /// As for a solution at one frequency.
    pub(super) fn solve_with(
        &mut self,
        resolution: Resolution,
        omega: f64,
        start: Option<&Unknowns>,
    ) -> Result<Point, Error> {
        let solved = self.attempt(resolution, omega, start)?;
        let failed = !matches!(solved.status, PointStatus::Converged | PointStatus::NotComputed);
        if !failed || resolution.samples.is_some() || self.follows() || self.is_spent() {
            return Ok(solved);
        }
        let (found, by_fewer) = self.solve_by_fewer(resolution, omega)?;
        if let Some(point) = found {
            return Ok(point);
        }
        // Where many harmonics fail of which fewer have a solution, a path takes long and hardly leads on.
        let hopeless = by_fewer && !self.has_short_homotopies(resolution.harmonics);
        let stuck = matches!(solved.status, PointStatus::Stalled | PointStatus::Free);
        if !stuck || hopeless || self.is_spent() {
            return Ok(solved);
        }
        if let Some(point) = self.solve_from_aside(resolution, omega)? {
            return Ok(point);
        }
        if solved.status != PointStatus::Stalled || self.is_spent() {
            return Ok(solved);
        }
        // Samples blur the edges between states at which an exact law may hold Newton's method up.
        let samples = Some(resolving(resolution.harmonics).max(BLURRED));
        let blurred = self.attempt(Resolution { samples, ..resolution }, omega, start)?;
        if !blurred.is_solved() {
            return Ok(solved);
        }
        let sharp = self.attempt(resolution, omega, blurred.unknowns.as_ref())?;
        let ended = sharp.status == PointStatus::NotComputed;
        Ok(if sharp.is_solved() || ended { sharp } else { blurred })
    }

    /// The chosen method from a start, and what follows where it fails.
    pub(super) fn attempt(
        &mut self,
        resolution: Resolution,
        omega: f64,
        start: Option<&Unknowns>,
    ) -> Result<Point, Error> {
        let rough = start.map(|start| self.rough_start(resolution, omega, start)).transpose()?;
        let lost = matches!(rough, Some(Rough::Lost));
        let start = match &rough {
            Some(Rough::Found(rough)) => Some(rough),
            _ => start,
        };
        let table = self.table(resolution.harmonics);
        let model = self.evaluated(resolution.samples)?;
        let interrupted = self.interruption();
        let mut equations = Condensed::new(model, &table, self.settings.residual, false);
        equations.watch(&interrupted);
        equations.granted = self.left();
        if self.settings.method != Method::Newton {
            equations.densify();
        }
        let states = self.neighbour.states.iter();
        equations.loads.iter_mut().zip(states).for_each(|(load, s)| load.repeated.clone_from(s));
        let solved =
            self.solve_equations(&mut equations, omega, (start, lost), resolution.samples)?;
        let states = equations.loads.iter_mut().map(|load| load.repeated.take());
        self.neighbour.states = states.collect();
        self.add_profile(&equations.profile);
        Ok(solved)
    }

    /// Whether static loads carry a body away.
    fn is_carried_away(&self) -> bool {
        *self.carried_away.get_or_init(|| is_carried_away(&self.model))
    }

    /// Whether a body that contacts alone hold goes away at a frequency, so that no motion repeats.
    fn goes_away(&mut self, omega: f64) -> bool {
        let held = self.is_monotone() && is_held_by_contacts(self.model.compliance());
        held && (self.is_carried_away() || self.walks(omega))
    }

    /// Whether a homotopy leads to the solution: it does where there is one alone.
    fn follows(&self) -> bool {
        self.is_monotone()
    }

    /// The chosen method from the start, then homotopy, then a status that says so.
    fn solve_equations(
        &mut self,
        equations: &mut Condensed<'_>,
        omega: f64,
        (start, lost): (Option<&Unknowns>, bool),
        samples: Option<usize>,
    ) -> Result<Point, Error> {
        let contacts = self.model.compliance().contacts();
        if let Err((order, error)) = equations.set_omega(omega) {
            if order == 0 || self.forced.contains(&order) {
                return Err(error);
            }
            return Ok(Point::empty(omega, PointStatus::Singular, self.observe.len(), contacts));
        }
        let harmonics = equations.harmonics();
        let mut x = start.map_or_else(
            || equations.stuck_response().to_vec(),
            |unknowns| unknowns.recast(harmonics),
        );
        let mut report = self.begin(equations, omega, &mut x, lost);
        if has_failed(&report) && self.has_no_bound(omega) {
            return Ok(Point::empty(omega, PointStatus::Singular, self.observe.len(), contacts));
        }
        let far = norm(&x) > AWAY * norm(equations.stuck_response());
        if (has_failed(&report) || far) && self.goes_away(omega) {
            return Ok(Point::empty(omega, PointStatus::Free, self.observe.len(), contacts));
        }
        let patient = self.is_worth_a_homotopy(harmonics.highest());
        if has_failed(&report) && start.is_some() && patient {
            // A neighbour in another state of the contacts may mislead.
            let spent = report.iterations;
            x = equations.stuck_response().to_vec();
            report = self.iterate(equations, &mut x, self.settings.newton);
            report.iterations += spent;
        }
        let orbit = has_failed(&report) && self.start_again(equations, omega, &mut x, &mut report);
        // Where harmonics are chosen an orbit is the answer.
        let answered = orbit && self.control.only_harmonics_climb();
        // Where nothing holds the mean of many contacts, paths to the same motion take minutes.
        let lacks = equations.lacks_direction();
        let lost = report.outcome == Outcome::Singular && (equations.is_lost() || lacks);
        let follows = (samples.is_some() || self.follows()) && !lost;
        if has_failed(&report) && !answered && patient && follows {
            self.profile.homotopies += 1;
            self.follow_paths(equations, &mut x, &mut report);
        }
        let status = match report.outcome {
            Outcome::Interrupted => {
                return Ok(self.not_computed(omega));
            }
            Outcome::Converged => PointStatus::Converged,
            Outcome::Singular if equations.free => PointStatus::Free,
            Outcome::Stalled if equations.loose || equations.floats() => PointStatus::Free,
            Outcome::Stalled | Outcome::Singular if self.is_carried_away() => PointStatus::Free,
            Outcome::Singular if !lacks => PointStatus::Singular,
            Outcome::Stalled | Outcome::Singular => PointStatus::Stalled,
        };
        if status != PointStatus::Converged {
            // The recovery reads slip loads at the point that is returned.
            equations.residual(&x, &mut vec![0.0; x.len()]);
        }
        let start = std::time::Instant::now();
        let mut point = equations.recover(&x, self.observe, status)?;
        point.samples = samples;
        self.profile.recovery += start.elapsed();
        // Without an observed DOF there is nothing whose error could be estimated.
        if status == PointStatus::Converged && self.estimated && !self.observe.is_empty() {
            let start = std::time::Instant::now();
            let estimated = self.estimate(equations, &x, &mut point, false)?;
            self.profile.estimate += start.elapsed();
            if !estimated {
                return Ok(self.not_computed(omega));
            }
        }
        point.residual = report.residual;
        point.iterations = report.iterations;
        point.unknowns = Some(Unknowns { harmonics: harmonics.clone(), values: x });
        Ok(point)
    }

    /// The chosen method from `x`; where Newton's is lost on its way, from an exact orbit that costs less.
    fn begin(
        &mut self,
        equations: &mut Condensed<'_>,
        omega: f64,
        x: &mut Vec<f64>,
        lost: bool,
    ) -> Report {
        let newton = self.settings.newton;
        let mut report = Report { outcome: Outcome::Stalled, iterations: 0, residual: f64::NAN };
        let orbit = lost || self.favours_orbit(omega, equations.harmonics().highest());
        if !lost {
            let most = if orbit { BRIEF } else { usize::MAX };
            let max_iterations = most.min(newton.max_iterations);
            report = self.iterate(equations, x, NewtonSettings { max_iterations, ..newton });
            if report.outcome != Outcome::Stalled || report.iterations < most {
                return report;
            }
            self.neighbour.lose();
        }
        self.start_again(equations, omega, x, &mut report);
        if has_failed(&report) {
            let spent = report.iterations;
            report = self.iterate(equations, x, newton);
            report.iterations += spent;
        }
        report
    }

    /// The chosen method from `x`.
    fn iterate(
        &mut self,
        equations: &mut Condensed<'_>,
        x: &mut [f64],
        settings: NewtonSettings,
    ) -> Report {
        let Method::Broyden(first) = self.settings.method else {
            let report = newton(equations, x, settings);
            return self.if_sound(report, x, equations);
        };
        let (report, effort) = broyden(equations, x, settings, first);
        equations.profile.factorisations += effort.jacobians;
        self.profile.updates += effort.updates;
        self.profile.restarts += usize::from(effort.jacobians > 1);
        self.if_sound(report, x, equations)
    }

    /// Newton's method from the exact orbit, or from a motion that settles where laws have no events and
    /// no homotopy leads on; whether there is an orbit.
    fn start_again(
        &mut self,
        equations: &mut Condensed<'_>,
        omega: f64,
        x: &mut Vec<f64>,
        report: &mut Report,
    ) -> bool {
        let harmonics = equations.harmonics();
        let highest = harmonics.highest();
        let exact =
            self.orbit_to_start_from(omega, highest).map(|orbit| orbit.contact_displacement);
        let is_exact = exact.is_some();
        let start = exact.or_else(|| self.settled_motion(omega, highest));
        equations.granted = self.left();
        let Some(amplitudes) = start else { return false };
        let orders = highest + 1;
        let mut trial = vec![0.0; x.len()];
        let points = amplitudes.chunks_exact(orders).zip(trial.chunks_exact_mut(harmonics.slots()));
        points.for_each(|(amplitudes, series)| harmonics.write_series(amplitudes, series));
        let again = newton(equations, &mut trial, self.settings.newton);
        let again = self.if_sound(again, &trial, equations);
        report.iterations += again.iterations;
        if !has_failed(&again) {
            (report.outcome, report.residual) = (again.outcome, again.residual);
            *x = trial;
        }
        is_exact
    }

    /// Homotopy, by Newton's method, after the chosen method has failed: first in the contact
    /// stiffness, whose path is smooth even for nearly rigid contacts, then, where friction alone acts, in
    /// a loss: beside a resonance that friction hardly bounds it leads to the phase that friction cannot
    /// change. Springs without stiffness at rest have no such loss; their path is that of the load.
    fn follow_paths(&self, equations: &mut Condensed<'_>, x: &mut Vec<f64>, report: &mut Report) {
        let last = if self.is_monotone() { Path::Loss } else { Path::Load };
        let price = self.price(self.model.compliance().contacts());
        let budget = price.budget_of_homotopy(equations.harmonics().highest());
        for path in [Path::Stiffness, last] {
            let mut along = x.clone();
            equations.choose(path);
            let followed = homotopy(equations, &mut along, self.settings.newton, budget);
            let followed = self.if_sound(followed, &along, equations);
            report.iterations += followed.iterations;
            if !has_failed(&followed) {
                (report.outcome, report.residual) = (followed.outcome, followed.residual);
                *x = along;
                break;
            }
            if equations.is_lost() {
                report.outcome = Outcome::Singular;
                break;
            }
        }
        // The recovery reads slip loads and tangents at the point that is returned.
        let mut residual = vec![0.0; equations.size()];
        equations.residual(x, &mut residual);
    }

    /// The report of a solution, unless nothing bounds the motion, or the equations do not hold there.
    fn if_sound(&self, report: Report, x: &[f64], equations: &Condensed<'_>) -> Report {
        if report.outcome == Outcome::Converged && !self.is_balanced(report.residual) {
            return Report { outcome: Outcome::Stalled, ..report };
        }
        if report.outcome == Outcome::Converged && !is_bounded(x, equations.stuck_response()) {
            return Report { outcome: Outcome::Singular, ..report };
        }
        report
    }

    /// Whether the equations hold at a solution, however small the last step was that led to it: a force that
    /// jumps lets Newton's method step to and fro over the jump.
    pub(super) fn is_balanced(&self, residual: f64) -> bool {
        is_balanced(residual, self.settings.newton)
    }
}

/// Whether a residual, relative to the motion, is that of a solution.
pub(crate) fn is_balanced(residual: f64, settings: NewtonSettings) -> bool {
    residual <= UNBALANCED * settings.tolerance
}

/// Whether a motion is small enough that rounding leaves the effect of the load in its digits.
pub(super) fn is_bounded(x: &[f64], stuck: &[f64]) -> bool {
    norm(x) <= UNBOUNDED * norm(stuck)
}

fn has_failed(report: &Report) -> bool {
    !matches!(report.outcome, Outcome::Converged | Outcome::Interrupted)
}
