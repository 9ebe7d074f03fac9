//! Exact periodic orbits against the converged table, Runge-Kutta and finite differences.
#![allow(clippy::unwrap_used)]

mod common;

use common::{beam_pair, runge_kutta, single_dof, snecma_beam, System};
use stickslip_core::contact::PointState;
use stickslip_core::orbit::{orbit_sweep, Orbit, OrbitSettings, PeriodicOrbits};

fn orbit(system: &System, omega: f64) -> Orbit {
    let model = system.model();
    let observe: Vec<usize> = (0..system.dofs()).collect();
    let mut orbits = PeriodicOrbits::new(&model, OrbitSettings::default(), &observe).unwrap();
    orbits.solve(omega, None).unwrap()
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
fn debug_print() {
    let system = snecma_beam(25.0);
    let model = system.model();
    let observe = [0, 1, 2];
    let omega: Vec<f64> = (0..400).map(|i| 20.0 + 330.0 * f64::from(i) / 399.0).collect();
    for _ in 0..2 {
        let start = std::time::Instant::now();
        let orbits = PeriodicOrbits::new(&model, OrbitSettings::default(), &observe).unwrap();
        let s = orbit_sweep(orbits, &omega).unwrap();
        println!("{:?} {:?}", start.elapsed(), s.profile);
        let bad =
            s.points.iter().filter(|p| p.response.residual.is_nan() || p.response.residual > 1e-12);
        for p in bad {
            println!(
                "bad {} {:?} {} {}",
                p.response.omega, p.response.status, p.response.residual, p.response.iterations
            );
        }
        let balance = s
            .points
            .iter()
            .map(|p| {
                let friction: f64 = p.response.contacts.iter().map(|c| c.dissipation).sum();
                ((p.work - p.viscous - friction) / p.work).abs()
            })
            .fold(0.0, f64::max);
        println!("energy {balance:e}");
        let it: usize = s.points.iter().map(|p| p.response.iterations).sum();
        println!("iterations {it}");
        println!("{:?}", s.points[200].multipliers);
    }
    let _ = (beam_pair(1.0), single_dof(1.0), runge_kutta);
}
