//! Returns of a free motion to a section: the map whose fixed points are periodic motions.
//!
//! The section is the maximum of one coordinate. A free motion has no clock; how long it takes to
//! come back is its period.

use super::flow_event::FlowSegment;
use super::modal_system::ModalSystem;
use super::polynomial::{sign_changes, value};
use super::state::State;
use super::transition::Transition;
use crate::solve::norm;
use std::collections::VecDeque;

/// Most returns in one period: harmonics may give a period several maxima.
const MOST: usize = 12;
/// Periods over which a motion has to close before it counts as settled.
const PERIODS: usize = 32;
/// Fall of the logarithm of a closing error over the periods that counts as none.
const STEADY: f64 = 1e-2;
/// Time, in units of the fastest rate, within which turning points are one.
const TURN: f64 = 1e-7;
/// Closing error that is rounding.
const ROUNDING: f64 = 1e-11;

/// A motion that closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Closed {
    /// Period \[s\].
    pub(super) period: f64,
}

/// The last returns of a motion, and how closely each repeats one before.
pub(super) struct Returns {
    /// Displacement of the section's coordinate per η.
    shape: Vec<f64>,
    tolerance: f64,
    /// Whether the coordinate rises.
    rises: bool,
    /// Coordinates at the last minimum.
    lowest: Vec<f64>,
    /// Time \[s\], coordinates and size of the motion of the last returns.
    last: VecDeque<(f64, Vec<f64>, f64)>,
    /// Size of the motion relative to the whole state, offset included, over the last returns.
    shares: VecDeque<f64>,
    /// Closing errors over the last periods, per number of returns in a period.
    errors: Vec<VecDeque<f64>>,
    series: Vec<f64>,
    slope: Vec<f64>,
    zeros: Vec<f64>,
}

impl Returns {
    pub(super) fn new(shape: Vec<f64>, tolerance: f64) -> Self {
        Self {
            shape,
            tolerance,
            rises: false,
            lowest: Vec::new(),
            last: VecDeque::new(),
            shares: VecDeque::new(),
            errors: vec![VecDeque::new(); MOST],
            series: Vec::new(),
            slope: Vec::new(),
            zeros: Vec::new(),
        }
    }

    /// Finds the returns on an segment that begins `begin` \[s\] after the start of the motion, less its
    /// own start. `told` hears of each: size of the motion, least closing error.
    pub(super) fn follow(
        &mut self,
        segment: &FlowSegment<'_>,
        begin: f64,
        system: &ModalSystem,
        coordinates: &Transition<'_>,
        told: &mut dyn FnMut(f64, f64),
    ) {
        segment.series.project(self.shape.iter().copied(), segment.length, &mut self.series);
        self.slope.clear();
        self.slope.extend(self.series[1..].iter().enumerate().map(|(n, a)| (n + 1) as f64 * a));
        let mut zeros = std::mem::take(&mut self.zeros);
        sign_changes(&self.slope, &mut zeros);
        let mut from = 0.0;
        for &to in zeros.iter().chain(&[1.0]) {
            // A contact sticks where it turns: the maximum may be an event, and the slope of the
            // segments on either side is rounding there.
            if (to - from) * segment.length > TURN {
                let rises = value(&self.slope, 0.5 * (from + to)) > 0.0;
                if self.rises != rises {
                    let tau = from * segment.length;
                    let mut state = State::rest(system);
                    segment.series.state_at(tau, system, state.parts());
                    let time = begin + segment.start + tau / segment.series.rate();
                    let y = coordinates.coordinates(&state);
                    if rises {
                        self.lowest = y;
                    } else {
                        let (size, error) = self.add(time, y);
                        told(size, error);
                    }
                }
                self.rises = rises;
            }
            from = to;
        }
        self.zeros = zeros;
    }

    /// Adds a return; its size and its least closing error.
    fn add(&mut self, time: f64, y: Vec<f64>) -> (f64, f64) {
        let apart = |from: &[f64]| -> f64 {
            norm(&y.iter().zip(from).map(|(a, b)| a - b).collect::<Vec<f64>>())
        };
        let whole = norm(&y);
        let size = if self.lowest.is_empty() { whole } else { 0.5 * apart(&self.lowest) };
        let (mut least, mut largest) = (f64::INFINITY, size);
        for (errors, (count, (_, before, own))) in
            self.errors.iter_mut().zip((1..).zip(self.last.iter().rev()))
        {
            // A period of several maxima is as large as the largest.
            largest = largest.max(*own);
            let error = if largest > 0.0 { apart(before) / largest } else { 0.0 };
            least = least.min(error);
            errors.push_back(error);
            if errors.len() > count * PERIODS {
                errors.pop_front();
            }
        }
        self.shares.push_back(if whole > 0.0 { size / whole } else { 0.0 });
        if self.shares.len() > PERIODS {
            self.shares.pop_front();
        }
        self.last.push_back((time, y, size));
        if self.last.len() > MOST {
            self.last.pop_front();
        }
        (size, least)
    }

    /// Whether next to nothing is left of the motion about an equilibrium, and it does not grow.
    pub(super) fn faded(&self) -> bool {
        let largest =
            |range: std::ops::Range<usize>| self.shares.range(range).copied().fold(0.0, f64::max);
        if self.shares.len() < PERIODS {
            return false;
        }
        let (first, last) = (largest(0..PERIODS / 2), largest(PERIODS / 2..PERIODS));
        first <= self.tolerance && last <= first
    }

    /// Whether the motion has closed, and will: over the last periods the closing error has been
    /// within the tolerance, and so is what is left of it if it goes on falling at its rate. Near an
    /// unstable orbit it grows instead.
    pub(super) fn closed(&self) -> Option<Closed> {
        for count in 1..=MOST {
            let fall = self.fall(count)?;
            let (last, rate) = (fall.last, fall.per_return * count as f64);
            // What a motion is still away from its period: a geometric series of its closing errors.
            let left = match rate {
                rate if last <= ROUNDING && rate >= 0.0 => 0.0,
                rate if rate > 0.0 => last / -(-rate).exp_m1(),
                _ => f64::INFINITY,
            };
            if fall.most > self.tolerance || left > self.tolerance {
                continue;
            }
            // A spiral towards one point passes close to itself every few returns; what tells it from
            // a longer period is that the errors of fewer returns fall as well.
            let spirals = (1..count).any(|fewer| {
                self.fall(fewer).is_some_and(|other| {
                    other.per_return > (0.5 * fall.per_return).max(STEADY / PERIODS as f64)
                })
            });
            if spirals {
                continue;
            }
            let end = self.last.len() - 1;
            let period = self.last[end].0 - self.last.get(end.checked_sub(count)?)?.0;
            return Some(Closed { period });
        }
        None
    }

    /// How the closing error of a number of returns falls over the last periods; `None` while they
    /// are too few.
    fn fall(&self, count: usize) -> Option<Fall> {
        let errors = &self.errors[count - 1];
        let half = count * PERIODS / 2;
        if errors.len() < 2 * half {
            return None;
        }
        let largest =
            |range: std::ops::Range<usize>| errors.range(range).copied().fold(0.0, f64::max);
        let (first, last) = (largest(0..half), largest(half..2 * half));
        let per_return = if last > 0.0 { (first / last).ln() / half as f64 } else { 0.0 };
        Some(Fall { most: first.max(last), last, per_return })
    }
}

/// Closing errors over the last periods.
struct Fall {
    most: f64,
    /// Largest of the second half.
    last: f64,
    /// Rate at which their logarithm falls.
    per_return: f64,
}
