//! The highest blade of mistuned rings: no point of a sweep lies above it; many patterns at once.

#![allow(clippy::unwrap_used)]

mod common;

use common::{snecma_beam, SLIP_FORCE, STIFFNESS};
use faer::{c64, Mat};
use std::cell::Cell;
use std::f64::consts::TAU;
use stickslip_core::balance::{
    sweep, ForcedBalance, HarmonicChoice, Linearised, PointStatus, Settings,
};
use stickslip_core::contact::{Jenkins, Residual};
use stickslip_core::design::{study, summits, Pattern, PeakQuery, Summits, TunedDisk};
use stickslip_core::fourier::{amplitude, Harmonics, Measure, SampleTable};
use stickslip_core::model::{Model, SectorContact};
use stickslip_core::structure::{HarmonicLoad, RingCoupling};

const SPAN: (f64, f64) = (150.0, 260.0);
const PATTERN: [f64; 5] = [0.06, -0.04, 0.0, 0.09, -0.08];
const SETTINGS: Settings = Settings {
    harmonics: HarmonicChoice::Fixed(3),
    tolerance: 1e-3,
    residual: Residual::Centred,
    max_harmonics: 255,
    evaluation: stickslip_core::balance::Evaluation::Direct,
    max_samples: 16384,
    method: stickslip_core::balance::Method::Newton,
    newton: stickslip_core::solve::NewtonSettings { tolerance: 1e-11, max_iterations: 50 },
};

/// A ring of beams coupled at their tips, with dampers to ground and between the tips.
fn disk(sectors: usize) -> TunedDisk {
    let beam = snecma_beam(20.313);
    let zero = Mat::<f64>::zeros(3, 3);
    let (mut own, mut next) = (zero.clone(), zero.clone());
    (own[(1, 1)], next[(1, 1)]) = (1.4e4, -7e3);
    let row = |dof: usize, sign: f64| Mat::from_fn(1, 3, |_, j| if j == dof { sign } else { 0.0 });
    let contact = |k, limit, own, next| SectorContact {
        law: Box::new(Jenkins::new(k, limit).unwrap()),
        own,
        next,
    };
    let load = |i: usize| {
        let mut amplitude = vec![c64::new(0.0, 0.0); 3];
        amplitude[1] = c64::from_polar(20.313, TAU * i as f64 / sectors as f64);
        vec![HarmonicLoad { harmonic: 1, amplitude }]
    };
    TunedDisk {
        mass: beam.mass,
        stiffness: beam.stiffness,
        coupled_stiffness: own,
        damping: [beam.damping, zero.clone(), zero.clone()],
        proportional: false,
        coupling: RingCoupling { mass: zero.clone(), damping: zero, stiffness: next },
        contacts: vec![
            contact(STIFFNESS, SLIP_FORCE, row(0, 1.0), Mat::zeros(1, 3)),
            contact(5e4, 5.0, row(1, 1.0), row(1, -1.0)),
        ],
        loads: (0..sectors).map(load).collect(),
    }
}

fn quest(model: &Model) -> PeakQuery {
    let dofs = model.compliance().dofs();
    let groups = vec![(0..dofs).step_by(3).collect(), (1..dofs).step_by(3).collect()];
    PeakQuery { groups, measure: Measure::HalfRange, span: SPAN }
}

/// Amplitudes of some DOFs at frequencies, point after point.
fn swept(model: &Model, omega: &[f64], dofs: &[usize]) -> Vec<Vec<f64>> {
    let balance = ForcedBalance::new(model, SETTINGS, dofs).unwrap();
    let half_wave = balance.half_wave();
    let solution = sweep(balance, omega).unwrap();
    let harmonics = Harmonics::new(3, half_wave);
    let table = SampleTable::new(harmonics.clone());
    let height = |amplitudes: &[c64]| {
        let mut series = vec![0.0; harmonics.slots()];
        harmonics.write_series(amplitudes, &mut series);
        amplitude(&table, &series, Measure::HalfRange)
    };
    solution
        .points
        .iter()
        .map(|point| point.displacement.chunks_exact(4).map(height).collect())
        .collect()
}

#[test]
fn no_point_of_a_fine_sweep_lies_above_the_summits() {
    let model = disk(5).mistuned(&PATTERN).unwrap();
    let quest = quest(&model);
    let found = summits(&model, SETTINGS, &quest, None, &|_| true).unwrap();
    let omega: Vec<f64> = (0..=1100).map(|i| SPAN.0 + 0.1 * f64::from(i)).collect();
    for (summit, group) in found.summits.iter().zip(&quest.groups) {
        let heights = swept(&model, &omega, group);
        let all = heights.iter().enumerate().flat_map(|(n, row)| {
            row.iter().enumerate().map(move |(blade, height)| (*height, blade, n))
        });
        let (height, blade, n) = all.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        assert_eq!(summit.status, PointStatus::Converged);
        assert!(height <= summit.amplitude * (1.0 + 1e-8), "{height} {}", summit.amplitude);
        assert!(height > 0.9999 * summit.amplitude);
        assert_eq!(summit.member, blade);
        assert!((summit.omega - omega[n]).abs() < 0.1);
        assert!(!summit.at_edge && summit.error_estimate > 0.0);
    }
    assert!(found.points < 60, "{}", found.points);
}

#[test]
fn slopes_of_all_blades_match_differences() {
    let model = disk(5).mistuned(&PATTERN).unwrap();
    let dofs: Vec<usize> = (0..15).collect();
    let (omega, step) = (193.0, 1e-4);
    let mut balance = ForcedBalance::new(&model, SETTINGS, &[]).unwrap();
    let point = balance.solve(omega, None).unwrap();
    let unknowns = point.unknowns().unwrap();
    let table = SampleTable::new(unknowns.harmonics().clone());
    let mut linearised =
        Linearised::new(&model, &table, Residual::Centred, omega, unknowns).unwrap();
    let jets = linearised.frequency_jets(&dofs, Measure::HalfRange).unwrap().unwrap();
    let (jets, rate) = (jets.amplitudes, jets.rate);
    let ends = swept(&model, &[omega - step, omega, omega + step], &dofs);
    for (dof, (height, slope)) in jets.iter().enumerate() {
        let difference = (ends[2][dof] - ends[0][dof]) / (2.0 * step);
        assert!((height / ends[1][dof] - 1.0).abs() < 1e-9);
        assert!((slope - difference).abs() < 1e-5 * (difference.abs() + height), "{dof}");
    }
    assert_eq!(rate.len(), unknowns.values().len());
}

/// Runs a study of random patterns; `most` ends it after so many.
fn run(threads: usize, most: usize) -> Vec<(usize, Summits)> {
    let (one, other) = (disk(5), disk(5));
    let rows: Vec<Vec<f64>> =
        (0..12).map(|n| (0..5).map(|i| 0.05 * f64::from(n * 5 + i).sin()).collect()).collect();
    let patterns: Vec<Pattern<'_>> =
        rows.iter().enumerate().map(|(n, row)| Pattern { disk: n % 2, deviations: row }).collect();
    let quest = PeakQuery { groups: vec![vec![1]], measure: Measure::HalfRange, span: SPAN };
    let mut found = Vec::new();
    let asked = Cell::new(0);
    study(
        &[&one, &other],
        &patterns,
        SETTINGS,
        &quest,
        &[None, None],
        threads,
        &mut |index, summits| {
            found.push((index, summits));
            found.len() < most
        },
        &mut || {
            asked.set(asked.get() + 1);
            true
        },
    )
    .unwrap();
    found.sort_by_key(|(index, _)| *index);
    found
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (one, three) = (run(1, 100), run(3, 100));
    assert_eq!(one.len(), 12);
    for ((index, alone), (same, company)) in one.iter().zip(&three) {
        assert_eq!((index, &alone.summits), (same, &company.summits));
        assert_eq!(alone.points, company.points);
    }
}

#[test]
fn a_study_ends_where_it_is_told_to() {
    assert_eq!(run(2, 3).len(), 3);
}

#[test]
fn impossible_disks_and_ranges_are_refused() {
    let disk = disk(5);
    let refused = |deviations: &[f64]| disk.mistuned(deviations).err().unwrap().to_string();
    assert!(refused(&[0.0; 4]).contains("expected 5 deviations, got 4"));
    assert!(refused(&[0.0, 0.0, -1.0, 0.0, 0.0]).contains("must be a deviation above -1"));
    let model = disk.mistuned(&PATTERN).unwrap();
    for (groups, span) in [(vec![vec![0]], (260.0, 150.0)), (vec![vec![]], SPAN), (vec![], SPAN)] {
        let quest = PeakQuery { groups, measure: Measure::Max, span };
        assert!(summits(&model, SETTINGS, &quest, None, &|_| true).is_err());
    }
    let quest = PeakQuery { groups: vec![vec![99]], measure: Measure::Max, span: SPAN };
    assert!(summits(&model, SETTINGS, &quest, None, &|_| true).is_err());
    let ended = PeakQuery { groups: vec![vec![0]], ..quest };
    let found = summits(&model, SETTINGS, &ended, None, &|_| false).unwrap();
    assert!(found.interrupted());
}
