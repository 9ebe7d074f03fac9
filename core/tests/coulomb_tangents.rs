//! Tangents of the exact evaluation of Coulomb contacts in random states, against central differences.
//!
//! The forces are smooth as long as no event comes, goes or changes places with another. Differences of
//! falling length are extrapolated (Richardson), from steps on which the events are those of the motion
//! itself; their last change tells how far they can be trusted.
#![allow(clippy::unwrap_used)]

mod common;

use common::damper::Random;
use common::node::{exact, largest, load, random_case, Case};
use std::f64::consts::TAU;
use stickslip_core::contact::{Closure, ContactLaw as _, Coulomb, Motion, Phase, Residual};
use stickslip_core::fourier::{Harmonics, SampleTable};

/// Longest step of the differences, relative to the motion; every further one is shorter by half.
const STEP: f64 = 2e-3;
const HALVINGS: i32 = 16;
/// Angle that is none.
const ROUNDING: f64 = 1e-12;
/// Change by the last extrapolation that needs no other, and that can be trusted.
const ENOUGH: f64 = 1e-11;
const TRUSTED: f64 = 1e-9;

/// Whether a contact is open, sticks or slips.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Doing {
    Open,
    Sticks,
    Slips,
}

fn along<'a>(case: &'a Case, residual: Residual, displacement: &'a [f64]) -> Motion<'a> {
    Motion { residual, table: &case.table, displacement }
}

/// What a contact does over a period, by turns, and the shortest time between two changes.
fn turns(case: &Case, motion: Motion<'_>) -> (Vec<Doing>, f64) {
    let directions = case.law.state_size();
    let doing = |phase: &Phase| {
        let (tangential, normal) = phase.states.split_at(directions);
        match (normal, tangential) {
            (normal, _) if normal.iter().any(|state| state.slips()) => Doing::Open,
            (_, tangential) if tangential.iter().any(|state| state.slips()) => Doing::Slips,
            _ => Doing::Sticks,
        }
    };
    let mut turns: Vec<(f64, Doing)> =
        exact(&case.law).phases(motion).iter().map(|phase| (phase.start, doing(phase))).collect();
    // What rounding leaves between two events that are one.
    let mut ends = turns.iter().map(|(start, _)| *start).collect::<Vec<f64>>();
    ends.rotate_left(1);
    let mut ends = ends.into_iter();
    let only = turns.len() == 1;
    turns.retain(|(start, _)| only || (ends.next().unwrap() - start).rem_euclid(TAU) > ROUNDING);
    turns.dedup_by_key(|(_, doing)| *doing);
    if turns.len() > 1 && turns[0].1 == turns[turns.len() - 1].1 {
        turns.remove(0);
    }
    let ends = turns.iter().skip(1).map(|(start, _)| *start).chain([turns[0].0 + TAU]);
    let shortest = turns.iter().zip(ends).map(|((start, _), end)| end - start).fold(TAU, f64::min);
    // It does not matter where in the period they begin.
    let doings: Vec<Doing> = turns.iter().map(|(_, doing)| *doing).collect();
    let rotated = |n: usize| [&doings[n..], &doings[..n]].concat();
    ((0..doings.len()).map(rotated).min().unwrap(), shortest)
}

/// Largest difference between the tangent and differences, relative to the tangent, and how far the
/// differences can be trusted; nothing where an event meets another one.
fn tangent_error(case: &Case, residual: Residual) -> Option<[f64; 2]> {
    let size = case.displacement.len();
    let tangent = load(exact(&case.law), along(case, residual, &case.displacement), true).tangent;
    let (events, _) = turns(case, along(case, residual, &case.displacement));
    let mut worst = [0.0_f64; 2];
    for j in 0..size {
        let slope = |step: f64| -> Option<Vec<f64>> {
            let moved = [step, -step].map(|by| {
                let mut moved = case.displacement.clone();
                moved[j] += by;
                moved
            });
            let meets = |u: &Vec<f64>| turns(case, along(case, residual, u)).0 == events;
            moved.iter().all(meets).then(|| {
                let [up, down] =
                    moved.map(|u| load(exact(&case.law), along(case, residual, &u), false).value);
                up.iter().zip(&down).map(|(up, down)| (up - down) / (2.0 * step)).collect()
            })
        };
        let scale = largest(&tangent);
        let (change, best) = extrapolated(largest(&case.displacement), scale, &slope)?;
        let error = (0..size).map(|i| (tangent[i * size + j] - best[i]).abs() / scale);
        worst = [error.fold(worst[0], f64::max), worst[1].max(change)];
    }
    Some(worst)
}

/// The slopes at no step, by the extrapolation that changes least by its last step, with this change.
fn extrapolated(
    unit: f64,
    scale: f64,
    slope: &dyn Fn(f64) -> Option<Vec<f64>>,
) -> Option<(f64, Vec<f64>)> {
    let mut best: Option<(f64, Vec<f64>)> = None;
    let mut row: Vec<Vec<f64>> = Vec::new();
    for halving in 0..HALVINGS {
        let Some(slopes) = slope(unit * STEP * 0.5_f64.powi(halving)) else {
            row.clear();
            continue;
        };
        let mut fresh = vec![slopes];
        for (order, wide) in (1..).zip(&row) {
            let fine = &fresh[fresh.len() - 1];
            let pairs = fine.iter().zip(wide);
            let by = 4.0_f64.powi(order) - 1.0;
            let better: Vec<f64> = pairs.map(|(fine, wide)| fine + (fine - wide) / by).collect();
            let change = |other: &[f64]| {
                better.iter().zip(other).map(|(a, b)| (a - b).abs() / scale).fold(0.0, f64::max)
            };
            let change = change(fine).max(change(wide));
            if best.as_ref().is_none_or(|(least, _)| change < *least) {
                best = Some((change, better.clone()));
            }
            fresh.push(better);
        }
        row = fresh;
        if best.as_ref().is_some_and(|(change, _)| *change < ENOUGH) {
            break;
        }
    }
    best
}

/// A contact in space with a motion of one to three harmonics: under constant load, behind a gap, under a
/// preload that may be lost, and under one that is not.
fn in_space(random: &mut Random, n: usize) -> Case {
    let friction = random.between(0.05, 1.2);
    let tangential_stiffness = 10f64.powf(random.between(-0.5, 1.0));
    let stiffness = 10f64.powf(random.between(-0.5, 1.0));
    let (normal, closure) = match n % 4 {
        0 => (None, Closure::Preload(random.between(0.2, 2.0))),
        1 => (Some(stiffness), Closure::Gap(random.between(-1.5, 0.7))),
        2 => (Some(stiffness), Closure::Preload(stiffness * random.between(0.0, 1.0))),
        _ => (Some(stiffness), Closure::Preload(stiffness * random.between(2.0, 4.0))),
    };
    let law = Coulomb::new(2, friction, tangential_stiffness, normal, closure).unwrap();
    let half_wave = n % 8 == 4;
    let highest = if half_wave { 1 + 2 * (n / 8 % 3) } else { 1 + n / 4 % 3 };
    let table = SampleTable::new(Harmonics::new(highest, half_wave));
    let slots = table.harmonics().slots();
    let amplitude = 10f64.powf(random.between(-1.0, 0.7));
    let size = |index: usize| if index / slots == 2 { 1.0 } else { amplitude };
    let displacement =
        (0..law.displacements() * slots).map(|index| size(index) * random.next()).collect();
    Case { law, table, displacement }
}

/// Compares tangents of random contacts and returns what they do, and how many are left out.
fn check(
    seed: u64,
    cases: usize,
    draw: impl Fn(&mut Random, usize) -> Case,
) -> (Vec<Doing>, usize) {
    let mut random = Random(seed);
    let residuals = [Residual::Centred, Residual::FromRest, Residual::Value(0.1)];
    let (mut seen, mut left_out, mut close) = (Vec::new(), 0, 0);
    let mut errors = Vec::new();
    for n in 0..cases {
        let (case, residual) = (draw(&mut random, n), residuals[n % 3]);
        let (doings, shortest) = turns(&case, along(&case, residual, &case.displacement));
        let found = tangent_error(&case, residual);
        let Some([error, _]) = found.filter(|[_, own]| *own < TRUSTED) else {
            println!("{n} left out: {doings:?}, {shortest:.1e} apart");
            left_out += 1;
            continue;
        };
        if error > 1e-8 {
            println!("{n}: {error:.1e} {doings:?}, {shortest:.1e} apart, {:?}", case.law);
        }
        close += usize::from(shortest < 0.02);
        seen.extend(doings);
        errors.push(error);
    }
    errors.sort_by(f64::total_cmp);
    let at = |share: f64| errors[((errors.len() - 1) as f64 * share) as usize];
    println!("{} compared, {close} with events close together, {left_out} left out", errors.len());
    println!("median {:.1e}, 99 % {:.1e}, worst {:.1e}", at(0.5), at(0.99), at(1.0));
    assert!(at(1.0) < 1e-8, "{:?}", &errors[errors.len() * 9 / 10..]);
    assert!(close > cases / 50, "{close} with events close together");
    (seen, left_out)
}

#[test]
fn contacts_in_space_with_few_harmonics() {
    let (seen, left_out) = check(1907, 448, in_space);
    assert!([Doing::Open, Doing::Sticks, Doing::Slips].iter().all(|doing| seen.contains(doing)));
    assert!(left_out <= 2, "{left_out}");
}

#[test]
fn contacts_in_space_with_many_harmonics() {
    let (_, left_out) = check(73, 150, |random, n| random_case(random, 2, 1 + n % 9));
    assert!(left_out <= 2, "{left_out}");
}

#[test]
fn contacts_in_one_direction() {
    let (_, left_out) = check(43, 300, |random, n| random_case(random, 1, 1 + n % 9));
    assert!(left_out <= 5, "{left_out}");
}
