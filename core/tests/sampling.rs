//! The sampling error of marched balances: its estimate against the truth, and the number of
//! samples that it chooses.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::{damped_beams, DOFS};
use common::snecma_beam;
use stickslip_core::balance::{
    sweep, Evaluation, ForcedBalance, HarmonicChoice, Point, PointStatus, SampleChoice, Settings,
    Solution,
};
use stickslip_core::model::Model;

fn fixed(highest: usize) -> Settings {
    Settings { harmonics: HarmonicChoice::Fixed(highest), ..Settings::default() }
}

fn marched(settings: Settings, samples: SampleChoice) -> Settings {
    Settings { evaluation: Evaluation::Marched(samples), ..settings }
}

fn grid(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

fn solve(model: &Model, settings: Settings, observe: &[usize], omega: &[f64]) -> Solution {
    sweep(ForcedBalance::new(model, settings, observe).unwrap(), omega).unwrap()
}

/// Sum over harmonics of the distance of one DOF from that of another solution, and the size of
/// the latter.
fn distance(one: &Point, other: &Point, dof: usize) -> (f64, f64) {
    let series = |p: &Point, k: usize| {
        let zero = faer::c64::new(0.0, 0.0);
        if k <= p.harmonics { p.displacement[dof * (p.harmonics + 1) + k] } else { zero }
    };
    let orders = 0..=one.harmonics.max(other.harmonics);
    let far = orders.map(|k| (series(one, k) - series(other, k)).norm()).sum();
    (far, series(other, 1).norm())
}

#[test]
fn automatic() {
    for (name, model, omega, observe) in [6.563, 20.313, 31.475, 38.438]
        .iter()
        .map(|&f| (format!("beam {f}"), snecma_beam(f).model(), grid(20.0, 350.0, 200), vec![0, 1]))
        .chain([20.0, 60.0, 120.0, 550.0].iter().map(|&f| {
            (format!("pair {f}"), damped_beams(f), grid(480.0, 700.0, 100), DOFS.to_vec())
        })) {
        for highest in [Some(9), None] {
            for tolerance in [1e-2, 1e-3, 1e-4] {
                let base = Settings { tolerance, ..Settings::default() };
                let base = highest.map_or(base, |h| Settings { harmonics: HarmonicChoice::Fixed(h), ..base });
                let clock = std::time::Instant::now();
                let s = solve(&model, marched(base, SampleChoice::Auto), &observe, &omega);
                let time = clock.elapsed().as_secs_f64();
                let exact = match highest {
                    Some(_) => solve(&model, base, &observe, &omega),
                    None => solve(&model, fixed(121), &observe, &omega),
                };
                let clock = std::time::Instant::now();
                let d = solve(&model, base, &observe, &omega);
                let direct = clock.elapsed().as_secs_f64();
                let mut n: Vec<usize> = s.points.iter().filter_map(|p| p.samples).collect();
                n.sort();
                let mut worst = [0.0_f64; 2];
                let mut over = [0; 2];
                for (run, s) in [&s, &d].iter().enumerate() {
                for (p, q) in s.points.iter().zip(&exact.points) {
                    for dof in 0..observe.len() {
                        let (t, size) = distance(p, q, dof);
                        let e = t / size;
                        worst[run] = worst[run].max(e);
                        over[run] += usize::from(e > tolerance);
                    }
                }
                }
                let not = s.points.iter().filter(|p| p.status != PointStatus::Converged).count();
                println!("{name} {highest:?} tol {tolerance:e}: worst {:.1e} {:.1e} over {over:?} samples {} median {} to {} not converged {not} H {:?} iterations {} time {time:.3} direct {direct:.3}", worst[0], worst[1], n[0], n[n.len() / 2], n[n.len() - 1], [&s, &d].map(|s| s.points.iter().map(|p| p.harmonics).max().unwrap()), s.points.iter().map(|p| p.iterations).sum::<usize>());
            }
        }
    }
}
