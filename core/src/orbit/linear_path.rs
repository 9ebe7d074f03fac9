//! The linearised contact laws along a given periodic motion: their events, and step by step their
//! derivatives, by the return map alone.

use crate::contact::{AssumedStart, ContactLaw, Motion, Residual, ReturnMapJacobian};
use crate::fourier::{Harmonics, SampleTable};
use faer::Mat;
use std::f64::consts::TAU;

/// Instants between which a change of state is looked for, beside the turning points.
const INSTANTS: usize = 128;
/// Angle that shows what a law does at an instant. About a turning point a shorter one would show
/// rounding.
const SHORT: f64 = 1e-8;
/// Angle to which an event is located.
const LOCATED: f64 = 1e-10;
/// Distance of an event from a turning point, which is known exactly, at which it is the same.
const AT_TURN: f64 = 1e-6;
/// Share of a change that one half of an interval has if the change is a jump: of one that is smooth
/// each has about a half.
const JUMP: f64 = 0.8;
/// Change of a derivative, relative to the largest, that counts.
const CHANGE: f64 = 1e-6;
/// Distance from an event at which a law is asked, on its own side: as a share of the way to the next,
/// at least, and at most.
const ASIDE: [f64; 3] = [1e-6, 4.0 * SHORT, 0.25];
/// Rounds until a state has to repeat.
const MOST_ROUNDS: usize = 200;
/// Change of a state over a round, relative to the largest, that counts as none.
const PERIODIC: f64 = 1e-12;
/// Departure from the force of a spring over a period, relative to its range, that is rounding where a
/// contact touches its limit.
const GRAZES: f64 = 1e-9;

/// A law, or a part of one that remembers by itself, with its places among displacements and states.
pub(super) struct Part {
    pub(super) law: Box<dyn ContactLaw>,
    pub(super) first: usize,
    pub(super) states: std::ops::Range<usize>,
    pub(super) stiffness: Mat<f64>,
}

/// Relative displacements over a period.
pub(super) struct Displacements<'a> {
    pub(super) harmonics: &'a Harmonics,
    pub(super) series: &'a [f64],
    /// What contacts keep that never slip in both senses.
    pub(super) residual: Residual,
}

impl Displacements<'_> {
    /// Where a part begins by the rule of [`Residual`]; nothing of a law that has none.
    fn assumed(&self, part: &Part) -> Option<AssumedStart> {
        let (slots, table) = (self.harmonics.slots(), SampleTable::new(self.harmonics.clone()));
        let last = part.first + part.law.displacements();
        let displacement = &self.series[part.first * slots..last * slots];
        part.law.assumed(Motion { table: &table, displacement, residual: self.residual })
    }

    /// Those of a part at an angle.
    fn at(&self, part: &Part, theta: f64) -> Vec<f64> {
        let slots = self.harmonics.slots();
        let own = part.first..part.first + part.law.displacements();
        let point = |i: usize| &self.series[i * slots..(i + 1) * slots];
        own.map(|i| self.harmonics.jet(point(i), theta)[0]).collect()
    }

    fn turns(&self, part: &Part) -> Vec<f64> {
        let (slots, table) = (self.harmonics.slots(), SampleTable::new(self.harmonics.clone()));
        let mut found = Vec::new();
        let mut turns = Vec::new();
        for i in part.first..part.first + part.law.displacements() {
            table.turning_points(&self.series[i * slots..(i + 1) * slots], &mut turns);
            for turn in &turns {
                found.push(turn.theta);
                if self.harmonics.half_wave() {
                    found.push(turn.theta + 0.5 * TAU);
                }
            }
        }
        found
    }
}

/// What a part does on its way through a period.
pub(super) struct PartPath {
    /// State where the period begins.
    pub(super) start: Vec<f64>,
    /// Angles of its events.
    pub(super) events: Vec<f64>,
    /// Whether it is a spring of its stiffness for good.
    pub(super) linear: bool,
    /// Whether it is one that has slipped before: it touches its limit, and has another derivative on
    /// the other side.
    pub(super) touches: bool,
}

impl PartPath {
    /// Follows a part until its state repeats; nothing if it does not.
    pub(super) fn new(part: &Part, u: &Displacements<'_>) -> Option<Self> {
        let mut angles: Vec<f64> =
            (0..INSTANTS).map(|n| TAU * n as f64 / INSTANTS as f64).collect();
        let turns = u.turns(part);
        angles.extend(&turns);
        angles.sort_by(f64::total_cmp);
        angles.push(TAU);
        angles.dedup_by(|b, a| *b - *a < SHORT);
        let (start, slipped) = periodic(part, u, &angles)?;
        let mut search = Search { part, u, scale: 0.0, events: Vec::new() };
        let (mut state, mut linear) = (start.clone(), true);
        let mut known = Vec::with_capacity(angles.len());
        let mut spring = Spring::new(part);
        for (n, &theta) in angles.iter().enumerate() {
            if n > 0 {
                let mut jacobian = ReturnMapJacobian::default();
                let force = step(part, u, [angles[n - 1], theta], &mut state, &mut jacobian);
                linear &= is_linear(part, &jacobian);
                spring.follow(&u.at(part, theta), &force);
            }
            let here = search.tangent(theta, &state);
            search.scale = here.iter().fold(search.scale, |most, x| most.max(x.abs()));
            known.push((theta, state.clone(), here));
        }
        for pair in known.windows(2) {
            search.between(&pair[0], &pair[1]);
        }
        let nearest = |event: f64| {
            turns.iter().copied().find(|turn| (turn - event).abs() < AT_TURN).unwrap_or(event)
        };
        let events = search.events.iter().map(|event| nearest(*event)).collect();
        let touches = slipped && spring.departure() <= GRAZES;
        Some(Self { start, events, linear: linear || touches, touches })
    }
}

/// Takes the state of a part from one angle to another, and tells the force there.
pub(super) fn step(
    part: &Part,
    u: &Displacements<'_>,
    angles: [f64; 2],
    state: &mut [f64],
    jacobian: &mut ReturnMapJacobian,
) -> Vec<f64> {
    let [before, after] = angles.map(|theta| u.at(part, theta));
    let mut force = vec![0.0; after.len()];
    part.law.return_map(&before, &after, state, &mut force, Some(jacobian));
    force
}

/// The comparison of a law with the spring of its stiffness over a period: component by component the
/// ranges of the force and of what it differs by.
struct Spring<'a> {
    part: &'a Part,
    force: Vec<[f64; 2]>,
    rest: Vec<[f64; 2]>,
}

impl<'a> Spring<'a> {
    fn new(part: &'a Part) -> Self {
        let none = vec![[f64::INFINITY, f64::NEG_INFINITY]; part.law.displacements()];
        Self { part, force: none.clone(), rest: none }
    }

    fn follow(&mut self, displacement: &[f64], force: &[f64]) {
        for (i, f) in force.iter().enumerate() {
            let held =
                displacement.iter().enumerate().map(|(j, u)| self.part.stiffness[(i, j)] * u);
            let rest = f - held.sum::<f64>();
            for (range, value) in [(&mut self.force[i], *f), (&mut self.rest[i], rest)] {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
    }

    /// Largest departure, relative to the largest range of a force.
    fn departure(&self) -> f64 {
        let most = |ranges: &[[f64; 2]]| ranges.iter().map(|r| r[1] - r[0]).fold(0.0, f64::max);
        most(&self.rest) / most(&self.force)
    }
}

/// State at the start of the period, which repeats, and whether the part has slipped on the way to it.
fn periodic(part: &Part, u: &Displacements<'_>, angles: &[f64]) -> Option<(Vec<f64>, bool)> {
    let count = part.law.displacements();
    let assumed = u.assumed(part);
    // Of a law without that rule nothing is known but that it repeats.
    let told = assumed.is_some();
    let begun = assumed.map(|begun| (begun.displacement, begun.state));
    let (before, mut state) = begun.unwrap_or_else(|| part.law.beginning());
    let (mut force, mut jacobian) = (vec![0.0; count], ReturnMapJacobian::default());
    let first = u.at(part, 0.0);
    part.law.return_map(&before, &first, &mut state, &mut force, Some(&mut jacobian));
    let mut slipped = !jacobian.sticks();
    let displacements: Vec<Vec<f64>> = angles.iter().map(|theta| u.at(part, *theta)).collect();
    for _ in 0..MOST_ROUNDS {
        let before = state.clone();
        let mut largest = 0.0_f64;
        for pair in displacements.windows(2) {
            part.law.return_map(&pair[0], &pair[1], &mut state, &mut force, Some(&mut jacobian));
            slipped |= !jacobian.sticks();
            largest = state.iter().fold(largest, |most, z| most.max(z.abs()));
        }
        let change = state.iter().zip(&before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if change <= PERIODIC * largest {
            return Some((state, slipped && told));
        }
    }
    None
}

/// Whether a step is that of a spring.
fn is_linear(part: &Part, jacobian: &ReturnMapJacobian) -> bool {
    let (states, count) = (part.law.state_size(), part.law.displacements());
    let close = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-12 * scale;
    let kept = (0..states * states).all(|i| {
        let own = if i / states == i % states { 1.0 } else { 0.0 };
        close(jacobian.by_state[i], own, 1.0)
    });
    let scale = part.stiffness.norm_max();
    let follows = (0..count * count).all(|at| {
        let (i, j) = (at / count, at % count);
        let of_state: f64 = (0..states)
            .map(|z| jacobian.force_by_state[i * states + z] * jacobian.by_after[z * count + j])
            .sum();
        close(of_state + jacobian.force_by_after[at], part.stiffness[(i, j)], scale)
    });
    kept && follows && jacobian.sticks()
}

/// An angle with the state and the tangent there.
type Known = (f64, Vec<f64>, Vec<f64>);

/// The search for jumps of the tangent.
struct Search<'a> {
    part: &'a Part,
    u: &'a Displacements<'a>,
    scale: f64,
    events: Vec<f64>,
}

impl Search<'_> {
    /// Derivatives of a short step, as numbers of one kind: forces by displacements.
    fn tangent(&self, theta: f64, state: &[f64]) -> Vec<f64> {
        let mut state = state.to_vec();
        let mut jacobian = ReturnMapJacobian::default();
        step(self.part, self.u, [theta, theta + SHORT], &mut state, &mut jacobian);
        let (states, count) = (state.len(), self.part.law.displacements());
        let mut out = jacobian.force_by_after.clone();
        for i in 0..count {
            for j in 0..count {
                let of_state = (0..states).map(|z| {
                    jacobian.force_by_state[i * states + z] * jacobian.by_after[z * count + j]
                });
                out[i * count + j] += of_state.sum::<f64>();
            }
        }
        out
    }

    fn between(&mut self, a: &Known, b: &Known) {
        let change = difference(&a.2, &b.2);
        if change <= CHANGE * self.scale {
            return;
        }
        let length = b.0 - a.0;
        if length <= LOCATED {
            return self.events.push(b.0);
        }
        let middle = a.0 + 0.5 * length;
        let mut state = a.1.clone();
        step(self.part, self.u, [a.0, middle], &mut state, &mut ReturnMapJacobian::default());
        let tangent = self.tangent(middle, &state);
        let middle = (middle, state, tangent);
        for (from, to) in [(a, &middle), (&middle, b)] {
            if difference(&from.2, &to.2) >= JUMP * change {
                self.between(from, to);
            }
        }
    }
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Angles inside a stretch, beside the events at its ends.
pub(super) fn inside(start: f64, end: f64, theta: f64) -> f64 {
    let length = end - start;
    let aside = (ASIDE[0] * length).max(ASIDE[1]).min(ASIDE[2] * length);
    theta.clamp(start + aside, end - aside)
}
