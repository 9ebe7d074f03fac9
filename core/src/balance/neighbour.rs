//! What a point tells of those beside it on a curve: of their error estimates, and of where to begin.
//!
//! A solution that starts from its neighbour takes two Newton steps instead of six, and its estimate should
//! not take longer. How much the second step of an estimate adds to the first one changes slowly along a
//! curve: what was found at one point holds for a few after it, as long as the first step makes no contact
//! begin or cease to slip. Where the motion but for its phase hardly changes, and no discarded harmonic
//! comes to a mode, the estimate itself goes on as it did between the two points before. What solutions take and
//! estimates do not adds up, also where nothing slips, so that estimates cost no more than solutions along the curve as a
//! whole, and the first points that slip can be followed far. Where this allows few harmonics only, an estimate is at least
//! that of more harmonics at a point beside: the motion is about the same.

use super::smooth_piece::{Estimated, SmoothPiece};
use super::solution::Point;
use super::unknowns::Unknowns;
use crate::contact::Repeated;

/// Points are beside one another up to this distance in frequency, relative to it.
const NEAR: f64 = 0.02;
/// Points in a row that the second step at one before them serves, and where to begin.
const SERVED: usize = 7;
/// Points at which slip begins, on which the estimates of the others lean: they are judged as one by itself.
const LEADING: usize = 2;

/// What fewer harmonics make of an extrapolation.
pub(super) enum Rough {
    /// It is as good as theirs, or there is nothing else to begin with.
    Near,
    /// It was far from the solution; here is a better one.
    Found(Unknowns),
    /// Newton's method did not come to them, or not from the last such extrapolation.
    Lost,
}

/// A point that tells of those beside it.
#[derive(Default)]
struct Told {
    omega: f64,
    harmonics: usize,
    served: usize,
}

impl Told {
    fn by(point: &Point) -> Self {
        Self { omega: point.omega, harmonics: point.harmonics, served: 0 }
    }

    /// Whether it tells of a point, as one more.
    fn serves(&mut self, point: &Point) -> bool {
        let near = (self.omega - point.omega).abs() <= NEAR * self.omega;
        self.served += 1;
        near && self.harmonics == point.harmonics && self.served <= SERVED
    }
}

/// An estimate, its highest harmonic and the size of the motion.
#[derive(Default)]
struct Far {
    at: Told,
    highest: usize,
    errors: Vec<f64>,
    motion: f64,
}

/// The point at which an estimate was made as a whole last.
#[derive(Default)]
pub(super) struct Neighbour {
    at: Told,
    /// Its error over that after the first step, of each observed DOF; empty where it is not known. It serves
    /// extended balances of another reach as well: to take the second step anew wherever the reach changes takes
    /// what an account has left for the reach itself, and estimates of rings come out more wrong.
    growth: Vec<f64>,
    /// The last estimate that had more harmonics than those after it.
    far: Far,
    /// The last frequency, and what the solutions so far allow the estimates after it, in reckoned nanoseconds.
    account: Option<(f64, f64)>,
    /// How many points with slip in a row end there.
    slips: usize,
    /// States that marches of the contacts have repeated: those at the next point begin with them.
    pub(super) states: Vec<Option<Repeated>>,
    pub(super) piece: SmoothPiece,
    /// Points that are not tried from their neighbours, for none led to the last one.
    lost: usize,
}

impl Neighbour {
    /// By how much a whole estimate would be above the first step at a point beside.
    pub(super) fn served(&mut self, point: &Point) -> Option<Vec<f64>> {
        let serves = self.at.serves(point);
        (serves && !self.growth.is_empty()).then(|| self.growth.clone())
    }

    /// Raises an estimate up to a harmonic to one of more harmonics beside it.
    pub(super) fn raise(&mut self, point: &Point, highest: usize, errors: &mut [f64]) {
        let motion = point.displacement.iter().map(|u| u.norm_sqr()).sum::<f64>().sqrt();
        let far = &mut self.far;
        if highest < far.highest && far.at.serves(point) {
            let found = far.errors.iter().map(|error| error * motion / far.motion);
            // What was at rest tells nothing, and what is infinite at a resonance is not so beside it.
            let known = errors.iter_mut().zip(found).filter(|(_, found)| found.is_finite());
            known.for_each(|(error, found)| *error = error.max(found));
        } else {
            *far = Far { at: Told::by(point), highest, errors: errors.to_vec(), motion };
        }
    }

    /// What the estimate of a point may take, whose solution has `earned` so much: without a limit where its
    /// solution began far away or from fewer harmonics, where slip begins, and where nobody knows what it took.
    pub(super) fn credit(&mut self, point: &Point, earned: Option<f64>) -> f64 {
        let climbs = self.account.is_some_and(|(at, _)| at == point.omega);
        let before = if self.earn(point, earned) { self.slips } else { 0 };
        self.slips = before + 1;
        let limited = self.account.filter(|_| before >= LEADING && !climbs);
        limited.map_or(f64::INFINITY, |(_, credit)| credit)
    }

    /// The solution of a point without slip, which takes no estimate, has earned so much.
    pub(super) fn save(&mut self, point: &Point, earned: Option<f64>) {
        self.earn(point, earned);
        self.slips = 0;
    }

    /// Whether a solution adds what it has earned to the account of those before it.
    fn earn(&mut self, point: &Point, earned: Option<f64>) -> bool {
        let before = self.account.filter(|(at, _)| (at - point.omega).abs() <= NEAR * at);
        let left = before.map_or(0.0, |(_, left)| left);
        self.account = earned.map(|earned| (point.omega, left + earned));
        before.is_some()
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

    /// Has the next point take an estimate as a whole.
    pub(super) fn forget(&mut self) {
        self.growth.clear();
    }

    /// Learns from a point at which an estimate was made as a whole, with the errors after its first step
    /// if they tell of others.
    pub(super) fn learn(&mut self, point: &Point, errors: &[f64], first: Option<&[f64]>) {
        let growth = errors.iter().zip(first.unwrap_or_default());
        // 0 over 0 is no growth.
        self.growth = growth.map(|(whole, first)| (whole / first).max(1.0)).collect();
        self.at = Told::by(point);
    }
}
