//! The sampling error of marched balances: its estimate against the event-driven evaluation, and
//! the numbers of samples that it chooses.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::grid;
use common::damper::{damped_beams, DOFS};
use common::{snecma_beam, SLIP_FORCE, STIFFNESS};
use faer::{c64, Mat};
use std::f64::consts::TAU;
use stickslip_core::balance::{
    sweep, sweep_range, Evaluation, ForcedBalance, HarmonicChoice, Point, PointStatus,
    SampleChoice, Settings, Solution,
};
use stickslip_core::contact::{BoucWen, ContactLaw, Jenkins};
use stickslip_core::design::{peak_curve, summits, PeakQuery, Target};
use stickslip_core::fourier::{amplitude, Harmonics, Measure, SampleTable};
use stickslip_core::model::{Contact, MarchedLaws, Model, SectorContact, Variation};
use stickslip_core::orbit::{orbit_sweep, OrbitSettings, PeriodicOrbits};
use stickslip_core::structure::{HarmonicLoad, RingCoupling, Structure};

fn fixed(highest: usize, tolerance: f64) -> Settings {
    Settings { harmonics: HarmonicChoice::Fixed(highest), tolerance, ..Settings::default() }
}

fn marched(settings: Settings, samples: SampleChoice) -> Settings {
    Settings { evaluation: Evaluation::Marched(samples), ..settings }
}

fn solve(model: &Model, settings: Settings, observe: &[usize], omega: &[f64]) -> Solution {
    sweep(ForcedBalance::new(model, settings, observe).unwrap(), omega).unwrap()
}

/// Sum over the harmonics of what two solutions differ by at one DOF, relative to its fundamental.
fn apart(one: &Point, other: &Point, dof: usize) -> f64 {
    let series = |p: &Point| {
        let orders = p.harmonics + 1;
        p.displacement[dof * orders..(dof + 1) * orders].to_vec()
    };
    let (a, b) = (series(one), series(other));
    a.iter().zip(&b).map(|(a, b)| (a - b).norm()).sum::<f64>() / b[1].norm()
}

/// Models, their frequencies and DOFs.
fn systems() -> Vec<(Model, Vec<f64>, Vec<usize>)> {
    let beams = [6.563, 20.313, 31.475, 38.438];
    let beams = beams.map(|f| (snecma_beam(f).model(), grid(120.0, 290.0, 60), vec![0, 1]));
    let pairs = [60.0, 120.0].map(|f| (damped_beams(f), grid(500.0, 600.0, 25), DOFS.to_vec()));
    beams.into_iter().chain(pairs).collect()
}

#[test]
fn estimates_are_the_true_error_or_more() {
    for (model, omega, observe) in systems() {
        let mut ratios = Vec::new();
        for highest in [5, 11] {
            let exact = solve(&model, fixed(highest, 1e-3), &observe, &omega);
            for samples in [64, 512] {
                let settings = marched(fixed(highest, 1e-3), SampleChoice::Fixed(samples));
                let coarse = solve(&model, settings, &observe, &omega);
                for (p, q) in coarse.points.iter().zip(&exact.points) {
                    for dof in 0..observe.len() {
                        let truth = apart(p, q, dof);
                        let size = q.displacement[dof * (highest + 1) + 1].norm();
                        let estimate = p.sampling_error[dof] / size;
                        assert!(p.error_estimate[dof] >= p.sampling_error[dof]);
                        if truth > 1e-8 {
                            ratios.push(estimate / truth);
                        }
                    }
                }
            }
        }
        ratios.sort_by(f64::total_cmp);
        let count = ratios.len();
        let median = ratios[count / 2];
        let below = ratios.iter().filter(|r| **r < 0.67).count() as f64 / count as f64;
        assert!(count > 50 && (1.1..1.5).contains(&median), "{median:.2} of {count}");
        assert!(below < 0.03 && ratios[0] > 0.1, "{below:.3}, least {:.2}", ratios[0]);
    }
}

#[test]
fn automatic_samples_keep_their_share_of_every_tolerance() {
    for (model, omega, observe) in systems() {
        let exact = solve(&model, fixed(9, 1e-3), &observe, &omega);
        let mut before = usize::MAX;
        for tolerance in [1e-4, 1e-3, 1e-2] {
            let settings = marched(fixed(9, tolerance), SampleChoice::Auto);
            let curve = solve(&model, settings, &observe, &omega);
            let mut worst = 0.0_f64;
            for (p, q) in curve.points.iter().zip(&exact.points) {
                assert_eq!(p.status, PointStatus::Converged);
                assert!(p.samples.unwrap().is_power_of_two());
                worst = (0..observe.len()).map(|dof| apart(p, q, dof)).fold(worst, f64::max);
            }
            assert!(worst < 0.4 * tolerance, "{tolerance:e}: {worst:e}");
            // Nor are there many more than it takes.
            assert!(worst > 0.02 * tolerance, "{tolerance:e}: {worst:e}");
            let all: usize = curve.points.iter().map(|p| p.samples.unwrap()).sum();
            assert!(all < before);
            before = all;
        }
    }
}

#[test]
fn truncation_and_sampling_together_keep_the_tolerance_against_orbits() {
    let observe = [0, 1, 2];
    let omega = grid(20.0, 350.0, 100);
    for force in [6.563, 31.475] {
        let model = snecma_beam(force).model();
        let settings = OrbitSettings { harmonics: 1, ..OrbitSettings::default() };
        let orbits =
            orbit_sweep(PeriodicOrbits::new(&model, settings, &observe).unwrap(), &omega).unwrap();
        for tolerance in [1e-2, 1e-3] {
            let settings = Settings { tolerance, ..Settings::default() };
            let curve = solve(&model, marched(settings, SampleChoice::Auto), &observe, &omega);
            for (point, orbit) in curve.points.iter().zip(&orbits.points) {
                assert_eq!(point.status, PointStatus::Converged);
                let table = SampleTable::new(Harmonics::new(point.harmonics, true));
                let mut series = vec![0.0; table.harmonics().slots()];
                let amplitudes = point.displacement.chunks_exact(point.harmonics + 1);
                for (amplitudes, range) in amplitudes.zip(&orbit.range) {
                    table.harmonics().write_series(amplitudes, &mut series);
                    let exact = 0.5 * (range[1] - range[0]);
                    let error = amplitude(&table, &series, Measure::HalfRange) / exact - 1.0;
                    assert!(error.abs() < tolerance, "{force} N, {} rad/s", point.omega);
                }
            }
        }
    }
}

#[test]
fn given_samples_are_taken_as_they_are() {
    let model = snecma_beam(20.313).model();
    let omega = grid(150.0, 250.0, 30);
    let curve = solve(&model, marched(fixed(9, 1e-3), SampleChoice::Fixed(90)), &[0, 1], &omega);
    let same =
        solve(&model.marched(90, MarchedLaws::All).unwrap(), fixed(9, 1e-3), &[0, 1], &omega);
    for (p, q) in curve.points.iter().zip(&same.points) {
        assert_eq!((p.samples, q.samples), (Some(90), None));
        assert_eq!(p.displacement, q.displacement);
        // Evaluated as they are, even marched laws have no sampling error that would be known.
        assert_eq!(q.sampling_error, [0.0, 0.0]);
        for dof in 0..2 {
            let sum = q.error_estimate[dof] + p.sampling_error[dof];
            assert!((p.error_estimate[dof] - sum).abs() <= 1e-12 * sum);
        }
    }
    assert!(curve.points.iter().any(|p| p.sampling_error[1] > 0.0));
}

/// A law that has no form of its own is marched; the exact integrals of others stay exact beside it.
#[test]
fn laws_with_a_form_keep_it_beside_marched_ones() {
    let beam = snecma_beam(20.313);
    let beside = |matrix: &Mat<f64>, own: f64| {
        Mat::from_fn(4, 4, |i, j| match (i, j) {
            (3, 3) => own,
            (3, _) | (_, 3) => 0.0,
            _ => matrix[(i, j)],
        })
    };
    let structure = Structure::new(
        beside(&beam.mass, 1.0).as_ref(),
        beside(&beam.damping, 10.0).as_ref(),
        beside(&beam.stiffness, 4e4).as_ref(),
    );
    let at = |dof: usize| Mat::from_fn(1, 4, |_, j| f64::from(u8::from(j == dof)));
    let laws: [Box<dyn ContactLaw>; 2] = [
        Box::new(Jenkins::new(STIFFNESS, SLIP_FORCE).unwrap()),
        Box::new(BoucWen::new(1e4, 5.0, 1.0, 0.5).unwrap()),
    ];
    let contacts = laws.into_iter().zip([0, 3]).map(|(law, dof)| Contact { law, rows: at(dof) });
    let force = |dof: usize| match dof {
        1 => c64::new(20.313, 0.0),
        3 => c64::new(10.0, 0.0),
        _ => c64::new(0.0, 0.0),
    };
    let load = HarmonicLoad { harmonic: 1, amplitude: (0..4).map(force).collect() };
    let mixed = Model::new(structure.unwrap(), contacts.collect(), vec![load]).unwrap();
    let omega = grid(170.0, 210.0, 9);
    let settings = fixed(9, 1e-2);
    let both = solve(&mixed, settings, &[1], &omega);
    let marched = solve(&mixed, marched(settings, SampleChoice::Auto), &[1], &omega);
    let alone = solve(&beam.model(), settings, &[1], &omega);
    let (mut worst, mut sampled) = (0.0_f64, 0.0_f64);
    for ((p, r), q) in both.points.iter().zip(&marched.points).zip(&alone.points) {
        assert!(p.samples.is_some() && p.is_solved());
        worst = worst.max(apart(p, q, 0));
        sampled = sampled.max(apart(r, q, 0));
    }
    assert!(worst < 1e-8, "{worst:e}");
    assert!(sampled > 1e-5, "{sampled:e}");
}

#[test]
fn a_limit_of_samples_is_a_status() {
    let model = snecma_beam(20.313).model();
    let settings = marched(fixed(9, 1e-5), SampleChoice::Auto);
    let curve = solve(&model, Settings { max_samples: 256, ..settings }, &[1], &[140.0, 190.0]);
    let [stuck, slipping] = &curve.points[..] else { unreachable!() };
    assert_eq!((stuck.status, stuck.samples), (PointStatus::Converged, Some(64)));
    assert_eq!((slipping.status, slipping.samples), (PointStatus::SamplesLimit, Some(256)));
    assert!(slipping.is_solved() && slipping.sampling_error[0] > 2.5e-6 * 1e-3);
    // The rest of the error is brought down all the same.
    let settings = Settings { tolerance: 1e-3, ..marched(Settings::default(), SampleChoice::Auto) };
    let settings = Settings { max_samples: 256, max_harmonics: 63, ..settings };
    let curve = solve(&model, settings, &[1], &[190.0]);
    let point = &curve.points[0];
    assert_eq!((point.status, point.samples), (PointStatus::SamplesLimit, Some(256)));
    let truncation = point.error_estimate[0] - point.sampling_error[0];
    assert!(truncation < 1.1e-3 * point.displacement[1].norm(), "{truncation:e}");
    for (most, harmonics) in [(1000, 9), (32, 9), (1024, 300), (1 << 21, 9)] {
        let settings = marched(fixed(harmonics, 1e-3), SampleChoice::Auto);
        let settings = Settings { max_samples: most, ..settings };
        let refused = ForcedBalance::new(&model, settings, &[1]).map(|_| ()).unwrap_err();
        assert!(refused.to_string().contains(&format!("max_samples = {most}")), "{refused}");
    }
}

#[test]
fn the_next_point_begins_with_what_the_last_one_took() {
    let model = damped_beams(120.0);
    let settings = marched(fixed(9, 1e-3), SampleChoice::Auto);
    let mut balance = ForcedBalance::new(&model, settings, &DOFS).unwrap();
    let first = balance.solve(530.0, None).unwrap();
    let again = balance.solve(530.0, first.unknowns()).unwrap();
    assert!(first.samples.unwrap() >= 256);
    assert!(again.samples <= first.samples);
    assert!(3 * again.iterations < first.iterations, "{} {}", again.iterations, first.iterations);
    // Where nothing slips any more they are few again.
    let far: Vec<usize> =
        (0..8).map(|_| balance.solve(250.0, None).unwrap().samples.unwrap()).collect();
    assert_eq!(far.last(), Some(&64), "{far:?}");
}

/// A ring of beams coupled at their tips, with dampers to ground.
fn ring(sectors: usize, deviations: &[f64]) -> Model {
    let beam = snecma_beam(20.313);
    let zero = Mat::<f64>::zeros(3, 3);
    let (mut own, mut next) = (zero.clone(), zero.clone());
    (own[(1, 1)], next[(1, 1)]) = (1.4e4, -7e3);
    let load = |i: usize| {
        let mut amplitude = vec![c64::new(0.0, 0.0); 3];
        amplitude[1] = c64::from_polar(20.313, TAU * i as f64 / sectors as f64);
        vec![HarmonicLoad { harmonic: 1, amplitude }]
    };
    let contact = SectorContact {
        law: Box::new(Jenkins::new(STIFFNESS, SLIP_FORCE).unwrap()),
        own: Mat::from_fn(1, 3, |_, j| f64::from(u8::from(j == 0))),
        next: Mat::zeros(1, 3),
    };
    stickslip_core::design::TunedDisk {
        mass: beam.mass,
        stiffness: beam.stiffness,
        coupled_stiffness: own,
        damping: [beam.damping, zero.clone(), zero.clone()],
        proportional: false,
        coupling: RingCoupling { mass: zero.clone(), damping: zero, stiffness: next },
        contacts: vec![contact],
        loads: (0..sectors).map(load).collect(),
    }
    .mistuned(deviations)
    .unwrap()
}

#[test]
fn rings_keep_the_tolerance_and_their_symmetry_within_it() {
    let tips: Vec<usize> = (0..7).map(|i| 3 * i + 1).collect();
    let omega = grid(180.0, 220.0, 15);
    for deviations in [[0.0; 7], [0.06, -0.04, 0.0, 0.09, -0.08, 0.02, 0.01]] {
        let model = ring(7, &deviations);
        let exact = solve(&model, fixed(5, 1e-3), &tips, &omega);
        let curve = solve(&model, marched(fixed(5, 1e-3), SampleChoice::Auto), &tips, &omega);
        assert!(exact.points.iter().any(|p| p.contacts.iter().all(|c| c.slip_fraction > 0.0)));
        for (p, q) in curve.points.iter().zip(&exact.points) {
            assert_eq!(p.status, PointStatus::Converged);
            // Seven sectors never share the instants of a power of two: they differ by no more.
            let worst = (0..7).map(|dof| apart(p, q, dof)).fold(0.0, f64::max);
            assert!(worst < 4e-4, "{} rad/s: {worst:e}", p.omega);
        }
    }
}

#[test]
fn ranges_and_summits_choose_samples_too() {
    let model = snecma_beam(20.313).model();
    let settings = marched(Settings::default(), SampleChoice::Auto);
    let balance = ForcedBalance::new(&model, settings, &[1]).unwrap();
    let curve = sweep_range(balance, 150.0, 250.0).unwrap();
    assert!(curve.points.iter().all(|p| p.status == PointStatus::Converged));
    let quest =
        PeakQuery { groups: vec![vec![1]], measure: Measure::HalfRange, span: (150.0, 250.0) };
    let summit = |settings: Settings| {
        let found = summits(&model, settings, &quest, None, &|_| true).unwrap();
        assert_eq!(found.summits[0].status, PointStatus::Converged);
        found.summits[0]
    };
    let (own, exact) = (summit(settings), summit(Settings::default()));
    assert!((own.amplitude / exact.amplitude - 1.0).abs() < 1e-3);
    assert!(own.error_estimate > 0.0);
    let target = Target { dof: 1, measure: Measure::HalfRange, span: (150.0, 250.0) };
    let curve = |settings: Settings| {
        let levels = [0.6, 1.0, 1.4];
        peak_curve(&model, settings, &Variation::Level, &levels, &target, &|_| true, None)
            .unwrap()
            .peaks
    };
    for (own, exact) in curve(settings).iter().zip(&curve(Settings::default())) {
        assert_eq!(own.status, PointStatus::Converged);
        assert!((own.amplitude / exact.amplitude - 1.0).abs() < 1e-3);
        assert!((own.slope / exact.slope - 1.0).abs() < 0.05);
    }
    let given = summit(marched(fixed(9, 1e-3), SampleChoice::Fixed(512)));
    let same = summits(
        &model.marched(512, MarchedLaws::All).unwrap(),
        fixed(9, 1e-3),
        &quest,
        None,
        &|_| true,
    );
    assert_eq!(given.amplitude, same.unwrap().summits[0].amplitude);
}
