//! Limit cycles of random systems: no branch stalls without saying so.
#![allow(clippy::unwrap_used)]

use faer::Mat;
use stickslip_core::balance::HarmonicChoice;
use stickslip_core::contact::Jenkins;
use stickslip_core::model::{Contact, Model, NegativeDamping, Variation};
use stickslip_core::orbit::{limit_cycles, CycleSettings, LimitCycles};
use stickslip_core::solve::End;
use stickslip_core::structure::Structure;

/// Numbers of a linear congruential generator (Knuth), uniform in [0, 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }
}

/// A chain or net of up to 8 masses with up to 3 dampers, its negative damping and a mode.
fn system(seed: u64) -> (Model, Mat<f64>, usize) {
    let mut numbers = Numbers(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(1));
    for _ in 0..8 {
        numbers.next();
    }
    let size = 1 + numbers.below(8);
    let mut mass = Mat::<f64>::zeros(size, size);
    let mut stiffness = Mat::<f64>::zeros(size, size);
    for i in 0..size {
        mass[(i, i)] = 0.5 + numbers.next();
        stiffness[(i, i)] += 20.0 + 200.0 * numbers.next();
        for j in 0..i {
            if j + 1 == i || numbers.next() < 0.2 {
                let k = 400.0 * numbers.next();
                stiffness[(i, i)] += k;
                stiffness[(j, j)] += k;
                stiffness[(i, j)] -= k;
                stiffness[(j, i)] -= k;
            }
        }
    }
    let contacts = (0..1 + numbers.below(3))
        .map(|_| {
            let (one, other) = (numbers.below(size), numbers.below(size));
            let between = one != other && numbers.next() < 0.5;
            let rows = Mat::from_fn(1, size, |_, j| {
                f64::from(u8::from(j == one)) - f64::from(u8::from(between && j == other))
            });
            let law = Jenkins::new(20.0 + 300.0 * numbers.next(), 0.2 + numbers.next()).unwrap();
            Contact { law: Box::new(law), rows }
        })
        .collect();
    let (a, b) = (0.05 * numbers.next(), 2e-4 * numbers.next());
    let coupled = numbers.next() < 0.3;
    let mut negative = faer::Scale(-a) * &mass + faer::Scale(-b) * &stiffness;
    if coupled {
        for i in 0..size {
            for j in 0..size {
                negative[(i, j)] += 0.01 * a * (numbers.next() - 0.5);
            }
        }
    }
    let share = if numbers.next() < 0.3 { 0.3 * numbers.next() } else { 0.0 };
    let damping = faer::Scale(-share) * &negative;
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let mode = numbers.below(size.min(3));
    (Model::new(structure, contacts, Vec::new()).unwrap(), negative, mode)
}

/// Whether a branch is complete: around the limit, and down to a tenth of it where it goes there.
fn complete(cycles: &LimitCycles) -> bool {
    let Some(limit) = cycles.limit else { return false };
    let ended = matches!(cycles.ends[1], End::Range | End::Condition);
    ended && cycles.ends[0] == End::Range && cycles.end_values[1] < limit.value
}

fn study(seeds: std::ops::Range<u64>, exact: bool) -> (usize, Vec<String>) {
    let (mut solved, mut causes) = (0, Vec::new());
    for seed in seeds {
        let (model, negative, mode) = system(seed);
        let settings = CycleSettings {
            mode,
            exact,
            harmonics: HarmonicChoice::Fixed(9),
            stability: false,
            ..CycleSettings::default()
        };
        let negative = NegativeDamping::Whole(negative);
        match limit_cycles(&model, &negative, &Variation::Ratio, 1.0, &settings, &|_| true) {
            Ok(cycles) if complete(&cycles) => solved += 1,
            Ok(cycles) => causes.push(format!(
                "{seed}: {:?} at {:?}, limit {:?}",
                cycles.ends, cycles.end_values, cycles.limit
            )),
            Err(error) => causes.push(format!("{seed}: {error}")),
        }
    }
    (solved, causes)
}

#[test]
fn branches_of_random_systems_are_complete() {
    for (seeds, exact) in [(0..12, false), (12..16, true)] {
        let (_, causes) = study(seeds, exact);
        assert!(causes.is_empty(), "exact {exact}: {causes:?}");
    }
}

#[test]
#[ignore = "two minutes"]
fn branches_of_a_hundred_random_systems_are_complete() {
    for exact in [false, true] {
        let (solved, causes) = study(0..100, exact);
        assert_eq!(solved, 100, "exact {exact}: {causes:?}");
    }
}
