//! The exponential of a matrix, by products of whatever stands for it and its functions; and of one whose last
//! rows are zeros.

use crate::solve::multiply;
use faer::{Accum, Mat, MatRef};

/// Size of a matrix up to which the polynomials of degree 8 and 18 are exact to rounding.
const REACH: [f64; 2] = [0.0499, 1.09];

/// Coefficients of degree 18: five sums of 1, A, A², A³ and A⁶, of which two products make the polynomial.
const SUMS: [[f64; 5]; 5] = [
    [0.0, -1.003_655_810_301_446_2e-1, -8.029_246_482_411_57e-3, -8.921_384_980_457_3e-4, 0.0],
    [
        0.0,
        3.978_497_494_996_451e-1,
        1.367_837_784_604_117_2,
        4.982_896_225_253_826_7e-1,
        -6.378_981_945_947_233e-4,
    ],
    [
        -1.096_763_960_529_620_6e1,
        1.680_158_138_789_062,
        5.717_798_464_788_655e-2,
        -6.982_101_224_880_521e-3,
        3.349_750_170_860_705e-5,
    ],
    [
        -9.043_168_323_908_106e-2,
        -6.764_045_190_713_819e-2,
        6.759_613_017_704_597e-2,
        2.955_525_704_293_155e-2,
        -1.391_802_575_160_607e-5,
    ],
    [0.0, 0.0, -9.233_646_193_671_186e-2, -1.693_649_390_020_817_2e-2, -1.400_867_981_820_361e-5],
];

/// A function of a matrix: a polynomial, or the exponential.
pub(super) trait Function: Sized {
    /// The product with another function of the same matrix.
    fn times(&self, other: &Self) -> Self;

    /// The product with itself.
    fn squared(&self) -> Self {
        self.times(self)
    }

    /// `constant + Σ factor · function`.
    fn combined<const N: usize>(constant: f64, factors: [f64; N], functions: [&Self; N]) -> Self;

    /// A size of its matrix that is that of no product larger than the product of the sizes.
    fn norm(&self) -> f64;
}

/// A polynomial of the matrix `[[M, N], [0, 0]]`: what linear equations `y' = M y + N r` with constant inputs
/// r do in a time.
#[derive(Debug, Clone)]
pub(super) struct Driven {
    /// The upper rows, of as many columns as M has and as there are inputs.
    pub(super) rows: Mat<f64>,
    /// Diagonal of the lower ones: the polynomial at 0.
    pub(super) kept: f64,
}

impl Driven {
    /// Of a matrix `[M, N]`.
    pub(super) fn new(rows: Mat<f64>) -> Self {
        Self { rows, kept: 0.0 }
    }

    /// The same times states and inputs, one column each.
    pub(super) fn applied(&self, states: MatRef<'_, f64>, inputs: MatRef<'_, f64>) -> Mat<f64> {
        let mut out = Mat::new();
        self.write_applied(states, inputs, &mut out);
        out
    }

    /// Writes it where there is room.
    pub(super) fn write_applied(
        &self,
        states: MatRef<'_, f64>,
        inputs: MatRef<'_, f64>,
        out: &mut Mat<f64>,
    ) {
        let size = states.nrows();
        out.resize_with(size, states.ncols(), |_, _| 0.0);
        let (own, driven) = (self.rows.get(.., ..size), self.rows.get(.., size..));
        multiply(out.as_mut(), Accum::Replace, own, states, 1.0);
        multiply(out.as_mut(), Accum::Add, driven, inputs, 1.0);
    }
}

impl Function for Driven {
    fn times(&self, other: &Self) -> Self {
        let size = self.rows.nrows();
        let mut rows = Mat::zeros(size, self.rows.ncols());
        let own = self.rows.get(.., ..size);
        multiply(rows.as_mut(), Accum::Replace, own, other.rows.as_ref(), 1.0);
        if other.kept != 0.0 {
            for j in size..rows.ncols() {
                let out = rows.col_as_slice_mut(j).iter_mut();
                out.zip(self.rows.col_as_slice(j)).for_each(|(out, a)| *out += other.kept * a);
            }
        }
        Self { rows, kept: self.kept * other.kept }
    }

    fn combined<const N: usize>(constant: f64, factors: [f64; N], functions: [&Self; N]) -> Self {
        let size = functions[0].rows.nrows();
        let kept = factors.iter().zip(functions).map(|(factor, own)| factor * own.kept);
        let kept = constant + kept.sum::<f64>();
        let mut rows = sum_of(factors, functions.map(|own| &own.rows));
        for j in 0..size {
            rows[(j, j)] += constant;
        }
        Self { rows, kept }
    }

    fn norm(&self) -> f64 {
        self.rows.norm_l2()
    }
}

/// Exponential of a matrix, given its square; `power` multiplies a power of it by the matrix itself. It is its
/// Taylor polynomial of degree 8 or 18 in three or five products (Bader, Blanes and Casas 2019), scaled and
/// squared. Powers of the matrix tell its size more closely than it does (Al-Mohy and Higham 2009).
pub(super) fn exponential<F: Function>(a: &F, second: F, power: impl Fn(&F) -> F) -> F {
    if a.norm() <= REACH[0] {
        return of_small(a, &second);
    }
    let third = power(&second);
    let sixth = third.squared();
    // ‖A^k‖ of k ≥ 19 is at most that of the sixth power as often as it is in k − 7, and of lower ones.
    let root = |power: &F, order: f64| power.norm().log2() / order;
    let most = root(&second, 2.0).max(root(&third, 3.0));
    let size = (12.0 * root(&sixth, 6.0).min(most) + 7.0 * most) / 19.0;
    let squarings = (size - REACH[1].log2()).ceil().max(0.0);
    let scale = 0.5_f64.powf(squarings);
    let scales = [scale, scale.powi(2), scale.powi(3), scale.powi(6)];
    let powers = [a, &second, &third, &sixth];
    let sum = |coefficients: &[f64; 5]| {
        let factors = [0, 1, 2, 3].map(|k| coefficients[k + 1] * scales[k]);
        F::combined(coefficients[0], factors, powers)
    };
    let [first, low, middle, offset, last] = [0, 1, 2, 3, 4].map(|number| sum(&SUMS[number]));
    let ninth = plus(&first.times(&last), &offset);
    let mut value = plus(&plus(&middle, &ninth).times(&ninth), &low);
    for _ in 0..squarings as usize {
        value = value.squared();
    }
    value
}

fn plus<F: Function>(one: &F, other: &F) -> F {
    F::combined(0.0, [1.0, 1.0], [one, other])
}

/// Degree 8, without scaling.
fn of_small<F: Function>(a: &F, second: &F) -> F {
    let root = 177.0_f64.sqrt();
    let third = 2.0 / 3.0;
    let ratio = third * (1.0 + root) / 88.0;
    let fourth = second.times(&F::combined(0.0, [ratio, 0.25 * ratio], [a, second]));
    let factors = [
        (11.0 * root - 11.0) / (1260.0 * third),
        (11.0 * root - 99.0) / (5040.0 * third),
        (89.0 - root) / (5040.0 * third * third),
    ];
    let constant = (29.0 * root - 271.0) / (315.0 * third);
    let eighth = F::combined(0.0, [third, 1.0], [second, &fourth]).times(&F::combined(
        constant,
        factors,
        [a, second, &fourth],
    ));
    let bend = (857.0 - 58.0 * root) / 630.0;
    F::combined(1.0, [1.0, bend, 1.0], [a, second, &eighth])
}

/// `Σ factor · matrix`.
pub(super) fn sum_of<const N: usize>(factors: [f64; N], matrices: [&Mat<f64>; N]) -> Mat<f64> {
    let mut sum = Mat::zeros(matrices[0].nrows(), matrices[0].ncols());
    pulp::Arch::new().dispatch(Sum { factors, matrices, sum: &mut sum });
    sum
}

/// A closure would be no part of what vector instructions are chosen for.
struct Sum<'a, const N: usize> {
    factors: [f64; N],
    matrices: [&'a Mat<f64>; N],
    sum: &'a mut Mat<f64>,
}

impl<const N: usize> pulp::NullaryFnOnce for Sum<'_, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for j in 0..self.sum.ncols() {
            let out = self.sum.col_as_slice_mut(j);
            for (factor, matrix) in self.factors.iter().zip(self.matrices) {
                if *factor != 0.0 {
                    let own = matrix.col_as_slice(j);
                    out.iter_mut().zip(own).for_each(|(out, a)| *out += factor * a);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(a: Mat<f64>) -> Mat<f64> {
        let a = Driven::new(a);
        exponential(&a, a.squared(), |power| a.times(power)).rows
    }

    /// Coefficients of the polynomials themselves, from a matrix with but one diagonal.
    #[test]
    fn both_polynomials_are_those_of_taylor() {
        for (degree, scale) in [(8, 0.01), (18, 0.2)] {
            let e = of(Mat::from_fn(25, 25, |i, j| if i == j + 1 { scale } else { 0.0 }));
            let mut expected = 1.0;
            for k in 0..=degree {
                assert!((e[(k, 0)] / expected - 1.0).abs() < 1e-13, "{degree} {k}");
                expected *= scale / (k + 1) as f64;
            }
        }
    }

    #[test]
    fn the_exponential_of_a_rotation_is_exact() {
        for angle in [1e-3_f64, 0.03, 0.7, 7.3, 111.0] {
            let e = of(Mat::from_fn(2, 2, |i, j| angle * (i as f64 - j as f64)));
            let allowed = 1e-15 * angle.max(10.0);
            assert!((e[(0, 0)] - angle.cos()).abs() < allowed, "{angle}");
            assert!((e[(1, 0)] - angle.sin()).abs() < allowed, "{angle}");
        }
    }

    /// `y' = J y + e r` turns about where it rests.
    #[test]
    fn constant_inputs_move_a_rotation_about_its_centre() {
        for angle in [1e-3_f64, 0.03, 0.7, 7.3, 111.0] {
            let e = of(Mat::from_fn(2, 3, |i, j| match j {
                2 => angle * (1.0 - i as f64),
                j => angle * (i as f64 - j as f64),
            }));
            let allowed = 1e-15 * angle.max(10.0);
            assert!((e[(0, 2)] - angle.sin()).abs() < allowed, "{angle}");
            assert!((e[(1, 2)] - (1.0 - angle.cos())).abs() < allowed, "{angle}");
        }
    }
}
