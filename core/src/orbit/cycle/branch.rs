//! The branch of limit cycles of a mode: from the stuck limit through the fold to the slipping side.

use super::limit_cycle::OrbitCurve;
use super::orbits::CycleOrbits;
use super::postprocess::postprocess;
use super::settings::{relative, Cycle, CycleSettings, LimitCycles, RARE};
use super::sides::{joined, value, Sides};
use super::stability::{judge, judge_along, Judge, TRACING};
use crate::balance::{
    oscillation, with_history, CycleBalance, HarmonicChoice, Onset, Point, PointStatus, Progress,
};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::{FlutterModel, Model, NegativeDamping, Variation};
use crate::motion::Quadrature;
use crate::solve::{at_parameter, tangent, Bounds, Branch, Curve, Steps};
use crate::timing::Profile;
use crate::Error;
use faer::c64;
use std::cell::Cell;
use std::time::{Duration, Instant};

/// Of the first point of exact branches.
const START_HARMONICS: usize = 15;
/// First ratio beyond the onset, relative to it, where the range does not say.
const BEYOND_ONSET: f64 = 0.01;
/// Share of the progress when the first point is known: from then on there is something to keep.
const BEGUN: f64 = 0.01;
/// Time that an ended analysis may take to read off what it has found.
const PATIENCE: Duration = Duration::from_millis(200);
/// Motion, relative to the onset of slip, at which a branch counts as going to infinity.
const ENDLESS: f64 = 1e5;
/// How many times further it is followed towards ratios that are asked for: beyond, friction drowns in rounding.
const FURTHER: f64 = 1e3;

/// Follows the limit cycles of a mode of `model` with the damping `C + r C_neg`.
///
/// # Errors
/// Settings outside their range, a mode that is not excited or moves no contact, no limit cycle
/// to begin with.
pub fn limit_cycles(
    model: &Model,
    negative: &NegativeDamping,
    variation: &Variation,
    ratio: f64,
    settings: &CycleSettings,
    progress: &Progress<'_>,
) -> Result<LimitCycles, Error> {
    settings.check()?;
    let begin = Instant::now();
    let held = if model.is_biased() { with_history(model)? } else { None };
    let model = held.as_ref().unwrap_or(model);
    let given = FlutterModel::new(model, negative.clone(), Variation::Ratio, ratio)?;
    let family = FlutterModel::new(model, negative.clone(), variation.clone(), ratio)?;
    let stopped = Cell::new(false);
    let share = Cell::new(0.0);
    let interrupted = || {
        stopped.set(stopped.get() || !progress(share.get()));
        stopped.get()
    };
    let onset = Onset::new(&given, settings.mode, ratio)?;
    // Without orbits a balance goes without its stability.
    let orbits = match CycleOrbits::new(&family) {
        Err(Error::NoEvents { .. }) if !settings.exact => None,
        orbits => orbits?,
    };
    let orbits = match orbits.map(|orbits| orbits.paced(onset.mode.omega)).transpose() {
        Err(_) if !settings.exact => None,
        orbits => orbits?,
    };
    let mut finder = Finder { given, family: &family, onset: &onset, settings, ratio };
    if settings.exact && orbits.is_none() {
        return Err(Error::TravellingWave);
    }
    let found = match (&orbits, settings.exact) {
        (Some(orbits), true) => finder.exactly(orbits, &interrupted, &share),
        _ => finder.balanced(orbits.as_ref(), &interrupted, &share),
    };
    let mut out = match found {
        // The caller has ended the search: there is nothing to report.
        Err(_) if stopped.get() => finder.result(&Sides::default(), Vec::new()),
        other => other?,
    };
    out.interrupted = stopped.get();
    out.profile.total = begin.elapsed();
    Ok(out)
}

struct Finder<'a> {
    /// The family in r, in which every branch begins.
    given: FlutterModel<'a>,
    family: &'a FlutterModel<'a>,
    onset: &'a Onset,
    settings: &'a CycleSettings,
    ratio: f64,
}

impl Finder<'_> {
    /// By harmonic balance.
    fn balanced(
        &mut self,
        orbits: Option<&CycleOrbits<'_>>,
        interrupted: &dyn Fn() -> bool,
        share: &Cell<f64>,
    ) -> Result<LimitCycles, Error> {
        let settings = self.settings;
        let rungs = settings.rungs();
        let last = rungs.len() - 1;
        for (rung, &highest) in rungs.iter().enumerate() {
            let table = self.table(highest);
            let sides = match self.follow_balance(&table, interrupted, share) {
                Err(_) if rung < last => continue,
                other => other?,
            };
            let start = sides.branch.points.first().cloned().unwrap_or_default();
            let mut curve = CycleBalance::new(self.family, &table, &start, interrupted);
            let selected = sides.select(self.settings.values.as_deref(), &mut curve);
            let beyond = self.table(highest + (highest / 2).max(4));
            let mut cycles = Vec::with_capacity(selected.len());
            let mut beyond_tolerance = 0;
            let mut ended = None;
            for (slipping, z) in &selected {
                let stop = interrupted();
                if stop && *ended.get_or_insert_with(Instant::now) + PATIENCE < Instant::now() {
                    break;
                }
                let mut point = curve.point(z, self.onset.dof);
                // What is found is kept; its errors are what takes the time.
                if stop {
                    cycles.push(self.cycle(z, *slipping, point));
                    continue;
                }
                let weights = curve.weights(z);
                let mut ahead = vec![0.0; z.len()];
                ahead[z.len() - 1] = 1.0;
                let along = tangent(&mut curve, z, &weights, &ahead).unwrap_or(ahead);
                point.error_estimate = curve.errors(z, &along, &beyond);
                beyond_tolerance += usize::from(relative(&point) > settings.tolerance);
                cycles.push(self.cycle(z, *slipping, point));
            }
            let few = beyond_tolerance * RARE <= selected.len();
            let enough = few || rung == last || interrupted();
            if settings.harmonics == HarmonicChoice::Auto {
                for cycle in &mut cycles {
                    let response = &cycle.response;
                    if response.is_solved() && relative(response) > settings.tolerance {
                        cycle.response.status = PointStatus::HarmonicsLimit;
                    }
                }
                if !enough {
                    continue;
                }
            }
            share.set(TRACING);
            let mut out = self.result(&sides, cycles);
            out.profile.evaluations = curve.evaluations;
            if let (Some(orbits), true) = (orbits, settings.stability) {
                judge(self.judge(orbits, None), &mut out, interrupted, share);
            } else if settings.stability && !self.family.is_symmetric() {
                judge_along(self.family, &mut out, interrupted, share);
            }
            return Ok(out);
        }
        Err(self.no_start())
    }

    fn exactly(
        &mut self,
        orbits: &CycleOrbits<'_>,
        interrupted: &dyn Fn() -> bool,
        share: &Cell<f64>,
    ) -> Result<LimitCycles, Error> {
        let scale = self.onset.mode.omega;
        let table = self.table(START_HARMONICS);
        let start = self.first(&table, interrupted)?;
        let of_ratio = CycleOrbits::new(&self.given)?.ok_or(Error::TravellingWave)?;
        let begin = {
            let mut balance = CycleBalance::new(&self.given, &table, &start, interrupted);
            let point = balance.point(&start, self.onset.dof);
            let value = start[start.len() - 1];
            let guess = of_ratio.unknowns(&point, value, scale, 1)?;
            let mut curve = OrbitCurve::new(&of_ratio, scale, &guess, interrupted);
            at_parameter(&mut curve, &guess, value, 40).ok_or_else(|| self.no_start())?.0
        };
        share.set(BEGUN);
        let mut of_ratio = OrbitCurve::new(&of_ratio, scale, &begin, interrupted);
        let mut curve = OrbitCurve::new(orbits, scale, &begin, interrupted);
        let sides = self.follow(&mut of_ratio, &mut curve, begin, &crate::solve::norm, scale)?;
        let selected = sides.select(self.settings.values.as_deref(), &mut curve);
        let reported = self.table(self.settings.reported);
        let mut quadrature = Quadrature::default();
        let mut cycles = Vec::with_capacity(selected.len());
        let mut points = Vec::new();
        let mut ended = None;
        share.set(TRACING);
        for (slipping, z) in selected {
            let late = interrupted()
                && *ended.get_or_insert_with(Instant::now) + PATIENCE < Instant::now();
            if late {
                break;
            }
            let blank = Point::empty(f64::NAN, PointStatus::Stalled, 0, 0);
            let cycle = self.cycle(&z, slipping, blank);
            let dof = self.onset.dof;
            let Some(cycle) = postprocess(&curve, &z, dof, &reported, &mut quadrature, cycle)
            else {
                continue;
            };
            cycles.push(cycle);
            points.push(z);
        }
        let mut out = self.result(&sides, cycles);
        out.profile.evaluations = curve.flows;
        out.profile.factorisations = curve.matrices;
        if self.settings.stability {
            judge(self.judge(orbits, Some(points)), &mut out, interrupted, share);
        }
        Ok(out)
    }

    fn judge<'b>(&self, orbits: &'b CycleOrbits<'b>, exact: Option<Vec<Vec<f64>>>) -> Judge<'b> {
        let whole = self.settings.values.is_none();
        Judge { orbits, scale: self.onset.mode.omega, exact, whole }
    }

    /// Samples of the harmonics that the motions have.
    fn table(&self, highest: usize) -> SampleTable {
        SampleTable::new(Harmonics::new(highest, self.family.is_symmetric()))
    }

    /// The first limit cycle in r, by harmonic balance.
    fn first(
        &self,
        table: &SampleTable,
        interrupted: &dyn Fn() -> bool,
    ) -> Result<Vec<f64>, Error> {
        let onset = self.onset.ratio;
        let low = self.lowest_ratio();
        let ratio = if low > onset { low } else { onset * (1.0 + BEYOND_ONSET) };
        let start = |ratio| self.onset.first_point(&self.given, table, ratio, interrupted);
        // What is asked for closer to the onset than the branch would begin is on it, too.
        let of_ratio = *self.family.variation() == Variation::Ratio;
        let values = self.settings.values.iter().flatten().copied().filter(|_| of_ratio);
        let nearest = values.filter(|value| (onset..ratio).contains(value)).reduce(f64::min);
        nearest.and_then(start).or_else(|| start(ratio)).ok_or_else(|| self.no_start())
    }

    fn lowest_ratio(&self) -> f64 {
        let settings = self.settings;
        if *self.family.variation() == Variation::Ratio {
            let values = settings.values.iter().flatten().copied();
            values.fold(settings.range.0, f64::min)
        } else {
            (0.01_f64).min(0.5 * self.ratio)
        }
    }

    fn no_start(&self) -> Error {
        Error::NoLimitCycle {
            mode: self.settings.mode,
            onset: self.onset.ratio,
            omega: self.onset.mode.omega,
        }
    }

    fn follow_balance(
        &self,
        table: &SampleTable,
        interrupted: &dyn Fn() -> bool,
        share: &Cell<f64>,
    ) -> Result<Sides, Error> {
        let start = self.first(table, interrupted)?;
        share.set(BEGUN);
        let mut of_ratio = CycleBalance::new(&self.given, table, &start, interrupted);
        let mut curve = CycleBalance::new(self.family, table, &start, interrupted);
        let moved = |u: &[f64]| oscillation(table.harmonics(), u);
        self.follow(&mut of_ratio, &mut curve, start, &moved, 1.0)
    }

    /// Follows the branch: in r at once, or in r to the ratio asked for and from there to both
    /// sides in the other scalar; `moved` is the size of the motion, of a displacement of 1 m about `unit`.
    fn follow(
        &self,
        of_ratio: &mut dyn Curve,
        curve: &mut dyn Curve,
        start: Vec<f64>,
        moved: &dyn Fn(&[f64]) -> f64,
        unit: f64,
    ) -> Result<Sides, Error> {
        let settings = self.settings;
        let steps = Steps::default();
        // The mean over the states, however many there are.
        let motion = |z: &[f64]| moved(&z[..z.len() - 2]) / (z.len() as f64).sqrt();
        // A contact that slips little by little has its onset at next to nothing.
        let whole =
            if self.onset.whole > 1.0 { self.onset.amplitude * self.onset.whole } else { 0.0 };
        let shape = self.onset.mode.contact.iter().map(|u| u.norm_sqr()).sum::<f64>();
        let first = motion(&start).max(unit * whole * (shape / start.len() as f64).sqrt());
        let endless = |z: &[f64]| motion(z) > ENDLESS * first;
        if *self.family.variation() == Variation::Ratio {
            let lowest = self.lowest_ratio().min(start[start.len() - 1]);
            let asked = settings.values.iter().flatten().copied().reduce(f64::min);
            let ahead = |z: &[f64]| asked.is_some_and(|asked| asked < value(z));
            let ends =
                |z: &[f64]| motion(z) > ENDLESS * first * if ahead(z) { FURTHER } else { 1.0 };
            let bounds =
                Bounds { range: (lowest, settings.range.1), most: settings.most, ends: &ends };
            let sudden = self.family.is_symmetric() && self.onset.whole <= 1.0;
            let sign = if sudden { 1.0 } else { rising(curve, &start, moved) };
            let branch = Branch::continue_branch(curve, start, sign, steps, &bounds);
            // What lies below the range served to get started.
            let low = settings.values.is_none().then_some(settings.range.0);
            return Ok(Sides::upwards(branch, low.unwrap_or(f64::NEG_INFINITY)));
        }
        let own = self.family.own_value().ok_or_else(|| {
            let got = "different ones; follow a factor on them";
            Error::shape("contacts", "one value of what is followed", got)
        })?;
        if own.is_infinite() {
            let remedy = "never slip; give the model a finite slip force, from which to follow it";
            return Err(Error::value("contacts", own, remedy));
        }
        let wanted = self.ratio;
        let reached = |z: &[f64]| value(z) >= wanted;
        let bounds = Bounds { range: (0.0, f64::INFINITY), most: settings.most, ends: &reached };
        let to_ratio = Branch::continue_branch(of_ratio, start, 1.0, steps, &bounds);
        let Some((_, mut z)) = to_ratio.at(of_ratio, wanted).into_iter().next() else {
            let largest = to_ratio.points.iter().map(|z| value(z)).fold(0.0, f64::max);
            let remedy = format!("the mode has limit cycles up to r = {largest:.6} only");
            return Err(Error::value("ratio", wanted, &remedy));
        };
        if let Some(last) = z.last_mut() {
            *last = own;
        }
        let values = settings.values.iter().flatten().copied();
        let low = values.clone().fold(settings.range.0, f64::min).min(own);
        let high = values.fold(settings.range.1, f64::max).max(own);
        let bounds = Bounds { range: (low, high), most: settings.most, ends: &endless };
        let up = Branch::continue_branch(curve, z.clone(), 1.0, steps, &bounds);
        let down = Branch::continue_branch(curve, z, -1.0, steps, &bounds);
        Ok(joined(up, down))
    }

    fn cycle(&self, z: &[f64], slipping: bool, response: Point) -> Cycle {
        let value = value(z);
        let model = self.family.model();
        let size = model.states();
        Cycle {
            value,
            ratio: self.family.ratio_at(value),
            slipping,
            range: Vec::new(),
            state: Vec::new(),
            viscous: f64::NAN,
            events: Vec::new(),
            multipliers: vec![c64::new(f64::NAN, f64::NAN); size.saturating_sub(1)],
            neutral: 0,
            closed: false,
            response,
        }
    }

    fn result(&self, sides: &Sides, cycles: Vec<Cycle>) -> LimitCycles {
        LimitCycles {
            cycles,
            limit: sides.limit.and_then(|at| sides.turn(at)),
            folds: sides.branch.folds.iter().filter_map(|at| sides.turn(*at)).collect(),
            changes: Vec::new(),
            ends: sides.ends,
            end_values: sides.end_values(),
            onset: self.onset.ratio,
            stuck_omega: self.onset.mode.omega,
            phase_dof: self.onset.dof,
            jumps: sides.branch.jumps,
            interrupted: false,
            profile: Profile::default(),
        }
    }
}

/// Direction in the scalar in which motions grow: contacts that open may take damping off a mode, or leave
/// it as it is.
fn rising(curve: &mut dyn Curve, z: &[f64], moved: &dyn Fn(&[f64]) -> f64) -> f64 {
    let weights = curve.weights(z);
    let mut ahead = vec![0.0; z.len()];
    ahead[z.len() - 1] = 1.0;
    let Some(along) = tangent(curve, z, &weights, &ahead) else { return 1.0 };
    let motion = |share: f64| -> f64 {
        let there = z.iter().zip(&along).map(|(z, way)| z + share * way);
        moved(&there.take(z.len() - 2).collect::<Vec<f64>>())
    };
    let grows = motion(1e-6) > motion(-1e-6);
    if grows == (value(&along) > 0.0) {
        1.0
    } else {
        -1.0
    }
}
