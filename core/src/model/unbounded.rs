//! Resonances that nothing bounds: nothing damps the structure with all limited points slipping, and the load
//! brings in more work than friction can take.
//!
//! That balance says nothing where forces grow with the motion: of a cubic spring, a stop, friction under a
//! normal load that the motion changes.

use super::contact_states::State;
use super::resonances::{driven, square_wave, Bearing, NOISE};
use super::Model;
use crate::Error;

/// Decay, over the highest natural frequency, that is rounding of none.
const UNDAMPED: f64 = 1e-14;

impl Model {
    /// The lowest frequency of the excitation inside `[low, high]` at which nothing bounds one of some DOFs, as
    /// far as that is known [rad/s].
    ///
    /// # Errors
    /// An eigenvalue iteration that fails.
    pub fn unbounded(&self, (low, high): (f64, f64), dofs: &[usize]) -> Result<Option<f64>, Error> {
        if !self.knows_its_states() {
            return Ok(None);
        }
        let forced = self.compliance.forced_harmonics();
        let limits: Vec<f64> = self.slip_limits().collect();
        let slips: Vec<bool> = limits.iter().map(|limit| limit.is_finite()).collect();
        let planes: Vec<[usize; 2]> = self.planes().collect();
        let mut found: Option<f64> = None;
        for harmonic in forced.into_iter().filter(|&k| k > 0) {
            let state = self.state(self.diameter(harmonic), &slips, 0.0)?;
            let (load, share) = (self.load(harmonic), square_wave(1, 1));
            let bearing =
                Bearing { load: &load, limits: &limits, stiffness: &[], planes: &planes, share };
            for (j, pole) in state.poles.values.iter().enumerate() {
                let omega = pole.im / harmonic as f64;
                let right = state.poles.right.col(j);
                let shown = NOISE * right.norm_l2();
                if (low..=high).contains(&omega)
                    && dofs.iter().any(|&dof| right[dof].norm() > shown)
                    && self.nothing_bounds(&bearing, &state, j, pole.re.abs())
                {
                    found = Some(found.map_or(omega, |known| known.min(omega)));
                }
            }
        }
        Ok(found)
    }

    /// Whether neither the decay of a pole nor any force bounds a motion in a state in which all slips.
    pub(super) fn nothing_bounds(
        &self,
        bearing: &Bearing<'_>,
        state: &State,
        pole: usize,
        decay: f64,
    ) -> bool {
        let highest = state.poles.values.iter().map(|s| s.norm()).fold(0.0, f64::max);
        // A motion that grows without a bound makes square waves of its own harmonic.
        let whole = Bearing { share: square_wave(1, 1), ..*bearing };
        decay <= UNDAMPED * highest
            && whole.driven(state, pole) > whole.friction(state, pole)
            && !self.grows(state, pole)
    }

    /// Pairs of contact points that slip in a plane.
    pub(super) fn planes(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let mut first = 0;
        self.laws.iter().flat_map(move |law| {
            let own = first;
            first += law.displacements();
            law.planes().into_iter().map(move |plane| plane.map(|i| own + i))
        })
    }

    /// Whether a contact that a resonance moves may carry more than its limits.
    fn grows(&self, state: &State, pole: usize) -> bool {
        let grows: Vec<bool> = self.laws.iter().flat_map(|law| law.grows()).collect();
        let mut first = 0;
        self.laws.iter().any(|law| {
            let own = first..first + law.displacements();
            first = own.end;
            own.clone().any(|i| state.contacts[pole][i][1] > 0.0)
                && own.into_iter().any(|i| grows[i] && self.moves(state, i, &grows))
        })
    }

    /// Whether loads, or slip of contacts whose forces do not grow, move a contact point.
    fn moves(&self, state: &State, point: usize, grows: &[bool]) -> bool {
        let mut poles = state.contacts.iter().enumerate();
        poles.any(|(pole, contacts)| {
            let slips =
                || contacts.iter().zip(grows).any(|([effect, _], grows)| *effect > 0.0 && !grows);
            let loaded =
                || self.ports.loads.iter().any(|load| driven(state, pole, &load.amplitude) > 0.0);
            contacts[point][1] > 0.0 && (slips() || loaded())
        })
    }
}
