//! Trigonometric series: the ground floor.

mod gradient;
mod harmonics;
mod instants;
mod interval_sums;
mod lanes;
mod legendre;
mod panel;
mod row_sums;
mod turning_points;
mod unit_circle;

pub use gradient::amplitude_gradient;
pub use harmonics::Harmonics;
pub use instants::Basis;
pub use interval_sums::IntervalSums;
pub(crate) use lanes::{cos_sin, doubled, rotate, sum, SERIES};
pub use lanes::{Lanes, NODES};
pub(crate) use legendre::{gauss_legendre, legendre};
pub use panel::{Interval, Panel};
pub use turning_points::{SampleTable, TurningPoint};

use faer::c64;
use std::f64::consts::TAU;

/// Amplitudes X_0, …, X_highest of motions of so many points, point after point, from even instants of a period,
/// instant after instant; 0 from half as many on as there are instants.
pub(crate) fn sampled_amplitudes(values: &[f64], points: usize, highest: usize) -> Vec<c64> {
    let mut amplitudes = vec![c64::new(0.0, 0.0); points * (highest + 1)];
    let instants = values.len() / points.max(1);
    for (j, instant) in values.chunks_exact(points.max(1)).enumerate() {
        for k in 0..=highest.min((instants / 2).saturating_sub(1)) {
            let share = if k == 0 { 1.0 } else { 2.0 } / instants as f64;
            let turn = TAU * (j * k % instants) as f64 / instants as f64;
            let wave = c64::new(share * turn.cos(), -share * turn.sin());
            for (point, u) in instant.iter().enumerate() {
                amplitudes[point * (highest + 1) + k] += wave * u;
            }
        }
    }
    amplitudes
}

/// Which scalar stands for the size of a periodic motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Half the peak-to-peak range.
    HalfRange,
    /// The largest absolute value.
    Max,
    /// The modulus of the fundamental.
    Fundamental,
}

impl std::str::FromStr for Measure {
    type Err = crate::Error;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        match name {
            "half_range" => Ok(Self::HalfRange),
            "max" => Ok(Self::Max),
            "fundamental" => Ok(Self::Fundamental),
            other => Err(crate::Error::shape(
                "measure",
                "\"half_range\", \"max\" or \"fundamental\"",
                format!("\"{other}\""),
            )),
        }
    }
}

/// Amplitude of the motion `series` in the given measure; extrema are those of the polynomial,
/// not of samples.
#[must_use]
pub fn amplitude(table: &SampleTable, series: &[f64], measure: Measure) -> f64 {
    let harmonics = table.harmonics();
    if measure == Measure::Fundamental {
        return harmonics.fundamental(series);
    }
    let mean = harmonics.mean(series);
    let mut points = Vec::new();
    table.turning_points(series, &mut points);
    let (mut low, mut high) = (mean, mean);
    for point in &points {
        low = low.min(point.value);
        high = high.max(point.value);
    }
    if harmonics.half_wave() {
        high = high.max(-low);
        low = -high;
    }
    match measure {
        Measure::Max => high.max(-low),
        _ => 0.5 * (high - low),
    }
}
