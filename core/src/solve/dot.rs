//! Scalar products.

/// Sums of a scalar product.
const SIDE_BY_SIDE: usize = 8;

/// Scalar product, by sums that go through the processor side by side: within
/// [`pulp::Arch::dispatch`] in vectors.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (mut a, mut b) = (a.chunks_exact(SIDE_BY_SIDE), b.chunks_exact(SIDE_BY_SIDE));
    let mut sums = [0.0; SIDE_BY_SIDE];
    for (a, b) in (&mut a).zip(&mut b) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a * b);
    }
    let rest = a.remainder().iter().zip(b.remainder());
    sums.iter().sum::<f64>() + rest.map(|(a, b)| a * b).sum::<f64>()
}

/// `Σ (scale x)²`, by such sums.
#[inline(always)]
pub(crate) fn scaled_square(x: &[f64], scale: &[f64]) -> f64 {
    let (mut x, mut scale) = (x.chunks_exact(SIDE_BY_SIDE), scale.chunks_exact(SIDE_BY_SIDE));
    let mut sums = [0.0; SIDE_BY_SIDE];
    for (x, scale) in (&mut x).zip(&mut scale) {
        sums.iter_mut().zip(x.iter().zip(scale)).for_each(|(sum, (x, s))| *sum += x * s * (x * s));
    }
    let rest = x.remainder().iter().zip(scale.remainder());
    sums.iter().sum::<f64>() + rest.map(|(x, s)| x * s * (x * s)).sum::<f64>()
}
