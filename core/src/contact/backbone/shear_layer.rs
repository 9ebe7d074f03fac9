//! The backbone of a bar on a layer of distributed friction (Menq, Bielak and Griffin 1986).
//!
//! By the share α of the bar that slips, with `T = tanh Λ(1 − α)` and `T₀ = tanh Λ`,
//! `φ = α + T/Λ` and `x = Λ T₀ (1/Λ² + w)` with `w = α²/2 + α T/Λ`. In `y = √(1 − 2w)` the loss is analytic
//! up to where all of the bar slips, y = 0: there it is kept as Chebyshev series on as many intervals as
//! give it an error of 1e-12, for the equation of α takes ten times as long; summed as powers.

use super::loss::Loss;
use crate::fourier::{Lanes, NODES};
use pulp::{Scalar, Simd, WithSimd};
use std::f64::consts::PI;

/// Last step of an iteration that squares its error, relative to the solution.
const SQUARED: f64 = 1e-8;
/// Terms of a Chebyshev series.
const TERMS: usize = 14;
/// Last terms of a series, relative to its largest value, that are left out.
const LEFT_OUT: f64 = 1e-13;
/// Share of the bar in slip up to which α itself is sought: the series would lose the digits of a small loss.
const LITTLE: f64 = 0.01;
/// Sums of a series that are made together.
const WIDE: usize = 4;
/// Halvings of an interval at most.
const HALVINGS: u32 = 16;
/// Share of displacement and work by which the rounding of a loss is wrong, as a difference of them.
const ROUNDING: f64 = 4e-15;

/// The shear layer of one shear lag.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    pub(super) lag: f64,
    stuck: f64,
    /// x where slip begins, and where all of it slips.
    pub(super) begin: f64,
    pub(super) end: f64,
    at_end: Loss,
    /// Intervals of y, ascending.
    pieces: Vec<Piece>,
}

/// Powers of the place on an interval of y, −1 to 1, of the loss over w², w and w³: value, slope and
/// integral, and what fills the vector.
#[derive(Debug, Clone, PartialEq)]
struct Piece {
    low: f64,
    high: f64,
    powers: [[f64; WIDE]; TERMS],
}

impl Layer {
    pub(super) fn new(lag: f64) -> Self {
        let stuck = lag.tanh();
        let (begin, end) = (stuck / lag, stuck * (1.0 / lag + 0.5 * lag));
        let mut layer =
            Self { lag, stuck, begin, end, at_end: Loss::default(), pieces: Vec::new() };
        layer.at_end = layer.at(end, 1.0, 0.0);
        let w = 0.5 * LITTLE * LITTLE + LITTLE * (lag * (1.0 - LITTLE)).tanh() / lag;
        layer.fit(0.0, (1.0 - 2.0 * w).sqrt(), HALVINGS);
        layer
    }

    /// Fits an interval of y, by halves where one series is not enough.
    fn fit(&mut self, low: f64, high: f64, halvings: u32) {
        let angle = |j: usize| PI * (j as f64 + 0.5) / TERMS as f64;
        let values: [[f64; 3]; TERMS] = std::array::from_fn(|j| {
            let y = 0.5 * (low + high) + 0.5 * (high - low) * angle(j).cos();
            let w = 0.5 * (1.0 - y * y);
            let stuck = self.sticking(y);
            let x = self.begin + self.lag * self.stuck * w;
            let loss = self.at(x, 1.0 - stuck, (self.lag * stuck).tanh());
            [loss.value / (w * w), loss.slope / w, loss.integral / (w * w * w)]
        });
        let mut terms = [[0.0; 3]; TERMS];
        for (k, term) in terms.iter_mut().enumerate() {
            for (j, value) in values.iter().enumerate() {
                let weight = (if k == 0 { 1.0 } else { 2.0 }) / TERMS as f64;
                let share = weight * (k as f64 * angle(j)).cos();
                (0..3).for_each(|i| term[i] += share * value[i]);
            }
        }
        let w = 0.5 * (1.0 - low * low);
        let lost = [self.end / (w * w), 1.0 / w, self.end * self.end / (w * w * w)];
        let rough = (0..3).any(|i| {
            let size = values.iter().fold(0.0_f64, |most, value| most.max(value[i].abs()));
            let most = (LEFT_OUT * size).max(ROUNDING * lost[i]);
            terms[TERMS - 2..].iter().any(|term| term[i].abs() > most)
        });
        if rough && halvings > 0 {
            let middle = 0.5 * (low + high);
            self.fit(low, middle, halvings - 1);
            self.fit(middle, high, halvings - 1);
        } else {
            self.pieces.push(Piece { low, high, powers: powers(&terms) });
        }
    }

    /// Share ε = 1 − α of the bar that sticks, from `ε − ε²/2 − (1 − ε) tanh(Λε)/Λ = y²/2`.
    fn sticking(&self, y: f64) -> f64 {
        let wanted = 0.5 * y * y;
        let (mut low, mut high) = (0.0, 1.0);
        let mut own = y.min(0.5);
        for _ in 0..80 {
            let z = self.lag * own;
            let t = z.tanh();
            let excess = rest_of_tanh(z) / self.lag + own * (t / self.lag - 0.5 * own) - wanted;
            if excess > 0.0 {
                high = own;
            } else {
                low = own;
            }
            let newton = own - excess / (t / self.lag + (1.0 - own) * t * t);
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            let moved = (next - own).abs();
            own = next;
            if moved <= 1e-16 * own {
                break;
            }
        }
        own
    }

    /// Share of the bar that slips.
    fn slipping(&self, x: f64) -> f64 {
        let (lag, wanted) = (self.lag, (x - self.begin) / (self.lag * self.stuck));
        let first = self.stuck / lag;
        // T is below T₀ and below Λ(1 − α): two bounds of the solution from below.
        let low = 2.0 * wanted / (first + (first * first + 2.0 * wanted).sqrt());
        let (mut low, mut high) = (low.max(1.0 - (1.0 - 2.0 * wanted).max(0.0).sqrt()), 1.0);
        let mut alpha = low;
        for _ in 0..60 {
            let t = (lag * (1.0 - alpha)).tanh();
            let excess = 0.5 * alpha * alpha + alpha * t / lag - wanted;
            if excess > 0.0 {
                high = alpha;
            } else {
                low = alpha;
            }
            let newton = alpha - excess / (t / lag + alpha * t * t);
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            let moved = (next - alpha).abs();
            alpha = next;
            // Newton's method squares its error.
            if moved <= SQUARED * alpha {
                break;
            }
        }
        alpha
    }

    /// `∫ φ dx` where the share α slips and φ is known.
    fn work(&self, x: f64, alpha: f64, t: f64) -> f64 {
        let lag = self.lag;
        let phi = alpha + t / lag;
        let lost = phi / (2.0 * lag * lag)
            + alpha.powi(3) / 6.0
            + alpha * t * (alpha + t / lag) / (2.0 * lag);
        x * phi - lag * self.stuck * lost
    }

    /// The loss where the share α slips.
    fn at(&self, x: f64, alpha: f64, t: f64) -> Loss {
        let (lag, t_0) = (self.lag, self.stuck);
        let lost = (lag * alpha).tanh() * (1.0 - t * t_0);
        Loss {
            integral: 0.5 * x * x - self.work(x, alpha, t),
            value: lag * t_0 * (0.5 * alpha * alpha + alpha * t / lag) - alpha + lost / lag,
            slope: (lost / t_0 + alpha * lag * t) / (1.0 + alpha * lag * t),
        }
    }

    pub(super) fn loss(&self, x: f64) -> Loss {
        if x <= self.begin {
            return Loss::default();
        }
        if x >= self.end {
            return self.at_end.straight(1.0, x - self.end);
        }
        let unit = self.lag * self.stuck;
        let y = (2.0 * (self.end - x) / unit).sqrt();
        let number = self.pieces.partition_point(|piece| piece.high < y);
        let Some(piece) = self.pieces.get(number) else {
            let alpha = self.slipping(x);
            return self.at(x, alpha, (self.lag * (1.0 - alpha)).tanh());
        };
        let w = (x - self.begin) / unit;
        let [value, slope, integral, _] = piece.at(Scalar::new(), y);
        Loss { integral: w * w * w * integral, value: w * w * value, slope: w * slope }
    }

    /// Value and slope of the loss at many displacements.
    pub(super) fn losses(&self, x: &Lanes) -> [Lanes; 2] {
        pulp::Arch::new().dispatch(Losing { layer: self, x })
    }

    /// `∂φ/∂Λ` at a fixed x.
    pub(super) fn by_shear_lag(&self, x: f64) -> f64 {
        if x <= self.begin || x >= self.end {
            return 0.0;
        }
        let (lag, t_0) = (self.lag, self.stuck);
        let alpha = self.slipping(x);
        let t = (lag * (1.0 - alpha)).tanh();
        let t_by = (1.0 - alpha) * (1.0 - t * t);
        let share = 1.0 / lag + 0.5 * lag * alpha * alpha + alpha * t;
        let x_by = (1.0 - t_0 * t_0) * share
            + t_0 * (-1.0 / (lag * lag) + 0.5 * alpha * alpha + alpha * t_by);
        t_by / lag - t / (lag * lag) - (1.0 - self.loss(x).slope) * x_by
    }
}

impl Piece {
    /// The series at y.
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, y: f64) -> [f64; WIDE] {
        const { assert!(S::F64_LANES <= WIDE) };
        let place = simd.splat_f64s((2.0 * y - self.low - self.high) / (self.high - self.low));
        let mut out = [0.0; WIDE];
        let (sums, _) = S::as_mut_simd_f64s(&mut out);
        for power in self.powers.iter().rev() {
            for (sum, power) in sums.iter_mut().zip(S::as_simd_f64s(power).0) {
                *sum = simd.mul_add_e_f64s(*sum, place, *power);
            }
        }
        out
    }
}

/// A series of Chebyshev polynomials in powers of their argument.
fn powers(terms: &[[f64; 3]; TERMS]) -> [[f64; WIDE]; TERMS] {
    let mut powers = [[0.0; WIDE]; TERMS];
    let (mut before, mut own) = ([0.0; TERMS], [0.0; TERMS]);
    own[0] = 1.0;
    for (k, term) in terms.iter().enumerate() {
        for (power, share) in powers.iter_mut().zip(own) {
            (0..3).for_each(|i| power[i] += share * term[i]);
        }
        let twice = if k == 0 { 1.0 } else { 2.0 };
        let next = |n: usize| if n == 0 { 0.0 } else { twice * own[n - 1] };
        let next = std::array::from_fn(|n| next(n) - before[n]);
        (before, own) = (own, next);
    }
    powers
}

/// The loss at many displacements.
struct Losing<'a> {
    layer: &'a Layer,
    x: &'a Lanes,
}

impl WithSimd for Losing<'_> {
    type Output = [Lanes; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [Lanes; 2] {
        let Self { layer, x } = self;
        let unit = layer.lag * layer.stuck;
        let (mut w, mut y) = ([0.0; NODES], [0.0; NODES]);
        for i in 0..NODES {
            w[i] = (x[i] - layer.begin) / unit;
            y[i] = (2.0 * (layer.end - x[i]) / unit).max(0.0).sqrt();
        }
        let [mut value, mut slope] = [[0.0; NODES]; 2];
        let (last, mut number) = (layer.pieces.len() - 1, 0);
        for i in 0..NODES {
            // Neighbours lie on the same interval as a rule.
            while number < last && layer.pieces[number].high < y[i] {
                number += 1;
            }
            while number > 0 && layer.pieces[number].low > y[i] {
                number -= 1;
            }
            let sum = layer.pieces[number].at(simd, y[i]);
            (value[i], slope[i]) = (w[i] * w[i] * sum[0], w[i] * sum[1]);
        }
        let highest = layer.pieces.last().map_or(0.0, |piece| piece.high);
        for i in 0..NODES {
            if x[i] <= layer.begin || x[i] >= layer.end || y[i] > highest {
                let loss = layer.loss(x[i]);
                (value[i], slope[i]) = (loss.value, loss.slope);
            }
        }
        [value, slope]
    }
}

/// `z − tanh z`.
fn rest_of_tanh(z: f64) -> f64 {
    if z > 0.5 {
        return z - z.tanh();
    }
    // z − tanh z = (z cosh z − sinh z)/cosh z, by the series of the numerator.
    let square = z * z;
    let mut term = z * square / 3.0;
    let mut sum = 0.0;
    for n in 1..12 {
        sum += term;
        let k = f64::from(2 * n);
        term *= square * (k + 2.0) / (k * (k + 2.0) * (k + 3.0));
    }
    sum / z.cosh()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_losses_are_those_of_each() {
        for lag in [0.01, 3.0, 400.0] {
            let layer = Layer::new(lag);
            for (from, to) in [(0.0, 1.2), (0.3, 0.4), (1.0 - 1e-6, 1.0 + 1e-6), (1.1, 0.0)] {
                let x = std::array::from_fn(|i| {
                    let share = from + (to - from) * i as f64 / (NODES - 1) as f64;
                    layer.begin + (layer.end - layer.begin) * share
                });
                let [value, slope] = layer.losses(&x);
                for i in 0..NODES {
                    let one = layer.loss(x[i]);
                    assert!((value[i] - one.value).abs() <= 1e-14 * one.value, "{lag} {i}");
                    assert!((slope[i] - one.slope).abs() <= 1e-14, "{lag} {i}");
                }
            }
        }
    }

    #[test]
    fn the_series_are_the_solution() {
        for lag in [0.01, 0.3, 1.5, 3.0, 20.0, 400.0, 5000.0] {
            let layer = Layer::new(lag);
            assert!(layer.pieces.len() < 300, "{lag}: {}", layer.pieces.len());
            for n in 1..2000 {
                let x = layer.begin + (layer.end - layer.begin) * f64::from(n) / 2000.0;
                let alpha = layer.slipping(x);
                let exact = layer.at(x, alpha, (lag * (1.0 - alpha)).tanh());
                let found = layer.loss(x);
                let close = |a: f64, b: f64, most: f64| {
                    assert!((a - b).abs() <= most, "{lag} {n}: {a:e} {b:e}");
                };
                close(found.value, exact.value, 2e-12 * exact.value + 2e-15 * layer.end);
                close(found.slope, exact.slope, 2e-11);
                close(found.integral, exact.integral, 2e-12 * exact.integral + 2e-15 * x * x);
            }
        }
    }

    #[test]
    fn the_rest_of_tanh_keeps_its_digits() {
        for z in [1e-6_f64, 1e-3, 0.1, 0.49] {
            let series = z * z * z / 3.0 * (1.0 - 0.4 * z * z + 17.0 / 105.0 * z.powi(4));
            assert!((rest_of_tanh(z) - series).abs() <= 0.08 * z.powi(9) + 1e-15 * series);
        }
        assert!((rest_of_tanh(0.5) / (0.5 - 0.5_f64.tanh()) - 1.0).abs() < 1e-13);
    }
}
