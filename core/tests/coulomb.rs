//! The exact evaluation of the Coulomb law over periodic motions: against closed forms, a fine march
//! of its return map, differences and the Jenkins element.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::Random;
use common::node::{
    assert_close, exact, force, largest, load, motion, random_case, shakes_down, summary, Case,
};
use std::f64::consts::PI;
use stickslip_core::contact::{
    Aft, Closure, ContactLaw, Coulomb, HarmonicForce, Jenkins, Motion, Residual, SlipLoad,
};
use stickslip_core::fourier::{Harmonics, SampleTable};

/// The same contact, marched through many samples of its return map.
fn marched(case: &Case, samples: usize) -> SlipLoad {
    let sampled = Aft::new(Box::new(case.law) as Box<dyn ContactLaw>, samples).unwrap();
    load(&sampled, motion(&case.table, &case.displacement), false)
}

fn check_marches(directions: usize, seed: u64, cases: usize, samples: usize, gate: f64) {
    let mut random = Random(seed);
    let mut compared = 0;
    let mut worst = 0.0_f64;
    for n in 0..cases {
        let case = random_case(&mut random, directions, 1 + n % 15);
        let u = motion(&case.table, &case.displacement);
        // What a contact keeps that never slips is assumed; a march has it from its start.
        if shakes_down(&case) {
            continue;
        }
        compared += 1;
        let found = load(exact(&case.law), u, false).value;
        let expected = marched(&case, samples).value;
        let stiffness = case.law.stiffness();
        let size = largest(&expected).max(stiffness[(0, 0)] * largest(&case.displacement));
        let error = found.iter().zip(&expected).map(|(a, b)| (a - b).abs() / size);
        let error = error.fold(0.0, f64::max);
        if error > gate {
            println!("{n}: {error:.1e} {:?}", case.law);
        }
        worst = worst.max(error);
    }
    println!("{compared} cases, worst {worst:.1e}");
    assert!(worst < gate && compared > 2 * cases / 3, "{worst:.1e} in {compared}");
}

/// Nothing presses a contact under a constant load of zero: it is the one without friction.
#[test]
fn a_contact_that_nothing_presses_has_no_traction() {
    let mut random = Random(5);
    for directions in [1, 2] {
        let case = random_case(&mut random, directions, 5);
        let size = directions * case.table.harmonics().slots();
        let u = motion(&case.table, &case.displacement[..size]);
        let [found, free] = [(0.3, 0.0), (0.0, 2.0)].map(|(friction, preload)| {
            let closure = Closure::Preload(preload);
            let law = Coulomb::new(directions, friction, 50.0, None, closure).unwrap();
            load(exact(&law), u, true)
        });
        assert!(largest(&free.value) > 0.0);
        assert_eq!((found.active, &found.value), (free.active, &free.value));
        assert_eq!(found.tangent, free.tangent);
    }
}

#[test]
fn one_direction_agrees_with_a_fine_march() {
    check_marches(1, 41, 150, 1 << 16, 1e-6);
}

#[test]
fn two_directions_agree_with_a_fine_march() {
    check_marches(2, 71, 150, 1 << 14, 1e-5);
}

/// Friction work and mean, first cosine and sine of both tractions along an ellipse: half-axes and
/// angle of the first one.
fn prescribed(half_axes: [f64; 2], angle: f64) -> (f64, [f64; 6]) {
    let table = SampleTable::new(Harmonics::new(5, false));
    let slots = table.harmonics().slots();
    let (sin, cos) = angle.sin_cos();
    let mut displacement = vec![0.0; 3 * slots];
    (displacement[1], displacement[slots + 1]) = (half_axes[0] * cos, half_axes[0] * sin);
    (displacement[2], displacement[slots + 2]) = (-half_axes[1] * sin, half_axes[1] * cos);
    let law = Coulomb::new(2, 0.4, 2e6, Some(3e6), Closure::Preload(300.0)).unwrap();
    let u = motion(&table, &displacement);
    let series = force(&law, u);
    let work = summary(&law, u).iter().map(|summary| summary.dissipation).sum();
    let mut found = [0.0; 6];
    found[..3].copy_from_slice(&series[..3]);
    found[3..].copy_from_slice(&series[slots..slots + 3]);
    (work, found)
}

#[test]
fn prescribed_motions_have_their_known_forces() {
    let (r, delta, limit) = (2e-4_f64, 120.0 / 2e6, 120.0);
    let root = (1.0 - (delta / r).powi(2)).sqrt();
    let (c, s) = (2e6 * delta * delta / r, -limit * root);
    let (work, found) = prescribed([r, r], 0.0);
    assert_close(&[work], &[2.0 * PI * r * limit * root], 1e-10, "circle");
    assert_close(&found, &[0.0, c, s, 0.0, -s, c], 1e-10, "circle");
    assert_close(&[work], &[0.14385064], 1e-7, "circle");
    let (work, found) = prescribed([3e-4, 1e-4], 0.0);
    assert_close(&[work], &[0.14615667], 1e-7, "ellipse");
    let expected = [0.0, 59.00718, -127.04818, 0.0, 84.08660, 28.33094];
    assert_close(&found, &expected, 1e-7, "ellipse");
    let (work, found) = prescribed([3e-4, 0.0], PI / 6.0);
    assert_close(&[work], &[4.0 * limit * (3e-4 - delta)], 1e-11, "line");
    let expected = [0.0, 73.9820, -105.8552, 0.0, 42.7136, -61.1155];
    assert_close(&found, &expected, 1e-6, "line");
}

/// The tangential displacements in a frame that is turned by an angle.
fn turned(case: &Case, angle: f64) -> Vec<f64> {
    let slots = case.table.harmonics().slots();
    let (sin, cos) = angle.sin_cos();
    let mut out = case.displacement.clone();
    for k in 0..slots {
        let (x, y) = (case.displacement[k], case.displacement[slots + k]);
        (out[k], out[slots + k]) = (cos * x - sin * y, sin * x + cos * y);
    }
    out
}

#[test]
fn no_direction_is_special() {
    let mut random = Random(79);
    let mut worst = 0.0_f64;
    for n in 0..150 {
        let mut case = random_case(&mut random, 2, 1 + n % 9);
        let angle = 3.0 * random.next();
        let value = load(exact(&case.law), motion(&case.table, &case.displacement), false).value;
        let displacement = turned(&case, angle);
        let found = load(exact(&case.law), motion(&case.table, &displacement), false).value;
        case.displacement = value;
        let expected = turned(&case, angle);
        let size = largest(&expected);
        let error = found.iter().zip(&expected).map(|(a, b)| (a - b).abs() / size);
        let error = error.fold(0.0, f64::max);
        if error > 1e-10 {
            println!("{n}: {error:.1e} {:?}", case.law);
        }
        worst = worst.max(error);
    }
    println!("worst {worst:.1e}");
    assert!(worst < 1e-10, "{worst:.1e}");
}

#[test]
fn motion_along_a_line_has_one_direction() {
    let mut random = Random(83);
    for n in 0..100 {
        let mut case = random_case(&mut random, 1, 1 + n % 9);
        let slots = case.table.harmonics().slots();
        let (sin, cos) = (3.0 * random.next()).sin_cos();
        let parameters = case.law.parameters();
        let closure = match (n % 3, parameters[2].name) {
            (0, "preload") => Closure::Preload(parameters[2].value),
            (0, _) => Closure::Gap(parameters[2].value),
            _ => Closure::Preload(random.between(0.0, 2.0)),
        };
        let normal = (n % 3 == 0).then_some(parameters[3].value);
        if n % 3 == 1 {
            case.table = SampleTable::new(Harmonics::new(2 * (n % 5) + 1, true));
        }
        let slots = case.table.harmonics().slots().min(slots);
        case.table = SampleTable::new(match case.table.harmonics().half_wave() {
            true => Harmonics::new(slots - 1, true),
            false => case.table.harmonics().clone(),
        });
        let slots = case.table.harmonics().slots();
        let (mu, k) = (parameters[0].value, parameters[1].value);
        let law = |directions| Coulomb::new(directions, mu, k, normal, closure).unwrap();
        let along = &case.displacement[..slots];
        let rest: Vec<f64> = match normal {
            Some(_) => case.displacement[slots..2 * slots].to_vec(),
            None => Vec::new(),
        };
        let one: Vec<f64> = along.iter().chain(&rest).copied().collect();
        let two: Vec<f64> = along.iter().map(|u| cos * u).collect();
        let two: Vec<f64> =
            two.into_iter().chain(along.iter().map(|u| sin * u)).chain(rest).collect();
        for residual in [Residual::Centred, Residual::FromRest] {
            let at = |law: &Coulomb, displacement: &[f64]| {
                let motion = Motion { table: &case.table, displacement, residual };
                load(exact(law), motion, true)
            };
            let (one, two) = (at(&law(1), &one), at(&law(2), &two));
            let across: Vec<f64> =
                (0..slots).map(|k| cos * two.value[slots + k] - sin * two.value[k]).collect();
            let along: Vec<f64> =
                (0..slots).map(|k| cos * two.value[k] + sin * two.value[slots + k]).collect();
            let size = largest(&one.value).max(1e-6);
            for k in 0..slots {
                assert!(
                    (along[k] - one.value[k]).abs() < 1e-10 * size,
                    "{n} {k} {residual:?}: {} {} {size} {law:?}",
                    along[k],
                    one.value[k],
                    law = law(2)
                );
                assert!(across[k].abs() < 1e-10 * size, "{n} {k} {residual:?}: {}", across[k]);
            }
        }
    }
}

#[test]
fn constant_load_is_a_jenkins_element() {
    let mut random = Random(47);
    for n in 0..60 {
        let mut case = random_case(&mut random, 1, 7);
        let half_wave = n % 2 == 1;
        case.table = SampleTable::new(Harmonics::new(7, half_wave));
        let slots = case.table.harmonics().slots();
        let preload = random.between(0.0, 3.0);
        let (mu, k) = (random.between(0.0, 1.2), random.between(0.5, 5.0));
        let jenkins = Jenkins::new(k, mu * preload).unwrap();
        let u: Vec<f64> = case.displacement[..slots].to_vec();
        for normal in [None, Some(0.0)] {
            let law = Coulomb::new(1, mu, k, normal, Closure::Preload(preload)).unwrap();
            let mut all = u.clone();
            all.extend(case.displacement[slots..2 * slots].iter().filter(|_| normal.is_some()));
            for residual in [Residual::Centred, Residual::FromRest, Residual::Value(0.2)] {
                let by = |law: &dyn HarmonicForce, displacement: &[f64]| {
                    let motion = Motion { table: &case.table, displacement, residual };
                    let summary = summary(law, motion);
                    let shares = vec![summary[0].slip_fraction, summary[0].dissipation];
                    (load(law, motion, true), shares, law.state_history(motion, 64))
                };
                let (found, shares, history) = by(exact(&law), &all);
                let (expected, own_shares, own_history) = by(&jenkins, &u);
                assert_close(&found.value[..slots], &expected.value, 1e-12, "value");
                for i in 0..slots {
                    let row = &found.tangent[i * all.len()..][..slots];
                    assert_close(row, &expected.tangent[i * slots..][..slots], 1e-12, "tangent");
                }
                assert_close(&shares, &own_shares, 1e-12, "shares");
                assert_close(&history, &own_history, 1e-12, "history");
                assert_eq!(found.active, expected.active);
            }
        }
    }
}

/// A variable load that does not vary is a constant one: the play's numbers are the element's.
#[test]
fn a_normal_load_that_stands_still_is_constant() {
    let mut random = Random(53);
    for _ in 0..60 {
        let mut case = random_case(&mut random, 1, 7);
        let slots = case.table.harmonics().slots();
        let preload = random.between(0.1, 3.0);
        case.displacement[slots..].fill(0.0);
        case.displacement[slots] = random.between(0.0, 1.0);
        let (mu, k) = (random.between(0.0, 1.2), random.between(0.5, 5.0));
        let law = Coulomb::new(1, mu, k, Some(1.0), Closure::Preload(preload)).unwrap();
        let jenkins = Jenkins::new(k, mu * (preload + case.displacement[slots])).unwrap();
        let found = load(exact(&law), motion(&case.table, &case.displacement), true);
        let expected = load(&jenkins, motion(&case.table, &case.displacement[..slots]), true);
        assert_close(&found.value[..slots], &expected.value, 1e-12, "value");
        for i in 0..slots {
            let row = &found.tangent[i * 2 * slots..][..slots];
            let own = &expected.tangent[i * slots..][..slots];
            assert!(row.iter().zip(own).all(|(a, b)| (a - b).abs() < 1e-11 * k), "{row:?} {own:?}");
        }
    }
}
