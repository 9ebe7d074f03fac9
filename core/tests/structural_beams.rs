//! Two beams with the dissertation's structure-like damper (Guillen 1999, section 6.4), converged.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::peak_of;
use common::damper::{damped_beams, DOFS};
use stickslip_core::balance::{sweep, ForcedBalance, HarmonicChoice, Point, PointStatus, Settings};
use stickslip_core::contact::{Aft, ContactLaw, Motion, PointState, Residual, SlipLoad};
use stickslip_core::fourier::{amplitude, Harmonics, Measure, SampleTable};
use stickslip_core::model::Model;
use stickslip_core::motion::{transient, Scheme, TransientSettings};
use stickslip_core::orbit::{orbit_sweep, Orbit, OrbitSettings, PeriodicOrbits};

/// Frequency [rad/s], force [N], largest forces at the contacts [N] and the slip sets.
type Case = (f64, f64, [f64; 4], &'static [&'static [usize]]);

const HISTORIES: [Case; 4] = [
    (250.0, 15.0, [2.6372, 2.8400, 15.0410, 14.8381], &[]),
    (550.0, 35.0, [24.6, 22.2518, 36.1656, 52.3142], &[&[0]]),
    (550.0, 140.0, [24.6, f64::NAN, f64::NAN, f64::NAN], &[&[0]]),
    (550.0, 550.0, [24.6, 100.0, 246.05, 370.65], &[&[0], &[0, 1], &[0, 2], &[0, 1, 2]]),
];

fn settings(harmonics: usize) -> Settings {
    Settings { harmonics: HarmonicChoice::Fixed(harmonics), ..Settings::default() }
}

fn balance(model: &Model, omega: f64, harmonics: usize) -> Point {
    ForcedBalance::new(model, settings(harmonics), &DOFS).unwrap().solve(omega, None).unwrap()
}

fn orbit(model: &Model, omega: f64) -> Orbit {
    let mut orbits = PeriodicOrbits::new(model, OrbitSettings::default(), &DOFS).unwrap();
    orbits.solve(omega, None).unwrap()
}

/// Real coefficients of the contact displacements of a balance.
fn series_of(table: &SampleTable, point: &Point) -> Vec<f64> {
    let mut series = vec![0.0; 4 * table.harmonics().slots()];
    let orders = point.harmonics + 1;
    for (amplitudes, series) in point
        .contact_displacement
        .chunks_exact(orders)
        .zip(series.chunks_exact_mut(table.harmonics().slots()))
    {
        table.harmonics().write_series(amplitudes, series);
    }
    series
}

/// The same motion from another instant on.
fn turned(table: &SampleTable, series: &[f64], phase: f64) -> Vec<f64> {
    let mut turned = series.to_vec();
    for series in turned.chunks_exact_mut(table.harmonics().slots()) {
        for &k in table.harmonics().oscillating() {
            let slot = table.harmonics().slot(k).unwrap();
            let (sin, cos) = (k as f64 * phase).sin_cos();
            let (a, b) = (series[slot], series[slot + 1]);
            (series[slot], series[slot + 1]) = (a * cos + b * sin, b * cos - a * sin);
        }
    }
    turned
}

/// Forces over the period and the slip sets, in order of first appearance, of a balance.
fn history(model: &Model, point: &Point) -> (Vec<f64>, Vec<Vec<usize>>) {
    let table = SampleTable::new(Harmonics::new(point.harmonics, true));
    let series = series_of(&table, point);
    let motion = Motion { table: &table, displacement: &series, residual: Residual::Centred };
    let law = &model.laws()[0];
    let mut sets = Vec::new();
    for phase in law.phases(motion) {
        push_set(&phase.states, &mut sets);
    }
    (law.force_history(motion, 8192), sets)
}

fn push_set(states: &[PointState], sets: &mut Vec<Vec<usize>>) {
    let set: Vec<usize> = (0..states.len()).filter(|&i| states[i] != PointState::Stuck).collect();
    if !set.is_empty() && !sets.contains(&set) {
        sets.push(set);
    }
}

fn peaks(forces: &[f64]) -> [f64; 4] {
    let mut peaks = [0.0_f64; 4];
    for forces in forces.chunks_exact(4) {
        for (peak, f) in peaks.iter_mut().zip(forces) {
            *peak = peak.max(f.abs());
        }
        let sum: f64 = forces.iter().sum();
        let largest = forces.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        assert!(sum.abs() <= 1e-9 * largest, "{forces:?}");
    }
    peaks
}

fn expect_peaks(got: [f64; 4], expected: [f64; 4], tolerance: f64) {
    for (got, expected) in got.into_iter().zip(expected) {
        // The expected ones are rounded to 1e-4 N.
        let error = ((got - expected).abs() - 5.1e-5).max(0.0) / expected;
        assert!(expected.is_nan() || error < tolerance, "{got} {expected}");
    }
}

fn sorted(mut sets: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
    sets.sort();
    sets
}

#[test]
fn natural_frequencies_of_all_eight_configurations() {
    let model = damped_beams(1.0);
    let beam = [159.5927, 901.7589, 2167.5410];
    for (slipping, expected) in [
        (&[][..], [541.2619, 1090.2088, 2026.5922]),
        (&[0], [509.2988, 715.1364, 1511.7374]),
        (&[1], [501.7571, 725.7708, 1639.5211]),
        (&[2], [191.2091, 678.9080, 1358.9952]),
        (&[0, 1], [159.5927, 695.4112, 901.7589]),
        (&[1, 2], [159.5927, 665.8486, 901.7589]),
        (&[0, 2], [159.5927, 547.5404, 901.7589]),
        (&[0, 1, 2], [beam[0], beam[0], beam[1]]),
    ] {
        let points: Vec<(usize, usize)> = slipping.iter().map(|&i| (0, i)).collect();
        let found = model.natural_frequencies(&points).unwrap();
        // The opposed beams share the first mode of a pair that the damper does not reach.
        let found: Vec<f64> = match slipping.len() {
            0 | 1 => found.iter().copied().filter(|w| *w > 160.0 || slipping == [2]).collect(),
            _ => found,
        };
        println!("{slipping:?} {found:?}");
        for expected in expected {
            let nearest =
                found.iter().fold(f64::INFINITY, |m, w| m.min((w / expected - 1.0).abs()));
            assert!(nearest < 1e-6, "{slipping:?}: {expected} not in {found:?}");
        }
    }
}

#[test]
fn forces_and_slip_sets_of_the_four_time_histories() {
    for (omega, force, expected, sets) in HISTORIES {
        let model = damped_beams(force);
        let exact = orbit(&model, omega);
        assert_eq!(exact.response.status, PointStatus::Converged);
        let run = TransientSettings {
            omega,
            periods: 1,
            scheme: Scheme::Exact,
            samples: 4096,
            tolerance: None,
            keep: None,
        };
        let path = transient(&model, &run, Some(&exact.state), &DOFS, &|_| true).unwrap();
        println!("{omega} {force} exact {:?}", peaks(&path.trace.force));
        expect_peaks(peaks(&path.trace.force), expected, 1e-5);
        let expected_sets = sorted(sets.iter().map(|set| set.to_vec()).collect());
        let mut states = vec![PointState::Stuck; 4];
        let mut met = Vec::new();
        for (number, event) in exact.events.iter().chain(&exact.events).enumerate() {
            let at_once = exact.events.iter().any(|e| e.time == event.time && e != event);
            states[event.point] = event.state;
            if !at_once && number >= exact.events.len() {
                push_set(&states, &mut met);
            }
        }
        println!("{met:?}");
        let point = balance(&model, omega, 25);
        assert_eq!(point.status, PointStatus::Converged);
        let (forces, found) = history(&model, &point);
        println!("{omega} {force} H=25 {:?} {found:?} {}", peaks(&forces), point.iterations);
        expect_peaks(peaks(&forces), expected, 1e-3);
        assert_eq!(sorted(found), expected_sets);
        assert_eq!(sorted(met), expected_sets);
    }
}

#[test]
fn the_first_slip_is_met_at_its_load() {
    for (force, slips) in [(21.796, false), (21.798, true)] {
        let model = damped_beams(force);
        let grid: Vec<f64> = (0..=400).map(|i| 538.0 + 0.02 * f64::from(i)).collect();
        let solution =
            sweep(ForcedBalance::new(&model, settings(1), &DOFS).unwrap(), &grid).unwrap();
        let any = solution.points.iter().any(|p| p.contacts.iter().any(|c| c.slip_fraction > 0.0));
        assert_eq!(any, slips, "{force}");
    }
}

/// Amplitudes of the four contacts over a grid.
fn curves(model: &Model, grid: &[f64], harmonics: usize) -> Vec<[f64; 4]> {
    let balance = ForcedBalance::new(model, settings(harmonics), &DOFS).unwrap();
    let solution = sweep(balance, grid).unwrap();
    let table = SampleTable::new(Harmonics::new(harmonics, true));
    solution
        .points
        .iter()
        .map(|point| {
            assert_eq!(point.status, PointStatus::Converged, "{}", point.omega);
            std::array::from_fn(|i| {
                let mut series = vec![0.0; table.harmonics().slots()];
                let own = &point.displacement[i * (harmonics + 1)..(i + 1) * (harmonics + 1)];
                table.harmonics().write_series(own, &mut series);
                amplitude(&table, &series, Measure::HalfRange)
            })
        })
        .collect()
}

#[test]
fn peaks_of_the_frequency_responses_and_sweeps_from_either_side() {
    for (force, expected) in [
        (
            20.0,
            [(1.9184e-5, 541.44), (1.9093e-5, 541.23), (3.0592e-5, 539.43), (2.4787e-5, 542.54)],
        ),
        (
            60.0,
            [(3.1929e-5, 532.85), (3.2890e-5, 531.06), (6.9382e-5, 531.04), (3.1452e-5, 532.92)],
        ),
        (
            120.0,
            [(4.3601e-5, 526.30), (4.6078e-5, 524.96), (1.1256e-4, 524.95), (3.9010e-5, 561.0)],
        ),
    ] {
        let model = damped_beams(force);
        let mut grid: Vec<f64> = (0..=400).map(|i| 500.0 + 0.5 * f64::from(i)).collect();
        let up = curves(&model, &grid, 25);
        grid.reverse();
        let down = curves(&model, &grid, 25);
        for (up, down) in up.iter().zip(down.iter().rev()) {
            for (up, down) in up.iter().zip(down) {
                assert!((up / down - 1.0).abs() < 1e-7, "{up} {down}");
            }
        }
        grid.reverse();
        for i in 0..4 {
            // Towards either end the response rises to other resonances.
            let near = |n: &usize| (grid[*n] - expected[i].1).abs() < 8.0;
            let (at, _) = (0..grid.len())
                .filter(near)
                .map(|n| (grid[n], up[n][i]))
                .fold((0.0, 0.0), |best, next| if next.1 > best.1 { next } else { best });
            let (expected, omega) = expected[i];
            let span = (at - 1.0, at + 1.0);
            let (at, height) = peak_of(&model, settings(25), DOFS[i], Measure::HalfRange, span);
            println!("{force} {i}: {height:e} @ {at} ({expected:e} @ {omega})");
            assert!((height / expected - 1.0).abs() < 2e-3, "{height} {expected}");
            assert!((at - omega).abs() < 1.0, "{at} {omega}");
        }
    }
}

/// At every 2 rad/s of Figs 6.8-6.11, without a neighbour, an exact orbit or a homotopy to help.
#[test]
fn newton_s_method_solves_every_point_from_the_linear_solution() {
    let mut most = 0;
    for force in [20.0, 30.0, 40.0, 50.0, 55.0, 60.0, 70.0, 80.0, 90.0, 100.0, 110.0, 120.0] {
        let model = damped_beams(force);
        for harmonics in [5, 9, 15, 25] {
            for i in 0..=100 {
                let omega = 500.0 + 2.0 * f64::from(i);
                let balance = ForcedBalance::new(&model, settings(harmonics), &[]).unwrap();
                let solution = sweep(balance, &[omega]).unwrap();
                let case = format!("{force} N, H = {harmonics}, {omega} rad/s");
                assert_eq!(solution.points[0].status, PointStatus::Converged, "{case}");
                assert_eq!(solution.profile.homotopies, 0, "{case}");
                most = most.max(solution.points[0].iterations);
            }
        }
    }
    println!("at most {most} iterations");
}

#[test]
fn the_increment_is_of_second_order_in_the_samples() {
    for (omega, force, ..) in &HISTORIES[1..] {
        let model = damped_beams(*force);
        let point = balance(&model, *omega, 9);
        let table = SampleTable::new(Harmonics::new(9, true));
        let series = series_of(&table, &point);
        let law = &model.laws()[0];
        let load = |law: &dyn ContactLaw, series: &[f64]| {
            let mut load = SlipLoad::default();
            let motion =
                Motion { table: &table, displacement: series, residual: Residual::Centred };
            law.slip_load(motion, false, &mut load);
            load.value
        };
        // Where in a step a transition falls makes single errors uneven: means of several phases.
        let counts = [128, 256, 512, 1024, 2048, 4096];
        let errors: Vec<f64> = counts
            .iter()
            .map(|&samples| {
                let marched = Aft::new(law.with_scaled_stiffness(1.0), samples).unwrap();
                let error = |phase: f64| {
                    let turned = turned(&table, &series, phase);
                    let (rough, exact) = (load(&marched, &turned), load(law.as_ref(), &turned));
                    let size = exact.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
                    rough.iter().zip(&exact).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / size
                };
                (0..16).map(|i| error(0.37 * f64::from(i))).sum::<f64>() / 16.0
            })
            .collect();
        let x: Vec<f64> = counts.iter().map(|n| f64::from(*n as u32).log2()).collect();
        let y: Vec<f64> = errors.iter().map(|e| e.log2()).collect();
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        let (mx, my) = (mean(&x), mean(&y));
        let slope: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum::<f64>()
            / x.iter().map(|x| (x - mx).powi(2)).sum::<f64>();
        println!("{force} N: order {:.2}, {errors:?}", -slope);
        assert!((1.7..2.3).contains(&-slope), "{force} N: {slope} {errors:?}");
    }
}

#[test]
fn exact_orbits_over_frequency_judge_the_balance() {
    let model = damped_beams(120.0);
    let grid: Vec<f64> = (0..=20).map(|i| 505.0 + 9.0 * f64::from(i)).collect();
    let orbits = PeriodicOrbits::new(&model, OrbitSettings::default(), &DOFS).unwrap();
    let exact = orbit_sweep(orbits, &grid).unwrap();
    for orbit in &exact.points {
        assert_eq!(orbit.response.status, PointStatus::Converged, "{}", orbit.response.omega);
        // Passive: stable.
        assert!(orbit.multipliers[orbit.neutral..].iter().all(|m| m.norm() < 1.0));
        let point = balance(&model, orbit.response.omega, 35);
        for i in 0..4 {
            let (a, b) = (orbit.response.displacement[i * 33 + 1], point.displacement[i * 36 + 1]);
            assert!((a - b).norm() < 3e-3 * a.norm(), "{} {i}: {a} {b}", orbit.response.omega);
        }
        let lost: f64 = orbit.response.contacts.iter().map(|c| c.dissipation).sum();
        assert!((orbit.work - orbit.viscous - lost).abs() < 1e-8 * orbit.work);
    }
}
