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
fn measure() {
    let beam: Vec<(String, Model, Vec<f64>, Vec<usize>)> = [6.563, 20.313, 31.475, 38.438]
        .iter()
        .map(|&f| (format!("beam {f}"), snecma_beam(f).model(), grid(120.0, 290.0, 86), vec![0, 1]))
        .chain([20.0, 60.0, 120.0, 550.0].iter().map(|&f| {
            (format!("pair {f}"), damped_beams(f), grid(480.0, 700.0, 60), DOFS.to_vec())
        }))
        .collect();
    for (name, model, omega, observe) in beam {
        for h in [5, 9, 15] {
            let exact = solve(&model, fixed(h), &observe, &omega);
            for n in [64, 128, 256, 1024] {
                let start = std::time::Instant::now();
                let s = solve(&model, marched(fixed(h), SampleChoice::Fixed(n)), &observe, &omega);
                let time = start.elapsed().as_secs_f64();
                let mut ratios = Vec::new();
                let mut largest = 0.0_f64;
                for (p, q) in s.points.iter().zip(&exact.points) {
                    if p.status != PointStatus::Converged || q.status != PointStatus::Converged {
                        continue;
                    }
                    for dof in 0..observe.len() {
                        let (truth, size) = distance(p, q, dof);
                        largest = largest.max(truth / size);
                        if truth > 1e-9 * size {
                            ratios.push(p.sampling_error[dof] / truth);
                        }
                    }
                }
                ratios.sort_by(f64::total_cmp);
                if ratios.is_empty() { continue; }
                let m = ratios.len();
                println!("{name} H{h} N{n}: count {m} least {:.2} 1% {:.2} median {:.3} 99% {:.2} most {:.2} largest error {largest:.1e} {time:.2}s solved {}",
                    ratios[0], ratios[m / 100], ratios[m / 2], ratios[m - 1 - m / 100], ratios[m - 1], s.points.iter().filter(|p| p.status == PointStatus::Converged).count());
            }
        }
    }
}
