//! Tangents against central differences in every contact state.

use proptest::prelude::*;
use stickslip_core::contact::{
    ContactLaw, HarmonicForce, Jenkins, Motion, PointSummary, Residual, SlipLoad,
};
use stickslip_core::fourier::{Harmonics, SampleTable};

const STIFFNESS: f64 = 2.0;
const SLIP_FORCE: f64 = 1.0;

/// Largest difference between tangent and central differences, relative to the stiffness.
fn tangent_error(law: &dyn ContactLaw, table: &SampleTable, u: &[f64], residual: Residual) -> f64 {
    let evaluate = |u: &[f64], tangent: bool| {
        let mut load = SlipLoad::default();
        law.slip_load(Motion { table, displacement: u, residual }, tangent, &mut load);
        load
    };
    let exact = evaluate(u, true);
    let size = u.len();
    let step = 1e-6;
    let mut worst = 0.0_f64;
    for column in 0..size {
        let mut shifted = u.to_vec();
        shifted[column] += step;
        let ahead = evaluate(&shifted, false);
        shifted[column] -= 2.0 * step;
        let behind = evaluate(&shifted, false);
        for row in 0..size {
            let difference = (ahead.value[row] - behind.value[row]) / (2.0 * step);
            worst = worst.max((exact.tangent[row * size + column] - difference).abs());
        }
    }
    worst / STIFFNESS
}

/// One harmonic of a series: order, cosine and sine coefficient.
type Term = (usize, f64, f64);

fn series(table: &SampleTable, terms: &[Term]) -> Vec<f64> {
    let harmonics = table.harmonics();
    let mut u = vec![0.0; harmonics.slots()];
    for &(order, a, b) in terms {
        if let Some(slot) = harmonics.slot(order) {
            u[slot] = a;
            if order > 0 {
                u[slot + 1] = b;
            }
        }
    }
    u
}

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
    let odd = SampleTable::new(Harmonics::new(7, true));
    let all = SampleTable::new(Harmonics::new(6, false));
    let once = [(1, 0.9, 0.2), (3, 0.05, -0.04)];
    let often = [(1, 0.8, 0.1), (3, 0.9, 0.5), (5, -0.3, 0.6), (7, 0.2, 0.1)];
    let uneven = [(0, 0.7, 0.0), (1, 1.1, 0.2), (2, 0.8, -0.5), (4, 0.1, 0.3)];
    let stuck = [(0, 0.2, 0.0), (1, 0.3, 0.05), (2, 0.06, 0.04)];
    let cases: [(&str, &SampleTable, &[Term], Residual); 10] = [
        ("slip twice", &odd, &once, Residual::Centred),
        ("slip in several windows", &odd, &often, Residual::Centred),
        ("gross slip", &odd, &[(1, 300.0, 40.0), (3, 2.0, 1.0)], Residual::Centred),
        ("slip without symmetry", &all, &uneven, Residual::Centred),
        ("slip twice, all harmonics", &all, &once, Residual::FromRest),
        ("stuck, odd", &odd, &[(1, 0.3, 0.1)], Residual::Centred),
        ("stuck, centred", &all, &stuck, Residual::Centred),
        ("stuck, from rest", &all, &stuck, Residual::FromRest),
        (
            "stuck, from rest, past its limit",
            &all,
            &[(0, 0.9, 0.0), (1, 0.3, 0.05), (2, 0.06, 0.04)],
            Residual::FromRest,
        ),
        ("stuck, given residual past its limit", &all, &stuck, Residual::Value(-0.8)),
    ];
    for (name, table, terms, residual) in cases {
        let error = tangent_error(&law, table, &series(table, terms), residual);
        assert!(error < 1e-6, "{name}: {error:.2e}");
    }
    assert_eq!(slip_phases(&law, &odd, &series(&odd, &once)), 2);
    assert!(slip_phases(&law, &odd, &series(&odd, &often)) >= 4);
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
