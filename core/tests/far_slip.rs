//! Contacts in a plane that move many millions of times as far as they slip: the slip equation is too stiff to be
//! followed, and rounding hides what the stiffness of their springs still changes.
#![allow(clippy::unwrap_used)]

mod common;

use common::node::{exact, largest, load};
use stickslip_core::contact::{Closure, Coulomb, Motion, Residual};
use stickslip_core::fourier::{Harmonics, SampleTable};

/// The limit, at rest \[N\].
const LIMIT: f64 = 0.4;

fn law(stiffness: f64, normal: Option<f64>) -> Coulomb {
    Coulomb::new(2, 0.2, stiffness, normal, Closure::Preload(LIMIT / 0.2)).unwrap()
}

/// Motions about as large as one: ellipses, nearly straight lines, and with more harmonics than one.
fn motions(slots: usize, normal: bool) -> Vec<Vec<f64>> {
    let series = |coefficients: &[(usize, f64)]| {
        let mut series = vec![0.0; slots];
        coefficients.iter().for_each(|(slot, value)| series[*slot] = *value);
        series
    };
    let ways = [
        [series(&[(1, 1.0), (0, 0.3)]), series(&[(2, 0.6)])],
        [series(&[(1, 1.0)]), series(&[(1, 0.5), (2, 0.05)])],
        [series(&[(1, 0.8), (3, 0.3), (6, -0.1)]), series(&[(2, -0.5), (4, 0.2)])],
    ];
    let normal = normal.then(|| series(&[(1, 0.1), (4, 0.05)]));
    ways.into_iter()
        .map(|[x, y]| [x, y].into_iter().chain(normal.clone()).flatten().collect())
        .collect()
}

/// Tractions are those of a contact with a softer spring, whose own slip hardly lags behind the motion, and so is all
/// of the tangent that the spring does not make.
#[test]
fn far_motions_have_the_traction_of_a_softer_spring() {
    let table = SampleTable::new(Harmonics::new(5, false));
    let slots = table.harmonics().slots();
    for normal in [None, Some(LIMIT / 0.2)] {
        for displacement in motions(slots, normal.is_some()) {
            let motion =
                Motion { residual: Residual::Centred, table: &table, displacement: &displacement };
            let (size, tangential) = (displacement.len(), 2 * slots);
            let [soft, stiff] = [4e6, 4e10].map(|stiffness| {
                let own = law(stiffness, normal);
                let load = load(&own, motion, true);
                assert!(load.active);
                let traction: Vec<f64> =
                    (0..tangential).map(|i| stiffness * displacement[i] - load.value[i]).collect();
                let mut tangent = load.tangent.clone();
                (0..tangential).for_each(|i| tangent[i * size + i] -= stiffness);
                (traction, tangent, exact(&own).force_history(motion, 64))
            });
            let difference = |a: &[f64], b: &[f64]| {
                largest(a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>().as_slice())
            };
            // Rounding of 4e10 is 8e-6.
            assert!(difference(&soft.0, &stiff.0) < 2e-4 * LIMIT, "{normal:?}");
            assert!(largest(&stiff.0) > 0.5 * LIMIT);
            assert!(difference(&soft.1, &stiff.1) < 1e-3 * largest(&soft.1), "{normal:?}");
            assert!(difference(&soft.2, &stiff.2) < 2e-4 * LIMIT, "{normal:?}");
        }
    }
}
