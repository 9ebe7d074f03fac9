//! Starts by fewer harmonics.
//!
//! Where contacts begin to slip, open or close between two points of a sweep, no extrapolation leads
//! close to the next one, and Newton's method takes most of its steps to find the new states. Few
//! harmonics know them, too, at a small part of the price.

use super::attempts::is_bounded;
use super::condensed::Condensed;
use super::forced::ForcedBalance;
use super::modal_work::is_large;
use super::neighbour::Rough;
use super::settings::{Method, Resolution};
use super::solution::Point;
use super::unknowns::Unknowns;
use crate::fourier::Harmonics;
use crate::solve::{newton, NewtonSettings, Outcome, System as _};
use crate::Error;

/// Harmonics over those of a rough start: its law costs a fifth of the whole one, its linear equations
/// a thirtieth.
const COARSER: usize = 3;
/// From so many harmonics on a rough start is worth its price.
const WORTHWHILE: usize = 19;
/// Relative error at which a rough start is left: fewer harmonics are no nearer to the solution.
const ROUGH: NewtonSettings = NewtonSettings { tolerance: 1e-3, max_iterations: 20 };
/// A first step so small, relative to the motion: the extrapolation is as good.
const NEAR: f64 = 1e-2;
/// Solutions of fewer harmonics from which a point is tried: where two do not lead up to it, the others hardly do.
const MOST_TRIES: usize = 2;
/// Frequencies aside from which a point is tried, relative to its own: far from it contacts stick, …
const ASIDE: [f64; 6] = [0.02, -0.02, 0.08, -0.08, 0.3, -0.3];
/// … and the longest and the shortest step back.
const STEPS: [f64; 2] = [1e-2, 1e-4];
/// Points on such ways that are solved at most.
const MOST_ASIDE: usize = 400;

impl ForcedBalance<'_> {
    /// Whether a point with harmonics up to `order` may begin with an exact orbit: there is one motion alone.
    pub(super) fn may_begin_with_orbit(&self, order: usize) -> bool {
        let newton = self.settings.method == Method::Newton;
        newton && order >= WORTHWHILE && self.is_monotone() && self.rescue.is_some()
    }

    /// Fewer harmonics, where they cost a small part only and leave out no load.
    pub(super) fn coarser(&mut self, fine: Resolution) -> Option<Resolution> {
        let harmonics = fine.harmonics / COARSER;
        let table = self.table(fine.harmonics);
        let loads = self.model.compliance().forced_harmonics().last().copied().unwrap_or(1);
        let suits = self.settings.method == Method::Newton
            && fine.harmonics >= WORTHWHILE
            && harmonics >= loads
            && !is_large(self.model.compliance(), table.harmonics());
        suits.then_some(Resolution { harmonics, ..fine })
    }

    /// What fewer harmonics make of the extrapolation to a point.
    pub(super) fn rough_start(
        &mut self,
        resolution: Resolution,
        omega: f64,
        start: &Unknowns,
    ) -> Result<Rough, Error> {
        let climbs = start.harmonics.highest() < resolution.harmonics;
        let Some(coarse) = self.coarser(resolution).filter(|_| !climbs) else {
            return Ok(Rough::Near);
        };
        let table = self.table(coarse.harmonics);
        let model = self.evaluated(coarse.samples)?;
        let interrupted = self.interruption();
        let mut equations = Condensed::new(model, &table, self.settings.residual, false);
        equations.watch(&interrupted);
        equations.granted = self.left();
        let mut x = start.recast(table.harmonics());
        let far = equations.set_omega(omega).is_ok() && {
            let (mut defect, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
            equations.residual(&x, &mut defect);
            equations.solve(&defect, &mut step) && equations.relative_size(&step, &x) > NEAR
        };
        let again = far && self.neighbour.is_lost_again();
        let found =
            far && !again && newton(&mut equations, &mut x, ROUGH).outcome == Outcome::Converged;
        self.add_profile(&equations.profile);
        if found {
            return Ok(Rough::Found(start.with_lower(table.harmonics(), &x)));
        }
        let lost = far && !again && self.favours_orbit(omega, resolution.harmonics);
        if lost {
            self.neighbour.lose();
        }
        Ok(if lost || again { Rough::Lost } else { Rough::Near })
    }
}

impl ForcedBalance<'_> {
    /// A point that Newton's method does not reach from the stuck response: from half as many harmonics,
    /// or half of those, whichever are solved from there, and back up. Whether any were solved is told, too.
    pub(super) fn solve_by_fewer(
        &mut self,
        fine: Resolution,
        omega: f64,
    ) -> Result<(Option<Point>, bool), Error> {
        let least = self.model.compliance().forced_harmonics().last().copied().unwrap_or(1).max(1);
        let halves = std::iter::successors(Some(fine.harmonics), |highest| Some(highest / 2));
        let mut levels = vec![fine.harmonics];
        let mut tries = 0;
        for highest in halves.skip(1).take_while(|&highest| highest >= least) {
            levels.push(highest);
            let coarse = Resolution { harmonics: highest, ..fine };
            let mut start = self.found_by_newton(coarse, omega, None)?;
            tries += usize::from(start.is_some());
            for &harmonics in levels.iter().rev().skip(1) {
                let Some(below) = start else { break };
                let above = Resolution { harmonics, ..fine };
                start = self.found_by_newton(above, omega, Some(&below))?;
            }
            if let Some(start) = start {
                let point = self.attempt(fine, omega, Some(&start))?;
                return Ok((Some(point).filter(Point::is_solved), true));
            }
            if tries == MOST_TRIES {
                break;
            }
        }
        Ok((None, tries > 0))
    }

    /// What Newton's method alone finds from a start, or the stuck response, if anything.
    fn found_by_newton(
        &mut self,
        at: Resolution,
        omega: f64,
        start: Option<&Unknowns>,
    ) -> Result<Option<Unknowns>, Error> {
        let table = self.table(at.harmonics);
        let model = self.evaluated(at.samples)?;
        let interrupted = self.interruption();
        let mut equations = Condensed::new(model, &table, self.settings.residual, false);
        equations.watch(&interrupted);
        equations.granted = self.left();
        if equations.set_omega(omega).is_err() {
            return Ok(None);
        }
        let mut x = start.map_or_else(
            || equations.stuck_response().to_vec(),
            |start| start.recast(table.harmonics()),
        );
        let outcome = newton(&mut equations, &mut x, self.settings.newton).outcome;
        let found = outcome == Outcome::Converged && is_bounded(&x, equations.stuck_response());
        self.add_profile(&equations.profile);
        let harmonics = table.harmonics().clone();
        Ok(found.then_some(Unknowns { harmonics, values: x }))
    }

    /// A point that Newton's method does not reach from the stuck response: from a frequency aside, which it
    /// does reach from there, and step by step back.
    pub(super) fn solve_from_aside(
        &mut self,
        at: Resolution,
        omega: f64,
    ) -> Result<Option<Point>, Error> {
        let mut solves = 0;
        for share in ASIDE {
            let mut here = (1.0 + share) * omega;
            let mut step = share.clamp(-STEPS[0], STEPS[0]) * omega;
            let mut start = self.found_by_newton(at, here, None)?;
            while let Some(known) = start.as_ref().filter(|_| here != omega) {
                solves += 1;
                if solves > MOST_ASIDE || self.is_spent() || self.is_ended() {
                    return Ok(None);
                }
                if step.abs() < STEPS[1] * omega {
                    start = None;
                    break;
                }
                let next = if (here - omega).abs() <= step.abs() { omega } else { here - step };
                if let Some(found) = self.found_by_newton(at, next, Some(known))? {
                    (here, start) = (next, Some(found));
                } else {
                    step *= 0.5;
                }
            }
            if start.is_some() {
                let point = self.attempt(at, omega, start.as_ref())?;
                return Ok(Some(point).filter(Point::is_solved));
            }
        }
        Ok(None)
    }
}

impl Unknowns {
    /// The same series with other coefficients of some of the harmonics.
    fn with_lower(&self, harmonics: &Harmonics, values: &[f64]) -> Self {
        let lower = Self { harmonics: harmonics.clone(), values: values.to_vec() };
        let mut changed = lower.recast(&self.harmonics);
        let (slots, width) = (self.harmonics.slots(), harmonics.slots());
        for (changed, own) in changed.chunks_exact_mut(slots).zip(self.values.chunks_exact(slots)) {
            changed[width..].copy_from_slice(&own[width..]);
        }
        Self { harmonics: self.harmonics.clone(), values: changed }
    }
}
