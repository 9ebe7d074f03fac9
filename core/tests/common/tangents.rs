//! Tangents of contact laws against central differences, and motions in every state of a contact with a
//! unit displacement at its limit.

use super::coupled::STIFFNESS;
use stickslip_core::contact::{ContactLaw, Motion, Residual, SlipLoad};
use stickslip_core::fourier::{Harmonics, SampleTable};

/// One harmonic of a series: order, cosine and sine coefficient.
pub type Term = (usize, f64, f64);

/// A motion with its name: the highest harmonic, whether the second half is the mirror image of the first
/// one, the series, and what stuck contacts hold.
pub type NamedMotion = (&'static str, (usize, bool), &'static [Term], Residual);

/// One of every state of a contact.
pub const STATES: [NamedMotion; 10] = [
    ("slip twice", ODD, ONCE, Residual::Centred),
    ("slip in several windows", ODD, OFTEN, Residual::Centred),
    ("gross slip", ODD, &[(1, 300.0, 40.0), (3, 2.0, 1.0)], Residual::Centred),
    ("slip without symmetry", ALL, UNEVEN, Residual::Centred),
    ("slip twice, all harmonics", ALL, ONCE, Residual::FromRest),
    ("stuck, odd", ODD, &[(1, 0.3, 0.1)], Residual::Centred),
    ("stuck, centred", ALL, STUCK, Residual::Centred),
    ("stuck, from rest", ALL, STUCK, Residual::FromRest),
    ("stuck, from rest, past its limit", ALL, PAST, Residual::FromRest),
    ("stuck, given residual past its limit", ALL, STUCK, Residual::Value(-0.8)),
];
const ODD: (usize, bool) = (7, true);
const ALL: (usize, bool) = (6, false);
/// It slips twice per period; …
pub const ONCE: &[Term] = &[(1, 0.9, 0.2), (3, 0.05, -0.04)];
/// … four times.
pub const OFTEN: &[Term] = &[(1, 0.8, 0.1), (3, 0.9, 0.5), (5, -0.3, 0.6), (7, 0.2, 0.1)];
const UNEVEN: &[Term] = &[(0, 0.7, 0.0), (1, 1.1, 0.2), (2, 0.8, -0.5), (4, 0.1, 0.3)];
const STUCK: &[Term] = &[(0, 0.2, 0.0), (1, 0.3, 0.05), (2, 0.06, 0.04)];
const PAST: &[Term] = &[(0, 0.9, 0.0), (1, 0.3, 0.05), (2, 0.06, 0.04)];

/// The table of a motion of [`STATES`].
pub fn table_of((highest, half_wave): (usize, bool)) -> SampleTable {
    SampleTable::new(Harmonics::new(highest, half_wave))
}

/// Coefficients of a series.
pub fn series(table: &SampleTable, terms: &[Term]) -> Vec<f64> {
    let mut u = vec![0.0; table.harmonics().slots()];
    for &(order, a, b) in terms {
        if let Some(slot) = table.harmonics().slot(order) {
            u[slot] = a;
            if order > 0 {
                u[slot + 1] = b;
            }
        }
    }
    u
}

/// A motion whose stuck contacts hold nothing on average.
pub fn motion<'a>(table: &'a SampleTable, displacement: &'a [f64]) -> Motion<'a> {
    Motion { table, displacement, residual: Residual::Centred }
}

/// Largest absolute value.
pub fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Largest difference.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

/// What a law answers a motion with, and the tangent.
pub fn load(law: &dyn ContactLaw, table: &SampleTable, u: &[f64], residual: Residual) -> SlipLoad {
    let mut load = SlipLoad::default();
    law.slip_load(Motion { table, displacement: u, residual }, true, &mut load);
    load
}

/// Largest difference between tangent and central differences, relative to the stiffness.
pub fn tangent_error(
    law: &dyn ContactLaw,
    table: &SampleTable,
    u: &[f64],
    residual: Residual,
) -> f64 {
    let exact = load(law, table, u, residual);
    let (size, step) = (u.len(), 1e-6);
    let mut worst = 0.0_f64;
    for column in 0..size {
        let mut shifted = u.to_vec();
        shifted[column] += step;
        let ahead = load(law, table, &shifted, residual).value;
        shifted[column] -= 2.0 * step;
        let behind = load(law, table, &shifted, residual).value;
        for row in 0..size {
            let difference = (ahead[row] - behind[row]) / (2.0 * step);
            worst = worst.max((exact.tangent[row * size + column] - difference).abs());
        }
    }
    worst / STIFFNESS
}
