//! The force of a contact without sliders along a step of the flow, as a power series in τ.
//!
//! The force is a smooth function of the displacement, and the displacement answers to it: beside the
//! linear part `K (u − u_0)` there is a rest, which is found at Chebyshev points of the step, one pass after
//! the other (Picard; each pass gains two orders in the length). The step is halved until the last
//! coefficients of the rest are below rounding. Behind a reversal the backbone has a power that need not
//! be an integer: there steps begin short and grow, for what the rest leaves out falls with the length.

use super::microslip::{Branch, Microslip};
use super::polynomial::{value, DEGREE};
use super::state::State;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Degree of the rest.
const ORDER: usize = 14;
const COUNT: usize = ORDER + 1;
/// Last coefficients of the rest times the length of the step, and by themselves, relative to the force, …
const LEFT_OUT: [f64; 2] = [1e-15, 1e-11];
/// … and those of the stiffness relative to it.
const LEFT_OUT_SLOPE: [f64; 2] = [1e-7, 1e-2];
/// Share of the forces that the rest is the difference of, that is rounding.
const ROUNDING: f64 = 1e-15;

/// Chebyshev points on the unit interval, and what makes powers of values there.
struct Rule {
    points: [f64; COUNT],
    /// Power by value.
    powers: Vec<[f64; COUNT]>,
}

fn rule() -> &'static Rule {
    static RULE: OnceLock<Rule> = OnceLock::new();
    RULE.get_or_init(|| {
        let angle = |j: usize| PI * j as f64 / ORDER as f64;
        let points = std::array::from_fn(|j| 0.5 * (1.0 - angle(j).cos()));
        // Powers of T_k(1 − 2x), whose value at the points is cos(k angle).
        let mut series = vec![[0.0; COUNT]; COUNT];
        (series[0][0], series[1][0], series[1][1]) = (1.0, 1.0, -2.0);
        for k in 2..COUNT {
            for power in 0..COUNT {
                let shifted = if power > 0 { series[k - 1][power - 1] } else { 0.0 };
                series[k][power] =
                    2.0 * (series[k - 1][power] - 2.0 * shifted) - series[k - 2][power];
            }
        }
        let powers = (0..COUNT)
            .map(|power| {
                std::array::from_fn(|j| (0..COUNT).map(|k| series[k][power] * weight(k, j)).sum())
            })
            .collect();
        Rule { points, powers }
    })
}

/// Share of the value at point j in the Chebyshev coefficient k.
fn weight(k: usize, j: usize) -> f64 {
    let ends = |n: usize| if n == 0 || n == ORDER { 0.5 } else { 1.0 };
    2.0 / ORDER as f64 * ends(k) * ends(j) * (PI * (k * j) as f64 / ORDER as f64).cos()
}

/// Sizes of the last two Chebyshev coefficients.
fn tail(values: &[f64; COUNT]) -> f64 {
    let own = |k: usize| (0..COUNT).map(|j| weight(k, j) * values[j]).sum::<f64>().abs();
    own(ORDER).max(own(ORDER - 1))
}

/// Coefficients in τ of a polynomial by its values over a step.
fn series(values: &[f64; COUNT], length: f64) -> [f64; COUNT] {
    let mut scale = 1.0;
    let mut out = [0.0; COUNT];
    for (out, row) in out.iter_mut().zip(&rule().powers) {
        *out = row.iter().zip(values).map(|(w, v)| w * v).sum::<f64>() / scale;
        scale *= length;
    }
    out
}

/// How a pass over the points has ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Pass {
    /// The rest is what it was before.
    Settled,
    /// The step is too long.
    Unresolved,
    /// It has changed.
    Changed,
}

/// A contact on its branch along a step.
#[derive(Debug, Clone)]
pub(crate) struct BranchSeries {
    pub(super) point: usize,
    /// Its number among the contacts without sliders.
    pub(crate) number: usize,
    branch: Branch,
    piece: usize,
    curve: crate::contact::LoadingCurve,
    /// Displacement at the start, and the force that its rest counts against.
    start: f64,
    size: f64,
    /// Stiffness at the start.
    pub(super) tangent: f64,
    rest: [f64; COUNT],
    /// Stiffness along the step.
    slope: [f64; COUNT],
    /// Where it closes a loop.
    closes: Option<f64>,
    /// Whether the branch has just begun.
    pub(super) fresh: bool,
    last: [f64; COUNT],
}

impl BranchSeries {
    pub(super) fn new(own: &Microslip, number: usize, state: &State, [u, speed]: [f64; 2]) -> Self {
        let reversals = &state.reversals[number];
        let branch = reversals.branch(state.points[own.point].sign());
        let tangent = branch.stiffness(own, u);
        let first = reversals.turns.first().map_or(0.0, |turn| (turn[0] - reversals.origin).abs());
        let way = (u - reversals.origin).abs().max(first).max(speed.abs());
        Self {
            point: own.point,
            number,
            piece: branch.piece(&own.breaks, u),
            closes: reversals.target(),
            fresh: branch.distance(u) <= 1e-3 * way,
            branch,
            curve: own.curve.clone(),
            start: u,
            size: (own.curve.stiffness() * way).min(own.curve.limit()),
            tangent,
            rest: [0.0; COUNT],
            slope: [0.0; COUNT],
            last: [0.0; COUNT],
        }
    }

    /// Displacements at which another formula begins to hold, each with a distance that is rounding.
    pub(super) fn targets(&self, own: &Microslip) -> Vec<[f64; 2]> {
        let ahead = own.breaks.get(self.piece).map(|by| self.branch.target(*by));
        let all = self.closes.into_iter().chain(ahead);
        all.map(|target| [target, self.branch.rounding(self.start, target)]).collect()
    }

    /// Whether it begins at its reversal, without velocity.
    pub(super) fn begins(&self) -> bool {
        self.branch.share < 1.0 && self.start == self.branch.begun[0]
    }

    /// Forgets the rest: another length is tried.
    pub(super) fn restart(&mut self) {
        (self.rest, self.last) = ([0.0; COUNT], [0.0; COUNT]);
    }

    /// Coefficient of the force beyond the constant one.
    pub(super) fn force(&self, power: usize, contact: &[f64]) -> f64 {
        let u = contact[self.point * (DEGREE + 1) + power];
        self.tangent * u + self.rest.get(power).copied().unwrap_or(0.0)
    }

    /// Finds the rest anew along a motion over a length of τ.
    pub(super) fn pass(&mut self, contact: &[f64], length: f64) -> Pass {
        let own = &contact[self.point * (DEGREE + 1)..(self.point + 1) * (DEGREE + 1)];
        let way = |tau: f64| tau * value(&own[1..], tau);
        let [lost, _] = self.branch.lost(&self.curve, self.piece, self.start);
        let k = self.curve.stiffness();
        let (mut rest, mut slope) = ([0.0; COUNT], [0.0; COUNT]);
        let (mut farthest, mut most) = (0.0_f64, 0.0_f64);
        for (j, x) in rule().points.iter().enumerate() {
            let by = way(x * length);
            let [own, loss] = self.branch.lost(&self.curve, self.piece, self.start + by);
            rest[j] = (k - self.tangent) * by - (own - lost);
            slope[j] = k - loss;
            farthest = farthest.max(by.abs());
            most = most.max(own.abs());
        }
        rest[0] = 0.0;
        let size = self.size.max((k * farthest).min(self.curve.limit()));
        let changed = rest.iter().zip(&self.last).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let first = self.last == [0.0; COUNT];
        let floor = ROUNDING * (size + most + k * farthest);
        let beyond = |tail: f64, of: f64, most: [f64; 2]| {
            tail * length > most[0] * of + floor * length || tail > most[1] * of + floor
        };
        self.last = rest;
        // Powers of rounding over a short step have no bound.
        let counts = rest.iter().any(|own| own.abs() > floor);
        self.rest = if counts { series(&rest, length) } else { [0.0; COUNT] };
        self.rest[0] = 0.0;
        self.slope = series(&slope, length);
        if !changed.is_finite()
            || beyond(tail(&rest), size, LEFT_OUT)
            || beyond(tail(&slope), k, LEFT_OUT_SLOPE)
        {
            return Pass::Unresolved;
        }
        if changed <= floor && (!first || changed == 0.0) {
            Pass::Settled
        } else {
            Pass::Changed
        }
    }

    /// Stiffness at τ [N/m].
    pub(crate) fn stiffness_at(&self, tau: f64) -> f64 {
        value(&self.slope, tau)
    }

    /// Coefficient of the disturbed force, from those of the displacement up to its power and what is
    /// disturbed where the branch began.
    pub(super) fn disturbed(&self, power: usize, contact: &[f64], [at, held]: [f64; 2]) -> f64 {
        let own = &contact[self.point * (DEGREE + 1)..(self.point + 1) * (DEGREE + 1)];
        let first = power.saturating_sub(ORDER);
        let moved = |n: usize| own[n] - if n == 0 { at } else { 0.0 };
        let sum: f64 = (first..=power).map(|n| self.slope[power - n] * moved(n)).sum();
        sum + if power == 0 { held } else { 0.0 }
    }
}
