//! What the exact evaluation of the Coulomb law tells beside its force: work, shares of slip, histories and
//! slopes in the parameters.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::Random;
use common::node::{assert_close, exact, force, largest, motion, random_case, summary};
use std::f64::consts::PI;
use stickslip_core::contact::{Closure, ContactLaw as _, Coulomb, SlipLoad};
use stickslip_core::fourier::{Harmonics, SampleTable};

fn work(series: &[f64], displacement: &[f64]) -> f64 {
    let pairs = series[1..].chunks_exact(2).zip(displacement[1..].chunks_exact(2));
    let term = |(order, (f, u)): (usize, (&[f64], &[f64]))| {
        (order + 1) as f64 * (f[0] * u[1] - f[1] * u[0])
    };
    PI * pairs.enumerate().map(term).sum::<f64>()
}

fn check_histories(directions: usize, seed: u64) {
    let mut random = Random(seed);
    for n in 0..60 {
        let case = random_case(&mut random, directions, 1 + n % 9);
        let (law, u) = (exact(&case.law), motion(&case.table, &case.displacement));
        let slots = case.table.harmonics().slots();
        let summary = summary(law, u);
        let series = force(&case.law, u);
        let stiffness = case.law.stiffness()[(0, 0)];
        let pull = stiffness * largest(&case.displacement[..directions * slots]);
        let size = (largest(&series) + pull) * largest(&case.displacement);
        for (i, point) in summary[..directions].iter().enumerate() {
            let own = i * slots..(i + 1) * slots;
            let expected = work(&series[own.clone()], &case.displacement[own]);
            let found = point.dissipation;
            assert!((found - expected).abs() < 1e-9 * size, "{n}: {found} {expected}");
            assert!(found >= 0.0);
            assert!((0.0..=1.0 + 1e-12).contains(&point.slip_fraction));
        }
        assert!((0.0..=1.0 + 1e-12).contains(&summary[directions].slip_fraction));
        assert_eq!(summary[directions].dissipation, 0.0);
        let count = 10_000;
        let history = law.force_history(u, count);
        let balanced = match case.law.parameters()[2] {
            closure if closure.name == "preload" => closure.value,
            _ => 0.0,
        };
        let friction = case.law.parameters()[0].value;
        let mut mean = vec![0.0; directions + 1];
        for forces in history.chunks_exact(directions + 1) {
            let normal = forces[directions] + balanced;
            let traction = forces[..directions].iter().map(|t| t * t).sum::<f64>().sqrt();
            assert!(traction <= friction * normal + 1e-12 * size, "{n}: {traction} {normal}");
            mean.iter_mut().zip(forces).for_each(|(sum, f)| *sum += f / count as f64);
        }
        for (i, mean) in mean.iter().enumerate() {
            assert!(
                (mean - series[i * slots]).abs() < 1e-5 * (largest(&series) + pull),
                "{n}: mean"
            );
        }
        let states = law.state_history(u, 100);
        let forces = law.force_history(u, 100);
        for (state, force) in
            states.chunks_exact(directions).zip(forces.chunks_exact(directions + 1))
        {
            assert_eq!(state, &force[..directions]);
        }
        let phases = law.phases(u);
        assert!(!phases.is_empty() && phases.windows(2).all(|p| p[0].start <= p[1].start));
    }
}

#[test]
fn work_shares_and_histories_in_one_direction() {
    check_histories(1, 59);
}

/// Under half-wave symmetry the second half of the period mirrors the first, wherever the march begins.
#[test]
fn histories_of_half_wave_symmetric_motions_cover_the_period() {
    let mut random = Random(97);
    for n in 0..40 {
        let case = random_case(&mut random, 2, 5);
        let friction = case.law.parameters()[0].value;
        let constant = Closure::Preload(random.between(0.1, 2.0));
        let law = Coulomb::new(2, friction, 2.0, None, constant).unwrap();
        let table = SampleTable::new(Harmonics::new(5, true));
        let slots = table.harmonics().slots();
        let u = motion(&table, &case.displacement[..2 * slots]);
        let series = force(&law, u);
        let count = 2_000;
        let history = exact(&law).force_history(u, count);
        for direction in 0..2 {
            let own = &series[direction * slots..(direction + 1) * slots];
            let mut basis = vec![0.0; slots];
            let mut found = vec![0.0; slots];
            for (sample, forces) in history.chunks_exact(2).enumerate() {
                table.harmonics().basis(2.0 * PI * sample as f64 / count as f64, &mut basis);
                let share = 2.0 * forces[direction] / count as f64;
                found.iter_mut().zip(&basis).for_each(|(sum, b)| *sum += share * b);
            }
            assert_close(&found, own, 1e-4 * (1.0 + largest(&series)), &format!("{n}"));
        }
        let phases = exact(&law).phases(u);
        let later = phases.iter().filter(|phase| phase.start >= PI).count();
        assert!(phases.len() == 1 || later.abs_diff(phases.len() - later) <= 1, "{n}: {later}");
    }
}

fn check_parameter_slopes(directions: usize, seed: u64) {
    let mut random = Random(seed);
    let mut errors = Vec::new();
    for n in 0..40 {
        let case = random_case(&mut random, directions, 1 + n % 7);
        let u = motion(&case.table, &case.displacement);
        for (index, parameter) in case.law.parameters().iter().enumerate() {
            let step = 1e-5 * parameter.value.abs().max(0.1);
            let at = |by: f64| {
                let law = case.law.with_parameter(index, parameter.value + by * step).unwrap();
                let mut out = SlipLoad::default();
                law.slip_load(u, false, &mut out);
                let (slots, stiffness) = (case.table.harmonics().slots(), law.stiffness());
                let stuck = |i: usize| stiffness[(i / slots, i / slots)] * case.displacement[i];
                (0..out.value.len()).map(|i| stuck(i) - out.value[i]).collect::<Vec<f64>>()
            };
            if parameter.value < 2.0 * step && parameter.name != "gap" {
                continue;
            }
            let sides = [at(1.0), at(-1.0), at(2.0), at(-2.0)];
            let mut slope = vec![0.0; case.displacement.len()];
            exact(&case.law).parameter_slope(u, index, &mut slope);
            let differences: Vec<f64> = (0..slope.len())
                .map(|i| {
                    let near = sides[0][i] - sides[1][i];
                    (8.0 * near - (sides[2][i] - sides[3][i])) / (12.0 * step)
                })
                .collect();
            let size = largest(&slope).max(largest(&differences)).max(1e-3);
            let error = slope.iter().zip(&differences).map(|(a, b)| (a - b).abs() / size);
            errors.push(error.fold(0.0, f64::max));
        }
    }
    errors.sort_by(f64::total_cmp);
    let most = errors[errors.len() * 97 / 100];
    assert!(most < 1e-7, "{:?}", &errors[errors.len() * 9 / 10..]);
}

#[test]
fn parameter_slopes_in_one_direction() {
    check_parameter_slopes(1, 61);
}

#[test]
fn work_shares_and_histories_in_two_directions() {
    check_histories(2, 89);
}

#[test]
fn parameter_slopes_in_two_directions() {
    check_parameter_slopes(2, 97);
}
