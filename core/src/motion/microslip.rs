//! Contacts that slip little by little in an exact motion: the reversals that no later loop has closed.
//!
//! On the branch that began at the reversal (u_r, f_r) the force is `f = f_r ± 2 F(|u − u_r|/2)`, at first
//! loading from the origin `±F(|u − c|)`. The branch ends where the velocity vanishes, and where it
//! passes the reversal before its own, which is forgotten with it (Masing 1926). Force and stiffness are
//! continuous there.

use crate::contact::{LoadingCurve, PointState, SlipElement, REVERSALS as PLACES};
use faer::Mat;
use std::ops::Range;

/// Distance, relative to the displacements that it is the difference of, that is rounding.
const ROUNDING: f64 = 1e-12;

/// A contact without sliders.
#[derive(Debug, Clone)]
pub(crate) struct Microslip {
    /// Its point among those of all elements.
    pub(crate) point: usize,
    /// Its place in what states remember.
    pub(crate) memory: Range<usize>,
    pub(crate) curve: LoadingCurve,
    /// Displacements where the backbone is not analytic, ascending \[m\].
    pub(super) breaks: Vec<f64>,
}

/// The branch that a contact is on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Branch {
    /// Displacement and force where it began.
    pub(super) begun: [f64; 2],
    /// Direction in which it is passed.
    pub(super) sign: f64,
    /// Displacement of the backbone over the way since: ½, at first loading 1.
    pub(super) share: f64,
}

/// What a contact remembers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reversals {
    /// Displacement without force before the first loading \[m\].
    pub(crate) origin: f64,
    /// Displacement \[m\] and force \[N\] at the reversals, alternating and ever closer to each other.
    pub(crate) turns: Vec<[f64; 2]>,
}

/// What an event does to the reversals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Turn {
    /// A reversal at this displacement \[m\] is added.
    Added(f64),
    /// The last reversal is none: the motion has turned round at once.
    Undone,
    /// So many reversals are forgotten; none where the backbone alone goes on by another formula.
    Forgotten(usize),
}

impl Branch {
    /// Displacement of the backbone \[m\].
    pub(super) fn distance(&self, u: f64) -> f64 {
        (self.share * self.sign * (u - self.begun[0])).max(0.0)
    }

    /// What slip takes off the elastic force since the branch began.
    pub(super) fn lost(&self, curve: &LoadingCurve, piece: usize, u: f64) -> [f64; 2] {
        let [value, slope] = curve.loss_on(piece, self.distance(u));
        [self.sign / self.share * value, slope]
    }

    /// Number of breaks of the backbone that lie behind.
    pub(super) fn piece(&self, breaks: &[f64], u: f64) -> usize {
        let distance = self.distance(u);
        let near = |by: f64| 2.0 * self.share * self.rounding(u, self.target(by));
        breaks.partition_point(|by| *by <= distance + near(*by))
    }

    /// Displacement at which the backbone has a displacement.
    pub(super) fn target(&self, by: f64) -> f64 {
        self.begun[0] + self.sign * by / self.share
    }

    /// Distance of two displacements that is rounding.
    pub(super) fn rounding(&self, u: f64, target: f64) -> f64 {
        ROUNDING * (u.abs() + target.abs() + self.begun[0].abs())
    }

    fn force(&self, own: &Microslip, u: f64) -> f64 {
        let [lost, _] = self.lost(&own.curve, self.piece(&own.breaks, u), u);
        let limit = own.curve.limit();
        (self.begun[1] + own.curve.stiffness() * (u - self.begun[0]) - lost).clamp(-limit, limit)
    }

    /// Stiffness at a displacement [N/m].
    pub(super) fn stiffness(&self, own: &Microslip, u: f64) -> f64 {
        own.curve.stiffness() - self.lost(&own.curve, self.piece(&own.breaks, u), u)[1]
    }
}

impl Reversals {
    /// Those of a law that is marched, by its steps: ways times the stiffness.
    pub(super) fn marched(steps: &[f64], stiffness: f64) -> Self {
        let mut at = 0.0;
        let turns = steps.iter().take_while(|step| **step != 0.0).map(|step| {
            at += step / stiffness;
            [at, 0.0]
        });
        Self { origin: 0.0, turns: turns.collect() }
    }

    /// Becomes its mirror image.
    pub(crate) fn mirror(&mut self) {
        self.origin = -self.origin;
        self.turns.iter_mut().flatten().for_each(|value| *value = -*value);
    }

    /// Moves with the displacement, with the place where loading has begun or without it.
    pub(crate) fn shift(&mut self, by: f64, with_origin: bool) {
        self.turns.iter_mut().for_each(|turn| turn[0] += by);
        self.origin += if with_origin { by } else { 0.0 };
    }

    /// The branch in a direction.
    pub(super) fn branch(&self, sign: f64) -> Branch {
        match self.turns.last() {
            Some(turn) => Branch { begun: *turn, sign, share: 0.5 },
            None => Branch { begun: [self.origin, 0.0], sign, share: 1.0 },
        }
    }

    /// Force at a displacement on the branch in a direction \[N\].
    pub(super) fn force(&self, own: &Microslip, sign: f64, u: f64) -> f64 {
        self.branch(sign).force(own, u)
    }

    /// Displacement at which the branch closes a loop.
    pub(super) fn target(&self) -> Option<f64> {
        match self.turns[..] {
            [] => None,
            [first] => Some(2.0 * self.origin - first[0]),
            [.., before, _] => Some(before[0]),
        }
    }

    /// Direction that leads away from the last reversal.
    pub(super) fn heading(&self, u: f64, speed: f64) -> f64 {
        let way = u - self.turns.last().map_or(self.origin, |turn| turn[0]);
        1.0_f64.copysign(if way == 0.0 { speed } else { way })
    }

    /// Turns round at a displacement, from a direction.
    pub(super) fn reverse(&mut self, own: &Microslip, sign: f64, u: f64) -> Turn {
        let branch = self.branch(sign);
        if (u - branch.begun[0]).abs() <= ROUNDING * (u.abs() + branch.begun[0].abs()) {
            // It has not moved since: the branch before goes on.
            return if self.turns.pop().is_some() { Turn::Undone } else { Turn::Forgotten(0) };
        }
        self.turns.push([u, branch.force(own, u)]);
        Turn::Added(u)
    }

    /// Forgets a loop that is closed at a displacement.
    pub(super) fn close(&mut self, sign: f64, u: f64) -> Turn {
        let Some(target) = self.target() else { return Turn::Forgotten(0) };
        let room = 2.0 * self.branch(sign).rounding(u, target);
        if sign * (u - target) < -room {
            return Turn::Forgotten(0);
        }
        let closed = self.turns.len().min(2);
        self.turns.truncate(self.turns.len() - closed);
        Turn::Forgotten(closed)
    }

    /// What is remembered at a displacement that is reached by given reversals, each as the way from the
    /// one before and the first from the origin; of each reversal kept its number in the list.
    pub(crate) fn through(
        own: &Microslip,
        origin: f64,
        ways: &[f64],
        now: f64,
    ) -> (Self, Vec<usize>) {
        let mut kept = Self { origin, turns: Vec::new() };
        let (mut numbers, mut at, mut sign) = (Vec::new(), origin, 0.0);
        let mut passed = origin;
        let stops = ways.iter().map(|way| {
            passed += way;
            passed
        });
        let stops: Vec<f64> = stops.chain([now]).collect();
        for (number, to) in stops.into_iter().enumerate() {
            if to == at {
                continue;
            }
            let direction = 1.0_f64.copysign(to - at);
            if sign != 0.0 && direction != sign {
                let force = kept.force(own, sign, at);
                kept.turns.push([at, force]);
                numbers.push(number - 1);
            }
            sign = direction;
            while kept.target().is_some_and(|target| sign * (to - target) >= 0.0) {
                let left = kept.turns.len() - kept.turns.len().min(2);
                kept.turns.truncate(left);
                numbers.truncate(left);
            }
            at = to;
        }
        (kept, numbers)
    }

    /// The numbers of a state: the origin, and the ways from reversal to reversal; of more than there are
    /// places for the smallest loops are left out.
    pub(crate) fn numbers(&self) -> [f64; 1 + PLACES] {
        let mut turns: Vec<f64> = self.turns.iter().map(|turn| turn[0]).collect();
        while turns.len() > PLACES {
            let way = |i: usize| (turns[i + 1] - turns[i]).abs();
            let least = (1..turns.len() - 1).min_by(|a, b| way(*a).total_cmp(&way(*b)));
            let least = least.unwrap_or(1);
            turns.drain(least..least + 2);
        }
        let mut numbers = [0.0; 1 + PLACES];
        numbers[0] = self.origin;
        let mut from = self.origin;
        for (number, turn) in numbers[1..].iter_mut().zip(turns) {
            *number = turn - from;
            from = turn;
        }
        numbers
    }
}

/// A contact without sliders as an element: its force comes from [`Reversals`].
#[derive(Debug)]
pub(super) struct Loaded(pub(super) LoadingCurve);

impl SlipElement for Loaded {
    fn stiffness(&self) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| self.0.stiffness())
    }

    fn limits(&self) -> Vec<f64> {
        vec![self.0.limit()]
    }

    fn bounds(&self) -> Vec<crate::contact::Bound> {
        vec![crate::contact::Bound::Backbone(self.0.limit())]
    }

    fn tangent(&self, points: &[PointState]) -> Mat<f64> {
        let at_rest = points[0] == PointState::Stuck;
        Mat::from_fn(1, 1, |_, _| if at_rest { self.0.stiffness() } else { 0.0 })
    }

    fn slip_rate(&self, _points: &[PointState]) -> Mat<f64> {
        Mat::zeros(1, 1)
    }

    /// Nothing: its reversals know the force.
    fn increment(&self, _: &[f64], _: &[f64], _: &mut [f64], _: Option<&mut [f64]>) {}
}
