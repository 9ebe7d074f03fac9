//! Derivatives of laws without sliders against differences, whatever loops are nested.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::Random;
use common::masing::{close, largest, laws, series, RESIDUALS};
use common::tangents::load;
use stickslip_core::contact::{ContactLaw, HarmonicForce as _, Motion, Residual};
use stickslip_core::fourier::{Harmonics, SampleTable};

#[test]
fn tangents_are_derivatives_whatever_loops_are_nested() {
    let mut random = Random(5);
    for law in laws() {
        for (case, half_wave) in [false, true].into_iter().cycle().take(18).enumerate() {
            let table = SampleTable::new(Harmonics::new(5, half_wave));
            let unit = law.limits()[0] / law.stiffness()[(0, 0)];
            let size = unit * 10f64.powf(random.between(-2.0, 1.0));
            let u = series(&mut random, &table, size);
            let residual = RESIDUALS[case % 3];
            let own = load(&law, &table, &u, residual);
            let direction = series(&mut random, &table, size);
            let slots = u.len();
            let value = |share: f64| {
                let moved: Vec<f64> =
                    u.iter().zip(&direction).map(|(u, d)| u + share * d).collect();
                load(&law, &table, &moved, residual).value
            };
            let h = 1e-4;
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|n| value(n * h));
            let slopes: Vec<f64> =
                (0..slots).map(|i| (8.0 * (c[i] - b[i]) - d[i] + a[i]) / (12.0 * h)).collect();
            let product: Vec<f64> = own
                .tangent
                .chunks_exact(slots)
                .map(|row| row.iter().zip(&direction).map(|(t, d)| t * d).sum())
                .collect();
            let scale = law.stiffness()[(0, 0)] * largest(&direction);
            let error = slopes.iter().zip(&product).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // Where a break of the backbone is crossed at a turning point L'' is large.
            assert!(error < 2e-7 * scale, "{} {case}: {}", law.name(), error / scale);
        }
    }
}

#[test]
fn the_tangent_is_continuous_where_reversals_merge() {
    // u = cos θ + a cos 2θ has two reversals more beyond a = 1/4.
    for law in laws() {
        let table = SampleTable::new(Harmonics::new(3, false));
        let unit = law.limits()[0] / law.stiffness()[(0, 0)];
        let at = |a: f64| {
            let mut u = vec![0.0; table.harmonics().slots()];
            (u[1], u[3]) = (2.3 * unit, 2.3 * unit * a);
            load(&law, &table, &u, Residual::Centred)
        };
        let (below, above) = (at(0.25 - 1e-9), at(0.25 + 1e-9));
        close(&above.value, &below.value, 1e-7, "value");
        close(&above.tangent, &below.tangent, 1e-3, "tangent");
        let h = 2e-5;
        for a in [0.25, 0.26, 0.3] {
            let [low, high] = [-h, h].map(|h| at(a + h).value);
            let own = at(a).tangent;
            let slots = low.len();
            for i in 0..slots {
                let slope = (high[i] - low[i]) / (2.0 * h);
                let product = 2.3 * unit * own[i * slots + 3];
                let scale = law.stiffness()[(0, 0)] * unit;
                assert!((slope - product).abs() < 1e-4 * scale, "{} {a} {i}", law.name());
            }
        }
    }
}

#[test]
fn the_return_map_has_its_derivatives() {
    let mut random = Random(13);
    for law in laws() {
        let unit = law.limits()[0] / law.stiffness()[(0, 0)];
        let (mut u, mut state) = (0.0, vec![0.0; law.state_size()]);
        for _ in 0..200 {
            let to = unit * 3.0 * random.next() * random.next();
            let run = |before: f64, after: f64, state: &[f64]| {
                let (mut state, mut force) = (state.to_vec(), [0.0]);
                law.return_map(&[before], &[after], &mut state, &mut force, None);
                (state, force[0])
            };
            let mut jacobian = Default::default();
            let (mut next, mut force) = (state.clone(), [0.0]);
            law.return_map(&[u], &[to], &mut next, &mut force, Some(&mut jacobian));
            let size = state.len();
            let through = |of: &dyn Fn(usize) -> f64| -> f64 {
                (0..size).map(|z| jacobian.force_by_state[z] * of(z)).sum()
            };
            let by_after = jacobian.force_by_after[0] + through(&|z| jacobian.by_after[z]);
            let by_before = through(&|z| jacobian.by_before[z]);
            let h = 1e-6 * unit;
            let slope = |low: f64, high: f64| (high - low) / (2.0 * h);
            let k = law.stiffness()[(0, 0)];
            let (a, b) = (run(u, to - h, &state).1, run(u, to + h, &state).1);
            let c = run(u, to, &state).1;
            let smooth = (a - 2.0 * c + b).abs() < 1e-4 * k * h;
            assert!(!smooth || (slope(a, b) - by_after).abs() < 1e-4 * k, "{}", law.name());
            // Before the step the motion may not reverse earlier.
            let remembered = state.iter().take_while(|z| **z != 0.0).count();
            if remembered > 0 {
                let (a, b) = (run(u - h, to, &state).1, run(u + h, to, &state).1);
                let smooth = (a - 2.0 * c + b).abs() < 1e-4 * k * h;
                assert!(!smooth || (slope(a, b) - by_before).abs() < 1e-4 * k, "{}", law.name());
                let z = remembered - 1;
                let moved = |side: f64| {
                    let mut state = state.clone();
                    state[z] += side * k * h;
                    run(u, to, &state).1
                };
                let by_state = through(&|i| jacobian.by_state[i * size + z]);
                let (a, b) = (moved(-1.0), moved(1.0));
                let smooth = (a - 2.0 * c + b).abs() < 1e-4 * k * h;
                assert!(!smooth || (slope(a, b) / k - by_state).abs() < 1e-4, "{}", law.name());
            }
            (u, state) = (to, next);
            assert!(force[0].abs() <= law.limits()[0] * (1.0 + 1e-12));
        }
    }
}

#[test]
fn parameters_have_their_derivatives() {
    let mut random = Random(17);
    for law in laws() {
        for (index, parameter) in law.parameters().into_iter().enumerate() {
            for (case, half_wave) in [false, true, false].into_iter().enumerate() {
                let table = SampleTable::new(Harmonics::new(4, half_wave));
                let unit = law.limits()[0] / law.stiffness()[(0, 0)];
                let size = unit * 10f64.powf(random.between(-1.0, 0.7));
                let u = series(&mut random, &table, size);
                let motion = Motion { table: &table, displacement: &u, residual: RESIDUALS[case] };
                let mut own = vec![0.0; u.len()];
                law.parameter_slope(motion, index, &mut own);
                let h = 1e-5 * if parameter.value == 0.0 { 1.0 } else { parameter.value.abs() };
                let force = |side: f64| -> Option<Vec<f64>> {
                    let law = law.with_parameter(index, parameter.value + side * h).ok()?;
                    let q = load(&*law, &table, &u, RESIDUALS[case]).value;
                    let k = law.stiffness()[(0, 0)];
                    Some(u.iter().zip(&q).map(|(u, q)| k * u - q).collect())
                };
                let (Some(low), Some(high)) = (force(-1.0), force(1.0)) else { continue };
                let slopes: Vec<f64> =
                    low.iter().zip(&high).map(|(a, b)| (b - a) / (2.0 * h)).collect();
                close(&own, &slopes, 3e-5, &format!("{} {}", law.name(), parameter.name));
            }
        }
    }
}
