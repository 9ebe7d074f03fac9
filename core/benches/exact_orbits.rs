//! Exact orbits and time integration of the SNECMA beam (Guillen 1999, eq. 2.32).
//!
//! `cargo bench -p stickslip-core --bench exact_orbits`

#[path = "../tests/common/mod.rs"]
mod common;

use common::snecma_beam;
use criterion::{criterion_group, criterion_main, Criterion};
use std::hint::black_box;
use stickslip_core::motion::{transient, Scheme, TransientSettings};
use stickslip_core::orbit::{orbit_sweep, OrbitSettings, PeriodicOrbits};

fn orbits(criterion: &mut Criterion) {
    let model = snecma_beam(20.313).model();
    let omega: Vec<f64> = (0..400).map(|i| 20.0 + 330.0 * f64::from(i) / 399.0).collect();
    criterion.bench_function("beam, 400 exact orbits", |b| {
        b.iter(|| {
            let orbits = PeriodicOrbits::new(&model, OrbitSettings::default(), &[0, 1, 2]);
            orbits.and_then(|orbits| orbit_sweep(orbits, black_box(&omega)))
        });
    });
}

fn periods(criterion: &mut Criterion) {
    let model = snecma_beam(20.313).model();
    for (name, scheme) in
        [("exact", Scheme::Exact), ("Runge-Kutta, 1000 steps", Scheme::RungeKutta(1000))]
    {
        let settings = TransientSettings {
            omega: 170.0,
            scheme,
            periods: 10,
            tolerance: None,
            samples: 1,
            keep: Some(1),
        };
        criterion.bench_function(&format!("beam, 10 periods, {name}"), |b| {
            b.iter(|| transient(&model, black_box(&settings), None, &[1], &|_| true));
        });
    }
}

criterion_group!(benches, orbits, periods);
criterion_main!(benches);
