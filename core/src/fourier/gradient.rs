//! Derivatives of an amplitude in the coefficients of its series.

use super::{Measure, SampleTable, TurningPoint};

/// Gradient of [`super::amplitude`] in the coefficients of `series`. A turning point moves with
/// them, but the series is stationary there: its value changes as if the point stayed. Where two
/// turning points are equally high, one side's derivative; of a series at rest, zero.
#[must_use]
pub fn amplitude_gradient(table: &SampleTable, series: &[f64], measure: Measure) -> Vec<f64> {
    let harmonics = table.harmonics();
    let mut gradient = vec![0.0; harmonics.slots()];
    if measure == Measure::Fundamental {
        let (first, modulus) = (harmonics.offset(), harmonics.fundamental(series));
        if modulus > 0.0 {
            gradient[first] = series[first] / modulus;
            gradient[first + 1] = series[first + 1] / modulus;
        }
        return gradient;
    }
    let mut points = Vec::new();
    table.turning_points(series, &mut points);
    let by_value = |a: &&TurningPoint, b: &&TurningPoint| a.value.total_cmp(&b.value);
    let (Some(high), Some(low)) = (points.iter().max_by(by_value), points.iter().min_by(by_value))
    else {
        // A series that only has a mean, which counts in the largest displacement alone.
        if measure == Measure::Max && harmonics.has_mean() && series[0] != 0.0 {
            gradient[0] = 1.0_f64.copysign(series[0]);
        }
        return gradient;
    };
    let mut basis = gradient.clone();
    let mut add = |point: &TurningPoint, share: f64| {
        harmonics.basis(point.theta, &mut basis);
        gradient.iter_mut().zip(&basis).for_each(|(g, b)| *g += share * b);
    };
    if harmonics.half_wave() || measure == Measure::Max {
        let largest = if high.value >= -low.value { high } else { low };
        add(largest, 1.0_f64.copysign(largest.value));
    } else {
        add(high, 0.5);
        add(low, -0.5);
    }
    gradient
}
