//! The value of a parameter that makes a peak least.
//!
//! As a function of the parameter the peak is the highest of several smooth maxima: continuous,
//! with a kink wherever two of them swap, and it is often least just there. Its exact slope says
//! on which side of a minimum a value lies.

use super::curve::{Curve, Follower, Peak, Target};
use super::member::objective;
use crate::balance::{Kept, PointStatus, Progress, Settings};
use crate::model::{Model, Variation};
use crate::Error;
use std::time::Instant;

/// Values of the coarse curve.
const COARSE: usize = 40;
/// Gain, relative, that is not worth another peak.
const GAIN: f64 = 1e-8;
/// Shortest bracket, relative to the value.
const SHORTEST: f64 = 1e-7;
/// Share of the work that the coarse curve is, for the progress.
const CURVE_SHARE: f64 = 0.7;
/// Slope, relative, of a curve on which nothing slips any more.
const FLAT: f64 = 1e-9;
/// Times that a curve which turns unseen between two values is halved there.
const HALVINGS: usize = 4;
/// Times that the least peak is looked for afresh, …
const CONFIRMATIONS: usize = 5;
/// … by how much, relative, what is found then refutes it, …
const REFUTED: f64 = 1e-6;
/// … and values how near to it, relative, are refuted with it.
const NEAR: f64 = 0.1;

/// The least peak, and how it was found.
#[derive(Debug, Clone)]
pub struct Optimum {
    /// Every local minimum, the least first.
    pub minima: Vec<Peak>,
    /// All peaks computed, by value.
    pub curve: Curve,
}

/// A value of the parameter with what is to be made least and its slope.
#[derive(Debug, Clone, Copy)]
struct Trial {
    peak: Peak,
    height: f64,
    slope: f64,
}

/// Finds every local minimum of the peak over `bounds` that a curve of logarithmically spaced
/// values shows, refined to a relative gain of 1e-8. With automatic harmonics minima count as one
/// if the rise between them is below twice the tolerance. `kept` takes the peaks as they are found.
///
/// # Errors
/// Bounds that are not positive and ordered, or as for the curve.
pub fn optimum(
    model: &Model,
    settings: Settings,
    variation: &Variation,
    (low, high): (f64, f64),
    target: &Target,
    progress: &Progress<'_>,
    kept: Option<&Kept<Peak>>,
) -> Result<Optimum, Error> {
    let start = Instant::now();
    if !(low > 0.0 && low < high && high.is_finite()) {
        return Err(Error::value("bounds: upper", high, "must lie above the lower one, above 0"));
    }
    let quest = target.quest();
    let mut follower = Follower::new(model, settings, variation, &quest, progress)?;
    follower.kept = kept;
    let mut trials = Vec::new();
    for i in 0..COARSE {
        let share = i as f64 / (COARSE - 1) as f64;
        let value = if i + 1 == COARSE { high } else { low * (high / low).powf(share) };
        trials.extend(try_value(&mut follower, value, CURVE_SHARE * share)?);
    }
    for _ in 0..HALVINGS {
        let hidden: Vec<f64> = trials
            .windows(2)
            .filter(|ends| turns_unseen(ends[0], ends[1]))
            .map(|ends| 0.5 * (ends[0].peak.value + ends[1].peak.value))
            .collect();
        for value in hidden {
            insert(&mut trials, try_value(&mut follower, value, CURVE_SHARE)?);
        }
    }
    let mut minima = local_minima(&mut follower, &mut trials, (low, high))?;
    for _ in 0..CONFIRMATIONS {
        // What searches that start from each other have missed, one that starts afresh may see.
        let Some(least) = minima.first().copied().filter(|_| !follower.interrupted) else { break };
        // Once that has come to pass all others do, too, or they would miss it again.
        follower.afresh = true;
        let Some(again) = try_value(&mut follower, least.peak.value, 1.0)? else { break };
        if again.height <= least.height * (1.0 + REFUTED) {
            break;
        }
        let near = |trial: &Trial| (trial.peak.value / least.peak.value - 1.0).abs() < NEAR;
        trials.retain(|trial| !near(trial));
        insert(&mut trials, Some(again));
        minima = local_minima(&mut follower, &mut trials, (low, high))?;
    }
    // With automatic harmonics or samples both sides of a dent are known to the tolerance only.
    let depth = if settings.is_automatic() { 2.0 * settings.tolerance } else { 0.0 };
    let minima = prominent(minima, &trials, depth);
    let missing = std::mem::take(&mut follower.missing);
    let mut peaks: Vec<Peak> = trials.iter().map(|trial| trial.peak).chain(missing).collect();
    peaks.sort_by(|a, b| a.value.total_cmp(&b.value));
    let minima = minima.into_iter().map(|trial| trial.peak).collect();
    Ok(Optimum { minima, curve: follower.finish(peaks, start) })
}

/// The minima that the trials show, closed in on, the least first.
fn local_minima(
    follower: &mut Follower<'_>,
    trials: &mut Vec<Trial>,
    (low, high): (f64, f64),
) -> Result<Vec<Trial>, Error> {
    let brackets: Vec<[Trial; 2]> = trials
        .windows(2)
        .filter(|ends| ends[0].slope < 0.0 && ends[1].slope > 0.0)
        .map(|ends| [ends[0], ends[1]])
        .collect();
    let mut minima = Vec::new();
    if let (Some(first), Some(last)) = (trials.first(), trials.last()) {
        // Beside values without a peak a curve that falls towards them has no minimum.
        let least = |end: &Trial, bound: f64, falls: bool| falls && end.peak.value == bound;
        minima.extend(least(first, low, first.slope >= 0.0).then_some(*first));
        minima.extend(least(last, high, last.slope <= 0.0).then_some(*last));
    }
    for (index, bracket) in brackets.iter().enumerate() {
        let share = CURVE_SHARE + (1.0 - CURVE_SHARE) * index as f64 / brackets.len() as f64;
        minima.push(refine(follower, *bracket, trials, share)?);
    }
    // A response that is highest where a contact is about to slip turns its slope at once: what lies
    // lower than every minimum that slopes show is closed in on by height.
    while let Some(lowest) = lowest(trials) {
        let known = minima.iter().map(|one| one.height).fold(f64::INFINITY, f64::min);
        if follower.interrupted || trials[lowest].height >= known * (1.0 - GAIN) {
            break;
        }
        minima.push(descend(follower, lowest, trials)?);
    }
    minima.sort_by(|a, b| a.height.total_cmp(&b.height));
    Ok(minima)
}

/// The peak at a value, if it is found.
fn try_value(follower: &mut Follower<'_>, value: f64, share: f64) -> Result<Option<Trial>, Error> {
    let peak = follower.peak(value, share)?;
    let solved = peak.status.is_solved();
    if !solved || !peak.amplitude.is_finite() {
        if peak.status != PointStatus::NotComputed {
            follower.missing.push(peak);
        }
        return Ok(None);
    }
    let (height, slope) = objective(follower.variation, value, peak.amplitude, peak.slope);
    Ok(Some(Trial { peak, height, slope }))
}

fn insert(trials: &mut Vec<Trial>, trial: Option<Trial>) {
    if let Some(trial) = trial {
        let at = trials.partition_point(|other| other.peak.value < trial.peak.value);
        trials.insert(at, trial);
    }
}

/// Whether the curve falls from one end into the interval but ends higher, without a rise at the
/// other end: a minimum and a maximum lie between. So does a minimum, perhaps, where it falls onto what
/// is flat: from a dip the peak of a contact that just slips rises to that of one that sticks.
fn turns_unseen(a: Trial, b: Trial) -> bool {
    let falls_in = a.slope < 0.0 && b.slope <= 0.0 && b.height > a.height;
    let rises_out = b.slope > 0.0 && a.slope >= 0.0 && a.height > b.height;
    let onto_flat = a.slope < 0.0 && !is_flat(a) && is_flat(b);
    let from_flat = b.slope > 0.0 && !is_flat(b) && is_flat(a);
    falls_in || rises_out || onto_flat || from_flat
}

fn is_flat(trial: Trial) -> bool {
    (trial.slope * trial.peak.value).abs() <= FLAT * trial.height
}

/// Drops every minimum that a rise of less than the share `depth` parts from a lower one.
fn prominent(minima: Vec<Trial>, trials: &[Trial], depth: f64) -> Vec<Trial> {
    let mut kept: Vec<Trial> = Vec::new();
    for minimum in minima {
        let parted = |lower: &Trial| {
            let (one, two) = (lower.peak.value, minimum.peak.value);
            let between = one.min(two)..=one.max(two);
            let inside = trials.iter().filter(|trial| between.contains(&trial.peak.value));
            let top = inside.map(|trial| trial.height).fold(0.0, f64::max);
            top > (1.0 + depth) * minimum.height
        };
        if kept.iter().all(parted) {
            kept.push(minimum);
        }
    }
    kept
}

/// Position of the lowest trial.
fn lowest(trials: &[Trial]) -> Option<usize> {
    (0..trials.len()).min_by(|&a, &b| trials[a].height.total_cmp(&trials[b].height))
}

/// Closes in on the minimum around the lowest trial by halving the intervals beside it.
fn descend(
    follower: &mut Follower<'_>,
    mut at: usize,
    trials: &mut Vec<Trial>,
) -> Result<Trial, Error> {
    for _ in 0..60 {
        let value = trials[at].peak.value;
        let beside = [at.checked_sub(1), Some(at + 1)].into_iter().flatten();
        let ends = beside.filter_map(|i| trials.get(i)).map(|end| end.peak.value);
        let wide = |end: &f64| (end - value).abs() > SHORTEST * value;
        let middles: Vec<f64> = ends.filter(wide).map(|end| 0.5 * (value + end)).collect();
        if middles.is_empty() || follower.interrupted {
            break;
        }
        let before = trials.len();
        for middle in middles {
            insert(trials, try_value(follower, middle, 1.0)?);
        }
        if trials.len() == before {
            break;
        }
        at = lowest(trials).unwrap_or(at);
    }
    Ok(trials[at])
}

/// Closes in on the minimum between a falling and a rising end. Cubics find a smooth minimum and
/// the crossing of the tangents finds a kink, in turns; halving guards both.
fn refine(
    follower: &mut Follower<'_>,
    [mut a, mut b]: [Trial; 2],
    trials: &mut Vec<Trial>,
    share: f64,
) -> Result<Trial, Error> {
    let mut earlier = [f64::INFINITY; 2];
    for step in 0..60 {
        let width = b.peak.value - a.peak.value;
        let best = if a.height <= b.height { a } else { b };
        let crossing = (b.height - a.height - b.slope * width) / (a.slope - b.slope);
        // Where the curve is convex no point of the bracket lies below these.
        let convex = (0.0..=width).contains(&crossing);
        let floor = (a.height + a.slope * crossing).max(best.height - best.slope.abs() * width);
        let closed = convex && best.height - floor <= GAIN * best.height;
        if closed || width <= SHORTEST * b.peak.value {
            break;
        }
        let halve = !convex || width > 0.5 * earlier[1];
        earlier = [width, earlier[0]];
        let shift = if halve {
            0.5 * width
        } else if step % 2 == 0 {
            crossing
        } else {
            cubic(a, b).unwrap_or(crossing)
        };
        let value = a.peak.value + shift.clamp(0.001 * width, 0.999 * width);
        let mut tried = try_value(follower, value, share)?;
        // A value without a peak is passed by.
        for part in [0.5, 0.4, 0.6, 0.25, 0.75] {
            if tried.is_none() && !follower.interrupted {
                tried = try_value(follower, a.peak.value + part * width, share)?;
            }
        }
        let Some(trial) = tried else { break };
        insert(trials, Some(trial));
        if trial.slope < 0.0 {
            a = trial;
        } else {
            b = trial;
        }
    }
    Ok(if a.height <= b.height { a } else { b })
}

/// Distance from `a` to the minimum of the cubic through both ends.
fn cubic(a: Trial, b: Trial) -> Option<f64> {
    let width = b.peak.value - a.peak.value;
    let s = a.slope + b.slope - 3.0 * (b.height - a.height) / width;
    let root = (s * s - a.slope * b.slope).sqrt();
    let shift = width * (1.0 - (b.slope + root - s) / (b.slope - a.slope + 2.0 * root));
    (shift > 0.0 && shift < width).then_some(shift)
}
