//! Laws without sliders, motions and their loads.

use super::damper::Random;
use stickslip_core::contact::{Backbone, Masing, Residual};
use stickslip_core::fourier::SampleTable;

pub const RESIDUALS: [Residual; 3] = [Residual::Centred, Residual::FromRest, Residual::Value(0.07)];

pub fn laws() -> Vec<Masing> {
    let table = Backbone::table(&[0.1, 0.3, 0.7, 2.0], &[1.0, 2.5, 4.0, 4.4]).unwrap().0;
    vec![
        Masing::new(2.0, 0.7, Backbone::Exponential).unwrap(),
        Masing::new(2.0, 0.7, Backbone::shear_layer(0.3).unwrap()).unwrap(),
        Masing::new(2.0, 0.7, Backbone::shear_layer(20.0).unwrap()).unwrap(),
        Masing::iwan(0.25, 0.2, -0.5, 0.0).unwrap(),
        Masing::iwan(1.0, 0.4, -0.93, 0.2).unwrap(),
        Masing::iwan(1.0, 0.4, -0.2, 3.0).unwrap(),
        Masing::iwan(1.0, 0.4, 0.0, 0.0).unwrap(),
        Masing::new(2.0, 0.7, table).unwrap(),
    ]
}

pub fn series(random: &mut Random, table: &SampleTable, size: f64) -> Vec<f64> {
    let slots = table.harmonics().slots();
    (0..slots).map(|slot| size * random.next() / (1.0 + 0.3 * slot as f64)).collect()
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

pub fn close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let size = largest(expected).max(1e-300);
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() <= tolerance * size,
            "{what}: {found} {expected} of {size}"
        );
    }
}
