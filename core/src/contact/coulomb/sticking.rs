//! Whether a motion leaves the slider where it is: its traction stays within the cone, and it is pressed
//! together, throughout.

use super::constant::Constant;
use super::drive::Drive;
use super::law::{squared, Coulomb};
use crate::contact::{AssumedStart, ContactLaw as _, Motion, Unslipped};

/// Part of the cone that bounds leave to rounding.
const ROUNDING: f64 = 1e-12;

impl Coulomb {
    /// See [`crate::contact::ContactLaw::surely_slips`].
    pub(super) fn surely_moves(&self, motion: Motion<'_>) -> Option<bool> {
        match Constant::of(self, motion) {
            Some(constant) => constant.surely_slips(),
            None if self.surely_rests(motion) => Some(false),
            None => Drive::new(self, motion, !self.is_odd()).surely_moves().then_some(true),
        }
    }

    /// See [`crate::contact::ContactLaw::surely_sticks`]: the slider of a contact in one direction under a normal
    /// load that varies stays where it rests.
    pub(super) fn surely_rests(&self, motion: Motion<'_>) -> bool {
        let one = self.directions == 1 && !self.is_odd() && !motion.residual.follows_middle();
        one && Drive::new(self, motion, true).holds(self.tangential_stiffness * self.slider()[0])
    }

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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::contact::{Aft, Closure, HarmonicForce as _, Residual, SlipLoad};
    use crate::fourier::{Harmonics, SampleTable};
    use crate::test_numbers::random;

    /// What bounds say of a motion samples say as well, and they say it of every small one.
    #[test]
    fn bounds_are_those_of_all_instants() {
        let table = SampleTable::new(Harmonics::new(5, false));
        let slots = table.harmonics().slots();
        let residual = Residual::FromRest;
        let (mut sure, mut missed) = (0, 0);
        for case in 0..600 {
            let directions = 1 + case % 2;
            let normal = (case % 3 > 0).then_some(200.0);
            let closure = if normal.is_some() && case % 5 == 0 {
                Closure::Gap(-0.1)
            } else {
                Closure::Preload(20.0)
            };
            let law = Coulomb::new(directions, 0.4, 150.0, normal, closure).unwrap();
            let size = 0.01 * (1.0 + (case % 20) as f64);
            let displacement: Vec<f64> = (0..law.displacements() * slots)
                .map(|i| size * random(case * 97 + i) / (1.0 + (i % slots) as f64))
                .collect();
            let motion = Motion { table: &table, displacement: &displacement, residual };
            let begun = AssumedStart {
                displacement: vec![0.0; law.displacements()],
                state: vec![0.0; directions],
                rate: vec![0.5; law.displacements() * displacement.len()],
            };
            let bounded = law.surely_unslipped(&begun, motion);
            let instants: Vec<f64> = (0..4096)
                .flat_map(|n| {
                    let theta = std::f64::consts::TAU * f64::from(n) / 4096.0;
                    let series = displacement.chunks_exact(slots);
                    series.map(|s| table.harmonics().jet(s, theta)[0]).collect::<Vec<_>>()
                })
                .collect();
            let sampled = law.unslipped(&begun, &instants);
            match (bounded, sampled) {
                (Some(own), Some(all)) => {
                    assert_eq!((own.value, own.rate), (all.value, all.rate), "{case}");
                    sure += 1;
                }
                (Some(_), None) => unreachable!("{case}: it slips"),
                (None, Some(_)) => {
                    assert!(size > 0.02, "{case}: so little");
                    missed += 1;
                }
                (None, None) => {
                    let aft = Aft::new(Box::new(law), 128).unwrap();
                    let mut load = SlipLoad::default();
                    aft.slip_load(motion, false, &mut load);
                    assert!(load.active, "{case}");
                }
            }
        }
        assert!(sure > 150 && missed < sure, "{sure} {missed}");
    }

    /// What amplitudes say of rest is so, whatever presses, and they say it of every small motion.
    #[test]
    fn what_surely_rests_has_no_tangent() {
        let table = SampleTable::new(Harmonics::new(5, false));
        let slots = table.harmonics().slots();
        let mut sure = [0, 0];
        for case in 0..400 {
            let closure = if case % 3 == 0 { Closure::Gap(-0.1) } else { Closure::Preload(20.0) };
            let law = Coulomb::new(1, 0.4, 150.0, Some(200.0), closure).unwrap();
            let size = 0.01 * (1.0 + (case % 20) as f64);
            let displacement: Vec<f64> = (0..2 * slots)
                .map(|i| size * random(case * 89 + i) / (1.0 + (i % slots) as f64))
                .collect();
            let at = |residual| Motion { table: &table, displacement: &displacement, residual };
            assert!(!law.surely_sticks(at(Residual::Centred)), "its slider follows the motion");
            let motion = at(Residual::FromRest);
            let mut load = SlipLoad::default();
            law.slip_load(motion, true, &mut load);
            let rests = law.surely_sticks(motion);
            assert!(!(rests && load.active), "{case}: it slips");
            assert_eq!(law.surely_slips(motion) == Some(false), rests, "{case}");
            sure[usize::from(rests)] += 1;
            assert!(rests || size > 0.015, "{case}: so little");
        }
        assert!(sure.iter().all(|count| *count > 20), "{sure:?}");
    }
}
