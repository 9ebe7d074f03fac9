//! Laws without memory: the stop and the cubic spring. Exact series against fine samples, tangents and
//! slopes in parameters against differences in every state.

#![allow(clippy::unwrap_used)]

use stickslip_core::contact::{Aft, ContactLaw, Cubic, Motion, Residual, SlipLoad, Stop};
use stickslip_core::fourier::{Harmonics, SampleTable};

const H: usize = 6;

fn table(half_wave: bool) -> SampleTable {
    SampleTable::new(Harmonics::new(H, half_wave))
}

fn load(law: &dyn ContactLaw, table: &SampleTable, u: &[f64]) -> SlipLoad {
    let mut load = SlipLoad::default();
    let motion = Motion { table, displacement: u, residual: Residual::Centred };
    law.slip_load(motion, true, &mut load);
    load
}

/// A motion of several turning points about a mean.
fn motion(mean: f64) -> Vec<f64> {
    let mut u = vec![0.9, -0.4, 0.3, 0.2, -0.25, 0.1, 0.05, -0.04, 0.03, 0.02, -0.01, 0.015];
    u.insert(0, mean);
    u
}

fn stops() -> Vec<(Stop, Vec<f64>)> {
    let stop = |gap: f64| Stop::new(7.0, gap).unwrap();
    vec![
        (stop(0.3), motion(0.1)),   // closes once
        (stop(0.3), motion(-4.0)),  // open
        (stop(0.3), motion(4.0)),   // closed
        (stop(-0.3), motion(-0.2)), // interference that opens
        (stop(-0.3), motion(4.0)),  // interference that stays closed
        (stop(-0.3), motion(-4.0)), // interference that is lost
        (stop(0.9), motion(0.5)),   // closes for a short while
        (stop(0.0), motion(0.0)),
    ]
}

fn differs(law: &dyn ContactLaw, table: &SampleTable, u: &[f64], scale: f64) -> f64 {
    let exact = load(law, table, u);
    let (size, step) = (u.len(), 1e-6);
    let mut worst = 0.0_f64;
    for column in 0..size {
        let mut shifted = u.to_vec();
        shifted[column] += step;
        let ahead = load(law, table, &shifted).value;
        shifted[column] -= 2.0 * step;
        let behind = load(law, table, &shifted).value;
        for row in 0..size {
            let slope = (ahead[row] - behind[row]) / (2.0 * step);
            worst = worst.max((exact.tangent[row * size + column] - slope).abs());
        }
    }
    worst / scale
}

#[test]
fn tangents_are_the_derivatives_in_every_state() {
    for (stop, u) in stops() {
        let error = differs(&stop, &table(false), &u, 7.0);
        assert!(error < 1e-8, "{stop:?} {u:?}: {error:e}");
    }
    for k in [3.0, -3.0] {
        let cubic = Cubic::new(k).unwrap();
        assert!(differs(&cubic, &table(false), &motion(0.4), 9.0) < 1e-8);
        assert!(differs(&cubic, &table(true), &motion(0.0)[1..7], 9.0) < 1e-8);
    }
}

/// Samples of a stop err by the second power of their distance, those of a cubic spring not at all.
#[test]
fn series_are_those_of_fine_samples() {
    let error = |law: &dyn ContactLaw, other: Box<dyn ContactLaw>, samples: usize, u: &[f64]| {
        let table = table(false);
        let sampled = Aft::new(other, samples).unwrap();
        let (a, b) = (load(law, &table, u), load(&sampled, &table, u));
        let pairs = a.value.iter().zip(&b.value).chain(a.tangent.iter().zip(&b.tangent));
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    for (stop, u) in stops() {
        let worst = error(&stop, Box::new(stop), 1 << 16, &u);
        // The tangent jumps between two samples.
        assert!(worst < 7.0 * 1e-4, "{stop:?} {u:?}: {worst:e}");
    }
    for k in [3.0, -3.0] {
        let cubic = Cubic::new(k).unwrap();
        let worst = error(&cubic, Box::new(cubic), 4 * H + 2, &motion(0.4));
        assert!(worst < 1e-13 * 30.0, "{worst:e}");
    }
}

#[test]
fn slopes_in_parameters_are_derivatives() {
    let laws = stops().into_iter().map(|(stop, u)| (Box::new(stop) as Box<dyn ContactLaw>, u));
    let cubic = Cubic::new(-3.0).unwrap();
    for (law, u) in laws.chain([(Box::new(cubic) as Box<dyn ContactLaw>, motion(0.4))]) {
        let table = table(false);
        let motion = Motion { table: &table, displacement: &u, residual: Residual::Centred };
        for (index, parameter) in law.parameters().iter().enumerate() {
            let mut slope = vec![0.0; u.len()];
            law.parameter_slope(motion, index, &mut slope);
            let step = 1e-6;
            let force = |value: f64| -> Vec<f64> {
                let law = law.with_parameter(index, value).unwrap();
                let stuck = law.stiffness()[(0, 0)];
                let load = load(law.as_ref(), &table, &u).value;
                load.iter().zip(&u).map(|(q, u)| stuck * u - q).collect()
            };
            let (a, b) = (force(parameter.value + step), force(parameter.value - step));
            for ((a, b), slope) in a.iter().zip(&b).zip(&slope) {
                let error = (0.5 * (a - b) / step - slope).abs();
                assert!(error < 1e-7, "{law:?} {index}: {error:e}");
            }
        }
    }
}

#[test]
fn laws_refuse_what_they_cannot_be() {
    assert!(Stop::new(-1.0, 0.0).is_err() && Stop::new(f64::INFINITY, 0.0).is_err());
    assert!(Stop::new(1.0, f64::NAN).is_err() && Stop::new(1.0, f64::INFINITY).is_err());
    assert!(Cubic::new(f64::NAN).is_err());
}
