//! Points at which there is nothing to be found: neither damping nor friction bounds a resonance there.

use super::forced::ForcedBalance;

/// Distance from such a resonance, over its frequency, at which a solution that fails does so by it: it is as many
/// times larger than the motion under a load at rest as rounding leaves of the digits.
const BESIDE: f64 = 1e-9;

impl ForcedBalance<'_> {
    /// Whether all resonances that nothing bounds are known beforehand.
    pub(crate) fn knows_what_has_no_bound(&self) -> bool {
        self.model.knows_what_is_unbounded()
    }

    /// Whether nothing bounds the motion at a frequency at which a solution has failed.
    pub(super) fn has_no_bound(&self, omega: f64) -> bool {
        let interrupted = self.interruption();
        let found = || self.model.unbounded_resonances(&|_| !interrupted());
        let all = || found().unwrap_or_default().into_iter().map(|(at, _)| at).collect();
        let known = self.unbounded.get_or_init(all);
        known.iter().any(|at| (omega - at).abs() <= BESIDE * at)
    }
}
