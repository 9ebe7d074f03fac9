//! The Jenkins element under a harmonic displacement has closed forms (Griffin 1980; Guillen
//! 1999, eqs. 2.12-2.14 with the sign of 2.13 corrected).

use faer::c64;
use std::f64::consts::PI;
use stickslip_core::contact::{
    Describing, HarmonicForce, Jenkins, Motion, PointSummary, Residual, SlipLoad,
};
use stickslip_core::fourier::{Harmonics, SampleTable};

const STIFFNESS: f64 = 3.0e5;
const SLIP_FORCE: f64 = 12.0;

fn motion<'a>(table: &'a SampleTable, displacement: &'a [f64]) -> Motion<'a> {
    Motion { table, displacement, residual: Residual::Centred }
}

#[test]
fn stiffness_and_dissipation_of_a_harmonic_displacement() {
    let law = Jenkins::new(STIFFNESS, SLIP_FORCE).unwrap();
    let delta = SLIP_FORCE / STIFFNESS;
    for half_wave in [true, false] {
        let table = SampleTable::new(Harmonics::new(5, half_wave));
        let first = table.harmonics().offset();
        for ratio in [1.0 + 1e-9, 1.05, 2.0, 3.7, 40.0] {
            let amplitude = ratio * delta;
            let mut u = vec![0.0; table.harmonics().slots()];
            u[first] = amplitude;
            let mut load = SlipLoad::default();
            law.slip_load(motion(&table, &u), false, &mut load);
            let in_phase = STIFFNESS * amplitude - load.value[first];
            let quadrature = -load.value[first + 1];
            let theta = (1.0 - 2.0 / ratio).acos();
            let stiffness = STIFFNESS / PI * (theta - 0.5 * (2.0 * theta).sin());
            assert!((in_phase - stiffness * amplitude).abs() < 1e-9 * SLIP_FORCE, "{ratio}");
            let work = 4.0 * SLIP_FORCE * (amplitude - delta);
            // u = A cos θ: the work per cycle is −π A times the sine coefficient of the force.
            assert!((-PI * amplitude * quadrature - work).abs() < 1e-9 * SLIP_FORCE * amplitude);
            let mut summary = [PointSummary::default()];
            law.summary(motion(&table, &u), &mut summary);
            assert!((summary[0].dissipation - work).abs() < 1e-12 * SLIP_FORCE * amplitude);
            assert!((summary[0].slip_fraction - (1.0 - theta / PI)).abs() < 1e-9);
        }
    }
}

#[test]
fn equivalent_damping_is_largest_at_twice_the_slip_displacement() {
    let law = Jenkins::new(STIFFNESS, SLIP_FORCE).unwrap();
    let delta = SLIP_FORCE / STIFFNESS;
    let table = SampleTable::new(Harmonics::new(1, true));
    let damping = |amplitude: f64| {
        let mut load = SlipLoad::default();
        law.slip_load(motion(&table, &[amplitude, 0.0]), false, &mut load);
        load.value[1] / amplitude
    };
    let largest = damping(2.0 * delta);
    assert!((largest - STIFFNESS / PI).abs() < 1e-9 * STIFFNESS);
    for ratio in [1.2, 1.9, 2.1, 5.0] {
        assert!(damping(ratio * delta) < largest);
    }
}

#[test]
fn the_force_history_closes_its_loop_and_matches_its_series() {
    let law = Jenkins::new(STIFFNESS, SLIP_FORCE).unwrap();
    let delta = SLIP_FORCE / STIFFNESS;
    for half_wave in [true, false] {
        let table = SampleTable::new(Harmonics::new(5, half_wave));
        let harmonics = table.harmonics();
        let mut u = vec![0.0; harmonics.slots()];
        for (order, a, b) in [(1, 2.0, -0.4), (3, 0.9, 1.1), (5, -0.5, 0.3)] {
            let slot = harmonics.slot(order).unwrap();
            (u[slot], u[slot + 1]) = (a * delta, b * delta);
        }
        let samples = 40_000;
        let history = law.force_history(motion(&table, &u), samples);
        assert!(history.iter().all(|f| f.abs() <= SLIP_FORCE));
        // The stop operator, marched through two periods, forgets its start: same force.
        let mut f = 0.0_f64;
        let mut largest = 0.0_f64;
        let displacement = |n: usize| harmonics.jet(&u, 2.0 * PI * n as f64 / samples as f64)[0];
        for n in 1..=2 * samples {
            let step = STIFFNESS * (displacement(n) - displacement(n - 1));
            f = (f + step).clamp(-SLIP_FORCE, SLIP_FORCE);
            if n > samples {
                largest = largest.max((f - history[n % samples]).abs());
            }
        }
        assert!(largest < 1e-5 * SLIP_FORCE, "{largest}");
        let mut load = SlipLoad::default();
        law.slip_load(motion(&table, &u), false, &mut load);
        for order in [1, 3, 5] {
            let slot = harmonics.slot(order).unwrap();
            let mean = |shape: &dyn Fn(f64) -> f64| {
                2.0 / samples as f64
                    * (0..samples)
                        .map(|n| {
                            shape(order as f64 * 2.0 * PI * n as f64 / samples as f64) * history[n]
                        })
                        .sum::<f64>()
            };
            let series = [
                STIFFNESS * u[slot] - load.value[slot],
                STIFFNESS * u[slot + 1] - load.value[slot + 1],
            ];
            assert!((series[0] - mean(&f64::cos)).abs() < 1e-6 * SLIP_FORCE);
            assert!((series[1] - mean(&f64::sin)).abs() < 1e-6 * SLIP_FORCE);
        }
    }
}

#[test]
fn slopes_are_those_of_the_stiffness_and_both_are_continuous_at_slip() {
    let (k, f) = (3.0, 1.2);
    let delta = f / k;
    for ratio in [1.001, 1.3, 2.0, 7.0, 900.0] {
        let (amplitude, h) = (ratio * delta, 1e-6 * delta);
        let at = |a| Describing::of_jenkins(k, f, a).stiffness;
        let slope = (at(amplitude + h) - at(amplitude - h)) / (2.0 * h);
        let exact = Describing::of_jenkins(k, f, amplitude).slope;
        assert!((slope - exact).norm() < 1e-5 * k / delta, "{ratio}: {slope} {exact}");
    }
    let (before, after) =
        (Describing::of_jenkins(k, f, delta), Describing::of_jenkins(k, f, delta * (1.0 + 1e-12)));
    assert!((before.stiffness - after.stiffness).norm() < 1e-11 * k);
    assert_eq!((before.slip_fraction, before.stiffness.re), (0.0, k));
}

#[test]
fn elements_without_friction_or_spring_carry_nothing() {
    let zero = c64::new(0.0, 0.0);
    for amplitude in [0.0, 2.0] {
        for (k, f) in [(3.0, 0.0), (0.0, 1.0)] {
            let found = Describing::of_jenkins(k, f, amplitude);
            assert_eq!((found.stiffness, found.slope), (zero, zero), "{k} {f} {amplitude}");
        }
    }
    let found = Describing::of_jenkins(3.0, f64::INFINITY, 1.0);
    assert_eq!(found.stiffness, c64::new(3.0, 0.0));
}

#[test]
fn slip_begins_where_the_range_of_several_harmonics_reaches_its_limit() {
    // 3rd harmonics that lower the crest, or raise it: amplitudes alone tell of the second.
    let table = SampleTable::new(Harmonics::new(3, true));
    for (third, crest) in [(-0.1, 0.9), (0.1, 1.1)] {
        for (ratio, slips) in [(0.5, false), (1.0 - 1e-9, false), (1.0 + 1e-9, true)] {
            let law = Jenkins::new(STIFFNESS, STIFFNESS * crest / ratio).unwrap();
            let u = [1.0, 0.0, third, 0.0];
            let mut load = SlipLoad::default();
            law.slip_load(motion(&table, &u), true, &mut load);
            assert_eq!(load.active, slips, "{third} {ratio}");
            assert_eq!(load.value.iter().any(|q| *q != 0.0), slips);
            assert_eq!((load.value.len(), load.tangent.len()), (4, 16));
            let mut summary = [PointSummary::default()];
            law.summary(motion(&table, &u), &mut summary);
            assert_eq!(summary[0].slip_fraction > 0.0, slips);
        }
    }
}
