//! Forced curves of the reference systems, and amplitudes of their points.

use super::System;
use stickslip_core::balance::{sweep, ForcedBalance, HarmonicChoice, Point, Settings, Solution};
use stickslip_core::design::{summits, PeakQuery};
use stickslip_core::fourier::{amplitude, Harmonics, Measure, SampleTable};
use stickslip_core::Model;

/// Settings with so many harmonics.
pub fn fixed(highest: usize) -> Settings {
    Settings { harmonics: HarmonicChoice::Fixed(highest), ..Settings::default() }
}

/// Frequencies in equal steps.
pub fn grid(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

/// The curve of all degrees of freedom of a system.
pub fn solve(system: &System, settings: Settings, omega: &[f64]) -> Solution {
    let model = system.model();
    let observe: Vec<usize> = (0..system.dofs()).collect();
    let balance = ForcedBalance::new(&model, settings, &observe).unwrap();
    sweep(balance, omega).unwrap()
}

/// Frequency and amplitude of the highest point of a range.
pub fn peak_of(
    model: &Model,
    settings: Settings,
    dof: usize,
    measure: Measure,
    span: (f64, f64),
) -> (f64, f64) {
    let quest = PeakQuery { groups: vec![vec![dof]], measure, span };
    let found = summits(model, settings, &quest, None, &|_| true).unwrap();
    (found.summits[0].omega, found.summits[0].amplitude)
}

/// Amplitude of the observed degree of freedom at a position.
pub fn amplitude_of(point: &Point, half_wave: bool, position: usize, measure: Measure) -> f64 {
    let table = SampleTable::new(Harmonics::new(point.harmonics, half_wave));
    let mut series = vec![0.0; table.harmonics().slots()];
    let orders = point.harmonics + 1;
    let own = &point.displacement[position * orders..(position + 1) * orders];
    table.harmonics().write_series(own, &mut series);
    amplitude(&table, &series, measure)
}
