//! What becomes of free motions: bounds against long exact runs, and random damped systems.

#![allow(clippy::unwrap_used)]

mod common;

use common::passive::passive_system;
use common::{single_dof, snecma_beam, System};
use proptest::prelude::*;
use stickslip_core::motion::{
    fates, transient, Classification, ClassificationSettings, Classifier, Reason, Scheme,
    TransientSettings,
};

const SETTINGS: ClassificationSettings = ClassificationSettings { periods: 2000, tolerance: 1e-6 };

/// A system without forces, its damping multiplied.
fn free(mut system: System, factor: f64) -> System {
    system.forces.clear();
    system.damping = faer::Scale(factor) * &system.damping;
    system
}

fn fate(system: &System, start: &[f64]) -> Classification {
    Classifier::new(&system.model(), SETTINGS).unwrap().of(start, &|| true).unwrap()
}

#[test]
fn growth_is_claimed_beyond_the_separatrix_alone() {
    // computed independently: slipping limit cycle at r = 3
    let system = free(single_dof(1.0), -3.0 * 7699.054 / 7700.0);
    let amplitude = 7.0556856e-5;
    for share in [0.3, 0.7, 0.95, 0.999] {
        let fate = fate(&system, &[share * amplitude, 0.0, common::SLIP_FORCE]);
        assert_eq!(fate.reason, Reason::Closed, "{share}");
        assert!((fate.amplitude[0] / 1.2959006e-5 - 1.0).abs() < 1e-6);
    }
    for share in [1.001, 1.05, 1.5, 1e3] {
        let fate = fate(&system, &[share * amplitude, 0.0, common::SLIP_FORCE]);
        assert_eq!(fate.reason, Reason::Unbounded, "{share}");
    }
}

#[test]
fn a_damped_motion_below_the_onset_of_slip_never_slips_again() {
    let system = free(snecma_beam(0.0), 1.0);
    let fate = fate(&system, &[1e-4, 2e-3, 1e-4, 0.0, 0.0, 0.0, 100.0]);
    assert_eq!(fate.reason, Reason::Stuck);
    assert!(fate.events > 0);
    let settings = TransientSettings {
        omega: 225.0,
        scheme: Scheme::Exact,
        periods: 200,
        tolerance: None,
        samples: 2,
        keep: None,
    };
    let after = transient(&system.model(), &settings, Some(&fate.state), &[0], &|_| true).unwrap();
    assert!(after.events.is_empty());
}

#[test]
fn a_longer_period_is_not_mistaken_for_a_spiral() {
    // At r = 0.1 mode 2 is reached on a spiral that nearly closes every five turns.
    let system = free(snecma_beam(0.0), -0.1);
    let fate = fate(&system, &[1e-5, 1e-5, 3e-4, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!((fate.reason, fate.mode), (Reason::Closed, Some(1)));
    assert!((fate.omega - 1403.96).abs() < 0.1, "{}", fate.omega);
}

#[test]
fn what_does_not_fit_is_refused_and_an_interruption_is_heard() {
    assert!(Classifier::new(&single_dof(1.0).model(), SETTINGS).is_err());
    let system = free(snecma_beam(0.0), -0.2);
    let model = system.model();
    let none = ClassificationSettings { periods: 0, ..SETTINGS };
    assert!(Classifier::new(&model, none).is_err());
    let loose = ClassificationSettings { tolerance: 1.0, ..SETTINGS };
    assert!(Classifier::new(&model, loose).is_err());
    let starts = vec![vec![1e-5, 1e-5, 3e-4, 0.0, 0.0, 0.0, 0.0]; 4];
    assert!(fates(&model, SETTINGS, &[vec![0.0; 3]], 0, &|_| true).is_err());
    let stopped = fates(&model, SETTINGS, &starts, 2, &|_| false).unwrap();
    let undone = |fate: &Option<Classification>| {
        fate.as_ref().is_none_or(|fate| fate.reason == Reason::Interrupted)
    };
    assert!(stopped.iter().all(undone));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn damped_systems_come_to_rest(system in passive_system(), size in 1e-3_f64..10.0) {
        let system = free(system, 1.0);
        let n = system.dofs();
        let mut start = vec![0.0; 2 * n + system.dampers.len()];
        start[0] = size;
        let fate = fate(&system, &start);
        prop_assert!(matches!(fate.reason, Reason::Stuck | Reason::Passive), "{:?}", fate.reason);
    }

    #[test]
    fn damping_that_is_negative_for_every_motion_never_decays(
        system in passive_system(),
        size in 1e-3_f64..10.0,
    ) {
        let system = free(system, -1.0);
        let n = system.dofs();
        let mut start = vec![0.0; 2 * n + system.dampers.len()];
        start[0] = size;
        let fate = fate(&system, &start);
        prop_assert!(!matches!(fate.reason, Reason::Stuck | Reason::Passive), "{:?}", fate.reason);
        prop_assert!(fate.reason != Reason::Contradiction);
    }
}
