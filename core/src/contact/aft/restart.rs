//! How a round of a march begins, from what the round before has made of the state.
//!
//! A slider that several parts of the period push in turn comes to rest like alternating projections:
//! geometrically, and slowly where the pushes are nearly opposite. A round is a map of the state with
//! the derivative P; `z + (1 − P)⁻¹ (z' − z)` is where the linearised map would end.

use faer::linalg::solvers::DenseSolveCore as _;
use faer::Mat;

/// Largest entry of `(1 − P)⁻¹`: beyond, a push leaves the slider free to lie anywhere on a line.
const FREE: f64 = 500.0;
/// The same of a single number, which has no line to lie on: a law that forgets slowly, as Bouc's and Wen's at small
/// motions, multiplies the rounding of a round by that.
const SLOW: f64 = 1e6;

/// How a round begins.
#[derive(Debug, Clone)]
pub(super) enum Restart {
    /// Where the round before has ended, mirrored under half-wave symmetry.
    GoesOn,
    /// At the mean of that and of where the round before has begun.
    Mean,
    /// At the fixed point of the linearised round, with `(1 − P)⁻¹`.
    FixedPoint(Mat<f64>),
}

impl Restart {
    /// At the fixed point of a round with a derivative, if it has one.
    pub(super) fn at_fixed_point(lap: &Mat<f64>) -> Option<Self> {
        let size = lap.nrows();
        let largest = if size == 1 { SLOW } else { FREE };
        let inverse = (Mat::<f64>::identity(size, size) - lap).partial_piv_lu().inverse();
        let bounded = (0..size).all(|j| inverse.col(j).iter().all(|a| a.abs() <= largest));
        bounded.then_some(Self::FixedPoint(inverse))
    }

    /// Turns what a round ends with, number of state by number of state, into what the next one begins
    /// with; `before` is what it has begun with itself.
    pub(super) fn apply(&self, ended: &mut [f64], before: &[f64]) {
        match self {
            Self::GoesOn => {}
            Self::Mean => {
                ended.iter_mut().zip(before).for_each(|(z, before)| *z = 0.5 * (*z + before));
            }
            Self::FixedPoint(inverse) => {
                let width = ended.len() / inverse.nrows().max(1);
                let change: Vec<f64> = ended.iter().zip(before).map(|(z, b)| z - b).collect();
                ended.copy_from_slice(before);
                for (i, row) in ended.chunks_exact_mut(width).enumerate() {
                    for (j, change) in change.chunks_exact(width).enumerate() {
                        let by = inverse[(i, j)];
                        row.iter_mut().zip(change).for_each(|(z, change)| *z += by * change);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::round::{distance, PERIODIC};
    use super::super::samples::Samples;
    use crate::contact::aft::law::of_the_law;
    use crate::contact::return_map::ReturnMapJacobian;
    use crate::contact::{Aft, BoucWen, Closure, ContactLaw, Coulomb, Jenkins, Motion, Residual};
    use crate::fourier::{Harmonics, SampleTable};
    use faer::Mat;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::Arc;

    /// A Jenkins element that counts its steps.
    #[derive(Debug)]
    struct Counted {
        law: Jenkins,
        steps: Arc<AtomicUsize>,
    }

    impl ContactLaw for Counted {
        of_the_law! {
            name() -> &'static str;
            displacements() -> usize;
            state_size() -> usize;
            stiffness() -> Mat<f64>;
            state_stiffness() -> Mat<f64>;
            is_odd() -> bool;
            is_monotone() -> bool;
            limits() -> Vec<f64>;
            with_scaled_stiffness(share: f64) -> Box<dyn ContactLaw>;
            with_scaled_forces(factor: f64) -> Box<dyn ContactLaw>;
        }

        fn return_map(
            &self,
            before: &[f64],
            after: &[f64],
            state: &mut [f64],
            force: &mut [f64],
            jacobian: Option<&mut ReturnMapJacobian>,
        ) {
            self.steps.fetch_add(1, Ordering::Relaxed);
            self.law.return_map(before, after, state, force, jacobian);
        }
    }

    /// A round that meets the one before it is the same from there on.
    #[test]
    fn what_slips_is_known_to_repeat_from_its_first_slip_on() {
        for half_wave in [false, true] {
            let table = SampleTable::new(Harmonics::new(1, half_wave));
            let displacement = if half_wave { vec![0.8, -0.5] } else { vec![0.1, 0.8, -0.5] };
            let residual = Residual::FromRest;
            let motion = Motion { table: &table, displacement: &displacement, residual };
            let law = Jenkins::new(1.0, 0.3).unwrap();
            let steps = Arc::new(AtomicUsize::new(0));
            let aft = Aft::new(Box::new(Counted { law, steps: Arc::clone(&steps) }), 128).unwrap();
            let samples = Samples::of(motion, 128);
            let round = aft.march(&samples, &aft.begin(motion));
            let taken = steps.load(Ordering::Relaxed);
            assert!(round.restarts.len() == 2 && taken < samples.count * 8 / 5, "{taken}");
            // One more round changes nothing.
            let mut step = aft.wrapped(&samples, &round.state);
            for n in 1..=samples.count {
                assert_eq!(step.state, round.state[n - 1..n]);
                aft.advance(&samples, n, &mut step, false);
            }
        }
    }

    /// A motion to and fro pushes the slider sideways at either end, by less and less: in the end it
    /// is as far from both as its spring reaches.
    #[test]
    fn pushes_in_turn_come_to_rest_in_a_few_rounds() {
        let half = 0.995_f64;
        let table = SampleTable::new(Harmonics::new(1, false));
        let displacement = [0.0, half, 0.0, -0.5, 0.0, 0.0];
        let residual = Residual::FromRest;
        let motion = Motion { table: &table, displacement: &displacement, residual };
        let law = Coulomb::new(2, 1.0, 1.0, None, Closure::Preload(1.0)).unwrap();
        let aft = Aft::new(Box::new(law), 128).unwrap();
        let samples = Samples::of(motion, 128);
        let round = aft.march(&samples, &aft.begin(motion));
        // Marched from period to period it takes some 700.
        assert!(round.restarts.len() < 20, "{}", round.restarts.len());
        let sideways = round.state[1];
        assert!((sideways + (1.0 - half * half).sqrt()).abs() < 1e-10, "{sideways}");
    }

    /// At small motions a hysteresis forgets by parts of a thousand and less where it began.
    #[test]
    fn what_is_forgotten_slowly_repeats_after_a_few_rounds() {
        let table = SampleTable::new(Harmonics::new(2, false));
        let residual = Residual::FromRest;
        for (size, mean) in [(0.3, 0.1), (0.1, 0.3), (0.05, 0.2), (0.02, 0.05)] {
            let displacement = [mean, 0.0, size, 0.3 * size, 0.2 * size];
            let motion = Motion { table: &table, displacement: &displacement, residual };
            let aft: Aft<Box<dyn ContactLaw>> =
                Aft::new(Box::new(BoucWen::new(1.0, 1.0, 1.9, 0.6).unwrap()), 64).unwrap();
            let samples = Samples::of(motion, 64);
            let round = aft.march(&samples, &aft.begin(motion));
            assert!(round.restarts.len() < 30, "{size}: {}", round.restarts.len());
            let changed = distance(&round.end, &round.state[..1]);
            assert!(changed <= PERIODIC * round.largest, "{size}: {changed}");
        }
    }
}
