//! Exact motions of contacts without sliders against Runge-Kutta, harmonic balance and differences.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::Random;
use common::tangents::largest;
use faer::{c64, Mat};
use stickslip_core::balance::{ForcedBalance, HarmonicChoice, PointStatus, Settings};
use stickslip_core::contact::{Backbone, ContactLaw, Jenkins, Masing, Residual};
use stickslip_core::model::{Contact, Model};
use stickslip_core::motion::{transient, History, Scheme, TransientSettings};
use stickslip_core::orbit::{Orbit, OrbitSettings, PeriodMap, PeriodicOrbits};
use stickslip_core::structure::{HarmonicLoad, Structure};

/// A random chain of unit masses with laws of all kinds to ground and between neighbours.
fn chain(random: &mut Random, symmetric: bool) -> (Model, f64) {
    let size = 1 + (random.between(0.0, 3.999) as usize);
    let mut stiffness = Mat::<f64>::zeros(size, size);
    for i in 0..size {
        stiffness[(i, i)] += random.between(0.3, 2.0);
        if i > 0 {
            let k = random.between(0.3, 2.0);
            stiffness[(i, i)] += k;
            stiffness[(i - 1, i - 1)] += k;
            stiffness[(i, i - 1)] -= k;
            stiffness[(i - 1, i)] -= k;
        }
    }
    let mass = Mat::from_fn(size, size, |i, j| if i == j { random.between(0.5, 2.0) } else { 0.0 });
    let damping = faer::Scale(random.between(0.01, 0.06)) * &stiffness;
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let count = 1 + (random.between(0.0, 2.999) as usize);
    let contacts = (0..count)
        .map(|_| {
            let (k, limit) = (random.between(0.2, 2.0), random.between(0.1, 2.0));
            let law: Box<dyn ContactLaw> = match random.between(0.0, 5.999) as usize {
                0 => Box::new(Masing::new(k, limit, Backbone::Exponential).unwrap()),
                1 => {
                    let lag = 10.0_f64.powf(random.between(-1.0, 1.5));
                    Box::new(Masing::new(k, limit, Backbone::shear_layer(lag).unwrap()).unwrap())
                }
                2 => {
                    let rows = ([0.1, 0.3, 0.7, 2.0], [1.0, 2.5, 4.0, 4.4]);
                    let table = Backbone::table(&rows.0, &rows.1).unwrap().0;
                    Box::new(Masing::new(k, limit, table).unwrap())
                }
                3 => Box::new(Jenkins::new(k, limit).unwrap()),
                _ => {
                    let beta = random.between(-1.0, 2.0).max(0.0);
                    Box::new(Masing::iwan(k, limit, random.between(-0.97, 0.0), beta).unwrap())
                }
            };
            let one = (random.between(0.0, size as f64 - 1e-9)) as usize;
            let other = (random.between(0.0, size as f64 - 1e-9)) as usize;
            let grounded = other == one;
            let rows = Mat::from_fn(1, size, |_, j| {
                let own = f64::from(u8::from(j == one));
                if grounded {
                    own
                } else {
                    own - f64::from(u8::from(j == other))
                }
            });
            Contact { law, rows }
        })
        .collect();
    let force = 10.0_f64.powf(random.between(-1.0, 0.7));
    let mut load = |harmonic: usize, share: f64| HarmonicLoad {
        harmonic,
        amplitude: (0..size)
            .map(|_| {
                c64::from_polar(
                    share * force * random.between(0.0, 1.0),
                    if harmonic == 0 { 0.0 } else { random.between(0.0, 6.0) },
                )
            })
            .collect(),
    };
    let mut loads = vec![load(1, 1.0)];
    if symmetric {
        loads.push(load(3, 0.5));
    } else {
        loads.push(load(0, 0.4));
        loads.push(load(2, 0.5));
    }
    let omega = random.between(0.4, 2.5);
    (Model::new(structure, contacts, loads).unwrap(), omega)
}

fn all(model: &Model) -> Vec<usize> {
    (0..model.structure().mass().nrows()).collect()
}

fn run(model: &Model, omega: f64, scheme: Scheme) -> History {
    let settings =
        TransientSettings { omega, scheme, periods: 12, tolerance: None, samples: 32, keep: None };
    transient(model, &settings, None, &all(model), &|_| true).unwrap()
}

#[test]
fn transients_from_rest_are_those_of_runge_kutta() {
    for seed in 0..16 {
        let (model, omega) = chain(&mut Random(1000 + seed), seed % 2 == 0);
        let exact = run(&model, omega, Scheme::Exact);
        assert_eq!(exact.halt, None, "seed {seed}");
        let steps = run(&model, omega, Scheme::RungeKutta(4096));
        for (a, b) in [
            (&exact.trace.displacement, &steps.trace.displacement),
            (&exact.trace.force, &steps.trace.force),
        ] {
            let size = largest(b);
            let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 3e-5 * size, "seed {seed}: {apart:e} of {size:e}");
        }
    }
}

fn orbit(model: &Model, omega: f64, residual: Residual) -> Orbit {
    let observe = all(model);
    let settings = OrbitSettings { residual, ..OrbitSettings::default() };
    PeriodicOrbits::new(model, settings, &observe).unwrap().solve(omega, None).unwrap()
}

#[test]
fn orbits_close_their_energy_and_agree_with_the_balance() {
    let mut iterations = Vec::new();
    for seed in 0..20 {
        let symmetric = seed % 3 != 0;
        let (model, omega) = chain(&mut Random(2000 + seed), symmetric);
        let residual = if seed % 2 == 0 { Residual::Centred } else { Residual::FromRest };
        let orbit = orbit(&model, omega, residual);
        assert_eq!(orbit.response.status, PointStatus::Converged, "seed {seed}");
        iterations.push(orbit.response.iterations);
        let lost: f64 = orbit.response.contacts.iter().map(|own| own.dissipation).sum();
        let balance = orbit.work - orbit.viscous - lost;
        assert!(balance.abs() < 1e-9 * (orbit.viscous + lost), "seed {seed}: {balance:e}");
        let harmonics = 25;
        let settings = Settings {
            harmonics: HarmonicChoice::Fixed(harmonics),
            max_harmonics: harmonics,
            residual,
            ..Settings::default()
        };
        let observe = all(&model);
        let mut equations = ForcedBalance::new(&model, settings, &observe).unwrap();
        let point = equations.solve(omega, None).unwrap();
        let half = |coefficients: &[c64], orders: usize| -> Vec<f64> {
            (0..observe.len()).map(|dof| coefficients[dof * orders + 1].norm()).collect()
        };
        let [a, b] = [&orbit.response, &point].map(|of| half(&of.displacement, of.harmonics + 1));
        let size = largest(&a);
        for (a, b) in a.iter().zip(&b) {
            assert!((a - b).abs() < 1e-4 * size, "seed {seed}: {a} {b}");
        }
        let mean = |of: &stickslip_core::balance::Point| -> Vec<f64> {
            observe.iter().map(|dof| of.displacement[dof * (of.harmonics + 1)].re).collect()
        };
        for (a, b) in mean(&orbit.response).iter().zip(mean(&point)) {
            assert!((a - b).abs() < 1e-4 * size, "seed {seed}: means {a} {b}");
        }
    }
    iterations.sort_unstable();
    assert!(iterations[iterations.len() / 2] <= 8);
}

/// Multipliers against those of the equations linearised along a balance of many harmonics.
#[test]
fn multipliers_are_those_along_the_balance() {
    for seed in 0..4 {
        let (model, omega) = chain(&mut Random(3000 + seed), true);
        let orbit = orbit(&model, omega, Residual::Centred);
        let harmonics = 25;
        let settings = Settings {
            harmonics: HarmonicChoice::Fixed(harmonics),
            max_harmonics: harmonics,
            ..Settings::default()
        };
        let observe = all(&model);
        let mut equations = ForcedBalance::new(&model, settings, &observe).unwrap();
        let point = equations.solve(omega, None).unwrap();
        let map = PeriodMap::new(&model).unwrap();
        let Some(found) = map.multipliers(omega, point.unknowns().unwrap(), Some(1e-5)) else {
            continue;
        };
        let own: Vec<c64> = orbit.multipliers[orbit.neutral..].to_vec();
        for value in own.iter().filter(|value| value.norm() > 1e-2) {
            let apart = |other: &c64| (other - value).norm();
            let nearest = found.values.iter().map(apart).fold(f64::INFINITY, f64::min);
            assert!(nearest < 3e-3, "seed {seed}: {own:?} {:?}", found.values);
        }
    }
}
