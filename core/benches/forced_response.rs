//! The 400-point sweep of the SNECMA beam (Guillen 1999, eq. 2.32) by number of harmonics, one
//! evaluation of the friction law with its tangent, and one compliance.
//!
//! `cargo bench -p stickslip-core`

#[path = "../tests/common/mod.rs"]
mod common;

use common::snecma_beam;
use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion};
use std::hint::black_box;
use stickslip_core::balance::{sweep, ForcedBalance, HarmonicChoice, Settings};
use stickslip_core::contact::{HarmonicForce as _, Jenkins, Motion, Residual, SlipLoad};
use stickslip_core::fourier::{Harmonics, SampleTable};
use stickslip_core::structure::Receptance;

fn beam_sweep(criterion: &mut Criterion) {
    let model = snecma_beam(20.313).model();
    let omega: Vec<f64> = (0..400).map(|i| 20.0 + 330.0 * f64::from(i) / 399.0).collect();
    let mut group = criterion.benchmark_group("beam, 400 points");
    for highest in [1, 3, 9, 15, 21, 35] {
        let settings =
            Settings { harmonics: HarmonicChoice::Fixed(highest), ..Settings::default() };
        group.bench_with_input(BenchmarkId::from_parameter(highest), &settings, |b, settings| {
            b.iter(|| {
                let balance = ForcedBalance::new(&model, *settings, &[0, 1, 2]);
                balance.and_then(|balance| sweep(balance, black_box(&omega)))
            });
        });
    }
    group.finish();
}

fn jenkins(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("jenkins, slip load and tangent");
    let Ok(law) = Jenkins::new(2.0, 1.0) else { return };
    for highest in [3, 15, 35] {
        let table = SampleTable::new(Harmonics::new(highest, true));
        let u: Vec<f64> = (0..table.harmonics().slots())
            .map(|i| 1.5 * (1.7 * i as f64).cos() / (1.0 + i as f64).powi(2))
            .collect();
        let motion = Motion { table: &table, displacement: &u, residual: Residual::Centred };
        let mut load = SlipLoad::default();
        group.bench_function(BenchmarkId::from_parameter(highest), |b| {
            b.iter(|| law.slip_load(black_box(motion), true, &mut load));
        });
    }
    group.finish();
}

fn receptance(criterion: &mut Criterion) {
    let model = snecma_beam(20.313).model();
    let mut out = Receptance::default();
    criterion.bench_function("beam, one receptance", |b| {
        b.iter(|| model.compliance().receptance(3, black_box(170.0), &mut out));
    });
}

criterion_group!(benches, beam_sweep, jenkins, receptance);
criterion_main!(benches);
