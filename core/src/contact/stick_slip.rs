//! The cycles of elastic, perfectly plastic elements over one period, from event to event.

use super::Motion;
use crate::fourier::{Harmonics, TurningPoint};
use std::f64::consts::PI;

/// Turning points per period that a motion has as a rule.
pub(super) const USUAL_TURNS: usize = 8;

/// An interval of the period in which the element sticks. The slip load is constant there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stick {
    pub(super) start: f64,
    pub(super) end: f64,
    /// Turning point of the path, by position, at which the last slip ended and this interval
    /// starts; its displacement fixes the slip load.
    pub(super) anchor: usize,
    pub(super) slip_load: f64,
}

/// An interval in which the element slips with force `sign * F_d`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slip {
    pub(super) start: f64,
    pub(super) end: f64,
    /// Turning point of the path, by position, at which it ends.
    pub(super) turn: usize,
    pub(super) sign: f64,
    pub(super) travel: f64,
}

/// A displacement at the crest of its fundamental and half a period later: it ranges at least as far.
pub(super) fn at_crest(motion: Motion<'_>) -> [f64; 2] {
    let harmonics = motion.table.harmonics();
    let pairs = motion.displacement[harmonics.offset()..].chunks_exact(2);
    let crest = pairs.clone().next().map_or(0.0, |pair| pair[1].atan2(pair[0]));
    let mut parts = [harmonics.mean(motion.displacement), 0.0];
    for (&order, pair) in harmonics.oscillating().iter().zip(pairs) {
        let (sine, cosine) = (order as f64 * crest).sin_cos();
        parts[order % 2] += pair[0] * cosine + pair[1] * sine;
    }
    [parts[0] + parts[1], parts[0] - parts[1]]
}

/// A displacement from turning point to turning point, which all elements on it share.
#[derive(Debug)]
pub(super) struct Path<'a> {
    harmonics: &'a Harmonics,
    series: &'a [f64],
    /// The two turning points that bound the displacement over the whole period.
    pub(super) crest: TurningPoint,
    pub(super) trough: TurningPoint,
    /// Turning points over one span, beginning and ending at the largest displacement (at its
    /// mirror image under half-wave symmetry); none if the displacement is constant.
    pub(super) turns: Vec<TurningPoint>,
}

impl<'a> Path<'a> {
    pub(super) fn new(motion: Motion<'a>) -> Self {
        let (harmonics, series) = (motion.table.harmonics(), motion.displacement);
        let mut turns = Vec::with_capacity(USUAL_TURNS);
        motion.table.turning_points(series, &mut turns);
        let (crest, trough) = extremes(harmonics, &turns, series);
        // A displacement that is not a number has no turning points: the caller sees it diverge.
        let turns = if turns.is_empty() { turns } else { path_from_crest(harmonics, &turns) };
        Self { harmonics, series, crest, trough, turns }
    }

    /// Middle of the displacement.
    pub(super) fn middle(&self) -> f64 {
        0.5 * (self.crest.value + self.trough.value)
    }

    /// Half the range of the displacement.
    pub(super) fn half_range(&self) -> f64 {
        0.5 * (self.crest.value - self.trough.value)
    }

    /// Adds multiples of the basis at crest and trough to the first row of a tangent, if there is one.
    pub(super) fn add_extremes(&self, [high, low]: [f64; 2], tangent: &mut [f64]) {
        let size = self.harmonics.slots();
        if tangent.is_empty() {
            return;
        }
        let mut basis = vec![0.0; size];
        for (factor, point) in [(high, self.crest), (low, self.trough)] {
            self.harmonics.basis(point.theta, &mut basis);
            tangent[..size].iter_mut().zip(&basis).for_each(|(slope, b)| *slope += factor * b);
        }
    }

    /// The angle of the span that the path covers at which the motion is as at `theta`, and the sign
    /// of its image there.
    pub(super) fn fold(&self, theta: f64) -> (f64, f64) {
        let (start, span) =
            (self.turns.first().map_or(0.0, |turn| turn.theta), self.harmonics.span());
        let turns = ((theta - start) / span).floor();
        let mirror = self.harmonics.half_wave() && turns.rem_euclid(2.0) != 0.0;
        (theta - turns * span, if mirror { -1.0 } else { 1.0 })
    }
}

/// The cycle of an element over the span its series is followed.
#[derive(Debug)]
pub(super) enum StickSlipIntervals {
    /// A slider without friction, or without spring: the slip load is `k_d u`.
    Free,
    /// No slip.
    Stuck,
    /// Stick and slip in turn.
    Slipping { sticks: Vec<Stick>, slips: Vec<Slip> },
}

impl StickSlipIntervals {
    /// Follows an element of stiffness k_d and slip force F_d along a path.
    pub(super) fn new(path: &Path<'_>, stiffness: f64, slip_force: f64) -> Self {
        if slip_force == 0.0 || stiffness == 0.0 {
            return Self::Free;
        }
        let range = path.crest.value - path.trough.value;
        if path.turns.is_empty() || stiffness * range <= 2.0 * slip_force {
            return Self::Stuck;
        }
        Self::follow(path, stiffness, slip_force)
    }

    /// Marches along the turning points of a path. At its start, the largest displacement, the
    /// force is known: a range above 2 F_d/k_d has pushed it to the limit.
    fn follow(path: &Path<'_>, k: f64, limit: f64) -> Self {
        let turns = &path.turns;
        let mut sticks = Vec::with_capacity(turns.len());
        let mut slips = Vec::with_capacity(turns.len());
        let start = turns[0];
        let sign = if start.value >= turns[1].value { 1.0 } else { -1.0 };
        let slip_load = k * start.value - sign * limit;
        let mut stick = Stick { start: start.theta, end: start.theta, anchor: 0, slip_load };
        for (index, ends) in turns.windows(2).enumerate() {
            let (from, to) = (ends[0], ends[1]);
            let sign = (to.value - from.value).signum();
            let onset = (stick.slip_load + sign * limit) / k;
            if sign * (to.value - onset) <= 0.0 {
                continue;
            }
            let (theta, value) = if sign * (from.value - onset) >= 0.0 {
                (from.theta, from.value)
            } else {
                (crossing(path.harmonics, path.series, from, to, onset), onset)
            };
            stick.end = theta;
            sticks.push(stick);
            let travel = (to.value - value).abs();
            slips.push(Slip { start: theta, end: to.theta, turn: index + 1, sign, travel });
            let slip_load = k * to.value - sign * limit;
            stick = Stick { start: to.theta, end: to.theta, anchor: index + 1, slip_load };
        }
        stick.end = turns[turns.len() - 1].theta;
        sticks.push(stick);
        Self::Slipping { sticks, slips }
    }
}

/// Highest and lowest turning point over the whole period.
fn extremes(
    harmonics: &Harmonics,
    turns: &[TurningPoint],
    series: &[f64],
) -> (TurningPoint, TurningPoint) {
    let rest = TurningPoint { theta: 0.0, value: harmonics.mean(series) };
    let highest = turns.iter().copied().max_by(|a, b| a.value.total_cmp(&b.value)).unwrap_or(rest);
    let lowest = turns.iter().copied().min_by(|a, b| a.value.total_cmp(&b.value)).unwrap_or(rest);
    if !harmonics.half_wave() {
        return (highest, lowest);
    }
    let mirror = |p: TurningPoint| TurningPoint { theta: p.theta + PI, value: -p.value };
    if highest.value >= -lowest.value {
        (highest, mirror(highest))
    } else {
        (mirror(lowest), lowest)
    }
}

/// Turning points in order over one span, beginning and ending at the largest displacement (at
/// its mirror image under half-wave symmetry).
fn path_from_crest(harmonics: &Harmonics, turns: &[TurningPoint]) -> Vec<TurningPoint> {
    let size = |p: &TurningPoint| if harmonics.half_wave() { p.value.abs() } else { p.value };
    let first =
        (0..turns.len()).max_by(|&a, &b| size(&turns[a]).total_cmp(&size(&turns[b]))).unwrap_or(0);
    let sign = if harmonics.half_wave() { -1.0 } else { 1.0 };
    let span = harmonics.span();
    let wrapped = turns[..=first.min(turns.len().saturating_sub(1))]
        .iter()
        .map(|p| TurningPoint { theta: p.theta + span, value: sign * p.value });
    turns[first..].iter().copied().chain(wrapped).collect()
}

/// Angle at which the monotone arc between two turning points takes the value `target`: Halley's
/// method from the angle of a cosine arc, kept inside its bracket.
pub(super) fn crossing(
    harmonics: &Harmonics,
    series: &[f64],
    from: TurningPoint,
    to: TurningPoint,
    target: f64,
) -> f64 {
    let rise = to.value - from.value;
    let share = ((target - from.value) / rise).clamp(0.0, 1.0);
    let (mut low, mut high) = (from.theta, to.theta);
    let mut theta = low + (high - low) * (1.0 - 2.0 * share).acos() / PI;
    for _ in 0..80 {
        let [value, slope, curvature] = harmonics.jet(series, theta);
        let excess = (value - target) * rise.signum();
        if excess > 0.0 {
            high = theta;
        } else {
            low = theta;
        }
        let step = (value - target) / slope;
        let halley = theta - step / (1.0 - 0.5 * step * curvature / slope);
        let next = if halley >= low - 1e-12 && halley <= high + 1e-12 {
            halley
        } else {
            0.5 * (low + high)
        };
        let moved = (next - theta).abs();
        theta = next;
        // Halley's method cubes its error, and the force is continuous here: after a step this
        // short the integrals are good to rounding.
        if moved <= 1e-6 {
            break;
        }
    }
    theta
}
