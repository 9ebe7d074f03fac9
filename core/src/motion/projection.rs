//! Modes seen at the contacts: `u = B Φ η`, and `(B Φ)ᵀ f` back.

/// Numbers that are summed side by side, in registers: many, and what is left over.
const WIDE: usize = 32;
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

    /// The product with a vector of which these columns alone are not 0, in whole blocks.
    fn product(&self, vector: impl Iterator<Item = (usize, f64)> + Clone, out: &mut Vec<f64>) {
        out.clear();
        if self.plain {
            let rows = self.narrow.chunks_exact(self.columns.max(1));
            out.extend(rows.map(|row| vector.clone().map(|(j, x)| row[j] * x).sum::<f64>()));
            return;
        }
        pulp::Arch::new().dispatch(|| {
            sums::<{ WIDE / 2 }>(&self.wide, self.columns, vector.clone(), out);
            sums::<{ NARROW / 2 }>(&self.narrow, self.columns, vector, out);
        });
    }
}

/// Products of blocks of twice so many rows.
#[inline(always)]
fn sums<const HALF: usize>(
    blocks: &[f64],
    columns: usize,
    vector: impl Iterator<Item = (usize, f64)> + Clone,
    out: &mut Vec<f64>,
) {
    for block in blocks.chunks_exact((2 * HALF * columns).max(1)) {
        let (mut upper, mut lower) = ([0.0; HALF], [0.0; HALF]);
        for (j, x) in vector.clone() {
            let column = &block[2 * HALF * j..2 * HALF * (j + 1)];
            let (first, last) = column.split_at(HALF);
            for (sum, b) in upper.iter_mut().zip(first) {
                *sum += b * x;
            }
            for (sum, b) in lower.iter_mut().zip(last) {
                *sum += b * x;
            }
        }
        out.extend_from_slice(&upper);
        out.extend_from_slice(&lower);
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

    /// Displacements of all points, in whole blocks; each is the sum over the modes in their order.
    pub(super) fn displacements(&self, modal: &[f64], out: &mut Vec<f64>) {
        self.to_points.product(modal.iter().copied().enumerate(), out);
    }

    /// Modal forces of forces at some points, in whole blocks.
    pub(super) fn modal_forces(&self, forces: &[(usize, f64)], out: &mut Vec<f64>) {
        self.to_modes.product(forces.iter().copied(), out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_with_the_rows() {
        for (points, modes) in [(1, 1), (3, 5), (16, 2), (37, 71)] {
            let rows: Vec<f64> = (0..points * modes).map(|i| (i as f64).sin()).collect();
            let projection = Projection::new(&rows, modes);
            let modal: Vec<f64> = (0..modes).map(|i| (i as f64).cos()).collect();
            let mut found = Vec::new();
            projection.displacements(&modal, &mut found);
            for (row, found) in rows.chunks_exact(modes).zip(&found) {
                let expected: f64 = row.iter().zip(&modal).map(|(b, x)| b * x).sum();
                assert_eq!(*found, expected);
            }
            let forces: Vec<(usize, f64)> =
                (0..points).step_by(2).map(|i| (i, (i as f64).cos())).collect();
            projection.modal_forces(&forces, &mut found);
            for (mode, found) in found.iter().enumerate().take(modes) {
                let expected: f64 = forces.iter().map(|(i, f)| rows[i * modes + mode] * f).sum();
                assert_eq!(*found, expected);
            }
        }
    }
}
