//! Bounds of a response over the residual tractions that Coulomb allows.
//!
//! The positions of the sliders that a motion never moves are varied: every position from which the
//! contact goes on without slip is admissible, and from any other one the motion pushes it to such a
//! one (see [`crate::contact::Residual`]). Amplitudes are made largest and least over them, by steps
//! along the exact gradient of the balance (quasi-Newton, Broyden 1970; Nocedal and Wright 2006,
//! chapter 6), which the law itself projects to what is admissible. What was extreme at one frequency
//! is followed to the next, forwards and then backwards; at every other point all corners are tried.
//! Where laws are not monotone, other vibrations may exist beside that of the curve: they are looked
//! for from starts far from it.
//!
//! What is found is attained, so that these are *inner* bounds: others could lie outside. Where all
//! laws are monotone operators and the structure is damped there is one vibration alone, and the two
//! coincide: that is proved (`docs/theory.md`, one solution).

use super::ascent::{climb, Ascent};
use crate::balance::{with_history, AmplitudeBounds, Evaluated, Point, Progress, Settings};
use crate::balance::{HeldMotion, SliderBalance, Solution, Uniqueness};
use crate::contact::Residual;
use crate::design::held_pool::{HeldPool, NO_WIDTH};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::timing::Profile;
use crate::Error;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Points after which all corners are tried again.
const SURVEY: usize = 2;

/// Distance, relative to the frequency, after which motions far from the curve's are looked for again.
const APART: f64 = 0.04;

/// Evaluations and factorisations over those of the curve that the points may take in turn, and all
/// of them with the way back.
const EFFORT: [f64; 2] = [4.3, 4.9];

/// Points of a curve from which on its effort is a measure: of fewer a search of one point is not paid.
const SHARING: usize = 6;

const UNLIMITED: [usize; 2] = [usize::MAX; 2];

/// What is tried at a point beside what its neighbour has found.
#[derive(Debug, Clone, Copy)]
pub(super) struct Survey {
    /// All corners of the sliders.
    pub(super) corners: bool,
    /// Motions far from that of the curve.
    pub(super) starts: bool,
}

/// What is known at a point.
#[derive(Default)]
pub(super) struct Found {
    /// The motion of the curve.
    pub(super) nominal: Option<HeldMotion>,
    /// The motions that are extreme in some DOF, largest and least.
    pub(super) extremes: Vec<HeldMotion>,
    ascents: Vec<Ascent>,
    /// Whether the search had to end before it was through.
    pub(super) cut: bool,
}

/// Bounds of all points of a curve.
pub(super) struct Search<'a> {
    model: Evaluated<'a>,
    settings: Settings,
    observe: &'a [usize],
    /// What the points of the curve resolve.
    tables: &'a BTreeMap<usize, SampleTable>,
    marched: BTreeMap<usize, Arc<Model>>,
    /// The ranges of all sliders that have been held, as of late.
    ranges: BTreeMap<usize, [f64; 2]>,
    /// Points at which motions far from the curve's have been looked for.
    surveys: usize,
    /// Evaluations and factorisations, after either of which nothing more is tried.
    affordable: [usize; 2],
    pub(super) profile: Profile,
}

/// Adds to the points of a curve the bounds of their amplitudes over all residual tractions. `proved`
/// tells that theory leaves one vibration alone; `settings` are those of the curve.
///
/// # Errors
/// As for the curve; a mean displacement that rigid-body motion leaves undefined.
pub fn bound(
    model: &Model,
    settings: Settings,
    observe: &[usize],
    proved: bool,
    solution: &mut Solution,
    progress: &Progress<'_>,
) -> Result<(), Error> {
    if proved {
        for point in solution.points.iter_mut().filter(|point| point.is_solved()) {
            let amplitude = point.half_ranges();
            Arc::make_mut(point).bounds = Some(AmplitudeBounds::unique(amplitude, true));
        }
        return Ok(());
    }
    let start = std::time::Instant::now();
    let tables = tables_of(solution);
    let mut search = Search::new(model, settings, observe, solution, &tables)?;
    let found = search.along(solution, Some(&solution.profile), progress)?;
    for (point, found) in solution.points.iter_mut().zip(&found) {
        if let Some(bounds) = found.bounds() {
            Arc::make_mut(point).bounds = Some(bounds);
        }
    }
    solution.profile.add(&search.profile);
    solution.profile.total += start.elapsed();
    solution.interrupted |= !progress(1.0);
    Ok(())
}

/// What the points of a curve resolve.
pub(super) fn tables_of(solution: &Solution) -> BTreeMap<usize, SampleTable> {
    let solved = solution.points.iter().filter(|point| point.is_solved());
    let table = |highest| SampleTable::new(Harmonics::new(highest, false));
    solved.map(|point| (point.harmonics, table(point.harmonics))).collect()
}

impl<'a> Search<'a> {
    /// The search along a curve of a model.
    pub(super) fn new(
        model: &'a Model,
        settings: Settings,
        observe: &'a [usize],
        solution: &Solution,
        tables: &'a BTreeMap<usize, SampleTable>,
    ) -> Result<Self, Error> {
        let made = match settings.residual {
            Residual::FromRest => with_history(model)?,
            Residual::Centred | Residual::Value(_) => None,
        };
        let model = made.map_or(Evaluated::Given(model), |made| Evaluated::Made(Arc::new(made)));
        model.compliance().require_grounded()?;
        let samples: BTreeSet<usize> =
            solution.points.iter().filter_map(|point| point.samples).collect();
        let laws = settings.evaluation.marched();
        let marched = samples.into_iter().map(|n| Ok((n, Arc::new(model.marched(n, laws)?))));
        let marched = marched.collect::<Result<_, Error>>()?;
        let (ranges, profile) = (BTreeMap::new(), Profile::default());
        Ok(Self {
            model,
            settings,
            observe,
            tables,
            marched,
            ranges,
            surveys: 0,
            affordable: UNLIMITED,
            profile,
        })
    }

    /// Goes along the curve and back; what was found, as far as nobody has ended it. `plain` tells
    /// what the curve has taken, unless that is no measure.
    pub(super) fn along(
        &mut self,
        solution: &Solution,
        plain: Option<&Profile>,
        progress: &Progress<'_>,
    ) -> Result<Vec<Found>, Error> {
        let count = solution.points.len();
        let effort = |share: f64| match plain.filter(|_| count >= SHARING) {
            Some(plain) => [plain.evaluations, plain.factorisations]
                .map(|count| (share * count as f64) as usize),
            None => UNLIMITED,
        };
        let [forwards, whole] = EFFORT;
        let mut found: Vec<Found> = Vec::with_capacity(count);
        let mut last = f64::NEG_INFINITY;
        for (n, point) in solution.points.iter().enumerate() {
            if !progress(n as f64 / count as f64) {
                break;
            }
            let corners = n % SURVEY == 0 || n + 1 == count;
            let starts = (point.omega - last).abs() >= APART * point.omega;
            last = if starts { point.omega } else { last };
            self.affordable = effort(forwards * (n + 1) as f64 / count as f64);
            let next = self.point(point, found.last(), Survey { corners, starts })?;
            found.push(next);
        }
        self.affordable = effort(whole);
        for n in (0..found.len().saturating_sub(1)).rev() {
            if !progress(1.0) {
                found[..=n].iter_mut().for_each(|one| one.cut = true);
                break;
            }
            let (before, after) = found.split_at_mut(n + 1);
            let next = &solution.points[n + 1];
            let jump = next.jump || next.further;
            self.again(&solution.points[n], &mut before[n], &after[0], jump)?;
        }
        self.affordable = UNLIMITED;
        Ok(found)
    }

    /// Searches at a point, from the extremes of the one before.
    pub(super) fn point(
        &mut self,
        point: &Point,
        before: Option<&Found>,
        survey: Survey,
    ) -> Result<Found, Error> {
        let Some(mut pool) = self.open(point)? else { return Ok(Found::default()) };
        let Some(nominal) = pool.balance.of_point(point, self.settings.residual) else {
            return Ok(Found::default());
        };
        pool.motions.push(nominal);
        if let Some((before, from)) = before.and_then(|one| Some((one, one.nominal.as_ref()?))) {
            pool.continue_from(from, before.extremes.iter());
        }
        if survey.starts {
            pool.try_starts(self.surveys);
            self.surveys += 1;
        }
        self.learn(&pool.motions);
        let known: Vec<(usize, [f64; 2])> = self.ranges.iter().map(|(n, r)| (*n, *r)).collect();
        let held = |found: &Found| found.nominal.as_ref().map(|motion| motion.held().count());
        let lost = pool.motions[0].held().count() < known.len();
        let changed = before.and_then(held) != Some(pool.motions[0].held().count());
        if survey.corners || changed {
            pool.try_corners(&known, lost);
            self.learn(&pool.motions);
        }
        let ascents = climb(&mut pool, before.map_or(&[], |before| &before.ascents));
        let found = Found::of(&pool, ascents);
        self.profile.add(pool.balance.profile());
        Ok(found)
    }

    /// Takes up where sliders may be.
    fn learn(&mut self, motions: &[HeldMotion]) {
        motions.iter().for_each(|motion| self.ranges.extend(motion.held()));
    }

    /// Tries at a point what is extreme at the next one and not here, and the curve's motion there if
    /// the curve comes to it from another one.
    fn again(
        &mut self,
        point: &Point,
        found: &mut Found,
        after: &Found,
        jump: bool,
    ) -> Result<(), Error> {
        let strange = |motion: &HeldMotion| !found.extremes.iter().any(|own| is_like(own, motion));
        let (Some(nominal), Some(from)) = (&found.nominal, &after.nominal) else { return Ok(()) };
        let other = jump || !is_like(nominal, from);
        let mut others = after.extremes.iter().filter(|motion| strange(motion)).peekable();
        if !other && others.peek().is_none() {
            return Ok(());
        }
        let Some(mut pool) = self.open(point)? else { return Ok(()) };
        pool.motions.push(nominal.clone());
        pool.motions.extend(found.extremes.iter().cloned());
        let known = pool.bounds();
        if other {
            pool.look_from(from);
        }
        pool.continue_from(from, others);
        let cut = found.cut;
        if pool.is_beyond(&known) {
            let ascents = climb(&mut pool, &found.ascents);
            *found = Found::of(&pool, ascents);
        }
        found.cut = cut || pool.balance.cut;
        self.profile.add(pool.balance.profile());
        Ok(())
    }

    /// The balance at a point in the positions of its sliders, at the resolution of the point.
    pub(super) fn open(&self, point: &Point) -> Result<Option<HeldPool<'a>>, Error> {
        let Some(table) = self.tables.get(&point.harmonics).filter(|_| point.is_solved()) else {
            return Ok(None);
        };
        let marched = point.samples.and_then(|samples| self.marched.get(&samples));
        let model = marched.map_or_else(|| self.model.clone(), |m| Evaluated::Made(Arc::clone(m)));
        let newton = self.settings.newton;
        let [evaluations, factorisations] = self.affordable;
        let left = [
            evaluations.saturating_sub(self.profile.evaluations),
            factorisations.saturating_sub(self.profile.factorisations),
        ];
        let balance = SliderBalance::new(model, table, point.omega, newton, self.observe, left)?;
        Ok(Some(HeldPool { balance, motions: Vec::new() }))
    }
}

impl Found {
    fn of(pool: &HeldPool<'_>, ascents: Vec<Ascent>) -> Self {
        let (nominal, cut) = (pool.motions.first().cloned(), pool.balance.cut);
        Self { nominal, extremes: pool.extremes(), ascents, cut }
    }

    pub(super) fn bounds(&self) -> Option<AmplitudeBounds> {
        let nominal = self.nominal.as_ref()?;
        let others = self.extremes.iter().map(|motion| motion.amplitude.as_slice());
        Some(between(&nominal.amplitude, nominal.pushed, others).by_search(self.cut))
    }
}

/// The bounds of some amplitudes; `pushed` is that of the first motion.
pub(super) fn between<'a>(
    nominal: &[f64],
    pushed: bool,
    others: impl Iterator<Item = &'a [f64]>,
) -> AmplitudeBounds {
    let (mut lower, mut upper) = (nominal.to_vec(), nominal.to_vec());
    for amplitude in others {
        lower.iter_mut().zip(amplitude).for_each(|(l, a)| *l = l.min(*a));
        upper.iter_mut().zip(amplitude).for_each(|(u, a)| *u = u.max(*a));
    }
    let same = |(l, u): (&f64, &f64)| u - l <= NO_WIDTH * u;
    if lower.iter().zip(&upper).all(same) {
        return AmplitudeBounds::unique(nominal.to_vec(), false);
    }
    let unique = if pushed { Uniqueness::Shakedown } else { Uniqueness::Residual };
    AmplitudeBounds { lower, upper, unique, proved: false }
}

/// Whether two motions of neighbouring points have their sliders at the same places of their ranges.
fn is_like(a: &HeldMotion, b: &HeldMotion) -> bool {
    let place = |motion: &HeldMotion, slider: usize| {
        motion.range[slider].map(|[low, high]| (motion.sliders[slider] - low) / (high - low))
    };
    (0..a.range.len()).all(|slider| match (place(a, slider), place(b, slider)) {
        (Some(a), Some(b)) => (a - b).abs() < 0.05,
        (None, None) => true,
        _ => false,
    })
}
