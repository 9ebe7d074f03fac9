//! One step of the Coulomb contact: exact along a straight line, with its exact tangent, in every
//! state that a step can meet.

#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use stickslip_core::contact::{
    Aft, Closure, ContactLaw, Coulomb, HarmonicForce as _, Motion, PointSummary, Residual,
    ReturnMapJacobian, SlipLoad,
};
use stickslip_core::fourier::{Harmonics, SampleTable};

const STIFFNESS: f64 = 2.0;
const NORMAL: f64 = 3.0;

fn law(directions: usize, friction: f64, preload: f64) -> Coulomb {
    Coulomb::new(directions, friction, STIFFNESS, Some(NORMAL), Closure::Preload(preload)).unwrap()
}

/// State and force after a step.
fn step(law: &Coulomb, before: &[f64], after: &[f64], state: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut state, mut force) = (state.to_vec(), vec![0.0; law.displacements()]);
    law.return_map(before, after, &mut state, &mut force, None);
    (state, force)
}

fn between(a: &[f64], b: &[f64], share: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect()
}

fn norm(t: &[f64]) -> f64 {
    t.iter().map(|t| t * t).sum::<f64>().sqrt()
}

prop_compose! {
    /// A law, two displacements and an admissible traction before.
    fn cases()(directions in 1usize..=2, friction in 0.05..1.2f64, preload in -0.5..2.0f64,
        numbers in prop::array::uniform6(-1.0..1.0f64), angle in 0.0..6.3f64, share in 0.0..1.0f64)
        -> (Coulomb, Vec<f64>, Vec<f64>, Vec<f64>) {
        let contact = if preload >= 0.0 {
            law(directions, friction, preload)
        } else {
            let gap = Closure::Gap(-preload / NORMAL);
            Coulomb::new(directions, friction, STIFFNESS, Some(NORMAL), gap).unwrap()
        };
        let end = |from: usize| {
            let mut u = numbers[from..from + directions].to_vec();
            u.push(0.5 * numbers[from + 2]);
            u
        };
        let (before, after) = (end(0), end(3));
        let pressing = (preload + NORMAL * before[directions]).max(0.0);
        let size = friction * pressing * share;
        let state = if directions == 2 {
            vec![size * angle.cos(), size * angle.sin()]
        } else {
            vec![size * angle.cos().signum()]
        };
        (contact, before, after, state)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// A line in two parts leads to the same traction as the line in one.
    #[test]
    fn a_straight_line_may_be_divided((law, before, after, state) in cases(), share in 0.05..0.95f64) {
        let (whole, force) = step(&law, &before, &after, &state);
        let middle = between(&before, &after, share);
        let (half, _) = step(&law, &before, &middle, &state);
        let (parts, _) = step(&law, &middle, &after, &half);
        for (a, b) in whole.iter().zip(&parts) {
            prop_assert!((a - b).abs() <= 1e-12, "{whole:?} {parts:?}");
        }
        let normal = force[law.displacements() - 1] + law.parameters().iter()
            .find(|p| p.name == "preload").map_or(0.0, |p| p.value);
        let friction = law.parameters()[0].value;
        prop_assert!(norm(&whole) <= friction * normal * (1.0 + 1e-12) + 1e-15);
    }

    #[test]
    fn tangents_are_those_of_differences((law, before, after, state) in cases()) {
        let (n, m) = (law.displacements(), law.state_size());
        let mut jacobian = ReturnMapJacobian::default();
        let (mut z, mut force) = (state.clone(), vec![0.0; n]);
        law.return_map(&before, &after, &mut z, &mut force, Some(&mut jacobian));
        let (plain, same) = step(&law, &before, &after, &state);
        prop_assert_eq!(&z, &plain);
        prop_assert_eq!(&force, &same);
        let h = 1e-6;
        let slope = |of: usize, column: usize| {
            let shifted = |by: f64| {
                let mut inputs = [state.clone(), before.clone(), after.clone()];
                inputs[of][column] += by;
                step(&law, &inputs[1], &inputs[2], &inputs[0])
            };
            let [a, b, c] = [shifted(h), shifted(-h), shifted(0.0)];
            // Beside a kink the two sides differ: no derivative to compare with.
            let smooth = a.0.iter().zip(&b.0).zip(&c.0).all(|((a, b), c)| {
                ((a - c) - (c - b)).abs() < 3e-3 * h
            }) && a.1.iter().zip(&b.1).zip(&c.1).all(|((a, b), c)| ((a - c) - (c - b)).abs() < 3e-3 * h);
            let rate = |a: &[f64], b: &[f64]| -> Vec<f64> {
                a.iter().zip(b).map(|(a, b)| (a - b) / (2.0 * h)).collect()
            };
            smooth.then(|| (rate(&a.0, &b.0), rate(&a.1, &b.1)))
        };
        for (of, columns) in [m, n, n].into_iter().enumerate() {
            for column in 0..columns {
                let Some((by, _)) = slope(of, column) else { continue };
                let matrix = [&jacobian.by_state, &jacobian.by_before, &jacobian.by_after][of];
                for i in 0..m {
                    let exact = matrix[i * columns + column];
                    prop_assert!((exact - by[i]).abs() < 1e-6 * (1.0 + exact.abs()),
                        "{of} {i} {column}: {exact} {}", by[i]);
                }
            }
        }
        for column in 0..n {
            let Some((_, by)) = slope(2, column) else { continue };
            let through: f64 = (0..m)
                .map(|j| jacobian.force_by_state[(n - 1) * m + j] * jacobian.by_after[j * n + column])
                .sum();
            let exact = through + jacobian.force_by_after[(n - 1) * n + column];
            prop_assert!((exact - by[n - 1]).abs() < 1e-6);
        }
    }
}

/// Prescribed paths of one node: work, and coefficients of the traction (a circle and a line are
/// exact, the ellipse is the slip equation integrated to eight digits). The error is of second order.
#[test]
fn prescribed_paths_converge_with_the_samples() {
    let exact = [
        ([2e-4, 0.0, 0.0, 2e-4], 0.143_850_64, [36.0, -114.4727], [114.4727, 36.0]),
        ([3e-4, 0.0, 0.0, 1e-4], 0.146_156_67, [59.007_18, -127.048_18], [84.086_6, 28.330_94]),
    ];
    let table = SampleTable::new(Harmonics::new(3, true));
    let law = Coulomb::new(2, 0.4, 2e6, None, Closure::Preload(300.0)).unwrap();
    for (path, work, x, y) in exact {
        let mut u = vec![0.0; 2 * table.harmonics().slots()];
        let slots = table.harmonics().slots();
        u[0..2].copy_from_slice(&path[0..2]);
        u[slots..slots + 2].copy_from_slice(&path[2..4]);
        let motion = Motion { table: &table, displacement: &u, residual: Residual::Centred };
        let error = |samples: usize| {
            let aft = Aft::new(Box::new(law) as Box<dyn ContactLaw>, samples).unwrap();
            let mut load = SlipLoad::default();
            aft.slip_load(motion, false, &mut load);
            let mut summary = [PointSummary::default(); 2];
            aft.summary(motion, &mut summary);
            let done = summary[0].dissipation + summary[1].dissipation;
            let f = |i: usize| 2e6 * u[i] - load.value[i];
            let parts = [f(0) - x[0], f(1) - x[1], f(slots) - y[0], f(slots + 1) - y[1]];
            let largest = parts.iter().fold(0.0_f64, |most, e| most.max(e.abs() / 120.0));
            largest.max((done / work - 1.0).abs())
        };
        let [coarse, fine] = [256, 4096].map(error);
        assert!(fine < 1e-6 && coarse < 256.0 * 3.0 * fine.max(2e-8), "{coarse:e} {fine:e}");
    }
}
