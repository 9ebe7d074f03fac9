//! A lap of straight steps along the samples of a motion.
//!
//! The slider is swept by the cone, a convex set that moves with the motion: two sliders never come farther
//! from one another (Moreau 1977), and slip brings them together.

use super::dual::{Dual, Real};
use super::law::{squared, Coulomb};
use crate::contact::lap::Lap;

/// Slip in a step, relative to the largest traction, that is a touch of the cone.
const TOUCH: f64 = 1e-6;

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
        let mut by: [[f64; D]; D] =
            std::array::from_fn(|i| std::array::from_fn(|j| if i == j { lap.sign } else { 0.0 }));
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
                let begun = self.pair(|i| Dual::<2>::variable(state[i], i));
                let passage = self.step(begun, du.map(Dual::from), from.into(), to.into());
                // Slip that begins with the end of the step is none.
                if !(from > 0.0 && passage.open == 0.0 && passage.slipping == 0.0) {
                    lap.departs = true;
                    let moved = passage.traction.iter().zip(trial);
                    let moved = moved.map(|(t, trial)| (t.value() - trial).abs());
                    if passage.open > 0.0 || moved.fold(0.0, f64::max) > TOUCH * lap.largest {
                        departure = Some(n);
                    }
                }
                by = std::array::from_fn(|i| {
                    let own = &passage.traction[i].slopes;
                    std::array::from_fn(|j| (0..D).map(|k| own[k] * by[k][j]).sum())
                });
                passage.traction.map(Real::value)
            };
            (0..D).for_each(|i| state[i] = traction[i]);
            lap.largest = state.iter().fold(lap.largest, |most, t| most.max(t.abs()));
            (u, from) = (next, to);
        }
        lap.departure = departure;
        if !met {
            lap.end.iter_mut().zip(state).for_each(|(end, t)| *end = lap.sign * t);
            lap.by.iter_mut().zip(by.iter().flatten()).for_each(|(to, by)| *to = *by);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::contact::{Closure, ContactLaw as _};
    use crate::test_numbers::random;

    const COUNT: usize = 40;

    struct Arrays {
        states: Vec<f64>,
        forces: Vec<f64>,
        end: Vec<f64>,
        by: Vec<f64>,
        departure: Option<usize>,
        largest: f64,
    }

    fn lap(law: &Coulomb, displacement: &[f64], state: &[f64], arrays: &mut Arrays) {
        let mut lap = Lap {
            displacement,
            sign: 1.0,
            state,
            states: &mut arrays.states,
            forces: &mut arrays.forces,
            end: &mut arrays.end,
            by: &mut arrays.by,
            departs: false,
            departure: arrays.departure,
            largest: arrays.largest,
            within: 1e-13,
        };
        assert!(law.lap(&mut lap));
        (arrays.departure, arrays.largest) = (lap.departure, lap.largest);
    }

    /// A lap takes the steps of the return map, says how its end follows its begin, and leaves the lap before
    /// where it meets it.
    #[test]
    fn laps_are_steps_one_after_the_other() {
        let mut departed = 0;
        for case in 0..60 {
            let directions = 1 + case % 2;
            let normal = (case % 3 > 0).then_some(200.0);
            let law = Coulomb::new(directions, 0.4, 150.0, normal, Closure::Preload(20.0)).unwrap();
            let width = law.displacements();
            let size = 0.02 * (1.0 + (case % 10) as f64);
            let displacement: Vec<f64> = (0..COUNT * width)
                .map(|i| {
                    let angle = std::f64::consts::TAU * (i / width) as f64 / COUNT as f64;
                    let phase = 7.0 * random(31 * case + i % width);
                    size * ((angle + phase).cos() + 0.5 * (2.0 * angle - phase).cos())
                })
                .collect();
            let fresh = || Arrays {
                states: vec![f64::NAN; COUNT * directions],
                forces: vec![0.0; COUNT * width],
                end: vec![0.0; directions],
                by: vec![0.0; directions * directions],
                departure: None,
                largest: 0.0,
            };
            let begun: Vec<f64> = (0..directions).map(|i| random(case + 3 * i)).collect();
            let mut arrays = fresh();
            lap(&law, &displacement, &begun, &mut arrays);
            let (mut state, mut force) = (begun.clone(), vec![0.0; width]);
            for n in 0..COUNT {
                let at = |n: usize| &displacement[(n % COUNT) * width..][..width];
                assert_eq!(arrays.states[n * directions..][..directions], state, "{case} {n}");
                if n > 0 {
                    assert_eq!(arrays.forces[n * width..][..width], force, "{case} {n}");
                }
                law.return_map(at(n), at(n + 1), &mut state, &mut force, None);
            }
            assert_eq!(arrays.end, state);
            departed += usize::from(arrays.departure.is_some());
            let step = 1e-6;
            for j in 0..directions {
                let ends = [step, -step].map(|by| {
                    let mut moved = begun.clone();
                    moved[j] += by;
                    let mut arrays = fresh();
                    lap(&law, &displacement, &moved, &mut arrays);
                    arrays.end
                });
                let own = arrays.by.chunks_exact(directions).map(|row| row[j]);
                for (own, (ahead, behind)) in own.zip(ends[0].iter().zip(&ends[1])) {
                    let slope = (ahead - behind) / (2.0 * step);
                    assert!((slope - own).abs() < 1e-5, "{case}: {slope} {own}");
                }
            }
            // The same lap again is met at once, another one where slip has brought both together.
            let known = arrays.states.clone();
            lap(&law, &displacement, &begun, &mut arrays);
            assert_eq!((&arrays.states, &arrays.end), (&known, &state));
            let other: Vec<f64> = begun.iter().map(|t| 0.5 * t).collect();
            let mut alone = fresh();
            lap(&law, &displacement, &other, &mut alone);
            lap(&law, &displacement, &other, &mut arrays);
            assert_eq!(arrays.departure, alone.departure, "{case}");
            for (met, own) in arrays.end.iter().zip(&alone.end) {
                assert!((met - own).abs() <= 1e-12 * alone.largest, "{case}");
            }
        }
        assert!(departed > 40, "{departed}");
    }
}
