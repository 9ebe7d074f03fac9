//! The harmonics of a nonlinear mode: as many as its tolerance asks for, and what the rest could change.

use super::equations::ModeEquations;
use super::point::ModePoint;
use super::settings::ModeSettings;
use crate::balance::HarmonicChoice;
use crate::fourier::{Harmonics, SampleTable};
use crate::solve::{at_parameter, largest, norm, Curve as _};
use crate::timing::Profile;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// First harmonics that automatic ones try, at most.
const FEWEST: usize = 5;

/// Newton iterations in more harmonics.
const ITERATIONS: usize = 20;

/// Share of the tolerance below which an error is generous, …
const GENEROUS: f64 = 0.1;
/// … and how many points with such errors in a row let the next one have fewer harmonics.
const STEADY: usize = 5;

/// Relative residual of the linear equations of an error estimate.
const ESTIMATE: f64 = 1e-2;

/// The equations in the harmonics kept, and in more than twice as many.
pub(super) struct Truncation<'a> {
    pub(super) equations: ModeEquations<'a>,
    finer: Option<ModeEquations<'a>>,
    /// Points in a row with generous errors.
    generous: usize,
    /// Whether harmonics have been given up, and those that were asked for after that: so many stay.
    eased: bool,
    lowest: usize,
    /// Highest harmonic that any point has had.
    pub(super) highest: usize,
    /// Work in harmonics that have been left.
    profile: Profile,
    estimate: Duration,
}

/// A Newton step in more harmonics, at the same amplitude, from a point there.
pub(super) struct Step {
    z: Vec<f64>,
    step: Vec<f64>,
    /// Least damping that changes count against.
    viscous: f64,
}

impl Step {
    /// Relative changes of frequency and damping.
    pub(super) fn relative(&self) -> [f64; 2] {
        self.changes(0.0)
    }

    /// The same, of damping relative to no less than this.
    fn changes(&self, least: f64) -> [f64; 2] {
        let (z, step, size) = (&self.z, &self.step, self.z.len());
        let omega = (step[size - 3] / z[size - 3]).abs();
        // ζ = ξ/(2ω), which may vanish; below a millionth it counts as none.
        let damping = step[size - 2].abs() / z[size - 2].abs().max(least).max(1e-6);
        [omega, damping + omega]
    }

    /// Largest relative change of frequency, damping and shape, of damping relative to its viscous part where
    /// that is more; infinite if one is not a number.
    pub(super) fn error(&self) -> f64 {
        let [omega, damping] = self.changes(self.viscous);
        let changes = [norm(&self.step[..self.z.len() - 3]), omega, damping];
        largest(changes.into_iter())
    }
}

/// First harmonics that automatic ones try.
pub(super) fn fewest(settings: &ModeSettings) -> usize {
    FEWEST.min(settings.max_harmonics)
}

/// The harmonics that they try after these.
fn above(order: usize) -> usize {
    order + 2 + order / 2
}

impl<'a> Truncation<'a> {
    /// The harmonics of these equations, and never fewer than `lowest`.
    pub(super) fn new(equations: ModeEquations<'a>, lowest: usize) -> Self {
        let highest = equations.harmonics().highest();
        Self {
            equations,
            finer: None,
            generous: 0,
            eased: false,
            lowest,
            highest,
            profile: Profile::default(),
            estimate: Duration::ZERO,
        }
    }

    /// A point in as many harmonics as the tolerance asks for, and what more could change.
    pub(super) fn refined(
        &mut self,
        mut z: Vec<f64>,
        settings: &ModeSettings,
    ) -> (Vec<f64>, Option<Step>) {
        loop {
            let step = self.step(&z);
            let kept = self.equations.harmonics().highest();
            let enough = step.as_ref().is_some_and(|step| step.error() <= settings.tolerance);
            let fixed = settings.harmonics != HarmonicChoice::Auto;
            if fixed || enough || kept >= settings.max_harmonics {
                return (z, step);
            }
            let mut equations = self.in_harmonics(above(kept).min(settings.max_harmonics));
            let recast = equations.recast(&z, equations.size());
            equations.hold(&recast);
            let log = recast[recast.len() - 1];
            let found = at_parameter(&mut equations, &recast, log, ITERATIONS);
            let Some((finer, _)) = found else {
                // It stays in the harmonics that it has, and says so.
                self.leave(&equations);
                return (z, step);
            };
            self.generous = 0;
            self.highest = self.highest.max(equations.harmonics().highest());
            if self.eased {
                self.lowest = equations.harmonics().highest();
            }
            z = finer;
            let left = std::mem::replace(&mut self.equations, equations);
            self.leave(&left);
        }
    }

    /// Lets the next point have fewer harmonics, where those kept are far more than the tolerance
    /// asks for.
    pub(super) fn ease(&mut self, step: &Step, settings: &ModeSettings) {
        let fixed = settings.harmonics != HarmonicChoice::Auto;
        let generous = step.error() <= GENEROUS * settings.tolerance;
        self.generous = if generous { self.generous + 1 } else { 0 };
        if fixed || self.generous < STEADY {
            return;
        }
        let kept = self.equations.harmonics().highest();
        let levels = std::iter::successors(Some(fewest(settings)), |order| Some(above(*order)));
        if let Some(fewer) = levels.take_while(|order| *order < kept).last() {
            if fewer < self.lowest {
                return;
            }
            (self.generous, self.eased) = (0, true);
            let equations = self.in_harmonics(fewer);
            let left = std::mem::replace(&mut self.equations, equations);
            self.leave(&left);
        }
    }

    /// The Newton step that a balance in more harmonics would take.
    pub(super) fn step(&mut self, z: &[f64]) -> Option<Step> {
        let start = Instant::now();
        let highest = 2 * self.equations.harmonics().highest() + 3;
        let known = self.finer.take().filter(|own| own.harmonics().highest() == highest);
        let mut equations = known.unwrap_or_else(|| self.in_harmonics(highest));
        equations.linear = ESTIMATE;
        equations.rest.clone_from(&self.equations.rest);
        let z = equations.recast(z, equations.size());
        equations.hold(&z);
        let mut right: Vec<f64> = equations.evaluate(&z).iter().map(|row| -row).collect();
        right.push(0.0);
        let mut border = vec![0.0; z.len()];
        border[z.len() - 1] = 1.0;
        let weights = equations.weights(&z);
        let found = equations.solve_bordered(&z, &border, &right, &weights);
        let viscous = equations.viscous_feed(&z);
        self.finer = Some(equations);
        self.estimate += start.elapsed();
        found.map(|(step, _)| Step { z, step, viscous })
    }

    /// Sum over all harmonics of the change of every DOF of a point by a step \[m\].
    pub(super) fn changes(&self, point: &ModePoint, step: &Step) -> Vec<f64> {
        let unknown = || vec![f64::NAN; point.response.error_estimate.len()];
        let of = |finer: &ModeEquations<'_>| point.changes(finer, &step.z, &step.step);
        self.finer.as_ref().map_or_else(unknown, of)
    }

    /// The equations in other harmonics.
    fn in_harmonics(&self, highest: usize) -> ModeEquations<'a> {
        let harmonics = Harmonics::new(highest, self.equations.harmonics().half_wave());
        self.equations.with_table(Arc::new(SampleTable::new(harmonics)))
    }

    fn leave(&mut self, equations: &ModeEquations<'_>) {
        self.profile.add(&equations.profile);
    }

    /// Work in all harmonics.
    pub(super) fn effort(mut self) -> Profile {
        if let Some(finer) = self.finer.take() {
            let Profile { evaluations, factorisations, products, .. } = finer.profile;
            let own = Profile { evaluations, factorisations, products, ..Profile::default() };
            self.profile.add(&own);
        }
        self.profile.add(&self.equations.profile);
        self.profile.estimate += self.estimate;
        self.profile
    }
}

impl ModeEquations<'_> {
    /// A point or a direction in these harmonics, of so many unknowns: common ones are kept, new ones
    /// are zero.
    pub(super) fn recast(&self, z: &[f64], size: usize) -> Vec<f64> {
        let slots = (z.len() - 3) / self.modes();
        let half_wave = self.harmonics().half_wave();
        let highest = if half_wave { slots - 1 } else { (slots - 1) / 2 };
        let from = Harmonics::new(highest, half_wave);
        let mut out = vec![0.0; size];
        for order in self.harmonics().orders() {
            let (Some(slot), range) = (from.slot(order), self.range(order)) else { continue };
            let start = self.modes() * slot;
            let length = range.len();
            out[range].copy_from_slice(&z[start..start + length]);
        }
        out[size - 3..].copy_from_slice(&z[z.len() - 3..]);
        out
    }
}
