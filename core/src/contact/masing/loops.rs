//! The loops of a Masing law over one period: branches between reversals, with return-point memory.
//!
//! A branch that began at the reversal (u_r, q_r) has the slip load `q = q_r ± 2 L(|u − u_r|/2)` with the
//! loss L of the backbone. Where it passes the reversal before its own, a loop has closed: both are
//! forgotten, and the branch before them goes on (Masing 1926). From the largest displacement on one
//! lap is enough.

use crate::contact::backbone::LoadingCurve;
use crate::contact::stick_slip::{crossing, Path};
use crate::contact::Motion;
use crate::fourier::TurningPoint;

/// A branch of a loop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Branch {
    /// Turning point of the path at which it begins.
    pub(super) turn: usize,
    /// Displacement there.
    pub(super) origin: f64,
    /// Direction of the displacement along it.
    pub(super) sign: f64,
    /// The branch that it reversed; none of the first.
    pub(super) parent: Option<usize>,
}

/// An interval of the period on one branch, on which the backbone is analytic.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    pub(super) branch: usize,
    pub(super) start: f64,
    pub(super) end: f64,
    /// Whether it begins at the reversal of its branch.
    pub(super) reverses: bool,
    /// Whether it ends where all of the contact begins to slip.
    pub(super) reaches_end: bool,
    /// How many displacements it has passed at which the backbone is not analytic.
    pub(super) piece: usize,
}

/// A period, or half of one under half-wave symmetry.
#[derive(Debug, Default)]
pub(super) struct Loops {
    pub(super) branches: Vec<Branch>,
    pub(super) stretches: Vec<Stretch>,
    /// Half the range of every loop that closes within the span.
    pub(super) closed: Vec<f64>,
}

impl Loops {
    /// Follows a path from its largest displacement.
    pub(super) fn new(curve: &LoadingCurve, motion: Motion<'_>, path: &Path<'_>) -> Self {
        let turns = &path.turns;
        let mut loops = Self::default();
        if turns.len() < 2 {
            return loops;
        }
        let sign = if turns[0].value >= turns[1].value { -1.0 } else { 1.0 };
        loops.branches.push(Branch { turn: 0, origin: turns[0].value, sign, parent: None });
        let mut stack = vec![0];
        let mut walk = Walk { curve, motion, breaks: curve.breaks(), loops: &mut loops };
        for (turn, ends) in turns.windows(2).enumerate() {
            let leg = [ends[0], ends[1]];
            if leg[0].value != leg[1].value {
                walk.follow(leg, turn, &mut stack);
            }
        }
        while let [.., parent, last] = stack[..] {
            stack.truncate(stack.len() - 2);
            loops.close(parent, last);
        }
        loops
    }

    /// What half the range of a branch and its parent is.
    fn half_range(&self, parent: usize, branch: usize) -> f64 {
        0.5 * (self.branches[branch].origin - self.branches[parent].origin).abs()
    }

    fn close(&mut self, parent: usize, branch: usize) {
        let half_range = self.half_range(parent, branch);
        self.closed.push(half_range);
    }

    /// Value at the reversals of all branches of what is odd like the slip load and has the backbone
    /// `of`; the first is at `half_range` from the middle.
    pub(super) fn at_reversals(&self, half_range: f64, of: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut loads: Vec<f64> = Vec::with_capacity(self.branches.len());
        for (index, branch) in self.branches.iter().enumerate() {
            loads.push(match branch.parent {
                None => -branch.sign * of(half_range),
                Some(parent) => {
                    let before = self.branches[parent].sign;
                    loads[parent] + 2.0 * before * of(self.half_range(parent, index))
                }
            });
        }
        loads
    }

    /// Slope of the backbone at the reversals of all branches.
    pub(super) fn slopes(&self, half_range: f64, of: impl Fn(f64) -> f64) -> Vec<f64> {
        let branches = self.branches.iter().enumerate();
        let range = |(index, branch): (usize, &Branch)| {
            branch.parent.map_or(half_range, |parent| self.half_range(parent, index))
        };
        branches.map(|branch| of(range(branch))).collect()
    }

    /// Branches that are not forgotten at an angle of the span, the first one first.
    pub(super) fn memory(&self, stretch: &Stretch) -> Vec<usize> {
        let mut known = vec![stretch.branch];
        while let Some(parent) = self.branches[known[known.len() - 1]].parent {
            known.push(parent);
        }
        known.reverse();
        known
    }

    /// The stretch at an angle of the span.
    pub(super) fn at(&self, theta: f64) -> Option<&Stretch> {
        let next = self.stretches.partition_point(|stretch| stretch.end < theta);
        self.stretches.get(next).or(self.stretches.last())
    }
}

struct Walk<'a> {
    curve: &'a LoadingCurve,
    motion: Motion<'a>,
    /// Displacements of the backbone where it is not analytic \[m\].
    breaks: Vec<f64>,
    loops: &'a mut Loops,
}

impl Walk<'_> {
    /// Goes from one turning point to the next.
    fn follow(&mut self, leg: [TurningPoint; 2], turn: usize, stack: &mut Vec<usize>) {
        let [from, to] = leg;
        let sign = (to.value - from.value).signum();
        let top = stack[stack.len() - 1];
        if self.loops.branches[top].sign != sign {
            stack.push(self.loops.branches.len());
            let branch = Branch { turn, origin: from.value, sign, parent: Some(top) };
            self.loops.branches.push(branch);
        }
        let mut start = from;
        while let [.., _, parent, branch] = stack[..] {
            let passed = self.loops.branches[parent].origin;
            if sign * (to.value - passed) <= 0.0 {
                break;
            }
            let end = self.reach(leg, start, passed);
            self.stretch(leg, branch, start, end);
            self.loops.close(parent, branch);
            stack.truncate(stack.len() - 2);
            start = end;
        }
        self.stretch(leg, stack[stack.len() - 1], start, to);
    }

    /// Where a leg reaches a displacement.
    fn reach(
        &self,
        [from, to]: [TurningPoint; 2],
        start: TurningPoint,
        value: f64,
    ) -> TurningPoint {
        let sign = (to.value - from.value).signum();
        if sign * (start.value - value) >= 0.0 {
            return start;
        }
        let (harmonics, series) = (self.motion.table.harmonics(), self.motion.displacement);
        let theta = crossing(harmonics, series, from, to, value);
        TurningPoint { theta: theta.clamp(start.theta, to.theta), value }
    }

    /// Adds an interval on a branch, cut where the backbone is not analytic.
    fn stretch(
        &mut self,
        leg: [TurningPoint; 2],
        branch: usize,
        start: TurningPoint,
        end: TurningPoint,
    ) {
        let Branch { origin, sign, .. } = self.loops.branches[branch];
        let mut from = start;
        let target = |own: f64| origin + 2.0 * sign * own;
        let passed = |own: &f64| sign * (target(*own) - start.value) <= 0.0;
        let first = self.breaks.partition_point(passed);
        for piece in first..self.breaks.len() {
            let target = target(self.breaks[piece]);
            if sign * (end.value - target) <= 0.0 {
                return self.push(branch, from, end, piece, false);
            }
            let to = self.reach(leg, from, target);
            self.push(branch, from, to, piece, piece + 1 == self.breaks.len());
            from = to;
        }
        self.push(branch, from, end, self.breaks.len(), false);
    }

    fn push(
        &mut self,
        branch: usize,
        from: TurningPoint,
        to: TurningPoint,
        piece: usize,
        reaches_end: bool,
    ) {
        if to.theta > from.theta {
            let reverses = from.value == self.loops.branches[branch].origin;
            let (start, end) = (from.theta, to.theta);
            let reaches_end = reaches_end && self.curve.backbone.root_at_end();
            let stretch = Stretch { branch, start, end, reverses, reaches_end, piece };
            self.loops.stretches.push(stretch);
        }
    }
}
