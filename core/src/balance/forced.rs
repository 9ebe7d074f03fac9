//! The forced response at one frequency.

use super::condensed::{Condensed, Path};
use super::evaluation::{Evaluated, Evaluations};
use super::resolution_control::{Level, ResolutionControl};
use super::scale::Scale;
use super::settings::{resolving, Method, Resolution, Settings};
use super::solution::{Point, PointStatus};
use super::statics::with_history;
use super::tangent::Tangent;
use super::unknowns::Unknowns;
use super::{ExactOrbits, Kept, Progress};
use crate::contact::Residual;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::{
    broyden, homotopy, newton, norm, Outcome, Parametrised as _, Report, System as _,
};
use crate::timing::Profile;
use crate::Error;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Contact displacements over those of the stuck structure at which an undamped resonance counts as
/// one that friction does not bound.
const UNBOUNDED: f64 = 1e12;

/// Samples per period by which a motion is tried that exact integrals do not lead to.
const BLURRED: usize = 512;

/// The harmonic balance of a model under its loads, from point to point.
pub struct ForcedBalance<'a> {
    pub(super) model: Evaluated<'a>,
    pub(super) settings: Settings,
    pub(super) observe: &'a [usize],
    half_wave: bool,
    forced: Vec<usize>,
    tables: Tables,
    evaluations: Evaluations<'a>,
    pub(super) control: ResolutionControl,
    pub(super) scale: Scale,
    /// The tangent at the last point of a sweep whose branch was asked for.
    pub(super) tangent: Option<Tangent>,
    progress: &'a Progress<'a>,
    pub(super) kept: Option<&'a Kept<Point>>,
    pub(super) rescue: Option<&'a dyn ExactOrbits>,
    share: f64,
    pub(super) profile: Profile,
}

/// Sample tables by highest harmonic.
#[derive(Default)]
struct Tables {
    /// Of solutions.
    fine: BTreeMap<usize, Arc<SampleTable>>,
    /// Of error estimates.
    coarse: BTreeMap<usize, Arc<SampleTable>>,
}

/// What passes from one balance to the next: sample tables, the level that automatic harmonics and
/// samples start from, and the account of the work.
#[derive(Default)]
pub(crate) struct WarmStart {
    tables: Tables,
    level: Level,
    half_wave: bool,
    pub(crate) profile: Profile,
}

impl<'a> ForcedBalance<'a> {
    /// Prepares the balance; displacements are recovered at the DOFs `observe`.
    ///
    /// # Errors
    /// Settings outside their range, a DOF that does not exist, or a mean displacement that
    /// rigid-body motion leaves undefined.
    pub fn new(model: &'a Model, settings: Settings, observe: &'a [usize]) -> Result<Self, Error> {
        let forced = model.compliance().forced_harmonics();
        let settings = settings.suited(model);
        settings.check(&forced)?;
        settings.check_resolution(model.resolves())?;
        Error::check_dofs(observe, model.compliance().dofs())?;
        let model = match settings.residual {
            Residual::FromRest => with_history(model)?.map(Arc::new).map(Evaluated::Made),
            Residual::Centred | Residual::Value(_) => None,
        }
        .unwrap_or(Evaluated::Given(model));
        let half_wave = model.is_symmetric() && settings.residual.is_symmetric();
        if !half_wave {
            model.compliance().require_grounded()?;
        }
        Ok(Self {
            settings,
            observe,
            half_wave,
            control: ResolutionControl::new(settings, &forced),
            forced,
            tables: Tables::default(),
            evaluations: Evaluations::new(model.clone()),
            model,
            scale: Scale::default(),
            tangent: None,
            progress: &|_| true,
            kept: None,
            rescue: None,
            share: 0.0,
            profile: Profile::default(),
        })
    }

    /// Has `progress` called during the analysis.
    #[must_use]
    pub fn watched(mut self, progress: &'a Progress<'a>) -> Self {
        self.progress = progress;
        self
    }

    /// Has automatic harmonics, samples and steps follow some of the observed DOFs alone, given by
    /// their positions in `observe`; of all if there is none.
    #[must_use]
    pub fn driven_by(mut self, driving: &[usize]) -> Self {
        self.scale = Scale::of(driving, self.observe.len());
        self
    }

    /// Has a sweep put its points into `kept` as they are solved, too.
    #[must_use]
    pub fn keeping(mut self, kept: &'a Kept<Point>) -> Self {
        self.kept = Some(kept);
        self
    }

    /// Has `rescue` asked for a start where Newton's method fails, before any homotopy, and for the
    /// answer where automatic harmonics would cost more.
    #[must_use]
    pub fn rescued(mut self, rescue: &'a dyn ExactOrbits) -> Self {
        self.rescue = Some(rescue);
        self
    }

    /// Reports the share of the work done; `false` if the analysis is to end.
    pub(crate) fn report(&mut self, share: f64) -> bool {
        self.share = share;
        (self.progress)(share)
    }

    /// Whether the analysis is to end.
    pub(super) fn interruption(&self) -> impl Fn() -> bool + 'a {
        let (progress, share) = (self.progress, self.share);
        move || !progress(share)
    }

    /// Takes over what another balance of the same contacts has learnt.
    #[must_use]
    pub(crate) fn remembering(mut self, memory: WarmStart) -> Self {
        let WarmStart { tables, level, half_wave, profile } = memory;
        if half_wave == self.half_wave {
            (self.tables, self.control.level) = (tables, level);
        }
        self.profile = profile;
        self
    }

    /// What a balance of the same contacts can use again.
    pub(crate) fn into_memory(self) -> WarmStart {
        let Self { tables, control, half_wave, profile, .. } = self;
        WarmStart { tables, level: control.level, half_wave, profile }
    }

    /// Whether only odd harmonics are solved for.
    #[must_use]
    pub fn half_wave(&self) -> bool {
        self.half_wave
    }

    pub(crate) fn table(&mut self, highest: usize) -> Arc<SampleTable> {
        let half_wave = self.half_wave;
        let table = || Arc::new(SampleTable::new(Harmonics::new(highest, half_wave)));
        Arc::clone(self.tables.fine.entry(highest).or_insert_with(table))
    }

    /// The table of an error estimate.
    pub(super) fn coarse_table(&mut self, highest: usize) -> Arc<SampleTable> {
        let half_wave = self.half_wave;
        let table = || Arc::new(SampleTable::coarse(Harmonics::new(highest, half_wave)));
        Arc::clone(self.tables.coarse.entry(highest).or_insert_with(table))
    }

    /// The model as it is evaluated with some samples per period, or with none.
    ///
    /// # Errors
    /// An odd or too small number of samples.
    pub(crate) fn evaluated(&mut self, samples: Option<usize>) -> Result<Evaluated<'a>, Error> {
        self.evaluations.with(samples)
    }

    /// Solves at a frequency that nobody has asked for, or aside of it where an undamped mode resonates with
    /// the load or with a harmonic of friction.
    ///
    /// # Errors
    /// As for a solution at one frequency.
    pub(crate) fn solve_beside(
        &mut self,
        omega: f64,
        aside: f64,
        start: Option<&Unknowns>,
    ) -> Result<Point, Error> {
        match self.solve(omega, start) {
            Ok(point) if point.status != PointStatus::Singular => Ok(point),
            Ok(_) | Err(Error::UndampedResonance { .. }) => self.solve(omega + aside, start),
            Err(error) => Err(error),
        }
    }

    /// Whether no contact slips at a frequency: the stuck response is the solution.
    ///
    /// # Errors
    /// As for a solution at one frequency.
    pub(crate) fn sticks(&mut self, omega: f64) -> Result<bool, Error> {
        let Resolution { harmonics, samples } = self.control.first();
        let (table, model) = (self.table(harmonics), self.evaluated(samples)?);
        let mut equations = Condensed::new(model, &table, self.settings.residual, false);
        if equations.set_omega(omega).is_err() {
            return Ok(false);
        }
        let x = equations.stuck_response().to_vec();
        equations.residual(&x, &mut vec![0.0; x.len()]);
        Ok(equations.is_linear())
    }

    pub(super) fn solve_with(
        &mut self,
        resolution: Resolution,
        omega: f64,
        start: Option<&Unknowns>,
    ) -> Result<Point, Error> {
        let solved = self.attempt(resolution, omega, start)?;
        let failed = !matches!(solved.status, PointStatus::Converged | PointStatus::NotComputed);
        if !failed || resolution.samples.is_some() || self.follows() {
            return Ok(solved);
        }
        if let Some(point) = self.solve_by_fewer(resolution, omega)? {
            return Ok(point);
        }
        if solved.status != PointStatus::Stalled {
            return Ok(solved);
        }
        // Samples blur the edges between states at which an exact law may hold Newton's method up.
        let samples = Some(resolving(resolution.harmonics).max(BLURRED));
        let blurred = self.attempt(Resolution { samples, ..resolution }, omega, start)?;
        if !blurred.is_solved() {
            return Ok(solved);
        }
        let sharp = self.attempt(resolution, omega, blurred.unknowns.as_ref())?;
        Ok(if sharp.is_solved() { sharp } else { blurred })
    }

    /// The chosen method from a start, and what follows where it fails.
    pub(super) fn attempt(
        &mut self,
        resolution: Resolution,
        omega: f64,
        start: Option<&Unknowns>,
    ) -> Result<Point, Error> {
        let rough = start.map(|start| self.rough_start(resolution, omega, start)).transpose()?;
        let start = rough.as_ref().and_then(Option::as_ref).or(start);
        let table = self.table(resolution.harmonics);
        let model = self.evaluated(resolution.samples)?;
        let interrupted = self.interruption();
        let mut equations = Condensed::new(model, &table, self.settings.residual, false);
        equations.watch(&interrupted);
        if self.settings.method != Method::Newton {
            equations.densify();
        }
        let solved = self.solve_equations(&mut equations, omega, start, resolution.samples)?;
        self.add_profile(&equations.profile);
        Ok(solved)
    }

    /// Whether a homotopy leads to the solution: it does where there is one alone.
    fn follows(&self) -> bool {
        self.is_monotone()
    }

    /// Whether all laws are monotone.
    pub(crate) fn is_monotone(&self) -> bool {
        self.model.is_monotone()
    }

    /// A point that was not computed.
    pub(super) fn not_computed(&self, omega: f64) -> Point {
        let contacts = self.model.compliance().contacts();
        Point::empty(omega, PointStatus::NotComputed, self.observe.len(), contacts)
    }

    pub(crate) fn add_profile(&mut self, profile: &Profile) {
        self.profile.add(profile);
    }

    /// The chosen method from the start, then homotopy, then a status that says so.
    fn solve_equations(
        &mut self,
        equations: &mut Condensed<'_>,
        omega: f64,
        start: Option<&Unknowns>,
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
        let mut report = self.iterate(equations, &mut x);
        let patient = self.is_worth_a_homotopy(harmonics.highest());
        if has_failed(&report) && start.is_some() && patient {
            // A neighbour in another state of the contacts may mislead.
            let spent = report.iterations;
            x = equations.stuck_response().to_vec();
            report = self.iterate(equations, &mut x);
            report.iterations += spent;
        }
        let orbit = has_failed(&report) && self.start_again(equations, omega, &mut x, &mut report);
        // Where harmonics are chosen an orbit is the answer.
        let answered = orbit && self.control.only_harmonics_climb();
        // Where nothing holds the mean of many contacts, paths to the same motion take minutes.
        let lost = report.outcome == Outcome::Singular && equations.is_lost();
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
            Outcome::Stalled if equations.loose => PointStatus::Free,
            Outcome::Stalled => PointStatus::Stalled,
            Outcome::Singular => PointStatus::Singular,
        };
        let start = std::time::Instant::now();
        let mut point = equations.recover(&x, self.observe, status)?;
        point.samples = samples;
        self.profile.recovery += start.elapsed();
        // Without an observed DOF there is nothing whose error could be estimated.
        if status == PointStatus::Converged && !self.observe.is_empty() {
            let start = std::time::Instant::now();
            let estimated = self.estimate(equations, &x, &mut point)?;
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

    /// The chosen method from `x`.
    fn iterate(&mut self, equations: &mut Condensed<'_>, x: &mut [f64]) -> Report {
        let Method::Broyden(first) = self.settings.method else {
            let report = newton(equations, x, self.settings.newton);
            return if_bounded(report, x, equations);
        };
        let (report, effort) = broyden(equations, x, self.settings.newton, first);
        equations.profile.factorisations += effort.jacobians;
        self.profile.updates += effort.updates;
        self.profile.restarts += usize::from(effort.jacobians > 1);
        if_bounded(report, x, equations)
    }

    /// Newton's method from the exact orbit; whether there is one.
    fn start_again(
        &self,
        equations: &mut Condensed<'_>,
        omega: f64,
        x: &mut Vec<f64>,
        report: &mut Report,
    ) -> bool {
        let harmonics = equations.harmonics();
        let orbit = self.orbit_to_start_from(omega, harmonics.highest());
        let Some(amplitudes) = orbit.map(|orbit| orbit.contact_displacement) else { return false };
        let orders = harmonics.highest() + 1;
        let mut trial = vec![0.0; x.len()];
        let points = amplitudes.chunks_exact(orders).zip(trial.chunks_exact_mut(harmonics.slots()));
        points.for_each(|(amplitudes, series)| harmonics.write_series(amplitudes, series));
        let again = newton(equations, &mut trial, self.settings.newton);
        let again = if_bounded(again, &trial, equations);
        report.iterations += again.iterations;
        if !has_failed(&again) {
            (report.outcome, report.residual) = (again.outcome, again.residual);
            *x = trial;
        }
        true
    }

    /// Homotopy, by Newton's method, after the chosen method has failed: first in the contact
    /// stiffness, whose path is smooth even for nearly rigid contacts, then, where friction alone acts, in
    /// a loss: beside a resonance that friction hardly bounds it leads to the phase that friction cannot
    /// change. Springs without stiffness at rest have no such loss; their path is that of the load.
    fn follow_paths(&self, equations: &mut Condensed<'_>, x: &mut Vec<f64>, report: &mut Report) {
        let last = if self.is_monotone() { Path::Loss } else { Path::Load };
        for path in [Path::Stiffness, last] {
            let mut along = x.clone();
            equations.choose(path);
            let followed = homotopy(equations, &mut along, self.settings.newton);
            let followed = if_bounded(followed, &along, equations);
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
}

/// The report of a solution, unless nothing bounds the motion.
fn if_bounded(report: Report, x: &[f64], equations: &Condensed<'_>) -> Report {
    if report.outcome == Outcome::Converged && !is_bounded(x, equations.stuck_response()) {
        return Report { outcome: Outcome::Singular, ..report };
    }
    report
}

/// Whether a motion is small enough that rounding leaves the effect of the load in its digits.
pub(super) fn is_bounded(x: &[f64], stuck: &[f64]) -> bool {
    norm(x) <= UNBOUNDED * norm(stuck)
}

fn has_failed(report: &Report) -> bool {
    !matches!(report.outcome, Outcome::Converged | Outcome::Interrupted)
}
