//! Automatic harmonics keep the tolerance against exact orbits.

#![allow(clippy::unwrap_used)]

mod common;

use common::snecma_beam;
use stickslip_core::balance::{sweep, ForcedBalance, PointStatus, Settings};
use stickslip_core::fourier::{amplitude, Harmonics, Measure, SampleTable};
use stickslip_core::orbit::{orbit_sweep, OrbitSettings, PeriodicOrbits};

/// Largest error of the amplitudes of the observed DOFs, each relative to the amplitude itself.
fn worst_error(force: f64, observe: &[usize], tolerance: f64) -> f64 {
    let model = snecma_beam(force).model();
    let omega: Vec<f64> = (0..400).map(|i| 20.0 + 330.0 * f64::from(i) / 399.0).collect();
    let settings = Settings { tolerance, ..Settings::default() };
    let balance = ForcedBalance::new(&model, settings, observe).unwrap();
    let solution = sweep(balance, &omega).unwrap();
    let settings = OrbitSettings { harmonics: 1, ..OrbitSettings::default() };
    let orbits =
        orbit_sweep(PeriodicOrbits::new(&model, settings, observe).unwrap(), &omega).unwrap();
    let mut worst = 0.0_f64;
    for (point, orbit) in solution.points.iter().zip(&orbits.points) {
        assert_eq!(point.status, PointStatus::Converged);
        assert_eq!(orbit.response.status, PointStatus::Converged);
        let table = SampleTable::new(Harmonics::new(point.harmonics, solution.half_wave));
        let mut series = vec![0.0; table.harmonics().slots()];
        let amplitudes = point.displacement.chunks_exact(point.harmonics + 1);
        for (amplitudes, range) in amplitudes.zip(&orbit.range) {
            table.harmonics().write_series(amplitudes, &mut series);
            let exact = 0.5 * (range[1] - range[0]);
            let error = amplitude(&table, &series, Measure::HalfRange) / exact - 1.0;
            worst = worst.max(error.abs());
        }
    }
    worst
}

#[test]
fn at_every_frequency_of_all_eight_loads() {
    for force in [0.938, 2.188, 6.563, 16.563, 20.313, 25.0, 31.475, 38.438] {
        let error = worst_error(force, &[0, 1, 2], 1e-3);
        assert!(error < 1e-3, "{force} N: {error:e}");
    }
}

#[test]
fn with_other_tolerances_and_observed_dofs() {
    for (observe, tolerance) in
        [(&[1][..], 1e-3), (&[0], 1e-3), (&[0, 1, 2], 1e-2), (&[0, 1, 2], 1e-4)]
    {
        for force in [6.563, 31.475] {
            let error = worst_error(force, observe, tolerance);
            assert!(error < tolerance, "{force} N, {observe:?}, {tolerance:e}: {error:e}");
        }
    }
}
