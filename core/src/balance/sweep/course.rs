//! The course of a curve over a range of frequencies: what its pieces have in common.

use super::stops::{stops, LONGEST};
use crate::balance::forced::ForcedBalance;
use crate::balance::scale::Scale;
use crate::balance::solution::Point;
use crate::Error;
use std::sync::Arc;

/// What all pieces of a range share.
pub(crate) struct Course {
    /// Both ends, in the direction of the sweep.
    pub(super) range: (f64, f64),
    /// Resonances with their bandwidths in this order, and the end.
    pub(super) stops: Vec<(f64, f64)>,
    /// What errors count against: the motions at all seams.
    scale: Scale,
}

impl Course {
    /// Of a range with its first point and others that are known.
    ///
    /// # Errors
    /// An eigenvalue iteration that fails.
    pub(crate) fn new(
        balance: &mut ForcedBalance<'_>,
        known: &[Arc<Point>],
        range: (f64, f64),
    ) -> Result<Self, Error> {
        known.iter().filter(|one| one.is_solved()).for_each(|one| balance.scale.include(one));
        let stops = match known.first() {
            Some(first) => stops(balance, first, range.0, range.1)?,
            None => Vec::new(),
        };
        Ok(Self { range, stops, scale: balance.scale.clone() })
    }

    /// Stops between two points of the range, and the second of them.
    pub(super) fn between(&self, begin: f64, end: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        let direction = (self.range.1 - self.range.0).signum();
        let apart = move |a: f64, b: f64| (b - a) * direction > 1e-6 * a;
        let inside = move |stop: &&(f64, f64)| apart(begin, stop.0) && apart(stop.0, end);
        self.stops.iter().filter(inside).copied().chain([(end, f64::INFINITY)])
    }

    /// Longest step.
    pub(super) fn longest(&self) -> f64 {
        LONGEST * (self.range.1 - self.range.0).abs()
    }

    /// Lets the errors of a piece count against the motions of all.
    pub(super) fn lead(&self, balance: &mut ForcedBalance<'_>) {
        balance.scale = self.scale.clone();
    }
}
