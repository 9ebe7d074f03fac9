//! The derivative of a march whose state repeats whatever it begins with.
//!
//! Through a round the derivative of the state is affine in the one that it begins with, `R₁ = A R₀ + B`, and
//! as the state repeats, so does it: `R₀ = (1 − A)⁻¹ B`. One round tells A and B, and the harmonics of the
//! derivative of the force, which are affine in R₀, too.

use super::lap_derivative::LapDerivative;
use super::march::scaled;
use super::rate::Rate;
use super::restart::Restart;
use super::samples::Samples;
use crate::contact::{Aft, ContactLaw};
use crate::solve::multiply;
use faer::{Accum, Mat, MatMut, MatRef};
use std::ops::Deref;

/// Outer products that are summed at once: a tangent is passed through once for all of them.
const TOGETHER: usize = 32;

impl<L: Deref<Target: ContactLaw>> Aft<L> {
    /// Adds the derivative of a march to a tangent from the states of a round that repeats, instant after instant;
    /// `false` if it depends on what the march begins with.
    pub(super) fn differentiate_repeated(
        &self,
        samples: &Samples,
        states: &[f64],
        slots: usize,
        out: &mut [f64],
    ) -> bool {
        let size = self.law.state_size();
        let mut step = self.wrapped(samples, states);
        let mut rate = Rate::new(self.law.stiffness(), self.law.state_stiffness(), slots);
        let mut lap = LapDerivative::new(size);
        let mut products = Products::new(self.law.displacements(), size, slots);
        let mut sum = vec![0.0; slots];
        for n in 1..=samples.count {
            let told = Some([&mut sum[..], &mut *out]);
            let changes = self.advance_derived(samples, n, &mut step, &rate, told);
            let wraps = n == samples.count;
            if !wraps && !changes {
                continue;
            }
            products.add(&step.force_by_state, [rate.rows(), &lap.by], &sum, out);
            sum.fill(0.0);
            if changes {
                let sign = if wraps { samples.sign } else { 1.0 };
                let [before, after] = [n - 1, n].map(|n| samples.basis(n));
                rate.follow(&step.jacobian, Some(before), &scaled(after, sign));
                lap.advance(&step.jacobian.by_state);
            }
        }
        products.sum_up(out);
        let mirrored = |i, j| samples.sign * lap.by[i * size + j];
        match Restart::at_fixed_point(&Mat::from_fn(size, size, mirrored)) {
            Some(Restart::FixedPoint(inverse)) => {
                products.begin_with(&inverse, rate.rows(), samples.sign, out);
                true
            }
            _ => false,
        }
    }
}

/// Outer products of instants with the derivatives of forces there.
struct Products {
    slots: usize,
    states: usize,
    /// Summed basis of the products at hand, one after the other.
    sums: Vec<f64>,
    /// Derivatives of each force there.
    rows: Vec<Vec<f64>>,
    /// Sums of the basis times the derivative of each force in each number of the state that a round
    /// begins with.
    begin: Vec<f64>,
}

impl Products {
    fn new(displacements: usize, states: usize, slots: usize) -> Self {
        let begin = vec![0.0; displacements * states * slots];
        Self { slots, states, sums: Vec::new(), rows: vec![Vec::new(); displacements], begin }
    }

    /// Adds one, of the derivatives of the state in the coefficients of the motion and in the state that the
    /// round begins with.
    fn add(&mut self, force_by_state: &[f64], by: [&[f64]; 2], sum: &[f64], out: &mut [f64]) {
        let Self { slots, states, .. } = *self;
        let size = self.rows.len() * slots;
        self.sums.extend_from_slice(sum);
        for (i, (rows, by_state)) in
            self.rows.iter_mut().zip(force_by_state.chunks_exact(states)).enumerate()
        {
            let first = rows.len();
            rows.resize(first + size, 0.0);
            for (j, share) in by_state.iter().enumerate().filter(|(_, share)| **share != 0.0) {
                let own = rows[first..].iter_mut().zip(&by[0][j * size..(j + 1) * size]);
                own.for_each(|(row, rate)| *row += share * rate);
                for (k, through) in by[1][j * states..(j + 1) * states].iter().enumerate() {
                    let begin = &mut self.begin[(i * states + k) * slots..][..slots];
                    begin.iter_mut().zip(sum).for_each(|(begin, s)| *begin += share * through * s);
                }
            }
        }
        if self.sums.len() == TOGETHER * slots {
            self.sum_up(out);
        }
    }

    /// Adds the products at hand to a tangent.
    fn sum_up(&mut self, out: &mut [f64]) {
        let Self { slots, .. } = *self;
        let size = self.rows.len() * slots;
        let held = self.sums.len() / slots;
        for (own, rows) in out.chunks_exact_mut(slots * size).zip(&mut self.rows) {
            if rows.iter().any(|entry| *entry != 0.0) {
                let own = MatMut::from_column_major_slice_mut(own, size, slots);
                let rows = MatRef::from_column_major_slice(rows, size, held);
                let sums = MatRef::from_column_major_slice(&self.sums, slots, held);
                multiply(own, Accum::Add, rows, sums.transpose(), 1.0);
            }
            rows.clear();
        }
        self.sums.clear();
    }

    /// Adds what follows from the derivative of the state that the round begins with.
    fn begin_with(&self, inverse: &Mat<f64>, ended: &[f64], sign: f64, out: &mut [f64]) {
        let Self { slots, states, .. } = *self;
        let size = self.rows.len() * slots;
        let mut begun = vec![0.0; size];
        for k in 0..states {
            begun.fill(0.0);
            for (j, ended) in ended.chunks_exact(size).enumerate() {
                let share = sign * inverse[(k, j)];
                begun.iter_mut().zip(ended).for_each(|(begun, ended)| *begun += share * ended);
            }
            for (i, rows) in out.chunks_exact_mut(slots * size).enumerate() {
                let sums = &self.begin[(i * states + k) * slots..][..slots];
                for (row, sum) in rows.chunks_exact_mut(size).zip(sums).filter(|(_, s)| **s != 0.0)
                {
                    row.iter_mut().zip(&begun).for_each(|(entry, by)| *entry += sum * by);
                }
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::samples::Samples;
    use crate::contact::{Aft, BoucWen, Closure, ContactLaw, Coulomb, HarmonicForce as _, Jenkins};
    use crate::contact::{Masing, Motion, Residual, SlipLoad};
    use crate::fourier::{Harmonics, SampleTable};
    use crate::test_numbers::random;

    fn largest(values: &[f64]) -> f64 {
        values.iter().fold(1e-300, |most, x| most.max(x.abs()))
    }

    fn assert_close(found: &[f64], expected: &[f64], tolerance: f64, case: usize) {
        assert_eq!(found.len(), expected.len());
        let size = largest(expected);
        for (found, expected) in found.iter().zip(expected) {
            let error = (found - expected).abs() / size;
            assert!(error < tolerance, "{case}: {found} {expected} of {size}: {error:.1e}");
        }
    }

    /// The tangent of a march, by central differences.
    fn differences(aft: &Aft<Box<dyn ContactLaw>>, motion: Motion<'_>, step: f64) -> Vec<f64> {
        let size = motion.displacement.len();
        let beside = |k: usize, by: f64| {
            let mut displacement = motion.displacement.to_vec();
            displacement[k] += by;
            let mut load = SlipLoad::default();
            aft.slip_load(Motion { displacement: &displacement, ..motion }, false, &mut load);
            load.value
        };
        let mut tangent = vec![0.0; size * size];
        for k in 0..size {
            let ends = beside(k, step).into_iter().zip(beside(k, -step));
            for (i, (after, before)) in ends.enumerate() {
                tangent[i * size + k] = (after - before) / (2.0 * step);
            }
        }
        tangent
    }

    /// One round tells the tangent, and a march that begins with the state of another
    /// motion ends with the same slip load, tangent and all.
    #[test]
    fn what_slips_depends_neither_on_the_start_nor_on_the_rounds() {
        let [mut slipped, mut told, mut resumed] = [0, 0, 0];
        for case in 0..240 {
            let half_wave = case % 4 == 3;
            let table = SampleTable::new(Harmonics::new(3, half_wave));
            let slots = table.harmonics().slots();
            let directions = 1 + case % 2;
            let normal = (!half_wave && case % 3 > 0).then_some(200.0);
            let law = Coulomb::new(directions, 0.4, 150.0, normal, Closure::Preload(20.0)).unwrap();
            let size = 0.02 * (1.0 + (case % 12) as f64);
            let series = |shift: f64| -> Vec<f64> {
                (0..law.displacements() * slots)
                    .map(|i| {
                        let own = random(case * 97 + i) + shift * random(case * 31 + i + 5);
                        size * own / (1.0 + (i % slots) as f64)
                    })
                    .collect()
            };
            let aft = Aft::new(Box::new(law), 128).unwrap();
            let residual = Residual::Centred;
            let [here, beside] = [series(0.0), series(0.05)];
            let [here, beside] = [&here, &beside].map(|displacement| Motion {
                table: &table,
                displacement,
                residual,
            });
            // The march from its own begin, with the derivative of all of it.
            let samples = Samples::of(here, 128);
            let begun = aft.begin(here);
            let round = aft.march(&samples, &begun);
            let mut cold = SlipLoad::default();
            aft.slip_load(here, true, &mut cold);
            if !cold.active || round.departure.is_none() {
                assert!(cold.repeated.is_none());
                continue;
            }
            slipped += 1;
            if cold.repeated.is_some() {
                told += 1;
                // A derivative that is carried along all rounds is up to 6e-6 off these differences.
                assert_close(&cold.tangent, &differences(&aft, here, 1e-7 * size), 1e-7, case);
            }
            let mut warm = SlipLoad::default();
            aft.slip_load(beside, true, &mut warm);
            if warm.repeated.is_none() || cold.repeated.is_none() {
                continue;
            }
            let known = warm.repeated.clone().unwrap();
            resumed += usize::from(aft.resume(&samples, &known).is_some());
            aft.slip_load(here, true, &mut warm);
            assert_close(&warm.value, &cold.value, 1e-10, case);
            assert_close(&warm.tangent, &cold.tangent, 1e-7, case);
        }
        assert!(slipped > 80 && told > 60 && resumed > 60, "{slipped} {told} {resumed}");
    }

    /// It is what all rounds carry along, and that lags behind the state which repeats.
    #[test]
    fn one_round_tells_the_tangent_of_every_law() {
        let laws: [fn() -> Box<dyn ContactLaw>; 4] = [
            || Box::new(Jenkins::new(150.0, 1.0).unwrap()),
            || Box::new(BoucWen::new(150.0, 1.0, 1.5, 0.6).unwrap()),
            || Box::new(Coulomb::new(1, 0.4, 150.0, None, Closure::Preload(4.0)).unwrap()),
            || Box::new(Coulomb::new(1, 0.4, 150.0, Some(90.0), Closure::Preload(4.0)).unwrap()),
        ];
        for (index, law) in laws.into_iter().enumerate() {
            let mut told = 0;
            for case in 0..120 {
                let table = SampleTable::new(Harmonics::new(5, index < 3 && case % 2 == 1));
                let slots = table.harmonics().slots();
                let count = law().displacements();
                let displacement: Vec<f64> = (0..count * slots)
                    .map(|i| 0.06 * random(case * 53 + i) / (1.0 + (i % slots) as f64))
                    .collect();
                let residual = Residual::FromRest;
                let motion = Motion { table: &table, displacement: &displacement, residual };
                let aft = Aft::new(law(), 64).unwrap();
                let (samples, begun) = (Samples::of(motion, 64), aft.begin(motion));
                let round = aft.march(&samples, &begun);
                let mut of = [0; 2].map(|_| vec![0.0; displacement.len().pow(2)]);
                if round.departure.is_some()
                    && aft.differentiate_repeated(&samples, &round.state, slots, &mut of[0])
                {
                    told += 1;
                    aft.differentiate(&samples, &begun, &round.restarts, slots, &mut of[1]);
                    assert_close(&of[0], &of[1], 1e-8, case);
                    let mut load = SlipLoad::default();
                    aft.slip_load(motion, true, &mut load);
                    assert_eq!(load.derived, 1);
                }
            }
            assert!(told > 10, "law {index}: {told}");
        }
    }

    /// What one round makes of many numbers takes longer than all rounds do for few coefficients.
    #[test]
    fn laws_that_remember_much_are_derived_along_all_rounds() {
        let table = SampleTable::new(Harmonics::new(9, true));
        let mut displacement = [0.0; 10];
        (displacement[0], displacement[1]) = (0.02, -0.01);
        let residual = Residual::FromRest;
        let motion = Motion { table: &table, displacement: &displacement, residual };
        let law = Masing::iwan(150.0, 1.0, -0.5, 2.0).unwrap();
        let few = law.with_memory(4).unwrap();
        for (law, one) in [(Box::new(law) as Box<dyn ContactLaw>, false), (few, true)] {
            let mut load = SlipLoad::default();
            Aft::new(law, 64).unwrap().slip_load(motion, true, &mut load);
            assert!(load.active && load.rounds > 1);
            assert_eq!(load.derived == 1, one, "{} of {}", load.derived, load.rounds);
        }
    }

    /// A state that slip has left does not stay with a motion that sticks: the start decides.
    #[test]
    fn what_sticks_is_marched_from_its_start() {
        let table = SampleTable::new(Harmonics::new(1, false));
        let law = Coulomb::new(2, 0.4, 150.0, Some(200.0), Closure::Preload(20.0)).unwrap();
        let aft = Aft::new(Box::new(law), 128).unwrap();
        let mut load = SlipLoad::default();
        for size in [0.1, 0.01] {
            let displacement: Vec<f64> =
                [0.3, 1.0, 0.0, 0.1, 0.2, 0.5, 0.0, 0.2, 0.1].map(|u: f64| size * u).to_vec();
            let residual = Residual::Centred;
            let motion = Motion { table: &table, displacement: &displacement, residual };
            aft.slip_load(motion, true, &mut load);
            let mut fresh = SlipLoad::default();
            aft.slip_load(motion, true, &mut fresh);
            assert_eq!(load.repeated.is_some(), size > 0.05);
            assert_close(&load.value, &fresh.value, 1e-12, 0);
        }
    }
}
