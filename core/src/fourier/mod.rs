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

pub use gradient::amplitude_gradient;
pub use harmonics::Harmonics;
pub use interval_sums::IntervalSums;
pub(crate) use lanes::{cos_sin, doubled, rotate, sum, SERIES};
pub use lanes::{Lanes, NODES};
pub(crate) use legendre::{gauss_legendre, legendre};
pub use panel::{Interval, Panel};
pub use turning_points::{SampleTable, TurningPoint};

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
