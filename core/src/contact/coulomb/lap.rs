//! A lap of straight steps along the samples of a motion.
//!
//! The slider is swept by the cone, a convex set that moves with the motion: two sliders never come farther
//! from one another (Moreau 1977), and slip brings them together.

use super::law::{squared, Coulomb};
use crate::contact::lap::Lap;

impl Coulomb {
    /// See [`crate::contact::ContactLaw::lap`].
    pub(super) fn straight_lap(&self, lap: &mut Lap<'_>) {
        match (self.directions, self.normal_stiffness.is_some()) {
            (1, false) => self.passed::<1, 1>(lap),
            (1, true) => self.passed::<1, 2>(lap),
            (_, false) => self.passed::<2, 2>(lap),
            (_, true) => self.passed::<2, 3>(lap),
        }
    }

    /// With D directions of C displacements: steps of a length that is known take no calls.
    #[inline(always)]
    fn passed<const D: usize, const C: usize>(&self, lap: &mut Lap<'_>) {
        let [k, mu] = [self.tangential_stiffness, self.friction];
        let count = lap.displacement.len() / C;
        let all = lap.displacement;
        let at = |n: usize| -> [f64; C] { std::array::from_fn(|i| all[n * C + i]) };
        let mut state: [f64; D] = std::array::from_fn(|i| lap.state[i]);
        let mut u = at(0);
        let mut from = self.pressing(&u);
        let (mut departure, mut met) = (None, false);
        for n in 0..count {
            if lap.meets(n, &state) {
                met = true;
                // What is left is that of the lap before.
                departure = lap.departure.filter(|last| *last >= n).or(departure);
                break;
            }
            lap.states[n * D..(n + 1) * D].copy_from_slice(&state);
            let force = &mut lap.forces[n * C..(n + 1) * C];
            force[..D].copy_from_slice(&state);
            if C > D {
                force[D] = from.max(0.0) - self.balanced();
            }
            let next = if n + 1 < count { at(n + 1) } else { at(0).map(|u| lap.sign * u) };
            let to = self.pressing(&next);
            let du = self.pair(|i| next[i] - u[i]);
            let trial = self.pair(|i| state[i] + k * (next[i] - u[i]));
            let limit = mu * to;
            let sticks = from > 0.0 && to > 0.0 && squared(trial) <= limit * limit;
            let traction = if sticks {
                trial
            } else {
                let passage = self.step(self.pair(|i| state[i]), du, from, to);
                // Slip that begins with the end of the step is none.
                if !(from > 0.0 && passage.open == 0.0 && passage.slipping == 0.0) {
                    departure = Some(n);
                }
                passage.traction
            };
            (0..D).for_each(|i| state[i] = traction[i]);
            lap.largest = state.iter().fold(lap.largest, |most, t| most.max(t.abs()));
            (u, from) = (next, to);
        }
        lap.departure = departure;
        if !met {
            lap.end.iter_mut().zip(state).for_each(|(end, t)| *end = lap.sign * t);
        }
    }
}
