//! Random chains of masses.

use faer::Mat;
use proptest::prelude::*;
use std::f64::consts::PI;
use std::ops::Range;

/// Masses, springs, contacts of a kind, loads `(DOF, harmonic, amplitude, phase)`, damping over mass.
pub type Parts<P> = (Vec<f64>, Vec<f64>, Vec<P>, Vec<(usize, usize, f64, f64)>, f64);

/// Chains with so many contacts, `pad` for a number of masses, and a load at harmonic 1 among others.
pub fn chains<S: Strategy>(
    pads: Range<usize>,
    pad: impl Fn(usize) -> S,
) -> impl Strategy<Value = Parts<S::Value>> {
    (2_usize..7, pads)
        .prop_flat_map(move |(dofs, pads)| {
            let load = (0..dofs, 0_usize..3, 0.2_f64..3.0, -PI..PI);
            (
                prop::collection::vec(0.5_f64..3.0, dofs),
                prop::collection::vec(50.0_f64..500.0, dofs),
                prop::collection::vec(pad(dofs), pads),
                prop::collection::vec(load, 1..4),
                0.1_f64..0.6,
            )
        })
        .prop_map(|(masses, springs, pads, mut loads, damping)| {
            loads[0].1 = 1;
            (masses, springs, pads, loads, damping)
        })
}

/// Stiffness of springs before every mass, the first one to the ground.
pub fn stiffness(springs: &[f64]) -> Mat<f64> {
    Mat::from_fn(springs.len(), springs.len(), |i, j| match i.abs_diff(j) {
        0 => springs[i] + springs.get(i + 1).copied().unwrap_or(0.0),
        1 => -springs[i.max(j)],
        _ => 0.0,
    })
}
