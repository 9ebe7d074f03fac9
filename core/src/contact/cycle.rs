//! The path of an elastic, perfectly plastic element over one period, from event to event.

use super::Motion;
use crate::fourier::{Harmonics, TurningPoint};
use std::f64::consts::PI;

/// Turning points per period that a motion has as a rule.
const USUAL_TURNS: usize = 8;

/// An interval of the period in which the element sticks. The slip load is constant there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stick {
    pub(super) start: f64,
    pub(super) end: f64,
    /// Turning point at which the last slip ended; its displacement fixes the slip load.
    pub(super) anchor: f64,
    pub(super) slip_load: f64,
}

/// An interval in which the element slips with force `sign * F_d`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slip {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) sign: f64,
    pub(super) travel: f64,
}

/// The path of an element over the span its series is followed.
#[derive(Debug)]
pub(super) enum Cycle {
    /// A slider without friction, or without spring: the slip load is `k_d u`.
    Free,
    /// No slip; the two turning points that bound the displacement.
    Stuck { crest: TurningPoint, trough: TurningPoint },
    /// Stick and slip in turn.
    Slipping { sticks: Vec<Stick>, slips: Vec<Slip> },
}

impl Cycle {
    /// Follows an element of stiffness k_d and slip force F_d over the span of the series.
    pub(super) fn new(motion: Motion<'_>, stiffness: f64, slip_force: f64) -> Self {
        if slip_force == 0.0 || stiffness == 0.0 {
            return Self::Free;
        }
        let harmonics = motion.table.harmonics();
        let mut turns = Vec::with_capacity(USUAL_TURNS);
        motion.table.turning_points(motion.displacement, &mut turns);
        let (crest, trough) = extremes(harmonics, &turns, motion.displacement);
        let range = crest.value - trough.value;
        // A displacement that is not a number has no turning points: the caller sees it diverge.
        if turns.is_empty() || stiffness * range <= 2.0 * slip_force {
            return Self::Stuck { crest, trough };
        }
        let path = path_from_crest(harmonics, &turns);
        Self::follow(harmonics, motion.displacement, &path, stiffness, slip_force)
    }

    /// Marches along the turning points of `path`. At its start, the largest displacement, the
    /// force is known: a range above 2 F_d/k_d has pushed it to the limit.
    fn follow(
        harmonics: &Harmonics,
        series: &[f64],
        path: &[TurningPoint],
        k: f64,
        limit: f64,
    ) -> Self {
        let mut sticks = Vec::with_capacity(path.len());
        let mut slips = Vec::with_capacity(path.len());
        let start = path[0];
        let sign = if start.value >= path[1].value { 1.0 } else { -1.0 };
        let mut stick = Stick {
            start: start.theta,
            end: start.theta,
            anchor: start.theta,
            slip_load: k * start.value - sign * limit,
        };
        for ends in path.windows(2) {
            let (from, to) = (ends[0], ends[1]);
            let sign = (to.value - from.value).signum();
            let onset = (stick.slip_load + sign * limit) / k;
            if sign * (to.value - onset) <= 0.0 {
                continue;
            }
            let (theta, value) = if sign * (from.value - onset) >= 0.0 {
                (from.theta, from.value)
            } else {
                (crossing(harmonics, series, from, to, onset), onset)
            };
            stick.end = theta;
            sticks.push(stick);
            slips.push(Slip {
                start: theta,
                end: to.theta,
                sign,
                travel: (to.value - value).abs(),
            });
            stick = Stick {
                start: to.theta,
                end: to.theta,
                anchor: to.theta,
                slip_load: k * to.value - sign * limit,
            };
        }
        stick.end = path[path.len() - 1].theta;
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
fn crossing(
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
