//! Random passive systems.

use super::{chain, System};
use faer::Mat;
use proptest::prelude::*;
use std::f64::consts::PI;

/// A chain of masses with random springs, light Rayleigh damping, dampers and forces.
pub fn passive_system() -> impl Strategy<Value = System> {
    (2_usize..7, 1_usize..4)
        .prop_flat_map(|(dofs, dampers)| {
            (
                prop::collection::vec(0.5_f64..3.0, dofs),
                prop::collection::vec(50.0_f64..500.0, dofs),
                prop::collection::vec((0..dofs, 0..dofs, 1.0_f64..4.0, -1.5_f64..1.0), dampers),
                prop::collection::vec((0..dofs, 0.2_f64..2.0, -PI..PI), 1..3),
                0.02_f64..0.3,
            )
        })
        .prop_map(|(masses, springs, dampers, forces, damping)| {
            let n = masses.len();
            let mass = Mat::from_fn(n, n, |i, j| if i == j { masses[i] } else { 0.0 });
            let stiffness = chain::stiffness(&springs);
            let damping = faer::Scale(damping) * &mass + faer::Scale(1e-4) * &stiffness;
            System {
                mass,
                damping,
                stiffness,
                dampers: dampers
                    .into_iter()
                    .map(|(one, other, stiffness, limit)| {
                        let other = (other != one).then_some(other);
                        (one, other, 10_f64.powf(stiffness), 10_f64.powf(limit))
                    })
                    .collect(),
                forces: forces.into_iter().map(|(dof, f, phase)| (dof, 1, f, phase)).collect(),
            }
        })
}

/// The same with loads that break the half-wave symmetry, contacts without friction and contacts
/// that never slip.
pub fn unsymmetric_system() -> impl Strategy<Value = System> {
    let extra = (0_usize..4, 0.2_f64..2.0, -PI..PI);
    (passive_system(), extra, 0_usize..4).prop_map(
        |(mut system, (harmonic, force, phase), kind)| {
            system.forces.push((0, harmonic, force, phase));
            match kind {
                0 => system.dampers[0].3 = 0.0,
                1 => system.dampers[0].3 = f64::INFINITY,
                2 => {
                    system.damping[(0, 1)] +=
                        0.5 * system.damping[(0, 0)].min(system.damping[(1, 1)])
                }
                _ => {}
            }
            system
        },
    )
}
