//! Sliders in parallel on one displacement against as many elements of their own.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::Random;
use stickslip_core::contact::{
    Aft, ContactLaw, HarmonicForce as _, Jenkins, Motion, PointSummary, Residual, Slider, SlipLoad,
};
use stickslip_core::fourier::{Harmonics, SampleTable};

const COUNT: usize = 20;

/// Sliders of all kinds: with and without friction or spring, rigid ones and such as never slip.
fn sliders(random: &mut Random) -> Vec<Slider> {
    let stiffness = |random: &mut Random| 10f64.powf(random.between(-1.0, 2.0));
    let mut sliders: Vec<Slider> = (0..COUNT - 3)
        .map(|_| Slider::new(stiffness(random), 10f64.powf(random.between(-1.0, 2.0))).unwrap())
        .collect();
    sliders.push(Slider::new(stiffness(random), 0.0).unwrap());
    sliders.push(Slider::new(stiffness(random), f64::INFINITY).unwrap());
    sliders.push(Slider::new(0.0, 1.0).unwrap());
    sliders
}

fn series(random: &mut Random, table: &SampleTable) -> Vec<f64> {
    (0..table.harmonics().slots()).map(|slot| random.next() / (1.0 + slot as f64)).collect()
}

fn close(found: &[f64], expected: &[f64], tolerance: f64) {
    let size = expected.iter().fold(1e-300_f64, |most, x| most.max(x.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance * size, "{found} {expected} of {size}");
    }
}

#[test]
fn sliders_in_parallel_are_the_sum_of_single_elements() {
    let mut random = Random(7);
    let residuals = [Residual::Centred, Residual::FromRest, Residual::Value(0.3)];
    for (case, half_wave) in [false, true].into_iter().cycle().take(60).enumerate() {
        let table = SampleTable::new(Harmonics::new(7, half_wave));
        let (own, u) = (sliders(&mut random), series(&mut random, &table));
        let motion = Motion { table: &table, displacement: &u, residual: residuals[case % 3] };
        let law = Jenkins::of(own.clone()).unwrap();
        let singles: Vec<Jenkins> =
            own.iter().map(|slider| Jenkins::of(vec![*slider]).unwrap()).collect();
        let mut load = SlipLoad::default();
        law.slip_load(motion, true, &mut load);
        let size = u.len();
        let (mut value, mut tangent) = (vec![0.0; size], vec![0.0; size * size]);
        let (mut one, mut work, mut share) = (SlipLoad::default(), 0.0, 0.0);
        let mut forces = vec![0.0; 64];
        for (single, slider) in singles.iter().zip(&own) {
            single.slip_load(motion, true, &mut one);
            value.iter_mut().zip(&one.value).for_each(|(sum, q)| *sum += q);
            tangent.iter_mut().zip(&one.tangent).for_each(|(sum, t)| *sum += t);
            let mut summary = [PointSummary::default()];
            single.summary(motion, &mut summary);
            work += summary[0].dissipation;
            share += slider.stiffness * summary[0].slip_fraction;
            let history = single.force_history(motion, 64);
            forces.iter_mut().zip(&history).for_each(|(sum, f)| *sum += f);
        }
        close(&load.value, &value, 1e-12);
        close(&load.tangent, &tangent, 1e-12);
        close(&law.force_history(motion, 64), &forces, 1e-12);
        let mut summary = [PointSummary::default()];
        law.summary(motion, &mut summary);
        let total: f64 = own.iter().map(|slider| slider.stiffness).sum();
        close(&[summary[0].dissipation, summary[0].slip_fraction], &[work, share / total], 1e-12);
        let amplitude = 0.7 * f64::from(case as u8);
        let describing = |law: &Jenkins| law.describing(amplitude).unwrap();
        let sum: faer::c64 = singles.iter().map(|single| describing(single).stiffness).sum();
        assert!((describing(&law).stiffness - sum).norm() < 1e-12 * total);
    }
}

#[test]
fn the_tangent_is_the_derivative_of_the_slip_load() {
    let mut random = Random(11);
    for half_wave in [false, true].into_iter().cycle().take(20) {
        let table = SampleTable::new(Harmonics::new(5, half_wave));
        let law = Jenkins::of(sliders(&mut random)).unwrap();
        let u = series(&mut random, &table);
        let at = |u: &[f64], tangent: bool| {
            let mut load = SlipLoad::default();
            let motion = Motion { table: &table, displacement: u, residual: Residual::Centred };
            law.slip_load(motion, tangent, &mut load);
            load
        };
        let (exact, size) = (at(&u, true).tangent, u.len());
        for j in 0..size {
            let moved = |by: f64| {
                let mut moved = u.clone();
                moved[j] += by;
                at(&moved, false).value
            };
            let (up, down) = (moved(1e-6), moved(-1e-6));
            let slope: Vec<f64> = up.iter().zip(&down).map(|(a, b)| (a - b) / 2e-6).collect();
            let column: Vec<f64> = (0..size).map(|i| exact[i * size + j]).collect();
            let scale = law.stiffness()[(0, 0)];
            for (found, expected) in column.iter().zip(&slope) {
                assert!((found - expected).abs() < 1e-5 * scale, "{found} {expected}");
            }
        }
    }
}

#[test]
fn slopes_in_parameters_are_those_of_the_force() {
    let mut random = Random(13);
    let table = SampleTable::new(Harmonics::new(5, false));
    for _ in 0..10 {
        let law = Jenkins::of(sliders(&mut random)).unwrap();
        let u = series(&mut random, &table);
        let motion = Motion { table: &table, displacement: &u, residual: Residual::Centred };
        let force = |law: &dyn ContactLaw| -> Vec<f64> {
            let mut load = SlipLoad::default();
            law.slip_load(motion, false, &mut load);
            let stuck = law.stiffness()[(0, 0)];
            u.iter().zip(&load.value).map(|(u, q)| stuck * u - q).collect()
        };
        for (index, parameter) in law.parameters().iter().enumerate() {
            let step = 1e-6 * parameter.value;
            if !(step > 0.0 && step.is_finite()) {
                continue;
            }
            let moved = |by: f64| force(&*law.with_parameter(index, parameter.value + by).unwrap());
            let (up, down) = (moved(step), moved(-step));
            let expected: Vec<f64> =
                up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * step)).collect();
            let mut slope = vec![0.0; u.len()];
            law.parameter_slope(motion, index, &mut slope);
            let scale = 1.0 + expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            for (found, expected) in slope.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-4 * scale, "{index}: {found} {expected}");
            }
        }
    }
}

/// The error of the samples falls with the square of their distance.
#[test]
fn samples_converge_at_second_order() {
    let mut random = Random(17);
    let table = SampleTable::new(Harmonics::new(5, false));
    let law = Jenkins::of(sliders(&mut random)).unwrap();
    let u: Vec<f64> = series(&mut random, &table).iter().map(|u| 4.0 * u).collect();
    let motion = Motion { table: &table, displacement: &u, residual: Residual::Centred };
    let mut exact = SlipLoad::default();
    law.slip_load(motion, true, &mut exact);
    let error = |samples: usize| -> f64 {
        let sampled = Aft::new(law.with_scaled_forces(1.0), samples).unwrap();
        let mut load = SlipLoad::default();
        sampled.slip_load(motion, true, &mut load);
        let pairs = load.value.iter().zip(&exact.value);
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    let errors: Vec<f64> = [256, 1024, 4096].into_iter().map(error).collect();
    for pair in errors.windows(2) {
        let rate = (pair[0] / pair[1]).log2() / 2.0;
        assert!((1.5..2.7).contains(&rate), "{errors:?}");
    }
}
