//! The structure-like damper as a law: tangents, sampled against exact, limiting cases.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::{stiffness, Random, LIMITS};
use common::tangents::{difference, largest, motion};
use faer::{c64, mat, Mat};
use std::f64::consts::TAU;
use stickslip_core::contact::{
    Aft, ContactLaw, HarmonicForce, Jenkins, Motion, PointState, PointSummary, Residual,
    SlipElement, SlipLoad, StructuralDamper,
};
use stickslip_core::fourier::{Harmonics, SampleTable};

fn load(law: &dyn ContactLaw, table: &SampleTable, u: &[f64]) -> SlipLoad {
    let mut load = SlipLoad::default();
    law.slip_load(motion(table, u), true, &mut load);
    load
}

#[test]
fn tangents_of_random_dampers_match_differences() {
    let mut random = Random(7);
    let mut slipped = 0;
    for case in 0..120 {
        let points = 1 + case % 6;
        let table = SampleTable::new(Harmonics::new(1 + case % 7, case % 2 == 0));
        let law = random.damper(points, 1.0, 1.0);
        let size = 10f64.powf(random.between(-1.0, 2.0));
        let u = random.series(&table, points, size);

        let exact = load(&law, &table, &u);
        slipped += usize::from(exact.active);
        let size = u.len();
        let direction: Vec<f64> = (0..size).map(|_| random.next()).collect();
        let along: Vec<f64> = exact
            .tangent
            .chunks_exact(size)
            .map(|row| row.iter().zip(&direction).map(|(t, d)| t * d).sum())
            .collect();
        // Now and then a difference steps over an event that appears or vanishes.
        let best = [1e-5, 1e-6, 1e-7]
            .iter()
            .map(|step| {
                let side = |sign: f64| -> Vec<f64> {
                    let u: Vec<f64> =
                        u.iter().zip(&direction).map(|(u, d)| u + sign * step * d).collect();
                    load(&law, &table, &u).value
                };
                let (ahead, behind) = (side(1.0), side(-1.0));
                let slope: Vec<f64> =
                    ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * step)).collect();
                difference(&slope, &along) / largest(&along).max(1.0)
            })
            .fold(f64::INFINITY, f64::min);
        assert!(best < 1e-5, "case {case}, {points} points: {best:e}, {law:?}, {u:?}");
    }
    assert!(slipped > 60, "{slipped}");
}

/// The cells in which transitions are looked for are no part of the law: their number grows with the
/// harmonics, and harmonics that are zero must not change the forces. Two points of small limits that
/// move against each other turn, stick and slip again within one cell.
#[test]
fn forces_of_points_that_turn_together_do_not_depend_on_the_grid() {
    let stiffness = mat![[1.2, -0.5], [-0.5, 1.0]];
    let mut random = Random(3);
    let mut slipped = 0;
    for case in 0..400 {
        let reach = 10f64.powf(random.between(-6.0, -3.0));
        let limits = [reach * random.between(0.1, 1.0), reach * random.between(0.5, 4.0)];
        let law = StructuralDamper::new(stiffness.as_ref(), &limits).unwrap();
        let phase = random.between(0.0, TAU);
        let later = phase + reach.sqrt() * random.between(-0.5, 0.5);
        let amplitudes = [c64::from_polar(1.4, phase), c64::from_polar(-1.0, later)];
        let mut fundamental = |highest: usize| -> Vec<f64> {
            let table = SampleTable::new(Harmonics::new(highest, true));
            let slots = table.harmonics().slots();
            let mut u = vec![0.0; 2 * slots];
            for (amplitude, series) in amplitudes.iter().zip(u.chunks_exact_mut(slots)) {
                let mut orders = vec![c64::new(0.0, 0.0); highest + 1];
                orders[1] = *amplitude;
                table.harmonics().write_series(&orders, series);
            }
            let load = load(&law, &table, &u);
            slipped += usize::from(load.active);
            load.value.chunks_exact(slots).flat_map(|series| series[..2].to_vec()).collect()
        };
        let loads: Vec<Vec<f64>> = [1, 3, 5, 7, 9, 13].map(&mut fundamental).to_vec();
        for other in &loads[1..] {
            let jump = difference(&loads[0], other) / largest(&limits);
            // Rounding of the loads, which are as large as the elastic forces.
            assert!(jump < 1e-13 / reach + 1e-9, "case {case}: {jump:e} of the limits {limits:?}");
        }
    }
    assert!(slipped > 1000, "{slipped}");
}

#[test]
fn random_marches_approach_the_exact_passage() {
    let mut random = Random(11);
    let mut falls = Vec::new();
    for case in 0..60 {
        let points = 2 + case % 5;
        let table = SampleTable::new(Harmonics::new(3 + case % 4, case % 2 == 0));
        let law = random.damper(points, 1.0, 1.0);
        let size = 10f64.powf(random.between(-0.5, 1.5));
        let u = random.series(&table, points, size);

        let exact = load(&law, &table, &u).value;
        let errors: Vec<f64> = [1024, 8192]
            .iter()
            .map(|&samples| {
                let marched = Aft::new(law.with_scaled_stiffness(1.0), samples).unwrap();
                difference(&load(&marched, &table, &u).value, &exact) / largest(&exact).max(1.0)
            })
            .collect();
        assert!(errors[1] < 3e-4, "{case}: {errors:?}");
        if errors[0] > 0.0 {
            falls.push((errors[0] / errors[1]).log2() / 3.0);
        }
    }
    // Where a point sticks because another begins to slip the increment is of first order.
    falls.sort_by(f64::total_cmp);
    let median = falls[falls.len() / 2];
    assert!((1.6..2.4).contains(&median), "{falls:?}");
}

#[test]
fn two_points_of_which_one_never_slips_are_a_jenkins_element() {
    let (k, limit) = (3.0, 0.7);
    let spring = mat![[k, -k], [-k, k]];
    let jenkins = Jenkins::new(k, limit).unwrap();
    let mut random = Random(5);
    for case in 0..40 {
        let table = SampleTable::new(Harmonics::new(1 + case % 9, case % 2 == 0));
        let slots = table.harmonics().slots();
        let u = random.series(&table, 2, 1.0 + case as f64 / 4.0);
        let relative: Vec<f64> = (0..slots).map(|i| u[i] - u[slots + i]).collect();
        let rest = Motion { table: &table, displacement: &relative, residual: Residual::FromRest };
        let expected = jenkins.force_history(rest, 64);
        let mut summary = [PointSummary::default()];
        jenkins.summary(rest, &mut summary);
        for (limits, moves) in
            [([limit, f64::INFINITY], 0), ([limit, 1.1 * limit], 0), ([2.0 * limit, limit], 1)]
        {
            let law = StructuralDamper::new(spring.as_ref(), &limits).unwrap();
            let force = law.force_history(motion(&table, &u), 64);
            for (pair, f) in force.chunks_exact(2).zip(&expected) {
                assert!((pair[0] - f).abs() < 1e-12 && (pair[1] + f).abs() < 1e-12, "{pair:?} {f}");
            }
            let mut own = [PointSummary::default(); 2];
            law.summary(motion(&table, &u), &mut own);
            assert!((own[moves].dissipation - summary[0].dissipation).abs() < 1e-11);
            assert!((own[moves].slip_fraction - summary[0].slip_fraction).abs() < 1e-11);
            assert_eq!(own[1 - moves], PointSummary::default());
        }
    }
}

#[test]
fn equal_limits_slip_together_with_the_least_slip() {
    let spring = mat![[3.0, -3.0], [-3.0, 3.0]];
    let law = StructuralDamper::new(spring.as_ref(), &[0.7, 0.7]).unwrap();
    let table = SampleTable::new(Harmonics::new(1, true));
    let u = [2.0, 0.0, -1.0, 0.3];
    let jenkins = Jenkins::new(3.0, 0.7).unwrap();
    let expected = jenkins.force_history(motion(&table, &[3.0, -0.3]), 32);
    let force = law.force_history(motion(&table, &u), 32);
    for (pair, f) in force.chunks_exact(2).zip(&expected) {
        assert!((pair[0] - f).abs() < 1e-12 && (pair[1] + f).abs() < 1e-12);
    }
    let mut both = [PointSummary::default(); 2];
    law.summary(motion(&table, &u), &mut both);
    let mut one = [PointSummary::default()];
    jenkins.summary(motion(&table, &[3.0, -0.3]), &mut one);
    let total = both[0].dissipation + both[1].dissipation;
    assert!((total - one[0].dissipation).abs() < 1e-12, "{both:?} {one:?}");
    // Everything without friction: no force, and a defined answer.
    let free = StructuralDamper::new(spring.as_ref(), &[0.0, 0.0]).unwrap();
    assert!(largest(&free.force_history(motion(&table, &u), 32)) == 0.0);
    let slip_load = load(&free, &table, &u);
    assert!((slip_load.value[0] - 9.0).abs() < 1e-14 && slip_load.active);
    let mut force = [0.2, -0.2];
    let mut gain = [0.0; 4];
    law.increment(&[0.0; 2], &[1.0, -1.0], &mut force, Some(&mut gain));
    assert_eq!(force, [0.7, -0.7]);
}

#[test]
fn increments_solve_their_complementarity_problem() {
    let mut random = Random(19);
    for case in 0..2000 {
        let points = 1 + case % 8;
        let law = random.damper(points, 1.0, 1.0);
        let (stiffness, limits) = (SlipElement::stiffness(&law), SlipElement::limits(&law));
        let mut force = vec![0.0; points];
        for _ in 0..4 {
            let size = 10f64.powf(random.between(-1.0, 2.0));
            let du: Vec<f64> = (0..points).map(|_| size * random.next()).collect();
            let before = force.clone();
            let mut gain = vec![0.0; points * points];
            law.increment(&vec![0.0; points], &du, &mut force, Some(&mut gain));
            let trial: Vec<f64> = (0..points)
                .map(|i| before[i] + (0..points).map(|j| stiffness[(i, j)] * du[j]).sum::<f64>())
                .collect();
            // What slip takes off is no more than the trial forces, along the limits alone.
            let scale = largest(&trial).max(1.0);
            let slips: Vec<usize> = (0..points).filter(|&i| gain[i * points + i] == 0.0).collect();
            let d = Mat::from_fn(slips.len(), slips.len(), |i, j| stiffness[(slips[i], slips[j])]);
            use faer::linalg::solvers::Solve as _;
            let lost = Mat::from_fn(slips.len(), 1, |i, _| trial[slips[i]] - force[slips[i]]);
            let slip = d.full_piv_lu().solve(&lost);
            for (row, &i) in slips.iter().enumerate() {
                assert!((force[i].abs() - limits[i]).abs() <= 1e-12 * limits[i]);
                // The slip of a floating body has a free part.
                if d.nrows() < points {
                    assert!(slip[(row, 0)] * force[i] >= -1e-9 * scale * scale, "{case}");
                }
            }
            for i in 0..points {
                assert!(force[i].abs() <= limits[i]);
                let taken: f64 = slips
                    .iter()
                    .enumerate()
                    .map(|(row, &j)| stiffness[(i, j)] * slip[(row, 0)])
                    .sum();
                assert!((trial[i] - taken - force[i]).abs() < 1e-9 * scale, "{case}");
            }
        }
    }
}

#[test]
fn phases_name_the_slip_sets_in_order() {
    let law = StructuralDamper::new(stiffness().as_ref(), &LIMITS).unwrap();
    let table = SampleTable::new(Harmonics::new(1, true));
    let u = [3e-5, 0.0, -3e-5, 0.0, 1e-6, 0.0, -1e-6, 0.0];
    let phases = law.phases(motion(&table, &u));
    let forces = law.force_history(motion(&table, &u), 4000);
    for (n, forces) in forces.chunks_exact(4).enumerate() {
        let theta = std::f64::consts::TAU * n as f64 / 4000.0;
        let phase = phases.iter().rev().find(|phase| phase.start <= theta).unwrap();
        let edge = phases.iter().any(|phase| (phase.start - theta).abs() < 2e-3);
        for i in 0..4 {
            let slips = forces[i].abs() >= LIMITS[i];
            assert!(edge || slips == (phase.states[i] != PointState::Stuck), "{n} {i}");
        }
        let sum: f64 = forces.iter().sum();
        assert!(sum.abs() < 1e-12 * largest(forces));
    }
}

#[test]
fn unphysical_dampers_are_refused_with_the_entry() {
    let refused = |d: Mat<f64>, limits: &[f64]| {
        StructuralDamper::new(d.as_ref(), limits).unwrap_err().to_string()
    };
    let skew = refused(mat![[1.0, -0.5], [-0.4, 1.0]], &[1.0, 1.0]);
    assert!(skew.contains("stiffness[0, 1]") && skew.contains("-0.4"), "{skew}");
    let active = refused(mat![[1.0, -2.0], [-2.0, 1.0]], &[1.0, 1.0]);
    assert!(active.contains("eigenvalue") && active.contains("-1"), "{active}");
    assert!(refused(mat![[1.0, 0.0]], &[1.0]).contains("square"));
    assert!(refused(mat![[1.0]], &[1.0, 2.0]).contains("slip_forces"));
    assert!(refused(mat![[1.0]], &[-1.0]).contains("slip_forces[0]"));
    assert!(refused(mat![[f64::NAN]], &[1.0]).contains("stiffness[0, 0]"));
}
