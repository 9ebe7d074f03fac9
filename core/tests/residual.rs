//! What a contact keeps that does not slip in both senses: the rule itself, and the same answer by
//! exact harmonics and by samples.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::Random;
use stickslip_core::contact::{Aft, Closure, ContactLaw, Coulomb, Motion, Residual, SlipLoad};
use stickslip_core::fourier::{Harmonics, SampleTable};

const SAMPLES: usize = 2048;
const FRICTION: f64 = 0.6;
const PRELOAD: f64 = 3.0;

/// A contact whose normal load varies without vanishing, with a past.
struct Case {
    directions: usize,
    law: Box<dyn ContactLaw>,
    stiffness: [f64; 2],
    /// Slider position that its past has left, scaled by k_t.
    rest: f64,
    table: SampleTable,
    displacement: Vec<f64>,
    residual: Residual,
}

impl Case {
    /// Motions that let it stick, or push it in one sense alone.
    fn random(random: &mut Random, directions: usize) -> Self {
        let stiffness = [random.between(0.5, 4.0), random.between(0.5, 2.0)];
        let [k, normal] = stiffness;
        let closure = Closure::Preload(PRELOAD);
        let law = Coulomb::new(directions, FRICTION, k, Some(normal), closure).unwrap();
        let moved: Vec<f64> = (0..=directions).map(|_| random.between(-0.5, 0.5)).collect();
        let traction: Vec<f64> = (0..directions).map(|_| random.between(-1.0, 1.0)).collect();
        let rest = k * moved[0] - traction[0];
        let table = SampleTable::new(Harmonics::new(3, false));
        let slots = table.harmonics().slots();
        let displacement = (0..(directions + 1) * slots).map(|index| {
            let size = if index / slots == directions { 0.6 / normal } else { 0.4 / k };
            size * random.next() / ((index % slots).div_ceil(2).max(1) as f64)
        });
        let displacement = displacement.collect();
        let residual = match random.between(0.0, 3.0) {
            kind if kind < 1.0 => Residual::Centred,
            kind if kind < 2.0 => Residual::FromRest,
            _ => Residual::Value(random.between(-2.5, 2.5)),
        };
        let law = law.with_history(&moved, &traction).unwrap();
        Self { directions, law, stiffness, rest, table, displacement, residual }
    }

    fn sampled(&self, samples: usize) -> Box<dyn ContactLaw> {
        Box::new(Aft::new(self.law.with_scaled_forces(1.0), samples).unwrap())
    }

    fn motion<'a>(&'a self, displacement: &'a [f64]) -> Motion<'a> {
        Motion { table: &self.table, displacement, residual: self.residual }
    }

    fn load(&self, law: &dyn ContactLaw, displacement: &[f64], tangent: bool) -> SlipLoad {
        let mut out = SlipLoad::default();
        law.slip_load(self.motion(displacement), tangent, &mut out);
        out
    }

    /// Whether it slips in no period, or in one sense on the way to that.
    fn sticks(&self) -> bool {
        let mut out = vec![Default::default(); self.directions + 1];
        self.law.summary(self.motion(&self.displacement), &mut out);
        out[0].slip_fraction == 0.0 && out[self.directions].slip_fraction == 0.0
    }

    /// Least and largest of a combination of tangential pull and limit, on a fine grid.
    fn range(&self, by_limit: f64) -> [f64; 2] {
        let slots = self.table.harmonics().slots();
        let (u, v) = self.displacement.split_at(slots);
        let at = |n: usize| {
            let theta = std::f64::consts::TAU * n as f64 / 20_000.0;
            let [u, v] = [u, v].map(|series| self.table.harmonics().jet(series, theta)[0]);
            self.stiffness[0] * u + by_limit * FRICTION * (PRELOAD + self.stiffness[1] * v)
        };
        let fold = |range: [f64; 2], x: f64| [range[0].min(x), range[1].max(x)];
        (0..20_000).map(at).fold([f64::INFINITY, f64::NEG_INFINITY], fold)
    }

    /// Difference between the tangent and the differences that agree with it best: those of short steps err
    /// by rounding, of long ones by their order.
    fn tangent_error(&self, law: &dyn ContactLaw) -> f64 {
        let tangent = self.load(law, &self.displacement, true).tangent;
        let errors = [1e-7, 1e-6, 1e-5].map(|step| self.tangent_error_by(law, &tangent, step));
        errors.into_iter().fold(f64::INFINITY, f64::min)
    }

    fn tangent_error_by(&self, law: &dyn ContactLaw, tangent: &[f64], step: f64) -> f64 {
        let size = self.displacement.len();
        let mut error = 0.0_f64;
        for j in 0..size {
            let moved = |by: f64| {
                let mut moved = self.displacement.clone();
                moved[j] += by;
                self.load(law, &moved, false).value
            };
            let (up, down) = (moved(step), moved(-step));
            for i in 0..size {
                let slope = (up[i] - down[i]) / (2.0 * step);
                let own = tangent.get(i * size + j).copied().unwrap_or(0.0);
                error = error.max((own - slope).abs());
            }
        }
        error / self.stiffness[0].max(self.stiffness[1])
    }
}

/// Planar contacts: the traction at mid-range is the assumed one, or the nearest that Coulomb allows.
#[test]
fn the_slider_is_where_the_rule_puts_it() {
    let mut random = Random(16);
    let (mut inside, mut pushed) = (0, 0);
    for _ in 0..200 {
        let case = Case::random(&mut random, 1);
        let (lower, upper) = (case.range(-1.0)[1], case.range(1.0)[0]);
        if lower > upper {
            continue;
        }
        let [least, largest] = case.range(0.0);
        let wanted = match case.residual {
            Residual::Centred => 0.5 * (least + largest),
            Residual::FromRest => case.rest,
            Residual::Value(force) => 0.5 * (least + largest) - force,
        };
        let expected = wanted.clamp(lower, upper);
        *(if expected == wanted { &mut inside } else { &mut pushed }) += 1;
        let pull = case.stiffness[0] * case.displacement[0];
        for law in [case.law.with_scaled_forces(1.0), case.sampled(SAMPLES)] {
            let found = case.load(law.as_ref(), &case.displacement, false).value[0];
            assert!(
                (found - expected).abs() < 1e-5,
                "{:?} {found} {expected} {pull}",
                case.residual
            );
        }
    }
    assert!(inside > 30 && pushed > 30, "{inside} {pushed}");
}

/// Exact harmonics and samples agree to the error of the samples, which is of second order.
#[test]
fn exact_harmonics_and_samples_keep_the_same() {
    let mut random = Random(1);
    for directions in [1, 2] {
        let mut compared = 0;
        for n in 0..150 {
            let case = Case::random(&mut random, directions);
            if !case.sticks() {
                continue;
            }
            compared += 1;
            let exact = case.load(case.law.as_ref(), &case.displacement, false);
            let sampled = case.load(case.sampled(SAMPLES).as_ref(), &case.displacement, false);
            let apart = exact.value.iter().zip(&sampled.value).map(|(a, b)| (a - b).abs());
            let apart = apart.fold(0.0, f64::max);
            assert!(apart < 2e-5, "{directions}, {n}: {:?} {apart:.1e}", case.residual);
            assert_eq!(exact.active, sampled.active, "{directions}, {n}: {:?}", case.residual);
        }
        assert!(compared > 50, "{compared}");
    }
}

/// Both tangents are those of differences, where a contact keeps what was assumed and where the motion
/// has pushed it; those of the slip equation to 1e-8 in all but one of thirty, and to 3e-6 in these.
#[test]
fn tangents_are_those_of_differences() {
    let mut random = Random(5);
    for directions in [1, 2] {
        let (mut compared, mut close) = (0, 0);
        for n in 0..if directions == 1 { 40 } else { 200 } {
            let case = Case::random(&mut random, directions);
            if !case.sticks() {
                continue;
            }
            let exact = case.tangent_error(case.law.as_ref());
            let most = if directions == 1 { 1e-7 } else { 3e-6 };
            assert!(exact < most, "exact, {directions}, {n}: {:?} {exact:.1e}", case.residual);
            (compared, close) = (compared + 1, close + usize::from(exact < 1e-8));
            let sampled = case.tangent_error(case.sampled(96).as_ref());
            assert!(
                sampled < 1e-7,
                "sampled, {directions}, {n}: {:?} {sampled:.1e}",
                case.residual
            );
        }
        assert!(directions == 1 || 30 * (compared - close) <= compared, "{close} of {compared}");
    }
}
