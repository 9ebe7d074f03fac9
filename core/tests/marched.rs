//! The marched evaluation: exact tangents of the discrete march, second order towards the closed
//! form, laws of several coupled points.

#![allow(clippy::unwrap_used)]

mod common;

use common::coupled::{Coupled, SLIP_FORCE, STIFFNESS};
use common::tangents::{load, series, table_of, tangent_error, ONCE, STATES};
use faer::{mat, Mat};
use stickslip_core::contact::{
    Aft, BoucWen, ContactLaw, HarmonicForce, Jenkins, Motion, PointSummary, Residual,
    ReturnMapJacobian, Slider, SlipElement as _, SlipLoad,
};
use stickslip_core::fourier::{Harmonics, SampleTable};

fn jenkins() -> Box<dyn ContactLaw> {
    Box::new(Jenkins::new(STIFFNESS, SLIP_FORCE).unwrap())
}

fn marched(samples: usize) -> Aft<Box<dyn ContactLaw>> {
    Aft::new(jenkins(), samples).unwrap()
}

#[test]
fn parameter_slopes_approach_those_of_the_closed_form() {
    let table = SampleTable::new(Harmonics::new(7, true));
    let series = [0.9, 0.2, 0.05, -0.04, 0.02, 0.01, 0.0, 0.0];
    let motion = Motion { table: &table, displacement: &series, residual: Residual::Centred };
    let mut slopes = [[0.0; 8]; 2];
    for parameter in 0..2 {
        jenkins().parameter_slope(motion, parameter, &mut slopes[0]);
        marched(4096).parameter_slope(motion, parameter, &mut slopes[1]);
        let size = slopes[0].iter().map(|s| s.abs()).fold(0.0, f64::max);
        let pairs = slopes[0].iter().zip(&slopes[1]);
        let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(size > 0.0 && error < 1e-3 * size, "{parameter}: {error:e} of {size:e}");
    }
}

/// However little force the slip limit of a contact is: where its stiffness begins, it holds what a spring holds.
#[test]
fn a_stiffness_of_zero_is_varied_by_a_step_of_its_scale() {
    let table = SampleTable::new(Harmonics::new(3, true));
    let displacement = [0.9, 0.2, 0.05, -0.04];
    for (units, limit) in [(1.0, 1e-9), (1e-3, 1e6)] {
        let displacement = displacement.map(|u| units * u);
        let motion =
            Motion { table: &table, displacement: &displacement, residual: Residual::Centred };
        let law = Box::new(BoucWen::new(0.0, limit, 1.0, 0.5).unwrap());
        let mut slope = [f64::NAN; 4];
        Aft::new(law, 512).unwrap().parameter_slope(motion, 0, &mut slope);
        let off = slope.iter().zip(&displacement).map(|(own, u)| (own - u).abs());
        assert!(off.fold(0.0, f64::max) < 1e-4 * units, "{slope:?} {displacement:?}");
    }
}

#[test]
fn tangents_in_every_contact_state() {
    for samples in [64, 258] {
        let law = marched(samples);
        for (name, harmonics, terms, residual) in STATES {
            let table = &table_of(harmonics);
            let u = series(table, terms);
            let error = tangent_error(&law, table, &u, residual);
            assert!(error < 1e-6, "{name}, {samples} samples: {error:.2e}");
            let states = [load(&law, table, &u, residual), load(&*jenkins(), table, &u, residual)];
            assert_eq!(states[0].active, states[1].active, "{name}");
        }
        let frictionless = Aft::new(Box::new(Jenkins::new(STIFFNESS, 0.0).unwrap()), samples);
        let odd = table_of((7, true));
        let u = series(&odd, ONCE);
        assert!(tangent_error(&frictionless.unwrap(), &odd, &u, Residual::Centred) < 1e-9);
    }
}

#[test]
fn coupled_points_keep_their_history_in_the_tangent() {
    let law = Aft::new(Box::new(Coupled::new()), 128).unwrap();
    for half_wave in [true, false] {
        let table = SampleTable::new(Harmonics::new(5, half_wave));
        for scale in [0.15, 0.6, 4.0] {
            let one = series(&table, &[(0, 0.1, 0.0), (1, scale, 0.3 * scale), (3, 0.1, 0.05)]);
            let two = series(&table, &[(1, -0.4 * scale, scale), (2, 0.2, 0.1), (5, 0.0, 0.07)]);
            let u = [one.clone(), two.clone()].concat();
            let got = load(&law, &table, &u, Residual::Centred);
            assert_eq!(got.active, scale > 0.2);
            let error = tangent_error(&law, &table, &u, Residual::Centred);
            assert!(error < 1e-6, "{half_wave}, {scale}: {error:.2e}");
            if !got.active {
                continue;
            }
            // The same two elements one by one, each in its own coordinate. Without symmetry a
            // coordinate that never slips holds another mean.
            let t = mat![[1.0, -0.6], [0.3, 0.9]];
            let element = |i: usize, k, f| {
                let v: Vec<f64> =
                    one.iter().zip(&two).map(|(a, b)| t[(i, 0)] * a + t[(i, 1)] * b).collect();
                let law = Aft::new(Box::new(Jenkins::new(k, f).unwrap()), 128).unwrap();
                load(&law, &table, &v, Residual::FromRest).value
            };
            let own = [element(0, STIFFNESS, SLIP_FORCE), element(1, 1.3, 0.7)];
            let slots = one.len();
            for (i, value) in got.value.chunks_exact(slots).enumerate() {
                for (value, (a, b)) in value.iter().zip(own[0].iter().zip(&own[1])) {
                    assert!((value - t[(0, i)] * a - t[(1, i)] * b).abs() < 1e-12);
                }
            }
        }
    }
}

/// Root mean square over many phases of the distance to the closed form: the place of an event
/// between two samples is as good as random.
fn distance(samples: usize, half_wave: bool) -> f64 {
    let (law, exact) = (marched(samples), jenkins());
    let table = SampleTable::new(Harmonics::new(5, half_wave));
    let mut sum = 0.0;
    for n in 0..40 {
        let phase = 0.1571 * f64::from(n);
        let term =
            |k: usize, a: f64| (k, a * (k as f64 * phase).cos(), a * (k as f64 * phase).sin());
        let u = series(&table, &[(0, 0.3, 0.0), term(1, 1.4), term(2, 0.3), term(3, 0.5)]);
        let [a, b] = [&law as &dyn ContactLaw, &*exact]
            .map(|law| load(law, &table, &u, Residual::Centred).value);
        sum += a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    }
    (sum / 40.0).sqrt()
}

#[test]
fn the_march_converges_to_the_closed_form_at_second_order() {
    for half_wave in [true, false] {
        let (coarse, fine) = (distance(64, half_wave), distance(1024, half_wave));
        let rate = (coarse / fine).log2() / 4.0;
        assert!((rate - 2.0).abs() < 0.1, "{rate}");
        assert!(fine < 1e-4 * SLIP_FORCE, "{fine:e}");
    }
}

#[test]
fn histories_and_summaries_converge_too() {
    for half_wave in [true, false] {
        let table = SampleTable::new(Harmonics::new(5, half_wave));
        for u in [
            series(&table, &[(0, 0.3, 0.0), (1, 1.4, 0.2), (2, 0.3, 0.1), (3, 0.2, 0.5)]),
            series(&table, &[(0, 0.1, 0.0), (1, 0.2, 0.1), (2, 0.05, 0.0)]),
        ] {
            let motion = Motion { table: &table, displacement: &u, residual: Residual::FromRest };
            let (law, exact) = (marched(4096), jenkins());
            let (a, b) = (law.force_history(motion, 300), exact.force_history(motion, 300));
            for (a, b) in a.iter().zip(&b) {
                assert!((a - b).abs() < 2e-5 && a.abs() <= SLIP_FORCE, "{a} {b}");
            }
            let mut summaries = [[PointSummary::default()]; 2];
            law.summary(motion, &mut summaries[0]);
            exact.summary(motion, &mut summaries[1]);
            let [[a], [b]] = summaries;
            assert!((a.slip_fraction - b.slip_fraction).abs() < 1e-3, "{a:?} {b:?}");
            assert!(a.dissipation >= 0.0);
            assert!((a.dissipation - b.dissipation).abs() <= 1e-5 * b.dissipation, "{a:?} {b:?}");
        }
    }
}

/// The slip load passes from a stuck motion to a slipping one without a jump.
#[test]
fn the_onset_of_slip_is_continuous() {
    let table = SampleTable::new(Harmonics::new(4, false));
    let law = marched(96);
    let shape = [(0, 0.4, 0.0), (1, 0.5, 0.1), (2, 0.12, -0.07)];
    let at = |scale: f64| {
        let terms =
            shape.map(|(k, a, b)| if k == 0 { (k, a, b) } else { (k, scale * a, scale * b) });
        load(&law, &table, &series(&table, &terms), Residual::Centred)
    };
    let (mut stuck, mut slipping) = (0.5, 2.0);
    let mean_alone = |load: &SlipLoad| load.value[1..].iter().all(|q| *q == 0.0);
    assert!(mean_alone(&at(stuck)) && !mean_alone(&at(slipping)));
    for _ in 0..45 {
        let middle = 0.5 * (stuck + slipping);
        if mean_alone(&at(middle)) {
            stuck = middle;
        } else {
            slipping = middle;
        }
    }
    for (a, b) in at(stuck).value.iter().zip(&at(slipping).value) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

/// A slider beside a spring that acts beyond a gap alone: its force departs from that of the stuck
/// contact without slip, and not by its state.
#[derive(Debug, Clone, Copy)]
struct Rubbing {
    slider: Slider,
    spring: f64,
    gap: f64,
}

impl ContactLaw for Rubbing {
    fn name(&self) -> &'static str {
        "rubbing"
    }

    fn displacements(&self) -> usize {
        1
    }

    fn state_size(&self) -> usize {
        1
    }

    fn stiffness(&self) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| self.slider.stiffness + self.spring)
    }

    fn state_stiffness(&self) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| self.slider.stiffness)
    }

    fn is_odd(&self) -> bool {
        false
    }

    fn is_monotone(&self) -> bool {
        true
    }

    fn limits(&self) -> Vec<f64> {
        vec![f64::INFINITY]
    }

    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: Option<&mut ReturnMapJacobian>,
    ) {
        let mut sticks = [0.0];
        self.slider.increment(before, after, state, Some(&mut sticks));
        let touches = f64::from(u8::from(after[0] > self.gap));
        force[0] = state[0] + touches * self.spring * (after[0] - self.gap);
        let Some(jacobian) = jacobian else { return };
        jacobian.reset(1, 1);
        jacobian.by_state[0] = sticks[0];
        jacobian.by_after[0] = sticks[0] * self.slider.stiffness;
        jacobian.by_before[0] = -jacobian.by_after[0];
        jacobian.force_by_state[0] = 1.0;
        jacobian.force_by_after[0] = touches * self.spring;
        jacobian.slipping[0] = 1.0 - sticks[0];
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        let stiffness = share * self.slider.stiffness;
        Box::new(Self {
            slider: Slider { stiffness, ..self.slider },
            spring: share * self.spring,
            gap: self.gap,
        })
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        let slip_force = factor * self.slider.slip_force;
        Box::new(Self {
            slider: Slider { slip_force, ..self.slider },
            gap: factor * self.gap,
            ..*self
        })
    }
}

#[test]
fn forces_that_depart_without_slip_have_their_load_and_tangent() {
    let table = SampleTable::new(Harmonics::new(5, false));
    let u: Vec<f64> =
        (0..table.harmonics().slots()).map(|i| (1.3 * i as f64 + 0.4).sin()).collect();
    // Slipping, and stuck for good.
    for slip_force in [0.4, f64::INFINITY] {
        let slider = Slider::new(STIFFNESS, slip_force).unwrap();
        let law = Rubbing { slider, spring: 0.7 * STIFFNESS, gap: 0.35 };
        let error = tangent_error(&law, &table, &u, Residual::Centred);
        // Samples that come to touch between two differences are few.
        assert!(error < 2e-3, "{slip_force}: {error:e}");
        let found = load(&law, &table, &u, Residual::Centred);
        assert!(found.active && found.value.iter().any(|q| q.abs() > 0.1));
    }
}
