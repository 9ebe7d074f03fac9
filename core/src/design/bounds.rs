//! Bounds of a response over the residual tractions that Coulomb allows.
//!
//! The positions of the sliders that a motion never moves are varied: every position from which the
//! contact goes on without slip is admissible, and from any other one the motion pushes it to such a
//! one (see [`crate::contact::Residual`]). Amplitudes are made largest and least over them, by steps
//! along the exact gradient of the balance (quasi-Newton, Broyden 1970; Nocedal and Wright 2006,
//! chapter 6), which the law itself projects to what is admissible. What was extreme at one frequency
//! is followed to the next, forwards and then backwards; from time to time all corners are tried.
//!
//! What is found is attained, so that these are *inner* bounds: others could lie outside. Where all
//! laws are monotone operators and the structure is damped there is one vibration alone, and the two
//! coincide: that is proved (`docs/theory.md`, one solution).

use super::ascent::Ascent;
use crate::balance::{with_history, AmplitudeBounds, Evaluated, Point, Progress, Settings};
use crate::balance::{HeldMotion, SliderBalance, Solution, Uniqueness};
use crate::contact::Residual;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::timing::Profile;
use crate::Error;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Points after which all corners are tried again.
const SURVEY: usize = 2;
/// Corners that are tried at most.
const CORNERS: usize = 8;
/// Width of the bounds, relative to the amplitude, that is none.
const NO_WIDTH: f64 = 1e-9;
/// Distance of two positions, relative to their range, that is none.
const SAME: f64 = 1e-3;

/// What is known at a point.
#[derive(Default)]
pub(super) struct Found {
    /// The motion of the curve.
    pub(super) nominal: Option<HeldMotion>,
    /// The motions that are extreme in some DOF, largest and least.
    pub(super) extremes: Vec<HeldMotion>,
    ascents: Vec<Ascent>,
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
    let found = search.along(solution, progress)?;
    for (point, found) in solution.points.iter_mut().zip(&found) {
        if let Some(bounds) = found.bounds() {
            Arc::make_mut(point).bounds = Some(bounds);
        }
    }
    solution.profile.add(&search.profile);
    solution.profile.total += start.elapsed();
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
        let marched = samples.into_iter().map(|n| Ok((n, Arc::new(model.marched(n)?))));
        let marched = marched.collect::<Result<_, Error>>()?;
        let (ranges, profile) = (BTreeMap::new(), Profile::default());
        Ok(Self { model, settings, observe, tables, marched, ranges, profile })
    }

    /// Goes along the curve and back; what was found, as far as nobody has ended it.
    pub(super) fn along(
        &mut self,
        solution: &Solution,
        progress: &Progress<'_>,
    ) -> Result<Vec<Found>, Error> {
        let count = solution.points.len();
        let mut found: Vec<Found> = Vec::with_capacity(count);
        for (n, point) in solution.points.iter().enumerate() {
            if !progress(n as f64 / count as f64) {
                break;
            }
            let survey = n % SURVEY == 0 || n + 1 == count;
            let next = self.point(point, found.last(), survey)?;
            found.push(next);
        }
        for n in (0..found.len().saturating_sub(1)).rev() {
            if !progress(1.0) {
                break;
            }
            let (before, after) = found.split_at_mut(n + 1);
            self.again(&solution.points[n], &mut before[n], &after[0])?;
        }
        Ok(found)
    }

    /// Searches at a point, from the extremes of the one before.
    fn point(
        &mut self,
        point: &Point,
        before: Option<&Found>,
        survey: bool,
    ) -> Result<Found, Error> {
        let Some(mut here) = self.open(point)? else { return Ok(Found::default()) };
        let Some(nominal) = here.balance.of_point(point, self.settings.residual) else {
            return Ok(Found::default());
        };
        here.pool.push(nominal);
        if let Some(before) = before {
            here.continue_from(before, |_| true);
        }
        self.learn(&here.pool);
        let known: Vec<(usize, [f64; 2])> = self.ranges.iter().map(|(n, r)| (*n, *r)).collect();
        let held = |found: &Found| found.nominal.as_ref().map(|motion| motion.held().count());
        let lost = here.pool[0].held().count() < known.len();
        let changed = before.and_then(held) != Some(here.pool[0].held().count());
        if survey || changed {
            here.try_corners(&known, lost);
            self.learn(&here.pool);
        }
        here.climb(before.map_or(&[], |before| &before.ascents));
        let found = here.end();
        self.profile.add(here.balance.profile());
        Ok(found)
    }

    /// Takes up where sliders may be.
    fn learn(&mut self, motions: &[HeldMotion]) {
        motions.iter().for_each(|motion| self.ranges.extend(motion.held()));
    }

    /// Tries at a point what is extreme at the next one and not here.
    fn again(&mut self, point: &Point, found: &mut Found, after: &Found) -> Result<(), Error> {
        let strange = |motion: &HeldMotion| !found.extremes.iter().any(|own| is_like(own, motion));
        if found.nominal.is_none() || !after.extremes.iter().any(strange) {
            return Ok(());
        }
        let Some(mut here) = self.open(point)? else { return Ok(()) };
        here.pool.extend(found.nominal.clone());
        here.pool.extend(found.extremes.iter().cloned());
        let known = here.bounds();
        here.continue_from(after, strange);
        if here.is_beyond(&known) {
            here.climb(&found.ascents);
            *found = here.end();
        }
        self.profile.add(here.balance.profile());
        Ok(())
    }

    /// The balance at a point in the positions of its sliders, at the resolution of the point.
    pub(super) fn open(&self, point: &Point) -> Result<Option<Here<'a>>, Error> {
        let Some(table) = self.tables.get(&point.harmonics).filter(|_| point.is_solved()) else {
            return Ok(None);
        };
        let marched = point.samples.and_then(|samples| self.marched.get(&samples));
        let model = marched.map_or_else(|| self.model.clone(), |m| Evaluated::Made(Arc::clone(m)));
        let newton = self.settings.newton;
        let balance = SliderBalance::new(model, table, point.omega, newton, self.observe)?;
        Ok(Some(Here { balance, pool: Vec::new(), ascents: Vec::new() }))
    }
}

/// The search at one point: every motion found is a bound of every DOF.
pub(super) struct Here<'a> {
    pub(super) balance: SliderBalance<'a>,
    /// All motions found, that of the curve first.
    pub(super) pool: Vec<HeldMotion>,
    ascents: Vec<Ascent>,
}

impl Here<'_> {
    /// Follows the extremes of a neighbour to here.
    fn continue_from(&mut self, other: &Found, wanted: impl Fn(&HeldMotion) -> bool) {
        let Some(from) = &other.nominal else { return };
        for motion in other.extremes.iter().filter(|motion| wanted(motion)) {
            let u = &self.pool[0].u;
            let mut start = motion.clone();
            if start.u.len() == u.len() && from.u.len() == u.len() {
                let moved = u.iter().zip(&from.u);
                start.u.iter_mut().zip(moved).for_each(|(x, (here, there))| *x += here - there);
            } else {
                start.u.clone_from(u);
            }
            let target = beyond(motion, &motion.sliders);
            let found = self.balance.solve(&target, Some(&start.u), true);
            let stays = |found: &HeldMotion| found.held().count() >= motion.held().count();
            let lost = !found.as_ref().is_some_and(stays);
            self.pool.extend(found);
            if lost && motion.u.len() == start.u.len() {
                // The curve itself may have come to another state.
                self.pool.extend(self.balance.solve(&target, Some(&motion.u), true));
            }
        }
    }

    /// Tries all corners of what is known of the sliders; with some that the curve's motion does not
    /// hold, motions that begin without slip as well.
    fn try_corners(&mut self, ranges: &[(usize, [f64; 2])], lost: bool) {
        let nominal = self.pool[0].clone();
        let most = if ranges.is_empty() { 0 } else { CORNERS };
        for corner in 0..most.min(1 << ranges.len().min(CORNERS)) {
            let mut target = nominal.sliders.clone();
            for (bit, (slider, [low, high])) in ranges.iter().enumerate() {
                let past = high - low;
                target[*slider] = if is_low(corner, bit) { low - past } else { high + past };
            }
            self.reach(0, &target);
            if lost {
                self.pool.extend(self.balance.solve(&target, None, true));
            }
        }
    }

    /// Moves the sliders of a motion of the pool; those that are sent to a limit go with it.
    pub(super) fn reach(&mut self, from: usize, target: &[f64]) -> Option<usize> {
        let from = self.pool[from].clone();
        let target = beyond(&from, target);
        let found = self.balance.follow(&from, &target)?;
        self.pool.push(found);
        Some(self.pool.len() - 1)
    }

    /// Raises every DOF to its largest and lowers it to its least amplitude.
    fn climb(&mut self, before: &[Ascent]) {
        let dofs = self.pool[0].amplitude.len();
        for dof in 0..dofs {
            for sign in [1.0, -1.0] {
                let known = before.iter().find(|ascent| ascent.is_of(dof, sign));
                let mut ascent = known.cloned().unwrap_or_else(|| Ascent::new(dof, sign));
                ascent.climb(self);
                self.ascents.push(ascent);
            }
        }
    }

    /// The motion with the largest amplitude of a DOF, or the least one.
    pub(super) fn best(&self, dof: usize, sign: f64) -> usize {
        let height = |motion: &HeldMotion| sign * motion.amplitude[dof];
        let order = |a: &usize, b: &usize| {
            height(&self.pool[*a]).total_cmp(&height(&self.pool[*b])).then(b.cmp(a))
        };
        (0..self.pool.len()).max_by(order).unwrap_or(0)
    }

    fn bounds(&self) -> Vec<[f64; 2]> {
        let dofs = self.pool[0].amplitude.len();
        let of = |dof: usize, sign: f64| self.pool[self.best(dof, sign)].amplitude[dof];
        (0..dofs).map(|dof| [of(dof, -1.0), of(dof, 1.0)]).collect()
    }

    /// Whether the motions found last have left bounds.
    fn is_beyond(&self, known: &[[f64; 2]]) -> bool {
        let wider = |(a, b): (&[f64; 2], &[f64; 2])| a[0] < b[0] || a[1] > b[1];
        self.bounds().iter().zip(known).any(wider)
    }

    fn end(&mut self) -> Found {
        let nominal = self.pool[0].amplitude.clone();
        let mut extremes: Vec<HeldMotion> = Vec::new();
        for (dof, amplitude) in nominal.into_iter().enumerate() {
            for sign in [1.0, -1.0] {
                let best = &self.pool[self.best(dof, sign)];
                let beyond = (best.amplitude[dof] - amplitude).abs() > NO_WIDTH * amplitude;
                let known = |own: &HeldMotion| own.amplitude == best.amplitude;
                if beyond && !extremes.iter().any(known) {
                    extremes.push(best.clone());
                }
            }
        }
        let ascents = std::mem::take(&mut self.ascents);
        Found { nominal: self.pool.first().cloned(), extremes, ascents }
    }
}

impl Found {
    fn bounds(&self) -> Option<AmplitudeBounds> {
        let nominal = self.nominal.as_ref()?;
        let others = self.extremes.iter().map(|motion| motion.amplitude.as_slice());
        Some(between(&nominal.amplitude, nominal.pushed, others))
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

/// On which side of its range a slider is in a corner: all corners in turn of up to three sliders, of
/// more those of the columns of a Hadamard matrix.
fn is_low(corner: usize, slider: usize) -> bool {
    (corner & (1 << (slider % 3) | (slider / 3))).count_ones() % 2 == 0
}

/// Positions, of which those at or past a limit go past it: there the law holds them at it, wherever
/// it moves.
pub(super) fn beyond(motion: &HeldMotion, target: &[f64]) -> Vec<f64> {
    let mut target = target.to_vec();
    for (slider, [low, high]) in motion.held() {
        let width = high - low;
        if target[slider] <= low + SAME * width {
            target[slider] = low - width;
        } else if target[slider] >= high - SAME * width {
            target[slider] = high + width;
        }
    }
    target
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
