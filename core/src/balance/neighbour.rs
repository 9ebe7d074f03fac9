//! What a point tells of those beside it on a curve: of their error estimates, and of where to begin.
//!
//! A solution that starts from its neighbour takes two Newton steps instead of six, and its estimate should
//! not take longer. How much the second step of an estimate adds to the first one changes slowly along a
//! curve: what was found at one point holds for a few after it, as long as the first step makes no contact
//! begin or cease to slip. Where the motion but for its phase hardly changes, and no discarded harmonic
//! comes to a mode, the estimate itself goes on as it did between the two points before. What solutions take and
//! estimates do not adds up, so that estimates cost no more than solutions along the curve as a whole.

use super::smooth_piece::{Estimated, SmoothPiece};
use super::solution::Point;
use super::unknowns::Unknowns;
use crate::contact::Repeated;

/// Points are beside one another up to this distance in frequency, relative to it.
const NEAR: f64 = 0.02;
/// Points in a row that the second step at one before them serves, and where to begin.
const SERVED: usize = 7;

/// What fewer harmonics make of an extrapolation.
pub(super) enum Rough {
    /// It is as good as theirs, or there is nothing else to begin with.
    Near,
    /// It was far from the solution; here is a better one.
    Found(Unknowns),
    /// Newton's method did not come to them, or not from the last such extrapolation.
    Lost,
}

/// The point at which an estimate was made as a whole last.
#[derive(Default)]
pub(super) struct Neighbour {
    omega: f64,
    harmonics: usize,
    /// Its error over that after the first step, of each observed DOF; empty where it is not known. It serves
    /// extended balances of another reach as well: to take the second step anew wherever the reach changes takes
    /// what an account has left for the reach itself, and estimates of rings come out more wrong.
    growth: Vec<f64>,
    served: usize,
    /// The last frequency with a slipping contact, and what the solutions so far allow the estimates after it,
    /// in reckoned nanoseconds.
    account: Option<(f64, f64)>,
    /// States that marches of the contacts have repeated: those at the next point begin with them.
    pub(super) states: Vec<Option<Repeated>>,
    pub(super) piece: SmoothPiece,
    /// Points that are not tried from their neighbours, for none led to the last one.
    lost: usize,
}

impl Neighbour {
    /// By how much a whole estimate would be above the first step at a point beside.
    pub(super) fn served(&mut self, point: &Point) -> Option<Vec<f64>> {
        let near = (self.omega - point.omega).abs() <= NEAR * self.omega;
        let suits = near && self.harmonics == point.harmonics && self.served < SERVED;
        self.served += 1;
        (suits && !self.growth.is_empty()).then(|| self.growth.clone())
    }

    /// What the estimate of a point may take, whose solution has `earned` so much: without a limit where its
    /// solution began far away, or where nobody knows what it took.
    pub(super) fn credit(&mut self, point: &Point, earned: Option<f64>) -> f64 {
        let before = self.account.filter(|(at, _)| (at - point.omega).abs() <= NEAR * at);
        let credit = before.map_or(0.0, |(_, left)| left) + earned.unwrap_or(0.0);
        self.account = earned.map(|_| (point.omega, credit));
        if before.is_some() && earned.is_some() {
            credit
        } else {
            f64::INFINITY
        }
    }

    /// Newton's method did not come from a neighbour to a point.
    pub(super) fn lose(&mut self) {
        self.lost = SERVED;
    }

    /// Whether it will not come to the next one either.
    pub(super) fn is_lost_again(&mut self) -> bool {
        let lost = self.lost > 0;
        self.lost -= usize::from(lost);
        lost
    }

    /// Notes what an estimate took.
    pub(super) fn pay(&mut self, taken: f64) {
        if let Some((_, credit)) = &mut self.account {
            *credit = (*credit - taken).max(0.0);
        }
    }

    /// Notes the estimate of a point, with its solution.
    pub(super) fn note(&mut self, point: &Point, solution: Unknowns, errors: &[f64]) {
        self.piece.note(Estimated::new(point, solution, errors));
    }

    /// Learns from a point at which an estimate was made as a whole, with the errors after its first step
    /// if they tell of others.
    pub(super) fn learn(&mut self, point: &Point, errors: &[f64], first: Option<&[f64]>) {
        let growth = errors.iter().zip(first.unwrap_or_default());
        // 0 over 0 is no growth.
        self.growth = growth.map(|(whole, first)| (whole / first).max(1.0)).collect();
        (self.omega, self.harmonics, self.served) = (point.omega, point.harmonics, 0);
    }
}
