//! Trigonometric series: layouts, turning points, sums over intervals.
#![allow(clippy::unwrap_used, clippy::panic)]

use stickslip_core::fourier::{Harmonics, IntervalSums, SampleTable, TurningPoint};

fn turning_points(harmonics: Harmonics, series: &[f64]) -> Vec<TurningPoint> {
    let mut points = Vec::new();
    SampleTable::new(harmonics).turning_points(series, &mut points);
    points
}

#[test]
fn a_cosine_turns_at_its_crest_and_trough() {
    let points = turning_points(Harmonics::new(1, false), &[0.5, 2.0, 0.0]);
    assert_eq!(points.len(), 2);
    assert!((points[1].theta - std::f64::consts::PI).abs() < 1e-9);
    assert!((points[0].value - 2.5).abs() < 1e-14 && (points[1].value + 1.5).abs() < 1e-14);
    let half = turning_points(Harmonics::new(1, true), &[2.0, 0.0]);
    assert_eq!(half.len(), 1);
    assert!((half[0].value.abs() - 2.0).abs() < 1e-14);
}

#[test]
fn both_layouts_find_the_same_points() {
    let odd = Harmonics::new(9, true);
    let all = Harmonics::new(9, false);
    let series: Vec<f64> =
        (0..odd.slots()).map(|i| (2.3 * i as f64 + 0.4).sin() / (1.0 + i as f64)).collect();
    let mut full = vec![0.0; all.slots()];
    for &k in odd.oscillating() {
        let (from, to) = (odd.slot(k).unwrap(), all.slot(k).unwrap());
        full[to..to + 2].copy_from_slice(&series[from..from + 2]);
    }
    let half = turning_points(odd, &series);
    let whole = turning_points(all, &full);
    assert_eq!(whole.len(), 2 * half.len());
    for (a, b) in half.iter().zip(&whole) {
        assert!((a.theta - b.theta).abs() < 1e-9 && (a.value - b.value).abs() < 1e-13);
    }
}

#[test]
fn a_pair_between_two_samples_is_found() {
    // The slope cos 2x − (1 − d) cos x, x = θ − shift, is d at x = 0 and has two zeros near it.
    let shift = 0.5 * std::f64::consts::FRAC_PI_2 / 16.0 + 0.3;
    let depth = 1e-4;
    let harmonics = Harmonics::new(4, false);
    let mut series = vec![0.0; harmonics.slots()];
    let mut add = |k: usize, amplitude: f64| {
        let slot = harmonics.slot(k).unwrap();
        let phase = k as f64 * shift;
        series[slot] += -amplitude * phase.sin() / k as f64;
        series[slot + 1] += amplitude * phase.cos() / k as f64;
    };
    add(2, 1.0);
    add(1, -1.0 + depth);
    let points = turning_points(harmonics.clone(), &series);
    let near: Vec<_> = points.iter().filter(|p| (p.theta - shift).abs() < 0.02).collect();
    assert_eq!(near.len(), 2, "{points:?}");
}

#[test]
fn odd_harmonics_skip_the_mean_and_the_even_orders() {
    let odd = Harmonics::new(6, true);
    assert_eq!(odd.orders().collect::<Vec<_>>(), [1, 3, 5]);
    assert_eq!((odd.slots(), odd.slot(3), odd.slot(2), odd.slot(0)), (6, Some(2), None, None));
    let all = Harmonics::new(2, false);
    assert_eq!(all.orders().collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!((all.slots(), all.slot(2), all.slot(3)), (5, Some(3), None));
}

#[test]
fn jet_agrees_with_direct_sums() {
    for half_wave in [true, false] {
        let harmonics = Harmonics::new(7, half_wave);
        let series: Vec<f64> = (0..harmonics.slots()).map(|i| ((3 * i + 1) as f64).sin()).collect();
        let theta = 0.83_f64;
        let [value, slope, curvature] = harmonics.jet(&series, theta);
        let mut expected = [harmonics.mean(&series), 0.0, 0.0];
        for &k in harmonics.oscillating() {
            let slot = harmonics.slot(k).unwrap();
            let (a, b, k) = (series[slot], series[slot + 1], k as f64);
            expected[0] += a * (k * theta).cos() + b * (k * theta).sin();
            expected[1] += k * (b * (k * theta).cos() - a * (k * theta).sin());
            expected[2] -= k * k * (a * (k * theta).cos() + b * (k * theta).sin());
        }
        assert!((value - expected[0]).abs() < 1e-13);
        assert!((slope - expected[1]).abs() < 1e-12);
        assert!((curvature - expected[2]).abs() < 1e-11);
    }
}

#[test]
fn products_agree_with_quadrature() {
    for half_wave in [false, true] {
        let harmonics = Harmonics::new(5, half_wave);
        let size = harmonics.slots();
        let (start, end) = (0.4, 2.9);
        let mut sums = IntervalSums::new(&harmonics);
        sums.add(start, end);
        let mut matrix = vec![vec![0.0; size]; size];
        sums.products(&harmonics, 1.0, |i, j, v| matrix[i][j] = v);
        let samples = 4000;
        let h = (end - start) / samples as f64;
        let mut expected = vec![vec![0.0; size]; size];
        let mut basis = vec![0.0; size];
        for n in 0..samples {
            harmonics.basis(start + (n as f64 + 0.5) * h, &mut basis);
            for (i, a) in basis.iter().enumerate() {
                for (j, b) in basis.iter().enumerate() {
                    expected[i][j] += h * a * b;
                }
            }
        }
        for (got, want) in matrix.iter().flatten().zip(expected.iter().flatten()) {
            assert!((got - want).abs() < 1e-6, "{got} {want}");
        }
    }
}
