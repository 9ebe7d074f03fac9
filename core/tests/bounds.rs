//! Bounds over residual tractions: against random sliders that are computed another way, a grid of
//! sliders, and what theory says of monotone laws.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::Random;
use common::planar::{Pad, Planar};
use faer::Mat;
use stickslip_core::balance::{
    sweep, ForcedBalance, HarmonicChoice, Settings, Solution, Uniqueness,
};
use stickslip_core::contact::{Closure, ContactLaw, Residual};
use stickslip_core::design::bound;
use stickslip_core::fourier::{amplitude, Harmonics, Measure, SampleTable};
use stickslip_core::model::Model;

/// What the search leaves, relative to the amplitude.
const SEARCH: f64 = 1e-5;

/// Three masses of which two rub, each against a plane that its own normal motion presses: where one
/// slips, the traction that the other one keeps shifts its load.
fn rubbing(random: &mut Random) -> Planar {
    let n = 4;
    let springs: Vec<f64> = (0..n).map(|_| random.between(60.0, 250.0)).collect();
    let mass = Mat::from_fn(n, n, |i, j| if i == j { 1.0 + 0.2 * i as f64 } else { 0.0 });
    let mut stiffness = Mat::from_fn(n, n, |i, j| if i == j { springs[i] + 120.0 } else { 0.0 });
    for (i, j) in [(0, 1), (1, 2), (2, 3), (0, 3)] {
        let k = random.between(20.0, 110.0);
        (stiffness[(i, j)], stiffness[(j, i)]) = (-k, -k);
        (stiffness[(i, i)], stiffness[(j, j)]) = (stiffness[(i, i)] + k, stiffness[(j, j)] + k);
    }
    let pads = (0..2)
        .map(|pad| {
            let mut rows = Mat::from_fn(2, n, |_, _| random.between(-0.4, 0.4));
            rows[(0, 2 * pad)] = 1.0;
            rows[(1, 2 * pad + 1)] = 1.0;
            Pad {
                rows,
                friction: random.between(0.3, 0.9),
                tangential: random.between(60.0, 300.0),
                normal: random.between(100.0, 400.0),
                closure: Closure::Preload(random.between(1.0, 4.0)),
            }
        })
        .collect();
    Planar {
        damping: faer::Scale(0.25) * &mass,
        mass,
        stiffness,
        pads,
        loads: vec![
            (0, 1, random.between(0.5, 2.5), 0.0),
            (2, 1, random.between(0.0, 1.5), random.between(-3.0, 3.0)),
            (1, 1, random.between(0.0, 0.8), 1.0),
        ],
    }
}

fn settings(residual: Residual) -> Settings {
    Settings { harmonics: HarmonicChoice::Fixed(5), residual, ..Settings::default() }
}

fn grid() -> Vec<f64> {
    (0..16).map(|i| 8.0 + 0.9 * f64::from(i)).collect()
}

fn curve(model: &Model, residual: Residual, observe: &[usize]) -> Solution {
    let balance = ForcedBalance::new(model, settings(residual), observe).unwrap();
    sweep(balance, &grid()).unwrap()
}

fn bounded(model: &Model, observe: &[usize]) -> Solution {
    let mut solution = curve(model, Residual::Centred, observe);
    let settings = settings(Residual::Centred);
    bound(model, settings, observe, false, &mut solution, &|_| true).unwrap();
    solution
}

/// Half range of the first observed DOF.
fn half_range(solution: &Solution, point: usize) -> f64 {
    let point = &solution.points[point];
    let table = SampleTable::new(Harmonics::new(point.harmonics, false));
    let mut series = vec![0.0; table.harmonics().slots()];
    table.harmonics().write_series(&point.displacement[..=point.harmonics], &mut series);
    amplitude(&table, &series, Measure::HalfRange)
}

/// The model whose sliders begin elsewhere: the laws carry the positions, not the balance.
fn begun_at(system: &Planar, sliders: &[f64]) -> Model {
    let laws = system.pads.iter().zip(sliders).map(|(pad, w)| -> Box<dyn ContactLaw> {
        pad.law().with_history(&[*w, 0.0], &[0.0]).unwrap()
    });
    system.model().with_laws(laws.collect()).unwrap()
}

fn reach(system: &Planar) -> Vec<f64> {
    let of = |pad: &Pad| match pad.closure {
        Closure::Preload(load) => 2.5 * pad.friction * load / pad.tangential,
        Closure::Gap(_) => 0.0,
    };
    system.pads.iter().map(of).collect()
}

#[test]
fn random_residuals_lie_inside() {
    let mut random = Random(7);
    let (mut wide, mut points) = (0, 0);
    for number in 0..4 {
        let system = rubbing(&mut random);
        let model = system.model();
        let found = bounded(&model, &[0]);
        let reach = reach(&system);
        for _ in 0..25 {
            let sliders: Vec<f64> = reach.iter().map(|r| r * random.between(-1.0, 1.0)).collect();
            let other = curve(&begun_at(&system, &sliders), Residual::FromRest, &[0]);
            for (n, point) in found.points.iter().enumerate() {
                if !(point.is_solved() && other.points[n].is_solved()) {
                    continue;
                }
                let bounds = point.bounds.as_ref().unwrap();
                let (low, high) = (bounds.lower[0], bounds.upper[0]);
                let own = half_range(&other, n);
                assert!(
                    own <= high * (1.0 + SEARCH) && own >= low * (1.0 - SEARCH),
                    "{number} {n} {sliders:?}: {own} outside {low} to {high}"
                );
            }
        }
        for point in found.points.iter().filter(|point| point.is_solved()) {
            let bounds = point.bounds.as_ref().unwrap();
            let width = (bounds.upper[0] - bounds.lower[0]) / bounds.upper[0];
            assert_eq!(bounds.unique == Uniqueness::Unique, width == 0.0);
            assert!(!bounds.proved);
            points += 1;
            wide += usize::from(width > 1e-3);
        }
    }
    assert!(10 * wide > points, "{wide} of {points}");
}

#[test]
fn a_search_that_may_cost_nothing_claims_nothing() {
    let model = rubbing(&mut Random(7)).model();
    let mut solution = curve(&model, Residual::Centred, &[0]);
    solution.profile.evaluations = 0;
    bound(&model, settings(Residual::Centred), &[0], false, &mut solution, &|_| true).unwrap();
    let found = solution.points.iter().filter_map(|point| point.bounds.as_ref());
    let words: Vec<Uniqueness> = found.map(|bounds| bounds.unique).collect();
    assert!(words.contains(&Uniqueness::NotDecided), "{words:?}");
    assert!(!words.contains(&Uniqueness::Unique), "{words:?}");
}

#[test]
fn the_interval_is_that_of_a_grid_of_sliders() {
    let mut random = Random(11);
    let mut compared = 0;
    for _ in 0..2 {
        let system = rubbing(&mut random);
        let found = bounded(&system.model(), &[0]);
        let reach = reach(&system);
        let mut extremes = vec![[f64::INFINITY, f64::NEG_INFINITY]; grid().len()];
        for i in 0..9 {
            for j in 0..9 {
                let at = |n: i32, reach: f64| reach * (f64::from(n) / 4.0 - 1.0);
                let sliders = [at(i, reach[0]), at(j, reach[1])];
                let other = curve(&begun_at(&system, &sliders), Residual::FromRest, &[0]);
                for (n, [low, high]) in extremes.iter_mut().enumerate() {
                    if other.points[n].is_solved() {
                        let own = half_range(&other, n);
                        (*low, *high) = (low.min(own), high.max(own));
                    }
                }
            }
        }
        for (point, [low, high]) in found.points.iter().zip(extremes) {
            let Some(bounds) = &point.bounds else { continue };
            assert!(bounds.lower[0] <= low * (1.0 + SEARCH), "{} {low}", bounds.lower[0]);
            assert!(bounds.upper[0] >= high * (1.0 - SEARCH), "{} {high}", bounds.upper[0]);
            compared += usize::from(high > low * 1.01);
        }
    }
    assert!(compared > 0, "{compared}");
}

#[test]
fn bounds_cost_at_most_five_more_curves() {
    let mut random = Random(3);
    let (mut plain, mut whole) = (0, 0);
    for _ in 0..4 {
        let model = rubbing(&mut random).model();
        plain += curve(&model, Residual::Centred, &[0]).profile.evaluations;
        whole += bounded(&model, &[0]).profile.evaluations;
    }
    assert!(whole <= 6 * plain, "{whole} of {plain}");
}
