//! Points solved by products with the modes are those of dense receptances.
#![allow(clippy::unwrap_used)]

use super::condensed::Condensed;
use super::effort::Effort;
use super::extension::Extension;
use super::linear::Linear;
use super::solution::PointStatus;
use crate::contact::{
    Closure, ContactLaw, Coulomb, Jenkins, Residual, Slider, SlipLoad, StructuralDamper,
};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::{Contact, MarchedLaws, Model};
use crate::solve::{newton, NewtonSettings, Outcome, Parametrised as _, System as _};
use crate::structure::{HarmonicLoad, Structure};
use crate::test_numbers;
use faer::{c64, Mat};

/// Numbers between 0 and 1 without a pattern.
fn random(seed: usize) -> f64 {
    0.5 + test_numbers::random(seed)
}

#[derive(Debug, Clone, Copy)]
enum Damping {
    Mass,
    Rayleigh,
    General,
}

/// Masses in rows, some of them coupled across, each law on the next ones; loads at harmonic 1 and
/// at rest.
fn model(laws: Vec<Box<dyn ContactLaw>>, damping: Damping, static_load: f64) -> Model {
    let size: usize = laws.iter().map(|law| law.displacements()).sum();
    let spring = |i: usize, j: usize| match i.abs_diff(j) {
        3 => 900.0 * (1.0 + random(i.min(j))),
        7 => 100.0 * random(3 * i.min(j)),
        _ => 0.0,
    };
    let stiffness = Mat::from_fn(size, size, |i, j| {
        let own: f64 = (0..size).map(|k| spring(i, k)).sum::<f64>() + 60.0;
        if i == j {
            own
        } else {
            -spring(i, j)
        }
    });
    let mass = Mat::from_fn(size, size, |i, j| f64::from(u8::from(i == j)) * (0.5 + random(5 * i)));
    let damping = match damping {
        Damping::Mass => faer::Scale(0.6) * &mass,
        Damping::Rayleigh => faer::Scale(0.4) * &mass + faer::Scale(2e-3) * &stiffness,
        Damping::General => Mat::from_fn(size, size, |i, j| {
            let own = f64::from(u8::from(i == j)) * (0.4 + random(11 * i));
            own + if i.abs_diff(j) < 3 { 0.05 * (random(i + 13 * j) - 0.5) } else { 0.0 }
        }),
    };
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let mut first = 0;
    let contacts = laws.into_iter().map(|law| {
        let count = law.displacements();
        let rows = Mat::from_fn(count, size, |i, j| f64::from(u8::from(first + i == j)));
        first += count;
        Contact { law, rows }
    });
    let load = |harmonic, force: f64| HarmonicLoad {
        harmonic,
        amplitude: (0..size)
            .map(|i| force * c64::new(random(17 * i), if harmonic == 0 { 0.0 } else { 0.3 }))
            .collect(),
    };
    let contacts = contacts.collect();
    Model::new(structure, contacts, vec![load(1, 40.0), load(0, static_load)]).unwrap()
}

/// Solutions with receptances and without, their largest difference relative to the motion, and
/// the share of the points that slip.
fn compared(model: &Model, highest: usize, omega: f64) -> (f64, f64) {
    let half_wave = model.is_symmetric();
    let table = SampleTable::new(Harmonics::new(highest, half_wave));
    let mut solutions = Vec::new();
    let mut share = 0.0;
    for dense in [true, false] {
        let mut equations = Condensed::new(model, &table, Residual::Centred, false);
        assert!(matches!(equations.linear, Linear::Modal(_)));
        if dense {
            equations.densify();
        }
        equations.set_omega(omega).unwrap();
        let mut x = equations.stuck_response().to_vec();
        let report = newton(&mut equations, &mut x, NewtonSettings::default());
        assert_eq!(report.outcome, Outcome::Converged, "{dense} {report:?}");
        let mut residual = vec![0.0; x.len()];
        equations.residual(&x, &mut residual);
        let active = equations.loads.iter().filter(|load| load.active).count();
        // What sticks in an odd motion takes no room.
        let zeros = |load: &&SlipLoad| !load.active && !load.tangent.is_empty();
        if half_wave && model.laws().iter().all(|law| law.name() == "jenkins") {
            let kept = equations.loads.iter().filter(zeros).count();
            assert!(4 * kept < equations.loads.len() - active, "{kept}");
        }
        share = active as f64 / equations.loads.len() as f64;
        let observe: Vec<usize> = (0..model.compliance().dofs()).step_by(5).collect();
        let status = PointStatus::Converged;
        let point = equations.recover(&x, &observe, status).unwrap();
        solutions.push((x, equations.frequency_rate(), point));
    }
    let difference = |a: &[f64], b: &[f64]| {
        let size = b.iter().fold(0.0_f64, |m, b| m.max(b.abs()));
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
    };
    let flat = |values: &[c64]| values.iter().flat_map(|z| [z.re, z.im]).collect::<Vec<_>>();
    let [(a, _, p), (b, _, q)] = &solutions[..] else { unreachable!() };
    let observed = difference(&flat(&p.displacement), &flat(&q.displacement));
    (difference(a, b).max(observed), share)
}

fn jenkins(count: usize) -> Vec<Box<dyn ContactLaw>> {
    let law = |i: usize| Jenkins::new(150.0, 10f64.powf(3.0 * random(7 * i))).unwrap();
    (0..count).map(|i| Box::new(law(i)) as Box<dyn ContactLaw>).collect()
}

fn coulomb(count: usize, directions: usize) -> Vec<Box<dyn ContactLaw>> {
    let law = |i: usize| {
        let preload = 10f64.powf(2.5 * random(7 * i) - 0.3);
        let closure = Closure::Preload(preload);
        Coulomb::new(directions, 0.4, 150.0, Some(200.0), closure).unwrap()
    };
    (0..count).map(|i| Box::new(law(i)) as Box<dyn ContactLaw>).collect()
}

#[test]
fn solutions_without_receptances_are_those_with_them() {
    for damping in [Damping::Mass, Damping::Rayleigh, Damping::General] {
        for static_load in [0.0, 5.0] {
            let model = model(jenkins(100), damping, static_load);
            let (difference, share) = compared(&model, 9, 9.0);
            assert!(difference < 1e-9, "{damping:?} {static_load}: {difference:e}");
            // Under a static load the mean of what sticks moves with it.
            assert!(static_load > 0.0 || (0.1..0.95).contains(&share), "{share}");
        }
    }
}

#[test]
fn so_are_those_of_other_laws() {
    let parallel = |i: usize| {
        let slider = |k, f| Slider::new(k, f).unwrap();
        let limit = 10f64.powf(3.0 * random(7 * i) - 0.5);
        Jenkins::of(vec![slider(80.0, 0.3 * limit), slider(60.0, limit)]).unwrap()
    };
    let structural = |i: usize| {
        let stiffness = faer::mat![[120.0, -40.0], [-40.0, 90.0]];
        let limit = |k: usize| 10f64.powf(3.0 * random(7 * i + k) - 0.5);
        StructuralDamper::new(stiffness.as_ref(), &[limit(0), limit(1)]).unwrap()
    };
    let laws: [Vec<Box<dyn ContactLaw>>; 4] = [
        (0..72).map(|i| Box::new(parallel(i)) as Box<dyn ContactLaw>).collect(),
        (0..36).map(|i| Box::new(structural(i)) as Box<dyn ContactLaw>).collect(),
        coulomb(40, 1),
        coulomb(26, 2),
    ];
    for laws in laws {
        let name = laws[0].name();
        let formless = name == "coulomb";
        let model = model(laws, Damping::Mass, 0.0);
        let model = if formless { model.marched(64, MarchedLaws::All).unwrap() } else { model };
        let (difference, share) = compared(&model, if formless { 3 } else { 7 }, 9.0);
        assert!(difference < 1e-9, "{name}: {difference:e}");
        assert!((0.1..=1.0).contains(&share), "{name} {share}");
    }
}

#[test]
fn rates_with_frequency_and_directions_are_those_with_receptances() {
    for damping in [Damping::Mass, Damping::General] {
        let model = model(jenkins(72), damping, 5.0);
        let table = SampleTable::new(Harmonics::new(5, false));
        let results: Vec<[Vec<f64>; 2]> = [true, false]
            .into_iter()
            .map(|dense| {
                let mut equations = Condensed::new(&model, &table, Residual::Centred, true);
                assert!(matches!(equations.linear, Linear::Modal(_)));
                if dense {
                    equations.densify();
                }
                equations.set_omega(9.0).unwrap();
                let x = equations.stuck_response().to_vec();
                let mut residual = vec![0.0; x.len()];
                equations.residual(&x, &mut residual);
                let rate = equations.frequency_rate();
                let mut step = vec![0.0; x.len()];
                assert!(equations.solve(&rate, &mut step));
                [rate, step]
            })
            .collect();
        for (a, b) in results[0].iter().zip(&results[1]) {
            let size = b.iter().fold(0.0_f64, |m, b| m.max(b.abs()));
            let worst = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-9 * size, "{damping:?}: {:e}", worst / size);
        }
    }
}

#[test]
fn steps_with_an_unknown_frequency_are_those_of_the_bordered_matrix() {
    let friction = model(coulomb(26, 2), Damping::Mass, 0.0).marched(64, MarchedLaws::All).unwrap();
    let coupled = model(jenkins(100), Damping::Rayleigh, 0.0);
    for (model, highest) in [(friction, 3), (coupled, 9)] {
        let table = SampleTable::new(Harmonics::new(highest, false));
        let steps: Vec<Vec<f64>> = [true, false]
            .into_iter()
            .map(|dense| {
                let mut equations = Condensed::new(&model, &table, Residual::Centred, true);
                equations.fine = false;
                assert!(matches!(equations.linear, Linear::Modal(_)));
                if dense {
                    equations.densify();
                }
                equations.set_omega(9.0).unwrap();
                let x = equations.stuck_response().to_vec();
                let mut residual = vec![0.0; x.len()];
                equations.residual(&x, &mut residual);
                let size = crate::solve::norm(&x);
                let row: Vec<f64> = (0..=x.len())
                    .map(|i| (0.3 * i as f64).cos() / if i < x.len() { size } else { 9.0 })
                    .collect();
                residual.push(0.1);
                let (step, _) = equations
                    .solve_bordered((&equations.frequency_rate(), equations.omega), &row, &residual)
                    .unwrap();
                assert_eq!(equations.profile.products > 0, !dense);
                step
            })
            .collect();
        let motion = steps[0].len() - 1;
        let omega = [0, 1].map(|i: usize| steps[i][motion]);
        let apart: Vec<f64> = steps[0].iter().zip(&steps[1]).map(|(a, b)| a - b).collect();
        let worst = crate::solve::norm(&apart[..motion]) / crate::solve::norm(&steps[0][..motion]);
        assert!(worst < 1e-4, "{highest}: {worst:e}");
        assert!((omega[0] - omega[1]).abs() < 1e-4 * omega[0].abs(), "{highest}: {omega:?}");
    }
}

#[test]
fn a_direction_ends_with_the_analysis() {
    let model = model(jenkins(72), Damping::Mass, 0.0);
    let table = SampleTable::new(Harmonics::new(7, true));
    let asked = std::cell::Cell::new(0);
    let ask = || {
        asked.set(asked.get() + 1);
        asked.get() > 4
    };
    let mut equations = Condensed::new(&model, &table, Residual::Centred, false);
    equations.watch(&ask);
    equations.set_omega(9.0).unwrap();
    let mut x = equations.stuck_response().to_vec();
    let report = newton(&mut equations, &mut x, NewtonSettings::default());
    assert_eq!(report.outcome, Outcome::Interrupted);
    // Once before the first step, then product by product.
    assert!(asked.get() <= 7 && report.iterations == 1, "{} {report:?}", asked.get());
}

/// The direction at a multiple of the stuck motion.
fn direction(equations: &mut Condensed<'_>, factor: f64) -> (bool, Vec<f64>) {
    let x: Vec<f64> = equations.stuck_response().iter().map(|x| factor * x).collect();
    let (mut residual, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    equations.residual(&x, &mut residual);
    let found = equations.solve(&residual, &mut step);
    (found, step)
}

#[test]
fn a_matrix_that_has_grown_too_large_gives_way_to_products_again() {
    let model = model(jenkins(130), Damping::Mass, 0.0);
    let table = SampleTable::new(Harmonics::new(15, true));
    let equations = || {
        let mut equations = Condensed::new(&model, &table, Residual::Centred, false);
        // Directions are those of Newton, not as inexact as far from a solution.
        equations.fine = true;
        equations.set_omega(9.0).unwrap();
        equations
    };
    let (mut formed, mut products) = (equations(), equations());
    let (found, few) = direction(&mut formed, 1.0);
    assert!(found && formed.form_instead() && matches!(formed.linear, Linear::Dense(_)));
    let (found, same) = direction(&mut formed, 1.0);
    assert!(found && matches!(formed.linear, Linear::Dense(_)));
    // All slip: 2080 unknowns.
    let (found, many) = direction(&mut formed, 1e4);
    assert!(found && matches!(formed.linear, Linear::Modal(_)));
    let (found, expected) = direction(&mut products, 1e4);
    assert!(found && products.loads.iter().all(|load| load.active));
    for (a, b) in [(few, same), (many, expected)] {
        let apart: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a - b).collect();
        let worst = crate::solve::norm(&apart) / crate::solve::norm(&b);
        assert!(worst < 1e-8, "{worst:e}");
    }
}

#[test]
fn no_jacobian_is_formed_for_what_is_held_to_few_products() {
    let model = model(jenkins(130), Damping::Mass, 0.0);
    let table = SampleTable::new(Harmonics::new(5, true));
    for held in [false, true] {
        let mut equations = Condensed::new(&model, &table, Residual::Centred, false);
        equations.set_omega(9.0).unwrap();
        if held {
            equations.hold_to_products(1);
        }
        let (found, _) = direction(&mut equations, 1e4);
        assert_eq!([found, equations.lacks_direction()], [!held, held]);
        assert!(!held || !equations.form_instead());
    }
}

/// A chain that its contacts alone hold, all of which slip: nothing holds its mean, whatever form the
/// Jacobian has.
#[test]
fn a_mean_that_nothing_holds_is_lost_with_a_formed_jacobian_too() {
    let size = 100;
    let stiffness = Mat::from_fn(size, size, |i, j| match i.abs_diff(j) {
        0 if i == 0 || i + 1 == size => 900.0,
        0 => 1800.0,
        1 => -900.0,
        _ => 0.0,
    });
    let mass = Mat::<f64>::identity(size, size);
    let damping = faer::Scale(0.6) * &mass;
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let contact = |i: usize| Contact {
        law: Box::new(Jenkins::new(150.0, 1e-3).unwrap()),
        rows: Mat::from_fn(1, size, |_, j| f64::from(u8::from(i == j))),
    };
    let load = |harmonic, force: f64| HarmonicLoad {
        harmonic,
        amplitude: (0..size).map(|_| c64::new(force, 0.0)).collect(),
    };
    let loads = vec![load(1, 40.0), load(0, 1.0)];
    let model = Model::new(structure, (0..size).map(contact).collect(), loads).unwrap();
    let table = SampleTable::new(Harmonics::new(9, false));
    for formed in [false, true] {
        let mut equations = Condensed::new(&model, &table, Residual::Centred, false);
        equations.set_omega(9.0).unwrap();
        assert!(!formed || equations.form_instead());
        let (found, _) = direction(&mut equations, 1.0);
        assert!(!found && equations.free && equations.is_lost(), "{formed}");
    }
}

/// A law that couples the points of a node has a tangent that every product reads: an estimate cannot afford
/// as many harmonics as with a law for each point.
#[test]
fn estimates_of_coupled_points_reach_less_far() {
    let nodes = model(coulomb(28, 2), Damping::Rayleigh, 0.0);
    let alone = model(jenkins(84), Damping::Rayleigh, 0.0);
    let reach = |model| {
        let effort = Effort::new(model, false, 40, 1);
        Extension::new(&effort, &Harmonics::new(3, false), 1.0, f64::INFINITY).highest
    };
    let [nodes, alone] = [&nodes, &alone].map(reach);
    assert!(nodes < alone, "{nodes} and {alone}");
}

/// Nodes that open yield all together: their Jacobian is dearer than that of as many single points.
#[test]
fn nodes_are_solved_by_products_where_single_points_are_not() {
    let table = SampleTable::new(Harmonics::new(3, false));
    let by_products = |laws: Vec<Box<dyn ContactLaw>>| {
        let model = model(laws, Damping::Mass, 1.0);
        let equations = Condensed::new(&model, &table, Residual::Centred, false);
        matches!(equations.linear, Linear::Modal(_))
    };
    let node = Coulomb::new(2, 0.4, 80.0, Some(100.0), Closure::Preload(1.0)).unwrap();
    let nodes = (0..16).map(|_| -> Box<dyn ContactLaw> { Box::new(node) });
    let single = Jenkins::new(80.0, 1.0).unwrap();
    let singles = (0..48).map(|_| -> Box<dyn ContactLaw> { Box::new(single.clone()) });
    assert_eq!([by_products(nodes.collect()), by_products(singles.collect())], [true, false]);
}
