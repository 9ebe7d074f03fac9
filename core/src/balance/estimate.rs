//! How wrong a solution of the condensed equations is.

use super::accuracy::{estimate, Estimate};
use super::condensed::Condensed;
use super::effort::Effort;
use super::evaluation::Evaluated;
use super::extension::Extension;
use super::forced::ForcedBalance;
use super::resonances::{self, Resonances};
use super::sampling::{finer_than, sampling_errors};
use super::scale::OF_HARMONICS;
use super::settings::{resolving_discarded, Method};
use super::smooth_piece::IN_A_ROW;
use super::solution::Point;
use super::unknowns::Unknowns;
use crate::fourier::Harmonics;
use crate::model::Model;
use crate::solve::{norm, System as _};
use crate::Error;

/// Rounding of a series of forces, relative to them.
const ROUNDING: f64 = 1e-12;

impl<'a> ForcedBalance<'a> {
    /// Number of points that slip, with those beside them that their law couples to them; a law that may
    /// depart from a spring without slip counts as one.
    pub(super) fn nonlinear_points(&self, point: &Point) -> usize {
        let laws = self.model.laws().iter().zip(self.model.points());
        let counted = laws.map(|(law, points)| {
            let own = &point.contacts[points.clone()];
            let slip = own.iter().filter(|one| one.slip_fraction > 0.0).count();
            match (slip, law.is_monotone()) {
                (slip, true) => slip,
                (0, false) => 1,
                (_, false) => own.len(),
            }
        });
        counted.sum()
    }

    /// What the solution of a point and its estimate cost.
    pub(super) fn effort<'m>(
        &self,
        model: &'m Model,
        harmonics: &Harmonics,
        point: &Point,
    ) -> Effort<'m> {
        let slipping = self.nonlinear_points(point);
        Effort::new(model, harmonics.half_wave(), slipping, self.observe.len()).of(point)
    }

    /// Writes the error estimate of a solution `x` of these equations; `false` if the analysis is to
    /// end. What lacks samples in any case needs no more than the error that says so, unless it is to be `whole`.
    pub(super) fn estimate(
        &mut self,
        equations: &mut Condensed<'_>,
        x: &[f64],
        point: &mut Point,
        whole: bool,
    ) -> Result<bool, Error> {
        let sampling = self.sampling_errors(equations, x, point)?;
        if !whole && self.lacks_samples(point, &sampling) {
            (point.error_estimate, point.sampling_error) = (sampling.clone(), sampling);
            point.partial = true;
            return Ok(true);
        }
        let most = if whole { Vec::new() } else { self.enough_for_more(point) };
        let solved = Some(&*equations);
        let done = self.estimate_truncation(equations.harmonics(), x, solved, point, &most)?;
        add_sampling(point, sampling);
        Ok(done)
    }

    /// Completes the estimate of a point that lacked harmonics or samples, but is the last one all the same.
    pub(super) fn complete_estimate(&mut self, point: &mut Point) -> Result<(), Error> {
        let solution = point.unknowns.as_ref().filter(|_| point.partial && point.is_solved());
        let Some(solution) = solution.cloned() else { return Ok(()) };
        let sampling = std::mem::take(&mut point.sampling_error);
        self.estimate_truncation(&solution.harmonics, &solution.values, None, point, &[])?;
        add_sampling(point, sampling);
        Ok(())
    }

    /// What a march through more samples would change in a solution; empty of laws that are evaluated as they
    /// are.
    fn sampling_errors(
        &mut self,
        equations: &mut Condensed<'_>,
        x: &[f64],
        point: &Point,
    ) -> Result<Vec<f64>, Error> {
        let Some(samples) = point.samples else { return Ok(Vec::new()) };
        if self.settings.method != Method::Newton {
            // Broyden's method leaves no tangent at the solution.
            equations.residual(x, &mut vec![0.0; x.len()]);
        }
        let finer = self.evaluated(Some(finer_than(samples)))?;
        sampling_errors(equations, &finer, x, self.observe, point)
    }

    /// Writes what the discarded harmonics could change in a solution `x`, of these equations if
    /// they are at hand, or no more than that they change one DOF by more than the `most` that is given; `false` if the
    /// analysis is to end.
    pub(super) fn estimate_truncation(
        &mut self,
        harmonics: &Harmonics,
        x: &[f64],
        solved: Option<&Condensed<'_>>,
        point: &mut Point,
        most: &[f64],
    ) -> Result<bool, Error> {
        point.partial = false;
        point.error_estimate = vec![0.0; self.observe.len()];
        point.sampling_error = vec![0.0; self.observe.len()];
        let given = self.evaluated(None)?;
        let effort = self.effort(&given, harmonics, point);
        // Points of a curve whose frequency is unknown take more than their steps.
        let counts = !self.control.samples_climb() && solved.is_none_or(|solved| !solved.slopes);
        let earned = counts.then(|| effort.earned(harmonics.highest()));
        if effort.slipping == 0 || solved.is_some_and(|solved| leaves_springs(solved, x)) {
            self.neighbour.save(point, earned);
            return Ok(true);
        }
        let credit = self.neighbour.credit(point, earned);
        let whole = Extension::new(&effort, harmonics, point.omega, credit).up_to(most);
        let solution = Unknowns { harmonics: harmonics.clone(), values: x.to_vec() };
        let Some(mut errors) = self.errors(&solution, solved, point, (&effort, whole))? else {
            return Ok(false);
        };
        if point.partial {
            point.error_estimate = errors;
            return Ok(true);
        }
        let meets =
            Resonances::beyond(whole.highest, whole.single, &effort, harmonics, point.omega);
        self.neighbour.pay(meets.effort);
        self.profile.work += meets.effort;
        for order in meets.orders {
            let (model, resolved) = self.resolving(point, order)?;
            if resolved < order {
                break;
            }
            let residual = self.settings.residual;
            let table = self.coarse_table(harmonics.highest(), order);
            let observe = self.observe;
            let more = resonances::answer(&model, &table, residual, &solution, observe, point);
            errors.iter_mut().zip(more).for_each(|(error, more)| *error += more);
        }
        point.error_estimate = errors;
        Ok(true)
    }

    /// What the harmonics of an extended balance would change in a solution, as it goes on along a curve or anew;
    /// nothing if the analysis is to end.
    fn errors(
        &mut self,
        solution: &Unknowns,
        solved: Option<&Condensed<'_>>,
        point: &mut Point,
        (effort, whole): (&Effort<'_>, Extension<'_>),
    ) -> Result<Option<Vec<f64>>, Error> {
        if !self.control.samples_climb() {
            let found = self.continued(solution, point, (effort, &whole));
            if found.is_some() {
                return Ok(found);
            }
        }
        let follows = whole.has_two();
        let growth = if follows { self.neighbour.served(point) } else { None };
        let extension = if growth.is_some() { whole.beside() } else { whole };
        let Some(estimate) = self.extended(solution, solved, point, (effort, extension))? else {
            return Ok(None);
        };
        self.neighbour.pay(extension.account.of(estimate.took_two));
        let Estimate { mut errors, first, keeps_states, ended_in_state, partial, .. } = estimate;
        point.partial = partial;
        if let Some(growth) = growth.filter(|_| ended_in_state) {
            errors.iter_mut().zip(growth).for_each(|(error, by)| *error *= by);
            if !self.may_lean(point, &errors) {
                self.neighbour.forget();
                return self.errors(solution, solved, point, (effort, whole));
            }
        } else {
            let told = follows && keeps_states && !partial;
            self.neighbour.learn(point, &errors, told.then_some(&first[..]));
        }
        if self.control.is_fixed() {
            self.neighbour.raise(point, extension.highest, &mut errors);
        }
        self.neighbour.note(point, solution.clone(), &errors);
        Ok(Some(errors))
    }

    /// What the discarded harmonics would change in a solution by how that has gone on along the curve; nothing if it
    /// does not say.
    fn continued(
        &mut self,
        solution: &Unknowns,
        point: &Point,
        (effort, whole): (&Effort<'_>, &Extension<'_>),
    ) -> Option<Vec<f64>> {
        let harmonics = &solution.harmonics;
        let (discarded, of) = (whole.discarded(harmonics), self.model.compliance());
        // As many points go on as solutions cost what an estimate does; all that may of a ring.
        let time = whole.account.of(false);
        let cost = time / effort.closely(harmonics.highest());
        let ring = of.ring().is_some();
        let in_a_row = if ring { IN_A_ROW } else { cost.ceil().max(1.0) as usize };
        let (piece, own) = (&mut self.neighbour.piece, (in_a_row, time));
        let found = piece.continued(point, solution, of, discarded, own)?;
        self.may_lean(point, &found).then_some(found)
    }

    /// Whether an estimate may lean on those beside it: one that asks for more harmonics is made by itself.
    fn may_lean(&self, point: &Point, errors: &[f64]) -> bool {
        let relative = || self.scale.relative(point, OF_HARMONICS, errors.iter().copied());
        !self.control.harmonics_climb() || relative() <= self.settings.tolerance
    }

    /// How wrong a solution is at its contacts: the largest change that the discarded harmonics would bring to
    /// the motion of one, relative to its vibration. Nothing without an answer.
    pub(crate) fn contact_error(&mut self, point: &Point) -> Option<f64> {
        let solution = point.unknowns.clone()?;
        let given = self.evaluated(None).ok()?;
        let harmonics = &solution.harmonics;
        let effort = self.effort(&given, harmonics, point);
        if effort.slipping == 0 {
            return Some(0.0);
        }
        let extension = Extension::new(&effort, harmonics, point.omega, f64::INFINITY);
        let mut point = point.clone();
        let found = self.extended(&solution, None, &mut point, (&effort, extension)).ok()??;
        Some(found.contacts)
    }

    /// What an extended balance says of a solution, one of fewer harmonics if the products that it may take do
    /// not lead to a step; nothing, and no estimate of the point, if the analysis is to end.
    fn extended(
        &mut self,
        solution: &Unknowns,
        solved: Option<&Condensed<'_>>,
        point: &mut Point,
        (effort, extension): (&Effort<'_>, Extension<'_>),
    ) -> Result<Option<Estimate>, Error> {
        let found = self.extended_to(solution, solved, point, extension)?;
        if extension.products.is_none() || !found.as_ref().is_some_and(Estimate::is_lost) {
            return Ok(found);
        }
        self.neighbour.pay(extension.account.of(false));
        let (kept, omega) = (&solution.harmonics, point.omega);
        let formed = Extension::new(&effort.formed(), kept, omega, f64::INFINITY);
        self.extended_to(solution, solved, point, formed)
    }

    /// What an extended balance says of a solution.
    fn extended_to(
        &mut self,
        solution: &Unknowns,
        solved: Option<&Condensed<'_>>,
        point: &mut Point,
        extension: Extension<'_>,
    ) -> Result<Option<Estimate>, Error> {
        let (model, order) = self.resolving(point, extension.highest)?;
        let extension = extension.within(order);
        let table = self.coarse_table(order, order);
        let residual = self.settings.residual;
        let ask = self.interruption();
        let observe = self.observe;
        let profile = &mut self.profile;
        let found = estimate(
            &model, &table, residual, solution, observe, point, solved, &extension, &ask, profile,
        )?;
        let Some(mut found) = found else {
            point.error_estimate = vec![f64::NAN; observe.len()];
            return Ok(None);
        };
        let unseen = self.unseen_of_massless(&solution.harmonics, &extension);
        let all = found.errors.iter_mut().chain(&mut found.first).chain([&mut found.contacts]);
        all.for_each(|error| *error *= unseen);
        Ok(Some(found))
    }

    /// The model as it is evaluated for what a point discards up to an order, or as high as it resolves. Few samples, as
    /// long as nobody insists on them, must not hide harmonics.
    fn resolving(&mut self, point: &Point, order: usize) -> Result<(Evaluated<'a>, usize), Error> {
        if self.control.samples_climb() {
            let samples = point.samples.map(|samples| samples.max(resolving_discarded(order)));
            return Ok((self.evaluated(samples)?, order));
        }
        let model = self.evaluated(point.samples)?;
        let resolved = order.min(model.resolves());
        Ok((model, resolved))
    }

    /// What the changes by an extended balance count. DOFs without mass move with kinks: harmonics fall with the
    /// square of their order, and the error with the first power of H, so that it has a known share of it.
    pub(super) fn unseen_of_massless(&self, kept: &Harmonics, extension: &Extension<'_>) -> f64 {
        if self.model.structure().massless().is_empty() {
            return 1.0;
        }
        let order = extension.highest;
        order as f64 / (order - kept.highest()) as f64
    }
}

/// Whether the contact forces of a solution are those of springs but for a constant: there are no harmonics to
/// discard.
fn leaves_springs(solved: &Condensed<'_>, x: &[f64]) -> bool {
    let (slots, offset) = (solved.harmonics().slots(), solved.harmonics().offset());
    let stiffness = solved.model.contact_stiffness();
    let slip_load = solved.slip_load();
    let mut points = slip_load.chunks_exact(slots).zip(x.chunks_exact(slots)).enumerate();
    points.all(|(i, (q, u))| norm(&q[offset..]) <= ROUNDING * stiffness[(i, i)] * norm(u))
}

/// Adds the sampling error to an estimate.
fn add_sampling(point: &mut Point, sampling: Vec<f64>) {
    if sampling.is_empty() {
        return;
    }
    point.error_estimate.iter_mut().zip(&sampling).for_each(|(error, own)| *error += own);
    point.sampling_error = sampling;
}
