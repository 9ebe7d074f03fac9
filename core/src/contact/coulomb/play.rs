//! The cycle of a Coulomb contact in one tangential direction: the play operator.
//!
//! The scaled slider position s = k_t w lies between two moving walls, `K − M ≤ s ≤ K + M`. The
//! lower one pushes it up while it rises, the upper one down while it falls; between them it rests.
//! Both are series, so that all events are their turning points and crossings. While the contact
//! is open the slider follows, `s = K`, and the history is forgotten.

use super::cycle::{Cycle, State, Stretch};
use super::drive::{shifted, Closed, Drive};
use crate::contact::stick_slip::{crossing, USUAL_TURNS};
use crate::contact::Residual;
use crate::fourier::{Harmonics, TurningPoint};

/// A wall of the play, `K − σM`: with σ = 1 the lower one, which pushes while it rises.
struct Wall {
    sign: f64,
    series: Vec<f64>,
    /// Turning points over two periods, and one beyond them on either side.
    turns: Vec<TurningPoint>,
    /// Turning points in the first period.
    count: usize,
}

impl Wall {
    fn new(drive: &Drive<'_>, sign: f64) -> Self {
        let by = sign * drive.friction;
        let mut series = drive.pull.clone();
        let mut slopes = drive.slopes().to_vec();
        if let Some(pressing) = &drive.pressing {
            series.iter_mut().zip(&pressing.series).for_each(|(k, n)| *k -= by * n);
            let own = pressing.slopes(drive.table);
            slopes.iter_mut().zip(own).for_each(|(k, n)| *k -= by * n);
        } else {
            series[0] -= by * drive.at_rest;
        }
        let mut turns = Vec::with_capacity(2 * USUAL_TURNS);
        drive.table.turning_points_by(&series, slopes, &mut turns);
        let (count, span) = (turns.len(), drive.harmonics().span());
        let rest = TurningPoint { theta: 0.0, value: series[0] };
        let first = turns.first().copied().unwrap_or(rest);
        let last = turns.last().copied().unwrap_or(rest);
        turns.extend_from_within(..);
        turns[count..].iter_mut().for_each(|turn| *turn = shifted(*turn, span));
        turns.insert(0, shifted(last, -span));
        turns.push(shifted(first, 2.0 * span));
        Self { sign, series, turns, count }
    }

    /// Where the wall reaches farthest.
    fn farthest(&self) -> TurningPoint {
        let own = self.turns[1..].iter().take(self.count.max(1));
        let reach = |turn: &&TurningPoint| self.sign * turn.value;
        let farthest = own.max_by(|a, b| reach(a).total_cmp(&reach(b)));
        farthest.copied().unwrap_or(self.turns[0])
    }

    /// The first arc after an angle on which the wall moves beyond the slider.
    fn next_arc(&self, theta: f64, slider: f64) -> Option<[TurningPoint; 2]> {
        let moves = |arc: &&[TurningPoint]| {
            let [from, to] = [arc[0], arc[1]];
            to.theta > theta
                && self.sign * (to.value - from.value) > 0.0
                && self.sign * (to.value - slider) > 0.0
        };
        self.turns.windows(2).find(moves).map(|arc| [arc[0], arc[1]])
    }

    /// Where on an arc, after an angle, the wall reaches the slider.
    fn reaches(&self, harmonics: &Harmonics, arc: [TurningPoint; 2], theta: f64, s: f64) -> f64 {
        let [from, to] = arc;
        let onset = if self.sign * (from.value - s) >= 0.0 {
            from.theta
        } else {
            crossing(harmonics, &self.series, from, to, s)
        };
        onset.max(theta)
    }
}

/// Where the slider has last been left.
#[derive(Clone, Copy)]
enum Anchor {
    /// By the wall with this sign where it turned.
    Turn(f64, f64),
    /// By closing, where M changes by this much per change of K.
    Closing(f64, f64),
}

/// The play of one contact, which follows its walls.
struct Play<'a> {
    drive: &'a Drive<'a>,
    walls: [Wall; 2],
    /// Whether derivatives are wanted.
    rates: bool,
    cycle: Cycle,
}

/// The cycle of a contact in one direction. `rest` is the scaled slider position from which friction
/// has its history; `rates` asks for derivatives.
pub(super) fn cycle(drive: &Drive<'_>, residual: Residual, rest: f64, rates: bool) -> Cycle {
    let span = drive.harmonics().span();
    let closed = drive.closed();
    if let Closed::Never = closed {
        let state = State::Open;
        return Cycle::new(vec![Stretch { start: 0.0, end: span, state }], drive.columns());
    }
    if matches!(closed, Closed::Always) && !residual.follows_middle() && drive.holds(rest) {
        let state = State::Stuck { slider: [rest, 0.0], rate: vec![0.0; drive.columns()] };
        return Cycle::new(vec![Stretch { start: 0.0, end: span, state }], drive.columns());
    }
    let walls = [1.0, -1.0].map(|sign| Wall::new(drive, sign));
    let mut play = Play { drive, walls, rates, cycle: Cycle::new(Vec::new(), drive.columns()) };
    match closed {
        Closed::During(windows) => {
            for (index, [start, end]) in windows.iter().enumerate() {
                let ([[pull, slope], _], [_, growth]) = drive.at(*start);
                let follows = (slope / (drive.friction * growth)).clamp(-1.0, 1.0);
                play.follow(*start, *end, pull, Anchor::Closing(*start, follows));
                let next = windows.get(index + 1).map_or(windows[0][0] + span, |next| next[0]);
                play.push(*end, next, State::Open);
            }
        }
        _ => {
            let [lower, upper] = [play.walls[0].farthest(), play.walls[1].farthest()];
            if lower.value > upper.value {
                // Both push: where the lower wall turns farthest up it has the slider with it.
                let (start, anchor) = (lower.theta, Anchor::Turn(1.0, lower.theta));
                play.follow(start, start + span, lower.value, anchor);
            } else {
                // Whether it depends on the motion is always told.
                play.rates = true;
                let state = play.held(residual, rest, lower, upper);
                play.push(0.0, span, state);
            }
        }
    }
    play.cycle
}

/// The positions that the walls leave a slider which never moves: from the first to the second, none
/// if the first is the larger.
pub(super) fn room(drive: &Drive<'_>) -> [f64; 2] {
    [1.0, -1.0].map(|sign| Wall::new(drive, sign).farthest().value)
}

impl Play<'_> {
    fn push(&mut self, start: f64, end: f64, state: State) {
        self.cycle.stretches.push(Stretch { start, end, state });
    }

    /// Follows the slider while the contact is closed.
    fn follow(&mut self, start: f64, end: f64, slider: f64, anchor: Anchor) {
        let harmonics = self.drive.harmonics();
        let (mut theta, mut slider, mut anchor) = (start, slider, anchor);
        while theta < end {
            let mut arcs =
                [0, 1].map(|n| self.walls[n].next_arc(theta, slider).map(|arc| (n, arc)));
            arcs.sort_by(|a, b| {
                let start = |arc: &Option<(usize, [TurningPoint; 2])>| {
                    arc.as_ref().map_or(f64::INFINITY, |(_, arc)| arc[0].theta)
                };
                start(a).total_cmp(&start(b))
            });
            let mut push: Option<(f64, f64, TurningPoint)> = None;
            for (n, arc) in arcs.into_iter().flatten() {
                let before = push.map_or(end, |(onset, ..)| onset);
                if arc[0].theta < before {
                    let onset = self.walls[n].reaches(harmonics, arc, theta, slider);
                    if onset < before {
                        push = Some((onset, self.walls[n].sign, arc[1]));
                    }
                }
            }
            let onset = push.map_or(end, |(onset, ..)| onset);
            if onset > theta {
                let state = State::Stuck { slider: [slider, 0.0], rate: self.rate(anchor) };
                self.push(theta, onset, state);
            }
            let Some((onset, sign, turn)) = push else { return };
            theta = turn.theta.min(end);
            self.push(onset, theta, State::Along(sign));
            (slider, anchor) = (turn.value, Anchor::Turn(sign, turn.theta));
        }
    }

    /// Derivative of the slider position in the coefficients of K and M.
    fn rate(&self, anchor: Anchor) -> Vec<f64> {
        let (Anchor::Turn(by_limit, theta) | Anchor::Closing(theta, by_limit)) = anchor;
        let mut rate = vec![0.0; if self.rates { self.drive.columns() } else { 0 }];
        self.add_rate(theta, 1.0, -by_limit, &mut rate);
        rate
    }

    fn add_rate(&self, theta: f64, by_pull: f64, by_limit: f64, rate: &mut [f64]) {
        if rate.is_empty() {
            return;
        }
        let slots = self.drive.pull.len();
        let mut basis = vec![0.0; slots];
        self.drive.harmonics().basis(theta, &mut basis);
        let (pull, limit) = rate.split_at_mut(slots);
        pull.iter_mut().zip(&basis).for_each(|(rate, b)| *rate += by_pull * b);
        limit.iter_mut().zip(&basis).for_each(|(rate, b)| *rate += by_limit * b);
    }

    /// A contact that never slips: what is assumed of it, as far as the walls leave it.
    fn held(
        &self,
        residual: Residual,
        rest: f64,
        lower: TurningPoint,
        upper: TurningPoint,
    ) -> State {
        let ends = residual.follows_middle().then(|| self.drive.extremes());
        let middle = ends.map_or(rest, |[trough, crest]| 0.5 * (crest.value + trough.value));
        let [wanted] = residual.slider([middle], [rest]);
        let mut rate = vec![0.0; if self.rates { self.drive.columns() } else { 0 }];
        let slider = if wanted < lower.value {
            self.add_rate(lower.theta, 1.0, -1.0, &mut rate);
            lower.value
        } else if wanted > upper.value {
            self.add_rate(upper.theta, 1.0, 1.0, &mut rate);
            upper.value
        } else {
            for end in ends.into_iter().flatten() {
                self.add_rate(end.theta, 0.5, 0.0, &mut rate);
            }
            wanted
        };
        State::Stuck { slider: [slider, 0.0], rate }
    }
}
