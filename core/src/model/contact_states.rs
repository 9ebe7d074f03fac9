//! States of the contacts in which every point sticks or slips, with the poles of each.

use super::body::Body;
use crate::contact::ContactLaw;
use crate::structure::Poles;
use crate::Error;
use faer::{c64, Mat};
use std::sync::OnceLock;

/// States of the contacts, at most: all of a few points; of more the stuck and the slipping one, and
/// those in which one point differs from all others.
pub(super) const MOST_STATES: usize = 16;
/// Shares of their stiffness that points carry at higher harmonics when they slip in a part of the period.
const CARRIED: [f64; 3] = [0.25, 0.5, 0.75];
/// DOFs above which only stuck and free natural frequencies are known.
pub(super) const MOST_DOFS: usize = 400;
/// The same of rings of sectors, whose searches are many and take no matrices of the whole.
const MOST_IN_RING: usize = 60;

/// Poles of a state, by what load and slip forces do to them and what the DOFs show of them.
#[derive(Debug)]
pub(super) struct State {
    pub(super) poles: Poles,
    /// Effect of a unit force at every contact point on every pole, poles by points, none where it is rounding.
    pub(super) effects: Mat<c64>,
    /// Size of that effect, none of points that stick, and
    /// what the point shows of it.
    pub(super) contacts: Vec<Vec<[f64; 2]>>,
    /// What of a slip limit a traction in each plane does to every pole, over what a force along a line does.
    pub(super) planes: Vec<Vec<f64>>,
    /// Which points slip.
    pub(super) slips: Vec<bool>,
    /// Share of the stiffness that these carry all the same: they slip in a part of the period.
    pub(super) carried: f64,
    /// Whether all points that can slip do.
    pub(super) all: bool,
}

/// The states of a model per nodal diameter, found when they are first needed.
#[derive(Debug)]
pub(super) struct States {
    pub(super) diameters: Vec<OnceLock<Result<Vec<State>, Error>>>,
}

impl States {
    pub(super) fn of(body: &Body, dofs: usize) -> Self {
        let count = match body {
            Body::Wave { cyclic, .. } => cyclic.sectors,
            Body::Whole => usize::from(dofs <= MOST_DOFS),
            Body::Ring(_) => usize::from(dofs <= MOST_IN_RING),
        };
        Self { diameters: (0..count).map(|_| OnceLock::new()).collect() }
    }
}

/// Which points always slip, and which never do: what the states of a model depend on.
pub(super) fn slip_kinds(laws: &[Box<dyn ContactLaw>]) -> Vec<(bool, bool)> {
    let limits = laws.iter().flat_map(|law| law.limits());
    limits.map(|limit| (limit == 0.0, limit.is_infinite())).collect()
}

/// The points that slip in each state that matters, the stuck and the slipping one if others would make more than
/// `most`: those without friction always do, those without a limit never.
pub(super) fn slip_sets(limits: &[f64], most: usize) -> Vec<Vec<bool>> {
    let either: Vec<usize> =
        (0..limits.len()).filter(|&i| limits[i] > 0.0 && limits[i].is_finite()).collect();
    let state = |slips: &dyn Fn(usize) -> bool| -> Vec<bool> {
        let mut state: Vec<bool> = limits.iter().map(|limit| *limit == 0.0).collect();
        either.iter().enumerate().for_each(|(position, &i)| state[i] = slips(position));
        state
    };
    let count = either.len();
    if count < usize::BITS as usize && 1 << count <= most {
        return (0..1 << count).map(|mask: usize| state(&|i| mask >> i & 1 == 1)).collect();
    }
    let mut sets = vec![state(&|_| false), state(&|_| true)];
    if 2 * (count + 1) <= 2 * most {
        sets.extend((0..count).flat_map(|one| [state(&|i| i == one), state(&|i| i != one)]));
    }
    sets
}

/// The points that slip in a part of the period in each of these states, all or, of a few, one, and the share of
/// their stiffness that they carry.
pub(super) fn partial_sets(limits: &[f64], most: usize) -> Vec<(Vec<bool>, f64)> {
    let mut sets = slip_sets(limits, most);
    let count = |slips: &[bool]| slips.iter().filter(|slips| **slips).count();
    let all_counts: Vec<usize> = sets.iter().map(|slips| count(slips)).collect();
    let least = all_counts.iter().copied().min().unwrap_or(0);
    let highest = all_counts.iter().copied().max().unwrap_or(0);
    let few = sets.len() <= most;
    let matters = |own: usize| own > least && (own == highest || few && own == least + 1);
    sets.retain(|slips| matters(count(slips)));
    sets.iter().flat_map(|slips| CARRIED.map(|carried| (slips.clone(), carried))).collect()
}
