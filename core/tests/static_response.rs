//! Structures under their static loads, with the history that friction keeps.

#![allow(clippy::unwrap_used)]

use faer::linalg::solvers::Solve as _;
use faer::{c64, mat, Mat};
use stickslip_core::balance::{static_response, AtRest, RestStatus};
use stickslip_core::contact::{Closure, ContactLaw, Coulomb, Jenkins};
use stickslip_core::model::{Contact, Model};
use stickslip_core::structure::{HarmonicLoad, Structure};

fn model(stiffness: &Mat<f64>, contacts: Vec<Contact>, load: &[f64]) -> Model {
    let size = load.len();
    let unit = Mat::<f64>::identity(size, size);
    let damping = faer::Scale(0.01) * &unit;
    let structure = Structure::new(unit.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let amplitude = load.iter().map(|p| c64::new(*p, 0.0)).collect();
    Model::new(structure, contacts, vec![HarmonicLoad { harmonic: 0, amplitude }]).unwrap()
}

fn at_rest(model: &Model, dofs: usize) -> AtRest {
    let observe: Vec<usize> = (0..dofs).collect();
    static_response(model, &observe, &|_| true).unwrap()
}

/// A body between two faces of a wedge: u = s y on both, v = c y.
fn wedge(angle: f64, friction: f64) -> Model {
    let (s, c) = angle.to_radians().sin_cos();
    let law = || {
        let law = Coulomb::new(1, friction, 3e5, Some(3e5), Closure::Gap(0.0)).unwrap();
        Box::new(law) as Box<dyn ContactLaw>
    };
    let left = Contact { law: law(), rows: mat![[c, s], [-s, c]] };
    let right = Contact { law: law(), rows: mat![[c, -s], [s, c]] };
    model(&Mat::zeros(2, 2), vec![left, right], &[0.0, 240.0])
}

#[test]
fn a_wedge_between_fixed_faces() {
    for friction in [0.0, 0.2, 0.6, 1.19] {
        let angle = 40.0_f64;
        let rest = at_rest(&wedge(angle, friction), 2);
        assert_eq!(rest.status, RestStatus::Converged);
        let (s, c) = angle.to_radians().sin_cos();
        // Equal stiffness: sticking, t/N = tan α; or it slips down at t = μN.
        let share = friction.min(s / c);
        let normal = 120.0 / (c + s * share);
        let [t, n] = [rest.contact_force[0], rest.contact_force[1]];
        assert!((n / normal - 1.0).abs() < 1e-10, "{friction}: {n} {normal}");
        assert!((t - share * normal).abs() < 1e-9 * normal, "{friction}: {t}");
        assert!((rest.displacement[1] - n / c / 3e5).abs() < 1e-10 * n / 3e5);
        assert!(rest.displacement[0].abs() < 1e-12);
    }
}

/// Friction remembers how the load came: brute force in many small steps.
#[test]
fn loading_keeps_its_history() {
    let stiffness = mat![[4e3, -5e2, 3e2], [-5e2, 3e3, -2e2], [3e2, -2e2, 5e3]];
    for (seed, closure) in [
        (1.0, Closure::Preload(8.0)),
        (2.0, Closure::Gap(0.0)),
        (3.0, Closure::Gap(2e-3)),
        (4.0, Closure::Gap(-1e-3)),
        (5.0, Closure::Preload(3.0)),
    ] {
        let law = Coulomb::new(2, 0.3, 6e3, Some(8e3), closure).unwrap();
        let rows = mat![[1.0, 0.0, 0.2], [0.1, 1.0, 0.0], [0.0, 0.1, 1.0]];
        let load = [30.0 * f64::sin(seed), 25.0 * f64::cos(2.0 * seed), 20.0];
        let rest = at_rest(
            &model(&stiffness, vec![Contact { law: Box::new(law), rows: rows.clone() }], &load),
            3,
        );
        assert_eq!(rest.status, RestStatus::Converged, "{closure:?}");
        // x by relaxation of K x = s P − Bᵀ f at every level.
        let levels = 3000;
        let stuck = &stiffness + rows.transpose() * law.stiffness() * &rows;
        let factors = stuck.partial_piv_lu();
        let (mut x, mut z, mut u) = (Mat::<f64>::zeros(3, 1), vec![0.0; 2], vec![0.0; 3]);
        for level in 0..=levels {
            let share = f64::from(level) / f64::from(levels);
            let (mut force, mut state, mut after) = (vec![0.0; 3], z.clone(), u.clone());
            for _ in 0..80 {
                let displaced = &rows * &x;
                after = (0..3).map(|i| displaced[(i, 0)]).collect();
                state.clone_from(&z);
                law.return_map(&u, &after, &mut state, &mut force, None);
                let pull = Mat::from_fn(3, 1, |i, _| {
                    (0..3).map(|j| law.stiffness()[(i, j)] * after[j]).sum::<f64>() - force[i]
                });
                let right = Mat::from_fn(3, 1, |i, _| share * load[i]) + rows.transpose() * pull;
                x = factors.solve(right);
            }
            (u, z) = (after, state);
        }
        for i in 0..3 {
            let error = (rest.displacement[i] - x[(i, 0)]).abs();
            assert!(
                error < 2e-6 * x.norm_l2(),
                "{closure:?} {i}: {error:e} {:?} {x:?}",
                rest.displacement
            );
        }
    }
}

#[test]
fn a_body_that_comes_free_is_named() {
    // Pulled off the only contact that holds it.
    let law = Coulomb::new(1, 0.3, 1e5, Some(1e5), Closure::Preload(10.0)).unwrap();
    let contact = Contact { law: Box::new(law), rows: Mat::identity(2, 2) };
    let rest = at_rest(&model(&Mat::zeros(2, 2), vec![contact], &[0.0, -20.0]), 2);
    assert_eq!(rest.status, RestStatus::Free);
    assert!((rest.share - 0.5).abs() < 1e-6, "{}", rest.share);
    // Pushed along it beyond its friction.
    let contact = Contact { law: Box::new(law), rows: Mat::identity(2, 2) };
    let rest = at_rest(&model(&Mat::zeros(2, 2), vec![contact], &[4.0, 0.0]), 2);
    assert_eq!(rest.status, RestStatus::Free);
    assert!((rest.share - 0.75).abs() < 1e-6, "{}", rest.share);
}

#[test]
fn jenkins_elements_slide_under_static_loads_too() {
    let law = Jenkins::new(2e3, 3.0).unwrap();
    let contact = Contact { law: Box::new(law), rows: mat![[1.0]] };
    let rest = at_rest(&model(&mat![[1e3]], vec![contact], &[10.0]), 1);
    assert_eq!(rest.status, RestStatus::Converged);
    assert!((rest.displacement[0] - 7e-3).abs() < 1e-14);
    assert!((rest.contact_force[0] - 3.0).abs() < 1e-12);
}
