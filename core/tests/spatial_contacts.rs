//! Coulomb contacts with two directions of sliding in the exact flow: closed forms, time integration,
//! orbits, multipliers, energy.
#![allow(clippy::unwrap_used)]

mod common;

use common::chain;
use common::differences::{assert_multipliers, multiplier_error};
use common::tangents::largest;
use faer::{c64, Mat};
use proptest::prelude::*;
use stickslip_core::balance::PointStatus;
use stickslip_core::contact::{Closure, ContactLaw, Coulomb};
use stickslip_core::model::{Contact, Model};
use stickslip_core::motion::{transient, History, Scheme, TransientSettings};
use stickslip_core::orbit::{Orbit, OrbitSettings, PeriodicOrbits};
use stickslip_core::structure::{HarmonicLoad, Structure};

fn diagonal(d: &[f64]) -> Mat<f64> {
    Mat::from_fn(d.len(), d.len(), |i, j| if i == j { d[i] } else { 0.0 })
}

/// One mass on a plane.
fn mass_on_a_plane(law: Coulomb, loads: &[(usize, [c64; 3])]) -> Model {
    let structure = Structure::new(
        diagonal(&[1.0; 3]).as_ref(),
        diagonal(&[8.0, 10.0, 16.0]).as_ref(),
        diagonal(&[4e4, 9e4, 1.6e5]).as_ref(),
    )
    .unwrap();
    let contacts = vec![Contact { law: Box::new(law), rows: Mat::identity(3, 3) }];
    let load = |(harmonic, amplitude): &(usize, [c64; 3])| HarmonicLoad {
        harmonic: *harmonic,
        amplitude: amplitude.to_vec(),
    };
    Model::new(structure, contacts, loads.iter().map(load).collect()).unwrap()
}

fn case() -> Model {
    let law = Coulomb::new(2, 0.4, 5e4, Some(8e4), Closure::Preload(40.0)).unwrap();
    let load = [c64::new(30.0, 0.0), c64::new(0.0, -25.0), c64::from_polar(20.0, -0.7)];
    mass_on_a_plane(law, &[(1, load)])
}

fn run(model: &Model, omega: f64, scheme: Scheme, periods: usize) -> History {
    let wanted =
        TransientSettings { omega, scheme, periods, tolerance: None, samples: 64, keep: None };
    let observe: Vec<usize> = (0..model.compliance().dofs()).collect();
    transient(model, &wanted, None, &observe, &|_| true).unwrap()
}

fn orbit(model: &Model, omega: f64) -> Orbit {
    let observe: Vec<usize> = (0..model.compliance().dofs()).collect();
    let mut orbits = PeriodicOrbits::new(model, OrbitSettings::default(), &observe).unwrap();
    orbits.solve(omega, None).unwrap()
}

/// Two codes agree on these values to 3e-5.
#[test]
fn a_mass_on_a_plane_meets_the_converged_values() {
    for (omega, expected) in [
        (180.0, [1.797_93e-3, 3.208_07e-4, 9.632_98e-5]),
        (260.0, [1.394_17e-3, 8.775_93e-4, 1.159_755e-4]),
        (340.0, [4.460_50e-4, 1.139_98e-3, 1.606_182e-4]),
    ] {
        let model = case();
        let found = orbit(&model, omega);
        assert_eq!(found.response.status, PointStatus::Converged);
        for (range, expected) in found.range.iter().zip(expected) {
            assert!((largest(range) / expected - 1.0).abs() < 1e-5, "{omega}: {range:?}");
        }
        assert!(energy_error(&found) < 1e-12);
        assert_multipliers(&model, &found);
        // The tractions lie within the cone at all instants.
        let exact = run(&model, omega, Scheme::Exact, 3);
        for force in exact.trace.force.chunks_exact(3) {
            let beyond = force[0].hypot(force[1]) / (0.4 * (force[2] + 40.0)) - 1.0;
            assert!(beyond < 1e-12, "{beyond:e}");
        }
    }
}

/// Under a rotating load the mass moves in a circle: δ = μN/k_t, contact force k_t δ²/R inwards and
/// μN sqrt(1 − (δ/R)²) against the motion, and of the load as much more as the structure takes.
#[test]
fn a_circle_has_its_closed_form() {
    let (friction, k, preload) = (0.4_f64, 2e6_f64, 300.0_f64);
    let (mass, damping, stiffness, omega) = (2.0, 30.0, 8e5, 300.0);
    let delta = friction * preload / k;
    for radius in [6.1e-5_f64, 2e-4, 5e-3] {
        let share = (1.0 - (delta / radius) * (delta / radius)).sqrt();
        let inwards = (stiffness - mass * omega * omega) * radius + k * delta * delta / radius;
        let against = damping * omega * radius + friction * preload * share;
        let load = c64::new(inwards, against);
        for normal in [None, Some(0.0), Some(3e6)] {
            let size = if normal.is_some() { 3 } else { 2 };
            let structure = Structure::new(
                diagonal(&vec![mass; size]).as_ref(),
                diagonal(&vec![damping; size]).as_ref(),
                diagonal(&vec![stiffness; size]).as_ref(),
            )
            .unwrap();
            let law = Coulomb::new(2, friction, k, normal, Closure::Preload(preload)).unwrap();
            let contacts = vec![Contact { law: Box::new(law), rows: Mat::identity(size, size) }];
            let amplitude: Vec<c64> =
                [load, load * c64::new(0.0, -1.0), c64::new(0.0, 0.0)][..size].to_vec();
            let loads = vec![HarmonicLoad { harmonic: 1, amplitude }];
            let model = Model::new(structure, contacts, loads).unwrap();
            let found = orbit(&model, omega);
            assert_eq!(found.response.status, PointStatus::Converged);
            for range in &found.range[..2] {
                assert!((range[1] / radius - 1.0).abs() < 1e-10, "{radius} {range:?}");
            }
            let contacts = &found.response.contacts;
            let work = contacts[0].dissipation + contacts[1].dissipation;
            let expected = std::f64::consts::TAU * radius * friction * preload * share;
            assert!((work / expected - 1.0).abs() < 1e-9, "{radius} {work} {expected}");
            assert!((contacts[0].slip_fraction - 1.0).abs() < 1e-12);
            assert!(found.multipliers.iter().all(|m| m.norm() < 1.0));
            assert_multipliers(&model, &found);
        }
    }
}

/// A block that slips, opens and closes, and moves across as far as it is pushed there.
fn block(loads: [f64; 3], angle: f64, law: Coulomb) -> Model {
    let structure = Structure::new(
        diagonal(&[1.0; 3]).as_ref(),
        diagonal(&[0.346_410_162, 0.4, 2.0]).as_ref(),
        diagonal(&[12.0, 15.0, 21.0]).as_ref(),
    )
    .unwrap();
    let (sin, cos) = angle.sin_cos();
    let turned = faer::mat![[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
    let rows = if law.displacements() == 3 {
        turned
    } else {
        faer::mat![[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    };
    let contacts = vec![Contact { law: Box::new(law), rows }];
    let load = |harmonic, amplitude: [f64; 3]| HarmonicLoad {
        harmonic,
        amplitude: amplitude.iter().map(|a| c64::new(*a, 0.0)).collect(),
    };
    let mut moving = load(1, loads);
    moving.amplitude[1] *= c64::new(0.0, 1.0);
    Model::new(structure, contacts, vec![moving, load(0, [0.0, 0.0, 100.0])]).unwrap()
}

fn pad(directions: usize) -> Coulomb {
    Coulomb::new(directions, 0.85, 5.0, Some(21.0), Closure::Gap(0.0)).unwrap()
}

/// Motion along a line is that of a planar contact, whatever the frame.
#[test]
fn a_planar_contact_in_space_is_a_planar_contact() {
    for ([x, z], omega) in [([40.0, 60.0], 5.0), ([40.0, 120.0], 3.0), ([80.0, 120.0], 8.0)] {
        let planar = orbit(&block([x, 0.0, z], 0.0, pad(1)), omega);
        assert_eq!(planar.response.status, PointStatus::Converged);
        let work =
            |found: &Orbit| -> f64 { found.response.contacts.iter().map(|c| c.dissipation).sum() };
        for angle in [0.0, 0.5, 2.0, -1.2] {
            let found = orbit(&block([x, 0.0, z], angle, pad(2)), omega);
            assert_eq!(found.response.status, PointStatus::Converged);
            for (one, other) in planar.range.iter().zip(&found.range) {
                let size = largest(one).max(1.0);
                assert!((one[0] - other[0]).abs() < 1e-9 * size, "{one:?} {other:?}");
                assert!((one[1] - other[1]).abs() < 1e-9 * size, "{one:?} {other:?}");
            }
            assert!((work(&planar) / work(&found) - 1.0).abs() < 1e-9);
            let last = found.response.contacts.len() - 1;
            let [one, other] = [&planar.response.contacts, &found.response.contacts];
            assert!((one[0].slip_fraction - other[0].slip_fraction).abs() < 1e-9);
            assert!((one[1].slip_fraction - other[last].slip_fraction).abs() < 1e-9);
        }
    }
}

/// Nothing depends on the frame in the plane; what opens and slides where it closes has its multipliers.
#[test]
fn separation_in_space_does_not_depend_on_the_frame() {
    for (loads, omega) in
        [([40.0, 30.0, 60.0], 5.0), ([40.0, 20.0, 120.0], 3.0), ([80.0, 50.0, 120.0], 8.0)]
    {
        let first = block(loads, 0.0, pad(2));
        let found = orbit(&first, omega);
        assert_eq!(found.response.status, PointStatus::Converged);
        assert!(found.response.contacts[2].slip_fraction > 0.1, "it opens");
        assert!(energy_error(&found) < 1e-10, "{:e}", energy_error(&found));
        assert_multipliers(&first, &found);
        for angle in [0.5, -1.2, 2.0] {
            let other = orbit(&block(loads, angle, pad(2)), omega);
            for (one, other) in found.range.iter().zip(&other.range) {
                let size = largest(one);
                assert!((one[0] - other[0]).abs() < 1e-10 * size, "{one:?} {other:?}");
                assert!((one[1] - other[1]).abs() < 1e-10 * size, "{one:?} {other:?}");
            }
            let of = |found: &Orbit| found.multipliers.iter().map(|m| m.norm()).fold(0.0, f64::max);
            assert!((of(&found) - of(&other)).abs() < 1e-8);
        }
    }
}

/// Work of the loads that is neither damping nor friction, relative to it.
fn energy_error(found: &Orbit) -> f64 {
    let friction: f64 = found.response.contacts.iter().map(|c| c.dissipation).sum();
    (found.work - found.viscous - friction).abs() / found.viscous
}

/// A contact in random directions: rows, μ, k_t, k_n, kind, gap or preload.
type Pad = (Vec<f64>, f64, f64, f64, usize, f64);

/// Chains of masses with contacts in random directions, under preload or behind a gap, some under
/// constant load; loads are `(DOF, harmonic, amplitude, phase)`.
#[derive(Debug, Clone)]
struct Chain {
    masses: Vec<f64>,
    springs: Vec<f64>,
    pads: Vec<Pad>,
    loads: Vec<(usize, usize, f64, f64)>,
    damping: f64,
}

impl Chain {
    fn model(&self) -> Model {
        let n = self.masses.len();
        let mass = diagonal(&self.masses);
        let stiffness = chain::stiffness(&self.springs);
        let damping = faer::Scale(self.damping) * &mass;
        let structure =
            Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
        let contact = |(rows, friction, tangential, normal, kind, size): &Pad| {
            let closure = match kind {
                1 => Closure::Gap(*size),
                _ => Closure::Preload(0.2 + 100.0 * size.abs()),
            };
            let normal = (*kind < 2).then_some(*normal);
            let law = Coulomb::new(2, *friction, *tangential, normal, closure).unwrap();
            let count = law.displacements();
            let rows = Mat::from_fn(count, n, |i, j| rows[i * n + j]);
            Contact { law: Box::new(law), rows }
        };
        let mut all: Vec<HarmonicLoad> = Vec::new();
        for &(dof, harmonic, amplitude, phase) in &self.loads {
            let force = c64::from_polar(amplitude, if harmonic == 0 { 0.0 } else { phase });
            let mut along = vec![c64::new(0.0, 0.0); n];
            along[dof] = force;
            match all.iter_mut().find(|load| load.harmonic == harmonic) {
                Some(load) => load.amplitude[dof] += force,
                None => all.push(HarmonicLoad { harmonic, amplitude: along }),
            }
        }
        Model::new(structure, self.pads.iter().map(contact).collect(), all).unwrap()
    }
}

fn chain() -> impl Strategy<Value = Chain> {
    let pad = |dofs: usize| {
        (
            prop::collection::vec(-1.0_f64..1.0, 3 * dofs),
            0.1_f64..1.2,
            50.0_f64..500.0,
            50.0_f64..500.0,
            0_usize..3,
            -0.005_f64..0.01,
        )
    };
    chain::chains(1..4, pad).prop_map(|(masses, springs, pads, loads, damping)| Chain {
        masses,
        springs,
        pads,
        loads,
        damping,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn motions_meet_those_of_short_steps(chain in chain(), omega in 2.0_f64..20.0) {
        let model = chain.model();
        let exact = run(&model, omega, Scheme::Exact, 3);
        prop_assert_eq!(exact.halt, None);
        let size = largest(&exact.trace.displacement);
        let error = |steps: usize| {
            let steps = run(&model, omega, Scheme::RungeKutta(steps), 3);
            let pairs = exact.trace.displacement.iter().zip(&steps.trace.displacement);
            largest(&pairs.map(|(a, b)| a - b).collect::<Vec<f64>>()) / size
        };
        let errors = [error(2000), error(16_000)];
        prop_assert!(errors[1] < 1e-5 && errors[1] < (errors[0] / 4.0).max(1e-7), "{:?}", errors);
    }

    #[test]
    fn orbits_close_in_energy_balance_with_their_multipliers(
        chain in chain(),
        omega in 2.0_f64..20.0,
    ) {
        let model = chain.model();
        let found = orbit(&model, omega);
        prop_assert_eq!(found.response.status, PointStatus::Converged);
        prop_assert!(energy_error(&found) < 1e-8, "{:e}", energy_error(&found));
        let differences = multiplier_error(&model, &found);
        prop_assume!(differences.is_some_and(|[_, own]| own < 1e-7));
        let error = differences.unwrap()[0];
        prop_assert!(error < 1e-6, "{error:e} {:?} {}", found.multipliers, found.events.len());
    }
}
