//! The exponential of a matrix.

use faer::Mat;

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

/// Exponential of a matrix: its Taylor polynomial of degree 8 or 18 in three or five products (Bader,
/// Blanes and Casas 2019), scaled and squared. Powers of the matrix tell its size more closely than it
/// does (Al-Mohy and Higham 2009).
pub(super) fn exponential(a: &Mat<f64>) -> Mat<f64> {
    if a.norm_l2() <= REACH[0] {
        return of_small(a);
    }
    let second = a * a;
    let third = &second * a;
    let sixth = &third * &third;
    // ‖A^k‖ of k ≥ 19 is at most that of the sixth power as often as it is in k − 7, and of lower ones.
    let root = |power: &Mat<f64>, order: f64| power.norm_l2().log2() / order;
    let most = root(&second, 2.0).max(root(&third, 3.0));
    let size = (12.0 * root(&sixth, 6.0).min(most) + 7.0 * most) / 19.0;
    let squarings = (size - REACH[1].log2()).ceil().max(0.0);
    let scale = 0.5_f64.powf(squarings);
    let scales = [scale, scale.powi(2), scale.powi(3), scale.powi(6)];
    let powers = [a, &second, &third, &sixth];
    let sum = |coefficients: &[f64; 5]| {
        let factors = [0, 1, 2, 3].map(|k| coefficients[k + 1] * scales[k]);
        combined(coefficients[0], factors, powers)
    };
    let [first, low, middle, offset, last] = [0, 1, 2, 3, 4].map(|number| sum(&SUMS[number]));
    let ninth = first * last + offset;
    let mut value = (middle + &ninth) * &ninth + low;
    for _ in 0..squarings as usize {
        value = &value * &value;
    }
    value
}

/// Degree 8, without scaling.
fn of_small(a: &Mat<f64>) -> Mat<f64> {
    let root = 177.0_f64.sqrt();
    let third = 2.0 / 3.0;
    let second = a * a;
    let ratio = third * (1.0 + root) / 88.0;
    let fourth = &second * combined(0.0, [ratio, 0.25 * ratio], [a, &second]);
    let factors = [
        (11.0 * root - 11.0) / (1260.0 * third),
        (11.0 * root - 99.0) / (5040.0 * third),
        (89.0 - root) / (5040.0 * third * third),
    ];
    let constant = (29.0 * root - 271.0) / (315.0 * third);
    let eighth = combined(0.0, [third, 1.0], [&second, &fourth])
        * combined(constant, factors, [a, &second, &fourth]);
    let bend = (857.0 - 58.0 * root) / 630.0;
    combined(1.0, [1.0, bend, 1.0], [a, &second, &eighth])
}

/// `constant + Σ factor · matrix`.
fn combined<const N: usize>(
    constant: f64,
    factors: [f64; N],
    matrices: [&Mat<f64>; N],
) -> Mat<f64> {
    let size = matrices[0].nrows();
    let mut sum = Mat::zeros(size, size);
    for j in 0..size {
        let out = sum.col_as_slice_mut(j);
        for (factor, matrix) in factors.iter().zip(matrices).filter(|(factor, _)| **factor != 0.0) {
            out.iter_mut().zip(matrix.col_as_slice(j)).for_each(|(out, a)| *out += factor * a);
        }
        out[j] += constant;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of the polynomials themselves, from a matrix with but one diagonal.
    #[test]
    fn both_polynomials_are_those_of_taylor() {
        for (degree, scale) in [(8, 0.01), (18, 0.2)] {
            let a = Mat::from_fn(25, 25, |i, j| if i == j + 1 { scale } else { 0.0 });
            let e = exponential(&a);
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
            let a = Mat::from_fn(2, 2, |i, j| angle * (i as f64 - j as f64));
            let e = exponential(&a);
            let allowed = 1e-15 * angle.max(10.0);
            assert!((e[(0, 0)] - angle.cos()).abs() < allowed, "{angle}");
            assert!((e[(1, 0)] - angle.sin()).abs() < allowed, "{angle}");
        }
    }
}
