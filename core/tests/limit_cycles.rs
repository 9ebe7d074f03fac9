//! Limit cycles under negative damping: the systems of Guillen (1999), chapter V, against values
//! that exact orbits, harmonic balance of many harmonics and fine time integration agree on.
#![allow(clippy::unwrap_used)]

mod common;

use common::snecma_beam;
use faer::{mat, Mat};
use stickslip_core::balance::HarmonicChoice;
use stickslip_core::contact::Jenkins;
use stickslip_core::model::{
    Contact, FlutterModel, Model, NegativeDamping, ParameterMode, Variation,
};
use stickslip_core::orbit::{
    limit_cycles, ChangeKind, Cycle, CycleOrbits, CycleSettings, LimitCycles, OrbitCurve,
};
use stickslip_core::solve::{at_parameter, End};
use stickslip_core::structure::Structure;
use stickslip_core::Error;

fn single_dof() -> (Model, Mat<f64>) {
    let one = |value: f64| Mat::from_fn(1, 1, |_, _| value);
    let structure =
        Structure::new(one(944.6).as_ref(), one(0.0).as_ref(), one(2.4e7).as_ref()).unwrap();
    let law = Box::new(Jenkins::new(2.4e7, 246.048).unwrap());
    let contacts = vec![Contact { law, rows: mat![[1.0]] }];
    (Model::new(structure, contacts, Vec::new()).unwrap(), one(-7699.054))
}

fn beam() -> (Model, Mat<f64>) {
    let mut system = snecma_beam(0.0);
    let negative = faer::Scale(-1.0) * &system.damping;
    system.damping = Mat::zeros(3, 3);
    system.forces.clear();
    (system.model(), negative)
}

/// Number of multipliers outside the unit circle.
fn unstable(cycle: &Cycle) -> usize {
    cycle.multipliers[cycle.neutral..].iter().filter(|m| m.norm() > 1.0).count()
}

fn follow((model, negative): &(Model, Mat<f64>), settings: &CycleSettings) -> LimitCycles {
    let negative = NegativeDamping::Whole(negative.clone());
    limit_cycles(model, &negative, &Variation::Ratio, 1.0, settings, &|_| true).unwrap()
}

fn exact(mode: usize, values: Option<Vec<f64>>) -> CycleSettings {
    CycleSettings { mode, values, exact: true, ..CycleSettings::default() }
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!((value / expected - 1.0).abs() <= relative, "{value} instead of {expected}");
}

/// Amplitude, frequency and largest multiplier: sticking and slipping at r = 0.1, 1, 3, 5.
const SINGLE: [(f64, [f64; 3], [f64; 3]); 4] = [
    (0.1, [1.0310896e-5, 225.38065, 7e-5], [2.5423978e-3, 159.43172, 1.0161]),
    (1.0, [1.0909294e-5, 224.01322, 0.0085], [2.4383235e-4, 160.51921, 1.1655]),
    (3.0, [1.2959006e-5, 216.70029, 0.1143], [7.0556856e-5, 166.33920, 1.4709]),
    (5.0, [1.9544597e-5, 197.41295, 0.7063], [2.8865970e-5, 183.15447, 1.2721]),
];

#[test]
fn the_single_mass_has_the_exact_cycles() {
    let system = single_dof();
    let values: Vec<f64> = SINGLE.iter().map(|row| row.0).collect();
    let cycles = follow(&system, &exact(0, Some(values)));
    assert_eq!(cycles.cycles.len(), 8);
    for (r, sticking, slipping) in SINGLE {
        for (slips, [amplitude, omega, multiplier]) in [(false, sticking), (true, slipping)] {
            let found = |c: &&Cycle| c.value == r && c.slipping == slips;
            let cycle = cycles.cycles.iter().find(found).unwrap();
            close(cycle.range[0][1], amplitude, 1e-6);
            close(cycle.response.omega, omega, 1e-7);
            assert!((cycle.multipliers[0].norm() - multiplier).abs() < 6e-5);
            assert_eq!(unstable(cycle), usize::from(slips));
            // What negative damping feeds friction dissipates.
            close(cycle.response.contacts[0].dissipation, -cycle.viscous, 1e-9);
        }
    }
}

#[test]
fn the_single_mass_turns_where_it_should() {
    let system = single_dof();
    let cycles = follow(&system, &exact(0, None));
    let limit = cycles.limit.unwrap();
    close(limit.value, 5.147991, 2e-7);
    close(limit.omega, 190.1742, 1e-6);
    assert_eq!(cycles.ends, [End::Range, End::Range]);
    assert_eq!(cycles.changes.len(), 1);
    assert_eq!(cycles.changes[0].kind, ChangeKind::Fold);
    close(cycles.changes[0].value, limit.value, 1e-6);
}

#[test]
fn harmonic_balance_of_the_single_mass_converges_to_the_exact_cycles() {
    let system = single_dof();
    for (harmonics, expected, tolerance) in
        [(1, 5.142453, 2e-7), (31, 5.147991, 1e-6), (7, 5.147991, 1e-3)]
    {
        let settings = CycleSettings {
            harmonics: HarmonicChoice::Fixed(harmonics),
            values: Some(vec![1.0]),
            ..CycleSettings::default()
        };
        let cycles = follow(&system, &settings);
        close(cycles.limit.unwrap().value, expected, tolerance);
        if harmonics == 31 {
            close(cycles.cycles[0].response.omega, 224.01322, 1e-6);
            close(cycles.cycles[1].response.omega, 160.51921, 1e-6);
            assert!(cycles.cycles.iter().all(|c| c.closed));
            assert!((cycles.cycles[1].multipliers[0].norm() - 1.1655).abs() < 6e-5);
        }
    }
}

#[test]
fn automatic_harmonics_meet_the_tolerance() {
    let system = single_dof();
    let settings = CycleSettings {
        harmonics: HarmonicChoice::Auto,
        tolerance: 1e-4,
        stability: false,
        values: Some(vec![1.0, 5.0]),
        ..CycleSettings::default()
    };
    let cycles = follow(&system, &settings);
    let reference = follow(&system, &exact(0, Some(vec![1.0, 5.0])));
    for (cycle, orbit) in cycles.cycles.iter().zip(&reference.cycles) {
        let (ours, theirs) = (cycle.response.displacement[1], orbit.response.displacement[1]);
        assert!((ours.norm() / theirs.norm() - 1.0).abs() < 1e-4);
    }
}

#[test]
fn the_stiffness_of_the_single_mass_can_be_followed() {
    let (model, negative) = single_dof();
    let negative = NegativeDamping::Whole(negative);
    let stiffness = Variation::Law {
        parameter: "stiffness".to_owned(),
        contacts: vec![(0, None)],
        common: ParameterMode::Factor,
    };
    let settings =
        CycleSettings { values: Some(vec![10.0, 1000.0]), range: (0.01, 1001.0), ..exact(0, None) };
    let cycles = limit_cycles(&model, &negative, &stiffness, 1.0, &settings, &|_| true).unwrap();
    close(cycles.limit.unwrap().value, 0.167108, 1e-6);
    let found: Vec<(bool, f64)> =
        cycles.cycles.iter().map(|c| (c.slipping, c.range[0][1])).collect();
    let expected =
        [(false, 1.02651e-8), (false, 1.03923e-6), (true, 2.54219e-4), (true, 2.55319e-4)];
    assert_eq!(found.len(), 4);
    for ((slips, amplitude), (side, value)) in found.iter().zip(expected) {
        assert_eq!(*slips, side);
        close(*amplitude, value, 1e-5);
    }
}

#[test]
fn the_slip_force_scales_the_motion_alone() {
    let (model, negative) = single_dof();
    let negative = NegativeDamping::Whole(negative);
    let force = Variation::Law {
        parameter: "slip_force".to_owned(),
        contacts: vec![(0, None)],
        common: ParameterMode::Value,
    };
    let settings = CycleSettings {
        values: Some(vec![100.0, 492.096]),
        range: (50.0, 500.0),
        stability: false,
        ..exact(0, None)
    };
    let cycles = limit_cycles(&model, &negative, &force, 1.0, &settings, &|_| true).unwrap();
    // No turn: the sticking side alone, with amplitudes in proportion.
    assert!(cycles.limit.is_none());
    for cycle in &cycles.cycles {
        close(cycle.range[0][1], 1.0909294e-5 * cycle.value / 246.048, 1e-6);
        close(cycle.response.omega, 224.01322, 1e-7);
    }
}

#[test]
fn the_beam_has_three_branches() {
    let system = beam();
    for (mode, limit, omega) in [(0, 5.1690, 185.80), (1, 14.4687, 1141.5), (2, 6.3604, 2676.4)] {
        let settings = CycleSettings { stability: false, ..exact(mode, None) };
        let cycles = follow(&system, &settings);
        let turn = cycles.limit.unwrap();
        close(turn.value, limit, 1e-5);
        close(turn.omega, omega, 1e-4);
        assert_eq!(cycles.ends, [End::Range, End::Range]);
        let stuck = [225.6623, 1404.3759, 3273.7922][mode];
        let free = [159.5927, 901.7589, 2167.5410][mode];
        close(cycles.cycles[0].response.omega, stuck, 2e-5);
        close(cycles.cycles.last().unwrap().response.omega, free, 2e-5);
        if mode == 0 {
            let near = |value: f64| cycles.folds.iter().any(|t| (t.value - value).abs() < 1e-3);
            assert!(near(4.878) && near(4.7746), "{:?}", cycles.folds);
        }
    }
}

#[test]
fn the_sticking_branches_of_the_beam_have_the_exact_cycles() {
    let system = beam();
    let rows = [
        (224.358, [1.42461e-5, 6.98269e-4, 5.954e-5], 1.525),
        (1393.49, [1.22105e-5, 6.42163e-5, 2.65122e-4], 0.957),
        (3257.26, [1.07091e-5, 5.43271e-6, 7.71674e-5], 0.953),
    ];
    for (mode, (omega, amplitudes, multiplier)) in rows.into_iter().enumerate() {
        let cycles = follow(&system, &exact(mode, Some(vec![1.0])));
        let cycle = cycles.cycles.iter().find(|c| !c.slipping).unwrap();
        close(cycle.response.omega, omega, 2e-5);
        for (range, amplitude) in cycle.range.iter().zip(amplitudes) {
            close(range[1], amplitude, 5e-4);
        }
        assert!((cycle.multipliers[0].norm() - multiplier).abs() < 6e-4, "{mode}");
    }
}

#[test]
fn the_third_mode_of_the_beam_loses_its_stability_to_a_complex_pair() {
    let cycles = follow(&beam(), &exact(2, None));
    let first = cycles.changes[0];
    assert_eq!((first.kind, first.unstable), (ChangeKind::ComplexPair, (0, 2)));
    close(first.value, 4.686, 2e-4);
    let slipping = cycles.cycles.iter().filter(|c| c.slipping);
    assert!(slipping.clone().count() > 10);
    assert!(slipping.into_iter().all(|c| unstable(c) > 0));
}

#[test]
fn harmonic_balance_passes_all_folds_of_the_first_mode() {
    let settings = CycleSettings { stability: false, ..CycleSettings::default() };
    let cycles = follow(&beam(), &settings);
    close(cycles.limit.unwrap().value, 5.1690, 1e-3);
    assert_eq!(cycles.ends, [End::Range, End::Range]);
}

/// At a given ratio the flow passes along the orbit once per step of Newton's method, and once at its start.
#[test]
fn multipliers_take_no_passes_of_their_own() {
    let system = beam();
    let settings = CycleSettings {
        values: Some(vec![1.0]),
        harmonics: HarmonicChoice::Fixed(31),
        ..CycleSettings::default()
    };
    let found = follow(&system, &settings);
    let negative = NegativeDamping::Whole(system.1.clone());
    let family = FlutterModel::new(&system.0, negative, Variation::Ratio, 1.0).unwrap();
    let orbits = CycleOrbits::new(&family).unwrap().unwrap();
    let cycle = found.cycles.iter().find(|cycle| cycle.closed && !cycle.slipping).unwrap();
    let scale = found.stuck_omega;
    let start = orbits.unknowns(&cycle.response, cycle.value, scale, 1).unwrap();
    let mut curve = OrbitCurve::new(&orbits, scale, &start, &|| false);
    let (z, steps) = at_parameter(&mut curve, &start, cycle.value, 12).unwrap();
    let (multipliers, _) = curve.multipliers(&z).unwrap();
    assert_eq!([curve.flows, curve.matrices], [steps + 1; 2]);
    // They are those of the whole analysis, over half a period.
    close(multipliers[0].norm_sqr(), cycle.multipliers[0].norm(), 1e-9);
}

#[test]
fn modes_that_are_not_excited_are_refused() {
    let (model, negative) = beam();
    let positive = NegativeDamping::Whole(faer::Scale(-1.0) * &negative);
    let settings = CycleSettings::default();
    let run = |negative: &NegativeDamping, settings: &CycleSettings| {
        limit_cycles(&model, negative, &Variation::Ratio, 1.0, settings, &|_| true).unwrap_err()
    };
    let error = run(&positive, &settings);
    assert!(error.to_string().contains("mind the sign"), "{error}");
    let whole = NegativeDamping::Whole(negative);
    let error = run(&whole, &CycleSettings { mode: 3, ..settings.clone() });
    assert!(error.to_string().starts_with("mode = 3: the structure has modes 0 to 2"), "{error}");
    let error = run(&NegativeDamping::Whole(Mat::zeros(2, 2)), &settings);
    assert!(matches!(error, Error::Shape { .. }));
}

#[test]
fn a_caller_can_end_the_analysis() {
    let (model, negative) = beam();
    let negative = NegativeDamping::Whole(negative);
    let calls = std::cell::Cell::new(0);
    let progress = |_: f64| {
        calls.set(calls.get() + 1);
        calls.get() < 300
    };
    let cycles =
        limit_cycles(&model, &negative, &Variation::Ratio, 1.0, &exact(0, None), &progress)
            .unwrap();
    assert!(cycles.interrupted);
}
