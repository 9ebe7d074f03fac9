//! Exact periodic orbits against the converged table, Runge-Kutta and finite differences.

#![allow(clippy::unwrap_used)]

mod common;

use common::passive::{passive_system, unsymmetric_system};
use common::{beam_pair, runge_kutta, single_dof, snecma_beam, System};
use faer::{c64, Mat};
use proptest::prelude::*;
use std::f64::consts::TAU;
use stickslip_core::balance::PointStatus;
use stickslip_core::contact::{PointState, Residual};
use stickslip_core::model::Model;
use stickslip_core::motion::{transient, Flow, ModalSystem, Scheme, State, TransientSettings};
use stickslip_core::orbit::{orbit_sweep, Orbit, OrbitSettings, PeriodicOrbits};

fn orbit_of(model: &Model, omega: f64, residual: Residual) -> Orbit {
    let observe: Vec<usize> = (0..model.structure().dofs()).collect();
    let settings = OrbitSettings { residual, ..OrbitSettings::default() };
    let mut orbits = PeriodicOrbits::new(model, settings, &observe).unwrap();
    orbits.solve(omega, None).unwrap()
}

fn orbit(system: &System, omega: f64) -> Orbit {
    orbit_of(&system.model(), omega, Residual::Centred)
}

fn half_range(orbit: &Orbit, dof: usize) -> f64 {
    0.5 * (orbit.range[dof][1] - orbit.range[dof][0])
}

/// Guillen (1999), Figs. 4.1 and 4.2, with the converged amplitudes.
#[test]
fn the_two_time_histories_of_the_beam_are_met() {
    for (force, omega, damper, tip, slips) in [
        (20.313, 170.0, 1.132_314_37e-5, 7.192_085_65e-4, 2),
        (25.0, 200.0, 1.015_974_22e-4, 1.571_886_00e-3, 6),
    ] {
        let orbit = orbit(&snecma_beam(force), omega);
        for (dof, expected) in [(0, damper), (1, tip)] {
            let amplitude = half_range(&orbit, dof);
            assert!((amplitude / expected - 1.0).abs() < 1e-8, "{amplitude} {expected}");
        }
        let onsets = orbit.events.iter().filter(|e| e.state != PointState::Stuck).count();
        assert_eq!(onsets, slips);
    }
}

#[test]
fn independent_time_integration_settles_on_the_orbit() {
    for (system, omega, periods) in [
        (snecma_beam(20.313), 170.0, 150),
        (snecma_beam(25.0), 200.0, 100),
        (single_dof(2.0), 66.0, 60),
        (beam_pair(40.0), 190.0, 200),
    ] {
        let orbit = orbit(&system, omega);
        let expected = runge_kutta(&system, omega, periods, 8000);
        for (dof, expected) in expected.iter().enumerate() {
            let error = half_range(&orbit, dof) / expected - 1.0;
            let tolerance = if dof % 3 == 2 { OF_MODE } else { 1e-6 };
            assert!(error.abs() < tolerance, "dof {dof}: {error:e}");
        }
    }
}

/// Runge-Kutta's own error at the kinks of the force, seen in the fast third mode alone, is larger
/// than what the displacements of the beam show.
const OF_MODE: f64 = 2e-6;

/// Largest difference between the multipliers and those of a transition matrix of differences.
fn multiplier_error(system: &System, omega: f64) -> f64 {
    let model = system.model();
    let orbit = orbit(system, omega);
    let size = orbit.state.len();
    let observe = [0];
    let settings = TransientSettings {
        omega,
        scheme: Scheme::Exact,
        periods: 1,
        tolerance: None,
        samples: 1,
        keep: None,
    };
    let after = |state: &[f64]| -> Vec<f64> {
        let run = transient(&model, &settings, Some(state), &observe, &|_| true).unwrap();
        run.poincare.last().unwrap().clone()
    };
    let n = system.dofs();
    let scale = |i: usize| {
        let part = if i < n {
            0..n
        } else if i < 2 * n {
            n..2 * n
        } else {
            2 * n..size
        };
        orbit.state[part].iter().map(|v| v.abs()).fold(0.0, f64::max)
    };
    let limits: Vec<f64> = system.dampers.iter().map(|d| d.3).collect();
    let mut matrix = faer::Mat::<f64>::zeros(size, size);
    for j in 0..size {
        let h = 1e-6 * scale(j);
        let shifted = |sign: f64| {
            let mut state = orbit.state.clone();
            state[j] += sign * h;
            if j >= 2 * n {
                let limit = limits[j - 2 * n];
                state[j] = state[j].clamp(-limit, limit);
            }
            after(&state)
        };
        // At its limit a force can only be lowered; there the difference is one-sided and zero.
        let (ahead, behind) = (shifted(1.0), shifted(-1.0));
        for i in 0..size {
            // Balanced: eigenvalues of a matrix in mixed units lose digits.
            matrix[(i, j)] = (ahead[i] - behind[i]) / (2.0 * h) * scale(j) / scale(i);
        }
    }
    let mut expected: Vec<c64> = matrix.eigenvalues().unwrap();
    let mut worst = 0.0_f64;
    for multiplier in &orbit.multipliers {
        let near = (0..expected.len())
            .min_by(|&a, &b| {
                (expected[a] - multiplier).norm().total_cmp(&(expected[b] - multiplier).norm())
            })
            .unwrap();
        worst = worst.max((expected.swap_remove(near) - multiplier).norm());
    }
    worst
}

#[test]
fn multipliers_match_differences_of_the_flow() {
    for (system, omega) in [
        (snecma_beam(20.313), 170.0),
        (snecma_beam(25.0), 200.0),
        (snecma_beam(25.0), 40.0),
        (beam_pair(40.0), 190.0),
        (single_dof(2.0), 66.0),
    ] {
        let error = multiplier_error(&system, omega);
        assert!(error < 1e-6, "{omega}: {error:e}");
    }
}

/// A chain that is held at one end and pulled at the other, with a damper of another limit on each mass.
fn chain(count: usize) -> System {
    let stiff = |i: usize, j: usize| match i.abs_diff(j) {
        0 if i + 1 == count => 400.0,
        0 => 800.0,
        1 => -400.0,
        _ => 0.0,
    };
    let stiffness = Mat::from_fn(count, count, stiff);
    let mass = Mat::<f64>::identity(count, count);
    System {
        damping: faer::Scale(0.05) * &mass + faer::Scale(1e-3) * &stiffness,
        mass,
        stiffness,
        dampers: (0..count).map(|i| (i, None, 60.0, 0.2 + 0.05 * i as f64)).collect(),
        forces: vec![(count - 1, 1, 30.0, 0.0)],
    }
}

#[test]
fn multipliers_of_many_contacts_match_differences_of_the_flow() {
    let (system, omega) = (chain(12), 3.1);
    let contacts = orbit(&system, omega).response.contacts;
    assert!(contacts.iter().filter(|one| one.slip_fraction > 0.0).count() > 6);
    let error = multiplier_error(&system, omega);
    assert!(error < 1e-6, "{error:e}");
}

#[test]
fn ranges_are_those_of_samples() {
    let (system, omega) = (chain(12), 3.1);
    let orbit = orbit(&system, omega);
    let samples = 4000;
    let settings = TransientSettings {
        omega,
        scheme: Scheme::Exact,
        periods: 1,
        tolerance: None,
        samples,
        keep: None,
    };
    let observe: Vec<usize> = (0..system.dofs()).collect();
    let model = system.model();
    let run = transient(&model, &settings, Some(&orbit.state), &observe, &|_| true).unwrap();
    for dof in observe {
        let values = run.trace.displacement.iter().skip(dof).step_by(system.dofs());
        let highest = values.fold(f64::NEG_INFINITY, |most, x| most.max(*x));
        let found = orbit.range[dof][1];
        // Between two samples a motion of a few harmonics rises by about the square of their distance.
        let missed = 20.0 * (TAU / samples as f64).powi(2);
        assert!((-1e-12..missed).contains(&(found / highest - 1.0)), "{dof}: {found} {highest}");
    }
}

/// The pass that reads an orbit is the one that looks at the last step of Newton's method.
#[test]
fn an_orbit_takes_few_passes() {
    let (system, omega) = (chain(12), 3.1);
    let model = system.model();
    let orbits = PeriodicOrbits::new(&model, OrbitSettings::default(), &[0]).unwrap();
    let found = orbit_sweep(orbits, &[omega]).unwrap();
    let modal = ModalSystem::new(&model).unwrap();
    let mut flow = Flow::new(&modal, omega);
    let mut state = State::from_dofs(&modal, &found.points[0].state).unwrap();
    flow.run(&mut state, 0.5 * TAU / omega, &mut |_| {}).unwrap();
    let passes = found.profile.evaluations as f64 / flow.steps as f64;
    assert!(passes < 5.5, "{passes}");
}

#[test]
fn every_orbit_of_the_beam_closes_and_is_stable() {
    for force in [0.938, 2.188, 6.563, 16.563, 20.313, 25.0, 31.475, 38.438] {
        let model = snecma_beam(force).model();
        let omega: Vec<f64> = (0..200).map(|i| 20.0 + 330.0 * f64::from(i) / 199.0).collect();
        let observe = [0, 1];
        let orbits = PeriodicOrbits::new(&model, OrbitSettings::default(), &observe).unwrap();
        let sweep = orbit_sweep(orbits, &omega).unwrap();
        for orbit in &sweep.points {
            assert_eq!(orbit.response.status, PointStatus::Converged);
            assert!(orbit.response.residual < 1e-11);
            assert!(orbit.multipliers[orbit.neutral..].iter().all(|m| m.norm() < 1.0));
            let slips = orbit.response.contacts[0].slip_fraction > 0.0;
            assert_eq!(orbit.neutral, usize::from(!slips));
        }
    }
}

/// The mean force of a contact that never slips is what is assumed, and changes nothing else.
#[test]
fn stuck_contacts_hold_the_assumed_residual() {
    let mut system = snecma_beam(0.5);
    system.forces.push((0, 0, 40.0, 0.0));
    let model = system.model();
    let centre = |orbit: &Orbit| orbit.response.contact_force[0].re;
    let displacement = |orbit: &Orbit| orbit.response.contact_displacement[0].re;
    let centred = orbit_of(&model, 100.0, Residual::Centred);
    let given = orbit_of(&model, 100.0, Residual::Value(30.0));
    let from_rest = orbit_of(&model, 100.0, Residual::FromRest);
    assert!(centre(&centred).abs() < 1e-9);
    assert!((centre(&given) - 30.0).abs() < 1e-9);
    let expected = common::STIFFNESS * displacement(&from_rest);
    assert!((centre(&from_rest) / expected - 1.0).abs() < 1e-9);
    for orbit in [&centred, &given, &from_rest] {
        assert_eq!(orbit.neutral, 1);
        assert!((half_range(orbit, 1) / half_range(&centred, 1) - 1.0).abs() < 1e-10);
    }
}

#[test]
fn hard_cases_close() {
    let mass_on_friction = |force: f64| System {
        mass: faer::mat![[1.0]],
        damping: faer::mat![[0.0]],
        stiffness: faer::mat![[0.0]],
        dampers: vec![(0, None, 100.0, 1.0)],
        forces: vec![(0, 1, force, 0.0)],
    };
    let mut rigid = snecma_beam(20.313);
    rigid.dampers[0].2 = 2.4e12;
    let mut light = snecma_beam(2.0);
    light.damping = faer::Scale(1e-2) * &light.damping;
    // A floating mass held by friction alone, a nearly rigid damper, little viscous damping.
    for (system, frequencies) in [
        (mass_on_friction(0.9), [3.0, 9.9, 11.0, 25.0]),
        (mass_on_friction(1.5), [3.0, 9.9, 11.0, 25.0]),
        (rigid, [150.0, 190.0, 225.0, 240.0]),
        (light, [159.0, 200.0, 225.5, 226.0]),
    ] {
        for omega in frequencies {
            let orbit = orbit(&system, omega);
            assert_eq!(orbit.response.status, PointStatus::Converged, "{omega}");
            assert!(orbit.response.residual < 1e-11);
        }
    }
}

#[test]
fn an_unbounded_resonance_is_no_orbit() {
    let system = System {
        mass: faer::mat![[2.0]],
        damping: faer::mat![[0.0]],
        stiffness: faer::mat![[8.0]],
        dampers: vec![(0, None, 10.0, 1.0)],
        forces: vec![(0, 1, 100.0, 0.0)],
    };
    assert_eq!(orbit(&system, 2.0).response.status, PointStatus::Stalled);
    assert_eq!(orbit(&system, 2.1).response.status, PointStatus::Converged);
    let alone = System { dampers: Vec::new(), ..system };
    assert_eq!(orbit(&alone, 2.0).response.status, PointStatus::Stalled);
    assert_eq!(orbit(&alone, 1.9).response.status, PointStatus::Converged);
}

fn assert_balanced(system: &System, omega: f64) -> Result<(), TestCaseError> {
    let orbit = orbit(system, omega);
    prop_assert_eq!(orbit.response.status, PointStatus::Converged);
    let friction: f64 = orbit.response.contacts.iter().map(|c| c.dissipation).sum();
    prop_assert!(friction >= 0.0 && orbit.viscous >= 0.0);
    let error = (orbit.work - orbit.viscous - friction).abs();
    prop_assert!(error <= 1e-8 * (orbit.viscous + friction), "{} {}", orbit.work, error);
    let largest = orbit.multipliers[orbit.neutral..].iter().map(|m| m.norm()).fold(0.0, f64::max);
    prop_assert!(largest < 1.0 + 1e-9, "{}", largest);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn random_orbits_close_in_energy_balance(system in passive_system(), omega in 0.5_f64..36.0) {
        assert_balanced(&system, omega)?;
    }

    #[test]
    fn so_do_unsymmetric_ones(system in unsymmetric_system(), omega in 0.5_f64..36.0) {
        assert_balanced(&system, omega)?;
    }
}
