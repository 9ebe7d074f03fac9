//! The branch of a nonlinear mode: where it begins, and the way from amplitude to amplitude.

use super::equations::ModeEquations;
use super::feed::Feed;
use super::harmonics::{fewest, Step, Truncation};
use super::point::{Interaction, ModePoint};
use super::settings::{Amplitudes, ModeEnd, ModeMethod, ModeSettings};
use super::start::{at_rest, linear_mode, Linear};
use crate::balance::{is_balanced, HarmonicChoice, PointStatus, Progress};
use crate::contact::Residual;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::{
    across, at_parameter, between, norm, Advance, Continuation, NewtonSettings, Steps,
};
use crate::timing::Profile;
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Longest steps along a branch whose points are wanted, and along one of which some amplitudes are, in
/// the metric of the unknowns: shares of the motion, and ln a.
const LONGEST: [f64; 2] = [0.25, 0.6];
/// Steps; the longest depends on what is wanted.
const STEPS: Steps = Steps { first: 0.05, shortest: 1e-7, longest: 0.25, max_iterations: 20 };
/// Change of the damping from point to point of such a branch, as a share of it or of its viscous part,
/// and the least damping, in units of 2ω, that counts.
const SEEN: [f64; 2] = [0.04, 1e-4];
/// Shortest step that the damping asks for: there is a corner.
const CORNER: f64 = 1e-3;
/// Amplitude relative to the least one that is asked for, below which a start is not looked for.
const LEAST_START: f64 = 1e-9;
/// Distance in frequency and shape from the linear mode at which a branch may begin.
const LINEAR: [f64; 2] = [0.02, 0.02];
/// Times that the way between two points is halved to find one between them.
const HALVINGS: usize = 20;
/// Share of the way between two points that steps then have.
const SHORTER: f64 = 0.25;
/// Amplitudes below the least one by this factor at which a branch that has turned back ends.
const BACK: f64 = 10.0;
/// Most evaluations of the equations: so many per step and per amplitude that is taken on the way, and so many
/// more for a few hard places.
const EVALUATIONS: [usize; 2] = [40, 1500];

/// Least share of the progress from the first point on: there is something to keep.
const BEGUN: f64 = 1e-3;

/// A branch on its way.
pub(super) struct Walk<'a> {
    settings: &'a ModeSettings,
    pub(super) truncation: Truncation<'a>,
    pub(super) linear: Linear,
    pub(super) points: Vec<ModePoint>,
    pub(super) turns: Vec<f64>,
    /// The strongest internal resonance on the way, and its ln a.
    pub(super) met: Option<(f64, Interaction)>,
    /// ln a of the last point of the branch.
    pub(super) last: Option<f64>,
    pub(super) profile: Profile,
}

impl<'a> Walk<'a> {
    /// A branch whose automatic harmonics are never fewer than `lowest`.
    pub(super) fn new(
        model: &'a Model,
        settings: &'a ModeSettings,
        residuals: Vec<Residual>,
        progress: &'a Progress<'a>,
        lowest: usize,
    ) -> Result<Self, Error> {
        let kept = match settings.harmonics {
            HarmonicChoice::Fixed(highest) => highest,
            HarmonicChoice::Auto => fewest(settings).max(lowest),
        };
        Error::check_order("harmonics", kept, crate::balance::HIGHEST_ORDER)?;
        residuals.iter().try_for_each(|residual| residual.check())?;
        let odd = model.laws().iter().all(|law| law.is_odd());
        let loaded = model.compliance().forced_harmonics().contains(&0);
        let half_wave = odd && !loaded && residuals.iter().all(|one| one.is_symmetric());
        let bases = model.modal_bases(4 * settings.max_harmonics.max(kept))?;
        let table = Arc::new(SampleTable::new(Harmonics::new(kept, half_wave)));
        let rest = if half_wave { vec![0.0; bases.at(0).modes()] } else { at_rest(model, &bases)? };
        let feed = Feed::Damping;
        let mut equations =
            ModeEquations::new(model, bases, table, residuals, rest, feed, progress);
        let linear = linear_mode(&mut equations, settings.mode)?;
        equations.unit = linear.omega;
        if settings.method == ModeMethod::PhaseResonance {
            let basis = equations.basis(1);
            let driven = Feed::force(basis, model.fundamental_load(), &linear.shape);
            equations.feed = driven.ok_or_else(|| {
                let remedy = "is not driven by the forces of harmonic 1; choose another";
                Error::value("mode", settings.mode as f64, remedy)
            })?;
        }
        Ok(Self {
            settings,
            truncation: Truncation::new(equations, lowest),
            linear,
            points: Vec::new(),
            turns: Vec::new(),
            met: None,
            last: None,
            profile: Profile::default(),
        })
    }

    pub(super) fn equations(&mut self) -> &mut ModeEquations<'a> {
        &mut self.truncation.equations
    }

    /// Least and largest ln a that are wanted.
    pub(super) fn bounds(&self) -> (f64, f64) {
        match &self.settings.amplitudes {
            Amplitudes::Range(low, high) => (low.ln(), high.ln()),
            Amplitudes::List(values) => {
                let ends = [values.first(), values.last()];
                let [low, high] = ends.map(|one| one.copied().unwrap_or(f64::NAN).ln());
                (low, high)
            }
        }
    }

    /// The first point, at an amplitude or, where the mode is far from linear there, at a smaller one;
    /// nothing if there is none. Its mean becomes the state at rest.
    pub(super) fn begin(&mut self, low: f64) -> Option<Vec<f64>> {
        let mut log = low;
        while log >= low + LEAST_START.ln() && !self.equations().is_interrupted() {
            let equations = &mut self.truncation.equations;
            let start = self.linear.point(equations, log);
            equations.hold(&start);
            let found = at_parameter(equations, &start, log, STEPS.max_iterations);
            if let Some((mut z, _)) = found {
                let [omega, shape] = LINEAR;
                let size = z.len();
                let range = equations.range(1);
                let along: f64 =
                    z[range.clone()].iter().zip(&start[range]).map(|(a, b)| a * b).sum();
                if (z[size - 3] - 1.0).abs() < omega && along > 1.0 - shape {
                    equations.rebase(&mut z);
                    return Some(z);
                }
            }
            log -= std::f64::consts::LN_10;
        }
        None
    }

    /// Follows the branch from its first point.
    pub(super) fn follow(&mut self, first: Vec<f64>) -> ModeEnd {
        let (low, high) = self.bounds();
        let whole = matches!(self.settings.amplitudes, Amplitudes::Range(..));
        let (first, step) = self.truncation.refined(first, self.settings);
        if log(&first) >= low {
            self.record(&first, step.as_ref());
        }
        self.last = Some(log(&first));
        let steps = Steps { longest: LONGEST[usize::from(!whole)], ..STEPS };
        let mut walk = Continuation::new(self.equations(), first, 1.0, steps);
        let (mut rises, mut taken) = (true, 0);
        loop {
            let before = walk.clone();
            let from = log(&before.point);
            if from >= high {
                return ModeEnd::Range;
            }
            if from < low - BACK.ln() && !rises {
                return ModeEnd::Returned;
            }
            let evaluations = self.equations().profile.evaluations;
            if evaluations > EVALUATIONS[0] * (taken + self.points.len()) + EVALUATIONS[1] {
                return ModeEnd::Evaluations;
            }
            if taken.max(self.points.len()) >= self.settings.most {
                return ModeEnd::Points;
            }
            let share = (from - low) / (high - low).max(f64::MIN_POSITIVE);
            let least = if self.points.is_empty() { 0.0 } else { BEGUN };
            self.equations().share.set(share.clamp(least, 1.0));
            match walk.advance(self.equations()) {
                Advance::Point => {}
                Advance::Stalled => return ModeEnd::Stalled,
                Advance::Interrupted => return ModeEnd::Interrupted,
            }
            let length = distance(&before.point, &walk.point);
            if whole && length > CORNER && !self.shows(&before.point, &walk.point) {
                walk = before;
                walk.limit_step((0.4 * length).max(STEPS.shortest));
                self.equations().hold(&walk.point);
                continue;
            }
            taken += 1;
            if (log(&walk.point) > from) != rises {
                rises = !rises;
                self.turns.push(from.exp());
            }
            self.last = Some(log(&walk.point));
            self.meet(&walk.point);
            let known = walk.point.len();
            self.pass(&before.point, &walk.point);
            if self.equations().size() == known {
                self.equations().hold(&walk.point);
            } else {
                self.recast(&mut walk, &before.point);
            }
        }
    }

    /// Remembers the strongest internal resonance within what is wanted.
    fn meet(&mut self, z: &[f64]) {
        let (at, (low, high)) = (log(z), self.bounds());
        let found = Interaction::largest(&self.truncation.equations, z);
        let Some(found) = found.filter(|_| at >= low && at <= high) else { return };
        if self.met.is_none_or(|(_, known)| found.share > known.share) {
            self.met = Some((at, found));
        }
    }

    /// Takes what is wanted between two points of the branch.
    fn pass(&mut self, before: &[f64], z: &[f64]) {
        let (from, to) = (log(before), log(z));
        let (low, high) = self.bounds();
        match self.settings.amplitudes.clone() {
            Amplitudes::Range(..) => {
                if from < low && to > low {
                    self.take_between(before, z, low);
                }
                if from < high && to > high {
                    self.take_between(before, z, high);
                } else if to >= low && to <= high {
                    self.take(z.to_vec());
                }
            }
            Amplitudes::List(values) => {
                for value in values.iter().skip(self.points.len()).map(|a| a.ln()) {
                    if from < value && value <= to {
                        self.take_between(before, z, value);
                    }
                }
            }
        }
    }

    /// Takes the point at an amplitude between two others.
    fn take_between(&mut self, before: &[f64], z: &[f64], value: f64) {
        let equations = &mut self.truncation.equations;
        let size = equations.size();
        let [mut before, mut z] = [before, z].map(|z| equations.recast(z, size));
        for _ in 0..HALVINGS {
            if let Some((point, _)) = between(equations, &before, &z, value) {
                return self.take(point);
            }
            // Behind a corner the branch is not where the chord is.
            equations.hold(&before);
            let Some(middle) = across(equations, &before, &z, 0.5) else { break };
            if log(&middle) < value {
                before = middle;
            } else {
                z = middle;
            }
        }
        if let Some(point) = self.walked([before, z], value) {
            return self.take(point);
        }
        let compliance = self.truncation.equations.model.compliance();
        let (dofs, contacts) = (compliance.dofs(), compliance.contacts());
        self.points.push(ModePoint::missing(dofs, contacts, value.exp()));
    }

    /// The point at an amplitude on the curve from one point to another, by shorter steps: about an internal
    /// resonance the curve is far from the chord.
    fn walked(&mut self, [before, z]: [Vec<f64>; 2], value: f64) -> Option<Vec<f64>> {
        let equations = &mut self.truncation.equations;
        let longest = (SHORTER * distance(&before, &z)).max(STEPS.shortest);
        let steps = Steps { first: 0.5 * longest, longest, ..STEPS };
        let mut walk = Continuation::new(equations, before, 1.0, steps);
        let most = equations.profile.evaluations + 2 * EVALUATIONS[1];
        while equations.profile.evaluations < most {
            let from = walk.point.clone();
            if walk.advance(equations) != Advance::Point {
                return None;
            }
            if log(&walk.point) >= value {
                let found = between(equations, &from, &walk.point, value);
                return found.map(|(point, _)| point);
            }
        }
        None
    }

    /// Takes a point, in as many harmonics as the tolerance asks for.
    fn take(&mut self, z: Vec<f64>) {
        let size = self.equations().size();
        let z = self.equations().recast(&z, size);
        let (z, step) = self.truncation.refined(z, self.settings);
        self.record(&z, step.as_ref());
        if let Some(step) = step {
            self.truncation.ease(&step, self.settings);
        }
    }

    /// Goes on in the harmonics that have been found necessary.
    fn recast(&mut self, walk: &mut Continuation, before: &[f64]) {
        let equations = &mut self.truncation.equations;
        let size = equations.size();
        let [a, b] = [before, &walk.point].map(|z| equations.recast(z, size));
        // Neither lies on the curve in other harmonics.
        let [a, b] = [0.0, 1.0].map(|share| {
            let known = if share == 0.0 { &a } else { &b };
            equations.hold(known);
            across(equations, &a, &b, share).unwrap_or_else(|| known.clone())
        });
        walk.restart(equations, &a, &b);
    }

    /// Whether two points of a branch that is wanted as a whole are close enough for what is read off
    /// between them: damping rises steeply where contacts begin to slip. Where contacts take what a
    /// negative damping feeds, none is left, and no share of it tells what is close.
    fn shows(&self, z: &[f64], ahead: &[f64]) -> bool {
        let (low, _) = self.bounds();
        let [before, after] = [z, ahead].map(|z| z[z.len() - 2]);
        let viscous = self.truncation.equations.viscous_feed(ahead);
        let size = before.abs().max(after.abs()).max(viscous).max(SEEN[1]);
        log(ahead) <= low || (after - before).abs() <= SEEN[0] * size
    }

    fn record(&mut self, z: &[f64], step: Option<&Step>) {
        let start = Instant::now();
        let equations = &mut self.truncation.equations;
        // What the equations were evaluated at last may be another point.
        let residual = norm(&equations.evaluate(z));
        let mut point = ModePoint::new(equations, &self.linear, z);
        point.response.residual = residual;
        if let Some(step) = step {
            point.errors = step.relative();
            point.response.error_estimate = self.truncation.changes(&point, step);
        }
        // An error that is not known is not below the tolerance.
        let enough = step.is_some_and(|step| step.error() <= self.settings.tolerance);
        if !is_balanced(residual, NewtonSettings::default()) {
            point.response.status = PointStatus::Stalled;
        } else if !enough && self.settings.harmonics == HarmonicChoice::Auto {
            point.response.status = PointStatus::HarmonicsLimit;
        }
        self.profile.recovery += start.elapsed();
        self.points.push(point);
    }

    /// Largest amplitude of a point that was found.
    pub(super) fn reached(&self) -> f64 {
        let found = self.points.iter().filter(|point| point.response.omega.is_finite());
        found.map(|point| point.amplitude).fold(0.0, f64::max)
    }

    /// Says of amplitudes that were not reached that they were not.
    pub(super) fn fill_up(&mut self) {
        let Amplitudes::List(values) = &self.settings.amplitudes else { return };
        let compliance = self.truncation.equations.model.compliance();
        for &value in values.iter().skip(self.points.len()) {
            self.points.push(ModePoint::missing(compliance.dofs(), compliance.contacts(), value));
        }
    }
}

fn log(z: &[f64]) -> f64 {
    z[z.len() - 1]
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>())
}
