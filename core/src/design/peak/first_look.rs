//! Where a search for the highest point looks first.

use super::samples::Sample;
use crate::fourier::Measure;
use crate::model::{Model, Resonance};
use crate::Error;

/// Fewest intervals of an even look at the range, and most where only stuck and free frequencies are
/// known.
const INTERVALS: [usize; 2] = [8, 24];
/// Length of an even interval that no resonance slips through, in bandwidths of the narrowest.
const BANDWIDTHS: f64 = 3.0;
/// Resonances closer than this share of a bandwidth to a point are seen from there; of those whose
/// height is not known, which are many and lie close, the second.
pub(super) const SEEN: [f64; 2] = [0.5, 1.0];
/// Points closer than this share of an even interval stand for each other.
const BESIDE: f64 = 0.02;
/// Maxima from this share of the highest are looked at again in the next response.
const RIVAL: f64 = 0.7;

/// When a top is known.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Precision {
    /// Gain in height, relative, that is not worth another point.
    pub(super) gain: f64,
    /// The same in the last steps to where the slope vanishes: the frequency errs by the root of it,
    /// in bandwidths.
    pub(super) flat: f64,
    /// How many times the error of an interpolant, as its width tells, is allowed for.
    pub(super) caution: f64,
}

/// What is looked for.
#[derive(Debug, Clone)]
pub(super) struct Aim {
    /// DOFs, group by group; the highest of each group is sought.
    pub(super) groups: Vec<Vec<usize>>,
    /// Measure of their amplitudes.
    pub(super) measure: Measure,
    /// Range of frequencies [rad/s].
    pub(super) span: (f64, f64),
    pub(super) precision: Precision,
    /// Points after which a search ends in any case.
    pub(super) most_points: usize,
}

/// A resonance inside the range.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    /// Where it is met [rad/s].
    pub(super) at: f64,
    /// Its half-power bandwidth [rad/s].
    pub(super) bandwidth: f64,
    /// How high it may be, group by group.
    pub(super) reach: Vec<f64>,
}

impl Candidate {
    /// How high any group may be.
    pub(super) fn highest(&self) -> f64 {
        self.reach.iter().copied().fold(0.0, f64::max)
    }
}

/// The first look at a range.
#[derive(Debug, Clone)]
pub(super) struct FirstLook {
    /// Frequencies from end to end: even ones, and those of maxima of a similar response.
    pub(super) omega: Vec<f64>,
    /// Resonances, to be looked at unless they cannot be the highest.
    pub(super) candidates: Vec<Candidate>,
    /// A resonance that a group shows and friction does not bound [rad/s].
    pub(super) unbounded: Vec<Option<f64>>,
}

impl FirstLook {
    /// At a model whose response has the `harmonics`, after a similar response.
    ///
    /// # Errors
    /// An eigenvalue iteration that fails.
    pub(super) fn new(
        model: &Model,
        aim: &Aim,
        harmonics: impl Iterator<Item = usize>,
        seeds: &[Sample],
    ) -> Result<Self, Error> {
        let (low, high) = aim.span;
        let resonances = match sees_all(model, aim.span) {
            true => Vec::new(),
            false => model.resonances(aim.span, harmonics)?,
        };
        let reach = |one: &Resonance, group: &[usize]| {
            let highest = |reach: &Vec<f64>| group.iter().map(|&i| reach[i]).fold(0.0, f64::max);
            one.reach.as_ref().map_or(f64::INFINITY, highest)
        };
        let unbounded = aim
            .groups
            .iter()
            .map(|group| {
                let grows = |one: &&Resonance| group.iter().any(|dof| one.unbounded.contains(dof));
                resonances.iter().find(grows)
            })
            .map(|one| one.map(|one| one.omega))
            .collect();
        let narrowest = resonances.iter().filter(|one| one.forced).map(|one| one.bandwidth);
        let narrowest = narrowest.fold(high - low, f64::min).max(1e-9 * high);
        let needed = ((high - low) / (BANDWIDTHS * narrowest)).ceil();
        let [least, most] = INTERVALS;
        let resolved = needed <= most as f64;
        // Where the states are known each of their resonances is looked at.
        let intervals = match (model.knows_its_states(), resolved) {
            (true, _) => least,
            (false, true) => least.max(needed as usize),
            (false, false) => most,
        };
        let spacing = (high - low) / intervals as f64;
        let mut omega: Vec<f64> = (1..intervals).map(|i| low + i as f64 * spacing).collect();
        omega.extend(rivals(seeds));
        // The ends stand for what lies too close to them.
        let distance = BESIDE * spacing;
        omega.retain(|w| (low + distance..=high - distance).contains(w));
        omega.sort_by(f64::total_cmp);
        omega.dedup_by(|a, b| (*a - *b).abs() < distance);
        omega.insert(0, low);
        omega.push(high);
        let candidates = resonances
            .iter()
            .map(|one| Candidate {
                at: one.omega,
                bandwidth: one.bandwidth,
                reach: aim.groups.iter().map(|group| reach(one, group)).collect(),
            })
            .collect();
        Ok(Self { omega, candidates, unbounded })
    }

    /// The narrowest bandwidth of a resonance, relative to its frequency.
    pub(super) fn narrowest(&self) -> f64 {
        let bandwidths = self.candidates.iter().map(|one| one.bandwidth / one.at);
        bandwidths.fold(f64::INFINITY, f64::min)
    }
}

/// Whether the even look alone sees all resonances whose height is not known: their frequencies, which
/// take a decomposition of a whole ring, need not be.
fn sees_all(model: &Model, (low, high): (f64, f64)) -> bool {
    let compliance = model.compliance();
    let order = compliance.forced_harmonics().into_iter().max().unwrap_or(1).max(1);
    let bandwidth = compliance.narrowest_bandwidth() / order as f64;
    // A point that stands for others lies up to `BESIDE` of an interval from them.
    let farthest = (0.5 + BESIDE) * (high - low) / INTERVALS[0] as f64;
    !model.knows_its_states() && farthest <= SEEN[1] * bandwidth
}

/// Frequencies at which a curve of a similar response has a maximum near its highest.
fn rivals(seeds: &[Sample]) -> Vec<f64> {
    let mut omega = Vec::new();
    for curve in 0..seeds.first().map_or(0, |seed| seed.knots.len()) {
        let highest = seeds.iter().map(|seed| seed.knots[curve].height).fold(0.0, f64::max);
        for three in seeds.windows(3) {
            let [a, b, c] = [&three[0], &three[1], &three[2]].map(|seed| seed.knots[curve]);
            if b.height >= a.height && b.height > c.height && b.height >= RIVAL * highest {
                omega.push(b.at);
            }
        }
    }
    omega
}
