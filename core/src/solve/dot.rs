//! Scalar products and other sums, by sums that go through the processor side by side.

/// Sums of a scalar product.
const SIDE_BY_SIDE: usize = 8;

/// Scalar product; within [`pulp::Arch::dispatch`], as all of these, in vectors.
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

/// `Σ (scale x)²`.
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

/// `Σ |a| b`.
#[inline(always)]
pub(crate) fn size(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; SIDE_BY_SIDE];
    for (a, b) in a.chunks(SIDE_BY_SIDE).zip(b.chunks(SIDE_BY_SIDE)) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a.abs() * b);
    }
    sums.iter().sum()
}

/// `Σ a b` and `Σ |a| c`.
#[inline(always)]
pub(crate) fn dot_with_size(a: &[f64], [b, c]: [&Vec<f64>; 2]) -> [f64; 2] {
    let (mut products, mut sizes) = ([0.0; SIDE_BY_SIDE], [0.0; SIDE_BY_SIDE]);
    let [of_a, of_b, of_c] =
        [a, b.as_slice(), c.as_slice()].map(|all| all.chunks_exact(SIDE_BY_SIDE));
    let rest = [&of_a, &of_b, &of_c].map(|all| all.remainder());
    for ((a, b), c) in of_a.zip(of_b).zip(of_c) {
        add([a, b, c], &mut products, &mut sizes);
    }
    add(rest, &mut products, &mut sizes);
    [products.iter().sum(), sizes.iter().sum()]
}

/// Adds products, and those of sizes, to sums.
#[inline(always)]
fn add(
    [a, b, c]: [&[f64]; 3],
    products: &mut [f64; SIDE_BY_SIDE],
    sizes: &mut [f64; SIDE_BY_SIDE],
) {
    let to = products.iter_mut().zip(sizes);
    for ((product, size), ((a, b), c)) in to.zip(a.iter().zip(b).zip(c)) {
        *product += a * b;
        *size += a.abs() * c;
    }
}
