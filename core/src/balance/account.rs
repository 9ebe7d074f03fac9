//! What a point may spend, and what looks between the points of a sweep may.

use crate::timing::Profile;

/// Evaluations that a point may take before any harmonics are solved, up to this multiple of its work: many nodes
/// that open and close take 1500.
const EVALUATIONS: f64 = 2000.0;
const UNSOLVED: f64 = 6.0;
/// Work that looks between points may take over that of the points so far: tangents take about as much as the
/// points, a curve that is followed some fifty times as much as one of them.
const SHARE: f64 = 4.0;
/// Work that looks may take in any case \[ns\].
pub(super) const LITTLE: f64 = 1e9;

/// What a point may spend and has spent.
#[derive(Default)]
pub(super) struct Account {
    /// Work granted \[ns\] …
    granted: f64,
    /// … since all the work and evaluations before it.
    begun: f64,
    evaluations: usize,
    /// Work of searches for orbits.
    pub(super) searched: f64,
    /// Whether some harmonics are solved.
    solved: bool,
}

impl Account {
    pub(super) fn open(granted: f64, profile: &Profile) -> Self {
        let Profile { work: begun, evaluations, .. } = *profile;
        Self { granted, begun, evaluations, ..Self::default() }
    }

    /// What is left after all that has been done.
    pub(super) fn left(&self, profile: &Profile) -> f64 {
        let taken = profile.work - self.begun;
        let count = (profile.evaluations - self.evaluations).max(1) as f64;
        let dear = EVALUATIONS * (taken - self.searched) / count;
        let most = if self.solved { self.granted } else { UNSOLVED * self.granted };
        dear.clamp(self.granted, most) - taken
    }

    /// Some harmonics are solved: what is granted is for those above them.
    pub(super) fn begin_to_climb(&mut self, profile: &Profile) {
        if !self.solved {
            self.solved = true;
            self.granted += profile.work - self.begun;
        }
    }
}

/// The work of a sweep \[ns\].
#[derive(Default)]
pub(super) struct Looks {
    /// Of its points.
    pub(super) points: f64,
    /// Of looks between them.
    pub(super) taken: f64,
}

impl Looks {
    /// What is left of what looks may take.
    pub(super) fn left(&self) -> f64 {
        (SHARE * self.points).max(LITTLE) - self.taken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a point that is not solved yet dear evaluations get more, searches do not; what is granted is for
    /// harmonics above.
    #[test]
    fn dear_evaluations_are_waited_for_until_some_harmonics_are_solved() {
        let mut profile = Profile::default();
        let mut account = Account::open(1e9, &profile);
        (profile.evaluations, profile.work) = (100, 1e8);
        assert_eq!(account.left(&profile), EVALUATIONS * 1e6 - 1e8);
        profile.work = 3.4e9;
        assert_eq!(account.left(&profile), UNSOLVED * 1e9 - 3.4e9);
        account.searched = 3.39e9;
        assert_eq!(account.left(&profile), 1e9 - 3.4e9);
        account.begin_to_climb(&profile);
        assert_eq!(account.left(&profile), 1e9);
    }

    /// Looks take a multiple of what the points have taken, and little in any case.
    #[test]
    fn looks_are_earned_by_points() {
        let left = |points: f64, taken: f64| Looks { points, taken }.left();
        assert_eq!(left(0.0, 0.0), LITTLE);
        assert_eq!(left(LITTLE, 0.0), SHARE * LITTLE);
        assert!(left(LITTLE, SHARE * LITTLE) <= 0.0);
    }
}
