//! A point of the forced response with as many harmonics and samples as the tolerance asks for.

use super::extension::PAST_LAST_MODE;
use super::forced::ForcedBalance;
use super::resolution_control::{beyond_modes, Decision};
use super::scale::OF_HARMONICS;
use super::settings::Resolution;
use super::solution::{Point, PointStatus};
use super::unknowns::Unknowns;
use crate::Error;

/// A point on its way to enough harmonics and samples.
#[derive(Default)]
struct Climb {
    iterations: usize,
    /// The last level that was solved.
    below: Option<Point>,
    /// Its error estimate, without doubts.
    estimate: Vec<f64>,
    stalled: bool,
    from_below: bool,
}

/// Where a climb goes on.
enum Way {
    On(Resolution),
    End(Box<Point>),
}

impl ForcedBalance<'_> {
    /// Solves at one frequency [rad/s] from a start, or from the stuck response: with more and more
    /// of what is chosen automatically, until what is left out matters less than the tolerance.
    ///
    /// # Errors
    /// The loads themselves excite an undamped resonance.
    pub fn solve(&mut self, omega: f64, start: Option<&Unknowns>) -> Result<Point, Error> {
        self.grant();
        let mut point = self.climb(omega, start)?;
        // Of an analysis that is to end a point is not what it would have come to.
        if point.status != PointStatus::Converged && self.is_ended() {
            return Ok(self.not_computed(omega));
        }
        let many = || self.rescue.is_some_and(|orbits| orbits.is_one_of_many(omega));
        if point.status == PointStatus::Stalled && many() {
            point.status = PointStatus::History;
        }
        if point.status == PointStatus::Stalled && self.is_spent() {
            point.status = PointStatus::WorkLimit;
        }
        Ok(point)
    }

    fn climb(&mut self, omega: f64, start: Option<&Unknowns>) -> Result<Point, Error> {
        let mut resolution = self.control.first();
        if self.control.is_fixed() {
            return self.solve_with(resolution, omega, start);
        }
        let mut start = start.cloned();
        let mut climb = Climb::default();
        loop {
            // What is solved below stands where more harmonics are dear and fail from there.
            let dear = climb.below.is_some() && !self.is_worth_a_homotopy(resolution.harmonics);
            let mut point = if dear {
                self.attempt(resolution, omega, start.as_ref())?
            } else {
                self.solve_with(resolution, omega, start.as_ref())?
            };
            climb.iterations += point.iterations;
            point.iterations = climb.iterations;
            let estimate = point.error_estimate.clone();
            self.doubt(&mut point, &climb);
            resolution = match point.status {
                PointStatus::Converged => match self.judge(&point) {
                    Decision::Enough => return Ok(point),
                    Decision::Limit(limit) => {
                        let exact = self.orbit_beyond(&point, limit);
                        point.status = limit;
                        return self.ended(exact.unwrap_or(point), resolution, &climb);
                    }
                    Decision::More(more) => {
                        self.account.begin_to_climb(&self.profile);
                        if let Some(last) = self.instead_of(more, &point) {
                            return self.ended(last, resolution, &climb);
                        }
                        if self.is_spent() {
                            point.status = PointStatus::EffortLimit;
                            return self.ended(point, resolution, &climb);
                        }
                        start.clone_from(&point.unknowns);
                        (climb.below, climb.estimate) = (Some(point), estimate);
                        more
                    }
                },
                PointStatus::Stalled => match self.past(&point, resolution, &mut climb) {
                    Way::On(next) => next,
                    Way::End(last) => return self.ended(*last, resolution, &climb),
                },
                _ => return Ok(point),
            };
        }
    }

    /// The way on from a point that stalled: the exact orbit, once a level more, which may be what it
    /// lacks, or the levels below. What is below stands if nothing helps.
    fn past(&mut self, point: &Point, at: Resolution, climb: &mut Climb) -> Way {
        let solved = climb.below.as_ref().unwrap_or(point);
        if let Some(exact) = self.orbit_below(solved, f64::INFINITY) {
            return Way::End(Box::new(exact));
        }
        let goes_on = !self.is_spent();
        let easy = self.is_worth_a_homotopy(at.harmonics) && goes_on;
        if climb.below.is_none() && !easy && !climb.from_below && goes_on {
            climb.from_below = true;
            return Way::On(self.control.start_over());
        }
        match (self.control.above(at).filter(|_| easy && !climb.stalled), &climb.below) {
            (Some(above), _) => {
                climb.stalled = true;
                Way::On(above)
            }
            (None, Some(below)) => {
                let status = PointStatus::EffortLimit;
                Way::End(Box::new(Point { status, ..below.clone() }))
            }
            (None, None) => Way::End(Box::new(point.clone())),
        }
    }

    /// A point that ends the climb; the next one begins with the harmonics at which it ended.
    fn ended(&mut self, mut point: Point, at: Resolution, climb: &Climb) -> Result<Point, Error> {
        let dear = point.status == PointStatus::EffortLimit;
        self.control.stay(if dear { point.resolution() } else { at });
        point.iterations = climb.iterations;
        self.complete_estimate(&mut point)?;
        Ok(point)
    }

    /// Whether the sampling errors of a solution alone ask for more samples.
    pub(super) fn lacks_samples(&mut self, point: &Point, sampling: &[f64]) -> bool {
        if !self.control.samples_climb() {
            return false;
        }
        self.scale.include(point);
        let error = self.scale.relative(point, OF_HARMONICS, sampling.iter().copied());
        self.control.lacking(point.resolution(), error).is_some()
    }

    /// Errors of which one that is exceeded asks for more harmonics, if these are chosen and there are more. Where laws
    /// are not monotone the whole estimate tells motions apart.
    pub(super) fn enough_for_more(&mut self, point: &Point) -> Vec<f64> {
        let more = self.control.harmonics_climb() && self.control.has_more(point.harmonics);
        if !more || !self.model.is_monotone() {
            return Vec::new();
        }
        self.scale.include(point);
        self.scale.most(point, OF_HARMONICS, self.settings.tolerance)
    }

    /// Order beyond which no mode takes part; there is none where degrees of freedom without mass follow all of them.
    pub(super) fn order_of_modes(&self, omega: f64) -> f64 {
        if self.model.structure().massless().is_empty() {
            PAST_LAST_MODE * self.model.compliance().highest_frequency() / omega
        } else {
            f64::INFINITY
        }
    }

    /// Among modes no estimate is believed that falls faster from one level to the next than errors do beyond them:
    /// it has missed something.
    fn doubt(&self, point: &mut Point, climb: &Climb) {
        let solved = point.status == PointStatus::Converged;
        let among = (point.harmonics as f64) < self.order_of_modes(point.omega);
        let Some(below) = climb.below.as_ref().filter(|_| solved && among) else { return };
        for (error, before) in point.error_estimate.iter_mut().zip(&climb.estimate) {
            let least = beyond_modes(*before, below.harmonics, point.harmonics);
            if least.is_finite() {
                *error = error.max(least);
            }
        }
    }

    /// What the errors of a solution ask for.
    pub(super) fn judge(&mut self, point: &Point) -> Decision {
        self.scale.include(point);
        let scale = &self.scale;
        let of_samples = scale.relative(point, OF_HARMONICS, point.sampling_error.iter().copied());
        // Nothing can be done about samples that were given.
        let climb = self.control.samples_climb();
        let errors = point.error_estimate.iter().zip(&point.sampling_error);
        let counted = |(all, sampling): (&f64, &f64)| if climb { *all } else { all - sampling };
        let error = scale.relative(point, OF_HARMONICS, errors.map(counted));
        let modes = self.order_of_modes(point.omega);
        self.control.judge(point.resolution(), [error, of_samples], modes)
    }
}
