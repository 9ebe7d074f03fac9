//! Where the search for an exact orbit begins: the state of a neighbour, or of a harmonic balance.

use super::periodic::PeriodicOrbits;
use super::shooting::{Shooting, STEPS};
use super::start::{later, start_of};
use crate::balance::{ForcedBalance, HarmonicChoice, PointStatus, Settings};
use crate::motion::State;
use crate::solve::{norm, NewtonSettings, System as _};

/// Harmonics of the balance that a cold start comes from: at least, at most, and units of the fastest rate
/// per period for each. Where passes along the orbit are long, more harmonics save some of them.
const START_HARMONICS: [usize; 2] = [9, 21];
const PER_HARMONIC: f64 = 100.0;
/// Closing error, relative to the motion, of a start that needs no better one.
const NEAR: f64 = 1e-4;
/// Share of a neighbour's error that a balance leaves where the next neighbour need not be asked, and its own
/// error up to which that goes on.
const FAR_BETTER: f64 = 1e-2;
const WELL: f64 = 1e-3;
/// Work that a start may take of orbits that are granted little, as reckoned \[ns\].
const OF_START: f64 = 2e9;
/// Of a balance where one motion alone is possible: the harmonics it lacks count for more than its error. Elsewhere
/// sliders keep where it leaves them.
const BALANCED: NewtonSettings = NewtonSettings { tolerance: 1e-4, max_iterations: 100 };

impl PeriodicOrbits<'_> {
    /// A start, or that of harmonic balance if it is better: where but one motion is possible, and each
    /// further step of Newton's method is dear. Behind a point at which it was, neighbours are not asked.
    pub(super) fn nearer_start(
        &mut self,
        shooting: &mut Shooting<'_>,
        omega: f64,
        neighbour: &State,
    ) -> Vec<f64> {
        let misses = |shooting: &mut Shooting<'_>, y: &[f64]| {
            let mut residual = vec![0.0; y.len()];
            shooting.residual(y, &mut residual);
            norm(&residual) / norm(y)
        };
        let y = shooting.unknowns(neighbour);
        let own = if self.beyond { f64::INFINITY } else { misses(shooting, &y) };
        let near = own <= NEAR || (!self.beyond && shooting.price() < 1.0);
        if near || !self.plan.unique {
            return y;
        }
        let other = shooting.unknowns(&self.harmonic_start(omega, 0.0));
        let balanced = misses(shooting, &other);
        if balanced < own {
            self.beyond = if self.beyond {
                balanced <= WELL
            } else {
                balanced <= NEAR || balanced <= FAR_BETTER * own.min(1.0)
            };
            other
        } else {
            y
        }
    }

    /// The state of a harmonic balance of low order at an angle of the period; rest where it
    /// has none.
    pub(super) fn harmonic_start(&mut self, omega: f64, angle: f64) -> State {
        let rest = State::rest(&self.plan.system);
        let forced = self.plan.model.compliance().forced_harmonics();
        let [least, most] = START_HARMONICS;
        let turn = std::f64::consts::TAU * self.plan.system.rate(omega) / omega;
        let suited = ((turn / PER_HARMONIC) as usize).clamp(least, most);
        let highest = forced.last().copied().unwrap_or(1).max(suited);
        let settings = Settings {
            harmonics: HarmonicChoice::Fixed(highest),
            max_harmonics: highest,
            residual: self.plan.settings.residual,
            newton: if self.plan.unique { BALANCED } else { NewtonSettings::default() },
            ..Settings::default()
        };
        let Ok(mut balance) = ForcedBalance::new(self.plan.model, settings, &self.everywhere)
        else {
            return rest;
        };
        balance = balance.watched(self.progress).unjudged();
        if self.plan.granted < STEPS {
            balance = balance.granting(OF_START);
        }
        let given = std::mem::take(&mut self.given);
        let known = self.balanced.take().filter(|_| self.plan.unique || given);
        let found = balance.solve(omega, known.as_ref());
        self.balanced = found.as_ref().ok().and_then(|point| point.unknowns().cloned());
        let half_wave = balance.half_wave();
        self.profile.work += balance.into_profile().work;
        match found {
            Ok(point) if point.status == PointStatus::Converged => start_of(
                self.plan.with_history.as_deref().unwrap_or(self.plan.model),
                &self.plan.system,
                self.plan.settings.residual,
                &later(&point, angle),
                half_wave,
            ),
            _ => rest,
        }
    }
}
