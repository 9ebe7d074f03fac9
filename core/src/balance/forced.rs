//! The forced response at one frequency.

use super::accuracy::{errors, extended_order};
use super::condensed::{Condensed, Path};
use super::scale::{Scale, OF_HARMONICS};
use super::settings::{HarmonicChoice, Method, Settings};
use super::solution::{Point, PointStatus};
use super::unknowns::Unknowns;
use super::{FreshStart, Progress};
use crate::contact::PointSummary;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::{broyden, homotopy, newton, Outcome, Report, System as _};
use crate::timing::Profile;
use crate::Error;
use faer::c64;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Orders that automatic harmonics climb: half as many again from rung to rung.
const LADDER: [usize; 17] = [1, 3, 5, 7, 9, 13, 19, 27, 39, 57, 83, 121, 177, 261, 387, 575, 857];
/// Below this order the friction force has no shape that an estimate could start from.
const LOWEST_ORDER: usize = 3;
/// First rung: enough for a smooth slip cycle.
const FIRST_RUNG: usize = 3;
/// An estimate this far below the tolerance lets the next point try one rung less.
const GENEROUS: f64 = 0.05;

/// The harmonic balance of a model under its loads, from point to point.
pub struct ForcedBalance<'a> {
    pub(super) model: &'a Model,
    pub(super) settings: Settings,
    pub(super) observe: &'a [usize],
    half_wave: bool,
    forced: Vec<usize>,
    tables: BTreeMap<usize, Arc<SampleTable>>,
    rung: usize,
    pub(super) scale: Scale,
    progress: &'a Progress<'a>,
    rescue: &'a FreshStart<'a>,
    share: f64,
    pub(super) profile: Profile,
}

/// What passes from one balance to the next: sample tables, the order that automatic harmonics
/// start from, and the account of the work.
#[derive(Default)]
pub(crate) struct Memory {
    tables: BTreeMap<usize, Arc<SampleTable>>,
    rung: usize,
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
        settings.check(&forced)?;
        settings.check_resolution(model.resolves())?;
        let known = model.compliance().dofs();
        if let Some(&dof) = observe.iter().find(|&&dof| dof >= known) {
            let remedy = format!("the structure has {known} DOFs");
            return Err(Error::value("observe", dof as f64, &remedy));
        }
        let half_wave = model.is_symmetric() && settings.residual.is_symmetric();
        if !half_wave {
            let mut receptance = crate::structure::Receptance::default();
            model.compliance().receptance(0, 0.0, &mut receptance)?;
        }
        Ok(Self {
            model,
            settings,
            observe,
            half_wave,
            forced,
            tables: BTreeMap::new(),
            rung: FIRST_RUNG,
            scale: Scale::default(),
            progress: &|_| true,
            rescue: &|_, _| None,
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

    /// Has `rescue` asked for a start where Newton's method fails, before any homotopy.
    #[must_use]
    pub fn rescued(mut self, rescue: &'a FreshStart<'a>) -> Self {
        self.rescue = rescue;
        self
    }

    /// Reports the share of the work done; `false` if the analysis is to end.
    pub(crate) fn report(&mut self, share: f64) -> bool {
        self.share = share;
        (self.progress)(share)
    }

    /// Takes over what another balance of the same contacts has learnt.
    #[must_use]
    pub(crate) fn remembering(mut self, memory: Memory) -> Self {
        let Memory { tables, rung, half_wave, profile } = memory;
        if half_wave == self.half_wave {
            (self.tables, self.rung) = (tables, rung);
        }
        self.profile = profile;
        self
    }

    /// What a balance of the same contacts can use again.
    pub(crate) fn into_memory(self) -> Memory {
        let Self { tables, rung, half_wave, profile, .. } = self;
        Memory { tables, rung, half_wave, profile }
    }

    /// Whether only odd harmonics are solved for.
    #[must_use]
    pub fn half_wave(&self) -> bool {
        self.half_wave
    }

    pub(crate) fn table(&mut self, highest: usize) -> Arc<SampleTable> {
        let half_wave = self.half_wave;
        let table = self
            .tables
            .entry(highest)
            .or_insert_with(|| Arc::new(SampleTable::new(Harmonics::new(highest, half_wave))));
        Arc::clone(table)
    }

    /// Solves at one frequency [rad/s] from a start, or from the stuck response.
    ///
    /// # Errors
    /// The loads themselves excite an undamped resonance.
    pub fn solve(&mut self, omega: f64, start: Option<&Unknowns>) -> Result<Point, Error> {
        match self.settings.harmonics {
            HarmonicChoice::Fixed(highest) => self.solve_with(highest, omega, start),
            HarmonicChoice::Auto => self.solve_automatically(omega, start),
        }
    }

    /// Climbs the ladder of orders until the discarded harmonics matter less than the tolerance.
    fn solve_automatically(
        &mut self,
        omega: f64,
        start: Option<&Unknowns>,
    ) -> Result<Point, Error> {
        let limit = self.settings.max_harmonics;
        let lowest = self.forced.last().copied().unwrap_or(1).max(1);
        let rungs: Vec<usize> =
            LADDER.iter().copied().filter(|&h| h >= lowest && h < limit).chain([limit]).collect();
        let lowest_rung = rungs.iter().position(|&h| h >= LOWEST_ORDER).unwrap_or(0);
        let mut rung = self.rung.min(rungs.len() - 1);
        let mut stalled = false;
        let mut start = start.cloned();
        let mut iterations = 0;
        loop {
            let mut point = self.solve_with(rungs[rung], omega, start.as_ref())?;
            iterations += point.iterations;
            point.iterations = iterations;
            match point.status {
                PointStatus::Converged => {
                    self.scale.include(&point);
                    let error = self.scale.relative(
                        &point,
                        OF_HARMONICS,
                        point.error_estimate.iter().copied(),
                    );
                    if error <= self.settings.tolerance {
                        let generous = error <= GENEROUS * self.settings.tolerance;
                        self.rung = (rung - usize::from(generous && rung > 0)).max(lowest_rung);
                        return Ok(point);
                    }
                    if rung + 1 == rungs.len() {
                        self.rung = rung;
                        point.status = PointStatus::HarmonicsLimit;
                        return Ok(point);
                    }
                    start = point.unknowns;
                }
                // One more rung may be what a stalled point lacks.
                PointStatus::Stalled if !stalled && rung + 1 < rungs.len() => stalled = true,
                // More harmonics cure no singular equations.
                _ => return Ok(point),
            }
            rung += 1;
        }
    }

    fn solve_with(
        &mut self,
        highest: usize,
        omega: f64,
        start: Option<&Unknowns>,
    ) -> Result<Point, Error> {
        let table = self.table(highest);
        let (progress, share) = (self.progress, self.share);
        let interrupted = || !progress(share);
        let mut equations = Condensed::new(self.model, &table, self.settings.residual, false);
        equations.watch(&interrupted);
        if self.settings.method != Method::Newton {
            equations.densify();
        }
        let solved = self.solve_equations(&mut equations, omega, start)?;
        self.add_profile(&equations.profile);
        Ok(solved)
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
        if has_failed(&report) && start.is_some() {
            // A neighbour in another state of the contacts may mislead.
            let spent = report.iterations;
            x = equations.stuck_response().to_vec();
            report = self.iterate(equations, &mut x);
            report.iterations += spent;
        }
        if has_failed(&report) {
            self.start_again(equations, omega, &mut x, &mut report);
        }
        if has_failed(&report) {
            self.profile.homotopies += 1;
            self.follow_paths(equations, &mut x, &mut report);
        }
        let status = match report.outcome {
            Outcome::Interrupted => {
                let (status, observed) = (PointStatus::NotComputed, self.observe.len());
                return Ok(Point::empty(omega, status, observed, contacts));
            }
            Outcome::Converged => PointStatus::Converged,
            Outcome::Stalled => PointStatus::Stalled,
            Outcome::Singular => PointStatus::Singular,
        };
        let start = std::time::Instant::now();
        let mut point = self.recover(equations, omega, &x, status)?;
        self.profile.recovery += start.elapsed();
        point.residual = report.residual;
        point.iterations = report.iterations;
        point.unknowns = Some(Unknowns { harmonics: harmonics.clone(), values: x });
        Ok(point)
    }

    /// The chosen method from `x`.
    fn iterate(&mut self, equations: &mut Condensed<'_>, x: &mut [f64]) -> Report {
        let Method::Broyden(first) = self.settings.method else {
            return newton(equations, x, self.settings.newton);
        };
        let (report, effort) = broyden(equations, x, self.settings.newton, first);
        equations.profile.factorisations += effort.jacobians;
        self.profile.updates += effort.updates;
        self.profile.restarts += usize::from(effort.jacobians > 1);
        report
    }

    /// Newton's method from the start that the rescue offers, if it offers one.
    fn start_again(
        &self,
        equations: &mut Condensed<'_>,
        omega: f64,
        x: &mut Vec<f64>,
        report: &mut Report,
    ) {
        let harmonics = equations.harmonics();
        let Some(amplitudes) = (self.rescue)(omega, harmonics.highest()) else { return };
        let orders = harmonics.highest() + 1;
        let mut trial = vec![0.0; x.len()];
        let points = amplitudes.chunks_exact(orders).zip(trial.chunks_exact_mut(harmonics.slots()));
        points.for_each(|(amplitudes, series)| harmonics.write_series(amplitudes, series));
        let again = newton(equations, &mut trial, self.settings.newton);
        report.iterations += again.iterations;
        if !has_failed(&again) {
            (report.outcome, report.residual) = (again.outcome, again.residual);
            *x = trial;
        }
    }

    /// Homotopy, by Newton's method, after the chosen method has failed: first in the contact stiffness, whose path is
    /// smooth even for nearly rigid contacts, then in the load.
    fn follow_paths(&self, equations: &mut Condensed<'_>, x: &mut Vec<f64>, report: &mut Report) {
        for path in [Path::Stiffness, Path::Load] {
            let mut along = x.clone();
            equations.choose(path);
            let followed = homotopy(equations, &mut along, self.settings.newton);
            report.iterations += followed.iterations;
            if !has_failed(&followed) {
                (report.outcome, report.residual) = (followed.outcome, followed.residual);
                *x = along;
                break;
            }
        }
        // The recovery reads slip loads and tangents at the point that is returned.
        let mut residual = vec![0.0; equations.size()];
        equations.residual(x, &mut residual);
    }

    /// Displacements, contact forces, slip shares and the error estimate of a solution.
    fn recover(
        &mut self,
        equations: &Condensed<'_>,
        omega: f64,
        x: &[f64],
        status: PointStatus,
    ) -> Result<Point, Error> {
        let harmonics = equations.harmonics();
        let contacts = self.model.compliance().contacts();
        let orders = harmonics.highest() + 1;
        let mut point = Point::empty(omega, status, self.observe.len(), contacts);
        point.harmonics = harmonics.highest();
        let zero = c64::new(0.0, 0.0);
        point.displacement = vec![zero; self.observe.len() * orders];
        point.contact_displacement = vec![zero; contacts * orders];
        point.contact_force = vec![zero; contacts * orders];
        let slip_load = equations.slip_load();
        let stiffness = self.model.contact_stiffness();
        equations.displacements(x, &slip_load, self.observe, |order, observed, u, q| {
            for (i, value) in observed.iter().enumerate() {
                point.displacement[i * orders + order] = *value;
            }
            // A contact's stiffness couples its own points alone.
            let points = self.model.points().iter().flat_map(|p| p.clone().map(move |i| (i, p)));
            for (i, own) in points {
                let stuck: c64 = own.clone().map(|j| u[j] * stiffness[(i, j)]).sum();
                point.contact_displacement[i * orders + order] = u[i];
                point.contact_force[i * orders + order] = stuck - q[i];
            }
        })?;
        let mut summaries = vec![PointSummary::default(); contacts];
        for (index, law) in self.model.laws().iter().enumerate() {
            let range = self.model.points()[index].clone();
            law.summary(equations.motion(index, x), &mut summaries[range]);
        }
        point.contacts = summaries;
        // Without an observed DOF there is nothing whose error could be estimated.
        if status == PointStatus::Converged && !self.observe.is_empty() {
            self.estimate(harmonics, x, Some(equations), &mut point)?;
        }
        Ok(point)
    }

    /// Writes the error estimate of a solution `x`, of these equations if they are at hand.
    pub(super) fn estimate(
        &mut self,
        harmonics: &Harmonics,
        x: &[f64],
        solved: Option<&Condensed<'_>>,
        point: &mut Point,
    ) -> Result<(), Error> {
        point.error_estimate = vec![0.0; self.observe.len()];
        let slipping = point.contacts.iter().filter(|c| c.slip_fraction > 0.0).count();
        if slipping == 0 {
            return Ok(());
        }
        let order = extended_order(harmonics, point.omega, self.model, slipping);
        let table = self.table(order);
        let solution = Unknowns { harmonics: harmonics.clone(), values: x.to_vec() };
        let residual = self.settings.residual;
        point.error_estimate =
            errors(self.model, &table, residual, &solution, self.observe, point, solved)?;
        Ok(())
    }
}

fn has_failed(report: &Report) -> bool {
    !matches!(report.outcome, Outcome::Converged | Outcome::Interrupted)
}
