//! Numbers with their derivatives: what a law says of a step, and what of its change.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number that a step of a law can be computed with.
pub(super) trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + From<f64>
{
    /// The number without its derivatives.
    fn value(self) -> f64;

    /// A function of the number, from its value and its slope there.
    fn through(self, value: f64, slope: f64) -> Self;

    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.through(root, 0.5 / root)
    }

    fn exp(self) -> Self {
        let power = self.value().exp();
        self.through(power, power)
    }

    /// `ln(1 + x)/x`.
    fn log_ratio(self) -> Self {
        let x = self.value();
        if x.abs() < 1e-3 {
            let term = |n: i32| f64::from(n).recip();
            let series = |c: [f64; 6]| c.iter().rev().fold(0.0, |sum, c| c - x * sum);
            let value = series([1.0, term(2), term(3), term(4), term(5), term(6)]);
            let slope =
                -series([term(2), 2.0 * term(3), 3.0 * term(4), 4.0 * term(5), 5.0 * term(6), 0.0]);
            return self.through(value, slope);
        }
        let value = x.ln_1p() / x;
        self.through(value, (1.0 / (1.0 + x) - value) / x)
    }
}

impl Real for f64 {
    fn value(self) -> f64 {
        self
    }

    fn through(self, value: f64, _slope: f64) -> Self {
        value
    }
}

/// A number with its derivatives in N others.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dual<const N: usize> {
    value: f64,
    pub(super) slopes: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// The number that is the `index`-th of those that all are differentiated in.
    pub(super) fn variable(value: f64, index: usize) -> Self {
        let mut slopes = [0.0; N];
        slopes[index] = 1.0;
        Self { value, slopes }
    }

    #[inline(always)]
    fn combined(value: f64, a: (f64, Self), b: (f64, Self)) -> Self {
        let slope = |i: usize| a.0 * a.1.slopes[i] + b.0 * b.1.slopes[i];
        Self { value, slopes: std::array::from_fn(slope) }
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    fn from(value: f64) -> Self {
        Self { value, slopes: [0.0; N] }
    }
}

impl<const N: usize> Real for Dual<N> {
    fn value(self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn through(self, value: f64, slope: f64) -> Self {
        Self { value, slopes: self.slopes.map(|own| slope * own) }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.through(-self.value, -1.0)
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::combined(self.value + other.value, (1.0, self), (1.0, other))
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::combined(self.value - other.value, (1.0, self), (-1.0, other))
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::combined(self.value * other.value, (other.value, self), (self.value, other))
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let ratio = self.value / other.value;
        Self::combined(ratio, (1.0 / other.value, self), (-ratio / other.value, other))
    }
}
