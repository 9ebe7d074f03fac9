//! Turning points of a trigonometric series: bracketed on samples, then located exactly.

use super::instants::{Basis, Instants};
use super::row_sums::{padded, RowSums};
use super::unit_circle::unit_circle;
use super::Harmonics;
use pulp::NullaryFnOnce;
use std::sync::Arc;

/// Samples per period and harmonic on which turning points are bracketed. A polynomial of degree
/// H has at most 2H turning points, so that 16H samples keep them apart by eight on average.
const SAMPLES_PER_HARMONIC: usize = 64;

/// Samples that are looked at together.
const BLOCK: usize = 32;

/// Distance of the samples of [`SampleTable::jets`] on that grid, and of all samples of a coarse table.
const COARSER: usize = 4;

/// Angles closer than this are the same.
const ROUNDING: f64 = 1e-12;

/// An angle where the series turns, and its value there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurningPoint {
    /// Angle θ = ωt.
    pub theta: f64,
    /// Value of the series.
    pub value: f64,
}

/// Cosines and sines on a quarter of the period, from which a series' slope on the whole grid
/// follows by reflection.
#[derive(Debug, Clone)]
pub struct SampleTable {
    harmonics: Harmonics,
    /// Intervals of a quarter of the period.
    quarter: usize,
    /// How many of them lie between two samples of [`SampleTable::jets`].
    stride: usize,
    cos: Vec<f64>,
    sin: Vec<f64>,
    instants: Instants,
}

impl SampleTable {
    /// The table of a set of harmonics.
    #[must_use]
    pub fn new(harmonics: Harmonics) -> Self {
        let resolved = harmonics.highest();
        Self::on_grid(harmonics, resolved, COARSER)
    }

    /// The table of motions that have hardly anything above the harmonic `resolved` and need not be followed to the last
    /// digit, on a quarter of the samples: it brackets turning points that are no closer than the harmonics usually have
    /// them, and takes a quarter of the effort.
    #[must_use]
    pub fn coarse_up_to(resolved: usize, harmonics: Harmonics) -> Self {
        Self::on_grid(harmonics, resolved, 1)
    }

    fn on_grid(harmonics: Harmonics, resolved: usize, stride: usize) -> Self {
        let quarter = stride * (SAMPLES_PER_HARMONIC / COARSER * resolved.max(4)).div_ceil(4);
        // The angles of all orders are multiples of the same step.
        let count = 4 * quarter;
        let unit = unit_circle(count);
        let row = padded(quarter + 1);
        let size = row * harmonics.oscillating().len();
        let (mut cos, mut sin) = (vec![0.0; size], vec![0.0; size]);
        let rows = cos.chunks_exact_mut(row).zip(sin.chunks_exact_mut(row));
        for (&order, (cos, sin)) in harmonics.oscillating().iter().zip(rows) {
            let (mut at, ahead) = (0, order % count);
            for (cos, sin) in cos.iter_mut().zip(sin) {
                (*sin, *cos) = unit[at];
                // A remainder would take most of the time.
                at += ahead;
                if at >= count {
                    at -= count;
                }
            }
        }
        Self { harmonics, quarter, stride, cos, sin, instants: Instants::default() }
    }

    /// The basis at the first `count` of `samples` equidistant instants of a period, an even number.
    #[must_use]
    pub fn basis(&self, samples: usize, count: usize) -> Arc<Basis> {
        self.instants.basis(&self.harmonics, samples, count)
    }

    /// The harmonics of the table.
    #[must_use]
    pub fn harmonics(&self) -> &Harmonics {
        &self.harmonics
    }

    /// Finds the turning points in `[0, span)` (half a period under half-wave symmetry), in
    /// ascending order.
    pub fn turning_points(&self, series: &[f64], points: &mut Vec<TurningPoint>) {
        self.turning_points_by(series, self.slopes(series), points);
    }

    /// The same of a series whose [`SampleTable::slopes`] are known.
    pub(crate) fn turning_points_by(
        &self,
        series: &[f64],
        slope: Vec<f64>,
        points: &mut Vec<TurningPoint>,
    ) {
        points.clear();
        let mirrored = self.harmonics.half_wave();
        let slope = self.with_seam(slope);
        let step = std::f64::consts::FRAC_PI_2 / self.quarter as f64;
        let last = slope.len() - 2;
        for block in (0..last).step_by(BLOCK) {
            if !may_turn(&slope[block..(block + BLOCK + 2).min(slope.len())]) {
                continue;
            }
            for i in block..(block + BLOCK).min(last) {
                let [here, next, after] = [slope[i], slope[i + 1], slope[i + 2]];
                let (left, right) = (i as f64 * step, (i + 1) as f64 * step);
                if (here > 0.0) != (next > 0.0) {
                    let guess = left + step * zero_between([here, next, after]);
                    points.push(self.locate(series, left, right, here > 0.0, guess));
                } else if dips(here, next, after) {
                    let bracket = [left, right + step];
                    self.push_hidden_pair(series, [here, next, after], bracket, points);
                }
            }
        }
        let span = self.harmonics.span();
        for point in points.iter_mut().filter(|p| p.theta >= span) {
            // A root in the last bracket may round up to the span, which is the mirrored start.
            point.theta -= span;
            if mirrored {
                point.value = -point.value;
            }
        }
        points.sort_by(|a, b| a.theta.total_cmp(&b.theta));
    }

    /// Slope of a series on the grid of `[0, span)`.
    pub(crate) fn slopes(&self, series: &[f64]) -> Vec<f64> {
        self.sampled(series, 1, |k, a, b| (k * b, -k * a))
    }

    /// Slopes on the grid and at the first two points beyond, no sample exactly zero at the seam, so
    /// that its mirror image has the other sign.
    fn with_seam(&self, mut slope: Vec<f64>) -> Vec<f64> {
        let sign = if self.harmonics.half_wave() { -1.0 } else { 1.0 };
        for slope in slope.iter_mut().take(2).filter(|slope| **slope == 0.0) {
            *slope = -f64::MIN_POSITIVE;
        }
        slope.extend([sign * slope[0], sign * slope[1]]);
        slope
    }

    /// Number of samples of [`SampleTable::jets`] over the span.
    #[must_use]
    pub fn coarse_samples(&self) -> usize {
        self.coarse_quarter() * if self.harmonics.half_wave() { 2 } else { 4 }
    }

    fn coarse_quarter(&self) -> usize {
        self.quarter / self.stride
    }

    /// Values, slopes and curvatures of a series at equidistant angles of `[0, span)`, a quarter
    /// as many as turning points are bracketed on.
    #[must_use]
    pub fn jets(&self, series: &[f64]) -> [Vec<f64>; 3] {
        let mut value = self.sampled(series, self.stride, |_, a, b| (a, b));
        let mean = self.harmonics.mean(series);
        value.iter_mut().for_each(|value| *value += mean);
        let slope = self.sampled(series, self.stride, |k, a, b| (k * b, -k * a));
        let curvature = self.sampled(series, self.stride, |k, a, b| (-k * k * a, -k * k * b));
        [value, slope, curvature]
    }

    /// Sum of `c cos kθ + s sin kθ` on every `stride`-th point of the grid of `[0, span)`, with
    /// (c, s) made of order and coefficients of each harmonic.
    fn sampled(
        &self,
        series: &[f64],
        stride: usize,
        of: impl Fn(f64, f64, f64) -> (f64, f64),
    ) -> Vec<f64> {
        let (all, q) = (padded(self.quarter + 1), self.quarter / stride);
        // Even and odd orders apart: they reflect with opposite sign about π/2.
        let length = padded(q + 1);
        let sums = |parity: usize| -> Vec<f64> {
            let mut factors = Vec::with_capacity(self.harmonics.oscillating().len());
            for (index, &order) in self.harmonics.oscillating().iter().enumerate() {
                if order % 2 == parity {
                    let slot = self.harmonics.offset() + 2 * index;
                    let (of_cos, of_sin) = of(order as f64, series[slot], series[slot + 1]);
                    if of_cos != 0.0 || of_sin != 0.0 {
                        factors.push((index * all, [of_cos, of_sin]));
                    }
                }
            }
            let mut sums = vec![0.0; 2 * length];
            let (cosines, sines) = sums.split_at_mut(length);
            if stride == 1 {
                let tables = [&self.cos[..], &self.sin];
                let of_rows = RowSums { tables, rows: &factors, sums: [cosines, sines] };
                pulp::Arch::new().dispatch(of_rows);
                return sums;
            }
            for (first, factors) in factors {
                for (sum, row, factor) in
                    [(&mut *cosines, &self.cos, factors[0]), (&mut *sines, &self.sin, factors[1])]
                {
                    let row = row[first..first + all].iter().step_by(stride);
                    sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += factor * value);
                }
            }
            sums
        };
        let odd = sums(1);
        let [odd_cos, odd_sin] = halves(&odd, length);
        let half_wave = self.harmonics.half_wave();
        // Room for the seam.
        let count = if half_wave { 2 * q } else { 4 * q } + 1;
        let mut out = Vec::with_capacity(count + 2);
        out.resize(count, 0.0);
        if half_wave {
            for i in 0..=q {
                out[i] = odd_cos[i] + odd_sin[i];
                out[2 * q - i] = odd_sin[i] - odd_cos[i];
            }
            out[q] = odd_cos[q] + odd_sin[q];
        } else {
            let even = sums(0);
            let [even_cos, even_sin] = halves(&even, length);
            for i in 0..=q {
                out[2 * q - i] = even_cos[i] - odd_cos[i] - even_sin[i] + odd_sin[i];
                out[2 * q + i] = even_cos[i] - odd_cos[i] + even_sin[i] - odd_sin[i];
                out[4 * q - i] = even_cos[i] + odd_cos[i] - even_sin[i] - odd_sin[i];
            }
            for i in 0..=q {
                out[i] = even_cos[i] + odd_cos[i] + even_sin[i] + odd_sin[i];
            }
        }
        // The last one repeats the first, or its mirror image.
        out.pop();
        out
    }

    /// Looks for two turning points between samples of equal sign: where the slope comes close to
    /// zero, its extremum decides.
    fn push_hidden_pair(
        &self,
        series: &[f64],
        slope: [f64; 3],
        bracket: [f64; 2],
        points: &mut Vec<TurningPoint>,
    ) {
        let [before, here, after] = slope.map(f64::abs);
        let bend = before - 2.0 * here + after;
        if bend <= 0.0 {
            return;
        }
        let vertex = here - (after - before).powi(2) / (8.0 * bend);
        if vertex > 0.25 * here {
            return;
        }
        let Some(theta) = self.slope_extremum(series, bracket) else {
            return;
        };
        let rising = slope[1] > 0.0;
        if (self.harmonics.jet(series, theta)[1] > 0.0) != rising {
            let middle = [0.5 * (bracket[0] + theta), 0.5 * (theta + bracket[1])];
            points.push(self.locate(series, bracket[0], theta, rising, middle[0]));
            points.push(self.locate(series, theta, bracket[1], !rising, middle[1]));
        }
    }

    /// Zero of the second derivative in the bracket, by bisection: rare, so that plain is best.
    fn slope_extremum(&self, series: &[f64], bracket: [f64; 2]) -> Option<f64> {
        let curvature = |theta: f64| self.harmonics.jet(series, theta)[2];
        let [mut low, mut high] = bracket;
        let sign = curvature(low) > 0.0;
        if (curvature(high) > 0.0) == sign {
            return None;
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if (curvature(middle) > 0.0) == sign {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }

    /// Newton's method on the slope, kept inside a bracket whose left end rises if `rising`.
    fn locate(
        &self,
        series: &[f64],
        mut low: f64,
        mut high: f64,
        rising: bool,
        guess: f64,
    ) -> TurningPoint {
        let mut theta = guess;
        let mut jet = self.harmonics.jet(series, theta);
        for _ in 0..60 {
            if (jet[1] > 0.0) == rising {
                low = theta;
            } else {
                high = theta;
            }
            let newton = theta - jet[1] / jet[2];
            // Rounding may place a root at the end of its bracket just outside.
            let next = if newton >= low - ROUNDING && newton <= high + ROUNDING {
                newton
            } else {
                0.5 * (low + high)
            };
            let moved = (next - theta).abs();
            // Newton's method squares its error, and the value is stationary here: after a step
            // this short both are good to rounding.
            if moved <= 1e-7 {
                return TurningPoint { theta: next, value: jet[0] + 0.5 * jet[1] * (next - theta) };
            }
            theta = next;
            jet = self.harmonics.jet(series, theta);
        }
        TurningPoint { theta, value: jet[0] }
    }
}

/// Whether the second of three values of equal sign is closest to zero.
fn dips(here: f64, next: f64, after: f64) -> bool {
    (next.abs() < here.abs()) & (next.abs() <= after.abs()) & ((after > 0.0) == (next > 0.0))
}

/// Whether the slope changes its sign or comes closest to zero somewhere in a block of samples.
fn may_turn(slope: &[f64]) -> bool {
    pulp::Arch::new().dispatch(Turns(slope))
}

/// A block of samples; a closure would not be compiled for the widest vectors.
struct Turns<'a>(&'a [f64]);

impl NullaryFnOnce for Turns<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let mut found = false;
        for ((here, next), after) in self.0.iter().zip(&self.0[1..]).zip(&self.0[2..]) {
            found |= (*here > 0.0) != (*next > 0.0);
            found |= (next.abs() < here.abs()) & (next.abs() <= after.abs());
        }
        found
    }
}

/// Where the parabola through three equidistant values of which the first two differ in sign
/// crosses zero, as a share of the first interval.
fn zero_between([here, next, after]: [f64; 3]) -> f64 {
    let chord = (here / (here - next)).clamp(0.0, 1.0);
    // One step of Newton's method on the parabola, from where its chord crosses.
    let bend = 0.5 * (after - 2.0 * next + here);
    let slope = next - here + bend * (2.0 * chord - 1.0);
    let share = chord - bend * chord * (chord - 1.0) / slope;
    if share.is_finite() {
        share.clamp(0.0, 1.0)
    } else {
        chord
    }
}

fn halves(sums: &[f64], length: usize) -> [&[f64]; 2] {
    let (first, second) = sums.split_at(length);
    [first, second]
}
