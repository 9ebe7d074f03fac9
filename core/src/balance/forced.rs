//! The forced response at one frequency.

use super::account::{Account, Looks};
use super::condensed::Condensed;
use super::evaluation::{Evaluated, Evaluations};
use super::history::history_of;
use super::neighbour::Neighbour;
use super::resolution_control::{Level, ResolutionControl};
use super::scale::Scale;
use super::settings::{Resolution, Settings};
use super::solution::{Point, PointStatus};
use super::tangent::Tangent;
use super::unknowns::Unknowns;
use super::{ExactOrbits, Kept, Progress};
use crate::contact::PointSummary;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::System as _;
use crate::timing::Profile;
use crate::Error;
use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The harmonic balance of a model under its loads, from point to point.
pub struct ForcedBalance<'a> {
    pub(super) model: Evaluated<'a>,
    pub(super) settings: Settings,
    pub(super) observe: &'a [usize],
    half_wave: bool,
    pub(super) forced: Vec<usize>,
    tables: Tables,
    evaluations: Evaluations<'a>,
    pub(super) neighbour: Neighbour,
    pub(super) control: ResolutionControl,
    pub(super) scale: Scale,
    /// Whether errors are estimated.
    pub(super) estimated: bool,
    /// The tangent at the last point of a sweep whose branch was asked for.
    pub(super) tangent: Option<Tangent>,
    /// The work of looks between the points of a sweep.
    pub(super) looks: Looks,
    progress: &'a Progress<'a>,
    pub(super) kept: Option<&'a Kept<Point>>,
    /// What the first point of a sweep begins with, if anything is known beforehand.
    pub(super) start: Option<Unknowns>,
    pub(super) rescue: Option<&'a dyn ExactOrbits>,
    /// Whether further branches are looked for.
    pub(super) further: bool,
    share: f64,
    /// Frequencies at which nothing bounds the motion, once they are asked for [rad/s].
    pub(super) unbounded: OnceCell<Vec<f64>>,
    /// Whether static loads carry a body away, once that is asked for.
    pub(super) carried_away: OnceCell<bool>,
    pub(super) profile: Profile,
    /// Work that every point may take, if that is said …
    pub(super) granted: f64,
    /// … and the account of the one at hand.
    pub(super) account: Account,
}

/// Sample tables by harmonics.
#[derive(Default)]
struct Tables {
    /// Of solutions, by the highest one.
    fine: BTreeMap<usize, Arc<SampleTable>>,
    /// Of error estimates, by that of motions and the highest one.
    coarse: BTreeMap<[usize; 2], Arc<SampleTable>>,
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
        let known = history_of(model, &settings)?;
        Self::with_known_history(model, known, settings, observe)
    }

    /// [`ForcedBalance::new`] of a model whose friction has a history that is known.
    ///
    /// # Errors
    /// As there.
    pub(crate) fn with_known_history(
        model: &'a Model,
        known: Option<Arc<Model>>,
        settings: Settings,
        observe: &'a [usize],
    ) -> Result<Self, Error> {
        let forced = model.compliance().forced_harmonics();
        let settings = settings.suited(model);
        settings.check(&forced)?;
        settings.check_resolution(model.resolves())?;
        Error::check_dofs(observe, model.compliance().dofs())?;
        let model = known.map_or(Evaluated::Given(model), Evaluated::Made);
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
            neighbour: Neighbour::default(),
            evaluations: Evaluations::new(model.clone(), settings.evaluation.marched()),
            model,
            scale: Scale::default(),
            estimated: true,
            tangent: None,
            looks: Looks::default(),
            progress: &|_| true,
            kept: None,
            start: None,
            rescue: None,
            further: false,
            share: 0.0,
            unbounded: OnceCell::new(),
            carried_away: OnceCell::new(),
            profile: Profile::default(),
            granted: f64::INFINITY,
            account: Account::open(f64::INFINITY, &Profile::default()),
        })
    }

    /// Has `progress` called during the analysis.
    #[must_use]
    pub fn watched(mut self, progress: &'a Progress<'a>) -> Self {
        self.progress = progress;
        self
    }

    /// Leaves the errors unknown of points that something else begins with.
    #[must_use]
    pub(crate) fn unjudged(mut self) -> Self {
        self.estimated = false;
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

    /// Has a sweep begin with a motion, as that of a model beside this one.
    #[must_use]
    pub fn begun_with(mut self, start: Option<Unknowns>) -> Self {
        self.start = start;
        self
    }

    /// Has a curve over a range, whose laws are not monotone, be followed by those of its further
    /// branches that are found.
    #[must_use]
    pub fn with_further_branches(mut self) -> Self {
        self.further = true;
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
    pub(super) fn is_ended(&self) -> bool {
        !(self.progress)(self.share)
    }

    /// The same as a question for others.
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

    /// The same, and what is chosen automatically begins with no less than this.
    #[must_use]
    pub(crate) fn beginning_with(mut self, resolution: Resolution) -> Self {
        self.control.begin_with(resolution);
        self
    }

    /// What a balance of the same contacts can use again.
    pub(crate) fn into_memory(self) -> WarmStart {
        let Self { tables, control, half_wave, profile, .. } = self;
        WarmStart { tables, level: control.level, half_wave, profile }
    }

    /// The account of its work.
    pub(crate) fn into_profile(self) -> Profile {
        self.profile
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

    /// The table of an error estimate, of motions up to the harmonic `resolved`.
    pub(super) fn coarse_table(&mut self, resolved: usize, highest: usize) -> Arc<SampleTable> {
        let harmonics = || Harmonics::new(highest, self.half_wave);
        let table = || Arc::new(SampleTable::coarse_up_to(resolved, harmonics()));
        Arc::clone(self.tables.coarse.entry([resolved, highest]).or_insert_with(table))
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
        self.add_profile(&equations.profile);
        if equations.is_linear() || !self.is_monotone() {
            return Ok(equations.is_linear());
        }
        // A contact that carries a mean has a tangent, and does not slip for that.
        let mut laws = self.model.laws().iter().zip(self.model.points()).enumerate();
        Ok(laws.all(|(index, (law, points))| {
            let mut own = vec![PointSummary::default(); points.len()];
            law.summary(equations.motion(index, &x), &mut own);
            own.iter().all(|point| point.slip_fraction == 0.0)
        }))
    }

    /// Harmonics that loads act at, ascending, but for a static one.
    pub(crate) fn loaded_harmonics(&self) -> Vec<usize> {
        let forced = self.model.compliance().forced_harmonics();
        forced.into_iter().filter(|&order| order > 0).collect()
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
}
