//! What a contact has done at equidistant instants.

use super::march::scaled;
use super::samples::Samples;
use crate::contact::{Aft, ContactLaw, Motion};
use std::f64::consts::TAU;
use std::ops::Deref;

impl<L: Deref<Target: ContactLaw>> Aft<L> {
    /// States and forces at equidistant instants. Between two instants of the march the law goes on
    /// from the earlier one.
    pub(super) fn history(&self, motion: Motion<'_>, samples: usize) -> (Vec<f64>, Vec<f64>) {
        if self.is_sum() {
            let parts: Vec<_> =
                self.parts().iter().map(|part| part.history(motion, samples)).collect();
            let mut states = Vec::with_capacity(samples * self.law.state_size());
            for n in 0..samples {
                for (own, _) in &parts {
                    let width = own.len() / samples;
                    states.extend(&own[n * width..(n + 1) * width]);
                }
            }
            let mut forces = vec![0.0; samples * self.law.displacements()];
            for (_, own) in &parts {
                forces.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
            }
            return (states, forces);
        }
        let harmonics = motion.table.harmonics();
        let (slots, count) = (harmonics.slots(), self.law.displacements());
        let size = self.law.state_size();
        let grid = Samples::of(motion, self.samples);
        let stuck = self.stuck(&grid, motion.residual);
        let round = self.march(&grid, &self.begin(motion));
        let (mut states, mut forces) = (Vec::new(), Vec::new());
        for m in 0..samples {
            let theta = TAU * m as f64 / samples as f64;
            let u: Vec<f64> = motion
                .displacement
                .chunks_exact(slots)
                .map(|series| harmonics.jet(series, theta)[0])
                .collect();
            let instant = (m * self.samples / samples) % self.samples;
            let n = instant % grid.count;
            let sign = if instant < grid.count { 1.0 } else { grid.sign };
            let mut state = round.state[n * size..(n + 1) * size].to_vec();
            let mut force = vec![0.0; count];
            self.law.return_map(grid.at(n), &scaled(&u, sign), &mut state, &mut force, None);
            if let Some((load, _)) = stuck {
                let mean = if harmonics.has_mean() { load } else { 0.0 };
                force[0] = sign * (self.law.stiffness()[(0, 0)] * u[0] - mean);
                if size == 1 {
                    state[0] = force[0];
                }
            }
            states.extend(scaled(&state, sign));
            forces.extend(scaled(&force, sign));
        }
        (states, forces)
    }
}
