//! Friction contacts whose normal load varies, in the balance: against independent computations.

#![allow(clippy::unwrap_used)]

use faer::{c64, Mat};
use stickslip_core::balance::{sweep, ForcedBalance, HarmonicChoice, Settings};
use stickslip_core::contact::{Closure, Coulomb, Residual};
use stickslip_core::model::{Contact, Model};
use stickslip_core::structure::{HarmonicLoad, Structure};

fn diagonal(values: &[f64]) -> Mat<f64> {
    Mat::from_fn(values.len(), values.len(), |i, j| if i == j { values[i] } else { 0.0 })
}

fn loads(parts: &[(usize, &[c64])]) -> Vec<HarmonicLoad> {
    parts
        .iter()
        .map(|(harmonic, p)| HarmonicLoad { harmonic: *harmonic, amplitude: p.to_vec() })
        .collect()
}

/// Largest, least and mean value of a DOF over the period.
fn range(coefficients: &[c64]) -> [f64; 3] {
    let values: Vec<f64> = (0..4096)
        .map(|n| {
            let theta = std::f64::consts::TAU * n as f64 / 4096.0;
            let terms = coefficients.iter().enumerate();
            terms.map(|(k, x)| (x * c64::from_polar(1.0, k as f64 * theta)).re).sum()
        })
        .collect();
    let fold = |f: fn(f64, f64) -> f64, start| values.iter().copied().fold(start, f);
    [fold(f64::max, f64::MIN), fold(f64::min, f64::MAX), coefficients[0].re]
}

/// One mass on a plane, pressed and sheared in three directions.
#[test]
fn a_mass_on_a_plane() {
    let structure = Structure::new(
        diagonal(&[1.0, 1.0, 1.0]).as_ref(),
        diagonal(&[8.0, 10.0, 16.0]).as_ref(),
        diagonal(&[4e4, 9e4, 1.6e5]).as_ref(),
    )
    .unwrap();
    let law = Coulomb::new(2, 0.4, 5e4, Some(8e4), Closure::Preload(40.0)).unwrap();
    let contact = Contact { law: Box::new(law), rows: Mat::identity(3, 3) };
    let force = [c64::new(30.0, 0.0), c64::new(0.0, -25.0), c64::from_polar(20.0, -0.7)];
    let model = Model::new(structure, vec![contact], loads(&[(1, &force)])).unwrap();
    let settings = Settings {
        harmonics: HarmonicChoice::Fixed(31),
        residual: Residual::Centred,
        tolerance: 1e-4,
        ..Settings::default()
    };
    let balance = ForcedBalance::new(&model, settings, &[0, 1, 2]).unwrap();
    let solution = sweep(balance, &[180.0, 260.0, 340.0]).unwrap();
    let expected = [
        [1.79793e-3, 3.20807e-4, 9.63298e-5],
        [1.39417e-3, 8.77593e-4, 1.159_755e-4],
        [4.46050e-4, 1.13998e-3, 1.606_182e-4],
    ];
    for (point, expected) in solution.points.iter().zip(expected) {
        assert!(point.is_solved(), "{point:?}");
        let orders = point.harmonics + 1;
        for (dof, expected) in expected.into_iter().enumerate() {
            let [high, low, _] = range(&point.displacement[dof * orders..][..orders]);
            let largest = high.max(-low);
            assert!(
                (largest / expected - 1.0).abs() < 1e-4,
                "{} {dof}: {largest} {expected} {:?} it {}",
                point.omega,
                point.samples,
                point.iterations
            );
        }
    }
}

/// A planar contact that separates under a static load.
#[test]
fn separation() {
    let cases = [
        (40.0, 60.0, 5.0, 4.16212, [5.665_875, -0.89573, 2.304_388]),
        (40.0, 120.0, 3.0, 6.79384, [6.443_992, -1.81509, 2.197_012]),
        (80.0, 120.0, 8.0, 2.27893, [6.228_533, -1.73474, 2.199_940]),
    ];
    for (tangential, normal, omega, largest, [high, low, mean]) in cases {
        let structure = Structure::new(
            diagonal(&[1.0, 1.0]).as_ref(),
            diagonal(&[0.346_410_162, 2.0]).as_ref(),
            diagonal(&[12.0, 21.0]).as_ref(),
        )
        .unwrap();
        let law = Coulomb::new(1, 0.85, 5.0, Some(21.0), Closure::Gap(0.0)).unwrap();
        let contact = Contact { law: Box::new(law), rows: Mat::identity(2, 2) };
        let real = |x: f64| c64::new(x, 0.0);
        let (still, moving) = ([real(0.0), real(100.0)], [real(tangential), real(normal)]);
        let model =
            Model::new(structure, vec![contact], loads(&[(0, &still), (1, &moving)])).unwrap();
        let settings = Settings {
            harmonics: HarmonicChoice::Fixed(63),
            residual: Residual::FromRest,
            tolerance: 1e-5,
            ..Settings::default()
        };
        let balance = ForcedBalance::new(&model, settings, &[0, 1]).unwrap();
        let solution = sweep(balance, &[omega]).unwrap();
        let point = &solution.points[0];
        assert!(point.is_solved(), "{:?} {}", point.status, point.residual);
        let orders = point.harmonics + 1;
        let normal = range(&point.displacement[orders..]);
        for (found, expected) in normal.into_iter().zip([high, low, mean]) {
            assert!((found - expected).abs() < 1e-5 * high, "{omega}: {normal:?}");
        }
        let [above, below, _] = range(&point.displacement[..orders]);
        assert!((above.max(-below) / largest - 1.0).abs() < 3e-4, "{omega}: {above} {below}");
    }
}
