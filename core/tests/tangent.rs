//! Tangents against central differences in every contact state.

mod common;

use common::coupled::{SLIP_FORCE, STIFFNESS};
use common::tangents::{series, table_of, tangent_error, OFTEN, ONCE, STATES};
use proptest::prelude::*;
use stickslip_core::contact::{ContactLaw, HarmonicForce, Jenkins, Motion, PointSummary, Residual};
use stickslip_core::fourier::{Harmonics, SampleTable};

/// Slip phases per period, counted on a fine force history.
fn slip_phases(law: &dyn ContactLaw, table: &SampleTable, u: &[f64]) -> usize {
    let history =
        law.force_history(Motion { table, displacement: u, residual: Residual::Centred }, 20_000);
    let slips = |f: f64| f.abs() >= SLIP_FORCE;
    (0..history.len())
        .filter(|&i| slips(history[i]) && !slips(history[(i + history.len() - 1) % history.len()]))
        .count()
}

#[test]
fn every_state_of_a_jenkins_element() {
    let law = Jenkins::new(STIFFNESS, SLIP_FORCE).unwrap();
    for (name, harmonics, terms, residual) in STATES {
        let table = table_of(harmonics);
        let error = tangent_error(&law, &table, &series(&table, terms), residual);
        assert!(error < 1e-6, "{name}: {error:.2e}");
    }
    let odd = table_of((7, true));
    assert_eq!(slip_phases(&law, &odd, &series(&odd, ONCE)), 2);
    assert!(slip_phases(&law, &odd, &series(&odd, OFTEN)) >= 4);
}

#[test]
fn degenerate_elements() {
    let table = SampleTable::new(Harmonics::new(3, true));
    let u = series(&table, &[(1, 0.9, 0.2), (3, 0.1, 0.0)]);
    for (stiffness, slip_force) in [(STIFFNESS, 0.0), (0.0, SLIP_FORCE), (STIFFNESS, f64::INFINITY)]
    {
        let law = Jenkins::new(stiffness, slip_force).unwrap();
        assert!(tangent_error(&law, &table, &u, Residual::Centred) < 1e-9);
    }
    let frictionless = Jenkins::new(STIFFNESS, 0.0).unwrap();
    let motion = Motion { table: &table, displacement: &u, residual: Residual::Centred };
    assert!(frictionless.force_history(motion, 32).iter().all(|f| *f == 0.0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Random series: the tangent holds away from the isolated kinks where a slip window is born,
    /// the work is never negative, and the force never passes its limit.
    #[test]
    fn random_series(
        coefficients in prop::collection::vec(-1.0_f64..1.0, 15),
        scale in 0.2_f64..5.0,
        half_wave in any::<bool>(),
    ) {
        let law = Jenkins::new(STIFFNESS, SLIP_FORCE).unwrap();
        let table = SampleTable::new(Harmonics::new(7, half_wave));
        let u: Vec<f64> = coefficients
            .iter()
            .take(table.harmonics().slots())
            .enumerate()
            .map(|(i, c)| scale * c / (1.0 + i as f64 / 4.0))
            .collect();
        let motion = Motion { table: &table, displacement: &u, residual: Residual::Centred };
        let mut summary = [PointSummary::default()];
        law.summary(motion, &mut summary);
        prop_assert!(summary[0].dissipation >= 0.0);
        prop_assert!((0.0..=1.0).contains(&summary[0].slip_fraction));
        let history = law.force_history(motion, 500);
        prop_assert!(history.iter().all(|f| f.abs() <= SLIP_FORCE * (1.0 + 1e-12)));
        let phases = |u: &[f64]| slip_phases(&law, &table, u);
        let nudged: Vec<f64> = u.iter().map(|x| x * (1.0 + 1e-3)).collect();
        prop_assume!(phases(&u) == phases(&nudged));
        let error = tangent_error(&law, &table, &u, Residual::Centred);
        // A window opening within the difference step would show as an error of order one.
        prop_assert!(error < 1e-4, "{}", error);
    }
}
