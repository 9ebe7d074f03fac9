//! Laws without sliders against closed forms, sums of many sliders, differences and their own march.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::Random;
use common::masing::{close, largest, laws, series, RESIDUALS};
use common::tangents::load;
use stickslip_core::contact::{
    Aft, Backbone, ContactLaw, HarmonicForce as _, Jenkins, Masing, Motion, PointSummary, Residual,
    Slider, SlipLoad,
};
use stickslip_core::fourier::{Harmonics, SampleTable};

fn summary(law: &dyn ContactLaw, table: &SampleTable, u: &[f64]) -> PointSummary {
    let mut out = [PointSummary::default()];
    law.summary(Motion { table, displacement: u, residual: Residual::Centred }, &mut out);
    out[0]
}

/// Force coefficients of a cosine of amplitude A: in-phase stiffness, and dissipation per cycle.
fn cosine(law: &Masing, amplitude: f64, highest: usize) -> [f64; 3] {
    let table = SampleTable::new(Harmonics::new(highest, true));
    let mut u = vec![0.0; table.harmonics().slots()];
    u[0] = amplitude;
    let work = summary(law, &table, &u).dissipation;
    let load = load(law, &table, &u, Residual::Centred);
    let motion = Motion { table: &table, displacement: &u, residual: Residual::Centred };
    let crest = law.force_history(motion, 4)[0];
    let lost = std::f64::consts::PI * amplitude * load.value[1];
    assert!((lost - work).abs() <= 1e-10 * work, "{lost} {work}");
    [crest, work, law.stiffness()[(0, 0)] - load.value[0] / amplitude]
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found} {expected}");
}

#[test]
fn a_cosine_has_the_closed_forms_of_its_backbone() {
    let iwan = Masing::iwan(0.25, 0.2, -0.5, 0.0).unwrap();
    let [f, d, k] = cosine(&iwan, 0.24, 1);
    near(f, 0.047_350_889_36, 1e-9);
    near(d, 0.002_428_629_243, 1e-9);
    near(k, 0.196_315_507_1, 1e-9);
    let [f, d, k] = cosine(&iwan, 2.4, 3);
    near(f, 0.2, 1e-12);
    near(d, 0.768, 1e-12);
    near(k, 0.080_234_727_37, 1e-9);
    // K_T 2e6, F_S 1000, χ 0: φ_max is 1e-3.
    let uniform = Masing::iwan(2e6, 1000.0, 0.0, 0.0).unwrap();
    let [f, d, k] = cosine(&uniform, 5e-4, 9);
    near(f, 750.0, 1e-12);
    near(d, 1.0 / 6.0, 1e-12);
    near(k, 1.5e6, 1e-11);
    let exponential = Masing::new(2e6, 400.0, Backbone::Exponential).unwrap();
    let [f, d, k] = cosine(&exponential, 5e-5, 15);
    near(f, 88.479_686_8, 1e-8);
    near(d, 7.365_638_11e-4, 1e-8);
    near(k, 1_768_443.3, 1e-7);
}

#[test]
fn a_bar_on_a_friction_layer_dissipates_what_it_has_to() {
    let (ea, length, k, q) = (1e7_f64, 0.1, 1e10_f64, 2e4);
    let lambda = (k / ea).sqrt();
    let stiffness = ea * lambda * (lambda * length).tanh();
    let law = Masing::new(stiffness, q * length, Backbone::shear_layer(lambda * length).unwrap());
    for (f, u, d) in [
        (800.0, 2.612_249_075e-6, 2.015_188_991e-4),
        (1200.0, 4.644_097_344e-6, 2.747_895_948e-3),
        (1600.0, 7.566_359_702e-6, 9.601_744_996e-3),
    ] {
        let [force, work, _] = cosine(law.as_ref().unwrap(), u, 3);
        near(force, f, 1e-9);
        near(work, d, 1e-8);
    }
}

/// Sliders that stand for Segalman's model without a common limit.
fn sliders(chi: f64, count: usize) -> Jenkins {
    let law = Masing::iwan(0.25, 0.2, chi, 0.0).unwrap();
    let end = 0.2 / 0.25 * (chi + 2.0) / (chi + 1.0);
    let own = |a: f64, b: f64| {
        let k = 0.25 * ((b / end).powf(chi + 1.0) - (a / end).powf(chi + 1.0));
        let limits = |u: f64| 0.2 * (u / end).powf(chi + 2.0);
        Slider::new(k, limits(b) - limits(a)).unwrap()
    };
    let edge = |i: usize| end * (i as f64 / count as f64).powi(2);
    let all = Jenkins::of((0..count).map(|i| own(edge(i), edge(i + 1))).collect()).unwrap();
    near(all.stiffness()[(0, 0)], law.stiffness()[(0, 0)], 1e-12);
    all
}

#[test]
fn sums_of_sliders_come_near_at_second_order() {
    let table = SampleTable::new(Harmonics::new(7, true));
    let mut u = vec![0.0; table.harmonics().slots()];
    (u[0], u[2]) = (1.0, 0.4);
    for chi in [-0.5, -0.3] {
        let law = Masing::iwan(0.25, 0.2, chi, 0.0).unwrap();
        let exact = load(&law, &table, &u, Residual::Centred);
        let work = summary(&law, &table, &u).dissipation;
        let errors = [100, 1000, 100_000].map(|count| {
            let sum = sliders(chi, count);
            let mut near = SlipLoad::default();
            let motion = Motion { table: &table, displacement: &u, residual: Residual::Centred };
            sum.slip_load(motion, false, &mut near);
            let apart = near.value.iter().zip(&exact.value).map(|(a, b)| (a - b).abs());
            let error = apart.fold(0.0, f64::max) / largest(&exact.value);
            (error, (summary(&sum, &table, &u).dissipation / work - 1.0).abs())
        });
        assert!(errors[1].0 < 0.03 * errors[0].0 && errors[1].1 < 0.03 * errors[0].1, "{errors:?}");
        assert!(errors[2].0 < 1e-8 && errors[2].1 < 1e-8, "{errors:?}");
    }
}

#[test]
fn a_table_is_a_sum_of_sliders() {
    let (u, f) = ([0.1, 0.3, 0.7, 2.0], [1.0, 2.5, 4.0, 4.4]);
    let (backbone, stiffness, most) = Backbone::table(&u, &f).unwrap();
    let law = Masing::new(stiffness, most, backbone).unwrap();
    let slope = |i: usize| match i {
        0 => f[0] / u[0],
        i if i < 4 => (f[i] - f[i - 1]) / (u[i] - u[i - 1]),
        _ => 0.0,
    };
    let element = |i: usize| {
        let k = slope(i) - slope(i + 1);
        Slider::new(k, k * u[i]).unwrap()
    };
    let sum = Jenkins::of((0..4).map(element).collect()).unwrap();
    let mut random = Random(3);
    for (case, half_wave) in [false, true].into_iter().cycle().take(60).enumerate() {
        let table = SampleTable::new(Harmonics::new(6, half_wave));
        let size = 10f64.powf(random.between(-2.0, 1.0));
        let displacement = series(&mut random, &table, size);
        // Each slider would hold the whole of a given residual force.
        let residual = RESIDUALS[case % 2];
        let (own, other) = (
            load(&law, &table, &displacement, residual),
            load(&sum, &table, &displacement, residual),
        );
        close(&own.value, &other.value, 1e-10, "value");
        close(&own.tangent, &other.tangent, 1e-9, "tangent");
        let motion = Motion { table: &table, displacement: &displacement, residual };
        close(&law.force_history(motion, 97), &sum.force_history(motion, 97), 1e-10, "force");
        let (own, other) =
            (summary(&law, &table, &displacement), summary(&sum, &table, &displacement));
        assert!((own.slip_fraction - other.slip_fraction).abs() < 1e-10);
        assert!((own.dissipation - other.dissipation).abs() <= 1e-10 * other.dissipation);
    }
}

#[test]
fn the_march_comes_near_the_integrals() {
    let mut random = Random(9);
    for law in laws() {
        for half_wave in [false, true] {
            let table = SampleTable::new(Harmonics::new(4, half_wave));
            let unit = law.limits()[0] / law.stiffness()[(0, 0)];
            let size = unit * 10f64.powf(random.between(-0.5, 0.5));
            let u = series(&mut random, &table, size);
            let exact = load(&law, &table, &u, Residual::FromRest);
            let errors = [1024, 4096].map(|samples| {
                let sampled = Aft::new(law.with_scaled_forces(1.0), samples).unwrap();
                let own = load(&sampled, &table, &u, Residual::FromRest);
                let apart = |a: &[f64], b: &[f64]| {
                    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
                };
                [
                    apart(&own.value, &exact.value) / largest(&exact.value),
                    apart(&own.tangent, &exact.tangent) / largest(&exact.tangent),
                ]
            });
            assert!(errors[0][0] < 2e-3 && errors[0][1] < 0.02, "{} {errors:?}", law.name());
            assert!(errors[1][0] < 1e-4 && errors[1][1] < 0.005, "{} {errors:?}", law.name());
        }
    }
}

#[test]
fn more_reversals_than_places_cost_little() {
    // A motion that dies away: exact memory would hold all of its reversals.
    let law = Masing::iwan(1.0, 0.5, -0.5, 0.0).unwrap();
    let sum = sliders_of(&law, 4000);
    for (places, error) in [(64, 1e-2), (256, 1e-3), (1024, 1e-6)] {
        let law = law.with_memory(places).unwrap();
        let most = dies_away(&*law, &sum);
        assert!(most < error * 0.5, "{places}: {most}");
    }
}

/// Largest difference of the forces of two laws.
fn dies_away(law: &dyn ContactLaw, sum: &Jenkins) -> f64 {
    let (mut u, mut state) = (0.0, vec![0.0; law.state_size()]);
    let (mut own, mut reference) = ([0.0], vec![0.0; 4000]);
    let mut most = 0.0_f64;
    for n in 0..600 {
        let to = 0.6 * 0.985_f64.powi(n) * if n % 2 == 0 { 1.0 } else { -1.0 };
        law.return_map(&[u], &[to], &mut state, &mut own, None);
        let mut force = [0.0];
        sum.return_map(&[u], &[to], &mut reference, &mut force, None);
        most = most.max((own[0] - force[0]).abs());
        u = to;
    }
    most
}

/// Sliders of a law without a common limit, by its forces.
fn sliders_of(law: &Masing, count: usize) -> Jenkins {
    let (k, s, chi) = (law.stiffness()[(0, 0)], law.limits()[0], law.parameters()[2].value);
    let end = s / k * (chi + 2.0) / (chi + 1.0);
    let edge = |i: usize| end * (i as f64 / count as f64).powi(2);
    let own = |i: usize| {
        let (a, b) = (edge(i) / end, edge(i + 1) / end);
        let part = |power: f64| b.powf(power) - a.powf(power);
        Slider::new(k * part(chi + 1.0), s * part(chi + 2.0)).unwrap()
    };
    Jenkins::of((0..count).map(own).collect()).unwrap()
}

#[test]
fn tiny_and_huge_motions_keep_their_digits() {
    for chi in [-0.99, -0.7, -0.5, 0.0] {
        let law = Masing::iwan(0.25, 0.2, chi, 0.0).unwrap();
        let end = 0.2 / 0.25 * (chi + 2.0) / (chi + 1.0);
        let limit = 0.25 / end.powf(chi + 1.0);
        for share in [1e-12, 1e-6, 1e-2, 0.9] {
            // 4 R A^(χ+3)/((χ+2)(χ+3)) with R = K_T (χ + 1)/φ^(χ+1).
            let a = share * end;
            let exact = 4.0 * limit * (chi + 1.0) * a.powf(chi + 3.0) / ((chi + 2.0) * (chi + 3.0));
            let [_, work, _] = cosine(&law, a, 3);
            near(work, exact, 1e-10);
        }
        let a = 1e3 * end;
        // The integral of F up to φ_max.
        let inner = 0.5 * 0.25 * end * end - 0.25 * end * end / ((chi + 2.0) * (chi + 3.0));
        let exact = 8.0 * (inner + 0.2 * (a - end)) - 4.0 * a * 0.2;
        let [force, work, _] = cosine(&law, a, 3);
        // The difference of k u and the slip load, which are larger.
        near(force, 0.2, 1e-15 * 0.25 * a / 0.2);
        near(work, exact, 1e-9);
    }
}

#[test]
fn limits_are_springs_and_nothing() {
    let table = SampleTable::new(Harmonics::new(3, false));
    let u = [0.1, 0.5, 0.2, 0.0, -0.3, 0.1, 0.0];
    for residual in RESIDUALS {
        let rigid = Masing::iwan(2.0, f64::INFINITY, -0.5, 0.1).unwrap();
        let own = load(&rigid, &table, &u, residual);
        assert!(own.value[1..].iter().all(|q| *q == 0.0));
        let free = load(&Masing::iwan(2.0, 0.0, -0.5, 0.1).unwrap(), &table, &u, residual);
        close(&free.value, &u.map(|u| 2.0 * u), 1e-12, "free");
        let none = load(&Masing::iwan(0.0, 1.0, -0.5, 0.1).unwrap(), &table, &u, residual);
        assert!(none.value.iter().all(|q| *q == 0.0));
        let still = load(
            &Masing::iwan(2.0, 0.0, -0.5, 0.1).unwrap(),
            &table,
            &[0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            residual,
        );
        assert!(still.value[0] == 0.6);
    }
    // With all weight on the common limit it is a Jenkins element.
    let jenkins = Jenkins::new(2.0, 0.3).unwrap();
    let iwan = Masing::iwan(2.0, 0.3, -0.5, 1e9).unwrap();
    let (own, other) = (
        load(&iwan, &table, &u, Residual::Centred).value,
        load(&jenkins, &table, &u, Residual::Centred).value,
    );
    close(&own, &other, 1e-8, "jenkins");
}

#[test]
fn the_describing_function_is_that_of_a_cosine() {
    for law in laws() {
        let unit = law.limits()[0] / law.stiffness()[(0, 0)];
        for share in [0.01, 0.6, 4.0, 300.0] {
            let amplitude = share * unit;
            let own = law.describing(amplitude).unwrap();
            let [_, work, in_phase] = cosine(&law, amplitude, 9);
            near(own.stiffness.re, in_phase, 1e-9);
            let loss = work / (std::f64::consts::PI * amplitude * amplitude);
            assert!((own.stiffness.im - loss).abs() <= 1e-9 * loss);
            let h = 1e-4 * amplitude;
            let [low, high] = [-h, h].map(|h| law.describing(amplitude + h).unwrap().stiffness);
            let error = ((high - low) / (2.0 * h) - own.slope).norm();
            assert!(error * amplitude < 1e-5 * law.stiffness()[(0, 0)], "{} {share}", law.name());
        }
    }
}
