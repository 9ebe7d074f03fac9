//! Exact sensitivities against central differences of solutions solved anew.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::amplitude_of;
use common::{beam_pair, single_dof, snecma_beam, System};
use proptest::prelude::*;
use stickslip_core::balance::{
    Cause, ForcedBalance, HarmonicChoice, Linearised, Point, PointStatus, Settings,
};
use stickslip_core::contact::{ContactLaw, HarmonicForce, Jenkins, Motion, Residual};
use stickslip_core::fourier::{Harmonics, Measure, SampleTable};
use stickslip_core::solve::NewtonSettings;
use stickslip_core::Model;

const MEASURES: [Measure; 3] = [Measure::HalfRange, Measure::Max, Measure::Fundamental];

fn settings(highest: usize, residual: Residual) -> Settings {
    Settings {
        harmonics: HarmonicChoice::Fixed(highest),
        residual,
        newton: NewtonSettings { tolerance: 1e-14, ..NewtonSettings::default() },
        ..Settings::default()
    }
}

fn solve(model: &Model, settings: Settings, omega: f64, dof: usize) -> Point {
    let observe = [dof];
    let mut balance = ForcedBalance::new(model, settings, &observe).unwrap();
    let point = balance.solve(omega, None).unwrap();
    assert_eq!(point.status, PointStatus::Converged);
    point
}

/// The system with one quantity multiplied by `factor`.
fn changed(system: &System, cause: Cause, factor: f64) -> System {
    let mut changed = system.clone();
    match cause {
        Cause::Frequency => {}
        Cause::Load => {
            let varying = changed.forces.iter_mut().filter(|force| force.1 > 0);
            varying.for_each(|force| force.2 *= factor);
        }
        Cause::Law { contact, parameter: 0 } => changed.dampers[contact].2 *= factor,
        Cause::Law { contact, .. } => changed.dampers[contact].3 *= factor,
    }
    changed
}

fn causes(system: &System) -> Vec<(Cause, f64)> {
    let mut causes = vec![(Cause::Frequency, 1.0), (Cause::Load, 1.0)];
    for (contact, damper) in system.dampers.iter().enumerate() {
        causes.push((Cause::Law { contact, parameter: 0 }, damper.2));
        causes.push((Cause::Law { contact, parameter: 1 }, damper.3));
    }
    causes
}

/// Compares every sensitivity with central differences, to `tolerance` of amplitude over value.
fn compare(system: &System, omega: f64, dof: usize, highest: usize, residual: Residual) -> usize {
    compare_at(system, omega, dof, highest, residual, &[1e-5])
}

/// As [`compare`]; one of the steps has to agree, for a kink beside the point spoils the longer.
fn compare_at(
    system: &System,
    omega: f64,
    dof: usize,
    highest: usize,
    residual: Residual,
    steps: &[f64],
) -> usize {
    let model = system.model();
    let settings = settings(highest, residual);
    let point = solve(&model, settings, omega, dof);
    let unknowns = point.unknowns().unwrap();
    let half_wave = unknowns.harmonics().half_wave();
    let table = SampleTable::new(unknowns.harmonics().clone());
    let mut linearised = Linearised::new(&model, &table, residual, omega, unknowns).unwrap();
    for measure in MEASURES {
        for (cause, value) in causes(system) {
            let (size, slopes) = linearised.amplitude(dof, measure, &[cause]).unwrap();
            assert!((size - amplitude_of(&point, half_wave, 0, measure)).abs() <= 1e-12 * size);
            let at = |step: f64| {
                let factor = 1.0 + step;
                let frequency = if cause == Cause::Frequency { omega * factor } else { omega };
                let model = changed(system, cause, factor).model();
                amplitude_of(&solve(&model, settings, frequency, dof), half_wave, 0, measure)
            };
            let scale = if cause == Cause::Frequency { omega } else { value };
            let exact = slopes[0] * scale;
            let differences: Vec<f64> =
                steps.iter().map(|h| (at(*h) - at(-h)) / (2.0 * h)).collect();
            let agrees = |difference: &f64| {
                (exact - difference).abs() <= 1e-5 * difference.abs().max(1e-3 * size)
            };
            assert!(
                differences.iter().any(agrees),
                "{cause:?} {measure:?} at {omega}: {exact:e} {differences:?} of {size:e}"
            );
        }
    }
    point.contacts.iter().filter(|contact| contact.slip_fraction > 0.0).count()
}

#[test]
fn stuck_slipping_and_several_slips_per_period() {
    assert_eq!(compare(&snecma_beam(0.5), 225.0, 1, 9, Residual::Centred), 0);
    assert_eq!(compare(&snecma_beam(20.313), 170.0, 1, 15, Residual::Centred), 1);
    // Six slips per period (errata, Fig 4.2).
    assert_eq!(compare(&snecma_beam(25.0), 200.0, 0, 21, Residual::Centred), 1);
    assert_eq!(compare(&single_dof(2.0), 41.6, 0, 15, Residual::Centred), 1);
}

#[test]
fn dampers_between_dofs_and_to_ground() {
    for (force, omega) in [(20.313, 190.0), (38.438, 163.0), (15.0, 215.0)] {
        for dof in [1, 4] {
            assert!(compare(&beam_pair(force), omega, dof, 9, Residual::Centred) >= 1);
        }
    }
}

#[test]
fn static_loads_and_residual_forces() {
    for residual in [Residual::Centred, Residual::FromRest, Residual::Value(40.0)] {
        for force in [0.5, 20.313] {
            let mut system = snecma_beam(force);
            system.forces.push((1, 0, 0.6 * force, 0.0));
            system.forces.push((0, 2, 0.2 * force, 0.4));
            compare(&system, 172.0, 1, 8, residual);
        }
    }
    // The slip limit holds the residual force down.
    compare(&snecma_beam(0.5), 222.0, 1, 5, Residual::Value(400.0));
}

/// A response is homogeneous of degree one in the load and the slip forces together.
#[test]
fn load_and_slip_forces_scale_together() {
    let system = beam_pair(25.0);
    let model = system.model();
    let point = solve(&model, settings(9, Residual::Centred), 180.0, 1);
    let unknowns = point.unknowns().unwrap();
    let table = SampleTable::new(unknowns.harmonics().clone());
    let mut linearised =
        Linearised::new(&model, &table, Residual::Centred, 180.0, unknowns).unwrap();
    let forces: Vec<Cause> = (0..3).map(|contact| Cause::Law { contact, parameter: 1 }).collect();
    let (size, by_force) = linearised.amplitude(1, Measure::HalfRange, &forces).unwrap();
    let (_, by_load) = linearised.amplitude(1, Measure::HalfRange, &[Cause::Load]).unwrap();
    let sum: f64 = by_force.iter().zip(&system.dampers).map(|(s, damper)| s * damper.3).sum();
    assert!((by_load[0] + sum - size).abs() < 1e-8 * size, "{} {sum} {size}", by_load[0]);
}

/// Largest deviation of the slopes from differences of the contact force itself.
fn law_error(
    stiffness: f64,
    slip_force: f64,
    u: &[f64],
    half_wave: bool,
    residual: Residual,
) -> f64 {
    let table = SampleTable::new(Harmonics::new(5, half_wave));
    let motion = Motion { table: &table, displacement: u, residual };
    let force = |stiffness: f64, slip_force: f64| -> Vec<f64> {
        let law = Jenkins::new(stiffness, slip_force).unwrap();
        let mut load = stickslip_core::contact::SlipLoad::default();
        law.slip_load(motion, false, &mut load);
        u.iter().zip(&load.value).map(|(u, q)| stiffness * u - q).collect()
    };
    let law = Jenkins::new(stiffness, slip_force).unwrap();
    let mut worst = 0.0_f64;
    for (index, parameter) in law.parameters().into_iter().enumerate() {
        let value = parameter.value;
        let mut slope = vec![0.0; u.len()];
        law.parameter_slope(motion, index, &mut slope);
        // One-sided at zero, where no smaller value exists.
        let (h, back) = if value == 0.0 { (1e-7, 0.0) } else { (1e-6 * value, 1e-6 * value) };
        let at = |step: f64| match index {
            0 => force(stiffness + step, slip_force),
            _ => force(stiffness, slip_force + step),
        };
        for (s, (a, b)) in slope.iter().zip(at(h).iter().zip(&at(-back))) {
            worst = worst.max((s - (a - b) / (h + back)).abs());
        }
    }
    worst
}

#[test]
fn force_slopes_of_the_jenkins_element_in_every_state() {
    let odd = [1.0, 0.3, 0.0, -0.6, 0.25, 0.1];
    let all = [0.4, 1.0, 0.3, 0.2, -0.1, 0.0, -0.6, 0.1, 0.05, 0.25, 0.1];
    for residual in [Residual::Centred, Residual::FromRest, Residual::Value(0.2)] {
        // Stuck, slipping at two limits, without friction, without spring.
        for (k, limit) in [(2.0, 9.0), (2.0, 1.0), (2.0, 0.2), (2.0, 0.0), (2.0, 2.9)] {
            // Without friction the difference itself errs with the root of its step.
            let tolerance = if limit == 0.0 { 1e-3 } else { 2e-6 };
            let error = law_error(k, limit, &all, false, residual);
            assert!(error < tolerance, "{k} {limit} {residual:?}: {error}");
        }
    }
    for (k, limit) in [(2.0, 9.0), (2.0, 1.0), (2.0, 0.2), (2.0, 0.0), (0.0, 1.0), (0.0, 0.0)] {
        let tolerance = if limit == 0.0 && k > 0.0 { 1e-3 } else { 2e-6 };
        let error = law_error(k, limit, &odd, true, Residual::Centred);
        assert!(error < tolerance, "{k} {limit}: {error}");
    }
    assert!(law_error(0.0, 1.0, &all, false, Residual::Centred) < 2e-6);
}

/// A kink so close to the point that only the shortest step stays beside it.
#[test]
fn beside_a_kink() {
    let mut system = beam_pair(45.235_766_246_006_71);
    let (stiffness, limits) = (
        [0.397_600_573_063_264_35, 2.078_701_770_219_901_8, 1.251_683_522_167_873],
        [1.411_135_938_746_365_3, 0.941_137_131_682_835_7, 2.977_896_814_696_231_2],
    );
    for (damper, (k, limit)) in system.dampers.iter_mut().zip(stiffness.iter().zip(&limits)) {
        damper.2 *= k;
        damper.3 *= limit;
    }
    system.forces[1].3 = -2.121_757_065_289_133_8;
    let omega = 289.604_711_463_494_25;
    compare_at(&system, omega, 0, 7, Residual::Centred, &[1e-5, 1e-6, 1e-4, 3e-6, 3e-7]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Random dampers, loads and frequencies, stuck and slipping.
    #[test]
    fn random_systems(
        force in 2.0_f64..60.0,
        omega in 120.0_f64..300.0,
        stiffness in prop::array::uniform3(0.2_f64..3.0),
        limits in prop::array::uniform3(0.2_f64..3.0),
        phase in -3.0_f64..3.0,
        dof in 0_usize..6,
    ) {
        let mut system = beam_pair(force);
        for (damper, (k, limit)) in system.dampers.iter_mut().zip(stiffness.iter().zip(&limits)) {
            damper.2 *= k;
            damper.3 *= limit;
        }
        system.forces[1].3 = phase;
        compare_at(&system, omega, dof, 7, Residual::Centred, &[1e-5, 1e-6, 1e-4, 3e-6, 3e-7]);
    }
}
