//! Whether two neighbouring points of a sweep lie on one branch, or the sweep has jumped between them.
//!
//! Where solutions are not unique Newton's method may lead to another branch. The way between two
//! points is explained if the extrapolation that the new point was found from has told it, or if the
//! tangents at both points do. Contacts that begin to slip bend the curve within little of the way:
//! points between the two divide it, there where the tangents meet, until they leave little of it
//! unexplained. What is left is followed by arclength, to where the curve first meets the new
//! frequency: that solution is taken. If the curve has turned back before, the sweep jumps.
//!
//! All that takes no more work than a multiple of what the points of the sweep have taken themselves. Of a point
//! that it does not suffice for it is not known whether it lies on the branch, which the point says.

use super::branch::STEPS;
use super::forced_curve::ForcedCurve;
use crate::balance::condensed::Condensed;
use crate::balance::evaluation::Evaluated;
use crate::balance::forced::ForcedBalance;
use crate::balance::settings::Resolution;
use crate::balance::solution::{Point, PointStatus};
use crate::balance::tangent::{distance, Tangent, UNEXPLAINED};
use crate::balance::unknowns::Unknowns;
use crate::contact::Residual;
use crate::fourier::{Harmonics, SampleTable};
use crate::solve::{between, newton, Advance, Continuation, NewtonSettings, Outcome, System as _};
use crate::timing::Profile;
use crate::Error;

/// Distance, relative to the motion, below which nothing has to be explained.
const CLOSE: f64 = 1e-5;
/// Part of the way by which harmonics that are left out may move its ends.
const MOVED: f64 = 0.1;
/// A piece of the way that is no longer than this part of it may be left.
const PIECE: f64 = 0.02;
/// Points that may divide the way.
const DIVISIONS: usize = 12;
/// A piece of the frequencies so short, …
const SUDDEN: f64 = 1e-3;
/// … with so much of the way, holds a jump.
const LEAP: f64 = 0.2;
/// Newton's method between two points: they say where the curve goes, and are not kept.
const BETWEEN: NewtonSettings = NewtonSettings { tolerance: 1e-7, max_iterations: 12 };
/// Newton iterations along a curve from one frequency to the next: over a longer way, or one with
/// more corners, a sweep that coarse does not say which branch it is on.
const MOST: usize = 150;
/// Distance of two solutions that are the same.
const SAME: f64 = 1e-6;
/// Where a branch leads.
enum Reached {
    /// To the same solution.
    Same,
    /// To another one, without a turn on the way or with some.
    Other(Unknowns, bool),
    /// Not known, but whether it has turned back before it met the new frequency: what was found there
    /// lies behind that turn.
    Lost(bool),
}

impl ForcedBalance<'_> {
    /// Lets looks between points take a multiple of what has been done since so much work had been.
    pub(super) fn earn_looks(&mut self, before: f64) {
        self.looks.points += self.profile.work - before;
    }

    /// Replaces a new point by that of the branch of the last one if Newton's method has left it or
    /// found none, and says so of a point that lies behind a turn, or that may. `guess` is what the new point was
    /// found from. A point whose branch is not known because the analysis is to end is none.
    pub(super) fn stay_on_branch(
        &mut self,
        last: &Point,
        guess: Option<&Unknowns>,
        point: &mut Point,
    ) -> Result<(), Error> {
        let failed = matches!(
            point.status,
            PointStatus::Stalled
                | PointStatus::Singular
                | PointStatus::Free
                | PointStatus::History
                | PointStatus::WorkLimit
        );
        if !last.is_solved() || !(point.is_solved() || failed) || last.omega == point.omega {
            return Ok(());
        }
        if point.is_solved() && foretold(last, guess, point) {
            return Ok(());
        }
        let before = self.profile.work;
        let reached = self.reached(last, point, before + self.looks.left())?;
        self.looks.taken += self.profile.work - before;
        match reached {
            Reached::Other(start, turned) => {
                let before = self.profile.work;
                let other = self.solve(point.omega, Some(&start))?;
                self.earn_looks(before);
                if other.is_solved() {
                    *point = other;
                }
                point.jump = turned && point.is_solved();
            }
            Reached::Lost(turned) => {
                point.jump = turned && point.is_solved();
                point.astray = !turned && point.is_solved();
            }
            Reached::Same => {}
        }
        if self.is_ended() {
            *point = self.not_computed(point.omega);
        }
        Ok(())
    }

    /// Where the branch of the last point leads, as far as that is known by when all work is so much.
    fn reached(&mut self, last: &Point, point: &Point, end: f64) -> Result<Reached, Error> {
        let solved = point.is_solved();
        let finer = last.resolution().or_finer(point.resolution());
        let resolution = if solved { finer } else { last.resolution() };
        let (Some(known), found) = (last.unknowns(), point.unknowns().filter(|_| solved)) else {
            return Ok(Reached::Lost(false));
        };
        let (from, to) = ((known, last.omega), found.map(|found| (found, point.omega)));
        if let (Some(coarse), Some(to)) = (self.coarser(resolution), to) {
            if let Told::Whole = self.told(coarse, from, to, end)? {
                return Ok(Reached::Same);
            }
        }
        let table = self.table(resolution.harmonics);
        let mut start = at(table.harmonics(), from);
        if let Some(to) = to {
            match self.told(resolution, from, to, end)? {
                Told::Whole => return Ok(Reached::Same),
                Told::UpTo(reached) => start = reached,
                Told::Nothing => {}
            }
        }
        let to = to.map(|to| at(table.harmonics(), to));
        let model = self.evaluated(resolution.samples)?;
        let ask = self.interruption();
        let mut curve = ForcedCurve::new(model, &table, self.settings.residual, &ask);
        curve.granted = end - self.profile.work;
        let reached = followed(&mut curve, &start, to.as_deref(), point.omega);
        self.add_profile(&curve.profile);
        Ok(reached)
    }

    /// How much of the way between two solutions tangents tell. In fewer harmonics than those that
    /// were solved for it has ends of its own, which have to be close.
    fn told(
        &mut self,
        resolution: Resolution,
        from: (&Unknowns, f64),
        to: (&Unknowns, f64),
        end: f64,
    ) -> Result<Told, Error> {
        let table = self.table(resolution.harmonics);
        let model = self.evaluated(resolution.samples)?;
        let (residual, granted) = (self.settings.residual, end - self.profile.work);
        let profile = Profile::default();
        let mut way = Way { model: &model, table: &table, residual, resolution, granted, profile };
        let known = self.tangent.take().filter(|known| known.is(resolution, from.1));
        let fewer = |of: &Unknowns| of.harmonics.highest() > resolution.harmonics;
        let cut = fewer(from.0) || fewer(to.0);
        let (from, to) = (at(table.harmonics(), from), at(table.harmonics(), to));
        let length = distance(&from, &to);
        if length < CLOSE {
            return Ok(Told::Whole);
        }
        let before = known.or_else(|| way.end(&from, cut, length));
        let after = before.as_ref().and_then(|_| way.end(&to, cut, length));
        let told = match (before, after) {
            (Some(before), Some(after)) => {
                let kept = after.clone();
                match way.explained(before, after) {
                    Ok(()) => {
                        self.tangent = Some(kept);
                        Told::Whole
                    }
                    Err(reached) => Told::UpTo(reached),
                }
            }
            _ => Told::Nothing,
        };
        self.add_profile(&way.profile);
        Ok(told)
    }
}

/// What tangents tell of the way between two solutions.
enum Told {
    Whole,
    UpTo(Vec<f64>),
    Nothing,
}

/// A solution in other harmonics, with its frequency behind it.
fn at(harmonics: &Harmonics, (unknowns, omega): (&Unknowns, f64)) -> Vec<f64> {
    let mut z = unknowns.recast(harmonics);
    z.push(omega);
    z
}

/// Whether the extrapolation that led to a new point has told the way to it.
fn foretold(last: &Point, guess: Option<&Unknowns>, point: &Point) -> bool {
    let (Some(guess), Some(from), Some(to)) = (guess, last.unknowns(), point.unknowns()) else {
        return false;
    };
    let harmonics = if from.harmonics.highest() > to.harmonics.highest() {
        &from.harmonics
    } else {
        &to.harmonics
    };
    let [guess, from, to] =
        [(guess, point.omega), (from, last.omega), (to, point.omega)].map(|one| at(harmonics, one));
    distance(&to, &guess) < UNEXPLAINED * distance(&to, &from)
}

/// The way between two points at one resolution.
struct Way<'a> {
    model: &'a Evaluated<'a>,
    table: &'a SampleTable,
    residual: Residual,
    resolution: Resolution,
    /// Work that it may take.
    granted: f64,
    profile: Profile,
}

impl Way<'_> {
    /// The equations at a frequency; nothing once all work is done.
    fn equations(&self, omega: f64) -> Option<Condensed<'_>> {
        let granted = self.granted - self.profile.work;
        let mut equations = Condensed::of_curve(self.model.clone(), self.table, self.residual);
        equations.granted = granted;
        equations.set_omega(omega).ok().filter(|()| granted > 0.0)?;
        Some(equations)
    }

    /// The tangent at an end of the way; with harmonics cut off at the solution close to it.
    fn end(&mut self, z: &[f64], cut: bool, length: f64) -> Option<Tangent> {
        let (omega, u) = z.split_last()?;
        let end = self.tangent(*omega, u.to_vec(), cut)?;
        (!cut || distance(z, &end.z) < MOVED * length).then_some(end)
    }

    /// The tangent at a motion, or at the solution that it leads to.
    fn tangent(&mut self, omega: f64, mut z: Vec<f64>, solve: bool) -> Option<Tangent> {
        let mut equations = self.equations(omega)?;
        let solved =
            !solve || newton(&mut equations, &mut z, BETWEEN).outcome == Outcome::Converged;
        let rate = solved.then(|| {
            equations.residual(&z, &mut vec![0.0; z.len()]);
            rate(&mut equations)
        });
        let profile = equations.profile;
        self.profile.add(&profile);
        z.push(omega);
        Some(Tangent { resolution: self.resolution, z, rate: rate?? })
    }

    /// The point between two others where their tangents meet.
    fn between(&mut self, from: &Tangent, to: &Tangent) -> Option<Tangent> {
        let (share, step) = (from.meets(to), to.omega() - from.omega());
        let omega = from.omega() + share * step;
        let ahead = from.ahead(share * step).zip(to.ahead((share - 1.0) * step));
        let z = ahead.map(|(a, b)| share * b + (1.0 - share) * a).collect();
        self.tangent(omega, z, true)
    }

    /// Whether tangents explain the way between two points, divided where they do not; if not, how
    /// far they do.
    fn explained(&mut self, from: Tangent, to: Tangent) -> Result<(), Vec<f64>> {
        let (way, step) = (distance(&from.z, &to.z), to.omega() - from.omega());
        let (mut from, mut ahead, mut divisions) = (from, vec![to], 0);
        while let Some(to) = ahead.last() {
            let piece = distance(&from.z, &to.z);
            if piece < CLOSE || piece < PIECE * way || from.explains(to) {
                from = ahead.pop().unwrap_or(from);
                continue;
            }
            let sudden = (to.omega() - from.omega()) / step < SUDDEN && piece > LEAP * way;
            let divided =
                if sudden || divisions == DIVISIONS { None } else { self.between(&from, to) };
            let Some(divided) = divided else { return Err(from.z) };
            divisions += 1;
            ahead.push(divided);
        }
        Ok(())
    }
}

/// Derivative of the displacements in the frequency where tangents were evaluated last.
fn rate(equations: &mut Condensed<'_>) -> Option<Vec<f64>> {
    let right = equations.frequency_rate();
    let mut rate = vec![0.0; right.len()];
    equations.solve(&right, &mut rate).then_some(rate)
}

/// Where the branch through `from` leads at a frequency at which Newton's method has found `to`.
fn followed(curve: &mut ForcedCurve<'_>, from: &[f64], to: Option<&[f64]>, end: f64) -> Reached {
    let sign = (end - from[from.len() - 1]).signum();
    let mut walk = Continuation::new(curve, from.to_vec(), sign, STEPS);
    let (mut before, mut turned) = (from.to_vec(), false);
    while walk.iterations < MOST && matches!(walk.advance(curve), Advance::Point) {
        let omega = walk.point[walk.point.len() - 1];
        turned |= (omega - before[before.len() - 1]) * sign < 0.0;
        if (omega - end) * sign >= 0.0 {
            let Some((z, _)) = between(curve, &before, &walk.point, end) else {
                break;
            };
            let same = !turned && to.is_some_and(|to| distance(&z, to) < SAME);
            return if same { Reached::Same } else { Reached::Other(curve.series(&z), turned) };
        }
        before.clone_from(&walk.point);
    }
    Reached::Lost(turned)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::balance::account::LITTLE;
    use crate::balance::settings::{HarmonicChoice, Settings};
    use crate::balance::sweep::sweep;
    use crate::contact::Stop;
    use crate::model::{Contact, Model};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, mat};

    /// Where all work is done a sweep goes on with its points alone, and tells which it has not looked at.
    #[test]
    fn a_jump_that_is_not_looked_for_is_not_known() {
        let [mass, damping, stiffness] = [1.0, 0.05, 1.0].map(|value| mat![[value]]);
        let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref());
        let law = Box::new(Stop::new(20.0, 1.0).unwrap());
        let load = HarmonicLoad { harmonic: 1, amplitude: vec![c64::new(0.2, 0.0)] };
        let contacts = vec![Contact { law, rows: mat![[1.0]] }];
        let model = Model::new(structure.unwrap(), contacts, vec![load]).unwrap();
        let omega: Vec<f64> = (0..113).map(|i| 0.4 + 0.025 * f64::from(i)).collect();
        let told = |taken: f64| {
            let settings = Settings { harmonics: HarmonicChoice::Fixed(5), ..Settings::default() };
            let mut balance = ForcedBalance::new(&model, settings, &[0]).unwrap();
            balance.looks.taken = taken;
            let found = sweep(balance, &omega).unwrap();
            assert!(found.points.iter().all(|point| point.is_solved()));
            let count = |of: fn(&Point) -> bool| found.points.iter().filter(|p| of(p)).count();
            (found.profile.work, count(|point| point.jump), count(|point| point.astray))
        };
        let ((whole, jumps, _), (work, missed, astray)) = (told(0.0), told(LITTLE));
        assert_eq!((jumps, missed), (1, 0));
        assert!(astray > 0 && work < 0.7 * whole, "{astray}: {work:e} {whole:e}");
    }
}
