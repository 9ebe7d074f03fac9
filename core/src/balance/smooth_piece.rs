//! A piece of a curve along which estimates go on smoothly.
//!
//! An estimate depends on the motion, whose harmonics above H it asks for, and on the compliance at these
//! harmonics. A motion that is later by an angle has the same estimate, so that its phase does not count. A
//! compliance varies little but where its harmonic comes to a narrow mode, stuck or free.

use super::solution::Point;
use super::unknowns::Unknowns;
use crate::fourier::Harmonics;
use crate::solve::norm;
use crate::structure::Compliance;
use std::ops::Range;

/// Farthest point at which an estimate goes on, relative to the frequency.
const NEAR: f64 = 0.01;
/// Farthest point, over the distance of the two before it.
const STEPS: f64 = 1.01;
/// Most points in a row that go on.
pub(super) const IN_A_ROW: usize = 3;
/// Change of the motion of a contact, apart from its phase and relative to it, up to which it is the same.
const SAME_MOTION: f64 = 0.25;
/// The same of the share of the period in which it slips.
const SAME_SLIP: f64 = 0.15;
/// How far it may be from where it was going to by the point before, …
const BEND: f64 = 0.01;
/// … and over its change.
const BEND_OF_CHANGE: f64 = 0.5;
/// Change of the estimates of all DOFs from one point to the next up to which they go on, …
const CHANGE: f64 = 1.5;
/// … that of one of them, …
const CHANGE_OF_ONE: f64 = 2.0;
/// … if it is no less than this share of the largest.
const COUNTS: f64 = 1e-2;

/// A point with an estimate of its own.
pub(super) struct Estimated {
    omega: f64,
    solution: Unknowns,
    slip_fractions: Vec<f64>,
    errors: Vec<f64>,
}

impl Estimated {
    pub(super) fn new(point: &Point, solution: Unknowns, errors: &[f64]) -> Self {
        let slip_fractions = slip_fractions(point).collect();
        Self { omega: point.omega, solution, slip_fractions, errors: errors.to_vec() }
    }

    /// Whether the slip of a point is about where it was going to from the point `before`, a `share` of that way on.
    fn slips_on(&self, before: &Self, point: &Point, share: f64) -> bool {
        let known = before.slip_fractions.iter().zip(&self.slip_fractions);
        known.zip(slip_fractions(point)).all(|((before, last), now)| {
            let bend = now - last - share * (last - before);
            bend.abs() <= BEND + BEND_OF_CHANGE * (now - last).abs()
        })
    }

    /// Whether a motion is the same but for its phase.
    fn moves_as(&self, point: &Point, solution: &Unknowns) -> bool {
        let states = self.slip_fractions.iter().zip(slip_fractions(point));
        let same_state = |(before, now): (&f64, f64)| {
            (*before > 0.0) == (now > 0.0) && (before - now).abs() <= SAME_SLIP
        };
        let harmonics = &solution.harmonics;
        let suits = self.solution.harmonics == *harmonics
            && self.slip_fractions.len() == point.contacts.len();
        let Some(first) = harmonics.slot(1).filter(|_| suits && states.into_iter().all(same_state))
        else {
            return false;
        };
        let slip = || self.slip_fractions.iter().map(|slips| *slips > 0.0);
        let pairs = || {
            let [before, now] =
                [&self.solution, solution].map(|of| of.values.chunks_exact(harmonics.slots()));
            before.zip(now).zip(slip()).filter(|(_, slips)| *slips).map(|(both, _)| both)
        };
        // The common angle, as the fundamentals tell it.
        let (mut along, mut ahead) = (0.0, 0.0);
        for (before, now) in pairs() {
            along += before[first] * now[first] + before[first + 1] * now[first + 1];
            ahead += before[first + 1] * now[first] - before[first] * now[first + 1];
        }
        let angle = f64::atan2(ahead, along);
        pairs().all(|(before, now)| {
            let mut left = turned(harmonics, angle, before);
            let (left, now) = (&mut left[harmonics.offset()..], &now[harmonics.offset()..]);
            left.iter_mut().zip(now).for_each(|(left, now)| *left -= now);
            norm(left) <= SAME_MOTION * norm(now)
        })
    }
}

/// The last two points with estimates of their own; few points without lie between them.
#[derive(Default)]
pub(super) struct SmoothPiece {
    before: Option<Estimated>,
    last: Option<Estimated>,
    /// Points behind the last one that did without.
    went_on: usize,
    /// What estimates have taken that might have gone on, if modes were known \[ns\].
    spent: f64,
}

impl SmoothPiece {
    /// Notes a point with an estimate of its own.
    pub(super) fn note(&mut self, point: Estimated) {
        let last = self.last.take();
        self.before = last.filter(|last| last.solution.harmonics == point.solution.harmonics);
        (self.last, self.went_on) = (Some(point), 0);
    }

    /// The estimate of a point that lies on the piece; nothing if it asks for its own, which takes a `time`
    /// \[ns\], as it does behind so many `in_a_row` that did without.
    pub(super) fn continued(
        &mut self,
        point: &Point,
        solution: &Unknowns,
        compliance: &dyn Compliance,
        discarded: Range<usize>,
        (in_a_row, time): (usize, f64),
    ) -> Option<Vec<f64>> {
        let (earlier, last) = self.before.as_ref().zip(self.last.as_ref())?;
        let errors = &earlier.errors;
        let (behind, ahead) = (last.omega - earlier.omega, point.omega - last.omega);
        let near = ahead.abs() <= NEAR * last.omega && errors.len() == last.errors.len();
        let share = ahead / behind;
        if self.went_on >= in_a_row.min(IN_A_ROW) || !near || !(share > 0.0 && share <= STEPS) {
            return None;
        }
        let size = |errors: &[f64]| errors.iter().sum::<f64>();
        let goes_on = |[before, now]: [f64; 2]| (now / before).powf(share);
        // Powers of each take most of the time.
        let of_one = CHANGE_OF_ONE.powf(1.0 / share);
        let largest = errors.iter().chain(&last.errors).copied().fold(0.0, f64::max);
        let smooth = errors.iter().zip(&last.errors).all(|(&before, &now)| {
            before.max(now) < COUNTS * largest || is_within(now / before, of_one)
        });
        if !(smooth
            && is_within(goes_on([size(errors), size(&last.errors)]), CHANGE)
            && last.slips_on(earlier, point, share)
            && last.moves_as(point, solution))
        {
            return None;
        }
        self.spent += time;
        let half_wave = solution.harmonics.half_wave();
        if !is_clear([last.omega, point.omega], compliance, discarded, half_wave, self.spent) {
            return None;
        }
        let both = errors.iter().zip(&last.errors);
        let estimates = both.map(|(&before, &now)| {
            // What falls may rise again.
            if now > before {
                now * goes_on([before, now]).min(CHANGE)
            } else {
                now
            }
        });
        self.went_on += 1;
        Some(estimates.collect())
    }
}

/// Whether a change is at most one by a factor.
fn is_within(change: f64, factor: f64) -> bool {
    (1.0 / factor..=factor).contains(&change)
}

/// Whether no discarded harmonic comes to a mode that it passes within a step.
fn is_clear(
    [before, now]: [f64; 2],
    compliance: &dyn Compliance,
    mut discarded: Range<usize>,
    half_wave: bool,
    spent: f64,
) -> bool {
    let step = (now - before).abs();
    discarded.all(|order| {
        // A motion whose halves mirror each other has no even harmonics.
        if half_wave && order % 2 == 0 {
            return true;
        }
        let range = [now - step, now + step].map(|omega| order as f64 * omega);
        compliance.is_clear(order, range, spent)
    })
}

fn slip_fractions(point: &Point) -> impl Iterator<Item = f64> + '_ {
    point.contacts.iter().map(|contact| contact.slip_fraction)
}

/// A series ahead by an angle.
fn turned(harmonics: &Harmonics, angle: f64, series: &[f64]) -> Vec<f64> {
    let mut turned = series.to_vec();
    let offset = harmonics.offset();
    let pairs = turned[offset..].chunks_exact_mut(2);
    for (pair, &order) in pairs.zip(harmonics.oscillating()) {
        let (sine, cosine) = (order as f64 * angle).sin_cos();
        let [a, b] = [pair[0], pair[1]];
        (pair[0], pair[1]) = (a * cosine + b * sine, b * cosine - a * sine);
    }
    turned
}
