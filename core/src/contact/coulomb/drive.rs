//! What drives a Coulomb contact through a period: its pull, its limit, and when it is closed.
//!
//! The traction depends on two functions of the angle alone: the pull `K = k_t u` of the stuck
//! spring and the limit `M = μN`.

use crate::contact::stick_slip::crossing;
use crate::contact::{Coulomb, Motion};
use crate::fourier::{Harmonics, SampleTable, TurningPoint};
use std::cell::OnceCell;
use std::f64::consts::{PI, TAU};

/// Part of a way that is rounding.
const ROUNDING: f64 = 1e-12;
/// Instants of a period that tell most motions from those that leave the slider where it is, at a tenth of the
/// price of a cycle.
const INSTANTS: usize = 16;

/// Way of the pull in a plane over the largest limit that nothing needs more of. The slip load K − t is a number of
/// the size of K, so that rounding hides what lies below that size over 1e16 in it. A contact that moves r times as
/// far as it slips at, r above R, has the traction of a spring R/r times as stiff but for about M/R, that is
/// K/(r R): with this R less than rounding. The slip equation, which has the time scale M/K', is that much less
/// stiff.
const FARTHEST: f64 = 1e8;

/// Pull and normal force of a periodic motion.
pub(super) struct Drive<'a> {
    pub(super) table: &'a SampleTable,
    /// Number of tangential directions.
    pub(super) directions: usize,
    pub(super) friction: f64,
    /// k_t, or a lower stiffness whose traction is the same to rounding.
    pub(super) stiffness: f64,
    /// Series of K, direction after direction.
    pub(super) pull: Vec<f64>,
    /// Series of `N₀ + k_n v`, its mean included; nothing if it is constant.
    pub(super) pressing: Option<Pressing>,
    /// N₀.
    pub(super) at_rest: f64,
    /// Slopes of the only direction of K on the grid of turning points, once they are asked for.
    slopes: OnceCell<Vec<f64>>,
}

/// A normal force that varies.
pub(super) struct Pressing {
    pub(super) series: Vec<f64>,
    /// Its slopes on the grid of turning points, once they are asked for.
    slopes: OnceCell<Vec<f64>>,
}

impl Pressing {
    pub(super) fn slopes(&self, table: &SampleTable) -> &[f64] {
        self.slopes.get_or_init(|| table.slopes(&self.series))
    }
}

/// When a contact is closed.
pub(super) enum Closed {
    Always,
    Never,
    /// From the first to the second angle of each, in order over one period.
    During(Vec<[f64; 2]>),
}

impl<'a> Drive<'a> {
    /// The drive of a law by a motion; `varies` tells whether its normal load does.
    pub(super) fn new(law: &Coulomb, motion: Motion<'a>, varies: bool) -> Self {
        let harmonics = motion.table.harmonics();
        let slots = harmonics.slots();
        let (tangential, normal) = motion.displacement.split_at(law.directions * slots);
        let pressing = law.normal_stiffness.filter(|_| varies).map(|k| {
            let mut series: Vec<f64> = normal.iter().map(|v| k * v).collect();
            series[0] += law.normal_at_rest();
            Pressing { series, slopes: OnceCell::new() }
        });
        let stiffness = enough(law, harmonics, tangential, pressing.as_ref());
        Self {
            table: motion.table,
            directions: law.directions,
            friction: law.friction,
            stiffness,
            pull: tangential.iter().map(|u| stiffness * u).collect(),
            pressing,
            at_rest: law.normal_at_rest(),
            slopes: OnceCell::new(),
        }
    }

    /// Slopes of the only direction of K on the grid of turning points.
    pub(super) fn slopes(&self) -> &[f64] {
        self.slopes.get_or_init(|| self.table.slopes(self.pull(0)))
    }

    /// Whether amplitudes alone show that the contact is closed and the limit never reaches a slider that rests
    /// there, of a contact in one direction.
    pub(super) fn holds(&self, slider: f64) -> bool {
        let least = self.pressing.as_ref().map_or(self.at_rest, |pressing| {
            let series = &pressing.series;
            series[0] - swing(series)
        });
        let farthest = (self.pull[0] - slider).abs() + swing(&self.pull);
        self.harmonics().has_mean() && least >= 0.0 && farthest <= self.friction * least
    }

    pub(super) fn harmonics(&self) -> &'a Harmonics {
        self.table.harmonics()
    }

    /// Series of one direction of K.
    pub(super) fn pull(&self, direction: usize) -> &[f64] {
        let slots = self.harmonics().slots();
        &self.pull[direction * slots..(direction + 1) * slots]
    }

    /// Both directions of K at an angle, and `N₀ + k_n v`, with their first two derivatives.
    pub(super) fn jets(&self, theta: f64) -> [[f64; 3]; 3] {
        let harmonics = self.harmonics();
        let at_rest = [self.at_rest, 0.0, 0.0];
        match (self.directions, &self.pressing) {
            (2, Some(pressing)) => {
                harmonics.jets([self.pull(0), self.pull(1), &pressing.series], theta)
            }
            (2, None) => {
                let [x, y] = harmonics.jets([self.pull(0), self.pull(1)], theta);
                [x, y, at_rest]
            }
            (_, Some(pressing)) => {
                let [x, pressing] = harmonics.jets([self.pull(0), &pressing.series], theta);
                [x, [0.0; 3], pressing]
            }
            (_, None) => [harmonics.jet(self.pull(0), theta), [0.0; 3], at_rest],
        }
    }

    /// K and its slope at an angle, and `N₀ + k_n v` with its slope.
    pub(super) fn at(&self, theta: f64) -> ([[f64; 2]; 2], [f64; 2]) {
        let [x, y, pressing] = self.jets(theta).map(|[value, slope, _]| [value, slope]);
        ([x, y], pressing)
    }

    /// Where the first direction of K is least, and where it is largest.
    pub(super) fn extremes(&self) -> [TurningPoint; 2] {
        let mut turns = Vec::new();
        self.table.turning_points_by(self.pull(0), self.slopes().to_vec(), &mut turns);
        let still = TurningPoint { theta: 0.0, value: self.pull[0] };
        let by_value = |a: &&TurningPoint, b: &&TurningPoint| a.value.total_cmp(&b.value);
        let trough = turns.iter().min_by(by_value).copied().unwrap_or(still);
        let crest = turns.iter().max_by(by_value).copied().unwrap_or(still);
        [trough, crest]
    }

    /// Series of M, its mean included; a single number if it is constant.
    pub(super) fn limit(&self) -> Vec<f64> {
        match &self.pressing {
            Some(pressing) => pressing.series.iter().map(|n| self.friction * n).collect(),
            None => vec![self.friction * self.at_rest],
        }
    }

    /// Numbers that describe a variation of the limit M: its coefficients, or one if it is constant.
    pub(super) fn limit_columns(&self) -> usize {
        self.pressing.as_ref().map_or(1, |pressing| pressing.series.len())
    }

    /// Numbers that describe a variation of K and M.
    pub(super) fn columns(&self) -> usize {
        self.pull.len() + self.limit_columns()
    }

    /// Whether a few instants show that the slider moves or the contact opens: those at which the fundamentals
    /// reach farthest, and as many others as tell most motions. A slider at rest would have to be within the
    /// limit at all of them.
    pub(super) fn surely_moves(&self) -> bool {
        let mut before: Vec<([f64; 2], f64)> = Vec::new();
        let others = (0..INSTANTS).map(|n| TAU * n as f64 / INSTANTS as f64);
        self.farthest().into_iter().chain(others).any(|theta| {
            let ([x, y], [pressing, _]) = self.at(theta);
            let (pull, limit) = ([x[0], y[0]], self.friction * pressing.max(0.0));
            let moves = before.iter().any(|(from, least)| {
                let way = (pull[0] - from[0]).hypot(pull[1] - from[1]);
                (1.0 - ROUNDING) * way > limit + least
            });
            before.push((pull, limit));
            moves || (self.pressing.is_some() && pressing < 0.0)
        })
    }

    /// Where the fundamental of the pressing force is least, and two instants between which those of the walls,
    /// or of the pull in two directions, have the longest way.
    fn farthest(&self) -> Vec<f64> {
        let Some(slot) = self.harmonics().slot(1) else { return Vec::new() };
        let pair = |series: &[f64]| [series[slot], series[slot + 1]];
        let crest = |[cosine, sine]: [f64; 2]| sine.atan2(cosine);
        let pressed = self.pressing.as_ref().map_or([0.0; 2], |pressing| pair(&pressing.series));
        let least = crest(pressed) + PI;
        let pull = pair(&self.pull);
        if self.directions == 1 {
            let wall = |sign: f64| {
                let by = sign * self.friction;
                crest([0, 1].map(|i| pull[i] - by * pressed[i]))
            };
            return vec![wall(1.0), wall(-1.0) + PI, least];
        }
        // |K|² of the fundamentals varies as cos 2θ.
        let across = pair(self.pull(1));
        let [c, s] = [0, 1].map(|i| [pull[i], across[i]]);
        let along = 2.0 * (c[0] * s[0] + c[1] * s[1]);
        let theta = 0.5 * along.atan2(c[0] * c[0] + c[1] * c[1] - s[0] * s[0] - s[1] * s[1]);
        vec![theta, theta + PI, least]
    }

    /// When the contact is closed.
    pub(super) fn closed(&self) -> Closed {
        let Some(pressing) = &self.pressing else {
            return Closed::Always;
        };
        let series = &pressing.series;
        if series[0] <= -swing(series) {
            return Closed::Never;
        } else if is_closed(series) {
            return Closed::Always;
        }
        let mut turns = Vec::new();
        self.table.turning_points_by(series, pressing.slopes(self.table).to_vec(), &mut turns);
        if turns.iter().all(|turn| turn.value >= 0.0) {
            return Closed::Always;
        } else if turns.iter().all(|turn| turn.value <= 0.0) {
            return Closed::Never;
        }
        let span = self.harmonics().span();
        let mut changes = Vec::new();
        for (index, from) in turns.iter().enumerate() {
            let to = turns.get(index + 1).copied().unwrap_or_else(|| shifted(turns[0], span));
            if (from.value > 0.0) != (to.value > 0.0) {
                changes.push((self.touch(series, *from, to), to.value > 0.0));
            }
        }
        // The contact closes and opens in turn.
        let first = usize::from(!changes[0].1);
        let next = |index: usize| {
            let turn = (first + index) / changes.len();
            changes[(first + index) % changes.len()].0 + turn as f64 * span
        };
        Closed::During((0..changes.len() / 2).map(|n| [next(2 * n), next(2 * n + 1)]).collect())
    }

    /// Where the contact closes or opens between two turning points of `N₀ + k_n v`.
    fn touch(&self, series: &[f64], from: TurningPoint, to: TurningPoint) -> f64 {
        let mut theta = crossing(self.harmonics(), series, from, to, 0.0);
        // The slider is fixed by where the contact closes: to rounding, even close to a turn.
        for _ in 0..2 {
            let [value, slope, _] = self.harmonics().jet(series, theta);
            let next = theta - value / slope;
            if next > from.theta && next < to.theta {
                theta = next;
            }
        }
        theta
    }
}

/// The stiffness of a contact in a plane, or as much of it as makes it move [`FARTHEST`].
fn enough(
    law: &Coulomb,
    harmonics: &Harmonics,
    tangential: &[f64],
    pressing: Option<&Pressing>,
) -> f64 {
    let stiffness = law.tangential_stiffness;
    if law.directions == 1 {
        return stiffness;
    }
    let ways = tangential.chunks_exact(harmonics.slots());
    let way: f64 = ways.flat_map(|way| &way[harmonics.offset()..]).map(|u| u.abs()).sum();
    let pressed = pressing
        .map_or(law.normal_at_rest(), |pressing| pressing.series.iter().map(|n| n.abs()).sum());
    let most = FARTHEST * law.friction * pressed;
    if most > 0.0 && stiffness * way > most {
        most / way
    } else {
        stiffness
    }
}

/// How far a normal force may leave its mean.
fn swing(series: &[f64]) -> f64 {
    series[1..].chunks_exact(2).map(|pair| pair[0].hypot(pair[1])).sum()
}

/// Whether a normal force cannot vanish. Without a number in it nothing opens: the caller sees it
/// diverge.
fn is_closed(series: &[f64]) -> bool {
    let swing = swing(series);
    series[0] >= swing || series[0].is_nan() || swing.is_nan()
}

/// A turning point, `by` later.
pub(super) fn shifted(turn: TurningPoint, by: f64) -> TurningPoint {
    TurningPoint { theta: turn.theta + by, ..turn }
}
