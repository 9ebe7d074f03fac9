//! Whether a motion leaves the slider where it is: its traction stays within the cone, and it is pressed
//! together, throughout.

use super::law::{squared, Coulomb};
use crate::contact::{AssumedStart, ContactLaw as _, Motion, Unslipped};

/// Part of the cone that bounds leave to rounding.
const ROUNDING: f64 = 1e-12;

impl Coulomb {
    /// See [`crate::contact::ContactLaw::surely_unslipped`]: a series stays as near to its mean as the sum of
    /// its amplitudes.
    pub(super) fn within_bounds(
        &self,
        begun: &AssumedStart,
        motion: Motion<'_>,
    ) -> Option<Unslipped> {
        let harmonics = motion.table.harmonics();
        let bounds = |i: usize| {
            let series = &motion.displacement[i * harmonics.slots()..(i + 1) * harmonics.slots()];
            let (mean, turned) = series.split_at(usize::from(harmonics.has_mean()));
            let most: f64 = turned.chunks_exact(2).map(|pair| pair[0].hypot(pair[1])).sum();
            (mean.first().copied().unwrap_or(0.0), most)
        };
        let (k, offset) = (self.tangential_stiffness, self.offset(begun));
        let traction = self.pair(|i| {
            let (mean, most) = bounds(i);
            (k * mean - offset[i]).abs() + k * most
        });
        let pressing = self.normal_at_rest()
            + self.normal_stiffness.map_or(0.0, |k| {
                let (mean, most) = bounds(self.directions);
                k * (mean - most)
            });
        let limit = self.friction * (1.0 - ROUNDING) * pressing;
        let stays = limit > 0.0 && squared(traction) <= limit * limit;
        (stays && self.pressing(&begun.displacement) > 0.0).then(|| self.kept(begun))
    }

    /// See [`crate::contact::ContactLaw::unslipped`]. The cone is convex: what is in it at all instants does
    /// not leave it on the lines between them.
    pub(super) fn within_cone(
        &self,
        begun: &AssumedStart,
        displacement: &[f64],
    ) -> Option<Unslipped> {
        let (k, offset) = (self.tangential_stiffness, self.offset(begun));
        let inside = |u: &[f64]| {
            let limit = self.friction * self.pressing(u);
            let [x, y] = self.pair(|i| k * u[i] - offset[i]);
            limit > 0.0 && squared([x, y]) <= limit * limit
        };
        let mut instants = displacement.chunks_exact(self.displacements());
        let stays = self.pressing(&begun.displacement) > 0.0 && instants.all(inside);
        stays.then(|| self.kept(begun))
    }

    /// What a stuck spring's force is above the traction.
    fn offset(&self, begun: &AssumedStart) -> [f64; 2] {
        self.pair(|i| self.tangential_stiffness * begun.displacement[i] - begun.state[i])
    }

    fn kept(&self, begun: &AssumedStart) -> Unslipped {
        let (count, k) = (self.displacements(), self.tangential_stiffness);
        let mut value = self.offset(begun)[..self.directions].to_vec();
        value.resize(count, self.balanced() - self.normal_at_rest());
        let rows = begun.rate.len() / count * self.directions;
        Unslipped { value, rate: begun.rate[..rows].iter().map(|rate| k * rate).collect() }
    }
}
