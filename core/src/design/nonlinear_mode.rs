//! A nonlinear mode from amplitude to amplitude: its frequency, damping and shape.
//!
//! It begins as the linear mode of the structure with its contacts as they are at rest, and is followed
//! by arclength in the logarithm of the amplitude, around the turns that contacts make as they lift off.

use super::mode_equations::{ModeEquations, Plane};
use super::mode_point::ModePoint;
use super::mode_start::{at_rest, linear_mode, Linear};
use crate::balance::{HarmonicChoice, PointStatus, Progress};
use crate::contact::{ContactLaw, Residual};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::norm;
use crate::timing::Profile;
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Longest steps along a branch whose points are wanted, and along one of which some amplitudes are, in
/// the metric of the unknowns: shares of the motion, and ln a.
const LONGEST: [f64; 2] = [0.25, 0.6];
/// Change of the damping from point to point of such a branch, as a share of it, and the least damping,
/// in units of 2ω, that counts.
const SEEN: [f64; 2] = [0.04, 1e-4];
/// First and shortest step.
const STEPS: [f64; 2] = [0.05, 1e-6];
/// Iterations up to which a step may grow, and from which on it shrinks.
const EASY: [usize; 2] = [5, 9];
/// Cosine of two steps below which the second is too long, …
const BEND: f64 = 0.9;
/// … unless it is this short: there is a corner.
const CORNER: f64 = 1e-3;
/// Amplitude relative to the least one that is asked for, below which a start is not looked for.
const LEAST_START: f64 = 1e-9;
/// Amplitude, relative to the least one that is asked for, at which a motion leaves the state at rest as it is.
const STILL: f64 = 1e-4;
/// Distance in frequency and shape from the linear mode at which a branch may begin.
const LINEAR: [f64; 2] = [0.02, 0.02];
/// Amplitudes below the least one by this factor at which a branch that has turned back ends.
const BACK: f64 = 10.0;
/// First harmonics that automatic ones try.
const FEWEST: usize = 5;

/// Which amplitudes are wanted [m √kg].
#[derive(Debug, Clone, PartialEq)]
pub enum Amplitudes {
    /// Exactly these, ascending.
    List(Vec<f64>),
    /// All between two.
    Range(f64, f64),
}

/// What is asked of a nonlinear mode.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeSettings {
    /// Which mode of the structure at rest, from 0.
    pub mode: usize,
    /// Where.
    pub amplitudes: Amplitudes,
    /// Harmonics kept.
    pub harmonics: HarmonicChoice,
    /// Relative error of frequency, damping and shape, for automatic harmonics.
    pub tolerance: f64,
    /// Highest harmonic that automatic ones may reach.
    pub max_harmonics: usize,
    /// Assumed force at mid-range of contacts that never slip.
    pub residual: Residual,
    /// Most points.
    pub most: usize,
}

/// How a branch ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModeEnd {
    /// At the largest amplitude.
    Range,
    /// It turned back to small amplitudes.
    Returned,
    /// No point ahead was found.
    Stalled,
    /// As many points as allowed.
    Points,
    /// The caller ended the analysis.
    Interrupted,
}

/// A nonlinear mode.
#[derive(Debug, Clone)]
pub struct NonlinearMode {
    /// Points along the branch, or at the amplitudes given.
    pub points: Vec<ModePoint>,
    /// Frequency [rad/s] and damping ratio at rest.
    pub linear: [f64; 2],
    /// Whether only odd harmonics were solved for.
    pub half_wave: bool,
    /// Amplitudes at which the branch turns.
    pub turns: Vec<f64>,
    /// How it ended, …
    pub end: ModeEnd,
    /// … and at which amplitude.
    pub end_amplitude: f64,
    /// Products with the tangent.
    pub products: usize,
    /// Where the time went.
    pub profile: Profile,
}

/// The nonlinear mode of a model; its loads but static ones are left out.
///
/// # Errors
/// A mode that does not exist, settings outside their range, a rigid-body motion under static loads.
pub fn nonlinear_mode(
    model: &Model,
    settings: &ModeSettings,
    progress: &Progress<'_>,
) -> Result<NonlinearMode, Error> {
    let start = Instant::now();
    let made = match settings.residual {
        Residual::FromRest => crate::balance::with_history(model)?,
        Residual::Centred | Residual::Value(_) => held_at_rest(model, settings, progress)?,
    };
    let residual = |law: &dyn ContactLaw| {
        let held = made.is_some() && keeps_history(law);
        if held {
            Residual::FromRest
        } else {
            settings.residual
        }
    };
    let residuals = model.laws().iter().map(|law| residual(law.as_ref())).collect();
    let mut walk = Walk::new(made.as_ref().unwrap_or(model), settings, residuals, progress)?;
    let (low, _) = walk.bounds();
    let end = match walk.begin(low) {
        Some(z) => walk.follow(z),
        None if !progress(0.0) => ModeEnd::Interrupted,
        None => ModeEnd::Stalled,
    };
    let end_amplitude = walk.last.map_or(f64::NAN, f64::exp);
    walk.fill_up();
    let mut profile = Profile { total: start.elapsed(), ..walk.profile };
    profile.add(&walk.equations.profile);
    Ok(NonlinearMode {
        points: walk.points,
        linear: [walk.linear.omega, walk.linear.damping / (2.0 * walk.linear.omega)],
        half_wave: walk.equations.harmonics().half_wave(),
        turns: walk.turns,
        end,
        end_amplitude,
        products: walk.equations.products + walk.products,
        profile,
    })
}

/// Whether friction keeps what it had at rest.
fn keeps_history(law: &dyn ContactLaw) -> bool {
    let (displacement, state) = law.beginning();
    law.with_history(&displacement, &state).is_some()
}

/// The model with friction that has its history from the equilibrium about which it vibrates: where a
/// contact slips to one side alone, sliders stay where they are until they are pushed. The assumed
/// residual force is that at rest. Nothing where nothing depends on it.
fn held_at_rest(
    model: &Model,
    settings: &ModeSettings,
    progress: &Progress<'_>,
) -> Result<Option<Model>, Error> {
    if !model.laws().iter().any(|law| keeps_history(law.as_ref())) {
        return Ok(None);
    }
    let settings = ModeSettings { harmonics: HarmonicChoice::Fixed(1), ..settings.clone() };
    let residuals = vec![settings.residual; model.laws().len()];
    let mut walk = Walk::new(model, &settings, residuals, progress)?;
    if walk.equations.harmonics().half_wave() {
        return Ok(None);
    }
    let (low, _) = walk.bounds();
    let Some(mut z) = walk.begin(low + STILL.ln()) else { return Ok(None) };
    // Without the motion.
    let size = z.len();
    z[size - 1] = f64::MIN_POSITIVE.sqrt().ln();
    walk.equations.evaluate(&z, false);
    let slots = walk.equations.harmonics().slots();
    let laws = model.laws().iter().zip(model.points()).enumerate().map(|(index, (law, points))| {
        let means = walk.equations.contact[points.start * slots..points.end * slots].iter();
        let displacement: Vec<f64> = means.step_by(slots).copied().collect();
        let states = law.state_history(walk.equations.motion(index), 2);
        law.with_history(&displacement, &states[..law.state_size()])
            .unwrap_or_else(|| law.with_scaled_forces(1.0))
    });
    model.with_laws(laws.collect()).map(Some)
}

/// A branch on its way.
struct Walk<'a> {
    settings: &'a ModeSettings,
    progress: &'a Progress<'a>,
    equations: ModeEquations<'a>,
    linear: Linear,
    points: Vec<ModePoint>,
    turns: Vec<f64>,
    /// ln a of the last point of the branch.
    last: Option<f64>,
    profile: Profile,
    products: usize,
}

impl<'a> Walk<'a> {
    fn new(
        model: &'a Model,
        settings: &'a ModeSettings,
        residuals: Vec<Residual>,
        progress: &'a Progress<'a>,
    ) -> Result<Self, Error> {
        let kept = match settings.harmonics {
            HarmonicChoice::Fixed(highest) => highest,
            HarmonicChoice::Auto => FEWEST.min(settings.max_harmonics),
        };
        Error::check_order("harmonics", kept, crate::balance::HIGHEST_ORDER)?;
        settings.residual.check()?;
        let odd = model.laws().iter().all(|law| law.is_odd());
        let loaded = model.compliance().forced_harmonics().contains(&0);
        let half_wave = odd && !loaded && settings.residual.is_symmetric();
        let bases = model.modal_bases(4 * settings.max_harmonics.max(kept))?;
        let table = Arc::new(SampleTable::new(Harmonics::new(kept, half_wave)));
        let rest = if half_wave { vec![0.0; bases.at(0).modes()] } else { at_rest(model, &bases)? };
        let mut equations = ModeEquations::new(model, bases, table, residuals, rest, 1.0);
        let linear = linear_mode(&mut equations, settings.mode)?;
        equations.unit = linear.omega;
        Ok(Self {
            settings,
            progress,
            equations,
            linear,
            points: Vec::new(),
            turns: Vec::new(),
            last: None,
            profile: Profile::default(),
            products: 0,
        })
    }

    /// Least and largest ln a that are wanted.
    fn bounds(&self) -> (f64, f64) {
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
    fn begin(&mut self, low: f64) -> Option<Vec<f64>> {
        let mut log = low;
        while log >= low + LEAST_START.ln() {
            if !(self.progress)(0.0) {
                return None;
            }
            let mut z = self.linear.point(&self.equations, log);
            self.equations.accept(&z);
            let start = z.clone();
            let found = self.solve(&mut z, &level(start.len(), log));
            let [omega, shape] = LINEAR;
            let size = z.len();
            let range = self.equations.range(1);
            let along: f64 = z[range.clone()].iter().zip(&start[range]).map(|(a, b)| a * b).sum();
            let near = (z[size - 3] - 1.0).abs() < omega && along > 1.0 - shape;
            if found.is_some() && near {
                self.equations.rebase(&mut z);
                return Some(z);
            }
            log -= std::f64::consts::LN_10;
        }
        None
    }

    /// Follows the branch from its first point.
    fn follow(&mut self, first: Vec<f64>) -> ModeEnd {
        let (low, high) = self.bounds();
        let listed = matches!(self.settings.amplitudes, Amplitudes::List(_));
        let longest = LONGEST[usize::from(listed)];
        let mut z = self.refined(first);
        let mut step = STEPS[0].min(longest);
        let mut way: Vec<f64> = level(z.len(), 0.0).normal;
        if z[z.len() - 1] >= low {
            self.record(&z);
        }
        self.last = z.last().copied();
        loop {
            let size = z.len();
            let log = z[size - 1];
            if log >= high {
                return ModeEnd::Range;
            }
            if log < low - BACK.ln() && way[size - 1] < 0.0 {
                return ModeEnd::Returned;
            }
            if self.points.len() >= self.settings.most {
                return ModeEnd::Points;
            }
            if !(self.progress)(((log - low) / (high - low)).clamp(0.0, 1.0)) {
                return ModeEnd::Interrupted;
            }
            self.equations.accept(&z);
            let Some((ahead, iterations)) = self.advance(&z, &way, &mut step) else {
                return if (self.progress)(0.0) { ModeEnd::Stalled } else { ModeEnd::Interrupted };
            };
            let turned = (ahead[size - 1] - log) * way[size - 1] < 0.0;
            if turned && self.last.is_some() {
                self.turns.push(log.exp());
            }
            way = difference(&ahead, &z);
            let before = std::mem::replace(&mut z, ahead);
            self.last = z.last().copied();
            let more = self.pass(&before, &z);
            if more.len() != z.len() {
                // In more harmonics the way goes on as it came.
                way = self.recast(&way, z.len());
            }
            z = more;
            step = match iterations {
                few if few <= EASY[0] => (1.6 * step).min(longest),
                many if many >= EASY[1] => 0.6 * step,
                _ => step,
            };
        }
    }

    /// The next point by a step along a direction, shortened as far as needed.
    fn advance(&mut self, z: &[f64], way: &[f64], step: &mut f64) -> Option<(Vec<f64>, usize)> {
        let size = z.len();
        let length = norm(way);
        let unit: Vec<f64> = way.iter().map(|w| w / length).collect();
        let next = self.next_stop(z[size - 1]);
        while *step >= STEPS[1] {
            if !(self.progress)(self.share(z[size - 1])) {
                return None;
            }
            let mut ahead: Vec<f64> = z.iter().zip(&unit).map(|(z, u)| z + *step * u).collect();
            // A step that reaches an amplitude asked for ends there.
            let stops = next.filter(|next| ahead[size - 1] >= *next && unit[size - 1] > 0.1);
            let plane = match stops {
                Some(next) => {
                    let share = (next - z[size - 1]) / unit[size - 1];
                    ahead = z.iter().zip(&unit).map(|(z, u)| z + share * u).collect();
                    level(size, next)
                }
                None => {
                    let value = unit.iter().zip(&ahead).map(|(u, z)| u * z).sum();
                    Plane { normal: unit.clone(), value }
                }
            };
            if let Some(iterations) = self.solve(&mut ahead, &plane) {
                if stops.is_some() {
                    ahead[size - 1] = plane.value;
                }
                let came = difference(&ahead, z);
                let along: f64 = came.iter().zip(&unit).map(|(a, b)| a * b).sum();
                let straight = along / norm(&came).max(f64::MIN_POSITIVE);
                let bend = if norm(&came) <= CORNER { 0.0 } else { BEND };
                let shows = self.shows(z, &ahead) || *step <= CORNER;
                if shows && straight > bend && norm(&came) < 3.0 * step.max(CORNER) {
                    return Some((ahead, iterations));
                }
            }
            *step *= 0.4;
        }
        None
    }

    /// Whether two points of a branch that is wanted as a whole are close enough for what is read off
    /// between them: damping rises steeply where contacts begin to slip.
    fn shows(&self, z: &[f64], ahead: &[f64]) -> bool {
        let size = z.len();
        let (low, _) = self.bounds();
        if ahead[size - 1] <= low || matches!(self.settings.amplitudes, Amplitudes::List(_)) {
            return true;
        }
        let [before, after] = [z, ahead].map(|z| z[size - 2].abs());
        (after - before).abs() <= SEEN[0] * before.max(after).max(SEEN[1])
    }

    /// The next ln a above one at which a point is wanted.
    fn next_stop(&self, log: f64) -> Option<f64> {
        let ahead = |stop: &f64| *stop > log + 1e-12;
        match &self.settings.amplitudes {
            Amplitudes::List(values) => values.iter().map(|a| a.ln()).find(ahead),
            Amplitudes::Range(low, high) => [low.ln(), high.ln()].into_iter().find(ahead),
        }
    }

    /// Takes what lies between two points of the branch; returns the second one in as many harmonics as
    /// have been found necessary.
    fn pass(&mut self, before: &[f64], z: &[f64]) -> Vec<f64> {
        let size = z.len();
        let (from, to) = (before[size - 1], z[size - 1]);
        let (low, high) = self.bounds();
        match self.settings.amplitudes.clone() {
            Amplitudes::Range(..) if to >= low && to <= high => {
                let z = self.refined(z.to_vec());
                self.record(&z);
                z
            }
            Amplitudes::List(values) => {
                let mut reached = z.to_vec();
                let known = self.points.len();
                for value in values.iter().skip(known).map(|a| a.ln()) {
                    if !(from < value && value <= to + 1e-12) {
                        continue;
                    }
                    if (value - to).abs() <= 1e-12 {
                        reached = self.refined(z.to_vec());
                        self.record(&reached);
                        continue;
                    }
                    // An arc has gone past it.
                    let share = (value - from) / (to - from);
                    let mut between: Vec<f64> =
                        before.iter().zip(z).map(|(a, b)| a + share * (b - a)).collect();
                    self.equations.accept(before);
                    if self.solve(&mut between, &level(size, value)).is_some() {
                        self.record(&between);
                    }
                }
                reached
            }
            Amplitudes::Range(..) => z.to_vec(),
        }
    }

    /// A point in as many harmonics as the tolerance asks for.
    fn refined(&mut self, mut z: Vec<f64>) -> Vec<f64> {
        if self.settings.harmonics != HarmonicChoice::Auto {
            return z;
        }
        loop {
            let kept = self.equations.harmonics().highest();
            if kept >= self.settings.max_harmonics || self.error(&z) <= self.settings.tolerance {
                return z;
            }
            let more = (kept + 2 + kept / 2).min(self.settings.max_harmonics);
            let mut equations = self.in_harmonics(more);
            let mut recast = recast(&z, &self.equations, &equations);
            equations.accept(&recast);
            let plane = level(recast.len(), recast[recast.len() - 1]);
            let progress = self.progress;
            if equations.solve(&mut recast, &plane, &|| progress(0.0)).is_none() {
                // It stays in the harmonics that it has, and says so.
                self.products += equations.products;
                return z;
            }
            self.profile.add(&self.equations.profile);
            self.products += self.equations.products;
            self.equations = equations;
            z = recast;
        }
    }

    /// The equations in other harmonics.
    fn in_harmonics(&self, highest: usize) -> ModeEquations<'a> {
        let harmonics = Harmonics::new(highest, self.equations.harmonics().half_wave());
        self.equations.with_table(Arc::new(SampleTable::new(harmonics)))
    }

    /// Change of all unknowns that a balance in more harmonics would bring, at the same amplitude.
    fn extended(&mut self, z: &[f64]) -> Option<(ModeEquations<'a>, Vec<f64>, Vec<f64>)> {
        let kept = self.equations.harmonics().highest();
        let start = Instant::now();
        let mut equations = self.in_harmonics(2 * kept + 3);
        let recast = recast(z, &self.equations, &equations);
        equations.accept(&recast);
        let residual = equations.evaluate(&recast, true);
        let plane = level(recast.len(), recast[recast.len() - 1]);
        let step = equations.step(&recast, &residual, &plane);
        self.products += equations.products;
        self.profile.evaluations += 1;
        self.profile.estimate += start.elapsed();
        step.map(|step| (equations, recast, step))
    }

    /// Largest relative error of frequency, damping and shape that truncation leaves.
    fn error(&mut self, z: &[f64]) -> f64 {
        let Some((_, recast, step)) = self.extended(z) else { return f64::INFINITY };
        let size = recast.len();
        let [omega, damping] = relative(&recast, &step);
        norm(&step[..size - 3]).max(omega).max(damping)
    }

    fn record(&mut self, z: &[f64]) {
        let start = Instant::now();
        // What the equations were evaluated at last may be another point.
        let residual = norm(&self.equations.evaluate(z, false));
        let mut point = ModePoint::new(&self.equations, &self.linear, z);
        point.response.residual = residual;
        if let Some((equations, recast, step)) = self.extended(z) {
            point.errors = relative(&recast, &step);
            point.response.error_estimate = point.changes(&equations, &recast, &step);
            let size = recast.len();
            let worst = point.errors[0].max(point.errors[1]).max(norm(&step[..size - 3]));
            let missed = worst > self.settings.tolerance;
            if missed && self.settings.harmonics == HarmonicChoice::Auto {
                point.response.status = PointStatus::HarmonicsLimit;
            }
        }
        self.profile.recovery += start.elapsed();
        self.points.push(point);
    }

    /// Says of amplitudes that were not reached that they were not.
    fn fill_up(&mut self) {
        let Amplitudes::List(values) = &self.settings.amplitudes else { return };
        let compliance = self.equations.model.compliance();
        for &value in values.iter().skip(self.points.len()) {
            self.points.push(ModePoint::missing(compliance.dofs(), compliance.contacts(), value));
        }
    }

    fn solve(&mut self, z: &mut [f64], plane: &Plane) -> Option<usize> {
        let (progress, share) = (self.progress, self.share(z[z.len() - 1]));
        self.equations.solve(z, plane, &|| progress(share))
    }

    fn share(&self, log: f64) -> f64 {
        let (low, high) = self.bounds();
        ((log - low) / (high - low).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    }

    /// A direction that was in fewer harmonics.
    fn recast(&self, way: &[f64], size: usize) -> Vec<f64> {
        let half_wave = self.equations.harmonics().half_wave();
        let slots = (size - 3) / self.equations.modes();
        let highest = if half_wave { slots - 1 } else { (slots - 1) / 2 };
        recast(way, &self.in_harmonics(highest), &self.equations)
    }
}

/// The condition that the amplitude is given.
fn level(size: usize, log: f64) -> Plane {
    let mut normal = vec![0.0; size];
    normal[size - 1] = 1.0;
    Plane { normal, value: log }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// Relative changes of frequency and damping by a step.
fn relative(z: &[f64], step: &[f64]) -> [f64; 2] {
    let size = z.len();
    let omega = (step[size - 3] / z[size - 3]).abs();
    // ζ = ξ/(2ω), which may vanish; below a millionth it counts as none.
    let damping = step[size - 2].abs() / z[size - 2].abs().max(1e-6);
    [omega, damping + omega]
}

/// A point in other harmonics: common ones are kept, new ones are zero.
fn recast(z: &[f64], from: &ModeEquations<'_>, to: &ModeEquations<'_>) -> Vec<f64> {
    let mut out = vec![0.0; to.unknowns()];
    for order in from.harmonics().orders() {
        if to.harmonics().slot(order).is_some() {
            out[to.range(order)].copy_from_slice(&z[from.range(order)]);
        }
    }
    let size = out.len();
    out[size - 3..].copy_from_slice(&z[z.len() - 3..]);
    out
}
