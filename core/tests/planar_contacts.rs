//! Planar Coulomb contacts in the exact flow: time integration, orbits, multipliers, energy.
#![allow(clippy::unwrap_used)]

mod common;

use common::differences::{assert_multipliers, multiplier_error};
use common::planar::{block, planar_system, Pad, Planar};
use common::tangents::largest;
use faer::{c64, mat, Mat};
use proptest::prelude::*;
use stickslip_core::balance::PointStatus;
use stickslip_core::contact::{Closure, ContactLaw, Coulomb, Jenkins, PointState, Residual};
use stickslip_core::model::{Contact, Model};
use stickslip_core::motion::{
    transient, ClassificationSettings, Classifier, Event, History, Reason, Scheme,
    TransientSettings,
};
use stickslip_core::orbit::{Orbit, OrbitSettings, PeriodicOrbits};
use stickslip_core::structure::{HarmonicLoad, Structure};

fn settings(omega: f64, scheme: Scheme, periods: usize, samples: usize) -> TransientSettings {
    TransientSettings { omega, scheme, periods, tolerance: None, samples, keep: None }
}

fn run(system: &Planar, settings: &TransientSettings, start: Option<&[f64]>) -> History {
    let observe: Vec<usize> = (0..system.dofs()).collect();
    transient(&system.model(), settings, start, &observe, &|_| true).unwrap()
}

fn orbit(system: &Planar, omega: f64) -> Orbit {
    let model = system.model();
    let observe: Vec<usize> = (0..system.dofs()).collect();
    let mut orbits = PeriodicOrbits::new(&model, OrbitSettings::default(), &observe).unwrap();
    orbits.solve(omega, None).unwrap()
}

/// Two codes agree on these values: greatest |u_t|, u_n, least u_n, mean u_n.
#[test]
fn separation_of_a_block_meets_the_converged_values() {
    for (loads, omega, [most, highest, lowest, mean]) in [
        ([40.0, 60.0], 5.0, [4.16212, 5.665_875, -0.89573, 2.304_388]),
        ([40.0, 120.0], 3.0, [6.79384, 6.443_992, -1.81509, 2.197_012]),
        ([80.0, 120.0], 8.0, [2.27893, 6.228_533, -1.73474, 2.199_940]),
    ] {
        let found = orbit(&block(100.0, loads), omega);
        assert_eq!(found.response.status, PointStatus::Converged, "{omega}");
        let [tangential, normal] = [found.range[0], found.range[1]];
        assert!((largest(&tangential) / most - 1.0).abs() < 3e-4, "{tangential:?}");
        let static_part = found.response.displacement[found.response.harmonics + 1].re;
        for (value, expected) in [(normal[1], highest), (normal[0], lowest), (static_part, mean)] {
            assert!((value / expected - 1.0).abs() < 1e-5, "{omega}: {value} {expected}");
        }
        // It slips, opens and closes.
        let [friction, normal] = found.response.contacts[..] else { panic!() };
        assert!(friction.slip_fraction > 0.01 && friction.dissipation > 0.0);
        assert!(normal.slip_fraction > 0.2 && normal.dissipation == 0.0);
        let opens = |event: &&Event| event.state == PointState::Open && event.point == 1;
        assert_eq!(found.events.iter().filter(opens).count(), 1);
        assert!(found.multipliers.iter().all(|m| m.norm() < 1.0));
    }
}

/// The contact slips towards one side until it sticks: the normal motion is determined, what is left
/// of the traction is not.
#[test]
fn shakedown_keeps_what_is_left_of_the_traction() {
    let system = block(100.0, [40.0, 60.0]);
    let mut reached = Vec::new();
    for start in [0.0, 20.0, -20.0] {
        let start = [0.0, 2.5, 0.0, 0.0, start];
        let settled = run(&system, &settings(3.0, Scheme::Exact, 400, 8), Some(&start));
        let change = settled.change.last().unwrap();
        assert!(*change < 1e-12, "{change:e}");
        let last = &settled.range[2 * 399..];
        assert!((last[1][1] / 4.169_806 - 1.0).abs() < 1e-5, "{last:?}");
        reached.push(largest(&last[0]));
    }
    let found = orbit(&system, 3.0);
    assert_eq!((found.response.status, found.neutral), (PointStatus::Converged, 1));
    assert!((found.range[1][1] / 4.169_806 - 1.0).abs() < 1e-5, "{:?}", found.range);
    reached.push(largest(&found.range[0]));
    assert!(reached.iter().all(|u| (6.13..7.2).contains(u)), "{reached:?}");
    assert!((reached[1] - reached[2]).abs() > 0.1, "{reached:?}");
}

/// A constant normal force makes a Jenkins element of it.
#[test]
fn under_constant_load_it_is_a_jenkins_element() {
    for (residual, constant) in [(Residual::Centred, 0.0), (Residual::FromRest, 0.3)] {
        for omega in [5.0, 8.5, 11.0, 14.0] {
            let pair = |law: Box<dyn ContactLaw>, rows: Mat<f64>| {
                let diagonal = |a: f64, b: f64| mat![[a, 0.0], [0.0, b]];
                let (mass, damping) = (diagonal(1.0, 2.0), diagonal(0.2, 0.3));
                let stiffness = mat![[90.0, -40.0], [-40.0, 120.0]];
                let structure =
                    Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
                let load = |harmonic, force| HarmonicLoad {
                    harmonic,
                    amplitude: vec![c64::new(0.0, 0.0), c64::new(force, 0.0)],
                };
                let loads = vec![load(1, 8.0), load(0, constant)];
                let model = Model::new(structure, vec![Contact { law, rows }], loads).unwrap();
                let settings = OrbitSettings { residual, ..OrbitSettings::default() };
                let mut orbits = PeriodicOrbits::new(&model, settings, &[0, 1]).unwrap();
                orbits.solve(omega, None).unwrap()
            };
            let along = mat![[1.0, 0.0]];
            let jenkins = pair(Box::new(Jenkins::new(60.0, 1.5).unwrap()), along.clone());
            let coulomb = |normal| {
                Box::new(Coulomb::new(1, 0.5, 60.0, normal, Closure::Preload(3.0)).unwrap())
            };
            for other in
                [pair(coulomb(None), along), pair(coulomb(Some(0.0)), mat![[1.0, 0.0], [0.0, 1.0]])]
            {
                assert_eq!(other.response.status, PointStatus::Converged);
                for (one, other) in jenkins.range.iter().zip(&other.range) {
                    assert!((one[0] - other[0]).abs() < 1e-9 && (one[1] - other[1]).abs() < 1e-9);
                }
                let (one, other) = (&jenkins.response.contacts[0], &other.response.contacts[0]);
                assert!((one.dissipation - other.dissipation).abs() < 1e-9);
                assert!((one.slip_fraction - other.slip_fraction).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn multipliers_of_a_block_match_differences_of_the_period_map() {
    for (loads, omega) in
        [([40.0, 60.0], 5.0), ([40.0, 120.0], 3.0), ([80.0, 120.0], 8.0), ([5.0, 10.0], 3.0)]
    {
        let system = block(100.0, loads);
        let found = orbit(&system, omega);
        assert_multipliers(&system.model(), &found);
    }
}

#[test]
fn the_flow_passes_a_contact_that_jams() {
    // What moves it forward presses the body down, at a friction beyond the stiffness of its spring.
    let system = Planar {
        mass: mat![[1.0]],
        damping: mat![[0.1]],
        stiffness: mat![[1.0]],
        pads: vec![Pad {
            rows: mat![[1.0], [1.0]],
            friction: 1.1,
            tangential: 10.0,
            normal: 100.0,
            closure: Closure::Preload(1.0),
        }],
        loads: vec![(0, 1, 5.0, 0.0)],
    };
    for omega in [0.5, 3.0, 9.0] {
        let history = run(&system, &settings(omega, Scheme::Exact, 50, 8), None);
        assert_eq!((history.halt, history.change.len()), (None, 50));
        assert!(history.trace.force.chunks(2).all(|f| f[0].abs() <= 1.1 * (f[1] + 1.0) + 1e-9));
    }
}

/// At the same tractions, two equal contacts turn about at the same instant.
#[test]
fn contacts_that_change_together_do_not_stop_the_flow() {
    let mut system = block(100.0, [40.0, 120.0]);
    system.pads[0].tangential *= 0.5;
    system.pads[0].normal *= 0.5;
    system.pads.push(system.pads[0].clone());
    let (one, both) = (orbit(&block(100.0, [40.0, 120.0]), 3.0), orbit(&system, 3.0));
    assert_eq!(both.response.status, PointStatus::Converged);
    assert!((one.range[1][1] / both.range[1][1] - 1.0).abs() < 1e-9);
    // Motion without any tangential part, in which friction begins and ends with the contact.
    let normal = orbit(&block(100.0, [0.0, 120.0]), 3.0);
    assert_eq!(normal.response.status, PointStatus::Converged);
    assert!(largest(&normal.range[0]) < 1e-12);
    assert!((normal.range[1][1] / one.range[1][1] - 1.0).abs() < 1e-9);
}

#[test]
fn states_that_no_contact_can_have_are_refused() {
    let system = block(100.0, [40.0, 60.0]);
    let refused = |start: &[f64]| {
        let wanted = settings(3.0, Scheme::Exact, 1, 8);
        transient(&system.model(), &wanted, Some(start), &[0], &|_| true).unwrap_err().to_string()
    };
    assert!(refused(&[0.0, -1.0, 0.0, 0.0, 0.1]).contains("slip limit of 0 N"));
    assert!(refused(&[0.0, 1.0, 0.0, 0.0, 18.0]).contains("slip limit of 17.8"));
    assert!(refused(&[0.0; 6]).contains("5 values"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn motions_meet_those_of_short_steps(system in planar_system(), omega in 2.0_f64..20.0) {
        let exact = run(&system, &settings(omega, Scheme::Exact, 3, 64), None);
        prop_assert_eq!(exact.halt, None);
        let n = system.dofs();
        let size = largest(&exact.trace.displacement);
        let error = |steps: usize| {
            let expected = system.by_steps(omega, 3.0, 192, steps);
            let apart = exact.trace.displacement[n..].iter().zip(&expected).map(|(a, b)| a - b);
            largest(&apart.collect::<Vec<f64>>()) / size
        };
        // Events within the steps leave an error of second order.
        let errors = [error(40), error(320)];
        prop_assert!(errors[1] < 1e-4 && errors[1] < (errors[0] / 4.0).max(1e-6), "{:?}", errors);
        for (forces, u) in exact
            .trace
            .force
            .chunks_exact(2 * system.pads.len())
            .zip(exact.trace.contact_displacement.chunks_exact(2 * system.pads.len()))
        {
            for (pad, (force, u)) in system.pads.iter().zip(forces.chunks(2).zip(u.chunks(2))) {
                let normal = pad.pressing(u[1]).max(0.0);
                prop_assert!((force[1] + pad.balanced() - normal).abs() < 1e-9);
                prop_assert!(force[0].abs() <= pad.friction * normal + 1e-9);
            }
        }
    }

    #[test]
    fn runge_kutta_steps_by_the_return_map_meet_them(
        system in planar_system(),
        omega in 2.0_f64..20.0,
    ) {
        let exact = run(&system, &settings(omega, Scheme::Exact, 3, 64), None);
        let steps = run(&system, &settings(omega, Scheme::RungeKutta(8000), 3, 64), None);
        let apart: Vec<f64> = exact
            .trace
            .displacement
            .iter()
            .zip(&steps.trace.displacement)
            .map(|(a, b)| a - b)
            .collect();
        prop_assert!(largest(&apart) < 1e-4 * largest(&exact.trace.displacement));
        prop_assert_eq!(exact.poincare[0].len(), steps.poincare[0].len());
    }

    #[test]
    fn orbits_close_in_energy_balance_with_their_multipliers(
        system in planar_system(),
        omega in 2.0_f64..20.0,
    ) {
        let found = orbit(&system, omega);
        if found.response.status == PointStatus::Stalled {
            // One that no motion settles on may not be found.
            let history = run(&system, &settings(omega, Scheme::Exact, 1000, 8), None);
            prop_assert!(history.change.iter().all(|change| *change > 1e-6));
            return Ok(());
        }
        prop_assert_eq!(found.response.status, PointStatus::Converged);
        let friction: f64 = found.response.contacts.iter().map(|c| c.dissipation).sum();
        prop_assert!(friction >= -1e-12 && found.viscous >= 0.0);
        let error = (found.work - found.viscous - friction).abs();
        prop_assert!(error <= 1e-8 * (found.viscous + friction), "{} {}", found.work, error);
        let differences = multiplier_error(&system.model(), &found);
        prop_assume!(differences.is_some_and(|[_, own]| own < 1e-7));
        let error = differences.unwrap()[0];
        prop_assert!(error < 1e-6, "{error:e} {:?} {}", found.multipliers, found.events.len());
    }
}

/// One mass on a plane: Runge-Kutta steps take the return map of two directions of sliding and settle on
/// the values of two codes.
#[test]
fn two_directions_of_sliding_are_stepped_through() {
    let diagonal = |d: [f64; 3]| Mat::from_fn(3, 3, |i, j| if i == j { d[i] } else { 0.0 });
    let structure = Structure::new(
        diagonal([1.0; 3]).as_ref(),
        diagonal([8.0, 10.0, 16.0]).as_ref(),
        diagonal([4e4, 9e4, 1.6e5]).as_ref(),
    )
    .unwrap();
    let law = Coulomb::new(2, 0.4, 5e4, Some(8e4), Closure::Preload(40.0)).unwrap();
    let contacts = vec![Contact { law: Box::new(law), rows: Mat::identity(3, 3) }];
    let amplitude = vec![c64::new(30.0, 0.0), c64::new(0.0, -25.0), c64::from_polar(20.0, -0.7)];
    let model =
        Model::new(structure, contacts, vec![HarmonicLoad { harmonic: 1, amplitude }]).unwrap();
    let wanted = TransientSettings {
        tolerance: Some(1e-9),
        keep: Some(1),
        ..settings(260.0, Scheme::RungeKutta(4000), 400, 64)
    };
    let follow = |settings: &TransientSettings, start: Option<&[f64]>| {
        transient(&model, settings, start, &[0, 1, 2], &|_| true)
    };
    let history = follow(&wanted, None).unwrap();
    assert!(history.settled);
    let last = &history.range[history.range.len() - 3..];
    for (range, expected) in last.iter().zip([1.394_17e-3, 8.775_93e-4, 1.159_755e-4]) {
        assert!((largest(range) / expected - 1.0).abs() < 1e-4, "{range:?} {expected}");
    }
    // It goes on from its last state, whose tractions it remembers.
    let state = history.poincare.last().unwrap();
    assert_eq!(state.len(), 8);
    let short = settings(260.0, Scheme::RungeKutta(4000), 1, 8);
    let next = follow(&short, Some(state)).unwrap();
    assert!(next.change[0] < 1e-8, "{:?}", next.change);
    let beyond: Vec<f64> = state[..6].iter().copied().chain([1e3, 0.0]).collect();
    let refused = follow(&short, Some(&beyond)).unwrap_err().to_string();
    assert!(refused.contains("slip limit"), "{refused}");
}

/// Free motions of a body under load die away in stick, or go on; what is stepped through agrees.
#[test]
fn free_motions_die_away_in_stick() {
    let mut system = block(0.0, [0.0, 0.0]);
    system.loads.clear();
    system.pads[0].closure = Closure::Preload(4.0);
    let (model, wanted) =
        (system.model(), ClassificationSettings { periods: 400, tolerance: 1e-6 });
    let prepared = Classifier::new(&model, wanted).unwrap();
    for start in [[3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [3.0, -2.0, 1.0]] {
        let state = [start[0], start[1], start[2], 0.0, 0.0];
        let before = run(&system, &settings(1.0, Scheme::Exact, 40, 8), Some(&state));
        let found = prepared.of(&state, &|| true).unwrap();
        assert_eq!(found.reason, Reason::Stuck, "{start:?}");
        // Stuck for good: neither slips nor opens again.
        let after = run(&system, &settings(1.0, Scheme::Exact, 40, 8), Some(&found.state));
        assert!(before.events_met > 0 && after.events_met == 0, "{start:?}");
    }
}
