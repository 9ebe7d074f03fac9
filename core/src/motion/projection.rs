//! Modes seen at the contacts: `u = B Φ η`, and `(B Φ)ᵀ f` back.

/// Numbers that are summed side by side, in registers: many, and what is left over.
const WIDE: usize = 16;
const NARROW: usize = 8;
/// Numbers of a matrix that is not worth vector instructions.
const SMALL: usize = 64;

/// B Φ in blocks, for products with vector instructions.
#[derive(Debug, Clone)]
pub(super) struct Projection {
    /// Blocks of points, mode after mode, and blocks of modes, point after point.
    to_points: Blocks,
    to_modes: Blocks,
}

/// A matrix in blocks of rows, each column after column; missing rows are zeros.
#[derive(Debug, Clone)]
struct Blocks {
    columns: usize,
    /// Whether it is too small for vector instructions: row after row.
    plain: bool,
    wide: Vec<f64>,
    narrow: Vec<f64>,
}

impl Blocks {
    fn new(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let plain = rows * columns <= SMALL;
        let whole = if plain { 0 } else { rows / WIDE * WIDE };
        let lanes = if plain { 1 } else { NARROW };
        let blocks = |first: usize, end: usize, lanes: usize| -> Vec<f64> {
            let padded = |i: usize, j: usize| if i < rows { entry(i, j) } else { 0.0 };
            let starts = (first..end).step_by(lanes);
            starts
                .flat_map(|start| (0..columns).map(move |j| (start, j)))
                .flat_map(|(start, j)| (start..start + lanes).map(move |i| (i, j)))
                .map(|(i, j)| padded(i, j))
                .collect()
        };
        Self { columns, plain, wide: blocks(0, whole, WIDE), narrow: blocks(whole, rows, lanes) }
    }

    /// The products with vectors of which these columns alone are not 0, in whole blocks.
    fn products<const N: usize>(
        &self,
        vectors: impl Iterator<Item = (usize, [f64; N])> + Clone,
        out: &mut [Vec<f64>; N],
    ) {
        if self.plain {
            let rows = self.narrow.chunks_exact(self.columns.max(1));
            out.iter_mut().for_each(|out| out.resize(rows.len(), 0.0));
            for (place, row) in rows.enumerate() {
                let mut sums = [0.0; N];
                for (j, x) in vectors.clone() {
                    sums.iter_mut().zip(x).for_each(|(sum, x)| *sum += row[j] * x);
                }
                out.iter_mut().zip(sums).for_each(|(out, sum)| out[place] = sum);
            }
            return;
        }
        out.iter_mut().for_each(Vec::clear);
        pulp::Arch::new().dispatch(Products { blocks: self, vectors, out });
    }
}

/// Products of all blocks; a closure would be no part of what vector instructions are chosen for. These multiply
/// and add in one, with one rounding.
struct Products<'a, V, const N: usize> {
    blocks: &'a Blocks,
    vectors: V,
    out: &'a mut [Vec<f64>; N],
}

impl<V, const N: usize> pulp::WithSimd for Products<'_, V, N>
where
    V: Iterator<Item = (usize, [f64; N])> + Clone,
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Blocks { columns, wide, narrow, .. } = self.blocks;
        sums::<{ WIDE / 2 }, N, S>(wide, *columns, self.vectors.clone(), self.out);
        sums::<{ NARROW / 2 }, N, S>(narrow, *columns, self.vectors, self.out);
    }
}

/// Products of blocks of twice so many rows.
#[inline(always)]
fn sums<const HALF: usize, const N: usize, S: pulp::Simd>(
    blocks: &[f64],
    columns: usize,
    vectors: impl Iterator<Item = (usize, [f64; N])> + Clone,
    out: &mut [Vec<f64>; N],
) {
    for block in blocks.chunks_exact((2 * HALF * columns).max(1)) {
        let (mut upper, mut lower) = ([[0.0; HALF]; N], [[0.0; HALF]; N]);
        for (j, x) in vectors.clone() {
            let column = &block[2 * HALF * j..2 * HALF * (j + 1)];
            let (first, last) = column.split_at(HALF);
            for ((upper, lower), x) in upper.iter_mut().zip(&mut lower).zip(x) {
                for (sum, b) in upper.iter_mut().zip(first) {
                    *sum = plus_product::<S>(*sum, *b, x);
                }
                for (sum, b) in lower.iter_mut().zip(last) {
                    *sum = plus_product::<S>(*sum, *b, x);
                }
            }
        }
        for (out, (upper, lower)) in out.iter_mut().zip(upper.iter().zip(&lower)) {
            out.extend_from_slice(upper);
            out.extend_from_slice(lower);
        }
    }
}

/// `sum + b x`; without vector instructions a product and a sum, for there both in one would be a call.
#[inline(always)]
fn plus_product<S: pulp::Simd>(sum: f64, b: f64, x: f64) -> f64 {
    if S::IS_SCALAR {
        sum + b * x
    } else {
        b.mul_add(x, sum)
    }
}

impl Projection {
    /// From the rows of B Φ, point after point.
    pub(super) fn new(rows: &[f64], modes: usize) -> Self {
        let points = rows.len() / modes.max(1);
        Self {
            to_points: Blocks::new(points, modes, |point, mode| rows[point * modes + mode]),
            to_modes: Blocks::new(modes, points, |mode, point| rows[point * modes + mode]),
        }
    }

    /// Displacements of all points in two motions, in whole blocks; each is the sum over the modes in their
    /// order.
    pub(super) fn displacements(&self, [one, other]: [&[f64]; 2], out: &mut [Vec<f64>; 2]) {
        let both = one.iter().zip(other).map(|(a, b)| [*a, *b]).enumerate();
        self.to_points.products(both, out);
    }

    /// The same in one motion.
    pub(super) fn displacement(&self, one: &[f64], out: &mut [Vec<f64>; 1]) {
        self.to_points.products(one.iter().map(|a| [*a]).enumerate(), out);
    }

    /// Modal forces of some sets of forces at some points, in whole blocks.
    pub(super) fn modal_forces<const N: usize>(
        &self,
        forces: &[(usize, [f64; N])],
        out: &mut [Vec<f64>; N],
    ) {
        self.to_modes.products(forces.iter().copied(), out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of sums of some tens of products, each rounded once or twice.
    const ROUNDING: f64 = 1e-15;

    #[test]
    fn products_are_those_with_the_rows() {
        for (points, modes) in [(1, 1), (3, 5), (16, 2), (37, 71)] {
            let rows: Vec<f64> = (0..points * modes).map(|i| (i as f64).sin()).collect();
            let projection = Projection::new(&rows, modes);
            let modal = |way: f64| (0..modes).map(|i| (way * i as f64).cos()).collect::<Vec<_>>();
            let both = [modal(1.0), modal(0.3)];
            let mut found = [Vec::new(), Vec::new()];
            projection.displacements([&both[0], &both[1]], &mut found);
            for (modal, found) in both.iter().zip(&found) {
                for (row, found) in rows.chunks_exact(modes).zip(found) {
                    let expected: f64 = row.iter().zip(modal).map(|(b, x)| b * x).sum();
                    let size: f64 = row.iter().zip(modal).map(|(b, x)| (b * x).abs()).sum();
                    assert!((found - expected).abs() <= ROUNDING * size);
                }
            }
            let mut alone = [Vec::new()];
            projection.displacement(&both[1], &mut alone);
            assert_eq!(alone[0], found[1]);
            let forces: Vec<(usize, [f64; 2])> =
                (0..points).step_by(2).map(|i| (i, [(i as f64).cos(), 0.5])).collect();
            projection.modal_forces(&forces, &mut found);
            for (n, found) in found.iter().enumerate() {
                for (mode, found) in found.iter().enumerate().take(modes) {
                    let parts = forces.iter().map(|(i, f)| rows[i * modes + mode] * f[n]);
                    let [expected, size] =
                        [parts.clone().sum::<f64>(), parts.map(f64::abs).sum::<f64>()];
                    assert!((found - expected).abs() <= ROUNDING * size);
                }
            }
        }
    }
}
