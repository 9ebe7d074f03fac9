//! A mistuned ring of beams (Guillen 1999, section 4.5) by number of blades and of harmonics.
//!
//! `cargo bench -p stickslip-core --bench ring`

#[path = "../tests/common/mod.rs"]
mod common;

use common::{snecma_beam, SLIP_FORCE, STIFFNESS};
use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion};
use faer::{c64, Mat};
use std::f64::consts::TAU;
use std::hint::black_box;
use stickslip_core::balance::{sweep, ForcedBalance, HarmonicChoice, Settings};
use stickslip_core::contact::Jenkins;
use stickslip_core::model::{Model, SectorContact};
use stickslip_core::structure::{HarmonicLoad, RingCoupling, Structure};
use stickslip_core::Error;

/// Coupling of neighbouring tips [N/m].
const COUPLING: f64 = 7e3;

/// Beams whose stiffness deviates by 7 %, uniformly distributed; engine order 3.
fn mistuned_ring(blades: usize) -> Result<Model, Error> {
    let beam = snecma_beam(20.313);
    let zero = Mat::zeros(3, 3);
    let mut next = zero.clone();
    next[(1, 1)] = -COUPLING;
    let (mut structures, mut contacts, mut loads) = (Vec::new(), Vec::new(), Vec::new());
    for blade in 0..blades {
        // Multiples of the golden ratio fill the interval evenly.
        let share = (0.618_033_988_75 * (1.0 + blade as f64)).fract();
        let factor = 1.0 + 0.07 * 3.0_f64.sqrt() * (2.0 * share - 1.0);
        let mut stiffness = faer::Scale(factor) * &beam.stiffness;
        stiffness[(1, 1)] += 2.0 * COUPLING;
        let (mass, damping) = (beam.mass.as_ref(), beam.damping.as_ref());
        structures.push(Structure::new(mass, damping, stiffness.as_ref())?);
        contacts.push(vec![SectorContact {
            law: Box::new(Jenkins::new(STIFFNESS, SLIP_FORCE)?),
            own: Mat::from_fn(1, 3, |_, j| f64::from(u8::from(j == 0))),
            next: Mat::zeros(1, 3),
        }]);
        let mut amplitude = vec![c64::new(0.0, 0.0); 3];
        amplitude[1] = c64::from_polar(20.313, TAU * 3.0 * blade as f64 / blades as f64);
        loads.push(vec![HarmonicLoad { harmonic: 1, amplitude }]);
    }
    let coupling = RingCoupling { mass: zero.clone(), damping: zero, stiffness: next };
    Model::ring(structures, coupling, contacts, loads)
}

fn curves(criterion: &mut Criterion) {
    let omega: Vec<f64> = (0..56).map(|i| 150.0 + 2.0 * f64::from(i)).collect();
    let mut group = criterion.benchmark_group("mistuned ring, 56 points");
    group.sample_size(10);
    for (blades, highest) in [(12, 3), (36, 3), (108, 3), (36, 9), (36, 25)] {
        let Ok(model) = mistuned_ring(blades) else { return };
        let observe: Vec<usize> = (0..blades).map(|blade| 3 * blade).collect();
        let settings =
            Settings { harmonics: HarmonicChoice::Fixed(highest), ..Settings::default() };
        let name = BenchmarkId::new(format!("{blades} blades"), highest);
        group.bench_with_input(name, &settings, |b, settings| {
            b.iter(|| {
                let balance = ForcedBalance::new(&model, *settings, &observe);
                balance.and_then(|balance| sweep(balance, black_box(&omega)))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, curves);
criterion_main!(benches);
